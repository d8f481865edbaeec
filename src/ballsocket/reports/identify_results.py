"""Results of an identification as figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy

from ..core.quantities import FIELD, LOADS, Quantity
from ..identification.experiment import Experiment
from ..identification.information import QUANTILE_95
from ..identification.measured import MEASURED, Measured
from ..identification.posterior import Posterior
from ..identification.result import IdentificationResult
from .style import BLUE, GREEN, GREY, INK, LEGEND, ORANGE, PINK, SKY, VERMILLION, finish, new_figure, single_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..core.arrays import Numbers

_MARKS = ("o", "s", "^", "D", "v", "P")
_COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PINK, SKY)
_SAMPLES = 4000  # samples about the best fit, without a posterior
_CONTENTS = (0.5, 0.95)  # shares of the samples within the drawn regions


def fit_figure(result: IdentificationResult) -> Figure:
    """Draw measured values with the fitted model above, and residuals in units of the uncertainty below."""
    indices = [index for index, data in enumerate(result.data) if data.load]
    figure = new_figure(4.2 * max(1, len(indices)), 5.2)
    if not indices:
        figure.text(0.5, 0.5, "nothing was measured at a load", ha="center")
        return figure
    panels = figure.subplots(2, len(indices), squeeze=False, sharex="col", height_ratios=(2.2, 1.0))
    for column, index in enumerate(indices):
        _draw_set(panels[0, column], panels[1, column], result, index)
    for axes in panels[0]:
        axes.legend(**LEGEND)
    panels[1, 0].set_ylabel("residual [uncertainties]")
    return figure


def _draw_set(above: Axes, below: Axes, result: IdentificationResult, index: int) -> None:
    data, residuals = result.data[index], result.residuals[index]
    x, label = _horizontal_values(data)
    quantity, factor = data.described, data.described.shown.factor
    colour, mark = _COLOURS[index % len(_COLOURS)], _MARKS[index % len(_MARKS)]
    above.plot(*_model_line(result, index, x, factor), color=INK, linewidth=1.4, label=result.model.name)
    uncertainty = result.uncertainties[index] if data.has_unknown_noise else data.uncertainty
    bars: Any = {"yerr": factor * uncertainty, "color": colour, "fmt": mark, "markersize": 4, "linewidth": 1}
    above.errorbar(x, factor * data.values, **bars, label="measured")
    cut = data.saturated
    if cut.any():
        more: Any = {"marker": "$\\uparrow$", "linestyle": "", "markersize": 14, "color": colour}
        above.plot(x[cut], factor * data.values[cut], **more, label="at least")
    below.axhspan(-2, 2, color="0.93", linewidth=0)
    below.axhline(0.0, color=INK, linewidth=0.8)
    below.plot(x, residuals, mark, color=colour, markersize=4)
    reach = max(3.0, 1.1 * float(abs(residuals).max()))
    below.set_ylim(-reach, reach)
    above.set_title(data.name, fontsize=9)
    finish(above, "", quantity.label())
    finish(below, label, "")


def _model_line(result: IdentificationResult, index: int, x: Numbers, factor: float) -> tuple[Numbers, Numbers]:
    """Return the model's curve, or its results at the measured angles."""
    data = result.data[index]
    if data.angle is not None:
        order = numpy.argsort(x)
        return x[order], factor * result.results[index][order]
    loads, answers = result.curve(index)
    return LOADS[data.load].shown.factor * loads, factor * answers


def _horizontal_values(data: Measured) -> tuple[Numbers, str]:
    """Return values and label of the horizontal axis: the load, or angles at a single load."""
    if data.angle is not None and numpy.ptp(data.loads) == 0:
        return FIELD["angle"].shown.factor * data.angle, FIELD["angle"].label()
    load = LOADS[data.load]
    return load.shown.factor * data.loads, load.label()


