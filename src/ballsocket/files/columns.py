"""Columns of numbers in the tables that machines and offices write: text, OpenSim, Excel (.xlsx) and Parquet."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import Annotated

import numpy

from ..core.arrays import Numbers
from ..core.checks import closest, nearest, needs, shown
from ..core.display import plain_number
from ..core.executors.processes import check_memory
from ..core.input_files import open_input, resolve_input
from ..core.kinds import Kind
from .cells import (
    EXCEL,
    OLD_EXCEL,
    Cell,
    NumberedRow,
    cell_number,
    count_words,
    decimal_mark,
    decode_text,
    is_data,
    possible_rows,
)
from .head_names import UNCERTAINTY, known_head, plain_name
from .schema import HeadMap, Table, Texts, meaning
from .units import parse, parse_units

_MAX_BYTES = 10_000_000
"""Largest size in bytes of a table that is not Parquet."""

_COPIES = 3
"""Copies of the numbers that are in memory at once: as read, as converted, as labels of a result."""

_MAX_HEAD_LENGTH, _MAX_HEAD_WORDS = 200, 8
"""Largest number of characters of a known column head, and of words in its name."""

_MAX_HEAD_ROWS = 4
"""Number of lines above the numbers in which the column heads are searched."""

_MAX_TABLES = 100
"""Largest number of tables in a file whose heads are compared."""

_MAX_NAMES = 3
"""Number of known names in a message."""

_MAX_LISTED = 20
"""Largest number of heads in a message."""

_HEADER_END = "endheader"
# possessive quantifiers (*+, ++) keep the matching time proportional to the length
_NAME = re.compile(r"[^\[(]*\w\.?")
_SEPARATOR = re.compile(r"[\s_\[(/,;:'-]")
_BRACKETED = re.compile(r"[\s_/,;:'-]*+[\[(]\s*+([^\])]*+)[\])]?\s*+")
_UNIT_CELL = re.compile(r"\s*+[\[(]?\s*+[A-Za-z%°µμ][A-Za-z%°µμ²³·*/^0-9 -]{0,14}[\])]?\s*+")


class HeadKeys(Table, frozen=True, kw_only=True):
    """Keys of a table that names a file with columns."""

    columns: Annotated[HeadMap | None, meaning("names of columns of the file by their heads")] = None
    skip: Annotated[Texts | None, meaning("heads of columns of the file that are not used")] = None

    def choice(self) -> HeadChoice:
        """Return the columns of the file that get another name, or that are not used."""
        return HeadChoice(columns={} if self.columns is None else self.columns.value, skip=tuple(self.skip or ()))


@dataclass(frozen=True, kw_only=True)
class HeadChoice:
    """Columns of a file that get another name, or that are not used.

    Parameters
    ----------
    columns : mapping of str to str
        Name, such as "force" or "force_N", by the head in the file with or without its unit. A name without a unit
        keeps the unit of the file.
    skip : sequence of str
        Heads of columns that are not used, with or without their units.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    skip: Sequence[str] = ()


ALL_COLUMNS = HeadChoice()
"""Choice of all columns of a file, under their names there."""


@dataclass(frozen=True)
class Head:
    """Column head: its text in the file, its known name or "", and its unit or ""."""

    text: str
    name: str
    unit: str = ""

    @property
    def plain_texts(self) -> tuple[str, str]:
        """Plain names of the text with and without the unit in brackets."""
        return plain_name(self.text), plain_name(re.split(r"[\[(]", self.text)[0])

    def factor(self, kind: Kind) -> float:
        """Return the factor from the unit of the column to mm, N, MPa or rad.

        Raises
        ------
        ValueError
            A missing unit, or the unit of another quantity.
        """
        if kind is Kind.NUMBER:
            return parse(self.text, f"1 {'' if self.unit in ('-', '1') else self.unit}".strip(), kind)
        if not self.unit:
            name = f"{self.name}_{kind.column_suffix}"
            raise ValueError(f"column {shown(self.text)} has no unit: use {name}, or another unit")
        return parse(f"the unit of {self.text}", f"1 {self.unit}", kind)


def split_head(text: str, names: Collection[str]) -> Head:
    """Split a head such as "Force [N]", "Kraft in N" or "force_N" into one of the known names and a unit.

    The name is "" if it is not known.
    """
    marks = [match.start() for match in _SEPARATOR.finditer(text[:_MAX_HEAD_LENGTH])][:_MAX_HEAD_WORDS]
    for end in (len(text), *reversed(marks)) if len(text) <= _MAX_HEAD_LENGTH else ():
        start = text[:end]
        if _NAME.fullmatch(start) and (name := known_head(plain_name(start), names)):
            return Head(text, name, _unit(text[end:]))
    bracket = re.search(r"[\[(]", text)
    return Head(text, "", _unit(text[bracket.start() :]) if bracket else "")


