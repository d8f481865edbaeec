"""The columns of a CSV or Parquet file, by their heads: read strictly, and no further than there is room for."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterator, Sequence
from io import TextIOWrapper
from pathlib import Path
from typing import TextIO

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs, shown
from ..core.input_files import open_input, resolve_input
from .room import check_rows

Check = Callable[[Sequence[str]], None]
"""Refuses heads before what is below them is read."""

_LONGEST_LINE = 100_000
_OFTEN = 1 << 16  # rows after which the room is looked at


def read_columns(path: Path, check: Check) -> dict[str, Numbers]:
    """Columns by their heads; a cell that is empty or no number is NaN.

    Raises
    ------
    ValueError
        Another ending, what is no CSV or Parquet, or more rows than there is memory for.
    OSError
        The file cannot be read.
    """
    if path.suffix.lower() not in _READERS:
        raise ValueError(f"{shown(str(path))} must end in {' or '.join(_READERS)}")
    resolved = resolve_input(path)
    if resolved.exists() and not resolved.is_file():
        raise ValueError(f"{path.name} is no file")
    return _READERS[path.suffix.lower()](path, check)


def _read_csv(path: Path, check: Check) -> dict[str, Numbers]:
    import csv

    with TextIOWrapper(open_input(path), encoding="utf-8-sig", newline="") as stream:
        reader = csv.reader(_lines(stream, path.name), strict=True)
        try:
            heads = next(reader, [])
            check(heads)
            columns = _rows(reader, path.name, len(heads))
        except csv.Error as error:
            raise ValueError(f"{path.name} is not CSV: {error}, in line {reader.line_num}") from error
        except UnicodeDecodeError as error:
            raise ValueError(f"{path.name} is not text in UTF-8: {error.reason}") from error
    return dict(zip(heads, columns, strict=True))


def _lines(stream: TextIO, title: str) -> Iterator[str]:
    """The lines of a text, one of which could be as long as the memory; remarks before the heads are passed over."""
    heads = False
    while line := stream.readline(_LONGEST_LINE):
        if len(line) == _LONGEST_LINE:
            raise ValueError(f"{title} has a line of more than {_LONGEST_LINE} characters")
        heads = heads or not line.startswith("#")
        if heads:
            yield line


def _rows(reader: Iterator[list[str]], title: str, width: int) -> list[Numbers]:
    columns = [array("d") for _ in range(width)]
    for number, row in enumerate(row for row in reader if row):
        if len(row) > width:
            raise ValueError(f"row {number} of {title} has more cells than there are columns")
        if number % _OFTEN == 0:
            check_rows(title, number, width)
        for place, found in enumerate(columns):
            found.append(_number(row[place] if place < len(row) else ""))
    return [numpy.array(found) for found in columns]


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")


def _read_parquet(path: Path, check: Check) -> dict[str, Numbers]:
    needs("study", "pyarrow")
    from pyarrow import ArrowException, parquet

    try:
        with open_input(path) as stream, parquet.ParquetFile(stream) as file:
            heads = file.schema_arrow.names
            check(heads)
            check_rows(path.name, file.metadata.num_rows, len(heads))
            read = file.read()
            return {name: read.column(name).to_numpy() for name in heads}
    except (ArrowException, OSError) as error:  # what it cannot decode is an OSError without a number
        if isinstance(error, OSError) and error.errno is not None:
            raise
        raise ValueError(f"{path.name} is not Parquet that can be read: {error}") from error


_READERS = {".csv": _read_csv, ".parquet": _read_parquet}
