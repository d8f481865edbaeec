"""Ball and socket as elastic bodies with their supports.

The ball is the half that faces the socket, held by its equator, which stays plane and is free along itself. The socket
ends at its rim. Outside it is fixed; or free, and then it sits on its rim, which stays on its cone.
"""

from __future__ import annotations

from functools import lru_cache
from math import inf

import numpy

from ...core.arrays import Numbers
from ...problem import Support
from .condensation import CondensedBody
from .elasticity import ElasticBlock
from .mesh import Block, block
from .shapes import Resolution, SocketShape, ball_corners


def socket_body(shape: SocketShape, resolution: Resolution) -> CondensedBody:
    """The socket, pressed from the inside."""
    angle, radii = shape.corners(resolution)
    mesh = socket_block(shape, angle, radii, resolution.order)
    outside = mesh.number[:, -1]
    held = _axis_held(mesh)
    if shape.support is Support.FIXED or shape.layers[-1][0] == inf:
        held[2 * outside + 1] = True
        held[2 * outside] |= not (shape.slides and len(radii) == 1)
    else:
        outermost = mesh.strips[mesh.layer == len(radii) - 1][0]  # a liner that slides in it keeps its own rim free
        held[2 * mesh.number[-1, outermost:]] = True
    bore = mesh.number[: int(numpy.searchsorted(mesh.angle, shape.reach + 1e-9)), 0]
    return CondensedBody(elastic=socket_elastic(shape, mesh), held=held, contact=bore)


def socket_block(shape: SocketShape, angle: Numbers, radii: list[Numbers], order: int) -> Block:
    """The socket's mesh from the corners of its elements; a liner that slides is parted from what is behind it."""
    return block(angle, radii, order, (1,) if shape.slides and len(radii) > 1 else ())


def socket_elastic(shape: SocketShape, mesh: Block) -> ElasticBlock:
    """The socket's mesh with the materials of its layers."""
    young, poisson = (numpy.array([layer[i] for layer in shape.layers]) for i in (1, 2))
    return ElasticBlock(block=mesh, young=young, poisson=poisson)


def ball_body(poisson: float, resolution: Resolution) -> CondensedBody:
    """A ball of radius 1 and Young's modulus 1, pressed from the outside."""
    angle, radii = ball_corners(resolution)
    mesh = block(angle, [radii], resolution.order)
    held = _axis_held(mesh)
    held[2 * mesh.number[-1]] = True  # the equator stays plane
    elastic = ElasticBlock(block=mesh, young=numpy.ones(1), poisson=numpy.array([poisson]))
    return CondensedBody(elastic=elastic, held=held, contact=mesh.number[:, -1])


def _axis_held(mesh: Block) -> Numbers:
    held = numpy.zeros(2 * mesh.number.size, dtype=bool)
    held[2 * mesh.number[0]] = True
    return held


@lru_cache(maxsize=64)
def socket_compliance(shape: SocketShape, resolution: Resolution) -> tuple[Numbers, Numbers]:
    """Angles of the bore's nodes, and their normal displacements by normal forces."""
    return _condensed(socket_body(shape, resolution))


@lru_cache(maxsize=64)
def ball_compliance(poisson: float, resolution: Resolution) -> tuple[Numbers, Numbers]:
    """Angles of the nodes on the ball's surface, and their normal displacements by normal forces."""
    return _condensed(ball_body(poisson, resolution))


def _condensed(body: CondensedBody) -> tuple[Numbers, Numbers]:
    block = body.elastic.block
    return block.angle[: len(body.contact)], body.compliance()
