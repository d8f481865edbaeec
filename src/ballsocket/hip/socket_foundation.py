"""Socket as a foundation under all loads of a cycle at once, and its form of radial springs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy

from ..core.arrays import Numbers
from ..elasticity.off_axis.directions import magnitudes_and_directions
from ..elasticity.off_axis.grid import Grid
from ..elasticity.off_axis.surfaces import initial_displacement
from .spring_equilibrium import SpringContact, load_blocks, spring_solver

NO_LATERAL_SPRING = numpy.zeros((3, 3))  # stiffness matrix (N/mm) for a ball without a lateral spring

_CONTACT_STEP = 1e-3  # step of a ball without contact beyond the clearance, relative to the socket's radius


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleEquilibrium:
    """Displacements and pressures of the ball under all loads of a cycle."""

    displacement: Numbers  # (loads, 3), displacement of the ball's centre in mm, in the cup's frame
    pressure: Numbers  # (loads, cells), pressure in MPa
    converged: bool  # True if every load is balanced
    # displacements and pressures of the solved load levels, if the loads are interpolated between levels
    levels: tuple[Numbers, Numbers] | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class SocketFoundation(ABC):
    """Foundation of a socket: pressures of its cells under all loads of a cycle."""

    directions: Numbers  # (3, cells), unit vectors to the centres of the cells, in the cup's frame
    normals: Numbers  # (3, cells), mean outward normal of each cell
    areas: Numbers  # (cells,), areas in mm²
    neighbours: Numbers  # (2, 2, cells), numbers of the neighbouring cells; see `grid_neighbours`
    clearance: float  # in mm
    socket_radius: float  # in mm

    edge_exponent: ClassVar[float]  # n of the pressure p ~ s^n at a distance s from the edge of a contact

    @property
    @abstractmethod
    def edge_inset(self) -> float:
        """Distance from the zero of `edge_field` inwards to the contact edge, in cell widths."""

    @property
    @abstractmethod
    def max_stiffness(self) -> float:
        """Largest ratio in MPa/mm of pressure change to worn depth, over all waves on the bore."""

    @abstractmethod
    def select_cells(self, cells: Numbers) -> SocketFoundation:
        """Return the foundation for a subset of the cells."""

    @abstractmethod
    def cells_near_contact(self, equilibrium: CycleEquilibrium, depth: Numbers, margin: float) -> Numbers:
        """Return a mask (cells,) of the cells in a contact or close to one under any load.

        The margin is relative to the largest overlap.
        """

    @abstractmethod
    def solve_equilibrium(
        self,
        loads: Numbers,
        depth: Numbers,
        start: CycleEquilibrium | None = None,
        lateral_stiffness: Numbers = NO_LATERAL_SPRING,
    ) -> CycleEquilibrium:
        """Solve for displacements in mm and pressures in MPa under all loads.

        Parameters
        ----------
        loads : array (loads, 3)
            Forces in N in the cup's frame, none of them zero.
        depth : array (cells,) or (loads, cells)
            Depth of the worn bore below the sphere in mm.
        start : CycleEquilibrium, optional
            Initial guess.
        lateral_stiffness : array (3, 3)
            Stiffness (N/mm) of a spring that unloads the ball as it moves.
        """

    @abstractmethod
    def smooth(self, depth: Numbers) -> Numbers:
        """Smooth a worn depth (cells,) in mm to waves that the grid resolves, with the same volume."""

    @abstractmethod
    def edge_field(self, equilibrium: CycleEquilibrium, depth: Numbers) -> Numbers:
        """Compute a field (loads, cells) in mm that is 0 near contact edges and positive in contacts."""

    def contact_shares(self, equilibrium: CycleEquilibrium, depth: Numbers) -> Numbers:
        """Compute the fraction of each cell that is in contact, from 0 to 1: (loads, cells).

        Linear interpolation of the edge field between two cells gives its zero. The edge lies inside that zero by
        `edge_inset`, a fraction of a cell's width; see `off_axis.edges`.
        """
        level = self.edge_field(equilibrium, depth)
        positive, span = level > 0, numpy.zeros_like(level)
        for pair in self.neighbours:
            level_differences = [
                numpy.where(positive[:, cells] != positive, abs(level - level[:, cells]), 0.0) for cells in pair
            ]
            span += numpy.maximum(*level_differences)
        edge_steps = numpy.divide(level, span, out=numpy.where(positive, 1.0, -1.0), where=span > 0)
        cell_shares: Numbers = numpy.clip(0.5 - self.edge_inset + edge_steps, 0.0, 1.0)
        return cell_shares


def foundation_cells(grid: Grid, socket_radius: float) -> dict[str, Numbers]:
    """Return the arrays of a `SocketFoundation` on a grid, by name."""
    return {
        "directions": numpy.ascontiguousarray(grid.middles.reshape(3, -1)),
        "normals": numpy.ascontiguousarray(grid.normals.reshape(3, -1)),
        "areas": numpy.repeat(grid.areas[:, 0], grid.meridians) * socket_radius**2,
        "neighbours": grid_neighbours(grid),
    }


def spring_foundation(grid: Grid, modulus: float, clearance: float, socket_radius: float) -> SpringFoundation:
    """Create a foundation of radial springs, one for each cell of a grid on the bore."""
    cells = foundation_cells(grid, socket_radius)
    return SpringFoundation(**cells, modulus=modulus, clearance=clearance, socket_radius=socket_radius)


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringFoundation(SocketFoundation):
    """Foundation of independent radial springs, whose pressure is modulus times overlap."""

    modulus: float  # foundation modulus K in MPa/mm

    edge_exponent: ClassVar[float] = 1.0
    edge_inset: ClassVar[float] = 0.0

    def select_cells(self, cells: Numbers) -> SpringFoundation:
        return replace(
            self,
            directions=self.directions[:, cells],
            normals=self.normals[:, cells],
            areas=self.areas[cells],
            neighbours=neighbours_in_subset(self.neighbours, cells),
        )

    def cells_near_contact(self, equilibrium: CycleEquilibrium, depth: Numbers, margin: float) -> Numbers:
        displacement, approach = equilibrium.displacement, numpy.zeros(len(self.areas))
        for block in load_blocks(len(displacement), len(self.areas)):
            approach = numpy.maximum(approach, (displacement[block] @ self.normals).max(axis=0))
        overlap = approach - self.clearance - depth
        mask: Numbers = overlap > -margin * float(overlap.max())
        return mask

    def smooth(self, depth: Numbers) -> Numbers:
        """Return the worn depth (cells,) unchanged, because springs resolve every wave of the grid."""
        return depth

    def edge_field(self, equilibrium: CycleEquilibrium, depth: Numbers) -> Numbers:
        """Compute the overlap (loads, cells) of ball and bore in mm, positive inside contacts."""
        return equilibrium.displacement @ self.normals - self.clearance - depth

    @property
    def max_stiffness(self) -> float:
        """Foundation modulus in MPa/mm, the ratio of pressure change to worn depth."""
        return self.modulus

    def contact(self, loads: Numbers, depth: Numbers, lateral_stiffness: Numbers = NO_LATERAL_SPRING) -> SpringContact:
        """Collect loads in N, springs and bore of a worn depth in mm for a solver; see `solve_equilibrium`."""
        return SpringContact(
            loads=numpy.ascontiguousarray(loads),
            closing=numpy.atleast_2d(self.clearance + depth),
            normals=numpy.ascontiguousarray(self.normals),
            areas=self.areas,
            modulus=float(self.modulus),
            lateral_stiffness=lateral_stiffness,
            approach=float(self.clearance + _CONTACT_STEP * self.socket_radius),
        )

    def solve_equilibrium(
        self,
        loads: Numbers,
        depth: Numbers,
        start: CycleEquilibrium | None = None,
        lateral_stiffness: Numbers = NO_LATERAL_SPRING,
    ) -> CycleEquilibrium:
        """Solve for displacements in mm and pressures in MPa under all loads by Newton's method."""
        displacement: Numbers = (
            initial_displacement(self, self.modulus, depth, *magnitudes_and_directions(loads))
            if start is None
            else start.displacement.copy()
        )
        pressure = numpy.empty((len(loads), len(self.areas)))
        converged = spring_solver()(self.contact(loads, depth, lateral_stiffness), displacement, pressure)
        return CycleEquilibrium(displacement=displacement, pressure=pressure, converged=converged)


