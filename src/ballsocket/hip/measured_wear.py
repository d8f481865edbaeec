"""Measured wear of a wear test or of patients: volumes, depths, penetrations or rates, also in tables of stations."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers, owned
from ..core.checks import check_text, known_name, refusals_of, require, shown
from ..core.display import counted
from ..files.cells import Cell, count_factor, count_words
from ..files.columns import CellTable, HeadChoice, read_cells

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
    with refusals_of(table.title):
        return _parse_readings(table, quantity, unit)


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


MILLION = 1e6  # cycles to which rates refer

WEAR_QUANTITIES: Mapping[str, str] = MappingProxyType(
    {"volume": "mm³", "depth": "mm", "penetration": "mm", "radiographic_penetration": "mm"}
)
"""Measured quantities with units: worn volume, deepest wear, displacement of the ball, and that in a radiograph."""

RATES = ("initial", "steady", "mean")
"""Kinds of rates: of the new bore, between two cycle counts, and from the new bore to a cycle count."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MeasuredWear:
    """Measured wear: totals at cycle counts, or a rate per million cycles.

    Parameters
    ----------
    quantity : str
        One of `WEAR_QUANTITIES`.
    values : number or array
        Totals in mm³ or mm, or rates in mm³ or mm per million cycles.
    cycles : number or array, optional
        Cycle count of each total.
    rate : str, optional
        Kind of a rate: "initial" of the new bore, "steady" from `begin` to `end`, "mean" from 0 to `end`.
    begin, end : float, optional
        Cycle counts of a rate.
    uncertainty : number or array, optional
        Standard uncertainty (k = 1) in the unit of the values. Without any, it is estimated from the scatter.
    relative_uncertainty : float, optional
        Standard uncertainty as a share of each true value, for which the fit has its fitted values: a reading that is
        low by chance has no larger weight.
    station : str or sequence of str, optional
        Station (specimen) of all values, or of each. Readings of one station at several cycle counts are cumulative
        and no independent values. Without it a data set is one specimen, and further values at the same cycle counts
        are further specimens, in the order of the values.
    density : float, optional
        Density in mg/mm³ by which a measured mass is the volume of the values; it is printed as the mass.
    name : str
        Name in messages.
    remark : str
        Sentence on lines of its file that are left out; empty without any.

    Raises
    ------
    ValueError
        A quantity or rate that is not known, missing cycles, or a number that is not allowed.

    Examples
    --------
    >>> MeasuredWear(quantity="volume", values=38.0, rate="steady", begin=5e6, end=1e7).description
    'volume rate, steady from 5 to 10 million cycles'
    """

    quantity: str
    values: Any
    cycles: Any = None
    rate: str | None = None
    begin: float | None = None
    end: float | None = None
    uncertainty: Any = None
    relative_uncertainty: float | None = None
    station: str | Sequence[str] | None = None
    density: float | None = None
    name: str = ""
    remark: str = ""

    def __post_init__(self) -> None:
        known_name("quantity", self.quantity, WEAR_QUANTITIES)
        values = _positive_array(self.quantity, self.values, "a measured wear is positive and finite")
        object.__setattr__(self, "values", values)
        if self.rate is None:
            self._check_totals(values)
        else:
            self._check_rate(known_name("rate", self.rate, RATES))
        if self.uncertainty is not None:
            sigma = _positive_array("uncertainty", self.uncertainty, "a standard uncertainty is positive and finite")
            if sigma.size not in (1, values.size):
                raise ValueError(f"uncertainty must have 1 or {values.size} numbers, got {sigma.size}")
            object.__setattr__(self, "uncertainty", numpy.broadcast_to(sigma, values.shape))
        if (share := self.relative_uncertainty) is not None:
            require("relative_uncertainty", share, 0 < share < inf, "a share of each value is positive and finite")
            if self.uncertainty is not None:
                raise ValueError("uncertainty and relative_uncertainty exclude each other: state one of them")
        if self.station is not None:
            names = (self.station,) * values.size if isinstance(self.station, str) else tuple(self.station)
            if len(names) != values.size:
                counts = f"{counted(len(names), 'name')} for {counted(values.size, 'value')}"
                raise ValueError(f"station has {counts}: one name, or one for each")
            object.__setattr__(self, "station", names)

    def _check_totals(self, values: Numbers) -> None:
        if self.begin is not None or self.end is not None:
            raise ValueError(f"from and to belong to a rate of {self.quantity}: state rate, or cycles for totals")
        if self.cycles is None:
            raise ValueError(
                f"{self.quantity} needs the cycles of its values, or else the kind of its rate: {', '.join(RATES)}"
            )
        cycles = _positive_array("cycles", self.cycles, "a number of cycles is positive and finite")
        if cycles.size != values.size:
            raise ValueError(
                f"{self.quantity} has {counted(values.size, 'value')} and cycles has {cycles.size}: one for each value"
            )
        object.__setattr__(self, "cycles", cycles)

    def _check_rate(self, rate: str) -> None:
        quantity, begin = self.quantity, self.begin or 0.0
        if self.cycles is not None:
            raise ValueError(f"a rate of {quantity} takes from and to, not cycles")
        if rate == "initial":
            if quantity not in ("volume", "depth"):
                raise ValueError(f"an initial rate of {quantity} is not defined: use volume, or a steady rate")
            if self.begin is not None or self.end is not None:
                raise ValueError("an initial rate is that of the new bore: remove from and to")
            return
        if self.end is None or (rate == "steady" and self.begin is None):
            needed = "from and to" if rate == "steady" else "to"
            raise ValueError(f"a {rate} rate of {quantity} needs {needed}: numbers of cycles, such as to = 5e6")
        if rate == "mean" and self.begin:
            raise ValueError(f"a mean rate is from 0 cycles, got from = {shown(self.begin)}: use rate = 'steady'")
        rule = f"it is above the {counted(begin, 'cycle')} of from, and finite"
        require("to", self.end, 0 <= begin < self.end < inf, rule)

    def __len__(self) -> int:
        return len(self.values)

    def standard_uncertainty(self, fitted: Numbers) -> Numbers:
        """Compute the standard uncertainty of each value from its fitted value, which it is itself if unknown."""
        if self.uncertainty is not None:
            return numpy.asarray(self.uncertainty)
        return fitted if self.relative_uncertainty is None else self.relative_uncertainty * fitted

    @property
    def unit(self) -> str:
        """Unit of the values: mm³ or mm, for a rate per million cycles (Mc)."""
        return WEAR_QUANTITIES[self.quantity] + ("" if self.rate is None else "/Mc")

    @property
    def measured_quantity(self) -> str:
        """Measured quantity in words: the mass, if a density is stated."""
        return self.quantity.replace("_", " ") if self.density is None else "mass"

    @property
    def description(self) -> str:
        """Quantity, kind of rate and cycle counts in words."""
        quantity = self.measured_quantity
        if self.rate is None:
            return f"{quantity} after {', '.join(f'{count / MILLION:g}' for count in self.cycles)} million cycles"
        if self.rate == "initial":
            return f"{quantity} rate, initial, of the new bore"
        begin, end = ((count or 0.0) / MILLION for count in (self.begin, self.end))
        return f"{quantity} rate, {self.rate} from {begin:g} to {end:g} million cycles"

    @property
    def counts(self) -> list[float]:
        """Cycle counts at which the simulation is needed; empty for an initial rate."""
        if self.rate is None:
            return [float(count) for count in self.cycles]
        return [float(count) for count in (self.begin, self.end) if count]

    def predict(self, totals: Callable[[float], float], initial: float) -> Numbers:
        """Compute the values of this data set from totals by cycle count, and the initial rate per million cycles."""
        if self.rate is None:
            return numpy.array([totals(count) for count in self.counts])
        if self.rate == "initial":
            return numpy.full(len(self), initial)
        begin, end = float(self.begin or 0.0), float(self.end or 0.0)
        start = totals(begin) if begin else 0.0
        return numpy.full(len(self), MILLION * (totals(end) - start) / (end - begin))

    def other_readings(self) -> Iterator[MeasuredWear]:
        """Yield this rate as those of other kinds: of the new bore, of the second million, from 5 to 10 million."""
        if self.quantity in ("volume", "depth"):
            yield replace(self, rate="initial", begin=None, end=None)
        for begin, end in ((1e6, 2e6), (5e6, 1e7)):
            yield replace(self, rate="steady", begin=begin, end=end)


def _positive_array(name: str, numbers: Any, rule: str) -> Numbers:
    """Convert a number or a sequence to an array; ValueError for numbers that are not positive and finite."""
    array = numpy.atleast_1d(numpy.asarray(numbers, dtype=float))
    require(name, array, (array > 0) & (array < inf), rule)
    return owned(array)
