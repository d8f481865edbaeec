"""Presses for the page, each done once: a joint, a load, a model."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from math import ceil, log10, pi

import numpy

from ..catalogue import catalogue
from ..compare import Comparison, compare, force_curves
from ..contact import Contact, Model
from ..core.validity import OutsideDomainError
from ..files.joint_file import JointFile
from ..problem import Joint
from ..problem.cup import Cup
from .solving import heavy, solved
from .written import WrittenContact

_POINTS = numpy.linspace(0.0, 1.0, 17) ** 1.5
_ANGLES = numpy.sin(numpy.linspace(0.0, pi / 2, 60))


def pressed(file: JointFile, names: tuple[str, ...]) -> Comparison:
    """Some models beside each other; those that take long have an answer once they have been asked, see `solving`."""
    slow = [name for name in names if heavy(file.joint, name)]
    quick = tuple(name for name in names if name not in slow)
    found = _pressed(file.joint, file.cup, tuple(file.load.items()), quick)
    if not slow:
        return found
    known = {name: solved(file, name) or _WAITING.format(name, file.joint.thickness_ratio) for name in slow}
    contacts = {**found.contacts, **{name: each for name, each in known.items() if not isinstance(each, str)}}
    missing = {name: each for name, each in known.items() if isinstance(each, str)}
    ordered = {name: contacts[name] for name in names if name in contacts}
    return Comparison(file.joint, ordered, {**missing, **found.missing})


_WAITING = "{} is being solved: at R2/L = {:.3g} that takes seconds"


@lru_cache(maxsize=64)
def _pressed(joint: Joint, cup: Cup, load: tuple[tuple[str, float], ...], names: tuple[str, ...]) -> Comparison:
    return compare(joint, models={name: catalogue[name] for name in names}, cup=cup, **dict(load))


def curve(contact: Contact, largest: float) -> Contact | None:
    """The model of a contact from first touch to the largest force, or as far as it was solved; None without answer."""
    if isinstance(contact, WrittenContact):
        return contact.curve
    return _curve(contact.joint, contact.model.name, largest)


@lru_cache(maxsize=256)
def _curve(joint: Joint, name: str, largest: float) -> Contact | None:
    try:
        return catalogue[name].press(joint, force=largest * _POINTS)
    except OutsideDomainError:
        return None


def fine_curves(contacts: Mapping[str, Contact], models: Mapping[str, Model]) -> dict[str, Contact]:
    """A curve of each contact, for a file: by `force_curves`, unless it was solved with the contact."""
    ready = {name: each.curve for name, each in contacts.items() if isinstance(each, WrittenContact) and each.curve}
    others = {name: each for name, each in contacts.items() if name not in ready}
    return {**ready, **(force_curves(others, models) if others else {})}


@lru_cache(maxsize=256)
def profile(contact: Contact) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Angles in rad from the pole to the edge of a contact, dense where the pressure falls steeply, and pressures."""
    angle = min(float(contact.half_angle), pi / 2) * _ANGLES
    return angle, numpy.asarray(contact.pressure(angle))


def rounded_up(value: float) -> float:
    """The next of 1, 1.5, 2, 3, 5, 7 times a power of ten: an axis that stays while a slider moves."""
    if not value > 0:
        return 1.0
    scale = 10.0 ** (ceil(log10(value)) - 1)
    return float(next(step * scale for step in (1, 1.5, 2, 3, 5, 7, 10, 15) if step * scale >= value * (1 - 1e-12)))
