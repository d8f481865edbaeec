"""One body in an input deck: numbered nodes and elements, written as lines."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from ....core.arrays import Numbers
from ..mesh import Block

TYPES = {1: "CAX4", 2: "CAX8R"}
"""Names of bilinear and biquadratic elements in CalculiX and Abaqus."""

_NUMBERS_PER_LINE = 16
_ANGLE_TOLERANCE = 1e-9  # rad


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckBody:
    """CondensedBody in the deck.

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
        """Nodes of each element (4 or 8, elements), without the middle one."""
        return self.block.elements[: 4 * self.block.order]

    @cached_property
    def number(self) -> Numbers:
        """Number of each node of the block in the deck, from 1 on; 0 for nodes in the middle of elements."""
        used = numpy.zeros(self.block.number.size, dtype=bool)
        used[self._outer_nodes] = True
        return numpy.where(used, self.nodes_before + numpy.cumsum(used), 0)

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return int(numpy.count_nonzero(self.number))

    def numbers(self, chosen: Numbers) -> list[int]:
        """Return the numbers in the deck of the nodes in a mask (nodes,), without those in the middle of elements."""
        return self.number[chosen & (self.number > 0)].tolist()

    @cached_property
    def on_axis(self) -> Numbers:
        """Mask of the nodes on the load axis."""
        mask = numpy.zeros(self.block.number.size, dtype=bool)
        mask[self.block.number[0]] = True
        return mask

    @property
    def fixed(self) -> Numbers:
        """Mask of the nodes that are fixed in both directions."""
        return self.fixed_directions[0] & self.fixed_directions[1]

    @property
    def sliding(self) -> tuple[Numbers, Numbers]:
        """Nodes on the inner and on the outer side of sliding interfaces."""
        columns = self.block.sliding
        return self.block.number[:, columns].ravel(), self.block.number[:, columns + 1].ravel()

    def surface(self) -> dict[str, list[Any]]:
        """Return numbers and angles of the contact nodes, from the pole outwards."""
        return {"node": self.number[self.contact].tolist(), "angle": self.block.angle[: len(self.contact)].tolist()}

    def contact_elements(self, reach: float, *, strip: int, extra: int = 0) -> Numbers:
        """Return the numbers of the elements of a strip that begin before an angle, and of a few extra ones."""
        corners, strips = self.block.angle[:: self.block.order], len(self.block.strips)
        count = min(int(numpy.searchsorted(corners, reach - _ANGLE_TOLERANCE)) + extra, len(corners) - 1)
        return self.elements_before + 1 + numpy.arange(count) * strips + strip % strips

    def node_lines(self) -> Iterator[str]:
        """Write the nodes; CalculiX reads at most twenty characters a number."""
        across, below = self.radius * self.block.nodes
        for node in numpy.flatnonzero(self.number):
            yield f"{self.number[node]}, {across[node]:.14g}, {-below[node] - self.drop:.14g}"

    def element_lines(self) -> Iterator[str]:
        """Write a header for each layer, and a line for each of its elements."""
        for layer, name in enumerate(self.names):
            yield f"*ELEMENT, TYPE={TYPES[self.block.order]}, ELSET={name}"
            for element in numpy.flatnonzero(self.block.layers == layer):
                nodes = self.number[self._outer_nodes[:, element]]
                yield ", ".join(map(str, [self.elements_before + 1 + element, *nodes]))


def node_set(name: str, nodes: list[int]) -> Iterator[str]:
    """Write a named set of nodes."""
    yield f"*NSET, NSET={name}"
    for start in range(0, len(nodes), _NUMBERS_PER_LINE):
        yield ", ".join(map(str, nodes[start : start + _NUMBERS_PER_LINE]))
