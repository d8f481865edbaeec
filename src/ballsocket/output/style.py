"""How things are drawn, everywhere: the line of each model, labels, grids."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# Okabe & Ito's colours, safe for the colour-blind; the dashes keep the curves apart in grey
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#999999")


_DASHES: tuple[Any, ...] = ("-", (0, (6, 2)), (0, (2, 1.5)), (0, (7, 2, 1.5, 2)), (0, (4, 1.5, 1, 1.5, 1, 1.5)))


REFERENCE_STYLE = {"color": "black", "linestyle": "-", "linewidth": 2.0}


def style(index: int, valid: bool) -> dict[str, Any]:
    return {
        "color": COLOURS[index % len(COLOURS)],
        "linestyle": _DASHES[(index + index // len(COLOURS)) % len(_DASHES)],
        "linewidth": 2.0 if valid else 1.0,
    }


def finish(axes: Axes, x: str, y: str) -> None:
    """Labels, a light grid, and no frame."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(color="0.9", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
