"""Named arrays on disk, in NumPy's own format: written whole, checked when read."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

import numpy

from .arrays import Numbers
from .atomic import at_once


def write_arrays(path: Path, **named: Any) -> None:
    """Write arrays, numbers and texts; each has its checksum in the file.

    Raises
    ------
    OSError
        A folder that cannot be written to.
    """
    with at_once(path) as draft, draft.open("wb") as stream:
        numpy.savez(stream, **named)


def read_arrays(path: Path) -> dict[str, Numbers]:
    """What was written, by name.

    Raises
    ------
    ValueError
        What is no such file, or damaged.
    OSError
        There is none, or it cannot be read.
    """
    try:
        with ZipFile(path) as whole:
            damaged = whole.testzip()  # NumPy alone believes a damaged shape that is smaller
        if damaged is not None:
            raise ValueError(f"{path.name} is damaged")
        with numpy.load(path, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (BadZipFile, EOFError, KeyError, RuntimeError) as error:
        raise ValueError(f"{path.name} is damaged") from error
