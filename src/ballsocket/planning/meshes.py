"""Triangles of liners and heads from STL, OBJ and PLY files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import BinaryIO

import numpy

from ..core.arrays import Numbers
from ..core.checks import shown
from ..core.display import counted
from ..core.input_files import open_input
from ..core.mesh_files import read_mesh_file
from ..core.records import Input

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
