"""A socket under loads that go around its axis as cos mφ: one mesh of the meridian serves every m.

With u_ρ and u_z ~ cos mφ and the azimuthal u_φ ~ sin mφ, strains are those of the axisymmetric problem and a part
that is proportional to m, so that the stiffness is K0 + m K1 + m² K2. The unknowns of node i are 3i, 3i + 1 and 3i + 2:
along the angle, along the radius and around the axis. As in `elasticity` the change of volume is projected.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from ...core.arrays import Numbers, gauss_legendre
from ...problem import Support
from .bodies import socket_block, socket_elastic
from .condensation import nested_dissection
from .elasticity import ElasticBlock, integration
from .mesh import Block
from .shapes import Resolution, SocketShape
from .surfaces import lagrange

_DIRECT, _HOOP, _SHEARS = 4, 3, (4, 5)
_SCALE = numpy.sqrt(numpy.array([2.0, 2.0, 1.0, 2.0, 1.0, 1.0]))[:, None]
_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(5))


@dataclass(frozen=True, kw_only=True, eq=False)
class Harmonics:
    """A socket's meridian for loads on its bore that go as cos mφ.

    Parameters
    ----------
    elastic : ElasticBlock
    shape : SocketShape
        What the mesh was made of.
    """

    elastic: ElasticBlock
    shape: SocketShape

    @property
    def _block(self) -> Block:
        return self.elastic.block

    @cached_property
    def bore(self) -> Numbers:
        """The nodes of the bore, from the pole to where it ends."""
        reach = int(numpy.searchsorted(self._block.angle, self.shape.reach + 1e-9))
        return self._block.number[:reach, 0]

    def ring_compliance(self, edges: Numbers, degrees: Iterable[int]) -> Numbers:
        """What rings of pressure cos mφ do to each other: the displacement of each, integrated over it.

        Parameters
        ----------
        edges : array (rings + 1,)
            Polar angles between rings in rad, among the corners of the elements.
        degrees : int
            The m.

        Returns
        -------
        array (degrees, rings, rings)
            ∫ u dA over the ring of the row by a unit of pressure on that of the column, without the factor
            ∫ cos² mφ dφ/2π; symmetric. For a bore of radius 1 and a liner of Young's modulus 1.
        """
        loads = self._ring_loads(edges)
        return numpy.stack([self._compliance(m, loads) for m in degrees])

    def _ring_loads(self, edges: Numbers) -> Numbers:
        """Forces on the bore's nodes by a unit of pressure on each ring: (nodes, rings)."""
        corners = self._block.angle[: len(self.bore) : self._block.order]
        low, high = edges[:-1], edges[1:]
        width = numpy.diff(corners)[:, None]
        angle = (corners[:-1, None] + width * _NODES).ravel()
        weights = (width * _WEIGHTS).ravel() * 2 * numpy.pi * numpy.sin(angle)
        inside = (angle[:, None] > low) & (angle[:, None] < high)
        return lagrange(corners, self._block.order, angle).T @ (inside * weights[:, None])

    def _compliance(self, m: int, loads: Numbers) -> Numbers:
        order, count = self._order(m)
        zero, one, two = self._matrices
        matrix = (zero + m * one + m * m * two)[order][:, order].tocsc()
        factors = splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        lower, upper = factors.L[-count:, -count:].toarray(), factors.U[-count:, -count:].toarray()
        felt = loads[-count:]
        compliance = felt.T @ numpy.linalg.solve(upper, numpy.linalg.solve(lower, felt))
        return (compliance + compliance.T) / 2

    def _order(self, m: int) -> tuple[Numbers, int]:
        """The free unknowns, the normal ones of the bore last, and how many these are."""
        block = self._block
        grid = numpy.arange(len(block.angle) * (block.place[-1] + 1)).reshape(len(block.angle), -1)
        rank = numpy.empty(grid.size, dtype=int)
        rank[nested_dissection(grid, block.order)] = numpy.arange(grid.size)
        of_node = rank[grid[:, block.place]].ravel()
        normals = 3 * self.bore + 1
        normals = normals[~self._held(m)[normals]]
        free = numpy.unique(self._unknowns)
        free = free[~self._held(m)[free] & ~numpy.isin(free, normals)]
        return numpy.concatenate([free[numpy.argsort(of_node[free // 3], kind="stable")], normals]), len(normals)

    def _held(self, m: int) -> Numbers:
        """Unknowns that are zero: on the axis what is not smooth there, and the supports.

        A liner that slides can turn about its centre: no pressure on its bore does that, and one unknown forbids it.
        """
        held = numpy.zeros((self._block.number.size, 3), dtype=bool)
        axis, outside = self._block.number[0], self._block.number[:, -1]
        held[axis] = {0: (True, False, False), 1: (False, True, False)}.get(m, (True, True, True))
        if m == 1 and self.shape.slides:
            held[axis[0], 0] = True
        if self.shape.support is Support.FIXED or self.shape.layers[-1][0] == inf:
            held[outside, 1] = True
            if not (self.shape.slides and len(self.shape.layers) == 1):
                held[outside] = True
        else:
            outermost = self._block.strips[self._block.layer == len(self.shape.layers) - 1][0]
            held[self._block.number[-1, outermost:], 0] = True
            held[self._block.number[-1, outermost:], 2] = True
        held[:, 2] |= m == 0
        return held.ravel()

    @cached_property
    def _unknowns(self) -> Numbers:
        """Numbers of each element's unknowns (elements, unknowns); layers that slide on each other share u_r."""
        own = numpy.arange(3 * self._block.number.size)
        for column in self._block.sliding:
            own[3 * self._block.number[:, column + 1] + 1] = 3 * self._block.number[:, column] + 1
        numbers = own[3 * self._block.elements[..., None] + numpy.arange(3)]
        return numbers.transpose(1, 0, 2).reshape(self._block.elements.shape[1], -1)

    @cached_property
    def _matrices(self) -> tuple[csc_matrix, csc_matrix, csc_matrix]:
        """K0, K1 and K2."""
        size = 3 * self._block.number.size
        rows, columns = numpy.broadcast_arrays(self._unknowns[:, :, None], self._unknowns[:, None, :])
        places = rows.ravel(), columns.ravel()
        zero, one, two = (coo_matrix((K.ravel(), places), shape=(size, size)).tocsc() for K in self._element_matrices())
        return zero, one, two

    def _element_matrices(self) -> tuple[Numbers, Numbers, Numbers]:
        """Energy 2G (|ε|² - tr²/3) + K tr² in powers of m."""
        every = numpy.arange(self._block.elements.shape[1])
        points, weights = integration(self._block.order)
        gradients = self.elastic.gradients(every, points)
        volume = gradients.volume * weights
        shear, bulk = (modulus[self._block.layers][:, None] * volume for modulus in self.elastic.moduli)
        plain, turned = self._strains(gradients.strain, points, gradients.place[0])
        traces = plain[..., :2, :].sum(axis=-2) + plain[..., _HOOP, :], turned[..., _HOOP, :]
        swelling = [self.elastic.projected(every, gradients.place, volume, trace) for trace in traces]
        rows = [_flat(strain * (_SCALE * numpy.sqrt(shear)[..., None, None])) for strain in (plain, turned)]
        drops = [trace * numpy.sqrt(2 / 3 * shear)[..., None] for trace in traces]
        swells = [each * numpy.sqrt(bulk)[..., None] for each in swelling]

        def product(i: int, j: int) -> Numbers:
            parts = (part[i].swapaxes(1, 2) @ part[j] for part in (rows, swells, drops))
            strain, swell, drop = parts
            return strain + swell - drop

        mixed = product(0, 1)
        return product(0, 0), mixed + mixed.swapaxes(1, 2), product(1, 1)

    def _strains(self, known: Numbers, points: Numbers, rho: Numbers) -> tuple[Numbers, Numbers]:
        """ε_ρρ, ε_zz, γ_ρz, ε_φφ, γ_ρφ, γ_zφ (elements, points, 6, unknowns): without m, and by m.

        `known` are the first four by the unknowns along angle and radius.
        """
        shapes, slopes, _ = self.elastic.cartesian(numpy.arange(len(rho)), points)
        count = len(shapes)
        over = shapes.T / rho[..., None]
        phi = self._block.angle[self._block.elements // self._block.radius.shape[1]].T[:, None]
        plain, turned = numpy.zeros((2, *rho.shape, 6, count, 3))
        plain[..., :_DIRECT, :, :2] = known.reshape(*rho.shape, _DIRECT, count, 2)
        plain[..., 4, :, 2], plain[..., 5, :, 2] = slopes[..., 0, :] - over, slopes[..., 1, :]
        turned[..., _HOOP, :, 2] = over
        turned[..., 4, :, 0], turned[..., 4, :, 1] = -over * numpy.cos(phi), -over * numpy.sin(phi)
        turned[..., 5, :, 0], turned[..., 5, :, 1] = over * numpy.sin(phi), -over * numpy.cos(phi)
        return plain.reshape(*rho.shape, 6, -1), turned.reshape(*rho.shape, 6, -1)


_GROWTH, _DEEPEST = 1.6, 0.27
"""Of the elements from the bore outwards, and the thickest as a share of its layer."""


def socket_harmonics(shape: SocketShape, edges: Numbers) -> Harmonics:
    """A socket meshed for rings of pressure between these angles: one biquadratic element along each.

    Parameters
    ----------
    shape : SocketShape
    edges : array (rings + 1,)
        In rad, from 0 to where the bore ends.
    """
    size = float(numpy.diff(edges).max())
    resolution = Resolution(size=size, reach=inf, growth=_GROWTH, widest=size, deepest=_DEEPEST, order=2)
    angle = shape.to_rim(edges, size)
    mesh = socket_block(shape, angle, shape.radii(angle, resolution), resolution.order)
    return Harmonics(elastic=socket_elastic(shape, mesh), shape=shape)


def _flat(strain: Numbers) -> Numbers:
    """(elements, points times strains, unknowns)."""
    return strain.reshape(len(strain), -1, strain.shape[-1])
