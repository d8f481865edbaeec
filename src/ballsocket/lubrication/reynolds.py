"""Reynolds' equation with mass-conserving cavitation, the load balance, and liners as springs.

In each cell either the film is full (void fraction 0, pressure p >= 0 above the vapour) or it holds vapour (p = 0).
Both conditions are one equation per cell, the Fischer-Burmeister function. Newton's method solves them with the
balance of volume and, where a load is given, the three forces.

Source: Woloszynski, Podsiadlo, Stachowiak, Tribology Letters 58 (2015) 18, doi:10.1007/s11249-015-0487-4 (method).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import TYPE_CHECKING

import numpy

from ..core.arrays import Numbers
from .mesh import FilmMesh
from .newton_system import CellUnknown, NewtonSystem, add_storage, balance_cells

if TYPE_CHECKING:
    from .dry_contact import ElasticSoftness

_LARGEST_FALL = 0.6  # largest part of a cell's film that one Newton step may take away
_SMOOTH, _FRONT = 0.1, 0.3  # largest relative change of a smooth film across a face, and the least of a front
_SHARE_UPDATES = 3  # number of Newton steps after which the share of central differences is fixed
_GROWTH = 1.8  # growth of the time steps on the way to the steady film
_MAX_TIME_STEPS = 40  # number of time steps on the way to the steady film after which it counts as not converged
_EASY_ITERATIONS = 10  # number of Newton steps up to which the next time step grows
_FARTHEST = 100.0  # displacement of the ball, relative to the largest gap, at which an iteration ends without a result
_MAX_LOAD_ERROR = 1e-3  # largest error of the balance of the load, relative to the load


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmState:
    """Pressure, vapour and position of the ball."""

    pressure: Numbers  # (cells,), pressure above the vapour pressure in MPa
    void: Numbers  # (cells,), fraction of the film that is vapour, 0 to 1
    eccentricity: Numbers  # (3,), displacement of the ball from the centre of the cup in mm
    converged: bool = True
    iterations: int = 0


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmProblem:
    """Film between a ball and a cup whose surface yields in proportion to the pressure."""

    mesh: FilmMesh
    viscosity: float  # viscosity in MPa s
    spin: Numbers  # (3,), rotation rate of the ball in rad/s
    gap: Numbers  # (cells,), film thickness in mm of the centred ball on the undeformed cup
    compliance: Numbers  # (cells,), displacement of the surface per pressure in mm/MPa; zeros on a rigid cup
    rim_pressure: Numbers  # (rim faces,), pressure of the lubricant at the rim in MPa
    force: Numbers | None = None  # (3,), load on the ball in N; None holds the ball where it is
    softness: ElasticSoftness | None = None  # further displacements of the surfaces, of elastic bodies
    # share of central differences in the carried film at each face, 0 to 1; the rest is the film upstream. None is
    # `smooth_share`.
    central_share: float | None = 1.0

    def displacement(self, pressure: Numbers) -> Numbers:
        """Compute the displacement of the surfaces in mm under pressures in MPa."""
        springs: Numbers = self.compliance * pressure
        return springs if self.softness is None else springs + self.softness(pressure)

    def thickness(self, state: FilmState) -> Numbers:
        """Compute the film thickness of each cell in mm."""
        return self.gap - self.mesh.direction @ state.eccentricity + self.displacement(state.pressure)

    def load(self, pressure: Numbers) -> Numbers:
        """Integrate the pressure over the cup to a force (3,) in N."""
        return (pressure * self.mesh.area) @ self.mesh.direction


def smooth_share(mesh: FilmMesh, thickness: Numbers) -> Numbers:
    """Compute the share of central differences in the carried film: 1 where it is smooth, and 0 at its fronts.

    Central differences are of second order. In a time step they make new extremes at a front, a change by 30 % or more
    of the thinner side, and the film may become thinner than nothing. The film upstream makes none, and is of first
    order. A change up to 10 % counts as smooth.
    """
    across = numpy.abs(thickness[mesh.second] - thickness[mesh.first])
    step = across / numpy.minimum(thickness[mesh.second], thickness[mesh.first])
    return numpy.asarray(numpy.clip((_FRONT - step) / (_FRONT - _SMOOTH), 0.0, 1.0))


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
    """Solve for the film after a time step in s by implicit Euler; `inf` gives the steady film.

    `volume` (cells,) is the lubricant per area at the start of the step in mm, None for a steady film. `tolerance` is
    the largest change of the last of at most `max_steps` Newton steps, relative to the largest pressure and to the
    film.
    """
    state = start
    share: Numbers | float = 1.0 if problem.central_share is None else problem.central_share
    for iteration in range(max_steps):
        if problem.central_share is None and iteration < _SHARE_UPDATES:
            share = smooth_share(problem.mesh, problem.thickness(state))
        try:
            later, change = _newton_step(problem, state, volume, step, share)
        except (RuntimeError, numpy.linalg.LinAlgError):  # singular matrix
            return replace(state, converged=False, iterations=iteration)
        lost = float(numpy.linalg.norm(later.eccentricity)) > _FARTHEST * float(numpy.abs(problem.gap).max())
        if lost or not isfinite(change):
            return replace(state, converged=False, iterations=iteration)
        state = later
        if change < tolerance:
            return replace(state, converged=_is_physical(problem, state), iterations=iteration + 1)
    return replace(state, converged=False, iterations=max_steps)


def _is_physical(problem: FilmProblem, state: FilmState) -> bool:
    if not problem.thickness(state).min() > 0:
        return False
    if problem.force is None:
        return True
    error = numpy.linalg.norm(problem.force - problem.load(state.pressure))
    return bool(error <= _MAX_LOAD_ERROR * numpy.linalg.norm(problem.force))


def _newton_step(
    problem: FilmProblem, state: FilmState, volume: Numbers | None, step: float, share: Numbers | float
) -> tuple[FilmState, float]:
    """Take one damped Newton step; return the new state and the largest relative change."""
    thickness = problem.thickness(state)
    balance = balance_cells(
        problem.mesh,
        problem.spin,
        problem.viscosity,
        thickness,
        state.pressure,
        state.void,
        problem.rim_pressure,
        share,
    )
    if volume is not None:
        balance = add_storage(balance, problem.mesh.area, thickness, state.void, volume, step)
    choice = CellUnknown.of(state.pressure, state.void)
    unknown, shift = NewtonSystem(
        balance=balance,
        unknown=choice,
        compliance=problem.compliance,
        softness=problem.softness,
        direction=problem.mesh.direction,
        weight=(problem.mesh.area[:, None] * problem.mesh.direction).T,
        missing_force=None if problem.force is None else problem.force - problem.load(state.pressure),
    ).solve()
    pressure_change = choice.pressure_at + choice.pressure_by * unknown
    void_change = choice.void_at + choice.void_by * unknown
    film_change = problem.displacement(pressure_change) - problem.mesh.direction @ shift
    thin = film_change < -_LARGEST_FALL * thickness  # a whole step would take most of the film of these cells
    length = float((_LARGEST_FALL * thickness[thin] / -film_change[thin]).min(initial=1.0))
    later = replace(
        state,
        pressure=numpy.maximum(state.pressure + length * pressure_change, 0.0),
        void=numpy.clip(state.void + length * void_change, 0.0, 1.0),
        eccentricity=state.eccentricity + length * shift,
    )
    change = float(numpy.abs(later.pressure - state.pressure).max()) / max(float(later.pressure.max()), 1e-9)
    change += float(numpy.abs(later.void - state.void).max())
    return later, change / length
