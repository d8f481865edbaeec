"""Ball and socket as the mesh sees them, in units of the contact's radius and of the liner's Young's modulus."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

import numpy

from ...core.arrays import Numbers
from ...problem import Joint, Support
from ...problem.cup import Cup, Interface
from .mesh import bisect_intervals, graded_points, join_points

_CORE = 0.02  # of the ball, left out around its centre
_FAR = 1e4  # of the bore's radius: where a massive socket is held


@dataclass(frozen=True, kw_only=True)
class Resolution:
    """How finely both bodies are meshed.

    Attributes
    ----------
    size : float
        Of the elements along the contact and across it, in rad.
    reach : float
        Up to which angle they are that small.
    growth : float
        How much longer each element is than the one before, away from the contact.
    widest : float
        Longest element along the surface in rad.
    deepest : float
        Longest element across a layer, as a share of its thickness.
    order : int
        1 is bilinear, 2 biquadratic.
    halvings : int
        How often every element is then cut in four.
    """

    size: float
    reach: float
    growth: float
    widest: float
    deepest: float
    order: int
    halvings: int = 0

    def cut(self, corners: Numbers) -> Numbers:
        """The corners with all halvings."""
        for _ in range(self.halvings):
            corners = bisect_intervals(corners)
        return corners

    def angles(self, end: float) -> Numbers:
        """Corners along the angle, from the pole to the end."""
        fine = min(self.reach, end)
        near = numpy.linspace(0.0, fine, max(round(fine / self.size), 1) + 1)
        if end - fine < self.size / 2:
            return numpy.linspace(0.0, end, len(near))
        return join_points([near, graded_points(fine, end, self.size * self.growth, self.growth, self.widest)])


@dataclass(frozen=True, kw_only=True)
class SocketShape:
    """A socket of inner radius 1 and a liner of Young's modulus 1.

    Attributes
    ----------
    layers : tuple of (outer radius, Young's modulus, Poisson's ratio)
        From the liner outwards.
    rim, chamfer : float
        Polar angle of the rim in rad; of its inner edge.
    interface, support
        What holds the liner on the next layer, and the outermost surface.
    """

    layers: tuple[tuple[float, float, float], ...]
    rim: float
    chamfer: float
    interface: Interface
    support: Support

    @property
    def reach(self) -> float:
        """The angle at which the bore ends."""
        return self.rim - self.chamfer

    @property
    def slides(self) -> bool:
        """Whether the liner slides on what is behind it."""
        return self.interface is Interface.SLIDING

    def corners(self, resolution: Resolution) -> tuple[Numbers, list[Numbers]]:
        """Corners of the elements: their angles, and the radii of each layer."""
        angle = resolution.cut(self.to_rim(resolution.angles(self.reach), resolution.size))
        return angle, self.radii(angle, resolution)

    def to_rim(self, angle: Numbers, size: float) -> Numbers:
        """Corners along the bore, and on across the chamfer."""
        if not self.chamfer:
            return angle
        return join_points([angle, graded_points(self.reach, self.rim, min(size, self.chamfer / 2), 1.0, inf)])

    def radii(self, angle: Numbers, resolution: Resolution) -> list[Numbers]:
        """Radii of the corners in each layer, finer towards the bore."""
        first, inner, radii = resolution.size, 1.0, []
        for outer, _, _ in self.layers:
            thickness = min(outer, _FAR) - inner
            longest = inf if outer == inf else thickness * resolution.deepest
            layer = graded_points(inner, inner + thickness, min(first, longest), resolution.growth, longest)
            radii.append(resolution.cut(layer))
            first, inner = (layer[-1] - layer[-2]) * resolution.growth, float(layer[-1])
        return [self._chamfered(angle, radii[0]), *radii[1:]]

    def _chamfered(self, angle: Numbers, liner: Numbers) -> Numbers:
        """The liner's radii, which follow the chamfer."""
        if not self.chamfer:
            return liner
        cut = numpy.clip(angle - self.reach, 0.0, None)[:, None]
        return liner + cut * (liner[-1] - liner) / (liner[-1] - liner[0])


def socket_shape(joint: Joint, cup: Cup) -> SocketShape:
    """The shape of a joint's socket, all numbers of the joint being plain."""
    R2, outer, layers = float(joint.socket_radius), 1.0, []
    every = [(joint.liner_thickness, joint.liner), *((layer.thickness, layer.material) for layer in joint.backing)]
    for thickness, material in every:
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
    """Corners of the ball's elements: angles, and radii from the inside out."""
    radii = graded_points(1.0, _CORE, resolution.size, resolution.growth, resolution.deepest / 2)[::-1]
    return resolution.cut(resolution.angles(pi / 2)), resolution.cut(radii)
