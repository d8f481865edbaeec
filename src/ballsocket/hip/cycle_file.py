"""A cycle of one's own, from a table: time, force and angles, each with its unit."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from math import pi
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy

from ..arrays import Numbers
from ..checks import check_names, require, shown
from .cycle import INSTANTS, Course, Cycle

_LARGEST = 10_000_000
_ROWS = 5, 100_000
_HEAD = re.compile(r"\s*\"?\s*([A-Za-z_]+)\s*(?:[\[(]\s*([^\])]+?)\s*[\])])?\s*\"?\s*")
_FORCES = ("force_x", "force_y", "force_z")
_ANGLES = ("flexion", "adduction", "rotation")
_NEWTON: Mapping[str, float] = MappingProxyType({"n": 1.0, "kn": 1e3, "%bw": 0.01, "bw": 1.0})
_RADIAN: Mapping[str, float] = MappingProxyType({"deg": pi / 180, "°": pi / 180, "rad": 1.0})
_UNITS: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        "time": {"s": 1.0, "ms": 1e-3, "min": 60.0},
        "phase": {"%": 0.01, "1": 1.0},
        **dict.fromkeys(("force", *_FORCES), _NEWTON),
        **dict.fromkeys(_ANGLES, _RADIAN),
    }
)
_CLOSED = 0.01
"""Of what a column spans: so much its end may differ from its beginning."""

_GAP = 3.0
"""Usual steps of time: a longer one is a gap."""


def read_cycle(
    path: str | Path, instants: int = INSTANTS, order: str = "xyz", body_weight: float | None = None
) -> Cycle:
    """Read a cycle from a table of text.

    The first line names the columns with their units: `time [s]` or `phase [%]`; `force [N]` along z, or `force_x [N]`,
    `force_y [N]`, `force_z [N]`, of the ball on the socket; `flexion [deg]`, `adduction [deg]`, `rotation [deg]`, of
    which those that are missing are zero. Forces may be in kN, or in %BW, which needs the body's weight. Columns are
    parted by commas, semicolons or tabs; lines that begin with # are passed over. The last line is the first again,
    one cycle later. Between the lines the course is monotone and smooth.

    Parameters
    ----------
    path : str or Path
    instants, order
        As of `Cycle`.
    body_weight : float, optional
        In N.

    Raises
    ------
    ValueError
        One sentence: a column without its unit, a gap, what is no number, a cycle that does not close.
    OSError
        The file cannot be read.
    """
    path = Path(path)
    try:
        heads, rows = _rows(path)
        columns = _columns(heads, rows, body_weight)
        phase, duration = _phase(columns)
        force = [columns[name] for name in (_FORCES if "force" not in columns else ("force",)) if name in columns]
        angles = numpy.stack([columns.get(name, 0.0 * phase) for name in _ANGLES])
        return Cycle(
            name=path.stem,
            force=_course(phase, force[0] if len(force) == 1 else numpy.stack(force)),
            angles=_course(phase, angles),
            instants=instants,
            order=order,
            duration=duration,
        )
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from error


def _rows(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The heads of the columns, and the other lines with their numbers."""
    with path.open("rb") as stream:
        raw = stream.read(_LARGEST + 1)
    if len(raw) > _LARGEST:
        raise ValueError(f"the table is larger than {_LARGEST} bytes")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"not text in UTF-8: {error.reason} at byte {error.start}") from error
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    lines = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    if len(lines) < _ROWS[0] + 1 or len(lines) > _ROWS[1]:
        raise ValueError(f"{max(len(lines) - 1, 0)} lines below the heads; a cycle has {_ROWS[0]} to {_ROWS[1]}")
    parting = max(",;\t", key=lines[0][1].count)
    return lines[0][1].split(parting), [(number, line.split(parting)) for number, line in lines[1:]]


