"""Columns over time made into a cycle: cut out, checked for gaps, closed, and smooth in between."""

from __future__ import annotations

from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .cycle import Course

CLOSED = 0.01
"""Of what a column spans: so much its end may differ from its beginning."""

_GAP = 3.0
"""Usual steps of time: a longer one is a gap."""

_FEWEST = 5
_SAME = 1e-6
"""Of a cycle: so far apart may two files end."""


def clock_of(columns: dict[str, Numbers]) -> str:
    """The name of the column that tells the time.

    Raises
    ------
    ValueError
        None, or two.
    """
    if ("time" in columns) == ("phase" in columns):
        raise ValueError("a column time [s] or phase [%] is needed, and not both")
    return "time" if "time" in columns else "phase"


def at_times(columns: dict[str, Numbers], like: dict[str, Numbers]) -> dict[str, Numbers]:
    """Columns of one table at the times of another.

    Raises
    ------
    ValueError
        They tell the time otherwise, or one ends before the other.
    """
    clock = clock_of(columns)
    if clock != clock_of(like):
        raise ValueError("one file has a column time, and another one phase: they cannot be put together")
    mine, wanted = columns[clock], like[clock]
    _check_rises(clock, mine)
    slack = _SAME * (wanted[-1] - wanted[0])
    if mine[0] > wanted[0] + slack or mine[-1] < wanted[-1] - slack:
        spans = (f"{each[0]:g} to {each[-1]:g}" for each in (wanted, mine))
        raise ValueError(f"one file goes from {next(spans)}, and another one only from {next(spans)}: use from and to")
    return {name: numpy.interp(wanted, mine, values) for name, values in columns.items() if name != clock}


def cut(columns: dict[str, Numbers], begin: float | None, end: float | None) -> dict[str, Numbers]:
    """What lies between two times, those included.

    Raises
    ------
    ValueError
        Times that are not in the table, or too little between them.
    """
    if begin is None and end is None:
        return columns
    clock = clock_of(columns)
    time = columns[clock]
    _check_rises(clock, time)
    first, last = (time[0] if begin is None else begin), (time[-1] if end is None else end)
    if not time[0] <= first < last <= time[-1]:
        raise ValueError(f"from {first:g} to {last:g} is not allowed: {clock} goes from {time[0]:g} to {time[-1]:g}")
    kept = numpy.concatenate([[first], time[(time > first) & (time < last)], [last]])
    require("lines between from and to", len(kept), len(kept) >= _FEWEST, f"a cycle has at least {_FEWEST}")
    return {name: kept if name == clock else numpy.interp(kept, time, values) for name, values in columns.items()}


def phases_of(columns: dict[str, Numbers]) -> tuple[Numbers, float]:
    """Phases from 0 to 1 and the duration in s, of a time without gaps.

    Raises
    ------
    ValueError
        It does not rise, or has a gap.
    """
    clock = clock_of(columns)
    time = columns[clock]
    _check_rises(clock, time)
    steps = numpy.diff(time)
    usual = float(numpy.median(steps))
    if steps.max() > _GAP * usual:
        at = int(steps.argmax())
        raise ValueError(
            f"{clock} has a gap from {time[at]:g} to {time[at + 1]:g}, {steps.max() / usual:.3g} usual steps long"
        )
    return (time - time[0]) / (time[-1] - time[0]), float(time[-1] - time[0]) if clock == "time" else 1.0


def _check_rises(clock: str, time: Numbers) -> None:
    steps = numpy.diff(time)
    if not (steps > 0).all():
        at = int((steps <= 0).argmax())
        raise ValueError(f"{clock} does not rise from row {at + 1} to row {at + 2}")


def check_closed(name: str, values: Numbers, closing: float, unit: str, factor: float) -> None:
    """Raise ValueError where a column ends elsewhere than it begins, told in a unit."""
    missing, span = abs(values[-1] - values[0]), float(numpy.ptp(values))
    if missing > closing * span:
        begin, end = (f"{factor * values[at]:.4g}{unit}" for at in (0, -1))
        raise ValueError(
            f"the cycle does not close: {name} begins with {begin} and ends with {end}; "
            "the last line is the first again, one cycle later (closing = 0.05 lets 5 % of its span pass)"
        )
    require(name, span, span < numpy.inf, "it is finite")


def course(phase: Numbers, values: Numbers) -> Course:
    """Monotone between the lines, and smooth over the end of the cycle, over which what is missing is spread."""
    from scipy.interpolate import PchipInterpolator

    around: Any = values - (phase - 0.5) * (values[..., -1:] - values[..., :1])
    before, after = slice(-4, -1), slice(1, 4)
    times = numpy.concatenate([phase[before] - 1, phase, phase[after] + 1])
    every = numpy.concatenate([around[..., before], around, around[..., after]], axis=-1)
    made = PchipInterpolator(times, every, axis=-1)
    return lambda phases: numpy.asarray(made(phases))
