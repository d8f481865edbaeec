"""Studies become pictures. Nothing is solved here."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy

from ..quantities import QUANTITIES
from ..studies.limits import Limit, allowed, margin_over
from .style import BLUE, INK, LEGEND, ORANGE, finish

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SHOWN = ("max_pressure", "area", "half_angle")
"""What a design map shows."""


def design_map(
    study: xarray.Dataset, limits: Sequence[Limit] = (), quantities: Iterable[str] = SHOWN, best: Any = None
) -> Figure:
    """Contours of answers over the two axes of a study, pale where a limit is broken, hatched where the model is
    not to be trusted.

    Parameters
    ----------
    study : xarray.Dataset
        From `study`, with two axes of more than one value.
    limits : sequence of Limit
        Their ends are dotted lines.
    quantities : iterable of str
    best : mapping of str to float, optional
        A point to mark.

    Raises
    ------
    ValueError
        A study that has not two axes.
    """
    from matplotlib.figure import Figure

    names = [name for name in quantities if name in study.data_vars]
    across, up = _two_axes(study)
    figure = Figure(figsize=(4.4 * len(names) + 0.4, 4.0), layout="constrained")
    good = allowed(study, limits).transpose(up, across).values
    trusted = study.valid.transpose(up, across).values
    for axes, name in zip(figure.subplots(1, len(names), squeeze=False).ravel(), names, strict=True):
        values = _read(study, name).transpose(up, across).values
        x, y = _read(study, across).values, _read(study, up).values
        axes.contourf(x, y, values, levels=14, cmap="viridis")
        lines = axes.contour(x, y, values, levels=7, colors="white", linewidths=0.6)
        axes.clabel(lines, fontsize=8)
        if not good.all():
            axes.contourf(x, y, (~good).astype(float), levels=[0.5, 1.5], colors="white", alpha=0.65)
        if not trusted.all():
            doubt = axes.contourf(x, y, (~trusted).astype(float), levels=[0.5, 1.5], colors="none", hatches=["//"])
            doubt.set_edgecolor("0.85")
            doubt.set_linewidth(0)
        _draw_limits(axes, study, limits, across, up)
        if best is not None:
            place = (best[axis] * QUANTITIES[axis].shown.factor for axis in (across, up))
            axes.plot(*place, "o", color="white", markeredgecolor="black", markersize=8)
        axes.set_xlabel(QUANTITIES[across].label())
        axes.set_ylabel(QUANTITIES[up].label())
        axes.set_title(QUANTITIES[name].label(), fontsize=10)
    said = [(good, "pale: a limit is broken, or no answer"), (trusted, "hatched: the model is not to be trusted")]
    figure.supxlabel("; ".join(words for where, words in said if not where.all()), fontsize=8, color="0.3")
    return figure


def _read(study: xarray.Dataset, name: str) -> xarray.DataArray:
    """A quantity or axis in the unit in which it is drawn."""
    return study[name] * QUANTITIES[name].shown.factor


def _two_axes(study: xarray.Dataset) -> tuple[str, str]:
    long = [str(dim) for dim, size in study.sizes.items() if size > 1]
    if len(long) != 2:
        raise ValueError(f"a map needs two axes of more than one value, got {', '.join(long) or 'none'}")
    for name in long:
        if name not in QUANTITIES:
            raise ValueError(f"a map has axes of numbers, and {name} has names")
    return long[0], long[1]


def _draw_limits(axes: Axes, study: xarray.Dataset, limits: Iterable[Limit], across: str, up: str) -> None:
    for limit in limits:
        values = margin_over(study, limit, across, up)
        if numpy.nanmin(values) < 0 < numpy.nanmax(values):
            x, y = _read(study, across).values, _read(study, up).values
            axes.contour(x, y, values, levels=[0.0], colors="black", linestyles=":")


def band_figure(study: xarray.Dataset, quantities: Iterable[str] = ("max_pressure", "half_angle")) -> Figure:
    """The median of answers over the one axis beside `sample`, with bands that hold 50, 90 and 99 % of the samples.

    Raises
    ------
    ValueError
        A study without samples, or without exactly one more axis.
    """
    from matplotlib.figure import Figure

    others = [str(dim) for dim in study.sizes if dim != "sample"]
    if "sample" not in study.sizes or len(others) != 1:
        raise ValueError("bands need samples and one more axis, such as the force")
    names = [name for name in quantities if name in study.data_vars]
    figure = Figure(figsize=(5.0 * len(names), 4.0), layout="constrained")
    for axes, name in zip(figure.subplots(1, len(names), squeeze=False).ravel(), names, strict=True):
        values, x = _read(study, name), _read(study, others[0]).values
        for share, shade in ((0.99, "0.85"), (0.90, "0.7"), (0.50, "0.5")):
            low, high = (values.quantile(end, dim="sample").values for end in ((1 - share) / 2, (1 + share) / 2))
            axes.fill_between(x, low, high, color=shade, label=f"{100 * share:g} % of the joints", linewidth=0)
        axes.plot(x, values.median(dim="sample").values, color="black", linewidth=1.8, label="median")
        finish(axes, QUANTITIES[others[0]].label(), QUANTITIES[name].label())
    figure.axes[0].legend(**LEGEND)
    return figure


def front_figure(
    study: xarray.Dataset, front: xarray.Dataset, minimise: tuple[str, str], limits: Sequence[Limit]
) -> Figure:
    """Every allowed design as a dot, and those that no other beats as a line.

    Parameters
    ----------
    study, front : xarray.Dataset
        From `study` and `pareto`.
    minimise : tuple of two str
    limits : sequence of Limit
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.6), layout="constrained")
    axes = figure.subplots()
    good = allowed(study, limits)
    one, other = (_read(study, name).where(good).values.ravel() for name in minimise)
    axes.plot(one, other, ".", color="0.75", markersize=3, label="allowed")
    best = [_read(front, name).values for name in minimise]
    axes.plot(*best, "o-", color=INK, markersize=4, linewidth=1.2, label="no other is better in both")
    finish(axes, *(QUANTITIES[name].label() for name in minimise))
    axes.legend(**LEGEND)
    return figure


def sensitivity_figure(found: xarray.Dataset) -> Figure:
    """First and total Sobol indices of every quantity, with their intervals."""
    from matplotlib.figure import Figure

    quantities, parameters = found.quantity.values.tolist(), found.parameter.values.tolist()
    figure = Figure(figsize=(3.4 * len(quantities) + 1.2, 0.55 * len(parameters) + 1.8), layout="constrained")
    rows = numpy.arange(len(parameters))
    for axes, quantity in zip(
        figure.subplots(1, len(quantities), squeeze=False, sharey=True).ravel(), quantities, strict=True
    ):
        for order, offset, colour in (("first", -0.17, BLUE), ("total", 0.17, ORANGE)):
            part = found.sel(quantity=quantity)
            values, low, high = (part[f"{order}_order{end}"].values for end in ("", "_low", "_high"))
            error = numpy.clip([values - low, high - values], 0.0, None)
            hatch = "" if order == "first" else "//"
            axes.barh(
                rows + offset,
                values,
                0.32,
                xerr=error,
                color=colour,
                hatch=hatch,
                edgecolor="white",
                label=f"{order} order",
            )
        axes.set_yticks(rows, [QUANTITIES[name].title for name in parameters])
        axes.set_xlim(0.0, 1.05)
        finish(axes, "share of the variance", "")
        axes.set_title(QUANTITIES[quantity].title, fontsize=10)
    figure.axes[0].invert_yaxis()
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure
