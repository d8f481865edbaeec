"""Section of a joint, drawn to scale as SVG, with its dimensions, its load and the pressure of a contact."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from itertools import accumulate, pairwise
from math import atan2, cos, isinf, pi, radians, sin

import numpy

from ..contact import Contact
from ..core.unit_systems import Units
from ..elasticity.off_axis.contact import OffAxisContact
from ..files.joint_file import JointFile
from ..problem import Joint, Material
from ..problem.presets import material_label
from . import svg
from .cup_map import shown_maximum

Numbers = numpy.ndarray
Cells = tuple[Numbers, Numbers, Numbers]
"""Radii (mm) and angles (rad) of the corners of quadrilaterals, (cells, 4), and their pressures or stresses in MPa."""

SIZE, LABEL = (624.0, 486.0), "the joint in section, to scale"
_MIDDLE = (300.0, 238.0)
_REACH = 168.0  # pixels from the centre to the outermost layer
_STEEP_TILT = radians(40.0)  # tilt from which the label of the load is to the left of its arrow
_ARROW_GAP, MIN_ARROW, ARROW_GROWTH = 8.0, 26.0, 54.0
"""Pixels of the load's arrow: gap to the ball, length without load, and the most that the load adds."""

_UNBOUNDED_THICKNESS = 0.8  # drawn thickness of an unbounded layer, relative to the socket radius
_FACTORS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
_MAX_GAP = 0.09  # largest drawn gap beside the ball, relative to the socket radius
_PETALS = 48
_HIGHEST = 0.45  # of the liner, or of the radius
_ANGLES = numpy.sin(numpy.linspace(0.0, pi / 2, 24))
_QUAD = "M{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}Z".format

_PAPER_COLOURS = {
    "text": "#1d2328",
    "quiet": "#5a646c",
    "load": "#b04a00",
    "paper": "#ffffff",
    "ball": "#c9ced3",
    "liner": "#e8eef4",
    "backing": "#b3a99c",
}
"""Colours of a drawing in a report, which are those of a light page of the explorer."""


@dataclass(frozen=True, kw_only=True)
class DrawnLoad:
    """Load of a drawing: its text, tilt (rad) from the cup's axis, and share of the longest arrow."""

    text: str
    tilt: float = 0.0
    share: float = 0.5


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


def frame_of(joint: Joint) -> DrawingFrame:
    """Return the frame of a joint in its drawing."""
    return DrawingFrame(x=_MIDDLE[0], y=_MIDDLE[1], scale=_REACH / radii_of(joint)[-1])


def radii_of(joint: Joint) -> list[float]:
    """Return the radii (mm) of the bore, and outwards behind the liner and each layer."""
    bore = float(joint.socket_radius)
    thicknesses = (
        float(thickness) for thickness in (joint.liner_thickness, *(layer.thickness for layer in joint.backing))
    )
    return list(
        accumulate(
            (_UNBOUNDED_THICKNESS * bore if isinf(thickness) else thickness for thickness in thicknesses), initial=bore
        )
    )


def gap_factor(joint: Joint) -> int:
    """Return the magnification of the drawn gap between ball and socket: a round number that makes it visible."""
    gap = abs(float(joint.clearance))
    allowed = [factor for factor in _FACTORS if factor * gap <= _MAX_GAP * float(joint.socket_radius)]
    return allowed[-1] if allowed and gap > 0 else 1


def joint_svg(
    file: JointFile,
    contact: Contact | None = None,
    half_angle: float = 0.0,
    load: DrawnLoad | None = None,
    units: Units = Units.SI,
) -> bytes:
    """Draw a joint in its cup for a report, as an SVG document that needs no other file.

    A dashed line marks `half_angle` (rad) from the cup's axis: the edge of a contact, where it is not 0.
    """
    edges = [] if load is None else edge_lines(file, half_angle, load.tilt)
    style = files(__package__).joinpath("templates", "drawing.css").read_text(encoding="utf-8")
    style = re.sub(r"var\(--(\w+)\)", lambda name: _PAPER_COLOURS[name[1]], style)
    frame, (below, above) = frame_of(file.joint), section_parts(file, contact, load, units)
    pressure = [] if contact is None else frame.cells(petals(file, contact), largest_drawn(contact) or 1.0)
    drawn_ball = ball(file, contact, frame, 0.0 if load is None else load.tilt)
    parts = [f"<style>{style}</style>", *below, drawn_ball, *pressure, *above, *edges]
    drawing = svg.picture(SIZE, LABEL, parts, ' xmlns="http://www.w3.org/2000/svg"')
    return drawing.encode("utf-8")


