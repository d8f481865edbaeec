"""One step of a ball in its socket: energy is kept to rounding, and what damping and friction take is never below 0.

The discrete gradient of Gonzalez: the elastic force of a step is that at its middle plus a part along the way, so that
its work is exactly what the energy falls by; damping, friction and spin are those at the middle of the step.
"""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from ..arrays import divisor, sqrt
from .reaction import (
    Constants,
    Elastic,
    Place,
    Three,
    dissipation,
    elastic,
    place_of,
    pressed,
    reaction,
    sliding,
)

ROUNDS = 60


class Ball(NamedTuple):
    """The ball as it moves: its centre (mm), velocity (mm/s) and spin (rad/s), seen from a socket at rest."""

    x: float
    y: float
    z: float
    vx: float
    vy: float
    vz: float
    wx: float
    wy: float
    wz: float


class Step(NamedTuple):
    """What a step led to: the ball, what was lost (N mm), and whether the iteration converged and the cup holds it."""

    ball: Ball
    lost: float
    good: bool


def stepped(  # type: ignore[no-untyped-def]
    potential, given: Constants, ball: Ball, mass: float, inertia: float, pull: Three, h: float
) -> Step:
    """The ball after h seconds.

    `mass` in t (N s²/mm), `inertia` in t mm², `pull` a constant force in N. The unknowns are velocity and spin at the
    middle of the step; each round solves for them as if stiffness and friction's rate were constant.
    """
    heavy, slow = 2.0 * mass / h, 2.0 * inertia / h
    begun = place_of(ball.x, ball.y, ball.z, given.clearance)
    middle = Middle(
        ball.vx + pull[0] / heavy, ball.vy + pull[1] / heavy, ball.vz + pull[2] / heavy, ball.wx, ball.wy, ball.wz
    )
    if begun.indentation + h * (abs(middle.x) + abs(middle.y) + abs(middle.z)) < -given.smoothing:
        return Step(ended(ball, middle, h), 0.0, True)
    start = elastic(potential, begun, given)
    push = start.normal / heavy
    ax, ay, az, bx, by, bz = middle
    middle = Middle(ax - push * begun.x, ay - push * begun.y, az - push * begun.z, bx, by, bz)
    size, best, moved = 1e-300, 1e300, 1e300
    for _ in range(ROUNDS):
        missed = missing(potential, given, ball, middle, start.energy, heavy, slow, pull, h)
        after, moved = corrected(missed, middle, given, heavy, slow, h)
        if not isfinite(moved):
            break
        middle = after
        size = max(size, speed_of(middle, given) + missed.force / heavy)
        if moved <= _ENOUGH * size or (moved <= _NOISE * size and moved >= 0.5 * best):
            break
        best = min(best, moved)
    ax, ay, az, bx, by, bz = middle
    place = place_of(ball.x + 0.5 * h * ax, ball.y + 0.5 * h * ay, ball.z + 0.5 * h * az, given.clearance)
    lost = h * dissipation(place, elastic(potential, place, given), (ax, ay, az), (bx, by, bz), given)
    return Step(ended(ball, middle, h), lost, missed.held and moved <= _NOISE * size)


_ENOUGH = 1e-13
"""Of the speeds in a step: what a last round may move them by; the next would by a hundredth of it."""

_NOISE = 1e-10
"""Of the speeds in a step: rounds that move them by less, and do not get better, have met rounding."""


_UNSURE = 1e-14
"""Of the indentation cubed: over so short a way what the middle misses is less than rounding, which would be divided
by the way."""


class Middle(NamedTuple):
    """Velocity and spin at the middle of a step."""

    x: float
    y: float
    z: float
    wx: float
    wy: float
    wz: float


class Missing(NamedTuple):
    """What the balance of a step misses: of force (N) and moment (N mm); the contact it was asked at."""

    x: float
    y: float
    z: float
    wx: float
    wy: float
    wz: float
    place: Place
    contact: Elastic
    force: float
    held: bool


def ended(ball: Ball, middle: Middle, h: float) -> Ball:
    """The ball after a step whose middle is known."""
    ax, ay, az, bx, by, bz = middle
    return Ball(
        ball.x + h * ax, ball.y + h * ay, ball.z + h * az,
        2.0 * ax - ball.vx, 2.0 * ay - ball.vy, 2.0 * az - ball.vz,
        2.0 * bx - ball.wx, 2.0 * by - ball.wy, 2.0 * bz - ball.wz,
    )  # fmt: skip


def speed_of(middle: Middle, given: Constants) -> float:
    """How fast the ball moves and its surface turns, in mm/s."""
    turning = abs(middle.wx) + abs(middle.wy) + abs(middle.wz)
    return abs(middle.x) + abs(middle.y) + abs(middle.z) + given.ball_radius * turning


