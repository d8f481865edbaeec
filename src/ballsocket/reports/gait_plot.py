"""Courses over a cycle become a picture: one panel each, over the same phases."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from ..core.arrays import Numbers
from .style import BLUE

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def course_figure(phase: Numbers, courses: Mapping[str, Numbers], title: str) -> Figure:
    """Panels below each other, each with one course over the cycle.

    Parameters
    ----------
    phase : array (instants,)
        In % of the cycle.
    courses : mapping of str to array (instants,)
        By the labels of their axes; NaN where there is none.
    title : str

    Returns
    -------
    matplotlib.figure.Figure
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 1.6 * len(courses) + 0.9), layout="constrained")
    panels = figure.subplots(len(courses), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (label, values) in zip(panels, courses.items(), strict=True):
        axes.plot(phase, values, color=BLUE)
        axes.set_ylabel(label)
        axes.set_ylim(bottom=0)
        axes.grid(color="0.9", linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
    panels[-1].set_xlabel("% of the cycle")
    figure.suptitle(title, fontsize=10, parse_math=False)
    return figure
