"""Section of a joint, drawn to scale, with its pressure or its stresses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import isinf, pi

import numpy

from ...contact import Contact
from ...files.joint_file import JointFile
from ...reports.section_plots import gap_factor, radii_of
from ..pressing import profile
from . import svg

_PETALS = 48
_HIGHEST = 0.45  # of the liner, or of the radius
_SIZE = 340.0

Outline = tuple[numpy.ndarray, numpy.ndarray]


@dataclass(frozen=True, kw_only=True)
class DrawingFrame:
    """Centre of the socket in a picture, and pixels per mm; angles run from the cup's pole to the right."""

    x: float
    y: float
    scale: float

    def at(self, radius: float, angle: float) -> tuple[float, float]:
        """Return picture coordinates of a radius in mm and an angle in rad."""
        return self.x + self.scale * radius * float(numpy.sin(angle)), self.y + self.scale * radius * float(
            numpy.cos(angle)
        )

    def path(self, outline: Outline) -> str:
        """Return the path of an outline in mm, upwards from the socket's centre."""
        return svg.closed(self.x + self.scale * outline[0], self.y - self.scale * outline[1])


def section(file: JointFile, contact: Contact | None, extent: float, highest: float) -> str:
    """Draw a joint under a load from above to `extent` (mm), with pressure colours up to `highest` (MPa)."""
    frame = DrawingFrame(x=_SIZE / 2, y=_SIZE / 2, scale=_SIZE / 2 / extent / 1.04)
    parts = [*layers(file, frame), ball(file, contact, frame, 0.0), *painted(file, contact, frame, highest, 0.0)]
    return svg.picture((_SIZE, _SIZE), "the joint in section, to scale", parts)


def layers(file: JointFile, frame: DrawingFrame) -> list[str]:
    """Draw liner and backing layers inside the cup's arc."""
    ends = list(pairwise(radii_of(file.joint)))
    kinds = ["liner", *(f"backing layer{number % 3}" for number in range(len(ends) - 1))]
    return [_part(_sector(*radii, file.cup.rim), frame, kind) for radii, kind in zip(ends, kinds, strict=True)]


def ball(file: JointFile, contact: Contact | None, frame: DrawingFrame, tilt: float) -> str:
    """Draw the loaded ball; its clearance is enlarged by `gap_factor`."""
    return _part(_ball(file, contact, tilt), frame, "ball")


def painted(file: JointFile, contact: Contact | None, frame: DrawingFrame, highest: float, tilt: float) -> list[str]:
    """Draw the pressure inside the cup's arc."""
    if contact is None:
        return []
    top = highest or 1.0
    return [
        f'<path fill="{svg.heat(pressure / top)}" d="{frame.path(outline)}"/>'
        for outline, pressure in petals(file, contact, tilt)
    ]


def _part(outline: Outline, frame: DrawingFrame, kind: str) -> str:
    return f'<path class="part {kind}" d="{frame.path(outline)}"/>'


def extent_of(file: JointFile) -> float:
    """Half the width of the drawing in mm."""
    return radii_of(file.joint)[-1]


def _sector(inner: float, outer: float, rim: float) -> Outline:
    angle = numpy.linspace(-rim, rim, 121)
    x = numpy.concatenate([inner * numpy.sin(angle), outer * numpy.sin(angle[::-1])])
    y = numpy.concatenate([-inner * numpy.cos(angle), -outer * numpy.cos(angle[::-1])])
    return x, y


def _ball(file: JointFile, contact: Contact | None, tilt: float) -> Outline:
    """Compute the socket's circle less the gap c - (c + d) cos φ from the load's axis; no gap in the contact."""
    clearance, depth = float(file.joint.clearance), 0.0 if contact is None else float(contact.indentation)
    angle = numpy.linspace(0.0, 2 * pi, 145)
    gap = numpy.clip(clearance - (clearance + depth) * numpy.cos(angle + tilt), 0.0, None)
    radius = float(file.joint.socket_radius) - gap_factor(file.joint) * gap
    return radius * numpy.sin(angle), -radius * numpy.cos(angle)


def petals(file: JointFile, contact: Contact, tilt: float = 0.0) -> list[tuple[Outline, float]]:
    """Return quadrilaterals (mm) in the liner whose height shows the pressure, each with its pressure (MPa)."""
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


_STRESS_COLUMNS, _STRESS_ROWS = 40, 10
_MASSIVE_DEPTH = 1.5  # contact radii that are drawn of what has no end
_STRESS_WIDTH = 1.25  # half angles to each side


@dataclass(frozen=True, eq=False)
class LinerStresses:
    """Stresses in MPa at angles (rad, from the load's axis) and depths (mm): a row a depth."""

    angles: numpy.ndarray
    depths: numpy.ndarray
    values: numpy.ndarray

    @property
    def largest(self) -> float:
        """Largest stress in MPa."""
        return float(self.values.max())


@lru_cache(maxsize=32)
def liner_stresses(contact: Contact) -> LinerStresses | None:
    """Compute the stresses of a contact; None if its model has none inside the liner."""
    if not hasattr(contact, "stress") or not float(contact.half_angle) > 0:
        return None
    half, joint = float(contact.half_angle), contact.joint
    deep = float(joint.liner_thickness)
    if isinf(deep):
        deep = _MASSIVE_DEPTH * half * float(joint.socket_radius)
    angles = _STRESS_WIDTH * half * (numpy.arange(_STRESS_COLUMNS) + 0.5) / _STRESS_COLUMNS
    depths = deep * (numpy.arange(_STRESS_ROWS) + 0.5) / _STRESS_ROWS
    values = numpy.asarray(contact.stress(angles[None, :], depths[:, None]).von_mises)
    return LinerStresses(angles, depths, values)


def painted_stresses(file: JointFile, stresses: LinerStresses, frame: DrawingFrame, tilt: float) -> str:
    """Draw each cell of the liner in the colour of its stress, inside the cup's arc."""
    wide, deep = stresses.angles[1] - stresses.angles[0], stresses.depths[1] - stresses.depths[0]
    bore, rim, top = float(file.joint.socket_radius), file.cup.rim, stresses.largest
    pieces = []
    for row, depth in enumerate(stresses.depths):
        inner, outer = bore + depth - 0.52 * deep, bore + depth + 0.52 * deep
        for side in (1, -1):
            for column, angle in enumerate(stresses.angles):
                ends = [side * (angle - 0.52 * wide) - tilt, side * (angle + 0.52 * wide) - tilt]
                low, high = max(min(ends), -rim), min(max(ends), rim)
                if low < high:
                    corners = [frame.at(r, a) for r, a in ((inner, low), (inner, high), (outer, high), (outer, low))]
                    x, y = map(numpy.array, zip(*corners, strict=True))
                    pieces.append(
                        f'<path fill="{svg.heat(stresses.values[row, column] / top)}" d="{svg.closed(x, y)}"/>'
                    )
    return "".join(pieces)
