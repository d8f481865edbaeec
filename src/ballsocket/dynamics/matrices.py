"""Components put together: vectors, symmetric matrices, and the matrix of damping."""

from __future__ import annotations

from typing import Any

import numpy

from .. import arrays
from ..arrays import Array, where
from . import friction
from .reaction import ROUNDED, Constants, Elastic, Place, Three, pressed, sliding
from .smooth import ramp


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
    x, y, z = place.x, place.y, place.z
    turn = given.ball_radius * matrix(((none, z, -y), (-z, none, x), (y, -x, none)))
    lever = arrays.sqrt(slip.lever_squared)
    xp = arrays.namespace(n)
    # rows: slip x, y, z and the lever's speed; columns: v and ω
    ways = xp.concat(
        [xp.concat([level, turn], axis=-1), xp.concat([0.0 * n, lever[..., None] * n], axis=-1)[..., None, :]], axis=-2
    )
    way = xp.stack([slip.x, slip.y, slip.z, lever * slip.spin], axis=-1)
    q, fall = _friction_fall(slip, given)
    rate = slip.rate[..., None, None] * xp.matmul(xp.matrix_transpose(ways), ways)
    felt = xp.sum(way[..., :, None] * ways, axis=-2)
    rate = rate + (fall / q)[..., None, None] * (felt[..., :, None] * felt[..., None, :])
    wide = xp.concat([push, 0.0 * push], axis=-1)
    return rate + xp.concat([wide, 0.0 * wide], axis=-2)


def _normal_rates(place: Place, contact: Elastic, velocity: Three, given: Constants) -> tuple[Array, Array]:
    """How fast the normal force rises with ḋ, and how a contact drags that travels along the socket."""
    lossy = given.hysteresis * contact.damped_force + given.time * contact.damped_stiffness
    force = contact.normal + lossy * _along(place, velocity)
    if given.smoothing > 0.0:
        width = ROUNDED * contact.damped_force
        slope = ramp(force / arrays.divisor(width), 1.0)[1]
    else:
        slope = where(force > 0.0, 0.0 * force + 1.0, 0.0 * force)
    return lossy * slope, given.time * contact.damped_force * place.over


def _friction_fall(slip: Any, given: Constants) -> tuple[Array, Array]:
    """q, and the slope of friction's rate over it."""
    squares = slip.x * slip.x + slip.y * slip.y + slip.z * slip.z
    q = friction.combined(squares, slip.lever_squared * slip.spin * slip.spin, given.transition_speed)
    mu = friction.coefficient_at(q, given.sliding, given.static, given.stribeck_speed)
    mu_slope = -2.0 * (mu - given.sliding) * q / (given.stribeck_speed * given.stribeck_speed)
    return q, slip.normal * (mu_slope - mu / q) / q


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
