"""Axisymmetric linear elasticity without locking: element matrices from scikit-fem's shape functions.

The unknowns of a node are its displacements u_φ and u_r along the angle and the radius, so that symmetry, supports,
sliding and contact each concern one of them. The change of volume of an element is projected onto polynomials of one
degree less than its displacements (constants for bilinear, linear ones for biquadratic elements): these are the mixed
elements Q1/P0 and Q2/P1 with the pressure eliminated element by element, which do not lock when ν comes near ½.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy
from scipy.sparse import coo_matrix, csc_matrix

from ...core.arrays import Numbers
from .mesh import Block

_CHUNK = 2048  # elements that are integrated at once: their arrays stay in the cache
_SHEAR, _HOOP = 2, 3
_SCALE = numpy.sqrt(numpy.array([2.0, 2.0, 1.0, 2.0]))[:, None]


@dataclass(frozen=True, kw_only=True, eq=False)
class Gradients:
    """From the unknowns of elements to strains at their points.

    Attributes
    ----------
    place : array (2, elements, points)
        (ρ, z) of the points.
    strain : array (elements, points, 4, unknowns)
        ε_ρρ, ε_zz, γ_ρz and the hoop strain u_ρ/ρ.
    volume : array (elements, points)
        What a weight of the unit square is worth in the volume of the whole ring.
    """

    place: Numbers
    strain: Numbers
    volume: Numbers

    @property
    def trace(self) -> Numbers:
        """The change of volume (elements, points, unknowns), not projected."""
        return self.strain[..., 0, :] + self.strain[..., 1, :] + self.strain[..., _HOOP, :]


@dataclass(frozen=True, kw_only=True, eq=False)
class Strains(Gradients):
    """Gradients with the projected change of volume, `swelling`, of the shape of `trace`."""

    swelling: Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticBlock:
    """A block of elastic layers.

    Parameters
    ----------
    block : Block
    young, poisson : array (layers,)
    """

    block: Block
    young: Numbers
    poisson: Numbers

    @cached_property
    def unknowns(self) -> Numbers:
        """Numbers of each element's unknowns, shape (elements, unknowns): u_φ and u_r of node i are 2i and 2i + 1.

        Where layers slide on each other they share u_r.
        """
        own = numpy.arange(2 * self.block.number.size)
        for column in self.block.sliding:
            own[2 * self.block.number[:, column + 1] + 1] = 2 * self.block.number[:, column] + 1
        numbers = own[2 * self.block.elements[..., None] + numpy.arange(2)]
        return numbers.transpose(1, 0, 2).reshape(self.block.elements.shape[1], -1)

    @cached_property
    def moduli(self) -> tuple[Numbers, Numbers]:
        """Shear and bulk modulus of each layer."""
        return self.young / (2 * (1 + self.poisson)), self.young / (3 * (1 - 2 * self.poisson))

    def matrix(self) -> csc_matrix:
        """The stiffness; displacements in units of length give forces on whole rings."""
        size = 2 * self.block.number.size
        count = self.unknowns.shape[1]
        K = numpy.empty((len(self.unknowns), count, count))
        every = numpy.arange(len(self.unknowns))
        for chunk in self.chunks(every):
            K[chunk] = self._stiffness(every[chunk])
        rows, columns = numpy.broadcast_arrays(self.unknowns[:, :, None], self.unknowns[:, None, :])
        places = (rows.ravel().astype(numpy.int32), columns.ravel().astype(numpy.int32))
        return coo_matrix((K.ravel(), places), shape=(size, size)).tocsc()

    def chunks(self, elements: Numbers) -> Iterator[slice]:
        """Slices of a list of elements that are worked on at once."""
        for first in range(0, len(elements), _CHUNK):
            yield slice(first, first + _CHUNK)

    def _stiffness(self, chosen: Numbers) -> Numbers:
        """Energy 2G (|ε|² - tr²/3) + K tr², the last one with the projected change of volume."""
        points, weights = integration(self.block.order)
        parts = self.strains(chosen, points)
        volume = parts.volume * weights
        shear, bulk = (modulus[self.block.layers[chosen]][:, None] * volume for modulus in self.moduli)
        rows = parts.strain * (_SCALE * numpy.sqrt(shear)[..., None, None])
        rows = rows.reshape(len(rows), -1, rows.shape[-1])
        trace = parts.trace * numpy.sqrt(2 / 3 * shear)[..., None]
        swelling = parts.swelling * numpy.sqrt(bulk)[..., None]
        return rows.swapaxes(1, 2) @ rows - trace.swapaxes(1, 2) @ trace + swelling.swapaxes(1, 2) @ swelling

    def strains(self, chosen: Numbers, points: Numbers) -> Strains:
        """Strains of some elements at points of the unit square (2, points)."""
        where, weights = integration(self.block.order)
        whole = self.gradients(chosen, where)
        here = whole if points is where else self.gradients(chosen, points)
        swelling = self.projected(chosen, whole.place, whole.volume * weights, whole.trace, here.place)
        return Strains(place=here.place, strain=here.strain, swelling=swelling, volume=here.volume)

    def projected(
        self, chosen: Numbers, place: Numbers, volume: Numbers, trace: Numbers, there: Numbers | None = None
    ) -> Numbers:
        """The polynomials nearest to a change of volume that is known at points with weights, at other points or these.

        Parameters
        ----------
        chosen : array of int (elements,)
        place, there : array (2, elements, points)
            (ρ, z) of the points with weights, and of those asked for.
        volume : array (elements, points)
            The weights.
        trace : array (elements, points, unknowns)
        """
        Q = self._polynomials(chosen, place)
        weighted = (Q * volume[..., None]).swapaxes(1, 2)
        asked = Q if there is None else self._polynomials(chosen, there)
        return asked @ numpy.linalg.solve(weighted @ Q, weighted @ trace)

    def _polynomials(self, chosen: Numbers, place: Numbers) -> Numbers:
        """1, or 1, ρ and z about the middle of the element: (elements, points, polynomials)."""
        one = numpy.ones((*place.shape[1:], 1))
        if self.block.order == 1:
            return one
        corners = self.block.nodes[:, self.block.elements[:4, chosen]]
        middle = corners.mean(axis=1)[..., None]
        size = abs(corners[:, 2] - corners[:, 0]).max(axis=0)[:, None]
        return numpy.concatenate([one, numpy.moveaxis((place - middle) / size, 0, -1)], axis=-1)

    def gradients(self, chosen: Numbers, points: Numbers) -> Gradients:
        """Strains of some elements by their unknowns, at points of the unit square (2, points)."""
        shapes, slopes, det = self.cartesian(chosen, points)
        elements = self.block.elements[:, chosen]
        place = numpy.einsum("cne,nq->ceq", self.block.nodes[:, elements], shapes)
        strain = numpy.zeros((*det.shape, 4, 2, len(elements)))  # of (ρ, z)
        strain[..., 0, 0, :] = strain[..., _SHEAR, 1, :] = slopes[..., 0, :]
        strain[..., 1, 1, :] = strain[..., _SHEAR, 0, :] = slopes[..., 1, :]
        strain[..., _HOOP, 0, :] = shapes.T / place[0][..., None]
        phi = self.block.angle[elements // self.block.radius.shape[1]].T[:, None, None]
        across, along = strain[..., 0, :], strain[..., 1, :]
        polar = numpy.stack(
            [across * numpy.cos(phi) - along * numpy.sin(phi), across * numpy.sin(phi) + along * numpy.cos(phi)], -1
        )
        return Gradients(place=place, strain=polar.reshape(*polar.shape[:-2], -1), volume=2 * pi * place[0] * abs(det))

    def cartesian(self, chosen: Numbers, points: Numbers) -> tuple[Numbers, Numbers, Numbers]:
        """Shape functions (nodes, points), their slopes by ρ and z (elements, points, 2, nodes), and Jacobians."""
        shapes, slopes = shape_functions(self.block.order, points)
        J = numpy.einsum("cne,ndq->eqcd", self.block.nodes[:, self.block.elements[:, chosen]], slopes)
        det = J[..., 0, 0] * J[..., 1, 1] - J[..., 0, 1] * J[..., 1, 0]
        turned = numpy.stack([J[..., 1, 1], -J[..., 1, 0], -J[..., 0, 1], J[..., 0, 0]], -1).reshape(J.shape)
        return shapes, numpy.einsum("ndq,eqcd->eqcn", slopes, turned / det[..., None, None]), det


def shape_functions(order: int, points: Numbers) -> tuple[Numbers, Numbers]:
    """Shape functions (nodes, points) and their gradients (nodes, 2, points) on the unit square."""
    from skfem import ElementQuad1, ElementQuad2

    element = ElementQuad1() if order == 1 else ElementQuad2()
    parts = [element.lbasis(points, i) for i in range(4 if order == 1 else 9)]
    return numpy.stack([part[0] for part in parts]), numpy.stack([part[1] for part in parts])


_RULES: dict[int, tuple[Numbers, Numbers]] = {}


def integration(order: int) -> tuple[Numbers, Numbers]:
    """Points (2, points) and weights (points,) that integrate an element's energy: 2 by 2, or 3 by 3."""
    if order not in _RULES:
        from skfem import ElementQuad1
        from skfem.quadrature import get_quadrature

        _RULES[order] = get_quadrature(ElementQuad1().refdom, 2 * order + 1)
    return _RULES[order]
