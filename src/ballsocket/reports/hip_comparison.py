"""Wear of several hips side by side, and the fit of a wear coefficient: tables, figures, CSV file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

from ..core.display import plain_number
from ..core.storage.atomic_files import write_csv
from ..hip.bands import Bands
from ..hip.history import History
from ..hip.wear_fit import WEAR_QUANTITIES, WearFit
from .hip_tables import print_notes, table_with_units
from .style import BLUE, GREEN, LEGEND, ORANGE, PINK, SKY, VERMILLION, finish, new_figure
from .terminal import Terminal, print_columns, print_folded, print_joint
from .unit_systems import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PINK, SKY)
_PANELS = {"volume": "worn volume [mm³]", "penetration": "penetration [mm]"}
"""Results of the panels of the figure, with the labels of their axes."""

_HEADS = {
    "cycles, hip": "million",
    "volume": "mm³",
    "depth": "mm",
    "penetration": "mm",
    "pmax": "MPa",
    "edge loading": "",
}
"""Units of the columns of the terminal's table by their heads."""


@dataclass(frozen=True, kw_only=True)
class HipRun:
    """Simulation of one hip with its bands, if any, and its name in tables and figures, such as that of its file."""

    name: str
    history: History
    bands: Bands | None = None


def wear_figure(histories: Mapping[str, History] | Sequence[History]) -> Figure:
    """Draw worn volume and penetration over the cycles, with a line for each hip.

    Parameters
    ----------
    histories : mapping of str to History, or sequence of History
        Simulations by the name in the legend; by default the name of their joint.
    """
    if not isinstance(histories, Mapping):
        histories = {history.use.joint.name or f"hip {i + 1}": history for i, history in enumerate(histories)}
    return comparison_figure([HipRun(name=name, history=history) for name, history in histories.items()])


def comparison_figure(runs: Sequence[HipRun], units: Units = Units.SI) -> Figure:
    """Draw worn volume and penetration over the cycles, with a line and a band for each hip."""
    figure = new_figure(9.2, 4.2)
    panels = figure.subplots(1, len(_PANELS), squeeze=False)[0]
    for axes, (result, label) in zip(panels, _PANELS.items(), strict=True):
        written, factor = units.axis(label)
        for index, run in enumerate(runs):
            dash = "-" if index < len(_COLOURS) else "--"
            _draw_run(axes, run, result, _COLOURS[index % len(_COLOURS)], dash, factor)
        axes.set_xlim(left=0)
        axes.set_ylim(bottom=0)
        finish(axes, "million cycles", written)
    if len(runs) > 1 or runs[0].bands is not None:
        panels[0].legend(**LEGEND)
    return figure


def _draw_run(axes: Axes, run: HipRun, result: str, colour: str, dash: str, factor: float) -> None:
    reports = run.history.reports
    cycles = [0.0, *(report.cycles / 1e6 for report in reports)]
    values = [0.0, *(factor * float(getattr(report, result)) for report in reports)]
    axes.plot(cycles, values, "o", linestyle=dash, markersize=4, color=colour, label=run.name or None)
    if run.bands is not None:
        low, high = ([0.0, *(factor * end for end in ends)] for ends in run.bands.band(result))
        label = f"{100 * run.bands.level:g} % of the {run.bands.subject}"
        axes.fill_between(cycles, low, high, color=colour, alpha=0.15, linewidth=0, label=label)


def print_comparison(runs: Sequence[HipRun], units: Units = Units.SI) -> None:
    """Print the wear of several hips, one below the other at each report, and the notes of each."""
    terminal = Terminal(units)
    for run in runs:
        print_joint(terminal, run.history.use.joint, f"; {run.history.use.cycle.name}", f"{run.name}: ")
    print_columns(terminal, _table(runs))
    for run in runs:
        verdict = "valid" if run.history.valid else "NOT VALID, see its notes"
        error = f"estimated numerical error of the volume {100 * run.history.error.volume:.2g} %"
        print_folded(terminal, f"{run.name}: contact {verdict}; {error}", "")
    for note, names in _notes_with_names(runs).items():
        prefix = "" if len(names) == len(runs) else f"{', '.join(names)}: "
        print_notes([f"{prefix}{note}"], units)