def _unit(text: str) -> str:
    """Return the unit behind the name of a head, without brackets and the word "in"."""
    bracketed = _BRACKETED.fullmatch(text)
    unit = bracketed[1] if bracketed else text.lstrip(" \t_/,;:'-").removeprefix("in ")
    return unit.replace("_per_", "/").replace("_", " ").strip()


@dataclass(frozen=True, kw_only=True, eq=False)
class NumberTable:
    """Columns of numbers in a file, by their heads.

    Attributes
    ----------
    title : str
        Name of the file.
    heads : tuple of Head
    columns : tuple of arrays
        Numbers of each column, shape (n_rows,); NaN for cells without a number.
    gaps : mapping of str to (int, str)
        Line and text of the first cell without a finite number, by the name of its column.
    left_out : mapping of str to int
        Numbers of lines that are not used, by their description, such as "above the heads".
    in_degrees : bool, optional
        Unit of angles in an OpenSim header: True for degrees, False for radians, None if not stated.
    is_opensim : bool
        True for an OpenSim storage file.
    """

    title: str
    heads: tuple[Head, ...]
    columns: tuple[Numbers, ...]
    gaps: Mapping[str, tuple[int, str]] = field(default_factory=dict)
    left_out: Mapping[str, int] = field(default_factory=dict)
    in_degrees: bool | None = None
    is_opensim: bool = False

    def __len__(self) -> int:
        return len(self.columns[0]) if self.columns else 0

    def remark(self, n_gaps: int = 0) -> str:
        """Return the number of rows, and the lines that are left out; empty without such lines.

        `n_gaps` is the number of rows with gaps that a result does not use.
        """
        counts = {**self.left_out, "with a gap": n_gaps}
        parts = [f"{count} {'line' if count == 1 else 'lines'} {place}" for place, count in counts.items() if count]
        return f"{self.title}: {len(self) - n_gaps} rows read, left out {', '.join(parts)}" if parts else ""

    def items(self) -> Iterator[tuple[Head, Numbers]]:
        """Yield each head with the numbers below it."""
        return zip(self.heads, self.columns, strict=True)

    def in_units(
        self, kinds: Mapping[str, Kind], units: Mapping[str, str] = MappingProxyType({})
    ) -> dict[str, Numbers]:
        """Return the columns by name in mm, N, MPa or rad; `units` are the units of heads without one.

        Raises
        ------
        ValueError
            A missing unit, or the unit of another quantity.
        """
        try:
            heads = [replace(head, unit=head.unit or units.get(head.name, "")) for head in self.heads]
            factors = {head.name: head.factor(kinds[head.name]) for head in heads}
        except ValueError as error:
            raise ValueError(f"{self.title}: {error}") from error
        return {head.name: factors[head.name] * values for head, values in self.items()}

    def numbers(self, name: str) -> Numbers:
        """Return the numbers of a column without gaps.

        Raises
        ------
        ValueError
            A row has no finite number; the message has its line.
        """
        if name in self.gaps:
            line, cell = self.gaps[name]
            content = shown(cell) if cell else "nothing"
            raise ValueError(f"line {line} has {content} for {name}: each line needs a finite number in each column")
        return self.columns[[head.name for head in self.heads].index(name)]


def read_columns(path: Path, names: Collection[str], choice: HeadChoice = ALL_COLUMNS) -> NumberTable:
    """Read the columns of numbers in a file.

    Text is in UTF-8, UTF-16 or cp1252. Its cells are separated by semicolons, tabs, commas or blanks, and may have
    quotes. All rows decide between decimal point and decimal comma. Lines above the heads, comments (#), blank lines
    and lines without a number are left out, and counted. Units stand in the heads, or in the line below them.

    Parameters
    ----------
    path : Path
    names : collection of str
        Names of the columns that are known.
    choice : HeadChoice
        Columns that get another name, or that are not used.

    Returns
    -------
    NumberTable

    Raises
    ------
    ValueError
        A file that is too large or no table, a column that is not known or appears twice, two tables with the same
        columns, or numbers whose decimal mark is ambiguous.
    ImportError
        An optional extra is not installed.
    OSError
        The file cannot be read.
    """
    try:
        resolved = resolve_input(path)
        if resolved.exists() and not resolved.is_file():
            raise ValueError("it is not a regular file")
        with open_input(path) as stream:
            raw = stream.read(_MAX_BYTES + 1)
        return _parse_table(path, raw, _HeadReader(names, choice))
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from error


