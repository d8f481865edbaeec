"""Reynolds' equation with mass-conserving cavitation, the load balance, and liners as springs.

In each cell either the film is full (void fraction 0, pressure p >= 0 above the vapour) or it holds vapour (p = 0).
Both conditions are one equation per cell, the Fischer-Burmeister function. Newton's method solves them with the
balance of volume and, where a load is given, the three forces.

Source: Woloszynski, Podsiadlo, Stachowiak, Tribology Letters 58 (2015) 18, doi:10.1007/s11249-015-0487-4 (method).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, sqrt
from typing import Any

import numpy
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg

from ..core.arrays import Numbers
from .mesh import FilmMesh

_LARGEST_FALL = 0.6
"""Largest part of a cell's film that one Newton step may take away."""

_MIN_STEP = 0.02
"""Smallest factor of a damped Newton step."""

_GROWTH = 1.8
"""Growth of the time steps on the way to the steady film."""

_MAX_TIME_STEPS = 40
"""Number of time steps on the way to the steady film after which it counts as not converged."""

_EASY_ITERATIONS = 10
"""Number of Newton steps up to which the next time step grows."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Balance:
    """Outflow of each cell in mm³/s, and its derivatives.

    Attributes
    ----------
    outflow : array (cells,)
    by_pressure, by_void, by_thickness : sparse matrix (cells, cells)
        Derivatives by pressure (MPa), void fraction and film thickness (mm).
    """

    outflow: Numbers
    by_pressure: scipy.sparse.csr_matrix
    by_void: scipy.sparse.csr_matrix
    by_thickness: scipy.sparse.csr_matrix


def balance_cells(
    mesh: FilmMesh,
    spin: Numbers,
    viscosity: float,
    thickness: Numbers,
    pressure: Numbers,
    void: Numbers,
    rim_pressure: Numbers,
) -> Balance:
    """Compute the volume that leaves each cell: Couette and Poiseuille flow (Reynolds' equation).

    Between two cells the film is taken as constant on each side and the pressure as continuous at the face, so that
    a step of the film is exact and a smooth film is of second order.

    Parameters
    ----------
    mesh : FilmMesh
    spin : array (3,)
        Rotation rate of the ball in rad/s.
    viscosity : float
        Viscosity in MPa s.
    thickness, pressure, void : array (cells,)
        Film thickness in mm, pressure in MPa, and the fraction of the film that is vapour.
    rim_pressure : array (rim faces,)
        Pressure of the lubricant at the rim in MPa.
    """
    velocity, rim_velocity = mesh.face_velocity(spin)
    first, second = mesh.first, mesh.second
    first_film, second_film = thickness[first], thickness[second]
    # Conductances of the two sides of a face; in series they carry the flow from centre to centre.
    first_side = first_film**3 / mesh.first_distance
    second_side = second_film**3 / mesh.second_distance
    both = first_side + second_side
    conductance = mesh.width / (12 * viscosity) * first_side * second_side / both
    film = (first_film * second_side + second_film * first_side) / both
    first_slope = 3 * first_side / first_film
    second_slope = 3 * second_side / second_film
    conductance_by_first = mesh.width / (12 * viscosity) * (second_side / both) ** 2 * first_slope
    conductance_by_second = mesh.width / (12 * viscosity) * (first_side / both) ** 2 * second_slope
    film_by_first = second_side / both + (second_film - first_film) * second_side / both**2 * first_slope
    film_by_second = first_side / both + (first_film - second_film) * first_side / both**2 * second_slope
    carried = 0.5 * velocity * mesh.width
    upstream = numpy.where(velocity > 0, first, second)
    full = 1 - void[upstream]
    fall = pressure[first] - pressure[second]
    flow = conductance * fall + carried * film * full
    rows = _FaceRows(mesh.cells, first, second)
    by_pressure = rows.matrix((first, conductance), (second, -conductance))
    by_void = rows.matrix((upstream, -carried * film))
    by_thickness = rows.matrix(
        (first, conductance_by_first * fall + carried * full * film_by_first),
        (second, conductance_by_second * fall + carried * full * film_by_second),
    )
    outflow = numpy.bincount(first, flow, mesh.cells) - numpy.bincount(second, flow, mesh.cells)
    # The rim: the film of the last cell, and lubricant without vapour outside.
    cell = mesh.rim_cell
    rim_film = thickness[cell]
    rim_conductance = mesh.rim_width * rim_film**3 / (12 * viscosity * mesh.rim_distance)
    rim_carried = 0.5 * rim_velocity * mesh.rim_width
    leaving = rim_velocity > 0
    rim_full = numpy.where(leaving, 1 - void[cell], 1.0)
    rim_fall = pressure[cell] - rim_pressure
    outflow += numpy.bincount(cell, rim_conductance * rim_fall + rim_carried * rim_film * rim_full, mesh.cells)
    rim = _RimRows(mesh.cells, cell)
    return Balance(
        outflow=outflow,
        by_pressure=by_pressure + rim.matrix(rim_conductance),
        by_void=by_void + rim.matrix(numpy.where(leaving, -rim_carried * rim_film, 0.0)),
        by_thickness=by_thickness + rim.matrix(3 * rim_conductance / rim_film * rim_fall + rim_carried * rim_full),
    )


@dataclass(frozen=True)
class _FaceRows:
    """Rows of the two cells of each face in a sparse matrix."""

    cells: int
    first: Numbers
    second: Numbers

    def matrix(self, *terms: tuple[Numbers, Numbers]) -> scipy.sparse.csr_matrix:
        """Add (column, flow from first to second) of each face to its two cells."""
        rows = numpy.concatenate([side for _ in terms for side in (self.first, self.second)])
        columns = numpy.concatenate([column for column, _ in terms for _ in range(2)])
        values = numpy.concatenate([part for _, flow in terms for part in (flow, -flow)])
        return scipy.sparse.csr_matrix((values, (rows, columns)), (self.cells, self.cells))


@dataclass(frozen=True)
class _RimRows:
    """Diagonal entries of the cells at the rim."""

    cells: int
    cell: Numbers

    def matrix(self, values: Numbers) -> scipy.sparse.csr_matrix:
        """Make a sparse matrix with `values` at the cells of the rim."""
        return scipy.sparse.csr_matrix((values, (self.cell, self.cell)), (self.cells, self.cells))


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
    softness : array (cells, cells), optional
        Further displacements of the surfaces per pressure in mm/MPa, of elastic bodies.
    """

    mesh: FilmMesh
    viscosity: float
    spin: Numbers
    gap: Numbers
    compliance: Numbers
    rim_pressure: Numbers
    force: Numbers | None = None
    softness: Numbers | None = None

    def displacement(self, pressure: Numbers) -> Numbers:
        """Compute the displacement of the surfaces in mm under pressures in MPa."""
        springs: Numbers = self.compliance * pressure
        return springs if self.softness is None else springs + self.softness @ pressure

    def slope_by_pressure(self, balance: Balance) -> Any:
        """Compute the derivative of the outflow by pressure at a fixed ball; of elastic bodies it is a full matrix."""
        springs = balance.by_pressure + balance.by_thickness @ scipy.sparse.diags_array(self.compliance)
        return springs if self.softness is None else springs.toarray() + balance.by_thickness @ self.softness

    def thickness(self, state: FilmState) -> Numbers:
        """Compute the film thickness of each cell in mm."""
        return self.gap - self.mesh.direction @ state.eccentricity + self.displacement(state.pressure)

    def load(self, pressure: Numbers) -> Numbers:
        """Integrate the pressure over the cup to a force (3,) in N."""
        return (pressure * self.mesh.area) @ self.mesh.direction


def solve_steady(problem: FilmProblem, start: FilmState, *, tolerance: float = 1e-8, max_steps: int = 100) -> FilmState:
    """Solve for the steady film by Newton's method from a close estimate."""
    return advance(problem, start, volume=None, step=inf, tolerance=tolerance, max_steps=max_steps)


def develop_film(problem: FilmProblem, start: FilmState, first_step: float, last_step: float) -> FilmState:
    """Solve for the steady film by time steps in s that grow from the first to the last one.

    The result is not converged if a step fails again and again; it is then the last film that was reached.
    """
    state, step, iterations = start, first_step, 0
    for _ in range(_MAX_TIME_STEPS):
        if not first_step / 1e3 < step < last_step:
            break
        volume = problem.thickness(state) * (1 - state.void)
        later = advance(problem, state, volume=volume, step=step, tolerance=1e-6, max_steps=25)
        iterations += later.iterations
        if not later.converged:
            step /= 3
            continue
        state = later
        step *= _GROWTH if later.iterations < _EASY_ITERATIONS else 1.0
    steady = solve_steady(problem, state)
    if not steady.converged:
        return replace(state, converged=False, iterations=iterations)
    return replace(steady, iterations=iterations + steady.iterations)


def advance(
    problem: FilmProblem,
    start: FilmState,
    *,
    volume: Numbers | None,
    step: float,
    tolerance: float = 1e-8,
    max_steps: int = 60,
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
    max_steps : int
        Largest number of Newton steps.
    """
    state = start
    for iteration in range(max_steps):
        state, change = _newton_step(problem, state, volume, step)
        if change < tolerance:
            return replace(state, converged=True, iterations=iteration + 1)
    return replace(state, converged=False, iterations=max_steps)


def _newton_step(
    problem: FilmProblem, state: FilmState, volume: Numbers | None, step: float
) -> tuple[FilmState, float]:
    """Take one damped Newton step; return the new state and the largest relative change."""
    thickness = problem.thickness(state)
    balance = balance_cells(
        problem.mesh, problem.spin, problem.viscosity, thickness, state.pressure, state.void, problem.rim_pressure
    )
    if volume is not None:
        balance = _add_storage(balance, problem.mesh.area, thickness, state.void, volume, step)
    choice = _CellUnknown.of(state.pressure, state.void)
    unknown, shift = _solve_linear(problem, state, balance, choice)
    pressure_change = choice.pressure_at + choice.pressure_by * unknown
    void_change = choice.void_at + choice.void_by * unknown
    film_change = problem.displacement(pressure_change) - problem.mesh.direction @ shift
    length = _step_length(thickness, film_change)
    later = replace(
        state,
        pressure=numpy.maximum(state.pressure + length * pressure_change, 0.0),
        void=numpy.clip(state.void + length * void_change, 0.0, 1.0),
        eccentricity=state.eccentricity + length * shift,
    )
    change = float(numpy.abs(later.pressure - state.pressure).max()) / max(float(later.pressure.max()), 1e-9)
    change += float(numpy.abs(later.void - state.void).max())
    return later, change / length


def _solve_linear(
    problem: FilmProblem, state: FilmState, balance: Balance, choice: _CellUnknown
) -> tuple[Numbers, Numbers]:
    """Solve the linear balance of a Newton step for the unknown of each cell and the shift of the ball in mm."""
    by_pressure = problem.slope_by_pressure(balance)
    matrix = _scale_columns(by_pressure, choice.pressure_by) + _scale_columns(balance.by_void, choice.void_by)
    right_side = -balance.outflow - by_pressure @ choice.pressure_at - balance.by_void @ choice.void_at
    solve = _factorise(matrix)
    unknown = solve(right_side)
    if problem.force is None:
        return unknown, numpy.zeros(3)
    # the three displacements of the ball balance the load: a border of three columns and rows
    by_shift = balance.by_thickness @ problem.mesh.direction
    response = numpy.stack([solve(by_shift[:, axis]) for axis in range(3)], axis=1)
    weight = (problem.mesh.area[:, None] * problem.mesh.direction).T
    pressure = state.pressure + choice.pressure_at + choice.pressure_by * unknown
    shift = numpy.linalg.solve((weight * choice.pressure_by) @ response, problem.force - problem.load(pressure))
    return unknown + response @ shift, shift


def _scale_columns(matrix: Any, factors: Numbers) -> Any:
    """Multiply the columns of a sparse or a full matrix by factors."""
    return matrix @ scipy.sparse.diags_array(factors) if scipy.sparse.issparse(matrix) else matrix * factors


def _factorise(matrix: Any) -> Callable[[Numbers], Numbers]:
    """Factorise a sparse or a full matrix with scaled rows; return the function that solves with it."""
    largest = abs(matrix).max(axis=1)
    largest = largest.toarray().ravel() if scipy.sparse.issparse(matrix) else numpy.asarray(largest).ravel()
    scale = 1 / numpy.maximum(largest, 1e-300)
    if scipy.sparse.issparse(matrix):
        sparse: Any = scipy.sparse.linalg.splu((scipy.sparse.diags_array(scale) @ matrix).tocsc())
        return lambda right_side: sparse.solve(scale * right_side)
    full = scipy.linalg.lu_factor(numpy.asarray(matrix) * scale[:, None], overwrite_a=True, check_finite=False)
    return lambda right_side: scipy.linalg.lu_solve(full, scale * right_side, check_finite=False)


def _step_length(thickness: Numbers, film_change: Numbers) -> float:
    """Choose the factor of a Newton step so that no cell loses most of its film."""
    thin = film_change < -_LARGEST_FALL * thickness
    if not thin.any():
        return 1.0
    return max(_MIN_STEP, float((_LARGEST_FALL * thickness[thin] / -film_change[thin]).min()))


@dataclass(frozen=True)
class _CellUnknown:
    """Unknown of each cell, its pressure where the film is full and its void elsewhere.

    Change of pressure and of void are linear in the unknown: `at + by * unknown`. They solve the linear form of the
    Fischer-Burmeister function a + b - sqrt(a² + b²) = 0 of a = p/scale and b = void.
    """

    pressure_at: Numbers
    pressure_by: Numbers
    void_at: Numbers
    void_by: Numbers

    @classmethod
    def of(cls, pressure: Numbers, void: Numbers) -> _CellUnknown:
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


def _add_storage(
    balance: Balance, area: Numbers, thickness: Numbers, void: Numbers, volume: Numbers, step: float
) -> Balance:
    """Add the growth of the lubricant in each cell over a time step to the outflow."""
    return Balance(
        outflow=balance.outflow + area * (thickness * (1 - void) - volume) / step,
        by_pressure=balance.by_pressure,
        by_void=balance.by_void - scipy.sparse.diags_array(area * thickness / step),
        by_thickness=balance.by_thickness + scipy.sparse.diags_array(area * (1 - void) / step),
    )
