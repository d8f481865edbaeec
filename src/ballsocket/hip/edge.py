"""The distance from the contact's edge to the rim over a cycle: how near, when and where."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy

from ..arrays import Numbers
from ..sphere.grid import Grid
from .placing import Placed


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
    """

    distance: float
    place: float
    told: str
    reaching: int

    @property
    def where(self) -> str:
        """Instant and place, in words."""
        return f"{self.told}, {abs(degrees(self.place)):.0f}° from the cup's uppermost point"

    def summary(self) -> dict[str, Any]:
        """For JSON."""
        place = degrees(self.place)
        return {"distance_mm": self.distance, "at": self.told, "place_deg": place, "instants_at_rim": self.reaching}


@dataclass(frozen=True, kw_only=True, eq=False)
class Edge:
    """How near each contact of a cycle comes to the end of the bore.

    Attributes
    ----------
    distance : array (loaded,)
        The arc in mm from the contact's edge, where it is nearest; 0 where it reaches it.
    place : array (loaded,)
        Where that is around the cup's axis, in rad from its uppermost point.
    """

    distance: Numbers
    place: Numbers

    def nearest(self, use: Placed) -> int | None:
        """Which of the contacts comes nearest; of several, that of the largest load; None where nothing is pressed."""
        if not len(self.distance):
            return None
        near = numpy.flatnonzero(self.distance <= self.distance.min())
        return int(near[numpy.linalg.norm(use.loads[near], axis=1).argmax()])

    def worst(self, use: Placed) -> Worst | None:
        """The worst instant; None where nothing is pressed."""
        chosen = self.nearest(use)
        if chosen is None:
            return None
        return Worst(
            distance=float(self.distance[chosen]),
            place=float(self.place[chosen]),
            told=use.cycle.told(int(use.loaded[chosen])),
            reaching=int((self.distance <= 0).sum()),
        )


def edge_of(grid: Grid, reach: float, radius: float, field: Numbers) -> Edge:
    """The edges of contacts in a bore of this radius in mm, which reaches so far (rad).

    They are found from what falls to 0 there as a straight line does: (loaded, cells).
    """
    polar, around = grid.polar, grid.azimuth
    rows = field.reshape(len(field), len(polar), len(around))
    ends = (rows > 0) & numpy.concatenate([rows[:, 1:] <= 0, numpy.ones_like(rows[:, :1], dtype=bool)], axis=1)
    fall = rows[:, :-1] - rows[:, 1:]
    share = numpy.divide(rows[:, :-1], fall, out=numpy.ones_like(fall), where=ends[:, :-1])
    edges = polar[:-1, None] + share * numpy.diff(polar)[:, None]
    edges = numpy.concatenate([edges, numpy.full_like(edges[:, :1], reach)], axis=1)
    furthest = numpy.where(ends, edges, 0.0).max(axis=1, initial=0.0)
    return Edge(
        distance=(reach - furthest.max(axis=1, initial=0.0)) * radius,
        place=_middle(furthest, rows[:, -1], around),
    )


def _middle(furthest: Numbers, last: Numbers, around: Numbers) -> Numbers:
    """Where edges (loads, meridians) are furthest out; at the rim, the middle of what is pressed there."""
    weight = numpy.where(furthest >= furthest.max(axis=1, initial=0.0)[:, None], numpy.maximum(last, 1e-300), 0.0)
    x, y = weight @ numpy.cos(around), weight @ numpy.sin(around)
    return numpy.arctan2(numpy.where(abs(y) < 1e-9 * abs(x), 0.0, y), x)
