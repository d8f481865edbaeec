"""Damping matrix of a load, and vectors and matrices built of components."""

from __future__ import annotations

from typing import Any

import numpy

from ..core import arrays
from ..core.arrays import Array, where
from . import friction
from .reaction import (
    SMOOTHING_SHARE,
    BallCentre,
    Constants,
    Elastic,
    Sliding,
    Vector,
    normal_force,
    ramp,
    sliding_state,
    versine,
)


def vector(kind: type, *components: Array) -> Any:
    """Join components to a tuple, or along the last axis of an array."""
    if kind is tuple:
        return components
    return arrays.namespace(*components).stack(components, axis=-1)


def damping_matrix(centre: BallCentre, contact: Elastic, velocity: Vector, spin: Vector, constants: Constants) -> Any:
    """Compute the damping matrix -∂(F, M)/∂(v, ω) at a constant normal force: (..., 6, 6).

    The units are N s/mm, N s and N mm s.
    """
    centre, contact = BallCentre(*_arrays(centre)), Elastic(*_arrays(contact))
    velocity, spin = _arrays(velocity), _arrays(spin)
    n, unit, zero = _vector(centre.x, centre.y, centre.z), *_one_and_zero(centre.distance)
    normal = n[..., :, None] * n[..., None, :]
    level = matrix(((unit, zero, zero), (zero, unit, zero), (zero, zero, unit))) - normal
    along, drag = _normal_rates(centre, contact, velocity, constants)
    push = along[..., None, None] * normal + drag[..., None, None] * level
    slip = sliding_state(
        centre, normal_force(contact, _normal_speed(centre, velocity), constants), velocity, spin, constants
    )
    slip = Sliding(*_arrays(slip))
    x, y, z = centre.x, centre.y, centre.z
    rotation = constants.ball_radius * matrix(((zero, z, -y), (-z, zero, x), (y, -x, zero)))
    lever = arrays.sqrt(slip.lever_squared)
    xp = arrays.namespace(n)
    # rows: v across the load, R1 ω x n, and the speed at the lever; columns: v and ω
    empty = 0.0 * level
    translation, turning = xp.concat([level, empty], axis=-1), xp.concat([empty, rotation], axis=-1)
    drilling = xp.concat([0.0 * n, lever[..., None] * n], axis=-1)[..., None, :]
    v, b = _vector(slip.x, slip.y, slip.z), _vector(slip.bx, slip.by, slip.bz)
    curvature = _potential_curvature(centre, slip, (translation, turning, drilling), (v, b), constants)
    rate = slip.rate[..., None, None] * curvature
    projection = _project(translation, slip.push[..., None] * v + slip.mixed[..., None] * b)
    projection = projection + _project(turning, slip.mixed[..., None] * v + slip.rotation[..., None] * b)
    projection = projection + _project(drilling, (slip.drill * lever * slip.spin)[..., None])
    fall = _friction_rate_slope(slip, constants) / slip.speed
    rate = rate + fall[..., None, None] * (projection[..., :, None] * projection[..., None, :])
    rows = xp.concat([push, 0.0 * push], axis=-1)
    return rate + xp.concat([rows, 0.0 * rows], axis=-2)


def _normal_rates(centre: BallCentre, contact: Elastic, velocity: Vector, constants: Constants) -> tuple[Array, Array]:
    """Compute the damping coefficients of the contact, along the load and across it, in N s/mm.

    The first is the derivative of the normal force by ḋ, the second the drag of a contact that moves along the socket.
    """
    lossy = constants.hysteresis * contact.damped_force + constants.time * contact.damped_stiffness
    force = contact.normal + lossy * _normal_speed(centre, velocity)
    if constants.smoothing > 0.0:
        width = SMOOTHING_SHARE * contact.damped_force
        slope = ramp(force / arrays.safe_divisor(width), 1.0)[1]
    else:
        slope = where(force > 0.0, 0.0 * force + 1.0, 0.0 * force)
    return lossy * slope, constants.time * contact.damped_force * centre.inverse_distance


def _potential_curvature(
    centre: BallCentre, slip: Sliding, directions: Vector, rates: tuple[Array, Array], constants: Constants
) -> Array:
    """Compute half of the second derivatives of the squared slip speed q² by velocity and spin: (..., 6, 6)."""
    xp = arrays.namespace(rates[0])
    (translation, turning, drilling), (v, b), kappa = directions, rates, friction.rolling_slip_ratio(versine(centre))
    share, drill = kappa * kappa, slip.lever_squared * slip.spin * slip.spin
    pole, tilt = v + b, v - b
    squares = xp.sum(pole * pole, axis=-1), xp.sum(tilt * tilt, axis=-1), xp.sum(pole * tilt, axis=-1)
    state = squares[0], share * squares[1], drill, kappa * squares[2]
    transition_squared = constants.transition_speed * constants.transition_speed
    bends = friction.effective_slip_bends(*state, transition_squared, versine(centre))
    plus, minus = translation + turning, translation - turning
    halves = (
        _project(plus, pole),
        share[..., None] * _project(minus, tilt),
        _project(drilling, (arrays.sqrt(slip.lever_squared) * slip.spin)[..., None]),
        0.5 * kappa[..., None] * (_project(plus, tilt) + _project(minus, pole)),
    )
    total = slip.push[..., None, None] * _outer(translation, translation)
    total = total + slip.rotation[..., None, None] * _outer(turning, turning)
    coupling = _outer(translation, turning) + _outer(turning, translation)
    total = total + slip.mixed[..., None, None] * coupling
    total = total + slip.drill[..., None, None] * _outer(drilling, drilling)
    for (i, j), bend in bends.items():
        outer = halves[i][..., :, None] * halves[j][..., None, :]
        both = outer if i == j else outer + xp.matrix_transpose(outer)
        total = total + 2.0 * bend[..., None, None] * both
    return total


def _outer(first: Array, second: Array) -> Array:
    xp = arrays.namespace(first)
    return xp.matmul(xp.matrix_transpose(first), second)


def _project(directions: Array, rates: Array) -> Array:
    return arrays.namespace(directions).sum(rates[..., :, None] * directions, axis=-2)


def _friction_rate_slope(slip: Sliding, constants: Constants) -> Array:
    """Compute the derivative of the friction rate by the effective slip speed q."""
    q = slip.speed
    mu = friction.friction_coefficient(q, constants.sliding, constants.static, constants.stribeck_speed)
    mu_slope = -2.0 * (mu - constants.sliding) * q / (constants.stribeck_speed * constants.stribeck_speed)
    return slip.normal * (mu_slope - mu / q) / q


def _normal_speed(centre: BallCentre, velocity: Vector) -> Array:
    return velocity[0] * centre.x + velocity[1] * centre.y + velocity[2] * centre.z


def _one_and_zero(like: Array) -> tuple[Array, Array]:
    return 0.0 * like + 1.0, 0.0 * like


def _vector(*components: Array) -> Any:
    return arrays.namespace(*components).stack(components, axis=-1)


def matrix(rows: Any) -> Any:
    """Join rows of components to matrices along the last two axes of an array."""
    stacked = [_vector(*row) for row in rows]
    return arrays.namespace(*stacked).stack(stacked, axis=-2)


def _arrays(components: Any) -> Any:
    return tuple(numpy.asarray(value) if type(value) is float else value for value in components)