def grid_neighbours(grid: Grid) -> Numbers:
    """Return the indices (2, 2, cells) of two neighbours along the meridian and two around the axis.

    Across the pole the neighbour is the opposite cell of the first ring. At the rim a cell is its own neighbour.
    """
    cells = numpy.arange(grid.rings * grid.meridians).reshape(grid.rings, grid.meridians)
    previous_ring = numpy.vstack([numpy.roll(cells[:1], grid.meridians // 2, axis=1), cells[:-1]])
    next_ring = numpy.vstack([cells[1:], cells[-1:]])
    ring_neighbours = [numpy.roll(cells, shift, axis=1) for shift in (1, -1)]
    return numpy.stack([previous_ring, next_ring, *ring_neighbours]).reshape(2, 2, -1)


def neighbours_in_subset(neighbours: Numbers, cells: Numbers) -> Numbers:
    """Renumber the neighbour indices for a subset of cells; cells outside are replaced by the cell itself."""
    subset_indices = numpy.full(neighbours.shape[-1], -1)
    subset_indices[cells] = numpy.arange(len(cells))
    subset_neighbour_indices = subset_indices[neighbours[..., cells]]
    return numpy.where(subset_neighbour_indices < 0, numpy.arange(len(cells)), subset_neighbour_indices)
