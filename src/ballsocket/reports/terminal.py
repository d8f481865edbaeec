"""Models side by side in a terminal, and what every output there shares."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import pi

import numpy
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..catalogue import reference
from ..compare import Comparison, relative_deviation
from ..contact import Contact
from ..contact.describe import COLUMNS, UTILISATION, Column, number_text
from ..core.quantities import CONTACT, HEADLINE
from .unit_systems import Units

_BARS = " ▁▂▃▄▅▆▇█"
_BARS_ASCII = " .:-=+*#@"
_PROFILE = "profile"
_OFF_THE_POLE = ("pole_pressure", "max_pressure_angle")
_LATER = ("stiffness", "area", _PROFILE, "indentation", "force", "half_angle")
_DROPPED = (*(name for name in reversed(tuple(CONTACT)) if name not in (*_LATER, "max_pressure")), *_LATER)
"""What a narrow terminal does without, first to last; never the largest pressure, nor the utilisation."""

_NEAR = 0.5
"""The utilisation from which on it is shown."""


def print_press(comparison: Comparison, remarks: Iterable[str] = (), units: Units = Units.SI) -> None:
    """The comparison as a table, the exact answer on top and below each other model how far from it every number is.

    Beside the numbers the pressure from the pole to 90 degrees; below them what the letters mean, remarks and notes.
    """
    terminal, led = console(), _led(comparison)
    print_folded(terminal, str(led.joint), "bold")
    table, shown = _fitting(led, terminal, units)
    terminal.print(table)
    for line in (_letters(led, shown), *remarks, *led.notes()):
        print_folded(terminal, line, "dim")


def _led(comparison: Comparison) -> Comparison:
    """With the exact answer on top, where it can be trusted."""
    exact = comparison.get(reference.name)
    if exact is None or not exact.valid:
        return comparison
    return replace(comparison, contacts={reference.name: exact, **comparison.contacts})


def _letters(comparison: Comparison, columns: Sequence[Column]) -> str:
    """What the heads of the columns mean."""
    meant = ", ".join(f"{column.symbol} {column.title}" for column in columns)
    apart = any(comparison.deviation(name) is not None for name in comparison)
    return f"{meant}; Δ % from {reference.name}" if apart else meant


def print_curve(contact: Contact) -> None:
    """Contacts at one load after the other as a table of the quantities of most interest, and the notes."""
    terminal = console()
    print_folded(terminal, f"{contact.model.name} on {contact.joint}", "bold")
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 1, 0, 0))
    for column in COLUMNS:
        if column.attribute in HEADLINE:
            table.add_column(column.head, justify="right", no_wrap=True)
    table.add_column("valid", no_wrap=True)
    values = [column.values_of(contact) for column in COLUMNS if column.attribute in HEADLINE]
    for place, valid in enumerate(contact.valid):
        table.add_row(*(number_text(value[place], 4, "-") for value in values), "yes" if valid else "no")
    terminal.print(table)
    for note in contact.notes:
        print_folded(terminal, note, "dim")


def console() -> Console:
    """The terminal, in which numbers keep the colour of their text."""
    return Console(highlight=False)


def print_folded(console: Console, text: str, style: str) -> None:
    """A line that is folded between words, and indented where it goes on."""
    folded = textwrap.fill(text, max(console.width, 20), subsequent_indent="    ", break_on_hyphens=False)
    console.print(Text(folded, style=style), soft_wrap=True)


def _fitting(comparison: Comparison, console: Console, units: Units) -> tuple[Table, list[Column]]:
    """The table with as many columns as the terminal is wide enough for, and those columns."""
    unbounded = console.options.update(width=10_000)
    bars = _BARS if console.encoding.startswith("utf") else _BARS_ASCII
    usual = (*_pole(comparison), *_rest(comparison))
    for count in range(len(_DROPPED) + 1):
        dropped = (*usual, *_DROPPED[:count])
        columns = [column for column in units.columns if column.attribute not in dropped]
        table = _press_table(comparison, columns, "" if _PROFILE in dropped else bars)
        if console.measure(table, options=unbounded).maximum <= console.width:
            break
    return table, columns


def _pole(comparison: Comparison) -> tuple[str, ...]:
    """The columns that say nothing new where every pressure that can be trusted is highest at the pole."""
    off = any(contact.valid and contact.max_pressure_angle > 0 for contact in comparison.values())
    return () if off else _OFF_THE_POLE


def _rest(comparison: Comparison) -> tuple[str, ...]:
    """The utilisation, where no model comes near to it, or nothing is known of it."""
    near = (contact for contact in comparison.values() if contact.utilisation_bounds[1] > _NEAR)
    return () if any(contact.utilisation > _NEAR for contact in near) else (UTILISATION.attribute,)


def _press_table(comparison: Comparison, columns: Sequence[Column], bars: str) -> Table:
    """Without bars no profiles."""
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 1, 0, 0))
    table.add_column("model", no_wrap=True)
    for column in columns:
        table.add_column(column.symbol, justify="right", no_wrap=True)
    if bars:
        table.add_column(" p, 0° to 90°", no_wrap=True)
    table.add_column("valid", justify="center", no_wrap=True)
    table.add_row("", *(Text(column.unit, style="dim") for column in columns))
    profiles = _profiles(comparison, bars) if bars else {}
    for name, contact in comparison.items():
        table.add_row(*_cells(name, contact, columns, [profiles[name]] if profiles else []))
        if comparison.deviation(name) is not None and not contact.status.failed:
            away = _percents(contact, comparison[reference.name], columns)
            table.add_row(*(Text(text, style="dim") for text in ("  Δ %", *away)))
    for name in comparison.missing:
        gaps = [*["-"] * len(columns), *[""] * bool(bars)]
        table.add_row(Text(name, style="dim"), *gaps, Text("no", style="red"))
    return table


def _percents(contact: Contact, exact: Contact, columns: Sequence[Column]) -> list[str]:
    """How far a contact is from the exact one; nothing where they are equal, or there is nothing to measure by."""
    shares = [100 * float(relative_deviation(column.values_of(contact), column.values_of(exact))) for column in columns]
    return ["" if share != share or share == 0 else f"{share:+.1f}".replace("-0.0", "+0.0") for share in shares]


def _cells(name: str, contact: Contact, columns: Sequence[Column], profile: Sequence[str]) -> list[Text]:
    style = "" if contact.valid else "yellow"
    numbers = [number_text(column.values_of(contact), 4, "-") for column in columns]
    bars = [Text(f" {bar}", style=style or "cyan") for bar in profile]
    mark = Text("yes", style="green") if contact.valid else Text("no", style="yellow")
    return [*(Text(text, style=style) for text in (name, *numbers)), *bars, mark]


def _profiles(comparison: Comparison, bars: str) -> dict[str, str]:
    """For every model its pressure from the pole to 90 degrees as a row of bars, all to one scale."""
    angle = numpy.linspace(0.0, pi / 2, 12)
    pressures = {name: _pressure(contact, angle) for name, contact in comparison.items()}
    highest = max((pressure.max() for pressure in pressures.values()), default=0.0)
    return {name: _bars(pressure / highest if highest > 0 else 0 * angle, bars) for name, pressure in pressures.items()}


def _pressure(contact: Contact, angle: numpy.ndarray) -> numpy.ndarray:
    return 0 * angle if contact.status.failed else numpy.nan_to_num(contact.pressure(angle), posinf=0.0)


def _bars(share: numpy.ndarray, bars: str) -> str:
    return "".join(bars[round(float(level) * 8)] for level in numpy.clip(share, 0.0, 1.0)).rstrip()
