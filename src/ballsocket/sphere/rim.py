"""How far contacts are from the end of their bore, and by how much those that reach it are beyond."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy

from ..arrays import Numbers
from .directions import polar_angle, unit_vectors

if TYPE_CHECKING:
    from .states import States

_TURNS, _SHUT = 6, 0.3
"""A contact comes nearer to the rim by what its load turns; near to it, where that gives way, by less.

It is turned again while more is left than such a share of a ring.
"""

_POLE = 1e-6  # rad: a load along the axis that knows its meridian


def edge_margins(states: States) -> Numbers:
    """Angles in rad from the edges of contacts to the end of the bore where that is nearest: (contacts,).

    A contact that reaches the end has less than 0: by so much would its load have to turn back towards the dome for it
    to end there. That of a displaced ball is its displacement.
    """
    margin = numpy.array([patch.edge_margin for patch in states.patches])
    cut = numpy.flatnonzero((states.edge_loaded == 1) & states.rest.found)
    if len(cut):
        margin[cut] = numpy.minimum(_touching_at(states, cut) - polar_angle(states.axes[cut].T), 0.0)
    return margin


def _touching_at(states: States, cut: Numbers) -> Numbers:
    """The tilts in rad at which contacts under these loads would just touch the end of the bore."""
    x, y, _ = states.axes[cut].T
    worn = bool(states.bed.separation.depth.any())  # otherwise all meridians are the same
    azimuth = numpy.arctan2(y, x) if worn else 0.0 * x
    rows, which = numpy.unique(numpy.stack([states.load[cut], azimuth]), axis=1, return_inverse=True)
    return _touching(states, *rows)[which.ravel()]


def _touching(states: States, load: Numbers, azimuth: Numbers) -> Numbers:
    """From the dome turned on by what is left to the rim; beyond it where the dome's own contact fills the bore."""
    tilt, some = numpy.full(len(load), _POLE), numpy.arange(len(load))
    for _ in range(_TURNS):
        here = tilt[some]
        there = states.press(states.bed, load[some], unit_vectors(here, azimuth[some]).T, states.edges)
        free = there.rest.found & (there.edge_loaded == 0)
        left = numpy.where(free, [patch.edge_margin for patch in there.patches], 0.0)
        tilt[some] = numpy.where(free | (here > _POLE), here + left, _filled(there))
        some = some[left > _SHUT * states.bed.compliance.grid.width]
        if not len(some):
            break
    return tilt


def _filled(states: States) -> Numbers:
    """The angles that a bore lacks of all that the displaced balls would stand in, below 0."""
    far = numpy.linalg.norm(states.rest.displacement, axis=1)
    share = states.bed.separation.clearance / numpy.where(far > 0, far, 1e-300)
    return numpy.minimum(states.bed.compliance.grid.reach - numpy.arccos(numpy.clip(share, -1.0, 1.0)), -_POLE)
