"""A sphere that gives way to each mode c_n P_n by itself, as matrices between rings: the ball, and a closed shell."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy

from ...core.arrays import Numbers, gauss_legendre
from .grid import Grid
from .harmonics import every_harmonic

_TIMES = 6  # as many modes as the rings resolve, so often
_POINTS = 8  # in a ring

Modes = Callable[[Numbers], Numbers]
"""From degrees n to modal compliances c_n in mm/MPa."""


def modal_rings(modes: Modes, grid: Grid) -> Numbers:
    """∫ u dA over the ring of the row by a unit of pressure on that of the column, for each m: (m, rings, rings).

    Parameters
    ----------
    modes : function
    grid : Grid

    Returns
    -------
    array (degrees + 1, rings, rings)
        On a sphere of radius 1; the mean over a cell's width is not in it.
    """
    count = int(_TIMES * pi / grid.width)
    compliance = modes(numpy.arange(count + 1))
    last = compliance[-1]  # that of all modes beyond, so that nothing is without any

    def some(m: Numbers) -> Numbers:
        shares = ring_shares(grid, m, count)
        return 2 * pi * (shares * (compliance - last)) @ shares.swapaxes(1, 2) + last * numpy.diag(grid.ring_areas)

    return every_harmonic(some, grid.degrees)


def ring_shares(grid: Grid, m: Numbers, count: int) -> Numbers:
    """∫ P sin θ dθ over each ring, P being normalised associated Legendre functions: (m, rings, n up to count)."""
    nodes, weights = (numpy.array(part) for part in gauss_legendre(_POINTS))
    width = numpy.diff(grid.edges)[:, None]
    angle = (grid.edges[:-1, None] + width * nodes).ravel()
    measure = (width * weights).ravel() * numpy.sin(angle)
    shares = numpy.zeros((len(m), grid.rings, count + 1))
    before, here = numpy.zeros((2, len(m), angle.size))
    start, first = numpy.sqrt(0.5) * numpy.ones(angle.size), {int(each): i for i, each in enumerate(m)}
    for n in range(count + 1):
        before, here = here, _next(n, m[:, None], before, here, numpy.cos(angle))
        if n in first:
            here[first[n]] = start
        start = start * numpy.sqrt((2 * n + 3) / (2 * n + 2)) * numpy.sin(angle)
        shares[..., n] = (here * measure).reshape(len(m), grid.rings, _POINTS).sum(axis=-1)
    return shares


def _next(n: int, m: Numbers, before: Numbers, here: Numbers, x: Numbers) -> Numbers:
    """The functions of degree n from those of n - 1 and n - 2, where m < n; 0 elsewhere."""
    low = m < n
    square = numpy.where(low, n * n - m * m, 1)
    rise = numpy.sqrt(numpy.where(low, (4 * n * n - 1) / square, 0.0))
    drop = numpy.sqrt(numpy.where(low, (2 * n + 1) * numpy.maximum((n - 1) ** 2 - m * m, 0) / square, 0.0))
    return rise * x * here - drop / numpy.sqrt(max(2 * n - 3, 1)) * before
