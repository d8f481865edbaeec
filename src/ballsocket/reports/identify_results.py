"""Results of an identification as figures and as tables in a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy
from rich.table import Table

from ..core.kinds import Unit
from ..core.quantities import FIELD, LOADS, Quantity
from ..identify.experiment import Experiment
from ..identify.measured import MEASURED, Measured
from ..identify.posterior import CONVERGED, Posterior
from ..identify.result import IdentificationResult
from ..identify.sensitivity import Sensitivity
from .style import BLUE, GREEN, GREY, INK, LEGEND, ORANGE, PINK, SKY, VERMILLION, finish
from .terminal import console, print_folded

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..core.arrays import Numbers

_MARKS = ("o", "s", "^", "D", "v", "P")
_COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PINK, SKY)
_DRAWN = 4000  # samples about the best point, where there is no posterior
_HELD = (0.5, 0.95)


def fit_figure(found: IdentificationResult) -> Figure:
    """What was measured and what the model says there, above; how many uncertainties they are apart, below."""
    from matplotlib.figure import Figure

    sets = [place for place, each in enumerate(found.data) if each.load]
    figure = Figure(figsize=(4.2 * max(1, len(sets)), 5.2), layout="constrained")
    if not sets:
        figure.text(0.5, 0.5, "nothing was measured at a load", ha="center")
        return figure
    panels = figure.subplots(2, len(sets), squeeze=False, sharex="col", height_ratios=(2.2, 1.0))
    for column, place in enumerate(sets):
        _draw_set(panels[0, column], panels[1, column], found, place)
    for axes in panels[0]:
        axes.legend(**LEGEND)
    panels[1, 0].set_ylabel("residual [uncertainties]")
    return figure


def _draw_set(above: Axes, below: Axes, found: IdentificationResult, place: int) -> None:
    each, residuals = found.data[place], found.residuals[place]
    x, label = _across(each)
    quantity, factor = each.described, each.described.shown.factor
    colour, mark = _COLOURS[place % len(_COLOURS)], _MARKS[place % len(_MARKS)]
    above.plot(*_line(found, place, x, factor), color=INK, linewidth=1.4, label=found.model.name)
    bars = {"yerr": factor * each.uncertainty, "color": colour, "fmt": mark, "markersize": 4, "linewidth": 1}
    above.errorbar(x, factor * each.values, **bars, label="measured")
    cut = each.saturated
    if cut.any():
        more: Any = {"marker": "$\\uparrow$", "linestyle": "", "markersize": 14, "color": colour}
        above.plot(x[cut], factor * each.values[cut], **more, label="at least")
    below.axhspan(-2, 2, color="0.93", linewidth=0)
    below.axhline(0.0, color=INK, linewidth=0.8)
    below.plot(x, residuals, mark, color=colour, markersize=4)
    reach = max(3.0, 1.1 * float(abs(residuals).max()))
    below.set_ylim(-reach, reach)
    above.set_title(each.name, fontsize=9)
    finish(above, "", quantity.label())
    finish(below, label, "")


def _line(found: IdentificationResult, place: int, x: Numbers, factor: float) -> tuple[Numbers, Numbers]:
    """The model's curve, or its answers at the angles that were measured."""
    each = found.data[place]
    if each.angle is not None:
        order = numpy.argsort(x)
        return x[order], factor * found.results[place][order]
    loads, answers = found.curve(place)
    return LOADS[each.load].shown.factor * loads, factor * answers


def _across(each: Measured) -> tuple[Numbers, str]:
    """What the axis across shows: the load, or angles where there is one load."""
    if each.angle is not None and numpy.ptp(each.loads) == 0:
        return FIELD["angle"].shown.factor * each.angle, FIELD["angle"].label()
    load = LOADS[each.load]
    return load.shown.factor * each.loads, load.label()


