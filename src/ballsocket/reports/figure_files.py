"""Figures as files and as bytes, and their registration as methods of results."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.display import Plot, register_plot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = ("png", "svg", "pdf")
"""Endings of the files that `save` writes."""


def check_format(path: Path) -> None:
    """Check that a path ends in .png, .svg or .pdf and that its folder exists.

    Raises
    ------
    ValueError
        Another ending, or a folder that does not exist.
    """
    from ..core.storage.atomic_files import check_parent_folder

    if path.suffix.lower().lstrip(".") not in FORMATS:
        raise ValueError(f"figure {str(path)!r} must end in {', '.join('.' + name for name in FORMATS)}")
    check_parent_folder(path)


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure as PNG, SVG or PDF, according to the ending of `path`; after an error there is no file.

    Raises
    ------
    ValueError
        Another ending, or a folder that does not exist.
    OSError
        The path cannot be written to.
    """
    from ..core.storage.atomic_files import write_atomically

    path = Path(path)
    check_format(path)
    with write_atomically(path) as draft:
        figure.savefig(draft, dpi=160)


def figure_bytes(figure: Figure, form: str = "png") -> bytes:
    """Return a figure as PNG or SVG bytes, reproducible with the same libraries."""
    from matplotlib import rc_context

    stream = BytesIO()
    metadata = {"Date": None} if form == "svg" else None
    with rc_context({"svg.hashsalt": "ballsocket"}):
        figure.savefig(stream, format=form, dpi=140, metadata=metadata)
    return stream.getvalue()


@contextmanager
def default_style() -> Iterator[None]:
    """Draw with the default style of matplotlib, independent of user settings."""
    from matplotlib import rc_context, rcdefaults

    with rc_context():
        rcdefaults()
        yield


STUDY_PLOTS = ("band_figure", "design_map", "front_figure", "sensitivity_figure")
"""Plots that `ballsocket.studies` offers."""


def register_plots() -> None:
    """Register the plots of this room; matplotlib is imported when the first of them is loaded."""
    register_plot("contacts", _load_contact_plot)
    register_plot("cycle_film", _load_cycle_film_figure)
    register_plot("film", _load_film_figure)
    register_plot("identification", _load_fit_figure)
    register_plot("wear", _load_wear_figure)
    for name in STUDY_PLOTS:
        register_plot(name, _study_plot_loader(name))


def _load_contact_plot() -> Plot:
    """Import and return the plot of contacts."""
    from .press_plots import plot

    return plot


def _load_cycle_film_figure() -> Plot:
    """Import and return the figure of a film over a cycle."""
    from .film_results import cycle_film_figure

    return cycle_film_figure


def _load_film_figure() -> Plot:
    """Import and return the figure of lubricating films."""
    from .film_results import film_figure

    return film_figure


def _load_fit_figure() -> Plot:
    """Import and return the plot of identifications."""
    from .identify_results import fit_figure

    return fit_figure


def _load_wear_figure() -> Plot:
    """Import and return the plot of wear simulations."""
    from .hip_comparison import wear_figure

    return wear_figure


def _study_plot_loader(name: str) -> Callable[[], Plot]:
    """Make a function that imports a plot of studies by its name."""

    def load() -> Plot:
        """Import and return the plot."""
        from . import study_plots

        plot: Plot = getattr(study_plots, name)
        return plot

    return load
