"""Section of the joint on the page: the drawing of reports, with handles to drag, or with its stresses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
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
    ball_radii,
    edge_lines,
    frame_of,
    largest_drawn,
    layers,
    petals,
    radii_of,
    section_parts,
)
from ..widgets.blocks import Block

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
    file: JointFile,
    contact: Contact | None,
    fields: Mapping[str, Any],
    units: Units,
    inside: LinerStresses | None = None,
) -> Block:
    """Draw a joint with its dimensions and load; the stresses `inside` its liner replace the pressure.

    `fields` are the inputs that its handles move. A script draws ball and cells from their numbers.
    """
    load, tilt, frame = fields["load"], fields["tilt"], frame_of(file.joint)
    text = f"{load['text']} {load['unit']}" + (f", {tilt['value']:.3g}{tilt['unit']}" if file.tilt else "")
    drawn = DrawnLoad(text=text, tilt=file.tilt, share=min(1.0, max(0.0, load["value"] / load["high"])))
    half_angle = 0.0 if contact is None or isinstance(contact, OffAxisContact) else float(contact.half_angle)
    start, pressed = arrow_start(file, contact), contact is not None and float(contact.half_angle) > 0
    away = start + MIN_ARROW + ARROW_GROWTH * drawn.share
    knob = f'cx="{frame.x + away * sin(file.tilt):.1f}" cy="{frame.y - away * cos(file.tilt):.1f}" r="8"'
    below, above = section_parts(file, contact, drawn, units, _handle("load", "arrow", load))
    cells = None if contact is None else _pressure(file, contact) if inside is None else _stresses(file, inside)
    return {
        "kind": "section",
        "size": list(SIZE),
        "label": LABEL,
        "data": {"centre": f"{frame.x:g} {frame.y:g}", "scale": f"{frame.scale:.5g}", "long": f"{ARROW_GROWTH:g}"},
        "below": below,
        "cells": cells,
        "ball": {"radii": (frame.scale * ball_radii(file, contact)).round(1).tolist(), "tilt": round(file.tilt, 4)},
        "above": [
            *above,
            *(edge_lines(file, half_angle, file.tilt) if pressed else ()),
            *_borders(file, frame, fields),
            f'<g {_handle("tilt", "arrow", tilt)}><circle class="knob" {knob}/></g>',
        ],
    }


def _pressure(file: JointFile, contact: Contact) -> dict[str, Any] | None:
    """Return the cells of the pressure: a row from the bore to the radii at their sides."""
    radii, angles, values = petals(file, contact)
    if not values.size:
        return None
    sides = [*radii[:, 3].tolist(), float(radii[-1, 2])]
    return _cells(
        file, [[radii[0, 0]], sides], [*angles[:, 0], angles[-1, 1]], values[None, :] / largest_drawn(contact)
    )


def _stresses(file: JointFile, stresses: LinerStresses) -> dict[str, Any]:
    """Return the cells of the stresses inside the cup's arc, on both sides of the axis."""
    wide, deep = stresses.angles[1] - stresses.angles[0], stresses.depths[1] - stresses.depths[0]
    radii = float(file.joint.socket_radius) + deep * numpy.arange(len(stresses.depths) + 1)
    sides = wide * numpy.arange(-len(stresses.angles), len(stresses.angles) + 1)
    shares = numpy.concatenate([stresses.values[:, ::-1], stresses.values], axis=1) / stresses.largest
    inside = (sides[:-1] > -file.cup.rim) & (sides[1:] < file.cup.rim)
    edges = sides[numpy.concatenate([inside, [False]]) | numpy.concatenate([[False], inside])]
    return _cells(file, radii[:, None].tolist(), edges, shares[:, inside])


def _cells(
    file: JointFile, radii: Sequence[Sequence[float]], angles: Iterable[float], shares: Numbers
) -> dict[str, Any]:
    """Return cells in pixels and rad between radii, each for all or for each of the angles; colours are percents."""
    scale = frame_of(file.joint).scale
    return {
        "radii": [[round(scale * float(radius), 1) for radius in row] for row in radii],
        "angles": [round(float(angle), 4) for angle in angles],
        "percents": numpy.rint(100 * shares).astype(int).tolist(),
    }


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


def key(top: str, quantity: Quantity, note: str = "") -> Block:
    """Return the colour scale from 0 to a value, with a note."""
    return {"kind": "scale", "words": [f"{quantity.title}: 0", top, note]}


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