def missing(  # type: ignore[no-untyped-def]
    potential,
    given: Constants,
    ball: Ball,
    middle: Middle,
    before: float,
    heavy: float,
    slow: float,
    pull: Three,
    h: float,
) -> Missing:
    """What is missing at a middle: inertia less forces, the elastic one with its part along the way."""
    ax, ay, az, bx, by, bz = middle
    place = place_of(ball.x + 0.5 * h * ax, ball.y + 0.5 * h * ay, ball.z + 0.5 * h * az, given.clearance)
    contact = elastic(potential, place, given)
    fx, fy, fz, mx, my, mz = reaction(place, contact, (ax, ay, az), (bx, by, bz), given)
    there = place_of(ball.x + h * ax, ball.y + h * ay, ball.z + h * az, given.clearance)
    end = elastic(potential, there, given)
    # what the middle's force misses of the energy's fall
    speed = ax * place.x + ay * place.y + az * place.z
    fall = contact.normal * speed - contact.polar * (ax * contact.px + ay * contact.py + az * contact.pz)
    size = ax * ax + ay * ay + az * az
    way, depth = h * sqrt(size), abs(place.indentation)
    sure = way * way * way / divisor(way * way * way + _UNSURE * depth * depth * depth)
    along = sure * ((end.energy - before) / h - fall) / divisor(size)
    return Missing(
        heavy * (ax - ball.vx) - fx + along * ax - pull[0],
        heavy * (ay - ball.vy) - fy + along * ay - pull[1],
        heavy * (az - ball.vz) - fz + along * az - pull[2],
        slow * (bx - ball.wx) - mx,
        slow * (by - ball.wy) - my,
        slow * (bz - ball.wz) - mz,
        place,
        contact,
        abs(fx) + abs(fy) + abs(fz),
        end.covered > -1.0 or there.indentation <= -given.smoothing,
    )


def corrected(
    missed: Missing, middle: Middle, given: Constants, heavy: float, slow: float, h: float
) -> tuple[Middle, float]:
    """The middle that misses nothing if stiffness and friction's rate stay, and how far it moved in mm/s."""
    place, contact, R1 = missed.place, missed.contact, given.ball_radius
    nx, ny, nz = place.x, place.y, place.z
    rate, lever_squared = 0.0, 0.0
    if given.static + given.viscous > 0.0:
        speed = middle.x * nx + middle.y * ny + middle.z * nz
        velocity, spin = (middle.x, middle.y, middle.z), (middle.wx, middle.wy, middle.wz)
        slip = sliding(place, pressed(contact, speed, given), velocity, spin, given)
        rate, lever_squared = slip.rate, slip.lever_squared
    lossy = given.hysteresis * contact.damped_force + given.time * contact.damped_stiffness
    across = (0.5 * h * contact.normal + given.time * contact.damped_force) * place.over
    outward = missed.x * nx + missed.y * ny + missed.z * nz
    turning = missed.wx * nx + missed.wy * ny + missed.wz * nz
    dn = -outward / (heavy + lossy + 0.5 * h * abs(contact.stiffness))
    dw = -turning / (slow + rate * lever_squared)
    # across the load: slip = v + R1 ω x n ties velocity and u = ω x n
    A, B, C = heavy + rate + across, slow + rate * R1 * R1, rate * R1
    over = 1.0 / (A * B - C * C)
    tx, ty, tz = missed.x - outward * nx, missed.y - outward * ny, missed.z - outward * nz
    ux = missed.wy * nz - missed.wz * ny
    uy = missed.wz * nx - missed.wx * nz
    uz = missed.wx * ny - missed.wy * nx
    dx, dy, dz = (C * ux - B * tx) * over, (C * uy - B * ty) * over, (C * uz - B * tz) * over
    ex, ey, ez = (C * tx - A * ux) * over, (C * ty - A * uy) * over, (C * tz - A * uz) * over
    moved = abs(dx) + abs(dy) + abs(dz) + abs(dn) + R1 * (abs(ex) + abs(ey) + abs(ez) + abs(dw))
    after = Middle(
        middle.x + dx + dn * nx,
        middle.y + dy + dn * ny,
        middle.z + dz + dn * nz,
        middle.wx + ny * ez - nz * ey + dw * nx,
        middle.wy + nz * ex - nx * ez + dw * ny,
        middle.wz + nx * ey - ny * ex + dw * nz,
    )
    return after, moved


def march(  # type: ignore[no-untyped-def]
    potential, given: Constants, ball: Ball, mass: float, inertia: float, pulls, h: float, states, lost
) -> int:
    """Steps into `states` (steps + 1, 9) and `lost` (steps + 1,), pulled by `pulls` (steps, 3); how many were good.

    In Python `pulls` is a list: numbers of NumPy would be slower.
    """
    states[0, :] = ball
    for number in range(len(lost) - 1):
        row = pulls[number]
        pull = row[0], row[1], row[2]
        after = stepped(potential, given, ball, mass, inertia, pull, h)
        ball = after.ball
        states[number + 1, :] = ball
        lost[number + 1] = lost[number] + after.lost
        if not after.good:
            return number
    return len(lost) - 1
