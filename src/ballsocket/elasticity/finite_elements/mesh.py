"""Meshes of ball and socket by geometry alone: spherical blocks of quadrilaterals in the half plane through the axis.

A polar angle φ counts from the pole of the contact; a point lies at the distance ρ = r sin φ from the load axis and at
the height z = r cos φ below the centre. Lengths are in units of the contact's radius.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy

from ...core.arrays import Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """A spherical block meshed along its angles and radii.

    Attributes
    ----------
    angle : array (angles,)
        Of the nodes in rad, ascending. For order 2 every other one lies between the corners of the elements.
    radius : array (angles, radii)
        Of the nodes, ascending. Where two layers slide on each other a radius stands twice.
    strips : array of int
        The first radius of each strip of elements.
    layer : array of int
        The layer that each strip belongs to.
    order : int
        1 is bilinear, 2 biquadratic.
    """

    angle: Numbers
    radius: Numbers
    strips: Numbers
    layer: Numbers
    order: int

    @cached_property
    def number(self) -> Numbers:
        """Number of each node, shape (angles, radii)."""
        return numpy.arange(self.radius.size).reshape(self.radius.shape)

    @cached_property
    def nodes(self) -> Numbers:
        """(ρ, z) of each node, shape (2, nodes)."""
        phi = self.angle[:, None]
        return numpy.stack([(numpy.sin(phi) * self.radius).ravel(), (numpy.cos(phi) * self.radius).ravel()])

    @cached_property
    def elements(self) -> Numbers:
        """Nodes of each element (nodes, elements): corners, for order 2 edges and middle, in scikit-fem's order."""
        step = self.order
        corners = [(0, 0), (0, step), (step, step), (step, 0)]
        between = [(0, 1), (1, 2), (2, 1), (1, 0), (1, 1)] if step == 2 else []
        rows = len(self.angle) - step
        parts = [self.number[i : i + rows : step][:, self.strips + j] for i, j in [*corners, *between]]
        return numpy.stack([part.ravel() for part in parts])

    @cached_property
    def layers(self) -> Numbers:
        """The layer of each element."""
        return numpy.tile(self.layer, (len(self.angle) - 1) // self.order)

    @cached_property
    def sliding(self) -> Numbers:
        """The radii that stand twice: the inner of each two."""
        return numpy.flatnonzero(numpy.diff(self.place) == 0)

    @cached_property
    def place(self) -> Numbers:
        """Counts the radii (radii,), two that slide on each other as one."""
        inside = numpy.zeros(self.radius.shape[1], dtype=bool)
        for step in range(1, self.order + 1):
            inside[self.strips + step] = True
        return numpy.cumsum(inside)


def block(angle: Numbers, layers: list[Numbers], order: int, parted: tuple[int, ...] = ()) -> Block:
    """A block from the corners of its elements.

    Parameters
    ----------
    angle : array (corners,)
        In rad.
    layers : list of arrays
        The radii of each layer's corners (corners,), from the inside out; each begins where the one before ends. Or
        radii that vary along the angle (corner angles, corners).
    order : int
    parted : tuple of int
        The layers that slide on the one inside of them.
    """
    angle = add_midpoints(angle, order)
    columns: list[Numbers] = []
    strips: list[int] = []
    owner: list[int] = []
    count = 0
    for index, layer in enumerate(layers):
        rows = numpy.broadcast_to(layer, ((len(angle) - 1) // order + 1, layer.shape[-1]))
        radius = add_midpoints(add_midpoints(rows.T, order).T, order)
        shared = 0 if index == 0 or index in parted else 1
        strips += range(count - shared, count - shared + radius.shape[1] - order, order)
        owner += [index] * ((radius.shape[1] - 1) // order)
        columns.append(radius[:, shared:])
        count += radius.shape[1] - shared
    radii = numpy.concatenate(columns, axis=1)
    return Block(angle=angle, radius=radii, strips=numpy.array(strips), layer=numpy.array(owner), order=order)


def add_midpoints(corners: Numbers, order: int) -> Numbers:
    """The places of all nodes from those of the corners, along the first axis."""
    return corners if order == 1 else bisect_intervals(corners)


def bisect_intervals(corners: Numbers) -> Numbers:
    """The corners with one more between each two of them."""
    between = (corners[1:] + corners[:-1]) / 2
    return numpy.insert(corners, numpy.arange(1, len(corners)), between, axis=0)


def graded_points(start: float, end: float, first: float, growth: float, longest: float) -> Numbers:
    """Places from start to end: the first interval about as given, each next one longer, up to `longest`."""
    reach = abs(end - start)
    steps = [min(first, reach)]
    total = steps[0]
    while total < reach * (1 - 1e-9):
        steps.append(min(steps[-1] * growth, longest))
        total += steps[-1]
    places = start + numpy.sign(end - start) * numpy.append(0.0, numpy.cumsum(steps)) * (reach / total)
    places[-1] = end
    return places


def join_points(parts: list[Numbers]) -> Numbers:
    """Rows of places that each begin where the one before ends."""
    for before, after in pairwise(parts):
        assert before[-1] == after[0]
    return numpy.concatenate([parts[0], *(part[1:] for part in parts[1:])])
