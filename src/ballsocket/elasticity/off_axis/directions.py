"""Directions in the cup's frame: unit vectors, angles and tangents.

Arrays of vectors have their components first. Only arrays that come from a user have them last.
"""

from __future__ import annotations

from dataclasses import replace
from math import radians
from typing import Any

import numpy

from ...core import arrays
from ...core.arrays import Array, Numbers
from ...core.checks import check_vectors, require
from ...core.quantities import AIM, CUP
from ...problem.cup import Cup

TILT_TOLERANCE = radians(0.02)
"""Largest step in a search for a tilt that is not solved any more: 0.006 mm of arc in a bore of 18 mm."""

_SMALLEST_COMPONENT = 1e-100  # squares of smaller components underflow


def check_direction(direction: Any) -> Numbers:
    """Validate directions (..., 3) of any length and return them as floats.

    Those whose squared length would overflow or underflow are scaled.

    Raises ValueError: an array without a last axis of 3, a length of zero, a component that is not finite.
    Raises TypeError: an array that does not contain numbers.
    """
    values = arrays.to_numpy(check_vectors("direction", direction, "x, y, z of a direction")).astype(float)
    largest = abs(values).max(axis=-1)
    require("length of direction", largest, (largest > 0) & (largest < numpy.inf), "a length is finite and above 0")
    squared_well = (largest > _SMALLEST_COMPONENT) & (largest < 1 / _SMALLEST_COMPONENT)
    return numpy.where(squared_well, 1.0, 1 / largest)[..., None] * values


def tilted_directions(tilt: Array, azimuth: Array | None) -> Numbers:
    """Compute unit vectors (..., 3) in the cup's frame from a tilt and an azimuth (0 by default) in rad."""
    inputs = {"tilt": tilt, "azimuth": 0.0 if azimuth is None else azimuth}
    angles = (arrays.to_numpy(AIM[name].check(angle)) for name, angle in inputs.items())
    return numpy.moveaxis(unit_vectors(*numpy.broadcast_arrays(*angles)), 0, -1)


def cup_frames(cup: Cup, inclination: Array | None, anteversion: Array | None) -> Numbers:
    """Compute the frames (..., 3, 3) of a cup rotated to other inclinations and anteversions in rad.

    An angle that is None keeps the value of the cup.
    """
    inputs = {"inclination": inclination, "anteversion": anteversion}
    given = {name: getattr(cup, name) if angle is None else angle for name, angle in inputs.items()}
    angles = numpy.stack(numpy.broadcast_arrays(*(arrays.to_numpy(CUP[name].check(given[name])) for name in given)))
    frames = [replace(cup, inclination=a, anteversion=b).frame for a, b in angles.reshape(2, -1).T.tolist()]
    return numpy.array(frames).reshape(*angles.shape[1:], 3, 3)


def unit_vectors(polar: Numbers, azimuth: Numbers) -> Numbers:
    """Compute unit vectors (3, ...) from polar angles and azimuths in rad."""
    radius = numpy.sin(polar)
    return numpy.stack([radius * numpy.cos(azimuth), radius * numpy.sin(azimuth), numpy.cos(polar) + 0 * azimuth])


def polar_angle(direction: Numbers) -> Numbers:
    """Compute the angle in rad between the pole of the dome and directions (3, ...) of any length."""
    x, y, z = direction
    return numpy.arctan2(numpy.hypot(x, y), z)


def tangents(directions: Numbers) -> tuple[Numbers, Numbers]:
    """Compute two tangent unit vectors (3, ...) that form a right-handed frame with each direction."""
    axis = numpy.moveaxis(numpy.eye(3)[abs(directions).argmin(axis=0)], -1, 0)
    first = axis - (axis * directions).sum(axis=0) * directions
    first = first / numpy.linalg.norm(first, axis=0)
    return first, numpy.cross(directions, first, axis=0)


def magnitudes_and_directions(vectors: Numbers) -> tuple[Numbers, Numbers]:
    """Compute lengths (n,) and unit vectors (n, 3) of vectors; a zero vector stays zero."""
    length = numpy.linalg.norm(vectors, axis=1)
    return length, vectors / numpy.where(length > 0, length, 1.0)[:, None]
