"""One contact on the grid: its pressure between the cells, where it is largest, and where it ends."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy
from scipy.interpolate import RegularGridInterpolator

from ...core.arrays import Numbers
from .directions import polar_angle, unit_vectors
from .grid import Grid

_RAYS = 90
_BISECTIONS = 8
_NEAR = 2.2  # widths of a ring: cells that far tell where the largest pressure is
_LATTICE = 25

_LEAST_MARGIN = 1e-6
"""Margin in rad of a contact that comes to the end of the bore without reaching it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Patch:
    """The pressure of one contact.

    Attributes
    ----------
    grid : Grid
    pressure : array (rings, meridians)
        In MPa.
    level : array (rings, meridians)
        In mm, positive in the contact, minus the gap outside; zero near the edge.
    axis : array (3,)
        Unit vector of the load, in the cup's frame.
    inset : float
        Distance of the edge inside the zero of `level`, as a share of a ring's width: see `Edges`.
    """

    grid: Grid
    pressure: Numbers
    level: Numbers
    axis: Numbers
    inset: float

    @cached_property
    def _between(self) -> RegularGridInterpolator:
        p, (last, before) = self.pressure, self.grid.polar[[-1, -2]]
        share = (self.grid.reach - last) / (last - before)
        return self._linear(p, numpy.maximum(p[-1] + share * (p[-1] - p[-2]), 0.0) * (p[-1] > 0))

    @cached_property
    def _levels(self) -> RegularGridInterpolator:
        return self._linear(self.level, self.level[-1])

    def _linear(self, values: Numbers, at_rim: Numbers) -> RegularGridInterpolator:
        """Interpolate linearly between cell middles, across the pole and to the end of the bore."""
        half = self.grid.meridians // 2
        beyond = numpy.roll(values[:2][::-1], half, axis=1)
        rows = numpy.vstack([beyond, values, at_rim])
        polar = numpy.concatenate([-self.grid.polar[:2][::-1], self.grid.polar, [self.grid.reach]])
        azimuth = numpy.concatenate(
            [[self.grid.azimuth[-1] - 2 * pi], self.grid.azimuth, [self.grid.azimuth[0] + 2 * pi]]
        )
        columns = numpy.hstack([rows[:, -1:], rows, rows[:, :1]])
        return RegularGridInterpolator((polar, azimuth), columns, bounds_error=False, fill_value=0.0)

    def at(self, directions: Numbers) -> Numbers:
        """The pressure in MPa in directions (..., 3) of the cup's frame; 0 outside the contact and the bore."""
        return self._between(_angles(directions)).reshape(directions.shape[:-1])

    def along(self, angle: Numbers) -> Numbers:
        """The pressure in MPa at angles from the load, in the plane of load and cup's axis towards the rim."""
        return self.at(_ray(self.axis, angle, 0.0 * angle))

    @cached_property
    def largest(self) -> tuple[float, Numbers]:
        """The largest pressure in MPa, and the unit vector to where it is."""
        row, column = numpy.unravel_index(self.pressure.argmax(), self.pressure.shape)
        if not self.pressure[row, column] > 0:
            return 0.0, self.axis
        middle = self.grid.middles[:, row, column]
        first, second = _across(middle)
        reach = _NEAR * self.grid.width
        near = (numpy.tensordot(middle, self.grid.middles, 1) > numpy.cos(reach)) & (self.pressure > 0)
        points = self.grid.middles[:, near]
        fit = _quadratic(first @ points, second @ points, self.pressure[near])
        places = numpy.linspace(-0.6 * reach, 0.6 * reach, _LATTICE)
        s, t = (each.ravel() for each in numpy.meshgrid(places, places))
        there = middle[:, None] + first[:, None] * s + second[:, None] * t
        there = there / numpy.linalg.norm(there, axis=0)
        values = _terms(first @ there, second @ there) @ fit
        values[there[2] < numpy.cos(self.grid.reach)] = 0.0
        best = int(values.argmax())
        if values[best] < self.pressure[row, column]:
            return float(self.pressure[row, column]), middle
        return float(values[best]), there[:, best]

    @cached_property
    def outline(self) -> Numbers:
        """Unit vectors (rays, 3) to the edge of the contact, where rays from its middle leave it."""
        return _ray(self._middle, self._edges, self._turns)

    @property
    def _turns(self) -> Numbers:
        return numpy.arange(_RAYS) * (2 * pi / _RAYS)

    @cached_property
    def _middle(self) -> Numbers:
        """Where the load points; of a contact that lies beside it the cell of the largest pressure."""
        if self.at(self.axis) > 0:
            return self.axis
        return self.grid.middles.reshape(3, -1)[:, self.pressure.argmax()]

    @cached_property
    def _edges(self) -> Numbers:
        """Angles from the middle to the edge along each ray: the first zero of the level, or the end of the bore.

        A ray that never leaves a contact all around the bore has the angle 0.
        """
        step, turns = self.grid.width / 2, self._turns
        out = numpy.arange(1, int(pi / step)) * step
        points = _ray(self._middle, out[:, None] + 0 * turns, turns)
        inside = points[..., 2] >= numpy.cos(self.grid.reach)
        outside = ~((self._levels(_angles(points)) > 0) & inside)
        end = numpy.argmax(outside, axis=0)  # the first step outside
        rim = self._rims(turns)
        high = numpy.where(inside[end, numpy.arange(_RAYS)], out[end], numpy.minimum(out[end], rim))
        edge = self._crossing(out[end] - step, high) - self.inset * self.grid.width
        reached = self._levels(_angles(_ray(self._middle, high, turns))) > 0
        ends = numpy.minimum(numpy.where(reached, rim, numpy.maximum(edge, 0.0)), rim)
        return numpy.where(outside.any(axis=0), ends, 0.0)

    def _crossing(self, low: Numbers, high: Numbers) -> Numbers:
        """Bisect each ray between an angle inside the contact and one outside."""
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            loaded = self._levels(_angles(_ray(self._middle, middle, self._turns))) > 0
            low, high = numpy.where(loaded, middle, low), numpy.where(loaded, high, middle)
        return (low + high) / 2

    def _rims(self, turns: Numbers) -> Numbers:
        """Angles from the middle to where the bore ends along each ray; infinite where it does not."""
        # z = cos out z(0) + sin out z(90°) = A cos(out - a)
        start, side = (_ray(self._middle, numpy.full(_RAYS, each), turns)[:, 2] for each in (0.0, pi / 2))
        share = numpy.cos(self.grid.reach) / numpy.hypot(start, side)
        ends = numpy.arctan2(side, start) + numpy.arccos(numpy.clip(share, -1, 1))
        return numpy.where(abs(share) < 1, ends, numpy.inf)

    @cached_property
    def half_angle(self) -> float:
        """Half angle in rad of a round contact of the same area: 2π (1 - cos ε) is the solid angle in the outline.

        A contact that the load does not point into, a ring around a preloaded ball, has the area of its cells.
        """
        if self.at(self.axis) == 0:
            solid = float(((self.pressure > 0) * self.grid.areas).sum())
            return float(numpy.arccos(numpy.clip(1 - solid / (2 * pi), -1.0, 1.0)))
        return float(numpy.arccos(numpy.clip(numpy.cos(self._edges).mean(), -1.0, 1.0)))

    @cached_property
    def edge_loaded(self) -> bool:
        """Whether there is pressure where the bore ends."""
        return bool((self.pressure[-1] > 0).any())

    @cached_property
    def edge_margin(self) -> float:
        """Smallest angle (rad) from the contact's edge to the end of the bore; 0 if the contact reaches it.

        On every meridian the edge lies between the last loaded cell and the first open one; a parabola through the
        furthest meridian and its neighbours gives the furthest point.
        """
        if self.edge_loaded:
            return 0.0
        edges = self._polar_edges
        furthest = int(edges.argmax())
        before, middle, after = edges[numpy.arange(furthest - 1, furthest + 2) % len(edges)]
        bend = 2 * middle - before - after
        between = (after - before) ** 2 / (8 * bend) if bend > 0 else 0.0
        return float(max(self.grid.reach - middle - between, _LEAST_MARGIN))

    @property
    def _polar_edges(self) -> Numbers:
        """Polar angles of the contact's edge towards the rim, (meridians,); 0 on a meridian without contact."""
        loaded, last = self.level > 0, self.grid.rings - 1
        ring, column = last - loaded[::-1].argmax(axis=0), numpy.arange(self.grid.meridians)
        after = numpy.minimum(ring + 1, last)
        one, other = self.level[ring, column], self.level[after, column]
        nodes = self.grid.polar - self.inset * numpy.diff(self.grid.edges)
        nodes[-1] = self.grid.reach  # the contact reaches the rim when the last ring is loaded
        share = numpy.divide(one, one - other, out=numpy.zeros_like(one), where=one > other)
        return numpy.where(loaded.any(axis=0), nodes[ring] + share * (nodes[after] - nodes[ring]), 0.0)


