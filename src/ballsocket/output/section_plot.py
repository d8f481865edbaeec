"""Finite elements become a picture: the mesh, the stresses in it, and the pressure beside the exact one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy

from ..catalogue import judge, reference
from ..contact import Contact
from ..fem.contact import MeshedContact
from ..quantities import FIELD
from .style import BLUE, LEGEND, finish, in_matplotlib, line_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..fem.section import Part

_RIM = {4: (0, 1, 2, 3), 9: (0, 4, 1, 5, 2, 6, 3, 7)}
"""The nodes around an element, one after the other."""

_LEVELS = 14


def section_figure(contact: MeshedContact, exact: Contact | None = None) -> Figure:
    """Half mesh, half von Mises stress, to scale; beside it the pressure with its error bar.

    Parameters
    ----------
    contact : MeshedContact
        One contact under load.
    exact : Contact, optional
        The exact answer to the same load, drawn in black.

    Raises
    ------
    ValueError
        More than one contact, or one without load or answer.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    _draw_section(figure, left, contact)
    _draw_pressure(right, contact, exact)
    title = f"{contact.joint.dimensions}; {contact.force:.4g} N, {contact.mesh.elements} elements"
    figure.suptitle(title, fontsize=10)
    return figure


def _draw_section(figure: Figure, axes: Axes, contact: MeshedContact) -> None:
    section = contact.section
    extent = 1.12 * (float(contact.joint.socket_radius) + min(float(contact.joint.liner_thickness), 40.0))
    highest = section.peak_stress.von_mises
    for part in section.parts:
        _draw_mesh(axes, part)
        filled = _draw_stress(axes, part, highest)
    bar = figure.colorbar(filled, ax=axes, shrink=0.75, pad=0.01, extend="max")
    bar.set_label("von Mises stress [MPa], in liner and ball")
    axes.set_aspect("equal")
    low = min(part.place[1].min() for part in section.parts)
    high = max(part.place[1].max() for part in section.parts)
    axes.set_xlim(-extent, extent)
    axes.set_ylim(max(low, -extent) - 1.0, min(high, extent) + 1.0)
    axes.set_xlabel("distance from the load axis [mm]")
    axes.set_ylabel("height [mm]")
    axes.spines[["top", "right"]].set_visible(False)


def _draw_mesh(axes: Axes, part: Part) -> None:
    """The outlines of the elements, on the left."""
    from matplotlib.collections import PolyCollection

    corners = part.place[:, part.elements[list(_RIM[len(part.elements)])]]
    outlines = numpy.moveaxis(corners * numpy.array([-1.0, 1.0])[:, None, None], (0, 1, 2), (2, 1, 0))
    colour = "0.45" if part.name == "ball" else BLUE
    axes.add_collection(PolyCollection(list(outlines), facecolors="white", edgecolors=colour, linewidths=0.25))


def _draw_stress(axes: Axes, part: Part, highest: float) -> Any:
    """Contours of the von Mises stress, on the right."""
    from matplotlib.ticker import MaxNLocator
    from matplotlib.tri import Triangulation

    a, b, c, d = part.elements[:4]
    triangles = numpy.concatenate([numpy.stack([a, b, c], -1), numpy.stack([a, c, d], -1)])
    levels = MaxNLocator(_LEVELS).tick_values(0.0, highest)
    mesh = Triangulation(part.place[0], part.place[1], triangles)
    return axes.tricontourf(mesh, part.stress.von_mises, levels=levels, cmap="viridis", extend="max")


def _draw_pressure(axes: Axes, contact: MeshedContact, exact: Contact | None) -> None:
    edge = contact.half_angle
    angle = edge * numpy.append(numpy.sin(numpy.linspace(0.0, numpy.pi / 2, 300)), 1 + 1e-6)
    pressure = contact.pressure(angle)
    if exact is not None:
        there = numpy.linspace(0.0, 1.0, 300) * exact.half_angle * (1 + 1e-6)
        axes.plot(numpy.degrees(there), exact.pressure(there), label="exact", **in_matplotlib(line_of(reference.name)))
    line = line_of(judge.name)
    axes.plot(numpy.degrees(angle), pressure, label="finite elements", **in_matplotlib(line))
    error = contact.error["max_pressure"]
    if error > 0:
        bars = {"yerr": error * contact.max_pressure, "capsize": 3, "fmt": "none"}
        axes.errorbar([0.0], [contact.max_pressure], color=line.colour, label=f"p0 ± {100 * error:.1g} %", **bars)
    finish(axes, *(each.label() for each in FIELD.values()))
    axes.set_xlim(0.0, max(1.08 * numpy.degrees(edge), 5.0))
    axes.set_ylim(bottom=0.0)
    axes.legend(**LEGEND)
