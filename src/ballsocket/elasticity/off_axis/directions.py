"""Directions in the cup's frame: their angles, and what lies across them.

Vectors have their components first, but where a user gives them.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy

from ...core import arrays
from ...core.arrays import Array, Numbers
from ...core.checks import check_vectors, require
from ...core.quantities import AIM, CUP
from ...problem.cup import Cup

_SMALL = 1e-100  # a component that small, and its inverse, need not have a square


def checked_direction(direction: Any) -> Numbers:
    """Directions (..., 3) that point somewhere, of lengths that have a square."""
    found = arrays.to_numpy(check_vectors("direction", direction, "x, y, z of a direction")).astype(float)
    largest = abs(found).max(axis=-1)
    require("length of direction", largest, (largest > 0) & (largest < numpy.inf), "a direction points somewhere")
    squared_well = (largest > _SMALL) & (largest < 1 / _SMALL)
    return numpy.where(squared_well, 1.0, 1 / largest)[..., None] * found


def tilted(tilt: Array, azimuth: Array | None) -> Numbers:
    """Unit vectors (..., 3) in the cup's frame at a tilt from its axis and an azimuth around that, in rad."""
    given = {"tilt": tilt, "azimuth": 0.0 if azimuth is None else azimuth}
    angles = (arrays.to_numpy(AIM[name].checked(angle)) for name, angle in given.items())
    return numpy.moveaxis(unit_vectors(*numpy.broadcast_arrays(*angles)), 0, -1)


def frames_of(cup: Cup, inclination: Array | None, anteversion: Array | None) -> Numbers:
    """The frames (..., 3, 3) of a cup that stands in many ways; as it does where an angle is not given."""
    given = {"inclination": inclination, "anteversion": anteversion}
    angles = (
        arrays.to_numpy(CUP[name].checked(getattr(cup, name) if angle is None else angle))
        for name, angle in given.items()
    )
    pairs = numpy.broadcast_arrays(*angles)
    frames = [
        replace(cup, inclination=float(one), anteversion=float(other)).frame
        for one, other in zip(*(each.ravel() for each in pairs), strict=True)
    ]
    return numpy.array(frames).reshape(*pairs[0].shape, 3, 3)


def unit_vectors(polar: Numbers, azimuth: Numbers) -> Numbers:
    """Unit vectors (3, ...) at angles in rad."""
    across = numpy.sin(polar)
    parts = across * numpy.cos(azimuth), across * numpy.sin(azimuth), numpy.cos(polar) + 0 * azimuth
    return numpy.stack(parts)


def polar_angle(direction: Numbers) -> Numbers:
    """The angle in rad from the dome's pole to directions (3, ...) of any length."""
    x, y, z = direction
    angle: Numbers = numpy.arctan2(numpy.hypot(x, y), z)
    return angle


def tangents(directions: Numbers) -> tuple[Numbers, Numbers]:
    """Two unit vectors (3, ...) across each unit vector and each other; the three are a right-handed frame."""
    least = numpy.moveaxis(numpy.eye(3)[abs(directions).argmin(axis=0)], -1, 0)
    one = least - (least * directions).sum(axis=0) * directions
    one = one / numpy.linalg.norm(one, axis=0)
    return one, numpy.cross(directions, one, axis=0)


def sized(vectors: Numbers) -> tuple[Numbers, Numbers]:
    """Lengths (n,) of vectors (n, 3), and unit vectors along them; those without a length stay so."""
    length = numpy.linalg.norm(vectors, axis=1)
    return length, vectors / numpy.where(length > 0, length, 1.0)[:, None]
