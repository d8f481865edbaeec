"""Coordinate of the half angle in which tabulated functions of a contact are smooth."""

from __future__ import annotations

from math import radians

from ..core.arrays import Array, exp, log, log1p, sqrt

LIMIT = radians(85.0)  # largest half angle in rad of the exact solution and its tables

ANGLE_SCALE, RATIO_SHIFT = 0.8, 0.2
"""Scales of the coordinates of ε and R2/L; tables are valid for the scales they were built with."""


def angle_root(angle: Array, ratio: Array) -> Array:
    """Compute the half angle's coordinate from 0 to 1, the root of a scaled logarithm, accurate for tiny angles too."""
    scale = ANGLE_SCALE * (1 + ratio)
    return sqrt(log1p(scale * angle) / log1p(scale * LIMIT))


def half_angle_at(coordinate: Array, ratio: Array) -> Array:
    """Compute the half angle ε in rad from its table coordinate, which runs from -1 to 1."""
    scale, share = ANGLE_SCALE * (1 + ratio), (1 + coordinate) / 2
    return (exp(share * share * log(1 + scale * LIMIT)) - 1) / scale


def log_angle_derivative(angle: Array, root: Array, ratio: Array) -> Array:
    """Compute the derivative of ln ε with respect to the table coordinate 2 root - 1."""
    near = ANGLE_SCALE * (1 + ratio)
    return (1 + near * angle) * log1p(near * LIMIT) * root / (near * angle)
