"""The joint large, with its dimensions, its load, and handles to drag: what a designer shows to a client."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from html import escape
from math import atan2, cos, degrees, isinf, pi, radians, sin

from ..contact import Contact
from ..core.kinds import Unit
from ..core.quantities import Quantity
from ..files.joint_file import JointFile
from ..reports.section_plots import gap_factor, radii_of
from . import svg
from .drawing import DrawingFrame, ball, heat, layers, painted
from .fields import Field

Said = Callable[[float], str]
Aim = tuple[float, Unit]
_WIDE, _HIGH = 624.0, 486.0
_MIDDLE = (300.0, 238.0)
_REACH = 168.0  # pixels from the centre to the outermost layer
_OFF, _SHORT, _LONG = 8.0, 26.0, 54.0  # of the load's arrow: from the ball, without load, and what is added at most


def first_view(file: JointFile, contact: Contact | None, fields: dict[str, Field], aim: Aim, inside: str = "") -> str:
    """A joint as SVG; `inside` is SVG of its stresses, in the frame of `frame_of`, in place of the pressure.

    `fields` are the inputs that its handles move; `aim` the load's tilt in rad, and the unit of lengths.
    """
    tilt, unit = aim
    frame = frame_of(file)
    top = 0.0 if contact is None else float(contact.max_pressure)
    parts = [
        *layers(file, frame),
        inside,
        f'<g class="grab" data-drag="load" data-how="ball">{ball(file, contact, frame, tilt)}</g>',
        *([] if inside else painted(file, contact, frame, top, tilt)),
        *_names(file, frame),
        *_dimensions(file, frame, unit),
        *_borders(file, frame, fields),
        *_contact_edge(file, contact, frame, tilt),
        *_load(_start(file, contact, frame), frame, fields, tilt),
    ]
    size = f' data-centre="{frame.x:g} {frame.y:g}" data-scale="{frame.scale:.5g}"'
    arrow = f' data-start="{_start(file, contact, frame) + _SHORT:.1f}" data-long="{_LONG:g}"'
    return svg.group_picture((_WIDE, _HIGH), "the joint in section, to scale", parts, size + arrow)


def frame_of(file: JointFile) -> DrawingFrame:
    """Where the joint lies in the picture."""
    return DrawingFrame(x=_MIDDLE[0], y=_MIDDLE[1], scale=_REACH / radii_of(file.joint)[-1])


def _arrow(x1: float, y1: float, x2: float, y2: float, kind: str, size: float = 7.0) -> str:
    """A line with a head at its end."""
    away = atan2(y2 - y1, x2 - x1)
    wings = [(x2 - size * cos(away + turn), y2 - size * sin(away + turn)) for turn in (0.4, -0.4)]
    head = " ".join(f"{x:.1f},{y:.1f}" for x, y in ((x2, y2), *wings))
    return svg.line(x1, y1, x2, y2, kind) + f'<polygon class="{kind} head" points="{head}"/>'


def _both_ways(x1: float, y1: float, x2: float, y2: float) -> str:
    middle = (x1 + x2) / 2, (y1 + y2) / 2
    return _arrow(*middle, x1, y1, "dim") + _arrow(*middle, x2, y2, "dim")


def _said(lines: tuple[str, str], x: float, y: float, anchor: str) -> str:
    """What it is, and below it how much."""
    return svg.text(x, y, lines[0], "quiet", anchor) + svg.text(x, y + 17, lines[1], "value", anchor)


def _dimensions(file: JointFile, frame: DrawingFrame, unit: Unit) -> Iterator[str]:
    def said(value: float) -> str:
        return f"{value * unit.factor:.4g} {unit.text}"

    yield from _head(file, frame, said)
    yield from _bore_and_gap(file, frame, said)
    yield from _liner(file, frame, said)
    lengths = [file.joint.liner_thickness, *(layer.thickness for layer in file.joint.backing)]
    if not any(isinf(float(length)) for length in lengths):
        yield from _shell(frame, f"⌀ {said(2 * radii_of(file.joint)[-1])}")


def _head(file: JointFile, frame: DrawingFrame, said: Said) -> Iterator[str]:
    radius, turn = float(file.joint.ball_radius), radians(118.0)
    near, far = frame.at(0.985 * radius, turn), frame.at(0.985 * radius, turn + pi)
    yield _both_ways(*near, *far)
    yield _said(("head", f"⌀ {said(2 * radius)}"), frame.x - 62, frame.y + 12, "middle")


def _bore_and_gap(file: JointFile, frame: DrawingFrame, said: Said) -> Iterator[str]:
    radius, rim, times = float(file.joint.socket_radius), file.cup.rim, gap_factor(file.joint)
    bore = frame.at(radius, min(rim, radians(86.0)))
    yield _leader(*bore, 486.0, bore[1] - 62)
    yield _said(("bore", f"⌀ {said(2 * radius)}"), 490.0, bore[1] - 66, "start")
    gap = frame.at(radius, min(rim, radians(72.0)))
    yield _leader(*gap, 492.0, gap[1] + 12)
    drawn = f"⌀ {said(2 * float(file.joint.clearance))}"
    if times > 1:
        yield svg.text(496.0, gap[1] + 42, f"drawn × {times}", "quiet", "start")
    yield _said(("clearance", drawn), 496.0, gap[1] + 8, "start")


def _liner(file: JointFile, frame: DrawingFrame, said: Said) -> Iterator[str]:
    radii, thickness = radii_of(file.joint), float(file.joint.liner_thickness)
    turn = -min(file.cup.rim, radians(62.0))
    inner, outer = frame.at(radii[0], turn), frame.at(radii[1], turn)
    if not isinf(thickness):
        yield _both_ways(*inner, *outer)
    yield _leader(*outer, 112.0, outer[1] + 14)
    thick = "massive" if isinf(thickness) else said(thickness)
    yield _said(("liner", thick), 106.0, outer[1] + 10, "end")


def _leader(x1: float, y1: float, x2: float, y2: float) -> str:
    return _arrow(x2, y2, x1, y1, "dim", 6.0)


def _shell(frame: DrawingFrame, said: str) -> Iterator[str]:
    """The outer diameter below the cup."""
    left, right, low = frame.x - _REACH, frame.x + _REACH, frame.y + _REACH + 34
    for x in (left, right):
        yield svg.line(x, frame.y + 4, x, low + 5, "thin")
    yield _both_ways(left, low, right, low)
    yield _said(("shell", said), frame.x, low + 20, "middle")


def _names(file: JointFile, frame: DrawingFrame) -> Iterator[str]:
    """Ball and layers by their materials."""
    joint = file.joint
    yield svg.text(frame.x, frame.y - 44, "rigid ball" if joint.ball is None else joint.ball.name or "ball", "name")
    materials = [joint.liner, *(layer.material for layer in joint.backing)]
    for number, (material, inner, outer) in enumerate(
        zip(materials, radii_of(file.joint), radii_of(file.joint)[1:], strict=False)
    ):
        if frame.scale * (outer - inner) > 14:
            x, y = frame.at((inner + outer) / 2, 0.0)
            yield svg.text(
                x, y + 4 + 0.2 * frame.scale * (outer - inner) * (number == 0), material.name or "liner", "name"
            )


def _contact_edge(file: JointFile, contact: Contact | None, frame: DrawingFrame, tilt: float) -> Iterator[str]:
    """The contact's half angle."""
    if contact is None or not float(contact.half_angle) > 0:
        return
    for turn in (0.0, float(contact.half_angle)):
        x, y = frame.at(float(file.joint.socket_radius), turn - tilt)
        yield svg.line(frame.x, frame.y, x, y, "edge")


