"""Folders of stored results, on a local disk or at the address of a remote store that fsspec knows."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from errno import ENOENT
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ..arrays import Numbers
from ..checks import needs
from ..executors.processes import available_disk_space
from ..input_files import open_input
from .atomic_files import address_of, pack_arrays, unpack_arrays, write_atomically
from .pieces import PieceStore

_LOCAL = "file://"  # beginning of the address of a local file


class ResultFolder(ABC):
    """Base class of folders of stored results. A file appears complete or not at all."""

    @abstractmethod
    def __str__(self) -> str:
        """Return the path or the address, for messages."""

    @abstractmethod
    def exists(self) -> bool:
        """Return True if the folder exists, with any content."""

    @abstractmethod
    def names(self) -> set[str]:
        """Return the names of the files in the folder; none if it does not exist."""

    @abstractmethod
    def read(self, name: str, max_size: int | None = None) -> bytes:
        """Read a file, or its first `max_size` bytes.

        Raises OSError: the file does not exist or is not readable.
        """

    @abstractmethod
    def write_blocks(self, name: str, blocks: Iterable[bytes]) -> None:
        """Write or replace a file from blocks of its content; its folder is created if necessary.

        Raises OSError: the folder is not writable or the disk is full.
        """

    def write(self, name: str, content: bytes) -> None:
        """Write or replace a file; see `write_blocks`."""
        self.write_blocks(name, (content,))

    def write_arrays(self, name: str, **arrays: Any) -> None:
        """Write named arrays, numbers and texts to an npz file, with checksums; see `write_blocks`."""
        self.write(name, pack_arrays(**arrays))

    def read_arrays(self, name: str) -> dict[str, Numbers]:
        """Read the arrays of an npz file by name; errors as of `read` and `unpack_arrays`."""
        return unpack_arrays(BytesIO(self.read(name)), name)

    @abstractmethod
    def create(self, write: Callable[[Path], None]) -> None:
        """Create the folder from a draft that a function writes to a given path.

        Raises OSError: the folder is not writable or the disk is full.
        """

    @abstractmethod
    def free_space(self) -> float:
        """Return the free space in bytes; infinite if it is not known."""

    @abstractmethod
    def zarr_store(self) -> Any:
        """Return the folder as zarr and xarray open it."""

    @contextmanager
    def errors(self) -> Iterator[None]:
        """Raise errors of the storage within the block as OSError with the name of the folder."""
        yield


@dataclass(frozen=True)
class LocalFolder(ResultFolder):
    """Folder on a local disk, or on one that all workers see under the same path."""

    path: Path

    def __str__(self) -> str:
        return str(self.path)

    def exists(self) -> bool:
        return self.path.exists()

    def names(self) -> set[str]:
        return {path.name for path in self.path.iterdir()} if self.path.is_dir() else set()

    def read(self, name: str, max_size: int | None = None) -> bytes:
        with open_input(self.path / name) as stream:
            return stream.read(-1 if max_size is None else max_size)

    def write_blocks(self, name: str, blocks: Iterable[bytes]) -> None:
        (self.path / name).parent.mkdir(parents=True, exist_ok=True)
        with write_atomically(self.path / name) as draft, draft.open("wb") as file:
            file.writelines(blocks)

    def create(self, write: Callable[[Path], None]) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with write_atomically(self.path) as draft:
            write(draft)

    def free_space(self) -> float:
        return available_disk_space(self.path)

    def zarr_store(self) -> Path:
        return self.path


@dataclass(frozen=True)
class RemoteFolder(ResultFolder):
    """Folder in a remote store, such as "s3://bucket/hips.zarr"; a copy works in another process."""

    address: str

    def __str__(self) -> str:
        return self.address

    def exists(self) -> bool:
        system, path = open_address(self.address)
        with self.errors():
            return bool(system.exists(path))

    def names(self) -> set[str]:
        system, path = open_address(self.address)
        with self.errors():
            system.invalidate_cache(path)
            return {name.rpartition("/")[2] for name in system.ls(path, detail=False)} if system.exists(path) else set()

    def read(self, name: str, max_size: int | None = None) -> bytes:
        system, path = open_address(self.address)
        with self.errors():
            content: bytes = system.cat_file(f"{path}/{name}", end=max_size)
            return content

    def write_blocks(self, name: str, blocks: Iterable[bytes]) -> None:
        """Send the blocks at once: a file that is sent in parts would remain incomplete after an error."""
        system, path = open_address(self.address)
        with self.errors():
            system.pipe_file(f"{path}/{name}", b"".join(blocks))

    def create(self, write: Callable[[Path], None]) -> None:
        """Copy a draft file by file, those of the top folder first: what is missing after a stop is repaired later."""
        with TemporaryDirectory() as folder:
            draft = Path(folder) / "draft"
            write(draft)
            names = [path.relative_to(draft).as_posix() for path in draft.rglob("*") if path.is_file()]
            for name in sorted(names, key=lambda name: (name.count("/"), name)):
                self.write(name, (draft / name).read_bytes())

    def free_space(self) -> float:
        return math.inf

    def zarr_store(self) -> Any:
        from zarr.storage import FsspecStore

        open_address(self.address)
        return FsspecStore.from_url(self.address)

    @contextmanager
    def errors(self) -> Iterator[None]:
        try:
            yield
        except FileNotFoundError as error:
            raise FileNotFoundError(ENOENT, "no such file or bucket", self.address) from error
        except Exception as error:  # each store raises errors of its own
            raise OSError(None, f"the remote store failed: {' '.join(str(error).split())}", self.address) from error


@dataclass(frozen=True, kw_only=True)
class ArrayPieceStore(PieceStore):
    """Store of arrays by name with one npz file for each piece, which carries the identity of its run.

    Derived classes convert other results to arrays and back.
    """

    folder: ResultFolder  # local or remote folder
    identity: str  # digest of the run
    prefix: str  # beginning of the file names

    def to_arrays(self, result: Any) -> Mapping[str, Any]:
        """Return the arrays of a result by name."""
        arrays: Mapping[str, Any] = result
        return arrays

    def from_arrays(self, piece: int, arrays: dict[str, Numbers]) -> Any:
        """Return the result of a piece from its arrays; None if it belongs to another run.

        Raises ValueError, TypeError, KeyError: an array is missing or has another shape.
        """
        return arrays

    def load(self, numbers: Sequence[int]) -> dict[int, Any]:
        """Load the stored results of some pieces; omit missing and damaged files, and those of other runs."""
        stored, results = self.folder.names(), {}
        for piece in numbers:
            if self._piece_name(piece) not in stored:
                continue
            with suppress(OSError, ValueError, TypeError, KeyError):
                arrays = self.folder.read_arrays(self._piece_name(piece))
                if str(arrays.pop("identity")) == self.identity:
                    results[piece] = self.from_arrays(piece, arrays)
        return {piece: result for piece, result in results.items() if result is not None}

    def save(self, number: int, result: Any) -> Any:
        """Write the result of a piece to its file, and return the result; see `ResultFolder.write_blocks`."""
        self.folder.write_arrays(self._piece_name(number), identity=self.identity, **self.to_arrays(result))
        return result

    def _piece_name(self, piece: int) -> str:
        return f"{self.prefix}_{piece:06d}.npz"


def folder_at(path: str | Path) -> ResultFolder:
    """Return the folder at a local path, or at the address of a remote store.

    Examples
    --------
    >>> str(folder_at("s3://bucket/hips.zarr"))
    's3://bucket/hips.zarr'
    """
    address = address_of(path)
    if address is None or address.startswith(_LOCAL):
        return LocalFolder(Path(address.removeprefix(_LOCAL) if address else path).absolute())
    return RemoteFolder(address.rstrip("/"))


def open_address(address: str) -> tuple[Any, str]:
    """Return the file system of fsspec for an address, and the path in it.

    Raises ImportError: the library of the store is not installed.
    Raises ValueError: an unknown kind of store.
    Raises OSError: the store does not respond.
    """
    needs("study", "fsspec")
    from fsspec.core import url_to_fs

    try:
        system, path = url_to_fs(address)
    except ImportError as error:
        raise ImportError(f"{address}: {error}", name=error.name) from error
    except ValueError as error:
        raise ValueError(f"{address}: {error}") from error
    except Exception as error:  # each store raises errors of its own
        raise OSError(None, f"the remote store does not respond: {error}", address) from error
    return system, str(path)
