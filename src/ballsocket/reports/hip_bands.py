"""Bands of patients who differ, and what matters: in a terminal, and as sections of a page."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from html import escape
from math import inf, isnan
from typing import TYPE_CHECKING

import numpy
from rich.table import Table

from ..hip.bands import INFLUENCED_RESULTS, Bands
from ..hip.history import History
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
    for head in _units(bands):
        shown.add_column(head, justify="right", overflow="fold")
    shown.add_row(*_units(bands).values(), style="dim")
    rest = (1 - bands.level) / 2
    for row in _rows(bands, (rest, 1 - rest)):
        shown.add_row(*row)
    terminal.print(shown)
    for line in _rim(bands):
        print_folded(terminal, line, "")
    print_folded(terminal, _contact(bands), "")
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
    told = f"<p>{escape(_told(bands))}: low to median to high.</p>"
    told += "".join(f"<p>{escape(line)}.</p>" for line in (*_rim(bands), _contact(bands)))
    told += f"<ul class='quiet'>{notes}</ul>"
    caption = f"The line is the usual patient's, the band holds {100 * bands.level:g} % of the {bands.subject}"
    caption += "." if bands.shared is None else ", the dark band that share of the patients at the median coefficient."
    curve = picture(drawn(penetration_curve(history, bands)), "Penetration", escape(caption))
    found = {
        "penetration": ("Penetration", curve),
        "patients": ("Patients who differ", f"{told}{table(_heads(bands), _rows(bands, (rest, 0.5, 1 - rest)))}"),
    }
    if bands.indices is not None:
        shares = picture(drawn(share_figure(bands)), "What matters", "Sobol's indices with 95 % intervals.")
        found["matters"] = ("What matters", shares)
    return found


def share_figure(bands: Bands) -> Figure:
    """First and total Sobol indices of what patients differ in, with their intervals."""
    from matplotlib.figure import Figure

    names, indices = list(bands.variability.distributions), bands.indices or {}
    figure = Figure(figsize=(3.0 * len(INFLUENCED_RESULTS) + 1.2, 0.5 * len(names) + 1.6), layout="constrained")
    rows = numpy.arange(len(names))
    panels = figure.subplots(1, len(INFLUENCED_RESULTS), squeeze=False, sharey=True).ravel()
    for number, (axes, answer) in enumerate(zip(panels, INFLUENCED_RESULTS, strict=True)):
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
    share, patients = f"{100 * bands.level:g} %", bands.n_patients - bands.n_failed
    if bands.shared is None:
        among = "" if bands.subject == "patients" else "predictions from "
        return f"{share} of {among}{patients} patients"
    return (
        f"{share} of {patients} patients for a low, median and high wear coefficient, and {share} of the predictions "
        f"for {_ANY} coefficient,"
    )


def _units(bands: Bands) -> dict[str, str]:
    """Return table heads with units; a shared coefficient has a column, and the rim has a separate line."""
    if bands.shared is None:
        return _HEADS
    (cycles, million), (years, no_unit), *others, _ = _HEADS.items()
    return {cycles: million, years: no_unit, "coefficient": "", **dict(others)}


def _heads(bands: Bands) -> list[str]:
    return [f"{head} [{unit}]" if unit else head for head, unit in _units(bands).items()]


def _rim(bands: Bands) -> Iterator[str]:
    """Describe the share of contacts at the rim at each report, where the table has no column for it."""
    if bands.shared is None:
        return
    shares = [f"{100 * bands.edge_loading(look):.3g} %" for look in range(len(bands.counts))]
    counts = [f"after {count / 1e6:g} million cycles" for count in bands.counts]
    yield f"contact at the rim: {', '.join(map(' '.join, zip(shares, counts, strict=True)))}"


def _contact(bands: Bands) -> str:
    """Describe validity and utilisation of the contacts from the first cycle to the last report."""
    rest = (1 - bands.level) / 2
    low, high = (bands.utilisation_quantile(share)[-1] for share in (rest, 1 - rest))
    reasons = [check.utilisation_note for check in bands.variability.coarse_simulation.unworn_checks] or [
        "nothing is pressed"
    ]
    peak = reasons[0] if isnan(low) else f"utilisation σv/σy {low:.3g} to {high:.3g}"
    model = bands.variability.coarse_simulation.contact_model.name
    return f"contact ({model}): valid in {100 * bands.valid_fraction(-1):.3g} % of the {bands.subject}; {peak}"


def _rows(bands: Bands, shares: Sequence[float]) -> Iterator[tuple[str, ...]]:
    year = bands.variability.cycles_per_year
    for look, count in enumerate(bands.counts):
        years = "-" if year is None else f"{count / year:.3g}"
        when = f"{count / 1e6:g}", years
        found = [_ends(bands.quantile(name, share)[look] for share in shares) for name in INFLUENCED_RESULTS]
        if bands.shared is None:
            yield (*when, *found, f"{100 * bands.edge_loading(look):.3g} %")
            continue
        for coefficient in bands.shared.values:
            quantile = partial(bands.shared.quantile, coefficient)
            yield (
                *when,
                coefficient,
                *(_ends(quantile(name, share)[look] for share in shares) for name in INFLUENCED_RESULTS),
            )
        yield (*when, _ANY, *found)


_ANY = "any"


def _ends(numbers: Iterable[float]) -> str:
    return " to ".join(f"{number:.3g}" for number in numbers)


def _shares(bands: Bands) -> Iterator[str]:
    """What makes how much of the scatter, most first."""
    if bands.indices is None:
        return
    for row, answer in enumerate(INFLUENCED_RESULTS):
        values = bands.indices["total_order"][row]
        low, high = (bands.indices[f"total_order_{end}"][row] for end in ("low", "high"))
        order = numpy.argsort(-numpy.nan_to_num(values, nan=-inf))
        names = list(bands.variability.distributions)
        told = ", ".join(f"{names[i]} {values[i]:.2f} ({low[i]:.2f} to {high[i]:.2f})" for i in order)
        yield f"what matters to {answer} (Sobol, total order): {told}"
