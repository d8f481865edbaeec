"""Section of a joint, drawn to scale, with its pressure or its stresses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import cos, isinf, pi, sin

import numpy

from ...contact import Contact
from ...elasticity.off_axis.contact import OffAxisContact
from ...files.joint_file import JointFile
from ...reports.section_plots import gap_factor, radii_of
from ..pressing import profile
from . import svg

_PETALS = 48
_HIGHEST = 0.45  # of the liner, or of the radius
_SIZE = 340.0

Numbers = numpy.ndarray
Cells = tuple[Numbers, Numbers, Numbers]
"""Radii (mm) and angles (rad) of the corners of quadrilaterals, (cells, 4), and their pressures or stresses in MPa."""

_QUAD = "M{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}Z".format
_STRESS_COLUMNS, _STRESS_ROWS = 40, 10
_MASSIVE_DEPTH = 1.5  # contact radii that are drawn of what has no end
_STRESS_WIDTH = 1.25  # half angles to each side


@dataclass(frozen=True, kw_only=True)
class DrawingFrame:
    """Centre of the socket in a picture, and pixels per mm; angles run from the cup's pole to the right."""

    x: float
    y: float
    scale: float

    def at(self, radius: float, angle: float) -> tuple[float, float]:
        """Return picture coordinates of a radius in mm and an angle in rad."""
        return self.x + self.scale * radius * sin(angle), self.y + self.scale * radius * cos(angle)

    def arc(self, radius: float, half: float) -> str:
        """Return the part of a path along a circle (mm), from -half to half about the pole (rad)."""
        (x1, y1), (x2, y2), away = self.at(radius, -half), self.at(radius, half), self.scale * radius
        return f"{x1:.1f},{y1:.1f}A{away:.1f},{away:.1f} 0 {int(abs(half) > pi / 2)} {int(half < 0)} {x2:.1f},{y2:.1f}"

    def cells(self, cells: Cells, top: float) -> list[str]:
        """Draw quadrilaterals in the colours of their values from 0 to `top`."""
        radii, angles, values = cells
        corners = self.x + self.scale * radii * numpy.sin(angles), self.y + self.scale * radii * numpy.cos(angles)
        rows = numpy.stack(corners, axis=-1).reshape(-1, 8).tolist()
        shares = (values / top).tolist()
        return [f'<path fill="{svg.heat(share)}" d="{_QUAD(*row)}"/>' for share, row in zip(shares, rows, strict=True)]


def section(file: JointFile, contact: Contact | None, extent: float, highest: float) -> str:
    """Draw a joint under a load from above to `extent` (mm), with pressure colours up to `highest` (MPa)."""
    frame = DrawingFrame(x=_SIZE / 2, y=_SIZE / 2, scale=_SIZE / 2 / extent / 1.04)
    parts = [*layers(file, frame), ball(file, contact, frame, 0.0), *painted(file, contact, frame, highest)]
    return svg.picture((_SIZE, _SIZE), "the joint in section, to scale", parts)


def layers(file: JointFile, frame: DrawingFrame) -> list[str]:
    """Draw liner and backing layers inside the cup's arc."""
    ends = list(pairwise(radii_of(file.joint)))
    kinds = ["liner", *(f"backing layer{number % 3}" for number in range(len(ends) - 1))]
    paths = [f"M{frame.arc(inner, file.cup.rim)}L{frame.arc(outer, -file.cup.rim)}Z" for inner, outer in ends]
    return [f'<path class="part {kind}" d="{path}"/>' for kind, path in zip(kinds, paths, strict=True)]


def ball(file: JointFile, contact: Contact | None, frame: DrawingFrame, tilt: float) -> str:
    """Draw the loaded ball: the bore less the gap c - (c + d) cos φ from the load's axis, enlarged by `gap_factor`.

    There is no gap in the contact.
    """
    clearance, depth = float(file.joint.clearance), 0.0 if contact is None else float(contact.indentation)
    angle = numpy.linspace(0.0, 2 * pi, 97)
    gap = numpy.clip(clearance - (clearance + depth) * numpy.cos(angle + tilt), 0.0, None)
    radius = frame.scale * (float(file.joint.socket_radius) - gap_factor(file.joint) * gap)
    outline = svg.closed(frame.x + radius * numpy.sin(angle), frame.y + radius * numpy.cos(angle))
    return f'<path class="part ball" d="{outline}"/>'


def painted(file: JointFile, contact: Contact | None, frame: DrawingFrame, highest: float) -> list[str]:
    """Draw the pressure inside the cup's arc."""
    return [] if contact is None else frame.cells(petals(file, contact), highest or 1.0)


