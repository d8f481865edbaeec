"""Formulas of the force element by components, for numbers, arrays, compiled functions and exported programs.

r = (x, y, z) is the position of the ball centre relative to the socket centre, in axes fixed to the socket. From it
follow e = |r|, n = r/e and d = e - c. All forces act on the ball, and all moments about its centre. `Load` gives force
and moment on the socket.
"""

from __future__ import annotations

from math import nan
from typing import NamedTuple

from ..core.arrays import Array, atan2, clip, safe_divisor, sqrt, where
from . import film, friction
from .ball_centre import BallCentre, Constants, Vector, dome_angle, rim_share, smooth_ramp, smooth_ramp_value


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


def elastic_contact(potential, centre: BallCentre, constants: Constants) -> Elastic:  # type: ignore[no-untyped-def]
    """Compute the elastic contact at a position of the ball, with the first touch smoothed over ± `smoothing`."""
    smoothed_depth = smooth_ramp(centre.indentation, constants.smoothing)
    return elastic_from_slopes(centre, smoothed_depth, potential(smoothed_depth[0]), constants)


def elastic_from_slopes(
    centre: BallCentre, smoothed_depth: Vector, energy_derivatives: Vector, constants: Constants
) -> Elastic:
    """Compute the elastic contact from energy, force and stiffness at the smoothed indentation of a position."""
    d = centre.indentation
    depth, slope, bend = smoothed_depth
    energy, force, stiffness = energy_derivatives
    nan_beyond_wall = where(d > constants.wall, nan, 0.0 * d)
    energy, force, stiffness = energy + nan_beyond_wall, force + nan_beyond_wall, stiffness + nan_beyond_wall
    if constants.rim > 0.0:
        return elastic_at_rim(centre, depth, slope, bend, energy, force, stiffness, constants)
    zero, normal = 0.0 * energy, force * slope
    k = stiffness * slope * slope + force * bend
    return Elastic(energy, normal, k, normal, k, zero + 1.0, zero, zero, zero, zero, zero, zero, zero)


def elastic_at_rim(
    centre: BallCentre, depth: Array, slope: Array, bend: Array, U: Array, F: Array, k: Array, constants: Constants
) -> Elastic:
    """Compute the elastic contact in a cup whose rim cuts off part of the contact.

    The energy is U W(s) with s = (rim - γ)/ε and cos ε = c/(c + d).
    """
    dome_cosine, dome_sine, ax, ay, az = dome_angle(centre, constants)
    gamma = atan2(dome_sine, dome_cosine)
    touching = depth > 0.0
    # ε = acos(c/g), g = c + d: ε' = c/(g w), ε'' = -c (2 g² - c²)/(g² w³), w = sqrt(g² - c²)
    c, g = constants.clearance, safe_divisor(constants.clearance + depth)
    w = where(touching, sqrt(where(touching, depth * (g + c), 1.0)), 1.0)
    epsilon = where(touching, atan2(w, c + 0.0 * w), 1.0)
    epsilon_slope, epsilon_bend = c / (g * w), -c * (2.0 * g * g - c * c) / (g * g * w * w * w)
    rim_ratio = (constants.rim - gamma) / epsilon
    W, W1, W2 = rim_share(rim_ratio)
    U, F, k = where(rim_ratio > -1.0, U, 0.0), where(rim_ratio > -1.0, F, 0.0), where(rim_ratio > -1.0, k, 0.0)
    s1 = -rim_ratio * epsilon_slope / epsilon
    s2 = rim_ratio * (2.0 * epsilon_slope * epsilon_slope / epsilon - epsilon_bend) / epsilon
    # derivatives of U W(s) over the depth and γ; s decreases by 1/ε per γ
    by_depth = F * W + U * W1 * s1
    by_both = (U * W1 * epsilon_slope / epsilon - F * W1 - U * W2 * s1) / epsilon
    by_angle = -U * W1 / epsilon
    inverse_sine, inverse_distance = 1.0 / safe_divisor(dome_sine), centre.inverse_distance
    return Elastic(
        energy=U * W,
        normal=by_depth * slope,
        stiffness=(k * W + 2.0 * F * W1 * s1 + U * (W2 * s1 * s1 + W1 * s2)) * slope * slope + by_depth * bend,
        damped_force=F * W * slope,
        damped_stiffness=W * (k * slope * slope + F * bend),
        rim_margin=rim_ratio,
        polar=-by_angle * inverse_distance,
        mixed=(by_both * slope - by_angle * inverse_distance) * inverse_distance,
        along=U * W2 * (inverse_distance * inverse_distance / (epsilon * epsilon)),
        around=by_angle * dome_cosine * inverse_sine * inverse_distance * inverse_distance,
        px=ax * inverse_sine,
        py=ay * inverse_sine,
        pz=az * inverse_sine,
    )


def normal_force(elastic: Elastic, speed: Array, constants: Constants) -> Array:
    """Compute the damped normal force F + (χ F + τ k) ḋ in N on the ball, without tension by damping."""
    damping_rate = constants.hysteresis * elastic.damped_force + constants.time * elastic.damped_stiffness
    force = elastic.normal + damping_rate * speed
    if constants.smoothing > 0.0:
        return smooth_ramp_value(force, SMOOTHING_SHARE * elastic.damped_force)
    lower_limit = where(elastic.normal < 0.0, elastic.normal, 0.0)  # negative for an adhesive ball
    return where(force < lower_limit, lower_limit, force)  # keeps NaN


