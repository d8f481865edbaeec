"""Bores as they were measured: scans of triangles, the sphere that fits them best, and what deviates from it."""

from __future__ import annotations

from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from math import radians
from pathlib import Path
from typing import Any

import numpy

from ...core.arrays import Numbers
from ...core.checks import check_number, needs, require
from ...core.input_files import open_input, resolve_input
from ...core.quantities import AIM
from .worn import Measured


@dataclass(frozen=True, kw_only=True, eq=False)
class Scan(Measured):
    """A bore as it was measured: the sphere that fits it best, and how the surface deviates from that.

    Attributes
    ----------
    radius : float
        Of the sphere in mm.
    centre : array (3,)
        In mm, in the scan's frame.
    axis : array (3,)
        Unit vector from the centre to the middle of what was scanned: the dome's pole.
    reach : float
        The polar angle in rad that the scan covers.
    roughness : float
        Root mean square of the deviations, in mm.
    directions, deviation : array (3, points), (points,)
        Unit vectors in the cup's frame, and how much deeper than the sphere the surface is there, in mm.
    """

    radius: float
    centre: Numbers
    axis: Numbers
    reach: float
    roughness: float
    directions: Numbers
    deviation: Numbers

    def between(self, directions: Numbers) -> Numbers:
        """From planes through the nearest points, no deeper and no higher than these; as far as the scan goes."""
        far, which = self._tree.query(numpy.moveaxis(directions, 0, -1), k=min(_NEAREST, len(self.deviation)))
        weights = (1 - 0.999 * (far / far[..., -1:]) ** 2) ** 2  # the farthest is about to be another
        beside = numpy.moveaxis((self.directions[:, which] - directions[..., None]) / far[..., -1:], 0, -1)
        terms = numpy.concatenate([numpy.ones_like(beside[..., :1]), beside], axis=-1)
        heavy = weights[..., None] * terms
        matrices = heavy.swapaxes(-1, -2) @ terms + numpy.diag([0.0, *3 * [_FLAT]])
        values = self.deviation[which]
        planes = numpy.linalg.solve(matrices, heavy.swapaxes(-1, -2) @ values[..., None])
        depth: Numbers = numpy.clip(planes[..., 0, 0], values.min(axis=-1), values.max(axis=-1))
        return depth

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        return cKDTree(self.directions.T)


_NEAREST, _FLAT = 24, 1e-3
_FEWEST = 200
_FURTHEST = 1e6
_NARROWEST = radians(25.0)
_ROUGHEST = 0.03
_COARSEST = 0.35


_FINEST = radians(4.0)


def read_scan(path: str | Path, finest: float = _FINEST, azimuth: float = 0.0) -> Scan:
    """A scan of a bore from a mesh of triangles (STL, PLY, OBJ) in mm.

    The sphere is the least-squares fit to the points; the cup's axis runs from its centre to the middle of what was
    scanned. Only the bore may be in the file, not the cup's outside.

    Parameters
    ----------
    path : path
    finest : float
        In rad, above 0 and at most 0.35 (20°); 4° by default. Points that lie so near are one, their mean: a
        micrometre of noise from point to point would be a pressure of its own.
    azimuth : float
        How the scan is turned around the cup's axis: where its x lies, across that axis, in rad from the cup's x.
        Its y takes the place of an x that is within 25° of the axis.

    Raises
    ------
    ValueError
        What is no mesh; fewer than 200 points; points that lie on no sphere, or on a piece of one that is narrower
        than 25° or seen from outside; an angle that is not allowed.
    OSError
        The file cannot be read.
    """
    needs("fem", "meshio")
    path = Path(path)
    return scan_of(numpy.unique(_points(path), axis=0), path.name, finest, azimuth)


def _points(path: Path) -> Numbers:
    """The points (points, 3) of a mesh."""
    import meshio

    no_mesh = f"{path.name} is no mesh that can be read: it is cut short, or not what its name says"
    with open_input(path) as file:
        head = file.read(_HEAD)
    if path.suffix.lower() == ".ply" and b"end_header" not in head:
        raise ValueError(no_mesh)  # it would be read for ever
    try:
        with numpy.errstate(all="ignore"), redirect_stdout(StringIO()), redirect_stderr(StringIO()):  # meshio prints
            points = numpy.asarray(meshio.read(resolve_input(path)).points, dtype=float)
    except (meshio.ReadError, ValueError, TypeError, LookupError, AttributeError, AssertionError, SystemExit) as error:
        raise ValueError(no_mesh) from error
    if points.ndim != 2 or points.shape[1] < 3:
        raise ValueError(no_mesh)
    return points[:, :3]


