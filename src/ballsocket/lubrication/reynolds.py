"""Reynolds' equation with mass-conserving cavitation, the load balance, and liners as springs.

In each cell either the film is full (void fraction 0, pressure p >= 0 above the vapour) or it holds vapour (p = 0).
Both conditions are one equation per cell, the Fischer-Burmeister function. Newton's method solves them with the
balance of volume and, where a load is given, the three forces.

Source: Woloszynski, Podsiadlo, Stachowiak, Tribology Letters 58 (2015) 18, doi:10.1007/s11249-015-0487-4 (method).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy
import scipy.sparse
import scipy.sparse.linalg

from ..core.arrays import Numbers
from .flow import Balance, balance_cells
from .mesh import FilmMesh

_LARGEST_FALL = 0.6
"""Largest part of a cell's film that one Newton step may take away."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmState:
    """Pressure, vapour and position of the ball.

    Attributes
    ----------
    pressure : array (cells,)
        Pressure above the vapour pressure in MPa.
    void : array (cells,)
        Fraction of the film that is vapour, 0 to 1.
    eccentricity : array (3,)
        Displacement of the ball from the centre of the cup in mm.
    converged : bool
    iterations : int
    """

    pressure: Numbers
    void: Numbers
    eccentricity: Numbers
    converged: bool = True
    iterations: int = 0


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmProblem:
    """Film between a ball and a cup whose surface yields in proportion to the pressure.

    Attributes
    ----------
    mesh : FilmMesh
    viscosity : float
        Viscosity in MPa s.
    spin : array (3,)
        Rotation rate of the ball in rad/s.
    gap : array (cells,)
        Film thickness in mm of the centred ball on the undeformed cup.
    compliance : array (cells,)
        Displacement of the surface per pressure in mm/MPa; zeros on a rigid cup.
    rim_pressure : array (rim faces,)
        Pressure of the lubricant at the rim in MPa.
    force : array (3,) or None
        Load on the ball in N; None holds the ball where it is.
    """

    mesh: FilmMesh
    viscosity: float
    spin: Numbers
    gap: Numbers
    compliance: Numbers
    rim_pressure: Numbers
    force: Numbers | None = None

    def thickness(self, state: FilmState) -> Numbers:
        """Compute the film thickness of each cell in mm."""
        return self.gap - self.mesh.direction @ state.eccentricity + self.compliance * state.pressure

    def load(self, pressure: Numbers) -> Numbers:
        """Integrate the pressure over the cup to a force (3,) in N."""
        return (pressure * self.mesh.area) @ self.mesh.direction


def solve_steady(problem: FilmProblem, start: FilmState, *, tolerance: float = 1e-8, most: int = 100) -> FilmState:
    """Solve for the steady film."""
    return advance(problem, start, volume=None, step=inf, tolerance=tolerance, most=most)


def advance(
    problem: FilmProblem,
    start: FilmState,
    *,
    volume: Numbers | None,
    step: float,
    tolerance: float = 1e-8,
    most: int = 60,
) -> FilmState:
    """Solve for the film after a time step, by implicit Euler.

    Parameters
    ----------
    problem : FilmProblem
    start : FilmState
        First estimate.
    volume : array (cells,) or None
        Lubricant per area at the start of the step in mm; not used for a steady film.
    step : float
        Time step in s; `inf` for the steady film.
    tolerance : float
        Largest change of the last Newton step, relative to the largest pressure and to the film.
    most : int
        Largest number of Newton steps.
    """
    state = start
    for iteration in range(most):
        state, change = _newton_step(problem, state, volume, step)
        if change < tolerance:
            return replace(state, converged=True, iterations=iteration + 1)
    return replace(state, converged=False, iterations=most)


