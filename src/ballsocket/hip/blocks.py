"""Millions of cycles in blocks: what is worn away changes the contact, as often as an error estimate asks for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from math import inf
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers
from .creep import Ladder
from .laws import Pass, steepest
from .near import near_cells
from .runge_kutta_chebyshev import ChebyshevStep, integrate_step, max_step_length, stage_count
from .set_up import SetUp
from .springs import Rest

_FIRST = 1e-2  # of the time in which what wears fastest would be worn in
_SAFE, _LEAST, _MOST = 0.8, 0.2, 4.0
_SURE = 1.1
_SOON, _GROWTH = 30.0, 0.25  # s of the first block with creep; of the time before, for the later ones
_SWEEPS, _MET = 8, 1e-3
_MARGIN = 0.3


@dataclass(kw_only=True, eq=False)
class Run:
    """A run under way.

    Attributes
    ----------
    use : SetUp
    cycles : float
        Done so far.
    depth : array (cells,)
        Worn away, in mm.
    ball : array (ball's cells,)
        Worn away of the ball, in mm; empty where it does not wear.
    work : float
        ∫∫ p v dA dt so far, in N mm.
    length : float
        Of the next block, in cycles.
    steps : int
        Blocks done.
    settled : bool
        Whether every contact has balanced its load.
    lost : float
        What the blocks missed of the volume, in mm³.
    margin : float
        Of the largest overlap: so far from contact cells are still looked at.
    rest : Rest
        The contacts that were found last.
    """

    use: SetUp
    cycles: float = 0.0
    depth: Numbers = field(default_factory=lambda: numpy.zeros(0))
    ball: Numbers = field(default_factory=lambda: numpy.zeros(0))
    work: float = 0.0
    length: float = inf
    steps: int = 0
    settled: bool = True
    lost: float = 0.0
    margin: float = _MARGIN

    def __post_init__(self) -> None:
        self.depth = numpy.zeros(len(self.use.bed.areas))
        self.ball = numpy.zeros(0 if self.use.ball_wear is None else len(self.use.ball_areas))
        self.strain = self.use.creep.rested(len(self.depth)) if self.use.creep else numpy.zeros((1, len(self.depth)))
        self.rest = self.use.unworn
        self._look()
        if self._fastest > 0:
            self.length = _FIRST / self._fastest

    @property
    def crept(self) -> Numbers:
        """Depth of creep in mm: (cells,)."""
        strain = self.strain.sum(axis=0)
        return self.use.bed.smoothed(float(self.use.joint.liner_thickness) * strain) if strain.any() else strain

    @property
    def volume(self) -> float:
        """Worn away, in mm³."""
        return float(self.depth @ self.use.bed.areas)

    @property
    def ball_volume(self) -> float:
        """Worn away of the ball, in mm³."""
        return float(self.ball @ self.use.ball_areas) if len(self.ball) else 0.0

    @property
    def missed(self) -> float:
        """What the blocks missed of the volume, relative to it."""
        whole = self.volume + self.ball_volume
        return self.lost / whole if whole > 0 else 0.0

    def _look(self) -> None:
        """Which cells are in reach, and what a cycle adds to them."""
        bed = self.use.bed
        cells = numpy.flatnonzero(bed.near(self.rest, self.depth + self.crept, self.margin))
        self._near = near_cells(self.use, cells)
        self._creep = self.crept[cells]
        self._slope = self._rate(self._values)

    @property
    def _values(self) -> Numbers:
        """Depths of the cells in reach, of socket and ball, and the work."""
        return numpy.concatenate([self.depth[self._near.cells], self.ball[self._near.ball_cells], [self.work]])

    def _rate(self, values: Numbers) -> Numbers:
        """What a cycle adds to the values."""
        near, count = self._near, len(self._near.cells)
        depth = values[:count] + self._creep
        if near.facing is not None:
            depth = depth + near.facing.gap(values[count:-1])
        rest = near.bed.rest(self.use.loads, depth, self.rest, self.use.tether)
        self.rest = rest
        self.settled = self.settled and rest.settled
        shares = partial(near.bed.contact_shares, rest, depth)
        self._pass = Pass(pressure=rest.pressure, sliding=near.sliding, shares=shares)
        worn = near.bed.smoothed(self.use.wear.depth(self._pass))
        return numpy.concatenate([worn, self._ball_rate, [float(self._pass.work @ near.bed.areas)]])

    @property
    def _ball_rate(self) -> Numbers:
        """What a cycle wears of the ball."""
        faced, law = self._near.facing, self.use.ball_wear
        return numpy.zeros(0) if faced is None or law is None else law.depth(faced.passed(self._pass))

    @property
    def _fastest(self) -> float:
        """How fast a wave of the worn depth can decay, per cycle: what a law adds for a pressure, times a stiffness."""
        slope = steepest(self.use.wear, self._pass)
        if self._near.facing is not None and self.use.ball_wear is not None:
            slope += steepest(self.use.ball_wear, self._near.facing.passed(self._pass))
        return _SURE * slope * self.use.bed.stiffest

    @property
    def state(self) -> dict[str, Any]:
        """State of the run before the next block: a resumed run equals an uninterrupted run bit by bit."""
        numbers = {name: getattr(self, name) for name in _STATE}
        return {**numbers, "cells": self._near.cells, "slope": self._slope, **_rest_arrays(self.rest)}

    def resume(self, state: Mapping[str, Numbers]) -> None:
        """Continue from a stored state with its contacts, without solving them again."""
        for name, kind in _STATE.items():
            setattr(self, name, kind(state[name]))
        self._near = near_cells(self.use, state["cells"])
        self._creep = self.crept[state["cells"]]
        self._slope = state["slope"]
        self.rest = _rest_of(state)
        self._pass = Pass(pressure=self.rest.pressure, sliding=self._near.sliding)

    def until(self, count: float, listen: Callable[[float], None]) -> Run:
        """This run, gone on until so many cycles are done."""
        while self.cycles < count:
            self._advance(count)
            listen(self.cycles)
        return self

    def _advance(self, count: float) -> None:
        """A block, as long as its error allows, and no further than asked for."""
        fastest, left = self._fastest, count - self.cycles
        while True:
            length = _shared(min(self.length, max_step_length(fastest), self._calm), left)
            taken = integrate_step(self._rate, self._values, self._slope, length, stage_count(length, fastest))
            if self._overlooked(taken):
                self.margin *= 2
                self._look()
                continue
            error = self._error(taken, fastest)
            self.length = length * min(max(_SAFE * max(error, 1e-12) ** (-1 / 3), _LEAST), _MOST)
            if error <= 1:
                break
        self.lost += abs(float(taken.error[:-1] @ self._near.areas))
        self._keep(taken.values)
        self.steps, self._slope = self.steps + 1, taken.rate
        self.cycles = count if length == left else self.cycles + length
        if self.use.creep is not None:
            self._advance_creep(self.use.creep, length * self.use.seconds)
        if self._spreads or self.use.creep is not None:
            self._look()

    def _keep(self, values: Numbers) -> None:
        near, count = self._near, len(self._near.cells)
        self.depth, self.ball, self.work = self.depth.copy(), self.ball.copy(), float(values[-1])
        self.depth[near.cells], self.ball[near.ball_cells] = values[:count], values[count:-1]

    @property
    def _calm(self) -> float:
        """Cycles in which little creeps: a share of those that there were."""
        return max(_GROWTH * self.cycles, _SOON / self.use.seconds) if self.use.creep else inf

    def _advance_creep(self, creep: Ladder, seconds: float) -> None:
        """Creep under the pressure that there is at the end, which falls where it creeps: a few sweeps to meet it."""
        near, shares = self._near, self.use.cycle.seconds[self.use.loaded] / self.use.cycle.duration
        stays, adds = creep.linear(self.strain[:, near.cells], seconds)
        thickness = float(self.use.joint.liner_thickness)
        mean = shares @ self._pass.pressure
        stiff = near.bed.stiffest * (shares @ (self._pass.pressure > 0))
        for _ in range(_SWEEPS):
            self._creep = near.bed.smoothed(thickness * (stays + adds * mean))
            self._rate(self._values)
            change = (shares @ self._pass.pressure - mean) / (1 + stiff * thickness * adds)
            mean = numpy.maximum(mean + change, 0.0)
            if abs(change).max(initial=0.0) <= _MET * mean.max(initial=0.0):
                break
        pressure = numpy.zeros(len(self.depth))
        pressure[near.cells] = mean
        self.strain = creep.advanced(self.strain, pressure, seconds)

    def _error(self, taken: ChebyshevStep, fastest: float) -> float:
        """What a block missed in the mean square of the cells, over what it may."""
        begun = _FIRST * float(self._slope[:-1].max(initial=0.0)) / fastest if fastest > 0 else 0.0
        allowed = self.use.tolerance * max(float(taken.values[:-1].max(initial=0.0)), begun)
        missed = taken.error[:-1]
        return float(numpy.sqrt(missed @ missed / max(len(missed), 1))) / allowed if allowed > 0 else 0.0

    def _overlooked(self, taken: ChebyshevStep) -> bool:
        """Whether a block has brought the contact to cells that are not looked at."""
        depth = self.crept
        depth += self.depth
        depth[self._near.cells] = taken.values[: len(self._near.cells)] + self._creep
        touched = self.use.bed.near(self.rest, depth, 0.0)
        touched[self._near.cells] = False
        return bool(touched.any())

    @property
    def _spreads(self) -> bool:
        """Whether the contact comes near to cells that are not looked at."""
        close = self.use.bed.near(self.rest, self.depth + self.crept, self.margin / 2)
        close[self._near.cells] = False
        return bool(close.any())


_STATE: Mapping[str, Callable[[Any], Any]] = MappingProxyType(
    {
        "cycles": float,
        "depth": numpy.asarray,
        "ball": numpy.asarray,
        "strain": numpy.asarray,
        "work": float,
        "length": float,
        "steps": int,
        "settled": bool,
        "lost": float,
        "margin": float,
    }
)


def _rest_arrays(rest: Rest) -> dict[str, Any]:
    """Return contacts as named arrays of a checkpoint."""
    arrays = {"rest_displacement": rest.displacement, "rest_pressure": rest.pressure, "rest_settled": rest.settled}
    if rest.levels is not None:
        arrays["level_displacement"], arrays["level_pressure"] = rest.levels
    return arrays


def _rest_of(state: Mapping[str, Numbers]) -> Rest:
    """Read contacts from the arrays of a checkpoint; see `_rest_arrays`."""
    solved = "level_displacement" in state
    return Rest(
        displacement=state["rest_displacement"],
        pressure=state["rest_pressure"],
        settled=bool(state["rest_settled"]),
        levels=(state["level_displacement"], state["level_pressure"]) if solved else None,
    )


def _shared(length: float, left: float) -> float:
    """A block no longer than what is left, which two share rather than a long and a short one."""
    return left if length >= left else min(length, left / 2)
