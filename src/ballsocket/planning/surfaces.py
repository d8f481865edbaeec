"""Surfaces of liners, heads and worn bores from files: triangles of STL, OBJ and PLY, and points from text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import BinaryIO

import numpy

from ..core.arrays import Numbers
from ..core.checks import refusals_of, shown
from ..core.display import counted
from ..core.input_files import open_input, read_input
from ..core.mesh_files import read_mesh_file
from ..core.records import Input
from ..files.cells import NumberedRow, decode_text, is_data, split_text
from ..files.columns import CellTable, find_cells

_MAX_FILE_SIZE = 200_000_000  # largest size of an STL file in bytes
_STL_SUFFIXES, _MESHIO_SUFFIXES = ("", ".stl"), (".obj", ".ply")
_BINARY_HEADER, _BINARY_FACET = 84, 50  # bytes of the header and of a facet of a binary STL file
_MAX_LINE = 1000  # largest length of a line of an ASCII STL file in bytes; the first facet begins within as many bytes

LENGTH_UNITS = MappingProxyType({"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 0.001, "in": 25.4})
"""Length in mm of each unit of a file."""

MICRON = MappingProxyType({"µm": "um", "μm": "um", "micron": "um"})
"""Other names of the micrometre in files."""

_SIZES = (12.0, 200.0)  # allowed largest extent of a liner or head in mm
_MAX_OPEN_AREA = 0.2  # sum of area vectors over total area below which a mesh with holes has a signed volume


@dataclass(frozen=True, eq=False)
class Mesh(Input):
    """Triangles of a mesh.

    Attributes
    ----------
    triangles : array (n, 3, 3)
        Corners in mm.
    name : str
        Name of the file, for messages.
    space : str or None
        "RAS" or "LPS" if the header states the coordinates of a scan, as 3D Slicer writes it.
    """

    triangles: Numbers
    name: str = "mesh"
    space: str | None = None

    @cached_property
    def _area_vectors(self) -> Numbers:
        """Return the normals times the areas in mm², out of a closed body."""
        first, second, third = self.triangles.transpose(1, 0, 2)
        vectors: Numbers = numpy.cross(second - first, third - first) / 2
        closed = numpy.linalg.norm(vectors.sum(axis=0)) < _MAX_OPEN_AREA * numpy.linalg.norm(vectors, axis=1).sum()
        volume = numpy.sum((self.middles - self.middles.mean(axis=0)) * vectors)
        return -vectors if closed and volume < 0 else vectors

    @cached_property
    def areas(self) -> Numbers:
        """Areas of the triangles in mm²: (n,)."""
        return numpy.linalg.norm(self._area_vectors, axis=1)

    @cached_property
    def middles(self) -> Numbers:
        """Centroids of the triangles in mm: (n, 3)."""
        return self.triangles.mean(axis=1)

    @cached_property
    def normals(self) -> Numbers:
        """Unit normals of the triangles: (n, 3)."""
        return self._area_vectors / self.areas[:, None]

    def part(self, selection: Numbers, equal_areas: bool = False) -> Mesh:
        """Return the triangles of a mask or of indices with their normals, and with equal areas if required."""
        part = replace(self, triangles=self.triangles[selection])
        part.__dict__["_area_vectors"] = (self.normals if equal_areas else self._area_vectors)[selection]
        return part


def read_mesh(path: str | Path, *, units: str = "mm") -> Mesh:
    """Read a mesh: an STL file, binary or ASCII, or with the package meshio an OBJ or PLY file by its suffix.

    Parameters
    ----------
    path : str or Path
    units : str
        Unit of the coordinates, which these files do not state: "mm" (default), "cm", "m", "um" or "in".

    Raises
    ------
    ValueError
        A file that is truncated, too large, or of another kind; coordinates that are not finite; a size that no liner
        or head has in that unit.
    ImportError
        An OBJ or PLY file without the package meshio.
    OSError
        The file cannot be read.
    """
    path, header = Path(path), b""
    length_of(units)
    if path.suffix.lower() in _MESHIO_SUFFIXES:
        points, corners = read_mesh_file(path)
        triangles = points[corners]
    else:
        with open_input(path) as stream:
            triangles, header = _read_stl(stream, path)
    if not len(triangles):
        raise ValueError(f"{path.name} has no triangles")
    length = check_extent(triangles.reshape(-1, 3), units, path.name)
    space = next((word for word in ("RAS", "LPS") if f"SPACE={word}".encode() in header), None)  # by 3D Slicer
    mesh = Mesh(triangles * length, path.name, space)
    return mesh.part(mesh.areas > 0)


def _read_stl(stream: BinaryIO, path: Path) -> tuple[Numbers, bytes]:
    """Return the triangles (n, 3, 3) of a file and its header."""
    name, size = path.name, stream.seek(0, 2)
    if size > _MAX_FILE_SIZE:
        raise ValueError(f"{name} has {size / 1e6:.0f} MB: at most {_MAX_FILE_SIZE // 1_000_000} are read")
    stream.seek(0)
    start = stream.read(_BINARY_HEADER)
    count = int.from_bytes(start[80:84], "little") if len(start) == _BINARY_HEADER else -1
    if size == _BINARY_HEADER + _BINARY_FACET * count:
        kind = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        return numpy.frombuffer(stream.read(), dtype=kind)["corners"].astype(float), start[:80]
    beginning = start + stream.read(_MAX_LINE)
    if beginning.lstrip()[:5].lower() != b"solid" or b"facet" not in beginning.lower():
        if start[:4].strip() == b"ply":
            raise ValueError(f"{name} is a PLY file: name it with the suffix .ply")
        if path.suffix.lower() not in _STL_SUFFIXES:
            raise ValueError(
                f"{name} is not read: {shown(path.suffix.lower())} is no suffix of a mesh; save it as STL, OBJ or PLY"
            )
        expected = f"its header states {counted(count, 'triangle')}, {_BINARY_HEADER + _BINARY_FACET * count} bytes"
        raise ValueError(
            f"{name} is a truncated or damaged binary STL: {size} bytes, "
            + (expected if count >= 0 else f"less than the header of {_BINARY_HEADER}")
        )
    stream.seek(0)
    try:
        numbers = numpy.fromiter(_ascii_coordinates(stream), float)
    except ValueError as error:
        raise ValueError(f"{name} is a truncated or damaged ASCII STL: {error}") from error
    return numbers.reshape(-1, 3, 3), beginning[:80]


def _ascii_coordinates(stream: BinaryIO) -> Iterator[float]:
    """Yield the coordinates of an ASCII STL file, nine for each facet."""
    vertices, facets, complete = 0, 0, False
    for line in iter(lambda: stream.readline(_MAX_LINE), b""):
        words = line.split()
        keyword = words[0].lower() if words else b""
        if keyword == b"vertex":
            if len(words) != 4:
                raise ValueError(f"a vertex is not three numbers, {shown(line.decode('latin-1').strip())}")
            vertices += 1
            yield from map(float, words[1:])
        elif keyword == b"endfacet":
            facets += 1
            if vertices != 3 * facets:
                raise ValueError(f"facet {facets} has not three vertices")
        complete = keyword == b"endsolid" or (complete and not words)
    if not complete or vertices != 3 * facets:
        raise ValueError("`endsolid` is missing at its end")


def check_extent(points: Numbers, units: str, name: str) -> float:
    """Return the length in mm of a unit, in which points (n, 3) have the size of a liner or head.

    Raises ValueError: an unknown unit; coordinates that are not finite; an extent that no liner or head has.
    """
    length = length_of(units)
    if not numpy.isfinite(points).all():
        raise ValueError(f"{name}: {counted((~numpy.isfinite(points)).sum(), 'coordinate')} without a finite number")
    low, high = _SIZES
    extent = float(numpy.ptp(points, axis=0).max())
    if not low <= extent * length <= high:
        fitting = [
            f"{unit} ({extent * other:.3g} mm)" for unit, other in LENGTH_UNITS.items() if low <= extent * other <= high
        ]
        raise ValueError(
            f"{name} is {extent:.3g} {units} large: a liner or head has {low:g} to {high:g} mm; "
            + (f"its unit may be {' or '.join(fitting)}" if fitting else "in no known unit it is one")
        )
    return length


def length_of(unit: str) -> float:
    """Return the length in mm of a unit; raise ValueError for an unknown one."""
    if unit not in LENGTH_UNITS:
        raise ValueError(f"units = {shown(unit)} is not allowed: {', '.join(LENGTH_UNITS)}")
    return LENGTH_UNITS[unit]


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
    raw = read_input(path, _MAX_BYTES)
    with refusals_of(path.name):
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
