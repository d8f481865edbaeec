"""How a cup may stand, in a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees

import numpy
from rich.table import Table
from rich.text import Text

from ..core.arrays import Numbers
from ..core.quantities import CONTACT, DERIVED
from ..core.validity import Status
from ..elasticity.off_axis.orientations import Orientations
from .orientation_plot import load_text
from .terminal import console, print_folded

_MOST = 7
"""Values of each angle that a table shows."""


def print_orientations(stood: Orientations) -> None:
    """Distance to the rim and largest pressure by inclination and anteversion, the best places, and what it took."""
    terminal = console()
    print_folded(terminal, str(stood.joint), "bold")
    print_folded(terminal, load_text(stood), "bold")
    fields = {DERIVED["edge_distance"]: stood.edge_distance, CONTACT["max_pressure"]: stood.max_pressure}
    for quantity, values in fields.items():
        terminal.print(Text(f"{quantity.label()}, anteversion by inclination"))
        terminal.print(_table(stood, values))
    for line in _remarks(stood):
        print_folded(terminal, line, "dim")


def _table(stood: Orientations, values: Numbers) -> Table:
    rows, columns = (_some(len(angles)) for angles in (stood.anteversion, stood.inclination))
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for head in ("", *(_degrees(stood.inclination[i]) for i in columns)):
        table.add_column(head, justify="right", no_wrap=True)
    for j in rows:
        cells = (_cell(stood, values, i, j) for i in columns)
        table.add_row(Text(_degrees(stood.anteversion[j]), style="bold"), *cells)
    return table


def _some(count: int) -> list[int]:
    """Evenly chosen places, the first and the last among them."""
    places = numpy.linspace(0, count - 1, min(count, _MOST)).round().astype(int)
    return [int(each) for each in places]


def _cell(stood: Orientations, values: Numbers, i: int, j: int) -> Text:
    if not stood.held[i, j]:
        return Text("-", style="dim")
    return Text(f"{values[i, j]:.1f}", style="yellow" if stood.edge_loaded[i, j] else "")


def _remarks(stood: Orientations) -> Iterator[str]:
    if stood.held.any():
        yield f"furthest from the rim: {_at(stood, stood.edge_distance, 'mm')}"
    if (stood.held & numpy.isfinite(stood.max_pressure)).any():
        yield f"least pressure: {_at(stood, -stood.max_pressure, 'MPa')}"
    loaded = int((stood.edge_loaded & stood.held).sum())
    if loaded:
        yield f"{loaded} of {stood.status.size} orientations load the rim (below 0: how far beyond first touch)"
    if numpy.isposinf(stood.max_pressure).any():
        yield "inf: the end of the bore digs in, where the pressure is unbounded"
    for status in Status:
        count = int((stood.status == int(status)).sum())
        if status.failed and count:
            yield f"{count} of {stood.status.size}: {status.sentence}"
    took = f"{stood.status.size} orientations in {stood.seconds:.2f} s"
    yield f"{stood.model.name}: rings of {degrees(stood.model.ring_width):.3g}°, {took}"


def _at(stood: Orientations, values: Numbers, unit: str) -> str:
    inclination, anteversion, place = stood.best(values)
    size = abs(float(values.flat[place])) if unit == "MPa" else float(values.flat[place])
    return f"{size:.1f} {unit} at inclination {_degrees(inclination)}, anteversion {_degrees(anteversion)}"


def _degrees(angle: float) -> str:
    return f"{degrees(angle):.3g}°"
