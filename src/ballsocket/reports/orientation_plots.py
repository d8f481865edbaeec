"""Orientations of a cup as a map of inclination and anteversion."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, isfinite
from typing import TYPE_CHECKING, Any

import numpy

from ..contact.verdict import Verdict
from ..core.arrays import Numbers
from ..core.quantities import CONTACT, CUP, DERIVED, Quantity
from ..core.unit_systems import Sentence, Units
from ..elasticity.off_axis.orientations import Orientations
from ..studies.limits import Limit
from ..studies.orientation_answer import angle_text, load_sentence, verdicts
from .style import BLUE, INK, LEGEND, VERMILLION, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEVELS = 12
_LOST_BALL_HATCH, _RIM_HATCH = "xxx", "///"


def orientation_figure(orientations: Orientations, units: Units = Units.SI, limits: Sequence[Limit] = ()) -> Figure:
    """Draw distance to the rim and largest pressure over inclination and anteversion, or over one of them.

    The contact reaches the rim on the dotted line. Two hatchings mark cups that do not hold the ball, and cups whose
    rim digs in, where the pressure is unbounded. A circle marks the orientation of the cup, if it is set. Results for
    one value of the other angle are drawn as curves.

    Parameters
    ----------
    orientations : Orientations
        Results for at least two inclinations or two anteversions.
    units : Units
        Units of every number.
    limits : sequence of Limit
        Limits that are drawn as dashed lines.

    Raises
    ------
    ValueError
        A single orientation.
    """
    if orientations.status.size < 2:
        raise ValueError("a figure needs two values of an angle, got one orientation")
    is_map = min(orientations.status.shape) > 1
    figure = new_figure(10.4, 4.6)
    axes_pair = figure.subplots(1, 2, sharey=is_map)
    quantities = DERIVED["edge_distance"], CONTACT["max_pressure"]
    for axes, quantity in zip(axes_pair, quantities, strict=True):
        if is_map:
            _draw(axes, orientations, getattr(orientations, quantity.name), quantity, units)
            _draw_limits(axes, orientations, limits, units)
        else:
            _draw_curve(axes, orientations, quantity, units, limits)
    if is_map:
        axes_pair[1].set_ylabel("")
    _draw_legend(figure)
    title = units.sentence(Sentence("{}; {}", orientations.joint.dimensions, load_sentence(orientations)))
    if not is_map:
        name = "anteversion" if orientations.status.shape[1] == 1 else "inclination"
        title += f"; {name} {angle_text(float(getattr(orientations, name)[0]))}"
    figure.suptitle(title, fontsize=10, parse_math=False)
    return figure


_LIMIT_LINE: Any = {"color": VERMILLION, "linestyle": "--", "linewidth": 1.6}


def _draw_limits(axes: Axes, orientations: Orientations, limits: Sequence[Limit], units: Units) -> None:
    """Draw each limit as a dashed line over the map where it lies between the values, and mark undecided values."""
    x, y = numpy.degrees(orientations.inclination), numpy.degrees(orientations.anteversion)
    for limit in limits:
        values = getattr(orientations, limit.name).T
        values = numpy.where(numpy.isfinite(values), values, numpy.nan)
        levels = [end for end in (limit.low, limit.high) if (values < end).any() and (values > end).any()]
        if levels:
            axes.contour(x, y, values, levels=sorted(set(levels)), colors=VERMILLION, linestyles="--", linewidths=1.6)
            axes.plot([], [], label=units.sentence(str(limit)), **_LIMIT_LINE)
    across, up = numpy.nonzero(verdicts(orientations, limits) == Verdict.UNDECIDED)
    if len(across):
        label = "undecided: by the error bar, or outside the range of the model"
        axes.plot(x[across], y[up], linestyle="", marker="$?$", color=VERMILLION, markersize=8, label=label)


def _draw_curve(
    axes: Axes, orientations: Orientations, quantity: Quantity, units: Units, limits: Sequence[Limit]
) -> None:
    """Draw one field over the angle that changes, with its limits; orientations without a number are left out."""
    name = "inclination" if orientations.status.shape[1] == 1 else "anteversion"
    label, factor = units.axis(quantity.label(quantity.written))
    bar = orientations.error_bar(quantity.name)
    known = orientations.held & numpy.isfinite(bar.value)
    shown, low, high = (factor * numpy.where(known, ends, numpy.nan).ravel() for ends in bar)
    angles, ends = numpy.degrees(getattr(orientations, name)), [shown - low, high - shown]
    axes.errorbar(angles, shown, yerr=ends, fmt="o-", color=BLUE, markersize=4)
    for limit in (limit for limit in limits if limit.name == quantity.name):
        for end in filter(isfinite, (limit.low, limit.high)):
            axes.axhline(factor * end, label=units.sentence(str(limit)), **_LIMIT_LINE)
    if quantity.name == "edge_distance" and numpy.nanmin(shown, initial=0.0) < 0:
        axes.axhline(0.0, linestyle=":", color=INK, linewidth=1.8, label="the contact reaches the rim")
    axes.set(xlabel=CUP[name].label(), ylabel=label)
    axes.grid(alpha=0.3)


def _draw_legend(figure: Figure) -> None:
    """Add one legend for both maps, with each text once."""
    pairs: dict[str, Any] = {}
    for axes in figure.axes:
        pairs |= {label: handle for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if pairs:
        figure.legend(list(pairs.values()), list(pairs), loc="outside lower center", ncols=len(pairs), **LEGEND)


def _draw(axes: Axes, orientations: Orientations, values: Numbers, quantity: Quantity, units: Units) -> None:
    """Draw one field with contours, and hatch orientations without a number."""
    x, y = numpy.degrees(orientations.inclination), numpy.degrees(orientations.anteversion)
    label, factor = units.axis(quantity.label(quantity.written))
    shown = factor * numpy.where(orientations.held & numpy.isfinite(values), values, numpy.nan).T
    if numpy.isfinite(shown).any() and numpy.nanmax(shown) > numpy.nanmin(shown):
        axes.contourf(x, y, shown, levels=_LEVELS, cmap="viridis")
        lines = axes.contour(x, y, shown, levels=_LEVELS // 2, colors="white", linewidths=0.6)
        axes.clabel(lines, fontsize=8, fmt="%.4g")
    _draw_rim(axes, orientations, x, y)
    _hatch(axes, x, y, ~orientations.held.T, _LOST_BALL_HATCH, "the load leaves the bore")
    _hatch(axes, x, y, numpy.isposinf(values).T, _RIM_HATCH, "the rim digs in: unbounded pressure")
    _mark(axes, orientations)
    axes.set(xlabel=CUP["inclination"].label(), ylabel=CUP["anteversion"].label())
    axes.set_title(label, fontsize=10)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))


def _draw_rim(axes: Axes, orientations: Orientations, x: Numbers, y: Numbers) -> None:
    """Draw the line of orientations at which the contact reaches the rim."""
    apart = orientations.edge_distance.T
    if numpy.nanmin(apart, initial=0.0) < 0 < numpy.nanmax(apart, initial=0.0):
        axes.contour(x, y, apart, levels=[0.0], colors="black", linestyles=":", linewidths=1.8)
        axes.plot([], [], ":", color="black", linewidth=1.8, label="the contact reaches the rim")


def _hatch(axes: Axes, x: Numbers, y: Numbers, where: Numbers, hatch: str, label: str) -> None:
    from matplotlib.patches import Rectangle

    if not where.any():
        return
    area = axes.contourf(x, y, where.astype(float), levels=[1e-3, 1.5], colors="white", hatches=[hatch], zorder=1.8)
    area.set_edgecolor("0.5")
    area.set_linewidth(0)
    axes.add_patch(Rectangle((x[0], y[0]), 0.0, 0.0, facecolor="white", edgecolor="0.5", hatch=hatch, label=label))


def _mark(axes: Axes, orientations: Orientations) -> None:
    """Mark the orientation of the cup, if it is set and lies on the map."""
    cup = orientations.model.cup
    inside = (
        orientations.inclination[0] <= cup.inclination <= orientations.inclination[-1]
        and orientations.anteversion[0] <= cup.anteversion <= orientations.anteversion[-1]
    )
    if inside and cup.oriented:
        position = degrees(cup.inclination), degrees(cup.anteversion)
        mark: Any = {
            "color": "white",
            "markeredgecolor": "black",
            "markersize": 8,
            "linestyle": "",
            "label": "this cup",
        }
        axes.plot(*position, "o", clip_on=False, **mark)
