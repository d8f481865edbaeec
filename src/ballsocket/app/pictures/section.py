"""Section of the joint on the page: the drawing of reports, with handles to drag, or with its stresses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from itertools import pairwise
from math import cos, isinf, sin
from typing import Any

import numpy

from ...contact import Contact
from ...core.quantities import Quantity
from ...core.unit_systems import Units
from ...elasticity.off_axis.contact import OffAxisContact
from ...files.joint_file import JointFile
from ...reports import svg
from ...reports.joint_drawing import (
    ARROW_GROWTH,
    LABEL,
    MIN_ARROW,
    SIZE,
    DrawingFrame,
    DrawnLoad,
    Numbers,
    arrow_start,
    ball,
    edge_lines,
    frame_of,
    layers,
    petals,
    radii_of,
    section_parts,
)

_SMALL = 340.0
_STRESS_COLUMNS, _STRESS_ROWS = 40, 10
_MASSIVE_DEPTH = 1.5  # contact radii that are drawn of what has no end
_STRESS_WIDTH = 1.25  # half angles to each side


def section(file: JointFile, contact: Contact | None, extent: float, highest: float) -> str:
    """Draw a joint under a load from above to `extent` (mm), with pressure colours up to `highest` (MPa)."""
    frame = DrawingFrame(x=_SMALL / 2, y=_SMALL / 2, scale=_SMALL / 2 / extent / 1.04)
    pressure = [] if contact is None else frame.cells(petals(file, contact), highest or 1.0)
    return svg.picture((_SMALL, _SMALL), LABEL, [*layers(file, frame), ball(file, contact, frame, 0.0), *pressure])


def extent_of(file: JointFile) -> float:
    """Return half the width of the drawing in mm."""
    return radii_of(file.joint)[-1]


def first_view(
    file: JointFile, contact: Contact | None, fields: Mapping[str, Any], units: Units, inside: list[str] | None = None
) -> str:
    """Draw a joint with its dimensions and load; `inside` is SVG of its stresses, which replaces the pressure.

    `fields` are the inputs that its handles move.
    """
    load, tilt, frame = fields["load"], fields["tilt"], frame_of(file.joint)
    text = f"{load['text']} {load['unit']}" + (f", {tilt['value']:.3g}{tilt['unit']}" if file.tilt else "")
    drawn = DrawnLoad(text=text, tilt=file.tilt, share=min(1.0, max(0.0, load["value"] / load["high"])))
    groups = {"ball": 'class="grab" data-drag="load" data-how="ball"', "load": _handle("load", "arrow", load)}
    half_angle = 0.0 if contact is None or isinstance(contact, OffAxisContact) else float(contact.half_angle)
    start, pressed = arrow_start(file, contact), contact is not None and float(contact.half_angle) > 0
    away = start + MIN_ARROW + ARROW_GROWTH * drawn.share
    knob = f'cx="{frame.x + away * sin(file.tilt):.1f}" cy="{frame.y - away * cos(file.tilt):.1f}" r="8"'
    parts = [
        *section_parts(file, contact, drawn, units, inside, groups),
        *(edge_lines(file, half_angle, file.tilt) if pressed else ()),
        *_borders(file, frame, fields),
        f'<g {_handle("tilt", "arrow", tilt)}><circle class="knob" {knob}/></g>',
    ]
    size = f' data-centre="{frame.x:g} {frame.y:g}" data-scale="{frame.scale:.5g}"'
    arrow = f' data-start="{start + MIN_ARROW:.1f}" data-long="{ARROW_GROWTH:g}"'
    return svg.picture(SIZE, LABEL, parts, size + arrow, "group")


def _borders(file: JointFile, frame: DrawingFrame, fields: Mapping[str, Any]) -> Iterator[str]:
    """Draw the outer border of each layer as a handle."""
    names = ["liner_thickness", *(f"layer{number}" for number in range(len(file.joint.backing)))]
    for name, (inner, outer) in zip(names, pairwise(radii_of(file.joint)), strict=False):
        if name in fields:
            numbers = f"data-inner='{inner!r}' data-factor='{fields[name]['factor']!r}'"
            arc = frame.arc(outer, 0.98 * file.cup.rim)
            yield f'<path {_handle(name, "border", fields[name])} {numbers} class="border" d="M{arc}"/>'


def _handle(name: str, how: str, field: Mapping[str, Any]) -> str:
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


def painted_stresses(file: JointFile, stresses: LinerStresses) -> list[str]:
    """Draw each cell of the liner in the colour of its stress, inside the cup's arc."""
    frame, pieces = frame_of(file.joint), list[str]()
    wide, deep = stresses.angles[1] - stresses.angles[0], stresses.depths[1] - stresses.depths[0]
    rim, depth = file.cup.rim, float(file.joint.socket_radius) + numpy.repeat(stresses.depths, len(stresses.angles))
    middle = numpy.tile(stresses.angles, len(stresses.depths))
    inner, outer = depth - 0.52 * deep, depth + 0.52 * deep
    for side in (1, -1):
        low, high = (numpy.clip(side * middle + end * wide, -rim, rim) for end in (-0.52, 0.52))
        radii, angles = (
            numpy.stack(corners, axis=-1) for corners in ((inner, inner, outer, outer), (low, high, high, low))
        )
        inside = low < high
        pieces += frame.cells((radii[inside], angles[inside], stresses.values.ravel()[inside]), stresses.largest)
    return pieces
