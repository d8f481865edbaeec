"""Directions in the cup's frame: their angles, and what lies across them. Vectors have their components first."""

from __future__ import annotations

import numpy

from ..arrays import Numbers


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
