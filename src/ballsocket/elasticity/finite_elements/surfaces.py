"""Ball and socket on their common surface: shapes of the pressure, and what they do to both bodies.

The pressure is linear between the corners of the socket's elements. It is integrated on the sphere itself, between the
corners of both bodies, so that their meshes need not match.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csr_array, dia_array

from ...core.arrays import Numbers, gauss_legendre
from .shapes import Resolution

_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(5))
_SAME = 1e-9  # rad: corners of two meshes that are one


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactSurface:
    """A body's contact surface: the angles of its nodes in rad, and normal displacements in mm by forces in N."""

    angle: Numbers
    order: int
    compliance: Numbers

    @property
    def corners(self) -> Numbers:
        """Where its elements end."""
        return self.angle[:: self.order]

    def shapes(self, angle: Numbers) -> csr_array:
        """Shape functions of the nodes at angles: (angles, nodes)."""
        return lagrange(self.corners, self.order, angle)

    def gathered(self, angle: Numbers, values: Numbers) -> Numbers:
        """Sums of values at angles, each shared among the nodes by their shape functions: (nodes,)."""
        nodes, parts = _around(self.corners, self.order, angle)
        return numpy.bincount(nodes.ravel(), weights=(parts * values[:, None]).ravel(), minlength=len(self.angle))


def lagrange(corners: Numbers, order: int, angle: Numbers) -> csr_array:
    """Polynomials of this degree between corners, one a node, at angles: (angles, nodes), few of them not zero."""
    nodes, parts = _around(corners, order, angle)
    ends = numpy.arange(len(angle) + 1) * (order + 1)
    return csr_array((parts.ravel(), nodes.ravel(), ends), shape=(len(angle), order * (len(corners) - 1) + 1))


def _around(corners: Numbers, order: int, angle: Numbers) -> tuple[Numbers, Numbers]:
    """The nodes of the element at each angle, and their shape functions there: (angles, order + 1) each."""
    element = numpy.clip(numpy.searchsorted(corners, angle) - 1, 0, len(corners) - 2)
    t = (angle - corners[element]) / (corners[element + 1] - corners[element])
    parts = [1 - t, t] if order == 1 else [(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)]
    return order * element[:, None] + numpy.arange(order + 1), numpy.stack(parts, axis=-1)


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfacePair:
    """The socket's surface and the ball's (a rigid one has none) on a sphere of this radius (mm), up to an angle."""

    surfaces: tuple[ContactSurface, ...]
    radius: float
    reach: float
    resolution: Resolution
    ball_resolution: Resolution

    @cached_property
    def angle(self) -> Numbers:
        """Where the pressure is known: the corners of the socket's elements, up to the reach."""
        corners = self.surfaces[0].corners
        return corners[corners <= self.reach + _SAME]

    @cached_property
    def corners(self) -> Numbers:
        """Polar angles of the elements' corners of both bodies, in rad."""
        every = numpy.sort(numpy.concatenate([surface.corners for surface in self.surfaces]))
        every = every[every <= self.angle[-1] + _SAME]
        return every[numpy.append(True, numpy.diff(every) > _SAME)]

    def area(self, angle: Numbers) -> Numbers:
        """dA/dφ in mm²/rad."""
        return 2 * pi * self.radius**2 * numpy.sin(angle)

    @cached_property
    def points(self) -> tuple[Numbers, Numbers]:
        """Angles and weights of ∫ dA, by Gauss-Legendre between the corners."""
        width = numpy.diff(self.corners)[:, None]
        angle = (self.corners[:-1, None] + width * _NODES).ravel()
        return angle, self.area(angle) * (width * _WEIGHTS).ravel()

    @cached_property
    def _weighing(self) -> csr_array:
        """The hats at the points times their weights: (shapes, points)."""
        angle, weights = self.points
        return csr_array(lagrange(self.angle, 1, angle).T @ dia_array((weights[None], [0]), shape=2 * weights.shape))

    def weighted(self, values: Numbers) -> Numbers:
        """∫ φ_i values dA of the pressure's shapes φ_i, from values at the points."""
        return self._weighing @ values

    @cached_property
    def displaced(self) -> tuple[Numbers, ...]:
        """Normal displacements of each surface's nodes by each shape of the pressure: (nodes, shapes)."""
        return tuple(surface.compliance @ forces for surface, forces in zip(self.surfaces, self.forces, strict=True))

    @cached_property
    def forces(self) -> tuple[Numbers, ...]:
        """Forces on each surface's nodes by each shape of the pressure: (nodes, shapes)."""
        return tuple((self._weighing @ surface.shapes(self.points[0])).toarray().T for surface in self.surfaces)

    @cached_property
    def matrix(self) -> Numbers:
        """∫ φ_i (displacement by φ_j) dA, summed over both bodies, in mm³/MPa; symmetric, positive definite."""
        return sum(forces.T @ displaced for forces, displaced in zip(self.forces, self.displaced, strict=True))

    @cached_property
    def whitening(self) -> Numbers:
        """The inverse W of the matrix' Cholesky factor, A⁻¹ = WᵀW; its leading blocks serve narrower contacts."""
        factor = cholesky(self.matrix, lower=True)
        return solve_triangular(factor, numpy.eye(len(factor)), lower=True)