def _start(file: JointFile, contact: Contact | None, frame: DrawingFrame) -> float:
    """Where the arrow ends, in pixels from the centre: just above the ball as it is drawn."""
    gap = 2 * float(file.joint.clearance) + (0.0 if contact is None else float(contact.indentation))
    return frame.scale * (float(file.joint.socket_radius) - gap_factor(file.joint) * gap) + _OFF


def _load(start: float, frame: DrawingFrame, fields: dict[str, Field], tilt: float) -> Iterator[str]:
    """The load's arrow, from outside to the ball; its tail turns it."""
    load, turn = fields["load"], fields["tilt"]
    share = min(1.0, max(0.0, load["value"] / load["high"]))
    long = start + _SHORT + _LONG * share
    tip, tail = ((frame.x + away * sin(tilt), frame.y - away * cos(tilt)) for away in (start, long))
    x, y = frame.x + (long + 16) * sin(tilt), frame.y - (long + 16) * cos(tilt)
    yield f"<g {_handle('load', 'arrow', load)}>{_arrow(*tail, *tip, 'load', 15.0)}</g>"
    yield (
        f"<g {_handle('tilt', 'arrow', turn)}>"
        + f'<circle class="knob" cx="{tail[0]:.1f}" cy="{tail[1]:.1f}" r="8"/></g>'
    )
    said = f"{load['text']} {load['unit']}" + (f", {turn['value']:.3g}{turn['unit']}" if tilt else "")
    yield svg.text(x + (4 if tilt else 14), y + 5, said, "value", "start")


