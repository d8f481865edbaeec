"""The folder of a pack: written with checksums, and computed again to see whether it still says the same."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from math import inf, isclose
from pathlib import Path
from typing import Any

from ..atomic import write_text
from ..checks import shown
from ..engines.local import Engine, Serial
from ..fingerprint import fingerprint
from .credibility import FACTORS
from .pack import Listener, gathered, silent
from .question import Question, read_question

QUESTION, RECORD, PAGE, SUMS = "question.toml", "evidence.json", "evidence.html", "checksums.txt"
CLOSE = 1e-9
"""Relative: what two runs on different machines may differ by."""

_FREE = ("version", "made_with", "made_on", "credibility")
"""What may differ with machine and day; credibility must be what the pack's own record comes to."""

_HERE = Serial()


def write(question: Question, record: Mapping[str, Any], page: str, folder: Path) -> Path:
    """The page in its folder, beside the question with the files that it names, the record and the checksums."""
    for path in question.files:
        target = folder / (QUESTION if path == question.path else path.relative_to(question.path.parent))
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.resolve() != path.resolve():
            target.write_bytes(path.read_bytes())
    write_text(folder / RECORD, json.dumps(record, indent=1, allow_nan=False) + "\n")
    written = write_text(folder / PAGE, page)
    write_text(folder / SUMS, "".join(f"{_sum(folder / name)}  {name}\n" for name in _names(question)))
    return written


def _names(question: Question) -> list[str]:
    """The files of a pack, but their sums."""
    return sorted({*(_name(question, path) for path in question.files), RECORD, PAGE})


def _name(question: Question, path: Path) -> str:
    return QUESTION if path == question.path else path.relative_to(question.path.parent).as_posix()


def _sum(path: Path) -> str:
    return sha256(path.read_bytes()).hexdigest()


@dataclass(frozen=True)
class Difference:
    """Something in a pack that is not as it was written down."""

    where: str
    written: Any
    now: Any

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {"where": self.where, "written": self.written, "now": self.now}

    def __str__(self) -> str:
        return f"{self.where}: written {shown(self.written)}, now {shown(self.now)}"


def differences(
    folder: Path,
    listen: Listener = silent,
    engine: Engine = _HERE,
    page: Callable[[Mapping[str, Any]], str] | None = None,
) -> tuple[int, list[Difference]]:
    """How many numbers and words were compared, and what differs: files by their sums, all the rest computed again.

    Parameters
    ----------
    folder : Path
    listen : callable
        Told the name of each piece when it is there.
    engine : Engine
    page : callable, optional
        Makes the page of a record: the page of the folder must say what its record says. Not asked of a pack that
        another version of the code wrote, whose words may be others.

    Raises
    ------
    ValueError
        A folder that holds no pack.
    OSError
        A file cannot be read.
    """
    sums, record = _sums(folder), _read(folder)
    question = read_question(folder / QUESTION)
    files = [*sums, *((name, "not listed") for name in _names(question) if name not in dict(sums))]
    found = [Difference(name, kept, _now(folder / name)) for name, kept in files if _now(folder / name) != kept]
    with tempfile.TemporaryDirectory() as room:
        again = json.loads(json.dumps(gathered(question, Path(room), listen, engine)))
    pairs = [
        each
        for name in {**again, **record}
        if name not in _FREE
        for each in _pairs(record.get(name), again.get(name), name)
    ]
    try:
        own = list(contradictions(record, folder, page))
    except (LookupError, TypeError, ValueError, AttributeError):  # parts are missing, or are something else
        own = [Difference(RECORD, "a record that lacks parts", "whole")]
    return len(pairs) + len(files), [*found, *(each for each in pairs if not _same(each)), *own]


def contradictions(
    record: Mapping[str, Any], folder: Path, page: Callable[[Mapping[str, Any]], str] | None
) -> Iterator[Difference]:
    """Where a pack disagrees with itself: checks with what they observed, factors and page with the record.

    Raises
    ------
    LookupError, TypeError, ValueError, AttributeError
        A record that lacks parts.
    """
    for place, each in enumerate(record.get("code_verification", ())):
        if each["passed"] and not each["low"] <= each["observed"] <= (inf if each["high"] is None else each["high"]):
            yield Difference(f"code_verification[{place}].observed", each["observed"], "not what has passed")
    if record.get("version") != fingerprint():
        return
    said = record.get("credibility")
    for pair in _pairs(said, [factor.summary(record) for factor in FACTORS], "credibility"):
        if not _same(pair):
            yield pair
    text = (folder / PAGE).read_text(encoding="utf-8", errors="replace") if (folder / PAGE).is_file() else ""
    if page is not None and _words(text) != _words(page(record)):
        yield Difference(PAGE, "another page", f"what {RECORD} says")


def _words(page: str) -> str:
    """A page without its pictures, whose bytes are those of the library that draws."""
    return _PICTURE.sub("", page)


_PICTURE = re.compile(r"data:image/[^']*")


def made_by(folder: Path) -> str:
    """The version that wrote a pack."""
    return str(_read(folder).get("version", "unknown"))


def _now(path: Path) -> str:
    return _sum(path) if path.is_file() else "missing"


def _sums(folder: Path) -> list[tuple[str, str]]:
    try:
        lines = (folder / SUMS).read_text(encoding="utf-8").splitlines()
    except FileNotFoundError as error:
        raise ValueError(f"{folder} holds no pack of evidence: {SUMS} is not there") from error
    except UnicodeDecodeError as error:
        raise ValueError(f"{folder} holds no pack of evidence: {SUMS} is not text") from error
    listed = [(name, kept) for kept, _, name in (line.partition("  ") for line in lines)]
    for name, _ in listed:
        if not name or Path(name).is_absolute() or ".." in Path(name).parts:
            raise ValueError(f"{SUMS} names {shown(name)}, which is no file of the pack")
    return listed


def _read(folder: Path) -> dict[str, Any]:
    try:
        record = json.loads((folder / RECORD).read_text(encoding="utf-8"))
    except (FileNotFoundError, ValueError, RecursionError) as error:
        raise ValueError(f"{folder} holds no pack of evidence: {RECORD} cannot be read") from error
    if not isinstance(record, dict):
        raise ValueError(f"{RECORD} holds no record")
    return record


def _pairs(written: Any, now: Any, where: str) -> Iterator[Difference]:
    """Every leaf, as it was written and as it is."""
    if isinstance(now, dict) and isinstance(written, dict):
        for name in sorted({*now, *written}):
            yield from _pairs(written.get(name), now.get(name), f"{where}.{name}")
    elif isinstance(now, list) and isinstance(written, list) and len(now) == len(written):
        for place, (one, other) in enumerate(zip(written, now, strict=True)):
            yield from _pairs(one, other, f"{where}[{place}]")
    else:
        yield Difference(where, written, now)


def _same(pair: Difference) -> bool:
    if _is_number(pair.now) and _is_number(pair.written):
        return isclose(pair.written, pair.now, rel_tol=CLOSE, abs_tol=_SMALL) or pair.where.endswith(_SPENT)
    return type(pair.written) is type(pair.now) and bool(pair.written == pair.now)


def _is_number(value: Any) -> bool:
    return isinstance(value, float | int) and not isinstance(value, bool)


_SMALL = 1e-12
_SPENT = ("seconds", "observed")
"""What is measured: times, and errors at the size of rounding, which have their own bounds."""
