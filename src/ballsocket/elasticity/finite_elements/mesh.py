"""Meshes of ball and socket: their shapes, and spherical blocks of quadrilaterals in the half plane through the axis.

The polar angle φ is measured from the pole of the contact. A point lies at the distance ρ = r sin φ from the load axis
and at the height z = r cos φ below the centre. Lengths are in units of the contact's radius, and moduli in units of
the liner's Young's modulus.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import inf, pi

import numpy

from ...core.arrays import Numbers
from ...problem import Joint, Support
from ...problem.cup import Cup, Interface


@dataclass(frozen=True, kw_only=True, eq=False)
class Block:
    """Spherical block meshed along its angles and radii."""

    # (angles,), angles of the nodes in rad, ascending. For order 2 every second one lies between the corners of
    # the elements.
    angle: Numbers
    # (angles, radii), radii of the nodes, ascending. A radius occurs twice where two layers slide on each other.
    radius: Numbers
    strips: Numbers  # index of the first radius of each strip of elements
    layer: Numbers  # layer of each strip
    order: int  # 1 is bilinear, 2 biquadratic

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

    `angle` (corners,) is in rad. Each layer has the radii of its corners (corners,) or (corner angles, corners), from
    the inside out, and begins at the end of the previous one. `sliding_layers` slide on the next inner one.
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


_CORE_RADIUS = 0.02  # over the ball's radius: hole around its centre
_MAX_RADIUS = 1e4  # over the bore's radius: outer radius of a massive socket


@dataclass(frozen=True, kw_only=True)
class Resolution:
    """Element sizes of both bodies."""

    size: float  # size of the elements along the contact and across it, in rad
    reach: float  # angle in rad up to which elements have this size
    growth: float  # ratio of the lengths of successive elements away from the contact
    widest: float  # longest element along the surface in rad
    deepest: float  # longest element across a layer, as a fraction of its thickness
    order: int  # 1 is bilinear, 2 biquadratic
    halvings: int = 0  # number of times that every element is divided in four

    def halved(self) -> Resolution:
        """Return elements of half the length."""
        return replace(self, halvings=self.halvings + 1)

    def doubled(self) -> Resolution:
        """Return elements of twice the length."""
        return replace(
            self, size=2 * self.size, growth=self.growth**2, widest=2 * self.widest, deepest=min(2 * self.deepest, 0.5)
        )

    def refine(self, corners: Numbers) -> Numbers:
        """Halve the intervals between corners as many times as `halvings`."""
        for _ in range(self.halvings):
            corners = bisect_intervals(corners)
        return corners

    def angles(self, end: float) -> Numbers:
        """Compute the angles of element corners in rad, from the pole to the end."""
        fine = min(self.reach, end)
        fine_angles = numpy.linspace(0.0, fine, max(round(fine / self.size), 1) + 1)
        if end - fine < self.size / 2:
            return numpy.linspace(0.0, end, len(fine_angles))
        return join_points([fine_angles, graded_points(fine, end, self.size * self.growth, self.growth, self.widest)])


@dataclass(frozen=True, kw_only=True)
class SocketShape:
    """Socket of inner radius 1 with a liner of Young's modulus 1."""

    layers: tuple[tuple[float, float, float], ...]  # layers from the liner outwards
    # polar angle of the rim in rad; of its inner edge
    rim: float
    chamfer: float
    # interface of the liner to the next layer, and support of the outermost surface
    interface: Interface
    support: Support

    @property
    def reach(self) -> float:
        """Polar angle in rad at which the bore ends."""
        return self.rim - self.chamfer

    @property
    def slides(self) -> bool:
        """True if the liner slides on its backing."""
        return self.interface is Interface.SLIDING

    def corners(self, resolution: Resolution) -> tuple[Numbers, list[Numbers]]:
        """Compute the corners of the elements: angles in rad, and relative radii of each layer."""
        angle = resolution.refine(self.extend_to_rim(resolution.angles(self.reach), resolution.size))
        return angle, self.radii(angle, resolution)

    def extend_to_rim(self, angle: Numbers, size: float) -> Numbers:
        """Extend the angles of corners along the bore by those across the chamfer."""
        if not self.chamfer:
            return angle
        return join_points([angle, graded_points(self.reach, self.rim, min(size, self.chamfer / 2), 1.0, inf)])

    def radii(self, angle: Numbers, resolution: Resolution) -> list[Numbers]:
        """Compute the relative radii of the corners in each layer, finer towards the bore."""
        first, inner, radii = resolution.size, 1.0, []
        for outer, _, _ in self.layers:
            thickness = min(outer, _MAX_RADIUS) - inner
            longest = inf if outer == inf else thickness * resolution.deepest
            layer = graded_points(inner, inner + thickness, min(first, longest), resolution.growth, longest)
            radii.append(resolution.refine(layer))
            first, inner = (layer[-1] - layer[-2]) * resolution.growth, float(layer[-1])
        if self.chamfer:
            liner, depth = radii[0], numpy.clip(angle - self.reach, 0.0, None)[:, None]
            radii[0] = liner + depth * (liner[-1] - liner) / (liner[-1] - liner[0])
        return radii


def socket_shape(joint: Joint, cup: Cup) -> SocketShape:
    """Make the shape of the socket of a joint of plain numbers."""
    R2, outer, layers = float(joint.socket_radius), 1.0, []
    backing = ((layer.thickness, layer.material) for layer in joint.backing)
    for thickness, material in ((joint.liner_thickness, joint.liner), *backing):
        outer += float(thickness) / R2
        layers.append((outer, float(material.young) / float(joint.liner.young), float(material.poisson)))
    return SocketShape(
        layers=tuple(layers), rim=cup.rim, chamfer=cup.chamfer / R2, interface=cup.interface, support=joint.support
    )


def ball_corners(resolution: Resolution) -> tuple[Numbers, Numbers]:
    """Compute the corners of the ball's elements: angles in rad, and relative radii from the inside out."""
    radii = graded_points(1.0, _CORE_RADIUS, resolution.size, resolution.growth, resolution.deepest / 2)[::-1]
    return resolution.refine(resolution.angles(pi / 2)), resolution.refine(radii)