def corner_figure(found: IdentificationResult, drawn: Posterior | None = None) -> Figure:
    """Every unknown alone, and every two against each other: samples of the posterior.

    Without a posterior they are drawn about the best point, as wide as the information there says.
    """
    from matplotlib.figure import Figure

    samples = _about(found) if drawn is None else drawn.samples
    unknowns = found.transform.unknowns
    count = len(unknowns)
    figure = Figure(figsize=(2.3 * count + 1.2, 2.1 * count + 1.0), layout="constrained")
    panels = figure.subplots(count, count, squeeze=False, sharex="col")
    columns = [each.quantity.shown.factor * samples[:, place] for place, each in enumerate(unknowns)]
    for row in range(count):
        for column in range(count):
            axes = panels[row, column]
            if column > row:
                axes.set_axis_off()
            elif column == row:
                _draw_alone(axes, columns[row])
            else:
                _draw_pair(axes, columns[column], columns[row])
            across = _label(unknowns[column].name, unknowns[column].quantity) if row == count - 1 else ""
            upwards = _label(unknowns[row].name, unknowns[row].quantity) if column == 0 and row else ""
            axes.set_xlabel(across, fontsize=9)
            axes.set_ylabel(upwards, fontsize=9)
            axes.spines[["top", "right"]].set_visible(False)
            axes.tick_params(labelsize=8)
    source = "drawn about the best point" if drawn is None else f"posterior, R-hat {max(drawn.r_hat.values()):.3f}"
    figure.suptitle(f"{found.model.name}: {source}; 50 and 95 % shaded", fontsize=10)
    return figure


def _label(name: str, quantity: Quantity) -> str:
    """By the name of the unknown: of two machines each has an offset."""
    return f"{name}\n{quantity.shown.text_in_brackets}".strip()


def _about(found: IdentificationResult) -> Numbers:
    random = numpy.random.default_rng(0)
    places = random.multivariate_normal(found.best.theta, found.information.covariance, _DRAWN)
    return found.transform.to_values(numpy.clip(places, found.transform.low, found.transform.high))


def _draw_alone(axes: Axes, values: Numbers) -> None:
    axes.hist(values, bins=40, color=SKY, histtype="stepfilled")
    for end in numpy.quantile(values, [0.025, 0.975]):
        axes.axvline(end, color=INK, linewidth=0.9, linestyle="--")
    axes.set_yticks([])


def _draw_pair(axes: Axes, x: Numbers, y: Numbers) -> None:
    """Shades that hold half and nearly all of the samples."""
    counts, across, upwards = numpy.histogram2d(x, y, bins=26)
    smooth = _smoothed(counts)
    ordered = numpy.sort(smooth.ravel())[::-1]
    held = numpy.cumsum(ordered) / ordered.sum()
    levels = sorted({float(ordered[numpy.searchsorted(held, share)]) for share in _HELD})
    middles = ((edges[1:] + edges[:-1]) / 2 for edges in (across, upwards))
    shades: Any = ["#BBDDF2", BLUE][-len(levels) :]
    axes.contourf(*middles, smooth.T, levels=[*levels, max(float(smooth.max()), levels[-1] * 1.01)], colors=shades)


def _smoothed(counts: Numbers) -> Numbers:
    """One conservative [1 2 1] pass each way."""
    for axis in (0, 1):
        wide = numpy.pad(counts, [(1, 1) if axis == each else (0, 0) for each in (0, 1)], mode="edge")
        parts = [numpy.take(wide, range(start, start + counts.shape[axis]), axis) for start in (0, 1, 2)]
        counts = (parts[0] + 2 * parts[1] + parts[2]) / 4
    return counts


