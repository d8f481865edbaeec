"""Contact surfaces of ball and socket: shape functions of the pressure, and compliances of both bodies.

The pressure is linear between the corners of the socket's elements. It is integrated on the sphere itself, between
the corners of both bodies, so their meshes need not match.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csr_array, dia_array

from ...core.arrays import Numbers, gauss_legendre
from .mesh import Resolution

_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(5))
_ANGLE_TOLERANCE = 1e-9  # rad: corners of two meshes closer than this are one


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactSurface:
    """Contact surface of a body: angles of its nodes in rad, and compliance matrix in mm/N."""

    angle: Numbers
    order: int
    compliance: Numbers

    @property
    def corners(self) -> Numbers:
        """Angles of the element corners in rad."""
        return self.angle[:: self.order]

    def shapes(self, angle: Numbers) -> csr_array:
        """Compute the shape functions of the nodes at angles (rad): (angles, nodes)."""
        return lagrange(self.corners, self.order, angle)

    def nodal_sums(self, angle: Numbers, values: Numbers) -> Numbers:
        """Sum values at angles (rad) onto the nodes, weighted with shape functions: (nodes,)."""
        nodes, shapes = _element_shapes(self.corners, self.order, angle)
        return numpy.bincount(nodes.ravel(), weights=(shapes * values[:, None]).ravel(), minlength=len(self.angle))


def lagrange(corners: Numbers, order: int, angle: Numbers) -> csr_array:
    """Compute the Lagrange polynomials of this order at angles: a sparse matrix (angles, nodes)."""
    nodes, shapes = _element_shapes(corners, order, angle)
    ends = numpy.arange(len(angle) + 1) * (order + 1)
    return csr_array((shapes.ravel(), nodes.ravel(), ends), shape=(len(angle), order * (len(corners) - 1) + 1))


def _element_shapes(corners: Numbers, order: int, angle: Numbers) -> tuple[Numbers, Numbers]:
    """Return the nodes of the element at each angle and their shape functions: (angles, order + 1) each."""
    element = numpy.clip(numpy.searchsorted(corners, angle) - 1, 0, len(corners) - 2)
    t = (angle - corners[element]) / (corners[element + 1] - corners[element])
    shapes = [1 - t, t] if order == 1 else [(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)]
    return order * element[:, None] + numpy.arange(order + 1), numpy.stack(shapes, axis=-1)


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfacePair:
    """Contact surfaces of the socket and of an elastic ball, on a sphere of one radius (mm) up to an angle (rad)."""

    surfaces: tuple[ContactSurface, ...]
    radius: float
    reach: float
    resolution: Resolution
    ball_resolution: Resolution

    @cached_property
    def angle(self) -> Numbers:
        """Angles in rad of the pressure nodes, which are corners of the socket's elements."""
        corners = self.surfaces[0].corners
        return corners[corners <= self.reach + _ANGLE_TOLERANCE]

    @cached_property
    def corners(self) -> Numbers:
        """Polar angles of the elements' corners of both bodies, in rad."""
        merged = numpy.sort(numpy.concatenate([surface.corners for surface in self.surfaces]))
        merged = merged[merged <= self.angle[-1] + _ANGLE_TOLERANCE]
        return merged[numpy.append(True, numpy.diff(merged) > _ANGLE_TOLERANCE)]

    def area(self, angle: Numbers) -> Numbers:
        """Compute the area per polar angle, dA/dφ, in mm²/rad."""
        return 2 * pi * self.radius**2 * numpy.sin(angle)

    @cached_property
    def points(self) -> tuple[Numbers, Numbers]:
        """Angles (rad) and weights (mm²) of Gauss-Legendre quadrature over the contact area."""
        width = numpy.diff(self.corners)[:, None]
        angle = (self.corners[:-1, None] + width * _NODES).ravel()
        return angle, self.area(angle) * (width * _WEIGHTS).ravel()

    @cached_property
    def _weighted_shapes(self) -> csr_array:
        """Shape functions of the pressure at the quadrature points, times the weights: (shapes, points)."""
        angle, weights = self.points
        return csr_array(lagrange(self.angle, 1, angle).T @ dia_array((weights[None], [0]), shape=2 * weights.shape))

    def integrate_with_shapes(self, values: Numbers) -> Numbers:
        """Integrate values at the quadrature points times each shape function of the pressure, over the area."""
        return self._weighted_shapes @ values

    @cached_property
    def displacements(self) -> tuple[Numbers, ...]:
        """Normal displacements of each surface's nodes in mm per shape function of the pressure: (nodes, shapes)."""
        return tuple(surface.compliance @ forces for surface, forces in zip(self.surfaces, self.forces, strict=True))

    @cached_property
    def forces(self) -> tuple[Numbers, ...]:
        """Normal forces on each surface's nodes in N per shape function of the pressure: (nodes, shapes)."""
        return tuple((self._weighted_shapes @ surface.shapes(self.points[0])).toarray().T for surface in self.surfaces)

    @cached_property
    def compliance_matrix(self) -> Numbers:
        """Integrals ∫ φ_i (displacement of both bodies by φ_j) dA in mm³/MPa, for shape functions φ of the pressure."""
        return sum(
            forces.T @ displacements for forces, displacements in zip(self.forces, self.displacements, strict=True)
        )

    @cached_property
    def whitening(self) -> Numbers:
        """Inverse W of the matrix' Cholesky factor, A⁻¹ = WᵀW; its leading blocks serve narrower contacts."""
        factor = cholesky(self.compliance_matrix, lower=True)
        return solve_triangular(factor, numpy.eye(len(factor)), lower=True)
