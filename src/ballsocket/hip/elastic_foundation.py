"""Elastic socket under all loads of a cycle: a closed shell, or the cup with its rim and backing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import ClassVar

import numpy
import scipy.fft

from ..core.arrays import Numbers
from ..elasticity.finite_elements.mesh import socket_shape
from ..elasticity.off_axis.bore_contact import BoreContact, EquilibriumBatch, GapField
from ..elasticity.off_axis.compliance import Compliance, make_compliance
from ..elasticity.off_axis.directions import magnitudes_and_directions
from ..elasticity.off_axis.equilibrium import solve_force
from ..elasticity.off_axis.grid import Grid, even_grid
from ..elasticity.off_axis.surfaces import ClosedShell, EdgeRelation, RealCup, initial_displacement
from ..problem import Joint
from ..problem.cup import Cup
from ..problem.gaps import LinearGap
from .socket_foundation import NO_LATERAL_SPRING, CycleEquilibrium, SocketFoundation, foundation_cells

_POWER_ITERATIONS = 60  # number of power iterations for the largest stiffness
_SEED = 1  # seed of the initial field of the power iteration
_DEEPER_STARTS = 1.0, 1.2  # factors of the initial displacement for loads that have not converged
_MAX_LEVELS = 12  # largest number of load levels of one direction
_PARALLEL_TOLERANCE = 1e-9  # relative tolerance for loads of one direction, and for loads of one magnitude


def interpolate_loads(loads: Numbers, max_levels: int = _MAX_LEVELS) -> tuple[Numbers, Numbers]:
    """Choose a few loads (levels, 3) in N to solve for, and weights (loads, levels) of their results in all loads.

    The weights of a load add up to 1, and they interpolate the loads (loads, 3) themselves exactly. The levels are
    closer to each other at small loads, where the contacts change most. Few loads, and loads of several directions, are
    all solved.
    """
    magnitudes, count = numpy.linalg.norm(loads, axis=1), len(loads)
    lateral = abs(numpy.cross(loads, loads[0])).max() if count > max_levels else 0.0
    if count <= max_levels or lateral > _PARALLEL_TOLERANCE * magnitudes.max() ** 2:
        return loads, numpy.eye(count)
    levels = numpy.linspace(magnitudes.min() ** 0.5, magnitudes.max() ** 0.5, max_levels) ** 2
    levels[0], levels[-1] = magnitudes.min(), magnitudes.max()
    if levels[-1] - levels[0] <= _PARALLEL_TOLERANCE * levels[-1]:
        levels, weights = levels[-1:], numpy.ones((count, 1))
    else:
        lower = numpy.clip(numpy.searchsorted(levels, magnitudes, side="right") - 1, 0, max_levels - 2)
        fraction = (magnitudes - levels[lower]) / (levels[lower + 1] - levels[lower])
        weights, indices = numpy.zeros((count, max_levels)), numpy.arange(count)
        weights[indices, lower], weights[indices, lower + 1] = 1 - fraction, fraction
    return levels[:, None] * loads[0] / magnitudes[0], weights


def smooth_fields(grid: Grid, fields: Numbers) -> Numbers:
    """Smooth fields (..., rings, meridians) by [1 2 1]/4 along the meridians and around the axis, with their integral.

    An elastic socket answers a wave of the worn depth with a pressure that increases as the wavelength decreases. The
    shortest waves are artefacts of the grid. Near the pole, where cells are narrow, the filter around the axis is as
    wide as the rings.
    """
    # the harmonic m times cos²(π m / 2M') is [1 2 1]/4 on M' cells a half circle
    half_circle = numpy.maximum(grid.meridians / 2 * numpy.sin(grid.polar), 1.0)[:, None]
    m = numpy.arange(grid.max_harmonic + 1)
    factors = numpy.where(m < half_circle, numpy.cos(numpy.pi * m / (2 * half_circle)) ** 2, 0.0)
    filtered = scipy.fft.irfft(scipy.fft.rfft(fields) * factors, n=grid.meridians)
    areas, no_flux = grid.areas, numpy.zeros_like(filtered[..., :1, :])
    flux = numpy.minimum(areas[1:], areas[:-1]) / 4 * numpy.diff(filtered, axis=-2)  # between neighbouring rings
    flux = numpy.concatenate([no_flux, flux, no_flux], axis=-2)
    return filtered + numpy.diff(flux, axis=-2) / areas


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticFoundation(SocketFoundation):
    """Foundation of an elastic socket, in which a pressure on one cell displaces all cells; its gap is linear."""

    compliance: Compliance
    edges: EdgeRelation  # relation of pressure and gap at the edge of a contact

    edge_exponent: ClassVar[float] = 0.5

    @property
    def grid(self) -> Grid:
        return self.compliance.grid

    def smooth(self, depth: Numbers) -> Numbers:
        return smooth_fields(self.grid, depth.reshape(self.grid.rings, -1)).ravel()

    @cached_property
    def max_stiffness(self) -> float:
        """Largest ratio in MPa/mm of pressure change to worn depth, over all waves on the bore; by power iteration."""
        field = numpy.random.default_rng(_SEED).normal(size=(1, self.grid.rings, self.grid.meridians))
        stiffness = 0.0
        for _ in range(_POWER_ITERATIONS):
            field = field / numpy.linalg.norm(field)
            field = smooth_fields(self.grid, self.compliance.stiffness(field))
            stiffness = float(numpy.linalg.norm(field))
        return stiffness

    def select_cells(self, cells: Numbers) -> ElasticFoundation:
        """Return this foundation unchanged: elastic cells are coupled, so all are needed."""
        return self

    def cells_near_contact(self, equilibrium: CycleEquilibrium, depth: Numbers, margin: float) -> Numbers:
        """Return a mask (cells,) of all cells: elastic cells are coupled, so all are needed."""
        return numpy.ones(len(self.areas), dtype=bool)

    @property
    def edge_inset(self) -> float:
        return self.edges.inset

    def edge_field(self, equilibrium: CycleEquilibrium, depth: Numbers) -> Numbers:
        shape = (len(equilibrium.pressure), self.grid.rings, self.grid.meridians)
        pressure = equilibrium.pressure.reshape(shape)
        overlap = equilibrium.displacement @ self.normals - self.clearance - depth
        gap = self.compliance.softness(pressure) - overlap.reshape(shape)
        return self.edges.levels(pressure, gap).reshape(equilibrium.pressure.shape)

    def solve_equilibrium(
        self,
        loads: Numbers,
        depth: Numbers,
        start: CycleEquilibrium | None = None,
        lateral_stiffness: Numbers = NO_LATERAL_SPRING,
    ) -> CycleEquilibrium:
        """Solve for displacements and pressures under all loads, with coupled elastic cells.

        For a fixed load direction, a few load levels are solved, and linear interpolation gives the others. It
        balances every load exactly.
        """
        levels, weights = interpolate_loads(loads, len(loads) if lateral_stiffness.any() else _MAX_LEVELS)
        shape = (len(levels), self.grid.rings, self.grid.meridians)
        gap = GapField(
            grid=self.grid,
            clearance=self.clearance,
            socket_radius=self.socket_radius,
            depth=depth.reshape(shape[1:]),
            kind=LinearGap,
        )
        bore_contact = BoreContact(compliance=self.compliance, gap=gap, tether=lateral_stiffness)
        solved = self._solve_load_levels(bore_contact, levels, depth, start)
        return CycleEquilibrium(
            displacement=weights @ solved.displacement,
            pressure=weights @ solved.pressure.reshape(shape[0], -1),
            converged=bool(solved.converged.all()),
            levels=(solved.displacement, solved.pressure),
        )

    def _solve_load_levels(
        self, bore_contact: BoreContact, loads: Numbers, depth: Numbers, start: CycleEquilibrium | None
    ) -> EquilibriumBatch:
        """Solve the contacts under the loads of all levels; repeat unconverged ones from a deeper start."""
        guess = initial_displacement(self, self.compliance.uniform_stiffness, depth, *magnitudes_and_directions(loads))
        displacement, pressure = guess, None
        if start is not None and start.levels is not None and len(start.levels[0]) == len(loads):
            displacement, pressure = start.levels
        solved = solve_force(bore_contact, loads, displacement, numpy.ones(len(loads), dtype=bool), pressure)
        for factor in _DEEPER_STARTS:
            unsolved = ~solved.converged
            if not unsolved.any():
                break
            retried = solve_force(bore_contact, loads, factor * guess, unsolved)
            for name in ("displacement", "pressure", "converged"):
                getattr(solved, name)[unsolved] = getattr(retried, name)[unsolved]
        return solved


@lru_cache(maxsize=4)
def elastic_foundation(surface: RealCup | ClosedShell, joint: Joint, cup: Cup, width: float) -> ElasticFoundation:
    """Create the elastic foundation of a joint on a grid, whose rings have a width in rad.

    The last four foundations are cached.
    """
    grid, socket_radius = even_grid(socket_shape(joint, cup).reach, width), float(joint.socket_radius)
    return ElasticFoundation(
        **foundation_cells(grid, socket_radius),
        compliance=make_compliance(surface, joint, cup, grid),
        clearance=float(joint.clearance),
        socket_radius=socket_radius,
        edges=surface.edges(joint, cup, grid),
    )
