"""Systems of units for tables and figures of contacts."""

from __future__ import annotations

from enum import StrEnum
from math import inf, isinf
from types import MappingProxyType

from ..contact.describe import UTILISATION, Column
from ..core.kinds import Kind, Unit
from ..core.quantities import CONTACT, Quantity

_LARGE = 1e4
"""Value from which numbers are written without an exponent."""

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
"""Imperial units by kind; a mil is a thousandth of an inch."""


class Units(StrEnum):
    """System of units: SI with mm, N and MPa, or inches and pounds."""

    SI = "SI"
    IMPERIAL = "imperial"

    def length(self, millimetres: float) -> str:
        """Write a length (mm) in mm or in inches."""
        if isinf(millimetres):
            return "to infinity"
        if self is Units.IMPERIAL:
            return f"{millimetres / _INCH:.4g} in"
        return f"{millimetres:.4g} mm"

    def torque(self, newton_millimetres: float) -> str:
        """Write a torque (N mm) in N m or in pound inches."""
        if self is Units.IMPERIAL:
            return f"{newton_millimetres / (_INCH * _POUND):.3g} lbf in"
        return f"{1e-3 * newton_millimetres:.3g} N m"

    def unit_of(self, quantity: Quantity) -> Unit:
        """Return the unit of a quantity."""
        return _IMPERIAL.get(quantity.kind, quantity.shown) if self is Units.IMPERIAL else quantity.shown

    def text_of(self, quantity: Quantity, number: float) -> str:
        """Write a number, stated in the internal unit, with the unit of this system."""
        unit = self.unit_of(quantity)
        shown = number * unit.factor
        text = f"{shown:.0f}" if _LARGE <= abs(shown) < inf else f"{shown:.4g}"
        return text if not unit.text else f"{text}{'' if unit.text == '°' else ' '}{unit.text}"

    @property
    def columns(self) -> tuple[Column, ...]:
        """Columns of a contact, each with its unit."""
        return (*(Column(quantity, self.unit_of(quantity)) for quantity in CONTACT.values()), UTILISATION)
