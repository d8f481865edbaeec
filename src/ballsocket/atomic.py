"""Files that appear whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory


@contextmanager
def at_once(path: Path) -> Iterator[Path]:
    """A place beside `path` to write to, with its name; what was written there becomes `path` when all went well.

    Raises
    ------
    OSError
        A folder that cannot be written to.
    """
    with TemporaryDirectory(dir=path.parent) as folder:
        draft = Path(folder) / path.name
        yield draft
        os.replace(draft, path)


def write_text(path: Path, text: str, encoding: str = "utf-8") -> Path:
    """Write a text file at once; returns its path."""
    with at_once(path) as draft:
        draft.write_text(text, encoding=encoding)
    return path
