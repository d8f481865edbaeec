"""Tables of wear tests with several stations: a column for each station, or a column with the name of the station."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..core.checks import check_text, shown
from ..core.input_files import open_input
from ..files.columns import split_head

_MAX_BYTES = 10_000_000
_STATION = "station"
_CYCLES = {"cycles": 1.0, "million cycles": 1e6, "mc": 1e6}
"""Numbers of cycles by the head of their column."""

_CYCLE_UNITS = {"": 1.0, "1": 1.0, "cycles": 1.0, "million": 1e6, "million cycles": 1e6, "mc": 1e6}


@dataclass(frozen=True, kw_only=True)
class StationReadings:
    """Readings of a table of stations, in the order of its rows.

    Attributes
    ----------
    stations : tuple of str
        Name of the station of each reading.
    values : tuple of str
        Readings with their units, such as "12.5 mg".
    cycles : tuple of float
        Number of cycles of each reading; empty for a table of rates without such a column.
    """

    stations: tuple[str, ...]
    values: tuple[str, ...]
    cycles: tuple[float, ...]


def read_stations(path: Path, quantity: str, unit: str | None = None) -> StationReadings:
    """Read the readings of several stations from a table with columns separated by commas, semicolons or tabs.

    The head of one column is `cycles`, or `cycles [Mc]` for millions. In the long form there is a column `station`, and
    a column with the name of the quantity, such as `mass [mg]`. In the wide form every other column is a station, named
    by its head, such as `A [mg]`; an empty cell is no reading. Lines that begin with # are skipped.

    Parameters
    ----------
    path : Path
    quantity : str
        Measured quantity, such as "volume" or "mass".
    unit : str, optional
        Unit of columns without one in their heads.

    Raises
    ------
    ValueError
        A column is missing, unknown or without a unit, or a cell is not a number.
    OSError
        The file cannot be read.
    """
    try:
        return _parse_readings(_read_cells(path), quantity, unit)
    except (ValueError, csv.Error) as error:
        raise ValueError(f"{path.name}: {error}") from error


def _read_cells(path: Path) -> list[list[str]]:
    """Read the cells of a table, heads first, with points as decimal marks."""
    with open_input(path) as stream:
        raw = stream.read(_MAX_BYTES + 1)
    if len(raw) > _MAX_BYTES:
        raise ValueError(f"the table is larger than {_MAX_BYTES} bytes")
    lines = [line for line in raw.decode("utf-8-sig").splitlines() if line.strip() and not line.startswith("#")]
    if len(lines) < 2:
        raise ValueError("the table needs a line of heads and at least one line of readings")
    separator = max(",;\t", key=lines[0].count)
    heads, *rows = csv.reader(lines, delimiter=separator, strict=True)
    mark = "." if separator == "," else ","
    return [[head.strip() for head in heads], *([cell.strip().replace(mark, ".") for cell in row] for row in rows)]


def _parse_readings(cells: Sequence[Sequence[str]], quantity: str, unit: str | None) -> StationReadings:
    """Find the columns of a table, and collect its readings."""
    heads = [split_head(head) for head in cells[0]]
    names = [name.lower() for name, _ in heads]
    cycle_column = next((column for column, name in enumerate(names) if name in _CYCLES), None)
    is_long = _STATION in names
    if is_long and quantity not in names:
        raise ValueError(f"the column {quantity} is missing; the columns are {', '.join(cells[0])}")
    columns = [names.index(quantity)] if is_long else [c for c in range(len(names)) if c != cycle_column]
    rows = [
        (number, row, column, row[names.index(_STATION)] if is_long else heads[column][0])
        for column in columns
        for number, row in enumerate(cells[1:], start=1)
        if column < len(row) and row[column]
    ]
    if not rows:
        raise ValueError("the table has no readings")
    return StationReadings(
        stations=tuple(_check_station(number, station) for number, _, _, station in rows),
        values=tuple(
            f"{_check_number(number, row[column], cells[0][column])!r} {_check_unit(cells[0][column], unit)}"
            for number, row, column, _ in rows
        ),
        cycles=()
        if cycle_column is None
        else tuple(
            _cycle_factor(cells[0][cycle_column]) * _check_number(number, row[cycle_column], cells[0][cycle_column])
            for number, row, _, _ in rows
        ),
    )


def _check_station(number: int, station: str) -> str:
    """Return the name of a station; ValueError if it is empty."""
    if not station:
        raise ValueError(f"row {number} names no station")
    return str(check_text("station", station))


def _check_number(number: int, cell: str, head: str) -> float:
    """Convert the cell of a numbered row to a number."""
    try:
        return float(cell)
    except ValueError as error:
        raise ValueError(f"row {number} has {shown(cell)} under {shown(head)}, which is not a number") from error


def _check_unit(head: str, unit: str | None) -> str:
    """Return the unit in a head, or else the stated one."""
    text = split_head(head)[1] or unit
    if not text:
        raise ValueError(f"the column {shown(head)} has no unit: write '{head} [mg]' as its head, or unit = 'mg'")
    return text


def _cycle_factor(head: str) -> float:
    """Return the number of cycles for which 1 stands in the column of cycles."""
    name, unit = split_head(head)
    if unit.lower() not in _CYCLE_UNITS:
        raise ValueError(f"the unit of {shown(head)} is not known; allowed are cycles and Mc (million cycles)")
    return _CYCLES[name.lower()] * _CYCLE_UNITS[unit.lower()]