def _table(runs: Sequence[HipRun]) -> Any:
    banded = any(run.bands is not None for run in runs)
    heads = {**_HEADS, "volume 95 %": "mm³", "penetration 95 %": "mm"} if banded else _HEADS
    table = table_with_units(heads, left=("cycles, hip",))
    for cycles in sorted({report.cycles for run in runs for report in run.history.reports}):
        for run in runs:
            for row in _rows_at(run, cycles, banded):
                table.add_row(*row)
    return table


def _rows_at(run: HipRun, cycles: float, banded: bool) -> Iterator[tuple[str, ...]]:
    for index, report in enumerate(run.history.reports):
        if report.cycles != cycles:
            continue
        numbers = (report.volume, report.depth, report.penetration, report.max_pressure)
        edge = "yes" if report.edge_loaded.any() else "no"
        row = (f"{cycles / 1e6:.6g} {run.name}", *(f"{number:.4g}" for number in numbers), edge)
        yield (*row, *(_band_text(run.bands, result, index) for result in _PANELS)) if banded else row


def _band_text(bands: Bands | None, result: str, report: int) -> str:
    if bands is None:
        return "-"
    low, high = bands.band(result)
    return f"{low[report]:.3g} to {high[report]:.3g}"


def _notes_with_names(runs: Sequence[HipRun]) -> dict[str, list[str]]:
    """Collect the notes of all hips, each with the names of the hips that have it."""
    notes: dict[str, list[str]] = {}
    for run in runs:
        for note in dict.fromkeys((*run.history.notes, *(run.bands.notes if run.bands else ()))):
            notes.setdefault(note, []).append(run.name)
    return notes


def print_wear_fit(fit: WearFit) -> None:
    """Print a fitted wear coefficient with its band, its value for each kind of rate, and the measured wear."""
    terminal, use = Terminal(), fit.simulation
    print_folded(terminal, f"{use.joint}; {use.cycle.name}: coefficient of the wear law {fit.law_name!r}", "bold")
    band = f"{fit.low:.4g} to {fit.high:.4g}" if isfinite(fit.high) else "-"
    table = table_with_units({"": "", "best": fit.unit, "95 %": fit.unit}, left=("",))
    table.add_row("coefficient", f"{fit.coefficient:.4g}", band)
    if len(fit.stations) > 1:
        for station, coefficient in fit.stations.items():
            table.add_row(station, f"{coefficient:.4g}", "")
    print_columns(terminal, table)
    if fit.readings:
        print_folded(terminal, "the same number as a rate of another kind:", "")
        readings = table_with_units({"rate": "", "coefficient": fit.unit}, left=("rate",))
        for description, coefficient in fit.readings.items():
            readings.add_row(description, f"{coefficient:.4g}")
        print_columns(terminal, readings)
    print_columns(terminal, _measured_table(fit))
    print_notes(fit.notes)


def _measured_table(fit: WearFit) -> Any:
    several = ["station"] if len(fit.specimens) > 1 else []
    heads = dict.fromkeys(["measured", "value", "fit", "unit", *several], "")
    table = table_with_units(heads, left=("measured", "unit", "station"))
    rows = {int(row): station for station, indices in fit.specimens.items() for row in indices}
    stations = ([rows[row]] if several else [] for row in range(len(rows)))
    for measured, results in zip(fit.data, fit.results, strict=True):
        cycles = (
            [""] * len(measured)
            if measured.rate
            else [f" after {plain_number(count)} cycles" for count in measured.cycles]
        )
        factor = measured.density or 1.0
        unit = measured.unit if measured.density is None else measured.unit.replace("mm³", "mg")
        for value, result, count in zip(factor * measured.values, factor * results, cycles, strict=True):
            title = measured.description if measured.rate else f"{measured.measured_quantity}{count}"
            table.add_row(title, f"{value:.4g}", f"{result:.4g}", unit, *next(stations))
    return table


