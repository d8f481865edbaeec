"""Distance of each contact of a cycle from the rim of the cup."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.records import Record
from ..elasticity.off_axis.grid import Grid
from .cup_frame import CupFrame


@dataclass(frozen=True, kw_only=True)
class ClosestApproach:
    """Step of a cycle in which the contact is closest to the rim.

    Attributes
    ----------
    distance : float
        Distance to the rim in mm; 0 is edge loading.
    azimuth : float
        Position around the cup's axis in rad from its uppermost point.
    step_description : str
        Phase of the step, in words.
    steps_at_rim : int
        Number of steps in which the contact reaches the rim.
    pressure : float
        Largest pressure in MPa in the outermost ring of cells in any step.
    steps_edge_loaded : int
        Number of steps with edge loading; see `RimDistance.edge_loaded`.
    """

    distance: float
    azimuth: float
    step_description: str
    steps_at_rim: int
    pressure: float = 0.0
    steps_edge_loaded: int = 0

    @property
    def kind(self) -> str:
        """Kind of the contact at the rim: "edge loading", "worn to the rim" or "clear of the rim"."""
        if self.steps_edge_loaded:
            return "edge loading"
        return "worn to the rim" if self.steps_at_rim else "clear of the rim"

    @property
    def location(self) -> str:
        """Time in the cycle and position around the cup in words."""
        return f"{self.step_description}, {abs(degrees(self.azimuth)):.0f}° from the cup's uppermost point"

    def summary(self) -> dict[str, Any]:
        """Return the closest approach as a dictionary for JSON, in mm and degrees."""
        return {
            "distance_mm": self.distance,
            "at": self.step_description,
            "place_deg": degrees(self.azimuth),
            "instants_at_rim": self.steps_at_rim,
            "pressure_at_rim_MPa": self.pressure,
            "kind": self.kind,
            "instants_edge_loaded": self.steps_edge_loaded,
        }


@dataclass(frozen=True, kw_only=True, eq=False)
class RimDistance(Record):
    """Distance of each contact of a cycle from the rim of the cup.

    Attributes
    ----------
    distance : array (loaded,)
        Shortest arc in mm from the contact's edge to the end of the bore; 0 if the contact reaches it.
    azimuth : array (loaded,)
        Position of the shortest distance around the cup's axis, in rad from its uppermost point.
    pressure : array (loaded,)
        Largest pressure in MPa in the outermost ring of cells.
    edge_loaded : array of bool (loaded,), optional
        Contacts that reach the rim and are edge loading, not wear: the unworn bore's contact reaches the rim under the
        same load, or the largest pressure of the cycle is at the rim. None for an unworn bore: all contacts that reach
        the rim.
    """

    distance: Numbers
    azimuth: Numbers
    pressure: Numbers
    edge_loaded: Numbers | None = None

    @property
    def is_edge_loaded(self) -> Numbers:
        """Mask of the contacts that are edge loading: (loaded,)."""
        return self.distance <= 0 if self.edge_loaded is None else self.edge_loaded

    def closest_index(self, loading: CupFrame) -> int | None:
        """Return the index of the contact closest to the rim; None without loads."""
        if not len(self.distance):
            return None
        closest_indices = numpy.flatnonzero(self.distance <= self.distance.min())
        return int(closest_indices[numpy.linalg.norm(loading.loads[closest_indices], axis=1).argmax()])

    def closest_approach(self, loading: CupFrame) -> ClosestApproach | None:
        """Return the step in which the contact is closest to the rim; None without loads."""
        index = self.closest_index(loading)
        if index is None:
            return None
        return ClosestApproach(
            distance=float(self.distance[index]),
            azimuth=float(self.azimuth[index]),
            step_description=loading.cycle.describe_step(int(loading.loaded[index])),
            steps_at_rim=int((self.distance <= 0).sum()),
            pressure=float(self.pressure.max()),
            steps_edge_loaded=int(self.is_edge_loaded.sum()),
        )


def mask_edge_loading(worn: RimDistance, unworn: RimDistance, max_pressure: float) -> Numbers:
    """Find the contacts of a worn bore that are edge loading, not wear: (loaded,).

    A worn bore that fits the ball touches it up to the rim in every instant. Edge loading is a contact at the rim for
    one of two reasons. The load points so close to the rim that the contact of the unworn bore reaches it too. Or the
    largest pressure of the cycle, in MPa, is at the rim.
    """
    at_rim = worn.distance <= 0
    largest_at_rim = (worn.pressure > 0) & (worn.pressure >= max_pressure)
    return numpy.asarray(at_rim & ((unworn.distance <= 0) | largest_at_rim))


def rim_distance(grid: Grid, radius: float, field: Numbers, pressure: Numbers, inset: float) -> RimDistance:
    """Compute the distance in mm of each contact from the rim, from a field that is 0 at contact edges.

    The field (loaded, cells) is positive in the contact; the edge is the zero of linear interpolation between two
    cells. `inset` is the distance of the edge inside that zero, as a share of a ring's width. If it is positive,
    pressure in the last ring means a contact that reaches the rim.
    """
    level = field.reshape(len(field), grid.rings, grid.meridians)
    polar_nodes = grid.polar - inset * numpy.diff(grid.edges)
    if inset > 0:
        polar_nodes[-1] = grid.reach
    is_end = (level > 0) & numpy.concatenate([level[:, 1:] <= 0, numpy.ones_like(level[:, :1], dtype=bool)], axis=1)
    next_ring = numpy.concatenate([numpy.arange(1, grid.rings), [grid.rings - 2]])  # extrapolates beyond the last ring
    step, ring, meridian = numpy.nonzero(is_end)
    last_level, spacing = level[is_end], (polar_nodes[next_ring] - polar_nodes)[ring]
    level_drop = last_level - level[step, next_ring[ring], meridian]
    fraction = numpy.divide(last_level, level_drop, out=numpy.full_like(level_drop, numpy.inf), where=level_drop != 0)
    end_angles = numpy.where(fraction * spacing >= 0, polar_nodes[ring] + fraction * spacing, grid.reach)
    edge_angle = numpy.zeros((len(level), grid.meridians))
    numpy.maximum.at(edge_angle, (step, meridian), numpy.minimum(end_angles, grid.reach))
    outermost = edge_angle.max(axis=1, initial=0.0)
    weight = numpy.where(edge_angle >= outermost[:, None], numpy.maximum(level[:, -1], 1e-300), 0.0)
    x, y = weight @ numpy.cos(grid.azimuth), weight @ numpy.sin(grid.azimuth)
    return RimDistance(
        distance=(grid.reach - outermost) * radius,
        azimuth=numpy.arctan2(numpy.where(abs(y) < 1e-9 * abs(x), 0.0, y), x),
        pressure=pressure.reshape(level.shape)[:, -1].max(axis=1, initial=0.0),
    )
