"""Tables of wear tests with several stations: a column for each station, or a column with the name of the station."""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy

from ..core.checks import check_text, shown
from ..files.cells import Cell, count_words
from ..files.columns import CellTable, HeadChoice, read_cells
from ..files.head_names import count_factor

_STATION = "station"
_CYCLES = {"cycles": 1.0, "million_cycles": 1e6}  # numbers of cycles by the head of their column


@dataclass(frozen=True, kw_only=True)
class StationReadings:
    """Readings of a table of stations."""

    stations: tuple[str, ...]  # name of the station of each reading
    values: tuple[str, ...]  # readings with their units, such as "12.5 mg"
    cycles: tuple[float, ...]  # number of cycles of each reading; empty for a table of rates without such a column
    remark: str  # sentence on lines of the file that are left out; empty without any


def read_stations(path: Path, quantity: str, unit: str | None, choice: HeadChoice) -> StationReadings:
    """Read the readings of several stations from a table in text or Excel.

    The head of one column is `cycles`, or `cycles [Mc]` for millions. In the long form there is a column `station`, and
    a column with the name of the quantity, such as `mass [mg]`. In the wide form every other column is a station, named
    by its head, such as `A [mg]`. `unit` is that of columns without one in their heads. An empty cell is no reading,
    and a reading of 0 at 0 cycles is left out.

    Raises ValueError: a column is missing, unknown or without a unit, or a cell is not a number.
    """
    table = read_cells(path, (*_CYCLES, quantity), choice, texts=(_STATION,))
    try:
        return _parse_readings(table, quantity, unit)
    except ValueError as error:
        raise ValueError(f"{table.title}: {error}") from error


def _parse_readings(table: CellTable, quantity: str, unit: str | None) -> StationReadings:
    heads = {head.name: head for head in table.heads}
    counts = [heads[name] for name in _CYCLES if name in heads]
    columns = [head for head in table.heads if head not in counts]
    names = [re.split(r"[\[(]", head.text)[0].strip() for head in columns]
    stations: dict[int, Cell] = {}
    if _STATION in heads:
        if quantity not in heads:
            texts = ", ".join(head.text for head in table.heads)
            raise ValueError(f"the column {quantity} is missing; the columns are {texts}")
        if "" in heads:
            text = shown(heads[""].text)
            raise ValueError(f"column {text} is not known: leave it out with skip = [{text}]")
        columns, names, stations = [heads[quantity]], [""], dict(table.cells(heads[_STATION]))
    elif twice := next((name for name in names if names.count(name) > 1), None):
        raise ValueError(f"the column {shown(twice)} appears twice: keep one, or name them after their stations")
    numbers = table.numbers([*counts, *columns])
    cycles = numpy.ones(len(numbers))
    if counts:
        text, unit_of_counts = shown(counts[0].text), counts[0].unit
        if len(counts) > 1:
            raise ValueError(f"the cycles are in two columns, {text} and {shown(counts[1].text)}: skip one")
        factor = count_factor(unit_of_counts)
        if factor is None:
            raise ValueError(f"the unit {unit_of_counts} of {text} is not known; allowed are cycles, Mc and 10^6")
        cycles = _CYCLES[counts[0].name] * factor * numbers.columns[0]
    readings: list[tuple[str, str, float]] = []
    unused = set()
    for head, name, values in zip(columns, names, numbers.columns[len(counts) :], strict=True):
        for (line, cell), value, count in zip(table.cells(head), values.tolist(), cycles.tolist(), strict=True):
            if not count_words([cell]):
                continue
            if not isfinite(value):
                raise ValueError(f"line {line} has {shown(cell)} under {shown(head.text)}, which is not a number")
            if not isfinite(count):
                raise ValueError(f"line {line} has a reading, and no number of cycles")
            if not (head.unit or unit):
                text = head.text
                raise ValueError(
                    f"the column {shown(text)} has no unit: write '{text} [mg]' as its head, or unit = 'mg'"
                )
            station = stations.get(line, name)
            station = station if isinstance(station, str) else f"{station:g}"
            if not station:
                raise ValueError(f"line {line} names no station")
            if value == count == 0:
                unused.add(line)
            else:
                readings.append((check_text("station", station), f"{value!r} {head.unit or unit}", count))
    if not readings:
        raise ValueError("the table has no readings")
    labels, stated, ends = zip(*readings, strict=True)
    remark = numbers.remark({"at 0 cycles": len(unused)})
    return StationReadings(stations=labels, values=stated, cycles=ends if counts else (), remark=remark)
