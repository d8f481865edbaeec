"""Figures of studies: design maps with limits, bands, Pareto fronts, Sobol indices."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy

from ..contact.verdict import Verdict
from ..core.quantities import QUANTITIES
from ..core.unit_systems import Sentence, Units
from ..studies.limits import (
    Limit,
    allowed,
    count_verdicts,
    margin_on_plane,
    relative_margins,
    undecided_reason,
    verdicts,
)
from ..studies.study_answer import amount_of
from .style import BLUE, INK, LEGEND, ORANGE, THICK, THIN, VERMILLION, finish, in_units, new_figure, single_axes

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.contour import ContourSet
    from matplotlib.figure import Figure

    from ..core.arrays import Numbers

SHOWN = ("max_pressure", "area", "half_angle")
"""Results that a design map shows by default."""

_VEIL = 0.65  # opacity of the white veil over forbidden areas


def design_map(
    study: xarray.Dataset,
    limits: Sequence[Limit] = (),
    quantities: Iterable[str] = SHOWN,
    best: Any = None,
    units: Units = Units.SI,
) -> Figure:
    """Draw contours of results over the two axes of a study, with limits and validity.

    The map is pale where a limit is exceeded or a result is missing, dotted where a limit is undecided, and hatched
    where the model is not valid.

    Parameters
    ----------
    study : xarray.Dataset
        From `study`, with two axes of more than one value.
    limits : sequence of Limit
        Limits; their ends are dotted lines with text.
    quantities : iterable of str
    best : mapping of str to float, optional
        A point to mark.
    units : Units
        Units of the axes.

    Raises
    ------
    ValueError
        A study without exactly two axes of more than one value.
    """
    names = [name for name in quantities if name in study.data_vars]
    across, up = _two_axes(study)
    figure = new_figure(4.4 * len(names) + 0.4, 4.4)
    answered, trusted = (condition.transpose(up, across).values for condition in (allowed(study, ()), study.valid))
    for axes, name in zip(figure.subplots(1, len(names), squeeze=False).ravel(), names, strict=True):
        shown = units.written(QUANTITIES[name].shown)
        values = study[name].transpose(up, across).values * shown.factor
        x, y = read(study, across).values, read(study, up).values
        axes.contourf(x, y, values, levels=14, cmap="viridis")
        lines = axes.contour(x, y, values, levels=7, colors="white", linewidths=0.6)
        if not answered.all():
            axes.contourf(x, y, (~answered).astype(float), levels=[0.5, 1.5], colors="white", alpha=_VEIL)
        if not trusted.all():
            hatching = axes.contourf(x, y, (~trusted).astype(float), levels=[0.5, 1.5], colors="none", hatches=["//"])
            hatching.set_edgecolor("0.85")
            hatching.set_linewidth(0)
        _draw_limits(axes, study, limits, (across, up))
        _label_lines(axes, lines)
        if best is not None:
            position = (best[axis] * QUANTITIES[axis].shown.factor for axis in (across, up))
            axes.plot(*position, "o", color="white", markeredgecolor="black", markersize=8)
        axes.set(xlabel=QUANTITIES[across].label(), ylabel=QUANTITIES[up].label())
        axes.set_title(QUANTITIES[name].label(shown), fontsize=10)
    figure.suptitle(_title(study), fontsize=10, parse_math=False)
    counts = count_verdicts(study, limits)
    texts = {
        "pale: a limit is exceeded, or no result": counts["exceeded"] or counts["no result"],
        f"dotted: undecided, {undecided_reason(study, limits)}": counts["undecided"],
        "hatched: the model is not valid": not trusted.all(),
    }
    figure.supxlabel("; ".join(words for words, present in texts.items() if present), fontsize=8, color="0.3")
    return in_units(figure, units)


def result_figure(study: xarray.Dataset, name: str, limits: Iterable[Limit] = (), units: Units = Units.SI) -> Figure:
    """Draw a result over the one axis of a study, with its limits as dotted lines; thin where it is not valid."""
    figure, axes = single_axes()
    (across,) = (str(dim) for dim, size in study.sizes.items() if size > 1)
    x, y, factor = read(study, across).values, read(study, name).values, QUANTITIES[name].shown.factor
    axes.plot(x, y, color=INK, linewidth=THIN)
    axes.plot(x, numpy.where(study.valid.values, y, numpy.nan), color=INK, linewidth=THICK)
    for end in (end for limit in limits for end in (limit.low, limit.high) if numpy.isfinite(end)):
        axes.axhline(end * factor, color=VERMILLION, linestyle=":")
    finish(axes, QUANTITIES[across].label(), QUANTITIES[name].label())
    axes.set_ylim(bottom=min(0.0, float(numpy.nanmin(y))))
    figure.suptitle(_title(study), fontsize=9)
    return in_units(figure, units)


def read(study: xarray.Dataset, name: str) -> xarray.DataArray:
    """Return a quantity or axis of a study in the unit of figures."""
    return study[name] * QUANTITIES[name].shown.factor


def _two_axes(study: xarray.Dataset) -> tuple[str, str]:
    """Return the names of the two axes of a study that have more than one value."""
    long = [str(dim) for dim, size in study.sizes.items() if size > 1]
    if len(long) != 2:
        raise ValueError(f"a map needs two axes of more than one value, got {', '.join(long) or 'none'}")
    for name in long:
        if name not in QUANTITIES:
            raise ValueError(f"a map has axes of numbers, and {name} has names")
    return long[0], long[1]


def _title(study: xarray.Dataset) -> Sentence:
    fixed = [
        Sentence("{} = {}", QUANTITIES[str(name)].title, amount_of(str(name), float(coordinate)))
        for name, coordinate in study.coords.items()
        if not coordinate.dims and name in QUANTITIES and numpy.issubdtype(coordinate.dtype, numpy.number)
    ]
    joint = json.loads(study.attrs["joint"])["name"]
    parts = [*([joint] if joint else []), *fixed, f"model {study.attrs['model']}"]
    return Sentence("; ".join("{}" for _ in parts), *parts)


def _draw_limits(axes: Axes, study: xarray.Dataset, limits: Iterable[Limit], names: tuple[str, str]) -> None:
    """Veil the area that exceeds the limits, dot the undecided area, and draw each limit as a line with its text."""
    across, up = names
    x, y = (read(study, name).values for name in names)
    worst, best = relative_margins(study, limits, across, up)
    if numpy.nanmin(best) < 0:
        axes.contourf(x, y, best, levels=[-2.0, 0.0], colors="white", alpha=_VEIL)
    decided = numpy.maximum(worst, -best)  # negative where only the better end of the bar keeps the limits
    if numpy.nanmin(decided) < 0:
        dots = axes.contourf(x, y, decided, levels=[-2.0, 0.0], colors="white", alpha=_VEIL / 2, hatches=[".."])
        dots.set_edgecolor("0.15")
        dots.set_linewidth(0)
    for limit in limits:
        for end in (replace(limit, high=numpy.inf), replace(limit, low=-numpy.inf)):
            values = margin_on_plane(study, end, across, up).value
            if numpy.nanmin(values) < 0 < numpy.nanmax(values):
                line = axes.contour(x, y, values, levels=[0.0], colors="black", linestyles=":")
                _label_lines(axes, line, end.sentence(QUANTITIES[end.name].title))


def _label_lines(axes: Axes, lines: ContourSet, text: str = "") -> None:
    """Write numbers, or a text, on contour lines, legible on every colour."""
    from matplotlib.patheffects import withStroke

    fmt: Any = {float(level): text for level in lines.levels} if text else None
    for label in axes.clabel(lines, fontsize=8, colors="black", fmt=fmt):
        label.set_path_effects([withStroke(linewidth=2.0, foreground="white", alpha=0.8)])


def band_figure(
    study: xarray.Dataset, quantities: Iterable[str] = ("max_pressure", "half_angle"), units: Units = Units.SI
) -> Figure:
    """Draw the median of results over an axis, with bands that contain 50, 90 and 99 % of the samples.

    Raises
    ------
    ValueError
        A study without samples, or without exactly one more axis.
    """
    axis_names = [str(dim) for dim in study.sizes if dim != "sample"]
    if "sample" not in study.sizes or len(axis_names) != 1:
        raise ValueError("bands need samples and one more axis, such as the force")
    names = [name for name in quantities if name in study.data_vars]
    figure = new_figure(5.0 * len(names), 4.0)
    for axes, name in zip(figure.subplots(1, len(names), squeeze=False).ravel(), names, strict=True):
        values, x = read(study, name), read(study, axis_names[0]).values
        for share, shade in ((0.99, "0.85"), (0.90, "0.7"), (0.50, "0.5")):
            low, high = (values.quantile(end, dim="sample").values for end in ((1 - share) / 2, (1 + share) / 2))
            axes.fill_between(x, low, high, color=shade, label=f"{100 * share:g} % of the joints", linewidth=0)
        axes.plot(x, values.median(dim="sample").values, color="black", linewidth=1.8, label="median")
        finish(axes, QUANTITIES[axis_names[0]].label(), QUANTITIES[name].label())
    figure.axes[0].legend(**LEGEND)
    return in_units(figure, units)


def front_figure(
    study: xarray.Dataset, front: xarray.Dataset, minimise: tuple[str, str], limits: Sequence[Limit]
) -> Figure:
    """Draw every kept and every undecided design as a dot, and the Pareto front as a line.

    Parameters
    ----------
    study, front : xarray.Dataset
        From `study` and `pareto`.
    minimise : tuple of two str
    limits : sequence of Limit
    """
    figure, axes = single_axes(6.4, 4.6)
    codes = verdicts(study, limits)
    for verdict, colour in ((Verdict.UNDECIDED, ORANGE), (Verdict.KEPT, "0.75")):
        first, second = (read(study, name).where(codes == int(verdict)).values.ravel() for name in minimise)
        if numpy.isfinite(first).any():
            axes.plot(first, second, ".", color=colour, markersize=3, label=verdict.word)
    best = [read(front, name).values for name in minimise]
    axes.plot(*best, "o-", color=INK, markersize=4, linewidth=1.2, label="no other is better in both")
    finish(axes, *(QUANTITIES[name].label() for name in minimise))
    axes.legend(**LEGEND)
    return figure


_INDEX_STYLES = {
    "first_order": ("first order", BLUE, ""),
    "total_order": ("total order", ORANGE, "//"),
    "shapley": ("Shapley effect", VERMILLION, ".."),
}
"""Label, colour and hatch of the bars for each kind of index."""


def sensitivity_figure(indices: xarray.Dataset) -> Figure:
    """Draw first and total indices, and Shapley effects, of every quantity with their intervals."""
    panels = {}
    for quantity in indices.quantity.values.tolist():
        part = indices.sel(quantity=quantity)
        panels[QUANTITIES[quantity].title] = {
            order: [part[name].values for end in ("", "_low", "_high") if (name := f"{order}{end}") in part]
            for order in _INDEX_STYLES
            if order in part
        }
    return draw_indices(panels, [QUANTITIES[name].title for name in indices.parameter.values.tolist()])


def draw_indices(panels: Mapping[str, Mapping[str, Sequence[Numbers]]], names: Sequence[str]) -> Figure:
    """Draw shares of the variance as bars, with a panel for each result.

    Parameters
    ----------
    panels : mapping
        For each result the kinds of index, "first_order", "total_order" or "shapley": shares (names,), and if known
        the low and the high ends of their intervals.
    names : sequence of str
        Titles of the parameters.
    """
    figure = new_figure(3.4 * len(panels) + 1.2, 0.55 * len(names) + 1.8)
    rows, axes_row = numpy.arange(len(names)), figure.subplots(1, len(panels), squeeze=False, sharey=True)[0]
    for axes, (title, kinds) in zip(axes_row, panels.items(), strict=True):
        height = 0.64 / len(kinds)
        for position, (order, (values, *ends)) in enumerate(kinds.items()):
            label, colour, hatch = _INDEX_STYLES[order]
            off = numpy.clip([values - ends[0], ends[1] - values], 0.0, None) if ends else None
            axes.barh(
                rows + (position - (len(kinds) - 1) / 2) * (height + 0.02),
                values,
                height,
                xerr=None if off is None else numpy.nan_to_num(off),
                color=colour,
                hatch=hatch,
                edgecolor="white",
                label=label,
            )
        axes.set_yticks(rows, names)
        axes.set_xlim(0.0, 1.05)
        finish(axes, "share of the variance", "")
        axes.set_title(title, fontsize=10)
    figure.axes[0].invert_yaxis()
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure
