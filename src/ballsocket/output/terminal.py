"""Models side by side in a terminal, and what every output there shares."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from math import pi
from typing import TYPE_CHECKING, Any

import numpy
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..catalogue import reference
from ..compare import Comparison
from ..contact import Contact
from ..describe import UTILISATION, Column, number_text
from ..quantities import CONTACT

if TYPE_CHECKING:
    pass

_BARS = " ▁▂▃▄▅▆▇█"
_BARS_ASCII = " .:-=+*#@"
_PROFILE = "profile"
_APART = "deviation"
_OFF_THE_POLE = ("pole_pressure", "max_pressure_angle")
_COLUMNS = (*(Column(each, each.shown) for each in CONTACT.values()), UTILISATION)
_LATER = ("stiffness", "area", _PROFILE, _APART, "indentation", "force", "half_angle")
_DROPPED = (*(name for name in reversed(tuple(CONTACT)) if name not in (*_LATER, "max_pressure")), *_LATER)
"""What a narrow terminal does without, first to last; never the largest pressure, nor the utilisation."""

_NEAR = 0.5
"""The utilisation from which on it is shown."""


def print_press(comparison: Comparison, remarks: Iterable[str] = ()) -> None:
    """The comparison as a table, each model with its pressure profile from the pole to 90 degrees, and remarks."""
    terminal = console()
    print_folded(terminal, str(comparison.joint), "bold")
    terminal.print(_fitting(comparison, terminal))
    for reason in (*remarks, *comparison.notes()):
        print_folded(terminal, reason, "dim")


def console() -> Console:
    """The terminal, in which numbers keep the colour of their text."""
    return Console(highlight=False)


def print_folded(console: Console, text: str, style: str) -> None:
    """A line that is folded between words, and indented where it goes on."""
    folded = textwrap.fill(text, max(console.width, 20), subsequent_indent="    ", break_on_hyphens=False)
    console.print(Text(folded, style=style), soft_wrap=True)


def _fitting(comparison: Comparison, console: Console) -> Table:
    """The table with as many columns as the terminal is wide enough for."""
    unbounded = console.options.update(width=10_000)
    bars = _BARS if console.encoding.startswith("utf") else _BARS_ASCII
    usual = (*_pole(comparison), *_rest(comparison))
    for count in range(len(_DROPPED) + 1):
        table = _press_table(comparison, (*usual, *_DROPPED[:count]), bars)
        if console.measure(table, options=unbounded).maximum <= console.width:
            break
    return table


def _pole(comparison: Comparison) -> tuple[str, ...]:
    """The columns that say nothing new where every pressure that can be trusted is highest at the pole."""
    off = any(contact.valid and contact.max_pressure_angle > 0 for contact in comparison.values())
    return () if off else _OFF_THE_POLE


def _rest(comparison: Comparison) -> tuple[str, ...]:
    """The utilisation, where no model comes near to it, or nothing is known of it."""
    near = (contact for contact in comparison.values() if contact.utilisation_between[1] > _NEAR)
    return () if any(contact.utilisation > _NEAR for contact in near) else (UTILISATION.attribute,)


def _press_table(comparison: Comparison, dropped: Sequence[str], bars: str) -> Table:
    columns = [column for column in _COLUMNS if column.attribute not in dropped]
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 1, 0, 0))
    table.add_column("model", no_wrap=True)
    apart = () if _APART in dropped else _compared(comparison)
    for head in (*(column.symbol for column in columns), *(f"Δ{column.symbol[0]}" for column in apart)):
        table.add_column(head, justify="right", no_wrap=True)
    if _PROFILE not in dropped:
        table.add_column(" p, 0° to 90°", no_wrap=True)
    table.add_column("valid", justify="center", no_wrap=True)
    units = (*(column.unit for column in columns), *("%" for _ in apart))
    table.add_row("", *(Text(unit, style="dim") for unit in units))
    profiles = {} if _PROFILE in dropped else _profiles(comparison, bars)
    for name, contact in comparison.items():
        away = _percents(comparison.deviation(name), apart)
        table.add_row(*_cells(name, contact, columns, away, [profiles[name]] if profiles else []))
    for name in comparison.missing:
        gaps = [*["-"] * len(columns), *[""] * (len(apart) + (_PROFILE not in dropped))]
        table.add_row(Text(name, style="dim"), *gaps, Text("no", style="red"))
    return table


def _compared(comparison: Comparison) -> tuple[Column, ...]:
    """What is measured against the exact answer: what the load leaves open, and the peak pressure."""
    if comparison.get(reference.name) is None or len(comparison) == 1:
        return ()
    by_depth = len({contact.indentation for contact in comparison.values()}) == 1
    first = "force" if by_depth else "indentation"
    return tuple(column for column in _COLUMNS if column.attribute in (first, "max_pressure"))


def _percents(deviation: dict[str, Any] | None, columns: Sequence[Column]) -> list[str]:
    if deviation is None:
        return [""] * len(columns)
    shares = [100 * float(deviation[column.name]) for column in columns]
    return ["-" if share != share else f"{share:+.1f}" for share in shares]


def _cells(
    name: str, contact: Contact, columns: Sequence[Column], away: Sequence[str], profile: Sequence[str]
) -> list[Text]:
    style = "" if contact.valid else "yellow"
    numbers = [number_text(column.of(contact), 4, "-") for column in columns]
    bars = [Text(f" {bar}", style=style or "cyan") for bar in profile]
    mark = Text("yes", style="green") if contact.valid else Text("no", style="yellow")
    return [*(Text(text, style=style) for text in (name, *numbers, *away)), *bars, mark]


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