def experiment_figure(experiment: Experiment) -> Figure:
    """What each candidate for the next measurement is expected to tell, over its load."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.subplots()
    names = list(dict.fromkeys(gain.candidate.quantity for gain in experiment.gains))
    for number, name in enumerate(names):
        gains = [gain for gain in experiment.gains if gain.candidate.quantity == name]
        colour, mark = _COLOURS[number % len(_COLOURS)], _MARKS[number % len(_MARKS)]
        title = MEASURED[name].title
        if gains[0].candidate.force is None:
            axes.axhline(gains[0].bits, color=GREY, linestyle="--", label=f"{title}, without a load")
            continue
        points = sorted((gain.candidate.force or 0.0, gain.bits) for gain in gains)
        axes.plot(*zip(*points, strict=True), marker=mark, color=colour, markersize=4, label=title)
    axes.set_ylim(bottom=0.0)
    finish(axes, LOADS["force"].label(), "expected gain [bits]")
    axes.legend(**LEGEND)
    return figure


_ROWS = 5


def print_identified(found: IdentificationResult, drawn: Posterior | None) -> None:
    """Print the unknowns with their bands, products, fit, sensitivity to machine errors, and the next measurement."""
    terminal, information = console(), found.information
    print_folded(terminal, f"{found.model.name} through {_counted(found)}", "bold")
    terminal.print(_table(found, drawn))
    rank = f"rank {information.rank} of {len(found.transform.names)}, condition {information.condition:.2g}"
    print_folded(terminal, f"information of {rank}; {_scatter(found)}", "")
    if drawn is not None:
        print_folded(terminal, _chains(drawn), "")
    if found.sensitivity:
        terminal.print(_sensitivity_table(found))
    terminal.print(_next(found))
    for note in found.notes:
        print_folded(terminal, note, "dim")


def _counted(found: IdentificationResult) -> str:
    sets = ", ".join(f"{len(each)} x {each.quantity}" for each in found.data)
    return f"{len(found.misfit.value)} values ({sets})"


def _scatter(found: IdentificationResult) -> str:
    if found.freedom <= 0:
        return "as many values as unknowns: the quality of the fit cannot be tested"
    return f"the data scatter {found.spread:.2f} times as far as their uncertainties say"


def _chains(drawn: Posterior) -> str:
    worst, fewest = max(drawn.r_hat.values()), min(drawn.effective.values())
    verdict = "converged" if drawn.converged else f"not converged, which is up to {CONVERGED}"
    return (
        f"{len(drawn.samples)} samples, as good as {fewest:.0f} independent ones; acceptance {drawn.acceptance:.2f}, "
        f"R-hat {worst:.4f}: {verdict}"
    )


def _table(found: IdentificationResult, drawn: Posterior | None) -> Table:
    table = _plain_table("", "best", "95 %", "unit", *(("posterior",) if drawn else ()))
    for unknown, each in zip(found.transform.unknowns, found.estimates.values(), strict=True):
        unit = unknown.quantity.shown
        best = _numbers(unit.factor, each.value) if each.identifiable else "not identifiable"
        band = _band(unit.factor, each.low, each.high)
        table.add_row(each.name, best, band, unit.text, *_drawn(drawn, each.name, unit))
    for product in found.information.products:
        table.add_row(product.name, _numbers(1.0, product.value), _band(1.0, product.low, product.high), product.unit)
    return table


def _plain_table(*heads: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for place, head in enumerate(heads):
        table.add_column(head, justify="left" if place == 0 or head == "unit" else "right", no_wrap=place == 0)
    return table


def _drawn(drawn: Posterior | None, name: str, unit: Unit) -> tuple[str, ...]:
    return () if drawn is None else (_band(unit.factor, *drawn.band(name)),)


def _band(factor: float, low: float, high: float) -> str:
    return f"{_numbers(factor, low)} to {_numbers(factor, high)}"


def _numbers(factor: float, number: float) -> str:
    return f"{factor * number:.4g}"


def _sensitivity_table(found: IdentificationResult) -> Table:
    """Make the table of shifts by machine errors, with ratios to half bands."""
    unknowns = found.transform.unknowns
    heads = [f"Δ{each.quantity.symbol}, {each.quantity.shown.text}".removesuffix(", ") for each in unknowns]
    table = _plain_table("if the machine had", *heads)
    for error in found.sensitivity:
        shifts = [_shift(found, error, index) for index in range(len(unknowns))]
        table.add_row(error.title, *shifts)
    return table


def _shift(found: IdentificationResult, error: Sensitivity, index: int) -> str:
    """Format a shift and its ratio to half a band."""
    unknown = found.transform.unknowns[index]
    ratio = found.shift_ratio(error, unknown.name)
    if not found.estimates[unknown.name].identifiable:
        return "-"
    return f"{unknown.quantity.shown.factor * error.shifts[unknown.name]:+.3g} ({ratio:.1f}x)" if ratio > 5e-3 else "0"


def _next(found: IdentificationResult) -> Table:
    """The best load of each quantity."""
    unknowns = found.transform.unknowns
    table = _plain_table(
        "measure next", "at", "to within", "bits", *(f"{each.quantity.symbol} left" for each in unknowns)
    )
    for gain in found.next.best_by_quantity[:_ROWS]:
        candidate, quantity = gain.candidate, MEASURED[gain.candidate.quantity]
        within = f"{_short(candidate.uncertainty * quantity.shown.factor)} {quantity.shown.text}"
        load = "-" if candidate.force is None else f"{candidate.force:.4g} N"
        left = [f"{100 * gain.uncertainty_ratio[each.name]:.0f} %" for each in unknowns]
        table.add_row(quantity.title, load, within, f"{gain.bits:.2f}", *left)
    return table


def _short(number: float) -> str:
    """Two digits, without an exponent where they are few."""
    return f"{float(f'{number:.2g}'):g}"
