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
    BallCentre,
    Constants,
    Elastic,
    Three,
    centre_of,
    dissipation,
    dome_angle,
    elastic,
    pressed,
    reaction,
    sliding,
)

MAX_ITERATIONS = 60


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
    dissipated: float
    converged: bool


def advance(  # type: ignore[no-untyped-def]
    potential, constants: Constants, ball: Ball, mass: float, inertia: float, pull: Three, h: float
) -> Step:
    """The ball after h seconds.

    `mass` in t (N s²/mm), `inertia` in t mm², `pull` a constant force in N. The unknowns are velocity and spin at the
    middle of the step; each round solves for them as if stiffness and friction's rate were constant.
    """
    mass_rate, inertia_rate = 2.0 * mass / h, 2.0 * inertia / h
    initial = centre_of(ball.x, ball.y, ball.z, constants.clearance)
    middle = MidpointVelocity(
        ball.vx + pull[0] / mass_rate,
        ball.vy + pull[1] / mass_rate,
        ball.vz + pull[2] / mass_rate,
        ball.wx,
        ball.wy,
        ball.wz,
    )
    if initial.indentation + h * (abs(middle.x) + abs(middle.y) + abs(middle.z)) < -constants.smoothing:
        return Step(end_state(ball, middle, h), 0.0, True)
    start = elastic(potential, initial, constants)
    push = start.normal / mass_rate
    ax, ay, az, bx, by, bz = middle
    middle = MidpointVelocity(ax - push * initial.x, ay - push * initial.y, az - push * initial.z, bx, by, bz)
    size, best, change = 1e-300, 1e300, 1e300
    for _ in range(MAX_ITERATIONS):
        residual = residual_of(
            potential, constants, ball, middle, initial.distance, start.energy, mass_rate, inertia_rate, pull, h
        )
        after, change = newton_correction(residual, middle, constants, mass_rate, inertia_rate, h)
        if not isfinite(change):
            break
        middle = after
        size = max(size, surface_speed(middle, constants) + residual.force / mass_rate)
        if change <= _RELATIVE_TOLERANCE * size or (change <= _ROUNDING_TOLERANCE * size and change >= 0.5 * best):
            break
        best = min(best, change)
    ax, ay, az, bx, by, bz = middle
    dissipated = h * dissipation(residual.centre, residual.contact, (ax, ay, az), (bx, by, bz), constants)
    return Step(end_state(ball, middle, h), dissipated, residual.in_cup and change <= _ROUNDING_TOLERANCE * size)


_RELATIVE_TOLERANCE = 1e-15
"""Change of the last round, as a share of the speeds in a step. A larger share leaves errors of one sign: 1e-13 adds
5e-15 of the energy in each bounce of two steps.
"""

_ROUNDING_TOLERANCE = 1e-10
"""Of the speeds in a step: rounds that move them by less, and do not get better, have met rounding."""


_MIN_PATH_RATIO = 1e-14
"""Smallest ratio of the cubed path to the cubed indentation at which the difference quotient of the energy is used.

For a shorter path the mean gradient is exact to rounding."""


class MidpointVelocity(NamedTuple):
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

    centre: BallCentre
    end: BallCentre
    contact: Elastic
    shortening: float
    qx: float
    qy: float
    qz: float
    ux: float
    uy: float
    uz: float


class StepResidual(NamedTuple):
    """Residual of the balance of a step: of force (N) and moment (N mm); the contact that it was evaluated at."""

    x: float
    y: float
    z: float
    wx: float
    wy: float
    wz: float
    centre: BallCentre
    contact: Elastic
    force: float
    in_cup: bool


def end_state(ball: Ball, middle: MidpointVelocity, h: float) -> Ball:
    """The ball after a step whose middle is known."""
    ax, ay, az, bx, by, bz = middle
    return Ball(
        ball.x + h * ax, ball.y + h * ay, ball.z + h * az,
        2.0 * ax - ball.vx, 2.0 * ay - ball.vy, 2.0 * az - ball.vz,
        2.0 * bx - ball.wx, 2.0 * by - ball.wy, 2.0 * bz - ball.wz,
    )  # fmt: skip


