"""Points and triangles of mesh files, read by meshio."""

from __future__ import annotations

import re
from contextlib import redirect_stderr, redirect_stdout
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any

import numpy

from .arrays import Numbers
from .checks import needs
from .display import counted
from .input_files import read_input, resolve_input

_HEADER_BYTES = 2**16  # number of bytes in which the header of a file ends
_MAX_BYTES = 200_000_000  # largest size of a mesh file


def read_mesh_file(path: Path) -> tuple[Numbers, Numbers]:
    """Read the points (n, 3) and the triangles (m, 3), as indices of points, of an STL, OBJ or PLY file.

    Polygons are split into triangles. A file of points alone has no triangles.

    Raises ValueError: a file that is too large, incomplete or no mesh; indices of points that are not in the file.
    Raises ImportError: the package meshio is not installed.
    Raises OSError: the file cannot be read.
    """
    needs("fem", "meshio")
    import meshio  # slow to import

    message = f"{path.name} cannot be read as a mesh: the file is incomplete or its suffix is wrong"
    raw = read_input(path, _MAX_BYTES)
    source: Any = resolve_input(path)
    suffix, first_index, n_stated = path.suffix.lower(), 1, None
    if suffix == ".obj":  # meshio takes only as many normals and textures as points: points and faces are enough
        lines = [line for line in raw.splitlines() if line.split(maxsplit=1)[:1] in ([b"v"], [b"f"])]
        source = StringIO(b"\n".join(lines).decode("latin-1"))
    elif suffix == ".ply":
        head, end, body = raw[:_HEADER_BYTES].partition(b"end_header")
        if not end:
            raise ValueError(message)  # meshio would read for ever
        head = head.replace(b" vertex_index\n", b" vertex_indices\n").replace(b" vertex_index\r", b" vertex_indices\r")
        source = BytesIO(head + end + body + raw[_HEADER_BYTES:])
        first_index, n_stated = 0, re.search(rb"element vertex +(\d+)", head)
    try:
        with numpy.errstate(all="ignore"), redirect_stdout(StringIO()), redirect_stderr(StringIO()):  # meshio prints
            mesh = meshio.read(source, file_format=suffix[1:])
            points = numpy.asarray(mesh.points, dtype=float)
            blocks = [_fans(numpy.asarray(cells.data, dtype=int)) for cells in mesh.cells]
    except (meshio.ReadError, ValueError, TypeError, LookupError, AttributeError, AssertionError, SystemExit) as error:
        raise ValueError(message) from error
    if points.ndim != 2 or points.shape[1] < 3:
        raise ValueError(message)
    if n_stated and int(n_stated[1]) != len(points):
        raise ValueError(
            f"{path.name} is incomplete: its header states {counted(int(n_stated[1]), 'point')}, and it has "
            f"{len(points)}: save it again"
        )
    triangles = numpy.concatenate([numpy.zeros((0, 3), dtype=int), *blocks])
    if len(triangles) and not 0 <= triangles.min() <= triangles.max() < len(points):
        wrong = first_index + (triangles.min() if triangles.min() < 0 else triangles.max())
        raise ValueError(
            f"{path.name}: a face names point {wrong}, and the file has {counted(len(points), 'point')}: count them "
            f"from {first_index}, not back from the last one"
        )
    return points[:, :3], triangles


def _fans(faces: Numbers) -> Numbers:
    """Split polygons (n, corners) into triangles (m, 3) around their first corner; lines have none."""
    corners = faces.shape[1] if faces.ndim == 2 else 0
    fans = [faces[:, [0, index, index + 1]] for index in range(1, corners - 1)]
    return numpy.concatenate([numpy.zeros((0, 3), dtype=int), *fans])
