"""Comparison of models in a terminal, and helpers for all terminal output."""

from __future__ import annotations

import textwrap
from collections.abc import Container, Iterable, Sequence
from copy import copy
from dataclasses import replace
from math import degrees, pi

import numpy
from rich.console import Console
from rich.table import Column as RichColumn
from rich.table import Table as RichTable
from rich.text import Text

from ..comparison import Comparison, relative_deviation
from ..contact import Contact
from ..contact.describe import COLUMNS, Column, columns_of, number_text
from ..contact.verdict import Verdict, strength_lines
from ..core.answers import PAGE, Answer, Grid, Table, grid
from ..core.quantities import CONTACT, HEADLINE
from ..core.unit_systems import Units
from ..model_catalogue import reference
from ..problem import Joint

_BARS = " ▁▂▃▄▅▆▇█"
_BARS_ASCII = " .:-=+*#@"
_PROFILE = "profile"
_OFF_THE_POLE = ("pole_pressure", "max_pressure_angle")
_DROPPED_LAST = ("stiffness", "area", "indentation", "force", "half_angle")
_DROPPED = (
    _PROFILE,
    *(name for name in reversed(tuple(CONTACT)) if name not in (*_DROPPED_LAST, "max_pressure")),
    *_DROPPED_LAST,
)
"""Columns that a narrow terminal omits, in this order; never the largest pressure, nor ratios of stress to strength."""


def print_press(comparison: Comparison, remarks: Iterable[str] = (), units: Units = Units.SI) -> None:
    """Print a comparison as a table: the exact solution first, below each other model its deviations.

    Bars beside the numbers show the pressure from the pole to 90 degrees. Symbols, remarks and notes follow below.
    """
    terminal, ordered, exact = Terminal(units), comparison, comparison.get(reference.name)
    if exact is not None and exact.valid:
        ordered = replace(comparison, contacts={reference.name: exact, **comparison.contacts})
    print_joint(terminal, ordered.joint)
    table, shown = _fitting_table(ordered, terminal, units)
    terminal.print(table)
    for line in strength_lines(ordered.contacts):
        print_folded(terminal, line, "")
    symbols = ", ".join(f"{column.symbol} {column.title}" for column in shown)
    deviating = any(ordered.deviation(name) is not None for name in ordered)
    lines = [f"{symbols}; Δ % from {reference.name}" if deviating else symbols]
    known = [*_pole_columns(ordered), *(column.attribute for column in shown)]
    omitted = [column for column in columns_of(ordered.joint, units) if column.attribute not in known]
    if omitted:
        text = ", ".join(f"{column.symbol} {column.title}" for column in omitted)
        lines.append(f"not shown, the terminal is too narrow: {text}")
    for line in (*lines, *remarks, *ordered.notes()):
        print_folded(terminal, line, "dim")


def print_curve(contact: Contact) -> None:
    """Print contacts at increasing loads as a table of the main quantities, and the notes."""
    terminal = Terminal()
    print_folded(terminal, f"{contact.model.name} on {contact.joint}", "bold")
    columns = [column for column in COLUMNS if column.attribute in HEADLINE]
    values = [column.values_of(contact) for column in columns]
    rows = [
        [*(number_text(value[index], 4, "-") for value in values), "yes" if valid else "no"]
        for index, valid in enumerate(contact.valid)
    ]
    heads = [*(column.head for column in columns), "valid"]
    print_columns(terminal, text_table(heads, rows, left=("valid",), gap=1))
    for note in contact.notes:
        print_folded(terminal, note, "dim")


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
    written = _fitting_grid(terminal, table)
    if written.rows:
        words = [column.head for column in written.columns if column.unit is None]
        texts = text_table(written.heads, left=words, folded=words)
        if any(written.units):
            texts.add_row(*(Text(unit, style="dim") for unit in written.units))
        for row, verdict in zip(written.rows, written.verdicts, strict=True):
            texts.add_row(*(Text(text, style=_STYLES[verdict]) for text in row))
        lead = 1 + next((i for i, column in enumerate(written.columns[1:]) if column.unit is not None), 0)
        print_columns(terminal, texts, lead)
    for line in table.lines:
        print_folded(terminal, line, "")


def _fitting_grid(terminal: Terminal, table: Table) -> Grid:
    """Write a table without the columns of the highest ranks, as long as it is too wide."""
    ranks = sorted({column.rank for column in table.columns if column.rank < PAGE}, reverse=True)
    for rank in ranks:
        written = grid(table, terminal.units, rank)
        widths = (max(map(len, texts)) for texts in zip(written.heads, written.units, *written.rows, strict=True))
        if sum(widths) + 2 * len(written.heads) - 2 <= terminal.width:
            break
    return written


class Terminal(Console):
    """Console that does not colour numbers, with the units of its sentences and tables."""

    def __init__(self, units: Units = Units.SI) -> None:
        super().__init__(highlight=False)
        self.units = units


