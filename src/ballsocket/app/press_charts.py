"""Pressure over angle beside force over indentation, of several contacts."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

import numpy

from ..contact import Contact
from ..output.press_plot import FORCE_CURVE
from ..output.quick_plot import MOST
from ..output.style import Line
from ..quantities import FIELD
from .curves import Curve, CurveChart
from .look import Palette
from .pressing import curve, rounded_up
from .words import unit_of

_ANGLES = numpy.sin(numpy.linspace(0.0, pi / 2, 60))


class PressCharts:
    """Two charts."""

    def __init__(self, palette: Palette) -> None:
        depth, force = FORCE_CURVE
        self._pressure = CurveChart("", FIELD["pressure"].label(), palette, ("0.00", "0.00"))
        self._force = CurveChart(depth.label, force.label, palette, ("0.0", "0.00"))
        self._force.legend.visible = False  # that of the pressure says it
        self.figures = (self._pressure.figure, self._force.figure)

    def show(self, contacts: Mapping[str, Contact], lines: Mapping[str, Line], angle: str) -> None:
        """Draw contacts that have an answer, each with the curve of its own model; angles in "degrees" or "radians"."""
        unit = unit_of(FIELD["angle"], angle)
        self._pressure.figure.xaxis.axis_label = FIELD["angle"].label(unit)
        if not contacts:
            self._pressure.show({}, 1.0, 1.0)
            self._force.show({}, 1.0, 1.0)
            return
        self._pressure.legend.visible = len(contacts) <= MOST  # else it covers curves, and the table below says it
        each = contacts.values()
        widest = min(max(float(contact.half_angle) for contact in each), pi / 2)
        highest = max(float(contact.max_pressure) for contact in each)
        profiles = {name: _profile(contact, unit.factor, lines[name]) for name, contact in contacts.items()}
        self._pressure.show(profiles, rounded_up(1.02 * widest * unit.factor), rounded_up(1.05 * highest))
        largest = rounded_up(1.2 * max(float(contact.force) for contact in each))
        depth, force = FORCE_CURVE
        deepest = max(float(depth.of(contact)) for contact in each)
        curves = {name: _curve(contact, largest, lines[name]) for name, contact in contacts.items()}
        self._force.show(curves, rounded_up(1.3 * deepest), largest * force.factor)


def _profile(contact: Contact, turn: float, line: Line) -> Curve:
    angle = min(float(contact.half_angle), pi / 2) * _ANGLES
    trusted = numpy.full(angle.shape, bool(contact.valid))
    return Curve(angle * turn, numpy.asarray(contact.pressure(angle)), trusted, line)


def _curve(contact: Contact, largest: float, line: Line) -> Curve:
    depth, force = FORCE_CURVE
    mark = (float(depth.of(contact)), float(force.of(contact)))
    press = curve(contact, largest)
    if press is None:
        return Curve(numpy.empty(0), numpy.empty(0), numpy.empty(0, dtype=bool), line, mark)
    return Curve(depth.of(press), force.of(press), numpy.asarray(press.valid), line, mark)
