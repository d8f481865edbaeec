"""Ball in a bore: the gap for any position of the ball, forces, contacts of a displaced ball, and their derivatives."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy

from ...core.arrays import Numbers, gauss_legendre
from ...problem.gaps import CircularGap, LinearGap
from .compliance import Compliance, UniformOperator
from .coupled_search import BoreArrays
from .grid import Grid
from .pressure_solver import solve_pressure, solve_pressure_change


@dataclass(frozen=True, kw_only=True, eq=False)
class GapField:
    """Gap between the undeformed ball and bore in every cell of a grid."""

    grid: Grid
    # radii in mm
    clearance: float
    socket_radius: float
    depth: Numbers  # (rings, meridians), depth of the worn bore below its sphere in mm
    kind: type[LinearGap] | type[CircularGap]  # `LinearGap` or `CircularGap`

    def overlap(self, displacement: Numbers) -> Numbers:
        """Compute the overlap of ball and undeformed bore in mm, negative in a gap: (batch, rings, meridians).

        `displacement` (batch, 3) is that of the ball's centre from the centre of the bore, in mm.
        """
        along = numpy.einsum("bk,kij->bij", displacement, self.grid.normals)
        if self.kind is LinearGap:
            return along - self.clearance - self.depth
        ball, square = self._half_chord(displacement, along)
        root = numpy.sqrt(numpy.maximum(square, 0.0))
        # e·n + sqrt(R1² - |e|² + (e·n)²) - R2, without cancellation
        overlap = along - self.clearance - self.depth - (ball * ball - square) / (ball + root)
        return numpy.where(square > 0, overlap, -self.socket_radius)  # the ray misses the ball

    def overlap_slope(self, displacement: Numbers) -> Numbers:
        """Compute the derivative of the overlap by the displacement of the ball: (batch or 1, 3, rings, meridians)."""
        normals = self.grid.normals[None]
        if self.kind is LinearGap:
            return normals
        along = numpy.einsum("bk,kij->bij", displacement, self.grid.normals)
        ball, square = self._half_chord(displacement, along)
        root = numpy.sqrt(numpy.maximum(square, (1e-6 * ball) ** 2))
        return normals + (along[:, None] * normals - displacement[:, :, None, None]) / root[:, None]

    def _half_chord(self, displacement: Numbers, along: Numbers) -> tuple[float, Numbers]:
        """Compute the ball's radius in mm, and the squared half chord of each cell's ray in the ball in mm²."""
        ball = self.socket_radius - self.clearance
        return ball, ball * ball - (displacement * displacement).sum(axis=1)[:, None, None] + along * along


_PATH_POINTS = 4  # number of contacts on the way of a ball, at which the work of the load is integrated
_BATCH_CELLS = 150_000  # number of cells that are solved together: more exceed the processor's cache


@dataclass(frozen=True, kw_only=True, eq=False)
class EquilibriumBatch:
    """Positions of the ball with their contacts."""

    displacement: Numbers  # (batch, 3), displacement of the ball's centre in mm, in the cup's frame
    pressure: Numbers  # (batch, rings, meridians), pressure in MPa
    converged: Numbers  # bool (batch,), True where the solver reached its tolerance

    def store(self, indices: Numbers, part: EquilibriumBatch) -> None:
        """Copy the solved balls of a part to these indices."""
        for name in ("displacement", "pressure", "converged"):
            getattr(self, name)[indices] = getattr(part, name)


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreContact:
    """Ball in a bore, described by the compliance of both bodies and the gap between them."""

    compliance: Compliance
    gap: GapField
    # (3, 3), stiffness in N/mm of a spring between ball and socket, parallel to the contact; none by default
    tether: Numbers = field(default_factory=lambda: numpy.zeros((3, 3)))

    @property
    def area(self) -> float:
        """Area of the bore per area of a unit sphere, R2² in mm²."""
        return self.gap.socket_radius**2

    @cached_property
    def _force_weights(self) -> Numbers:
        """Force vectors in N by unit pressure (MPa) in each cell: (cells, 3)."""
        grid = self.compliance.grid
        return numpy.ascontiguousarray((self.area * grid.normals * grid.areas).reshape(3, -1).T)

    @cached_property
    def coarser_bore(self) -> BoreContact | None:
        """Same ball and bore in cells twice as wide, or None if the grid has few rings."""
        compliance = self.compliance.coarser_compliance
        if compliance is None:
            return None
        gap = replace(self.gap, grid=compliance.grid, depth=self.gap.grid.coarsen(self.gap.depth))
        return replace(self, compliance=compliance, gap=gap)

    def force(self, pressure: Numbers) -> Numbers:
        """Compute the force on the bore in N, (batch, 3), from pressures (batch, rings, meridians)."""
        return pressure.reshape(len(pressure), len(self._force_weights)) @ self._force_weights

    def solve_displaced(self, displacement: Numbers) -> EquilibriumBatch:
        """Solve one contact for each prescribed displacement (batch, 3) of the ball in mm."""
        batch = self.unsolved_batch(displacement)
        for block in self.split_into_blocks(numpy.arange(len(displacement))):
            solution = solve_pressure(self.compliance, self.gap.overlap(displacement[block]))
            batch.pressure[block], batch.converged[block] = solution.pressure, solution.converged
        return batch

    def work_beyond_stored_energy(self, displacement: Numbers) -> Numbers:
        """Compute the work of the load in N mm, (batch,), less the stored energy, on straight ways from the centre.

        The pressure acts along the normals of the bore, but the overlap of a circular gap grows by less than the
        displacement along them. The difference is small, so that contacts on the coarser grid suffice.
        """
        if self.gap.kind.conservative:
            return numpy.zeros(len(displacement))
        bore = self.coarser_bore or self
        initial, final = (bore.gap.overlap(factor * displacement) for factor in (0.0, 1.0))
        touch = numpy.where(final > 0, -initial / numpy.where(final > 0, final - initial, 1.0), 1.0)
        first_touch = numpy.clip(touch.min(axis=(1, 2)), 0.0, 1.0)  # as a fraction of the way
        work = numpy.zeros(len(displacement))
        for node, weight in zip(*gauss_legendre(_PATH_POINTS), strict=True):
            moved = displacement * (first_touch + (1 - first_touch) * node)[:, None]
            difference = bore.compliance.grid.normals - bore.gap.overlap_slope(moved)
            growth = numpy.einsum("bkij,bk->bij", difference, displacement)
            power = bore.compliance.grid.integrate_product(bore.solve_displaced(moved).pressure, growth)
            work += weight * (1 - first_touch) * bore.area * power
        return work

    def pressure_sensitivity(
        self,
        displacement: Numbers,
        share: Numbers,
        start: Numbers | None = None,
        tolerance: float = 0.1,
        edge_compliance: Numbers | float = 1.0,
    ) -> Numbers:
        """Compute the derivative of pressures by displacement in MPa/mm: (batch, 3, rings, meridians)."""
        shape = (len(share), 3, *share.shape[1:])
        overlap_slope = numpy.broadcast_to(self.gap.overlap_slope(displacement), shape).reshape(-1, *shape[2:])
        shares = numpy.broadcast_to(share[:, None], shape).reshape(-1, *shape[2:])
        initial = None if start is None else start.reshape(-1, *shape[2:])
        change = solve_pressure_change(
            self.compliance, shares, overlap_slope, initial, tolerance, edge_compliance=edge_compliance
        )
        return change.reshape(shape)

    def tangent(self, sensitivity: Numbers) -> Numbers:
        """Compute the tangent stiffness (batch, 3, 3) of contact and tether in N/mm from the sensitivity."""
        tangent = sensitivity.reshape(len(sensitivity), 3, len(self._force_weights)) @ self._force_weights
        return tangent.swapaxes(1, 2) + self.tether

    def split_into_blocks(self, indices: Numbers) -> list[Numbers]:
        """Split the indices of contacts into blocks that fit into the processor's cache."""
        grid = self.compliance.grid
        size = max(_BATCH_CELLS // (grid.rings * grid.meridians), 1)
        return [indices[i : i + size] for i in range(0, len(indices), size)]

    def unsolved_batch(self, displacement: Numbers) -> EquilibriumBatch:
        """Return balls at displacements (batch, 3) in mm, without pressure and not converged."""
        count, grid = len(displacement), self.compliance.grid
        pressure, converged = numpy.zeros((count, grid.rings, grid.meridians)), numpy.zeros(count, dtype=bool)
        return EquilibriumBatch(displacement=displacement.copy(), pressure=pressure, converged=converged)


def make_bore_arrays(bore: BoreContact, dtype: type = numpy.float32) -> BoreArrays:
    """Make the NumPy arrays of a ball in an elastic bore with a linear gap."""
    gap: Numbers = numpy.ascontiguousarray(bore.gap.clearance + bore.gap.depth.T).astype(dtype)[..., None]
    return _compliance_arrays(bore.compliance, bore.area, dtype)._replace(gap=gap, tether=bore.tether.astype(dtype))


@lru_cache(maxsize=6)
def _compliance_arrays(compliance: Compliance, area: float, dtype: type) -> BoreArrays:
    """Make the arrays of a bore that balls of all clearances, and all wear, have in common; from a cache."""
    grid, half = compliance.grid, compliance.grid.meridians // 2
    phase = grid.azimuth[:half]
    cosines, sines = (numpy.sqrt(1 / half) * numpy.ones((half, half)) for _ in range(2))
    cosines *= numpy.cos(numpy.arange(half)[:, None] * phase)
    sines *= numpy.sin(numpy.arange(1, half + 1)[:, None] * phase)
    cosines[0] *= numpy.sqrt(0.5)
    sines[-1] *= numpy.sqrt(0.5)
    normals = grid.normals.transpose(2, 1, 0)
    softness, stiffness = compliance.softness, compliance.stiffness
    if dtype is numpy.float32:
        softness = compliance.single_precision_softness
    if isinstance(softness, UniformOperator) or isinstance(stiffness, UniformOperator):
        raise TypeError("a bore of springs has no matrices")
    bore_arrays = BoreArrays(
        cosines=cosines,
        sines=sines,
        softness=softness.matrices,
        stiffness=stiffness.matrices,
        normals=normals.reshape(-1, 3),
        gap=(),
        areas=grid.areas[:, 0],
        force_weights=(area * grid.areas * normals).reshape(-1, 3).T,
        scale=numpy.asarray(area),
        tether=(),
    )
    return BoreArrays(*(numpy.ascontiguousarray(array, dtype=dtype) for array in bore_arrays))
