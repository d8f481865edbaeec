"""Tables of wear tests with several stations: a column for each station, or a column with the name of the station."""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from ..core.checks import check_text, shown
from ..core.input_files import open_input
from ..files.cells import Cell, cell_number, decimal_mark, possible_rows
from ..files.columns import Head, split_head

_MAX_BYTES = 10_000_000
_STATION = "station"
_SIGNS = re.compile(r"[\[(]")
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
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from error


def _read_cells(path: Path) -> tuple[list[str], list[list[Cell]], str]:
    """Read the heads and the cells of a table in text or Excel, and its decimal mark."""
    with open_input(path) as stream:
        raw = stream.read(_MAX_BYTES + 1)
    if len(raw) > _MAX_BYTES:
        raise ValueError(f"the table is larger than {_MAX_BYTES} bytes")
    for separator, rows in possible_rows(raw):
        (_, heads), *numbered = [row for row in rows if any(str(cell) for cell in row[1])] or [(0, [])]
        if len(heads) > 1 and numbered:
            mark = decimal_mark(((line, cell) for line, cells in numbered for cell in cells), separator)
            body = [[*cells, *[""] * (len(heads) - len(cells))] for _, cells in numbered]
            return [str(head) for head in heads], body, mark
    raise ValueError("the table needs a line of heads and at least one line of readings")


def _parse_readings(table: tuple[list[str], list[list[Cell]], str], quantity: str, unit: str | None) -> StationReadings:
    """Find the columns of a table, and collect its readings."""
    texts, body, mark = table
    heads = [split_head(text, (_STATION, *_CYCLES, quantity)) for text in texts]
    names = [head.name for head in heads]
    cycle_column = next((column for column, name in enumerate(names) if name in _CYCLES), None)
    is_long = _STATION in names
    if is_long and quantity not in names:
        raise ValueError(f"the column {quantity} is missing; the columns are {', '.join(texts)}")
    twice = next((text for text in texts if text and texts.count(text) > 1), None)
    if twice is not None:
        raise ValueError(f"the column {shown(twice)} appears twice: keep one, or name them after their stations")
    columns = [names.index(quantity)] if is_long else [c for c in range(len(names)) if c != cycle_column]
    rows = [
        (number, row, column, str(row[names.index(_STATION)]) if is_long else _SIGNS.split(texts[column])[0].strip())
        for column in columns
        for number, row in enumerate(body, start=1)
        if column < len(row) and row[column] != ""
    ]
    if not rows:
        raise ValueError("the table has no readings")
    return StationReadings(
        stations=tuple(_check_station(number, station) for number, _, _, station in rows),
        values=tuple(
            f"{_check_number(number, row[column], texts[column], mark)!r} {_check_unit(heads[column], unit)}"
            for number, row, column, _ in rows
        ),
        cycles=()
        if cycle_column is None
        else tuple(
            _cycle_factor(heads[cycle_column]) * _check_number(number, row[cycle_column], texts[cycle_column], mark)
            for number, row, _, _ in rows
        ),
    )


def _check_station(number: int, station: str) -> str:
    """Return the name of a station; ValueError if it is empty."""
    if not station:
        raise ValueError(f"row {number} names no station")
    return str(check_text("station", station))


def _check_number(number: int, cell: Cell, head: str, mark: str) -> float:
    """Convert the cell of a numbered row to a number."""
    value = cell_number(cell, mark)
    if not isfinite(value):
        raise ValueError(f"row {number} has {shown(cell)} under {shown(head)}, which is not a number")
    return value


def _check_unit(head: Head, unit: str | None) -> str:
    """Return the unit in a head, or else the stated one."""
    text = head.unit or unit
    if not text:
        raise ValueError(
            f"the column {shown(head.text)} has no unit: write '{head.text} [mg]' as its head, or unit = 'mg'"
        )
    return text


def _cycle_factor(head: Head) -> float:
    """Return the number of cycles for which 1 stands in the column of cycles."""
    if head.unit.lower() not in _CYCLE_UNITS:
        raise ValueError(f"the unit of {shown(head.text)} is not known; allowed are cycles and Mc (million cycles)")
    return _CYCLES[head.name] * _CYCLE_UNITS[head.unit.lower()]
