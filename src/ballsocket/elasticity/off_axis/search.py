"""Where the ball comes to rest: the displacement under which the pressures balance a load, by Newton's method."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy

from ...core.arrays import Numbers
from .balance import balanced
from .compliance import Compliance
from .gap import Separation
from .solver import answers, pressed

_NEAR = 150_000
"""Cells of contacts that are solved side by side: more do not stay in the processor's cache."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Rest:
    """Balls at rest side by side.

    Attributes
    ----------
    displacement : array (batch, 3)
        Of the ball's centre in mm, in the cup's frame.
    pressure : array (batch, rings, meridians)
        In MPa.
    found : array of bool (batch,)
    """

    displacement: Numbers
    pressure: Numbers
    found: Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class Bed:
    """A bore with a ball in it: a compliance and a gap.

    Attributes
    ----------
    compliance : Compliance
    separation : Separation
    tether : array (3, 3)
        A stiffness in N/mm that holds the ball beside the bore; none by default.
    """

    compliance: Compliance
    separation: Separation
    tether: Numbers = field(default_factory=lambda: numpy.zeros((3, 3)))

    @property
    def area(self) -> float:
        """Area on the bore over that on a sphere of radius 1, in mm²."""
        return self.separation.socket_radius**2

    @cached_property
    def _outward(self) -> Numbers:
        """From pressures of cells to forces in N: (cells, 3)."""
        grid = self.compliance.grid
        return numpy.ascontiguousarray((self.area * grid.normals * grid.areas).reshape(3, -1).T)

    @cached_property
    def coarser(self) -> Bed | None:
        """This bed in cells twice as wide; None where these are wide already."""
        soft = self.compliance.coarser
        return None if soft is None else replace(self, compliance=soft, separation=self.separation.on(soft.grid))

    def spread(self, fields: Numbers) -> Numbers:
        """Fields (..., rings, meridians) of the coarser cells in these."""
        return self.compliance.grid.spread(fields)

    def force(self, pressure: Numbers) -> Numbers:
        """The load in N that pressures (batch, rings, meridians) carry: (batch, 3)."""
        force: Numbers = pressure.reshape(len(pressure), len(self._outward)) @ self._outward
        return force

    def at(self, displacement: Numbers) -> Rest:
        """The contacts of displaced balls."""
        pressure, found = self._empty(len(displacement)), numpy.zeros(len(displacement), dtype=bool)
        for some in self._blocks(numpy.arange(len(displacement))):
            made = pressed(self.compliance, self.separation.overlap(displacement[some]))
            pressure[some], found[some] = made.pressure, made.settled
        return Rest(displacement=displacement, pressure=pressure, found=found)

    def stretched(
        self, displacement: Numbers, pressure: Numbers, start: Numbers | None = None, tolerance: float = 0.1
    ) -> Numbers:
        """Change of the pressures by the displacement: (batch, 3, rings, meridians) in MPa/mm."""
        shape = (len(pressure), 3, *pressure.shape[1:])
        asked = numpy.broadcast_to(self.separation.slope(displacement), shape).reshape(-1, *shape[2:])
        touching = numpy.broadcast_to((pressure > 0)[:, None], shape).reshape(-1, *shape[2:])
        begin = None if start is None else start.reshape(-1, *shape[2:])
        return answers(self.compliance, touching, asked, begin, tolerance).reshape(shape)

    def tangent(self, stretched: Numbers) -> Numbers:
        """The stiffness of bore and tether in N/mm: (batch, 3, 3)."""
        tangent = stretched.reshape(len(stretched), 3, len(self._outward)) @ self._outward
        return tangent.swapaxes(1, 2) + self.tether

    def under(self, load: Numbers, start: Numbers, held: Numbers, pressure: Numbers | None = None) -> Rest:
        """Balls at rest under loads.

        Parameters
        ----------
        load : array (batch, 3)
            In N, in the cup's frame, none of them zero.
        start : array (batch, 3)
            Displacements to begin with, in mm, that touch.
        held : array of bool (batch,)
            Those that are asked for; the others stay where they are.
        pressure : array (batch, rings, meridians), optional
            Pressures to begin with, none of them negative.
        """
        rest = Rest(displacement=start.copy(), pressure=self._empty(len(load)), found=held & False)
        preload = self.area * self.compliance.evenly * max(-self.separation.clearance, 0.0)
        size = numpy.maximum(numpy.linalg.norm(load, axis=1), preload)
        for some in self._blocks(numpy.flatnonzero(held)):
            begin = None if pressure is None else pressure[some]
            found = balanced(self, load[some], size[some], start[some], begin)
            rest.displacement[some], rest.pressure[some], rest.found[some] = found.place, found.pressure, found.found
        return rest

    def _blocks(self, places: Numbers) -> list[Numbers]:
        """Places cut so that what is computed side by side stays near the processor."""
        grid = self.compliance.grid
        size = max(_NEAR // (grid.rings * grid.meridians), 1)
        return [places[i : i + size] for i in range(0, len(places), size)]

    def _empty(self, count: int) -> Numbers:
        grid = self.compliance.grid
        return numpy.zeros((count, grid.rings, grid.meridians))
