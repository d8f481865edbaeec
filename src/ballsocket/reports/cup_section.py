"""A cup and its ball cut through in the plane of load and cup's axis, the dome above, and the pressure on the cut."""

from __future__ import annotations

from math import cos, inf, isfinite, sin
from typing import TYPE_CHECKING

import numpy

from ..core.arrays import Numbers
from ..elasticity.off_axis.contact import OffAxisContact
from ..problem import Support
from .cup_map import highest
from .style import BLUE, INK, ORANGE, VERMILLION

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_BALL, _SOLIDS = "0.9", ("#f3e6c4", "#cfd8de", "#e7d9cc", "#dcdcdc")
_THICKEST = 0.8  # of the bore's radius: what is thicker is drawn so thick
_BAND = 0.45  # of the bore's radius: the largest pressure
_BACK = 0.08  # of the bore's radius: what is rigid


def draw_section(axes: Axes, contact: OffAxisContact) -> None:
    """Draw the ball, the liner and what is behind it, the pressure as a band on the bore, the rim and the load."""
    joint, radius = contact.joint, float(contact.joint.socket_radius)
    outer = _draw_socket(axes, contact, radius)
    _draw_ball(axes, contact)
    _draw_pressure(axes, contact, radius)
    _draw_margin(axes, contact, radius)
    _draw_load(axes, contact, float(joint.ball_radius))
    axes.axvline(0.0, color="0.5", linewidth=0.6, linestyle=(0, (8, 3, 2, 3)), zorder=0.5)
    axes.set_aspect("equal")
    axes.set_xlim(-1.04 * outer, 1.04 * outer)
    axes.set_xlabel("across the cup's axis [mm]")
    axes.set_ylabel("along the cup's axis [mm]")
    axes.spines[["top", "right"]].set_visible(False)


def lateral(contact: OffAxisContact) -> Numbers:
    """The unit vector across the cup's axis in the plane of axis and load; the cup's x under a load along the axis."""
    x, y, _ = contact.force_vector
    size = numpy.hypot(x, y)
    if size <= 1e-9 * contact.force:
        return numpy.array([1.0, 0.0, 0.0])
    return numpy.array([x / size, y / size, 0.0])


def _arc(radius: float, start: float, end: float) -> Numbers:
    """Points (n, 2) from one polar angle to another."""
    angle = numpy.linspace(start, end, 181)
    return radius * numpy.stack([numpy.sin(angle), numpy.cos(angle)], axis=-1)


def _draw_socket(axes: Axes, contact: OffAxisContact, radius: float) -> float:
    """All layers from the liner outwards; the radius of the outermost."""
    joint, cup = contact.joint, contact.model.cup
    thicknesses = [float(joint.liner_thickness), *(float(layer.thickness) for layer in joint.backing)]
    end, rim, inner = float(contact.model.reach_of(joint)), cup.rim, radius
    edge = radius + cup.chamfer
    for number, thickness in enumerate(thicknesses):
        outer = inner + min(thickness, _THICKEST * radius)
        bore = (
            [_arc(inner, -end, end)] if number else [_corner(edge, -rim), _arc(radius, -end, end), _corner(edge, rim)]
        )
        shape = numpy.vstack([*bore, _arc(outer, rim, -rim)])
        axes.fill(*shape.T, facecolor=_SOLIDS[number % len(_SOLIDS)], edgecolor=INK, linewidth=0.9)
        inner, end = outer, rim
    if joint.support is Support.FIXED and thicknesses[-1] < inf:
        shape = numpy.vstack([_arc(inner, -rim, rim), _arc(inner + _BACK * radius, rim, -rim)])
        axes.fill(*shape.T, facecolor="none", edgecolor="0.5", hatch="//////", linewidth=0.0)
        inner += _BACK * radius
    return inner


def _corner(radius: float, angle: float) -> Numbers:
    return radius * numpy.array([[sin(angle), cos(angle)]])


def _draw_ball(axes: Axes, contact: OffAxisContact) -> None:
    from matplotlib.patches import Circle

    middle = float(contact.displacement @ lateral(contact)), float(contact.displacement[2])
    axes.add_patch(Circle(middle, float(contact.joint.ball_radius), facecolor=_BALL, edgecolor=INK, linewidth=0.9))


def _draw_pressure(axes: Axes, contact: OffAxisContact, radius: float) -> None:
    """Inwards from the bore, so that it leaves the layers to be seen."""
    end, most = float(contact.model.reach_of(contact.joint)), highest(contact)
    angle = numpy.linspace(-end, end, 721)
    out = numpy.stack([numpy.sin(angle), numpy.cos(angle)], axis=-1)
    along = out[:, :1] * lateral(contact) + out[:, 1:] * numpy.array([0.0, 0.0, 1.0])
    share = numpy.minimum(contact.pressure_at(along) / most, 1.15)
    foot, top = radius * out, radius * (1 - _BAND * share)[:, None] * out
    axes.fill(*numpy.vstack([foot, top[::-1]]).T, facecolor=BLUE, alpha=0.45, linewidth=0.0, zorder=2.5)
    axes.plot(*top[share > 0].T, color=BLUE, linewidth=1.5, label="pressure on the cut")


def _draw_margin(axes: Axes, contact: OffAxisContact, radius: float) -> None:
    """The bore from the edge of the contact to the rim, or the rim that is loaded."""
    end = float(contact.model.reach_of(contact.joint))
    if contact.edge_loaded:
        said = "contact at the rim" if isfinite(contact.max_pressure) else "contact at the rim: unbounded pressure"
        axes.plot(*_corner(radius, end).T, "s", color=VERMILLION, markersize=6, label=said)
        return
    said = f"{contact.edge_distance:.1f} mm from contact to rim"
    axes.plot(*_arc(radius, end - float(contact.edge_margin), end).T, color=ORANGE, linewidth=3.0, label=said)


def _draw_load(axes: Axes, contact: OffAxisContact, length: float) -> None:
    """From the ball's centre half of the way to where it presses; a preloaded ball at rest has no load."""
    if contact.force == 0:
        return
    load = contact.force_vector / contact.force
    tip = 0.5 * length * float(load @ lateral(contact)), 0.5 * length * float(load[2])
    axes.annotate("", tip, (0.0, 0.0), arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 1.8})
    axes.plot(0.0, 0.0, "o", color=INK, markersize=3)
