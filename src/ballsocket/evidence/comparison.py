"""Comparison of a pack with the results and figures of this version: every file, number and byte of the page."""

from __future__ import annotations

import json
import os
import re
import stat
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import date, timedelta
from hashlib import sha256
from math import isclose
from pathlib import Path
from typing import Any

from ..core.checks import shown
from ..core.executors.processes import Engine, Serial
from ..core.storage.pieces import fingerprint
from .credibility import assess
from .credibility_levels import Record
from .folder import (
    MAX_FILE_SIZE,
    PAGE,
    QUESTION,
    RECORD,
    SIGNATURE,
    SUMS,
    PageMaker,
    digest,
    names_of,
    page_bytes,
    read_checksums,
    read_record,
    record_bytes,
    sums_bytes,
)
from .pack import DRAWING, STATED, Listener, gather_evidence, ignore_progress, made_with
from .question import read_question

RELATIVE_TOLERANCE = 1e-9
"""Largest relative difference between the numbers of two machines."""

_ABSOLUTE_TOLERANCE = 1e-12
_OBSERVED_TOLERANCE = 1e-3
"""Largest difference of an observed error, as a share of the allowed error: observed errors depend on rounding."""

_STATED = ("version", "made_with", "made_on")
"""Entries that no computation can confirm; only a signature covers them."""

_DERIVED = ("credibility", "requirements", "adequacy")
"""Entries that follow from the other entries of the record and are derived again."""

_MAX_FILES = 200

_SERIAL = Serial()


