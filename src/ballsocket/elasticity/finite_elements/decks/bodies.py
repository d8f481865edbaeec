"""Both bodies of a contact in a deck: the ball at first contact, with a scaled clearance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy

from ....core.arrays import Numbers
from ....problem import Joint, Material
from ..bodies import ball_body, socket_body
from ..contact import MeshedContact
from ..mesh import Block, block
from ..shapes import socket_shape
from ..surfaces import SurfacePair
from ..tangent import Solved
from .solid import DeckBody

_RING_THICKNESS = 0.05  # meshed part of a rigid ball, over its radius
_ANGLE_TOLERANCE = 1e-9  # rad


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckBodies:
    """Ball and socket of one contact, their materials, and the extent of the pressure nodes."""

    contact: MeshedContact
    scale: float

    @property
    def solved(self) -> Solved:
        """Solved contact on its mesh."""
        return self.contact._solved

    @cached_property
    def joint(self) -> Joint:
        """Joint in plain numbers."""
        return self.contact._plain_joint

    @cached_property
    def socket(self) -> DeckBody:
        """Liner and backing."""
        body = socket_body(socket_shape(self.joint, self.contact.model.cup), self.solved.pair.resolution)
        return DeckBody(
            names=("LINER", *(f"BACKING{number}" for number in range(1, len(self.joint.backing) + 1))),
            block=body.elastic.block,
            fixed_directions=body.fixed_unknowns.reshape(-1, 2).T,
            contact=body.contact,
            radius=float(self.joint.socket_radius),
        )

    @cached_property
    def ball(self) -> DeckBody:
        """Ball at first contact, with the radius that the scaled clearance leaves."""
        mesh, fixed_directions, contact = self._ring() if self.joint.ball is None else self._half(self.joint.ball)
        clearance = self.scale * float(self.joint.clearance)
        return DeckBody(
            names=("BALL",),
            block=mesh,
            fixed_directions=fixed_directions,
            contact=contact,
            radius=float(self.joint.socket_radius) - clearance,
            drop=clearance,
            nodes_before=self.socket.nodes,
            elements_before=self.socket.block.elements.shape[1],
        )

    def _half(self, material: Material) -> tuple[Block, Numbers, Numbers]:
        """Mesh half of an elastic ball."""
        body = ball_body(float(material.poisson), self.solved.pair.ball_resolution)
        return body.elastic.block, body.fixed_unknowns.reshape(-1, 2).T, body.contact

    def _ring(self) -> tuple[Block, Numbers, Numbers]:
        """Mesh a rigid ball: one layer of elements, matching the bore's and one element longer, all of it fixed."""
        corners = self.solved.pair.angle
        corners = numpy.append(corners, 2 * corners[-1] - corners[-2])
        mesh = block(corners, [numpy.array([1 - _RING_THICKNESS, 1.0])], self.solved.pair.resolution.order)
        return mesh, numpy.ones((2, mesh.number.size), dtype=bool), mesh.number[:, -1]

    @property
    def reach(self) -> float:
        """Angle in rad of the last pressure node."""
        return float(self.solved.pair.angle[-1])

    @property
    def materials(self) -> dict[str, tuple[float, float]]:
        """Young's modulus and Poisson's ratio of each set of elements; those of a rigid ball have no effect."""
        joint = self.joint
        materials = [joint.liner, *(layer.material for layer in joint.backing), joint.ball or joint.liner]
        moduli = {
            name: (float(material.young), float(material.poisson))
            for name, material in zip((*self.socket.names, *self.ball.names), materials, strict=True)
        }
        young, poisson = moduli["BALL"]
        return {**moduli, "BALL": (young * float(joint.socket_radius) / self.ball.radius, poisson)}


def faceting_gap(pair: SurfacePair) -> float:
    """Compute the gap in mm between the surface of elements and its sphere; 0 if both bodies have the same nodes.

    A chord lies R h²/2 below its arc of half angle h, a parabola through three of its points R h⁴/32.
    """
    corners = [surface.corners[surface.corners <= pair.angle[-1] + _ANGLE_TOLERANCE] for surface in pair.surfaces]
    if all(len(angles) == len(pair.angle) and abs(angles - pair.angle).max() < _ANGLE_TOLERANCE for angles in corners):
        return 0.0
    half = max(float(numpy.diff(angles).max()) for angles in corners) / 2
    return pair.radius * (half**2 / 2 if pair.resolution.order == 1 else half**4 / 32)
