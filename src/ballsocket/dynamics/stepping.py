"""One time step of a ball in its socket: second order, with energy and angular momentum conserved to rounding.

The elastic force is the discrete gradient of Gonzalez in the invariants of the contact: the distance e = |r| of the
centres and, in a cup, r·dome. Without a rim it is -ΔU/Δ(e²) (r0 + r1). Its work is exactly the fall of the energy. It
has no moment about the socket's centre, in a cup none about the dome axis. Damping, friction and spin are those at the
middle of the step; what they dissipate is never negative.
"""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from ..core.arrays import safe_divisor, sqrt
from .reaction import (
    Constants,
    Elastic,
    Place,
    Three,
    dissipation,
    elastic,
    leaning,
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
        missed = missing(potential, given, ball, middle, begun.distance, start.energy, heavy, slow, pull, h)
        after, moved = corrected(missed, middle, given, heavy, slow, h)
        if not isfinite(moved):
            break
        middle = after
        size = max(size, speed_of(middle, given) + missed.force / heavy)
        if moved <= _ENOUGH * size or (moved <= _NOISE * size and moved >= 0.5 * best):
            break
        best = min(best, moved)
    ax, ay, az, bx, by, bz = middle
    lost = h * dissipation(missed.place, missed.contact, (ax, ay, az), (bx, by, bz), given)
    return Step(ended(ball, middle, h), lost, missed.held and moved <= _NOISE * size)


_ENOUGH = 1e-15
"""Change of the last round, as a share of the speeds in a step. A larger share leaves errors of one sign: 1e-13 adds
5e-15 of the energy in each bounce of two steps.
"""

_NOISE = 1e-10
"""Of the speeds in a step: rounds that move them by less, and do not get better, have met rounding."""


_UNSURE = 1e-14
"""Smallest ratio of the cubed path to the cubed indentation at which the difference quotient of the energy is used.

For a shorter path the mean gradient is exact to rounding."""


class Middle(NamedTuple):
    """Velocity and spin at the middle of a step."""

    x: float
    y: float
    z: float
    wx: float
    wy: float
    wz: float


class MeanContact(NamedTuple):
    """Elastic contact at the mean of the invariants of both ends of a step.

    `place` has the direction of the middle of the step and the mean distance; `end` is the place after the step.
    `shortening` is the distance of the middle over the mean distance. The rim's force acts along (`qx`, `qy`, `qz`);
    (`ux`, `uy`, `uz`) is the unit vector across the middle's direction in its plane with the dome axis.
    """

    place: Place
    end: Place
    contact: Elastic
    shortening: float
    qx: float
    qy: float
    qz: float
    ux: float
    uy: float
    uz: float


class Missing(NamedTuple):
    """Residual of the balance of a step: of force (N) and moment (N mm); the contact that it was evaluated at."""

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


def mean_contact(  # type: ignore[no-untyped-def]
    potential, given: Constants, ball: Ball, middle: Middle, distance: float, h: float
) -> MeanContact:
    """Evaluate the elastic contact at the mean of both ends of a step, which begins at a distance of the centres.

    The mean is that of e and of r·dome. There the difference of the energy is the gradient times the differences of
    the invariants to third order, also for a step that hardly changes them.
    """
    ax, ay, az = middle.x, middle.y, middle.z
    half = place_of(ball.x + 0.5 * h * ax, ball.y + 0.5 * h * ay, ball.z + 0.5 * h * az, given.clearance)
    end = place_of(ball.x + h * ax, ball.y + h * ay, ball.z + h * az, given.clearance)
    mean = 0.5 * (distance + end.distance)
    nx, ny, nz, over = half.x, half.y, half.z, 1.0 / safe_divisor(mean)
    shortening, depth = half.distance * over, mean - given.clearance
    place = Place(mean, nx, ny, nz, depth, over)
    if given.rim == 0.0:
        contact = elastic(potential, place, given)
        return MeanContact(place, end, contact, shortening, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    cosine, sine, px, py, pz = leaning(half, given)
    lean, across = shortening * cosine, 1.0 / safe_divisor(sine)
    level = sqrt(max(1.0 - lean * lean, 0.0))
    stretch, steep = level * across, 1.0 / safe_divisor(level)
    gx, gy, gz = given.dome_x, given.dome_y, given.dome_z
    kx, ky, kz = lean * gx, lean * gy, lean * gz
    kx, ky, kz = kx + stretch * (nx - cosine * gx), ky + stretch * (ny - cosine * gy), kz + stretch * (nz - cosine * gz)
    contact = elastic(potential, Place(mean, kx, ky, kz, depth, over), given)
    tilt = lean * shortening
    return MeanContact(
        place, end, contact, shortening,
        (tilt * nx - gx) * steep, (tilt * ny - gy) * steep, (tilt * nz - gz) * steep,
        px * across, py * across, pz * across,
    )  # fmt: skip


def missing(  # type: ignore[no-untyped-def]
    potential,
    given: Constants,
    ball: Ball,
    middle: Middle,
    distance: float,
    before: float,
    heavy: float,
    slow: float,
    pull: Three,
    h: float,
) -> Missing:
    """Compute the residual at a middle: inertia less the discrete gradient, damping, friction and pull."""
    ax, ay, az, bx, by, bz = middle
    mean = mean_contact(potential, given, ball, middle, distance, h)
    place, end, contact = mean.place, mean.end, mean.contact
    fx, fy, fz, mx, my, mz = reaction(place, contact, (ax, ay, az), (bx, by, bz), given)
    after = elastic(potential, end, given)
    nx, ny, nz = place.x, place.y, place.z
    speed = ax * nx + ay * ny + az * nz
    normal, polar = mean.shortening * contact.normal, contact.polar
    fall, square, drift = normal * speed, speed * speed, 0.0
    if given.rim > 0.0:
        fall = fall - polar * (ax * mean.qx + ay * mean.qy + az * mean.qz)
        drift = ax * mean.ux + ay * mean.uy + az * mean.uz
        square = square + drift * drift
    way, depth = h * sqrt(square), abs(place.indentation)
    sure = way * way * way / safe_divisor(way * way * way + _UNSURE * depth * depth * depth)
    along = sure * ((after.energy - before) / h - fall) / safe_divisor(square)
    inward = normal - contact.normal + along * speed  # beyond the normal force that the reaction has
    fx, fy, fz = fx - inward * nx, fy - inward * ny, fz - inward * nz
    if given.rim > 0.0:
        aside = along * drift
        fx = fx + polar * (mean.qx - contact.px) - aside * mean.ux
        fy = fy + polar * (mean.qy - contact.py) - aside * mean.uy
        fz = fz + polar * (mean.qz - contact.pz) - aside * mean.uz
    return Missing(
        heavy * (ax - ball.vx) - fx - pull[0],
        heavy * (ay - ball.vy) - fy - pull[1],
        heavy * (az - ball.vz) - fz - pull[2],
        slow * (bx - ball.wx) - mx,
        slow * (by - ball.wy) - my,
        slow * (bz - ball.wz) - mz,
        place,
        contact,
        abs(fx) + abs(fy) + abs(fz),
        after.covered > -1.0 or end.indentation <= -given.smoothing,
    )


def corrected(
    missed: Missing, middle: Middle, given: Constants, heavy: float, slow: float, h: float
) -> tuple[Middle, float]:
    """The middle that misses nothing if stiffness and friction's rate stay, and how far it moved in mm/s."""
    place, contact, R1 = missed.place, missed.contact, given.ball_radius
    nx, ny, nz = place.x, place.y, place.z
    push, mixed, turn, drill = 0.0, 0.0, 0.0, 0.0
    if given.static + given.viscous > 0.0:
        speed = middle.x * nx + middle.y * ny + middle.z * nz
        velocity, spin = (middle.x, middle.y, middle.z), (middle.wx, middle.wy, middle.wz)
        slip = sliding(place, pressed(contact, speed, given), velocity, spin, given)
        push, mixed, turn = slip.rate * slip.push, slip.rate * slip.mixed, slip.rate * slip.turn
        drill = slip.rate * slip.drill * slip.lever_squared
    lossy = given.hysteresis * contact.damped_force + given.time * contact.damped_stiffness
    across = (0.5 * h * contact.normal + given.time * contact.damped_force) * place.over
    outward = missed.x * nx + missed.y * ny + missed.z * nz
    turning = missed.wx * nx + missed.wy * ny + missed.wz * nz
    dn = -outward / (heavy + lossy + 0.5 * h * abs(contact.stiffness))
    dw = -turning / (slow + drill)
    # across the load friction couples the velocity with u = ω x n
    A, B, C = heavy + push + across, slow + turn * R1 * R1, mixed * R1
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
