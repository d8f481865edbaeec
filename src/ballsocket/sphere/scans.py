"""Bores as they were measured: scans of triangles, the sphere that fits them best, and what deviates from it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi, radians
from pathlib import Path
from typing import Any

import numpy

from ..arrays import Numbers
from ..checks import needs, one_number, require
from .directions import tangents
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
        """From the nearest points, weighted by the inverse square of their distance; as far as the scan goes."""
        far, which = self._tree.query(numpy.moveaxis(directions, 0, -1), k=_NEAREST)
        weights = 1 / (far**2 + (_BLUNT * self._spacing) ** 2)
        depth: Numbers = (weights * self.deviation[which]).sum(axis=-1) / weights.sum(axis=-1)
        return depth

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        return cKDTree(self.directions.T)

    @property
    def _spacing(self) -> float:
        """About how far the points are from each other, in rad."""
        return float(numpy.sqrt(2 * pi * (1 - numpy.cos(self.reach)) / len(self.deviation)))


_NEAREST, _BLUNT = 6, 0.5
_FEWEST = 200
_NARROWEST = radians(25.0)
_ROUGHEST = 0.03
_COARSEST = 0.35


_FINEST = radians(4.0)


def read_scan(path: str | Path, finest: float = _FINEST) -> Scan:
    """A scan of a bore from a mesh of triangles (STL, PLY, OBJ) in mm.

    The sphere is the least-squares fit to the points; the cup's axis runs from its centre to the middle of what was
    scanned. Only the bore may be in the file, not the cup's outside.

    Parameters
    ----------
    path : path
    finest : float
        In rad, above 0 and at most 0.35 (20°); 4° by default. Points that lie so near are one, their mean: a
        micrometre of noise from point to point would be a pressure of its own.

    Raises
    ------
    ValueError
        What is no mesh; fewer than 200 points; points that lie on no sphere, or on a piece of one that is narrower
        than 25° or seen from outside.
    OSError
        The file cannot be read.
    """
    needs("fem", "meshio")
    import meshio

    path = Path(path)
    try:
        with numpy.errstate(all="ignore"):
            mesh = meshio.read(path)
    except (meshio.ReadError, ValueError, KeyError, IndexError, UnicodeDecodeError, SystemExit) as error:
        raise ValueError(f"{path.name} is no mesh that can be read: {error or type(error).__name__}") from error
    return scan_of(numpy.unique(numpy.asarray(mesh.points, dtype=float)[:, :3], axis=0), path.name, finest)


def scan_of(points: Numbers, name: str = "the scan", finest: float = _FINEST) -> Scan:
    """A scan from its points (points, 3) in mm; see `read_scan`."""
    size = one_number("finest", finest)
    require("finest", size, 0 < size <= _COARSEST, "what is averaged is above 0 and at most 0.35 radians (20°)")
    require(f"points of {name}", len(points), len(points) >= _FEWEST, f"a scan has {_FEWEST} points and more")
    require(f"points of {name}", points, numpy.isfinite(points), "a point is finite")
    centre, radius = _fitted(points)
    out = points - centre
    length = numpy.linalg.norm(out, axis=1)
    roughness = float(numpy.sqrt(numpy.mean((length - radius) ** 2)))
    round_enough = f"{name} is not a bore: its points lie {roughness:.3g} mm off a sphere of {radius:.4g} mm"
    if not roughness < _ROUGHEST * radius:
        raise ValueError(round_enough)
    middle = (out / length[:, None]).mean(axis=0)
    size = float(numpy.linalg.norm(middle))
    if size < 1e-3:
        raise ValueError(f"{name} is not a bore: its points go all around")
    axis = middle / size
    directions = numpy.stack([*tangents(axis), axis]) @ (out / length[:, None]).T
    reach = float(numpy.arccos(numpy.clip(directions[2], -1, 1)).max())
    if reach < _NARROWEST:
        raise ValueError(f"{name} covers {numpy.degrees(reach):.0f}° around its pole; a bore takes 25° and more")
    return Scan(
        radius=radius,
        centre=centre,
        axis=axis,
        reach=reach,
        roughness=roughness,
        **_averaged(directions, length - radius, finest),
    )


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
