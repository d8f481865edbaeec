"""Axisymmetric linear elasticity without locking: element matrices from scikit-fem's shape functions.

The unknowns of a node are its displacements u_φ and u_r along the angle and the radius. Symmetry, supports, sliding and
contact then each concern one of them. The change of volume of an element is projected onto polynomials of one degree
less than its displacements: constants for bilinear, linear ones for biquadratic elements. These are the mixed elements
Q1/P0 and Q2/P1 with the pressure eliminated element by element, which do not lock for ν close to ½.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from math import pi

import numpy
from scipy.sparse import coo_matrix, csc_matrix

from ...core.arrays import Numbers
from .mesh import Block

_CHUNK = 2048  # elements that are integrated at once; their arrays fit into the cache
_SHEAR, _HOOP = 2, 3
_SCALE = numpy.sqrt(numpy.array([2.0, 2.0, 1.0, 2.0]))[:, None]


@dataclass(frozen=True, kw_only=True, eq=False)
class Gradients:
    """Strains of elements per unknown at quadrature points."""

    coordinates: Numbers  # (2, elements, points), coordinates (ρ, z) of the points
    strain: Numbers  # (elements, points, 4, unknowns), strains ε_ρρ, ε_zz, γ_ρz and the hoop strain u_ρ/ρ
    volume: Numbers  # (elements, points), volume of the full ring per weight on the unit square

    @property
    def trace(self) -> Numbers:
        """Relative change of volume per unknown (elements, points, unknowns), not projected."""
        return self.strain[..., 0, :] + self.strain[..., 1, :] + self.strain[..., _HOOP, :]


@dataclass(frozen=True, kw_only=True, eq=False)
class Strains(Gradients):
    """Strains with the projected change of volume, `swelling`, in the shape of `trace`."""

    swelling: Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticBlock:
    """Meshed block of elastic layers."""

    block: Block
    # (layers,)
    young: Numbers
    poisson: Numbers

    @cached_property
    def element_unknowns(self) -> Numbers:
        """Indices (elements, unknowns) of each element's unknowns: u_φ and u_r of node i are 2i and 2i + 1."""
        return self.number_unknowns(2)

    def number_unknowns(self, per_node: int) -> Numbers:
        """Return the indices (elements, unknowns) of each element's unknowns; the second of a node is u_r.

        Where layers slide on each other they share u_r.
        """
        shared = numpy.arange(per_node * self.block.number.size)
        for column in self.block.sliding:
            shared[per_node * self.block.number[:, column + 1] + 1] = per_node * self.block.number[:, column] + 1
        indices = shared[per_node * self.block.elements[..., None] + numpy.arange(per_node)]
        return indices.transpose(1, 0, 2).reshape(self.block.elements.shape[1], -1)

    @cached_property
    def moduli(self) -> tuple[Numbers, Numbers]:
        """Shear and bulk modulus of each layer, in the unit of `young`."""
        return self.young / (2 * (1 + self.poisson)), self.young / (3 * (1 - 2 * self.poisson))

    def stiffness_matrix(self) -> csc_matrix:
        """Assemble the stiffness matrix, from displacements to forces on full rings.

        The energy density 2G (|ε|² - tr²/3) + K tr² is integrated over elements; in its last term tr is projected.
        """
        count = self.element_unknowns.shape[1]
        K = numpy.empty((len(self.element_unknowns), count, count))
        elements, (points, weights) = numpy.arange(len(self.element_unknowns)), element_quadrature(self.block.order)
        for chunk in self.chunks(elements):
            strains = self.strains(elements[chunk], points)
            volume = strains.volume * weights
            shear, bulk = (modulus[self.block.layers[chunk]][:, None] * volume for modulus in self.moduli)
            rows = strains.strain * (_SCALE * numpy.sqrt(shear)[..., None, None])
            rows = rows.reshape(len(rows), -1, rows.shape[-1])
            trace = strains.trace * numpy.sqrt(2 / 3 * shear)[..., None]
            swelling = strains.swelling * numpy.sqrt(bulk)[..., None]
            energy = rows.swapaxes(1, 2) @ rows - trace.swapaxes(1, 2) @ trace
            K[chunk] = energy + swelling.swapaxes(1, 2) @ swelling
        return assemble(K, self.element_unknowns, 2 * self.block.number.size)

    def chunks(self, elements: Numbers) -> Iterator[slice]:
        """Yield slices of a list of elements, each small enough for the cache."""
        for first in range(0, len(elements), _CHUNK):
            yield slice(first, first + _CHUNK)

    def strains(self, element_indices: Numbers, points: Numbers) -> Strains:
        """Compute the strains and projected changes of volume per unknown of some elements.

        They are evaluated at points of the unit square (2, points).
        """
        quadrature_points, weights = element_quadrature(self.block.order)
        integrated = self.gradients(element_indices, quadrature_points)
        evaluated = integrated if points is quadrature_points else self.gradients(element_indices, points)
        weighted = integrated.coordinates, integrated.volume * weights, integrated.trace
        swelling = self.project_volume(element_indices, *weighted, evaluated.coordinates)
        return Strains(**vars(evaluated), swelling=swelling)

    def project_volume(
        self,
        element_indices: Numbers,
        coordinates: Numbers,
        volume: Numbers,
        trace: Numbers,
        other_coordinates: Numbers | None = None,
    ) -> Numbers:
        """Project the volume change in elements onto polynomials, by weighted least squares.

        `trace` (elements, points, unknowns) is known at points (ρ, z), `coordinates` (2, elements, points), which have
        the weights `volume` (elements, points). The result is evaluated at them or at the other coordinates.
        """
        Q = self._volume_polynomials(element_indices, coordinates)
        weighted = (Q * volume[..., None]).swapaxes(1, 2)
        target = Q if other_coordinates is None else self._volume_polynomials(element_indices, other_coordinates)
        return target @ numpy.linalg.solve(weighted @ Q, weighted @ trace)

    def _volume_polynomials(self, element_indices: Numbers, coordinates: Numbers) -> Numbers:
        """Evaluate 1, and for order 2 also ρ and z about the middle, in elements: (elements, points, polynomials)."""
        constant = numpy.ones((*coordinates.shape[1:], 1))
        if self.block.order == 1:
            return constant
        corners = self.block.nodes[:, self.block.elements[:4, element_indices]]
        middle = corners.mean(axis=1)[..., None]
        size = abs(corners[:, 2] - corners[:, 0]).max(axis=0)[:, None]
        return numpy.concatenate([constant, numpy.moveaxis((coordinates - middle) / size, 0, -1)], axis=-1)

    def gradients(self, element_indices: Numbers, points: Numbers) -> Gradients:
        """Compute the strains per unknown of some elements, at points of the unit square (2, points)."""
        shapes, slopes, det = self.cartesian_shape_functions(element_indices, points)
        elements = self.block.elements[:, element_indices]
        coordinates = numpy.einsum("cne,nq->ceq", self.block.nodes[:, elements], shapes)
        strain = numpy.zeros((*det.shape, 4, 2, len(elements)))  # of (ρ, z)
        strain[..., 0, 0, :] = strain[..., _SHEAR, 1, :] = slopes[..., 0, :]
        strain[..., 1, 1, :] = strain[..., _SHEAR, 0, :] = slopes[..., 1, :]
        strain[..., _HOOP, 0, :] = shapes.T / coordinates[0][..., None]
        phi = self.block.angle[elements // self.block.radius.shape[1]].T[:, None, None]
        across, along = strain[..., 0, :], strain[..., 1, :]
        along_angle = across * numpy.cos(phi) - along * numpy.sin(phi)
        polar = numpy.stack([along_angle, across * numpy.sin(phi) + along * numpy.cos(phi)], -1)
        return Gradients(
            coordinates=coordinates,
            strain=polar.reshape(*polar.shape[:-2], -1),
            volume=2 * pi * coordinates[0] * abs(det),
        )

    def cartesian_shape_functions(self, element_indices: Numbers, points: Numbers) -> tuple[Numbers, Numbers, Numbers]:
        """Compute the shape functions of elements, their derivatives by ρ and z, and Jacobian determinants.

        The shapes are (nodes, points), (elements, points, 2, nodes) and (elements, points).
        """
        shapes, slopes = shape_functions(self.block.order, points)
        J = numpy.einsum("cne,ndq->eqcd", self.block.nodes[:, self.block.elements[:, element_indices]], slopes)
        det = J[..., 0, 0] * J[..., 1, 1] - J[..., 0, 1] * J[..., 1, 0]
        adjugate = numpy.stack([J[..., 1, 1], -J[..., 1, 0], -J[..., 0, 1], J[..., 0, 0]], -1).reshape(J.shape)
        return shapes, numpy.einsum("ndq,eqcd->eqcn", slopes, adjugate / det[..., None, None]), det


def assemble(matrices: Numbers, unknowns: Numbers, size: int) -> csc_matrix:
    """Assemble element matrices (elements, unknowns, unknowns) to a sparse matrix (size, size)."""
    rows, columns = numpy.broadcast_arrays(unknowns[:, :, None], unknowns[:, None, :])
    positions = rows.ravel().astype(numpy.int32), columns.ravel().astype(numpy.int32)
    return coo_matrix((matrices.ravel(), positions), shape=(size, size)).tocsc()


def shape_functions(order: int, points: Numbers) -> tuple[Numbers, Numbers]:
    """Evaluate shape functions (nodes, points) and their gradients (nodes, 2, points) on the unit square."""
    from skfem import ElementQuad1, ElementQuad2

    element = ElementQuad1() if order == 1 else ElementQuad2()
    functions = [element.lbasis(points, i) for i in range(4 if order == 1 else 9)]
    return numpy.stack([function[0] for function in functions]), numpy.stack([function[1] for function in functions])


@cache
def element_quadrature(order: int) -> tuple[Numbers, Numbers]:
    """Return the quadrature points (2, points) and weights (points,) of an element's energy, 2 by 2 or 3 by 3."""
    from skfem import ElementQuad1
    from skfem.quadrature import get_quadrature

    points, weights = get_quadrature(ElementQuad1().refdom, 2 * order + 1)
    return points, weights
