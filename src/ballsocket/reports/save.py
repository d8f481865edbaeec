"""Figures as files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..core.storage.atomic_files import check_parent_folder, write_atomically

if TYPE_CHECKING:
    from matplotlib.figure import Figure


FORMATS = ("png", "svg", "pdf")


def check_format(path: Path) -> None:
    """Raise ValueError unless `path` ends in .png, .svg or .pdf, in a folder that is there."""
    if path.suffix.lower().lstrip(".") not in FORMATS:
        raise ValueError(f"figure {str(path)!r} must end in {', '.join('.' + name for name in FORMATS)}")
    check_parent_folder(path)


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure as PNG, SVG or PDF, by the ending of `path`; one that cannot be drawn leaves no file.

    Raises
    ------
    ValueError
        Another ending, or a folder that is not there.
    OSError
        A path that cannot be written to.
    """
    path = Path(path)
    check_format(path)
    with write_atomically(path) as draft:
        figure.savefig(draft, dpi=160)
