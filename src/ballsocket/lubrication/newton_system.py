"""Linear system of a Newton step: a sparse factor on springs, and GMRES with that factor for elastic bodies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING

import numpy
import scipy.sparse
import scipy.sparse.linalg

from ..core.arrays import Numbers
from .balance import Balance

if TYPE_CHECKING:
    from .dry_contact import ElasticSoftness

_RESIDUAL = 1e-5  # residual of GMRES relative to the right side; Newton's next step removes it
_MAX_KRYLOV, _MAX_RESTARTS = 60, 3  # number of directions of GMRES, and largest number of times that it restarts


@dataclass(frozen=True)
class CellUnknown:
    """Unknown of each cell, its pressure where the film is full and its void elsewhere.

    Change of pressure and of void are linear in the unknown: `at + by * unknown`. They solve the linear form of the
    Fischer-Burmeister function a + b - sqrt(a² + b²) = 0 of a = p/scale and b = void.
    """

    pressure_at: Numbers
    pressure_by: Numbers
    void_at: Numbers
    void_by: Numbers

    @classmethod
    def of(cls, pressure: Numbers, void: Numbers) -> CellUnknown:
        """Choose the unknowns at a state."""
        scale = max(float(pressure.max()), 1e-6)
        share = pressure / scale
        length = numpy.hypot(share, void)
        safe = numpy.where(length > 0, length, 1.0)
        at_zero = 1 - sqrt(0.5)
        by_pressure = numpy.where(length > 0, 1 - share / safe, at_zero) / scale
        by_void = numpy.where(length > 0, 1 - void / safe, at_zero)
        complement = share + void - length
        full = by_void >= by_pressure * scale
        with numpy.errstate(divide="ignore", invalid="ignore"):
            return cls(
                pressure_at=numpy.where(full, 0.0, -complement / by_pressure),
                pressure_by=numpy.where(full, 1.0, -by_void / by_pressure),
                void_at=numpy.where(full, -complement / by_void, 0.0),
                void_by=numpy.where(full, -by_pressure / by_void, 1.0),
            )


@dataclass(frozen=True, kw_only=True, eq=False)
class NewtonSystem:
    """Linear balance of a Newton step for the unknowns of the cells and the shift of the ball."""

    balance: Balance
    unknown: CellUnknown
    compliance: Numbers  # (cells,), displacement of the surface per pressure on springs in mm/MPa
    softness: ElasticSoftness | None  # further displacements, of elastic bodies
    direction: Numbers  # (cells, 3), normals of the cells; the film falls by `direction @ shift`
    weight: Numbers  # (3, cells), force of a unit pressure on each cell in mm²
    missing_force: Numbers | None  # (3,), load less the integral of the pressure in N; None holds the ball where it is

    def solve(self) -> tuple[Numbers, Numbers]:
        """Solve for the unknown of each cell and the shift of the ball in mm."""
        right_side = -self.balance.outflow - self._flow(self.unknown.pressure_at, self.unknown.void_at)
        load_error = None
        if self.missing_force is not None:
            load_error = self.missing_force - self.weight @ self.unknown.pressure_at
        factor = self._factorise()
        if self.softness is None:
            return factor.solve(right_side, load_error)
        return self._solve_elastic(factor, right_side, load_error)

    def _flow(self, pressure: Numbers, void: Numbers) -> Numbers:
        """Compute the change of the outflow by changes of pressure and void at a fixed ball."""
        film = self.compliance * pressure
        if self.softness is not None:
            film = film + self.softness(pressure)
        balance = self.balance
        return numpy.asarray(balance.by_pressure @ pressure + balance.by_thickness @ film + balance.by_void @ void)

    def _factorise(self) -> _SpringsFactor:
        """Factorise the system in which each elastic cell yields under its own pressure alone."""
        diagonal = self.compliance if self.softness is None else self.compliance + self.softness.diagonal
        balance, unknown = self.balance, self.unknown
        by_pressure = balance.by_pressure + balance.by_thickness @ scipy.sparse.diags_array(diagonal)
        matrix = by_pressure @ scipy.sparse.diags_array(unknown.pressure_by)
        matrix = matrix + balance.by_void @ scipy.sparse.diags_array(unknown.void_by)
        scale = 1 / numpy.maximum(abs(matrix).max(axis=1).toarray().ravel(), 1e-300)
        return _SpringsFactor(
            factor=scipy.sparse.linalg.splu((scipy.sparse.diags_array(scale) @ matrix).tocsc()),
            scale=scale,
            by_shift=-balance.by_thickness @ self.direction,
            load=self.weight * unknown.pressure_by,
        )

    def _solve_elastic(
        self, factor: _SpringsFactor, right_side: Numbers, load_error: Numbers | None
    ) -> tuple[Numbers, Numbers]:
        """Solve with the elastic operator by GMRES; the factor of the springs is the preconditioner."""
        cells, unknown = len(right_side), self.unknown
        free = load_error is not None
        scale = numpy.append(factor.scale, numpy.full(3 if free else 0, 1 / self.weight.max() / cells))

        def precondition(values: Numbers) -> tuple[Numbers, Numbers]:
            return factor.solve(values[:cells] / factor.scale, values[cells:] / scale[cells:] if free else None)

        def apply(values: Numbers) -> Numbers:
            change, shift = precondition(values)
            flow = self._flow(unknown.pressure_by * change, unknown.void_by * change) + factor.by_shift @ shift
            return scale * (numpy.append(flow, factor.load @ change) if free else flow)

        target = scale * (right_side if load_error is None else numpy.append(right_side, load_error))
        operator = scipy.sparse.linalg.LinearOperator((len(target), len(target)), matvec=apply, dtype=float)
        values, _ = scipy.sparse.linalg.gmres(
            operator, target, rtol=_RESIDUAL, restart=_MAX_KRYLOV, maxiter=_MAX_RESTARTS
        )
        return precondition(values)


@dataclass(frozen=True, kw_only=True, eq=False)
class _SpringsFactor:
    """Sparse factor of the balance of the cells, bordered by the three displacements of the ball."""

    factor: scipy.sparse.linalg.SuperLU
    scale: Numbers  # (cells,), factors of the rows before the factorisation
    by_shift: Numbers  # (cells, 3), derivative of the outflow by the shift of the ball
    load: Numbers  # (3, cells), derivative of the force on the ball by the unknowns

    @cached_property
    def _response(self) -> Numbers:
        """Change of the unknowns (cells, 3) by shifts of the ball."""
        return -self._solve_cells(self.by_shift)

    def _solve_cells(self, right_side: Numbers) -> Numbers:
        """Solve for the unknowns at a fixed ball."""
        return numpy.asarray(self.factor.solve((self.scale * right_side.T).T))

    def solve(self, right_side: Numbers, load_error: Numbers | None) -> tuple[Numbers, Numbers]:
        """Solve for unknowns and shift; without a load the ball stays where it is."""
        unknown = self._solve_cells(right_side)
        if load_error is None:
            return unknown, numpy.zeros(3)
        shift = numpy.linalg.solve(self.load @ self._response, load_error - self.load @ unknown)
        return unknown + self._response @ shift, shift
