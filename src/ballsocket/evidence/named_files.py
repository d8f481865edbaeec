"""The files that a file names: what has to come along so that it can be read elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..checks import shown
from ..io.toml import read_toml

_MOST = 50


def files_of(path: Path) -> tuple[Path, ...]:
    """A TOML file, the files in its folder that it names, and those that these name.

    Raises
    ------
    ValueError
        A name that leads out of the folder; too many files.
    """
    found, left = {path: None}, [path]
    while left:
        here = left.pop()
        for text in _texts(read_toml(here, "question", dict)):
            there = here.parent / text
            if len(text) < 200 and there.is_file() and there not in found:
                _check_inside(text)
                found[there] = None
                left += [there] if there.suffix == ".toml" else []
        if len(found) > _MOST:
            raise ValueError(f"{path.name} and what it names are more than {_MOST} files")
    return tuple(found)


def _check_inside(text: str) -> None:
    if Path(text).is_absolute() or ".." in Path(text).parts:
        raise ValueError(f"{shown(text)} lies outside the folder of its file: put it beside that")


def _texts(part: Any) -> Iterator[str]:
    """Every text in the tables of a file that may be a file's name."""
    if isinstance(part, dict):
        for each in part.values():
            yield from _texts(each)
    elif isinstance(part, list):
        for each in part:
            yield from _texts(each)
    elif isinstance(part, str) and part.strip() and "\0" not in part and "\n" not in part:
        yield part