def section_parts(
    file: JointFile,
    contact: Contact | None,
    load: DrawnLoad | None,
    units: Units = Units.SI,
    load_attributes: str = "",
) -> tuple[list[str], list[str]]:
    """Draw the parts of a joint in its `frame_of` below and above ball and pressure.

    Below are liner and backing, above diameters, magnified clearance, names and the load with its `load_attributes`.
    """
    frame = frame_of(file.joint)
    words = [*_names(file.joint, frame), *_dimensions(file, frame, units)]
    arrow = () if load is None else _load(file, contact, frame, load, load_attributes)
    return layers(file, frame), [*words, *arrow]


def layers(file: JointFile, frame: DrawingFrame) -> list[str]:
    """Draw liner and backing layers inside the cup's arc."""
    ends = list(pairwise(radii_of(file.joint)))
    kinds = ["liner", *(f"backing layer{number % 3}" for number in range(len(ends) - 1))]
    paths = [f"M{frame.arc(inner, file.cup.rim)}L{frame.arc(outer, -file.cup.rim)}Z" for inner, outer in ends]
    return [f'<path class="part {kind}" d="{path}"/>' for kind, path in zip(kinds, paths, strict=True)]


def ball(file: JointFile, contact: Contact | None, frame: DrawingFrame, tilt: float) -> str:
    """Draw the loaded ball by its `ball_radii`."""
    radii = frame.scale * ball_radii(file, contact)
    angle = numpy.linspace(0.0, 2 * pi, 2 * len(radii) - 1) - tilt
    radius = numpy.concatenate([radii, radii[-2::-1]])
    outline = svg.closed(frame.x + radius * numpy.sin(angle), frame.y + radius * numpy.cos(angle))
    return f'<path class="part ball" d="{outline}"/>'


def ball_radii(file: JointFile, contact: Contact | None) -> Numbers:
    """Return radii (mm) of the drawn ball at even angles from the load's axis to the back.

    They are the bore less the gap c - (c + d) cos φ, enlarged by `gap_factor`; there is no gap in the contact.
    """
    clearance, depth = float(file.joint.clearance), 0.0 if contact is None else float(contact.indentation)
    gap = numpy.clip(clearance - (clearance + depth) * numpy.cos(numpy.linspace(0.0, pi, 49)), 0.0, None)
    return float(file.joint.socket_radius) - gap_factor(file.joint) * gap


@lru_cache(maxsize=256)
def profile(contact: Contact) -> tuple[Numbers, Numbers]:
    """Sample angles (rad) from the pole to the edge of a contact, dense near the edge, and pressures."""
    angle = min(float(contact.half_angle), pi / 2) * _ANGLES
    return angle, numpy.asarray(contact.pressure(angle))


def largest_drawn(contact: Contact) -> float:
    """Return the largest pressure (MPa) of a drawing, which is finite where a sharp rim digs in."""
    if isinstance(contact, OffAxisContact) and isinf(contact.max_pressure):
        return shown_maximum(contact)
    return float(contact.max_pressure)


def petals(file: JointFile, contact: Contact) -> Cells:
    """Return quadrilaterals in the liner whose height shows the pressure, up to the `largest_drawn`."""
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
    reach = radius + highest * numpy.minimum(pressure / largest_drawn(contact), 1.0)
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


def edge_lines(file: JointFile, half_angle: float, tilt: float) -> list[str]:
    """Draw the direction of a load at a tilt (rad), and the edge of its contact where the half angle is not 0."""
    frame, radius = frame_of(file.joint), float(file.joint.socket_radius)
    ends = [frame.at(radius, angle - tilt) for angle in dict.fromkeys((0.0, half_angle))]
    return [svg.line(frame.x, frame.y, *end, "edge") for end in ends]


def arrow_start(file: JointFile, contact: Contact | None) -> float:
    """Return the distance in pixels from the centre to the arrow's tip, just above the drawn ball."""
    gap = 2 * float(file.joint.clearance) + (0.0 if contact is None else float(contact.indentation))
    radius = float(file.joint.socket_radius) - gap_factor(file.joint) * gap
    return frame_of(file.joint).scale * radius + _ARROW_GAP


def _arrow(x1: float, y1: float, x2: float, y2: float, kind: str, size: float = 7.0) -> str:
    away = atan2(y2 - y1, x2 - x1)
    wings = [(x2 - size * cos(away + angle), y2 - size * sin(away + angle)) for angle in (0.4, -0.4)]
    head = " ".join(f"{x:.1f},{y:.1f}" for x, y in ((x2, y2), *wings))
    return svg.line(x1, y1, x2, y2, kind) + f'<polygon class="{kind} head" points="{head}"/>'


