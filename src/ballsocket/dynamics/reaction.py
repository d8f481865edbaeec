"""Formulas of the force element by components, for numbers, arrays, compiled functions and exported programs.

r = (x, y, z) is the position of the ball centre relative to the socket centre, in axes fixed to the socket. From it
follow e = |r|, n = r/e and d = e - c. All forces act on the ball, and all moments about its centre. `Load` gives force
and moment on the socket.
"""

from __future__ import annotations

from math import nan, pi
from typing import NamedTuple

from ..core.arrays import Array, atan2, clip, safe_divisor, sqrt, where
from . import friction

Vector = tuple[Array, Array, Array]
"""Components of a vector."""


class Constants(NamedTuple):
    """Constants of a force element except its potential: lengths in mm, speeds in mm/s, times in s.

    `rim` is the polar angle of the cup rim in rad, 0 without a rim. `dome` is the unit vector to the pole of the bore.
    """

    ball_radius: float
    socket_radius: float
    clearance: float
    wall: float
    smoothing: float
    hysteresis: float
    time: float
    sliding: float
    static: float
    transition_speed: float
    stribeck_speed: float
    viscous: float
    rim: float
    dome_x: float
    dome_y: float
    dome_z: float


class BallCentre(NamedTuple):
    """Position of the ball centre: distance, direction, indentation, and inverse distance.

    The distance and the direction are those from the socket centre to the ball centre. The direction is a unit
    vector, or zero where the centres coincide.
    """

    distance: Array
    x: Array
    y: Array
    z: Array
    indentation: Array
    inverse_distance: Array


class Elastic(NamedTuple):
    """Elastic contact forces and stiffnesses at a position of the ball.

    `energy` is U, `normal` the force dU/de to the socket centre, and `stiffness` is d²U/de². Damping is proportional to
    `damped_force` and `damped_stiffness`, which lack the gradient of the rim. `rim_margin` is the angle to the rim over
    the half angle, 1 or more away from the rim. (`px`, `py`, `pz`) is the direction to the nearest rim. `polar` is the
    force along it, and `mixed`, `along` and `around` are components of the tangent.
    """

    energy: Array
    normal: Array
    stiffness: Array
    damped_force: Array
    damped_stiffness: Array
    rim_margin: Array
    polar: Array
    mixed: Array
    along: Array
    around: Array
    px: Array
    py: Array
    pz: Array


