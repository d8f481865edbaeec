"""Bands of patients who differ, and what matters: in a terminal, and as sections of a page."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from math import inf
from typing import TYPE_CHECKING

import numpy
from rich.table import Table

from ..hip.history import History
from ..hip.uncertainty import SHARED, Bands
from .hip_plots import penetration_curve
from .html import drawn, picture, table
from .style import BLUE, ORANGE, finish
from .terminal import console, print_folded

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_HEADS = {
    "cycles": "million",
    "years": "",
    "volume": "mm³",
    "depth": "mm",
    "penetration": "mm",
    "at the rim": "patients",
}
_INK = (BLUE, ORANGE)


def print_bands(bands: Bands) -> None:
    """Bands in a table, what matters in a line for each answer, and remarks."""
    terminal = console()
    print_folded(terminal, f"{_told(bands)} lie between", "bold")
    shown = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for head in _HEADS:
        shown.add_column(head, justify="right", no_wrap=True)
    shown.add_row(*_HEADS.values(), style="dim")
    rest = (1 - bands.level) / 2
    for row in _rows(bands, (rest, 1 - rest)):
        shown.add_row(*row)
    terminal.print(shown)
    for line in _shares(bands):
        print_folded(terminal, line, "")
    print_notes(bands.notes)


def print_notes(notes: Iterable[str]) -> None:
    """Remarks, each in a line."""
    terminal = console()
    for note in notes:
        print_folded(terminal, note, "dim")


def band_sections(history: History, bands: Bands) -> dict[str, tuple[str, str]]:
    """Sections of a page: by their id a title and HTML."""
    rest = (1 - bands.level) / 2
    notes = "".join(f"<li>{escape(note)}</li>" for note in bands.notes)
    told = f"<p>{escape(_told(bands))}: low to median to high.</p><ul class='quiet'>{notes}</ul>"
    caption = f"The line is the usual patient's, the band holds {100 * bands.level:g} % of the patients."
    curve = picture(drawn(penetration_curve(history, bands)), "Penetration", escape(caption))
    found = {
        "penetration": ("Penetration", curve),
        "patients": ("Patients who differ", f"{told}{table(_heads(), _rows(bands, (rest, 0.5, 1 - rest)))}"),
    }
    if bands.indices is not None:
        shares = picture(drawn(share_figure(bands)), "What matters", "Sobol's indices with 95 % intervals.")
        found["matters"] = ("What matters", shares)
    return found


def share_figure(bands: Bands) -> Figure:
    """First and total Sobol indices of what patients differ in, with their intervals."""
    from matplotlib.figure import Figure

    names, indices = list(bands.scatter.distributions), bands.indices or {}
    figure = Figure(figsize=(3.0 * len(SHARED) + 1.2, 0.5 * len(names) + 1.6), layout="constrained")
    rows = numpy.arange(len(names))
    panels = figure.subplots(1, len(SHARED), squeeze=False, sharey=True).ravel()
    for number, (axes, answer) in enumerate(zip(panels, SHARED, strict=True)):
        for order, offset, colour in zip(("first", "total"), (-0.17, 0.17), _INK, strict=True):
            value, low, high = (indices[f"{order}_order{end}"][number] for end in ("", "_low", "_high"))
            off = numpy.nan_to_num(numpy.clip([value - low, high - value], 0.0, None))
            axes.barh(rows + offset, value, 0.32, xerr=off, color=colour, edgecolor="white", label=f"{order} order")
        axes.set_yticks(rows, [name.replace("_", " ") for name in names])
        axes.set_xlim(0.0, 1.05)
        finish(axes, "share of the variance", "")
        axes.set_title(answer, fontsize=10)
    figure.axes[0].invert_yaxis()
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


def _told(bands: Bands) -> str:
    return f"{100 * bands.level:g} % of {bands.patients - bands.without} patients"


def _heads() -> list[str]:
    return [f"{head} [{unit}]" if unit else head for head, unit in _HEADS.items()]


def _rows(bands: Bands, shares: Sequence[float]) -> Iterator[tuple[str, ...]]:
    year = bands.scatter.cycles_per_year
    for look, count in enumerate(bands.counts):
        found = (" to ".join(f"{bands.quantile(name, share)[look]:.3g}" for share in shares) for name in SHARED)
        years = "-" if year is None else f"{count / year:.3g}"
        yield f"{count / 1e6:g}", years, *found, f"{100 * bands.edge_loading(look):.3g} %"


def _shares(bands: Bands) -> Iterator[str]:
    """What makes how much of the scatter, most first."""
    if bands.indices is None:
        return
    for row, answer in enumerate(SHARED):
        values = bands.indices["total_order"][row]
        low, high = (bands.indices[f"total_order_{end}"][row] for end in ("low", "high"))
        order = numpy.argsort(-numpy.nan_to_num(values, nan=-inf))
        names = list(bands.scatter.distributions)
        told = ", ".join(f"{names[i]} {values[i]:.2f} ({low[i]:.2f} to {high[i]:.2f})" for i in order)
        yield f"what matters to {answer} (Sobol, total order): {told}"
