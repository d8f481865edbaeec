"""The paper's figures, drawn from their numbers. Nothing is computed here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy

from .figures import COLOURS, finish
from .paper.cases import OUTER_RADII
from .paper.curves import FIT, Figure, Line, Map, Panel

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_STYLES: dict[str, dict[str, Any]] = {
    "exact": {"color": "black", "linestyle": "-", "linewidth": 2.2},
    "finite elements": {
        "color": "#CC79A7",
        "linestyle": "",
        "marker": "o",
        "markersize": 3.5,
        "markerfacecolor": "none",
    },
    "hess-forsbach": {"color": "#D55E00", "linestyle": (0, (6, 2)), "linewidth": 1.6},
    "bartel": {"color": "#0072B2", "linestyle": (0, (2, 1.5)), "linewidth": 1.6},
    "bonded-layer": {"color": "#009E73", "linestyle": (0, (7, 2, 1.5, 2)), "linewidth": 1.6},
    "hertz": {"color": "#56B4E9", "linestyle": (0, (4, 1.5, 1, 1.5)), "linewidth": 1.6},
    "refined": {"color": "#E69F00", "linestyle": (0, (1, 1)), "linewidth": 2.0},
    FIT: {"color": "0.5", "linestyle": ":", "linewidth": 1.6},
}
_COLUMNS = 2


def draw(figure: Figure) -> Drawing:
    """One of the paper's figures."""
    from matplotlib.figure import Figure as Drawing

    parts: list[Panel | Map] = [*figure.panels, *figure.maps]
    columns = len(parts) if len(parts) < 4 else _COLUMNS
    rows = -(-len(parts) // columns)
    drawing = Drawing(figsize=(4.4 * columns + 0.6, 3.5 * rows + 0.5), layout="constrained")
    for axes, part in zip(drawing.subplots(rows, columns, squeeze=False).ravel(), parts, strict=False):
        if isinstance(part, Panel):
            _draw_panel(axes, part)
        else:
            _draw_map(axes, part)
    _name_models(drawing, figure)
    return drawing


def _name_models(drawing: Drawing, figure: Figure) -> None:
    """A legend of the models below; cases are named in the panels."""
    from matplotlib.lines import Line2D

    lines = [line for panel in figure.panels for line in panel.lines]
    coloured = len({line.case for line in lines}) == 1
    models = dict.fromkeys(line.model for line in lines)
    styles = {model: _STYLES[model] if coloured else {**_STYLES[model], "color": "0.3"} for model in models}
    if models:
        handles = [Line2D([], [], label=model, **style) for model, style in styles.items()]
        drawing.legend(
            handles=handles, loc="outside lower center", ncols=min(len(handles), 6), frameon=False, fontsize=9
        )


def _draw_panel(axes: Axes, panel: Panel) -> None:
    cases = list(dict.fromkeys(line.case for line in panel.lines))
    named: set[str] = set()
    for line in panel.lines:
        label = line.case if len(cases) > 1 and line.case not in named and _STYLES[line.model]["linestyle"] else None
        named |= {line.case} if label else set()
        axes.plot(line.x, line.y, label=label, **_style(line, cases))
    finish(axes, panel.x, panel.y)
    axes.set_title(panel.title, fontsize=10)
    axes.set_xlim(left=0.0)
    if "pressure" in panel.y:
        axes.set_ylim(bottom=0.0)
    if "force" in panel.y:
        axes.set_ylim(0.0, 4000.0)
        axes.set_xlim(0.0, 1.15 * max(line.x[-1] for line in panel.lines if line.model != "hertz"))
    if named:
        axes.legend(frameon=False, fontsize=8)


def _style(line: Line, cases: list[str]) -> dict[str, Any]:
    """The model's own, with a colour for each case where there are several."""
    style = dict(_STYLES[line.model])
    if len(cases) > 1:
        style["color"] = COLOURS[cases.index(line.case) % len(COLOURS)]
    return style


def _draw_map(axes: Axes, each: Map) -> None:
    values = numpy.array([[numpy.nan if value is None else value for value in row] for row in each.z], dtype=float)
    filled = axes.contourf(each.x, each.y, values, levels=12, cmap="viridis")
    lines = axes.contour(each.x, each.y, values, levels=numpy.array(filled.levels)[::2], colors="white", linewidths=0.6)
    axes.clabel(lines, fontsize=7)
    radius = numpy.array(each.x)
    for outer in OUTER_RADII:
        axes.plot(radius, outer - radius, color="black", linestyle=":", linewidth=1.5)
    axes.set_ylim(each.y[0], each.y[-1])
    axes.set_xlabel(each.x_label)
    axes.set_ylabel(each.y_label)
    axes.set_title(each.title, fontsize=10)
