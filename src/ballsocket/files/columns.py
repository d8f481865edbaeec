"""Columns of numbers in the tables that machines and offices write: text, OpenSim, Excel (.xlsx) and Parquet."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, zip_longest
from pathlib import Path
from types import MappingProxyType
from typing import Annotated

import numpy

from ..core.arrays import Numbers
from ..core.checks import closest, nearest, needs, refusals_of, shown
from ..core.display import counted, plain_number
from ..core.executors.processes import check_memory
from ..core.input_files import open_input, resolve_input
from ..core.kinds import Kind
from .cells import (
    EXCEL,
    OLD_EXCEL,
    UNCERTAINTY,
    Cell,
    NumberedRow,
    cell_number,
    count_factor,
    count_words,
    decimal_mark,
    decode_text,
    is_data,
    known_head,
    plain_name,
    read_excel,
    split_text,
)
from .schema import FileTable, HeadMap, Texts, meaning
from .units import Units, parse, parse_units

_MAX_BYTES = 10_000_000  # largest size in bytes of a table that is not Parquet
_COPIES = 3  # copies of the numbers that are in memory at once: as read, as converted, as labels of a result

_MAX_HEAD_LENGTH, _MAX_HEAD_WORDS = 200, 8
"""Largest number of characters of a known column head, and of words in its name."""

_MAX_HEAD_ROWS, _MAX_TABLES = 4, 100
"""Lines above the numbers in which the column heads are searched, and tables of a file whose heads are compared."""

_MAX_NAMES, _MAX_LISTED = 3, 20  # largest numbers of known names and of heads in a message

_HEADER_END = "endheader"
# possessive quantifiers (*+, ++) keep the matching time proportional to the length
_NAME = re.compile(r"\w(?:[^\[(]*\w)?\.?")
_SEPARATOR = re.compile(r"[\s_\[(/,;:'-]")
_BRACKETED = re.compile(r"[\s_/,;:'-]*+[\[(]\s*+([^\])]*+)[\])]?\s*+")
_LABEL = re.compile(r"[\s_#-]*+\w[\s\w.#-]*+[\[(][^\])]*+[\])]\s*+")
"""Number or word before a unit in brackets, by which a head differs from others: "Force 2 [N]"."""

_UNIT_CELL = re.compile(r"\s*+[\[(]?\s*+[A-Za-z%°µμ][A-Za-z%°µμ²³·*/^0-9. -]{0,14}[\])]?\s*+")


class HeadKeys(FileTable, frozen=True, kw_only=True):
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


ALL_COLUMNS = HeadChoice()  # choice of all columns of a file, under their names there


@dataclass(frozen=True)
class Head:
    """Column head: its text in the file, its known name or "", its unit or "", and the index of its column."""

    text: str
    name: str
    unit: str = ""
    column: int = 0

    @property
    def plain_texts(self) -> tuple[str, str]:
        """Plain names of the text with and without the unit in brackets."""
        return plain_name(self.text), plain_name(re.split(r"[\[(]", self.text)[0])

    def factor(self, kind: Kind) -> float:
        """Return the factor from the unit of the column to mm, N, MPa or rad.

        Raises ValueError: a missing unit, or the unit of another quantity.
        """
        if kind is Kind.NUMBER:
            return parse(self.text, f"1 {'' if self.unit in ('-', '1') else self.unit}".strip(), kind)
        if not self.unit:
            name = f"{self.name}_{kind.column_suffix}"
            raise ValueError(f"column {shown(self.text)} has no unit: use {name}, or another unit")
        return parse(f"the unit of {self.text}", f"1 {self.unit}", kind)


def split_head(text: str, names: Collection[str]) -> Head:
    """Split a head such as "Force [N]", "Kraft in N" or "force_N" into one of the known names and a unit.

    The name is "" if it is not known, or if there is more before the unit, as in "Force 2 [N]".
    """
    marks = [match.start() for match in _SEPARATOR.finditer(text[:_MAX_HEAD_LENGTH])][:_MAX_HEAD_WORDS]
    for end in (len(text), *reversed(marks)) if len(text) <= _MAX_HEAD_LENGTH else ():
        start = text[:end]
        if _NAME.fullmatch(start) and (name := known_head(plain_name(start), names)):
            return split_head(text, ()) if _LABEL.fullmatch(text[end:]) else Head(text, name, _unit(text[end:]))
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
    lines : tuple of int
        Line of each row in the file.
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
    lines: Sequence[int]
    gaps: Mapping[str, tuple[int, str]] = field(default_factory=dict)
    left_out: Mapping[str, int] = field(default_factory=dict)
    in_degrees: bool | None = None
    is_opensim: bool = False

    def __len__(self) -> int:
        return len(self.columns[0]) if self.columns else 0

    def remark(self, unused: Mapping[str, int] = MappingProxyType({})) -> str:
        """Return the number of rows, and the lines that are left out; empty without such lines.

        `unused` are the numbers of rows that a result does not use, by their description.
        """
        counts = {**self.left_out, **unused}
        parts = [f"{counted(count, 'line')} {place}" for place, count in counts.items() if count]
        n_rows = len(self) - sum(unused.values())
        return f"{self.title}: {counted(n_rows, 'row')} read, left out {', '.join(parts)}" if parts else ""

    def items(self) -> Iterator[tuple[Head, Numbers]]:
        """Yield each head with the numbers below it."""
        return zip(self.heads, self.columns, strict=True)

    def in_units(
        self, kinds: Mapping[str, Kind], units: Mapping[str, str] = MappingProxyType({})
    ) -> dict[str, Numbers]:
        """Return the columns by name in mm, N, MPa or rad; `units` are the units of heads without one.

        Raises ValueError: a missing unit, or the unit of another quantity.
        """
        with refusals_of(self.title):
            heads = [replace(head, unit=head.unit or units.get(head.name, "")) for head in self.heads]
            factors = {head.name: head.factor(kinds[head.name]) for head in heads}
        return {head.name: factors[head.name] * values for head, values in self.items()}

    def numbers(self, name: str) -> Numbers:
        """Return the numbers of a column without gaps.

        Raises ValueError: a row has no finite number; the message has its line.
        """
        if name in self.gaps:
            line, cell = self.gaps[name]
            content = shown(cell) if cell else "nothing"
            raise ValueError(f"line {line} has {content} for {name}: each line needs a finite number in each column")
        return self.columns[[head.name for head in self.heads].index(name)]


@dataclass(frozen=True, kw_only=True, eq=False)
class CellTable:
    """Cells below column heads, each row with its line in the file; Excel files have cells of numbers.

    `title` has the sheet if there are several. `left_out` has the numbers of lines that are not used, by description.
    """

    title: str
    heads: tuple[Head, ...]
    rows: Sequence[NumberedRow]
    separator: str
    left_out: Mapping[str, int] = field(default_factory=dict)

    def cells(self, head: Head) -> list[tuple[int, Cell]]:
        """Return the line and the content of each cell in a column."""
        return [(line, row[head.column] if head.column < len(row) else "") for line, row in self.rows]

    def numbers(self, heads: Sequence[Head]) -> NumberTable:
        """Convert columns to numbers.

        Raises ValueError: numbers whose decimal mark is ambiguous, or more than fit into the memory.
        """
        check_memory(
            f"{plain_number(len(self.rows), 3)} rows of {self.title}", _COPIES * 8 * len(self.rows) * len(heads)
        )
        cells = [self.cells(head) for head in heads]
        mark = decimal_mark(chain.from_iterable(cells), self.separator)
        columns = tuple(numpy.array([cell_number(cell, mark) for _, cell in column]) for column in cells)
        gaps = {}
        for head, column, values in zip(heads, cells, columns, strict=True):
            if not numpy.isfinite(values).all():
                line, cell = column[int(numpy.isfinite(values).argmin())]
                gaps[head.name] = line, str(cell)
        lines, left_out = tuple(line for line, _ in self.rows), self.left_out
        return NumberTable(
            title=self.title, heads=tuple(heads), columns=columns, lines=lines, gaps=gaps, left_out=left_out
        )


def read_columns(path: Path, names: Collection[str], choice: HeadChoice = ALL_COLUMNS) -> NumberTable:
    """Read the columns of numbers in a file.

    Text is in UTF-8, UTF-16 or cp1252. Its cells are separated by semicolons, tabs, vertical bars, commas or blanks,
    and may have quotes. All rows decide between decimal point and decimal comma. Lines above the heads, comments (#),
    blank lines and lines without a number are left out, and counted. Units stand in the heads, or in the line below.

    Parameters
    ----------
    path : Path
    names : collection of str
        Names of the columns that are known.
    choice : HeadChoice
        Columns that get another name, or that are not used.

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
    reader = _HeadReader(names, choice)
    with refusals_of(path.name):
        raw = _read_bytes(path)
        if raw.startswith(b"PAR1"):
            return _read_parquet(path, reader)
        lines = [] if raw.startswith((OLD_EXCEL, EXCEL)) else decode_text(raw).split("\n")
        if end := next((index for index, line in enumerate(lines) if line.strip().lower() == _HEADER_END), None):
            return _parse_opensim(path.name, lines, end)
        table = _parse_table(path.name, raw, reader)
        reader.check_known(table.heads)
        return table.numbers(table.heads)


def read_cells(path: Path, names: Collection[str], choice: HeadChoice, texts: Collection[str]) -> CellTable:
    """Read the cells of a table in text or Excel; the name of a head that is not known is "".

    The names in `texts` are those of columns of text, whose heads have no unit.

    Raises ValueError: a file that is too large or no table, a known column that appears twice, or two tables with the
    same columns.
    Raises ImportError: an optional extra is not installed.
    Raises OSError: the file cannot be read.
    """
    with refusals_of(path.name):
        return _parse_table(path.name, _read_bytes(path), _HeadReader(names, choice, texts))


def find_cells(
    title: str, candidates: Iterable[tuple[str, Sequence[NumberedRow]]], names: Collection[str]
) -> CellTable:
    """Find the table with the most known heads among separators with their rows; raise ValueError without any."""
    reader = _HeadReader(names, ALL_COLUMNS)
    return _best_block(candidates, reader).parse(title, reader)


def _read_bytes(path: Path) -> bytes:
    """Read the content of a table, or the beginning of a Parquet file."""
    resolved = resolve_input(path)
    if resolved.exists() and not resolved.is_file():
        raise ValueError("it is not a regular file")
    with open_input(path) as stream:
        raw = stream.read(_MAX_BYTES + 1)
    if len(raw) > _MAX_BYTES and not raw.startswith(b"PAR1"):
        raise ValueError(f"a table has at most {_MAX_BYTES // 1_000_000} MB: cut it, or save it as Parquet")
    return raw


def _parse_table(title: str, raw: bytes, reader: _HeadReader) -> CellTable:
    """Find the table in text, or in the sheet of an Excel file with the most known heads."""
    if raw.startswith(OLD_EXCEL):
        raise ValueError("an old Excel file (.xls) is not read: save it as .xlsx or CSV")
    if not raw.startswith(EXCEL):
        return _best_block(split_text(decode_text(raw)), reader).parse(title, reader)
    sheets = read_excel(raw)
    blocks = {name: _best_block([("", rows)], reader) for name, rows in sheets.items()}
    name = max(blocks, key=lambda name: blocks[name].score)
    others = [other for other in sheets if other != name]
    for other in others:
        if blocks[other].score[0] == blocks[name].score[0] > 0:
            raise ValueError(f"the sheets {shown(name)} and {shown(other)} have such columns: keep one of them")
    table = blocks[name].parse(f"{title}, sheet {shown(name)}" if others else title, reader)
    n_lines = sum(bool(count_words(cells)) for other in others for _, cells in sheets[other])
    return replace(table, left_out={**table.left_out, "in other sheets": n_lines})


class _HeadReader:
    """Reader of column heads, with the names that are known and the choice of the user."""

    def __init__(self, names: Collection[str], choice: HeadChoice, texts: Collection[str] = ()) -> None:
        self.names, self.texts, self.choice = names, texts, choice
        self.targets = {plain_name(head): name for head, name in choice.columns.items()}
        self.skipped = {plain_name(head) for head in choice.skip}

    def target(self, head: Head) -> str:
        """Return the name that the user gives to a head; "" for none."""
        return next((self.targets[text] for text in head.plain_texts if text in self.targets), "")

    def read(self, text: str, unit_below: str = "", column: int = 0) -> Head:
        """Return the head of a column, whose unit may stand below it; raise ValueError for two units."""
        head = replace(split_head(text, self.names), column=column)
        target = self.target(head)
        if self.skips(head):
            return head
        if name := known_head(plain_name(target or text), self.texts):
            return Head(text, name, column=column)
        wanted = split_head(target, self.names) if target else head
        unit = head.unit or unit_below
        if _parse_unit(unit_below) and not _are_equal(unit, unit_below):
            raise ValueError(f"column {shown(text)} has the unit {unit_below} in the line below: correct one of them")
        if wanted.unit and unit and not _are_equal(wanted.unit, unit):
            raise ValueError(f"columns names {shown(target)} for {shown(text)}, but the file has the unit {unit}")
        return Head(text, wanted.name, wanted.unit or unit, column)

    def skips(self, head: Head) -> bool:
        """Return True if the column is not used."""
        return any(text in self.skipped for text in head.plain_texts)

    def count(self, cells: Iterable[Cell]) -> tuple[int, int]:
        """Count the heads in a row that are known; with such heads, the others are a negative number."""
        names = (*self.names, *self.texts)
        heads = [split_head(cell, names) for cell in cells if isinstance(cell, str) and cell]
        named = [head for head in heads if head.name and (_parse_unit(head.unit) or not re.search("[,;\t]", head.text))]
        known = sum(head in named or bool(self.target(head)) or self.skips(head) for head in heads)
        return known, known - len(heads) if known else min(len(heads), 2)

    def choose(self, heads: Sequence[Head]) -> tuple[Head, ...]:
        """Return the heads that are used; raise ValueError for equal names, or a choice that matches no head."""
        present = {text for head in heads for text in head.plain_texts}
        for key, chosen in (("columns", self.choice.columns), ("skip", self.choice.skip)):
            for text in chosen:
                if plain_name(text) not in present:
                    columns = ", ".join(shown(head.text) for head in heads[:_MAX_LISTED])
                    raise ValueError(f"{key} names {shown(text)}, but the columns are {columns}")
        used = tuple(head for head in heads if not self.skips(head))
        self.check_known(head for head in used if self.target(head))
        for name, count in Counter(head.name for head in used if head.name).items():
            if count > 1:
                raise ValueError(f"the column {name} appears twice: skip one with skip = [...]")
        return used

    def check_known(self, heads: Iterable[Head]) -> None:
        """Raise ValueError for a head that is not known."""
        head = next((head for head in heads if not head.name), None)
        if head is None:
            return
        if target := self.target(head):
            hint = nearest(plain_name(target), (*self.names, *self.texts))
            raise ValueError(f"columns names {shown(target)} for {shown(head.text)}{hint}")
        if not head.text:
            raise ValueError("a column of numbers has no head: name it, or skip it with skip = ['']")
        names = [name for name in self.names if not name.endswith(UNCERTAINTY)]
        text, close = shown(head.text), closest(plain_name(head.text), names)
        hint = f"did you mean {close!r}?" if close else f"known: {', '.join(names[:_MAX_NAMES])}, ...;"
        raise ValueError(
            f"column {text} is not known; {hint} columns = {{{text} = '{close or 'NAME'}'}} names it, "
            f"skip = [{text}] leaves it out"
        )


def _parse_unit(text: str) -> Units | str:
    """Return a unit, or a text such as "%BW"; empty for other text."""
    try:
        return parse_units(text)
    except ValueError:
        return text if text.startswith("%") else ""


def _are_equal(unit: str, other: str) -> bool:
    return (_parse_unit(unit) or unit) == (_parse_unit(other) or other)


@dataclass(frozen=True, kw_only=True)
class _Block:
    """Heads above rows of numbers, with their score and the separator of cells; -1 for no heads."""

    rows: Sequence[NumberedRow] = ()
    separator: str = ""
    score: tuple[int, int] = (-1, 0)
    head: int = 0
    start: int = 0
    repeats: tuple[int, ...] = ()

    @property
    def rank(self) -> tuple[int, int]:
        """Order of separators, of which the first with the largest rank is chosen: known heads, numbers, cells."""
        n_cells = count_words(self.rows[self.head][1]) if self.rows else 0
        return self.score[0] + (self.start < len(self.rows)), min(n_cells, 2)

    def parse(self, title: str, reader: _HeadReader) -> CellTable:
        """Return the cells below the heads; raise ValueError for wrong heads, or several tables with the same."""
        if self.score[0] < 0:
            raise ValueError("it has no line of column heads above lines of numbers")
        if self.repeats and self.score[0]:
            lines = ", ".join(str(self.rows[head][0]) for head in (self.head, *self.repeats[:_MAX_LISTED]))
            raise ValueError(f"it has several tables with these columns, in lines {lines}: keep one")
        texts = [str(cell) for cell in self.rows[self.head][1]]
        between = [cells for _, cells in self.rows[self.head + 1 : self.start]]
        units = next((cells for cells in reversed(between) if _are_units(cells, texts)), ())
        body, left_out = _select_rows(self.rows, self.start)
        width = max((index + 1 for index, text in enumerate(texts) if text), default=0)
        for line, cells in body:
            is_wide = any(cell != "" for cell in cells[max(width, len(texts)) :])
            if is_wide or (self.separator == " " and len(cells) < width):
                raise ValueError(
                    f"line {line} has {counted(len(cells), 'cell')}, the line of heads {width}: decimal commas and "
                    "empty cells need semicolons or tabs between the cells, or quotes"
                )
        filled = {index for _, cells in body for index, cell in enumerate(cells) if cell != ""}
        heads = [
            reader.read(text, _unit(f"_{unit}"), index)
            for index, (text, unit) in enumerate(zip_longest(texts, units, fillvalue=""))
            if text or index in filled
        ]
        chosen = reader.choose(heads)
        for line, cells in body if all(head.column for head in chosen) else ():  # a mean below an unused counter
            if str(cells[0])[:1].isalpha() and is_data(body[0][1][:1]) and not is_data(cells[:1]):
                raise ValueError(f"line {line} begins with {shown(cells[0])}, and other lines with a number: cut it")
        return CellTable(
            title=title,
            heads=chosen,
            rows=body,
            separator=self.separator,
            left_out={
                "above the heads": sum(bool(count_words(cells)) for _, cells in self.rows[: self.head]),
                "between heads and numbers": sum(bool(count_words(cells)) for cells in between) - bool(units),
                **left_out,
            },
        )


def _best_block(candidates: Iterable[tuple[str, Sequence[NumberedRow]]], reader: _HeadReader) -> _Block:
    """Find the best known heads; the candidates are separators of cells, with the rows."""
    best = _Block()
    for separator, rows in candidates:
        for block in _find_blocks(rows, reader):
            if block.score > best.score if rows is best.rows else block.rank > best.rank:
                best = replace(block, separator=separator)
            elif block.score == best.score and rows is best.rows:
                best = replace(best, repeats=(*best.repeats, block.head))
        if best.score[0] > 1 and not best.score[1]:
            break  # all heads are known
    return best


def _find_blocks(rows: Sequence[NumberedRow], reader: _HeadReader) -> Iterator[_Block]:
    """Yield the heads above each group of rows with numbers; without such rows, the last heads."""
    above: list[int] = []
    n_blocks = 0
    for index, (_, cells) in enumerate([*rows, (0, [0.0])]):
        if not is_data(cells):
            above = [*above, index][-_MAX_HEAD_ROWS:] if any(cells) else above
            continue
        if above and n_blocks < (_MAX_TABLES if index < len(rows) else 1):
            lines = [(reader.count(rows[index][1]), count_words(rows[index][1]), -index) for index in above]
            score, _, head = max(lines)
            yield _Block(rows=rows, score=score, head=-head, start=index)
            n_blocks += 1
        above = []


def _are_units(cells: Sequence[Cell], texts: Sequence[str]) -> bool:
    """Return True for a row of units; below heads with a unit in brackets, other text is none."""
    units = [str(cell) for cell in cells if count_words([cell])]
    has_units = any(mark in text for text in texts for mark in "[(")

    def is_unit(text: str) -> bool:
        unit = _unit(f"_{text}")
        return bool(count_factor(unit) or (_parse_unit(unit) if has_units else _UNIT_CELL.fullmatch(text)))

    return bool(units) and len(cells) <= len(texts) and all(map(is_unit, units))


def _select_rows(rows: Sequence[NumberedRow], start: int) -> tuple[list[NumberedRow], dict[str, int]]:
    """Return the rows of numbers up to the heads of another table, and the numbers of the other rows.

    The other table has fewer rows, and a blank line above it.
    """
    body: list[NumberedRow] = []
    n_text = n_missing = n_blank = n_pending = n_other = 0
    for index in range(start, len(rows)):
        cells = rows[index][1]
        if is_data(cells):
            body.append(rows[index])
            n_blank, n_pending = n_blank + n_pending, 0
        elif (n_words := count_words(cells)) > 1:
            if sum(is_data(cells) for _, cells in rows[index:]) > (len(body) if n_pending else 0):
                raise ValueError(f"line {rows[index][0]} has text between numbers: cut the lines above or below it")
            n_other = sum(bool(count_words(cells)) for _, cells in rows[index:])
            break
        elif n_words == 0 and any(cells):
            n_missing += 1
        else:
            n_text, n_pending = n_text + n_words, n_pending + (not n_words)
    return body, {
        "of text": n_text,
        "of signs for missing numbers": n_missing,
        "of another table below": n_other,
        "blank or with a comment": n_blank,
    }


def _parse_opensim(title: str, lines: Sequence[str], end: int) -> NumberTable:
    settings = {
        name.strip().lower(): value.strip()
        for name, _, value in (line.strip().partition("=" if "=" in line else " ") for line in lines[:end])
    }  # `nRows=5`, or in old files `datarows 5`
    rows = [(number, line.split()) for number, line in enumerate(lines[end + 1 :], end + 2) if line.strip()]
    if not rows:
        raise ValueError("it has no line of column heads below its header")
    stated = settings.get("nrows", settings.get("datarows", str(len(rows) - 1)))
    if stated != str(len(rows) - 1):
        raise ValueError(f"the header states {shown(stated)} rows, but the file has {len(rows) - 1}")
    heads = tuple(Head(text, text, column=column) for column, text in enumerate(rows[0][1]))
    in_degrees = {"yes": True, "no": False}.get(settings.get("indegrees", "").lower())
    table = CellTable(title=title, heads=heads, rows=rows[1:], separator=",").numbers(heads)
    return replace(table, in_degrees=in_degrees, is_opensim=True)


def _read_parquet(path: Path, reader: _HeadReader) -> NumberTable:
    needs("study", "pyarrow")
    from pyarrow import ArrowException, parquet

    try:
        with open_input(path) as stream, parquet.ParquetFile(stream) as file:
            texts = file.schema_arrow.names
            heads = reader.choose([reader.read(text) for text in texts])
            reader.check_known(heads)
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
    return NumberTable(title=path.name, heads=heads, columns=tuple(columns.values()), lines=range(1, n_rows + 1))
