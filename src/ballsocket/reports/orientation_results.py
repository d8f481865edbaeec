"""Orientations of a cup as a map of inclination and anteversion, and as text in a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy
from rich.table import Table
from rich.text import Text

from ..core.arrays import Numbers
from ..core.quantities import CONTACT, CUP, DERIVED, Quantity
from ..core.validity import Status
from ..elasticity.off_axis.orientations import Orientations
from .style import LEGEND
from .terminal import console, print_folded

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


_MOST = 7
"""Values of each angle that a table shows."""


def print_orientations(stood: Orientations) -> None:
    """Distance to the rim and largest pressure by inclination and anteversion, the best places, and what it took."""
    terminal = console()
    print_folded(terminal, str(stood.joint), "bold")
    print_folded(terminal, load_text(stood), "bold")
    fields = {DERIVED["edge_distance"]: stood.edge_distance, CONTACT["max_pressure"]: stood.max_pressure}
    for quantity, values in fields.items():
        terminal.print(Text(f"{quantity.label()}, anteversion by inclination"))
        terminal.print(_table(stood, values))
    for line in _remarks(stood):
        print_folded(terminal, line, "dim")


def _table(stood: Orientations, values: Numbers) -> Table:
    rows, columns = (_some(len(angles)) for angles in (stood.anteversion, stood.inclination))
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for head in ("", *(_degrees(stood.inclination[i]) for i in columns)):
        table.add_column(head, justify="right", no_wrap=True)
    for j in rows:
        cells = (_cell(stood, values, i, j) for i in columns)
        table.add_row(Text(_degrees(stood.anteversion[j]), style="bold"), *cells)
    return table


def _some(count: int) -> list[int]:
    """Evenly chosen places, the first and the last among them."""
    places = numpy.linspace(0, count - 1, min(count, _MOST)).round().astype(int)
    return [int(each) for each in places]


def _cell(stood: Orientations, values: Numbers, i: int, j: int) -> Text:
    if not stood.held[i, j]:
        return Text("-", style="dim")
    return Text(f"{values[i, j]:.1f}", style="yellow" if stood.edge_loaded[i, j] else "")


def _remarks(stood: Orientations) -> Iterator[str]:
    if stood.held.any():
        yield f"furthest from the rim: {_at(stood, stood.edge_distance, 'mm')}"
    if (stood.held & numpy.isfinite(stood.max_pressure)).any():
        yield f"least pressure: {_at(stood, -stood.max_pressure, 'MPa')}"
    loaded = int((stood.edge_loaded & stood.held).sum())
    if loaded:
        yield f"{loaded} of {stood.status.size} orientations load the rim (below 0: how far beyond first touch)"
    if numpy.isposinf(stood.max_pressure).any():
        yield "inf: the end of the bore digs in, where the pressure is unbounded"
    for status in Status:
        count = int((stood.status == int(status)).sum())
        if status.failed and count:
            yield f"{count} of {stood.status.size}: {status.sentence}"
    took = f"{stood.status.size} orientations in {stood.seconds:.2f} s"
    yield f"{stood.model.name}: rings of {degrees(stood.model.ring_width):.3g}°, {took}"


def _at(stood: Orientations, values: Numbers, unit: str) -> str:
    inclination, anteversion, place = stood.best(values)
    size = abs(float(values.flat[place])) if unit == "MPa" else float(values.flat[place])
    return f"{size:.1f} {unit} at inclination {_degrees(inclination)}, anteversion {_degrees(anteversion)}"


def _degrees(angle: float) -> str:
    return f"{degrees(angle):.3g}°"
