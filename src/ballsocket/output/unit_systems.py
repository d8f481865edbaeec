"""In which units a terminal shows contacts."""

from __future__ import annotations

from enum import StrEnum
from types import MappingProxyType

from ..contact.describe import UTILISATION, Column
from ..kinds import Kind, Unit
from ..quantities import CONTACT

_INCH, _POUND = 25.4, 4.4482216152605  # mm, N
_PSI = _INCH**2 / _POUND

_IMPERIAL = MappingProxyType(
    {
        Kind.LENGTH: Unit("mil", 1e3 / _INCH),
        Kind.FORCE: Unit("lbf", 1 / _POUND),
        Kind.MODULUS: Unit("psi", _PSI),
        Kind.AREA: Unit("in²", _INCH**-2),
        Kind.STIFFNESS: Unit("kip/in", 1e-3 * _INCH / _POUND),
        Kind.ENERGY: Unit("lbf in", 1 / (_INCH * _POUND)),
        Kind.FOUNDATION: Unit("ksi/in", 1e-3 * _PSI * _INCH),
    }
)
"""Units by what they measure; a mil is a thousandth of an inch."""


class Units(StrEnum):
    """A system of units: SI with mm, N and MPa, or inches and pounds."""

    SI = "SI"
    IMPERIAL = "imperial"

    @property
    def columns(self) -> tuple[Column, ...]:
        """What is shown of a contact, each in its unit."""
        units = _IMPERIAL if self is Units.IMPERIAL else {}
        return (*(Column(each, units.get(each.kind, each.shown)) for each in CONTACT.values()), UTILISATION)