def remove_tension_damping(contact: Elastic) -> Elastic:
    """Remove the damping of a contact in tension, because it would generate energy there."""
    compressive_force = clip(contact.damped_force, 0.0, float("inf"))
    return contact._replace(
        damped_force=compressive_force, damped_stiffness=clip(contact.damped_stiffness, 0.0, float("inf"))
    )


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
    """Compute the slip of the ball on the contact patch in mm/s, and the rate of its friction."""
    (vx, vy, vz), (wx, wy, wz), R1 = velocity, spin, constants.ball_radius
    nx, ny, nz = centre.x, centre.y, centre.z
    speed, turning = vx * nx + vy * ny + vz * nz, wx * nx + wy * ny + wz * nz
    ax, ay, az = vx - speed * nx, vy - speed * ny, vz - speed * nz
    bx, by, bz = R1 * (wy * nz - wz * ny), R1 * (wz * nx - wx * nz), R1 * (wx * ny - wy * nx)
    patch_versine = versine(centre)
    lever = constants.socket_radius * friction.drill_lever(patch_versine)
    kappa = friction.rolling_slip_ratio(patch_versine)
    squared, squared_kappa = lever * lever * patch_versine * (2.0 - patch_versine), kappa * kappa
    squared_velocity = ax * ax + ay * ay + az * az
    squared_rotation = bx * bx + by * by + bz * bz
    cross = 2.0 * (ax * bx + ay * by + az * bz)
    squared_sum = squared_velocity + squared_rotation
    transition_squared = constants.transition_speed * constants.transition_speed
    squared_drill_speed, mixed_product = squared * turning * turning, kappa * (squared_velocity - squared_rotation)
    q2, by_slip, by_tilt, by_drill, by_mixed = friction.effective_slip(
        squared_sum + cross,
        squared_kappa * (squared_sum - cross),
        squared_drill_speed,
        mixed_product,
        transition_squared,
        squared_kappa,
        patch_versine,
    )
    q, by_tilt, by_mixed = sqrt(q2), squared_kappa * by_tilt, kappa * by_mixed
    mu = friction.friction_coefficient(q, constants.sliding, constants.static, constants.stribeck_speed)
    N = force * friction.widening_factor(patch_versine)
    rate, mean_slope = N * (mu / q + constants.viscous), by_slip + by_tilt
    push, rotation = mean_slope + by_mixed, mean_slope - by_mixed
    return Sliding(ax, ay, az, bx, by, bz, turning, squared, N, rate, q, push, by_slip - by_tilt, rotation, by_drill)


def versine(centre: BallCentre) -> Array:
    """Compute the versine d/e = 1 - cos ε of the half angle ε, from indentation d and distance e of the centres."""
    return where(centre.indentation > 0.0, centre.indentation * centre.inverse_distance, 0.0)


def force_and_moment(
    centre: BallCentre, contact: Elastic, velocity: Vector, spin: Vector, constants: Constants
) -> tuple[Array, ...]:
    """Compute force (N) and moment (N mm) on the ball about its centre by contact and lubricant, as six components."""
    fx, fy, fz, mx, my, mz = contact_force_and_moment(centre, contact, velocity, spin, constants)
    if constants.film_damping == 0.0:
        return fx, fy, fz, mx, my, mz
    gx, gy, gz, lx, ly, lz = film.film_force_and_moment(centre, velocity, spin, constants)
    return fx + gx, fy + gy, fz + gz, mx + lx, my + ly, mz + lz


def contact_force_and_moment(
    centre: BallCentre, contact: Elastic, velocity: Vector, spin: Vector, constants: Constants
) -> tuple[Array, ...]:
    """Compute force (N) and moment (N mm) of the dry contact on the ball about its centre, as six components."""
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
    """Compute the power in N mm/s that damping, liner, friction and lubricant dissipate."""
    vx, vy, vz = velocity
    speed = vx * centre.x + vy * centre.y + vz * centre.z
    normal = normal_force(contact, speed, constants)
    slip = sliding_state(centre, normal, velocity, spin, constants)
    drag = constants.time * contact.damped_force * centre.inverse_distance
    squared_velocity = slip.x * slip.x + slip.y * slip.y + slip.z * slip.z
    mixed_product = slip.x * slip.bx + slip.y * slip.by + slip.z * slip.bz
    squared_rotation = slip.bx * slip.bx + slip.by * slip.by + slip.bz * slip.bz
    friction_power = slip.push * squared_velocity + 2.0 * slip.mixed * mixed_product + slip.rotation * squared_rotation
    friction_power = friction_power + slip.drill * slip.lever_squared * slip.spin * slip.spin
    power = (normal - contact.normal) * speed + drag * squared_velocity + slip.rate * friction_power
    if constants.film_damping == 0.0:
        return power
    return power + film.film_dissipation(centre, velocity, spin, constants)


def tangent_stiffness(centre: BallCentre, contact: Elastic, constants: Constants) -> tuple[Array, ...]:
    """Compute the tangent stiffness ∂²U/∂r² in N/mm: components xx, yy, zz, xy, yz, zx."""
    nx, ny, nz, px, py, pz = centre.x, centre.y, centre.z, contact.px, contact.py, contact.pz
    # where the centres coincide, without clearance, the stiffness is isotropic
    tangential = where(centre.distance > 0.0, contact.normal * centre.inverse_distance, contact.stiffness)
    radial = contact.stiffness - tangential
    xx, yy, zz = tangential + radial * nx * nx, tangential + radial * ny * ny, tangential + radial * nz * nz
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
