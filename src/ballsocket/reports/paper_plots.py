"""Figures of the paper, drawn from their numbers, and the accuracy of all models as a heat map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy

from ..catalogue import judge
from ..models.foundation import HessForsbach
from ..paper.cases import OUTER_RADII
from ..paper.curves import FIT
from ..paper.figure import Figure, Map, Panel
from ..paper.plan import ELEMENTS
from .accuracy_table import HEADS, spread
from .style import LEGEND, finish, in_matplotlib, line_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_MODELS = {ELEMENTS: judge.name, FIT: HessForsbach().name}
"""Catalogue names of models with another name in the paper's figures."""

_WIDTH = 10.8  # inches: the width of a page, with letters of the size of its text


def draw(figure: Figure) -> Drawing:
    """Draw one of the paper's figures."""
    from matplotlib.figure import Figure as Drawing

    parts: list[Panel | Map] = [*figure.panels, *figure.maps]
    rows = -(-len(parts) // figure.columns)
    drawing = Drawing()
    for axes, part in zip(
        _grid(drawing, rows, figure.columns, bottom_margin=0.95 if figure.panels else 0.55), parts, strict=False
    ):
        axes.set_visible(True)
        if isinstance(part, Map):
            _draw_map(axes, part)
            continue
        _draw_panel(axes, part)
        if not _have_same_cases(figure.panels):
            _name_cases(axes, part)
    _name_models(drawing, figure)
    return drawing


def _grid(drawing: Drawing, rows: int, columns: int, bottom_margin: float) -> Iterator[Axes]:
    """Yield hidden axes of equal size; fixed margins save the seconds of a layout engine."""
    left_margin, column_gap, right_margin, top_margin, row_gap = 0.75, 0.75, 0.15, 0.35, 0.85
    width = (_WIDTH - left_margin - right_margin - (columns - 1) * column_gap) / columns
    height = 0.72 * width
    height_of_figure = top_margin + rows * height + (rows - 1) * row_gap + bottom_margin
    drawing.set_size_inches(_WIDTH, height_of_figure)
    drawing.subplots_adjust(
        left=left_margin / _WIDTH,
        right=1 - right_margin / _WIDTH,
        top=1 - top_margin / height_of_figure,
        bottom=bottom_margin / height_of_figure,
        wspace=column_gap / width,
        hspace=row_gap / height,
    )
    for axes in drawing.subplots(rows, columns, squeeze=False).ravel():
        axes.set_visible(False)
        yield axes


def _name_models(drawing: Drawing, figure: Figure) -> None:
    """Add a legend of the models below, and of the cases if all panels have the same."""
    from matplotlib.lines import Line2D

    lines = [line for panel in figure.panels for line in panel.lines]
    if not lines:
        return
    models, cases = (
        list(dict.fromkeys(names)) for names in zip(*((line.model, line.case) for line in lines), strict=True)
    )
    styles = {model: _style(model) if len(cases) == 1 else {**_style(model), "color": "0.3"} for model in models}
    if len(cases) > 1 and _have_same_cases(figure.panels):
        styles |= {case: {"color": colour, "linewidth": 4.0} for case, colour in _case_colours(cases).items()}
    handles = [Line2D([], [], label=name, **style) for name, style in styles.items()]
    drawing.legend(handles=handles, loc="lower center", ncols=min(len(handles), 8), **LEGEND)


def _have_same_cases(panels: Sequence[Panel]) -> bool:
    """Return whether all panels have the same cases."""
    return len({frozenset(line.case for line in panel.lines) for panel in panels}) == 1


def _draw_panel(axes: Axes, panel: Panel) -> None:
    """Draw the lines of a panel."""
    cases = list(dict.fromkeys(line.case for line in panel.lines))
    for line in panel.lines:
        colour = {} if len(cases) == 1 else {"color": _case_colours(cases)[line.case]}
        axes.plot(line.x, line.y, **{**_style(line.model), **colour})
    finish(axes, panel.x, panel.y)
    axes.locator_params(nbins=5)
    axes.set_title(panel.title, fontsize=10)
    _limit(axes, panel)


def _limit(axes: Axes, panel: Panel) -> None:
    """Start axes at zero where the lines nearly do, and cut off values beyond the panel."""
    lines = [line for line in panel.lines if line.model != "hertz"]
    longest = max(line.x[-1] for line in lines)
    if min(line.x[0] for line in panel.lines) < 0.1 * longest:
        axes.set_xlim(left=0.0)
    if panel.highest is not None:
        axes.set_ylim(0.0, panel.highest)
        axes.set_xlim(0.0, 1.15 * longest)
    else:
        axes.set_ylim(0.0, 1.1 * max(max(line.y) for line in lines))


def _name_cases(axes: Axes, panel: Panel) -> None:
    """Add a legend of the cases to a panel."""
    from matplotlib.lines import Line2D

    cases = dict.fromkeys(line.case for line in panel.lines)
    handles = [Line2D([], [], label=case, color=colour) for case, colour in _case_colours(list(cases)).items()]
    axes.legend(handles=handles, frameon=False, fontsize=8)


def _case_colours(cases: Sequence[str]) -> dict[str, Any]:
    """Return a colour for each case, from dark to light, distinguishable in grey."""
    from matplotlib import colormaps

    return dict(zip(cases, colormaps["viridis"](numpy.linspace(0.0, 0.82, len(cases))), strict=True))


def _style(model: str) -> dict[str, Any]:
    """Return the line style of a model; circles for the finite elements, which coincide with other lines."""
    style = in_matplotlib(line_of(_MODELS.get(model, model)), 1.6)
    if model != ELEMENTS:
        return style
    return {**style, "linestyle": "", "marker": "o", "markersize": 3.5, "markerfacecolor": "none", "markevery": 3}


def _draw_map(axes: Axes, field: Map) -> None:
    """Draw filled contours of a map with numbers on its lines."""
    values = numpy.array([[numpy.nan if value is None else value for value in row] for row in field.z], dtype=float)
    colours = _about_zero() if field.about_zero else {"cmap": "viridis", "levels": 9}
    filled = axes.contourf(field.x, field.y, values, **colours)
    lines = axes.contour(field.x, field.y, values, levels=filled.levels, colors="black", linewidths=0.5, linestyles="-")
    for text in axes.clabel(lines, fontsize=7):
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.6})
    radius = numpy.array(field.x)
    for outer in OUTER_RADII:
        axes.plot(radius, outer - radius, color="black", linestyle=":", linewidth=1.5)
    axes.set_ylim(field.y[0], field.y[-1])
    axes.set_xlabel(field.x_label)
    axes.set_ylabel(field.y_label)
    axes.set_title(field.title, fontsize=10)


