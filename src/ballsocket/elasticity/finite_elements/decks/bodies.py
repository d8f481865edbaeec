"""Both bodies of a contact as a deck has them: where the ball first touches, with a clearance that is scaled."""

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

_RING = 0.05  # of a rigid ball's radius, meshed
_SAME = 1e-9  # rad


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckBodies:
    """Ball and socket of one contact, their materials, and how far a pressure is looked for."""

    contact: MeshedContact
    scale: float

    @property
    def solved(self) -> Solved:
        """The contact on its mesh."""
        return self.contact._solved

    @cached_property
    def joint(self) -> Joint:
        """The joint in plain numbers."""
        return self.contact._plain_joint

    @cached_property
    def socket(self) -> DeckBody:
        """Liner and backing."""
        body = socket_body(socket_shape(self.joint, self.contact.model.cup), self.solved.pair.resolution)
        return DeckBody(
            names=("LINER", *(f"BACKING{number}" for number in range(1, len(self.joint.backing) + 1))),
            block=body.elastic.block,
            held=body.held.reshape(-1, 2).T,
            contact=body.contact,
            radius=float(self.joint.socket_radius),
        )

    @cached_property
    def ball(self) -> DeckBody:
        """Where it first touches. It is as large as the scaled clearance leaves room for."""
        mesh, held, contact = self._ring() if self.joint.ball is None else self._half(self.joint.ball)
        clearance = self.scale * float(self.joint.clearance)
        return DeckBody(
            names=("BALL",),
            block=mesh,
            held=held,
            contact=contact,
            radius=float(self.joint.socket_radius) - clearance,
            drop=clearance,
            nodes_before=self.socket.nodes,
            elements_before=self.socket.block.elements.shape[1],
        )

    def _half(self, material: Material) -> tuple[Block, Numbers, Numbers]:
        body = ball_body(float(material.poisson), self.solved.pair.ball_resolution)
        return body.elastic.block, body.held.reshape(-1, 2).T, body.contact

    def _ring(self) -> tuple[Block, Numbers, Numbers]:
        """A rigid ball: one layer of elements, matching the bore's and one element longer, all of it held."""
        corners = self.solved.pair.angle
        corners = numpy.append(corners, 2 * corners[-1] - corners[-2])
        mesh = block(corners, [numpy.array([1 - _RING, 1.0])], self.solved.pair.resolution.order)
        return mesh, numpy.ones((2, mesh.number.size), dtype=bool), mesh.number[:, -1]

    @property
    def reach(self) -> float:
        """The angle in rad up to which a pressure was looked for."""
        return float(self.solved.pair.angle[-1])

    @property
    def materials(self) -> dict[str, tuple[float, float]]:
        """Young's modulus and Poisson's ratio of each set of elements; those of a rigid ball do not matter."""
        joint = self.joint
        materials = [joint.liner, *(layer.material for layer in joint.backing), joint.ball or joint.liner]
        moduli = {
            name: (float(material.young), float(material.poisson))
            for name, material in zip((*self.socket.names, *self.ball.names), materials, strict=True)
        }
        young, poisson = moduli["BALL"]
        return {**moduli, "BALL": (young * float(joint.socket_radius) / self.ball.radius, poisson)}


def faceting_gap(pair: SurfacePair) -> float:
    """Between the surface of elements and its sphere, in mm; 0 where it is the same for both bodies.

    A chord lies R h²/2 below its arc of half angle h, a parabola through three of its points R h⁴/32.
    """
    corners = [surface.corners[surface.corners <= pair.angle[-1] + _SAME] for surface in pair.surfaces]
    if all(len(own) == len(pair.angle) and abs(own - pair.angle).max() < _SAME for own in corners):
        return 0.0
    half = max(float(numpy.diff(own).max()) for own in corners) / 2
    return pair.radius * (half**2 / 2 if pair.resolution.order == 1 else half**4 / 32)
