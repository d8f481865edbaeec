"""Large section of the joint with dimensions, load and handles to drag."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from html import escape
from itertools import pairwise
from math import atan2, cos, isinf, pi, radians, sin

from ...contact import Contact
from ...core.kinds import Unit
from ...core.quantities import Quantity
from ...elasticity.off_axis.contact import OffAxisContact
from ...files.joint_file import JointFile
from ...reports.section_plots import gap_factor, radii_of
from ..pictures import svg
from ..pictures.section import DrawingFrame, ball, layers, painted
from ..widgets.controls import Field
from ..widgets.reading import number_text

Formatter = Callable[[float], str]
Aim = tuple[float, Unit]
_WIDTH, _HEIGHT = 624.0, 486.0
_MIDDLE = (300.0, 238.0)
_REACH = 168.0  # pixels from the centre to the outermost layer
_STEEP_TILT = radians(40.0)  # tilt from which the label of the load is to the left of its arrow
_ARROW_GAP, _MIN_ARROW, _ARROW_GROWTH = 8.0, 26.0, 54.0
"""Pixels of the load's arrow: gap to the ball, length without load, and the most that the load adds."""


def first_view(
    file: JointFile, contact: Contact | None, fields: Mapping[str, Field], aim: Aim, inside: str = ""
) -> str:
    """Draw a joint as SVG; `inside` is SVG of its stresses, which replaces the pressure.

    `fields` are the inputs that its handles move; `aim` the load's tilt in rad, and the unit of lengths.
    """
    tilt, unit = aim
    frame = frame_of(file)
    top = 0.0 if contact is None else float(contact.max_pressure)
    parts = [
        *layers(file, frame),
        inside,
        f'<g class="grab" data-drag="load" data-how="ball">{ball(file, contact, frame, tilt)}</g>',
        *([] if inside else painted(file, contact, frame, top)),
        *_names(file, frame),
        *_dimensions(file, frame, unit),
        *_borders(file, frame, fields),
        *_contact_edge(file, contact, frame, tilt),
        *_load(_start(file, contact, frame), frame, fields, tilt),
    ]
    size = f' data-centre="{frame.x:g} {frame.y:g}" data-scale="{frame.scale:.5g}"'
    arrow = f' data-start="{_start(file, contact, frame) + _MIN_ARROW:.1f}" data-long="{_ARROW_GROWTH:g}"'
    return svg.picture((_WIDTH, _HEIGHT), "the joint in section, to scale", parts, size + arrow, "group")


def frame_of(file: JointFile) -> DrawingFrame:
    """Return the frame of the joint in the picture."""
    return DrawingFrame(x=_MIDDLE[0], y=_MIDDLE[1], scale=_REACH / radii_of(file.joint)[-1])


def _arrow(x1: float, y1: float, x2: float, y2: float, kind: str, size: float = 7.0) -> str:
    away = atan2(y2 - y1, x2 - x1)
    wings = [(x2 - size * cos(away + angle), y2 - size * sin(away + angle)) for angle in (0.4, -0.4)]
    head = " ".join(f"{x:.1f},{y:.1f}" for x, y in ((x2, y2), *wings))
    return svg.line(x1, y1, x2, y2, kind) + f'<polygon class="{kind} head" points="{head}"/>'


def _both_ways(x1: float, y1: float, x2: float, y2: float) -> str:
    middle = (x1 + x2) / 2, (y1 + y2) / 2
    return _arrow(*middle, x1, y1, "dim") + _arrow(*middle, x2, y2, "dim")


def _labelled_value(lines: tuple[str, str], x: float, y: float, anchor: str) -> str:
    return svg.text(x, y, lines[0], "quiet", anchor) + svg.text(x, y + 17, lines[1], "value", anchor)


def _dimensions(file: JointFile, frame: DrawingFrame, unit: Unit) -> Iterator[str]:
    """Draw the diameters of head, bore and shell, the clearance, and the thickness of the liner."""

    def format_length(value: float) -> str:
        return f"{number_text(value * unit.factor)} {unit.text}"

    radius, angle = float(file.joint.ball_radius), radians(118.0)
    yield _both_ways(*frame.at(0.985 * radius, angle), *frame.at(0.985 * radius, angle + pi))
    label = _labelled_value(("head", f"⌀ {format_length(2 * radius)}"), frame.x - 62, frame.y + 12, "middle")
    yield f'<g class="on-ball">{label}</g>'
    yield from _bore_and_gap(file, frame, format_length)
    yield from _liner(file, frame, format_length)
    lengths = [file.joint.liner_thickness, *(layer.thickness for layer in file.joint.backing)]
    if any(isinf(float(length)) for length in lengths):
        return
    x_left, x_right, low = frame.x - _REACH, frame.x + _REACH, frame.y + _REACH + 34
    for x in (x_left, x_right):
        yield svg.line(x, frame.y + 4, x, low + 5, "thin")
    yield _both_ways(x_left, low, x_right, low)
    shell = f"⌀ {format_length(2 * radii_of(file.joint)[-1])}"
    yield _labelled_value(("shell", shell), frame.x, low + 20, "middle")


def _bore_and_gap(file: JointFile, frame: DrawingFrame, format_length: Formatter) -> Iterator[str]:
    radius, rim, times = float(file.joint.socket_radius), file.cup.rim, gap_factor(file.joint)
    bore = frame.at(radius, min(rim, radians(86.0)))
    yield _leader(*bore, 486.0, bore[1] - 62)
    yield _labelled_value(("bore", f"⌀ {format_length(2 * radius)}"), 490.0, bore[1] - 66, "start")
    gap = frame.at(radius, min(rim, radians(72.0)))
    yield _leader(*gap, 492.0, gap[1] + 12)
    name, fit = file.joint.fit
    drawn = f"⌀ {format_length(2 * float(fit))}"
    if times > 1:
        yield svg.text(496.0, gap[1] + 42, f"drawn × {times}", "quiet", "start")
    yield _labelled_value((name, drawn), 496.0, gap[1] + 8, "start")


