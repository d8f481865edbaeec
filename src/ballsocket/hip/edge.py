"""The distance from the contact's edge to the rim over a cycle: how near, when and where."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.deprecation import renamed_fields
from ..elasticity.off_axis.grid import Grid
from .placing import Placed


@renamed_fields(place="azimuth", told="step_description", reaching="steps_at_rim")
@dataclass(frozen=True, kw_only=True)
class Worst:
    """The instant of a cycle in which the contact comes nearest to the rim; of several, that of the largest load.

    Attributes
    ----------
    distance : float
        In mm; 0 is edge loading.
    azimuth : float
        Around the cup's axis, in rad from its uppermost point.
    step_description : str
        The instant, in words.
    steps_at_rim : int
        Instants in which the contact reaches the rim.
    pressure : float
        Largest pressure in MPa in the outermost ring of cells in any instant.
    """

    distance: float
    azimuth: float
    step_description: str
    steps_at_rim: int
    pressure: float = 0.0

    @property
    def where(self) -> str:
        """Instant and place, in words."""
        return f"{self.step_description}, {abs(degrees(self.azimuth)):.0f}° from the cup's uppermost point"

    def summary(self) -> dict[str, Any]:
        """For JSON."""
        place = degrees(self.azimuth)
        return {
            "distance_mm": self.distance,
            "at": self.step_description,
            "place_deg": place,
            "instants_at_rim": self.steps_at_rim,
            "pressure_at_rim_MPa": self.pressure,
        }


@renamed_fields(place="azimuth")
@dataclass(frozen=True, kw_only=True, eq=False)
class Edge:
    """How near each contact of a cycle comes to the end of the bore.

    Attributes
    ----------
    distance : array (loaded,)
        The arc in mm from the contact's edge, where it is nearest; 0 where it reaches it.
    azimuth : array (loaded,)
        Where that is around the cup's axis, in rad from its uppermost point.
    pressure : array (loaded,)
        Largest pressure in MPa in the outermost ring of cells.
    """

    distance: Numbers
    azimuth: Numbers
    pressure: Numbers

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
            azimuth=float(self.azimuth[chosen]),
            step_description=use.cycle.describe_step(int(use.loaded[chosen])),
            steps_at_rim=int((self.distance <= 0).sum()),
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
        azimuth=_middle(furthest, rows[:, -1], grid.azimuth),
        pressure=pressure.reshape(rows.shape)[:, -1].max(axis=1, initial=0.0),
    )


def _middle(furthest: Numbers, last: Numbers, around: Numbers) -> Numbers:
    """Where edges (loads, meridians) are furthest out; at the rim, the middle of what is pressed there."""
    weight = numpy.where(furthest >= furthest.max(axis=1, initial=0.0)[:, None], numpy.maximum(last, 1e-300), 0.0)
    x, y = weight @ numpy.cos(around), weight @ numpy.sin(around)
    return numpy.arctan2(numpy.where(abs(y) < 1e-9 * abs(x), 0.0, y), x)
