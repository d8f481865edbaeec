"""Scans of bores: points of a mesh, the sphere that fits them best, and the deviation from it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import degrees, radians
from pathlib import Path
from typing import Any

import numpy

from ...core.arrays import Numbers
from ...core.checks import check_number, require
from ...core.mesh_files import read_mesh_file
from ...core.quantities import AIM
from .bore_shapes import InterpolatedDeviation

_NEIGHBOURS = 24  # number of nearest points that the local plane is fitted to
_SLOPE_PENALTY = 1e-3  # regularisation of the slope of the local plane

MIN_POINTS = 200  # least number of points of a bore
_MAX_COORDINATE = 1e6  # mm
MIN_REACH = radians(25.0)  # least polar angle that the points of a bore reach

_MAX_ROUGHNESS = 0.03  # root mean square deviation of a bore, as a fraction of its radius

_MAX_AVERAGING_ANGLE = 0.35
_AVERAGING_ANGLE = radians(4.0)

_ITERATIONS = 20  # largest number of steps of the fit of a sphere


@dataclass(frozen=True, kw_only=True, eq=False)
class Scan(InterpolatedDeviation):
    """Scan of a bore: the best-fit sphere, and the deviation of the surface from it.

    Attributes
    ----------
    radius : float
        Radius of the sphere in mm.
    centre : array (3,)
        Centre of the sphere in mm, in the scan's frame.
    axis : array (3,)
        Unit vector from the centre to the middle of the scanned surface: the pole of the dome.
    reach : float
        Polar angle in rad that the scan covers.
    roughness : float
        Root mean square of the deviations, in mm.
    directions, deviation : array (3, points), (points,)
        Unit vectors in the cup's frame, and the depth of the surface below the sphere there, in mm.
    """

    radius: float
    centre: Numbers
    axis: Numbers
    reach: float
    roughness: float
    directions: Numbers
    deviation: Numbers

    def interpolate(self, directions: Numbers) -> Numbers:
        """Interpolate the depth of the bore in mm at unit vectors (3, ...), by planes through the nearest points.

        The depth stays between the smallest and the largest of these points, also beyond the end of the scan.
        """
        count = min(_NEIGHBOURS, len(self.deviation))
        distance, index = self._search_tree.query(numpy.moveaxis(directions, 0, -1), k=count)
        scale = distance[..., -1:]
        weights = (1 - 0.999 * (distance / scale) ** 2) ** 2  # small for the farthest: continuous when it changes
        offsets = numpy.moveaxis((self.directions[:, index] - directions[..., None]) / scale, 0, -1)
        terms = numpy.concatenate([numpy.ones_like(offsets[..., :1]), offsets], axis=-1)
        weighted = weights[..., None] * terms
        matrices = weighted.swapaxes(-1, -2) @ terms + numpy.diag([0.0, *3 * [_SLOPE_PENALTY]])
        values = self.deviation[index]
        planes = numpy.linalg.solve(matrices, weighted.swapaxes(-1, -2) @ values[..., None])
        return numpy.clip(planes[..., 0, 0], values.min(axis=-1), values.max(axis=-1))

    @cached_property
    def _search_tree(self) -> Any:
        from scipy.spatial import cKDTree  # slow to import

        return cKDTree(self.directions.T)


def read_scan(path: str | Path, finest: float = _AVERAGING_ANGLE, azimuth: float = 0.0) -> Scan:
    """Read a scan of a bore from a triangle mesh (STL, PLY, OBJ) in mm.

    The sphere is the least-squares fit to the points. The cup's axis runs from its centre to the middle of the scanned
    surface. The file must contain the bore alone, without the outer surface of the cup.

    Parameters
    ----------
    path : path
    finest : float
        Angle in rad, above 0 and at most 0.35 (20°); 4° by default. Points within this angle are averaged. Otherwise
        noise of a micrometre between neighbouring points would produce a pressure.
    azimuth : float
        Azimuth in the cup's frame, in rad, of the scan's x axis, projected perpendicular to the cup's axis. If x lies
        within 25° of that axis, the scan's y replaces it.

    Raises
    ------
    ValueError
        A file without a mesh; fewer than 200 points; points off a sphere, on its outside, or within 25° of its pole; an
        angle outside its range.
    OSError
        A file that cannot be read.
    """
    path = Path(path)
    points, _ = read_mesh_file(path)
    return scan_from_points(numpy.unique(points, axis=0), path.name, finest, azimuth)


def scan_from_points(
    points: Numbers, name: str = "the scan", finest: float = _AVERAGING_ANGLE, azimuth: float = 0.0
) -> Scan:
    """Make a scan of a bore from points (points, 3) in mm; `read_scan` explains the arguments."""
    size = check_number("finest", finest)
    allowed = f"an angle above 0 and at most {_MAX_AVERAGING_ANGLE:g} radians ({degrees(_MAX_AVERAGING_ANGLE):.0f}°)"
    require("finest", size, 0 < size <= _MAX_AVERAGING_ANGLE, allowed)
    rotation = check_number("azimuth", AIM["azimuth"].check(azimuth))
    require(f"points of {name}", len(points), len(points) >= MIN_POINTS, f"a scan has at least {MIN_POINTS} points")
    require(f"points of {name}", points, numpy.isfinite(points), "a point is finite")
    in_range = abs(points) <= _MAX_COORDINATE
    require(f"points of {name}", points, in_range, f"coordinates (mm) are at most {_MAX_COORDINATE:g}")
    centre, radius = fit_sphere(points)
    vectors = points - centre
    length = numpy.linalg.norm(vectors, axis=1)
    roughness = float(numpy.sqrt(numpy.mean((length - radius) ** 2)))
    if not roughness < _MAX_ROUGHNESS * radius:
        raise ValueError(f"{name} is not a bore: its points lie {roughness:.3g} mm off a sphere of {radius:.4g} mm")
    mean = (vectors / length[:, None]).mean(axis=0)
    mean_length = float(numpy.linalg.norm(mean))
    if mean_length < 1e-3:
        raise ValueError(f"{name} is not a bore: its points cover a full sphere, without an opening")
    axis = mean / mean_length
    directions = _cup_axes(axis, rotation) @ (vectors / length[:, None]).T
    reach = float(numpy.arccos(numpy.clip(directions[2], -1, 1)).max())
    if reach < MIN_REACH:
        raise ValueError(f"{name} covers {degrees(reach):.0f}° around its pole; a scan needs {degrees(MIN_REACH):.0f}°")
    directions, deviation = _average_in_boxes(directions, length - radius, size)
    return Scan(
        radius=radius,
        centre=centre,
        axis=axis,
        reach=reach,
        roughness=roughness,
        directions=directions,
        deviation=deviation,
    )


def _cup_axes(axis: Numbers, azimuth: float) -> Numbers:
    """Compute the cup's axes (3, 3) in the scan's frame, from the cup's axis z and the azimuth of the scan's x."""
    reference = numpy.eye(3)[0 if abs(axis[0]) < numpy.cos(MIN_REACH) else 1]
    x = reference - (reference @ axis) * axis
    x = x / numpy.linalg.norm(x)
    y = numpy.cross(axis, x)
    c, s = numpy.cos(azimuth), numpy.sin(azimuth)
    return numpy.stack([c * x - s * y, s * x + c * y, axis])


def _average_in_boxes(directions: Numbers, deviation: Numbers, size: float) -> tuple[Numbers, Numbers]:
    boxes = numpy.round(directions.T / size).astype(int)
    _, box, count = numpy.unique(boxes, axis=0, return_inverse=True, return_counts=True)
    sums = numpy.stack([numpy.bincount(box.ravel(), component) for component in directions])
    return sums / numpy.linalg.norm(sums, axis=0), numpy.bincount(box.ravel(), deviation) / count


def fit_sphere(points: Numbers, weights: Numbers | None = None) -> tuple[Numbers, float]:
    """Fit a sphere to points (n, 3) with weights (n,), by orthogonal distances; return its centre and radius."""
    weight = numpy.ones(len(points)) if weights is None else weights
    origin = weight @ points / weight.sum()
    local, root = points - origin, numpy.sqrt(weight)
    terms = numpy.column_stack([2.0 * local, numpy.ones(len(local))])
    solution = numpy.linalg.lstsq(root[:, None] * terms, root * numpy.sum(local**2, axis=1), rcond=None)[0]
    centre, radius = solution[:3], float(numpy.sqrt(max(solution[3] + solution[:3] @ solution[:3], 0.0)))
    for _ in range(_ITERATIONS):
        offset = local - centre
        distance = numpy.linalg.norm(offset, axis=1)
        jacobian = numpy.column_stack([-offset / numpy.maximum(distance, 1e-12)[:, None], -numpy.ones(len(local))])
        step = numpy.linalg.lstsq(root[:, None] * jacobian, root * (radius - distance), rcond=None)[0]
        centre, radius = centre + step[:3], radius + float(step[3])
        if numpy.linalg.norm(step) < 1e-9 * abs(radius):
            break
    return origin + centre, radius