def corner_figure(result: IdentificationResult, posterior: Posterior | None = None) -> Figure:
    """Draw samples of the posterior: each unknown alone, and each pair of unknowns, with the printed 95 % bands.

    Without a posterior, the samples are of the normal distribution about the best fit that has the width of the bands.
    """
    samples = _approximate_samples(result) if posterior is None else posterior.samples
    unknowns = result.transform.unknowns
    count = len(unknowns)
    figure = new_figure(max(2.3 * count + 1.2, 4.6), 2.1 * count + 1.2)
    panels = figure.subplots(count, count, squeeze=False, sharex="col")
    columns = [unknown.quantity.shown.factor * samples[:, index] for index, unknown in enumerate(unknowns)]
    for row in range(count):
        for column in range(count):
            axes = panels[row, column]
            if column > row:
                axes.set_axis_off()
            elif column == row:
                axes.hist(columns[row], bins=40, color=SKY, histtype="stepfilled")
                name, factor = unknowns[row].name, unknowns[row].quantity.shown.factor
                estimate = result.estimates[name]
                for end in (estimate.low, estimate.high) if posterior is None else posterior.band(name):
                    axes.axvline(factor * end, color=INK, linewidth=0.9, linestyle="--")
                axes.set_yticks([])
            else:
                _draw_regions(axes, columns[column], columns[row])
            across = _label(unknowns[column].name, unknowns[column].quantity) if row == count - 1 else ""
            upwards = _label(unknowns[row].name, unknowns[row].quantity) if column == 0 and row else ""
            axes.set_xlabel(across, fontsize=9)
            axes.set_ylabel(upwards, fontsize=9)
            axes.spines[["top", "right"]].set_visible(False)
            axes.tick_params(labelsize=8, labelleft=column == 0)
            axes.tick_params(axis="x", labelrotation=40)
    drawn = "shaded: 50 and 95 % of" if count > 1 else "bars:"
    source = (
        f"dashed: 95 % by profile likelihood, quantile {result.information.quantile:.3g}\n"
        f"{drawn} a normal distribution that is as wide"
        if posterior is None
        else f"posterior, R-hat {max(posterior.r_hat.values()):.3f}\ndashed: 95 %; {drawn} the samples"
    )
    figure.suptitle(f"{result.model.name}: {source}", fontsize=9)
    return figure


def _label(name: str, quantity: Quantity) -> str:
    """Return the name of an unknown with its unit; each machine has an offset of its name."""
    return f"{name}\n{quantity.shown.text_in_brackets}".strip()


def _approximate_samples(result: IdentificationResult) -> Numbers:
    """Draw samples from the normal distribution about the best fit that is as wide as the 95 % bands."""
    random, information = numpy.random.default_rng(0), result.information
    covariance = information.covariance * (information.quantile / QUANTILE_95) ** 2
    theta = random.multivariate_normal(result.best.theta, covariance, _SAMPLES)
    return result.transform.to_values(numpy.clip(theta, result.transform.low, result.transform.high))


def _draw_regions(axes: Axes, x: Numbers, y: Numbers) -> None:
    """Draw the regions that contain 50 % and 95 % of the samples of two unknowns."""
    from scipy.ndimage import convolve1d  # slow to import

    smooth, across, upwards = numpy.histogram2d(x, y, bins=26)
    for axis in (0, 1):
        smooth = convolve1d(smooth, [0.25, 0.5, 0.25], axis, mode="nearest")  # conserves the sum
    ordered = numpy.sort(smooth.ravel())[::-1]
    content = numpy.cumsum(ordered) / ordered.sum()
    levels = sorted({float(ordered[numpy.searchsorted(content, share)]) for share in _CONTENTS})
    middles = ((edges[1:] + edges[:-1]) / 2 for edges in (across, upwards))
    shades: Any = ["#BBDDF2", BLUE][-len(levels) :]
    axes.contourf(*middles, smooth.T, levels=[*levels, max(float(smooth.max()), levels[-1] * 1.01)], colors=shades)


def experiment_figure(experiment: Experiment) -> Figure:
    """Draw the expected information gain of each candidate for the next measurement over its load."""
    figure, axes = single_axes()
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
