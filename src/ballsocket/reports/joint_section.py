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

_MASSIVE = 0.8  # of the socket's radius is drawn of what has no end
_ROUND = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
_WIDEST_GAP = 0.09  # of the socket's radius, beside the ball


def radii_of(joint: Joint) -> list[float]:
    """Radii in mm of the bore, and from there outwards behind the liner and each layer."""
    bore = float(joint.socket_radius)
    thick = (float(each) for each in (joint.liner_thickness, *(layer.thickness for layer in joint.backing)))
    return list(accumulate((_MASSIVE * bore if isinf(each) else each for each in thick), initial=bore))


def gap_factor(joint: Joint) -> int:
    """How many times the gap between ball and socket is drawn: a round number, so that it can be seen."""
    gap = abs(float(joint.clearance))
    fitting = [times for times in _ROUND if times * gap <= _WIDEST_GAP * float(joint.socket_radius)]
    return fitting[-1] if fitting and gap > 0 else 1


_LAYERS = (SKY, GREY, ORANGE, GREEN, PINK, BLUE)
_LINE = {"color": INK, "linewidth": 0.8}


def joint_section(joint: Joint, cup: Cup, contact: Contact | None = None, units: Units = Units.SI) -> Figure:
    """Ball, liner and backing, head, bore and outside with their diameters, the clearance as many times as is said.

    Parameters
    ----------
    joint : Joint
        Of plain numbers.
    cup : Cup
        Its arc of cover is drawn.
    contact : Contact, optional
        What is painted on the liner: the pressure up to its edge, and its load.
    units : Units
        Of the lengths.

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
    _bodies(axes, joint, cup, contact, radii, times)
    _diameters(axes, joint, radii, units)
    _named(axes, joint, cup, radii, units)
    if contact is not None:
        _loaded(axes, joint, contact, units)
    text = f"diametral clearance {units.length(2 * joint.clearance)}, drawn {times:g} times as wide"
    axes.text(0.0, -1.1 * radii[-1], text, ha="center", va="top", fontsize=9)
    return figure


def _polar(radius: float | numpy.ndarray, angle: float | numpy.ndarray) -> Points:
    """From the pole, which lies below."""
    return radius * numpy.sin(angle), -radius * numpy.cos(angle)


def _between(inner: Points, outer: Points) -> Points:
    """The outline of what lies between two arcs."""
    return numpy.append(inner[0], outer[0][::-1]), numpy.append(inner[1], outer[1][::-1])


def _bodies(axes: Axes, joint: Joint, cup: Cup, contact: Contact | None, radii: list[float], times: float) -> None:
    around = numpy.linspace(-cup.rim, cup.rim, 200)
    for number, (inner, outer) in enumerate(pairwise(radii)):
        colour = _LAYERS[number % len(_LAYERS)]
        axes.fill(*_between(_polar(inner, around), _polar(outer, around)), facecolor=colour, edgecolor=INK, alpha=0.55)
    sunk = 0.0 if contact is None else float(contact.indentation)
    whole = numpy.linspace(0.0, 2 * pi, 200)
    radius, drop = radii[0] - times * float(joint.clearance), times * (float(joint.clearance) + sunk)
    x, y = _polar(radius, whole)
    axes.fill(x, y - drop, facecolor="white", edgecolor=INK, linewidth=1.2)


def _diameters(axes: Axes, joint: Joint, radii: list[float], units: Units) -> None:
    """Above the ball, one over the other."""
    listed = [("head", float(joint.ball_radius)), ("bore", radii[0]), ("outside", float(joint.outer_radius))]
    step = 0.13 * radii[-1]
    for number, (name, radius) in enumerate(each for each in listed if not isinf(each[1])):
        level = radii[0] + (number + 0.8) * step
        axes.annotate("", (-radius, level), (radius, level), arrowprops={"arrowstyle": "<|-|>", **_LINE})
        for side in (-radius, radius):
            axes.plot([side, side], [0.0, level + 0.2 * step], color=GREY, linewidth=0.6)
        axes.text(0.0, level, f"{name} ⌀ {units.length(2 * radius)}", ha="center", va="bottom", fontsize=9)


def _named(axes: Axes, joint: Joint, cup: Cup, radii: list[float], units: Units) -> None:
    """The layers by name, from the bore outwards, with lines that lead to them."""
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


def _loaded(axes: Axes, joint: Joint, contact: Contact, units: Units) -> None:
    """The pressure within the arc of the contact, and the load's arrow."""
    radius, edge = float(joint.socket_radius), float(contact.half_angle)
    if not edge > 0:
        return
    angle = edge * numpy.sin(numpy.linspace(-pi / 2, pi / 2, 81))
    pressure = numpy.asarray(contact.pressure(numpy.abs(angle)))
    high = 0.5 * min(float(joint.liner_thickness), 0.5 * radius) * pressure / float(contact.max_pressure)
    axes.fill(*_between(_polar(radius, angle), _polar(radius + high, angle)), color=VERMILLION, alpha=0.85)
    arrow = {"arrowstyle": "-|>", "color": VERMILLION, "linewidth": 2.0}
    axes.annotate("", (0.0, -0.15 * radius), (0.0, 0.55 * radius), arrowprops=arrow)
    axes.text(
        0.06 * radius, 0.4 * radius, units.told(CONTACT["force"], float(contact.force)), color=VERMILLION, fontsize=10
    )