def _borders(file: JointFile, frame: DrawingFrame, fields: dict[str, Field]) -> Iterator[str]:
    """The outer border of each layer that has one, to be dragged."""
    radii = radii_of(file.joint)
    names = ["liner_thickness", *(f"layer{number}" for number in range(len(file.joint.backing)))]
    for name, inner, outer in zip(names, radii, radii[1:], strict=False):
        if name in fields:
            numbers = f"data-inner='{inner!r}' data-factor='{fields[name]['factor']!r}'"
            arc = _arc(frame, outer, 0.98 * file.cup.rim)
            yield f'<path {_handle(name, "border", fields[name])} {numbers} class="border" d="{arc}"/>'


def _arc(frame: DrawingFrame, radius: float, half: float) -> str:
    """Part of a circle (mm) to both sides of the pole."""
    (x1, y1), (x2, y2) = frame.at(radius, -half), frame.at(radius, half)
    away = frame.scale * radius
    return f"M{x1:.1f},{y1:.1f}A{away:.1f},{away:.1f} 0 {int(half > pi / 2)} 0 {x2:.1f},{y2:.1f}"


def _handle(name: str, how: str, field: Field) -> str:
    """What makes a part a slider, for the mouse, the keyboard and a screen reader."""
    said = f"{field['text']} {field['unit']}".strip()
    return (
        f'tabindex="0" role="slider" data-drag="{name}" data-how="{how}" aria-label="{escape(field["label"])}" '
        f'aria-valuemin="{field["low"]:g}" aria-valuemax="{field["high"]:g}" aria-valuenow="{field["value"]:g}" '
        f'aria-valuetext="{escape(said)}"'
    )


def key(top: str, quantity: Quantity, instead: bool) -> str:
    """The scale of the colours from 0 to a number with its unit; `instead`: nothing else is known inside."""
    stops = ", ".join(heat(share / 8) for share in range(9))
    note = "<span>this model knows no stresses inside the liner</span>" if instead else ""
    return (
        f"<p class='scale'><span>{escape(quantity.title)}: 0</span>"
        f"<i style='background: linear-gradient(to right, {stops})'></i>"
        f"<span>{escape(top)}</span>{note}</p>"
    )


def about_the_rim(file: JointFile, contact: Contact | None, tilt: float) -> str:
    """How a tilted load lies to the cup's rim, as HTML: these numbers are those of a socket without one."""
    if contact is None or not tilt:
        return ""
    left = degrees(file.cup.rim - tilt - float(contact.half_angle))
    if left > 0:
        return f"<p class='quiet'>The contact ends {left:.3g}° before the rim.</p>"
    return (
        f"<p class='trust no'>✗ the contact reaches {-left:.3g}° over the rim, which no answer here knows: "
        "ask <code>sphere</code></p>"
    )
