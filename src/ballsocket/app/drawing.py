"""A joint in section, to scale: ball, liner, what is behind it, and the pressure on its socket."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi

import numpy

from ..contact import Contact
from ..files.joint_file import JointFile
from ..reports.section_plots import gap_factor, radii_of
from . import svg
from .pressing import profile

_PETALS = 48
_HIGHEST = 0.45  # of the liner, or of the radius
_SIZE = 340.0

Outline = tuple[numpy.ndarray, numpy.ndarray]


@dataclass(frozen=True, kw_only=True)
class DrawingFrame:
    """Where the socket's centre lies in a picture, and pixels for a mm; angles go from the cup's pole to the right."""

    x: float
    y: float
    scale: float

    def at(self, radius: float, angle: float) -> tuple[float, float]:
        """A place in the picture: a radius in mm and an angle in rad."""
        return self.x + self.scale * radius * float(numpy.sin(angle)), self.y + self.scale * radius * float(
            numpy.cos(angle)
        )

    def path(self, outline: Outline) -> str:
        """An outline in mm, upwards from the socket's centre."""
        return svg.closed(self.x + self.scale * outline[0], self.y - self.scale * outline[1])


def section(file: JointFile, contact: Contact | None, extent: float, highest: float) -> str:
    """A joint as SVG, the load from above, drawn to `extent` (mm), the pressure's colours to `highest` (MPa)."""
    frame = DrawingFrame(x=_SIZE / 2, y=_SIZE / 2, scale=_SIZE / 2 / extent / 1.04)
    parts = [*layers(file, frame), ball(file, contact, frame, 0.0), *painted(file, contact, frame, highest, 0.0)]
    return svg.picture((_SIZE, _SIZE), "the joint in section, to scale", parts)


def layers(file: JointFile, frame: DrawingFrame) -> list[str]:
    """Liner and what is behind it, as far as the cup reaches."""
    ends = list(pairwise(radii_of(file.joint)))
    kinds = ["liner", *(f"backing layer{number % 3}" for number in range(len(ends) - 1))]
    return [_part(_sector(*each, file.cup.rim), frame, kind) for each, kind in zip(ends, kinds, strict=True)]


def ball(file: JointFile, contact: Contact | None, frame: DrawingFrame, tilt: float) -> str:
    """The ball where the load has brought it; its clearance is drawn as many times as `gap_factor` says."""
    return _part(_ball(file, contact, tilt), frame, "ball")


def painted(file: JointFile, contact: Contact | None, frame: DrawingFrame, highest: float, tilt: float) -> list[str]:
    """The pressure, inside the cup's arc."""
    if contact is None:
        return []
    top = highest or 1.0
    return [
        f'<path fill="{heat(pressure / top)}" d="{frame.path(outline)}"/>'
        for outline, pressure in petals(file, contact, tilt)
    ]


def _part(outline: Outline, frame: DrawingFrame, kind: str) -> str:
    return f'<path class="part {kind}" d="{frame.path(outline)}"/>'


_HEAT = numpy.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]])
"""Five colours of viridis, from low to high."""


def heat(share: float) -> str:
    """A colour for a share from 0 to 1."""
    stops = numpy.linspace(0.0, 1.0, len(_HEAT))
    red, green, blue = (round(float(numpy.interp(share, stops, column))) for column in _HEAT.T)
    return f"#{red:02x}{green:02x}{blue:02x}"


def extent_of(file: JointFile) -> float:
    """Half the width of the drawing in mm."""
    return radii_of(file.joint)[-1]


def _sector(inner: float, outer: float, rim: float) -> Outline:
    angle = numpy.linspace(-rim, rim, 121)
    x = numpy.concatenate([inner * numpy.sin(angle), outer * numpy.sin(angle[::-1])])
    y = numpy.concatenate([-inner * numpy.cos(angle), -outer * numpy.cos(angle[::-1])])
    return x, y


def _ball(file: JointFile, contact: Contact | None, tilt: float) -> Outline:
    """The socket's circle less the gap, c - (c + d) cos φ from the load's axis, which is nothing in the contact."""
    clearance, depth = float(file.joint.clearance), 0.0 if contact is None else float(contact.indentation)
    angle = numpy.linspace(0.0, 2 * pi, 145)
    gap = numpy.clip(clearance - (clearance + depth) * numpy.cos(angle + tilt), 0.0, None)
    radius = float(file.joint.socket_radius) - gap_factor(file.joint) * gap
    return radius * numpy.sin(angle), -radius * numpy.cos(angle)


def petals(file: JointFile, contact: Contact, tilt: float = 0.0) -> list[tuple[Outline, float]]:
    """Quadrilaterals in the liner up to its rim, in mm, as high as the pressure, each with its pressure in MPa."""
    half = float(contact.half_angle)
    if not half > 0:
        return []
    low, high = max(-half - tilt, -file.cup.rim), min(half - tilt, file.cup.rim)
    angle = numpy.sort(numpy.clip(half * numpy.sin(numpy.linspace(-pi / 2, pi / 2, _PETALS + 1)) - tilt, low, high))
    pressure = numpy.interp(numpy.abs(angle + tilt), *profile(contact), right=0.0)
    radius = float(file.joint.socket_radius)
    highest = _HIGHEST * min(float(file.joint.liner_thickness), 0.6 * radius)
    reach = radius + highest * pressure / float(contact.max_pressure)
    return [
        (_quadrilateral((radius, radius, reach[b], reach[a]), (angle[a], angle[b], angle[b], angle[a])), mean)
        for a, b, mean in _pieces(angle, pressure)
    ]


def _pieces(angle: numpy.ndarray, pressure: numpy.ndarray) -> Iterator[tuple[int, int, float]]:
    for a, b in pairwise(range(len(angle))):
        if angle[b] > angle[a]:
            yield a, b, float(pressure[a] + pressure[b]) / 2


def _quadrilateral(radii: Sequence[float], angles: Sequence[float]) -> Outline:
    away, turned = numpy.array(radii), numpy.array(angles)
    return away * numpy.sin(turned), -away * numpy.cos(turned)
