"""Figures of contacts: pressed joints, and joints in motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy

from ..comparison import force_curves, successful_contacts
from ..contact import Contact
from ..contact.describe import values_of
from ..core import arrays
from ..core.kinds import NEWTONS, Unit
from ..core.quantities import CONTACT, FIELD
from ..core.unit_systems import Amount, Sentence, Units
from ..dynamics.motion import Motion
from ..elasticity.off_axis.contact import OffAxisContact
from ..model_catalogue import reference
from .cup_plots import cup_figure
from .style import LEGEND, THICK, THIN, LineStyle, finish, in_matplotlib, line_of, new_figure, single_axes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..core.arrays import Numbers

FORCE_CURVE = CONTACT["indentation"], CONTACT["force"]
"""Quantities of the axes of a force curve."""


def force_axes(units: Units) -> tuple[Unit, Unit]:
    """Return the units of indentation and force on the axes of a force curve."""
    depth, force = map(units.unit_of, FORCE_CURVE)
    return depth, Unit("kN", 1e-3) if units is Units.SI else force


def press_figure(
    contacts: Mapping[str, Contact],
    curves: Mapping[str, Contact],
    title: str = "",
    lines: Mapping[str, LineStyle] | None = None,
    note: str = "",
    units: Units = Units.SI,
) -> Figure:
    """Draw the pressure over the angle beside the force over the indentation.

    Parameters
    ----------
    contacts : mapping of str to Contact
        One contact without axes for each model: the pressed state.
    curves : mapping of str to Contact
        For each of these models a contact of a 1-D array of loads: its force-indentation curve.
    title : str
        Title; by default the joint of the first contact and its load.
    lines : mapping of str to LineStyle, optional
        Line style of each contact; by default that of the model of its name.
    note : str
        Text above the legend.
    units : Units
        Units of the axes.

    Returns
    -------
    matplotlib.figure.Figure
        Figure; curves outside the validity of their model are thin.
    """
    figure, axes = new_figure(10.0, 4.6), list(zip(FORCE_CURVE, force_axes(units), strict=True))
    pressure = units.unit_of(FIELD["pressure"])
    pressure_axes, force_panel = figure.subplots(1, 2)
    for name, contact in contacts.items():
        line = line_of(name) if lines is None else lines[name]
        style = in_matplotlib(line, THICK if contact.valid else THIN)
        angle = _angles(contact)
        pressure_axes.plot(
            numpy.degrees(angle),
            contact.pressure(angle) * pressure.factor,
            label=f"\u200b{name}" if name.startswith("_") else name,
            **style,
        )
        force_panel.plot(*(arrays.to_numpy(values_of(curves[name], *axis)) for axis in axes), **style)
        force_panel.plot(*(values_of(contact, *axis) for axis in axes), "o", color=line.colour, markersize=4.5)
    finish(pressure_axes, FIELD["angle"].label(), FIELD["pressure"].label(pressure))
    pressure_axes.set_xlim(0.0, 90.0)
    if pressure_axes.dataLim.ymin > -0.02 * pressure_axes.dataLim.ymax:
        pressure_axes.set_ylim(bottom=0.0)
    pressure_axes.set_xticks(range(0, 91, 15))
    finish(force_panel, *(quantity.label(unit) for quantity, unit in axes))
    furthest = [max(values_of(contact, *axis) for contact in contacts.values()) for axis in axes]
    force_panel.set_xlim(0.0, 1.12 * furthest[0] or 1.0)
    force_panel.set_ylim(0.0, 1.6 * furthest[1] or 1.0)
    columns = min(len(contacts), 4)
    legend = figure.legend(loc="outside lower center", ncols=columns, title=note, title_fontsize=8, **LEGEND)
    for text in (*legend.get_texts(), legend.get_title()):
        text.set_parse_math(False)
    figure.suptitle(title or _title(next(iter(contacts.values())), units), fontsize=9, parse_math=False)
    return figure


def _angles(contact: Contact) -> numpy.ndarray:
    """Return polar angles (rad) to just beyond the edge of the contact, dense where the pressure is steep."""
    edge = min(float(contact.half_angle), numpy.pi / 2)
    return edge * numpy.append(numpy.sin(numpy.linspace(0.0, numpy.pi / 2, 200)), 1.0 + 1e-6)


def _title(contact: Contact, units: Units) -> str:
    joint, force = contact.joint, Amount(float(contact.force), NEWTONS)
    ball = "rigid" if joint.ball is None else str(joint.ball)
    return units.sentence(Sentence("{} of {}; ball {}; ● at {}", joint.diameters, str(joint.liner), ball, force))


MAX_CURVES = 7
"""Curves that are distinguishable in one figure."""


def plot(contacts: Mapping[str, Contact], units: Units = Units.SI) -> Figure:
    """Draw single contacts: the pressure over the angle, beside the force over the indentation.

    A contact off the cup's axis that is alone is drawn in its cup. Of many models at most `MAX_CURVES` are drawn, and
    the others are named.

    Raises ValueError: more than one contact of a model, or only failed contacts.
    """
    for contact in contacts.values():
        shape = tuple(getattr(contact.indentation, "shape", ()))
        if shape:
            sizes = " x ".join(map(str, shape))
            raise ValueError(f"a plot shows one contact for each model, got {sizes}; draw several with a study")
    shown = successful_contacts(contacts)
    if not shown:
        raise ValueError("there is nothing to draw: no model has an answer")
    single = next(iter(shown.values())) if len(shown) == 1 else None
    if isinstance(single, OffAxisContact) and single.max_pressure > 0:
        return cup_figure(single, units)
    chosen = select_curves(shown)
    models: Any = {name: contact.model for name, contact in chosen.items()}
    omitted = ", ".join(name for name in shown if name not in chosen)
    note = f"not drawn: {omitted}" if omitted else ""
    return press_figure(chosen, force_curves(chosen, models), note=note, units=units)


def select_curves(contacts: Mapping[str, Contact]) -> dict[str, Contact]:
    """Select at most `MAX_CURVES` contacts: valid ones first, none that coincides with the exact one."""
    if len(contacts) <= MAX_CURVES:
        return dict(contacts)
    exact = contacts.get(reference.name)
    distinct = [name for name, contact in contacts.items() if exact in (None, contact) or not _coincide(contact, exact)]
    chosen = sorted(distinct, key=lambda name: not contacts[name].valid)[:MAX_CURVES]
    return {name: contact for name, contact in contacts.items() if name in chosen}


def _coincide(contact: Contact, exact: Contact) -> bool:
    """Return whether two contacts agree within 0.1 %, so that their curves coincide."""
    ratios = [getattr(contact, name) / getattr(exact, name) for name in ("force", "indentation", "max_pressure")]
    return all(abs(ratio - 1) < 1e-3 for ratio in ratios)


_PARTS = {
    "kinetic_energy": ("moving", "#0072B2"),
    "energy": ("stored", "#009E73"),
    "dissipated_energy": ("lost", "#D55E00"),
}
_DASHES = ("-", "--", "-.", ":")


def energy_balance(motion: Motion) -> Figure:
    """Draw kinetic, stored and dissipated energy over time as a stack, with the total supplied energy as a line."""
    figure, axes = single_axes()
    parts = [getattr(motion, name) for name in _PARTS]
    labels, colours = zip(*_PARTS.values(), strict=True)
    axes.stackplot(1e3 * motion.time, parts, labels=labels, colors=colours, alpha=0.7, linewidth=0)
    supplied = motion.kinetic_energy[0] + motion.energy[0] + motion.dissipated_energy[0] + motion.work
    axes.plot(1e3 * motion.time, supplied, color="black", linewidth=1.0, label="put in")
    finish(axes, "time [ms]", "energy [N mm]")
    axes.set_title(f"balanced to {motion.drift:.0e} of the largest", fontsize=10)
    axes.legend(frameon=False, fontsize=8)
    return figure


def motion_figure(motion: Motion) -> Figure:
    """Draw the path of the ball's centre within its clearance, seen along y, and the force over time."""
    figure = new_figure(9.0, 3.9)
    path_axes, force_panel = figure.subplots(1, 2)
    clearance = float(motion.element.joint.clearance)
    angle = numpy.linspace(0.0, 2 * numpy.pi, 200)
    path_axes.plot(clearance * numpy.sin(angle), clearance * numpy.cos(angle), color="0.4", linewidth=0.8)
    path_axes.plot(motion.position[:, 0], motion.position[:, 2], color="#0072B2", linewidth=0.8)
    path_axes.set_aspect("equal")
    finish(path_axes, "x [mm]", "z [mm]; grey is first touch")
    load = motion.element(motion.position, motion.velocity, motion.spin)
    force_panel.plot(1e3 * motion.time, numpy.linalg.norm(load.force, axis=1), color="#D55E00", linewidth=0.8)
    finish(force_panel, "time [ms]", "force [N]")
    force_panel.set_ylim(bottom=0)
    return figure


def loop_figure(depth: Numbers, forces: dict[str, Numbers]) -> Figure:
    """Draw forces over the indentation, each with the energy (N mm) that its loop dissipates."""
    figure, axes = single_axes()
    for dash, (name, force) in zip(_DASHES * len(forces), forces.items(), strict=False):
        label = Sentence("{}: {} lost", name, Amount(float(numpy.trapezoid(force, depth)), Unit("N mm"), 3))
        axes.plot(1e3 * numpy.asarray(depth), force, dash, label=label)
    finish(axes, "indentation d [µm]", "force [N]")
    axes.legend(frameon=False, fontsize=8)
    return figure
