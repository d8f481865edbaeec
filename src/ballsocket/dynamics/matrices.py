"""Damping matrix of a load, and vectors and matrices built of components."""

from __future__ import annotations

from typing import Any

import numpy

from ..core import arrays
from ..core.arrays import Array, where
from . import friction
from .ball_centre import BallCentre, Constants, Vector, smooth_ramp
from .film import film_damping, squeeze_damping
from .reaction import SMOOTHING_SHARE, Elastic, Sliding, normal_force, sliding_state, versine


def join_vector(kind: type, *components: Array) -> Any:
    """Join components to a vector: a tuple, or an array with the components along its last axis."""
    if kind is tuple:
        return components
    return arrays.namespace(*components).stack(components, axis=-1)


def damping_matrix(centre: BallCentre, contact: Elastic, velocity: Vector, spin: Vector, constants: Constants) -> Any:
    """Compute the damping matrix -∂(F, M)/∂(v, ω) (..., 6, 6) of a contact at a constant normal force.

    The units are N s/mm, N s and N mm s.
    """
    centre, contact = BallCentre(*_floats_to_arrays(centre)), Elastic(*_floats_to_arrays(contact))
    velocity, spin = _floats_to_arrays(velocity), _floats_to_arrays(spin)
    direction, zeros = join_vector(object, centre.x, centre.y, centre.z), 0.0 * centre.distance
    ones = zeros + 1.0
    normal = direction[..., :, None] * direction[..., None, :]
    tangential = join_matrix(((ones, zeros, zeros), (zeros, ones, zeros), (zeros, zeros, ones))) - normal
    normal_damping, tangential_damping = _damping_coefficients(centre, contact, velocity, constants)
    normal_block = normal_damping[..., None, None] * normal + tangential_damping[..., None, None] * tangential
    slip = sliding_state(
        centre, normal_force(contact, _normal_speed(centre, velocity), constants), velocity, spin, constants
    )
    slip = Sliding(*_floats_to_arrays(slip))
    x, y, z = centre.x, centre.y, centre.z
    rotation = constants.ball_radius * join_matrix(((zeros, z, -y), (-z, zeros, x), (y, -x, zeros)))
    lever = arrays.sqrt(slip.lever_squared)
    xp = arrays.namespace(direction)
    # rows: v across the load, R1 ω x n, and the speed at the lever; columns: v and ω
    zero_block = 0.0 * tangential
    translation_rows = xp.concat([tangential, zero_block], axis=-1)
    rotation_rows = xp.concat([zero_block, rotation], axis=-1)
    drilling_row = xp.concat([0.0 * direction, lever[..., None] * direction], axis=-1)[..., None, :]
    v, b = join_vector(object, slip.x, slip.y, slip.z), join_vector(object, slip.bx, slip.by, slip.bz)
    curvature = _potential_curvature(centre, slip, (translation_rows, rotation_rows, drilling_row), (v, b), constants)
    rate = slip.rate[..., None, None] * curvature
    projection = _weighted_row_sum(translation_rows, slip.push[..., None] * v + slip.mixed[..., None] * b)
    projection = projection + _weighted_row_sum(rotation_rows, slip.mixed[..., None] * v + slip.rotation[..., None] * b)
    projection = projection + _weighted_row_sum(drilling_row, (slip.drill * lever * slip.spin)[..., None])
    # derivative of the friction rate N μ(q)/q by the effective slip speed q, over q
    q = slip.speed
    mu = friction.friction_coefficient(q, constants.sliding, constants.static, constants.stribeck_speed)
    mu_slope = -2.0 * (mu - constants.sliding) * q / (constants.stribeck_speed * constants.stribeck_speed)
    rate_slope = slip.normal * (mu_slope - mu / q) / q / q
    rate = rate + rate_slope[..., None, None] * (projection[..., :, None] * projection[..., None, :])
    rows = xp.concat([normal_block, 0.0 * normal_block], axis=-1)
    contact_matrix = rate + xp.concat([rows, 0.0 * rows], axis=-2)
    if constants.film_damping == 0.0:
        return contact_matrix
    # V = v - ½ ω x r across n; rotation_rows are R1 ω x n
    mean_rows = translation_rows - (0.5 / constants.ball_radius) * centre.distance[..., None, None] * rotation_rows
    drilling_axis = xp.concat([0.0 * direction, direction], axis=-1)[..., None, :]
    normal_axis = xp.concat([direction, 0.0 * direction], axis=-1)[..., None, :]
    turning_rows = xp.concat([zero_block, tangential], axis=-1)
    damping = film_damping(centre, constants)
    along = squeeze_damping(damping, _normal_speed(centre, velocity), constants)[1]
    film_matrix = along[..., None, None] * _sum_outer_products(normal_axis, normal_axis)
    film_matrix = film_matrix + damping.across[..., None, None] * _sum_outer_products(mean_rows, mean_rows)
    film_matrix = film_matrix + damping.drilling[..., None, None] * _sum_outer_products(drilling_axis, drilling_axis)
    film_matrix = film_matrix + damping.turning[..., None, None] * _sum_outer_products(turning_rows, turning_rows)
    return contact_matrix + film_matrix


