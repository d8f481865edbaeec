"""Pictures of a bore with a field on it, flat and in three dimensions."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from html import escape
from math import cos, degrees, hypot, pi, radians, sin
from typing import Any

import numpy

from ...core.quantities import DERIVED, FIELD
from ...elasticity.off_axis.contact import OffAxisContact
from ...elasticity.off_axis.directions import unit_vectors
from ...elasticity.off_axis.grid import Grid
from ...hip.ball_wear import interpolation_at
from ...problem.cup import Cup
from ...reports.cup_map import from_page, on_page, shown_maximum, shown_pressure
from ..widgets.reading import Reading
from . import svg
from .svg import Contours, levels_of, scale

METRIC = Reading()
"""mm, N, MPa and degrees."""

_MAP_WIDTH, _MIDDLE, _RADIUS, _MAP_HEIGHT = 360.0, 180.0, 140.0, 400.0
_POINTS = 181
_MOSTLY_VERTICAL = 0.7
_MIN_IN_PLANE = 0.3  # of a unit vector: one that points more steeply out of the picture is not drawn


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreField:
    """Values on a bore up to the angle `reach`; `at` takes unit vectors (..., 3) of the cup's frame."""

    name: str
    at: Callable[[numpy.ndarray], numpy.ndarray]
    highest: float
    label: str
    reach: float
    cup: Cup


def pressed_bore(contact: OffAxisContact, reading: Reading = METRIC) -> str:
    """Draw the pressure of a contact with its edge, its load and its maximum."""
    reach, unit = float(contact.model.reach_of(contact.joint)), reading.unit(FIELD["pressure"])
    field = BoreField(
        name="cup",
        at=lambda directions: unit.factor * shown_pressure(contact, directions),
        highest=unit.factor * shown_maximum(contact),
        label=reading.label(FIELD["pressure"]),
        reach=reach,
        cup=contact.model.cup,
    )
    project = _projection(reach)
    edge = svg.closed(*project(contact.outline))
    marks = [
        f'<path class="patch" d="{edge}"/>',
        *_load_cross(*map(float, project(contact.force_vector / contact.force))),
    ]
    if numpy.isfinite(contact.max_pressure):
        x, y = map(float, project(contact.max_pressure_at))
        marks.append(f'<circle class="most" cx="{x:.1f}" cy="{y:.1f}" r="5"/>')
    highest = reading.with_unit(FIELD["pressure"], shown_maximum(contact))
    distance = reading.with_unit(DERIVED["edge_distance"], float(contact.edge_distance))
    label = f"pressure on the cup seen from its opening, up to {highest}; the contact ends {distance} from the rim"
    return bore_map(label, field, marks)


def worn_bore(field: BoreField, label: str, load: Any) -> str:
    """Draw the worn depth of a bore, with a cross at the direction of the load (3,)."""
    return bore_map(label, field, list(_load_cross(*map(float, _projection(field.reach)(load)))))


def grid_field(grid: Grid, values: numpy.ndarray) -> Callable[[numpy.ndarray], numpy.ndarray]:
    """Make a function of directions (..., 3) from the cell values (rings, meridians) of a grid."""

    def at(directions: numpy.ndarray) -> numpy.ndarray:
        interpolation = interpolation_at(grid, numpy.moveaxis(directions, -1, 0).reshape(3, 1, -1))
        return interpolation.interpolate(values.reshape(1, -1)).reshape(directions.shape[:-1])

    return at


def bore_map(label: str, field: BoreField, marks: list[str]) -> str:
    """Draw a field on a bore with rings every 30°, the rim, body directions and marks on top."""
    line = numpy.linspace(-1.0, 1.0, _POINTS)
    right, up = numpy.meshgrid(line, line)
    values = field.at(from_page(2 * sin(field.reach / 2) * right, 2 * sin(field.reach / 2) * up, field.reach))
    levels = levels_of(field.highest)
    contours = Contours(_MIDDLE + _RADIUS * right, _MIDDLE - _RADIUS * up, values)
    shown = contours.bands([1e-3 * field.highest, *levels[1:]])
    rim = f'cx="{_MIDDLE}" cy="{_MIDDLE}" r="{_RADIUS}"'
    name = f"bore-{field.name}"
    parts = [
        f'<clipPath id="{name}"><circle {rim}/></clipPath><circle class="bore" {rim}/>',
        f'<g clip-path="url(#{name})">{"".join(shown)}</g>',
        *_angle_rings(field.reach),
        f'<circle class="rim" {rim}/>',
        *marks,
        *_body_directions(field.cup),
        *scale(levels, field.label, 40, _MAP_WIDTH + 6, _MAP_WIDTH - 80),
    ]
    return svg.picture((_MAP_WIDTH, _MAP_HEIGHT), label, parts)