NO_CONTACT = Elastic(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""Elastic contact of a ball that does not touch the socket."""


def centre_of(x: Array, y: Array, z: Array, clearance: float) -> BallCentre:
    """Compute distance, direction and indentation of the ball centre."""
    distance = sqrt(x * x + y * y + z * z)
    over = 1.0 / safe_divisor(distance)
    return BallCentre(distance, x * over, y * over, z * over, distance - clearance, over)


def elastic_contact(potential, centre: BallCentre, constants: Constants) -> Elastic:  # type: ignore[no-untyped-def]
    """Compute the elastic contact at a position, with a first touch smoothed over ± `smoothing`."""
    rounded = ramp(centre.indentation, constants.smoothing)
    return elastic_from_slopes(centre, rounded, potential(rounded[0]), constants)


def elastic_from_slopes(centre: BallCentre, rounded: Vector, slopes: Vector, constants: Constants) -> Elastic:
    """Compute the elastic contact from energy, force and stiffness at the smoothed indentation."""
    d = centre.indentation
    depth, slope, bend = rounded
    energy, force, stiffness = slopes
    missing = where(d > constants.wall, nan, 0.0 * d)
    energy, force, stiffness = energy + missing, force + missing, stiffness + missing
    if constants.rim > 0.0:
        return elastic_at_rim(centre, depth, slope, bend, energy, force, stiffness, constants)
    zero, normal = 0.0 * energy, force * slope
    k = stiffness * slope * slope + force * bend
    return Elastic(energy, normal, k, normal, k, zero + 1.0, zero, zero, zero, zero, zero, zero, zero)


def elastic_at_rim(
    centre: BallCentre, depth: Array, slope: Array, bend: Array, U: Array, F: Array, k: Array, constants: Constants
) -> Elastic:
    """Compute the elastic contact in a cup, whose rim cuts part of the contact.

    The energy is U W(s) with s = (rim - γ)/ε and cos ε = c/(c + d).
    """
    lean, across, ax, ay, az = dome_angle(centre, constants)
    gamma = atan2(across, lean)
    touching = depth > 0.0
    # ε = acos(c/g), g = c + d: ε' = c/(g w), ε'' = -c (2 g² - c²)/(g² w³), w = sqrt(g² - c²)
    c, g = constants.clearance, safe_divisor(constants.clearance + depth)
    w = where(touching, sqrt(where(touching, depth * (g + c), 1.0)), 1.0)
    epsilon = where(touching, atan2(w, c + 0.0 * w), 1.0)
    first, second = c / (g * w), -c * (2.0 * g * g - c * c) / (g * g * w * w * w)
    s = (constants.rim - gamma) / epsilon
    W, W1, W2 = rim_share(s)
    U, F, k = where(s > -1.0, U, 0.0), where(s > -1.0, F, 0.0), where(s > -1.0, k, 0.0)
    s1, s2 = -s * first / epsilon, s * (2.0 * first * first / epsilon - second) / epsilon
    # derivatives of U W(s) over the depth and γ; s decreases by 1/ε per γ
    by_depth = F * W + U * W1 * s1
    by_both = (U * W1 * first / epsilon - F * W1 - U * W2 * s1) / epsilon
    by_angle = -U * W1 / epsilon
    over, nearer = 1.0 / safe_divisor(across), centre.inverse_distance
    return Elastic(
        energy=U * W,
        normal=by_depth * slope,
        stiffness=(k * W + 2.0 * F * W1 * s1 + U * (W2 * s1 * s1 + W1 * s2)) * slope * slope + by_depth * bend,
        damped_force=F * W * slope,
        damped_stiffness=W * (k * slope * slope + F * bend),
        rim_margin=s,
        polar=-by_angle * nearer,
        mixed=(by_both * slope - by_angle * nearer) * nearer,
        along=U * W2 * (nearer * nearer / (epsilon * epsilon)),
        around=by_angle * lean * over * nearer * nearer,
        px=ax * over,
        py=ay * over,
        pz=az * over,
    )


def dome_angle(centre: BallCentre, constants: Constants) -> tuple[Array, Array, Array, Array, Array]:
    """Compute cosine, sine and direction of the angle γ from the dome axis to the ball.

    The last three results are sin γ times the direction of increasing γ.
    """
    lean = constants.dome_x * centre.x + constants.dome_y * centre.y + constants.dome_z * centre.z
    ax, ay, az = (
        lean * centre.x - constants.dome_x,
        lean * centre.y - constants.dome_y,
        lean * centre.z - constants.dome_z,
    )
    return lean, sqrt(ax * ax + ay * ay + az * az), ax, ay, az


def normal_force(elastic: Elastic, speed: Array, constants: Constants) -> Array:
    """Compute the damped normal force F + (χ F + τ k) ḋ towards the socket centre in N; damping causes no tension."""
    lossy = constants.hysteresis * elastic.damped_force + constants.time * elastic.damped_stiffness
    force = elastic.normal + lossy * speed
    if constants.smoothing > 0.0:
        return ramp_value(force, SMOOTHING_SHARE * elastic.damped_force)
    least = where(elastic.normal < 0.0, elastic.normal, 0.0)  # negative for an adhesive ball
    return where(force < least, least, force)  # keeps NaN


def remove_tension_damping(contact: Elastic) -> Elastic:
    """Remove the damping of a contact in tension, where it would generate energy."""
    pressing = clip(contact.damped_force, 0.0, float("inf"))
    return contact._replace(damped_force=pressing, damped_stiffness=clip(contact.damped_stiffness, 0.0, float("inf")))


SMOOTHING_SHARE = 0.1
"""Share of the force, on both sides of 0, over which a smooth element rounds off the separation of the contact."""


class Sliding(NamedTuple):
    """Slip of the ball on the contact patch, with the rate of its friction.

    (`x`, `y`, `z`) is the velocity v across the load and (`bx`, `by`, `bz`) is b = R1 ω x n, both in mm/s. `spin` is
    the angular velocity about the load in rad/s, and `lever_squared` is in mm². `normal` is N, and `speed` the
    effective slip speed q. `rate` is N μ(q)/q plus viscous friction. The friction force is -rate (push v + mixed b).
    Its moment is -rate R1 n x (mixed v + rotation b) across the load and -rate drill lever² spin about it.
    """

    x: Array
    y: Array
    z: Array
    bx: Array
    by: Array
    bz: Array
    spin: Array
    lever_squared: Array
    normal: Array
    rate: Array
    speed: Array
    push: Array
    mixed: Array
    rotation: Array
    drill: Array


def sliding_state(centre: BallCentre, force: Array, velocity: Vector, spin: Vector, constants: Constants) -> Sliding:
    """Compute the slip of the ball on the contact patch and the rate of friction."""
    (vx, vy, vz), (wx, wy, wz), R1 = velocity, spin, constants.ball_radius
    nx, ny, nz = centre.x, centre.y, centre.z
    speed, turning = vx * nx + vy * ny + vz * nz, wx * nx + wy * ny + wz * nz
    ax, ay, az = vx - speed * nx, vy - speed * ny, vz - speed * nz
    bx, by, bz = R1 * (wy * nz - wz * ny), R1 * (wz * nx - wx * nz), R1 * (wx * ny - wy * nx)
    m = versine(centre)
    lever, kappa = constants.socket_radius * friction.drill_lever(m), friction.rolling_slip_ratio(m)
    squared, share = lever * lever * m * (2.0 - m), kappa * kappa
    aa, bb, cross = ax * ax + ay * ay + az * az, bx * bx + by * by + bz * bz, 2.0 * (ax * bx + ay * by + az * bz)
    both, transition_squared = aa + bb, constants.transition_speed * constants.transition_speed
    drilled, twisted = squared * turning * turning, kappa * (aa - bb)
    q2, slope, tilt, drill, twist = friction.effective_slip(
        both + cross, share * (both - cross), drilled, twisted, transition_squared, share, m
    )
    q, tilt, twist = sqrt(q2), share * tilt, kappa * twist
    mu = friction.friction_coefficient(q, constants.sliding, constants.static, constants.stribeck_speed)
    N = force * friction.widening_factor(m)
    rate, mean = N * (mu / q + constants.viscous), slope + tilt
    push, rotation = mean + twist, mean - twist
    return Sliding(ax, ay, az, bx, by, bz, turning, squared, N, rate, q, push, slope - tilt, rotation, drill)


def versine(centre: BallCentre) -> Array:
    """Compute the versine 1 - cos ε = d/e of the overlap of ball and socket; 0 without contact.

    e is the distance of the centres.
    """
    return where(centre.indentation > 0.0, centre.indentation * centre.inverse_distance, 0.0)


def force_and_moment(
    centre: BallCentre, contact: Elastic, velocity: Vector, spin: Vector, constants: Constants
) -> tuple[Array, ...]:
    """Compute force (N) and moment (N mm) on the ball about its centre, as six components."""
    (vx, vy, vz), nx, ny, nz = velocity, centre.x, centre.y, centre.z
    speed = vx * nx + vy * ny + vz * nz
    normal = normal_force(contact, speed, constants)
    fx, fy, fz = -normal * nx, -normal * ny, -normal * nz
    if constants.rim > 0.0:
        P = contact.polar
        fx, fy, fz = fx + P * contact.px, fy + P * contact.py, fz + P * contact.pz
    if constants.time > 0.0:
        drag = constants.time * contact.damped_force * centre.inverse_distance
        fx, fy, fz = fx - drag * (vx - speed * nx), fy - drag * (vy - speed * ny), fz - drag * (vz - speed * nz)
    if constants.static + constants.viscous == 0.0:
        zero = 0.0 * normal
        return fx, fy, fz, zero, zero, zero
    ax, ay, az, bx, by, bz, twirl, lever, _, rate, _, push, mixed, rotation, drill = sliding_state(
        centre, normal, velocity, spin, constants
    )
    push, mixed = -rate * push, -rate * mixed
    tx, ty, tz = push * ax + mixed * bx, push * ay + mixed * by, push * az + mixed * bz
    R1, drill = constants.ball_radius, -rate * drill * lever * twirl
    rotation, mixed = -rate * rotation * R1, mixed * R1
    gx, gy, gz = mixed * ax + rotation * bx, mixed * ay + rotation * by, mixed * az + rotation * bz
    mx = ny * gz - nz * gy + drill * nx
    my = nz * gx - nx * gz + drill * ny
    mz = nx * gy - ny * gx + drill * nz
    return fx + tx, fy + ty, fz + tz, mx, my, mz


def dissipation(centre: BallCentre, contact: Elastic, velocity: Vector, spin: Vector, constants: Constants) -> Array:
    """Compute the power in N mm/s dissipated by damping, liner and friction."""
    vx, vy, vz = velocity
    speed = vx * centre.x + vy * centre.y + vz * centre.z
    normal = normal_force(contact, speed, constants)
    slip = sliding_state(centre, normal, velocity, spin, constants)
    drag = constants.time * contact.damped_force * centre.inverse_distance
    aa = slip.x * slip.x + slip.y * slip.y + slip.z * slip.z
    cross = slip.x * slip.bx + slip.y * slip.by + slip.z * slip.bz
    bb = slip.bx * slip.bx + slip.by * slip.by + slip.bz * slip.bz
    friction_power = slip.push * aa + 2.0 * slip.mixed * cross + slip.rotation * bb
    friction_power = friction_power + slip.drill * slip.lever_squared * slip.spin * slip.spin
    return (normal - contact.normal) * speed + drag * aa + slip.rate * friction_power


def tangent(centre: BallCentre, contact: Elastic, constants: Constants) -> tuple[Array, ...]:
    """Compute the components xx, yy, zz, xy, yz, zx of the tangent stiffness ∂²U/∂r² in N/mm."""
    nx, ny, nz, px, py, pz = centre.x, centre.y, centre.z, contact.px, contact.py, contact.pz
    # where the centres coincide, without clearance, the stiffness is isotropic
    across = where(centre.distance > 0.0, contact.normal * centre.inverse_distance, contact.stiffness)
    radial = contact.stiffness - across
    xx, yy, zz = across + radial * nx * nx, across + radial * ny * ny, across + radial * nz * nz
    xy, yz, zx = radial * nx * ny, radial * ny * nz, radial * nz * nx
    if constants.rim > 0.0:
        A, B = contact.mixed, contact.around
        C = contact.along - B
        xx = xx + B + 2.0 * A * nx * px - B * nx * nx + C * px * px
        yy = yy + B + 2.0 * A * ny * py - B * ny * ny + C * py * py
        zz = zz + B + 2.0 * A * nz * pz - B * nz * nz + C * pz * pz
        xy = xy + A * (nx * py + ny * px) - B * nx * ny + C * px * py
        yz = yz + A * (ny * pz + nz * py) - B * ny * nz + C * py * pz
        zx = zx + A * (nz * px + nx * pz) - B * nz * nx + C * pz * px
    return xx, yy, zz, xy, yz, zx


def ramp(y: Array, width: float) -> tuple[Array, Array, Array]:
    """Compute a smoothed max(y, 0) and its two derivatives; a polynomial replaces the corner at ± `width`."""
    if width == 0.0:
        zero = 0.0 * y
        return where(y > 0.0, y, zero), where(y >= 0.0, zero + 1.0, zero), zero
    t = clip((y + width) / (2.0 * width), 0.0, 1.0)
    bend = 15.0 * t * t * (1.0 - t) * (1.0 - t) / width
    return where(y >= width, y, 2.0 * width * _rounded(t)), t * t * t * (10.0 - 15.0 * t + 6.0 * t * t), bend


def ramp_value(y: Array, width: Array) -> Array:
    """Compute a smoothed max(y, 0) like `ramp`, for a width that may be an array and 0."""
    span = where(width > 0.0, width, 1.0)
    t = clip((y + width) / (2.0 * span), 0.0, 1.0)
    return where(y >= width, y, 2.0 * width * _rounded(t))


def _rounded(t: Array) -> Array:
    # ∫ (10 t³ - 15 t⁴ + 6 t⁵) dt
    return t * t * t * t * (2.5 - 3.0 * t + t * t)


def rim_share(centre: Array) -> tuple[Array, Array, Array]:
    """Compute the fraction W(s) of the contact energy inside a straight rim, with its two derivatives.

    s is the distance of the rim from the patch centre over the half angle. W is 1 for s >= 1, and 0 for s <= -1. It is
    the marginal of (1 - x² - y²)² over a disc, the energy density of radial springs under a small patch.
    """
    s = clip(centre, -1.0, 1.0)
    square = clip(1.0 - s * s, 0.0, 1.0)
    root = sqrt(square)
    W = 0.5 + (atan2(s, root) + s * root * (33.0 + s * s * (8.0 * s * s - 26.0)) / 15.0) / pi
    slope = 16.0 / (5.0 * pi) * square * square * root
    return clip(W, 0.0, 1.0), slope, -16.0 / pi * s * square * root
