"""Pictures of a bore with a field on it, flat and in three dimensions."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from math import cos, degrees, hypot, pi, radians, sin
from typing import Any

import numpy
from scipy.interpolate import RegularGridInterpolator

from ...core.quantities import DERIVED, FIELD
from ...elasticity.off_axis.contact import OffAxisContact
from ...elasticity.off_axis.directions import unit_vectors
from ...elasticity.off_axis.grid import Grid
from ...hip.ball_wear import interpolation_at
from ...problem import Joint
from ...problem.cup import Cup, Side
from ...reports import svg
from ...reports.cup_map import from_page, on_page, shown_maximum, shown_pressure
from ...reports.svg import Contours, heat, levels_between, scale
from ..widgets.reading import Reading

METRIC = Reading()  # mm, N, MPa and degrees
CELLS_EDGE = 0.03  # share of the highest value from which values on cells are drawn: their edge is no sharper
_MAP_WIDTH, _MIDDLE, _RADIUS, _MAP_HEIGHT = 400.0, 200.0, 140.0, 420.0
_TOP = 30.0  # of the picture: above are neither bore nor directions
_RIM = f'cx="{_MIDDLE}" cy="{_MIDDLE}" r="{_RADIUS}"'
_POINTS = 181
_MOSTLY_VERTICAL = 0.7
_MIN_IN_PLANE = 0.3  # of a unit vector: one that points more steeply out of the picture is not drawn
_RINGS, _MERIDIANS = 96, 256
_FULL = 255
_MAX_LINER, _MAX_BACKING = 0.8, 0.4  # of the bore's radius: thicker layers are drawn so thick


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreField:
    """Values on a bore up to the angle `reach`, drawn from the share `least` of the highest value.

    `at` takes unit vectors (..., 3) of the cup's frame.
    """

    name: str
    at: Callable[[numpy.ndarray], numpy.ndarray]
    highest: float
    label: str
    reach: float
    cup: Cup
    least: float = 1e-3


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
    edge = svg.closed(*_project(reach, contact.outline))
    marks = [f'<path class="patch" d="{edge}"/>']
    if numpy.isfinite(contact.max_pressure):
        x, y = map(float, _project(reach, contact.max_pressure_at))
        marks.append(f'<circle class="most" cx="{x:.1f}" cy="{y:.1f}" r="5"/>')
    highest = reading.with_unit(FIELD["pressure"], shown_maximum(contact))
    distance = reading.with_unit(DERIVED["edge_distance"], float(contact.edge_distance))
    label = f"pressure on the cup seen from its opening, up to {highest}; the contact ends {distance} from the rim"
    return bore_map(label, field, contact.force_vector / (contact.force or 1.0), marks)


def grid_field(grid: Grid, values: numpy.ndarray) -> Callable[[numpy.ndarray], numpy.ndarray]:
    """Make a function of directions (..., 3) from the cell values (rings, meridians) of a grid."""

    def at(directions: numpy.ndarray) -> numpy.ndarray:
        interpolation = interpolation_at(grid, numpy.moveaxis(directions, -1, 0).reshape(3, 1, -1))
        return interpolation.interpolate(values.reshape(1, -1)).reshape(directions.shape[:-1])

    return at


def node_field(nodes: numpy.ndarray, reach: float) -> Callable[[numpy.ndarray], numpy.ndarray]:
    """Make a function of directions (..., 3) from values (rings + 1, meridians) at `node_directions`."""
    meridians = nodes.shape[1]
    azimuth = 2 * pi * (numpy.arange(-1, meridians + 1) + 0.5) / meridians
    around = numpy.concatenate([nodes[:, -1:], nodes, nodes[:, :1]], axis=1)
    values = RegularGridInterpolator((numpy.linspace(0.0, reach, len(nodes)), azimuth), around)

    def at(directions: numpy.ndarray) -> numpy.ndarray:
        x, y, z = numpy.moveaxis(directions, -1, 0)
        polar = numpy.minimum(numpy.arccos(numpy.clip(z, -1.0, 1.0)), reach)
        return numpy.asarray(values(numpy.stack([polar, numpy.arctan2(y, x) % (2 * pi)], axis=-1)))

    return at


def bore_map(label: str, field: BoreField, load: numpy.ndarray, further_marks: Iterable[str] = ()) -> str:
    """Draw a field on a bore with rings every 30°, the rim, body directions and marks.

    A cross is at the direction of the load (3,), if that is not zero.
    """
    line = numpy.linspace(-1.0, 1.0, _POINTS)
    right, up = numpy.meshgrid(line, line)
    values = field.at(from_page(2 * sin(field.reach / 2) * right, 2 * sin(field.reach / 2) * up, field.reach))
    levels = levels_between(0.0, field.highest)
    contours = Contours(_MIDDLE + _RADIUS * right, _MIDDLE - _RADIUS * up, values)
    name, bands = f"bore-{field.name}", contours.bands([field.least * field.highest, *levels[1:]])
    clip = f'<clipPath id="{name}"><circle {_RIM}/></clipPath><g clip-path="url(#{name})">{"".join(bands)}</g>'
    scale_bar = scale(levels, field.label, 60, _MAP_HEIGHT - 34, _MAP_WIDTH - 120)
    return _bore_picture(
        label, field.cup, field.reach, clip, [*_load_cross(field.reach, load), *further_marks, *scale_bar]
    )


def bare_bore(cup: Cup, reach: float) -> str:
    """Draw a bore without a field, for a result that is being prepared."""
    words = svg.text(_MIDDLE, _MIDDLE + 70, "Preparing ...", "label")
    return _bore_picture("the pressure on the cup is being prepared", cup, reach, "", [words])


def _bore_picture(label: str, cup: Cup, reach: float, field: str, marks: Iterable[str]) -> str:
    rings, azimuth = [], radians(136)
    for angle in range(30, int(degrees(reach)) - 4, 30):
        radius = _RADIUS * sin(radians(angle) / 2) / sin(reach / 2)
        x, y = _MIDDLE + radius * sin(azimuth), _MIDDLE - radius * cos(azimuth)
        rings.append(f'<circle class="ring" cx="{_MIDDLE}" cy="{_MIDDLE}" r="{radius:.1f}"/>')
        rings.append(svg.text(x, y, f"{angle}°", "faint"))
    rim, bore = f'<circle class="rim" {_RIM}/>', f'<circle class="bore" {_RIM}/>'
    parts = [bore, field, *rings, rim, *marks, *_body_directions(cup)]
    inside = f'<g transform="translate(0 {-_TOP:g})">{"".join(parts)}</g>'
    return svg.picture((_MAP_WIDTH, _MAP_HEIGHT - _TOP), label, [inside])


def _project(reach: float, directions: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Project unit vectors in the cup's frame to picture coordinates."""
    size = _RADIUS / (2 * sin(reach / 2))
    right, up = on_page(directions)
    return _MIDDLE + size * right, _MIDDLE - size * up


