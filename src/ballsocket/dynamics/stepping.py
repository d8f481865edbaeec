"""Time steps of a ball in its socket: second order, conserving energy and angular momentum to rounding.

A ball of mass m and moment of inertia I has its centre at r from that of the socket, the velocity v and the spin w. The
unknowns of a step of h seconds are velocity a and spin b at its midpoint. With values 0 at its start and 1 at its end

    r1 = r0 + h a,   v1 = 2 a - v0,   w1 = 2 b - w0,   (1)
    2 m (a - v0)/h = F(a, b) + pull,   2 I (b - w0)/h = M(a, b).   (2)

The force F has an elastic part G, the discrete gradient of Gonzalez (1996, doi 10.1007/BF02440162) of the energy U in
the invariants of the contact: the distance e = |r| of the centres and, in a cup, r·dome. With the gradient U' at the
mean of the invariants, and the part s of the velocity a along r or, in a cup, in the plane of r and the dome axis,

    G = -U' - ((U1 - U0)/h - U'·a) s/s².   (3)

Without a rim it is -ΔU/Δ(e²) (r0 + r1). Its work is exactly the decrease of the energy. It has no moment about the
socket centre, or in a cup about the dome axis. Damping, friction and spin are evaluated at the midpoint of the step,
and their dissipation is never negative.

An iteration holds the stiffness k, the damping c and the rate of friction constant. Along the unit vector n to the ball
the residuals R and R_w of (2), left side minus right side, then change the unknowns by

    (2 m/h + c + h k/2) Δa·n = -R·n,   (2 I/h + drill) Δb·n = -R_w·n,   (4)

and across n friction couples a with b x n by the matrix (A, C; C, B) in each direction.   (5)
"""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from ..core.arrays import safe_divisor, sqrt
from . import film
from .ball_centre import BallCentre, Constants, Vector, ball_centre_at, dome_angle
from .reaction import Elastic, dissipation, elastic_contact, force_and_moment, normal_force, sliding_state

MAX_ITERATIONS = 60  # largest number of iterations of a step


class BallState(NamedTuple):
    """State of a ball: centre (mm), velocity (mm/s) and spin (rad/s) relative to a socket at rest."""

    x: float
    y: float
    z: float
    vx: float
    vy: float
    vz: float
    wx: float
    wy: float
    wz: float


class StepResult(NamedTuple):
    """Ball after a time step, dissipated energy in N mm, and True for a converged step that ends in the cup."""

    ball: BallState
    dissipated: float
    converged: bool


def advance_one_step(  # type: ignore[no-untyped-def]
    potential, constants: Constants, ball: BallState, mass: float, inertia: float, pull: Vector, h: float
) -> StepResult:
    """Advance the state of a ball by one time step of h seconds.

    `mass` is in t (N s²/mm), `inertia` in t mm², and `pull` is a constant force in N.
    """
    mass_rate, inertia_rate = 2.0 * mass / h, 2.0 * inertia / h
    initial = ball_centre_at(ball.x, ball.y, ball.z, constants.clearance)
    ax, ay, az = ball.vx + pull[0] / mass_rate, ball.vy + pull[1] / mass_rate, ball.vz + pull[2] / mass_rate
    path_bound = h * (abs(ax) + abs(ay) + abs(az))
    if constants.film_damping == 0.0 and initial.indentation + path_bound < -constants.smoothing:
        return StepResult(end_state(ball, Midpoint(ax, ay, az, ball.wx, ball.wy, ball.wz), h), 0.0, True)
    start = elastic_contact(potential, initial, constants)
    push = start.normal / mass_rate
    ax, ay, az = ax - push * initial.x, ay - push * initial.y, az - push * initial.z
    midpoint = Midpoint(ax, ay, az, ball.wx, ball.wy, ball.wz)
    speed_scale, smallest_change, change = 1e-300, 1e300, 1e300
    for _ in range(MAX_ITERATIONS):
        residual = step_residual(
            potential, constants, ball, midpoint, initial.distance, start.energy, mass_rate, inertia_rate, pull, h
        )
        corrected, change = newton_correction(residual, midpoint, constants, mass_rate, inertia_rate, h)
        if not isfinite(change):
            break
        midpoint = corrected
        speed_scale = max(speed_scale, surface_speed(midpoint, constants) + residual.force / mass_rate)
        if change <= _RELATIVE_TOLERANCE * speed_scale or (
            change <= _ROUNDING_TOLERANCE * speed_scale and change >= 0.5 * smallest_change
        ):
            break
        smallest_change = min(smallest_change, change)
    ax, ay, az, bx, by, bz = midpoint
    dissipated = h * dissipation(residual.centre, residual.contact, (ax, ay, az), (bx, by, bz), constants)
    return StepResult(
        end_state(ball, midpoint, h), dissipated, residual.in_cup and change <= _ROUNDING_TOLERANCE * speed_scale
    )


