"""Studies become pictures. Nothing is solved here."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy

from ..core.quantities import QUANTITIES
from ..studies.limits import Limit, allowed
from .design_map import SHOWN, design_map, read
from .style import BLUE, INK, LEGEND, ORANGE, finish

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

__all__ = ["SHOWN", "band_figure", "design_map", "front_figure", "sensitivity_figure"]


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
        values, x = read(study, name), read(study, others[0]).values
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
    one, other = (read(study, name).where(good).values.ravel() for name in minimise)
    axes.plot(one, other, ".", color="0.75", markersize=3, label="allowed")
    best = [read(front, name).values for name in minimise]
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
