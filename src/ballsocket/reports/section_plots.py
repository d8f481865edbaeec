"""Sections: a joint to scale with its dimensions, and the mesh and stresses of a finite-element solution."""

from __future__ import annotations

from itertools import accumulate, pairwise
from math import isinf, pi
from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Contact
from ..core.kinds import NEWTONS
from ..core.quantities import CONTACT, FIELD
from ..core.unit_systems import Amount, Sentence, Units
from ..elasticity.finite_elements.model import MeshedContact
from ..model_catalogue import JUDGE, reference
from ..problem import Joint
from ..problem.cup import Cup
from .style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LEGEND,
    ORANGE,
    PINK,
    SKY,
    VERMILLION,
    finish,
    in_matplotlib,
    line_of,
    new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Points = tuple[numpy.ndarray, numpy.ndarray]
    from ..elasticity.finite_elements.section import Part

_UNBOUNDED_THICKNESS = 0.8  # drawn thickness of an unbounded layer, relative to the socket radius

_FACTORS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)

_MAX_GAP = 0.09  # largest drawn gap beside the ball, relative to the socket radius


_PLASTIC_EDGE = 1e-4  # plastic strain at the drawn edge of the plastic zone


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
    """Draw ball, liner and backing in section, with diameters, magnified clearance, and pressure and load of a contact.

    The joint has no axes, and the cup the arc of cover.
    """
    figure = new_figure(6.6, 5.4)
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.axis("off")
    radii, times = radii_of(joint), gap_factor(joint)
    _draw_bodies(axes, joint, cup, contact, radii, times)
    _draw_diameters(axes, joint, radii, units)
    _label_layers(axes, joint, cup, radii, units)
    if contact is not None:
        _draw_load(axes, joint, contact, units)
    name, fit = joint.fit
    text = f"diametral {name} {units.length(2 * fit)}, drawn {times:g} times as wide"
    axes.text(0.0, -1.1 * radii[-1], text, ha="center", va="top", fontsize=9)
    return figure


def _polar(radius: float | numpy.ndarray, angle: float | numpy.ndarray) -> Points:
    """Return x and y (mm) of a radius (mm) and an angle (rad) from the pole, which is at the bottom."""
    return radius * numpy.sin(angle), -radius * numpy.cos(angle)


def _outline(inner: Points, outer: Points) -> Points:
    return numpy.append(inner[0], outer[0][::-1]), numpy.append(inner[1], outer[1][::-1])


def _draw_bodies(axes: Axes, joint: Joint, cup: Cup, contact: Contact | None, radii: list[float], times: float) -> None:
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
    listed = [("head", float(joint.ball_radius)), ("bore", radii[0]), ("outside", float(joint.outer_radius))]
    step = 0.13 * radii[-1]
    for number, (name, radius) in enumerate(item for item in listed if not isinf(item[1])):
        level = radii[0] + (number + 0.8) * step
        axes.annotate("", (-radius, level), (radius, level), arrowprops={"arrowstyle": "<|-|>", **_LINE})
        for side in (-radius, radius):
            axes.plot([side, side], [0.0, level + 0.2 * step], color=GREY, linewidth=0.6)
        axes.text(0.0, level, f"{name} ⌀ {units.length(2 * radius)}", ha="center", va="bottom", fontsize=9)


def _label_layers(axes: Axes, joint: Joint, cup: Cup, radii: list[float], units: Units) -> None:
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


_RIM = {4: (0, 1, 2, 3), 9: (0, 4, 1, 5, 2, 6, 3, 7)}  # nodes around an element in order, by its number of nodes

_LEVELS = 14
_SCALES = {"backing": "magma", "liner": "viridis", "ball": "cividis"}
"""Colour map of each kind of part; stresses of a shell and of a liner differ by orders of magnitude."""


def section_figure(contact: MeshedContact, exact: Contact | None = None) -> Figure:
    """Draw mesh and von Mises stress in section, to scale, beside the pressure with its error bar.

    Parameters
    ----------
    contact : MeshedContact
        One contact under load.
    exact : Contact, optional
        Exact contact of the same load, drawn in black.

    Raises
    ------
    ValueError
        More than one contact, a contact without load, or a failed one.
    """
    figure = new_figure(11.0, 4.8)
    section_axes, pressure_axes = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    _draw_section(figure, section_axes, contact)
    _draw_pressure(pressure_axes, contact, exact)
    force, elements = Amount(float(contact.force), NEWTONS), str(contact.mesh.elements)
    figure.suptitle(Sentence("{}; {}, {} elements", contact.joint.dimensions, force, elements), fontsize=10)
    return figure


