"""Equilibrium of the ball under prescribed loads, by Newton's method for a batch of balls.

The coupled search of `lane_solver` comes first where it applies. The guarded search here solves what remains: warm
starts, springs, circular gaps, small grids, and loads at first touch or at the limit of the bore.

The total potential, stored energy minus the work of the load, is least at equilibrium. A step that increases both this
potential and the residual force is rejected and shortened. The tangent is solved at the start and after steps that gain
little. Between these, secants of the computed forces update it (Broyden, Fletcher, Goldfarb, Shanno).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy

from ...core.arrays import Numbers
from .bore_contact import BoreContact, EquilibriumBatch
from .lane_solver import coarser_lanes, solve_lanes
from .pressure_solver import TOLERANCE, solve_pressure

_MAX_ITERATIONS = 80

_MAX_COARSE_ITERATIONS = 15

_FORCE_TOLERANCE = 1e-6  # residual force at equilibrium, relative to the load
_COARSE_FORCE_TOLERANCE = 1e-3  # residual force at the end of the search in wide cells, relative to the load
_MAX_PRESSURE_TOLERANCE = 1e-2  # loosest tolerance of the pressures in an iteration
_PRESSURE_TOLERANCE_FACTOR = 0.02  # tolerance of the next pressures, relative to the residual force
_MIN_GAIN = 0.2  # ratio of residual forces after and before a step, above which the tangent is solved again
_NOISE_FACTOR = 5.0  # residual force that may come from inexact pressures alone, relative to their tolerance

_REGULARISATION = 1e-12
"""Fraction of the trace of a stiffness, added to each direction so that one without stiffness stays solvable."""

_MIN_DAMPING = 1e-6  # fraction of the trace that shortens the step after the first rejected one
_NEGLIGIBLE_DAMPING = 1e-10  # fraction of the trace below which damping ends

_STATE_NAMES = (
    *("load", "force_scale", "displacement", "pressure", "sensitivity", "force", "tangent", "residual", "potential"),
    *("tolerance", "damping", "separation", "used_tolerance", "converged", "stale"),
)
"""Arrays of `_NewtonSearch` with one entry per ball."""


def solve_force(
    bore: BoreContact, load: Numbers, start: Numbers, held: Numbers, pressure: Numbers | None = None
) -> EquilibriumBatch:
    """Solve the displacements and pressures of balls in equilibrium with their loads.

    Loads (batch, 3) are in N, none of them zero. Initial displacements (batch, 3) in mm touch the bore. Balls that are
    not `held` (batch,) stay there without pressure. Without initial pressures (batch, rings, meridians) in MPa, at
    least 0, a search in cells twice as wide comes first.
    """
    solution = bore.unsolved_batch(start)
    preload = bore.area * bore.compliance.uniform_stiffness * max(-bore.gap.clearance, 0.0)
    force_scale = numpy.maximum(numpy.linalg.norm(load, axis=1), preload)
    coarser = coarser_lanes(bore)
    if pressure is None and coarser is not None:
        lanes = solve_lanes(bore, coarser, load[held], force_scale[held], start[held], _FORCE_TOLERANCE)
        solution.store(numpy.flatnonzero(held), lanes)
        held = held & ~solution.converged
    for block in bore.split_into_blocks(numpy.flatnonzero(held)):
        initial = None if pressure is None else pressure[block]
        solution.store(block, _solve_block(bore, load[block], force_scale[block], start[block], initial))
    return solution


@dataclass(frozen=True, kw_only=True, eq=False)
class _SearchResult(EquilibriumBatch):
    """Displacements and pressures of balls at the end of an equilibrium search."""

    # (batch, 3, rings, meridians), approximate derivative of the pressure by the displacement, in MPa/mm
    sensitivity: Numbers
    tangent: Numbers  # (batch, 3, 3), approximate stiffness in N/mm


def _solve_block(
    bore: BoreContact, load: Numbers, force_scale: Numbers, start: Numbers, pressure: Numbers | None
) -> _SearchResult:
    coarse = None
    if pressure is None and bore.coarser_bore is not None:
        coarse = _solve_coarse(bore, bore.coarser_bore, load, force_scale, start)
    return _iterate_search(_NewtonSearch(bore, load, force_scale, start, pressure, coarse), _MAX_ITERATIONS)


def _solve_coarse(
    bore: BoreContact, coarser: BoreContact, load: Numbers, force_scale: Numbers, start: Numbers
) -> _SearchResult:
    search = _NewtonSearch(coarser, load, force_scale, start, None, tolerance=_COARSE_FORCE_TOLERANCE)
    result = _iterate_search(search, _MAX_COARSE_ITERATIONS)
    pressure, sensitivity = (bore.compliance.grid.refine(field) for field in (result.pressure, result.sensitivity))
    displacement = numpy.where(result.converged[:, None], result.displacement, start)
    return replace(result, displacement=displacement, pressure=pressure, sensitivity=sensitivity)


def _iterate_search(search: _NewtonSearch, max_iterations: int) -> _SearchResult:
    result = _SearchResult(
        displacement=search.displacement.copy(),
        pressure=search.pressure.copy(),
        converged=numpy.zeros(len(search.load), dtype=bool),
        sensitivity=search.sensitivity.copy(),
        tangent=search.tangent.copy(),
    )
    active = numpy.arange(len(search.load))
    for number in range(max_iterations):
        search.evaluate_trial()
        finished = search.converged | (number == max_iterations - 1)
        for name, values in vars(result).items():
            values[active[finished]] = getattr(search, name)[finished]
        search.select_balls(~finished)
        active = active[~finished]
        if not len(active):
            break
        search.advance_trial()
    return result


class _NewtonSearch:
    """State of an equilibrium search by Newton's method: best displacements so far, and the next trial."""

    def __init__(
        self,
        bore: BoreContact,
        load: Numbers,
        force_scale: Numbers,
        start: Numbers,
        pressure: Numbers | None,
        coarse: _SearchResult | None = None,
        tolerance: float = _FORCE_TOLERANCE,
    ) -> None:
        """Initialise the search at the displacements `start`, or from the search in wide cells."""
        self.bore, self.load, self.force_scale, self.force_tolerance = bore, load, force_scale, tolerance
        count, grid = len(load), bore.compliance.grid
        cells = grid.rings, grid.meridians
        self.displacement, self.trial, self.initial_pressure = start.copy(), start, pressure
        self.pressure = numpy.zeros((count, *cells))
        self.sensitivity = numpy.zeros((count, 3, *cells), dtype=numpy.float32)
        self.force, self.tangent = numpy.zeros((count, 3)), numpy.zeros((count, 3, 3))
        self.residual, self.potential = numpy.full(count, numpy.inf), numpy.full(count, numpy.inf)
        self.tolerance, self.damping = numpy.full(count, _MAX_PRESSURE_TOLERANCE), numpy.zeros(count)
        self.separation, self.used_tolerance = numpy.zeros(count), numpy.full(count, _MAX_PRESSURE_TOLERANCE)
        self.converged, self.stale = numpy.zeros(count, dtype=bool), numpy.ones(count, dtype=bool)
        if coarse is not None:
            self.trial, self.initial_pressure, self.stale = coarse.displacement, coarse.pressure, ~coarse.converged
            self.sensitivity, self.tangent = coarse.sensitivity, coarse.tangent
            self.tolerance = numpy.where(coarse.converged, _COARSE_FORCE_TOLERANCE, _MAX_PRESSURE_TOLERANCE)

    def evaluate_trial(self) -> None:
        """Solve the contacts at the trial displacements, and accept those that are closer to equilibrium."""
        overlap = self.bore.gap.overlap(self.trial)
        solution = solve_pressure(self.bore.compliance, overlap, self.initial_pressure, self.tolerance)
        tether_force = self.trial @ self.bore.tether
        force = self.bore.force(solution.pressure) + tether_force
        residual = numpy.linalg.norm(self.load - force, axis=1) / self.force_scale
        work = numpy.einsum("bk,bk->b", self.trial, self.load - tether_force / 2)
        potential = self.bore.area * solution.energy - work
        separation = numpy.minimum(overlap.max(axis=(1, 2)), 0.0)
        first = numpy.isinf(self.potential)
        lower = potential <= self.potential
        lower |= (residual < self.residual) | (residual < _NOISE_FACTOR * self.used_tolerance)
        better = first | ((separation == 0) & lower) | (separation > self.separation)
        accurate = self.tolerance <= max(self.force_tolerance, TOLERANCE)
        self.converged = better & solution.converged & (residual <= self.force_tolerance) & accurate
        self.stale = better & numpy.where(first, self.stale, residual > _MIN_GAIN * self.residual)
        self._update_tangent(better & ~first, force)
        stronger = numpy.maximum(30 * self.damping, _MIN_DAMPING)
        weaker = numpy.where(self.damping > _NEGLIGIBLE_DAMPING, self.damping / 10, 0.0)
        self.damping = numpy.where(better, weaker, stronger)
        accepted = {"force": force, "residual": residual, "potential": potential, "pressure": solution.pressure}
        accepted |= {"separation": separation, "displacement": self.trial, "used_tolerance": self.tolerance}
        for name, value in accepted.items():
            getattr(self, name)[better] = value[better]

    def _update_tangent(self, mask: Numbers, force: Numbers) -> None:
        """Update the tangents of the balls in a mask from the last step, by the BFGS formula."""
        s, y, J = self.trial - self.displacement, force - self.force, self.tangent
        Js = numpy.einsum("bkl,bl->bk", J, s)
        sy, sJs = (numpy.einsum("bk,bk->b", s, vector) for vector in (y, Js))
        mask = mask & (sy > 1e-3 * sJs) & (sJs > 0)
        for sign, vector, scale in ((1, y, sy), (-1, Js, sJs)):
            outer = vector[mask, :, None] * vector[mask, None, :]
            J[mask] += sign * outer / scale[mask, None, None]

    def select_balls(self, mask: Numbers) -> None:
        """Continue the search with only the balls in a mask (batch,)."""
        if mask.all():
            return
        for name in _STATE_NAMES:
            setattr(self, name, getattr(self, name)[mask])

    def advance_trial(self) -> None:
        """Compute the next trial displacements: Newton's step, or a step back to the bore after separation."""
        if self.stale.any():
            stale = self.stale
            start = self.sensitivity[stale] if self.sensitivity[stale].any() else None
            self.sensitivity[stale] = self.bore.pressure_sensitivity(
                self.displacement[stale], self.pressure[stale] > 0, start
            )
            self.tangent[stale] = self.bore.tangent(self.sensitivity[stale])
        along = self.load / self.force_scale[:, None]
        return_step = -1.1 * self.separation[:, None] * along
        step = numpy.where(self.separation[:, None] < 0, return_step, self._newton_step())
        self.trial = self.displacement + step
        increase = numpy.einsum("bk,bkij->bij", step.astype(numpy.float32), self.sensitivity)
        self.initial_pressure = numpy.maximum(self.pressure + increase, 0.0)
        tightest = max(self.force_tolerance, TOLERANCE)
        self.tolerance = numpy.clip(_PRESSURE_TOLERANCE_FACTOR * self.residual, tightest, _MAX_PRESSURE_TOLERANCE)

    def _newton_step(self) -> Numbers:
        """Compute Newton's step in mm, (batch, 3), from the damped tangent and the residual force."""
        trace = numpy.trace(self.tangent, axis1=1, axis2=2)
        diagonal = numpy.where(trace > 0, (_REGULARISATION + self.damping) * trace, 1.0)
        matrices = self.tangent + diagonal[:, None, None] * numpy.eye(3)
        return numpy.linalg.solve(matrices, (self.load - self.force)[:, :, None])[:, :, 0]
