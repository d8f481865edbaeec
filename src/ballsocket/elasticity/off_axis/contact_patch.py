"""Patch of one contact on the grid: pressure between the cells, largest pressure, outline, and margin to the rim."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import nan, pi

import numpy
from scipy.interpolate import RegularGridInterpolator

from ...core.arrays import Numbers
from .directions import polar_angle, unit_vectors
from .grid import Grid

_RAYS = 90
"""Number of rays from the centre of a contact to its outline."""

_BISECTIONS = 8
"""Number of bisections of a step of half a ring's width."""

_FIT_RADIUS = 2.2
"""Radius of the quadratic fit around the largest pressure, in widths of a ring."""

_LATTICE_POINTS = 25
"""Number of points in each direction at which the fit is evaluated."""

_EDGE_RINGS = numpy.array([2.0, 3.0, 4.0])
"""Distances from the edge in ring widths at which the rise of the pressure is fitted."""

_MIN_EDGE_RINGS = 5.0
"""Smallest distance from the centre to the edge in ring widths for a fit of the edge."""

_MIN_MARGIN = 1e-6
"""Margin in rad of a contact that comes to the end of the bore without reaching it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactPatch:
    """Pressure of one contact on the grid, with its outline and its largest value.

    Attributes
    ----------
    grid : Grid
    pressure : array (rings, meridians)
        Pressure in MPa.
    level : array (rings, meridians)
        Level in mm: positive in the contact, minus the gap outside, zero near the edge.
    axis : array (3,)
        Unit vector of the load, in the cup's frame.
    inset : float
        Distance of the edge inside the zero of `level`, as a fraction of a ring's width: see `EdgeRelation`.
    """

    grid: Grid
    pressure: Numbers
    level: Numbers
    axis: Numbers
    inset: float

    @cached_property
    def _pressure_interpolator(self) -> RegularGridInterpolator:
        """Interpolator of the pressure over polar angle and azimuth, extrapolated linearly to a loaded rim."""
        p, (last, before) = self.pressure, self.grid.polar[[-1, -2]]
        ratio = (self.grid.reach - last) / (last - before)
        return self._make_interpolator(p, numpy.maximum(p[-1] + ratio * (p[-1] - p[-2]), 0.0) * (p[-1] > 0))

    @cached_property
    def _level_interpolator(self) -> RegularGridInterpolator:
        """Interpolator of the level over polar angle and azimuth, constant between the last ring and the rim."""
        return self._make_interpolator(self.level, self.level[-1])

    def _make_interpolator(self, values: Numbers, at_rim: Numbers) -> RegularGridInterpolator:
        """Make a linear interpolator between cell middles, across the pole and to the end of the bore."""
        half = self.grid.meridians // 2
        beyond = numpy.roll(values[:2][::-1], half, axis=1)
        rows = numpy.vstack([beyond, values, at_rim])
        polar = numpy.concatenate([-self.grid.polar[:2][::-1], self.grid.polar, [self.grid.reach]])
        azimuth = numpy.concatenate(
            [[self.grid.azimuth[-1] - 2 * pi], self.grid.azimuth, [self.grid.azimuth[0] + 2 * pi]]
        )
        columns = numpy.hstack([rows[:, -1:], rows, rows[:, :1]])
        return RegularGridInterpolator((polar, azimuth), columns, bounds_error=False, fill_value=0.0)

    def pressure_at(self, directions: Numbers) -> Numbers:
        """Interpolate the pressure in MPa in directions (..., 3) of the cup's frame; 0 outside contact and bore."""
        return self._pressure_interpolator(_spherical_coordinates(directions)).reshape(directions.shape[:-1])

    def pressure_along(self, angle: Numbers) -> Numbers:
        """Interpolate the pressure in MPa at angles from the load towards the rim, in the plane of load and axis."""
        return self.pressure_at(_ray_directions(self.axis, angle, 0.0 * angle))

    @cached_property
    def largest(self) -> tuple[float, Numbers]:
        """Largest pressure in MPa and the unit vector to it, from a quadratic fit around the cell with the maximum."""
        row, column = numpy.unravel_index(self.pressure.argmax(), self.pressure.shape)
        if not self.pressure[row, column] > 0:
            return 0.0, self.axis
        middle = self.grid.middles[:, row, column]
        first, second = tangents_at(middle)
        radius = _FIT_RADIUS * self.grid.width
        fitted = (numpy.tensordot(middle, self.grid.middles, 1) > numpy.cos(radius)) & (self.pressure > 0)
        points = self.grid.middles[:, fitted]
        fit = _fit_quadratic(first @ points, second @ points, self.pressure[fitted])
        lattice = numpy.linspace(-0.6 * radius, 0.6 * radius, _LATTICE_POINTS)
        s, t = (coordinate.ravel() for coordinate in numpy.meshgrid(lattice, lattice))
        candidates = middle[:, None] + first[:, None] * s + second[:, None] * t
        candidates = candidates / numpy.linalg.norm(candidates, axis=0)
        values = _quadratic_terms(first @ candidates, second @ candidates) @ fit
        values[candidates[2] < numpy.cos(self.grid.reach)] = 0.0
        best = int(values.argmax())
        if values[best] < self.pressure[row, column]:
            return float(self.pressure[row, column]), middle
        return float(values[best]), candidates[:, best]

    @cached_property
    def outline(self) -> Numbers:
        """Edge of the contact, as unit vectors (rays, 3) at the ends of rays from its centre."""
        return _ray_directions(self._contact_centre, self._edge_angles, self._ray_azimuths)

    @property
    def _ray_azimuths(self) -> Numbers:
        """Azimuths in rad of the rays about the centre of the contact."""
        return numpy.arange(_RAYS) * (2 * pi / _RAYS)

    @cached_property
    def _contact_centre(self) -> Numbers:
        """Centre of the contact: direction of the load, or of the largest pressure if the load points outside it."""
        if self.pressure_at(self.axis) > 0:
            return self.axis
        return self.grid.middles.reshape(3, -1)[:, self.pressure.argmax()]

    @cached_property
    def _edge_angles(self) -> Numbers:
        """Angles in rad from the centre to the edge along each ray.

        The edge is the first zero of the level, or the end of the bore. A ray that never leaves a contact all around
        the bore has the angle 0.
        """
        step, azimuths = self.grid.width / 2, self._ray_azimuths
        angles = numpy.arange(1, int(pi / step)) * step
        points = _ray_directions(self._contact_centre, angles[:, None] + 0 * azimuths, azimuths)
        inside = points[..., 2] >= numpy.cos(self.grid.reach)
        outside = ~((self._level_interpolator(_spherical_coordinates(points)) > 0) & inside)
        end = numpy.argmax(outside, axis=0)  # the first step outside
        rim = self._rim_angles(azimuths)
        high = numpy.where(inside[end, numpy.arange(_RAYS)], angles[end], numpy.minimum(angles[end], rim))
        edge = self._bisect_edge(angles[end] - step, high) - self.inset * self.grid.width
        reached = (
            self._level_interpolator(_spherical_coordinates(_ray_directions(self._contact_centre, high, azimuths))) > 0
        )
        ends = numpy.minimum(numpy.where(reached, rim, numpy.maximum(edge, 0.0)), rim)
        return numpy.where(outside.any(axis=0), ends, 0.0)

    def _bisect_edge(self, low: Numbers, high: Numbers) -> Numbers:
        """Find the zero of the level on each ray in rad, by bisection between angles inside and outside."""
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            loaded = (
                self._level_interpolator(
                    _spherical_coordinates(_ray_directions(self._contact_centre, middle, self._ray_azimuths))
                )
                > 0
            )
            low, high = numpy.where(loaded, middle, low), numpy.where(loaded, high, middle)
        return (low + high) / 2

    def _rim_angles(self, azimuths: Numbers) -> Numbers:
        """Compute the angles in rad from the centre to the end of the bore along rays; infinite if a ray misses it."""
        # z = cos out z(0) + sin out z(90°) = A cos(out - a)
        start, side = (
            _ray_directions(self._contact_centre, numpy.full(_RAYS, angle), azimuths)[:, 2] for angle in (0.0, pi / 2)
        )
        cosine = numpy.cos(self.grid.reach) / numpy.hypot(start, side)
        ends = numpy.arctan2(side, start) + numpy.arccos(numpy.clip(cosine, -1, 1))
        return numpy.where(abs(cosine) < 1, ends, numpy.inf)

    @cached_property
    def half_angle(self) -> float:
        """Half angle in rad of a round contact of the same area.

        The solid angle in the outline is 2π (1 - cos ε).

        A contact that the load does not point into, a ring around a preloaded ball, has the area of its cells.
        """
        if self.pressure_at(self.axis) == 0:
            solid_angle = float(((self.pressure > 0) * self.grid.areas).sum())
            return float(numpy.arccos(numpy.clip(1 - solid_angle / (2 * pi), -1.0, 1.0)))
        return float(numpy.arccos(numpy.clip(numpy.cos(self._edge_angles).mean(), -1.0, 1.0)))

    def edge_constant(self, exponent: float) -> float:
        """Compute the mean over the edge of p/s^n for a distance s (rad) to it; NaN in a contact of few rings.

        A power p^(1/n) of the pressure is smooth there. A parabola through three points of each ray has its slope.
        """
        rays = self._edge_angles > _MIN_EDGE_RINGS * self.grid.width
        rays &= self._edge_angles < self._rim_angles(self._ray_azimuths) - self.grid.width
        if not rays.any():
            return nan
        edge, azimuths = self._edge_angles[rays], self._ray_azimuths[rays]
        distance = self.grid.width * _EDGE_RINGS[:, None] + 0 * edge
        power = self.pressure_at(_ray_directions(self._contact_centre, edge - distance, azimuths)) ** (1 / exponent)
        slope = numpy.polynomial.polynomial.polyfit(distance[:, 0], power, 2)[1]
        return float((numpy.maximum(slope, 0.0) ** exponent).mean())

    @cached_property
    def edge_loaded(self) -> bool:
        """True if there is pressure at the end of the bore."""
        return bool((self.pressure[-1] > 0).any())

    @cached_property
    def edge_margin(self) -> float:
        """Smallest angle in rad from the contact's edge to the end of the bore; 0 if the contact reaches it.

        On every meridian the edge lies between the last loaded cell and the first open one. A parabola through the
        furthest meridian and its neighbours gives the furthest point.
        """
        if self.edge_loaded:
            return 0.0
        edges = self._polar_edges
        furthest = int(edges.argmax())
        before, middle, after = edges[numpy.arange(furthest - 1, furthest + 2) % len(edges)]
        bend = 2 * middle - before - after
        rise = (after - before) ** 2 / (8 * bend) if bend > 0 else 0.0
        return float(max(self.grid.reach - middle - rise, _MIN_MARGIN))

    @property
    def _polar_edges(self) -> Numbers:
        """Polar angles in rad of the contact's edge towards the rim, (meridians,); 0 on a meridian without contact."""
        loaded, last = self.level > 0, self.grid.rings - 1
        ring, column = last - loaded[::-1].argmax(axis=0), numpy.arange(self.grid.meridians)
        after = numpy.minimum(ring + 1, last)
        inner, outer = self.level[ring, column], self.level[after, column]
        nodes = self.grid.polar - self.inset * numpy.diff(self.grid.edges)
        nodes[-1] = self.grid.reach  # the contact reaches the rim when the last ring is loaded
        fraction = numpy.divide(inner, inner - outer, out=numpy.zeros_like(inner), where=inner > outer)
        return numpy.where(loaded.any(axis=0), nodes[ring] + fraction * (nodes[after] - nodes[ring]), 0.0)


