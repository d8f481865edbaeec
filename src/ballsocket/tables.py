"""Results in a terminal."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees, pi
from typing import Any

import numpy
from rich.console import Console
from rich.table import Table
from rich.text import Text

from .compare import Comparison
from .contact import Contact
from .presets import joints, materials

_BARS = " ▁▂▃▄▅▆▇█"


# head, unit, attribute, factor, least width of the terminal that shows it
_COLUMNS = (
    ("F", "N", "force", 1.0, 0),
    ("d", "µm", "indentation", 1e3, 0),
    ("ε", "°", "half_angle", degrees(1.0), 0),
    ("p0", "MPa", "max_pressure", 1.0, 0),
    ("area", "mm²", "area", 1.0, 0),
    ("dF/dd", "kN/mm", "stiffness", 1e-3, 80),
    ("U", "N mm", "energy", 1.0, 95),
    ("K", "MPa/mm", "foundation_modulus", 1.0, 95),
)


def print_press(comparison: Comparison) -> None:
    """The comparison as a table, each model with its pressure profile from the pole to 90 degrees."""
    console = Console(highlight=False)
    columns = [column for column in _COLUMNS if console.width >= column[-1]]
    highest = max((_number(contact.max_pressure) for contact in comparison.values()), default=0.0)
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 1, 0, 0))
    table.add_column("model", no_wrap=True)
    for head, *_ in columns:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column(" p, 0° to 90°", no_wrap=True)
    table.add_column("valid", justify="center", no_wrap=True)
    table.add_row("", *(Text(unit, style="dim") for _, unit, *_ in columns))
    for name, contact in comparison.items():
        style = "" if contact.valid else "yellow"
        numbers = (getattr(contact, attribute) * factor for _, _, attribute, factor, _ in columns)
        cells = [Text("-" if number != number else f"{number:.4g}", style=style) for number in numbers]
        mark = Text("yes", style="green") if contact.valid else Text("no", style="yellow")
        table.add_row(
            Text(name, style=style), *cells, Text(" " + _profile(contact, highest), style=style or "cyan"), mark
        )
    for name in comparison.missing:
        table.add_row(Text(name, style="dim"), *["-"] * len(columns), "", Text("no", style="red"))
    console.print(Text(str(comparison.joint), style="bold"), soft_wrap=True)
    console.print(table)
    for reason in notes(comparison):
        console.print(Text(reason, style="dim"), soft_wrap=True)


def notes(comparison: Comparison) -> list[str]:
    """Why models are outside their validity or have no answer: each reason once, with the models it holds for."""
    holders: dict[str, list[str]] = {}
    for name, contact in comparison.items():
        for note in contact.notes:
            holders.setdefault(note, []).append(name)
    return [f"{', '.join(names)}: {note}" for note, names in holders.items()] + list(comparison.missing.values())


def _profile(contact: Contact, highest: float) -> str:
    if not highest > 0 or contact.status.failed:
        return ""
    share = numpy.asarray(contact.pressure(numpy.linspace(0.0, pi / 2, 12))) / highest
    return "".join(_BARS[round(float(level) * 8)] for level in numpy.clip(share, 0.0, 1.0))


def _number(value: Any) -> float:
    return 0.0 if value != value else float(value)


def print_models(models: Iterable[Any]) -> None:
    """The catalogue with validity and sources."""
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 1, 0))
    for head in ("model", "what it is", "trusted for", "source"):
        table.add_column(head, overflow="fold")
    for model in models:
        trusted = "\n".join(str(limit) for limit in model.validity)
        places: dict[str, list[str]] = {}
        for source in model.sources:
            places.setdefault(source.short, []).extend([source.place] if source.place else [])
        sources = "\n".join(", ".join([short, *place]) for short, place in places.items())
        table.add_row(Text(model.name, style="bold"), model.title, trusted, sources)
    Console(highlight=False).print(table)


def print_presets() -> None:
    """Materials and joints with the sources of their numbers."""
    console = Console(highlight=False)
    for title, rows in (("materials", materials), ("joints", joints)):
        table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
        table.add_column(title, no_wrap=True)
        table.add_column("numbers", overflow="fold")
        table.add_column("source", overflow="fold", style="dim")
        for name, row in rows.items():
            text = str(row).removeprefix(f"{row.name}: ").removeprefix(f"{row.name} ")
            table.add_row(name, text, row.source)
        console.print(table)
        console.print()
