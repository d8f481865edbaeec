"""Half of a spherical block in quadratic bricks, and wedges at its pole, as decks number them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy

from ...core.arrays import Numbers
from ..finite_elements.mesh import add_midpoints
from .directions import unit_vectors


@dataclass(frozen=True, kw_only=True, eq=False)
class Bricks:
    """A block of a sphere between polar angles, azimuths from 0 to π, and radii, in bricks and, at the pole, wedges.

    Attributes
    ----------
    polar, azimuth, radius : array
        Of the corners, ascending; the first polar angle is 0.
    centre : array (3,)
        In mm.
    before : tuple of int
        Nodes and elements of other bodies that are numbered first.
    """

    polar: Numbers
    azimuth: Numbers
    radius: Numbers
    centre: Numbers
    before: tuple[int, int] = (0, 0)

    @cached_property
    def number(self) -> Numbers:
        """Number of the node at each polar angle, azimuth and radius, middles included; 0 where there is none."""
        shape = tuple(2 * len(part) - 1 for part in (self.polar, self.azimuth, self.radius))
        i, j, k = numpy.indices(shape)
        used = (i % 2 + j % 2 + k % 2) <= 1
        used[0, 1:] = False  # all azimuths meet at the pole
        number = numpy.where(used, self.before[0] + numpy.cumsum(used).reshape(shape), 0)
        number[0, 1:] = number[0, :1]
        return number

    @property
    def count(self) -> int:
        """The last node's number."""
        return int(self.number.max())

    @cached_property
    def places(self) -> Numbers:
        """Where each node lies in mm: (3, polar, azimuth, radius)."""
        polar, azimuth, radius = (add_midpoints(part, 2) for part in (self.polar, self.azimuth, self.radius))
        out = unit_vectors(polar[:, None], azimuth)
        return out[..., None] * radius + self.centre[:, None, None, None]

    def elements(self) -> Iterator[tuple[int, str, tuple[int, int, int], list[int]]]:
        """Number, type, place and nodes of each element."""
        number = self.before[1]
        for i, j, k in numpy.ndindex(len(self.polar) - 1, len(self.azimuth) - 1, len(self.radius) - 1):
            number += 1
            kind, steps = ("C3D15", _WEDGE) if i == 0 else ("C3D20R", _BRICK)
            nodes = [int(self.number[2 * i + a, 2 * j + b, 2 * k + c]) for a, b, c in steps]
            yield number, kind, (i, j, k), nodes

    def node_lines(self) -> Iterator[str]:
        """A line for each node."""
        flat = self.places.reshape(3, -1)
        numbers, first = numpy.unique(self.number.ravel(), return_index=True)
        for number, place in zip(numbers, first, strict=True):
            if number:
                x, y, z = flat[:, place]
                yield f"{number}, {x:.14g}, {y:.14g}, {z:.14g}"


def _edges(corners: list[tuple[int, int]]) -> list[tuple[int, int]]:
    return [((a + c) // 2, (b + d) // 2) for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1], strict=True)]


def _layered(corners: list[tuple[int, int]], middles: list[tuple[int, int]]) -> list[tuple[int, int, int]]:
    """Corners below and above, middles below and above, and the uprights between."""
    rows = [(corners, 0), (corners, 2), (middles, 0), (middles, 2), (corners, 1)]
    return [(a, b, c) for row, c in rows for a, b in row]


_SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2)]
_BRICK = _layered(_SQUARE, _edges(_SQUARE))
_WEDGE = _layered([(0, 0), (2, 0), (2, 2)], [(1, 0), (2, 1), (1, 2)])
