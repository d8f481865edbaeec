"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryDirectory

try:
    import fcntl
except ImportError:  # Windows: what a killed process left stays
    fcntl = None  # type: ignore[assignment]

_DRAFT = ".draft"
_SHORT = 40  # characters of a name, so that what is made of it is no longer than a name may be
_YOUNG = 60.0  # seconds


def is_draft(name: str) -> bool:
    """Check if a name is that of a draft folder from a killed process."""
    return name.startswith(".") and name.endswith(_DRAFT)


def check_folder(path: Path) -> None:
    """Raise ValueError where there is no folder to write a file into."""
    if not path.parent.is_dir():
        raise ValueError(f"{str(path.parent)!r} is no folder to write {path.name} into")


@contextmanager
def at_once(path: Path) -> Iterator[Path]:
    """A place beside `path` to write to, with its name; what was written there becomes `path` when all went well.

    Raises
    ------
    OSError
        A folder that cannot be written to, a disk that is full: of `path`.
    """
    with draft_folder(path) as folder:
        draft = folder / path.name
        try:
            yield draft
            os.replace(draft, path)
        except OSError as error:
            if error.errno is None or error.filename not in (None, str(draft)):
                raise
            raise OSError(error.errno, error.strerror, str(path)) from error


@contextmanager
def draft_folder(path: Path) -> Iterator[Path]:
    """A folder beside `path` that goes when it is left; those of processes that were killed go too.

    Raises
    ------
    OSError
        A folder that cannot be written to.
    """
    begin = f".{path.name[:_SHORT]}."
    with suppress(OSError):
        for old in path.parent.iterdir():
            if old.name.startswith(begin) and old.name.endswith(_DRAFT) and _forsaken(old):
                rmtree(old, ignore_errors=True)
    try:
        made = TemporaryDirectory(prefix=begin, suffix=_DRAFT, dir=path.parent)
    except OSError as error:  # of the name that was asked for, not of the draft's
        raise OSError(error.errno, error.strerror, str(path)) from error
    with made as folder, _locked(Path(folder)):
        yield Path(folder)


@contextmanager
def _locked(folder: Path) -> Iterator[bool]:
    """A lock that goes with the process that holds it, however that ends; false where another has it, or none can."""
    if fcntl is None:
        yield False
        return
    held = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield True
    except BlockingIOError:
        yield False
    finally:
        os.close(held)


def _forsaken(folder: Path) -> bool:
    """Whether nobody writes there any more; one that is young may be about to be locked."""
    with _locked(folder) as free:
        return free and time.time() - folder.stat().st_mtime > _YOUNG


def write_text(path: Path, text: str, encoding: str = "utf-8") -> Path:
    """Write a text file at once; returns its path."""
    with at_once(path) as draft:
        draft.write_text(text, encoding=encoding)
    return path
