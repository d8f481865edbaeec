"""Registration of the plots that contacts, comparisons and studies provide as methods and attributes."""

from __future__ import annotations

from collections.abc import Callable

from ..core.plotting import Plot, register_plot

STUDY_PLOTS = ("band_figure", "design_map", "front_figure", "sensitivity_figure")
"""Plots that `ballsocket.studies` offers."""


def register_plots() -> None:
    """Register the plots of this room; matplotlib is imported when the first of them is loaded."""
    register_plot("contacts", _load_contact_plot)
    for name in STUDY_PLOTS:
        register_plot(name, _study_plot_loader(name))


def _load_contact_plot() -> Plot:
    """Import and return the plot of contacts."""
    from .press_plots import plot

    return plot


def _study_plot_loader(name: str) -> Callable[[], Plot]:
    """Make a function that imports a plot of studies by its name."""

    def load() -> Plot:
        """Import and return the plot."""
        from . import study_plots

        plot: Plot = getattr(study_plots, name)
        return plot

    return load
