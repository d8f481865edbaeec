"""Points of measured surfaces: clouds from text files, and the corners of meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy

from ..core.arrays import Numbers
from ..core.checks import shown
from ..core.display import counted
from ..core.input_files import open_input
from ..core.mesh_files import read_mesh_file
from ..core.records import Input
from ..files.cells import NumberedRow, decode_text, is_data, split_text
from ..files.columns import CellTable, find_cells
from .meshes import LENGTH_UNITS, MICRON, check_extent, length_of, read_mesh

_CLOUD_SUFFIXES = (".xyz", ".csv", ".txt", ".asc", ".pts")
_MAX_BYTES = 100_000_000  # largest size of a file of points
_COMMENTS = ("#", "//", "%", "!")
_AXES = ("x", "y", "z")
_HEAD_LINES = 100  # number of lines in which heads, separators and the first points are searched


@dataclass(frozen=True, eq=False)
class PointCloud(Input):
    """Points of a measured surface.

    Attributes
    ----------
    points : array (n, 3)
        Coordinates in mm, each point once.
    name : str
        Name of the file, for messages.
    notes : tuple of str
        Sentences on columns that are not read.
    """

    points: Numbers
    name: str = "cloud"
    notes: tuple[str, ...] = ()


def read_points(path: str | Path, *, units: str = "mm") -> PointCloud:
    """Read points from text with columns x, y, z (.xyz, .csv, .txt, .asc, .pts) or from a mesh (.stl, .obj, .ply).

    Columns are separated by blanks, tabs, commas or semicolons. Without heads, the first three are x, y, z. A decimal
    comma is read where commas do not separate the columns. Numbers have no mark between thousands.

    Parameters
    ----------
    path : str or Path
    units : str
        Unit of the coordinates: "mm" (default), "cm", "m", "um" or "in".

    Raises
    ------
    ValueError
        A file of another kind, too large, or with fewer than three columns of numbers; heads that state another unit; a
        size that no bore has in that unit.
    ImportError
        An OBJ or PLY file without the package meshio.
    OSError
        The file cannot be read.
    """
    path, _ = Path(path), length_of(units)
    suffix = path.suffix.lower()
    notes: tuple[str, ...] = ()
    if suffix in (".stl", ".obj"):
        points = read_mesh(path, units=units).triangles.reshape(-1, 3)
    elif suffix in (".ply", *_CLOUD_SUFFIXES):
        points, notes = (read_mesh_file(path)[0], ()) if suffix == ".ply" else _read_text(path, units)
        points = points * check_extent(points, units, path.name)
    else:
        kinds = ", ".join((*_CLOUD_SUFFIXES, ".stl", ".obj", ".ply"))
        raise ValueError(
            f"{path.name} is not read: {shown(suffix)} is no suffix of points or meshes; save it as {kinds}"
        )
    return PointCloud(numpy.unique(points, axis=0), path.name, notes)


def _read_text(path: Path, units: str) -> tuple[Numbers, tuple[str, ...]]:
    """Return the points (n, 3) of a text, and notes on columns that are not read."""
    with open_input(path) as file:
        raw = file.read(_MAX_BYTES + 1)
    if len(raw) > _MAX_BYTES:
        raise ValueError(f"{path.name} has more than {_MAX_BYTES // 1_000_000} MB, the most that is read")
    try:
        lines = ["" if line.startswith(_COMMENTS) else line for line in map(str.strip, decode_text(raw).split("\n"))]
        first = next((number for number, line in enumerate(lines) if line), None)
        if first is None:
            raise ValueError("it has no points")
        n_stated = lines[first] if lines[first].isdigit() else ""  # number of points, as .pts files have it
        lines[first] = lines[first].removeprefix(n_stated)
        tables = list(split_text("\n".join(lines[: first + _HEAD_LINES])))
        table = find_cells(path.name, _without_heads(tables) or tables, _AXES)
        points, notes = _read_points(lines, table, _find_columns(table, units))
        if n_stated and int(n_stated) != len(points):
            raise ValueError(
                f"its first line states {counted(int(n_stated), 'point')}, and it has {len(points)}: save it again"
            )
        return points, notes
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from error


def _without_heads(tables: Sequence[tuple[str, list[NumberedRow]]]) -> list[tuple[str, list[NumberedRow]]]:
    """Return the table that begins with numbers, below the names of the axes; empty for a table with heads."""
    found: list[tuple[str, list[NumberedRow]]] = []
    width = 1
    for separator, rows in tables:
        cells = next((cells for _, cells in rows if any(cells)), [])
        numbers = all(is_data([cell]) and not str(cell).endswith(",") for cell in cells if cell)
        if numbers and len(cells) >= width:
            found, width = [(separator, [(0, [*_AXES, *[""] * (len(cells) - 3)]), *rows])], min(len(cells), 3)
    return found


def _read_points(lines: Sequence[str], table: CellTable, columns: Sequence[int]) -> tuple[Numbers, tuple[str, ...]]:
    """Return the points (n, 3) below the heads of a table, and a note on columns without heads."""
    start, separator = table.rows[0][0], table.separator
    numbers, body = zip(*((number, line) for number, line in enumerate(lines[start - 1 :], start) if line), strict=True)
    marks = {mark for mark in ".," if mark != separator and any(mark in line for line in body)}
    n_unnamed = sum(not head.text for head in table.heads)
    if separator == "," and (len({line.count(",") for line in body}) > 1 or (n_unnamed and not marks)):
        raise ValueError("its commas may separate numbers or decimals: write semicolons between the numbers")
    if len(marks) > 1:
        raise ValueError("it has decimal points and decimal commas: write one of them, and no mark between thousands")
    if "," in marks:
        body = tuple(line.replace(",", ".") for line in body)
    delimiter = None if separator == " " else separator
    try:
        points = numpy.loadtxt(body, delimiter=delimiter, usecols=columns, ndmin=2, comments=None, quotechar='"')
    except (ValueError, IndexError) as error:
        rows = [[cell.strip(' "') for cell in line.split(delimiter)] for line in body]
        bad = (row for row, cells in enumerate(rows) if not all(is_data(cells[axis : axis + 1]) for axis in columns))
        row = next(bad, 0)
        raise ValueError(
            f"line {numbers[row]} has {shown(lines[numbers[row] - 1])}: that is no point, three numbers x y z"
        ) from error
    note = f"{table.title}: not read: {counted(n_unnamed, 'column')} without a name, behind x, y and z"
    return points, (note,) * bool(n_unnamed)


def _find_columns(table: CellTable, units: str) -> list[int]:
    """Return the columns of x, y and z; raise ValueError for heads without them, or with another unit."""
    heads = {head.name: head for head in table.heads}
    if not table.rows:
        raise ValueError("it has no points")
    if not set(_AXES) <= set(heads):
        names = ", ".join(shown(head.text) for head in table.heads)
        raise ValueError(f"it has the columns {names[:200]}: name three of them x, y and z")
    stated = {MICRON.get(unit, unit) for axis in _AXES if (unit := heads[axis].unit.lower())}
    if len(stated) > 1:
        raise ValueError(f"it has columns in different units, {' and '.join(sorted(stated))}: write all in one unit")
    if stated - {units}:
        unit = stated.pop()
        remedy = f"state --stl-units {unit}" if unit in LENGTH_UNITS else f"write them in {', '.join(LENGTH_UNITS)}"
        raise ValueError(f"it states the unit {shown(unit)} in its heads, but is read in {units}: {remedy}")
    return [heads[axis].column for axis in _AXES]
