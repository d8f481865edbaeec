"""Units in which a page shows numbers: angles in degrees or radians, all else metric or imperial."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, inf, isclose, isnan, log10
from typing import Any

from ...contact.describe import values_of
from ...core.arrays import Array
from ...core.kinds import Kind, Unit
from ...core.quantities import Quantity
from ...core.unit_systems import Units
from ...reports.svg import rounded_up

_DIGITS, _BOX_DIGITS = 4, 5
_LARGEST_PLAIN = 1e12  # value from which numbers are written with an exponent
_CONVERTED = ("in", "mil", "lbf", "psi", "ksi", "Mpsi")  # units of which a box has four digits, unless it is exact

_PSI_MULTIPLES = {"liner_young": ("ksi", 1e-3), "ball_young": ("Mpsi", 1e-6)}
"""Units of Young's moduli on imperial pages, and their factors from psi."""


@dataclass(frozen=True, kw_only=True)
class Reading:
    """Units of a page."""

    angle: str = "degrees"
    units: Units = Units.SI

    def unit(self, quantity: Quantity) -> Unit:
        """Return the unit of a quantity."""
        if quantity.kind is Kind.ANGLE:
            return Unit(quantity.unit) if self.angle == "radians" else quantity.shown
        unit = self.units.unit_of(quantity)
        if self.units is Units.IMPERIAL and quantity.name in _PSI_MULTIPLES:
            text, factor = _PSI_MULTIPLES[quantity.name]
            return Unit(text, factor * unit.factor)
        return unit

    def label(self, quantity: Quantity) -> str:
        """Return title, symbol and unit for an axis."""
        return quantity.label(self.unit(quantity))

    def with_unit(self, quantity: Quantity, value: float, error: float = 0.0) -> str:
        """Write a number in internal units with its chosen unit, without digits below its error.

        All digits are written if the error is 0, or NaN where there is no solution.
        """
        unit = self.unit(quantity)
        number = value * unit.factor
        if 0 < error < inf:
            number = round(number, max(0, ceil(-log10(error * unit.factor))))
        return f"{number_text(number)}{unit_suffix(unit.text)}"

    def values_of(self, contact: Any, quantity: Quantity) -> Array:
        """Return a quantity of a contact in its chosen unit."""
        return values_of(contact, quantity, self.unit(quantity))


def unit_suffix(unit: str) -> str:
    """Return the text of a unit as it stands behind a number."""
    return unit if unit in ("", "°") else f" {unit}"


def number_text(value: float) -> str:
    """Format a number with four digits; NaN and infinity in words."""
    if isnan(value):
        return "no result"
    if 10**_DIGITS <= abs(value) < _LARGEST_PLAIN:
        return f"{value:.0f}"
    return f"{value:.{_DIGITS}g}" if abs(value) < inf else "∞"


def box_text(value: float, unit: str = "") -> str:
    """Format a number for a box with at most five digits, or four if it was converted from metric units.

    Examples
    --------
    >>> box_text(32 / 25.4, "in"), box_text(1.0625, "in"), box_text(674.427, "lbf")
    ('1.26', '1.0625', '674.4')
    """
    text = _digits(value, _BOX_DIGITS)
    exact = unit not in _CONVERTED or isclose(float(text), value, rel_tol=1e-9)
    return text if exact else _digits(value, _DIGITS)


def _digits(value: float, digits: int) -> str:
    """Format a number with a number of digits, without an exponent if it is not too large."""
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < _LARGEST_PLAIN else text


def handy_step(step: float) -> float:
    """Round down to 1, 2 or 5 times a power of ten."""
    return 1 / rounded_up(1 / step, (1, 2, 5, 10))  # the factors divide 10
