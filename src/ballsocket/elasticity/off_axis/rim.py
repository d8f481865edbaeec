"""Distance of contacts from the end of their bore; for a cut contact, the rotation of the load back to first touch."""

from __future__ import annotations

from math import radians
from typing import TYPE_CHECKING

import numpy

from ...core.arrays import Numbers
from .directions import polar_angle, unit_vectors

if TYPE_CHECKING:
    from .states import States

_MAX_ITERATIONS = 30
_TILT_TOLERANCE = radians(0.02)
"""Largest step of the tilt that is not pressed any more: 0.006 mm of arc in a bore of 18 mm."""

_POLE = 1e-6  # rad: tilt of an axial load that still defines a meridian


def edge_margins(states: States) -> Numbers:
    """Compute the smallest angles in rad from the edges of contacts to the end of the bore: (contacts,).

    A contact that reaches the end has less than 0: by so much would its load have to turn back towards the dome for it
    to end there. Of a displaced ball the displacement would turn.
    """
    margin = _margins(states)
    cut = numpy.flatnonzero((states.edge_loaded == 1) & states.rest.found)
    if len(cut):
        margin[cut] = numpy.minimum(_touching_tilts(states, cut) - polar_angle(states.axes[cut].T), 0.0)
    return margin


def _touching_tilts(states: States, cut: Numbers) -> Numbers:
    """Compute the tilts in rad of first touch with the end of the bore under these loads: (cut,)."""
    x, y, _ = states.axes[cut].T
    worn = bool(states.bed.separation.depth.any())  # otherwise all meridians are the same
    azimuth = numpy.arctan2(y, x) if worn else 0.0 * x
    rows, group = numpy.unique(numpy.stack([states.load[cut], azimuth]), axis=1, return_inverse=True)
    group, tilt, level = group.ravel(), polar_angle(states.axes[cut].T), _rim_levels(states)[cut]
    least = numpy.array([numpy.flatnonzero(group == i)[tilt[group == i].argmin()] for i in range(rows.shape[1])])
    load, azimuth = rows
    return _solve_touching(states, load, azimuth, tilt[least], level[least])[group]


def _solve_touching(states: States, load: Numbers, azimuth: Numbers, high: Numbers, level: Numbers) -> Numbers:
    """Find the tilts at which the level at the rim is 0 by the Illinois method.

    Parameters
    ----------
    states : States
    load, azimuth : array (n,)
    high, level : array (n,)
        Tilts in rad at which the rim is loaded, and the levels there in mm.
    """

    def press(some: Numbers, tilt: Numbers) -> States:
        axes = unit_vectors(tilt, azimuth[some]).T
        return states.press(states.bed, load[some], axes, states.edges)

    everything, low = numpy.arange(len(load)), numpy.full(len(load), _POLE)
    along = press(everything, low)
    filled = ~along.rest.found | (along.edge_loaded == 1)
    below, above, root = _rim_levels(along), level.copy(), low.copy()
    margin = _margins(along)
    guess = low + margin  # first touch of a rigid rim
    some, free_before = everything[~filled & (high > low)], numpy.full(len(load), -1)
    for _ in range(_MAX_ITERATIONS):
        if not len(some):
            break
        one, other = below[some], above[some]
        tilt = (low[some] * other - high[some] * one) / (other - one)
        tilt = numpy.where(guess[some] < high[some], guess[some], tilt)  # excludes NaN and infinity
        pressed = press(some, tilt)
        values, left = _rim_levels(pressed), _margins(pressed)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            ahead = tilt + left * (tilt - low[some]) / (margin[some] - left)
        free = values <= 0
        share = numpy.where(free == free_before[some], 0.5, 1.0)  # halved for an end that stays twice (Illinois)
        above[some] = numpy.where(free, share * other, values)
        below[some] = numpy.where(free, values, share * one)
        free_before[some] = free
        # margins are convex in the tilt: their secant stays on the free side
        guess[some] = numpy.where(free, ahead, numpy.inf)
        margin[some] = numpy.where(free, left, margin[some])
        low[some], high[some] = numpy.where(free, tilt, low[some]), numpy.where(free, high[some], tilt)
        one, other = below[some], above[some]
        between = (low[some] * other - high[some] * one) / (other - one)
        root[some] = numpy.where(free & (left < _TILT_TOLERANCE), numpy.minimum(tilt + left, high[some]), between)
        some = some[abs(root[some] - tilt) > _TILT_TOLERANCE]
    return numpy.where(filled, _missing_angles(along), root)


def _margins(states: States) -> Numbers:
    return numpy.array([patch.edge_margin for patch in states.patches])


def _rim_levels(states: States) -> Numbers:
    """Find the largest level of each contact in the last ring, in mm: (contacts,)."""
    largest: Numbers = states.levels[:, -1].max(axis=1)
    return largest


def _missing_angles(states: States) -> Numbers:
    """Compute the negative angles in rad by which the undeformed overlap extends beyond the bore."""
    distance = numpy.linalg.norm(states.rest.displacement, axis=1)
    share = states.bed.separation.clearance / numpy.where(distance > 0, distance, 1e-300)
    return numpy.minimum(states.bed.compliance.grid.reach - numpy.arccos(numpy.clip(share, -1.0, 1.0)), -_POLE)
