"""Where the ball comes to rest: the displacement under which the pressures balance a load, by Newton's method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..arrays import Numbers
from .compliance import Compliance
from .gap import Separation
from .solver import TOLERANCE, answers, pressed

_ROUNDS = 40
_LOOSE = 1e-2
_CLOSE = 1e-6  # of the load: where the balance is good


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
            some = self._under(load[held], start[held], None if pressure is None else pressure[held])
            for whole, part in zip((rest.displacement, rest.pressure, rest.found), some, strict=True):
                whole[held] = part
        return rest

    def _empty(self, count: int) -> Numbers:
        grid = self.compliance.grid
        return numpy.zeros((count, grid.rings, grid.meridians))

    def _under(self, load: Numbers, start: Numbers, pressure: Numbers | None) -> tuple[Numbers, Numbers, Numbers]:
        preload = self.area * self.compliance.evenly * max(-self.separation.clearance, 0.0)
        size = numpy.maximum(numpy.linalg.norm(load, axis=1), preload)
        e, p, q = start.copy(), pressure, None
        misses, found = numpy.full(len(load), numpy.inf), numpy.zeros(len(load), dtype=bool)
        tolerance = numpy.full(len(load), _LOOSE)
        for _ in range(_ROUNDS):
            overlap = self.separation.overlap(e)
            made = pressed(self.compliance, overlap, p, tolerance)
            missing, before = load - self.force(made.pressure), misses
            misses = numpy.linalg.norm(missing, axis=1) / size
            found = made.settled & (misses <= _CLOSE) & (tolerance <= TOLERANCE)
            if found.all():
                break
            q = self.stretched(e, made.pressure, q)
            step = self._step(q, missing, e) * numpy.where(misses > 0.9 * before, 0.5, 1.0)[:, None]
            apart = numpy.minimum(overlap.max(axis=(1, 2)), 0.0) / size  # a ball that has lost its bore goes back to it
            step = numpy.where(apart[:, None] < 0, -1.1 * apart[:, None] * load, step)
            e = numpy.where(found[:, None], e, e + step)
            p = numpy.maximum(made.pressure + numpy.einsum("bk,bkij->bij", step, q), 0.0)
            tolerance = numpy.clip(misses**2, TOLERANCE, _LOOSE)
        return e, made.pressure, found

    def _step(self, stretched: Numbers, missing: Numbers, displacement: Numbers) -> Numbers:
        """Newton's step, shorter where it would lose the contact."""
        tangent = self.tangent(stretched)
        trace = numpy.trace(tangent, axis1=1, axis2=2)[:, None, None]
        solid = numpy.where(trace > 0, _SOLID * trace, 1.0) * numpy.eye(3)
        step: Numbers = numpy.linalg.solve(tangent + solid, missing[:, :, None])[:, :, 0]
        depth = numpy.linalg.norm(displacement, axis=1) - self.separation.clearance
        moved = numpy.linalg.norm(displacement + step, axis=1) - self.separation.clearance
        share = numpy.where(moved < depth / 4, 0.75 * depth / numpy.maximum(depth - moved, 1e-300), 1.0)
        return step * share[:, None]


_SOLID = 1e-12
"""Of the trace of a stiffness, added to each direction: one in which nothing pushes back stays solvable."""
