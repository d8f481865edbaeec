"""The points of a study from a file: the rows of a CSV or Parquet table."""

from __future__ import annotations

from array import array
from pathlib import Path

import numpy

from ..arrays import Numbers
from ..checks import check_names
from .axes import TableAxis, column
from .design import Design
from .parameters import PARAMETERS


def table(path: str | Path) -> Design:
    """The rows of a CSV or Parquet file, whose columns are named like parameters, in mm, N, MPa and rad.

    A column that ends in `_deg` is in degrees.

    Raises
    ------
    ValueError
        A column that is not known; a value that is missing or no number, named with its row.
    OSError
        The file cannot be read.
    """
    path = Path(path)
    if path.suffix.lower() not in _READERS:
        raise ValueError(f"{str(path)!r} must end in {' or '.join(_READERS)}")
    columns = {}
    for name, values in _READERS[path.suffix.lower()](path).items():
        parameter = _NAMES.get(name, name)
        if parameter in columns:
            raise ValueError(f"{path.name} has {parameter} twice")
        check_names([parameter], PARAMETERS, f"among the columns of {path.name}")
        found = column(parameter, values, row=f" in row {{}} of {path.name}")
        columns[parameter] = numpy.radians(found) if name != parameter else found
    if not columns:
        raise ValueError(f"{path.name} has no columns")
    return Design((TableAxis(columns),))


_NAMES = {quantity.key: name for name, quantity in PARAMETERS.items()}


def _read_csv(path: Path) -> dict[str, Numbers]:
    import csv

    with path.open(encoding="utf-8-sig", newline="") as stream:
        reader = csv.reader(stream, strict=True)
        heads = next(reader, [])
        for name in heads:
            if heads.count(name) > 1:
                raise ValueError(f"{path.name} has {name} twice")
        columns = [array("d") for _ in heads]
        for number, row in enumerate(row for row in reader if row):
            if len(row) > len(heads):
                raise ValueError(f"row {number} of {path.name} has more cells than there are columns")
            for place, found in enumerate(columns):
                found.append(_number(row[place] if place < len(row) else ""))
    return {name: numpy.array(found) for name, found in zip(heads, columns, strict=True)}


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")


def _read_parquet(path: Path) -> dict[str, Numbers]:
    from ..checks import needs

    needs("study", "pyarrow")
    from pyarrow import parquet

    read = parquet.read_table(path)
    return {name: read.column(name).to_numpy() for name in read.column_names}


_READERS = {".csv": _read_csv, ".parquet": _read_parquet}
