"""Pressure over angle beside force over indentation, of several contacts."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

import numpy

from ..contact import Contact
from ..contact.describe import Column
from ..core.quantities import FIELD
from ..reports.press_plots import force_axes
from ..reports.style import LineStyle
from .chart import Curve, chart, legend
from .pressing import curve, profile, rounded_up
from .reading import Reading


def press_charts(contacts: Mapping[str, Contact], lines: Mapping[str, LineStyle], reading: Reading) -> str:
    """Two charts and their key as HTML: contacts that have an answer, each with the curve of its own model."""
    if not contacts:
        return "<p class='quiet'>No curve to draw.</p>"
    key = legend({name: lines[name] for name in contacts})
    charts = _pressures(contacts, lines, reading), _forces(contacts, lines, reading)
    figures = "".join(f"<figure>{each}</figure>" for each in charts)
    return f"<div class='pair'>{figures}</div><p class='legend'>{key}</p>"


def _pressures(contacts: Mapping[str, Contact], lines: Mapping[str, LineStyle], reading: Reading) -> str:
    angle, pressure = reading.unit(FIELD["angle"]), reading.unit(FIELD["pressure"])
    widest = min(max(float(contact.half_angle) for contact in contacts.values()), pi / 2)
    highest = max(float(contact.max_pressure) for contact in contacts.values())
    return chart(
        "pressure over angle, highest at the pole",
        FIELD["angle"].label(angle),
        FIELD["pressure"].label(pressure),
        {name: _profile(contact, (angle.factor, pressure.factor), lines[name]) for name, contact in contacts.items()},
        (rounded_up(1.02 * widest * angle.factor), rounded_up(1.05 * highest * pressure.factor)),
    )


def _forces(contacts: Mapping[str, Contact], lines: Mapping[str, LineStyle], reading: Reading) -> str:
    axes = depth, force = force_axes(reading.units)
    top = rounded_up(1.2 * max(float(force.values_of(contact)) for contact in contacts.values()))
    largest = top / force.factor
    deepest = max(float(depth.values_of(contact)) for contact in contacts.values())
    return chart(
        "force over indentation",
        depth.label,
        force.label,
        {name: _curve(contact, largest, axes, lines[name]) for name, contact in contacts.items()},
        (rounded_up(1.3 * deepest), top),
    )


def _profile(contact: Contact, turns: tuple[float, float], line: LineStyle) -> Curve:
    angle, pressure = profile(contact)
    trusted = numpy.full(angle.shape, bool(contact.valid))
    return Curve(angle * turns[0], pressure * turns[1], trusted, line)


def _curve(contact: Contact, largest: float, axes: tuple[Column, Column], line: LineStyle) -> Curve:
    depth, force = axes
    mark = (float(depth.values_of(contact)), float(force.values_of(contact)))
    press = curve(contact, largest)
    if press is None:
        return Curve(numpy.empty(0), numpy.empty(0), numpy.empty(0, dtype=bool), line, mark)
    return Curve(depth.values_of(press), force.values_of(press), numpy.asarray(press.valid), line, mark)
