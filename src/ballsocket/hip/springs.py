"""A socket of radial springs under a whole cycle of loads at once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy

from ..core.arrays import Numbers
from ..elasticity.off_axis.directions import magnitudes_and_directions
from ..elasticity.off_axis.gap import initial_displacement
from ..elasticity.off_axis.grid import Grid
from .contact_shares import contact_shares, grid_neighbours, subset_neighbours

_ROUNDS = 60
TOLERANCE = 1e-8
FREE = numpy.zeros((3, 3))
"""Of the load, where the balance is good; and the stiffness of a ball that no spring of its cycle holds."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Rest:
    """Balls at rest, one for each load.

    Attributes
    ----------
    displacement : array (loads, 3)
        Of the ball's centre in mm, in the cup's frame.
    pressure : array (loads, cells)
        In MPa.
    settled : bool
        Whether every load is balanced.
    levels : pair of arrays, optional
        Displacements and pressures of the loads that were solved, where those are not all.
    """

    displacement: Numbers
    pressure: Numbers
    settled: bool
    levels: tuple[Numbers, Numbers] | None = None


class CycleBed(Protocol):
    """A bore under a whole cycle of loads at once, in cells."""

    @property
    def clearance(self) -> float: ...
    @property
    def socket_radius(self) -> float: ...
    @property
    def directions(self) -> Numbers: ...
    @property
    def normals(self) -> Numbers: ...
    @property
    def areas(self) -> Numbers: ...
    @property
    def stiffest(self) -> float: ...
    def part(self, cells: Numbers) -> CycleBed: ...
    def near(self, rest: Rest, depth: Numbers, margin: float) -> Numbers: ...
    def rest(self, loads: Numbers, depth: Numbers, start: Rest | None = None, tether: Numbers = FREE) -> Rest: ...
    def smoothed(self, depth: Numbers) -> Numbers: ...
    @property
    def inset(self) -> float: ...
    def edge_field(self, rest: Rest, depth: Numbers) -> Numbers: ...
    def contact_shares(self, rest: Rest, depth: Numbers) -> Numbers: ...


def spring_bed(grid: Grid, modulus: float, clearance: float, socket_radius: float) -> SpringBed:
    """A bore of springs in the cells of a grid; see `SpringBed`."""
    return SpringBed(
        directions=numpy.ascontiguousarray(grid.middles.reshape(3, -1)),
        normals=numpy.ascontiguousarray(grid.normals.reshape(3, -1)),
        areas=numpy.repeat(grid.areas[:, 0], grid.meridians) * socket_radius**2,
        modulus=modulus,
        clearance=clearance,
        socket_radius=socket_radius,
        neighbours=grid_neighbours(grid),
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringBed:
    """A bore of springs that know nothing of each other, p = K max(u, 0), u = e·n - c - h.

    Attributes
    ----------
    directions, normals : array (3, cells)
        Unit vectors to the middles of the cells, and the means of the outward normal over them, in the cup's frame.
    areas : array (cells,)
        In mm².
    modulus : float
        K in MPa/mm.
    clearance, socket_radius : float
        In mm.
    neighbours : array (2, 2, cells)
        Numbers of the neighbouring cells; see `grid_neighbours`.
    """

    directions: Numbers
    normals: Numbers
    areas: Numbers
    modulus: float
    clearance: float
    socket_radius: float
    neighbours: Numbers

    def part(self, cells: Numbers) -> SpringBed:
        """Some of the cells alone."""
        return replace(
            self,
            directions=self.directions[:, cells],
            normals=self.normals[:, cells],
            areas=self.areas[cells],
            neighbours=subset_neighbours(self.neighbours, cells),
        )

    def near(self, rest: Rest, depth: Numbers, margin: float) -> Numbers:
        """The cells that any of the displaced balls touches, or would if their overlap were larger by a share."""
        overlap = (rest.displacement @ self.normals).max(axis=0, initial=0.0) - self.clearance - depth
        found: Numbers = overlap > -margin * float(overlap.max())
        return found

    def smoothed(self, depth: Numbers) -> Numbers:
        """A depth as it is: springs carry every wave of the grid alike."""
        return depth

    @property
    def inset(self) -> float:
        """Distance of the edge inside the zero of `edge_field`, as a share of a cell: 0 on springs."""
        return 0.0

    def edge_field(self, rest: Rest, depth: Numbers) -> Numbers:
        """Compute the overlap in mm, with 0 at the edge of the contacts: (loads, cells)."""
        return rest.displacement @ self.normals - self.clearance - depth

    def contact_shares(self, rest: Rest, depth: Numbers) -> Numbers:
        """Compute the share of each cell that is in contact, from 0 to 1: (loads, cells)."""
        return contact_shares(self.edge_field(rest, depth), self.neighbours, self.inset)

    @property
    def stiffest(self) -> float:
        """The largest change of a pressure by the depth of a wave, in MPa/mm."""
        return self.modulus

    @cached_property
    def _outward(self) -> Numbers:
        """From pressures to forces in N: (cells, 3)."""
        return (self.normals * self.areas).T.copy()

    @cached_property
    def _products(self) -> Numbers:
        """n nᵀ dA of the cells: (cells, 9)."""
        n = self.normals
        return (n[:, None] * n[None] * self.areas).reshape(9, -1).T.copy()

    def rest(self, loads: Numbers, depth: Numbers, start: Rest | None = None, tether: Numbers = FREE) -> Rest:
        """Where balls come to rest under loads.

        Parameters
        ----------
        loads : array (loads, 3)
            In N, in the cup's frame, none of them zero.
        depth : array (cells,)
            Of the worn bore below the sphere in mm.
        start : Rest, optional
            To begin with.
        tether : array (3, 3)
            In N/mm: so much less of the loads is left by where the ball has moved.
        """
        e = (
            initial_displacement(self, self.modulus, depth, *magnitudes_and_directions(loads))
            if start is None
            else start.displacement
        )
        allowed = TOLERANCE * numpy.linalg.norm(loads, axis=1)
        lost = numpy.inf
        for _ in range(_ROUNDS):
            overlap = e @ self.normals
            overlap -= self.clearance + depth
            touching = (overlap > 0).astype(float)
            pressure = numpy.maximum(overlap, 0.0, out=overlap)
            pressure *= self.modulus
            missing = loads - e @ tether - pressure @ self._outward
            lost = float((numpy.linalg.norm(missing, axis=1) / allowed).max(initial=0.0))
            if lost <= 1:
                break
            e = e + self._step(touching, missing, loads, tether)
        return Rest(displacement=e, pressure=pressure, settled=lost <= 1)

    def _step(self, touching: Numbers, missing: Numbers, loads: Numbers, tether: Numbers) -> Numbers:
        """Newton's step; a ball that has lost its bore moves on along its load."""
        tangent = self.modulus * (touching @ self._products).reshape(-1, 3, 3)
        trace = numpy.trace(tangent, axis1=1, axis2=2)
        apart = trace <= 0
        tangent += tether
        solid = numpy.where(apart, 1.0, 1e-12 * trace)
        step = numpy.linalg.solve(tangent + solid[:, None, None] * numpy.eye(3), missing[:, :, None])[:, :, 0]
        along = loads / numpy.linalg.norm(loads, axis=1)[:, None]
        return numpy.where(apart[:, None], (self.clearance + 1e-3 * self.socket_radius) * along, step)
