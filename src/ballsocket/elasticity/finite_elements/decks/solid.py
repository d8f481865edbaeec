"""One body in a deck: its nodes and elements, with their numbers, as lines."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from ....core.arrays import Numbers
from ..mesh import Block

TYPES = {1: "CAX4", 2: "CAX8R"}
"""What both programs call bilinear and biquadratic elements."""

_A_LINE = 16  # numbers
_SAME = 1e-9  # rad


@dataclass(frozen=True, kw_only=True, eq=False)
class DeckBody:
    """A body in the deck.

    `names` are its layers; `held` (2, nodes) is along the angle and along the radius; `contact` are the nodes of its
    surface; `radius` (mm) is that of the block's unit, and `drop` how far its centre lies below the socket's.
    """

    names: tuple[str, ...]
    block: Block
    held: Numbers
    contact: Numbers
    radius: float
    drop: float = 0.0
    nodes_before: int = 0
    elements_before: int = 0

    @cached_property
    def _rims(self) -> Numbers:
        """Nodes of each element (4 or 8, elements), without the middle."""
        return self.block.elements[: 4 * self.block.order]

    @cached_property
    def number(self) -> Numbers:
        """Number in the deck of each node of the block, from 1 on; 0 for those in the middle of elements."""
        used = numpy.zeros(self.block.number.size, dtype=bool)
        used[self._rims] = True
        return numpy.where(used, self.nodes_before + numpy.cumsum(used), 0)

    @property
    def nodes(self) -> int:
        """How many it has."""
        return int(numpy.count_nonzero(self.number))

    def numbers(self, chosen: Numbers) -> list[int]:
        """Numbers in the deck of the nodes that a mask (nodes,) chooses; those in the middle of elements have none."""
        return self.number[chosen & (self.number > 0)].tolist()

    @cached_property
    def on_axis(self) -> Numbers:
        """Whether each node lies on the load axis."""
        on = numpy.zeros(self.block.number.size, dtype=bool)
        on[self.block.number[0]] = True
        return on

    @property
    def fixed(self) -> Numbers:
        """Whether each node is held in both directions."""
        return self.held[0] & self.held[1]

    @property
    def sliding(self) -> tuple[Numbers, Numbers]:
        """Nodes inside and outside of where layers slide."""
        columns = self.block.sliding
        return self.block.number[:, columns].ravel(), self.block.number[:, columns + 1].ravel()

    def surface(self) -> dict[str, list[Any]]:
        """Numbers and angles of the nodes that may touch, from the pole on."""
        return {"node": self.number[self.contact].tolist(), "angle": self.block.angle[: len(self.contact)].tolist()}

    def touching(self, reach: float, *, strip: int, more: int = 0) -> Numbers:
        """Numbers of the elements of a strip that begin before an angle, and of some more."""
        corners, strips = self.block.angle[:: self.block.order], len(self.block.strips)
        count = min(int(numpy.searchsorted(corners, reach - _SAME)) + more, len(corners) - 1)
        return self.elements_before + 1 + numpy.arange(count) * strips + strip % strips

    def node_lines(self) -> Iterator[str]:
        """Twenty characters a number are all that CalculiX reads."""
        across, below = self.radius * self.block.nodes
        for node in numpy.flatnonzero(self.number):
            yield f"{self.number[node]}, {across[node]:.14g}, {-below[node] - self.drop:.14g}"

    def element_lines(self) -> Iterator[str]:
        """A headline for each layer, and a line for each of its elements."""
        for layer, name in enumerate(self.names):
            yield f"*ELEMENT, TYPE={TYPES[self.block.order]}, ELSET={name}"
            for element in numpy.flatnonzero(self.block.layers == layer):
                nodes = self.number[self._rims[:, element]]
                yield ", ".join(map(str, [self.elements_before + 1 + element, *nodes]))


def node_set(name: str, nodes: list[int]) -> Iterator[str]:
    """The lines that give nodes a name."""
    yield f"*NSET, NSET={name}"
    for start in range(0, len(nodes), _A_LINE):
        yield ", ".join(map(str, nodes[start : start + _A_LINE]))