def _both_ways(x1: float, y1: float, x2: float, y2: float) -> str:
    middle = (x1 + x2) / 2, (y1 + y2) / 2
    return _arrow(*middle, x1, y1, "dim") + _arrow(*middle, x2, y2, "dim")


def _labelled_value(name: str, value: str, x: float, y: float, anchor: str) -> str:
    return svg.text(x, y, name, "quiet", anchor) + svg.text(x, y, value, "value", anchor, ' dy="1.2em"')


def _dimensions(file: JointFile, frame: DrawingFrame, units: Units) -> Iterator[str]:
    """Draw the diameters of head, bore and outside, the clearance, and the thickness of the liner."""
    joint, radii, rim = file.joint, radii_of(file.joint), file.cup.rim
    ball_radius, across = float(joint.ball_radius), radians(118.0)
    yield _both_ways(*frame.at(0.985 * ball_radius, across), *frame.at(0.985 * ball_radius, across + pi))
    head = _labelled_value("head", f"⌀ {units.length(2 * ball_radius)}", frame.x - 62, frame.y - 10, "middle")
    yield f'<g class="on-ball">{head}</g>'

    bore = frame.at(radii[0], min(rim, radians(86.0)))
    yield _arrow(486.0, bore[1] - 62, *bore, "dim", 6.0)
    yield _labelled_value("bore", f"⌀ {units.length(2 * radii[0])}", 490.0, bore[1] - 66, "start")
    gap, (name, fit), times = frame.at(radii[0], min(rim, radians(72.0))), joint.fit, gap_factor(joint)
    yield _arrow(492.0, gap[1] + 12, *gap, "dim", 6.0)
    yield _labelled_value(name, f"⌀ {units.length(2 * float(fit))}", 496.0, gap[1] + 8, "start")
    if times > 1:
        yield svg.text(496.0, gap[1] + 8, f"drawn × {times}", "quiet", "start", ' dy="2.5em"')

    thickness, angle = float(joint.liner_thickness), -min(rim, radians(62.0))
    inner, outer = frame.at(radii[0], angle), frame.at(radii[1], angle)
    if not isinf(thickness):
        yield _both_ways(*inner, *outer)
    yield _arrow(112.0, outer[1] + 14, *outer, "dim", 6.0)
    thick = "solid" if isinf(thickness) else units.length(thickness)
    yield _labelled_value("liner", thick, 106.0, outer[1] + 10, "end")

    if isinf(float(joint.outer_radius)):
        return
    left, right, low = frame.x - _REACH, frame.x + _REACH, frame.y + _REACH + 34
    for x in (left, right):
        yield svg.line(x, frame.y + 4, x, low + 5, "thin")
    yield _both_ways(left, low, right, low)
    yield _labelled_value("outside", f"⌀ {units.length(2 * radii[-1])}", frame.x, low + 20, "middle")


def _names(joint: Joint, frame: DrawingFrame) -> Iterator[str]:
    ball = "rigid ball" if joint.ball is None else _drawn_label(joint.ball, "ball")
    yield svg.text(frame.x, frame.y - 44, ball, "name")
    materials = [joint.liner, *(layer.material for layer in joint.backing)]
    for number, (material, (inner, outer)) in enumerate(zip(materials, pairwise(radii_of(joint)), strict=False)):
        thick = frame.scale * (outer - inner)
        if thick > 14:
            x, y = frame.at((inner + outer) / 2, 0.0)
            yield svg.text(x, y + 4 + 0.2 * thick * (number == 0), _drawn_label(material, "liner"), "name")


def _drawn_label(material: Material, unnamed: str) -> str:
    return material_label(material, unnamed).partition(",")[0]


def _load(
    file: JointFile, contact: Contact | None, frame: DrawingFrame, load: DrawnLoad, attributes: str
) -> Iterator[str]:
    """Draw the load's arrow to the ball, with its size and tilt behind its tail."""
    start = arrow_start(file, contact)
    ends = start, start + MIN_ARROW + ARROW_GROWTH * load.share
    tip, tail, words = (
        (frame.x + away * sin(load.tilt), frame.y - away * cos(load.tilt)) for away in (*ends, ends[1] + 16)
    )
    yield f"<g {attributes}>{_arrow(*tail, *tip, 'load', 15.0)}</g>"
    if load.tilt > _STEEP_TILT:  # the names of bore and gap are to the right
        yield svg.text(words[0] - 20, words[1] - 16, load.text, "value", "end")
    else:
        yield svg.text(words[0] + (4 if load.tilt else 14), words[1] + 5, load.text, "value", "start")
