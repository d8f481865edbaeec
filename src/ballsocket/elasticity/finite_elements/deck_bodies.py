"""Both bodies of a contact in a deck: the ball at first contact, with a scaled clearance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from ...core.arrays import Numbers
from ...problem import Joint
from .bodies import SurfacePair, ball_body, socket_body
from .load_search import Solved
from .mesh import Block, Resolution, mesh_block, socket_shape
from .model import MeshedContact

_RING_THICKNESS = 0.05  # meshed part of a rigid ball, over its radius
_ANGLE_TOLERANCE = 1e-9  # rad


TYPES = {1: "CAX4", 2: "CAX8R"}  # names of bilinear and biquadratic elements in CalculiX and Abaqus


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckBody:
    """Meshed body in the deck.

    `names` are its layers; `fixed_directions` (2, nodes) is along the angle and along the radius. `contact` are the
    nodes of its surface. `radius` (mm) is that of the block's unit, and `drop` the distance of its centre below the
    socket's.
    """

    names: tuple[str, ...]
    block: Block
    fixed_directions: Numbers
    contact: Numbers
    radius: float
    drop: float = 0.0
    nodes_before: int = 0
    elements_before: int = 0

    @cached_property
    def _outer_nodes(self) -> Numbers:
        """Indices of the nodes of each element (4 or 8, elements), without the middle one."""
        return self.block.elements[: 4 * self.block.order]

    @cached_property
    def number(self) -> Numbers:
        """Number of each node of the block in the deck, from 1 on; 0 for nodes in the middle of elements."""
        used = numpy.zeros(self.block.number.size, dtype=bool)
        used[self._outer_nodes] = True
        return numpy.where(used, self.nodes_before + numpy.cumsum(used), 0)

    def node_numbers(self, mask: Numbers) -> list[int]:
        """Return the deck's numbers of the nodes in a mask (nodes,), without those in the middle of elements."""
        return self.number[mask & (self.number > 0)].tolist()

    @cached_property
    def axis_nodes(self) -> Numbers:
        """Mask of the nodes on the load axis."""
        return numpy.isin(numpy.arange(self.block.number.size), self.block.number[0])

    @property
    def fixed_nodes(self) -> Numbers:
        """Mask of the nodes that are fixed in both directions."""
        return self.fixed_directions[0] & self.fixed_directions[1]

    @property
    def sliding(self) -> tuple[Numbers, Numbers]:
        """Indices of the nodes on the inner and on the outer side of sliding interfaces."""
        columns = self.block.sliding
        return self.block.number[:, columns].ravel(), self.block.number[:, columns + 1].ravel()

    @property
    def corners(self) -> Numbers:
        """Angles (rad) of the elements' corners."""
        return self.block.angle[:: self.block.order]

    def surface(self) -> dict[str, list[Any]]:
        """Return the deck's numbers and angles (rad) of the contact nodes, from the pole outwards."""
        return {"node": self.number[self.contact].tolist(), "angle": self.block.angle[: len(self.contact)].tolist()}

    def contact_elements(self, reach: float, *, strip: int, extra: int = 0) -> Numbers:
        """Return the deck's numbers of the elements of a strip up to an angle (rad), and of a few extra ones."""
        strips = len(self.block.strips)
        count = min(int(numpy.searchsorted(self.corners, reach - _ANGLE_TOLERANCE)) + extra, len(self.corners) - 1)
        return self.elements_before + 1 + numpy.arange(count) * strips + strip % strips

    def node_lines(self) -> Iterator[str]:
        """Yield a line of number and coordinates for each node; CalculiX reads 20 characters of a number."""
        across, below = self.radius * self.block.nodes
        for node in numpy.flatnonzero(self.number):
            yield f"{self.number[node]}, {across[node]:.14g}, {-below[node] - self.drop:.14g}"

    def element_lines(self) -> Iterator[str]:
        """Yield a header for each layer, and a line for each of its elements."""
        for layer, name in enumerate(self.names):
            yield f"*ELEMENT, TYPE={TYPES[self.block.order]}, ELSET={name}"
            for element in numpy.flatnonzero(self.block.layers == layer):
                nodes = self.number[self._outer_nodes[:, element]]
                yield ", ".join(map(str, [self.elements_before + 1 + element, *nodes]))


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckBodies:
    """Ball and socket of one contact, their materials, and the extent of the pressure nodes."""

    contact: MeshedContact
    scale: float

    @property
    def solved(self) -> Solved:
        """Solved contact on its meshes."""
        return self.contact._solved

    @cached_property
    def joint(self) -> Joint:
        """Joint in plain numbers."""
        return self.contact._plain_joint

    @cached_property
    def resolutions(self) -> tuple[Resolution, Resolution]:
        """Element sizes of socket and ball: those of an elastic contact, half as long as those of a yielding one."""
        pair = self.solved.pair
        if self.contact.yields:
            return pair.resolution.halved(), pair.ball_resolution.halved()
        return pair.resolution, pair.ball_resolution

    @cached_property
    def socket(self) -> DeckBody:
        """Body of the socket: liner and backing."""
        body = socket_body(socket_shape(self.joint, self.contact.model.cup), self.resolutions[0])
        return DeckBody(
            names=("LINER", *(f"BACKING{number}" for number in range(1, len(self.joint.backing) + 1))),
            block=body.elastic.block,
            fixed_directions=body.fixed_unknowns.reshape(-1, 2).T,
            contact=body.contact,
            radius=float(self.joint.socket_radius),
        )

    @cached_property
    def ball(self) -> DeckBody:
        """Body of the ball at first contact; its radius is R2 minus the scaled clearance."""
        if self.joint.ball is None:
            # one fixed layer of elements, which match the bore's and extend one element further
            corners = self.socket.corners[self.socket.corners <= self.reach + _ANGLE_TOLERANCE]
            corners = numpy.append(corners, 2 * corners[-1] - corners[-2])
            radii = numpy.array([1 - _RING_THICKNESS, 1.0])
            mesh = mesh_block(corners, [radii], self.resolutions[0].order)
            fixed_directions, contact = numpy.ones((2, mesh.number.size), dtype=bool), mesh.number[:, -1]
        else:
            body = ball_body(float(self.joint.ball.poisson), self.resolutions[1])
            mesh, fixed_directions, contact = body.elastic.block, body.fixed_unknowns.reshape(-1, 2).T, body.contact
        clearance = self.scale * float(self.joint.clearance)
        return DeckBody(
            names=("BALL",),
            block=mesh,
            fixed_directions=fixed_directions,
            contact=contact,
            radius=float(self.joint.socket_radius) - clearance,
            drop=clearance,
            nodes_before=int(self.socket.number.max()),
            elements_before=self.socket.block.elements.shape[1],
        )

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
