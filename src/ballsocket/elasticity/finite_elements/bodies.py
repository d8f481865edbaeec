"""Ball and socket as elastic bodies with their supports, condensed onto their contact surfaces, and pairs of these.

The ball is the half that faces the socket, supported at its equator, which stays plane and is free to expand. The
socket ends at its rim. Its outer surface is fixed; or it is free, and the socket stands on its rim, which stays on its
cone.

The nodes of a structured block are ordered by nested dissection, which needs no graph here: halve the longer side and
place the line between the halves last. The normal displacements of the contact come at the very end. The last block of
the factors is then the factored Schur complement, the stiffness at the contact.

The pressure is linear between the corners of the socket's elements. It is integrated on the sphere itself, between
the corners of both bodies, so their meshes need not match.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf, pi
from typing import Any

import numpy
from scipy.linalg import cholesky, solve_triangular
from scipy.sparse import csc_matrix, csr_array, dia_array
from scipy.sparse.linalg import splu

from ...core.arrays import Numbers, gauss_legendre
from ...problem import Support
from .elasticity import ElasticBlock
from .mesh import Block, Resolution, SocketShape, ball_corners, mesh_block

_MAX_LEAF_SIZE = 24  # nodes in a part that is not halved further


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedBody:
    """Elastic block with supports, and normal loads on its contact surface."""

    elastic: ElasticBlock
    fixed_unknowns: Numbers  # bool (unknowns,), mask of the unknowns that the supports fix to zero
    contact: Numbers  # (nodes,), nodes of the contact surface, from the pole outwards

    @cached_property
    def free_unknowns(self) -> Numbers:
        """Indices of the free unknowns in the order of elimination, those of the contact last."""
        block, unknowns = self.elastic.block, self.elastic.element_unknowns
        return elimination_order(block, unknowns, self.fixed_unknowns, 2 * self.contact + 1)  # normal ones last

    def free_stiffness(self) -> csc_matrix:
        """Assemble the stiffness of the free unknowns in the order of elimination."""
        return self.elastic.stiffness_matrix()[self.free_unknowns][:, self.free_unknowns].tocsc()

    def surface_compliance(self) -> tuple[Numbers, Numbers]:
        """Compute angles (rad) of the contact nodes and their normal displacements by unit normal forces."""
        count = len(self.contact)
        lower, upper = last_factors(factorize(self.free_stiffness()), count)
        stiffness = lower @ upper
        return self.elastic.block.angle[:count], numpy.linalg.inv((stiffness + stiffness.T) / 2)

    def displacements(self, forces: Numbers) -> Numbers:
        """Compute the displacements u_φ and u_r of all nodes, (nodes, 2), under normal forces on contact nodes."""
        load = numpy.zeros(len(self.free_unknowns))
        load[-len(self.contact) :] = forces
        return self.nodal_displacements(factorize(self.free_stiffness()).solve(load))

    def nodal_displacements(self, free_displacements: Numbers) -> Numbers:
        """Return the displacements u_φ and u_r of all nodes, (nodes, 2), from the free unknowns in order."""
        solution = numpy.zeros(len(self.fixed_unknowns))
        solution[self.free_unknowns] = free_displacements
        for column in self.elastic.block.sliding:
            number = self.elastic.block.number
            solution[2 * number[:, column + 1] + 1] = solution[2 * number[:, column] + 1]
        return solution.reshape(-1, 2)


def factorize(matrix: csc_matrix) -> Any:
    """Compute the LU factors of a symmetric matrix, whose unknowns are in the order of elimination."""
    return splu(matrix.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def last_factors(factors: Any, count: int) -> tuple[Numbers, Numbers]:
    """Return the blocks of both LU factors for the last `count` unknowns, those of the contact."""
    return factors.L[-count:, -count:].toarray(), factors.U[-count:, -count:].toarray()


def elimination_order(block: Block, element_unknowns: Numbers, fixed: Numbers, last: Numbers) -> Numbers:
    """Order the free unknowns by nested dissection of their nodes, with the unknowns `last` at the end.

    `fixed` is the mask of the unknowns that are zero. Both nodes of a sliding interface have one rank.
    """
    free = numpy.unique(element_unknowns)
    free = free[~fixed[free] & ~numpy.isin(free, last)]
    per_node = len(fixed) // block.number.size
    grid = numpy.arange(len(block.angle) * (block.level[-1] + 1)).reshape(len(block.angle), -1)
    rank = numpy.empty(grid.size, dtype=int)
    rank[nested_dissection(grid, block.order)] = numpy.arange(grid.size)
    ranks = rank[grid[:, block.level]].ravel()
    return numpy.concatenate([free[numpy.argsort(ranks[free // per_node], kind="stable")], last])


def nested_dissection(nodes: Numbers, order: int, start: tuple[int, int] = (0, 0)) -> Numbers:
    """Order the nodes of a part of a grid, which begins at `start`, by nested dissection between elements."""
    if nodes.size <= _MAX_LEAF_SIZE or min(nodes.shape) <= 2:
        return nodes.ravel()
    along = 0 if nodes.shape[0] >= nodes.shape[1] else 1
    lines = nodes if along == 0 else nodes.T
    middle = len(lines) // 2
    middle += (start[along] + middle) % order  # counted in the full block
    second_start = (start[0] + middle + 1, start[1]) if along == 0 else (start[0], start[1] + middle + 1)
    first, second = (half if along == 0 else half.T for half in (lines[:middle], lines[middle + 1 :]))
    parts = nested_dissection(first, order, start), nested_dissection(second, order, second_start)
    return numpy.concatenate([*parts, lines[middle]])


def socket_body(shape: SocketShape, resolution: Resolution) -> CondensedBody:
    """Mesh the socket as an elastic body that is loaded on its bore."""
    angle, radii = shape.corners(resolution)
    mesh = socket_block(shape, angle, radii, resolution.order)
    outside = mesh.number[:, -1]
    fixed_unknowns = _axis_mask(mesh)
    if shape.support is Support.FIXED or shape.layers[-1][0] == inf:
        fixed_unknowns[2 * outside + 1] = True
        fixed_unknowns[2 * outside] |= not (shape.slides and len(radii) == 1)
    else:
        # the rim of a liner that slides in the outermost layer stays free
        outermost = mesh.strips[mesh.layer == len(radii) - 1][0]
        fixed_unknowns[2 * mesh.number[-1, outermost:]] = True
    bore = mesh.number[: int(numpy.searchsorted(mesh.angle, shape.reach + 1e-9)), 0]
    return CondensedBody(elastic=socket_elastic(shape, mesh), fixed_unknowns=fixed_unknowns, contact=bore)


def socket_block(shape: SocketShape, angle: Numbers, radii: list[Numbers], order: int) -> Block:
    """Mesh the socket from the corners of its elements; a sliding liner has separate nodes."""
    return mesh_block(angle, radii, order, (1,) if shape.slides and len(radii) > 1 else ())


def socket_elastic(shape: SocketShape, mesh: Block) -> ElasticBlock:
    """Assign the materials of the layers to the socket's mesh."""
    young, poisson = (numpy.array([layer[i] for layer in shape.layers]) for i in (1, 2))
    return ElasticBlock(block=mesh, young=young, poisson=poisson)


