"""Rotations of the ball, and sliding of the ball over the socket."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import shown
from ..elasticity.off_axis.directions import tangents

_AXIS_NAMES = {
    **dict.fromkeys(("flexion", "flexion-extension", "fe", "f", "x"), "x"),
    **dict.fromkeys(("adduction", "abduction", "abduction-adduction", "adduction-abduction", "aa", "a", "y"), "y"),
    **dict.fromkeys(("rotation", "inward rotation", "inward-outward rotation", "ier", "ie", "r", "z"), "z"),
}


def parse_rotation_order(text: Any) -> str:
    """Convert an order of rotations, such as "flexion, adduction, rotation", to axis letters such as "xyz"."""
    words = text if isinstance(text, list | tuple) else []
    if isinstance(text, str):
        words = text.replace(";", ",").split(",") if "," in text else text.replace("-", " ").split()
        words = list(words[0].strip()) if len(words) == 1 and len(words[0].strip()) == 3 else words
    axes = "".join(_AXIS_NAMES.get(str(word).strip().lower(), "?") for word in words)
    if sorted(axes) != ["x", "y", "z"]:
        allowed = "'flexion, adduction, rotation' in any order"
        raise ValueError(f"rotation_order = {shown(text)} is not allowed: {allowed} (R is their product from the left)")
    return axes


def rotation_matrices(angles: Numbers, order: str = "xyz") -> Numbers:
    """Compute rotation matrices (..., 3, 3) from angles in rad about the axes x, y and z.

    Parameters
    ----------
    angles : array (..., 3)
        Angles in rad.
    order : str
        Order of the product from the left: "xyz" is R = Rx Ry Rz.

    Returns
    -------
    array (..., 3, 3)
    """
    matrices = numpy.broadcast_to(numpy.eye(3), (*angles.shape[:-1], 3, 3))
    for letter in order:
        axis = "xyz".index(letter)
        cross = numpy.cross(numpy.eye(3)[axis], numpy.eye(3)).T  # cross @ r is the product of the axis and r
        sine, versine = numpy.sin(angles[..., axis]), 1 - numpy.cos(angles[..., axis])
        # Rodrigues' formula
        matrices = matrices @ (
            numpy.eye(3) + numpy.multiply.outer(sine, cross) + numpy.multiply.outer(versine, cross @ cross)
        )
    return matrices


def rotation_vectors(matrices: Numbers) -> Numbers:
    """Compute rotation vectors (axis times angle in rad) from rotation matrices, for angles below π.

    Parameters
    ----------
    matrices : array (..., 3, 3)

    Returns
    -------
    array (..., 3)
    """
    m = matrices
    doubled_sine_axis = numpy.stack(
        [m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]], axis=-1
    )
    sine = numpy.linalg.norm(doubled_sine_axis, axis=-1) / 2
    angle = numpy.arctan2(sine, (numpy.trace(m, axis1=-2, axis2=-1) - 1) / 2)
    angle_over_sine = numpy.divide(angle, sine, out=numpy.ones_like(angle), where=sine > 0)
    return doubled_sine_axis / 2 * angle_over_sine[..., None]


def cross_shear(xx: Numbers, yy: Numbers, xy: Numbers) -> Numbers:
    """Compute the cross-shear ratio of sliding from its second moments xx, yy and xy.

    It is the smaller eigenvalue over the sum of both: 0 on a straight track or without sliding, 1/2 on a circle.
    """
    # λ_min/(λ_min + λ_max), without cancellation
    trace = xx + yy
    difference = numpy.hypot(xx - yy, 2 * xy)
    smaller = 2 * (xx * yy - xy * xy) / numpy.where(trace > 0, trace + difference, 1.0)
    return numpy.clip(numpy.divide(smaller, trace, out=numpy.zeros_like(trace), where=trace > 0), 0.0, 0.5)


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceSliding:
    """Sliding of the ball's surface over points of the socket during a cycle."""

    radius: float  # radius of the ball in mm
    # (steps, 3), rotation vectors of the time steps in rad, in the frame of the directions
    rotation_increments: Numbers
    directions: Numbers  # (3, points), unit vectors from the centre to the points of the socket

    @cached_property
    def distances(self) -> Numbers:
        """Sliding distance in mm at each point in each time step: (steps, points)."""
        axial_part = self.rotation_increments @ self.directions
        squared_angles = (self.rotation_increments * self.rotation_increments).sum(axis=1)[:, None]
        return self.radius * numpy.sqrt(numpy.maximum(squared_angles - axial_part * axial_part, 0.0))

    def select_points(self, points: Numbers) -> SurfaceSliding:
        """Return the sliding at a subset of the points, selected by indices or a mask."""
        selected = SurfaceSliding(
            radius=self.radius, rotation_increments=self.rotation_increments, directions=self.directions[:, points]
        )
        vars(selected)["distances"] = self.distances[:, points]  # cached: not computed again
        return selected

    @cached_property
    def _rotated_sliding_components(self) -> tuple[Numbers, Numbers]:
        """Two tangential components of each sliding step, rotated by 90°, in mm: (steps, points)."""
        first, second = tangents(self.directions)
        return self.radius * (self.rotation_increments @ first), self.radius * (self.rotation_increments @ second)

    def _sliding_second_moments(self, pressure: Numbers) -> tuple[Numbers, ...]:
        """Sum the second moments xx, yy and xy of the sliding steps over their lengths, by pressure: (points,) each."""
        (x, y), length = self._rotated_sliding_components, self.distances
        weight = numpy.divide(pressure, length, out=numpy.zeros_like(length), where=length > 0)
        return tuple(numpy.einsum("tp,tp,tp->p", weight, *pair) for pair in ((x, x), (y, y), (x, y)))

    def cross_shear(self, pressure: Numbers) -> Numbers:
        """Compute the cross-shear ratio (points,) of sliding, weighted by the pressure (steps, points)."""
        loaded, ratio = numpy.flatnonzero(pressure.any(axis=0)), numpy.zeros(pressure.shape[1])
        ratio[loaded] = cross_shear(*self.select_points(loaded)._sliding_second_moments(pressure[:, loaded]))
        return ratio

    def crossing_angle(self, pressure: Numbers) -> Numbers:
        """Compute the mean angle (points,) in rad between sliding and its principal direction.

        The mean is weighted by pressure (steps, points) and sliding distance. It is 0 on a straight track and π/4 on
        a circle.
        """
        xx, yy, xy = self._sliding_second_moments(pressure)
        first_component, second_component = self._rotated_sliding_components
        direction = numpy.arctan2(second_component, first_component) - numpy.arctan2(2 * xy, xx - yy) / 2
        deviation = numpy.arccos(numpy.clip(abs(numpy.cos(direction)), 0.0, 1.0))
        weight = pressure * self.distances
        total, weighted_sum = weight.sum(axis=0), numpy.einsum("tp,tp->p", weight, deviation)
        return numpy.divide(weighted_sum, total, out=numpy.zeros_like(total), where=total > 0)


def sliding_distance(radius: float, rotation_increments: Numbers, direction: Numbers) -> float:
    """Compute the distance in mm that the ball slides over one point of the socket during a cycle.

    Parameters
    ----------
    radius : float
        Radius of the ball in mm.
    rotation_increments : array (steps, 3)
        Rotation vectors of the time steps in rad.
    direction : array (3,) or (steps, 3)
        Unit vector to the point, constant or at each step, such as the direction of the load.
    """
    return float(radius * numpy.linalg.norm(numpy.cross(rotation_increments, direction), axis=-1).sum())


def tracks(rotations: Numbers, points: Numbers, radius: float = 1.0) -> Numbers:
    """Compute the paths in mm of points of the ball over the socket during a cycle.

    Parameters
    ----------
    rotations : array (n, 3, 3)
        Rotations of the ball. Transposed matrices (0, 2, 1) give the tracks of socket points on the ball.
    points : array (3, points)
        Unit vectors to the points while the ball is not rotated.
    radius : float
        Radius of the ball in mm.

    Returns
    -------
    array (points, n, 3)
        Positions in mm.
    """
    return radius * numpy.einsum("nij,jp->pni", rotations, points)