def text_table(
    heads: Iterable[str],
    rows: Iterable[Sequence[str | Text]] = (),
    left: Container[str] = (),
    folded: Container[str] = (),
    gap: int = 2,
) -> RichTable:
    """Make a table of texts; columns are aligned to the right but in `left`, and in one line but in `folded`."""
    table = RichTable(box=None, pad_edge=False, header_style="bold", padding=(0, gap, 0, 0))
    for head in heads:
        table.add_column(Text(head), justify="left" if head in left else "right", no_wrap=head not in folded)
    for row in rows:
        table.add_row(*(Text(cell) if isinstance(cell, str) else cell for cell in row))  # "[nm]" is no style of rich
    return table


def print_folded(console: Console, text: str, style: str) -> None:
    """Print a line in the units of the console, folded between words, with continuation lines indented."""
    console.print(Text(_folded(_units_of(console).sentence(text), console), style=style), soft_wrap=True)


def _folded(text: str, console: Console) -> str:
    """Fold a line between words, with continuation lines indented."""
    return textwrap.fill(text, max(console.width, 20), subsequent_indent="    ", break_on_hyphens=False)


def print_joint(terminal: Console, joint: Joint, end: str = "", start: str = "") -> None:
    """Print the description of a joint, whose name is not converted to other units."""
    folded = _folded(start + _units_of(terminal).joint(joint) + end, terminal)
    terminal.print(Text(folded, style="bold"), soft_wrap=True)


def _units_of(terminal: Console) -> Units:
    """Return the units of a console; SI for one of another kind."""
    return terminal.units if isinstance(terminal, Terminal) else Units.SI


def print_columns(terminal: Console, table: RichTable, lead: int = 1) -> None:
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


def _fitting_table(comparison: Comparison, console: Console, units: Units) -> tuple[RichTable, list[Column]]:
    """Return a table with as many columns as fit the width of the terminal, and these columns."""
    unbounded = console.options.update(width=10_000)
    bars = _BARS if console.encoding.startswith("utf") else _BARS_ASCII
    omitted = _pole_columns(comparison)
    for count in range(len(_DROPPED) + 1):
        dropped = (*omitted, *_DROPPED[:count])
        columns = [column for column in columns_of(comparison.joint, units) if column.attribute not in dropped]
        table = _press_table(comparison, columns, "" if _PROFILE in dropped else bars)
        if console.measure(table, options=unbounded).maximum <= console.width:
            break
    return table, columns


def _pole_columns(comparison: Comparison) -> tuple[str, ...]:
    """Return the columns to omit if every valid pressure is largest at the pole."""
    off_pole = any(contact.valid and contact.max_pressure_angle > 0 for contact in comparison.values())
    return () if off_pole else _OFF_THE_POLE


def _press_table(comparison: Comparison, columns: Sequence[Column], bars: str) -> RichTable:
    """Make the table of a comparison; pressure profiles only if `bars` is not empty."""
    table = RichTable(box=None, pad_edge=False, header_style="bold", padding=(0, 1, 0, 0))
    table.add_column("model", no_wrap=True)
    for column in columns:
        table.add_column(column.symbol, justify="right", no_wrap=True)
    if bars:
        table.add_column(f" p, 0° to {degrees(_profile_end(comparison)):.0f}°", no_wrap=True)
    table.add_column("valid", justify="center", no_wrap=True)
    table.add_row("", *(Text(column.unit, style="dim") for column in columns))
    profiles = _profiles(comparison, bars) if bars else {}
    for name, contact in comparison.items():
        table.add_row(*_cells(name, contact, columns, [profiles[name]] if profiles else []))
        if comparison.deviation(name) is not None and not contact.status.failed:
            deviations = _percents(contact, comparison[reference.name], columns)
            table.add_row(*(Text(text, style="dim") for text in ("  Δ %", *deviations)))
    for name in comparison.missing:
        gaps = [*["-"] * len(columns), *[""] * bool(bars)]
        table.add_row(Text(name, style="dim"), *gaps, Text("no", style="red"))
    return table


def _percents(contact: Contact, exact: Contact, columns: Sequence[Column]) -> list[str]:
    """Write the deviations from the exact contact in percent; empty if equal or undefined."""
    deviations = [
        100 * float(relative_deviation(column.values_of(contact), column.values_of(exact))) for column in columns
    ]
    return [
        "" if deviation != deviation or deviation == 0 else f"{deviation:+.1f}".replace("-0.0", "+0.0")
        for deviation in deviations
    ]


def _cells(name: str, contact: Contact, columns: Sequence[Column], profile: Sequence[str]) -> list[Text]:
    style = "" if contact.valid else "yellow"
    numbers = [number_text(column.values_of(contact), 4 if column.unit else 3, "-") for column in columns]
    bars = [Text(f" {bar}", style=style or "cyan") for bar in profile]
    mark = Text("yes", style="green") if contact.valid else Text("no", style="yellow")
    return [*(Text(text, style=style) for text in (name, *numbers)), *bars, mark]


def _profiles(comparison: Comparison, bars: str) -> dict[str, str]:
    """Draw the pressure of every model from the pole to the end of the profile as a row of bars, to one scale."""
    angle = numpy.linspace(0.0, _profile_end(comparison), 12)
    pressures = {
        name: 0 * angle if contact.status.failed else numpy.nan_to_num(contact.pressure(angle), posinf=0.0)
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
