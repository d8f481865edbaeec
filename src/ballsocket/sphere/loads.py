"""From loads of one kind to balls at rest: displaced, under a force, or as wide as asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import MappingProxyType

import numpy

from ..arrays import Numbers
from ..models.kinematics import linear_indentation_of_versine
from .directions import polar_angle
from .gap import sunk
from .search import Bed
from .states import Edges, States

Loaded = Callable[[Bed, Numbers, Numbers, Edges], States]
"""From a bed, loads (contacts,), their directions (contacts, 3) in the cup's frame, and what edges are like."""


def _displaced(bed: Bed, indentation: Numbers, axes: Numbers, edges: Edges) -> States:
    rest = bed.at(axes * (bed.separation.clearance + indentation)[:, None])
    apart = ~(rest.pressure > 0).any(axis=(1, 2))
    far = bed.separation.clearance + indentation > _OUT * bed.separation.socket_radius
    lost = numpy.asarray(apart & far)
    return States(bed=bed, rest=rest, axes=axes, edges=edges, dislocated=lost)


def _forced(bed: Bed, force: Numbers, axes: Numbers, edges: Edges) -> States:
    reach = bed.compliance.grid.reach
    held = (polar_angle(axes.T) < reach) | (reach > numpy.pi / 2)
    begin = sunk(bed.separation, bed.compliance.evenly, bed.separation.depth, force, axes)
    rest = bed.under(axes * force[:, None], begin, held)
    leaves = polar_angle(rest.displacement.T) > reach + _SWUNG
    out = held & (numpy.linalg.norm(rest.displacement, axis=1) > _AWAY * bed.separation.socket_radius)
    return States(bed=bed, rest=rest, axes=axes, edges=edges, dislocated=~held | out | (~rest.found & leaves))


_OUT = 0.5
"""Of the bore's radius: a ball that touches nothing and is displaced further has left its bore."""

_AWAY = 0.25
"""Of the bore's radius: a ball at rest is nearer, and a preloaded one that is not was pushed out by its bore."""

_SWUNG = numpy.pi / 3
"""So far beyond the rim the centre of a ball has swung that no longer comes to rest.

Without friction a bore pushes back along its normals alone: one that ends before its equator holds no load beyond its
end, one that ends behind it holds any.
"""


_ROUNDS = 12


def _spread(bed: Bed, half_angle: Numbers, axes: Numbers, edges: Edges) -> States:
    """Indentations whose contacts have this half angle, by secants of the versine over the indentation."""
    separation = bed.separation
    asked = 2 * numpy.sin(half_angle / 2) ** 2
    depth = linear_indentation_of_versine(separation.socket_radius, separation.clearance, asked)
    for _ in range(_ROUNDS):
        states = _displaced(bed, depth, axes, edges)
        shares = asked / numpy.maximum(2 * numpy.sin(states.half_angle / 2) ** 2, 1e-12)
        if (abs(shares - 1) < 1e-4).all():
            break
        depth = depth * numpy.clip(shares, 0.25, 4.0)
    missed = (abs(shares - 1) >= 1e-3) & ~states.dislocated
    return replace(states, rest=replace(states.rest, found=states.rest.found & ~missed))


LOADED: MappingProxyType[str, Loaded] = MappingProxyType(
    {"force": _forced, "indentation": _displaced, "half_angle": _spread}
)