def _liner(file: JointFile, frame: DrawingFrame, format_length: Formatter) -> Iterator[str]:
    radii, thickness = radii_of(file.joint), float(file.joint.liner_thickness)
    angle = -min(file.cup.rim, radians(62.0))
    inner, outer = frame.at(radii[0], angle), frame.at(radii[1], angle)
    if not isinf(thickness):
        yield _both_ways(*inner, *outer)
    yield _leader(*outer, 112.0, outer[1] + 14)
    thick = "solid" if isinf(thickness) else format_length(thickness)
    yield _labelled_value(("liner", thick), 106.0, outer[1] + 10, "end")


def _leader(x1: float, y1: float, x2: float, y2: float) -> str:
    return _arrow(x2, y2, x1, y1, "dim", 6.0)


def _names(file: JointFile, frame: DrawingFrame) -> Iterator[str]:
    joint = file.joint
    yield svg.text(frame.x, frame.y - 44, "rigid ball" if joint.ball is None else joint.ball.name or "ball", "name")
    materials = [joint.liner, *(layer.material for layer in joint.backing)]
    for number, (material, (inner, outer)) in enumerate(zip(materials, pairwise(radii_of(joint)), strict=False)):
        thick = frame.scale * (outer - inner)
        if thick > 14:
            x, y = frame.at((inner + outer) / 2, 0.0)
            yield svg.text(x, y + 4 + 0.2 * thick * (number == 0), material.name or "liner", "name")


def _contact_edge(file: JointFile, contact: Contact | None, frame: DrawingFrame, tilt: float) -> Iterator[str]:
    """Draw the direction of the load, and the half angle of a contact about the cup's axis."""
    if contact is None or not float(contact.half_angle) > 0:
        return
    for angle in (0.0,) if isinstance(contact, OffAxisContact) else (0.0, float(contact.half_angle)):
        x, y = frame.at(float(file.joint.socket_radius), angle - tilt)
        yield svg.line(frame.x, frame.y, x, y, "edge")


def _start(file: JointFile, contact: Contact | None, frame: DrawingFrame) -> float:
    """Return the distance in pixels from the centre to the arrow's tip, just above the drawn ball."""
    gap = 2 * float(file.joint.clearance) + (0.0 if contact is None else float(contact.indentation))
    return frame.scale * (float(file.joint.socket_radius) - gap_factor(file.joint) * gap) + _ARROW_GAP


def _load(start: float, frame: DrawingFrame, fields: Mapping[str, Field], tilt: float) -> Iterator[str]:
    """Draw the load's arrow to the ball; its tail is the handle of the tilt."""
    load, tilt_field = fields["load"], fields["tilt"]
    share = min(1.0, max(0.0, load["value"] / load["high"]))
    long = start + _MIN_ARROW + _ARROW_GROWTH * share
    tip, tail = ((frame.x + away * sin(tilt), frame.y - away * cos(tilt)) for away in (start, long))
    x, y = frame.x + (long + 16) * sin(tilt), frame.y - (long + 16) * cos(tilt)
    yield f"<g {_handle('load', 'arrow', load)}>{_arrow(*tail, *tip, 'load', 15.0)}</g>"
    knob = f'<circle class="knob" cx="{tail[0]:.1f}" cy="{tail[1]:.1f}" r="8"/>'
    yield f"<g {_handle('tilt', 'arrow', tilt_field)}>{knob}</g>"
    text = f"{load['text']} {load['unit']}" + (f", {tilt_field['value']:.3g}{tilt_field['unit']}" if tilt else "")
    if tilt > _STEEP_TILT:  # the names of bore and gap are to the right
        yield svg.text(x - 20, y - 16, text, "value", "end")
    else:
        yield svg.text(x + (4 if tilt else 14), y + 5, text, "value", "start")


def _borders(file: JointFile, frame: DrawingFrame, fields: Mapping[str, Field]) -> Iterator[str]:
    """Draw the outer border of each layer as a handle."""
    names = ["liner_thickness", *(f"layer{number}" for number in range(len(file.joint.backing)))]
    for name, (inner, outer) in zip(names, pairwise(radii_of(file.joint)), strict=False):
        if name in fields:
            numbers = f"data-inner='{inner!r}' data-factor='{fields[name]['factor']!r}'"
            arc = frame.arc(outer, 0.98 * file.cup.rim)
            yield f'<path {_handle(name, "border", fields[name])} {numbers} class="border" d="M{arc}"/>'


def _handle(name: str, how: str, field: Field) -> str:
    """Return the attributes of a slider for mouse, keyboard and screen readers."""
    text = f"{field['text']} {field['unit']}".strip()
    return (
        f'tabindex="0" role="slider" data-drag="{name}" data-how="{how}" aria-label="{escape(field["label"])}" '
        f'aria-valuemin="{field["low"]:g}" aria-valuemax="{field["high"]:g}" aria-valuenow="{field["value"]:g}" '
        f'aria-valuetext="{escape(text)}"'
    )


def key(top: str, quantity: Quantity, note: str = "") -> str:
    """Draw the colour scale from 0 to a value, with a note."""
    stops = ", ".join(svg.heat(share / 8) for share in range(9))
    remark = f"<span>{escape(note)}</span>" if note else ""
    return (
        f"<p class='scale'><span>{escape(quantity.title)}: 0</span>"
        f"<i style='background: linear-gradient(to right, {stops})'></i>"
        f"<span>{escape(top)}</span>{remark}</p>"
    )
