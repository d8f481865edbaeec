"""In which units numbers are read: angles in degrees or radians, all else in mm, N, MPa or in, lbf, psi."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, isfinite, isnan, log10

from ..contact.describe import Column
from ..core.kinds import Kind, Unit
from ..core.quantities import CONTACT, JOINT, Quantity
from ..reports.unit_systems import Units

_DIGITS = 4
_INCH = Unit("in", 1 / 25.4)
_THOUSANDTH = 1e-3


@dataclass(frozen=True, kw_only=True)
class Reading:
    """What somebody reads numbers in."""

    angle: str = "degrees"
    units: Units = Units.SI

    def unit(self, quantity: Quantity) -> Unit:
        """The unit of a quantity; lengths that are read in µm are mils where others are inches."""
        if quantity.kind is Kind.ANGLE:
            return Unit(quantity.unit) if self.angle == "radians" else quantity.shown
        if self.units is Units.IMPERIAL and quantity.kind is Kind.LENGTH and quantity.display_unit is None:
            return _INCH
        return self.units.unit_of(quantity)

    @property
    def length(self) -> Unit:
        """The unit of a dimension."""
        return self.unit(JOINT["ball_radius"])

    def label(self, quantity: Quantity) -> str:
        """Title, symbol and unit, for an axis."""
        return quantity.label(self.unit(quantity))

    def said(self, quantity: Quantity, value: float) -> str:
        """A number from the unit inside, with its unit."""
        unit = self.unit(quantity)
        gap = "" if unit.text in ("", "°") else " "
        return f"{number_text(value * unit.factor)}{gap}{unit.text}"

    @property
    def columns(self) -> tuple[Column, ...]:
        """Every quantity of a contact."""
        return tuple(Column(each, self.unit(each)) for each in CONTACT.values())


def number_text(value: float) -> str:
    """Four digits; what has no answer, and what is infinite, in words."""
    if isnan(value):
        return "no answer"
    if 10**_DIGITS <= abs(value) < 1e12:
        return f"{value:.0f}"
    return f"{value:.{_DIGITS}g}" if isfinite(value) else "∞"


def handy_step(step: float) -> float:
    """The next round number below: 1, 2 or 5 times a power of ten."""
    scale = 10.0 ** floor(log10(step * (1 + 1e-9)))
    return max(factor * scale for factor in (1, 2, 5) if factor * scale <= step * (1 + 1e-9))
