"""Presses of the joint on the screen, cached, with their curves and charts."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from math import ceil, log10, pi

import numpy

from ..catalogue import catalogue
from ..compare import Comparison, compare, force_curves
from ..contact import Contact, Model
from ..contact.describe import Column
from ..core.quantities import FIELD
from ..core.validity import OutsideDomainError
from ..files.joint_file import JointFile
from ..problem import Joint
from ..problem.cup import Cup
from ..reports.press_plots import force_axes
from ..reports.style import LineStyle
from .pictures.chart import Curve, chart, legend
from .solving import RecordedContact, heavy, solved
from .widgets.reading import Reading

_POINTS = numpy.linspace(0.0, 1.0, 17) ** 1.5
_ANGLES = numpy.sin(numpy.linspace(0.0, pi / 2, 60))


def pressed(file: JointFile, names: tuple[str, ...]) -> Comparison:
    """Press a joint by several models; slow models have a result once `solving` has finished."""
    slow = [name for name in names if heavy(file.joint, name)]
    quick = tuple(name for name in names if name not in slow)
    quick_results = _pressed(file.joint, file.cup, tuple(file.load.items()), quick)
    if not slow:
        return quick_results
    known = {name: solved(file, name) or _WAITING.format(name, file.joint.thickness_ratio) for name in slow}
    contacts = {
        **quick_results.contacts,
        **{name: result for name, result in known.items() if not isinstance(result, str)},
    }
    missing = {name: result for name, result in known.items() if isinstance(result, str)}
    ordered = {name: contacts[name] for name in names if name in contacts}
    return Comparison(file.joint, ordered, {**missing, **quick_results.missing})


_WAITING = "{} is being solved: at R2/L = {:.3g} that takes seconds"


@lru_cache(maxsize=64)
def _pressed(joint: Joint, cup: Cup, load: tuple[tuple[str, float], ...], names: tuple[str, ...]) -> Comparison:
    return compare(joint, models={name: catalogue[name] for name in names}, cup=cup, **dict(load))


def curve(contact: Contact, largest: float) -> Contact | None:
    """Compute the curve of a contact's model up to the largest force; None without a result."""
    if isinstance(contact, RecordedContact):
        return contact.curve
    return _cached_curve(contact.joint, contact.model.name, largest)


@lru_cache(maxsize=256)
def _cached_curve(joint: Joint, name: str, largest: float) -> Contact | None:
    try:
        return catalogue[name].press(joint, force=largest * _POINTS)
    except OutsideDomainError:
        return None


def fine_curves(contacts: Mapping[str, Contact], models: Mapping[str, Model]) -> dict[str, Contact]:
    """Compute a curve of each contact for a file, unless it was solved with the contact."""
    ready = {
        name: contact.curve
        for name, contact in contacts.items()
        if isinstance(contact, RecordedContact) and contact.curve
    }
    unsolved = {name: contact for name, contact in contacts.items() if name not in ready}
    return {**ready, **(force_curves(unsolved, models) if unsolved else {})}


@lru_cache(maxsize=256)
def profile(contact: Contact) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Sample angles (rad) from the pole to the edge of a contact, dense near the edge, and pressures."""
    angle = min(float(contact.half_angle), pi / 2) * _ANGLES
    return angle, numpy.asarray(contact.pressure(angle))


def rounded_up(value: float) -> float:
    """Round up to 1, 1.5, 2, 3, 5 or 7 times a power of ten, for axes that stay while a slider moves."""
    if not value > 0:
        return 1.0
    scale = 10.0 ** (ceil(log10(value)) - 1)
    return float(next(step * scale for step in (1, 1.5, 2, 3, 5, 7, 10, 15) if step * scale >= value * (1 - 1e-12)))


def press_charts(contacts: Mapping[str, Contact], lines: Mapping[str, LineStyle], reading: Reading) -> str:
    """Draw pressure over angle and force over indentation of several contacts, with a legend."""
    if not contacts:
        return "<p class='quiet'>No curve to draw.</p>"
    key = legend({name: lines[name] for name in contacts})
    charts = _pressure_chart(contacts, lines, reading), _force_chart(contacts, lines, reading)
    figures = "".join(f"<figure>{picture}</figure>" for picture in charts)
    return f"<div class='pair'>{figures}</div><p class='legend'>{key}</p>"


def _pressure_chart(contacts: Mapping[str, Contact], lines: Mapping[str, LineStyle], reading: Reading) -> str:
    angle, pressure = reading.unit(FIELD["angle"]), reading.unit(FIELD["pressure"])
    widest = min(max(float(contact.half_angle) for contact in contacts.values()), pi / 2)
    highest = max(float(contact.max_pressure) for contact in contacts.values())
    return chart(
        "pressure over angle, highest at the pole",
        FIELD["angle"].label(angle),
        FIELD["pressure"].label(pressure),
        {
            name: _pressure_curve(contact, (angle.factor, pressure.factor), lines[name])
            for name, contact in contacts.items()
        },
        (rounded_up(1.02 * widest * angle.factor), rounded_up(1.05 * highest * pressure.factor)),
    )


def _force_chart(contacts: Mapping[str, Contact], lines: Mapping[str, LineStyle], reading: Reading) -> str:
    axes = depth, force = force_axes(reading.units)
    top = rounded_up(1.2 * max(float(force.values_of(contact)) for contact in contacts.values()))
    largest = top / force.factor
    deepest = max(float(depth.values_of(contact)) for contact in contacts.values())
    return chart(
        "force over indentation",
        depth.label,
        force.label,
        {name: _force_curve(contact, largest, axes, lines[name]) for name, contact in contacts.items()},
        (rounded_up(1.3 * deepest), top),
    )


def _pressure_curve(contact: Contact, factors: tuple[float, float], line: LineStyle) -> Curve:
    angle, pressure = profile(contact)
    trusted = numpy.full(angle.shape, bool(contact.valid))
    return Curve(angle * factors[0], pressure * factors[1], trusted, line)


def _force_curve(contact: Contact, largest: float, axes: tuple[Column, Column], line: LineStyle) -> Curve:
    depth, force = axes
    mark = (float(depth.values_of(contact)), float(force.values_of(contact)))
    press = curve(contact, largest)
    if press is None:
        return Curve(numpy.empty(0), numpy.empty(0), numpy.empty(0, dtype=bool), line, mark)
    return Curve(depth.values_of(press), force.values_of(press), numpy.asarray(press.valid), line, mark)
