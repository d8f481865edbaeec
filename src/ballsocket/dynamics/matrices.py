"""Components put together: vectors, symmetric matrices, and the matrix of damping."""

from __future__ import annotations

from typing import Any

import numpy

from ..core import arrays
from ..core.arrays import Array, where
from . import friction
from .reaction import ROUNDED, Constants, Elastic, Place, Sliding, Three, pressed, ramp, sliding, versine


def vector(kind: type, *components: Array) -> Any:
    """Components as a tuple, or along the last axis of an array."""
    if kind is tuple:
        return components
    return arrays.namespace(*components).stack(components, axis=-1)


def damping_matrix(place: Place, contact: Elastic, velocity: Three, spin: Three, given: Constants) -> Any:
    """∂/∂(v, ω) of what damping and friction take, friction at the normal force as it is: (..., 6, 6)."""
    place, contact = Place(*_arrays(place)), Elastic(*_arrays(contact))
    velocity, spin = _arrays(velocity), _arrays(spin)
    n, one, none = _vector(place.x, place.y, place.z), *_ones(place.distance)
    normal = n[..., :, None] * n[..., None, :]
    level = matrix(((one, none, none), (none, one, none), (none, none, one))) - normal
    along, drag = _normal_rates(place, contact, velocity, given)
    push = along[..., None, None] * normal + drag[..., None, None] * level
    slip = sliding(place, pressed(contact, _along(place, velocity), given), velocity, spin, given)
    slip = Sliding(*_arrays(slip))
    x, y, z = place.x, place.y, place.z
    turn = given.ball_radius * matrix(((none, z, -y), (-z, none, x), (y, -x, none)))
    lever = arrays.sqrt(slip.lever_squared)
    xp = arrays.namespace(n)
    # rows: v across the load, R1 ω x n, and the lever's speed; columns: v and ω
    empty = 0.0 * level
    moved, turned = xp.concat([level, empty], axis=-1), xp.concat([empty, turn], axis=-1)
    drilled = xp.concat([0.0 * n, lever[..., None] * n], axis=-1)[..., None, :]
    v, b = _vector(slip.x, slip.y, slip.z), _vector(slip.bx, slip.by, slip.bz)
    rate = slip.rate[..., None, None] * _potential_bend(place, slip, (moved, turned, drilled), (v, b), given)
    felt = _felt(moved, slip.push[..., None] * v + slip.mixed[..., None] * b)
    felt = felt + _felt(turned, slip.mixed[..., None] * v + slip.turn[..., None] * b)
    felt = felt + _felt(drilled, (slip.drill * lever * slip.spin)[..., None])
    fall = _friction_fall(slip, given) / slip.speed
    rate = rate + fall[..., None, None] * (felt[..., :, None] * felt[..., None, :])
    wide = xp.concat([push, 0.0 * push], axis=-1)
    return rate + xp.concat([wide, 0.0 * wide], axis=-2)


def _normal_rates(place: Place, contact: Elastic, velocity: Three, given: Constants) -> tuple[Array, Array]:
    """How fast the normal force rises with ḋ, and how a contact drags that travels along the socket."""
    lossy = given.hysteresis * contact.damped_force + given.time * contact.damped_stiffness
    force = contact.normal + lossy * _along(place, velocity)
    if given.smoothing > 0.0:
        width = ROUNDED * contact.damped_force
        slope = ramp(force / arrays.safe_divisor(width), 1.0)[1]
    else:
        slope = where(force > 0.0, 0.0 * force + 1.0, 0.0 * force)
    return lossy * slope, given.time * contact.damped_force * place.over


def _potential_bend(place: Place, slip: Sliding, ways: Three, rates: tuple[Array, Array], given: Constants) -> Array:
    """Compute half of the second slopes of q² over velocity and spin: (..., 6, 6)."""
    xp = arrays.namespace(rates[0])
    (moved, turned, drilled), (v, b), kappa = ways, rates, friction.tilt_share(versine(place))
    share, drill = kappa * kappa, slip.lever_squared * slip.spin * slip.spin
    pole, tilt = v + b, v - b
    squares = xp.sum(pole * pole, axis=-1), xp.sum(tilt * tilt, axis=-1), xp.sum(pole * tilt, axis=-1)
    state = squares[0], share * squares[1], drill, kappa * squares[2]
    bends = friction.effective_slip_bends(*state, given.transition_speed * given.transition_speed, versine(place))
    first, other = moved + turned, moved - turned
    halves = (
        _felt(first, pole),
        share[..., None] * _felt(other, tilt),
        _felt(drilled, (arrays.sqrt(slip.lever_squared) * slip.spin)[..., None]),
        0.5 * kappa[..., None] * (_felt(first, tilt) + _felt(other, pole)),
    )
    total = slip.push[..., None, None] * _square(moved, moved) + slip.turn[..., None, None] * _square(turned, turned)
    total = total + slip.mixed[..., None, None] * (_square(moved, turned) + _square(turned, moved))
    total = total + slip.drill[..., None, None] * _square(drilled, drilled)
    for (i, j), bend in bends.items():
        outer = halves[i][..., :, None] * halves[j][..., None, :]
        both = outer if i == j else outer + xp.matrix_transpose(outer)
        total = total + 2.0 * bend[..., None, None] * both
    return total


def _square(one: Array, other: Array) -> Array:
    xp = arrays.namespace(one)
    return xp.matmul(xp.matrix_transpose(one), other)


def _felt(ways: Array, rates: Array) -> Array:
    return arrays.namespace(ways).sum(rates[..., :, None] * ways, axis=-2)


def _friction_fall(slip: Sliding, given: Constants) -> Array:
    """Compute the slope of friction's rate over q."""
    q = slip.speed
    mu = friction.coefficient_at(q, given.sliding, given.static, given.stribeck_speed)
    mu_slope = -2.0 * (mu - given.sliding) * q / (given.stribeck_speed * given.stribeck_speed)
    return slip.normal * (mu_slope - mu / q) / q


def _along(place: Place, velocity: Three) -> Array:
    return velocity[0] * place.x + velocity[1] * place.y + velocity[2] * place.z


def _ones(like: Array) -> tuple[Array, Array]:
    return 0.0 * like + 1.0, 0.0 * like


def _vector(*components: Array) -> Any:
    return arrays.namespace(*components).stack(components, axis=-1)


def matrix(rows: Any) -> Any:
    """Rows of components as the last two axes of an array."""
    stacked = [_vector(*row) for row in rows]
    return arrays.namespace(*stacked).stack(stacked, axis=-2)


def _arrays(components: Any) -> Any:
    return tuple(numpy.asarray(part) if type(part) is float else part for part in components)