def extent_of(file: JointFile) -> float:
    """Return half the width of the drawing in mm."""
    return radii_of(file.joint)[-1]


def petals(file: JointFile, contact: Contact) -> Cells:
    """Return quadrilaterals in the liner whose height shows the pressure."""
    if not float(contact.half_angle) > 0:
        return numpy.empty((0, 4)), numpy.empty((0, 4)), numpy.empty(0)
    if isinstance(contact, OffAxisContact):
        angle, pressure = _pressure_in_plane(contact)
    else:
        half, rim = float(contact.half_angle), file.cup.rim
        angle = half * numpy.sin(numpy.linspace(-pi / 2, pi / 2, _PETALS + 1))
        angle = numpy.clip(angle, max(-half, -rim), min(half, rim))
        pressure = numpy.interp(numpy.abs(angle), *profile(contact), right=0.0)
    radius = float(file.joint.socket_radius)
    highest = _HIGHEST * min(float(file.joint.liner_thickness), 0.6 * radius)
    reach = radius + highest * pressure / float(contact.max_pressure)
    bore, a, b = numpy.full_like(angle[1:], radius), angle[:-1], angle[1:]
    radii, angles = numpy.stack([bore, bore, reach[1:], reach[:-1]], axis=-1), numpy.stack([a, b, b, a], axis=-1)
    wide = b > a
    return radii[wide], angles[wide], (pressure[:-1] + pressure[1:])[wide] / 2


def _pressure_in_plane(contact: OffAxisContact) -> tuple[Numbers, Numbers]:
    """Sample angles (rad) and the pressure in the plane of load and cup axis; the load lies at a negative angle."""
    load, reach = contact.single_state.axes[0], float(contact.model.reach_of(contact.joint))
    angle = numpy.linspace(-reach, reach, 2 * _PETALS + 1)
    across = load[:2] / (numpy.linalg.norm(load[:2]) or 1.0)
    directions = numpy.stack([*(-numpy.sin(angle) * part for part in across), numpy.cos(angle)], axis=-1)
    pressure = numpy.asarray(contact.pressure_at(directions))
    in_contact = numpy.flatnonzero(pressure > 0)
    shown = slice(max(in_contact[0] - 1, 0), in_contact[-1] + 2) if in_contact.size else slice(0, 0)
    return angle[shown], pressure[shown]


@dataclass(frozen=True, eq=False)
class LinerStresses:
    """Stresses in MPa at angles (rad, from the load's axis) and depths (mm): a row a depth."""

    angles: Numbers
    depths: Numbers
    values: Numbers

    @property
    def largest(self) -> float:
        return float(self.values.max())


@lru_cache(maxsize=32)
def liner_stresses(contact: Contact) -> LinerStresses | None:
    """Compute the stresses of a contact; None if its model has none inside the liner, or it is too narrow for them."""
    if not hasattr(contact, "stress") or not float(contact.half_angle) > 0:
        return None
    half, joint = float(contact.half_angle), contact.joint
    deep = float(joint.liner_thickness)
    if isinf(deep):
        deep = _MASSIVE_DEPTH * half * float(joint.socket_radius)
    angles = _STRESS_WIDTH * half * (numpy.arange(_STRESS_COLUMNS) + 0.5) / _STRESS_COLUMNS
    depths = deep * (numpy.arange(_STRESS_ROWS) + 0.5) / _STRESS_ROWS
    try:
        values = numpy.asarray(contact.stress(angles[None, :], depths[:, None]).von_mises)
    except ValueError:
        return None
    return LinerStresses(angles, depths, values)


def painted_stresses(file: JointFile, stresses: LinerStresses, frame: DrawingFrame) -> str:
    """Draw each cell of the liner in the colour of its stress, inside the cup's arc."""
    wide, deep = stresses.angles[1] - stresses.angles[0], stresses.depths[1] - stresses.depths[0]
    rim, depth = file.cup.rim, float(file.joint.socket_radius) + numpy.repeat(stresses.depths, len(stresses.angles))
    middle = numpy.tile(stresses.angles, len(stresses.depths))
    inner, outer = depth - 0.52 * deep, depth + 0.52 * deep
    pieces = []
    for side in (1, -1):
        low, high = (numpy.clip(side * middle + end * wide, -rim, rim) for end in (-0.52, 0.52))
        radii, angles = (
            numpy.stack(corners, axis=-1) for corners in ((inner, inner, outer, outer), (low, high, high, low))
        )
        inside = low < high
        pieces += frame.cells((radii[inside], angles[inside], stresses.values.ravel()[inside]), stresses.largest)
    return "".join(pieces)
