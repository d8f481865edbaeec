"""Tables of text about a hip: columns with heads and units, or OpenSim's storage with its header."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy

from ..core.arrays import Numbers
from ..core.checks import shown
from ..core.input_files import open_input

_LARGEST = 10_000_000
_ROWS = 5, 100_000
# possessive quantifiers (*+, ++) keep the matching time proportional to the length
_HEAD = re.compile(r"\s*+\"?\s*+([A-Za-z_]++)'?\s*+(?:[\[(]([^\])]++)[\])])?\s*+\"?\s*+")
_WORDS = re.compile(r"[^\s\[(]++(?:\s{0,20}+[\[(][^\])]{0,60}+[\])])?")
_BEGINS = re.compile(r"\s*+\"?\s*+(time|phase|cycle)\b", re.IGNORECASE)
_UNIT = re.compile(r"\s*+[\[(]?\s*+[A-Za-z%°]++\s*+[\])]?\s*+")
_LINES_BEFORE = 100
_END = "endheader"

Row = tuple[int, list[str]]
"""The number of a line, and its cells."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Table:
    """Columns of text under their heads, as they are written.

    Attributes
    ----------
    title : str
        The file's name.
    heads : tuple of str
    rows : tuple of (int, list of str)
    comma : bool
        Whether numbers have a decimal comma.
    degrees : bool, optional
        What the header of a storage says of its angles; None where it says nothing.
    storage : bool
        Whether it is one of OpenSim.
    """

    title: str
    heads: tuple[str, ...]
    rows: tuple[Row, ...]
    comma: bool = False
    degrees: bool | None = None
    storage: bool = False

    def column(self, head: str, name: str) -> Numbers:
        """The numbers under a head; ValueError where a line has none, told with the name."""
        place = self.heads.index(head)
        return numpy.array([self._number(name, number, row, place) for number, row in self.rows])

    def _number(self, name: str, number: int, row: Sequence[str], place: int) -> float:
        text = row[place].strip() if place < len(row) else ""
        try:
            value = float(text.replace(",", ".") if self.comma else text)
        except ValueError:
            value = numpy.nan
        if not numpy.isfinite(value):
            what = shown(text) if text else "nothing"
            raise ValueError(f"line {number} has {what} for {name}: each line needs a finite number in each column")
        return value


def parted_head(head: str) -> tuple[str, str | None]:
    """The name of a head in small letters and its unit, if it has one.

    Raises
    ------
    ValueError
        No name with a unit.
    """
    match = _HEAD.fullmatch(head)
    if match is None:
        raise ValueError(f"the head {shown(head)} is not a name with a unit, such as 'force [N]'")
    return match[1].lower(), match[2] and match[2].strip()


def read_table(path: Path) -> Table:
    """Read a table: OpenSim's .mot and .sto, or columns parted by commas, semicolons, tabs or blanks.

    Raises
    ------
    ValueError
        One sentence: too large, not text, too few or too many lines, fewer than the header says.
    OSError
        The file cannot be read.
    """
    with open_input(path) as stream:
        raw = stream.read(_LARGEST + 1)
    if len(raw) > _LARGEST:
        raise ValueError(f"the table is larger than {_LARGEST} bytes")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"not text in UTF-8: {error.reason} at byte {error.start}") from error
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    ends = [place for place, (_, line) in enumerate(lines) if line.strip().lower() == _END]
    if ends:
        return _storage(path.name, lines[: ends[0]], lines[ends[0] + 1 :])
    return _columns(path.name, [each for each in lines if not each[1].lstrip().startswith("#")])


def _storage(title: str, header: Sequence[tuple[int, str]], lines: Sequence[tuple[int, str]]) -> Table:
    told = dict(_told(line) for _, line in header)
    _check_count(len(lines) - 1)
    count = told.get("nrows", told.get("datarows", str(len(lines) - 1)))
    if count != str(len(lines) - 1):
        raise ValueError(f"the header tells of {shown(count)} rows, and {len(lines) - 1} are there")
    degrees = {"yes": True, "no": False}.get(told.get("indegrees", "").lower())
    rows = tuple((number, line.split()) for number, line in lines[1:])
    return Table(title=title, heads=tuple(lines[0][1].split()), rows=rows, degrees=degrees, storage=True)


def _told(line: str) -> tuple[str, str]:
    """A name and its value in a header: `nRows=5`, or as it was once, `datarows 5`."""
    name, _, value = line.strip().partition("=" if "=" in line else " ")
    return name.strip().lower(), value.strip()


def _columns(title: str, lines: Sequence[tuple[int, str]]) -> Table:
    """What stands before the heads is passed over, if a later line has a head for time."""
    begin = next((place for place, (_, line) in enumerate(lines[:_LINES_BEFORE]) if _has_time(line)), 0)
    below = lines[begin + 1 :]
    _check_count(len(below))
    first = lines[begin][1]
    parting = max(",;\t", key=first.count)
    blanks = parting not in first
    heads = _WORDS.findall(first) if blanks else first.split(parting)
    rows = [(number, line.split() if blanks else line.split(parting)) for number, line in below]
    units = rows[0][1]
    if len(units) == len(heads) and all("[" not in head for head in heads) and all(map(_is_unit, units)):
        heads = [f"{head.strip()} [{unit.strip().strip('[]()')}]" for head, unit in zip(heads, units, strict=True)]
        rows = rows[1:]
    comma = parting != "," and any("," in cell for cell in rows[0][1])
    return Table(title=title, heads=tuple(heads), rows=tuple(rows), comma=comma)


def _has_time(line: str) -> bool:
    return any(_BEGINS.match(cell) for cell in re.split(r"[,;\t]|\s{2,}", line)) and not line.strip()[-1].isdigit()


def _is_unit(cell: str) -> bool:
    return bool(_UNIT.fullmatch(cell)) and cell.strip().lower() not in (
        "nan",
        "inf",
    )


def _check_count(count: int) -> None:
    if not _ROWS[0] <= count < _ROWS[1]:
        raise ValueError(f"{max(count, 0)} lines below the heads; a cycle has {_ROWS[0]} to {_ROWS[1]}")
