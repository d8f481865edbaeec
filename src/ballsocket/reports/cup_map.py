"""Map of the pressure on a cup, seen from its opening, in an equal-area projection.

Angles from the dome's pole go from the middle outwards, the cup's x, towards which it is inclined, upwards.
"""

from __future__ import annotations

from math import cos, degrees, hypot, pi, radians, sin
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.quantities import CONTACT, FIELD
from ..core.unit_systems import Units
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.directions import unit_vectors
from .style import INK, VERMILLION

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.contour import ContourSet

BORE = "0.92"  # colour of a bore without pressure

_POINTS = 321
_LEVELS = 8
_CIRCLE = numpy.linspace(0.0, 2 * pi, 181)
_NEAR_RIM = 3  # ring widths from an edge that digs in, within which the pressure depends on the grid
_CUT = 0.12  # share of the largest pressure; lower values outside the contact's outline come from cut cells
_TEXT_RADIUS, _FRAME_RADIUS = 1.04, 1.14  # relative to the rim's radius on the page
_SEEN = 0.3  # least length of a drawn projection of a unit vector


def on_page(directions: Numbers) -> tuple[Numbers, Numbers]:
    """Project unit vectors (..., 3) of the cup's frame to right and up on the page; the equator is at sqrt(2)."""
    x, y, z = numpy.moveaxis(numpy.asarray(directions, dtype=float), -1, 0)
    scale = numpy.sqrt(2 / numpy.maximum(1 + z, 1e-12))
    return y * scale, x * scale


def shown_maximum(contact: OffAxisContact) -> float:
    """Return the largest pressure (MPa) that a figure shows, without the end of a bore that digs in."""
    if numpy.isfinite(contact.max_pressure):
        return float(contact.max_pressure)
    polar, _, pressure = contact.pressure_map
    inside = polar < polar[-1] - _NEAR_RIM * contact.model.ring_width
    return float(pressure[inside].max()) or float(pressure.max())


def shown_pressure(contact: OffAxisContact, directions: Numbers) -> Numbers:
    """Compute the pressure (MPa) in directions (..., 3), without the low ends of cells cut by the contact's edge."""
    from matplotlib.path import Path

    pressure, page = contact.pressure_at(directions), numpy.stack(on_page(directions), axis=-1)
    edge = Path(numpy.stack(on_page(contact.outline), axis=-1))
    inside = edge.contains_points(page.reshape(-1, 2)).reshape(pressure.shape)
    return numpy.where(inside | (pressure > _CUT * shown_maximum(contact)), pressure, 0.0)


def draw_map(axes: Axes, contact: OffAxisContact, units: Units = Units.SI) -> ContourSet:
    """Draw the pressure of one contact with rim, load and largest pressure; return the contours for a colour bar."""
    reach = float(contact.model.reach_of(contact.joint))
    _draw_bore(axes, contact, reach)
    filled = _draw_pressure(axes, contact, reach, units.unit_of(FIELD["pressure"]).factor)
    axes.plot(*on_page(numpy.vstack([contact.outline, contact.outline[:1]])), color=INK, linewidth=1.2)
    _draw_marks(axes, contact, units)
    _draw_body(axes, contact, reach)
    half_width = 2 * sin(reach / 2) * _FRAME_RADIUS
    axes.set(aspect="equal", xlim=(-half_width, half_width), ylim=(-half_width, half_width))
    axes.set_axis_off()
    return filled


def _ring(polar: float) -> tuple[Numbers, Numbers]:
    """Return the circle of one polar angle (rad) on the page."""
    circle = [sin(polar) * numpy.cos(_CIRCLE), sin(polar) * numpy.sin(_CIRCLE), cos(polar) + 0 * _CIRCLE]
    return on_page(numpy.stack(circle, axis=-1))


