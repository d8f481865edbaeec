"""Columns of numbers in text tables (CSV and similar, OpenSim) and Parquet files, read in bounded memory."""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from io import TextIOWrapper
from math import isfinite, nan
from pathlib import Path
from typing import TextIO

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs, shown
from ..core.executors.processes import check_memory
from ..core.input_files import open_input, resolve_input

CheckHeads = Callable[[Sequence[str]], None]
"""Function that refuses column heads before the rows below them are read."""

CheckRows = Callable[[int], None]
"""Function that refuses a number of rows."""

_MAX_LINE = 100_000
"""Largest number of characters in a line of a CSV file."""

_MAX_TEXT_BYTES = 10_000_000
"""Largest size in bytes of a text table with any separator."""

_MAX_PREAMBLE = 100
"""Number of lines in which the column heads are searched."""

_ROWS_PER_CHECK = 1 << 16
"""Number of rows of a CSV file between two checks of the memory."""

_COPIES = 3
"""Copies of the numbers that are in memory at once: as read, as converted, as labels of a result."""

_HEADER_END = "endheader"
# possessive quantifiers (*+, ++) keep the matching time proportional to the length
_HEAD_WORDS = re.compile(r"[^\s\[(]++(?:\s{0,20}+[\[(][^\])]{0,60}+[\])])?")
_UNIT = re.compile(r"\s*+[\[(]?\s*+[A-Za-z%°]++\s*+[\])]?\s*+")

NumberedLine = tuple[int, str]
"""Number of a line in its file, and its text."""

NumberedRow = tuple[int, Sequence[str]]
"""Number of a row or line, and its cells."""


@dataclass(frozen=True, eq=False)
class NumberColumn:
    """Numbers of a column; NaN for cells without a number."""

    numbers: array[float] = field(default_factory=lambda: array("d"))
    gaps: list[tuple[int, str]] = field(default_factory=list)
    """Row or line number and text of the first cell without a finite number; empty if there is none."""

    def append(self, number: int, cell: str, decimal_mark: str) -> None:
        """Append the number in a cell of a row."""
        try:
            value = float(cell.replace(decimal_mark, "."))
        except ValueError:
            value = nan
        if not (self.gaps or isfinite(value)):
            self.gaps.append((number, cell.strip()))
        self.numbers.append(value)


def _fill_columns(rows: Iterable[NumberedRow], width: int, decimal_mark: str = ".") -> list[NumberColumn]:
    """Convert rows of cells to columns; missing cells at the end of a row are gaps."""
    columns = [NumberColumn() for _ in range(width)]
    for number, cells in rows:
        for index, column in enumerate(columns):
            column.append(number, cells[index] if index < len(cells) else "", decimal_mark)
    return columns


def split_head(head: str) -> tuple[str, str]:
    """Split a head such as "Force [N]" or "area (mm2)" into a name and the unit in brackets, or "" without brackets."""
    plain = head.strip().removeprefix('"').removesuffix('"').strip()
    start = min((plain.index(bracket) for bracket in "[(" if bracket in plain), default=-1)
    if start < 0 or plain[-1] not in "])":
        return plain, ""
    return plain[:start].rstrip(), plain[start + 1 : -1].strip()


def read_columns(path: Path, check_heads: CheckHeads) -> dict[str, Numbers]:
    """Read the columns of a CSV or Parquet file by their heads; NaN for an empty cell or one without a number.

    In CSV, lines before the heads that begin with # are skipped.

    Raises
    ------
    ValueError
        Another ending, content that is not CSV or Parquet, or more rows than fit into the memory.
    OSError
        The file cannot be read.
    """
    if path.suffix.lower() not in _READERS:
        raise ValueError(f"{shown(str(path))} must end in {' or '.join(_READERS)}")
    resolved = resolve_input(path)
    if resolved.exists() and not resolved.is_file():
        raise ValueError(f"{path.name} is not a regular file")
    return _READERS[path.suffix.lower()](path, check_heads)