def _newton_step(
    problem: FilmProblem, state: FilmState, volume: Numbers | None, step: float
) -> tuple[FilmState, float]:
    """Take one damped Newton step; return the new state and the largest relative change."""
    mesh = problem.mesh
    thickness = problem.thickness(state)
    pressure, void = state.pressure, state.void
    balance = balance_cells(mesh, problem.spin, problem.viscosity, thickness, pressure, void, problem.rim_pressure)
    outflow, by_pressure, by_void = _add_storage(balance, mesh.area, thickness, void, volume, step, problem.compliance)
    by_thickness = balance.by_thickness
    if step < inf:
        by_thickness = by_thickness + scipy.sparse.diags_array(mesh.area * (1 - void) / step)
    scale = max(float(pressure.max()), 1e-6)
    # Fischer-Burmeister: a + b - sqrt(a² + b²) = 0 with a = p/scale and b = void.
    share = pressure / scale
    length = numpy.hypot(share, void)
    safe = numpy.where(length > 0, length, 1.0)
    pressure_slope = numpy.where(length > 0, 1 - share / safe, 1 - numpy.sqrt(0.5)) / scale
    void_slope = numpy.where(length > 0, 1 - void / safe, 1 - numpy.sqrt(0.5))
    complement = share + void - length
    # Where the film is full the pressure is the unknown of a cell, else the void.
    full = void_slope * 1.0 >= pressure_slope * scale
    # full: dvoid = (-complement - pressure_slope dp)/void_slope;  vapour: dp = (-complement - void_slope dvoid)/pressure_slope
    with numpy.errstate(divide="ignore", invalid="ignore"):
        void_by = numpy.where(full, -pressure_slope / void_slope, 1.0)
        void_at = numpy.where(full, -complement / void_slope, 0.0)
        pressure_by = numpy.where(full, 1.0, -void_slope / pressure_slope)
        pressure_at = numpy.where(full, 0.0, -complement / pressure_slope)
    matrix = by_pressure @ scipy.sparse.diags_array(pressure_by) + by_void @ scipy.sparse.diags_array(void_by)
    right_side = -outflow - by_pressure @ pressure_at - by_void @ void_at
    rows = 1 / numpy.maximum(abs(matrix).max(axis=1).toarray().ravel(), 1e-300)
    factor = scipy.sparse.linalg.splu((scipy.sparse.diags_array(rows) @ matrix).tocsc())
    unknown = factor.solve(rows * right_side)
    shift = numpy.zeros(3)
    if problem.force is not None:
        by_shift = -(by_thickness @ mesh.direction)
        response = numpy.stack([factor.solve(-rows * by_shift[:, axis]) for axis in range(3)], axis=1)
        weight = (mesh.area[:, None] * mesh.direction).T
        missing = problem.force - problem.load(pressure + pressure_at + pressure_by * unknown)
        shift = numpy.linalg.solve((weight * pressure_by) @ response, missing)
        unknown = unknown + response @ shift
    pressure_change = pressure_at + pressure_by * unknown
    void_change = void_at + void_by * unknown
    film_change = problem.compliance * pressure_change - mesh.direction @ shift
    thin = film_change < -_LARGEST_FALL * thickness
    factor_of_step = 1.0
    if thin.any():
        factor_of_step = max(0.02, float((_LARGEST_FALL * thickness[thin] / -film_change[thin]).min()))
    new_pressure = pressure + factor_of_step * pressure_change
    new_void = numpy.clip(void + factor_of_step * void_change, 0.0, 1.0)
    new = replace(
        state,
        pressure=numpy.maximum(new_pressure, 0.0),
        void=new_void,
        eccentricity=state.eccentricity + factor_of_step * shift,
    )
    change = float(numpy.abs(new.pressure - pressure).max()) / max(float(new.pressure.max()), 1e-9)
    change += float(numpy.abs(new.void - void).max())
    return new, change / factor_of_step


def _add_storage(
    balance: Balance,
    area: Numbers,
    thickness: Numbers,
    void: Numbers,
    volume: Numbers | None,
    step: float,
    compliance: Numbers,
) -> tuple[Numbers, scipy.sparse.csr_matrix, scipy.sparse.csr_matrix]:
    """Add the growth of the lubricant in each cell to the outflow, and the film's dependence on pressure."""
    by_thickness, by_void, outflow = balance.by_thickness, balance.by_void, balance.outflow
    if step < inf:
        outflow = outflow + area * (thickness * (1 - void) - volume) / step
        by_thickness = by_thickness + scipy.sparse.diags_array(area * (1 - void) / step)
        by_void = by_void - scipy.sparse.diags_array(area * thickness / step)
    by_pressure = balance.by_pressure + by_thickness @ scipy.sparse.diags_array(compliance)
    return outflow, by_pressure, by_void
