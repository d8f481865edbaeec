"""A joint in section, to scale, with the pressure painted on its socket."""

from __future__ import annotations

from itertools import pairwise
from math import isinf, pi

import numpy

from ..contact import Contact
from ..io.joint_file import JointFile
from . import svg
from .pressing import profile

_MASSIVE = 0.8  # of the socket's radius is drawn of what has no end
_PETALS = 48
_HIGHEST = 0.45  # of the liner, or of the radius
_SIZE = 340.0

Outline = tuple[numpy.ndarray, numpy.ndarray]


def section(file: JointFile, contact: Contact | None, extent: float | None = None, highest: float | None = None) -> str:
    """Ball, liner, backing and cup as SVG, the load from above; without a contact nothing is painted on it.

    `extent` (mm) and `highest` (MPa) are those of several drawings that are to be compared, this joint's without.
    """
    scale = _SIZE / 2 / (extent or extent_of(file)) / 1.04
    radii = _radii(file)
    names = ["liner", *["backing"] * (len(radii) - 2)]
    layers = [
        _part(_sector(*ends, file.cup.rim), scale, name) for ends, name in zip(pairwise(radii), names, strict=True)
    ]
    depth = 0.0 if contact is None else float(contact.indentation)
    ball = _part(_ball(float(file.joint.ball_radius), float(file.joint.clearance) + depth), scale, "ball")
    painted = [] if contact is None else _painted(file, contact, scale, highest)
    return svg.picture((_SIZE, _SIZE), "the joint in section, to scale", [*layers, ball, *painted])


def _part(outline: Outline, scale: float, name: str) -> str:
    return f'<path class="part {name}" d="{svg.closed(*_placed(outline, scale))}"/>'


def _placed(outline: Outline, scale: float) -> Outline:
    """From mm, upwards from the socket's centre, to the picture."""
    x, y = outline
    return _SIZE / 2 + scale * x, _SIZE / 2 - scale * y


def _painted(file: JointFile, contact: Contact, scale: float, highest: float | None) -> list[str]:
    top = highest or float(contact.max_pressure) or 1.0
    return [
        f'<path fill="{heat(pressure / top)}" d="{svg.closed(*_placed(outline, scale))}"/>'
        for outline, pressure in petals(file, contact)
    ]


_HEAT = numpy.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]])
"""Five colours of viridis, from low to high."""


def heat(share: float) -> str:
    """A colour for a share from 0 to 1."""
    stops = numpy.linspace(0.0, 1.0, len(_HEAT))
    red, green, blue = (round(float(numpy.interp(share, stops, column))) for column in _HEAT.T)
    return f"#{red:02x}{green:02x}{blue:02x}"


def extent_of(file: JointFile) -> float:
    """Half the width of the drawing in mm."""
    return _radii(file)[-1]


def _radii(file: JointFile) -> list[float]:
    """Radii in mm of the bore, and from there outwards behind the liner and each layer."""
    radii = [float(file.joint.socket_radius)]
    for thickness in (file.joint.liner_thickness, *(layer.thickness for layer in file.joint.backing)):
        radii.append(radii[-1] + (_MASSIVE * radii[0] if isinf(float(thickness)) else float(thickness)))
    return radii


def _sector(inner: float, outer: float, rim: float) -> Outline:
    angle = numpy.linspace(-rim, rim, 121)
    x = numpy.concatenate([inner * numpy.sin(angle), outer * numpy.sin(angle[::-1])])
    y = numpy.concatenate([-inner * numpy.cos(angle), -outer * numpy.cos(angle[::-1])])
    return x, y


def _ball(radius: float, drop: float) -> Outline:
    angle = numpy.linspace(0.0, 2 * pi, 121)
    return radius * numpy.sin(angle), radius * numpy.cos(angle) - drop


def petals(file: JointFile, contact: Contact) -> list[tuple[Outline, float]]:
    """Quadrilaterals in the liner up to its rim, in mm, as high as the pressure, each with its pressure in MPa."""
    if not float(contact.half_angle) > 0:
        return []
    radius, edge = float(file.joint.socket_radius), min(float(contact.half_angle), file.cup.rim)
    angle = edge * numpy.sin(numpy.linspace(-pi / 2, pi / 2, _PETALS + 1))
    pressure = numpy.interp(numpy.abs(angle), *profile(contact))
    highest = _HIGHEST * min(float(file.joint.liner_thickness), 0.6 * radius)
    reach = radius + highest * pressure / float(contact.max_pressure)
    corners = numpy.stack([angle[:-1], angle[1:], angle[1:], angle[:-1]], axis=1)
    away = numpy.stack([numpy.full(_PETALS, radius)] * 2 + [reach[1:], reach[:-1]], axis=1)
    x, y = away * numpy.sin(corners), -away * numpy.cos(corners)
    means = (pressure[:-1] + pressure[1:]) / 2
    return [((x[number], y[number]), float(mean)) for number, mean in enumerate(means)]