def _read_csv(path: Path, check_heads: CheckHeads) -> dict[str, Numbers]:
    """Read the columns of a CSV file."""
    import csv

    with TextIOWrapper(open_input(path), encoding="utf-8-sig", newline="") as stream:
        reader = csv.reader(_csv_lines(stream, path.name), strict=True)
        try:
            heads = next(reader, [])
            check_heads(heads)
            columns = _fill_columns(_csv_rows(reader, path.name, len(heads)), len(heads))
        except csv.Error as error:
            raise ValueError(f"{path.name} is not CSV: {error}, in line {reader.line_num}") from error
        except UnicodeDecodeError as error:
            raise ValueError(f"{path.name} is not text in UTF-8: {error.reason}") from error
    return {head: numpy.array(column.numbers) for head, column in zip(heads, columns, strict=True)}


def _csv_lines(stream: TextIO, title: str) -> Iterator[str]:
    """Yield the lines of a text of limited length, from the heads on."""
    in_table = False
    while line := stream.readline(_MAX_LINE):
        if len(line) == _MAX_LINE:
            raise ValueError(f"{title} has a line of more than {_MAX_LINE} characters")
        in_table = in_table or not line.startswith("#")
        if in_table:
            yield line


def _csv_rows(reader: Iterator[list[str]], title: str, width: int) -> Iterator[NumberedRow]:
    """Yield the rows of a CSV file with their numbers from 0, as long as they fit into the memory."""
    for number, cells in enumerate(filter(None, reader)):
        if len(cells) > width:
            raise ValueError(f"row {number} of {title} has more cells than there are columns")
        if number % _ROWS_PER_CHECK == 0:
            _check_size(title, number, width)
        yield number, cells


def _check_size(title: str, n_rows: int, n_columns: int) -> None:
    """Check that a table fits into the memory."""
    check_memory(f"{n_rows:.3g} rows of {title}", _COPIES * 8 * n_rows * n_columns)


def _read_parquet(path: Path, check_heads: CheckHeads) -> dict[str, Numbers]:
    """Read the columns of a Parquet file."""
    needs("study", "pyarrow")
    from pyarrow import ArrowException, parquet

    try:
        with open_input(path) as stream, parquet.ParquetFile(stream) as file:
            heads = file.schema_arrow.names
            check_heads(heads)
            _check_size(path.name, file.metadata.num_rows, len(heads))
            table = file.read()
            return {head: table.column(head).to_numpy() for head in heads}
    except (ArrowException, OSError) as error:  # pyarrow raises an OSError without a number for damaged content
        if isinstance(error, OSError) and error.errno is not None:
            raise
        raise ValueError(f"{path.name} is not a readable Parquet file: {error}") from error


_READERS = {".csv": _read_csv, ".parquet": _read_parquet}


@dataclass(frozen=True, kw_only=True, eq=False)
class TextTable:
    """Columns of numbers in a text file, by their heads.

    Attributes
    ----------
    heads : tuple of str
        Heads of the columns, in the order of the file, with units from the line below them.
    columns : tuple of NumberColumn
        Numbers of each column.
    in_degrees : bool, optional
        Unit of angles in an OpenSim header: True for degrees, False for radians, None if not stated.
    is_opensim : bool
        True for an OpenSim storage file.
    """

    heads: tuple[str, ...]
    columns: tuple[NumberColumn, ...]
    in_degrees: bool | None = None
    is_opensim: bool = False

    def numbers(self, head: str, name: str) -> Numbers:
        """Return the numbers under a head, shape (n_rows,).

        Raises
        ------
        ValueError
            A row has no finite number; the message has its line and the `name` of the column.
        """
        column = self.columns[self.heads.index(head)]
        for line, cell in column.gaps:
            content = shown(cell) if cell else "nothing"
            raise ValueError(f"line {line} has {content} for {name}: each line needs a finite number in each column")
        return numpy.array(column.numbers)


