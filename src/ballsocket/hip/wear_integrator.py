"""Integration of wear and creep over millions of cycles, in blocks with a controlled error.

A block is a Runge-Kutta-Chebyshev step: explicit, second order, stable over long steps of decaying processes.
Sommeijer, Shampine & Verwer 1998, doi 10.1016/S0377-0427(97)00219-7.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache, partial
from math import inf, sqrt
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers
from .ball_wear import select_active_cells
from .creep_law import CreepLaw
from .hip_setup import HipSetup
from .socket_foundation import CycleEquilibrium
from .wear_law import CycleExposure, max_wear_sensitivity

_FIRST_BLOCK = 1e-2  # length of the first block, relative to the time in which the fastest wave of the bore decays
_STEP_SAFETY = 0.8  # safety factor of the next block's length
_MIN_GROWTH, _MAX_GROWTH = 0.2, 4.0  # limits of the ratio of a block's length to that of the block before
_RATE_SAFETY = 1.1  # safety factor of the fastest decay rate
_FIRST_CREEP_BLOCK = 30.0  # length in s of the first block with creep
_CREEP_GROWTH = 0.25  # length of a block with creep, relative to the total time before it
_MAX_CREEP_SWEEPS = 8  # largest number of iterations for the mean pressure under which the liner creeps
_CREEP_TOLERANCE = 1e-3  # relative tolerance of that mean pressure
_MARGIN = 0.3  # initial margin of the active cells, relative to the largest overlap

Rate = Callable[[Numbers], Numbers]  # function from values to their rate of change per unit of length

_DAMPING = 2 / 13
_STABILITY = 1.54  # stability constant β: a step h with s stages is stable up to h ρ = ((s - 1)² - 1)/β

_MAX_STAGES = 60


@dataclass(frozen=True, kw_only=True, eq=False)
class ChebyshevStep:
    """Result of one Runge-Kutta-Chebyshev step."""

    # values and their rate of change at the end of the step
    values: Numbers
    rate: Numbers
    error: Numbers  # estimated local error of the values


def stage_count(length: float, spectral_radius: float) -> int:
    """Compute the number of stages, 2 to 60, for a stable step; `spectral_radius` is the largest decay rate."""
    return min(max(2, 1 + int(sqrt(1 + _STABILITY * length * spectral_radius)) + 1), _MAX_STAGES)


def max_step_length(spectral_radius: float) -> float:
    """Compute the length of the longest stable step; infinite for a decay rate of 0."""
    return ((_MAX_STAGES - 2) ** 2 - 1) / (_STABILITY * spectral_radius) if spectral_radius > 0 else float("inf")


@lru_cache(maxsize=_MAX_STAGES)
def _stage_coefficients(stages: int) -> tuple[tuple[float, ...], ...]:
    """Compute the coefficients (μ, ν, μ~, γ~) of all Runge-Kutta-Chebyshev stages."""
    w0 = 1 + _DAMPING / stages**2
    T, D, S = [1.0, w0], [0.0, 1.0], [0.0, 0.0]  # Chebyshev polynomials at w0, their first and second derivatives
    for _ in range(2, stages + 1):
        T.append(2 * w0 * T[-1] - T[-2])
        D.append(2 * w0 * D[-1] - D[-2] + 2 * T[-2])
        S.append(2 * w0 * S[-1] - S[-2] + 4 * D[-2])
    w1 = D[-1] / S[-1]
    b = [S[j] / D[j] ** 2 if j > 1 else S[2] / D[2] ** 2 for j in range(stages + 1)]
    rows: list[tuple[float, ...]] = [(0.0, 0.0, b[1] * w1, 0.0)]
    for j in range(2, stages + 1):
        mu_tilde = 2 * b[j] * w1 / b[j - 1]
        rows.append((2 * b[j] * w0 / b[j - 1], -b[j] / b[j - 2], mu_tilde, -(1 - b[j - 1] * T[j - 1]) * mu_tilde))
    return tuple(rows)


def integrate_step(rate: Rate, values: Numbers, slope: Numbers, length: float, stages: int) -> ChebyshevStep:
    """Integrate a differential equation over one Runge-Kutta-Chebyshev step, with an error estimate.

    `values` and `slope` are the values and their rate of change at the beginning; `stages` as of `stage_count`.
    """
    (_, _, first_mu_tilde, _), *further_stages = _stage_coefficients(stages)
    previous, current = values, values + first_mu_tilde * length * slope
    for mu, nu, mu_tilde, gamma in further_stages:
        following = (
            (1 - mu - nu) * values + mu * current + nu * previous + length * (mu_tilde * rate(current) + gamma * slope)
        )
        previous, current = current, following
    end_rate = rate(current)
    # (12 (y_n - y_n+1) + 6 h (f_n + f_n+1))/15
    error = 0.8 * (values - current) + 0.4 * length * (slope + end_rate)
    return ChebyshevStep(values=current, rate=end_rate, error=numpy.asarray(error))


@dataclass(kw_only=True, eq=False)
class WearIntegrator:
    """Integrator of wear and creep: state of a run, advanced in blocks of cycles."""

    setup: HipSetup
    cycles: float = 0.0  # number of cycles so far
    depth: Numbers = field(default_factory=lambda: numpy.zeros(0))  # (cells,), worn depth of the socket in mm
    # (ball's cells,), worn depth of the ball in mm; empty for a ball without wear
    ball: Numbers = field(default_factory=lambda: numpy.zeros(0))
    work: float = 0.0  # ∫∫ p v dA dt so far, in N mm
    length: float = inf  # length of the next block in cycles
    steps: int = 0  # number of blocks so far
    converged: bool = True  # True if every contact balanced its load
    volume_error: float = 0.0  # estimated error of the worn volume by the blocks, in mm³
    margin: float = _MARGIN  # margin of the active cells around the contacts, relative to the largest overlap

    def __post_init__(self) -> None:
        """Initialize the state of the integrator for an unworn bore."""
        self.depth = numpy.zeros(len(self.setup.foundation.areas))
        self.ball = numpy.zeros(0 if self.setup.ball_wear is None else len(self.setup.ball_areas))
        creep, cell_count = self.setup.creep, len(self.depth)
        self.strain = numpy.zeros((1, cell_count)) if creep is None else creep.initial_strain(cell_count)
        self.equilibrium = self.setup.unworn
        self._update_active_cells()
        if self._max_decay_rate > 0:
            self.length = _FIRST_BLOCK / self._max_decay_rate

    @property
    def creep_depth(self) -> Numbers:
        """Depth in mm of each cell by creep of the liner: (cells,)."""
        strain = self.strain.sum(axis=0)
        if not strain.any():
            return strain
        return self.setup.foundation.smooth(float(self.setup.joint.liner_thickness) * strain)

    @property
    def volume(self) -> float:
        """Worn volume of the socket in mm³."""
        return float(self.depth @ self.setup.foundation.areas)

    @property
    def ball_volume(self) -> float:
        return float(self.ball @ self.setup.ball_areas) if len(self.ball) else 0.0

    def _update_active_cells(self) -> None:
        """Select the active cells, those near the contacts, and compute their wear per cycle."""
        mask = self.setup.foundation.cells_near_contact(self.equilibrium, self.depth + self.creep_depth, self.margin)
        cells = numpy.flatnonzero(mask)
        self._active = select_active_cells(self.setup, cells)
        self._active_creep = self.creep_depth[cells]
        self._rate = self._compute_change_per_cycle(self._state_vector)

    @property
    def _state_vector(self) -> Numbers:
        """State vector: worn depths in mm of the active cells of socket and ball, and friction work."""
        active = self._active
        return numpy.concatenate([self.depth[active.cells], self.ball[active.ball_cells], [self.work]])

    def _compute_change_per_cycle(self, state_vector: Numbers) -> Numbers:
        active, socket_cell_count = self._active, len(self._active.cells)
        depth = state_vector[:socket_cell_count] + self._active_creep
        if active.counterface is not None:
            depth = depth + active.counterface.depth_on_socket(state_vector[socket_cell_count:-1])
        equilibrium = active.foundation.solve_equilibrium(
            self.setup.frame.loads, depth, self.equilibrium, self.setup.frame.lateral_stiffness
        )
        self.equilibrium = equilibrium
        self.converged = self.converged and equilibrium.converged
        contact_shares = partial(active.foundation.contact_shares, equilibrium, depth)
        self._exposure = CycleExposure(
            pressure=equilibrium.pressure, sliding=active.sliding, contact_shares=contact_shares
        )
        wear_per_cycle = active.foundation.smooth(self.setup.wear.depth(self._wearing_exposure))
        work_per_cycle = float(self._exposure.work @ active.foundation.areas)
        ball_wear_per_cycle = numpy.zeros(0)
        if active.counterface is not None and self.setup.ball_wear is not None:
            ball_wear_per_cycle = self.setup.ball_wear.depth(active.counterface.ball_exposure(self._wearing_exposure))
        return numpy.concatenate([wear_per_cycle, ball_wear_per_cycle, [work_per_cycle]])

    @property
    def _wearing_exposure(self) -> CycleExposure:
        """Exposure of the active cells where they wear, by the limit of the film ratio."""
        return self.setup.wearing_exposure(self._exposure, self._active.cells)

    @property
    def _max_decay_rate(self) -> float:
        """Largest decay rate per cycle of a wave on the worn bore: wear sensitivity times stiffness."""
        exposure = self._wearing_exposure
        sensitivity = max_wear_sensitivity(self.setup.wear, exposure)
        counterface = self._active.counterface
        if counterface is not None and self.setup.ball_wear is not None:
            sensitivity += max_wear_sensitivity(self.setup.ball_wear, counterface.ball_exposure(exposure))
        return _RATE_SAFETY * sensitivity * self.setup.foundation.max_stiffness

    @property
    def state(self) -> dict[str, Any]:
        """State of the simulation between two blocks, as named arrays for a checkpoint.

        A resumed run equals an uninterrupted run bit by bit.
        """
        equilibrium, numbers = self.equilibrium, {name: getattr(self, name) for name in _STATE}
        arrays = {
            "cells": self._active.cells,
            "rate": self._rate,
            "equilibrium_displacement": equilibrium.displacement,
            "equilibrium_pressure": equilibrium.pressure,
            "equilibrium_converged": equilibrium.converged,
        }
        if equilibrium.levels is not None:
            arrays["level_displacement"], arrays["level_pressure"] = equilibrium.levels
        return {**numbers, **arrays}

    def resume(self, state: Mapping[str, Numbers]) -> None:
        """Restore a stored state with its contacts, without solving the contacts again."""
        for name, convert in _STATE.items():
            setattr(self, name, convert(state[name]))
        self._active = select_active_cells(self.setup, state["cells"])
        self._active_creep = self.creep_depth[state["cells"]]
        self._rate = state["rate"]
        has_levels = "level_displacement" in state
        self.equilibrium = CycleEquilibrium(
            displacement=state["equilibrium_displacement"],
            pressure=state["equilibrium_pressure"],
            converged=bool(state["equilibrium_converged"]),
            levels=(state["level_displacement"], state["level_pressure"]) if has_levels else None,
        )
        self._exposure = CycleExposure(pressure=self.equilibrium.pressure, sliding=self._active.sliding)

    def run_until(self, count: float, progress: Callable[[float], None]) -> WearIntegrator:
        """Integrate wear and creep up to a number of cycles, and return this integrator."""
        while self.cycles < count:
            self._advance_block(count)
            progress(self.cycles)
        return self

    def _advance_block(self, count: float) -> None:
        """Integrate one block of cycles, whose length is limited by its error and the final count."""
        decay_rate, remaining, creep_step = self._max_decay_rate, count - self.cycles, inf
        if self.setup.creep:
            creep_step = max(_CREEP_GROWTH * self.cycles, _FIRST_CREEP_BLOCK / self.setup.seconds)
        while True:
            length = min(self.length, max_step_length(decay_rate), creep_step)
            # two last blocks share the remaining cycles equally
            length = remaining if length >= remaining else min(length, remaining / 2)
            block = integrate_step(
                self._compute_change_per_cycle, self._state_vector, self._rate, length, stage_count(length, decay_rate)
            )
            depth = self.depth + self.creep_depth
            depth[self._active.cells] = block.values[: len(self._active.cells)] + self._active_creep
            if self._reaches_inactive_cells(depth, 0.0):
                self.margin *= 2
                self._update_active_cells()
                continue
            relative_error = self._relative_block_error(block, decay_rate)
            self.length = length * min(
                max(_STEP_SAFETY * max(relative_error, 1e-12) ** (-1 / 3), _MIN_GROWTH), _MAX_GROWTH
            )
            if relative_error <= 1:
                break
        self.volume_error += abs(float(block.error[:-1] @ self._active.areas))
        active, socket_cell_count = self._active, len(self._active.cells)
        self.depth, self.ball, self.work = self.depth.copy(), self.ball.copy(), float(block.values[-1])
        self.depth[active.cells] = block.values[:socket_cell_count]
        self.ball[active.ball_cells] = block.values[socket_cell_count:-1]
        self.steps, self._rate = self.steps + 1, block.rate
        self.cycles = count if length == remaining else self.cycles + length
        if self.setup.creep is not None:
            self._advance_creep_strain(self.setup.creep, length * self.setup.seconds)
        depth = self.depth + self.creep_depth
        if self.setup.creep is not None or self._reaches_inactive_cells(depth, self.margin / 2):
            self._update_active_cells()

    def _advance_creep_strain(self, creep: CreepLaw, seconds: float) -> None:
        """Advance the creep strains by a time in s under the mean pressures of a cycle, which creep decreases."""
        active, setup = self._active, self.setup
        weights = setup.cycle.seconds[setup.frame.loaded] / setup.cycle.duration
        recovered_strain, strain_per_pressure = creep.linear_response(self.strain[:, active.cells], seconds)
        thickness = float(setup.joint.liner_thickness)
        mean_pressure = weights @ self._exposure.pressure
        stiffness = active.foundation.max_stiffness * (weights @ (self._exposure.pressure > 0))
        for _ in range(_MAX_CREEP_SWEEPS):
            self._active_creep = active.foundation.smooth(
                thickness * (recovered_strain + strain_per_pressure * mean_pressure)
            )
            self._compute_change_per_cycle(self._state_vector)
            pressure_change = (weights @ self._exposure.pressure - mean_pressure) / (
                1 + stiffness * thickness * strain_per_pressure
            )
            mean_pressure = numpy.maximum(mean_pressure + pressure_change, 0.0)
            if abs(pressure_change).max(initial=0.0) <= _CREEP_TOLERANCE * mean_pressure.max(initial=0.0):
                break
        pressure = numpy.zeros(len(self.depth))
        pressure[active.cells] = mean_pressure
        self.strain = creep.advance_strain(self.strain, pressure, seconds)

    def _relative_block_error(self, block: ChebyshevStep, decay_rate: float) -> float:
        """Estimate the root mean square depth error of a block, divided by the allowed error."""
        initial_depth = _FIRST_BLOCK * float(self._rate[:-1].max(initial=0.0)) / decay_rate if decay_rate > 0 else 0.0
        allowed_error = self.setup.tolerance * max(float(block.values[:-1].max(initial=0.0)), initial_depth)
        depth_error = block.error[:-1]
        mean_error = float(numpy.sqrt(depth_error @ depth_error / max(len(depth_error), 1)))
        return mean_error / allowed_error if allowed_error > 0 else 0.0

    def _reaches_inactive_cells(self, depth: Numbers, margin: float) -> bool:
        """Check if a contact on a bore of a depth (cells,) in mm reaches inactive cells, or comes near to them."""
        mask = self.setup.foundation.cells_near_contact(self.equilibrium, depth, margin)
        mask[self._active.cells] = False
        return bool(mask.any())


_STATE: Mapping[str, Callable[[Any], Any]] = MappingProxyType(
    {
        "cycles": float,
        "depth": numpy.asarray,
        "ball": numpy.asarray,
        "strain": numpy.asarray,
        "work": float,
        "length": float,
        "steps": int,
        "converged": bool,
        "volume_error": float,
        "margin": float,
    }
)
"""Types of the attributes in a stored state."""