def _draw_bore(axes: Axes, contact: OffAxisContact, reach: float) -> None:
    """Draw the bore with circles every 30 degrees, its rim and its chamfer."""
    axes.fill(*_ring(reach), facecolor=BORE, zorder=0)
    for angle in range(30, int(degrees(reach)) - 4, 30):
        axes.plot(*_ring(radians(angle)), color="0.7", linewidth=0.6, zorder=1)
        right, up = _ring(radians(angle))
        axes.text(right[68], up[68], f"{angle}°", fontsize=7, color="0.4", ha="center", va="center")
    axes.plot(*_ring(reach), color=INK, linewidth=2.0, label="rim")
    if contact.model.cup.chamfer > 0:
        axes.plot(*_ring(contact.model.cup.rim), color=INK, linewidth=0.8, label="chamfer")


def _draw_pressure(axes: Axes, contact: OffAxisContact, reach: float, factor: float) -> Any:
    """Draw filled contours of the pressure within the rim, times the factor of its unit."""
    from matplotlib.patches import Circle
    from matplotlib.ticker import MaxNLocator

    edge = 2 * sin(reach / 2)
    line = numpy.linspace(-edge, edge, _POINTS)
    grid, maximum = numpy.meshgrid(line, line), factor * shown_maximum(contact)
    pressure = factor * shown_pressure(contact, from_page(*grid, reach))
    ticks = MaxNLocator(_LEVELS).tick_values(0.0, maximum)
    levels = [1e-3 * maximum, *ticks[1:]]
    beyond = "neither" if numpy.isfinite(contact.max_pressure) else "max"
    filled = axes.contourf(*grid, pressure, levels=levels, cmap="viridis", extend=beyond, zorder=1.5)
    inside = numpy.where(numpy.hypot(*grid) <= edge, pressure, numpy.nan)
    lines = axes.contour(*grid, inside, levels=levels[1:], colors="white", linewidths=0.6, zorder=1.6)
    axes.clabel(lines, levels=levels[2::2], fontsize=7, fmt="%g")
    filled.set_clip_path(Circle((0.0, 0.0), edge, transform=axes.transData))
    return filled


def from_page(right: Numbers, up: Numbers, reach: float) -> Numbers:
    """Return unit vectors (..., 3) of points on the page; beyond the rim the nearest point of the rim."""
    polar = numpy.minimum(2 * numpy.arcsin(numpy.minimum(numpy.hypot(right, up) / 2, 1.0)), reach)
    return numpy.moveaxis(unit_vectors(polar, numpy.arctan2(right, up)), 0, -1)


def _draw_marks(axes: Axes, contact: OffAxisContact, units: Units) -> None:
    if contact.force > 0:
        load = on_page(contact.force_vector / contact.force)
        axes.plot(*load, "x", color="white", markersize=8, markeredgewidth=3.6)
        axes.plot(*load, "x", color=INK, markersize=7, markeredgewidth=1.6, linestyle="", label="load")
    if not numpy.isfinite(contact.max_pressure):
        return
    label = f"largest pressure, {units.text_of(CONTACT['max_pressure'], float(contact.max_pressure))}"
    mark: Any = {"markersize": 8, "markerfacecolor": "none", "markeredgecolor": VERMILLION, "markeredgewidth": 2.0}
    axes.plot(*on_page(contact.max_pressure_at), "o", linestyle="", label=label, **mark)


def _draw_body(axes: Axes, contact: OffAxisContact, reach: float) -> None:
    """Write the body's directions beside the rim of a cup with an orientation, an explicit 0° included."""
    cup = contact.model.cup
    if not cup.oriented:
        return
    x, y, _ = cup.frame
    outside = 2 * sin(reach / 2) * _TEXT_RADIUS
    for name, axis in (("up", 2), ("anterior", 1)):
        right, up = y[axis], x[axis]
        length = hypot(right, up)
        if length > _SEEN:
            position = outside * right / length, outside * up / length
            alignment: Any = (
                {"ha": "center", "va": "bottom"}
                if up / length > 0.7
                else {"ha": "left" if right >= 0 else "right", "va": "center"}
            )
            axes.text(*position, name, fontsize=8, color="0.3", **alignment)
