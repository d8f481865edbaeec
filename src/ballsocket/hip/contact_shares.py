"""Contact share of each cell: 0 outside, 1 inside, between 0 and 1 at the edge of the contact."""

from __future__ import annotations

import numpy

from ..core.arrays import Numbers
from ..elasticity.off_axis.grid import Grid


def grid_neighbours(grid: Grid) -> Numbers:
    """Number the four neighbours of every cell: (2, 2, cells), along the meridians and around the axis.

    Across the pole the neighbour is the opposite cell of the first ring. At the rim a cell is its own neighbour.
    """
    cells = numpy.arange(grid.rings * grid.meridians).reshape(grid.rings, grid.meridians)
    before = numpy.vstack([numpy.roll(cells[:1], grid.meridians // 2, axis=1), cells[:-1]])
    after = numpy.vstack([cells[1:], cells[-1:]])
    circumferential = [numpy.roll(cells, shift, axis=1) for shift in (1, -1)]
    return numpy.stack([before, after, *circumferential]).reshape(2, 2, -1)


def subset_neighbours(neighbours: Numbers, cells: Numbers) -> Numbers:
    """Renumber the neighbours for a subset of the cells; a neighbour outside the subset becomes the cell itself."""
    numbers = numpy.full(neighbours.shape[-1], -1)
    numbers[cells] = numpy.arange(len(cells))
    chosen = numbers[neighbours[..., cells]]
    return numpy.where(chosen < 0, numpy.arange(len(cells)), chosen)


def contact_shares(level: Numbers, neighbours: Numbers, inset: float) -> Numbers:
    """Compute the share of each cell that is in contact, from 0 to 1: (loads, cells).

    Parameters
    ----------
    level : array (loads, cells)
        In mm, positive in the contact. Linear interpolation between two cells gives the zero of the level.
    neighbours : array (2, 2, cells)
    inset : float
        Distance of the edge inside that zero, as a share of a cell's width; see `sphere.edges`.
    """
    positive, span = level > 0, numpy.zeros_like(level)
    for pair in neighbours:
        falls = [numpy.where(positive[:, cells] != positive, abs(level - level[:, cells]), 0.0) for cells in pair]
        span += numpy.maximum(*falls)
    steps = numpy.divide(level, span, out=numpy.where(positive, 1.0, -1.0), where=span > 0)
    cell_shares: Numbers = numpy.clip(0.5 - inset + steps, 0.0, 1.0)
    return cell_shares
