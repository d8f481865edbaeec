"""Presses of the joint on the screen, cached, with their curves and charts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import cbrt, ceil
from typing import Any

import numpy

from ..comparison import MAX_HALF_ANGLE, Comparison, compare, force_curves
from ..contact import Contact, Model
from ..contact.describe import values_of
from ..core.checks import unique
from ..core.quantities import FIELD
from ..core.validity import OutsideDomainError
from ..files.joint_file import JointFile
from ..model_catalogue import catalogue, reference
from ..problem import Joint
from ..problem.cup import Cup
from ..question import complete, real_cup_reason
from ..reports.joint_drawing import profile
from ..reports.press_plots import FORCE_CURVE, force_axes
from ..reports.style import LineStyle
from ..reports.svg import rounded_up
from ..studies.derivatives import LocalUncertainty, local_uncertainty, scattered_joints
from ..studies.expressions import parse_distribution
from ..studies.run import default_model
from .pictures.chart import Curve, chart, charts
from .solving import heavy, solved, solved_curve
from .state.screen import phrases_in
from .widgets.blocks import Block, sentence
from .widgets.reading import Reading

_POINTS = numpy.sqrt(numpy.linspace(0.0, 1.0, 17))
_LOADS = numpy.linspace(0.0, 1.0, 40) ** 2
_WAITING = "Computing {}: at R2/L = {:.3g} this takes some seconds"
_ANGLE_STEP = 0.02  # step in rad of the largest half angle of a curve, which stays while a slider moves a little
_SLOWEST_SCATTERED = 1e-4  # s a press of models that press the hundreds of joints within tolerances
_AXIS_ENDS = 1, 1.5, 2, 3, 5, 7, 10  # times a power of ten
_SMALLEST_AXIS = 1e-300  # number below which powers of ten lose digits
AXIAL_CURVES = sentence("Curves: for loads along the axis of a full sphere.")
Profile = tuple[numpy.ndarray, numpy.ndarray, bool]  # angles (rad), pressures (MPa), and True where they can be trusted


def pressed(file: JointFile, names: tuple[str, ...]) -> Comparison:
    """Press a joint by several models; slow models have a result once `solving` has finished."""
    contacts: dict[str, Contact] = {}
    missing: dict[str, str] = {}
    file, _ = complete(file)
    for name in names:
        if heavy(file.joint, name):
            result = solved(file, name) or _WAITING.format(name, file.joint.thickness_ratio)
            if isinstance(result, str):
                missing[name] = result
            else:
                contacts[name] = result
        else:
            comparison = _pressed(file.joint, file.cup, (*file.load.items(), *file.aim.items()), name)
            contacts |= comparison.contacts
            missing |= comparison.missing
    return Comparison(file.joint, contacts, missing)


def is_waiting(file: JointFile, name: str) -> bool:
    """Return True while a slow model has no result yet."""
    return heavy(file.joint, name) and solved(file, name) is None


@lru_cache(maxsize=1024)
def _pressed(joint: Joint, cup: Cup, load: tuple[tuple[str, Any], ...], name: str) -> Comparison:
    return compare(joint, models={name: catalogue[name]}, cup=cup, **dict(load))


def effects_of(file: JointFile, tolerances: str) -> LocalUncertainty | None:
    """Compute the effect of one percent of each number of a joint, and bands of the results for its tolerances.

    None without a load along the cup's axis. Raises ValueError: tolerances that are not phrases of names and
    distributions, without the joint, or so wide that their presses would take minutes.
    """
    if not _has_effects(file):
        return None
    spreads = unique(map(parse_distribution, phrases_in(tolerances)))
    if spreads and scattered_joints(file.joint, file.load, spreads)[0].seconds_a_press > _SLOWEST_SCATTERED:
        raise ValueError("some joints within the tolerances are outside the tables: check their middle, or narrow them")
    return local_uncertainty(file.joint, file.cup, file.load, spreads)


def effects_are_slow(file: JointFile) -> bool:
    """Return True if `effects_of` takes seconds, where a joint of a thin liner is outside the tables."""
    if not _has_effects(file) or not heavy(file.joint, reference.name):
        return False
    return default_model(file.joint, {name: [load] for name, load in file.load.items()}).name != "tabulated"


def _has_effects(file: JointFile) -> bool:
    return any(float(load) > 0 for load in file.load.values()) and not real_cup_reason(file)


_DEFAULT_LOADS = {"force": 3000.0, "indentation": 0.05, "half_angle": 0.7}
"""Loads (N, mm, rad) of a joint for which a model has no contact."""


def same_load(file: JointFile, model: str, kind: str) -> dict[str, float]:
    """Return the load of another kind with the same contact by a model."""
    contact = pressed(file, (model,)).contacts.get(model)
    value = float("nan") if contact is None else float(getattr(contact, kind))
    return {kind: float(f"{value:.6g}") if value > 0 else _DEFAULT_LOADS[kind]}


def curve(contact: Contact, largest: float) -> Contact | None:
    """Compute the curve of a contact's model up to the largest force; None without a result.

    A given half angle needs no search for the load. Forces grow at least with its third power.
    """
    if heavy(contact.joint, contact.model.name):
        return solved_curve(contact)
    force, half = float(contact.force), float(contact.half_angle)
    if not (force > 0 and half > 0):
        return None
    end = min(half * cbrt(max(largest / force, 1.0)), MAX_HALF_ANGLE)
    return _cached_curve(contact.joint, contact.model.name, min(ceil(end / _ANGLE_STEP) * _ANGLE_STEP, MAX_HALF_ANGLE))


@lru_cache(maxsize=256)
def _cached_curve(joint: Joint, name: str, half_angle: float) -> Contact | None:
    try:
        return catalogue[name].press(joint, half_angle=half_angle * _POINTS)
    except OutsideDomainError:
        return None


@lru_cache(maxsize=256)
def load_curve(joint: Joint, name: str, kind: str, largest: float) -> Contact | None:
    """Press a joint by loads from zero to the largest, dense at zero; None without a result."""
    try:
        return catalogue[name].press(joint, **{kind: largest * _LOADS})
    except OutsideDomainError:
        return None


def fine_curves(contacts: Mapping[str, Contact], models: Mapping[str, Model]) -> dict[str, Contact]:
    """Compute a curve of each contact for a file, unless it was solved with the contact."""
    known = {name: solved_curve(contact) for name, contact in contacts.items()}
    ready = {name: curve for name, curve in known.items() if curve is not None}
    unsolved = {name: contact for name, contact in contacts.items() if name not in ready}
    return {**ready, **(force_curves(unsolved, models) if unsolved else {})}


def axis_end(value: float) -> float:
    """Round up to the end of an axis, which stays while a slider moves a little; 1 for a value that is not positive."""
    return rounded_up(value, _AXIS_ENDS) if value > _SMALLEST_AXIS else 1.0


def press_charts(contacts: Mapping[str, Contact], lines: Mapping[str, LineStyle], reading: Reading) -> Block:
    """Draw pressure over angle and force over indentation of several contacts, with a legend."""
    if not contacts:
        return sentence("No curve to draw.")
    profiles = {name: (*profile(contact), bool(contact.valid)) for name, contact in contacts.items()}
    return charts(pressure_chart(profiles, lines, reading), _force_chart(contacts, lines, reading), legend=[])


def pressure_chart(
    profiles: Mapping[str, Profile], lines: Mapping[str, LineStyle], reading: Reading, caption: Sequence[str] = ()
) -> Block:
    """Draw named pressures over their angles."""
    angle, pressure = reading.unit(FIELD["angle"]), reading.unit(FIELD["pressure"])
    curves = {
        name: Curve(angle.factor * x, pressure.factor * y, lines[name], trusted)
        for name, (x, y, trusted) in profiles.items()
    }
    widest, highest = (max(float(getattr(curve, axis).max()) for curve in curves.values()) for axis in "xy")
    labels = FIELD["angle"].label(angle), FIELD["pressure"].label(pressure)
    ends = axis_end(1.02 * widest), axis_end(1.05 * highest)
    return chart("pressure over angle, highest at the pole", *labels, curves, ends, caption=caption)


def _force_chart(contacts: Mapping[str, Contact], lines: Mapping[str, LineStyle], reading: Reading) -> Block:
    (x, y), (depth, force) = FORCE_CURVE, force_axes(reading.units)
    marks = {
        name: (float(values_of(contact, x, depth)), float(values_of(contact, y, force)))
        for name, contact in contacts.items()
    }
    deepest, largest = (max(ends) for ends in zip(*marks.values(), strict=True))
    top, curves = axis_end(1.2 * largest), {}
    for name, contact in contacts.items():
        press, line = curve(contact, top / force.factor), lines[name]
        if press is None:
            curves[name] = Curve(numpy.empty(0), numpy.empty(0), line, mark=marks[name])
        else:
            course = values_of(press, x, depth), values_of(press, y, force)
            curves[name] = Curve(*course, line, press.valid, marks[name])
    return chart("force over indentation", x.label(depth), y.label(force), curves, (axis_end(1.3 * deepest), top))
