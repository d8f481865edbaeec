"""Resumable work: numbered pieces whose results are stored one by one, plans of named pieces, and fingerprints of code.

A stored result is up to date if the fingerprint of the package and the digest of its inputs are those of the run.
"""

from __future__ import annotations

import json
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property, partial
from hashlib import sha256
from itertools import chain
from pathlib import Path
from typing import Any

from ...version import __version__
from ..display import full_repr
from ..executors.processes import Engine, Serial, Work
from .atomic_files import make_folder, write_text

_SUFFIXES = {".py", ".npz", ".toml", ".csv", ".html", ".css"}


@cache
def fingerprint() -> str:
    """Compute an identifier of the installed code, data and templates: the version and eight characters of a hash."""
    package = Path(__file__).parents[2]
    digest = sha256()
    for path in sorted(path for path in package.rglob("*") if path.suffix in _SUFFIXES):
        digest.update(path.relative_to(package).as_posix().encode())
        digest.update(path.read_bytes())
    return f"{__version__}+{digest.hexdigest()[:8]}"


def check_worker_code(code: str) -> None:
    """Raise ValueError unless this worker runs the code with the `fingerprint` of the process that started the run."""
    if fingerprint() != code:
        raise ValueError(f"this worker has ballsocket {fingerprint()}, but the run was started by {code}")


def hash_inputs(*inputs: object) -> str:
    """Compute the SHA-256 digest of the `full_repr` of inputs, as 64 hexadecimal characters."""
    return sha256(full_repr(inputs).encode()).hexdigest()


class PieceStore(ABC):
    """Base class of stores for the results of numbered pieces of work; each worker process receives a copy."""

    @abstractmethod
    def load(self, numbers: Sequence[int]) -> dict[int, Any]:
        """Load the stored results of some pieces, by number.

        Missing or damaged pieces and those of another run are omitted.
        """

    @abstractmethod
    def save(self, number: int, result: Any) -> Any:
        """Store the result of a piece of work; return the value to send back to the calling process.

        Raises OSError: the store is not writable or the disk is full.
        """


@dataclass(frozen=True, eq=False)
class PieceRun:
    """Resumable run of numbered pieces of work: only pieces without a stored result are computed."""

    work: Work  # computes the result of a piece from its number. Worker processes must be able to import it.
    numbers: Sequence[int]  # numbers of the pieces
    # each result is stored by the process that computed it. A killed run loses only unfinished pieces.
    store: PieceStore | None = None

    @cached_property
    def stored(self) -> dict[int, Any]:
        """Results of earlier runs, by number of the piece."""
        return {} if self.store is None else self.store.load(self.numbers)

    @cached_property
    def missing(self) -> list[int]:
        """Numbers of the pieces without a stored result, in the order of `numbers`."""
        return [number for number in self.numbers if number not in self.stored]

    def compute_missing(self, engine: Engine) -> Iterator[tuple[int, Any]]:
        """Compute and store the missing pieces; yield (number, result) in the order of completion."""
        work = self.work if self.store is None else partial(_compute_and_store, self.work, self.store)
        return engine.run(work, self.missing)


def _compute_and_store(work: Work, store: PieceStore, number: int) -> Any:
    return store.save(number, work(number))


Piece = Callable[[], Any]  # function that computes a result for a JSON file
Results = dict[str, list[Any]]  # results of the pieces, by part

_SERIAL = Serial()


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Named pieces of work in named parts."""

    name: str  # name of the plan, which is the name of its folder of stored results
    parts: Mapping[str, Mapping[str, Piece]]  # pieces by part and name

    def __len__(self) -> int:
        return sum(map(len, self.parts.values()))

    def run(self, folder: Path, engine: Engine = _SERIAL) -> Iterator[tuple[str, str, Any]]:
        """Yield part, name and result of each piece: stored results first, then the others as they are computed.

        Results are stored in a subfolder with the plan's name.

        Raises OSError: the folder is not writable or the disk is full.
        """
        folder = folder / self.name
        make_folder(folder)
        pieces = [(part, name) for part, pieces in self.parts.items() for name in pieces]
        store = _ResultFiles(
            paths=tuple(folder / ("_".join([part, *re.findall(r"\w+", name)]) + ".json") for part, name in pieces),
            keys=tuple(f"ballsocket {fingerprint()}, {self.name}, {part} {name}" for part, name in pieces),
        )
        work = partial(_compute_piece, tuple(self.parts[part][name] for part, name in pieces))
        run = PieceRun(work, range(len(pieces)), store)
        for number, result in chain(run.stored.items(), run.compute_missing(engine)):
            yield *pieces[number], result

    def results(
        self, folder: Path, progress: Callable[[str], None] = lambda name: None, engine: Engine = _SERIAL
    ) -> Results:
        """Return all results by part, in the order of the pieces; compute only those that the folder does not store.

        `progress` is called with part and name of each piece whose result is present.
        """
        results: dict[tuple[str, str], Any] = {}
        for part, name, result in self.run(folder, engine):
            results[part, name] = result
            progress(f"{part} {name}".strip())
        return {part: [results[part, name] for name in pieces] for part, pieces in self.parts.items()}


def _compute_piece(pieces: Sequence[Piece], number: int) -> Any:
    return pieces[number]()


@dataclass(frozen=True)
class _ResultFiles(PieceStore):
    """Results of a plan in JSON files, one file a piece, each with a key that names the piece and the code."""

    paths: tuple[Path, ...]
    keys: tuple[str, ...]

    def load(self, numbers: Sequence[int]) -> dict[int, Any]:
        """Load the results of the pieces whose files are undamaged and have their key."""
        results = {}
        for number in numbers:
            with suppress(OSError, ValueError, KeyError, TypeError):  # missing or damaged
                record = json.loads(self.paths[number].read_text(encoding="utf-8"))
                if record["key"] == self.keys[number] and record["result"] is not None:
                    results[number] = record["result"]
        return results

    def save(self, number: int, result: Any) -> Any:
        """Write the result of a piece, and return it.

        Raises ValueError: the result has a number that is NaN or infinite.
        """
        try:
            record = json.dumps({"key": self.keys[number], "result": result}, allow_nan=False)
        except ValueError as error:
            raise ValueError(f"{self.paths[number].stem} has a number that is missing or infinite") from error
        write_text(self.paths[number], record)
        return result


@dataclass(frozen=True)
class Summary:
    """Piece that computes the summary of a result; a value that can be sent to another process."""

    compute: Callable[[], Any]

    def __call__(self) -> Any:
        return self.compute().summary()