def _projection(reach: float) -> Callable[[numpy.ndarray], tuple[numpy.ndarray, numpy.ndarray]]:
    """Make the projection of unit vectors in the cup's frame to picture coordinates."""
    size = _RADIUS / (2 * sin(reach / 2))

    def project(directions: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray]:
        right, up = on_page(directions)
        return _MIDDLE + size * right, _MIDDLE - size * up

    return project


def _load_cross(x: float, y: float) -> Iterator[str]:
    """Draw a cross at the direction of the load."""
    lines = f"M{x - 5:.1f},{y - 5:.1f}L{x + 5:.1f},{y + 5:.1f}M{x - 5:.1f},{y + 5:.1f}L{x + 5:.1f},{y - 5:.1f}"
    yield f'<path class="halo" d="{lines}"/><path class="cross" d="{lines}"/>'


def _angle_rings(reach: float) -> Iterator[str]:
    for angle in range(30, int(degrees(reach)) - 4, 30):
        radius = _RADIUS * sin(radians(angle) / 2) / sin(reach / 2)
        yield f'<circle class="ring" cx="{_MIDDLE}" cy="{_MIDDLE}" r="{radius:.1f}"/>'
        azimuth = radians(136)
        yield svg.text(_MIDDLE + radius * sin(azimuth), _MIDDLE - radius * cos(azimuth), f"{angle}°", "faint")


def _body_directions(cup: Cup) -> Iterator[str]:
    """Write the body's directions beside the rim of a cup with an orientation, an explicit 0° included."""
    if not cup.oriented:
        return
    x, y, _ = cup.frame
    for name, axis in (("up", 2), ("front", 1)):
        right, up = y[axis], x[axis]
        if (length := hypot(right, up)) > _MIN_IN_PLANE:
            across, above = right / length, up / length
            anchor = "middle" if abs(above) > _MOSTLY_VERTICAL else "start" if across > 0 else "end"
            position = _MIDDLE + (_RADIUS + 8) * across, _MIDDLE - (_RADIUS + 8) * above + 5 - 5 * above
            yield svg.text(*position, name, "tick", anchor)


_BOWL_RINGS, _BOWL_MERIDIANS = 40, 96
_MAX_DRAWN_THICKNESS = 0.8  # of the bore's radius: what is thicker is drawn so thick


def pressed_bowl(contact: OffAxisContact) -> str:
    """Draw the pressure of a contact on its cup in three dimensions, with the load as an arrow."""
    joint, reach = contact.joint, float(contact.model.reach_of(contact.joint))
    polar = numpy.linspace(0.0, reach, _BOWL_RINGS + 1)
    azimuth = 2 * pi * numpy.arange(_BOWL_MERIDIANS) / _BOWL_MERIDIANS
    middles = unit_vectors(((polar[1:] + polar[:-1]) / 2)[:, None], azimuth + pi / _BOWL_MERIDIANS)
    values = shown_pressure(contact, numpy.moveaxis(middles, 0, -1))
    radius = float(joint.socket_radius)
    label = (
        f"the cup in three dimensions with its pressure, up to {shown_maximum(contact):.3g} {FIELD['pressure'].unit}"
    )
    return bowl(
        "cup",
        f"{label}; arrow keys turn it, Home looks into its opening",
        polar=polar.round(5).tolist(),
        meridians=_BOWL_MERIDIANS,
        values=(values / shown_maximum(contact)).round(3).ravel().tolist(),
        outer=1 + min(float(joint.liner_thickness) / radius, _MAX_DRAWN_THICKNESS),
        load=(contact.force_vector / contact.force).tolist(),
        turned=[0.5, -0.35],
    )


def bowl(name: str, label: str, **data: Any) -> str:
    """Return the canvas of a bore that a script draws and rotates.

    Its data are the `polar` edges of its rings in rad, `meridians`, `values` of its cells from 0 to 1, the `outer`
    radius over that of the bore, where the `load` points, and how it is `turned` at first, in rad.
    """
    return (
        f'<canvas class="bowl" data-name="{name}" tabindex="0" role="img" aria-label="{escape(label)}" '
        f"data-bowl='{json.dumps(data, separators=(',', ':'))}'></canvas>"
    )
