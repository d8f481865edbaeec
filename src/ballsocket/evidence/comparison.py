"""Comparison of a pack with the results of this version for its question: every file, key and number."""

from __future__ import annotations

import json
import re
import tempfile
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from datetime import date, timedelta
from hashlib import sha256
from math import isclose
from pathlib import Path
from typing import Any

from ..core.checks import shown
from ..core.display import counted
from ..core.executors.processes import Engine, Serial
from .credibility import assess
from .credibility_levels import Record
from .folder import QUESTION, RECORD, SIGNATURES, SUMS, digest, names_of
from .pack import STATED, Listener, gather_evidence
from .question import read_question

RELATIVE_TOLERANCE = 1e-9  # largest relative difference between the numbers of two machines

_OBSERVED_TOLERANCE = 1e-3
"""Largest difference of an observed error, as a share of the allowed error: observed errors depend on rounding."""

_OBSERVED = re.compile(r"code_verification\[(\d+)\]\.observed")

_STATED = ("version", "made_on", "made_with")  # entries that a computation cannot confirm

_DERIVED = ("credibility", "requirements", "adequacy")
"""Entries that follow from the others. They have rounded numbers, and so they are derived from the pack's own."""

_SERIAL = Serial()


@dataclass(frozen=True)
class Difference:
    """Difference between a pack and the results of this version, with a reason that the values do not show."""

    where: str
    written: Any
    now: Any
    reason: str = ""

    def __str__(self) -> str:
        return f"{self.where}: {self.reason or f'written {shown(self.written)}, now {shown(self.now)}'}"


@dataclass(frozen=True, kw_only=True)
class PackComparison:
    """Result of the comparison of a pack.

    Attributes
    ----------
    count : int
        Numbers, words and files that were compared.
    differences : tuple of Difference
        Empty for a pack that agrees with this version.
    notes : tuple of str
        Libraries that the pack states and that differ from those of this machine.
    digest : str
        Digest of the checksum file.
    record : mapping
        Record of the pack.
    """

    count: int
    differences: tuple[Difference, ...]
    notes: tuple[str, ...]
    digest: str
    record: Record


def compare(folder: Path, progress: Listener = lambda name: None, engine: Engine = _SERIAL) -> PackComparison:
    """Compare a pack with the results of this version for its question.

    Everything is computed again: no stored result of an earlier run is used. The page is compared with its checksum.

    Parameters
    ----------
    folder : Path
    progress : callable
        Called with the name of each completed part.
    engine : Engine

    Raises
    ------
    ValueError
        A folder without a pack.
    OSError
        A file cannot be read.
    """
    for name in (SUMS, QUESTION, RECORD):
        if not (folder / name).is_file():
            raise ValueError(f"{folder} holds no pack of evidence: {name} is missing")
    checksums = (folder / SUMS).read_bytes()
    try:
        record = json.loads((folder / RECORD).read_bytes(), object_pairs_hook=_unique_keys)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{folder / RECORD} cannot be read: {shown(str(error))}") from error
    if not isinstance(record, dict):
        raise ValueError(f"{folder / RECORD} holds no record of a pack")
    question = read_question(folder / QUESTION)
    names = names_of(question)
    files = list(_compare_files(folder, names, checksums.decode("utf-8", "replace")))
    with tempfile.TemporaryDirectory() as work:
        computed = json.loads(json.dumps(gather_evidence(question, Path(work), progress, engine)))
    compared = {*computed, *record} - {*_STATED, *_DERIVED}
    pairs = list(_pair_values(_entries(record, compared), _entries(computed, compared)))
    differences = [*(pair for pair in pairs if not _agrees(pair, computed)), *_compare_stated(record, computed)]
    if not differences:  # only then the record has every entry that its assessment needs
        derived = list(_pair_values(_entries(record, _DERIVED), json.loads(json.dumps(assess(record)))))
        differences = [pair for pair in derived if not _agrees(pair, record)]
        pairs += derived
    libraries = _pair_values(record.get("made_with"), computed["made_with"], "made_with")
    return PackComparison(
        count=len(pairs) + len(names),
        differences=(*files, *differences),
        notes=tuple(str(pair) for pair in libraries if pair.written != pair.now),
        digest=digest(checksums),
        record=record,
    )


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    ((name, count),) = Counter(name for name, _ in pairs).most_common(1) or [("", 1)]
    if count > 1:
        raise ValueError(f"the key {shown(name)} is there {count} times")
    return dict(pairs)


