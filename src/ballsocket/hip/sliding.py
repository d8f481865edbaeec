"""Sliding: how points of ball and socket pass each other, by rotation matrices and their logarithm."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy

from ..core.arrays import Numbers
from ..core.deprecation import renamed_arguments, renamed_fields
from ..elasticity.off_axis.directions import tangents


def rotation_matrices(angles: Numbers, order: str = "xyz") -> Numbers:
    """Rotations by angles (..., 3) in rad about x, y and z, multiplied from the left in this order: (..., 3, 3)."""
    product = numpy.broadcast_to(numpy.eye(3), (*angles.shape[:-1], 3, 3))
    for name in order:
        axis = "xyz".index(name)
        product = product @ _about(axis, angles[..., axis])
    return product


def _about(axis: int, angle: Numbers) -> Numbers:
    one, other = (axis + 1) % 3, (axis + 2) % 3
    matrix = numpy.zeros((*angle.shape, 3, 3))
    matrix[..., axis, axis] = 1.0
    matrix[..., one, one] = matrix[..., other, other] = numpy.cos(angle)
    matrix[..., other, one] = numpy.sin(angle)
    matrix[..., one, other] = -numpy.sin(angle)
    return matrix


def rotation_vectors(matrices: Numbers) -> Numbers:
    """The axis times the angle in rad of rotations (..., 3, 3) by less than half a turn: (..., 3)."""
    m = matrices
    across = numpy.stack(
        [m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]], axis=-1
    )
    sine = numpy.linalg.norm(across, axis=-1) / 2
    angle = numpy.arctan2(sine, (numpy.trace(m, axis1=-2, axis2=-1) - 1) / 2)
    share = numpy.divide(angle, sine, out=numpy.ones_like(angle), where=sine > 0)
    return across / 2 * share[..., None]


def cross_shear(xx: Numbers, yy: Numbers, xy: Numbers) -> Numbers:
    """The smaller eigenvalue of a second moment of sliding over the sum of both; 0 where nothing slides.

    0 on a straight track, 1/2 where no direction is preferred, as on a circle.
    """
    # λ_min/(λ_min + λ_max), without cancellation
    whole = xx + yy
    spread = numpy.hypot(xx - yy, 2 * xy)
    smaller = 2 * (xx * yy - xy * xy) / numpy.where(whole > 0, whole + spread, 1.0)
    return numpy.clip(numpy.divide(smaller, whole, out=numpy.zeros_like(whole), where=whole > 0), 0.0, 0.5)


def cross_shear_of(steps: Numbers, weights: Numbers | float = 1.0) -> Numbers:
    """The cross-shear of a track.

    Parameters
    ----------
    steps : array (..., n, 2)
        Along the track, in its tangent plane.
    weights : array (..., n)
        The pressure at each step, say.

    Examples
    --------
    A rectangle of 3 by 1 mm has b/(a + b):

    >>> sides = numpy.array([[3.0, 0.0], [0.0, 1.0], [-3.0, 0.0], [0.0, -1.0]])
    >>> float(cross_shear_of(sides))
    0.25
    """
    length = numpy.linalg.norm(steps, axis=-1)
    share = weights * numpy.divide(1.0, length, out=numpy.zeros_like(length), where=length > 0)
    x, y = steps[..., 0], steps[..., 1]
    return cross_shear(*((share * each).sum(axis=-1) for each in (x * x, y * y, x * y)))


@renamed_fields(turns="rotation_increments")
@dataclass(frozen=True, kw_only=True, eq=False)
class Sliding:
    """The ball's surface passing over points of the socket.

    Attributes
    ----------
    radius : float
        Of the ball in mm.
    rotation_increments : array (instants, 3)
        Rotation vectors of the instants in rad, in the frame of the directions.
    directions : array (3, points)
        Unit vectors from the centre to the points of the socket.
    """

    radius: float
    rotation_increments: Numbers
    directions: Numbers

    @cached_property
    def steps(self) -> Numbers:
        """How far the ball slides over each point in each instant, in mm: (instants, points)."""
        along = self.rotation_increments @ self.directions
        square = (self.rotation_increments * self.rotation_increments).sum(axis=1)[:, None]
        return self.radius * numpy.sqrt(numpy.maximum(square - along * along, 0.0))

    def part(self, points: Numbers) -> Sliding:
        """Some of the points alone."""
        chosen = Sliding(
            radius=self.radius, rotation_increments=self.rotation_increments, directions=self.directions[:, points]
        )
        vars(chosen)["steps"] = self.steps[:, points]
        return chosen

    def velocities(self, seconds: Numbers) -> Numbers:
        """Velocities of the ball over points, R ω × n, in instants that last so long: (instants, points, 3) mm/s."""
        omega = self.rotation_increments / seconds[:, None]
        return self.radius * numpy.cross(omega[:, None], self.directions.T[None])

    @cached_property
    def _turned(self) -> tuple[Numbers, Numbers]:
        """The two parts of each step in the tangent plane, turned by 90°: each (instants, points)."""
        one, other = tangents(self.directions)
        return self.radius * (self.rotation_increments @ one), self.radius * (self.rotation_increments @ other)

    @cached_property
    def _moments(self) -> tuple[Numbers, ...]:
        """ds dsᵀ/|ds| of each step in the tangent plane, turned by 90°: xx, yy, xy, each (instants, points)."""
        a, b = self._turned
        share = numpy.divide(1.0, self.steps, out=numpy.zeros_like(self.steps), where=self.steps > 0)
        return a * a * share, b * b * share, a * b * share

    def cross_shear(self, pressure: Numbers) -> Numbers:
        """Cross-shear of each point of the socket, weighted by pressures (instants, points): (points,)."""
        return cross_shear(*(numpy.einsum("tp,tp->p", pressure, part) for part in self._moments))

    def crossing_angle(self, pressure: Numbers) -> Numbers:
        """The mean angle in rad between sliding and its principal direction at each point of the socket: (points,).

        Weighted by pressures (instants, points) and slides: 0 on a straight track, π/4 on a circle.
        """
        xx, yy, xy = (numpy.einsum("tp,tp->p", pressure, part) for part in self._moments)
        principal, (a, b) = numpy.arctan2(2 * xy, xx - yy) / 2, self._turned
        off = numpy.arccos(numpy.clip(abs(numpy.cos(numpy.arctan2(b, a) - principal)), 0.0, 1.0))
        weight = pressure * self.steps
        whole, summed = weight.sum(axis=0), numpy.einsum("tp,tp->p", weight, off)
        return numpy.divide(summed, whole, out=numpy.zeros_like(whole), where=whole > 0)


@renamed_arguments(turns="rotation_increments")
def slide(radius: float, rotation_increments: Numbers, direction: Numbers) -> float:
    """How far the ball slides in mm over a point of the socket in a cycle.

    Parameters
    ----------
    radius : float
        Of the ball in mm.
    rotation_increments : array (instants, 3)
        Rotation vectors of the instants in rad.
    direction : array (3,) or (instants, 3)
        Unit vector to the point; where the load points at each instant, say.
    """
    return float(radius * numpy.linalg.norm(numpy.cross(rotation_increments, direction), axis=-1).sum())


def tracks(rotations: Numbers, points: Numbers, radius: float = 1.0) -> Numbers:
    """The tracks that points of the ball draw on the socket.

    Parameters
    ----------
    rotations : array (n, 3, 3)
        Of the ball; transposed (0, 2, 1), points of the socket draw their tracks on the ball.
    points : array (3, points)
        Unit vectors to where the points are while the ball is not turned.
    radius : float
        Of the ball in mm.

    Returns
    -------
    array (points, n, 3)
        In mm.
    """
    return radius * numpy.einsum("nij,jp->pni", rotations, points)
