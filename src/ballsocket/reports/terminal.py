"""Descriptions of results in a terminal: tables that fit its width, and folded sentences."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import replace
from math import degrees, pi

import numpy
from rich.console import Console
from rich.table import Column as RichColumn
from rich.table import Table as RichTable
from rich.text import Text

from ..comparison import Comparison
from ..contact.verdict import Verdict
from ..core.answers import PAGE, Answer, Column, PrintedTable, Table, grid
from ..core.arrays import Numbers
from ..core.unit_systems import Units
from ..press_answer import describe_press

_BARS = " ▁▂▃▄▅▆▇█"
_BARS_ASCII = " .:-=+*#@"


def print_press(comparison: Comparison, remarks: Iterable[str] = (), units: Units = Units.SI) -> None:
    """Print a comparison; where the terminal is wide enough, bars show the pressure of each model over the angle."""
    described = describe_press(comparison, remarks)
    (table,) = described.tables
    angles = numpy.linspace(0.0, _profile_end(comparison), 12)
    profiles = _profiles(comparison, angles, _BARS if Terminal(units).encoding.startswith("utf") else _BARS_ASCII)
    column = Column.of_words("profile", f" p, 0° to {degrees(angles[-1]):.0f}°", rank=PAGE - 1)
    rows = [
        row._replace(
            cells=[*row.cells[:-1], f" {profiles.get(str(row.cells[0]), '')}", row.cells[-1]],
            below=[[*cells[:-1], "", cells[-1]] for cells in row.below],
        )
        for row in table.rows
    ]
    table = table._replace(columns=[*table.columns[:-1], column, table.columns[-1]], rows=rows)
    print_answer(replace(described, tables=[table]), units)


_STYLES = {None: "", Verdict.KEPT: "", Verdict.UNDECIDED: "yellow", Verdict.EXCEEDED: "red"}


def print_answer(answer: Answer, units: Units = Units.SI) -> None:
    """Print a description: title, sentences, tables with their sentences, and notes."""
    terminal = Terminal(units)
    print_folded(terminal, answer.title, "bold")
    for line in answer.lines:
        print_folded(terminal, line, "")
    for table in answer.tables:
        print_table(terminal, table)
    for note in answer.notes:
        print_folded(terminal, note, "dim")


def print_table(terminal: Terminal, table: Table) -> None:
    """Print a table with as many columns as fit, and its sentences; columns that must stay follow in blocks below.

    Each block begins with the first column and the columns of words next to it.
    """
    written, gap = _fitting_grid(terminal, table)
    if written.rows:
        texts = RichTable(box=None, pad_edge=False, header_style="bold", padding=(0, gap, 0, 0))
        for column in written.columns:  # words may be folded, numbers are not
            is_number = column.unit is not None
            texts.add_column(Text(column.head), justify="right" if is_number else "left", no_wrap=is_number)
        if any(written.units):
            texts.add_row(*(Text(unit, style="dim") for unit in written.units))
        for row, verdicts in zip(written.rows, written.verdicts, strict=True):
            texts.add_row(*(Text(text, style=_STYLES[verdict]) for text, verdict in zip(row, verdicts, strict=True)))
        lead = 1 + next((i for i, column in enumerate(written.columns[1:]) if column.unit is not None), 0)
        print_columns(terminal, texts, lead)
    for line in table.lines:
        print_folded(terminal, line, "")
    symbols = [column for column in written.columns if _meaning(column) != column.head]
    if symbols:
        print_folded(terminal, ", ".join(map(_meaning, symbols)), "dim")
    omitted = [column for column in table.columns if column.rank < PAGE and column not in written.columns]
    if omitted:
        text = ", ".join(map(_meaning, omitted))
        print_folded(terminal, f"not shown, the terminal is too narrow: {text}", "dim")


def _meaning(column: Column) -> str:
    """Return the head of a column, and the title of a symbol; words stand for themselves."""
    has_symbol = " " not in column.head and column.head not in column.title.split()
    return f"{column.head} {column.title}".strip() if has_symbol else column.head


def _fitting_grid(terminal: Terminal, table: Table) -> tuple[PrintedTable, int]:
    """Write a table without the columns of the highest ranks, as long as it is too wide, and return its gap.

    One space between the columns comes before columns that are left out.
    """
    ranks = sorted({column.rank for column in table.columns if column.rank < PAGE}, reverse=True)
    for rank in ranks:
        written = grid(table, terminal.units, rank)
        texts = zip(written.heads, written.units, *written.rows, strict=True)
        width, gaps = sum(max(map(len, column)) for column in texts), len(written.heads) - 1
        if width + gaps <= terminal.width:
            return written, 2 if width + 2 * gaps <= terminal.width else 1
    return written, 2


class Terminal(Console):
    """Console that does not colour numbers, with the units of its sentences and tables."""

    def __init__(self, units: Units = Units.SI) -> None:
        super().__init__(highlight=False)
        self.units = units


def print_folded(terminal: Terminal, text: str, style: str) -> None:
    """Print a line in the units of the terminal, folded between words, with continuation lines indented."""
    written, width = terminal.units.sentence(text), max(terminal.width, 20)
    folded = textwrap.fill(written, width, subsequent_indent="    ", break_on_hyphens=False)
    terminal.print(Text(folded, style=style), soft_wrap=True)


def print_columns(terminal: Console, table: RichTable, lead: int) -> None:
    """Print a table without a cut number: columns that do not fit follow below, beside the first `lead` ones again.

    Columns without `no_wrap` are folded between words first.
    """
    limits = [_width_limits(terminal, column) for column in table.columns]
    gap = table.padding[1] + table.padding[3]
    for indices in _column_blocks([least for least, _ in limits], gap, terminal.width, lead):
        part = copy(table)
        widths = _fitted_widths([limits[index] for index in indices], terminal.width - gap * (len(indices) - 1))
        part.columns = [
            replace(table.columns[index], _index=position, width=width)
            for position, (index, width) in enumerate(zip(indices, widths, strict=True))
        ]
        terminal.print(part)


def _width_limits(terminal: Console, column: RichColumn) -> tuple[int, int]:
    """Return the least and the largest useful width of a column: its longest word, and its longest cell."""
    unbounded = terminal.options.update(width=10_000)
    sizes = [terminal.measure(cell, options=unbounded) for cell in (column.header, *column.cells)]
    longest = max(size.maximum for size in sizes)
    return longest if column.no_wrap else max(size.minimum for size in sizes), longest


def _column_blocks(widths: Sequence[int], gap: int, available: int, lead: int) -> list[list[int]]:
    """Group the columns of a table into blocks that fit; each block begins with the first `lead` columns."""
    first = list(range(lead))
    blocks, width_of_first = [[*first]], sum(widths[:lead]) + gap * (lead - 1)
    used = width_of_first
    for index, width in enumerate(widths[lead:], start=lead):
        if used + gap + width > available and len(blocks[-1]) > lead:
            blocks.append([*first])
            used = width_of_first
        blocks[-1].append(index)
        used += gap + width
    return blocks


def _fitted_widths(limits: Sequence[tuple[int, int]], available: int) -> list[int]:
    """Narrow the widest columns until all fit, none below its least width."""
    widths = [longest for _, longest in limits]
    while sum(widths) > available:
        reducible = [index for index, (least, _) in enumerate(limits) if widths[index] > least]
        if not reducible:
            break
        widths[max(reducible, key=widths.__getitem__)] -= 1
    return widths


def _profiles(comparison: Comparison, angles: Numbers, bars: str) -> dict[str, str]:
    """Draw the pressure of every model over the angles as a row of bars, to one scale."""
    pressures = {
        name: 0 * angles if contact.status.failed else numpy.nan_to_num(contact.pressure(angles), posinf=0.0)
        for name, contact in comparison.items()
    }
    highest = max((pressure.max() for pressure in pressures.values()), default=0.0)
    scale = highest if highest > 0 else 1.0
    shares = {name: numpy.clip(pressure / scale, 0.0, 1.0) for name, pressure in pressures.items()}
    return {name: "".join(bars[round(8 * float(level))] for level in share).rstrip() for name, share in shares.items()}


def _profile_end(comparison: Comparison) -> float:
    """Return the last angle (rad) of the pressure profiles: the end of the socket of a preloaded joint, else π/2."""
    if comparison.joint.clearance >= 0:
        return pi / 2
    cups = (contact.model.cup for contact in comparison.values() if hasattr(contact.model, "cup"))
    return max((float(cup.arc_of_cover) / 2 for cup in cups), default=pi / 2)
