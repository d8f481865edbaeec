"""Where the ball comes to rest: the displacement under which the pressures balance a load, by Newton's method."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy

from ..arrays import Numbers
from .balance import balanced
from .compliance import Compliance
from .gap import Separation
from .solver import answers, pressed


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
    """A bore with a ball in it: a compliance and a gap."""

    compliance: Compliance
    separation: Separation

    @property
    def area(self) -> float:
        """Area on the bore over that on a sphere of radius 1, in mm²."""
        return self.separation.socket_radius**2

    @cached_property
    def coarser(self) -> Bed | None:
        """The same in cells twice as wide; None where these are wide already."""
        soft = self.compliance.coarser
        return None if soft is None else Bed(compliance=soft, separation=self.separation.on(soft.grid))

    def spread(self, fields: Numbers) -> Numbers:
        """Fields (..., rings, meridians) of the coarser cells in these."""
        return self.compliance.grid.spread(fields)

    def force(self, pressure: Numbers) -> Numbers:
        """The load in N that pressures (batch, rings, meridians) carry: (batch, 3)."""
        grid = self.compliance.grid
        return self.area * numpy.einsum("bij,kij,i->bk", pressure, grid.normals, grid.areas[:, 0], optimize=True)

    def at(self, displacement: Numbers) -> Rest:
        """The contacts of displaced balls."""
        made = pressed(self.compliance, self.separation.overlap(displacement))
        return Rest(displacement=displacement, pressure=made.pressure, found=made.settled)

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
        """The stiffness in N/mm: (batch, 3, 3)."""
        grid = self.compliance.grid
        return self.area * numpy.einsum("blij,kij,i->bkl", stretched, grid.normals, grid.areas[:, 0], optimize=True)

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
        if held.any():
            preload = self.area * self.compliance.evenly * max(-self.separation.clearance, 0.0)
            size = numpy.maximum(numpy.linalg.norm(load[held], axis=1), preload)
            some = balanced(self, load[held], size, start[held], None if pressure is None else pressure[held])
            rest.displacement[held], rest.pressure[held], rest.found[held] = some.place, some.pressure, some.found
        return rest

    def _empty(self, count: int) -> Numbers:
        grid = self.compliance.grid
        return numpy.zeros((count, grid.rings, grid.meridians))