def _angles(directions: Numbers) -> Numbers:
    """Polar angle and azimuth (..., 2) of directions."""
    first = numpy.moveaxis(directions, -1, 0)
    return numpy.stack([polar_angle(first), numpy.arctan2(first[1], first[0]) % (2 * pi)], axis=-1)


def _ray(middle: Numbers, out: Numbers, turns: Numbers) -> Numbers:
    """Unit vectors at angles from another, on rays that turn around it from its plane with the cup's axis."""
    first, second = _across(middle)
    side = numpy.cos(turns)[..., None] * first + numpy.sin(turns)[..., None] * second
    ray: Numbers = numpy.cos(out)[..., None] * middle + numpy.sin(out)[..., None] * side
    return ray


def _across(axis: Numbers) -> tuple[Numbers, Numbers]:
    """Two unit vectors across an axis: away from the pole in its meridian, and around it."""
    polar, azimuth = float(polar_angle(axis)), float(numpy.arctan2(axis[1], axis[0]))
    around = numpy.array([-numpy.sin(azimuth), numpy.cos(azimuth), 0.0])
    return unit_vectors(numpy.asarray(polar + pi / 2), numpy.asarray(azimuth)), around


def _terms(s: Numbers, t: Numbers) -> Numbers:
    return numpy.stack([numpy.ones_like(s), s, t, s * s, s * t, t * t], axis=-1)


def _quadratic(s: Numbers, t: Numbers, values: Numbers) -> Numbers:
    return numpy.linalg.lstsq(_terms(s, t), values, rcond=None)[0]
