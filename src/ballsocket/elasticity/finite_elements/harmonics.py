"""Socket under loads that vary around its axis as cos mφ: one mesh of the meridian serves every m.

With u_ρ and u_z ~ cos mφ and the azimuthal u_φ ~ sin mφ, strains are the axisymmetric ones plus terms proportional
to m. The stiffness is therefore K0 + m K1 + m² K2. The unknowns of node i are 3i, 3i + 1 and 3i + 2: along the angle,
along the radius and around the axis. As in `elasticity` the change of volume is projected.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy
from scipy.sparse import csc_matrix

from ...core.arrays import Numbers, gauss_legendre
from ...problem import Support
from .bodies import elimination_order, factorize, lagrange, last_factors, socket_block, socket_elastic
from .elasticity import ElasticBlock, assemble, element_quadrature
from .mesh import Block, Resolution, SocketShape

_DIRECT, _HOOP = 4, 3  # number of the axisymmetric strains, and index of the hoop strain
_SCALE = numpy.sqrt(numpy.array([2.0, 2.0, 1.0, 2.0, 1.0, 1.0]))[:, None]
_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(5))


StiffnessPowers = tuple[csc_matrix, csc_matrix, csc_matrix]
"""Stiffness matrices K0, K1 and K2 of the powers of m, or their derivatives."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Harmonics:
    """Meridian mesh of a socket for loads on its bore that vary as cos mφ."""

    elastic: ElasticBlock
    shape: SocketShape  # shape of the meshed socket

    @property
    def _block(self) -> Block:
        return self.elastic.block

    @cached_property
    def bore(self) -> Numbers:
        """Indices of the nodes on the bore, from the pole to its end."""
        reach = int(numpy.searchsorted(self._block.angle, self.shape.reach + 1e-9))
        return self._block.number[:reach, 0]

    def ring_compliance(self, edges: Numbers, degrees: Iterable[int]) -> Numbers:
        """Compute the compliance matrices between rings for pressures that vary as cos mφ: (degrees, rings, rings).

        They are ∫ u dA over the ring of the row by a unit of pressure on that of the column, without the factor ∫ cos²
        mφ dφ/2π, for a bore of radius 1 and a liner of Young's modulus 1. The edges (rings + 1,) are polar angles
        between rings in rad, among the corners of the elements.
        """
        loads, matrices = self._ring_loads(edges), []
        for m in degrees:
            _, count, stiffness = self._ordered_systems[min(m, 2)]
            lower, upper = last_factors(factorize(_sum_powers(stiffness, m)), count)
            normal_loads = loads[-count:]
            compliance = normal_loads.T @ numpy.linalg.solve(upper, numpy.linalg.solve(lower, normal_loads))
            matrices.append((compliance + compliance.T) / 2)
        return numpy.stack(matrices)

    def ring_compliance_slopes(self, edges: Numbers, degrees: Iterable[int], slopes: list[StiffnessPowers]) -> Numbers:
        """Compute the derivatives of `ring_compliance` from those of the stiffness: (slopes, degrees, rings, rings).

        With the displacements U under the loads, the derivative of the compliance is -Uᵀ dK U.
        """
        loads, matrices = self._ring_loads(edges), []
        for m in degrees:
            order, count, stiffness = self._ordered_systems[min(m, 2)]
            load = numpy.zeros((len(order), loads.shape[1]))
            load[-count:] = loads[-count:]
            displacements = factorize(_sum_powers(stiffness, m)).solve(load)
            forces = [_sum_powers(slope, m)[order][:, order] @ displacements for slope in slopes]
            matrices.append(numpy.stack([-displacements.T @ force for force in forces]))
        return numpy.stack(matrices, axis=1)

    def _ring_loads(self, edges: Numbers) -> Numbers:
        """Compute the nodal forces on the bore by unit pressure on each ring: (nodes, rings)."""
        corners = self._block.angle[: len(self.bore) : self._block.order]
        low, high = edges[:-1], edges[1:]
        width = numpy.diff(corners)[:, None]
        angle = (corners[:-1, None] + width * _NODES).ravel()
        weights = (width * _WEIGHTS).ravel() * 2 * numpy.pi * numpy.sin(angle)
        inside = (angle[:, None] > low) & (angle[:, None] < high)
        return lagrange(corners, self._block.order, angle).T @ (inside * weights[:, None])

    @cached_property
    def _ordered_systems(self) -> tuple[tuple[Numbers, int, StiffnessPowers], ...]:
        """Systems of m = 0, of m = 1 and of all higher m, whose supports differ.

        Each has the free unknowns in the order of elimination, the number of contact unknowns at the end, and the
        stiffness matrices between these unknowns.
        """
        systems = []
        for m in range(3):
            fixed, normals = self._fixed_unknowns(m), 3 * self.bore + 1
            normals = normals[~fixed[normals]]
            order = elimination_order(self._block, self._element_unknowns, fixed, normals)
            powers = (power[order][:, order].sorted_indices() for power in self.stiffness_powers)
            systems.append((order, len(normals), tuple(powers)))
        return tuple(systems)

    def _fixed_unknowns(self, m: int) -> Numbers:
        """Return the mask of unknowns that are zero: on the axis by symmetry, and at the supports.

        A sliding liner can rotate about its centre without load, so one more unknown is fixed.
        """
        is_fixed = numpy.zeros((self._block.number.size, 3), dtype=bool)
        axis, outside = self._block.number[0], self._block.number[:, -1]
        is_fixed[axis] = {0: (True, False, False), 1: (False, True, False)}.get(m, (True, True, True))
        if m == 1 and self.shape.slides:
            is_fixed[axis[0], 0] = True
        if self.shape.support is Support.FIXED or self.shape.layers[-1][0] == inf:
            is_fixed[outside, 1] = True
            if not (self.shape.slides and len(self.shape.layers) == 1):
                is_fixed[outside] = True
        else:
            outermost = self._block.strips[self._block.layer == len(self.shape.layers) - 1][0]
            is_fixed[self._block.number[-1, outermost:], 0] = True
            is_fixed[self._block.number[-1, outermost:], 2] = True
        is_fixed[:, 2] |= m == 0
        return is_fixed.ravel()

    @cached_property
    def _element_unknowns(self) -> Numbers:
        return self.elastic.number_unknowns(3)

    def has_mesh_of(self, other: Harmonics) -> bool:
        """Return True if both meshes have the same elements, at any radii."""
        return numpy.array_equal(self._block.layer, other.elastic.block.layer)

    @cached_property
    def stiffness_powers(self) -> StiffnessPowers:
        """Stiffness matrices K0, K1 and K2 of the powers of m.

        They integrate the energy density 2G (|ε|² - tr²/3) + K tr² over elements.
        """
        elements = numpy.arange(self._block.elements.shape[1])
        points, weights = element_quadrature(self._block.order)
        gradients = self.elastic.gradients(elements, points)
        volume = gradients.volume * weights
        shear, bulk = (modulus[self._block.layers][:, None] * volume for modulus in self.elastic.moduli)
        plain, azimuthal = self._harmonic_strains(gradients.strain, points, gradients.coordinates[0])
        traces = plain[..., :2, :].sum(axis=-2) + plain[..., _HOOP, :], azimuthal[..., _HOOP, :]
        swelling = [self.elastic.project_volume(elements, gradients.coordinates, volume, trace) for trace in traces]
        scale = _SCALE * numpy.sqrt(shear)[..., None, None]
        rows = [(strain * scale).reshape(len(strain), -1, strain.shape[-1]) for strain in (plain, azimuthal)]
        drops = [trace * numpy.sqrt(2 / 3 * shear)[..., None] for trace in traces]
        swells = [projection * numpy.sqrt(bulk)[..., None] for projection in swelling]

        def multiply_strains(i: int, j: int) -> Numbers:
            strain, swell, drop = (factors[i].swapaxes(1, 2) @ factors[j] for factors in (rows, swells, drops))
            return strain + swell - drop

        mixed, size = multiply_strains(0, 1), 3 * self._block.number.size
        powers = multiply_strains(0, 0), mixed + mixed.swapaxes(1, 2), multiply_strains(1, 1)
        constant, linear, quadratic = (assemble(K, self._element_unknowns, size) for K in powers)
        return constant, linear, quadratic

    def _harmonic_strains(self, axisymmetric: Numbers, points: Numbers, rho: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the strains per unknown (elements, points, 6, unknowns): terms without m, and terms per unit of m.

        The components are ε_ρρ, ε_zz, γ_ρz, ε_φφ, γ_ρφ and γ_zφ; `axisymmetric` holds the first four.
        """
        shapes, slopes, _ = self.elastic.cartesian_shape_functions(numpy.arange(len(rho)), points)
        count = len(shapes)
        over_radius = shapes.T / rho[..., None]
        phi = self._block.angle[self._block.elements // self._block.radius.shape[1]].T[:, None]
        plain, azimuthal = numpy.zeros((2, *rho.shape, 6, count, 3))
        plain[..., :_DIRECT, :, :2] = axisymmetric.reshape(*rho.shape, _DIRECT, count, 2)
        plain[..., 4, :, 2], plain[..., 5, :, 2] = slopes[..., 0, :] - over_radius, slopes[..., 1, :]
        azimuthal[..., _HOOP, :, 2] = over_radius
        azimuthal[..., 4, :, 0], azimuthal[..., 4, :, 1] = -over_radius * numpy.cos(phi), -over_radius * numpy.sin(phi)
        azimuthal[..., 5, :, 0], azimuthal[..., 5, :, 1] = over_radius * numpy.sin(phi), -over_radius * numpy.cos(phi)
        return plain.reshape(*rho.shape, 6, -1), azimuthal.reshape(*rho.shape, 6, -1)


_GROWTH, _DEEPEST = 1.6, 0.27
"""Growth of the elements from the bore outwards, and the thickest as a fraction of its layer."""


def socket_harmonics(shape: SocketShape, edges: Numbers) -> Harmonics:
    """Mesh a socket for rings of pressure between these angles in rad, with one biquadratic element along each."""
    size = float(numpy.diff(edges).max())
    resolution = Resolution(size=size, reach=inf, growth=_GROWTH, widest=size, deepest=_DEEPEST, order=2)
    angle = shape.extend_to_rim(edges, size)
    mesh = socket_block(shape, angle, shape.radii(angle, resolution), resolution.order)
    return Harmonics(elastic=socket_elastic(shape, mesh), shape=shape)


def _sum_powers(powers: StiffnessPowers, m: int) -> csc_matrix:
    """Sum the stiffness matrices of the powers of m: K0 + m K1 + m² K2."""
    constant, linear, quadratic = powers
    return constant + m * linear + m * m * quadratic
