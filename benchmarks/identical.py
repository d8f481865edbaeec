"""Numerical identity: results of every public entry, recorded before a change and compared bit for bit after it.

    python -m benchmarks.identical record before.npz
    python -m benchmarks.identical compare before.npz
    python -m benchmarks.identical compare before.npz --only hip

`compare` records the present code and compares it with the file, or it compares the file with a second one. Exit
status: 0 all results are identical; 1 a result differs or is missing, or a room has nearly no results. Every room runs
in a process of its own, on one thread, with an empty cache. Texts (notes, messages, comments in exported programs) are
results too. With `--numbers` sentences may differ, for a change that rewords them. Both records must come from one
machine with the same libraries. The entries call the present names.
"""

from __future__ import annotations

import argparse
import logging
import os
import sys
import tempfile
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum
from functools import partial
from hashlib import sha256
from importlib import import_module
from math import inf, isfinite
from pathlib import Path
from typing import Any

import numpy
from rich.console import Console
from rich.table import Table
from rich.text import Text

from .report import Report, Rows
from .timing import apart

Numbers = numpy.ndarray[Any, Any]

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
ENVIRONMENT = {**dict.fromkeys(_THREADS, "1"), "PYTHONHASHSEED": "0", "COLUMNS": "100"}
"""Environment of the process that records a room."""

VOLATILE = ("version", "seconds", "made_on", "made_with", "call", "code")
"""Keys of JSON that differ from run to run, or that name private modules."""

ROOMS = {
    **dict.fromkeys(("contact", "models", "exact", "finite_elements", "off_axis"), "entries_of_contact"),
    **dict.fromkeys(("dynamics", "hip", "patients", "export"), "entries_in_use"),
    **dict.fromkeys(("identify", "studies", "evidence", "command"), "entries_of_questions"),
    "refusals": "entries_of_refusals",
}
"""Rooms by name, and the module with a function of that name that records it."""

_LONGEST_TEXT, _LONGEST_CELL = 2000, 120
_MAX_ROWS = 40


@dataclass
class Results:
    """Results of a room by name: arrays of float64, and texts.

    Attributes
    ----------
    folder : str
        Temporary folder of the room, which texts do not name.
    arrays : dict of str to array
        Numbers as float64 of any shape; a text as an array of one string.
    exceptions : list of str
        Names of results that raised an exception, with its type.
    seconds : float
        Time of the processor.
    """

    folder: str
    arrays: dict[str, Numbers] = field(default_factory=dict)
    exceptions: list[str] = field(default_factory=list)
    seconds: float = 0.0

    def add(self, name: str, value: Any) -> None:
        """Add a number, an array, a text, or a nested mapping or sequence of these."""
        if isinstance(value, Mapping):
            for key, part in value.items():
                if key not in VOLATILE:
                    self.add(f"{name}/{key}", part)
        elif isinstance(value, str):
            self._store(name, numpy.array([_shortened(value.replace(self.folder, "FOLDER"))]))
        elif isinstance(value, numpy.ndarray) and value.dtype.kind in "UO":
            self.add(name, value.tolist())
        elif (numbers := _as_numbers(value)) is not None:
            self._store(name, numbers)
        elif all(isinstance(part, str) for part in value):
            self._store(f"{name}/count", numpy.array(float(len(value))))
            self.add(name, "\n".join(value))
        else:
            for place, part in enumerate(value):
                self.add(f"{name}/{place}", part)

    def add_attributes(self, name: str, source: Any, attributes: str) -> None:
        """Add attributes of an object, whose names are parted by blanks."""
        for attribute in attributes.split():
            with self.attempt(f"{name}/{attribute}"):
                self.add(f"{name}/{attribute}", getattr(source, attribute))

    @contextmanager
    def attempt(self, name: str) -> Iterator[None]:
        """Record an exception as a result: its type, and the first line of its message."""
        try:
            yield
        except Exception as error:
            kind, message = type(error).__name__, str(error).partition("\n")[0]
            self.exceptions.append(f"{name}: {kind}: {message:.100}")
            self._store(f"{name}/exception", numpy.array([kind]))
            self._store(f"{name}/message", numpy.array([f"message: {message}"]))

    def _store(self, name: str, value: Numbers) -> None:
        if name in self.arrays:
            raise RuntimeError(f"{name!r} is recorded twice: give it another name")
        self.arrays[name] = value


def _as_numbers(value: Any) -> Numbers | None:
    """Convert numbers, None included, to an array of float64; None for anything else."""
    if not isinstance(value, numpy.ndarray):
        value = _without_none(value)
    try:
        numbers = numpy.asarray(value)
    except ValueError:  # rows of different lengths
        return None
    if numbers.dtype.kind == "c":
        numbers = numpy.stack([numbers.real, numbers.imag], axis=-1)
    return numpy.array(numbers, dtype=numpy.float64) if numbers.dtype.kind in "biuf" else None