def ball_body(poisson: float, resolution: Resolution) -> CondensedBody:
    """Mesh the ball with radius and Young's modulus 1 as an elastic body that is loaded on its surface."""
    angle, radii = ball_corners(resolution)
    mesh = mesh_block(angle, [radii], resolution.order)
    fixed_unknowns = _axis_mask(mesh)
    fixed_unknowns[2 * mesh.number[-1]] = True  # the equator stays plane
    elastic = ElasticBlock(block=mesh, young=numpy.ones(1), poisson=numpy.array([poisson]))
    return CondensedBody(elastic=elastic, fixed_unknowns=fixed_unknowns, contact=mesh.number[:, -1])


def _axis_mask(mesh: Block) -> Numbers:
    fixed_unknowns = numpy.zeros(2 * mesh.number.size, dtype=bool)
    fixed_unknowns[2 * mesh.number[0]] = True
    return fixed_unknowns


@lru_cache(maxsize=64)
def socket_compliance(shape: SocketShape, resolution: Resolution) -> tuple[Numbers, Numbers]:
    """Compute angles (rad) and compliance matrix of the nodes on the bore, from a cache."""
    return socket_body(shape, resolution).surface_compliance()


@lru_cache(maxsize=64)
def ball_compliance(poisson: float, resolution: Resolution) -> tuple[Numbers, Numbers]:
    """Compute angles (rad) and compliance matrix of the nodes on the ball's surface, from a cache."""
    return ball_body(poisson, resolution).surface_compliance()


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
        shapes = (lagrange(surface.corners, surface.order, self.points[0]) for surface in self.surfaces)
        return tuple((self._weighted_shapes @ functions).toarray().T for functions in shapes)

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