def _load_cross(reach: float, load: numpy.ndarray) -> list[str]:
    if not numpy.any(load):
        return []
    x, y = map(float, _project(reach, load))
    lines = f"M{x - 5:.1f},{y - 5:.1f}L{x + 5:.1f},{y + 5:.1f}M{x - 5:.1f},{y + 5:.1f}L{x + 5:.1f},{y - 5:.1f}"
    return [f'<path class="halo" d="{lines}"/><path class="cross" d="{lines}"/>']


def _body_directions(cup: Cup) -> Iterator[str]:
    """Write the body's directions beside the rim of a cup with an orientation, an explicit 0° included."""
    if not cup.oriented:
        return
    x, y, _ = cup.frame
    for name, axis in (("up", 2), ("anterior", 1)):
        right, up = y[axis], x[axis]
        if (length := hypot(right, up)) > _MIN_IN_PLANE:
            across, above = right / length, up / length
            anchor = "middle" if abs(above) > _MOSTLY_VERTICAL else "start" if across > 0 else "end"
            position = _MIDDLE + (_RADIUS + 8) * across, _MIDDLE - (_RADIUS + 8) * above + 5 - 5 * above
            yield svg.text(*position, name, "tick", anchor)


def pressed_viewer(contact: OffAxisContact, reading: Reading = METRIC) -> str:
    """Show the pressure of a contact on its cup in three dimensions, with the load as an arrow."""
    joint, cup, reach = contact.joint, contact.model.cup, float(contact.model.reach_of(contact.joint))
    unit = reading.unit(FIELD["pressure"])
    levels = levels_between(0.0, unit.factor * shown_maximum(contact))
    directions = numpy.moveaxis(node_directions(reach, _RINGS, _MERIDIANS), 0, -1)
    cells = relative_bytes(unit.factor * shown_pressure(contact, directions), levels[-1])
    return viewer(
        "cup",
        f"pressure on the cup, up to {reading.with_unit(FIELD['pressure'], shown_maximum(contact))}",
        colour_scale(levels, reading.label(FIELD["pressure"])),
        **shape_of(joint, cup, reach, _RINGS, _MERIDIANS),
        bytes=b64encode(cells.tobytes()).decode("ascii"),
        loads=[(contact.force_vector / (contact.force or 1.0)).round(4).tolist()],
        sizes=[float(contact.force != 0)],
        gain=1.0,
        outline=contact.outline.round(4).tolist(),
        film=False,
    )


