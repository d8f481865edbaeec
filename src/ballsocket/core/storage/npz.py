"""Named arrays on disk, in NumPy's own format: written whole, checked when read."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, BinaryIO
from zipfile import BadZipFile, ZipFile

import numpy

from ..arrays import Numbers
from ..input_files import open_input
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
        with open_input(path) as stream:
            with ZipFile(stream) as archive:
                damaged = archive.testzip()  # NumPy accepts a damaged, smaller shape without this test
                members = len(archive.infolist())
            if damaged is not None or members != _count_of(stream):
                raise ValueError(f"{path.name} is damaged")
            stream.seek(0)
            with numpy.load(stream, allow_pickle=False) as file:
                return {name: file[name] for name in file.files}
    except (BadZipFile, EOFError, KeyError, RuntimeError) as error:
        raise ValueError(f"{path.name} is damaged") from error


def _count_of(stream: BinaryIO) -> int:
    """Read the number of members from the end record of an archive; a damaged directory lists fewer."""
    stream.seek(-_END, os.SEEK_END)
    return int.from_bytes(stream.read(_END)[10:12], "little")


_END = 22
"""Length in bytes of the end record of an archive without a comment."""
