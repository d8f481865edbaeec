"""From loads of one kind to balls at rest: displaced, under a force, or as wide as asked for."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy

from ...core.arrays import Numbers
from ...models.kinematics import versine_of
from .directions import polar_angle
from .gap import sunk
from .search import Bed
from .states import Edges, Loaded, States


def _displaced(bed: Bed, indentation: Numbers, axes: Numbers, edges: Edges) -> States:
    rest = bed.at(axes * (bed.separation.clearance + indentation)[:, None])
    apart = ~(rest.pressure > 0).any(axis=(1, 2))
    far = (bed.separation.clearance + indentation) / bed.separation.socket_radius
    lost = numpy.asarray((apart & (far > _OUT)) | (far > 1))
    return States(bed=bed, rest=rest, axes=axes, edges=edges, dislocated=lost, load=indentation, press=_displaced)


def _forced(bed: Bed, force: Numbers, axes: Numbers, edges: Edges) -> States:
    reach = bed.compliance.grid.reach
    held = (polar_angle(axes.T) < reach) | (reach > numpy.pi / 2)
    begin = sunk(bed.separation, bed.compliance.evenly, bed.separation.depth, force, axes)
    rest = bed.under(axes * force[:, None], begin, held)
    leaves = polar_angle(rest.displacement.T) > reach + _SWUNG
    out = held & (numpy.linalg.norm(rest.displacement, axis=1) > _AWAY * bed.separation.socket_radius)
    lost = ~held | out | (~rest.found & leaves)
    return States(bed=bed, rest=rest, axes=axes, edges=edges, dislocated=lost, load=force, press=_forced)


_OUT = 0.5
"""Of the bore's radius: a ball that touches nothing and is displaced further has left its bore.

So has one whose centre lies beyond the bore's own surface, whatever it touches.
"""

_AWAY = 0.25
"""Of the bore's radius: a ball at rest is nearer, and a preloaded one that is not was pushed out by its bore."""

_SWUNG = numpy.pi / 3
"""So far beyond the rim the centre of a ball has swung that no longer comes to rest.

Without friction a bore pushes back along its normals alone: one that ends before its equator holds no load beyond its
end, one that ends behind it holds any.
"""


_ROUNDS = 40
_SHUT = 1e-3
"""Of an indentation: a bracket that holds nothing but a jump."""

_EXACT, _RAGGED = 0.005, 1.0
"""Of a ring's width: where a half angle is good, and as far it may jump where more cells touch, a ring at once."""


def _spread(bed: Bed, half_angle: Numbers, axes: Numbers, edges: Edges) -> States:
    """Indentations whose contacts have this half angle, by Newton's method in brackets that shrink."""
    width, most = bed.compliance.grid.width, _OUT * bed.separation.socket_radius
    depth = numpy.clip(_in_springs(bed, half_angle), 1e-6 * most, most)
    low, high, some = 0.0 * depth, numpy.full_like(depth, most), numpy.arange(len(depth))
    for _ in range(_ROUNDS):
        d, aim = depth[some], half_angle[some]
        got = _displaced(bed, d, axes[some], edges).half_angle
        low[some], high[some] = numpy.where(got < aim, d, low[some]), numpy.where(got < aim, high[some], d)
        left = (abs(got - aim) > _EXACT * width) & (high[some] - low[some] > _SHUT * high[some])
        if not left.any():
            break
        guess = d * numpy.clip(_in_springs(bed, aim) / numpy.maximum(_in_springs(bed, got), 1e-9 * d), 0.1, 10.0)
        some, guess = some[left], guess[left]
        depth[some] = _between(guess, low[some], high[some], most)
    states = _displaced(bed, depth, axes, edges)
    off = half_angle - states.half_angle
    found = states.rest.found & (abs(off) <= _RAGGED * width)
    too_wide = (low >= (1 - _SHUT) * most) & (off > _EXACT * width)
    return replace(states, rest=replace(states.rest, found=found), too_wide=too_wide)


def _in_springs(bed: Bed, half_angle: Numbers) -> Numbers:
    """The indentation in mm by which a contact in springs is so wide; without a clearance a measure of it."""
    versine = versine_of(half_angle)
    return max(abs(bed.separation.clearance), 1e-9) * versine / numpy.maximum(1 - versine, 0.05)


def _between(guess: Numbers, low: Numbers, high: Numbers, most: float) -> Numbers:
    """The guess, or a place inside the bracket; at its end where nothing shows yet how far that must be."""
    middle = numpy.where(low > 0, numpy.sqrt(low * high), high / 10)
    inside: Numbers = numpy.where((guess > low) & (guess < high), guess, middle)
    return numpy.where((guess >= most) & (high >= most), (1 - _SHUT / 2) * most, inside)


LOADED: MappingProxyType[str, Loaded] = MappingProxyType(
    {"force": _forced, "indentation": _displaced, "half_angle": _spread}
)