def _without_none(value: Any) -> Any:
    """Replace None by NaN in nested lists."""
    if isinstance(value, list | tuple):
        return [_without_none(part) for part in value]
    return numpy.nan if value is None else value


def _shortened(text: str) -> str:
    """Replace a long text by its digest."""
    digest = sha256(text.encode()).hexdigest()
    return text if len(text) <= _LONGEST_TEXT else f"digest {digest} of {len(text)} characters"


@dataclass(frozen=True)
class Record:
    """Results of several rooms, by "room/name".

    Attributes
    ----------
    arrays : dict of str to array
    rows : list of tuple
        Of each recorded room its name, numbers, texts, exceptions and seconds of the processor.
    exceptions : list of str
    """

    arrays: dict[str, Numbers] = field(default_factory=dict)
    rows: list[tuple[str, int, int, int, float]] = field(default_factory=list)
    exceptions: list[str] = field(default_factory=list)

    @property
    def empty_rooms(self) -> list[str]:
        """Rooms with fewer than a hundred numbers, or hardly more numbers than exceptions."""
        return [room for room, numbers, _, exceptions, _ in self.rows if numbers < 100 + 10 * exceptions]

    def save(self, path: Path) -> None:
        """Write a file of named arrays."""
        with path.open("wb") as file:
            numpy.savez_compressed(file, **self.arrays)  # type: ignore[arg-type]

    def of_rooms(self, rooms: Sequence[str]) -> dict[str, Numbers]:
        """Return the results of these rooms."""
        return {name: array for name, array in self.arrays.items() if name.partition("/")[0] in rooms}


def load(path: Path) -> Record:
    """Read a file of named arrays."""
    with numpy.load(path) as file:
        return Record(arrays=dict(file))


def record(rooms: Sequence[str] = tuple(ROOMS)) -> Record:
    """Record the results of the present code, room by room."""
    total = Record()
    for room in rooms:
        with tempfile.TemporaryDirectory() as folder:
            work = partial(_record_room, room, folder)
            results: Results = apart(work, **ENVIRONMENT, BALLSOCKET_CACHE=f"{folder}/cache")
        total.arrays.update({f"{room}/{name}": array for name, array in results.arrays.items()})
        total.exceptions.extend(f"{room}/{exception}" for exception in results.exceptions)
        numbers, texts = _sizes(results.arrays.values())
        total.rows.append((room, numbers, texts, len(results.exceptions), results.seconds))
        counts = f"{numbers:7d} numbers {texts:5d} texts {len(results.exceptions):4d} exceptions"
        print(f"{room:<16}{counts} {results.seconds:6.1f} s", file=sys.stderr)
    return total


def _record_room(room: str, folder: str) -> Results:
    """Record the results of a room."""
    results = Results(folder=folder)
    with warnings.catch_warnings(), numpy.errstate(all="ignore"), results.attempt("complete"):
        warnings.simplefilter("ignore")
        logging.disable()
        module = import_module(f".{ROOMS[room]}", "benchmarks")
        getattr(module, room)(results, Path(folder))
    results.seconds = sum(os.times()[:4])
    return results


def _sizes(arrays: Iterable[Numbers]) -> tuple[int, int]:
    """Count numbers and texts."""
    listed = list(arrays)
    texts = sum(array.dtype.kind == "U" for array in listed)
    return sum(array.size for array in listed) - texts, texts


class Kind(Enum):
    """Kind of a result: a number, a name or code, or a sentence."""

    NUMBER = "number"
    CODE = "code"
    SENTENCE = "sentence"


def _kind(array: Numbers) -> Kind:
    if array.dtype.kind != "U":
        return Kind.NUMBER
    return Kind.SENTENCE if " " in str(array[0]) else Kind.CODE


@dataclass(frozen=True)
class Difference:
    """Result that differs between two records."""

    name: str
    kind: Kind
    old: str
    new: str
    relative: float = inf


def differences(old: Mapping[str, Numbers], new: Mapping[str, Numbers]) -> list[Difference]:
    """List the results of both records that differ: numbers first, by their relative difference."""
    listed = [change for name in old if name in new for change in _differences(name, old[name], new[name])]
    return sorted(listed, key=lambda change: (list(Kind).index(change.kind), -change.relative))


