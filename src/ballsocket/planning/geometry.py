"""Least-squares planes through points, angles and distances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers

_TUKEY = 4.685  # residual over the scale beyond which a point has no weight (Tukey's biweight)
_NORMAL_MAD = 1.4826  # standard deviation over the median absolute deviation of normal scatter
_ITERATIONS = 20
_SEED, _TRIPLES = 20260102, 300


@dataclass(frozen=True, kw_only=True, eq=False)
class Plane:
    """Least-squares plane."""

    centre: Numbers  # (3,), centroid of the points
    normal: Numbers  # (3,), unit normal of either sign
    distances: Numbers  # (n,), distances of the points from the plane, along the normal
    # (2,), root of the sum of squares of the points along the two main directions in the plane, the larger first
    spread: Numbers

    @property
    def residual(self) -> float:
        """Root mean square of the distances."""
        return float(numpy.sqrt(numpy.mean(self.distances**2)))

    @property
    def angle_error(self) -> float | None:
        """Standard error of the normal in rad, from the scatter of the points; None for three points."""
        freedom = len(self.distances) - 3
        if freedom < 1:
            return None
        return float(numpy.sqrt(numpy.sum(self.distances**2) / freedom) / self.spread[1])


def fit_plane(points: Numbers, weights: Numbers | None = None) -> Plane:
    """Fit a plane to points (n, 3) with weights (n,)."""
    weight = numpy.ones(len(points)) if weights is None else weights
    centre = weight @ points / weight.sum()
    _, sizes, axes = numpy.linalg.svd(numpy.sqrt(weight)[:, None] * (points - centre), full_matrices=False)
    return Plane(centre=centre, normal=axes[2], distances=(points - centre) @ axes[2], spread=sizes[:2])


def fit_plane_robustly(points: Numbers, tolerance: float) -> Plane:
    """Fit a plane to points (n, 3) of which many lie off the plane.

    The start is the plane through three points with the most others within `tolerance`. The weights of its
    neighbours follow from their scatter, and end at `tolerance`.
    """
    triples = points[numpy.random.default_rng(_SEED).integers(len(points), size=(_TRIPLES, 3))]
    normals = numpy.cross(triples[:, 1] - triples[:, 0], triples[:, 2] - triples[:, 0])
    lengths = numpy.linalg.norm(normals, axis=1)
    wide = lengths > 0.1 * lengths.max()
    normals, origins = normals[wide] / lengths[wide, None], triples[wide, 0]
    inliers = abs(normals @ points.T - numpy.sum(normals * origins, axis=1)[:, None]) < tolerance
    mask = inliers[inliers.sum(axis=1).argmax()]
    plane = fit_plane(points, numpy.where(mask, 1.0, 1e-9))
    for _ in range(_ITERATIONS):
        scale = min(max(robust_scale(plane.distances[mask]), 0.01 * tolerance), tolerance / _TUKEY)
        weights = numpy.clip(1.0 - (plane.distances / (_TUKEY * scale)) ** 2, 1e-9, None) ** 2
        plane = fit_plane(points, weights)
        mask = weights > 1e-9
    return plane


def robust_scale(residuals: Numbers) -> float:
    """Estimate the standard deviation of residuals of mean zero from their median absolute value."""
    return _NORMAL_MAD * float(numpy.median(abs(residuals)))


def polar(points: Numbers, centre: Numbers) -> tuple[Numbers, Numbers]:
    """Return the unit vectors (n, 3) and the distances (n,) of points from a centre."""
    offsets = points - centre
    distances = numpy.linalg.norm(offsets, axis=1)
    return offsets / numpy.maximum(distances, 1e-12)[:, None], distances


def angle_between(first: Numbers, second: Numbers) -> float:
    """Return the angle in rad between two unit vectors (3,)."""
    return float(numpy.arctan2(numpy.linalg.norm(numpy.cross(first, second)), first @ second))
