"""Ball and socket as elastic bodies with their supports.

The ball is the half that faces the socket, supported at its equator, which stays plane and is free to expand. The
socket ends at its rim. Its outer surface is fixed; or it is free, and the socket stands on its rim, which stays on its
cone.
"""

from __future__ import annotations

from functools import lru_cache
from math import inf

import numpy

from ...core.arrays import Numbers
from ...problem import Support
from .condensation import CondensedBody
from .elasticity import ElasticBlock
from .mesh import Block, mesh_block
from .shapes import Resolution, SocketShape, ball_corners


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
    """Return the mask of displacements that are zero because their node lies on the axis."""
    fixed_unknowns = numpy.zeros(2 * mesh.number.size, dtype=bool)
    fixed_unknowns[2 * mesh.number[0]] = True
    return fixed_unknowns


@lru_cache(maxsize=64)
def socket_compliance(shape: SocketShape, resolution: Resolution) -> tuple[Numbers, Numbers]:
    """Compute angles (rad) and compliance matrix of the nodes on the bore, from a cache.

    The matrix has normal displacements by unit normal forces.
    """
    return _surface_compliance(socket_body(shape, resolution))


@lru_cache(maxsize=64)
def ball_compliance(poisson: float, resolution: Resolution) -> tuple[Numbers, Numbers]:
    """Compute angles (rad) and compliance matrix of the nodes on the ball's surface, from a cache.

    The matrix has normal displacements by unit normal forces.
    """
    return _surface_compliance(ball_body(poisson, resolution))


def _surface_compliance(body: CondensedBody) -> tuple[Numbers, Numbers]:
    """Compute angles (rad) and compliance matrix of a body's contact nodes."""
    block = body.elastic.block
    return block.angle[: len(body.contact)], body.compliance()