def _damping_coefficients(
    centre: BallCentre, contact: Elastic, velocity: Vector, constants: Constants
) -> tuple[Array, Array]:
    """Compute the damping coefficients of the contact along the load and across the load, in N s/mm.

    The first is the derivative of the normal force by ḋ, the second the drag of a contact that moves along the socket.
    """
    damping_rate = constants.hysteresis * contact.damped_force + constants.time * contact.damped_stiffness
    force = contact.normal + damping_rate * _normal_speed(centre, velocity)
    if constants.smoothing > 0.0:
        width = SMOOTHING_SHARE * contact.damped_force
        slope = smooth_ramp(force / arrays.safe_divisor(width), 1.0)[1]
    else:
        slope = where(force > 0.0, 0.0 * force + 1.0, 0.0 * force)
    return damping_rate * slope, constants.time * contact.damped_force * centre.inverse_distance


def _potential_curvature(
    centre: BallCentre, slip: Sliding, directions: Vector, rates: tuple[Array, Array], constants: Constants
) -> Array:
    """Compute half of the second derivatives (..., 6, 6) of q² by velocity and spin; q is the slip speed."""
    xp = arrays.namespace(rates[0])
    (translation, turning, drilling), (v, b), kappa = directions, rates, friction.rolling_slip_ratio(versine(centre))
    squared_kappa, squared_drill_speed = kappa * kappa, slip.lever_squared * slip.spin * slip.spin
    pole_slip, opposite_slip = v + b, v - b
    squares = (
        xp.sum(pole_slip * pole_slip, axis=-1),
        xp.sum(opposite_slip * opposite_slip, axis=-1),
        xp.sum(pole_slip * opposite_slip, axis=-1),
    )
    state = squares[0], squared_kappa * squares[1], squared_drill_speed, kappa * squares[2]
    transition_squared = constants.transition_speed * constants.transition_speed
    bends = friction.effective_slip_bends(*state, transition_squared, versine(centre))
    slip_directions, opposite_directions = translation + turning, translation - turning
    half_gradients = (
        _weighted_row_sum(slip_directions, pole_slip),
        squared_kappa[..., None] * _weighted_row_sum(opposite_directions, opposite_slip),
        _weighted_row_sum(drilling, (arrays.sqrt(slip.lever_squared) * slip.spin)[..., None]),
        0.5
        * kappa[..., None]
        * (_weighted_row_sum(slip_directions, opposite_slip) + _weighted_row_sum(opposite_directions, pole_slip)),
    )
    total = slip.push[..., None, None] * _sum_outer_products(translation, translation)
    total = total + slip.rotation[..., None, None] * _sum_outer_products(turning, turning)
    coupling = _sum_outer_products(translation, turning) + _sum_outer_products(turning, translation)
    total = total + slip.mixed[..., None, None] * coupling
    total = total + slip.drill[..., None, None] * _sum_outer_products(drilling, drilling)
    for (i, j), second_derivative in bends.items():
        gradient_product = half_gradients[i][..., :, None] * half_gradients[j][..., None, :]
        symmetric_product = gradient_product if i == j else gradient_product + xp.matrix_transpose(gradient_product)
        total = total + 2.0 * second_derivative[..., None, None] * symmetric_product
    return total


def _sum_outer_products(first: Array, second: Array) -> Array:
    xp = arrays.namespace(first)
    return xp.matmul(xp.matrix_transpose(first), second)


def _weighted_row_sum(directions: Array, rates: Array) -> Array:
    return arrays.namespace(directions).sum(rates[..., :, None] * directions, axis=-2)


def _normal_speed(centre: BallCentre, velocity: Vector) -> Array:
    """Compute the speed of the ball centre along the load in mm/s."""
    return velocity[0] * centre.x + velocity[1] * centre.y + velocity[2] * centre.z


def join_matrix(rows: Any) -> Any:
    """Join rows of components to matrices, along the last two axes of an array."""
    stacked = [join_vector(object, *row) for row in rows]
    return arrays.namespace(*stacked).stack(stacked, axis=-2)


def _floats_to_arrays(components: Any) -> Any:
    return tuple(numpy.asarray(value) if type(value) is float else value for value in components)
