"""The ball's own cells, and places between the cells of a grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from ..elasticity.off_axis.grid import Grid, even_grid


@dataclass(frozen=True, kw_only=True, eq=False)
class Spots:
    """Places between the cells of a grid, each with the four around it.

    Attributes
    ----------
    cells : array (n, places, 4)
    shares : array (n, places, 4)
        They add up to 1; 0 beyond the grid's reach.
    """

    cells: Numbers
    shares: Numbers

    def of(self, fields: Numbers) -> Numbers:
        """Values of fields (n or 1, all cells) at the places: (n, places)."""
        count, places, four = self.cells.shape
        fields = numpy.broadcast_to(fields, (count, fields.shape[-1]))
        found = numpy.take_along_axis(fields, self.cells.reshape(count, -1), axis=1)
        return numpy.einsum("tpk,tpk->tp", found.reshape(count, places, four), self.shares)


def spots_of(grid: Grid, directions: Numbers) -> Spots:
    """Where unit vectors (3, n, places) lie between the middles of a grid's cells."""
    x, y, z = directions
    polar, around = numpy.arctan2(numpy.hypot(x, y), z), numpy.arctan2(y, x)
    ring = numpy.clip(numpy.searchsorted(grid.polar, polar) - 1, 0, grid.rings - 2)
    up = numpy.clip((polar - grid.polar[ring]) / (grid.polar[ring + 1] - grid.polar[ring]), 0.0, 1.0)
    turn = around / (2 * numpy.pi) * grid.meridians - 0.5
    first = numpy.floor(turn).astype(int)
    on = turn - first
    cells = numpy.stack(
        [(ring + i) * grid.meridians + (first + j) % grid.meridians for i in (0, 1) for j in (0, 1)], axis=-1
    )
    shares = numpy.stack([(1 - up) * (1 - on), (1 - up) * on, up * (1 - on), up * on], axis=-1)
    return Spots(cells=cells, shares=shares * (polar <= grid.reach)[..., None])


def ball_grid(width: float) -> Grid:
    """The ball's cells: rings about its axis to the front, so that none of those that are pressed is a sliver."""
    return even_grid(numpy.pi, width)


def ball_directions(grid: Grid) -> Numbers:
    """Unit vectors (3, cells) to the middles of the cells of a ball that is not turned, in the body's directions."""
    along, across, front = grid.middles.reshape(3, -1)
    return numpy.stack([across, front, along])
