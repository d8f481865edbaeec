"""Estimates of unknowns, and of products of unknowns, with their bands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..core.deprecation import RenamedAttribute


@dataclass(frozen=True)
class Estimate:
    """Estimated value of one unknown with its 95 % band.

    Attributes
    ----------
    name, unit : str
    value : float
        NaN for an unidentifiable unknown without a stated distribution.
    low, high : float
        Band of 95 % from the profile likelihood within the ranges of all unknowns.
    width_ratio : float
        Width of the band over the prior range.
    limited_by : tuple of str
        Unknowns whose ranges limit the band, its own name included. Empty where the data alone limit it.
    """

    name: str
    unit: str
    value: float
    low: float
    high: float
    width_ratio: float
    limited_by: tuple[str, ...] = ()
    left = RenamedAttribute("width_ratio")
    told = RenamedAttribute("identifiable")

    @property
    def identifiable(self) -> bool:
        """True if the data identify the unknown, or if its prior is a stated distribution."""
        return self.value == self.value

    def summary(self) -> dict[str, Any]:
        """Return the estimate as a dictionary for JSON; the value of an unidentifiable unknown is None."""
        value = self.value if self.identifiable else None
        return {
            "name": self.name,
            "unit": self.unit,
            "value": value,
            "low": self.low,
            "high": self.high,
            "identifiable": self.identifiable,
            "told": self.identifiable,
            "limited_by": list(self.limited_by),
        }


@dataclass(frozen=True)
class Product:
    """Identifiable product of powers of unknowns that are not identifiable separately.

    Attributes
    ----------
    exponents : dict of str to float
        Power of each unknown.
    unit : str
    value, low, high : float
        Value of the product, and its band of 95 %.
    """

    exponents: dict[str, float]
    unit: str
    value: float
    low: float
    high: float

    @property
    def name(self) -> str:
        """Name of the product from its factors, such as "clearance · liner_young"."""
        return " · ".join(name if power == 1 else f"{name}^{power:.3g}" for name, power in self.exponents.items())

    def summary(self) -> dict[str, Any]:
        """Return the product as a dictionary for JSON."""
        return {
            "name": self.name,
            "exponents": self.exponents,
            "unit": self.unit,
            "value": self.value,
            "low": self.low,
            "high": self.high,
        }
