"""How things are drawn, everywhere: the line of each model, labels, grids."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any
from zlib import crc32

from ..core.deprecation import renamed_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK = "black"
"""The colour of text: on a dark page that is a light one."""

BLUE, VERMILLION, GREEN, PINK, SKY, ORANGE, GREY = (
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#56B4E9",
    "#E69F00",
    "#999999",
)
"""Okabe & Ito's colours, safe for the colour-blind, and a grey."""

_COLOURS = (BLUE, VERMILLION, GREEN, PINK, SKY, ORANGE, GREY)

# ink and gaps in widths of the line: they keep curves apart in grey
_THROUGH = ()
_LONG, _SHORT, _DOTS = (6.0, 2.0), (2.0, 1.5), (1.0, 1.0)
_DOT, _TWO_DOTS, _EVEN = (7.0, 2.0, 1.5, 2.0), (4.0, 1.5, 1.0, 1.5, 1.0, 1.5), (4.0, 4.0)
_DASHES = (_THROUGH, _LONG, _SHORT, _DOT, _TWO_DOTS, _DOTS, _EVEN)

THICK, THIN = 2.0, 1.0
"""Where a model can be trusted, and where not: in points, or in pixels of a browser."""


@dataclass(frozen=True)
class LineStyle:
    """How a curve is drawn: its colour, and lengths of ink and gap in widths of the line; none is drawn through."""

    colour: str
    dash: tuple[float, ...] = ()


_MODELS = {  # relatives share a colour, and differ by their dashes
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

# of the dashes that the catalogue leaves to the exact answer and the finite elements
_SPARE = [LineStyle(*pair) for pair in product(_COLOURS, (_THROUGH, _EVEN))]
_FREE = [line for line in _SPARE if line not in _MODELS.values()]


def line_of(model: str) -> LineStyle:
    """The line of a model, by its name: one that is not of the catalogue keeps a line of its own in every figure."""
    return _MODELS[model] if model in _MODELS else _FREE[crc32(model.encode()) % len(_FREE)]


def numbered(index: int) -> LineStyle:
    """The line of one of several cases that are no models."""
    return LineStyle(_COLOURS[index % len(_COLOURS)], _DASHES[(index + index // len(_COLOURS)) % len(_DASHES)])


def in_matplotlib(line: LineStyle, width: float = THICK) -> dict[str, Any]:
    """A line as Matplotlib takes it; one without gaps lies below those through which it can be seen."""
    dash, below = ((0, line.dash), 0.0) if line.dash else ("-", 0.1)
    return {"color": line.colour, "linestyle": dash, "linewidth": width, "zorder": 2.0 - below}


LEGEND: dict[str, Any] = {"frameon": False, "fontsize": 9, "handlelength": 3.4}
"""Long enough for a whole dash."""


def finish(axes: Axes, x: str, y: str) -> None:
    """Labels, a light grid, and no frame."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(color="0.9", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)


__getattr__ = renamed_names(__name__, {"Line": "LineStyle"})
