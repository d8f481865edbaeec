"""A bore of full elasticity under a whole cycle of loads: a closed shell, or the cup as it is built."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy

from ..core.arrays import Numbers
from ..elasticity.finite_elements.shapes import socket_shape
from ..elasticity.off_axis.bore_contact import BoreContact
from ..elasticity.off_axis.bore_contact import EquilibriumBatch as BedRest
from ..elasticity.off_axis.compliance import Compliance, make_compliance
from ..elasticity.off_axis.directions import magnitudes_and_directions
from ..elasticity.off_axis.equilibrium import solve_force
from ..elasticity.off_axis.gap import GapField, initial_displacement
from ..elasticity.off_axis.grid import Grid, even_grid
from ..elasticity.off_axis.surfaces import ClosedShell, EdgeRelation, RealCup
from ..problem import Joint
from ..problem.cup import Cup
from ..problem.gaps import LinearGap
from .contact_shares import contact_shares, grid_neighbours
from .levels import Levels, each_of, levels_of
from .smoothing import Smoothing
from .springs import FREE, Rest

_POWER = 60
_SEED = 1
_DEEPER = 1.0, 1.2


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticBed:
    """A bore whose cells know of each other.

    Attributes
    ----------
    compliance : Compliance
    clearance, socket_radius : float
        In mm.
    edges : EdgeRelation
        Relation of pressure and gap at the edge of a contact.
    """

    compliance: Compliance
    clearance: float
    socket_radius: float
    edges: EdgeRelation

    @property
    def grid(self) -> Grid:
        return self.compliance.grid

    @cached_property
    def directions(self) -> Numbers:
        """Unit vectors to the middles of the cells, in the cup's frame: (3, cells)."""
        return numpy.ascontiguousarray(self.grid.middles.reshape(3, -1))

    @cached_property
    def normals(self) -> Numbers:
        """Means of the outward normal over the cells: (3, cells)."""
        return numpy.ascontiguousarray(self.grid.normals.reshape(3, -1))

    @cached_property
    def areas(self) -> Numbers:
        """Areas of the cells in mm²: (cells,)."""
        return numpy.repeat(self.grid.areas[:, 0], self.grid.meridians) * self.socket_radius**2

    @cached_property
    def _smoothing(self) -> Smoothing:
        return Smoothing(grid=self.grid)

    def smoothed(self, depth: Numbers) -> Numbers:
        """A depth without what the grid cannot carry, of the same volume: (cells,)."""
        return self._smoothing(depth.reshape(self.grid.rings, -1)).ravel()

    @cached_property
    def stiffest(self) -> float:
        """The largest change of a pressure by the depth of a wave that is left after smoothing, in MPa/mm."""
        field = numpy.random.default_rng(_SEED).normal(size=(1, self.grid.rings, self.grid.meridians))
        growth = 0.0
        for _ in range(_POWER):
            field = field / numpy.linalg.norm(field)
            field = self._smoothing(self.compliance.pressure(field))
            growth = float(numpy.linalg.norm(field))
        return growth

    def part(self, cells: Numbers) -> ElasticBed:
        """All of them: they know of each other."""
        return self

    def near(self, rest: Rest, depth: Numbers, margin: float) -> Numbers:
        """All cells."""
        return numpy.ones(len(self.areas), dtype=bool)

    @property
    def inset(self) -> float:
        """Distance of the edge inside the zero of `edge_field`, as a share of a ring."""
        return self.edges.inset

    def edge_field(self, rest: Rest, depth: Numbers) -> Numbers:
        """Compute the levels in mm, with 0 at the edge of the contacts: (loads, cells)."""
        shape = (len(rest.pressure), self.grid.rings, self.grid.meridians)
        pressure = rest.pressure.reshape(shape)
        overlap = rest.displacement @ self.normals - self.clearance - depth
        gap = self.compliance.displacement(pressure) - overlap.reshape(shape)
        return self.edges.levels(pressure, gap).reshape(rest.pressure.shape)

    @cached_property
    def _neighbours(self) -> Numbers:
        return grid_neighbours(self.grid)

    def contact_shares(self, rest: Rest, depth: Numbers) -> Numbers:
        """Compute the share of each cell that is in contact, from 0 to 1: (loads, cells)."""
        return contact_shares(self.edge_field(rest, depth), self._neighbours, self.inset)

    def rest(self, loads: Numbers, depth: Numbers, start: Rest | None = None, tether: Numbers = FREE) -> Rest:
        """Where balls come to rest under loads; see `SpringBed.rest`.

        Loads of one direction are solved at a few sizes, with straight lines between: those carry the load as it is.
        """
        levels = levels_of(loads) if not tether.any() else each_of(loads)
        shape = (len(levels.loads), self.grid.rings, self.grid.meridians)
        gap = GapField(
            grid=self.grid,
            clearance=self.clearance,
            socket_radius=self.socket_radius,
            depth=depth.reshape(shape[1:]),
            kind=LinearGap,
        )
        bed = BoreContact(compliance=self.compliance, gap=gap, tether=tether)
        found = self._settled(bed, levels, depth, start)
        flat = found.pressure.reshape(shape[0], -1)
        return Rest(
            displacement=levels.between(found.displacement),
            pressure=levels.between(flat),
            settled=bool(found.converged.all()),
            levels=(found.displacement, found.pressure),
        )

    def _settled(self, bed: BoreContact, levels: Levels, depth: Numbers, start: Rest | None) -> BedRest:
        """Balls at rest, from where they were before; those that do not settle begin again, pressed in deeper."""
        count, deep = (
            len(levels.loads),
            initial_displacement(
                self, self.compliance.uniform_stiffness, depth, *magnitudes_and_directions(levels.loads)
            ),
        )
        kept = None if start is None else start.levels
        begin, pressure = kept if kept is not None and len(kept[0]) == count else (deep, None)
        found = solve_force(bed, levels.loads, begin, numpy.ones(count, dtype=bool), pressure)
        for more in _DEEPER:
            if found.converged.all():
                break
            again = solve_force(bed, levels.loads, more * deep, ~found.converged)
            missed = ~found.converged
            for name in ("displacement", "pressure", "converged"):
                getattr(found, name)[missed] = getattr(again, name)[missed]
        return found


@lru_cache(maxsize=4)
def elastic_bed(surface: RealCup | ClosedShell, joint: Joint, cup: Cup, width: float) -> ElasticBed:
    """The bore of a joint in rings of one width (rad); the last few are kept."""
    cells = even_grid(socket_shape(joint, cup).reach, width)
    return ElasticBed(
        compliance=make_compliance(surface, joint, cup, cells),
        clearance=float(joint.clearance),
        socket_radius=float(joint.socket_radius),
        edges=surface.edges(joint, cup, cells),
    )