def _columns(
    heads: Sequence[str], rows: Sequence[tuple[int, list[str]]], body_weight: float | None
) -> dict[str, Numbers]:
    """Columns by name, in s, N and rad."""
    found: dict[str, Numbers] = {}
    for place, head in enumerate(heads):
        name, factor = _head(head, body_weight)
        if name in found:
            raise ValueError(f"the column {name} is there twice")
        found[name] = factor * numpy.array([_number(name, number, row, place) for number, row in rows])
    if ("time" in found) == ("phase" in found):
        raise ValueError("a column time [s] or phase [%] is needed, and not both")
    whole = all(name in found for name in _FORCES)
    if ("force" in found) == whole or (not whole and any(name in found for name in _FORCES)):
        raise ValueError("a column force [N], or force_x, force_y and force_z, is needed")
    return found


def _head(head: str, body_weight: float | None) -> tuple[str, float]:
    """A column's name, and the factor to s, N or rad."""
    match = _HEAD.fullmatch(head)
    if match is None:
        raise ValueError(f"the head {shown(head)} is not a name with a unit, such as 'force [N]'")
    name, unit = match[1].lower(), match[2]
    check_names([name], _UNITS, "as a column")
    known = _UNITS[name]
    if unit is None:
        raise ValueError(f"the column {name} has no unit: write '{name} [{_first(known)}]' as its head")
    unit = unit.replace(" ", "").lower().replace("degrees", "deg")
    if unit not in known:
        raise ValueError(f"the unit {shown(match[2])} of the column {name} is not known; known: {', '.join(known)}")
    if "bw" not in unit:
        return name, known[unit]
    if body_weight is None:
        raise ValueError(f"the column {name} is in {match[2]}, and no body_weight is given")
    return name, known[unit] * body_weight


def _first(units: Mapping[str, float]) -> str:
    unit = next(iter(units))
    return {"n": "N"}.get(unit, unit)


def _number(name: str, number: int, row: Sequence[str], place: int) -> float:
    text = row[place].strip() if place < len(row) else ""
    try:
        value = float(text)
    except ValueError:
        value = numpy.nan
    if not numpy.isfinite(value):
        what = shown(text) if text else "nothing"
        raise ValueError(f"line {number} has {what} for {name}: each line needs a finite number in each column")
    return value


def _phase(columns: dict[str, Numbers]) -> tuple[Numbers, float]:
    """Phases from 0 to 1 and the duration in s, of a cycle without gaps that closes."""
    name = "time" if "time" in columns else "phase"
    time = columns.pop(name)
    steps = numpy.diff(time)
    if not (steps > 0).all():
        at = int((steps <= 0).argmax())
        raise ValueError(f"{name} does not rise from row {at + 1} to row {at + 2}")
    usual = float(numpy.median(steps))
    if steps.max() > _GAP * usual:
        at = int(steps.argmax())
        raise ValueError(
            f"{name} has a gap from {time[at]:g} to {time[at + 1]:g}, {steps.max() / usual:.3g} usual steps long"
        )
    for title, values in columns.items():
        _check_closed(title, values)
    return (time - time[0]) / (time[-1] - time[0]), float(time[-1] - time[0]) if name == "time" else 1.0


def _check_closed(name: str, values: Numbers) -> None:
    missing, span = abs(values[-1] - values[0]), float(numpy.ptp(values))
    if missing > _CLOSED * span:
        unit, factor = ("°", 180 / pi) if name in _ANGLES else (" N", 1.0)
        begin, end = (f"{factor * values[at]:.4g}{unit}" for at in (0, -1))
        raise ValueError(
            f"the cycle does not close: {name} begins with {begin} and ends with {end}; "
            "the last line is the first again, one cycle later"
        )
    require(name, span, span < numpy.inf, "it is finite")


def _course(phase: Numbers, values: Numbers) -> Course:
    """Monotone between the lines, and smooth over the end of the cycle."""
    from scipy.interpolate import PchipInterpolator

    around: Any = values.copy()
    around[..., -1] = around[..., 0] = (values[..., 0] + values[..., -1]) / 2
    before, after = slice(-4, -1), slice(1, 4)
    times = numpy.concatenate([phase[before] - 1, phase, phase[after] + 1])
    every = numpy.concatenate([around[..., before], around, around[..., after]], axis=-1)
    made = PchipInterpolator(times, every, axis=-1)
    return lambda phases: numpy.asarray(made(phases))