def node_directions(reach: float, rings: int, meridians: int) -> numpy.ndarray:
    """Return unit vectors (3, rings + 1, meridians) of the nodes of a viewer's field, from the dome to the rim."""
    azimuth = 2 * pi * (numpy.arange(meridians) + 0.5) / meridians
    return numpy.asarray(unit_vectors(numpy.linspace(0.0, reach, rings + 1)[:, None], azimuth))


def relative_bytes(values: numpy.ndarray, highest: float) -> numpy.ndarray:
    """Return values from 0 to `highest` as bytes."""
    return numpy.rint(_FULL * numpy.clip(values / (highest or 1.0), 0.0, 1.0)).astype(numpy.uint8)


def shape_of(joint: Joint, cup: Cup, reach: float, rings: int, meridians: int) -> dict[str, Any]:
    """Return radii over that of the bore, body directions in the cup's frame and size of the field of a viewer."""
    radius = float(joint.socket_radius)
    liner = 1 + min(float(joint.liner_thickness) / radius, _MAX_LINER)
    backing = min(sum(float(layer.thickness) for layer in joint.backing) / radius, _MAX_BACKING)
    medial = -1.0 if cup.side is Side.RIGHT else 1.0
    x, y, z = (numpy.array(axis) for axis in cup.frame)
    body = {"medial": medial * numpy.eye(3)[0], "anterior": numpy.eye(3)[1], "up": numpy.eye(3)[2]}
    axes = {name: [round(float(axis @ part), 4) for part in (x, y, z)] for name, axis in body.items()}
    return {
        "reach": round(reach, 5),
        "radii": [round(float(joint.ball_radius) / radius, 5), round(liner, 5), round(liner + backing, 5)],
        "rings": rings,
        "columns": meridians,
        "axes": axes if cup.oriented else {"opening": [0, 0, -1]},
    }


def colour_scale(levels: Sequence[float], label: str) -> str:
    """Return the colours of a viewer with their numbers, from the lowest at the foot."""
    numbers = "".join(f"<span>{level:.4g}</span>" for level in reversed(levels))
    stops = ", ".join(heat(share / 4) for share in range(5))
    bar = f"<i style='background: linear-gradient(to top, {stops})'></i>"
    return f"<div class='scale-bar'><b>{escape(label)}</b><div>{bar}<p>{numbers}</p></div></div>"


def viewer(name: str, label: str, scale: str, **data: Any) -> str:
    """Return the element in which a script shows a bore in three dimensions, beside its colour scale.

    Its data are those of `shape_of`, and for each frame the `bytes` of the field at `node_directions`, the direction of
    the load in `loads` and its relative size in `sizes`. `gain` leads from bytes to shares of the colours, `outline` is
    the edge of the contact, and `film` is True for a field that is 0 outside the contact.
    """
    keys = "drag or arrow keys turn it, wheel or + and - zoom, Home looks into its opening"
    return (
        f'<div class="viewer" data-name="{name}" data-label="{escape(label)}; {keys}" '
        f"{svg.attribute('viewer', data)}>{scale}</div>"
    )