_HEAD = 2**16
"""Bytes in which the head of a file ends."""


def scan_of(points: Numbers, name: str = "the scan", finest: float = _FINEST, azimuth: float = 0.0) -> Scan:
    """A scan from its points (points, 3) in mm; see `read_scan`."""
    size = check_number("finest", finest)
    require("finest", size, 0 < size <= _COARSEST, "what is averaged is above 0 and at most 0.35 radians (20°)")
    turned = check_number("azimuth", AIM["azimuth"].checked(azimuth))
    require(f"points of {name}", len(points), len(points) >= _FEWEST, f"a scan has {_FEWEST} points and more")
    require(f"points of {name}", points, numpy.isfinite(points), "a point is finite")
    near = abs(points) <= _FURTHEST
    require(f"points of {name}", points, near, f"coordinates (mm) are at most {_FURTHEST:g}")
    centre, radius = _fitted(points)
    out = points - centre
    length = numpy.linalg.norm(out, axis=1)
    roughness = float(numpy.sqrt(numpy.mean((length - radius) ** 2)))
    round_enough = f"{name} is not a bore: its points lie {roughness:.3g} mm off a sphere of {radius:.4g} mm"
    if not roughness < _ROUGHEST * radius:
        raise ValueError(round_enough)
    middle = (out / length[:, None]).mean(axis=0)
    beside = float(numpy.linalg.norm(middle))
    if beside < 1e-3:
        raise ValueError(f"{name} is not a bore: its points go all around")
    axis = middle / beside
    directions = _frame(axis, turned) @ (out / length[:, None]).T
    reach = float(numpy.arccos(numpy.clip(directions[2], -1, 1)).max())
    if reach < _NARROWEST:
        raise ValueError(f"{name} covers {numpy.degrees(reach):.0f}° around its pole; a bore takes 25° and more")
    return Scan(
        radius=radius,
        centre=centre,
        axis=axis,
        reach=reach,
        roughness=roughness,
        **_averaged(directions, length - radius, size),
    )


def _frame(axis: Numbers, azimuth: float) -> Numbers:
    """The cup's axes in the scan's frame (3, 3): z is the axis, and the scan's x, across that, lies at the azimuth."""
    near = numpy.eye(3)[0 if abs(axis[0]) < numpy.cos(_NARROWEST) else 1]
    x = near - (near @ axis) * axis
    x = x / numpy.linalg.norm(x)
    y = numpy.cross(axis, x)
    c, s = numpy.cos(azimuth), numpy.sin(azimuth)
    return numpy.stack([c * x - s * y, s * x + c * y, axis])


def _averaged(directions: Numbers, deviation: Numbers, size: float) -> dict[str, Numbers]:
    """The means of what lies in boxes of this size, on a sphere of radius 1."""
    boxes = numpy.round(directions.T / size).astype(int)
    _, which, count = numpy.unique(boxes, axis=0, return_inverse=True, return_counts=True)
    middle = numpy.stack([numpy.bincount(which.ravel(), each) for each in directions])
    return {
        "directions": middle / numpy.linalg.norm(middle, axis=0),
        "deviation": numpy.bincount(which.ravel(), deviation) / count,
    }


def _fitted(points: Numbers) -> tuple[Numbers, float]:
    """Centre and radius of the sphere nearest to the points: linear least squares, then of the distances."""
    from scipy.optimize import least_squares

    rows = numpy.hstack([2 * points, numpy.ones((len(points), 1))])
    first = numpy.linalg.lstsq(rows, (points**2).sum(axis=1), rcond=None)[0]
    start = numpy.append(first[:3], numpy.sqrt(max(first[3] + first[:3] @ first[:3], 1e-12)))

    def off(x: Numbers) -> Numbers:
        away: Numbers = numpy.linalg.norm(points - x[:3], axis=1) - x[3]
        return away

    found = least_squares(off, start).x
    return found[:3], float(found[3])
