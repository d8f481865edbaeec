"""Tables of measured cycles, with units or from OpenSim, and periodic functions through their values."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import pi
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_names, require, shown
from ..core.display import counted
from ..files.columns import Head, HeadChoice, NumberTable, read_columns
from ..problem.cup import Side
from .cycle import PhaseFunction

_MIN_ROWS, _ROW_LIMIT = 5, 100_000

FORCES = ("force_x", "force_y", "force_z")
ANGLES = ("flexion", "adduction", "rotation")
_SECONDS: Mapping[str, float] = MappingProxyType({"s": 1.0, "sec": 1.0, "ms": 1e-3, "min": 60.0})
_CYCLES: Mapping[str, float] = MappingProxyType({"%": 0.01, "1": 1.0})
_NEWTON: Mapping[str, float] = MappingProxyType({"n": 1.0, "kn": 1e3, "%bw": 0.01, "bw": 1.0})
_RADIAN: Mapping[str, float] = MappingProxyType({"deg": pi / 180, "°": pi / 180, "rad": 1.0})
_UNITS: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        "time": _SECONDS,
        "phase": _CYCLES,
        **dict.fromkeys(("force", *FORCES), _NEWTON),
        **dict.fromkeys(ANGLES, _RADIAN),
    }
)
_ORTHOLOAD = MappingProxyType({"fx": "force_x", "fy": "force_y", "fz": "force_z"})
_IGNORED_ORTHOLOAD = ("f", "fres", "fr", "mx", "my", "mz", "m", "mres", "mr")  # repeated, or not needed
_HEADS = (*_UNITS, *_ORTHOLOAD, *_IGNORED_ORTHOLOAD)


def read_table(path: Path, choice: HeadChoice) -> NumberTable:
    """Read the table of a cycle: an OpenSim file (.mot, .sto), or columns with any separator.

    Raises ValueError: no table, or too few or too many rows.
    """
    table = read_columns(path, _HEADS, choice)
    if not _MIN_ROWS <= len(table) < _ROW_LIMIT:
        raise ValueError(
            f"{path.name}: {counted(len(table), 'line')} below the heads; a cycle has {_MIN_ROWS} to {_ROW_LIMIT}"
        )
    return table


_OPENSIM_ANGLE = re.compile(r"(?:.*/)?hip_(flexion|adduction|rotation)_([rl])(?:/value)?")
_OPENSIM_REACTION = re.compile(r"hip_([rl])_on_(femur|pelvis)(?:_[rl])?_in_(femur|pelvis|ground)(?:_[rl])?_f([xyz])")
_OPENSIM_AXES = MappingProxyType({"z": "force_x", "x": "force_y", "y": "force_z"})  # right, front, up


@dataclass(frozen=True, kw_only=True, eq=False)
class HipColumns:
    """Columns of time (s), force (N) and angles (rad) of one hip."""

    # "time" in s or "phase", "force" or "force_x", "force_y", "force_z" in N, angles in rad
    columns: dict[str, Numbers] = field(default_factory=dict)
    force_on: str | None = None  # body that the force acts on, "ball" or "socket", if the column names state it
    frame: str | None = None  # frame of the force, "body" or "femur", if the column names state it
    # True for forces Fx, Fy, Fz, which are taken for OrthoLoad's: on the ball, in the frame of the femur
    orthoload: bool = False


def text_columns(table: NumberTable, body_weight: float | None) -> HipColumns:
    """Convert the columns of a text table, whose heads have units; forces in %BW need the body weight in N."""
    columns: dict[str, Numbers] = {}
    orthoload = any(head.name in _ORTHOLOAD for head in table.heads)
    names = _ORTHOLOAD if orthoload else {"f": "force"}
    for head in table.heads:
        if orthoload and head.name in _IGNORED_ORTHOLOAD:
            continue
        name = names.get(head.name, head.name)
        check_names([name], _UNITS, "as a column")
        if name in columns:
            raise ValueError(f"the column {name} appears twice")
        columns[name] = _unit_factor(name, head, body_weight) * table.numbers(head.name)
    if orthoload and "time" in columns:
        columns.pop("phase", None)  # repeats the time
    if orthoload:
        return HipColumns(columns=columns, force_on="ball", frame="femur", orthoload=True)
    return HipColumns(columns=columns)


def _unit_factor(name: str, head: Head, body_weight: float | None) -> float:
    factors = _UNITS[name]
    if not head.unit:
        example = next(iter(factors)).replace("n", "N")
        raise ValueError(f"the column {head.text} has no unit: write '{head.text} [{example}]' as its head")
    plain = head.unit.replace(" ", "").lower().replace("degrees", "deg")
    if plain not in factors:
        allowed = ", ".join(factors)
        raise ValueError(f"the unit {shown(head.unit)} of the column {name} is unknown; allowed: {allowed}")
    if "bw" not in plain:
        return factors[plain]
    if body_weight is None:
        raise ValueError(f"the column {name} is in {head.unit}: set body_weight")
    return factors[plain] * body_weight


def opensim_columns(table: NumberTable, side: Side) -> HipColumns:
    """Extract angles and joint reaction of one hip from an OpenSim table; other columns are ignored."""
    letter = side.value[0]
    names = [head.name for head in table.heads]
    columns = {"time": table.numbers("time")} if "time" in names else {}
    reactions: set[tuple[str, str]] = set()
    for head in names:
        if (angle := _OPENSIM_ANGLE.fullmatch(head)) and angle[2] == letter:
            if table.in_degrees is None:
                raise ValueError("the header does not state the unit of angles: it needs inDegrees=yes or inDegrees=no")
            columns[angle[1]] = (pi / 180 if table.in_degrees else 1.0) * table.numbers(head)
        elif (force := _OPENSIM_REACTION.fullmatch(head)) and force[1] == letter:
            reactions.add((force[2], force[3]))
            columns[_OPENSIM_AXES[force[4]]] = table.numbers(head)
    if len(columns) < 2:
        examples = f"hip_flexion_{letter} or hip_{letter}_on_femur_..."
        raise ValueError(f"the table has no column of the {side.value} hip, such as {examples}")
    if not reactions:
        return HipColumns(columns=columns)
    if len(reactions) > 1:
        raise ValueError("the table has more than one joint reaction: on several bodies, or in several frames")
    body, frame = reactions.pop()
    if frame == "ground":
        raise ValueError("the joint reaction is in the ground frame: let OpenSim express it in pelvis or femur")
    loaded = "ball" if body == "femur" else "socket"
    return HipColumns(columns=columns, force_on=loaded, frame="femur" if frame == "femur" else "body")


def combine_columns(tables: Sequence[HipColumns]) -> HipColumns:
    """Combine the columns of several tables of one cycle, interpolated at the times of the first table."""
    if len(tables) == 1:
        return tables[0]
    columns, name = dict(tables[0].columns), time_column(tables[0].columns)
    reference_time = columns[name]
    time_tolerance = _TIME_TOLERANCE * (reference_time[-1] - reference_time[0])
    for table in tables[1:]:
        if time_column(table.columns) != name:
            raise ValueError("one file has a column time and another one phase: they cannot be combined")
        time = table.columns[name]
        _check_increasing_times(name, time)
        if time[0] > reference_time[0] + time_tolerance or time[-1] < reference_time[-1] - time_tolerance:
            spans = (f"{times[0]:g} to {times[-1]:g}" for times in (reference_time, time))
            ends = f"one file goes from {next(spans)}, and another one only from {next(spans)}"
            raise ValueError(f"{ends}: use from and to")
        for title, values in table.columns.items():
            if title == name:
                continue
            if title in columns:
                raise ValueError(f"the column {title} is in two files")
            columns[title] = numpy.interp(reference_time, time, values)
    reaction = next((table for table in tables if table.frame is not None), HipColumns())
    return replace(reaction, columns=columns)


DEFAULT_CLOSURE = 0.01  # largest difference between the ends of a column, as a share of its range

_MAX_STEP_RATIO = 3.0  # longest time step as a multiple of the median step; a longer one is a gap
_TIME_TOLERANCE = 1e-6  # difference by which two tables may end apart, as a share of the duration


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
    """Find the name of the column with times or phases: "time" or "phase"."""
    if ("time" in columns) == ("phase" in columns):
        raise ValueError("a column time [s] or phase [%] is needed, and not both")
    return "time" if "time" in columns else "phase"


def select_time_range(columns: dict[str, Numbers], begin: float | None, end: float | None) -> dict[str, Numbers]:
    """Select the rows of a table between two times, and interpolate rows at both times."""
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
    """Convert the time column of a table to phases from 0 to 1, and return also the duration in s."""
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
    steps = numpy.diff(time)
    if not (steps > 0).all():
        row = int((steps <= 0).argmax())
        raise ValueError(f"{name} does not increase from row {row + 1} to row {row + 2}")


def check_closed(name: str, values: Numbers, closure: float, unit: str, factor: float) -> None:
    """Check that a column ends with its first value, as a closed cycle does; ValueError otherwise.

    The difference may be a share (`closure`) of the column's range; `factor` converts values to `unit` for the message.
    """
    difference, span = abs(values[-1] - values[0]), float(numpy.ptp(values))
    if difference > closure * span:
        begin, end = (f"{factor * values[row]:.4g}{unit}" for row in (0, -1))
        raise ValueError(
            f"the cycle does not close: {name} begins with {begin} and ends with {end}; "
            "the last line must repeat the first, one cycle later (closing = 0.05 allows 5 % of the column's range)"
        )
    require(name, span, span < numpy.inf, "it is finite")
