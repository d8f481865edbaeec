"""Patch of one contact on the grid: pressure between the cells, outline, and rise of the pressure at the edge."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import nan

import numpy

from ...core.arrays import Numbers
from . import patch_measures as measures
from .grid import Grid
from .patch_measures import CellArrays, Patches

_EDGE_RINGS = numpy.array([2.0, 3.0, 4.0])
"""Distances from the edge in ring widths at which the rise of the pressure is fitted."""

_MIN_EDGE_RINGS = 5.0  # smallest distance from the centre to the edge in ring widths for a fit of the edge


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactPatch:
    """Pressure of one contact on the grid, with its outline."""

    grid: Grid
    pressure: Numbers  # (rings, meridians), pressure in MPa
    # (rings, meridians), level in mm: positive in the contact, minus the gap outside, zero near the edge
    level: Numbers
    axis: Numbers  # (3,), unit vector of the load, in the cup's frame
    inset: float  # distance of the edge inside the zero of `level`, as a fraction of a ring's width: see `EdgeRelation`

    @cached_property
    def _cells(self) -> CellArrays:
        return measures.make_cell_arrays(self.grid, self.inset)

    @cached_property
    def _table(self) -> Numbers:
        return measures.pressure_table(self._cells, self.pressure[None])

    def pressure_at(self, directions: Numbers) -> Numbers:
        """Interpolate the pressure in MPa in directions (..., 3) of the cup's frame; 0 outside contact and bore."""
        return measures.interpolate(self._cells, self._table, numpy.asarray(directions)[None])[0]

    def pressure_along(self, angle: Numbers) -> Numbers:
        """Interpolate the pressure in MPa at angles from the load towards the rim, in the plane of load and axis."""
        return self.pressure_at(measures.ray_directions(self.axis, angle, 0.0 * angle))

    @cached_property
    def outline(self) -> Numbers:
        """Edge of the contact, as unit vectors (rays, 3) at the ends of rays from its centre."""
        centre, angles = self._edges
        return measures.ray_directions(centre, angles, measures.ray_azimuths(self.pressure))

    @cached_property
    def _edges(self) -> tuple[Numbers, Numbers]:
        """Centre (3,) of the contact, and the angles (rays,) in rad from it to the edge along rays."""
        patches = Patches(pressure=self.pressure[None], level=self.level[None], axis=self.axis[None])
        centres, angles = measures.measure_edges(self._cells, patches)
        return centres[0], angles[0]

    def edge_constant(self, exponent: float) -> float:
        """Compute the mean over the edge of p/s^n for a distance s (rad) to it; NaN in a contact of few rings.

        A power p^(1/n) of the pressure is smooth there. A parabola through three points of each ray has its slope.
        """
        centre, angles = self._edges
        rays = angles > _MIN_EDGE_RINGS * self.grid.width
        rays &= angles < measures.rim_angles(self._cells, centre[None])[0] - self.grid.width
        if not rays.any():
            return nan
        edge, azimuths = angles[rays], measures.ray_azimuths(self.pressure)[rays]
        distance = self.grid.width * _EDGE_RINGS[:, None] + 0 * edge
        power = self.pressure_at(measures.ray_directions(centre, edge - distance, azimuths)) ** (1 / exponent)
        slope = numpy.polynomial.polynomial.polyfit(distance[:, 0], power, 2)[1]
        return float((numpy.maximum(slope, 0.0) ** exponent).mean())
