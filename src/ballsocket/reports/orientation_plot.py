"""How a cup may stand becomes a map: inclination by anteversion, coloured by what the rim and the pressure say."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.quantities import CONTACT, CUP, DERIVED, Quantity
from ..elasticity.off_axis.orientations import Orientations
from .style import LEGEND

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEVELS = 12
_LOST, _DUG = "xxx", "///"


def orientation_figure(stood: Orientations) -> Figure:
    """The distance from the contact to the rim beside the largest pressure, over inclination and anteversion.

    A dotted line is where the contact reaches the rim. Hatched without a colour are cups that do not hold the ball, and
    those whose rim digs in, where the pressure has no largest value. A circle is the orientation of the
    cup, if it is set.

    Parameters
    ----------
    stood : Orientations
        Of two inclinations or more, and two anteversions.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        Fewer orientations.
    """
    from matplotlib.figure import Figure

    if min(stood.status.shape) < 2:
        raise ValueError(f"a map needs two values of each angle, got {' x '.join(map(str, stood.status.shape))}")
    figure = Figure(figsize=(10.4, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    _draw(left, stood, stood.edge_distance, DERIVED["edge_distance"])
    _draw(right, stood, stood.max_pressure, CONTACT["max_pressure"])
    right.set_ylabel("")
    _draw_legend(figure)
    figure.suptitle(f"{stood.joint.dimensions}; {load_text(stood)}", fontsize=10, parse_math=False)
    return figure


def _draw_legend(figure: Figure) -> None:
    """Each word once, where there are any."""
    pairs: dict[str, Any] = {}
    for axes in figure.axes:
        pairs |= {said: handle for handle, said in zip(*axes.get_legend_handles_labels(), strict=True)}
    if pairs:
        figure.legend(list(pairs.values()), list(pairs), loc="outside lower center", ncols=len(pairs), **LEGEND)


def _draw(axes: Axes, stood: Orientations, values: Numbers, quantity: Quantity) -> None:
    """One field, its contours, and what has no number."""
    x, y = numpy.degrees(stood.inclination), numpy.degrees(stood.anteversion)
    shown = numpy.where(stood.held & numpy.isfinite(values), values, numpy.nan).T
    if numpy.isfinite(shown).any() and numpy.nanmax(shown) > numpy.nanmin(shown):
        axes.contourf(x, y, shown, levels=_LEVELS, cmap="viridis")
        lines = axes.contour(x, y, shown, levels=_LEVELS // 2, colors="white", linewidths=0.6)
        axes.clabel(lines, fontsize=8, fmt="%.4g")
    _draw_rim(axes, stood, x, y)
    _hatch(axes, x, y, ~stood.held.T, _LOST, "the load leaves the bore")
    _hatch(axes, x, y, numpy.isposinf(values).T, _DUG, "the rim digs in: unbounded pressure")
    _mark(axes, stood)
    axes.set_xlabel(CUP["inclination"].label())
    axes.set_ylabel(CUP["anteversion"].label())
    axes.set_title(quantity.label(), fontsize=10)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))


def _draw_rim(axes: Axes, stood: Orientations, x: Numbers, y: Numbers) -> None:
    """Where the contact reaches the rim."""
    apart = stood.edge_distance.T
    if numpy.nanmin(apart, initial=0.0) < 0 < numpy.nanmax(apart, initial=0.0):
        axes.contour(x, y, apart, levels=[0.0], colors="black", linestyles=":", linewidths=1.8)
        axes.plot([], [], ":", color="black", linewidth=1.8, label="the contact reaches the rim")


def _hatch(axes: Axes, x: Numbers, y: Numbers, where: Numbers, hatch: str, said: str) -> None:
    """All that touches the points of a mask, hatched on white."""
    from matplotlib.patches import Rectangle

    if not where.any():
        return
    area = axes.contourf(x, y, where.astype(float), levels=[1e-3, 1.5], colors="white", hatches=[hatch], zorder=1.8)
    area.set_edgecolor("0.5")
    area.set_linewidth(0)
    axes.add_patch(Rectangle((x[0], y[0]), 0.0, 0.0, facecolor="white", edgecolor="0.5", hatch=hatch, label=said))


def _mark(axes: Axes, stood: Orientations) -> None:
    """Mark the orientation of the cup, if it is set and lies on the map."""
    cup = stood.model.cup
    inside = (
        stood.inclination[0] <= cup.inclination <= stood.inclination[-1]
        and stood.anteversion[0] <= cup.anteversion <= stood.anteversion[-1]
    )
    if inside and cup.oriented:
        place = degrees(cup.inclination), degrees(cup.anteversion)
        mark: Any = {
            "color": "white",
            "markeredgecolor": "black",
            "markersize": 8,
            "linestyle": "",
            "label": "this cup",
        }
        axes.plot(*place, "o", clip_on=False, **mark)


def load_text(stood: Orientations) -> str:
    """The load with its direction in the body, in words."""
    load = ", ".join(f"{CONTACT[name].symbol} {_number(name, value)}" for name, value in stood.load.items())
    along = ", ".join(f"{each:g}" for each in stood.model.direction)
    return f"{load} along ({along}); arc of cover {degrees(stood.model.cup.arc_of_cover):.4g}°"


def _number(name: str, value: float) -> str:
    unit = CONTACT[name].shown
    return f"{value * unit.factor:.4g} {unit.text}"