def _compare_files(folder: Path, names: Sequence[str], checksums: str) -> Iterator[Difference]:
    """Yield the missing, unknown and changed files of a pack. Unknown ones are not opened."""
    stated = {
        name or checksum: checksum for checksum, _, name in (line.partition("  ") for line in checksums.splitlines())
    }
    present = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir()}
    for name in sorted({*names, *stated, *present} - {SUMS, *SIGNATURES}):
        if name not in names:
            yield Difference(name, "present", "absent", "does not belong to the pack")
        elif not (folder / name).is_file():
            yield Difference(name, "absent", "present", "is missing")
        elif name not in stated:
            yield Difference(name, "present", "not listed", f"is not listed in {SUMS}")
        elif stated[name] != (now := sha256((folder / name).read_bytes()).hexdigest()):
            yield Difference(name, stated[name], now, f"was changed: {SUMS} has another checksum")


def _entries(record: Record, names: Collection[str]) -> dict[str, Any]:
    return {name: value for name, value in record.items() if name in names}


def _pair_values(written: Any, now: Any, where: str = "") -> Iterator[Difference]:
    """Yield the values of two records in pairs, one for each entry without subentries; their keys must be equal."""
    if isinstance(now, dict) and isinstance(written, dict):
        for name in sorted({*now, *written}):
            path = f"{where}.{name}".lstrip(".")
            if name not in now:
                yield Difference(path, written[name], None, "was added: no computation results in it")
            elif name not in written:
                yield Difference(path, None, now[name], "is missing")
            else:
                yield from _pair_values(written[name], now[name], path)
    elif isinstance(now, list) and isinstance(written, list) and len(now) == len(written):
        for index, (old, new) in enumerate(zip(written, now, strict=True)):
            yield from _pair_values(old, new, f"{where}[{index}]")
    else:
        lists = isinstance(now, list) and isinstance(written, list)
        yield Difference(
            where, written, now, f"has {counted(len(written), 'row')}, computed {len(now)}" if lists else ""
        )


def _agrees(pair: Difference, computed: Record) -> bool:
    """Check that the two values of a pair are equal, numbers within a tolerance."""
    if pair.reason or type(pair.written) is not type(pair.now):
        return False
    if not isinstance(pair.now, float):
        return bool(pair.written == pair.now)
    match, absolute = _OBSERVED.fullmatch(pair.where), 1e-12
    if match is not None:
        check = computed["code_verification"][int(match[1])]
        absolute = _OBSERVED_TOLERANCE * (check["low"] if check["high"] is None else check["high"])
    return isclose(pair.written, pair.now, rel_tol=RELATIVE_TOLERANCE, abs_tol=absolute)


def _compare_stated(record: Record, computed: Record) -> Iterator[Difference]:
    """Yield another version, a date to come, and unknown libraries: all that can be wrong about stated entries."""
    version, libraries = record.get("version"), record.get("made_with")
    if version != computed["version"]:
        reason = (
            f"cannot be verified by this version of ballsocket, {computed['version']}: the pack is of {shown(version)}"
        )
        yield Difference("version", version, computed["version"], reason)
    try:
        past = date.fromisoformat(record["made_on"]) <= date.today() + timedelta(days=1)
    except (KeyError, TypeError, ValueError):
        past = False
    if not past:
        day = record.get("made_on")
        reason = f"must be a date that is not in the future, got {shown(day)}"
        yield Difference("made_on", day, computed["made_on"], reason)
    if not isinstance(libraries, dict) or not {*libraries} <= {*STATED}:
        yield Difference("made_with", libraries, computed["made_with"], f"has other names than {', '.join(STATED)}")
