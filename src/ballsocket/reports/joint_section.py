"""Joint in section to scale, with the dimensions of a drawing."""

from __future__ import annotations

from itertools import accumulate, pairwise
from math import isinf, pi
from typing import TYPE_CHECKING

import numpy

from ..contact import Contact
from ..core.quantities import CONTACT
from ..problem import Joint
from ..problem.cup import Cup
from .style import BLUE, GREEN, GREY, INK, ORANGE, PINK, SKY, VERMILLION
from .unit_systems import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Points = tuple[numpy.ndarray, numpy.ndarray]

_UNBOUNDED_THICKNESS = 0.8
"""Drawn thickness of an unbounded layer, relative to the socket radius."""

_FACTORS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)

_MAX_GAP = 0.09
"""Largest drawn gap beside the ball, relative to the socket radius."""


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


_LAYERS = (SKY, GREY, ORANGE, GREEN, PINK, BLUE)
_LINE = {"color": INK, "linewidth": 0.8}


def joint_section(joint: Joint, cup: Cup, contact: Contact | None = None, units: Units = Units.SI) -> Figure:
    """Draw ball, liner and backing in section, with diameters, magnified clearance, pressure and load.

    Parameters
    ----------
    joint : Joint
        Joint without axes.
    cup : Cup
        Cup with the arc of cover.
    contact : Contact, optional
        Contact whose pressure and load are drawn.
    units : Units
        Units of the dimensions.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.6, 5.4), layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.axis("off")
    radii, times = radii_of(joint), gap_factor(joint)
    _draw_bodies(axes, joint, cup, contact, radii, times)
    _draw_diameters(axes, joint, radii, units)
    _label_layers(axes, joint, cup, radii, units)
    if contact is not None:
        _draw_load(axes, joint, contact, units)
    text = f"diametral clearance {units.length(2 * joint.clearance)}, drawn {times:g} times as wide"
    axes.text(0.0, -1.1 * radii[-1], text, ha="center", va="top", fontsize=9)
    return figure


def _polar(radius: float | numpy.ndarray, angle: float | numpy.ndarray) -> Points:
    """Return x and y (mm) of a radius (mm) and an angle (rad) from the pole, which is at the bottom."""
    return radius * numpy.sin(angle), -radius * numpy.cos(angle)


def _outline(inner: Points, outer: Points) -> Points:
    """Return the outline of the area between two arcs."""
    return numpy.append(inner[0], outer[0][::-1]), numpy.append(inner[1], outer[1][::-1])


def _draw_bodies(axes: Axes, joint: Joint, cup: Cup, contact: Contact | None, radii: list[float], times: float) -> None:
    """Draw the layers and the ball."""
    angle = numpy.linspace(-cup.rim, cup.rim, 200)
    for number, (inner, outer) in enumerate(pairwise(radii)):
        colour = _LAYERS[number % len(_LAYERS)]
        axes.fill(*_outline(_polar(inner, angle), _polar(outer, angle)), facecolor=colour, edgecolor=INK, alpha=0.55)
    indentation = 0.0 if contact is None else float(contact.indentation)
    circle = numpy.linspace(0.0, 2 * pi, 200)
    radius, drop = radii[0] - times * float(joint.clearance), times * (float(joint.clearance) + indentation)
    x, y = _polar(radius, circle)
    axes.fill(x, y - drop, facecolor="white", edgecolor=INK, linewidth=1.2)


def _draw_diameters(axes: Axes, joint: Joint, radii: list[float], units: Units) -> None:
    """Draw the dimensions of head, bore and outside above the ball."""
    listed = [("head", float(joint.ball_radius)), ("bore", radii[0]), ("outside", float(joint.outer_radius))]
    step = 0.13 * radii[-1]
    for number, (name, radius) in enumerate(item for item in listed if not isinf(item[1])):
        level = radii[0] + (number + 0.8) * step
        axes.annotate("", (-radius, level), (radius, level), arrowprops={"arrowstyle": "<|-|>", **_LINE})
        for side in (-radius, radius):
            axes.plot([side, side], [0.0, level + 0.2 * step], color=GREY, linewidth=0.6)
        axes.text(0.0, level, f"{name} ⌀ {units.length(2 * radius)}", ha="center", va="bottom", fontsize=9)


def _label_layers(axes: Axes, joint: Joint, cup: Cup, radii: list[float], units: Units) -> None:
    """Label the layers with name and thickness, from the bore outwards."""
    parts = [(joint.liner.name or "liner", joint.liner_thickness)]
    parts += [(layer.material.name or "backing", layer.thickness) for layer in joint.backing]
    across, angle = 1.25 * radii[-1], min(0.8 * cup.rim, 1.15)
    for number, (name, thickness) in enumerate(parts):
        x, y = _polar((radii[number] + radii[number + 1]) / 2, angle - 0.14 * number)
        level = float(y) - 0.04 * radii[-1] * number
        axes.plot([float(x), across], [float(y), level], color=INK, linewidth=0.7)
        axes.plot(float(x), float(y), "o", color=INK, markersize=2.5)
        axes.text(1.02 * across, level, f"{name}, {units.length(float(thickness))}", ha="left", va="center", fontsize=9)
    axes.set_xlim(-1.1 * radii[-1], 2.4 * radii[-1])


def _draw_load(axes: Axes, joint: Joint, contact: Contact, units: Units) -> None:
    """Draw the pressure within the arc of the contact, and the load's arrow."""
    radius, edge = float(joint.socket_radius), float(contact.half_angle)
    if not edge > 0:
        return
    angle = edge * numpy.sin(numpy.linspace(-pi / 2, pi / 2, 81))
    pressure = numpy.asarray(contact.pressure(numpy.abs(angle)))
    high = 0.5 * min(float(joint.liner_thickness), 0.5 * radius) * pressure / float(contact.max_pressure)
    axes.fill(*_outline(_polar(radius, angle), _polar(radius + high, angle)), color=VERMILLION, alpha=0.85)
    arrow = {"arrowstyle": "-|>", "color": VERMILLION, "linewidth": 2.0}
    axes.annotate("", (0.0, -0.15 * radius), (0.0, 0.55 * radius), arrowprops=arrow)
    axes.text(
        0.06 * radius,
        0.4 * radius,
        units.text_of(CONTACT["force"], float(contact.force)),
        color=VERMILLION,
        fontsize=10,
    )
