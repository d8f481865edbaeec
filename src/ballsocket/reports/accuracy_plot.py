"""The accuracy of the catalogue as a picture. Nothing is computed here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy

from .accuracy_table import HEADS, spread

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def heat_map(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Errors of every model by quantity, of `Accuracy.summary()`: the colour is the 95th percentile."""
    from matplotlib.colors import LogNorm
    from matplotlib.figure import Figure

    errors = [[row["errors"][name] for name in HEADS] for row in rows]
    high = numpy.array([[100 * error["percentile_95"] for error in line] for line in errors])
    figure = Figure(figsize=(8.6, 0.42 * len(rows) + 1.3), layout="constrained")
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
