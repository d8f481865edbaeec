"""Mesh and stresses of a finite-element solution in section."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Contact
from ..core.kinds import NEWTONS
from ..core.quantities import FIELD
from ..core.unit_systems import Amount, Sentence, Units
from ..elasticity.finite_elements.model import MeshedContact
from ..model_catalogue import JUDGE, reference
from ..problem.presets import material_label
from . import svg
from .style import BLUE, INK, LEGEND, bytes_by_units, finish, in_matplotlib, line_of, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..elasticity.finite_elements.section import Part, Section

_PLASTIC_EDGE = 1e-4  # plastic strain at the drawn edge of the plastic zone

_MAX_EXTENT = 40.0  # largest distance (mm) behind the bore that is drawn; a massive socket has no end

_BALL_DEPTH = 0.3
"""Depth over the radius to which the stress of the ball is drawn: deeper it depends on how the ball is pushed."""

_MAX_SHARE = 99.5
"""Percentile of the stresses in ball or backing at the end of the colours, which leaves out sharp corners."""

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
    figure.suptitle(Sentence("{}; {}, {} elements", contact.joint.diameters, force, elements), fontsize=10)
    return figure


def section_picture(contact: MeshedContact) -> dict[Units, str]:
    """Draw mesh and von Mises stress in section as SVG of a page with a theme, in each system of units."""
    from matplotlib import rc_context

    figure = new_figure(4.4, 3.4)
    _draw_section(figure, figure.subplots(), contact)
    label = "mesh and von Mises stress in section"
    with rc_context({"svg.fonttype": "none"}):  # text for the font of the page, not outlines
        drawings = bytes_by_units(figure, "svg")
    return {units: svg.themed(drawing, label) for units, drawing in drawings.items()}


def _draw_section(figure: Figure, axes: Axes, contact: MeshedContact) -> None:
    """Draw the mesh at the left and the stress at the right, with a colour bar for each kind of part."""
    section = contact.section
    outermost = max(float(part.position[0].max()) for part in section.parts)
    extent = 1.03 * min(outermost, float(contact.joint.socket_radius) + _MAX_EXTENT)
    for part in section.parts:
        _draw_mesh(axes, part)
    for kind, colours in _SCALES.items():
        parts = [part for part in section.parts if part.name.startswith(kind)]
        if parts:
            highest = _largest_stress(section, kind)
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
    rim = _RIM[len(part.elements)]
    x, y = part.position[:, part.elements[[*rim, rim[0]]]]
    gaps = numpy.full((1, x.shape[1]), numpy.nan)  # between the outlines of elements
    points = [numpy.concatenate([values, gaps]).T.ravel() for values in (-x, y)]
    axes.plot(*points, color="0.45" if part.name == "ball" else BLUE, linewidth=0.25)


def _shown_triangles(part: Part) -> numpy.ndarray:
    """Return triangles (triangles, 3) of nodes in which the stress of a part is drawn: in the ball near its surface."""
    a, b, c, d = part.elements[:4]
    triangles = numpy.concatenate([numpy.stack([a, b, c], -1), numpy.stack([a, c, d], -1)])
    return triangles[_is_shown(part)[triangles].all(axis=-1)]


def _largest_stress(section: Section, kind: str) -> float:
    """Return the von Mises stress (MPa) at the end of the colours of the parts of a kind: liner, ball or backing."""
    if kind == "liner":
        return float(section.peak_stress.von_mises)
    drawn = [part for part in section.parts if part.name.startswith(kind)]
    return max(float(numpy.percentile(part.stress.von_mises[_is_shown(part)], _MAX_SHARE)) for part in drawn)


def _is_shown(part: Part) -> numpy.ndarray:
    """Return True at the nodes whose stress is drawn."""
    radius = numpy.hypot(*part.position)
    return numpy.asarray(radius >= (1 - _BALL_DEPTH) * radius.max() * part.name.startswith("ball"))


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
        label = "" if material is None else material_label(material, "")
        text = f"{part.name}: {label}" if label else part.name
        x, y = part.position[:, nearest]
        arrow = {"arrowstyle": "-", "lw": 0.6, "color": "0.2", "relpos": (1.0, 0.5)}
        where = (0.02, 0.98 - 0.08 * number)
        axes.annotate(text, (-x, y), where, textcoords="axes fraction", fontsize=8, va="top", arrowprops=arrow)
    arc = numpy.degrees(contact.model.cup.arc_of_cover)
    zone = "; line: edge of the plastic zone" if contact.section["liner"].plastic_strain.any() else ""
    axes.set_title(f"arc of cover {arc:.4g}°, outside {joint.support.value}{zone}", fontsize=8)


def _draw_stress(axes: Axes, part: Part, highest: float, colours: str) -> Any:
    """Draw contours of the von Mises stress at the right."""
    from matplotlib.ticker import MaxNLocator
    from matplotlib.tri import Triangulation

    levels = MaxNLocator(_LEVELS).tick_values(0.0, highest)
    mesh = Triangulation(part.position[0], part.position[1], _shown_triangles(part))
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
