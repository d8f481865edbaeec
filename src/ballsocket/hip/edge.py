"""The distance from the contact's edge to the rim over a cycle: how near, when and where."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..elasticity.off_axis.grid import Grid
from .cup_frame import CupFrame


@dataclass(frozen=True, kw_only=True)
class Worst:
    """The instant of a cycle in which the contact comes nearest to the rim; of several, that of the largest load.

    Attributes
    ----------
    distance : float
        In mm; 0 is edge loading.
    place : float
        Around the cup's axis, in rad from its uppermost point.
    told : str
        The instant, in words.
    reaching : int
        Instants in which the contact reaches the rim.
    pressure : float
        Largest pressure in MPa in the outermost ring of cells in any instant.
    """

    distance: float
    place: float
    told: str
    reaching: int
    pressure: float = 0.0

    @property
    def where(self) -> str:
        """Instant and place, in words."""
        return f"{self.told}, {abs(degrees(self.place)):.0f}° from the cup's uppermost point"

    def summary(self) -> dict[str, Any]:
        """For JSON."""
        place = degrees(self.place)
        return {
            "distance_mm": self.distance,
            "at": self.told,
            "place_deg": place,
            "instants_at_rim": self.reaching,
            "pressure_at_rim_MPa": self.pressure,
        }


@dataclass(frozen=True, kw_only=True, eq=False)
class Edge:
    """How near each contact of a cycle comes to the end of the bore.

    Attributes
    ----------
    distance : array (loaded,)
        The arc in mm from the contact's edge, where it is nearest; 0 where it reaches it.
    place : array (loaded,)
        Where that is around the cup's axis, in rad from its uppermost point.
    pressure : array (loaded,)
        Largest pressure in MPa in the outermost ring of cells.
    """

    distance: Numbers
    place: Numbers
    pressure: Numbers

    def nearest(self, use: CupFrame) -> int | None:
        """Which of the contacts comes nearest; of several, that of the largest load; None where nothing is pressed."""
        if not len(self.distance):
            return None
        near = numpy.flatnonzero(self.distance <= self.distance.min())
        return int(near[numpy.linalg.norm(use.loads[near], axis=1).argmax()])

    def worst(self, use: CupFrame) -> Worst | None:
        """The worst instant; None where nothing is pressed."""
        chosen = self.nearest(use)
        if chosen is None:
            return None
        return Worst(
            distance=float(self.distance[chosen]),
            place=float(self.place[chosen]),
            told=use.cycle.told(int(use.loaded[chosen])),
            reaching=int((self.distance <= 0).sum()),
            pressure=float(self.pressure.max()),
        )


def edge_of(grid: Grid, radius: float, field: Numbers, pressure: Numbers, inset: float) -> Edge:
    """Find the edges of contacts towards the end of the bore.

    Parameters
    ----------
    grid : Grid
    radius : float
        Radius of the bore in mm.
    field : array (loaded, cells)
        Positive in the contact and negative outside; linear interpolation between two cells gives its zero.
    pressure : array (loaded, cells)
        In MPa.
    inset : float
        Distance of the edge inside that zero, as a share of a ring's width. If it is positive, pressure in the last
        ring means a contact that reaches the rim.
    """
    rows = field.reshape(len(field), grid.rings, grid.meridians)
    nodes = grid.polar - inset * numpy.diff(grid.edges)
    if inset > 0:
        nodes[-1] = grid.reach
    ends = (rows > 0) & numpy.concatenate([rows[:, 1:] <= 0, numpy.ones_like(rows[:, :1], dtype=bool)], axis=1)
    last = numpy.concatenate([numpy.arange(1, grid.rings), [grid.rings - 2]])  # extrapolates beyond the last ring
    fall = rows - rows[:, last]
    share = numpy.divide(rows, fall, out=numpy.full_like(rows, numpy.inf), where=ends & (fall != 0))
    steps = (nodes[last] - nodes)[:, None]
    edges = numpy.where(share * steps >= 0, nodes[:, None] + share * steps, grid.reach)
    furthest = numpy.where(ends, numpy.minimum(edges, grid.reach), 0.0).max(axis=1, initial=0.0)
    return Edge(
        distance=(grid.reach - furthest.max(axis=1, initial=0.0)) * radius,
        place=_middle(furthest, rows[:, -1], grid.azimuth),
        pressure=pressure.reshape(rows.shape)[:, -1].max(axis=1, initial=0.0),
    )


def _middle(furthest: Numbers, last: Numbers, around: Numbers) -> Numbers:
    """Where edges (loads, meridians) are furthest out; at the rim, the middle of what is pressed there."""
    weight = numpy.where(furthest >= furthest.max(axis=1, initial=0.0)[:, None], numpy.maximum(last, 1e-300), 0.0)
    x, y = weight @ numpy.cos(around), weight @ numpy.sin(around)
    return numpy.arctan2(numpy.where(abs(y) < 1e-9 * abs(x), 0.0, y), x)
