"""Results in a terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from math import pi
from typing import Any

import numpy
from rich.console import Console
from rich.table import Table
from rich.text import Text

from .compare import Comparison
from .contact import Contact
from .describe import COLUMNS, Column, number_text
from .joint import Joint, Material
from .presets import joints, materials

_BARS = " ▁▂▃▄▅▆▇█"
_BARS_ASCII = " .:-=+*#@"
_UNITS = {"indentation": ("µm", 1e3), "stiffness": ("kN/mm", 1e-3)}  # handier here than those of JSON
_NARROW = 72
_PROFILE = "profile"
# what a narrow terminal does without, first to last
_DROPPED = ("foundation_modulus", "energy", "stiffness", "area", _PROFILE, "indentation", "force", "half_angle_deg")


def print_press(comparison: Comparison) -> None:
    """The comparison as a table, each model with its pressure profile from the pole to 90 degrees."""
    console = _console()
    _print_folded(console, str(comparison.joint), "bold")
    console.print(_fitting(comparison, console))
    for reason in comparison.notes():
        _print_folded(console, reason, "dim")


def _console() -> Console:
    return Console(highlight=False)


def _print_folded(console: Console, text: str, style: str) -> None:
    folded = textwrap.fill(text, max(console.width, 20), subsequent_indent="    ", break_on_hyphens=False)
    console.print(Text(folded, style=style), soft_wrap=True)


def _fitting(comparison: Comparison, console: Console) -> Table:
    """The table with as many columns as the terminal is wide enough for."""
    unbounded = console.options.update(width=10_000)
    bars = _BARS if console.encoding.startswith("utf") else _BARS_ASCII
    for count in range(len(_DROPPED) + 1):
        table = _press_table(comparison, _DROPPED[:count], bars)
        if console.measure(table, options=unbounded).maximum <= console.width:
            break
    return table


def _press_table(comparison: Comparison, dropped: Sequence[str], bars: str) -> Table:
    columns = [column for column in COLUMNS if column.name not in dropped]
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 1, 0, 0))
    table.add_column("model", no_wrap=True)
    for column in columns:
        table.add_column(column.symbol, justify="right", no_wrap=True)
    if _PROFILE not in dropped:
        table.add_column(" p, 0° to 90°", no_wrap=True)
    table.add_column("valid", justify="center", no_wrap=True)
    table.add_row("", *(Text(_shown_unit(column)[0], style="dim") for column in columns))
    profiles = {} if _PROFILE in dropped else _profiles(comparison, bars)
    for name, contact in comparison.items():
        table.add_row(*_cells(name, contact, columns, [profiles[name]] if profiles else []))
    for name in comparison.missing:
        gaps = [*["-"] * len(columns), *[""] * (_PROFILE not in dropped)]
        table.add_row(Text(name, style="dim"), *gaps, Text("no", style="red"))
    return table


def _cells(name: str, contact: Contact, columns: Sequence[Column], profile: Sequence[str]) -> list[Text]:
    style = "" if contact.valid else "yellow"
    numbers = [number_text(column.of(contact) * _shown_unit(column)[1], 4, "-") for column in columns]
    bars = [Text(f" {bar}", style=style or "cyan") for bar in profile]
    mark = Text("yes", style="green") if contact.valid else Text("no", style="yellow")
    return [*(Text(text, style=style) for text in (name, *numbers)), *bars, mark]


def _shown_unit(column: Column) -> tuple[str, float]:
    return _UNITS.get(column.name, (column.unit, 1.0))


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


def print_models(models: Iterable[Any]) -> None:
    """The catalogue with validity and sources."""
    rows = [(model.name, model.title, "\n".join(map(str, model.validity)), _sources(model)) for model in models]
    _print_rows(("model", "what it is", "trusted for", "source"), rows, gap=1)


def print_presets() -> None:
    """Materials and joints with the sources of their numbers."""
    for title, presets in (("materials", materials), ("joints", joints)):
        rows = [(name, _numbers(preset), preset.source) for name, preset in presets.items()]
        _print_rows((title, "numbers", "source"), rows, gap=0)
        _console().print()


def _sources(model: Any) -> str:
    """A line for each publication, with all its places."""
    places: dict[str, list[str]] = {}
    for source in model.sources:
        places.setdefault(source.short, []).extend([source.place] if source.place else [])
    return "\n".join(", ".join([short, *place]) for short, place in places.items())


def _numbers(preset: Material | Joint) -> str:
    text = str(preset).removeprefix(preset.name)
    return text.removeprefix(": ") if isinstance(preset, Joint) else text.strip(" ()")


def _print_rows(heads: Sequence[str], rows: Sequence[Sequence[str]], gap: int) -> None:
    """A table with `gap` empty lines between rows; a paragraph for each row where the terminal is narrow."""
    console = _console()
    if console.width < _NARROW:
        for name, *texts in rows:
            console.print(Text(name, style="bold"))
            for text in texts:
                _print_folded(console, f"  {text.replace(chr(10), '; ')}", "")
        return
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, gap, 0))
    for head in heads:
        table.add_column(head, overflow="fold", no_wrap=head == heads[0])
    for name, *texts in rows:
        table.add_row(Text(name, style="bold"), *map(Text, texts))
    console.print(table)