def _parse_table(path: Path, raw: bytes, reader: _HeadReader) -> NumberTable:
    """Convert the content of a file by its first bytes."""
    if raw.startswith(b"PAR1"):
        return _read_parquet(path, reader)
    if len(raw) > _MAX_BYTES:
        raise ValueError(f"a table has at most {_MAX_BYTES // 1_000_000} MB: cut it, or save it as Parquet")
    if not raw.startswith((OLD_EXCEL, EXCEL)):
        lines = decode_text(raw).split("\n")
        ends = [index for index, line in enumerate(lines) if line.strip().lower() == _HEADER_END]
        if ends:
            return _parse_opensim(path.name, lines, ends[0])
    return _parse_rows(path.name, possible_rows(raw), reader)


class _HeadReader:
    """Reader of column heads, with the names that are known and the choice of the user."""

    def __init__(self, names: Collection[str], choice: HeadChoice) -> None:
        self.names = names
        self.choice = choice
        self.targets = {plain_name(head): name for head, name in choice.columns.items()}
        self.skipped = {plain_name(head) for head in choice.skip}

    def target(self, head: Head) -> str:
        """Return the name that the user gives to a head; "" for none."""
        return next((self.targets[text] for text in head.plain_texts if text in self.targets), "")

    def read(self, text: str, unit: str = "") -> Head:
        """Return the head of a column, whose unit may stand below it."""
        head = split_head(text, self.names)
        target = self.target(head)
        wanted = split_head(target, self.names) if target else head
        return Head(text, wanted.name, wanted.unit or head.unit or unit)

    def skips(self, head: Head) -> bool:
        """Return True if the column is not used."""
        return any(text in self.skipped for text in head.plain_texts)

    def count(self, cells: Iterable[Cell]) -> tuple[int, int]:
        """Count the heads in a row that are known; with such heads, the others are a negative number."""
        heads = [self.read(cell) for cell in cells if isinstance(cell, str) and cell]
        known = sum((bool(head.name) and _is_one_head(head)) or self.skips(head) for head in heads)
        return known, known - len(heads) if known else min(len(heads), 2)

    def choose(self, texts: Sequence[str], units: Sequence[str]) -> dict[int, Head]:
        """Return the heads that are used, by the indices of their columns.

        Raises
        ------
        ValueError
            An unknown head, two equal names, two units of a column, or a choice that matches no head.
        """
        heads = [self.read(text, unit) for text, unit in zip(texts, units, strict=True)]
        present = {text for head in heads for text in head.plain_texts}
        for key, chosen in (("columns", self.choice.columns), ("skip", self.choice.skip)):
            for text in chosen:
                if plain_name(text) not in present:
                    columns = ", ".join(shown(head.text) for head in heads[:_MAX_LISTED])
                    raise ValueError(f"{key} names {shown(text)}, but the columns are {columns}")
        used = {index: head for index, head in enumerate(heads) if not self.skips(head)}
        counts = Counter(head.name for head in used.values())
        for index, head in used.items():
            if not head.name:
                raise ValueError(self._unknown(head))
            if counts[head.name] > 1:
                raise ValueError(f"the column {head.name} appears twice: skip one with skip = [...]")
            unit = split_head(head.text, self.names).unit or units[index]
            if unit and unit != head.unit:
                target = shown(self.target(head))
                raise ValueError(f"columns names {target} for {shown(head.text)}, but the file has the unit {unit}")
        return used

    def _unknown(self, head: Head) -> str:
        """Return the message for a head that is not known."""
        if target := self.target(head):
            return f"columns names {shown(target)} for {shown(head.text)}{nearest(plain_name(target), self.names)}"
        if not head.text:
            return "a column of numbers has no head: name it, or skip it with skip = ['']"
        names = [name for name in self.names if not name.endswith(UNCERTAINTY)]
        text, close = shown(head.text), closest(plain_name(head.text), names)
        hint = f"did you mean {close!r}?" if close else f"known: {', '.join(names[:_MAX_NAMES])}, ...;"
        return (
            f"column {text} is not known; {hint} columns = {{{text} = '{close or 'NAME'}'}} names it, "
            f"skip = [{text}] leaves it out"
        )