def _draw_section(figure: Figure, axes: Axes, contact: MeshedContact) -> None:
    """Draw the mesh at the left and the stress at the right, with a colour bar for each kind of part."""
    section = contact.section
    outermost = max(float(part.position[0].max()) for part in section.parts)
    extent = 1.03 * min(outermost, float(contact.joint.socket_radius) + 40.0)
    for part in section.parts:
        _draw_mesh(axes, part)
    for kind, colours in _SCALES.items():
        parts = [part for part in section.parts if part.name.startswith(kind)]
        if parts:
            highest = (
                section.peak_stress.von_mises
                if kind == "liner"
                else max(float(numpy.percentile(part.stress.von_mises, 99.5)) for part in parts)
            )
            filled = [_draw_stress(axes, part, highest, colours) for part in parts][-1]
            bar = figure.colorbar(filled, ax=axes, shrink=0.75, pad=0.01, extend="max")
            bar.set_label(f"von Mises stress in the {kind} [MPa]", fontsize=8)
    _name_parts(axes, contact, extent)
    axes.set_aspect("equal")
    low = min(part.position[1].min() for part in section.parts)
    high = max(part.position[1].max() for part in section.parts)
    axes.set_xlim(-extent, extent)
    axes.set_ylim(max(low, -extent) - 1.0, min(high, extent) + 0.1 * extent * (len(section.parts) + 1))
    axes.set(xlabel="distance from the load axis [mm]", ylabel="height [mm]")
    axes.spines[["top", "right"]].set_visible(False)


def _draw_mesh(axes: Axes, part: Part) -> None:
    from matplotlib.collections import PolyCollection

    corners = part.position[:, part.elements[list(_RIM[len(part.elements)])]]
    outlines = numpy.moveaxis(corners * numpy.array([-1.0, 1.0])[:, None, None], (0, 1, 2), (2, 1, 0))
    colour = "0.45" if part.name == "ball" else BLUE
    axes.add_collection(PolyCollection(list(outlines), facecolors="white", edgecolors=colour, linewidths=0.25))


def _name_parts(axes: Axes, contact: MeshedContact, extent: float) -> None:
    """Label each part on the side of the mesh, and state the arc of cover."""
    joint = contact.joint
    materials = {"ball": joint.ball, "liner": joint.liner}
    materials |= {f"backing {number}": layer.material for number, layer in enumerate(joint.backing, start=1)}
    for number, part in enumerate(sorted(contact.section.parts, key=lambda part: part.name != "ball")):
        angle, middle = (
            0.9 * float(part.angle.max()),
            (float(part.radius.min()) + min(float(part.radius.max()), extent)) / 2,
        )
        nearest = numpy.argmin((part.angle - angle) ** 2 * middle**2 + (part.radius - middle) ** 2)
        material = materials[part.name]
        text = f"{part.name}: {material.name}" if material is not None and material.name else part.name
        x, y = part.position[:, nearest]
        arrow = {"arrowstyle": "-", "lw": 0.6, "color": "0.2", "relpos": (1.0, 0.5)}
        where = (0.02, 0.98 - 0.07 * number)
        axes.annotate(text, (-x, y), where, textcoords="axes fraction", fontsize=7, va="top", arrowprops=arrow)
    arc = numpy.degrees(contact.model.cup.arc_of_cover)
    zone = "; line: edge of the plastic zone" if contact.section["liner"].plastic_strain.any() else ""
    axes.set_title(f"arc of cover {arc:.4g}°, outside {joint.support.value}{zone}", fontsize=8)


def _draw_stress(axes: Axes, part: Part, highest: float, colours: str) -> Any:
    """Draw contours of the von Mises stress at the right."""
    from matplotlib.ticker import MaxNLocator
    from matplotlib.tri import Triangulation

    a, b, c, d = part.elements[:4]
    triangles = numpy.concatenate([numpy.stack([a, b, c], -1), numpy.stack([a, c, d], -1)])
    levels = MaxNLocator(_LEVELS).tick_values(0.0, highest)
    mesh = Triangulation(part.position[0], part.position[1], triangles)
    if part.plastic_strain.any():
        axes.tricontour(mesh, part.plastic_strain, levels=[_PLASTIC_EDGE], colors=INK, linewidths=1.2)
    return axes.tricontourf(mesh, part.stress.von_mises, levels=levels, cmap=colours, extend="max")


def _draw_pressure(axes: Axes, contact: MeshedContact, exact: Contact | None) -> None:
    """Draw the pressure over the angle beside the exact one, with the error bar of its largest value."""
    edge = contact.half_angle
    angle = edge * numpy.append(numpy.sin(numpy.linspace(0.0, numpy.pi / 2, 300)), 1 + 1e-6)
    pressure = contact.pressure(angle)
    if exact is not None:
        exact_angle = numpy.linspace(0.0, 1.0, 300) * exact.half_angle * (1 + 1e-6)
        axes.plot(
            numpy.degrees(exact_angle),
            exact.pressure(exact_angle),
            label="exact",
            **in_matplotlib(line_of(reference.name)),
        )
    line = line_of(JUDGE)
    axes.plot(numpy.degrees(angle), pressure, label="finite elements", **in_matplotlib(line))
    error = contact.error["max_pressure"]
    if error > 0:
        bars = {"yerr": error * contact.max_pressure, "capsize": 3, "fmt": "none"}
        axes.errorbar([0.0], [contact.max_pressure], color=line.colour, label=f"p0 ± {100 * error:.1g} %", **bars)
    finish(axes, *(quantity.label() for quantity in FIELD.values()))
    axes.set_xlim(0.0, max(1.08 * numpy.degrees(edge), 5.0))
    axes.set_ylim(bottom=0.0)
    axes.legend(**LEGEND)
