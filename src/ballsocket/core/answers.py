"""Description of a result: tables, checks and sentences, which every door prints in its own way.

A result lists its numbers once, in internal units, in a module beside it. Units and formats are applied by printers::

    columns = Column.of(WEAR["volume"]), Column.of(CONTACT["max_pressure"])
    table = Table("history", "Wear", columns, [Row((report.volume, report.max_pressure)) for report in reports])
    Answer(title="Wear of a hip", tables=[table], notes=history.notes)

`ballsocket.reports.terminal` and `ballsocket.reports.pages` print it; `records` and `to_frame` are its data.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import Any, NamedTuple

from .bounded import Bounded, Verdict
from .checks import needs
from .display import html_table, plain_number
from .kinds import PLAIN, Unit
from .quantities import Quantity
from .unit_systems import Amount, Units, fixed_text

PAGE, QUIET = 18, 19
"""Ranks of what a terminal leaves out, and of what only data have: JSON, CSV and data frames."""


@dataclass(frozen=True)
class Judged:
    """Number in the internal unit with the verdict on it, which its mark shows: "?" undecided, "*" exceeded."""

    value: float
    verdict: Verdict


Cell = float | str | bool | Amount | Judged | tuple[float, ...] | None
"""Number in the internal unit, words, an amount with a unit of its own, or the ends of a range; None is missing."""


@dataclass(frozen=True, kw_only=True)
class Column:
    """Column of a table."""

    key: str  # in JSON
    name: str  # in CSV and data frames, with the unit at its end
    head: str
    title: str = ""  # meaning of the head in words
    unit: Unit | None = None  # metric unit for readers, also of a plain number; None for a column of words
    written: Unit = PLAIN  # unit in data
    digits: int = 4  # significant, for readers
    decimals: int | None = None  # in the metric unit, in place of significant digits
    rank: int = 0  # the highest ranks leave a narrow terminal first; 0 stays, `QUIET` is in data only

    @classmethod
    def of(cls, quantity: Quantity, *, head: str = "", digits: int = 4, rank: int = 0) -> Column:
        """Make the column of a quantity; its head is by default the symbol, else the title."""
        return cls(
            key=quantity.key,
            name=quantity.column,
            head=head or quantity.symbol or quantity.title,
            title=quantity.title,
            unit=quantity.shown,
            written=quantity.written,
            digits=digits,
            rank=rank,
        )

    @classmethod
    def of_words(cls, key: str, head: str = "", rank: int = 0) -> Column:
        """Make a column of words."""
        return cls(key=key, name=key, head=head or key, rank=rank)

    @classmethod
    def of_number(cls, key: str, head: str = "", unit: Unit = PLAIN, *, digits: int = 4, rank: int = 0) -> Column:
        """Make a column of numbers that are no quantity of the package, or of amounts with units of their own."""
        return cls(key=key, name=key, head=head or key, unit=unit, digits=digits, rank=rank)


class Row(NamedTuple):
    """Row of a table: its cells, the verdict that colours it, and its rank, which is that of a column.

    Readers find the rows of `below` under it, such as deviations in percent; data do not have them.
    """

    cells: Sequence[Cell]
    verdict: Verdict | None = None
    rank: int = 0
    below: Sequence[Sequence[Cell]] = ()


class Table(NamedTuple):
    """Table of a result, with its key in JSON, its title on a page, and sentences that belong to it."""

    key: str
    title: str
    columns: Sequence[Column]
    rows: Sequence[Row]
    lines: Sequence[str] = ()


@dataclass(frozen=True, kw_only=True)
class Answer:
    """Description of a result."""

    title: str
    lines: Sequence[str] = ()  # sentences before the tables
    tables: Sequence[Table] = ()
    notes: Sequence[str] = ()  # sentences on assumptions and limits


@dataclass(frozen=True, kw_only=True)
class Check:
    """Comparison of one demand on a joint with its capacity; plain data, which a process can return."""

    title: str  # demand in words, such as "pressure on the liner"
    quantity: str  # name of the quantity of demand and capacity in `QUANTITIES`
    demand: Bounded  # with its error bar, in internal units: mm, MPa, rad
    capacity: float | None  # largest acceptable value; None if it is unknown
    limit: str  # capacity in words, such as "allowable pressure"
    source: str  # origin of the capacity, or the input that is missing
    trusted: bool = True  # the demand lies in the range of its model
    part: str = ""  # body of a stress: "liner" or "ball"

    @cached_property
    def ratio(self) -> Bounded | None:
        """Ratio of demand to capacity; None without a capacity."""
        return None if self.capacity is None else self.demand.scaled(1 / self.capacity)

    @cached_property
    def verdict(self) -> Verdict:
        """Verdict on the demand; undecided without a capacity, or for a kept one outside the range of its model."""
        if self.capacity is None:
            return Verdict.UNDECIDED
        verdict = self.demand.verdict(high=self.capacity)
        return verdict if self.trusted else max(verdict, Verdict.UNDECIDED)

    @property
    def is_near(self) -> bool:
        """True if the verdict is kept at more than 90 % of the capacity."""
        return self.ratio is not None and self.verdict is Verdict.KEPT and self.ratio.value > _NEAR

    @property
    def result(self) -> str:
        """Sign and word of the verdict, with the reason for an undecided one."""
        reason = ", near the limit" if self.is_near else ""
        if self.verdict is Verdict.UNDECIDED:
            reason = ": limit not known" if self.capacity is None else _UNTRUSTED if not self.trusted else _BAR
        return f"{self.verdict.sign} {self.verdict.word}{reason}"


_NEAR = 0.9  # ratio of demand to capacity from which a kept limit is near
_UNTRUSTED, _BAR = ": outside the range of the model", ": the error bar contains the limit"


class PrintedTable(NamedTuple):
    """Table as texts for readers: heads, their units, rows, and the verdicts of their cells."""

    columns: Sequence[Column]
    heads: list[str]
    units: list[str]
    rows: list[list[str]]
    verdicts: list[list[Verdict | None]]

    @property
    def heads_with_units(self) -> list[str]:
        """Heads with their units in brackets."""
        return [head + Unit(unit).text_in_brackets for head, unit in zip(self.heads, self.units, strict=True)]


def grid(table: Table, units: Units = Units.SI, most_rank: int = PAGE) -> PrintedTable:
    """Write the cells of a table up to a rank in a system of units."""
    shown = [index for index, column in enumerate(table.columns) if column.rank <= most_rank]
    columns = [table.columns[index] for index in shown]
    written = [units.written(column.unit or PLAIN) for column in columns]
    rows = [row for row in table.rows if row.rank <= most_rank]
    lines = [(cells, row.verdict) for row in rows for cells in (row.cells, *row.below)]
    texts = [
        [
            _text(cells[index], column, unit.factor, units)
            for index, column, unit in zip(shown, columns, written, strict=True)
        ]
        for cells, _ in lines
    ]
    heads, unit_texts = [column.head for column in columns], [unit.text for unit in written]
    verdicts = [[getattr(cells[index], "verdict", verdict) for index in shown] for cells, verdict in lines]
    return PrintedTable(columns, heads, unit_texts, texts, verdicts)


_MARKS = ("", "?", "*")


def _text(cell: Cell, column: Column, factor: float, units: Units) -> str:
    """Write a cell; `factor` leads from the internal unit to the shown one."""
    if cell is None or isinstance(cell, bool):
        return "-" if cell is None else "yes" if cell else "no"
    if isinstance(cell, str):
        return units.sentence(cell)
    if isinstance(cell, Amount):
        return units.amount(cell)
    if isinstance(cell, Judged):
        mark = "" if cell.value != cell.value else _MARKS[cell.verdict]
        return f"{_text(cell.value, column, factor, units)}{mark}"
    ends = cell if isinstance(cell, tuple) else (cell,)
    return " to ".join("-" if end != end else _number_text(end, column, factor) for end in ends)


def _number_text(number: float, column: Column, factor: float) -> str:
    if column.decimals is None or not isfinite(number):
        return plain_number(number * factor, column.digits)
    return fixed_text(number, factor, (column.unit or PLAIN).factor, column.decimals)


def records(table: Table) -> list[dict[str, Any]]:
    """Return the rows of a table as data for JSON by the keys of its columns; None for missing numbers."""
    return [dict(zip((column.key for column in table.columns), cells, strict=True)) for cells in _data(table)]


def named_records(table: Table) -> list[dict[str, Any]]:
    """Return the rows of a table as data for CSV and data frames by the names of its columns, with units."""
    return [dict(zip((column.name for column in table.columns), cells, strict=True)) for cells in _data(table)]


def to_frame(table: Table) -> Any:
    """Return a table as a pandas DataFrame; heads have units: "volume_mm3".

    Raises ImportError: pandas is not installed; the message has the command.
    """
    needs("study", "pandas")
    import pandas

    return pandas.DataFrame(named_records(table))


def to_html(table: Table) -> str:
    """Return a table in mm, N and MPa as HTML for a notebook."""
    written = grid(table)
    return html_table(written.heads_with_units, written.rows)


def _data(table: Table) -> Iterator[list[Any]]:
    for row in table.rows:
        yield [_datum(cell, column.written) for cell, column in zip(row.cells, table.columns, strict=True)]


def _datum(cell: Cell, unit: Unit) -> Any:
    if cell is None or isinstance(cell, str | bool):
        return cell
    if isinstance(cell, tuple):
        return [_datum(end, unit) for end in cell]
    number = cell.value if isinstance(cell, Amount | Judged) else cell
    return (number if unit.factor == 1 else number * unit.factor + 0.0) if isfinite(number) else None