def _spherical_coordinates(directions: Numbers) -> Numbers:
    """Compute polar angles and azimuths in rad (..., 2) of directions (..., 3)."""
    components = numpy.moveaxis(directions, -1, 0)
    azimuth = numpy.arctan2(components[1], components[0]) % (2 * pi)
    return numpy.stack([polar_angle(components), azimuth], axis=-1)


def _ray_directions(centre: Numbers, angle: Numbers, azimuth: Numbers) -> Numbers:
    """Compute unit vectors (..., 3) at angles (rad) from a centre, on rays at azimuths (rad) about it.

    The ray of azimuth 0 lies in the plane of the centre and the cup's axis, away from the pole.
    """
    first, second = tangents_at(centre)
    side = numpy.cos(azimuth)[..., None] * first + numpy.sin(azimuth)[..., None] * second
    ray: Numbers = numpy.cos(angle)[..., None] * centre + numpy.sin(angle)[..., None] * side
    return ray


def tangents_at(axis: Numbers) -> tuple[Numbers, Numbers]:
    """Compute two unit vectors perpendicular to an axis: away from the pole, and along the ring of the axis."""
    polar, azimuth = float(polar_angle(axis)), float(numpy.arctan2(axis[1], axis[0]))
    along_ring = numpy.array([-numpy.sin(azimuth), numpy.cos(azimuth), 0.0])
    return unit_vectors(numpy.asarray(polar + pi / 2), numpy.asarray(azimuth)), along_ring


def _quadratic_terms(s: Numbers, t: Numbers) -> Numbers:
    """Compute the terms 1, s, t, s², s t, t² of a quadratic polynomial: (..., 6)."""
    return numpy.stack([numpy.ones_like(s), s, t, s * s, s * t, t * t], axis=-1)


def _fit_quadratic(s: Numbers, t: Numbers, values: Numbers) -> Numbers:
    """Fit the six coefficients of a quadratic polynomial in s and t to values, by least squares."""
    return numpy.linalg.lstsq(_quadratic_terms(s, t), values, rcond=None)[0]
