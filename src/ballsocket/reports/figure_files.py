"""Figures as files and as bytes, and their registration as methods of results."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.display import PLOTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = (".png", ".svg", ".pdf")  # endings of the files that `save` writes


def check_format(*paths: Path | None) -> None:
    """Check that each path ends in .png, .svg or .pdf and that its folder exists; None is no figure.

    Raises ValueError: another ending, or a folder that does not exist.
    """
    given = [path for path in paths if path is not None]
    if not given:
        return
    from ..core.storage.atomic_files import check_ending  # a press without a figure does without it

    for path in given:
        check_ending("figure", path, *FORMATS)


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure as PNG, SVG or PDF, according to the ending of `path`; after an error there is no file.

    Raises ValueError: another ending, or a folder that does not exist.
    Raises OSError: the path cannot be written to.
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


_PLOTS = {
    "band_figure": "study_plots:band_figure",
    "contacts": "press_plots:plot",
    "cycle_film": "film_results:cycle_film_figure",
    "design_map": "study_plots:design_map",
    "film": "film_results:film_figure",
    "front_figure": "study_plots:front_figure",
    "identification": "identify_results:fit_figure",
    "sensitivity_figure": "study_plots:sensitivity_figure",
    "wear": "hip_comparison:wear_figure",
}
"""Module and function of each registered plot by its name."""


def register_plots() -> None:
    """Register the plots of this room; matplotlib is imported when the first of them is loaded."""
    PLOTS.update((name, f"{__package__}.{function}") for name, function in _PLOTS.items())
