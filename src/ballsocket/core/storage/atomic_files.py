"""Atomic writing: a file or folder appears complete under its name, or not at all."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryDirectory

try:
    import fcntl
except ImportError:  # Windows: draft folders of killed processes are not removed
    fcntl = None  # type: ignore[assignment]

_DRAFT_SUFFIX = ".draft"

_PREFIX_LENGTH = 40
"""Characters of the final name in the name of its draft folder, which keeps that below the system's limit."""

_MIN_AGE = 60.0
"""Age in s below which an unlocked draft folder is not removed: its process may be about to lock it."""


def is_draft_folder(name: str) -> bool:
    """Check if a name has the form of a draft folder."""
    return name.startswith(".") and name.endswith(_DRAFT_SUFFIX)


def check_parent_folder(path: Path) -> None:
    """Check that a path is local and that its parent folder exists; raise ValueError otherwise."""
    check_local(path)
    if not path.parent.is_dir():
        raise ValueError(f"cannot write {path.name}: {str(path.parent)!r} is not a folder; create it first")


# a drive of Windows has a single letter
_ADDRESS = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):/+(.*)", re.DOTALL)


def address_of(path: str | Path) -> str | None:
    """Return the address of a file in a remote store, such as "s3://bucket/file"; None for a local path.

    A `Path` has lost one slash of its address, which is restored.

    Examples
    --------
    >>> address_of(Path("s3://bucket/hips.zarr")), address_of("hips.zarr")
    ('s3://bucket/hips.zarr', None)
    """
    match = _ADDRESS.fullmatch(path.as_posix() if isinstance(path, Path) else path)
    if match is None:
        return None
    scheme, rest = match.groups()
    return f"{scheme}:///{rest}" if scheme == "file" else f"{scheme}://{rest}"


def check_local(path: str | Path) -> None:
    """Check that a path is local; raise ValueError for the address of a remote store."""
    address = address_of(path)
    if address is not None:
        raise ValueError(f"{address!r} is the address of a remote store: use a local file or folder, and copy it")


@contextmanager
def write_atomically(path: Path) -> Iterator[Path]:
    """Yield a draft path to write to, and move the draft to `path` at the end.

    An error in the block discards the draft. The draft has the same file name.

    The draft is a file or a folder.

    Raises
    ------
    OSError
        The folder is not writable or the disk is full. The error names `path`.
    """
    with make_draft_folder(path) as folder:
        draft = folder / path.name
        try:
            yield draft
            os.replace(draft, path)
        except OSError as error:
            if error.errno is None or error.filename not in (None, str(draft)):
                raise
            raise OSError(error.errno, error.strerror, str(path)) from error


@contextmanager
def make_draft_folder(path: Path) -> Iterator[Path]:
    """Make a temporary draft folder in the parent folder of `path`, until the end of the block.

    Draft folders of killed processes are removed first.

    Raises
    ------
    ValueError
        The address of a remote store.
    OSError
        The parent folder is not writable. The error names `path`.
    """
    check_local(path)
    prefix = f".{path.name[:_PREFIX_LENGTH]}."
    with suppress(OSError):
        for folder in path.parent.iterdir():
            if folder.name.startswith(prefix) and is_draft_folder(folder.name) and _is_abandoned_draft(folder):
                rmtree(folder, ignore_errors=True)
    try:
        temporary_folder = TemporaryDirectory(prefix=prefix, suffix=_DRAFT_SUFFIX, dir=path.parent)
    except OSError as error:  # the error names the path of the caller instead of the draft folder
        raise OSError(error.errno, error.strerror, str(path)) from error
    with temporary_folder as name, _lock_folder(Path(name)):
        yield Path(name)


@contextmanager
def _lock_folder(folder: Path) -> Iterator[bool]:
    """Lock a folder until the end of the block, and yield True; yield False if this is impossible."""
    if fcntl is None:
        yield False
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield True
    except BlockingIOError:
        yield False
    finally:
        os.close(descriptor)


def _is_abandoned_draft(folder: Path) -> bool:
    """Check if the process that made a draft folder has ended."""
    with _lock_folder(folder) as locked:
        return locked and time.time() - folder.stat().st_mtime > _MIN_AGE


def write_text(path: Path, text: str, encoding: str = "utf-8") -> Path:
    """Write a text file atomically, and return its path.

    Raises
    ------
    OSError
        The folder is not writable or the disk is full.
    """
    with write_atomically(path) as draft:
        draft.write_text(text, encoding=encoding)
    return path
