"""Contacts of one joint by half angle, force or indentation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from math import inf
from typing import Any

import numpy

from ...contact.coordinates import LIMIT
from ...contact.per_joint import JointContacts
from ...contact.roots import bisect
from ...core.arrays import Numbers
from ...problem.gaps import Gap
from .abel import AbelState
from .grid import cached_grid
from .kernel import CachedIntervals, Intervals, Kernel

_GRIDS = (14, 20, 28, 40, 56, 80)  # numbers of points, increased until the error is small enough
_COARSE_POINTS = 10
_NEWTON_STEPS = 8
_LOAD_TOLERANCE = 1e-10  # relative
_SAFETY = 3.0  # factor on the difference of the two solutions of the equation
_MAX_ANGLE = 1.03 * LIMIT  # of the contacts that are computed, to detect those that are too wide
_DEGREES = (0.5, 0.8, 1.3, 2, 3, 4.5, 6.5, 9, 12, 16, 20, 25, 30, 36, 42, 48, 54, 60, 66, 72, 78, 82, 85)
_ANGLES = numpy.append(numpy.radians(_DEGREES), _MAX_ANGLE)
_KNOT_INTERVALS = CachedIntervals(half_angle=_ANGLES, grid=cached_grid(points=_COARSE_POINTS))
_WINDOW, _WINDOW_STEP = 8, 4  # number of knots in a window of half angles, and the step between windows

_LOADS = ("force", "indentation")  # kinds of loads for which the half angle is searched


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadCurve:
    """Force, indentation and half angle of one joint, to a relative tolerance."""

    kernel: Kernel
    gap: Gap
    tolerance: float

    def press(self, kind: str, load: Numbers) -> JointContacts:
        """Solve the contacts for loads of one kind: "force", "indentation" or "half_angle"."""
        touching = load > 0
        positive_load = load[touching]
        angle = positive_load
        if kind != "half_angle" and self._max_computed_angle > 0:
            angle = self._estimate_angle(kind, positive_load)
        for points in _GRIDS:
            state, residual = self._solve(kind, positive_load, self._clip_angles(angle), points)
            reached = (state.half_angle <= LIMIT) & (state.half_angle < self._max_computed_angle) & _is_contact(state)
            floor = residual + self.kernel.tolerance
            error = {name: error + floor for name, error in estimate_errors(kind, state).items()}
            if not any(numpy.any(values[reached] > self.tolerance) for values in error.values()):
                break
            angle = numpy.where(angle <= self._max_computed_angle, state.half_angle, angle)
        return JointContacts(load=load, touching=touching, state=state, reached=reached, error=error)

    def state(self, angle: Numbers, points: int) -> AbelState:
        """Make the contacts with these half angles (rad), on a grid with this number of points."""
        intervals = Intervals(half_angle=angle, grid=cached_grid(points=points))
        return AbelState(kernel=self.kernel, gap=self.gap, intervals=intervals)

    def _solve(self, kind: str, load: Numbers, angle: Numbers, points: int) -> tuple[AbelState, Numbers]:
        state = self.state(angle, points)
        if kind == "half_angle":
            return state, numpy.zeros_like(load)
        for _ in range(_NEWTON_STEPS):
            residual = numpy.log(getattr(state, kind) / load)
            if not numpy.any(abs(residual) > _LOAD_TOLERANCE):
                break
            step = numpy.clip(residual / log_slope(kind, state), -0.5, 0.5)
            state = self.state(self._clip_angles(state.half_angle * numpy.exp(-step)), points)
        return state, abs(residual)

    def _clip_angles(self, angle: Numbers) -> Numbers:
        return numpy.where(angle < self._max_computed_angle, angle, self._max_computed_angle)

    @cached_property
    def _max_computed_angle(self) -> float:
        """Widest half angle in rad that is computed: slightly beyond the limit, or just before the perfect fit."""
        is_contact = _is_contact(self._knot_state)
        if is_contact.all():
            return _MAX_ANGLE
        first = int(numpy.argmin(is_contact))
        low, high = (float(_ANGLES[first - 1]) if first else 0.0), float(_ANGLES[first])
        return bisect(low, high, lambda e: bool(_is_contact(self.state(numpy.array([e]), _GRIDS[0])).all()), 16)

    @property
    def ratio(self) -> float:
        """Ratio R2/L of socket radius and liner thickness."""
        return self.gap.socket_radius / self.kernel.socket.shells[0].thickness

    @property
    def widest_angle(self) -> float:
        """Largest half angle in rad with a solution."""
        return min(LIMIT, self._max_computed_angle)

    @cached_property
    def _knot_state(self) -> AbelState:
        return AbelState(kernel=self.kernel, gap=self.gap, intervals=_KNOT_INTERVALS)

    @cached_property
    def knots(self) -> AbelState:
        """Valid contacts at a few half angles up to the widest one, from which others are estimated."""
        if self._max_computed_angle == _MAX_ANGLE:
            return self._knot_state
        inside = _ANGLES[self._max_computed_angle > _ANGLES]
        margin = self._max_computed_angle - inside.max(initial=0.0)
        outermost = self._max_computed_angle - margin * numpy.array([0.5, 0.2, 0.07, 0.02])
        return self.state(numpy.append(inside, outermost), _COARSE_POINTS)

    def knots_in(self, window: slice) -> AbelState | None:
        """Return the contacts at a slice of the tabulated half angles, or None if one of them is not valid."""
        state = AbelState(kernel=self.kernel, gap=self.gap, intervals=_window_intervals(window.start, window.stop))
        return state if _is_contact(state).all() else None

    def _estimate_angle(self, kind: str, load: Numbers) -> Numbers:
        """Estimate the half angle in rad by cubics between the knots, or by a power law below the first."""
        knots = self.knots
        x, y, slope = numpy.log(getattr(knots, kind)), numpy.log(knots.half_angle), 1 / log_slope(kind, knots)
        goal = numpy.log(load)
        bounded = numpy.clip(interpolate_cubic(goal, x, y, slope)[0], y[0], y[-1])
        return numpy.exp(numpy.where(goal < x[0], y[0] + slope[0] * (goal - x[0]), bounded))


def interpolate_cubic(at: Numbers, x: Numbers, y: Numbers, slope: Numbers) -> tuple[Numbers, Numbers]:
    """Interpolate by cubics with given slopes at x; return values and slopes."""
    i = numpy.clip(numpy.searchsorted(x, at) - 1, 0, len(x) - 2)
    width, t = x[i + 1] - x[i], (at - x[i]) / (x[i + 1] - x[i])
    rise, first, second = y[i + 1] - y[i], width * slope[i], width * slope[i + 1]
    values = y[i] + t * (first + t * (3 * rise - 2 * first - second + t * (first + second - 2 * rise)))
    slopes = (first + t * (2 * (3 * rise - 2 * first - second) + 3 * t * (first + second - 2 * rise))) / width
    return values, slopes


def knot_window(angle: Numbers) -> slice | None:
    """Choose the slice of tabulated half angles around a narrow range; None if no slice contains the range."""
    index = numpy.searchsorted(_ANGLES, angle)
    start = int(max(index.min() - 2, 0) // _WINDOW_STEP * _WINDOW_STEP)
    stop = start + _WINDOW
    return slice(start, stop) if index.max() + 2 < stop <= len(_ANGLES) else None


@cache
def _window_intervals(start: int, stop: int) -> CachedIntervals:
    return CachedIntervals(half_angle=_ANGLES[start:stop], grid=cached_grid(points=_COARSE_POINTS))


def _is_contact(state: AbelState) -> Numbers:
    """Return True for contacts that exist and are finite; beyond the perfect fit there are none."""
    with numpy.errstate(invalid="ignore", over="ignore", under="ignore"):
        work = state.indentation * state.force  # infinite or zero before any of the other quantities
        return (state.indentation > 0) & (state.pole_pressure > 0) & (work > 0) & (work < inf)


def log_slope(kind: str, state: Any) -> Numbers:
    """Compute d ln(load)/d ln ε of solved or interpolated contacts."""
    deepening = state.half_angle * state.indentation_slope
    return deepening / state.indentation if kind == "indentation" else deepening * state.stiffness / state.force


def estimate_errors(kind: str, state: Any) -> dict[str, Numbers]:
    """Estimate the relative error of each quantity at the applied load."""
    state_error = _SAFETY * state.error
    slopes = {name: log_slope(name, state) for name in _LOADS}
    shift = state_error / slopes[kind] if kind in _LOADS else 0.0 * state_error
    errors = {name: state_error + shift * slope for name, slope in slopes.items()}
    errors["half_angle"] = shift
    for name in ("max_pressure", "pole_pressure", "stiffness", "pressure_integral"):
        errors[name] = state_error + shift * slopes["force"]
    errors["energy"] = errors["force"] + errors["indentation"]
    if kind in errors:
        errors[kind] = 0.0 * state_error
    return errors
