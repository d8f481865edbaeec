"""Points of measured surfaces: clouds from text files, and the corners of meshes."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy

from ..core.arrays import Numbers
from ..core.checks import shown
from ..core.input_files import open_input
from ..core.mesh_files import read_mesh_file
from .meshes import LENGTH_UNITS, check_extent, length_of, read_mesh

_MESH_SUFFIXES = (".stl", ".obj", ".ply")
_CLOUD_SUFFIXES = (".xyz", ".csv", ".txt", ".asc", ".pts")
_MAX_BYTES = 100_000_000
"""Largest size of a file of points."""

_COMMENTS = ("#", "//", "%", "!")
_HEAD = re.compile(r"([xyz])(?:[ _]*[\[(]?([a-zµμ]*)[\])]?)?", re.IGNORECASE)
"""Head of a column of coordinates with its unit, such as `x`, `Y [mm]` or `z_mm`."""

_MICRON = {"µm": "um", "μm": "um", "micron": "um"}


@dataclass(frozen=True, eq=False)
class PointCloud:
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
    comma is read where commas do not separate the columns.

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
    path, length = Path(path), length_of(units)
    suffix = path.suffix.lower()
    notes: tuple[str, ...] = ()
    if suffix == ".ply":
        points, _ = read_mesh_file(path)
        length = check_extent(points, units, path.name)
    elif suffix in _MESH_SUFFIXES:
        points, length = read_mesh(path, units=units).triangles.reshape(-1, 3), 1.0
    elif suffix in _CLOUD_SUFFIXES:
        points, notes = _read_text(path, units)
        length = check_extent(points, units, path.name)
    else:
        kinds = ", ".join((*_CLOUD_SUFFIXES, *_MESH_SUFFIXES))
        raise ValueError(
            f"{path.name} is not read: {shown(suffix)} is no suffix of points or meshes; save it as {kinds}"
        )
    return PointCloud(numpy.unique(points * length, axis=0), path.name, notes)


def _read_text(path: Path, units: str) -> tuple[Numbers, tuple[str, ...]]:
    """Return the points (n, 3) of a text, and notes on columns that are not read."""
    with open_input(path) as file:
        raw = file.read(_MAX_BYTES + 1)
    if len(raw) > _MAX_BYTES:
        raise ValueError(f"{path.name} has more than {_MAX_BYTES // 1_000_000} MB, the most that is read")
    text = raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", errors="replace")
    lines = [line for line in map(str.strip, text.splitlines()) if line and not line.startswith(_COMMENTS)]
    if lines and lines[0].isdigit():  # number of points, as .pts files have it
        lines = lines[1:]
    if not lines:
        raise ValueError(f"{path.name} has no points")
    separator = next((mark for mark in (";", "\t", ",") if mark in lines[-1]), None)
    if separator == "," and len(lines[-1].split()) >= 3:  # blanks between numbers with decimal commas
        separator = None if ", " not in lines[-1] else ","
    heads = [cell.strip().strip('"') for cell in lines[0].split(separator)]
    columns, notes = [0, 1, 2], []
    if any(map(_is_number, heads)):
        if len(heads) > 3:
            notes.append(f"{path.name}: columns 4 to {len(heads)} are not read: x, y and z are the first three")
    else:
        columns, lines = _find_columns(heads, units, path.name), lines[1:]
    if len(heads) < 3:
        raise ValueError(f"{path.name} has {len(heads)} columns in {shown(lines[0])}: a point has three, x y z")
    if separator != ",":
        lines = [line.replace(",", ".") for line in lines]
    try:
        points = numpy.loadtxt(lines, delimiter=separator, usecols=columns, ndmin=2, comments=None, quotechar='"')
    except (ValueError, IndexError) as error:
        cells = [line.split(separator) for line in lines]
        bad = [line for line, row in zip(lines, cells, strict=True) if not _has_point(row, columns)]
        line = shown(bad[0] if bad else lines[0])
        raise ValueError(f"{path.name}: {line} is no point, three numbers x y z as in the other lines") from error
    return points, tuple(notes)


def _is_number(cell: str) -> bool:
    """Return True for a number with a decimal point or comma."""
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True


def _has_point(cells: Sequence[str], columns: Sequence[int]) -> bool:
    """Return True for a row with numbers in some columns."""
    return len(cells) > max(columns) and all(_is_number(cells[column]) for column in columns)


def _find_columns(heads: Sequence[str], units: str, name: str) -> list[int]:
    """Return the columns of x, y and z; raise ValueError for heads without them, or with another unit."""
    matches = {index: match for index, head in enumerate(heads) if (match := _HEAD.fullmatch(head))}
    columns = {match[1].lower(): index for index, match in reversed(matches.items())}
    if set(columns) != set("xyz"):
        raise ValueError(f"{name} has the columns {', '.join(map(shown, heads))[:200]}: name three of them x, y and z")
    stated = {_MICRON.get(unit, unit) for index in columns.values() if (unit := (matches[index][2] or "").lower())}
    if len(stated) > 1:
        raise ValueError(
            f"{name} has columns in different units, {' and '.join(sorted(stated))}: write all in one unit"
        )
    if stated - {units}:
        unit = stated.pop()
        remedy = f"state --stl-units {unit}" if unit in LENGTH_UNITS else f"write them in {', '.join(LENGTH_UNITS)}"
        raise ValueError(f"{name} states the unit {shown(unit)} in its heads, but is read in {units}: {remedy}")
    return [columns[axis] for axis in "xyz"]