def surface_speed(middle: MidpointVelocity, constants: Constants) -> float:
    """How fast the ball moves and its surface turns, in mm/s."""
    turning = abs(middle.wx) + abs(middle.wy) + abs(middle.wz)
    return abs(middle.x) + abs(middle.y) + abs(middle.z) + constants.ball_radius * turning


def mean_contact(  # type: ignore[no-untyped-def]
    potential, constants: Constants, ball: Ball, middle: MidpointVelocity, distance: float, h: float
) -> MeanContact:
    """Evaluate the elastic contact at the mean of both ends of a step, which begins at a distance of the centres.

    The mean is that of e and of r·dome. There the difference of the energy is the gradient times the differences of
    the invariants to third order, also for a step that hardly changes them.
    """
    ax, ay, az = middle.x, middle.y, middle.z
    half = centre_of(ball.x + 0.5 * h * ax, ball.y + 0.5 * h * ay, ball.z + 0.5 * h * az, constants.clearance)
    end = centre_of(ball.x + h * ax, ball.y + h * ay, ball.z + h * az, constants.clearance)
    mean = 0.5 * (distance + end.distance)
    nx, ny, nz, over = half.x, half.y, half.z, 1.0 / safe_divisor(mean)
    shortening, depth = half.distance * over, mean - constants.clearance
    centre = BallCentre(mean, nx, ny, nz, depth, over)
    if constants.rim == 0.0:
        contact = elastic(potential, centre, constants)
        return MeanContact(centre, end, contact, shortening, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    cosine, sine, px, py, pz = dome_angle(half, constants)
    lean, across = shortening * cosine, 1.0 / safe_divisor(sine)
    level = sqrt(max(1.0 - lean * lean, 0.0))
    stretch, steep = level * across, 1.0 / safe_divisor(level)
    gx, gy, gz = constants.dome_x, constants.dome_y, constants.dome_z
    kx, ky, kz = lean * gx, lean * gy, lean * gz
    kx, ky, kz = kx + stretch * (nx - cosine * gx), ky + stretch * (ny - cosine * gy), kz + stretch * (nz - cosine * gz)
    contact = elastic(potential, BallCentre(mean, kx, ky, kz, depth, over), constants)
    tilt = lean * shortening
    return MeanContact(
        centre, end, contact, shortening,
        (tilt * nx - gx) * steep, (tilt * ny - gy) * steep, (tilt * nz - gz) * steep,
        px * across, py * across, pz * across,
    )  # fmt: skip


def residual_of(  # type: ignore[no-untyped-def]
    potential,
    constants: Constants,
    ball: Ball,
    middle: MidpointVelocity,
    distance: float,
    before: float,
    mass_rate: float,
    inertia_rate: float,
    pull: Three,
    h: float,
) -> StepResidual:
    """Compute the residual at a middle: inertia less the discrete gradient, damping, friction and pull."""
    ax, ay, az, bx, by, bz = middle
    mean = mean_contact(potential, constants, ball, middle, distance, h)
    centre, end, contact = mean.centre, mean.end, mean.contact
    fx, fy, fz, mx, my, mz = reaction(centre, contact, (ax, ay, az), (bx, by, bz), constants)
    after = elastic(potential, end, constants)
    nx, ny, nz = centre.x, centre.y, centre.z
    speed = ax * nx + ay * ny + az * nz
    normal, polar = mean.shortening * contact.normal, contact.polar
    fall, square, drift = normal * speed, speed * speed, 0.0
    if constants.rim > 0.0:
        fall = fall - polar * (ax * mean.qx + ay * mean.qy + az * mean.qz)
        drift = ax * mean.ux + ay * mean.uy + az * mean.uz
        square = square + drift * drift
    path, depth = h * sqrt(square), abs(centre.indentation)
    certainty = path * path * path / safe_divisor(path * path * path + _MIN_PATH_RATIO * depth * depth * depth)
    along = certainty * ((after.energy - before) / h - fall) / safe_divisor(square)
    inward = normal - contact.normal + along * speed  # beyond the normal force that the reaction has
    fx, fy, fz = fx - inward * nx, fy - inward * ny, fz - inward * nz
    if constants.rim > 0.0:
        aside = along * drift
        fx = fx + polar * (mean.qx - contact.px) - aside * mean.ux
        fy = fy + polar * (mean.qy - contact.py) - aside * mean.uy
        fz = fz + polar * (mean.qz - contact.pz) - aside * mean.uz
    return StepResidual(
        mass_rate * (ax - ball.vx) - fx - pull[0],
        mass_rate * (ay - ball.vy) - fy - pull[1],
        mass_rate * (az - ball.vz) - fz - pull[2],
        inertia_rate * (bx - ball.wx) - mx,
        inertia_rate * (by - ball.wy) - my,
        inertia_rate * (bz - ball.wz) - mz,
        centre,
        contact,
        abs(fx) + abs(fy) + abs(fz),
        after.covered > -1.0 or end.indentation <= -constants.smoothing,
    )


def newton_correction(
    residual: StepResidual,
    middle: MidpointVelocity,
    constants: Constants,
    mass_rate: float,
    inertia_rate: float,
    h: float,
) -> tuple[MidpointVelocity, float]:
    """The middle that misses nothing if stiffness and friction's rate stay, and how far it moved in mm/s."""
    centre, contact, R1 = residual.centre, residual.contact, constants.ball_radius
    nx, ny, nz = centre.x, centre.y, centre.z
    push, mixed, rotation, drill = 0.0, 0.0, 0.0, 0.0
    if constants.static + constants.viscous > 0.0:
        speed = middle.x * nx + middle.y * ny + middle.z * nz
        velocity, spin = (middle.x, middle.y, middle.z), (middle.wx, middle.wy, middle.wz)
        slip = sliding(centre, pressed(contact, speed, constants), velocity, spin, constants)
        push, mixed, rotation = slip.rate * slip.push, slip.rate * slip.mixed, slip.rate * slip.rotation
        drill = slip.rate * slip.drill * slip.lever_squared
    lossy = constants.hysteresis * contact.damped_force + constants.time * contact.damped_stiffness
    across = (0.5 * h * contact.normal + constants.time * contact.damped_force) * centre.over
    outward = residual.x * nx + residual.y * ny + residual.z * nz
    turning = residual.wx * nx + residual.wy * ny + residual.wz * nz
    dn = -outward / (mass_rate + lossy + 0.5 * h * abs(contact.stiffness))
    dw = -turning / (inertia_rate + drill)
    # across the load friction couples the velocity with u = ω x n
    A, B, C = mass_rate + push + across, inertia_rate + rotation * R1 * R1, mixed * R1
    over = 1.0 / (A * B - C * C)
    tx, ty, tz = residual.x - outward * nx, residual.y - outward * ny, residual.z - outward * nz
    ux = residual.wy * nz - residual.wz * ny
    uy = residual.wz * nx - residual.wx * nz
    uz = residual.wx * ny - residual.wy * nx
    dx, dy, dz = (C * ux - B * tx) * over, (C * uy - B * ty) * over, (C * uz - B * tz) * over
    ex, ey, ez = (C * tx - A * ux) * over, (C * ty - A * uy) * over, (C * tz - A * uz) * over
    change = abs(dx) + abs(dy) + abs(dz) + abs(dn) + R1 * (abs(ex) + abs(ey) + abs(ez) + abs(dw))
    after = MidpointVelocity(
        middle.x + dx + dn * nx,
        middle.y + dy + dn * ny,
        middle.z + dz + dn * nz,
        middle.wx + ny * ez - nz * ey + dw * nx,
        middle.wy + nz * ex - nx * ez + dw * ny,
        middle.wz + nx * ey - ny * ex + dw * nz,
    )
    return after, change


def march(  # type: ignore[no-untyped-def]
    potential, constants: Constants, ball: Ball, mass: float, inertia: float, pulls, h: float, states, dissipated
) -> int:
    """Steps into `states` (steps + 1, 9) and `lost` (steps + 1,), pulled by `pulls` (steps, 3); how many were good.

    In Python `pulls` is a list: numbers of NumPy would be slower.
    """
    states[0, :] = ball
    for number in range(len(dissipated) - 1):
        row = pulls[number]
        pull = row[0], row[1], row[2]
        after = advance(potential, constants, ball, mass, inertia, pull, h)
        ball = after.ball
        states[number + 1, :] = ball
        dissipated[number + 1] = dissipated[number] + after.dissipated
        if not after.converged:
            return number
    return len(dissipated) - 1
