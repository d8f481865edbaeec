"""All contacts of one joint: half angle, force and indentation find each other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from math import inf, radians
from typing import Protocol

import numpy

from ...contact.per_joint import Piece
from ...core.arrays import Numbers
from ...problem.gaps import Gap
from .abel import AbelState
from .grid import cached_grid
from .intervals import CachedIntervals, Intervals
from .kernel import Kernel

LIMIT = radians(85.0)
"""The widest contact that is solved."""

_GRIDS = (14, 20, 28, 40, 56, 80)  # points, more of them until the error is small enough
_COARSE = 10
_STEPS = 8
_CLOSE = 1e-10  # of a load
_SAFETY = 3.0  # over how far the two solutions of the equation disagree
_END = 1.03 * LIMIT  # of the contacts that are computed, to see which are too wide
_DEGREES = (0.5, 0.8, 1.3, 2, 3, 4.5, 6.5, 9, 12, 16, 20, 25, 30, 36, 42, 48, 54, 60, 66, 72, 78, 82, 85)
_ANGLES = numpy.append(numpy.radians(_DEGREES), _END)
_FIRST_LOOK = CachedIntervals(half_angle=_ANGLES, grid=cached_grid(_COARSE))
_WINDOW, _WINDOW_STEP = 8, 4
"""Number of knots around one half angle, and the step between the windows that are used."""

_LAWS = {"force": lambda state: state.force, "indentation": lambda state: state.indentation}


class CurvePoints(Protocol):
    """What is known of contacts that were solved, or read from a curve."""

    @property
    def half_angle(self) -> Numbers: ...
    @property
    def indentation(self) -> Numbers: ...
    @property
    def force(self) -> Numbers: ...
    @property
    def stiffness(self) -> Numbers: ...
    @property
    def widening(self) -> Numbers: ...
    @property
    def error(self) -> Numbers: ...


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadCurve:
    """Force, indentation and half angle of one joint, to a relative tolerance."""

    kernel: Kernel
    gap: Gap
    tolerance: float

    def press(self, kind: str, load: Numbers) -> Piece:
        """The contacts that belong to loads of one kind: "force", "indentation" or "half_angle"."""
        touching = load > 0
        given = load[touching]
        angle = given if kind == "half_angle" or self._end == 0 else self._guess(kind, given)
        for points in _GRIDS:
            state, miss = self._solved(kind, given, self._bounded(angle), points)
            reached = (state.half_angle <= LIMIT) & (state.half_angle < self._end) & _sound(state)
            floor = miss + self.kernel.tolerance
            error = {name: error + floor for name, error in errors(kind, state).items()}
            if not any(numpy.any(part[reached] > self.tolerance) for part in error.values()):
                break
            angle = numpy.where(angle <= self._end, state.half_angle, angle)
        return Piece(load=load, touching=touching, state=state, reached=reached, error=error)

    def state(self, angle: Numbers, points: int) -> AbelState:
        """The contacts of half angles, solved at so many points."""
        return AbelState(
            kernel=self.kernel, gap=self.gap, intervals=Intervals(half_angle=angle, grid=cached_grid(points))
        )

    def _solved(self, kind: str, given: Numbers, angle: Numbers, points: int) -> tuple[AbelState, Numbers]:
        """The state at the half angle that gives the load, by Newton's method in the logarithms, and what it misses."""
        state = self.state(angle, points)
        if kind == "half_angle":
            return state, numpy.zeros_like(given)
        for _ in range(_STEPS):
            miss = numpy.log(_LAWS[kind](state) / given)
            if not numpy.any(abs(miss) > _CLOSE):
                break
            step = numpy.clip(miss / log_slope(kind, state), -0.5, 0.5)
            state = self.state(self._bounded(state.half_angle * numpy.exp(-step)), points)
        return state, abs(miss)

    def _bounded(self, angle: Numbers) -> Numbers:
        """Angles up to where contacts are still computed to see that they are too wide; so is what is no number."""
        return numpy.where(angle < self._end, angle, self._end)

    @cached_property
    def _end(self) -> float:
        """A little beyond the widest contact that is solved, or just before the ball fits perfectly, if that is less.

        At the perfect fit the indentation is infinite, and beyond it there is no contact.
        """
        sound = _sound(self._first_look)
        if sound.all():
            return _END
        first = int(numpy.argmin(sound))
        low, high = (_ANGLES[first - 1] if first else 0.0), _ANGLES[first]
        for _ in range(16):
            middle = (low + high) / 2
            low, high = (middle, high) if _sound(self.state(numpy.array([middle]), _GRIDS[0])).all() else (low, middle)
        return float(low)

    @property
    def ratio(self) -> float:
        """R2/L"""
        return self.gap.socket_radius / self.kernel.socket.shells[0].thickness

    @property
    def widest(self) -> float:
        """The widest contact that is answered."""
        return min(LIMIT, self._end)

    @cached_property
    def _first_look(self) -> AbelState:
        return AbelState(kernel=self.kernel, gap=self.gap, intervals=_FIRST_LOOK)

    @cached_property
    def knots(self) -> AbelState:
        """A few contacts, all of them sound."""
        if self._end == _END:
            return self._first_look
        inside = _ANGLES[self._end > _ANGLES]
        room = self._end - inside.max(initial=0.0)
        return self.state(numpy.append(inside, self._end - room * numpy.array([0.5, 0.2, 0.07, 0.02])), _COARSE)

    def knots_in(self, window: slice) -> AbelState | None:
        """Return the contacts at some of the knots; None where one of them is not sound."""
        state = AbelState(kernel=self.kernel, gap=self.gap, intervals=_window_intervals(window.start, window.stop))
        return state if _sound(state).all() else None

    @cached_property
    def _knots(self) -> dict[str, tuple[Numbers, Numbers, Numbers]]:
        """ln(load), ln ε and their slope at the coarse contacts."""
        coarse = self.knots
        y = numpy.log(coarse.half_angle)
        return {kind: (numpy.log(law(coarse)), y, 1 / log_slope(kind, coarse)) for kind, law in _LAWS.items()}

    def _guess(self, kind: str, given: Numbers) -> Numbers:
        """The half angle by cubics between a few coarse contacts; like a power of the load below the first."""
        x, y, slope = self._knots[kind]
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


