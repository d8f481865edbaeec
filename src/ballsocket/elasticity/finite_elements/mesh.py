"""Meshes of ball and socket: spherical blocks of quadrilaterals in the half plane through the axis.

The polar angle φ is measured from the pole of the contact. A point lies at the distance ρ = r sin φ from the load axis
and at the height z = r cos φ below the centre. Lengths are in units of the contact's radius.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy

from ...core.arrays import Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """Spherical block meshed along its angles and radii.

    Attributes
    ----------
    angle : array (angles,)
        Angles of the nodes in rad, ascending. For order 2 every second one lies between the corners of the elements.
    radius : array (angles, radii)
        Radii of the nodes, ascending. A radius occurs twice where two layers slide on each other.
    strips : array of int
        Index of the first radius of each strip of elements.
    layer : array of int
        Layer of each strip.
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
        """Index of each node, shape (angles, radii)."""
        return numpy.arange(self.radius.size).reshape(self.radius.shape)

    @cached_property
    def nodes(self) -> Numbers:
        """Coordinates (ρ, z) of each node, shape (2, nodes)."""
        phi = self.angle[:, None]
        return numpy.stack([(numpy.sin(phi) * self.radius).ravel(), (numpy.cos(phi) * self.radius).ravel()])

    @cached_property
    def elements(self) -> Numbers:
        """Indices of the nodes of each element, shape (nodes, elements), in scikit-fem's order.

        The order is corners, for order 2 also edges and middle.
        """
        step = self.order
        corners = [(0, 0), (0, step), (step, step), (step, 0)]
        between = [(0, 1), (1, 2), (2, 1), (1, 0), (1, 1)] if step == 2 else []
        rows = len(self.angle) - step
        columns = [self.number[i : i + rows : step][:, self.strips + j] for i, j in [*corners, *between]]
        return numpy.stack([column.ravel() for column in columns])

    @cached_property
    def layers(self) -> Numbers:
        """Index of the layer of each element."""
        return numpy.tile(self.layer, (len(self.angle) - 1) // self.order)

    @cached_property
    def sliding(self) -> Numbers:
        """Indices of the radii at which layers slide on each other: the inner one of each two equal radii."""
        return numpy.flatnonzero(numpy.diff(self.level) == 0)

    @cached_property
    def level(self) -> Numbers:
        """Index of each distinct radius (radii,); two equal radii of a sliding interface have the same one."""
        inside = numpy.zeros(self.radius.shape[1], dtype=bool)
        for step in range(1, self.order + 1):
            inside[self.strips + step] = True
        return numpy.cumsum(inside)


def mesh_block(angle: Numbers, layers: list[Numbers], order: int, sliding_layers: tuple[int, ...] = ()) -> Block:
    """Mesh a spherical block from the corners of its elements.

    Parameters
    ----------
    angle : array (corners,)
        Angles of the corners in rad.
    layers : list of arrays
        Radii of each layer's corners (corners,), from the inside out; each layer begins at the end of the previous one.
        Radii may vary along the angle (corner angles, corners).
    order : int
    sliding_layers : tuple of int
        Layers that slide on the next inner one.
    """
    angle = add_midpoints(angle, order)
    columns: list[Numbers] = []
    strips: list[int] = []
    owner: list[int] = []
    count = 0
    for index, layer in enumerate(layers):
        rows = numpy.broadcast_to(layer, ((len(angle) - 1) // order + 1, layer.shape[-1]))
        radius = add_midpoints(add_midpoints(rows.T, order).T, order)
        shared = 0 if index == 0 or index in sliding_layers else 1
        strips += range(count - shared, count - shared + radius.shape[1] - order, order)
        owner += [index] * ((radius.shape[1] - 1) // order)
        columns.append(radius[:, shared:])
        count += radius.shape[1] - shared
    radii = numpy.concatenate(columns, axis=1)
    return Block(angle=angle, radius=radii, strips=numpy.array(strips), layer=numpy.array(owner), order=order)


def add_midpoints(corners: Numbers, order: int) -> Numbers:
    """Add the midpoints between adjacent corners along the first axis, for elements of order 2 only."""
    return corners if order == 1 else bisect_intervals(corners)


def bisect_intervals(corners: Numbers) -> Numbers:
    """Insert the midpoint between each two adjacent corners."""
    between = (corners[1:] + corners[:-1]) / 2
    return numpy.insert(corners, numpy.arange(1, len(corners)), between, axis=0)


def graded_points(start: float, end: float, first: float, growth: float, longest: float) -> Numbers:
    """Divide the line from start to end into intervals that grow from about `first` up to `longest`.

    `growth` is the ratio of successive intervals.
    """
    reach = abs(end - start)
    steps = [min(first, reach)]
    total = steps[0]
    while total < reach * (1 - 1e-9):
        steps.append(min(steps[-1] * growth, longest))
        total += steps[-1]
    points = start + numpy.sign(end - start) * numpy.append(0.0, numpy.cumsum(steps)) * (reach / total)
    points[-1] = end
    return points


def join_points(rows: list[Numbers]) -> Numbers:
    """Join rows of points, each of which begins at the last point of the previous row."""
    for before, after in pairwise(rows):
        assert before[-1] == after[0]
    return numpy.concatenate([rows[0], *(row[1:] for row in rows[1:])])
