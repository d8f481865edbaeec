"""Units in which a page shows numbers: angles in degrees or radians, all else metric or imperial."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, isfinite, isnan, log10

from ...contact.describe import Column
from ...core.kinds import Kind, Unit
from ...core.quantities import CONTACT, JOINT, Quantity
from ...reports.unit_systems import Units

_DIGITS = 4
_INCH = Unit("in", 1 / 25.4)
_THOUSANDTH = 1e-3


@dataclass(frozen=True, kw_only=True)
class Reading:
    """Units of a page."""

    angle: str = "degrees"
    units: Units = Units.SI

    def unit(self, quantity: Quantity) -> Unit:
        """Return the unit of a quantity; lengths in µm become mils on imperial pages."""
        if quantity.kind is Kind.ANGLE:
            return Unit(quantity.unit) if self.angle == "radians" else quantity.shown
        if self.units is Units.IMPERIAL and quantity.kind is Kind.LENGTH and quantity.display_unit is None:
            return _INCH
        return self.units.unit_of(quantity)

    @property
    def length(self) -> Unit:
        """Unit of a dimension."""
        return self.unit(JOINT["ball_radius"])

    def label(self, quantity: Quantity) -> str:
        """Title, symbol and unit, for an axis."""
        return quantity.label(self.unit(quantity))

    def with_unit(self, quantity: Quantity, value: float) -> str:
        """Write a number in internal units with its chosen unit."""
        unit = self.unit(quantity)
        gap = "" if unit.text in ("", "°") else " "
        return f"{number_text(value * unit.factor)}{gap}{unit.text}"

    @property
    def columns(self) -> tuple[Column, ...]:
        """Every quantity of a contact."""
        return tuple(Column(quantity, self.unit(quantity)) for quantity in CONTACT.values())


def number_text(value: float) -> str:
    """Format a number with four digits; NaN and infinity in words."""
    if isnan(value):
        return "no answer"
    if 10**_DIGITS <= abs(value) < 1e12:
        return f"{value:.0f}"
    return f"{value:.{_DIGITS}g}" if isfinite(value) else "∞"


def handy_step(step: float) -> float:
    """Round down to 1, 2 or 5 times a power of ten."""
    scale = 10.0 ** floor(log10(step * (1 + 1e-9)))
    return max(factor * scale for factor in (1, 2, 5) if factor * scale <= step * (1 + 1e-9))
