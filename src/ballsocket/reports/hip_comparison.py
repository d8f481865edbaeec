"""Figures and CSV file of several hips side by side, and the figure of a fitted wear coefficient."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

from ..core.answers import named_records
from ..core.kinds import Unit
from ..core.storage.atomic_files import write_csv
from ..core.unit_systems import Amount, Sentence
from ..hip.answers import HipRun
from ..hip.history import History
from ..hip.measured_wear import WEAR_QUANTITIES
from .style import BLUE, GREEN, LEGEND, ORANGE, PINK, SKY, VERMILLION, finish, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..hip.wear_fit import WearFit

_COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PINK, SKY)
_PANELS = {"volume": "worn volume [mm³]", "penetration": "penetration [mm]"}
"""Results of the panels of the figure, with the labels of their axes."""


def wear_figure(histories: Mapping[str, History] | Sequence[History]) -> Figure:
    """Draw worn volume and penetration over the cycles, with a named line for each hip, by default its joint."""
    if not isinstance(histories, Mapping):
        histories = {history.use.joint.name or f"hip {i + 1}": history for i, history in enumerate(histories)}
    return comparison_figure([HipRun(name=name, history=history) for name, history in histories.items()])


def comparison_figure(runs: Sequence[HipRun]) -> Figure:
    """Draw worn volume and penetration over the cycles, with a line and a band for each hip."""
    figure = new_figure(9.2, 4.2)
    panels = figure.subplots(1, len(_PANELS), squeeze=False)[0]
    for axes, (result, label) in zip(panels, _PANELS.items(), strict=True):
        for index, run in enumerate(runs):
            dash = "-" if index < len(_COLOURS) else "--"
            _draw_run(axes, run, result, _COLOURS[index % len(_COLOURS)], dash)
        axes.set_xlim(left=0)
        axes.set_ylim(bottom=0)
        finish(axes, "million cycles", label)
    if len(runs) > 1 or runs[0].bands is not None:
        panels[0].legend(**LEGEND)
    return figure


def _draw_run(axes: Axes, run: HipRun, result: str, colour: str, dash: str) -> None:
    reports = run.history.reports
    cycles = [0.0, *(report.cycles / 1e6 for report in reports)]
    values = [0.0, *(float(getattr(report, result)) for report in reports)]
    axes.plot(cycles, values, "o", linestyle=dash, markersize=4, color=colour, label=run.name or None)
    if run.bands is not None:
        low, high = ([0.0, *ends] for ends in run.bands.band(result))
        label = f"{100 * run.bands.level:g} % of the {run.bands.subject}"
        axes.fill_between(cycles, low, high, color=colour, alpha=0.15, linewidth=0, label=label)


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
    tables = [named_records(run.table()) for run in runs]
    cycles = [0.0, *(row["cycles"] / 1e6 for row in tables[0])]
    totals, low, high = ([0.0, *(row[column] for row in table)] for table in tables)
    coefficient, *ends = (Amount(value, Unit(fit.unit), 3) for value in (fit.coefficient, fit.low, fit.high))
    axes.plot(cycles, totals, color=BLUE, label=Sentence("coefficient {}", coefficient))
    if isfinite(fit.high):
        band = Sentence("95 %: {} to {}", *ends)
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

    Raises OSError: the file cannot be written.
    """
    rows: list[dict[str, Any]] = []
    for run in runs:
        bands = run.bands.table() if run.bands is not None else [{}] * len(run.history.reports)
        rows += [
            {"hip": run.name, **row, **band}
            for row, band in zip(named_records(run.history.table()), bands, strict=True)
        ]
    heads = list(dict.fromkeys(head for row in rows for head in row))
    return write_csv(path, [heads, *([_cell(row.get(head, "")) for head in heads] for row in rows)])


def _cell(value: Any) -> str:
    """Write a cell of a table: a truth value as 0 or 1, a missing or infinite number as nothing."""
    if value is None or isinstance(value, str):
        return value or ""
    return f"{float(value):.9g}" if numpy.isfinite(value) else ""
