"""Access to input files: every reader opens the files of users here.

A server restricts its processes to certain folders by the environment variable of `restriction_variables`. Child
processes inherit this variable. The command line reads any file of its user.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from io import BufferedReader, FileIO
from pathlib import Path
from typing import Any, BinaryIO

from .checks import shown
from .display import counted

_MAX_FILES = 50
_VARIABLE = "BALLSOCKET_INPUT_FOLDERS"
_opened: ContextVar[list[Path] | None] = ContextVar("opened_inputs", default=None)


def resolve_inside(folders: Iterable[Path], path: Path, name: str) -> Path:
    """Resolve symbolic links and ".." in a path, and check that it lies in folders without symbolic links.

    `name` replaces the path in the message.

    Raises ValueError: a path outside the folders.
    """
    resolved = resolve_path(path)
    if not any(resolved.is_relative_to(folder) for folder in folders):
        raise ValueError(f"{shown(name)} lies outside the folder of this server: name a file in that folder")
    return resolved


def restriction_variables(folders: Iterable[Path]) -> Mapping[str, str]:
    """Return the environment variables that restrict a process and its children to some input folders."""
    return {_VARIABLE: json.dumps([str(resolve_path(folder)) for folder in folders])}


def is_restricted() -> bool:
    """Return True in a process that a server restricts to certain folders."""
    return _VARIABLE in os.environ


def resolve_input(path: Path) -> Path:
    """Resolve the path of an input file, and check that it lies in the allowed folders.

    The file is not accessed.

    Raises ValueError: a path outside the allowed folders.
    """
    allowed = os.environ.get(_VARIABLE)
    if allowed is None:
        return path
    return resolve_inside(map(Path, json.loads(allowed)), path, str(path))


def open_input(path: Path) -> BinaryIO:
    """Open an input file for reading bytes.

    Raises ValueError: a path from which this process may not read, or no regular file there.
    Raises OSError: the file cannot be read.
    """
    resolved = resolve_input(path)
    if is_restricted() and resolved.exists() and not resolved.is_file():
        raise ValueError(f"{shown(str(path))} is not a regular file")
    stream = BufferedReader(_NamedFile(resolved))
    opened = _opened.get()
    if opened is not None and path not in opened:
        opened.append(path)
    return stream


def read_input(path: Path, max_bytes: int) -> bytes:
    """Read an input file of limited size.

    Raises ValueError: a larger file, or one that `open_input` refuses.
    Raises OSError: the file cannot be read.
    """
    with open_input(path) as stream:
        raw = stream.read(max_bytes + 1)
    if len(raw) > max_bytes:
        raise ValueError(f"{path.name} has more than {max_bytes // 1_000_000} MB, the most that is read")
    return raw


class _NamedFile(FileIO):
    """Raw input file whose errors name it: those of a read have no path."""

    def readinto(self, buffer: Any) -> int | None:
        with self._named_errors():
            return super().readinto(buffer)

    def readall(self) -> bytes:
        with self._named_errors():
            return super().readall()

    @contextmanager
    def _named_errors(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            error.filename = error.filename or str(self.name)
            raise


@contextmanager
def record_inputs() -> Iterator[list[Path]]:
    """Record the path of each input file that is opened within the block."""
    opened: list[Path] = []
    token = _opened.set(opened)
    try:
        yield opened
    finally:
        _opened.reset(token)
        outer = _opened.get()
        if outer is not None:
            outer += [path for path in opened if path not in outer]


def resolve_path(path: Path) -> Path:
    """Resolve symbolic links and ".." in a path; raise ValueError if the system cannot."""
    try:
        return path.resolve()
    except (OSError, RuntimeError) as error:  # a circle of links, a name that is too long
        raise ValueError(f"{shown(str(path))} cannot be resolved: {error}") from error


def packed_files(main: Path, opened: Iterable[Path]) -> tuple[Path, ...]:
    """Check the files that an input file opened, and return them with the input file first.

    Raises ValueError: a file outside the folder of the input file; too many files.
    """
    files = tuple(dict.fromkeys((main, *opened)))
    for path in files:
        if not path.is_relative_to(main.parent) or ".." in path.relative_to(main.parent).parts:
            raise ValueError(f"{shown(str(path))} lies outside the folder of {main.name}: put it beside that file")
    if len(files) > _MAX_FILES:
        raise ValueError(f"{main.name} names {counted(len(files) - 1, 'file')}: at most {_MAX_FILES - 1} are allowed")
    return files