_RELATIVE_TOLERANCE = 1e-15
"""Largest change of the speeds in a converged iteration, relative to the speeds of the step.

A larger tolerance leaves errors of one sign: 1e-13 adds 5e-15 of the energy in each bounce of two steps.
"""

_ROUNDING_TOLERANCE = 1e-10
"""Relative change of the speeds below which an iteration that no longer improves is limited by rounding."""


_MIN_PATH_RATIO = 1e-14
"""Smallest ratio of the cubed path to the cubed indentation at which the difference quotient of the energy is used.

For a shorter path the mean gradient is exact to rounding.
"""


class Midpoint(NamedTuple):
    """Velocity (mm/s) and spin (rad/s) at the midpoint of a time step."""

    x: float
    y: float
    z: float
    wx: float
    wy: float
    wz: float


class MeanContact(NamedTuple):
    """Elastic contact at the mean position of a time step, between its start and its end.

    `centre` has the direction of the midpoint of the step and the mean distance. `end` is the position after the step.
    `shortening` is the distance at the midpoint over the mean distance. The force of the rim acts along (`qx`, `qy`,
    `qz`). (`ux`, `uy`, `uz`) is the unit vector across the direction of the midpoint, in its plane with the dome axis.
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
    """Residuals of force (N) and moment (N mm) in the balance (2) of a time step, with its mean contact."""

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


def end_state(ball: BallState, midpoint: Midpoint, h: float) -> BallState:
    """Compute the state (1) of the ball after a time step from its velocity and spin at the midpoint."""
    ax, ay, az, bx, by, bz = midpoint
    return BallState(
        ball.x + h * ax, ball.y + h * ay, ball.z + h * az,
        2.0 * ax - ball.vx, 2.0 * ay - ball.vy, 2.0 * az - ball.vz,
        2.0 * bx - ball.wx, 2.0 * by - ball.wy, 2.0 * bz - ball.wz,
    )  # fmt: skip


def surface_speed(midpoint: Midpoint, constants: Constants) -> float:
    """Compute an upper bound of the surface speed of the ball in mm/s, from velocity and spin."""
    turning = abs(midpoint.wx) + abs(midpoint.wy) + abs(midpoint.wz)
    return abs(midpoint.x) + abs(midpoint.y) + abs(midpoint.z) + constants.ball_radius * turning


def mean_contact(  # type: ignore[no-untyped-def]
    potential, constants: Constants, ball: BallState, midpoint: Midpoint, distance: float, h: float
) -> MeanContact:
    """Compute the elastic contact at the mean position of the ball in a time step that starts at a distance in mm.

    The mean is that of e and of r·dome. To third order the difference of the energy is the gradient at the mean times
    the differences of the invariants, also for a step that hardly changes them.
    """
    ax, ay, az = midpoint.x, midpoint.y, midpoint.z
    midpoint_centre = ball_centre_at(
        ball.x + 0.5 * h * ax, ball.y + 0.5 * h * ay, ball.z + 0.5 * h * az, constants.clearance
    )
    end = ball_centre_at(ball.x + h * ax, ball.y + h * ay, ball.z + h * az, constants.clearance)
    mean_distance = 0.5 * (distance + end.distance)
    nx, ny, nz = midpoint_centre.x, midpoint_centre.y, midpoint_centre.z
    inverse_distance = 1.0 / safe_divisor(mean_distance)
    shortening, depth = midpoint_centre.distance * inverse_distance, mean_distance - constants.clearance
    centre = BallCentre(mean_distance, nx, ny, nz, depth, inverse_distance)
    if constants.rim == 0.0:
        contact = elastic_contact(potential, centre, constants)
        return MeanContact(centre, end, contact, shortening, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    cosine, sine, px, py, pz = dome_angle(midpoint_centre, constants)
    lean, across = shortening * cosine, 1.0 / safe_divisor(sine)
    mean_sine = sqrt(max(1.0 - lean * lean, 0.0))
    sine_ratio, inverse_sine = mean_sine * across, 1.0 / safe_divisor(mean_sine)
    gx, gy, gz = constants.dome_x, constants.dome_y, constants.dome_z
    kx, ky, kz = lean * gx, lean * gy, lean * gz
    kx = kx + sine_ratio * (nx - cosine * gx)
    ky = ky + sine_ratio * (ny - cosine * gy)
    kz = kz + sine_ratio * (nz - cosine * gz)
    contact = elastic_contact(potential, BallCentre(mean_distance, kx, ky, kz, depth, inverse_distance), constants)
    tilt = lean * shortening
    return MeanContact(
        centre, end, contact, shortening,
        (tilt * nx - gx) * inverse_sine, (tilt * ny - gy) * inverse_sine, (tilt * nz - gz) * inverse_sine,
        px * across, py * across, pz * across,
    )  # fmt: skip


def step_residual(  # type: ignore[no-untyped-def]
    potential,
    constants: Constants,
    ball: BallState,
    midpoint: Midpoint,
    distance: float,
    start_energy: float,
    mass_rate: float,
    inertia_rate: float,
    pull: Vector,
    h: float,
) -> StepResidual:
    """Compute the residual force and moment of the balance (2) at a trial midpoint of a time step.

    The force of the reaction has the elastic force -U' of the mean contact; the corrections replace it by (3).
    """
    ax, ay, az, bx, by, bz = midpoint
    mean = mean_contact(potential, constants, ball, midpoint, distance, h)
    centre, end, contact = mean.centre, mean.end, mean.contact
    fx, fy, fz, mx, my, mz = force_and_moment(centre, contact, (ax, ay, az), (bx, by, bz), constants)
    end_contact = elastic_contact(potential, end, constants)
    nx, ny, nz = centre.x, centre.y, centre.z
    speed = ax * nx + ay * ny + az * nz
    normal, polar = mean.shortening * contact.normal, contact.polar
    mean_power, square, tangential_speed = normal * speed, speed * speed, 0.0
    if constants.rim > 0.0:
        mean_power = mean_power - polar * (ax * mean.qx + ay * mean.qy + az * mean.qz)
        tangential_speed = ax * mean.ux + ay * mean.uy + az * mean.uz
        square = square + tangential_speed * tangential_speed
    # second term of (3), with the mean power U'·a and the square s²; it vanishes for short paths, whose ΔU is rounding
    path_length, depth = h * sqrt(square), abs(centre.indentation)
    cubed_path = path_length * path_length * path_length
    quotient_weight = cubed_path / safe_divisor(cubed_path + _MIN_PATH_RATIO * depth * depth * depth)
    gradient_correction = (
        quotient_weight * ((end_contact.energy - start_energy) / h - mean_power) / safe_divisor(square)
    )
    # in addition to the normal force of the reaction
    force_correction = normal - contact.normal + gradient_correction * speed
    fx, fy, fz = fx - force_correction * nx, fy - force_correction * ny, fz - force_correction * nz
    if constants.rim > 0.0:
        tangential_correction = gradient_correction * tangential_speed
        fx = fx + polar * (mean.qx - contact.px) - tangential_correction * mean.ux
        fy = fy + polar * (mean.qy - contact.py) - tangential_correction * mean.uy
        fz = fz + polar * (mean.qz - contact.pz) - tangential_correction * mean.uz
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
        end_contact.rim_margin > -1.0 or end.indentation <= -constants.smoothing,
    )


def newton_correction(
    residual: StepResidual, midpoint: Midpoint, constants: Constants, mass_rate: float, inertia_rate: float, h: float
) -> tuple[Midpoint, float]:
    """Solve the linearised equations (4) and (5) for a new midpoint; return it and its change in mm/s."""
    centre, contact, R1 = residual.centre, residual.contact, constants.ball_radius
    nx, ny, nz = centre.x, centre.y, centre.z
    push, mixed, rotation, drill = 0.0, 0.0, 0.0, 0.0
    speed = midpoint.x * nx + midpoint.y * ny + midpoint.z * nz
    if constants.static + constants.viscous > 0.0:
        velocity, spin = (midpoint.x, midpoint.y, midpoint.z), (midpoint.wx, midpoint.wy, midpoint.wz)
        slip = sliding_state(centre, normal_force(contact, speed, constants), velocity, spin, constants)
        push, mixed, rotation = slip.rate * slip.push, slip.rate * slip.mixed, slip.rate * slip.rotation
        drill = slip.rate * slip.drill * slip.lever_squared
    damping_rate = constants.hysteresis * contact.damped_force + constants.time * contact.damped_stiffness
    if constants.film_damping > 0.0:
        film_damping, lever = film.film_damping(centre, constants), 0.5 * centre.distance / R1
        damping_rate = damping_rate + film.squeeze_damping(film_damping, speed, constants)[1]
        damping_rate = damping_rate + 0.5 * h * max(speed, 0.0) * film_damping.steepening
        push, mixed = push + film_damping.across, mixed - lever * film_damping.across
        rotation = rotation + lever * lever * film_damping.across + film_damping.turning / (R1 * R1)
        drill = drill + film_damping.drilling
    tangential_stiffness = (0.5 * h * contact.normal + constants.time * contact.damped_force) * centre.inverse_distance
    # along and about the load (4)
    outward = residual.x * nx + residual.y * ny + residual.z * nz
    turning = residual.wx * nx + residual.wy * ny + residual.wz * nz
    dn = -outward / (mass_rate + damping_rate + 0.5 * h * abs(contact.stiffness))
    dw = -turning / (inertia_rate + drill)
    # across the load (5), with u = R_w x n
    A, B, C = mass_rate + push + tangential_stiffness, inertia_rate + rotation * R1 * R1, mixed * R1
    inverse_determinant = 1.0 / (A * B - C * C)
    tx, ty, tz = residual.x - outward * nx, residual.y - outward * ny, residual.z - outward * nz
    ux = residual.wy * nz - residual.wz * ny
    uy = residual.wz * nx - residual.wx * nz
    uz = residual.wx * ny - residual.wy * nx
    dx = (C * ux - B * tx) * inverse_determinant
    dy = (C * uy - B * ty) * inverse_determinant
    dz = (C * uz - B * tz) * inverse_determinant
    ex = (C * tx - A * ux) * inverse_determinant
    ey = (C * ty - A * uy) * inverse_determinant
    ez = (C * tz - A * uz) * inverse_determinant
    change = abs(dx) + abs(dy) + abs(dz) + abs(dn) + R1 * (abs(ex) + abs(ey) + abs(ez) + abs(dw))
    new_midpoint = Midpoint(
        midpoint.x + dx + dn * nx,
        midpoint.y + dy + dn * ny,
        midpoint.z + dz + dn * nz,
        midpoint.wx + ny * ez - nz * ey + dw * nx,
        midpoint.wy + nz * ex - nx * ez + dw * ny,
        midpoint.wz + nx * ey - ny * ex + dw * nz,
    )
    return new_midpoint, change


def march(  # type: ignore[no-untyped-def]
    potential, constants: Constants, ball: BallState, mass: float, inertia: float, pulls, h: float, states, dissipated
) -> int:
    """Advance a ball over all time steps, and return the number of converged ones.

    `states` (steps + 1, 9) and `dissipated` (steps + 1,) in N mm are filled. `pulls` (steps, 3) is the pull in each
    step; in Python it is a list, which is faster than an array.
    """
    states[0, :] = ball
    for index in range(len(dissipated) - 1):
        components = pulls[index]
        pull = components[0], components[1], components[2]
        result = advance_one_step(potential, constants, ball, mass, inertia, pull, h)
        ball = result.ball
        states[index + 1, :] = ball
        dissipated[index + 1] = dissipated[index] + result.dissipated
        if not result.converged:
            return index
    return len(dissipated) - 1
