"""A field on the bore of a cup, seen from its opening, as SVG: equal areas of the bore have equal areas there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import cos, degrees, hypot, radians, sin
from typing import Any

import numpy

from ..core.quantities import DERIVED, FIELD
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.grid import Grid
from ..hip.ball_wear import interpolation_at
from ..problem.cup import Cup
from ..reports.cup_map import from_page, on_page, shown_maximum, shown_pressure
from . import svg
from .contours import Contours, levels_of, scale
from .reading import Reading

SHOWN = Reading()
"""mm, N, MPa and degrees."""

_SIZE, _MIDDLE, _RADIUS, _HIGH = 360.0, 180.0, 140.0, 400.0
_POINTS = 181
_STEEP = 0.7
_SEEN = 0.3  # of a unit vector: one that points more steeply out of the picture is not drawn


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreField:
    """Values on a bore, by direction.

    Attributes
    ----------
    name : str
        Of its own among those on the page.
    at : function
        From unit vectors (..., 3) of the cup's frame to values (...).
    highest : float
    label : str
    reach : float
        Where the bore ends, in rad from the dome's pole.
    cup : Cup
        How it stands.
    """

    name: str
    at: Callable[[numpy.ndarray], numpy.ndarray]
    highest: float
    label: str
    reach: float
    cup: Cup


def pressed_bore(contact: OffAxisContact, reading: Reading = SHOWN) -> str:
    """The pressure of one contact with its edge, the load, and where it is largest."""
    reach, unit = float(contact.model.reach_of(contact.joint)), reading.unit(FIELD["pressure"])
    field = BoreField(
        name="cup",
        at=lambda directions: unit.factor * shown_pressure(contact, directions),
        highest=unit.factor * shown_maximum(contact),
        label=reading.label(FIELD["pressure"]),
        reach=reach,
        cup=contact.model.cup,
    )
    place = _places(reach)
    edge = svg.closed(*place(contact.outline))
    marks = [f'<path class="patch" d="{edge}"/>', *_cross(*map(float, place(contact.force_vector / contact.force)))]
    if numpy.isfinite(contact.max_pressure):
        x, y = map(float, place(contact.max_pressure_at))
        marks.append(f'<circle class="most" cx="{x:.1f}" cy="{y:.1f}" r="5"/>')
    said = (
        f"pressure on the cup seen from its opening, up to {reading.said(FIELD['pressure'], shown_maximum(contact))}; "
        f"the contact ends {reading.said(DERIVED['edge_distance'], float(contact.edge_distance))} from the rim"
    )
    return bore_map(said, field, marks)


def worn_bore(field: BoreField, said: str, load: Any) -> str:
    """What is worn of a bore, with a cross where the load (3,) points."""
    return bore_map(said, field, list(_cross(*map(float, _places(field.reach)(load)))))


def cells_of(grid: Grid, values: numpy.ndarray) -> Callable[[numpy.ndarray], numpy.ndarray]:
    """Values of the cells of a grid, (rings, meridians), as a function of directions (..., 3)."""

    def at(directions: numpy.ndarray) -> numpy.ndarray:
        spots = interpolation_at(grid, numpy.moveaxis(directions, -1, 0).reshape(3, 1, -1))
        return spots.interpolate(values.reshape(1, -1)).reshape(directions.shape[:-1])

    return at


def bore_map(said: str, field: BoreField, marks: list[str]) -> str:
    """A field with rings at each 30°, the rim, and where the body's directions point; marks lie on top."""
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
        *_rings(field.reach),
        f'<circle class="rim" {rim}/>',
        *marks,
        *_body(field.cup),
        *scale(levels, field.label, 40, _SIZE + 6, _SIZE - 80),
    ]
    return svg.picture((_SIZE, _HIGH), said, parts)


def _places(reach: float) -> Callable[[numpy.ndarray], tuple[numpy.ndarray, numpy.ndarray]]:
    """From unit vectors of the cup's frame to the picture."""
    size = _RADIUS / (2 * sin(reach / 2))

    def place(directions: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray]:
        right, up = on_page(directions)
        return _MIDDLE + size * right, _MIDDLE - size * up

    return place


def _cross(x: float, y: float) -> Iterator[str]:
    """Where the load points."""
    lines = f"M{x - 5:.1f},{y - 5:.1f}L{x + 5:.1f},{y + 5:.1f}M{x - 5:.1f},{y + 5:.1f}L{x + 5:.1f},{y - 5:.1f}"
    yield f'<path class="halo" d="{lines}"/><path class="cross" d="{lines}"/>'


def _rings(reach: float) -> Iterator[str]:
    for angle in range(30, int(degrees(reach)) - 4, 30):
        radius = _RADIUS * sin(radians(angle) / 2) / sin(reach / 2)
        yield f'<circle class="ring" cx="{_MIDDLE}" cy="{_MIDDLE}" r="{radius:.1f}"/>'
        turn = radians(136)
        yield svg.text(_MIDDLE + radius * sin(turn), _MIDDLE - radius * cos(turn), f"{angle}°", "faint")


def _body(cup: Cup) -> Iterator[str]:
    """Write the body's directions beside the rim of a cup with an orientation, an explicit 0° included."""
    if not cup.oriented:
        return
    x, y, _ = cup.frame
    for name, axis in (("up", 2), ("front", 1)):
        right, up = y[axis], x[axis]
        if (length := hypot(right, up)) > _SEEN:
            across, above = right / length, up / length
            anchor = "middle" if abs(above) > _STEEP else "start" if across > 0 else "end"
            place = _MIDDLE + (_RADIUS + 8) * across, _MIDDLE - (_RADIUS + 8) * above + 5 - 5 * above
            yield svg.text(*place, name, "tick", anchor)