def _is_one_head(head: Head) -> bool:
    """Return False for the heads of several columns that another separator splits."""
    if not re.search("[,;\t]", head.text) or not head.unit:
        return True
    try:
        parse_units(head.unit)
    except ValueError:
        return False
    return True


@dataclass(frozen=True)
class _Block:
    """Heads above rows of numbers: their score, and the indices of both."""

    score: tuple[int, int]
    head: int
    start: int


def _find_blocks(rows: Sequence[NumberedRow], reader: _HeadReader) -> list[_Block]:
    """Find the heads above each group of rows with numbers; without such rows, the last heads."""
    blocks: list[_Block] = []
    above: list[int] = []

    def add(start: int) -> None:
        """Add the line of heads among the lines of text above a row."""
        lines = [(reader.count(rows[index][1]), count_words(rows[index][1]), -index) for index in above]
        score, _, index = max(lines)
        blocks.append(_Block(score, -index, start))

    for index, (_, cells) in enumerate(rows):
        if not is_data(cells):
            above = [*above, index][-_MAX_HEAD_ROWS:] if any(cells) else above
            continue
        if above and len(blocks) < _MAX_TABLES:
            add(index)
        above = []
    if above and not blocks:
        add(len(rows))
    return blocks


def _parse_rows(
    title: str, candidates: Iterable[tuple[str, Sequence[NumberedRow]]], reader: _HeadReader
) -> NumberTable:
    """Convert the rows below the best known heads; the candidates are separators of cells, with the rows."""
    best: tuple[tuple[int, int], str, Sequence[NumberedRow], list[_Block]] | None = None
    for separator, rows in candidates:
        blocks = _find_blocks(rows, reader)
        score = max((block.score for block in blocks), default=(-1, 0))
        if blocks and (best is None or score > best[0]):
            best = score, separator, rows, [block for block in blocks if block.score == score]
        if score[0] > 1 and not score[1]:
            break  # all heads are known
    if best is None:
        raise ValueError("it has no line of column heads above lines of numbers")
    score, separator, rows, blocks = best
    if len(blocks) > 1 and score[0]:
        lines = ", ".join(str(rows[block.head][0]) for block in blocks[:_MAX_LISTED])
        raise ValueError(f"it has several tables with these columns, in lines {lines}: keep one")
    return _parse_block(title, rows, blocks[0], reader, separator)


def _parse_block(
    title: str, rows: Sequence[NumberedRow], block: _Block, reader: _HeadReader, separator: str
) -> NumberTable:
    """Convert the rows below heads to columns."""
    texts = [str(cell) for cell in rows[block.head][1]]
    between = [cells for _, cells in rows[block.head + 1 : block.start]]
    units = next((cells for cells in reversed(between) if _are_units(cells, texts)), ())
    body, left_out = _select_rows(rows, block.start)
    width = max((index + 1 for index, text in enumerate(texts) if text), default=0)
    for line, cells in body:
        if any(cell != "" for cell in cells[max(width, len(texts)) :]):
            raise ValueError(
                f"line {line} has {len(cells)} cells, and there are {width} columns: decimal commas need semicolons or "
                "tabs between the cells, or quotes"
            )
    width = max([width, *(len(cells) for _, cells in body)])
    filled = {index for _, cells in body for index, cell in enumerate(cells) if cell != ""}
    used = [index for index in range(width) if index in filled or any(texts[index : index + 1])]
    below = [_unit(f"_{units[index]}") if index < len(units) else "" for index in used]
    heads = reader.choose([texts[index] if index < len(texts) else "" for index in used], below)
    check_memory(f"{plain_number(len(body), 3)} rows of {title}", _COPIES * 8 * len(body) * len(heads))
    return _make_table(
        title,
        {head: used[index] for index, head in heads.items()},
        body,
        separator,
        left_out={
            "above the heads": len([cells for _, cells in rows[: block.head] if count_words(cells)]),
            "between heads and numbers": len([cells for cells in between if count_words(cells)]) - bool(units),
            **left_out,
        },
    )


def _are_units(cells: Sequence[Cell], texts: Sequence[str]) -> bool:
    """Return True if a row below heads without units in brackets has a unit in each cell that is not empty."""
    units = [str(cell) for cell in cells if count_words([cell])]
    has_units = any(mark in text for text in texts for mark in "[(")
    return bool(units) and not has_units and len(cells) <= len(texts) and all(map(_UNIT_CELL.fullmatch, units))