def window_of(angle: Numbers) -> slice | None:
    """Return the knots around half angles that lie close together, with two or more on each side; else None."""
    place = numpy.searchsorted(_ANGLES, angle)
    start = int(max(place.min() - 2, 0) // _WINDOW_STEP * _WINDOW_STEP)
    stop = start + _WINDOW
    return slice(start, stop) if place.max() + 2 < stop <= len(_ANGLES) else None


@cache
def _window_intervals(start: int, stop: int) -> CachedIntervals:
    return CachedIntervals(half_angle=_ANGLES[start:stop], grid=cached_grid(_COARSE))


def _sound(state: AbelState) -> Numbers:
    """Whether there is a contact: not beyond the perfect fit, where the ball does not reach, or without a number."""
    with numpy.errstate(invalid="ignore", over="ignore", under="ignore"):
        work = state.indentation * state.force  # infinite or zero before any of the other quantities
        return (state.indentation > 0) & (state.pole_pressure > 0) & (work > 0) & (work < inf)


def log_slope(kind: str, state: CurvePoints) -> Numbers:
    """d ln(load)/d ln ε."""
    deepening = state.half_angle * state.widening
    return deepening / state.indentation if kind == "indentation" else deepening * state.stiffness / state.force


def errors(kind: str, state: CurvePoints) -> dict[str, Numbers]:
    """Relative errors of each quantity, at the given load."""
    own = _SAFETY * state.error
    steep = {name: log_slope(name, state) for name in _LAWS}
    shift = own / steep[kind] if kind in _LAWS else 0.0 * own
    errors = {name: own + shift * each for name, each in steep.items()}
    errors["half_angle"] = shift
    errors.update(
        dict.fromkeys(("max_pressure", "pole_pressure", "stiffness", "pressure_integral"), own + shift * steep["force"])
    )
    errors["energy"] = errors["force"] + errors["indentation"]
    if kind in errors:
        errors[kind] = 0.0 * own
    return errors
