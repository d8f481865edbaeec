"""Style of all figures: line of each model, labels, grids."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any
from zlib import crc32

import numpy

from ..core.unit_systems import Units
from .figure_files import figure_bytes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK = "black"  # colour of text; a light one on a dark page

BLUE, VERMILLION, GREEN, PINK, SKY, ORANGE, GREY = (
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#56B4E9",
    "#E69F00",
    "#999999",
)
"""Colours of Okabe and Ito, distinguishable with colour blindness, and a grey."""

_COLOURS = (BLUE, VERMILLION, GREEN, PINK, SKY, ORANGE, GREY)

# lengths of ink and gap in line widths; they distinguish curves in grey
_THROUGH = ()
_LONG, _SHORT, _DOTS = (6.0, 2.0), (2.0, 1.5), (1.0, 1.0)
_DOT, _TWO_DOTS, _EVEN = (7.0, 2.0, 1.5, 2.0), (4.0, 1.5, 1.0, 1.5, 1.0, 1.5), (4.0, 4.0)
_DASHES = (_THROUGH, _LONG, _SHORT, _DOT, _TWO_DOTS, _DOTS, _EVEN)

THICK, THIN = 2.0, 1.0  # line widths of a valid and of an invalid contact, in points or in pixels of a browser


@dataclass(frozen=True)
class LineStyle:
    """Colour and dashes of a curve; dash lengths of ink and gap in line widths, none for a solid line."""

    colour: str
    dash: tuple[float, ...] = ()


_MODELS = {  # related models share a colour and differ by their dashes
    "exact": LineStyle(INK),
    "tabulated": LineStyle(GREY, _SHORT),
    "fem": LineStyle(PINK, _EVEN),
    "sphere": LineStyle(BLUE, _LONG),
    "refined": LineStyle(ORANGE, _DOTS),
    "hess-forsbach": LineStyle(VERMILLION, _LONG),
    "adhesive": LineStyle(VERMILLION, _DOTS),
    "vessel": LineStyle(BLUE, _DOT),
    "bartel": LineStyle(BLUE, _SHORT),
    "bonded-layer": LineStyle(GREEN, _DOT),
    "bonded-layer-exact": LineStyle(GREEN, _SHORT),
    "hertz": LineStyle(SKY, _TWO_DOTS),
    "steuermann": LineStyle(SKY, _LONG),
    "plane-layer": LineStyle(GREEN, _TWO_DOTS),
    "cosine-limit": LineStyle(PINK, _DOTS),
    "liu-reconstruction": LineStyle(GREY, _TWO_DOTS),
}

# styles of other models: dashes that the catalogue uses only for the exact solution and the finite elements
_SPARE = [LineStyle(*pair) for pair in product(_COLOURS, (_THROUGH, _EVEN))]
_FREE = [line for line in _SPARE if line not in _MODELS.values()]


def line_of(model: str) -> LineStyle:
    """Return the line style of a model by name; an unknown name gets the same style in every figure."""
    return _MODELS[model] if model in _MODELS else _FREE[crc32(model.encode()) % len(_FREE)]


def numbered(index: int) -> LineStyle:
    """Return the line style of one of several cases, by index."""
    return LineStyle(_COLOURS[index % len(_COLOURS)], _DASHES[(index + index // len(_COLOURS)) % len(_DASHES)])


def in_matplotlib(line: LineStyle, width: float = THICK) -> dict[str, Any]:
    """Convert a line style to arguments of matplotlib; solid lines are drawn below dashed ones."""
    dash, below = ((0, line.dash), 0.0) if line.dash else ("-", 0.1)
    return {"color": line.colour, "linestyle": dash, "linewidth": width, "zorder": 2.0 - below}


LEGEND: dict[str, Any] = {"frameon": False, "fontsize": 9, "handlelength": 3.4}
"""Arguments of legends; the handle shows a complete dash."""


def finish(axes: Axes, x: str, y: str) -> None:
    """Add labels and a light grid, and remove the frame."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(color="0.9", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def in_units(figure: Figure, units: Units) -> Figure:
    """Write axes, colour bars and sentences of a figure that is drawn in mm, N and MPa in another system of units."""
    from matplotlib.text import Text
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    class ScaledLocator(MaxNLocator):
        """Ticks at round numbers of another unit, `factor` of which are one of the axis."""

        def __init__(self, factor: float) -> None:
            super().__init__(nbins="auto", steps=[1, 2, 2.5, 5, 10])
            self.factor = factor

        def tick_values(self, vmin: float, vmax: float) -> Any:
            return numpy.asarray(super().tick_values(vmin * self.factor, vmax * self.factor)) / self.factor

    if units is Units.SI:
        return figure
    for text in figure.findobj(Text):
        text.set_text(units.sentence(text.get_text()))
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            label, factor = units.axis(axis.get_label_text())
            if label != axis.get_label_text():
                axis.set_label_text(label)
                axis.set_major_locator(ScaledLocator(factor))
                axis.set_major_formatter(FuncFormatter(lambda value, _, factor=factor: f"{value * factor:.4g}"))
    return figure


def bytes_by_units(figure: Figure, form: str = "png") -> dict[Units, bytes]:
    """Return a figure in mm, N and MPa as bytes in each system of units."""
    return {units: figure_bytes(in_units(figure, units), form) for units in Units}  # the metric one comes first


def new_figure(width: float, height: float) -> Figure:
    """Create a figure whose layout fits its labels; width and height are in inches."""
    from .notebook_figure import NotebookFigure

    return NotebookFigure(figsize=(width, height), layout="constrained")


def single_axes(width: float = 6.4, height: float = 4.2) -> tuple[Figure, Axes]:
    """Create a figure with one pair of axes; width and height are in inches."""
    figure = new_figure(width, height)
    return figure, figure.subplots()
