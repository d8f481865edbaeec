"""Compliance of bore and ball together on a grid: from pressures to displacements and back."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, replace
from functools import cached_property
from threading import Lock

import numpy
import scipy.fft

from ...core.arrays import Numbers
from ...problem import Joint
from ...problem.cup import Cup
from ..exact.modes import ball_of
from ..finite_elements.mesh import socket_shape
from .grid import Grid, rim_grid
from .ring_matrices import sphere_rings
from .surfaces import Springs, Surface


@dataclass(frozen=True, kw_only=True, eq=False)
class AxisymmetricOperator:
    """Linear operator on fields of cells that is axisymmetric: one matrix (rings, rings) for each harmonic m."""

    matrices: Numbers  # (max_harmonic + 1, rings, rings), single precision where it is sufficient; it is twice as fast

    def __call__(self, fields: Numbers) -> Numbers:
        """Apply the operator to fields (batch, rings, meridians), in the precision of the matrices."""
        batch, rings, meridians = fields.shape
        waves = scipy.fft.rfft(fields.astype(self.matrices.dtype, copy=False))
        columns = numpy.ascontiguousarray(waves.transpose(2, 1, 0))
        products = self.matrices @ columns.view(self.matrices.dtype)
        transformed = products.reshape(len(self.matrices), rings, 2 * batch).view(waves.dtype).transpose(2, 1, 0)
        return scipy.fft.irfft(transformed, n=meridians)


@dataclass(frozen=True, kw_only=True, eq=False)
class UniformOperator:
    """Linear operator on fields of cells that multiplies each cell by one factor."""

    factor: float

    def __call__(self, fields: Numbers) -> Numbers:
        """Apply the operator to fields (batch, rings, meridians)."""
        return fields * self.factor


@dataclass(frozen=True, kw_only=True, eq=False)
class Compliance:
    """Compliance of bore and ball together, between the cells of a grid."""

    grid: Grid
    # operator from pressures in MPa to the sum of both surface displacements in mm; and its inverse, from displacements
    # to pressures of either sign
    softness: AxisymmetricOperator | UniformOperator
    stiffness: AxisymmetricOperator | UniformOperator

    @cached_property
    def single_precision_softness(self) -> AxisymmetricOperator | UniformOperator:
        """Operator from pressures to displacements in single precision."""
        if isinstance(self.softness, UniformOperator):
            return self.softness
        return AxisymmetricOperator(matrices=self.softness.matrices.astype(numpy.float32))

    @cached_property
    def coarser_compliance(self) -> Compliance | None:
        """Compliance in cells twice as wide, or None if the grid has few rings."""
        cells = self.grid.coarser_grid
        if cells is None:
            return None
        if isinstance(self.softness, UniformOperator):
            return replace(self, grid=cells)
        return _make_from_matrices(cells, self.grid.coarsen_matrices(self.softness.matrices))

    @cached_property
    def uniform_stiffness(self) -> float:
        """Mean pressure per uniform radial displacement of the bore, in MPa/mm."""
        unit = numpy.ones((1, self.grid.rings, self.grid.meridians))
        return float(self.grid.integrate_product(self.stiffness(unit), unit)[0] / self.grid.ring_areas.sum())


def _make_from_matrices(grid: Grid, matrices: Numbers) -> Compliance:
    """Make a compliance from its matrices, with an inverse in single precision, which only guides the iteration."""
    inverse = numpy.linalg.inv(matrices).astype(numpy.float32)
    softness, stiffness = (AxisymmetricOperator(matrices=operator) for operator in (matrices, inverse))
    return Compliance(grid=grid, softness=softness, stiffness=stiffness)


def make_compliance(surface: Surface, joint: Joint, cup: Cup, grid: Grid) -> Compliance:
    """Compute the compliance of bore and ball of one joint of plain numbers on a grid, without a cache."""
    ball = ball_of(joint)
    if isinstance(surface, Springs) and ball is None:
        modulus = float(surface.modulus(joint))
        softness, stiffness = (UniformOperator(factor=factor) for factor in (1 / modulus, modulus))
        return Compliance(grid=grid, softness=softness, stiffness=stiffness)
    matrices = surface.rings(joint, cup, grid)
    if ball is not None:
        matrices = matrices + grid.average_over_cells(sphere_rings(ball.compliance, grid))
    return _make_from_matrices(grid, matrices)


_CACHE: OrderedDict[tuple[object, ...], Compliance] = OrderedDict()
_CACHE_SIZE, _LOCK = 8, Lock()


def cached_compliance(surface: Surface, joint: Joint, cup: Cup, width: float) -> Compliance:
    """Return the compliance of one joint in rings of this width (rad); the last eight are cached."""
    key = (surface, joint, cup.arc_of_cover, cup.chamfer, cup.interface, width)
    with _LOCK:
        if key not in _CACHE:
            grid = rim_grid(socket_shape(joint, cup).reach, width)
            _CACHE[key] = make_compliance(surface, joint, cup, grid)
            if len(_CACHE) > _CACHE_SIZE:
                _CACHE.popitem(last=False)
        _CACHE.move_to_end(key)
        return _CACHE[key]