def _select_rows(rows: Sequence[NumberedRow], start: int) -> tuple[list[NumberedRow], dict[str, int]]:
    """Return the rows of numbers up to the heads of another table, and the numbers of the other rows.

    Raises
    ------
    ValueError
        The other table has more rows of numbers.
    """
    body: list[NumberedRow] = []
    n_text = n_blank = n_pending = n_other = 0
    for index in range(start, len(rows)):
        cells = rows[index][1]
        if is_data(cells):
            body.append(rows[index])
            n_blank, n_pending = n_blank + n_pending, 0
        elif (n_words := count_words(cells)) > 1:
            if sum(is_data(cells) for _, cells in rows[index:]) > len(body):
                raise ValueError(f"line {rows[index][0]} has text, and more numbers are below it than above: cut one")
            n_other = sum(bool(count_words(cells)) for _, cells in rows[index:])
            break
        else:
            n_text, n_pending = n_text + n_words, n_pending + (not n_words)
    return body, {"of text": n_text, "of another table below": n_other, "blank or with a comment": n_blank}


def _make_table(
    title: str,
    heads: Mapping[Head, int],
    body: Sequence[NumberedRow],
    separator: str,
    left_out: Mapping[str, int] = MappingProxyType({}),
) -> NumberTable:
    """Convert rows of cells to columns, whose indices in a row the heads have."""
    cells = {
        head: [(line, row[index] if index < len(row) else "") for line, row in body] for head, index in heads.items()
    }
    mark = decimal_mark(chain.from_iterable(cells.values()), separator)
    columns = {head: numpy.array([cell_number(cell, mark) for _, cell in column]) for head, column in cells.items()}
    rows = {head: int(numpy.isfinite(column).argmin()) for head, column in columns.items() if len(column)}
    gaps = {head: cells[head][row] for head, row in rows.items() if not isfinite(columns[head][row])}
    return NumberTable(
        title=title,
        heads=tuple(columns),
        columns=tuple(columns.values()),
        gaps={head.name: (line, str(cell)) for head, (line, cell) in gaps.items()},
        left_out=left_out,
    )


def _parse_opensim(title: str, lines: Sequence[str], end: int) -> NumberTable:
    """Convert the lines of an OpenSim file to columns."""
    settings = dict(_parse_setting(line) for line in lines[:end] if line.strip())
    rows = [(number, line.split()) for number, line in enumerate(lines[end + 1 :], end + 2) if line.strip()]
    if not rows:
        raise ValueError("it has no line of column heads below its header")
    stated = settings.get("nrows", settings.get("datarows", str(len(rows) - 1)))
    if stated != str(len(rows) - 1):
        raise ValueError(f"the header states {shown(stated)} rows, but the file has {len(rows) - 1}")
    heads = {Head(text, text): index for index, text in enumerate(rows[0][1])}
    in_degrees = {"yes": True, "no": False}.get(settings.get("indegrees", "").lower())
    return replace(_make_table(title, heads, rows[1:], ","), in_degrees=in_degrees, is_opensim=True)


def _parse_setting(line: str) -> tuple[str, str]:
    """Split a header line into name and value: `nRows=5`, or in old files `datarows 5`."""
    name, _, value = line.strip().partition("=" if "=" in line else " ")
    return name.strip().lower(), value.strip()


def _read_parquet(path: Path, reader: _HeadReader) -> NumberTable:
    """Read the columns of a Parquet file."""
    needs("study", "pyarrow")
    from pyarrow import ArrowException, parquet

    try:
        with open_input(path) as stream, parquet.ParquetFile(stream) as file:
            texts = file.schema_arrow.names
            heads = tuple(reader.choose(texts, [""] * len(texts)).values())
            n_rows = file.metadata.num_rows
            check_memory(f"{plain_number(n_rows, 3)} rows of {path.name}", _COPIES * 8 * n_rows * len(heads))
            table = file.read([head.text for head in heads])
    except (ArrowException, OSError) as error:  # pyarrow raises an OSError without a number for damaged content
        if isinstance(error, OSError) and error.errno is not None:
            raise
        raise ValueError(f"it is not a readable Parquet file: {error}") from error
    columns = {head: table.column(head.text).to_numpy() for head in heads}
    for head, column in columns.items():
        if column.dtype.kind not in "iuf":
            raise ValueError(f"column {shown(head.text)} has values of type {column.dtype}, not numbers")
    return NumberTable(title=path.name, heads=heads, columns=tuple(columns.values()))
