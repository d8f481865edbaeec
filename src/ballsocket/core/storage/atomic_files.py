"""Files and folders that appear complete under their name or not at all: texts, named arrays, and a cache of arrays."""

from __future__ import annotations

import csv
import os
import re
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryDirectory
from typing import Any, BinaryIO
from zipfile import BadZipFile, ZipFile

import numpy

from ..arrays import Numbers
from ..input_files import open_input

try:
    import fcntl
except ImportError:  # Windows: draft folders of killed processes are not removed
    fcntl = None  # type: ignore[assignment]

_DRAFT_SUFFIX = ".draft"

_PREFIX_LENGTH = 40
"""Characters of the final name in the name of its draft folder, which keeps that below the system's limit."""

_MIN_AGE = 60.0  # age in s below which an unlocked draft folder is not removed: its process may be about to lock it


def is_draft_folder(name: str) -> bool:
    """Check if a name has the form of a draft folder."""
    return name.startswith(".") and name.endswith(_DRAFT_SUFFIX)


def check_parent_folder(path: Path) -> None:
    """Check that a path is local and that its parent folder exists; raise ValueError otherwise."""
    check_local(path)
    if not path.parent.is_dir():
        raise ValueError(f"cannot write {path.name}: {str(path.parent)!r} is not a folder; create it first")


def check_ending(noun: str, path: Path, *endings: str) -> None:
    """Check that a path has one of the endings, and that its parent folder exists.

    Raises ValueError: another ending, in a message that begins with the noun, or a folder that does not exist.
    """
    if path.suffix.lower() not in endings:
        allowed = (" or " if len(endings) == 2 else ", ").join(endings)
        raise ValueError(f"{noun} {str(path)!r} must end in {allowed}".strip())
    check_parent_folder(path)


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


def make_folder(path: Path) -> None:
    """Create a local folder and its parents unless they exist; raise ValueError for the address of a remote store."""
    check_local(path)
    path.mkdir(parents=True, exist_ok=True)


@contextmanager
def write_atomically(path: Path) -> Iterator[Path]:
    """Yield a draft path to write to, and move the draft to `path` at the end.

    The draft is a file or a folder of the same name. An error in the block discards it.

    Raises OSError: the folder is not writable or the disk is full. The error names `path`.
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

    Raises ValueError: the address of a remote store.
    Raises OSError: the parent folder is not writable. The error names `path`.
    """
    check_local(path)
    prefix = f".{path.name[:_PREFIX_LENGTH]}."
    with suppress(OSError):
        for folder in path.parent.iterdir():
            if folder.name.startswith(prefix) and is_draft_folder(folder.name):
                with _lock_folder(folder) as locked:
                    is_abandoned = locked and time.time() - folder.stat().st_mtime > _MIN_AGE
                if is_abandoned:
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


def write_text(path: Path, text: str, encoding: str = "utf-8") -> Path:
    """Write a text file, and return its path; errors as of `write_atomically`."""
    with write_atomically(path) as draft:
        draft.write_text(text, encoding=encoding)
    return path


def write_csv(path: Path, rows: Iterable[Iterable[Any]]) -> Path:
    """Write rows as CSV atomically, and return its path; see `write_text`."""
    with write_atomically(path) as draft, draft.open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream, lineterminator="\n").writerows(rows)
    return path


_END_RECORD_LENGTH = 22  # length in bytes of the end record of a zip archive without a comment
_CACHE_VERSION = 3  # version of the cached arrays: raise it when the elements or the rings of off-axis models change
_MAX_CACHE_SIZE = 2 * 2**30  # size in bytes of the cache folder above which the oldest files are removed


def write_arrays(path: Path, **arrays: Any) -> None:
    """Write named arrays, numbers and texts to an npz file, with checksums; errors as of `write_atomically`."""
    with write_atomically(path) as draft:
        draft.write_bytes(pack_arrays(**arrays))


def pack_arrays(**arrays: Any) -> bytes:
    """Return the content of an npz file with named arrays, numbers and texts, and checksums."""
    stream = BytesIO()
    numpy.savez(stream, **arrays)
    return stream.getvalue()


def read_arrays(path: Path) -> dict[str, Numbers]:
    """Read the arrays of an npz file by name; errors as of `open_input` and `unpack_arrays`."""
    with open_input(path) as stream:
        return unpack_arrays(stream, path.name)


def unpack_arrays(stream: BinaryIO, name: str) -> dict[str, Numbers]:
    """Read the arrays of an npz file by name, and verify their checksums.

    Raises ValueError: the file is damaged or is not an npz file; the message has its `name`.
    """
    try:
        with ZipFile(stream) as archive:
            damaged = archive.testzip()  # NumPy accepts a damaged, smaller shape without this test
            n_members = len(archive.infolist())
        stream.seek(-_END_RECORD_LENGTH, os.SEEK_END)  # a damaged archive lists fewer members than its end record
        if damaged is not None or n_members != int.from_bytes(stream.read(_END_RECORD_LENGTH)[10:12], "little"):
            raise ValueError(f"{name} is damaged")
        stream.seek(0)
        with numpy.load(stream, allow_pickle=False) as file:
            return {key: file[key] for key in file.files}
    except (BadZipFile, EOFError, KeyError, RuntimeError) as error:
        raise ValueError(f"{name} is damaged") from error


def cached_array(key: object, compute: Callable[[], Numbers]) -> Numbers:
    """Read an array from the cache folder; compute and store it if it is missing.

    Processes share the cache. A damaged file is replaced. If the folder is not writable, the array is only computed.
    The `repr` of the key, which has all inputs of the array, identifies the file.
    """
    path = _cached_path(key)
    with suppress(OSError, ValueError, KeyError):  # missing or damaged
        return read_arrays(path)["rings"]
    array = compute()
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_arrays(path, rings=array)
        size = 0
        for cached in sorted(path.parent.glob("cup-*"), key=lambda path: path.stat().st_mtime, reverse=True):
            size += cached.stat().st_size
            if size > _MAX_CACHE_SIZE:  # the oldest files go
                cached.unlink(missing_ok=True)
    return array


def is_array_cached(key: object) -> bool:
    """Return True if the cache folder has the array of these inputs."""
    return _cached_path(key).is_file()


def _cached_path(key: object) -> Path:
    return cache_folder() / f"cup-{sha256(f'{_CACHE_VERSION} {key!r}'.encode()).hexdigest()[:32]}.npz"


def cache_folder() -> Path:
    """Return the cache folder: BALLSOCKET_CACHE of the environment, or `ballsocket` in the user's cache folder."""
    folder = os.environ.get("BALLSOCKET_CACHE")
    if folder:
        return Path(folder)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "ballsocket"
