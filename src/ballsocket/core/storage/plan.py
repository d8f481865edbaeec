"""Plans: named pieces of work whose results are stored in JSON files, so that a stopped run is resumed."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from ..deprecation import renamed_arguments
from ..executors.processes import Engine, Serial
from .atomic_files import write_text
from .fingerprint import fingerprint
from .pieces import PieceRun, PieceStore

Piece = Callable[[], Any]
"""Function that computes a result for a JSON file."""

Results = dict[str, list[Any]]
"""Results of the pieces, by part."""

_SERIAL = Serial()


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Named pieces of work in named parts.

    Attributes
    ----------
    name : str
        Name of the plan, which is the name of its folder of stored results.
    parts : mapping of str to mapping of str to callable
        Pieces by part and name.
    """

    name: str
    parts: Mapping[str, Mapping[str, Piece]]

    def __len__(self) -> int:
        """Count the pieces."""
        return sum(map(len, self.parts.values()))

    def run(self, folder: Path, engine: Engine = _SERIAL) -> Iterator[tuple[str, str, Any]]:
        """Yield part, name and result of each piece: stored results first, then the others as they are computed.

        Results are stored in a subfolder with the plan's name.

        Raises
        ------
        OSError
            The folder is not writable or the disk is full.
        """
        folder = folder / self.name
        folder.mkdir(parents=True, exist_ok=True)
        pieces = [(part, name) for part, pieces in self.parts.items() for name in pieces]
        store = _ResultFiles(
            paths=tuple(folder / f"{part}{_file_suffix(name)}.json" for part, name in pieces),
            keys=tuple(f"ballsocket {fingerprint()}, {self.name}, {part} {name}" for part, name in pieces),
        )
        work = _PlanWork(tuple(self.parts[part][name] for part, name in pieces))
        run = PieceRun(work, range(len(pieces)), store)
        for number, result in chain(run.stored.items(), run.compute_missing(engine)):
            yield *pieces[number], result

    @renamed_arguments(listen="progress")
    def results(
        self, folder: Path, progress: Callable[[str], None] = lambda name: None, engine: Engine = _SERIAL
    ) -> Results:
        """Return all results by part, in the order of the pieces; compute only those without a stored result.

        Parameters
        ----------
        folder : Path
            Folder of the stored results.
        progress : callable
            Called with part and name of each piece whose result is present.
        engine : Engine
        """
        results: dict[tuple[str, str], Any] = {}
        for part, name, result in self.run(folder, engine):
            results[part, name] = result
            progress(f"{part} {name}".strip())
        return {part: [results[part, name] for name in pieces] for part, pieces in self.parts.items()}


@dataclass(frozen=True)
class _PlanWork:
    """Work of a plan; a call with a number computes that piece."""

    pieces: tuple[Piece, ...]

    def __call__(self, number: int) -> Any:
        """Compute a piece."""
        return self.pieces[number]()


@dataclass(frozen=True)
class _ResultFiles(PieceStore):
    """Results of a plan in JSON files, one file a piece, each with a key that names the piece and the code."""

    paths: tuple[Path, ...]
    keys: tuple[str, ...]

    def load(self, numbers: Sequence[int]) -> dict[int, Any]:
        """Load the results of the pieces whose files are undamaged and have their key."""
        results = {number: self._read(number) for number in numbers}
        return {number: result for number, result in results.items() if result is not None}

    def save(self, number: int, result: Any) -> Any:
        """Write the result of a piece, and return it.

        Raises
        ------
        ValueError
            The result has a number that is NaN or infinite.
        """
        try:
            record = json.dumps({"key": self.keys[number], "result": result}, allow_nan=False)
        except ValueError as error:
            raise ValueError(f"{self.paths[number].stem} has a number that is missing or infinite") from error
        write_text(self.paths[number], record)
        return result

    def _read(self, number: int) -> Any:
        """Read the result of a piece; return None if it is missing, damaged or of another run."""
        try:
            record = json.loads(self.paths[number].read_text(encoding="utf-8"))
            return record["result"] if record["key"] == self.keys[number] else None
        except (OSError, ValueError, KeyError, TypeError):
            return None


def _file_suffix(name: str) -> str:
    """Convert the name of a piece to the end of a file name."""
    return "".join(f"_{word}" for word in re.findall(r"\w+", name))


@dataclass(frozen=True)
class Summary:
    """Piece that computes the summary of a result; a value that can be sent to another process."""

    compute: Callable[[], Any]

    def __call__(self) -> Any:
        return self.compute().summary()