def read_text_table(path: Path, head_words: Sequence[str], check_rows: CheckRows) -> TextTable:
    """Read an OpenSim file (.mot, .sto), or columns separated by commas, semicolons, tabs or blanks.

    Lines that begin with # are skipped. Numbers may have a decimal comma if the separator is another character.

    Parameters
    ----------
    path : Path
    head_words : sequence of str
        Words with which a column head begins in the line of heads. Lines above that line are skipped.
    check_rows : function
        Raises ValueError for a number of rows that is not allowed.

    Raises
    ------
    ValueError
        The file is too large, not text in UTF-8, has a wrong number of rows, or fewer rows than its header states.
    OSError
        The file cannot be read.
    """
    with open_input(path) as stream:
        raw = stream.read(_MAX_TEXT_BYTES + 1)
    if len(raw) > _MAX_TEXT_BYTES:
        raise ValueError(f"the table is larger than {_MAX_TEXT_BYTES} bytes")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"not text in UTF-8: {error.reason} at byte {error.start}") from error
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    for index, (_, line) in enumerate(lines):
        if line.strip().lower() == _HEADER_END:
            return _parse_opensim(lines[:index], lines[index + 1 :], check_rows)
    return _parse_separated([line for line in lines if not line[1].lstrip().startswith("#")], head_words, check_rows)


def _parse_opensim(header: Sequence[NumberedLine], lines: Sequence[NumberedLine], check_rows: CheckRows) -> TextTable:
    """Convert the lines of an OpenSim file to columns."""
    settings = dict(_parse_setting(line) for _, line in header)
    n_rows = len(lines) - 1
    check_rows(n_rows)
    stated = settings.get("nrows", settings.get("datarows", str(n_rows)))
    if stated != str(n_rows):
        raise ValueError(f"the header states {shown(stated)} rows, but the file has {n_rows}")
    heads = lines[0][1].split()
    columns = _fill_columns(((number, line.split()) for number, line in lines[1:]), len(heads))
    in_degrees = {"yes": True, "no": False}.get(settings.get("indegrees", "").lower())
    return TextTable(heads=tuple(heads), columns=tuple(columns), in_degrees=in_degrees, is_opensim=True)


def _parse_setting(line: str) -> tuple[str, str]:
    """Split a header line into name and value: `nRows=5`, or in old files `datarows 5`."""
    name, _, value = line.strip().partition("=" if "=" in line else " ")
    return name.strip().lower(), value.strip()


def _parse_separated(lines: Sequence[NumberedLine], head_words: Sequence[str], check_rows: CheckRows) -> TextTable:
    """Convert separated lines to columns: the heads, an optional line of units, and rows of numbers."""
    pattern = re.compile(rf"\s*+\"?\s*+({'|'.join(head_words)})\b", re.IGNORECASE)
    start = next((index for index, (_, line) in enumerate(lines[:_MAX_PREAMBLE]) if _is_head_line(line, pattern)), 0)
    body = lines[start + 1 :]
    check_rows(len(body))
    head_line = lines[start][1]
    separator = max(",;\t", key=head_line.count)
    by_blanks = separator not in head_line
    heads = _HEAD_WORDS.findall(head_line) if by_blanks else head_line.split(separator)
    cells = [line.split(None if by_blanks else separator) for _, line in body[:2]]
    units = cells[0]
    if len(units) == len(heads) and all("[" not in head for head in heads) and all(map(_is_unit, units)):
        heads = [f"{head.strip()} [{unit.strip().strip('[]()')}]" for head, unit in zip(heads, units, strict=True)]
        body, cells = body[1:], cells[1:]
    decimal_mark = "," if separator != "," and any("," in cell for cell in cells[0]) else "."
    rows = ((number, line.split(None if by_blanks else separator)) for number, line in body)
    return TextTable(heads=tuple(heads), columns=tuple(_fill_columns(rows, len(heads), decimal_mark)))


def _is_head_line(line: str, pattern: re.Pattern[str]) -> bool:
    """Return True if a cell of the line begins with a head word, and the line does not end with a number."""
    cells = re.split(r"[,;\t]|\s{2,}", line)
    return any(pattern.match(cell) for cell in cells) and not line.strip()[-1].isdigit()


def _is_unit(cell: str) -> bool:
    """Return True if a cell can be a unit, and is not a missing number."""
    return bool(_UNIT.fullmatch(cell)) and cell.strip().lower() not in ("nan", "inf")
