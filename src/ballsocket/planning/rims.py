"""Rims of spherical surfaces: the plane in which a surface ends, and the two planes of a liner with a lip."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, cos, pi, radians, sin

import numpy

from ..core.arrays import Numbers
from .geometry import Plane, angle_between, fit_plane_robustly
from .surfaces import Mesh

_RIM_SECTORS = 120

RIM_TOLERANCE = radians(1.0)
"""Distance of points from the plane of a rim over the radius, up to which they belong to it."""

_MIN_SECTORS = 0.5  # least share of the sectors around the axis in which a rim must have points
_SECTOR_OFFSET = 0.37  # start of the sectors over their width: corners of a regular mesh are not between two sectors
_MIN_LIP = 0.1  # least share of the rim that a lip has
_MAX_TILT = radians(35.0)  # largest angle between the axis of a liner and the planes of its rim

DISTINCT_AXES = radians(1.0)
"""Angle from which two planes of a rim give different axes."""

_MIN_EVIDENCE = 0.1  # relative difference of the outer surface's moments about two axes from which one is right
_SPHERE_MOMENTS = 0.02  # moments of the normals of a faceted sphere, over its area and radius
_MIN_LOWER = 0.33  # least share of the rim from which the lower one of two parallel planes is the main one
_PLANE_PASSES = 4  # number of times that the ends of a bore are divided between the two planes of its rim
_SAME_AXIS = radians(3.0)  # angle to the outer surface up to which the plane of the rim is the more exact axis
_MIN_END = 0.75  # least share of the end of an outer surface that lies in a plane, if the plane gives the axis


@dataclass(frozen=True, kw_only=True, eq=False)
class RimPlane:
    """Plane in which a part of the rim lies.

    Attributes
    ----------
    normal : array (3,)
        Unit normal out of the opening, in the coordinates of the file.
    height : float
        Distance in mm from the centre of the bore, positive out of the opening.
    share : float
        Share of the circumference whose rim lies in the plane.
    """

    normal: Numbers
    height: float
    share: float


def fit_rim(corners: Numbers, pole: Numbers, name: str) -> tuple[Numbers, float, float]:
    """Fit a plane to the end of a spherical surface, given by its facets (n, 3, 3) and its approximate pole.

    The facets are relative to the centre, in radii. Points on the edges count: the edges of a rim lie in its plane.

    Returns the unit vector (3,) out of the opening, the polar angle in rad of the rim from the pole, and the largest
    angle in rad of the rim from the plane.
    """
    points, dome = edge_points(corners), pole / numpy.linalg.norm(pole)
    for _ in range(8):
        ends = farthest_points(points, dome)
        if len(ends) < _MIN_SECTORS * _RIM_SECTORS:
            raise ValueError(f"{name}: the spherical surface has no rim around its axis")
        plane = fit_plane_robustly(ends, RIM_TOLERANCE)
        normal = plane.normal if plane.normal @ dome > 0 else -plane.normal
        change, dome = float(normal @ dome), normal
        if change > 1 - 1e-12:
            break
    angle = acos(float(numpy.clip(plane.centre @ dome, -1.0, 1.0)))
    return -dome, angle, rim_deviation(ends, dome, angle)


def rim_deviation(ends: Numbers, dome: Numbers, angle: float) -> float:
    """Return the angle in rad by which most ends of a surface deviate from a plane rim at a polar angle."""
    return float(numpy.quantile(abs(ends @ dome - cos(angle)) / max(sin(angle), 0.1), 0.95))


def rim_planes(ends: Numbers, axis: Numbers, radius: float) -> tuple[RimPlane, ...]:
    """Find up to two planes in the ends of a bore (n, 3), relative to its centre in radii; the larger one first.

    A plane between both is near many of their points: a narrow tolerance avoids it, a wide one is needed for scatter.
    Of two parallel planes, the lower one is first if it has a third of the rim: a lip is raised.
    """
    tolerances = (RIM_TOLERANCE, RIM_TOLERANCE / 3.0)
    pairs = [_plane_pair(ends, tolerance) for tolerance in tolerances]
    planes = max(pairs, key=lambda pair: sum(int((abs(plane.distances) < tolerances[1]).sum()) for plane in pair))
    found = [
        RimPlane(
            normal=plane.normal * sign,
            height=radius * sign * float(plane.centre @ plane.normal),
            share=float((abs(plane.distances) < RIM_TOLERANCE).sum()) / len(ends),
        )
        for plane in planes
        for sign in (1.0 if plane.normal @ axis > 0 else -1.0,)
    ]
    fitting = [plane for plane in found if plane.share >= _MIN_LIP and plane.normal @ axis > cos(_MAX_TILT)]
    if len(fitting) == 2 and angle_between(fitting[0].normal, fitting[1].normal) < DISTINCT_AXES:
        lower, upper = sorted(fitting, key=lambda plane: plane.height)
        return (lower, upper) if lower.share > _MIN_LOWER else (upper, lower)
    return tuple(sorted(fitting, key=lambda plane: -plane.share))


def _plane_pair(ends: Numbers, tolerance: float) -> list[Plane]:
    """Fit one or two planes to the ends of a bore (n, 3), each to the points that are nearer to it."""
    planes: list[Plane] = []
    remaining = ends
    while len(planes) < 2 and len(remaining) >= max(_MIN_LIP * len(ends), 3):
        plane = fit_plane_robustly(remaining, tolerance)
        remaining = remaining[abs((remaining - plane.centre) @ plane.normal) > tolerance]
        planes.append(plane)
    for _ in range(_PLANE_PASSES):
        distances = numpy.array([abs((ends - plane.centre) @ plane.normal) for plane in planes])
        parts = [ends[distances.argmin(axis=0) == index] for index in range(len(planes))]
        planes = [fit_plane_robustly(part, tolerance) for part in parts if len(part) >= _MIN_LIP * len(ends)]
    return planes


def main_plane_first(
    planes: tuple[RimPlane, ...], outer: Mesh, moments: Numbers, centre: Numbers
) -> tuple[tuple[RimPlane, ...], Numbers, bool]:
    """Put the main one of two planes first, by the moments (n, 3) of the outer surface; return them, axis, and doubt.

    Two planes of a rim are equally good rims. The outer surface is turned around the axis of the liner: its normals
    meet it, so that the sum of the moments of the normals about it is smallest. A spherical outer surface has no such
    moments, but may end in one plane.
    """
    sums = [float(abs(moments @ plane.normal).sum()) for plane in planes]
    arms = numpy.linalg.norm(outer.middles - centre, axis=1)
    scale = max(numpy.linalg.norm(moments, axis=1).sum(), _SPHERE_MOMENTS * float(outer.areas @ arms))
    if abs(sums[0] - sums[1]) > _MIN_EVIDENCE * scale * sin(angle_between(planes[0].normal, planes[1].normal)):
        main, lip = planes if sums[0] < sums[1] else planes[::-1]
        axis = _turned_axis(moments, main.normal)
        return (main, lip), main.normal if angle_between(axis, main.normal) < _SAME_AXIS else axis, False
    normal = None  # of the plane in which the outer surface ends, if most of its end lies in one
    if len(outer.triangles):
        corners, dome = outer.triangles - centre, -planes[0].normal
        points = edge_points(corners / numpy.linalg.norm(corners, axis=2).mean())
        plane = fit_plane_robustly(farthest_points(points, dome), RIM_TOLERANCE)
        if numpy.mean(abs(plane.distances) < RIM_TOLERANCE) >= _MIN_END:
            normal = plane.normal if plane.normal @ dome < 0 else -plane.normal
    for main, lip in (planes, planes[::-1]):
        if normal is not None and angle_between(normal, main.normal) < DISTINCT_AXES:
            return (main, lip), main.normal, False
    return planes, planes[0].normal, True


def _turned_axis(moments: Numbers, start: Numbers) -> Numbers:
    """Find the axis with the smallest sum of the absolute moments (n, 3) about it, by reweighted least squares."""
    axis, sizes = start, numpy.linalg.norm(moments, axis=1)
    floor = 1e-9 * float(sizes.max())
    for _ in range(60):
        weights = 1.0 / numpy.maximum(abs(moments @ axis), floor + 1e-6 * sizes)
        vector = numpy.linalg.eigh((weights[:, None] * moments).T @ moments)[1][:, 0]
        vector = vector if vector @ axis > 0 else -vector
        change, axis = float(numpy.linalg.norm(vector - axis)), vector
        if change < 1e-12:
            break
    return axis


def edge_points(corners: Numbers) -> Numbers:
    """Return points (n, 3) on the edges of facets (n, 3, 3), as near as the sectors of a rim."""
    following = numpy.roll(corners, -1, axis=1)
    largest = float(numpy.linalg.norm(corners - following, axis=2).max())
    steps = min(int(numpy.ceil(largest / (pi / _RIM_SECTORS))), 20) or 1
    shares = [step / steps for step in range(steps)]
    return numpy.concatenate([((1 - share) * corners + share * following).reshape(-1, 3) for share in shares])


def farthest_points(points: Numbers, dome: Numbers) -> Numbers:
    """Return the point of the largest polar angle from the dome in each sector around it.

    The sectors begin at the first point far from the dome: they turn and move with the file.
    """
    height = points @ dome / numpy.linalg.norm(points, axis=1)
    reference = points[(abs(height) < 0.9).argmax()]
    first = reference - (reference @ dome) * dome
    first /= numpy.linalg.norm(first)
    azimuth = numpy.arctan2(points @ numpy.cross(dome, first), points @ first)
    sector = ((azimuth + pi) * (_RIM_SECTORS / (2 * pi)) + _SECTOR_OFFSET).astype(int) % _RIM_SECTORS
    order = numpy.argsort(-height, kind="stable")
    farthest = numpy.full(_RIM_SECTORS, -1)
    farthest[sector[order]] = order  # the last one stays
    ends: Numbers = points[farthest[farthest >= 0]]
    return ends