def _differences(name: str, old: Numbers, new: Numbers) -> Iterator[Difference]:
    """Yield the elements of a result that differ in any bit; NaN equals NaN."""
    if old.dtype.kind != new.dtype.kind or old.shape != new.shape:
        yield Difference(name, Kind.NUMBER, f"{old.dtype} {old.shape}", f"{new.dtype} {new.shape}")
    elif old.dtype.kind == "U":
        if old[0] != new[0]:
            yield Difference(name, _kind(old), *_excerpts(str(old[0]), str(new[0])))
    else:
        first, second = (numpy.atleast_1d(array).view(numpy.int64) for array in (old, new))
        changed = (first != second).reshape(old.shape) & ~(numpy.isnan(old) & numpy.isnan(new))
        for place in map(tuple, numpy.argwhere(changed)):
            index = f"[{', '.join(map(str, place))}]" if place else ""
            before, after = float(old[place]), float(new[place])
            yield Difference(name + index, Kind.NUMBER, repr(before), repr(after), _relative(before, after))


def _excerpts(old: str, new: str) -> tuple[str, str]:
    """Cut two texts to where they differ first."""
    same = next((place for place, (one, other) in enumerate(zip(old, new, strict=False)) if one != other), 0)
    start = max(same - _LONGEST_CELL // 4, 0)
    return old[start : start + _LONGEST_CELL], new[start : start + _LONGEST_CELL]


def _relative(old: float, new: float) -> float:
    """Compute the relative difference; infinite for NaN and infinite numbers, 0 for the two zeros."""
    if old == new:
        return 0.0
    return abs(new - old) / max(abs(old), abs(new)) if isfinite(old) and isfinite(new) else inf


def compare(old: Mapping[str, Numbers], new: Mapping[str, Numbers], *, numbers_only: bool = False) -> int:
    """Print how two records differ; return the exit status."""
    changes = differences(old, new)
    missing, added = ([name for name in one if name not in other] for one, other in ((old, new), (new, old)))
    sizes = _sizes(array for name, array in old.items() if name in new)
    of_numbers = sum(change.kind is Kind.NUMBER for change in changes)
    for kind, size, differ in (("numbers", sizes[0], of_numbers), ("texts", sizes[1], len(changes) - of_numbers)):
        print(f"{size} {kind} in both: {size - differ} identical to the last bit, {differ} differ")
    if numbers_only:
        changes = [change for change in changes if change.kind is not Kind.SENTENCE]
        missing = [name for name in missing if _kind(old[name]) is not Kind.SENTENCE]
    _show(changes)
    for title, names in (("missing", missing), ("new", added)):
        if names:
            print(f"{len(names)} {title}:\n  " + "\n  ".join(names[:_MAX_ROWS]))
    print("identical" if not changes and not missing else f"{len(changes)} differ, {len(missing)} missing")
    return 1 if changes or missing else 0


def _show(changes: Sequence[Difference]) -> None:
    """Print the first differences as a table."""
    if not changes:
        return
    table = Table(
        "name", "old", "new", "relative", title=f"{min(len(changes), _MAX_ROWS)} of {len(changes)} differences"
    )
    for change in changes[:_MAX_ROWS]:
        relative = f"{change.relative:.1e}" if change.kind is Kind.NUMBER else ""
        table.add_row(change.name, *(Text(text) for text in (change.old, change.new)), relative)
    Console(width=None if Console().is_terminal else 200, highlight=False, markup=False).print(table)


def measure() -> Report:
    """Record twice, and report the results of each room and the differences of the two records."""
    first, second = record(), record()
    rows = Rows("Recorded results", ("room", "numbers", "texts", "exceptions", "seconds"))
    for room, numbers, texts, exceptions, seconds in first.rows:
        rows.add(room, numbers, texts, exceptions, f"{seconds:.1f}")
    changes = differences(first.arrays, second.arrays)
    return Report([rows], [f"Two records in a row differ in {len(changes)} results."])


def main(words: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.identical", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("action", choices=("record", "compare"))
    parser.add_argument("file", type=Path, help="the record: written, or compared with")
    parser.add_argument("other", type=Path, nargs="?", help="compare with this record in place of the present code")
    parser.add_argument(
        "--only", metavar="ROOM", action="append", choices=tuple(ROOMS), help=f"{', '.join(ROOMS)}; repeat"
    )
    parser.add_argument("--numbers", action="store_true", help="sentences may differ")
    parser.add_argument("--exceptions", action="store_true", help="list what raised an exception")
    options = parser.parse_args(words)
    rooms = options.only or tuple(ROOMS)
    old = load(options.file).of_rooms(rooms) if options.action == "compare" else {}
    new = record(rooms) if options.other is None else load(options.other)
    if options.exceptions:
        print("\n".join(new.exceptions))
    for room in new.empty_rooms:
        print(f"{room}: nearly no results; --exceptions lists why", file=sys.stderr)
    if options.action == "compare":
        return max(compare(old, new.of_rooms(rooms), numbers_only=options.numbers), int(bool(new.empty_rooms)))
    new.save(options.file)
    print(f"{options.file}: {sum(_sizes(new.arrays.values()))} results")
    return 1 if new.empty_rooms else 0


if __name__ == "__main__":
    sys.exit(main())