_ENDS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
_LEVELS = (*(-end for end in reversed(_ENDS)), *_ENDS)


def _about_zero() -> dict[str, Any]:
    """Return contour levels that all maps share, so that a colour means the same error in each."""
    from matplotlib.colors import SymLogNorm

    norm = SymLogNorm(linthresh=1.0, vmin=-300.0, vmax=300.0)
    return {"levels": _LEVELS, "cmap": "RdBu_r", "norm": norm, "extend": "both"}


def heat_map(rows: Sequence[Mapping[str, Any]]) -> Drawing:
    """Draw the errors of every model by quantity; the colour is the 95th percentile."""
    from matplotlib.colors import LogNorm
    from matplotlib.figure import Figure as Drawing

    errors = [[row["errors"][name] for name in HEADS] for row in rows]
    high = numpy.array([[100 * error["percentile_95"] for error in line] for line in errors])
    figure = Drawing(figsize=(8.6, 0.42 * len(rows) + 1.3), layout="constrained")
    axes = figure.subplots()
    norm = LogNorm(*_HEAT_ENDS)
    image = axes.imshow(high, cmap="YlOrRd", norm=norm, aspect="auto")
    for i, line in enumerate(errors):
        for j, error in enumerate(line):
            dark = norm(high[i, j]) > _DARK
            axes.text(j, i, spread(error), ha="center", va="center", fontsize=8.5, color="white" if dark else "black")
    axes.set_xticks(range(len(HEADS)), list(HEADS.values()))
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(rows)), [row["model"] for row in rows])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    bar = figure.colorbar(image, ax=axes, extend="both", pad=0.01)
    bar.set_label("95th percentile [%]")
    axes.set_xlabel("median / 95th percentile / worst error in %")
    return figure


_HEAT_ENDS = (0.1, 300.0)  # %
_DARK = 0.72  # of the colours
