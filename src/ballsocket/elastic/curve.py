"""All contacts of one joint: half angle, force and indentation find each other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import radians

import numpy

from ..models.by_joint import Piece
from .abel import State
from .gaps import Gap
from .kernel import Kernel, grid

Array = numpy.ndarray

LIMIT = radians(85.0)
"""The widest contact that is solved."""

_GRIDS = (14, 20, 28, 40, 56, 80)
_COARSE = 8
_STEPS = 8
_CLOSE = 1e-12
_SAFETY = 3.0
_END = 1.03 * LIMIT
_ANGLES = numpy.radians([0.5, 0.8, 1.3, 2, 3, 4.5, 6.5, 9, 12, 16, 20, 25, 30, 36, 42, 48, 54, 60, 66, 72, 78, 82, 85])
_LAWS = {"force": lambda state: state.force, "indentation": lambda state: state.indentation}


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """Force, indentation and half angle of one joint, to a relative tolerance."""

    kernel: Kernel
    gap: Gap
    tolerance: float

    def press(self, kind: str, load: Array) -> Piece:
        """The contacts that belong to loads of one kind: "force", "indentation" or "half_angle"."""
        touching = load > 0
        given = load[touching]
        angle = given if kind == "half_angle" else self._guess(kind, given)
        for points in _GRIDS:
            state, miss = self._solved(kind, given, _bounded(angle), points)
            error = {name: error + miss for name, error in _errors(kind, state).items()}
            reached = (state.half_angle <= LIMIT) & (angle <= _END)
            if not any(numpy.any(part[reached] > self.tolerance) for part in error.values()):
                break
            angle = numpy.where(angle <= _END, state.half_angle, angle)
        return Piece(load=load, touching=touching, state=state, reached=reached, error=error)

    def _state(self, angle: Array, points: int) -> State:
        return State(kernel=self.kernel, gap=self.gap, grid=grid(points), half_angle=angle)

    def _solved(self, kind: str, given: Array, angle: Array, points: int) -> tuple[State, Array]:
        """The state at the half angle that gives the load, by Newton's method in the logarithms, and what it misses."""
        state = self._state(angle, points)
        if kind == "half_angle":
            return state, numpy.zeros_like(given)
        for _ in range(_STEPS):
            miss = numpy.log(_LAWS[kind](state) / given)
            if not numpy.any(abs(miss) > _CLOSE):
                break
            step = numpy.clip(miss / _steepness(kind, state), -0.5, 0.5)
            state = self._state(_bounded(state.half_angle * numpy.exp(-step)), points)
        return state, abs(miss)

    @cached_property
    def _coarse(self) -> State:
        return self._state(_ANGLES, _COARSE)

    def _guess(self, kind: str, given: Array) -> Array:
        """The half angle by cubics between a few coarse contacts; like a power of the load below the first."""
        x, y = numpy.log(_LAWS[kind](self._coarse)), numpy.log(_ANGLES)
        slope = 1 / _steepness(kind, self._coarse)
        goal = numpy.log(given)
        i = numpy.clip(numpy.searchsorted(x, goal) - 1, 0, len(x) - 2)
        width, t = x[i + 1] - x[i], (goal - x[i]) / (x[i + 1] - x[i])
        cubic = (
            y[i] * (1 + 2 * t) * (1 - t) ** 2
            + y[i + 1] * t * t * (3 - 2 * t)
            + width * t * (1 - t) * (slope[i] * (1 - t) - slope[i + 1] * t)
        )
        inside = numpy.clip(cubic, y[i], y[i + 1])
        return numpy.exp(numpy.where(t < 0, y[0] + slope[0] * (goal - x[0]), inside))


def _bounded(angle: Array) -> Array:
    """Angles up to a little beyond the widest contact; what is no number counts as too wide."""
    return numpy.where(angle < _END, angle, _END)


def _steepness(kind: str, state: State) -> Array:
    """d ln(load)/d ln ε."""
    deepening = state.half_angle * state.widening
    return deepening / state.indentation if kind == "indentation" else deepening * state.stiffness / state.force


def _errors(kind: str, state: State) -> dict[str, Array]:
    """Relative errors of each quantity, at the given load."""
    own = _SAFETY * state.error
    steepness = {name: _steepness(name, state) for name in _LAWS}
    shift = own / steepness[kind] if kind in _LAWS else 0.0 * own
    errors = {name: own + shift * steep for name, steep in steepness.items()}
    errors["half_angle"] = shift
    errors.update(dict.fromkeys(("max_pressure", "stiffness", "pressure_integral"), own + shift * steepness["force"]))
    errors["energy"] = errors["force"] + errors["indentation"]
    if kind in errors:
        errors[kind] = 0.0 * own
    return errors
