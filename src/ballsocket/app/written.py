"""A contact as plain numbers: what another process hands over, and a page draws."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from typing import Any

import numpy

from ..contact import Contact
from ..core import arrays
from ..core.arrays import Array

_NAMES = (
    "half_angle",
    "max_pressure",
    "max_pressure_angle",
    "pole_pressure",
    "stiffness",
    "energy",
    "foundation_modulus",
    "pressure_integral",
)
_SHARES = numpy.sin(numpy.linspace(0.0, pi / 2, 120))  # of the half angle, dense where the pressure falls steeply
_NOTHING = (numpy.zeros(1), numpy.zeros(1))


@dataclass(frozen=True, kw_only=True, eq=False)
class Written:
    """The `Laws` of a contact that is known: its numbers, and its pressure (MPa) at angles (rad) up to its edge."""

    half_angle: Array
    max_pressure: Array
    max_pressure_angle: Array
    pole_pressure: Array
    stiffness: Array
    energy: Array
    foundation_modulus: Array
    pressure_integral: Array
    profile: tuple[numpy.ndarray, numpy.ndarray]

    def pressure(self, angle: Array) -> Array:
        """Between the angles along straight lines: for a picture."""
        return numpy.interp(arrays.to_numpy(angle), *self.profile, right=0.0)


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class WrittenContact(Contact):
    """A contact that another process solved, with its estimated errors, notes and validity, and its curve."""

    error: dict[str, Any] = field(default_factory=dict)
    curve: Contact | None = None
    solved_notes: tuple[str, ...] = ()
    solved_valid: Array = True

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of the process that solved the contact."""
        return self.solved_notes

    @property
    def valid(self) -> Array:
        """Validity by the process that solved the contact."""
        return self.solved_valid


def written(contact: Contact, curve: Contact | None = None) -> WrittenContact:
    """A contact without what solved it, and its curve from first touch on, if there is one."""
    laws = Written(**{name: getattr(contact, name) for name in _NAMES}, profile=_profile(contact))
    return WrittenContact(
        model=contact.model,
        joint=contact.joint,
        status=contact.status,
        laws=laws,
        force=contact.force,
        indentation=contact.indentation,
        error=dict(getattr(contact, "error", {})),
        curve=curve,
        solved_notes=contact.notes,
        solved_valid=contact.valid,
    )


def _profile(contact: Contact) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Angles and pressures; of many contacts none, since nobody draws them all."""
    if numpy.ndim(contact.half_angle) or not float(contact.half_angle) > 0:
        return _NOTHING
    angles = min(float(contact.half_angle), pi / 2) * _SHARES
    return angles, numpy.asarray(contact.pressure(angles))