@dataclass(frozen=True)
class Difference:
    """Difference between a pack and the results of this version, with a reason that the values do not show."""

    where: str
    written: Any
    now: Any
    reason: str = ""

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return {"where": self.where, "written": self.written, "now": self.now, "reason": self.reason}

    def __str__(self) -> str:
        """Return the difference as one line of text."""
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
    digest : str
        Digest of the files in the folder.
    made_by : str
        Version of ballsocket that wrote the pack.
    sums : bytes
        Compared content of the checksum file: a signature is made and verified for these bytes.
    record : mapping
        Compared record.
    """

    count: int
    differences: tuple[Difference, ...]
    digest: str
    made_by: str
    sums: bytes
    record: Record


def compare(
    folder: Path,
    page: PageMaker,
    progress: Listener = ignore_progress,
    engine: Engine = _SERIAL,
) -> PackComparison:
    """Compare a pack with the results of this version for its question.

    The files are read once, before anything is computed. Everything is computed again: no stored result of
    an earlier run is used.

    Parameters
    ----------
    folder : Path
    page : callable
        Page maker for a record and a digest.
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
    contents, foreign = _read_files(folder)
    if QUESTION not in contents:
        raise ValueError(f"{folder} holds no pack of evidence: {QUESTION} is missing")
    checksums = read_checksums(folder, contents)
    record = read_record(folder, contents)
    with tempfile.TemporaryDirectory() as copy:
        for name, content in contents.items():
            path = Path(copy, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        question = read_question(Path(copy, QUESTION))
        names = names_of(question)
        again = json.loads(record_bytes(gather_evidence(question, Path(copy, "computed.anew"), progress, engine)))
    files = {name: contents[name] for name in names if name in contents}
    outside = [name for name in contents if name not in {*names, SUMS, SIGNATURE}]
    differences = [*foreign, *(Difference(name, "present", "absent", _FOREIGN) for name in sorted(outside))]
    differences += _foreign_folders(folder, {*names, SUMS, SIGNATURE})
    differences += _compare_checksums(checksums, names, files, contents[SUMS])
    pairs = [
        pair
        for name in {**again, **record}
        if name not in (*_STATED, *_DERIVED)
        for pair in _leaf_pairs(record.get(name, _ABSENT), again.get(name, _ABSENT), name)
    ]
    differences += [pair for pair in pairs if not _agrees(pair, again)]
    try:
        differences += contradictions(record, files, page)
    except Exception as error:  # a crafted record may break any line that draws it
        differences.append(
            Difference(RECORD, "a record", "no record", f"no page can be made of it ({shown(str(error))})")
        )
    return PackComparison(
        count=len(pairs) + len(checksums),
        differences=tuple(differences),
        digest=digest(files),
        made_by=str(record.get("version", "unknown")),
        sums=contents[SUMS],
        record=record,
    )


_FOREIGN = "does not belong to the pack"


class _Absent(str):
    """Text in the place of an entry that a record lacks; of another type than each text of a record."""


_ABSENT = _Absent("absent")


def contradictions(record: Mapping[str, Any], files: Mapping[str, bytes], page: PageMaker) -> Iterator[Difference]:
    """Compare the parts of a pack: form of the record, stated entries, assessment and page.

    Raises
    ------
    Exception
        A record with missing or unknown entries.
    """
    if files.get(RECORD) != record_bytes(record):
        yield Difference(
            RECORD, "another form", "one form", "differs from the canonical form of its record: the file was edited"
        )
    yield from _check_stated_entries(record)
    if record.get("version") != fingerprint():
        made_by = record.get("version")
        reason = f"cannot be verified by this version of ballsocket, {fingerprint()}: the pack is of {shown(made_by)}"
        yield Difference("version", made_by, fingerprint(), reason)
        return
    for name, part in assess(record).items():
        for pair in _leaf_pairs(record.get(name, _ABSENT), json.loads(json.dumps(part)), name):
            if not _agrees(pair, record):
                yield pair
    if PAGE in files:
        yield from _compare_pages(files[PAGE], page_bytes(page(record, digest(files))), record)


def _check_stated_entries(record: Mapping[str, Any]) -> Iterator[Difference]:
    """Check the form of entries that cannot be computed: a past date, names and versions of libraries."""
    try:
        day = date.fromisoformat(record["made_on"])
        good = day.isoformat() == record["made_on"] and day <= date.today() + timedelta(days=1)
    except (KeyError, TypeError, ValueError):
        good = False
    if not good:
        yield Difference("made_on", record.get("made_on"), "a date", "must be a date that is not in the future")
    made = record.get("made_with")
    if not isinstance(made, dict) or set(made) - set(STATED) or not all(map(_is_version, made.values())):
        yield Difference("made_with", made, "versions", "holds more than the names and versions of libraries")


_VERSION = re.compile(r"[\w.+~-]{1,30}( [\w.-]{1,20})?", re.ASCII)


def _is_version(text: Any) -> bool:
    """Check the form of a version of a library."""
    return isinstance(text, str) and _VERSION.fullmatch(text) is not None


def _compare_pages(written: bytes, drawn: bytes, record: Mapping[str, Any]) -> Iterator[Difference]:
    """Compare the page byte by byte with a page made from the record."""
    if written == drawn:
        return
    now = made_with()
    changed = [name for name in DRAWING if record["made_with"].get(name) != now.get(name)]
    if changed and _FIGURE.sub(b"", written) == _FIGURE.sub(b"", drawn):
        theirs, ours = (
            ", ".join(f"{name} {part.get(name)}" for name in changed) for part in (record["made_with"], now)
        )
        reason = (
            f"its figures cannot be verified with {ours}: the pack was made with {theirs} (its words are as computed)"
        )
        yield Difference(PAGE, theirs, ours, reason)
        return
    yield Difference(PAGE, _excerpt(written, drawn), _excerpt(drawn, written), _describe_position(written, drawn))


_FIGURE = re.compile(rb"(?<=src='data:image/svg\+xml;base64,)[A-Za-z0-9+/=]*(?=')")


def _first_difference(written: bytes, drawn: bytes) -> int:
    """Return the index of the first byte that differs."""
    pairs = enumerate(zip(written, drawn, strict=False))
    return next((index for index, (first, second) in pairs if first != second), min(len(written), len(drawn)))


def _excerpt(page: bytes, compared: bytes) -> str:
    """Return the text of a page around the first difference."""
    position = _first_difference(page, compared)
    return page[max(0, position - 20) : position + 40].decode("utf-8", "replace")


def _describe_position(written: bytes, drawn: bytes) -> str:
    """Describe the first difference of two pages."""
    position = _first_difference(written, drawn)
    figures = [match.span() for match in _FIGURE.finditer(drawn)]
    inside = [number for number, (start, end) in enumerate(figures, 1) if start <= position < end]
    if inside:
        return f"figure {inside[0]} of the page differs from the figure made from {RECORD}"
    contrast = f"{shown(_excerpt(written, drawn))} instead of {shown(_excerpt(drawn, written))}"
    return f"the page differs from the page made from {RECORD}: {contrast}"


def _read_files(folder: Path) -> tuple[dict[str, bytes], list[Difference]]:
    """Read every regular file of a folder; list links and devices without opening them."""
    contents: dict[str, bytes] = {}
    foreign: list[Difference] = []
    if not (folder / SUMS).is_file():
        raise ValueError(f"{folder} holds no pack of evidence: {SUMS} is missing")
    for parent, folders, names in os.walk(folder):
        for name in [*names, *(name for name in folders if Path(parent, name).is_symlink())]:
            path = Path(parent, name)
            inside, mode = path.relative_to(folder).as_posix(), path.lstat()
            if len(contents) + len(foreign) >= _MAX_FILES:
                raise ValueError(f"{folder} holds more than {_MAX_FILES} files: a pack of evidence has fewer")
            if stat.S_ISLNK(mode.st_mode):
                foreign.append(Difference(inside, "a link", "a file", "is a symbolic link: a pack holds files only"))
            elif not stat.S_ISREG(mode.st_mode) or mode.st_size > MAX_FILE_SIZE:
                foreign.append(Difference(inside, "present", "absent", _FOREIGN))
            else:
                contents[inside] = path.read_bytes()
    return contents, foreign


def _foreign_folders(folder: Path, names: set[str]) -> Iterator[Difference]:
    """Yield the folders that contain no file of the pack."""
    parents = {parent.as_posix() for name in names for parent in Path(name).parents}
    for parent, folders, _ in os.walk(folder):
        for path in (Path(parent, name) for name in sorted(folders)):
            inside = path.relative_to(folder).as_posix()
            if inside not in parents and not path.is_symlink():
                yield Difference(inside, "present", "absent", _FOREIGN)


def _compare_checksums(
    checksums: list[tuple[str, str]], names: list[str], files: Mapping[str, bytes], written: bytes
) -> list[Difference]:
    """Return the differences of the checksums from the files, and of the checksum file from its canonical form."""
    sums = dict(checksums)
    both = [*sums, *(name for name in names if name not in sums)]
    now = {name: sha256(files[name]).hexdigest() if name in files else "missing" for name in both}
    stated = {name: sums.get(name, "not listed") for name in both}
    wrong = [Difference(name, stated[name], now[name]) for name in both if stated[name] != now[name]]
    if not wrong and written != sums_bytes(files):
        reason = "has other content than checksums, or lists them in another order"
        wrong.append(Difference(SUMS, "another form", "one form", reason))
    return wrong


def _leaf_pairs(written: Any, now: Any, where: str) -> Iterator[Difference]:
    """Yield the values of two records in pairs, one for each entry without subentries."""
    if isinstance(now, dict) and isinstance(written, dict):
        for name in sorted({*now, *written}):
            yield from _leaf_pairs(written.get(name, _ABSENT), now.get(name, _ABSENT), f"{where}.{name}")
        if list(now) != list(written) and set(now) == set(written):
            yield Difference(where, list(written), list(now), "has its keys in another order")
    elif isinstance(now, list) and isinstance(written, list) and len(now) == len(written):
        for index, (old, new) in enumerate(zip(written, now, strict=True)):
            yield from _leaf_pairs(old, new, f"{where}[{index}]")
    else:
        yield Difference(where, written, now)


def _agrees(pair: Difference, computed: Mapping[str, Any]) -> bool:
    """Check that the two values of a pair are equal, numbers within a tolerance."""
    if pair.reason or type(pair.written) is not type(pair.now):
        return False
    if not isinstance(pair.now, float):
        return bool(pair.written == pair.now)
    match = _OBSERVED.fullmatch(pair.where)
    absolute = _ABSOLUTE_TOLERANCE
    if match is not None:
        check = computed["code_verification"][int(match[1])]
        absolute = _OBSERVED_TOLERANCE * (check["low"] if check["high"] is None else check["high"])
    return isclose(pair.written, pair.now, rel_tol=RELATIVE_TOLERANCE, abs_tol=absolute)


_OBSERVED = re.compile(r"code_verification\[(\d+)\]\.observed")
