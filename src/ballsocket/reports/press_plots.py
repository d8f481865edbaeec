"""Figures of pressed joints: pressure over angle beside force over indentation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy

from ..catalogue import reference
from ..compare import force_curves, successful_contacts
from ..contact import Contact
from ..contact.describe import Column
from ..core import arrays
from ..core.kinds import Unit
from ..core.quantities import CONTACT, FIELD
from ..elasticity.off_axis.contact import OffAxisContact
from .cup_plots import cup_figure
from .style import LEGEND, THICK, THIN, LineStyle, finish, in_matplotlib, line_of
from .unit_systems import Units

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORCE_CURVE = (
    Column(CONTACT["indentation"], CONTACT["indentation"].shown),
    Column(CONTACT["force"], Unit("kN", 1e-3)),
)
"""What a curve of forces is drawn over and along."""


def force_axes(units: Units) -> tuple[Column, Column]:
    """Indentation and force in a system of units."""
    if units is Units.SI:
        return FORCE_CURVE
    depth, force = (Column(each.quantity, units.of(each.quantity)) for each in FORCE_CURVE)
    return depth, force


def press_figure(
    contacts: Mapping[str, Contact],
    curves: Mapping[str, Contact],
    title: str = "",
    lines: Mapping[str, LineStyle] | None = None,
    note: str = "",
    units: Units = Units.SI,
) -> Figure:
    """Pressure over angle beside force over indentation.

    Parameters
    ----------
    contacts : mapping of str to Contact
        One contact of plain numbers a model: the pressed state.
    curves : mapping of str to Contact
        For each of these models a contact of a 1-D array of loads: its force-indentation curve.
    title : str
        By default the joint of the first contact, and its load.
    lines : mapping of str to Line, optional
        How each is drawn; by default as the model of that name is drawn everywhere.
    note : str
        What is said above the legend.
    units : Units
        Of the axes.

    Returns
    -------
    matplotlib.figure.Figure
        Curves of models outside their validity are drawn thin.
    """
    from matplotlib.figure import Figure

    figure, axes = Figure(figsize=(10.0, 4.6), layout="constrained"), force_axes(units)
    pressure = units.of(FIELD["pressure"])
    left, right = figure.subplots(1, 2)
    for name, contact in contacts.items():
        line = line_of(name) if lines is None else lines[name]
        style = in_matplotlib(line, THICK if contact.valid else THIN)
        angle = _angles(contact)
        left.plot(numpy.degrees(angle), contact.pressure(angle) * pressure.factor, label=_said(name), **style)
        right.plot(*(arrays.to_numpy(axis.values_of(curves[name])) for axis in axes), **style)
        right.plot(*(axis.values_of(contact) for axis in axes), "o", color=line.colour, markersize=4.5)
    finish(left, FIELD["angle"].label(), FIELD["pressure"].label(pressure))
    left.set_xlim(0.0, 90.0)
    if left.dataLim.ymin > -0.02 * left.dataLim.ymax:
        left.set_ylim(bottom=0.0)
    left.set_xticks(range(0, 91, 15))
    finish(right, *(axis.label for axis in axes))
    furthest = [max(axis.values_of(contact) for contact in contacts.values()) for axis in axes]
    right.set_xlim(0.0, 1.12 * furthest[0] or 1.0)
    right.set_ylim(0.0, 1.6 * furthest[1] or 1.0)
    columns = min(len(contacts), 4)
    legend = figure.legend(loc="outside lower center", ncols=columns, title=note, title_fontsize=8, **LEGEND)
    for text in (*legend.get_texts(), legend.get_title()):
        text.set_parse_math(False)
    figure.suptitle(title or _title(next(iter(contacts.values())), units), fontsize=10, parse_math=False)
    return figure


def _said(name: str) -> str:
    """Matplotlib leaves out what begins with an underscore; names of joints may."""
    return f"\u200b{name}" if name.startswith("_") else name


def _angles(contact: Contact) -> numpy.ndarray:
    """Polar angles up to just beyond the edge of the contact, dense where the pressure falls steeply."""
    edge = min(float(contact.half_angle), numpy.pi / 2)
    return edge * numpy.append(numpy.sin(numpy.linspace(0.0, numpy.pi / 2, 200)), 1.0 + 1e-6)


def _title(contact: Contact, units: Units) -> str:
    joint = contact.joint
    if units is Units.IMPERIAL:
        lengths = {"head": joint.head_diameter, "clearance": joint.diametral_clearance}
        said = ", ".join(f"{name} ⌀ {units.length(float(length))}" for name, length in lengths.items())
        return f"{said}; ● at {units.told(CONTACT['force'], float(contact.force))}"
    ball = "rigid ball" if joint.ball is None else f"ball {float(joint.ball.young) / 1e3:g} GPa"
    return (
        f"{joint.dimensions} of {float(joint.liner.young) / 1e3:g} GPa, "
        f"ν {float(joint.liner.poisson):g}; {ball}; ● at {contact.force:.4g} N"
    )


MOST = 7
"""Curves that can be told from each other in one figure."""


def plot(contacts: Mapping[str, Contact]) -> Figure:
    """The pressure over the angle of single contacts, beside the force over the indentation.

    A contact off the cup's axis that is alone is drawn in its cup. Of many models at most `MOST` are drawn, and the
    others named.

    Raises
    ------
    ValueError
        More than one contact of a model, or none that has an answer.
    """
    for contact in contacts.values():
        shape = tuple(getattr(contact.indentation, "shape", ()))
        if shape:
            many = " x ".join(map(str, shape))
            raise ValueError(f"a plot shows one contact of a model, and here are {many}: a study draws many")
    shown = successful_contacts(contacts)
    if not shown:
        raise ValueError("there is nothing to draw: no model has an answer")
    alone = next(iter(shown.values())) if len(shown) == 1 else None
    if isinstance(alone, OffAxisContact) and alone.max_pressure > 0:
        return cup_figure(alone)
    kept = telling(shown)
    models: Any = {name: contact.model for name, contact in kept.items()}
    return press_figure(kept, force_curves(kept, models), note=_left_out(shown, kept))


def telling(contacts: Mapping[str, Contact]) -> dict[str, Contact]:
    """At most `MOST` of the contacts: those that can be trusted first, and none that lies on the exact one."""
    if len(contacts) <= MOST:
        return dict(contacts)
    exact = contacts.get(reference.name)
    apart = [name for name, contact in contacts.items() if exact in (None, contact) or not _same(contact, exact)]
    first = sorted(apart, key=lambda name: not contacts[name].valid)[:MOST]
    return {name: contact for name, contact in contacts.items() if name in first}


def _same(contact: Contact, exact: Contact) -> bool:
    """Whether two curves would lie on each other."""
    ratios = [getattr(contact, name) / getattr(exact, name) for name in ("force", "indentation", "max_pressure")]
    return all(abs(ratio - 1) < 1e-3 for ratio in ratios)


def _left_out(shown: Iterable[str], kept: Mapping[str, Contact]) -> str:
    names = [name for name in shown if name not in kept]
    return f"not drawn: {', '.join(names)}" if names else ""
