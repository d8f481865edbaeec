"""Periodic functions of phase through tabulated points, and the checks of tabulated times."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .cycle import PhaseFunction

DEFAULT_CLOSURE = 0.01
"""Largest difference between the ends of a column, as a share of its range."""

_MAX_STEP_RATIO = 3.0
"""Longest time step as a multiple of the median step; a longer one is a gap."""

_MIN_ROWS = 5
_TIME_TOLERANCE = 1e-6
"""Difference by which two tables may end apart, as a share of the duration."""


def half_cosines(phases: Numbers, knots: Numbers, values: Numbers) -> Numbers:
    """Interpolate between values at knots of a cycle by half cosines, with zero slope at each knot."""
    interval = numpy.clip(numpy.searchsorted(knots, phases, side="right") - 1, 0, len(knots) - 2)
    fraction = (phases - knots[interval]) / (knots[interval + 1] - knots[interval])
    return values[interval] + (values[interval + 1] - values[interval]) * (1 - numpy.cos(pi * fraction)) / 2


def monotone_periodic(phase: Numbers, values: Numbers) -> PhaseFunction:
    """Create a smooth periodic function through the values of a table, monotone between them.

    The difference between the last and the first value is distributed linearly over the cycle.
    """
    from scipy.interpolate import PchipInterpolator

    closed_values: Any = values - (phase - 0.5) * (values[..., -1:] - values[..., :1])
    last_values, first_values = slice(-4, -1), slice(1, 4)
    times = numpy.concatenate([phase[last_values] - 1, phase, phase[first_values] + 1])
    extended = numpy.concatenate(
        [closed_values[..., last_values], closed_values, closed_values[..., first_values]], axis=-1
    )
    interpolator = PchipInterpolator(times, extended, axis=-1)
    return lambda phases: numpy.asarray(interpolator(phases))


def time_column(columns: dict[str, Numbers]) -> str:
    """Find the name of the column with times or phases: "time" or "phase".

    Raises
    ------
    ValueError
        Neither or both columns exist.
    """
    if ("time" in columns) == ("phase" in columns):
        raise ValueError("a column time [s] or phase [%] is needed, and not both")
    return "time" if "time" in columns else "phase"


def resample(columns: dict[str, Numbers], reference: dict[str, Numbers]) -> dict[str, Numbers]:
    """Interpolate the columns of a table at the times of a reference table.

    Raises
    ------
    ValueError
        One table has times and the other has phases, or this one does not cover the other.
    """
    name = time_column(columns)
    if name != time_column(reference):
        raise ValueError("one file has a column time and another one phase: they cannot be combined")
    time, reference_time = columns[name], reference[name]
    _check_increasing_times(name, time)
    time_tolerance = _TIME_TOLERANCE * (reference_time[-1] - reference_time[0])
    if time[0] > reference_time[0] + time_tolerance or time[-1] < reference_time[-1] - time_tolerance:
        spans = (f"{times[0]:g} to {times[-1]:g}" for times in (reference_time, time))
        raise ValueError(f"one file goes from {next(spans)}, and another one only from {next(spans)}: use from and to")
    return {title: numpy.interp(reference_time, time, values) for title, values in columns.items() if title != name}


def select_time_range(columns: dict[str, Numbers], begin: float | None, end: float | None) -> dict[str, Numbers]:
    """Select the rows of a table between two times, and interpolate rows at both times.

    Raises
    ------
    ValueError
        The times are outside the table, or fewer than five rows lie between them.
    """
    if begin is None and end is None:
        return columns
    name = time_column(columns)
    time = columns[name]
    _check_increasing_times(name, time)
    first, last = (time[0] if begin is None else begin), (time[-1] if end is None else end)
    if not time[0] <= first < last <= time[-1]:
        raise ValueError(f"from {first:g} to {last:g} is not allowed: {name} goes from {time[0]:g} to {time[-1]:g}")
    times = numpy.concatenate([[first], time[(time > first) & (time < last)], [last]])
    require("lines between from and to", len(times), len(times) >= _MIN_ROWS, f"a cycle has at least {_MIN_ROWS}")
    return {title: times if title == name else numpy.interp(times, time, data) for title, data in columns.items()}


def phases_and_duration(columns: dict[str, Numbers]) -> tuple[Numbers, float]:
    """Convert the time column of a table to phases from 0 to 1, and return also the duration in s.

    Raises
    ------
    ValueError
        Times do not increase, or have a gap.
    """
    name = time_column(columns)
    time = columns[name]
    _check_increasing_times(name, time)
    steps = numpy.diff(time)
    median = float(numpy.median(steps))
    if steps.max() > _MAX_STEP_RATIO * median:
        row = int(steps.argmax())
        raise ValueError(
            f"{name} has a gap from {time[row]:g} to {time[row + 1]:g}, {steps.max() / median:.3g} times the median "
            f"step; allowed are {_MAX_STEP_RATIO:g} times"
        )
    return (time - time[0]) / (time[-1] - time[0]), float(time[-1] - time[0]) if name == "time" else 1.0


def _check_increasing_times(name: str, time: Numbers) -> None:
    """Check that times increase from row to row; ValueError otherwise."""
    steps = numpy.diff(time)
    if not (steps > 0).all():
        row = int((steps <= 0).argmax())
        raise ValueError(f"{name} does not increase from row {row + 1} to row {row + 2}")


def check_closed(name: str, values: Numbers, closure: float, unit: str, factor: float) -> None:
    """Check that a column ends with its first value, as a closed cycle does; ValueError otherwise.

    `closure` is the allowed difference as a share of the column's range; `factor` converts values to `unit` for the
    message.
    """
    difference, span = abs(values[-1] - values[0]), float(numpy.ptp(values))
    if difference > closure * span:
        begin, end = (f"{factor * values[row]:.4g}{unit}" for row in (0, -1))
        raise ValueError(
            f"the cycle does not close: {name} begins with {begin} and ends with {end}; "
            "the last line must repeat the first, one cycle later (closing = 0.05 allows 5 % of the column's range)"
        )
    require(name, span, span < numpy.inf, "it is finite")