def wear_fit_figure(fit: WearFit, cycles: float = 0.0) -> Figure:
    """Draw the fitted simulation with its band over the cycles, with the measured totals and rates of each station.

    `cycles` is the number of cycles of the prediction, where it goes further than the data.
    """
    quantities, runs = list(dict.fromkeys(measured.quantity for measured in fit.data)), fit.predict(cycles)
    figure = new_figure(6.4 * len(quantities), 4.6)
    for axes, quantity in zip(figure.subplots(1, len(quantities), squeeze=False)[0], quantities, strict=True):
        _draw_fit(axes, fit, runs, quantity)
        axes.set_xlim(left=0)
        axes.set_ylim(bottom=0)
        finish(axes, "million cycles", f"{quantity.replace('_', ' ')} [{WEAR_QUANTITIES[quantity]}]")
        axes.legend(**LEGEND)
    return figure


def _draw_fit(axes: Axes, fit: WearFit, runs: Sequence[History], quantity: str) -> None:
    """Draw one quantity of the fitted simulation and of both ends of its band, with its measured values."""
    column = f"{quantity}_{'mm3' if quantity == 'volume' else 'mm'}"
    tables = [run.table() for run in runs]
    cycles = [0.0, *(row["cycles"] / 1e6 for row in tables[0])]
    totals, low, high = ([0.0, *(row[column] for row in table)] for table in tables)
    axes.plot(cycles, totals, color=BLUE, label=f"coefficient {fit.coefficient:.3g} {fit.unit}")
    if isfinite(fit.high):
        band = f"95 %: {fit.low:.3g} to {fit.high:.3g}"
        axes.fill_between(cycles, low, high, color=BLUE, alpha=0.15, linewidth=0, label=band)
    starts = numpy.cumsum([0, *map(len, fit.data)])
    for number, (station, indices) in enumerate(fit.specimens.items()):
        colour, marker = _COLOURS[1 + number % (len(_COLOURS) - 1)], "os^Dv"[number % 5]
        label: str | None = f"measured, {station}" if len(fit.specimens) > 1 else "measured"
        for measured, start in zip(fit.data, starts[:-1], strict=True):
            rows = indices[(indices >= start) & (indices < start + len(measured))] - start
            if measured.quantity != quantity or not len(rows):
                continue
            if measured.rate is None:
                axes.plot(measured.cycles[rows] / 1e6, measured.values[rows], marker, color=colour, label=label)
            else:
                begin, end = (measured.begin or 0.0) / 1e6, (measured.end or 1e6) / 1e6
                first = float(numpy.interp(begin, cycles, totals))
                last = first + float(measured.values[rows].mean()) * (end - begin)
                rate_label = label and label.replace("measured", f"measured {measured.rate} rate")
                axes.plot([begin, end], [first, last], "--", color=colour, label=rate_label)
            label = None


def write_table(path: Path, runs: Sequence[HipRun]) -> Path:
    """Write a CSV file with a row for each hip and report, and return its path; heads have units.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    rows: list[dict[str, Any]] = []
    for run in runs:
        bands = run.bands.table() if run.bands is not None else [{}] * len(run.history.reports)
        rows += [{"hip": run.name, **row, **band} for row, band in zip(run.history.table(), bands, strict=True)]
    heads = list(dict.fromkeys(head for row in rows for head in row))
    return write_csv(path, [heads, *([_cell(row.get(head, "")) for head in heads] for row in rows)])


def _cell(value: Any) -> str:
    """Write a cell of a table: a truth value as 0 or 1, a missing or infinite number as nothing."""
    if isinstance(value, str):
        return value
    return f"{float(value):.9g}" if numpy.isfinite(value) else ""
