"""Shapes of ball and socket in units of the contact's radius and of the liner's Young's modulus."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

import numpy

from ...core.arrays import Numbers
from ...problem import Joint, Support
from ...problem.cup import Cup, Interface
from .mesh import bisect_intervals, graded_points, join_points

_CORE_RADIUS = 0.02  # over the ball's radius: hole around its centre
_MAX_RADIUS = 1e4  # over the bore's radius: outer radius of a massive socket


@dataclass(frozen=True, kw_only=True)
class Resolution:
    """Element sizes of both bodies.

    Attributes
    ----------
    size : float
        Size of the elements along the contact and across it, in rad.
    reach : float
        Angle in rad up to which elements have this size.
    growth : float
        Ratio of the lengths of successive elements away from the contact.
    widest : float
        Longest element along the surface in rad.
    deepest : float
        Longest element across a layer, as a fraction of its thickness.
    order : int
        1 is bilinear, 2 biquadratic.
    halvings : int
        Number of times that every element is divided in four.
    """

    size: float
    reach: float
    growth: float
    widest: float
    deepest: float
    order: int
    halvings: int = 0

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
    """Socket of inner radius 1 with a liner of Young's modulus 1.

    Attributes
    ----------
    layers : tuple of (outer radius, Young's modulus, Poisson's ratio)
        Layers from the liner outwards.
    rim, chamfer : float
        Polar angle of the rim in rad; of its inner edge.
    interface, support
        Interface of the liner to the next layer, and support of the outermost surface.
    """

    layers: tuple[tuple[float, float, float], ...]
    rim: float
    chamfer: float
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
        return [self._chamfer_liner(angle, radii[0]), *radii[1:]]

    def _chamfer_liner(self, angle: Numbers, liner: Numbers) -> Numbers:
        """Compute the liner's radii with the chamfer cut off: (angles, radii)."""
        if not self.chamfer:
            return liner
        depth = numpy.clip(angle - self.reach, 0.0, None)[:, None]
        return liner + depth * (liner[-1] - liner) / (liner[-1] - liner[0])


def socket_shape(joint: Joint, cup: Cup) -> SocketShape:
    """Make the shape of the socket of a joint of plain numbers."""
    R2, outer, layers = float(joint.socket_radius), 1.0, []
    thickness_and_material = [
        (joint.liner_thickness, joint.liner),
        *((layer.thickness, layer.material) for layer in joint.backing),
    ]
    for thickness, material in thickness_and_material:
        outer += float(thickness) / R2
        layers.append((outer, float(material.young) / float(joint.liner.young), float(material.poisson)))
    return SocketShape(
        layers=tuple(layers),
        rim=cup.rim,
        chamfer=cup.chamfer / R2,
        interface=cup.interface,
        support=joint.support,
    )


def ball_corners(resolution: Resolution) -> tuple[Numbers, Numbers]:
    """Compute the corners of the ball's elements: angles in rad, and relative radii from the inside out."""
    radii = graded_points(1.0, _CORE_RADIUS, resolution.size, resolution.growth, resolution.deepest / 2)[::-1]
    return resolution.refine(resolution.angles(pi / 2)), resolution.refine(radii)
