"""What the data can tell: the information matrix, its rank, and what it does not see, in words."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import exp, inf, log
from typing import Any

import numpy

from ..arrays import Numbers
from .unknowns import Scales

TOLD = 0.5
"""What the data leave of the width that was known, from which on they do not tell: half of it."""

WIDE = 1.959963984540054
"""Deviations to either side of a band of 95 %."""

_ALONE = 0.97  # share of a direction, from which on it is one number and no mix


@dataclass(frozen=True)
class Product:
    """A product of powers of unknowns that the data tell, where they do not tell the factors.

    Attributes
    ----------
    exponents : dict of str to float
    unit : str
    value, low, high : float
        The product, and its band of 95 %.
    """

    exponents: dict[str, float]
    unit: str
    value: float
    low: float
    high: float

    @property
    def name(self) -> str:
        """The product in words, "clearance · liner_young"."""
        return " · ".join(name if power == 1 else f"{name}^{power:.3g}" for name, power in self.exponents.items())

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "name": self.name,
            "exponents": self.exponents,
            "unit": self.unit,
            "value": self.value,
            "low": self.low,
            "high": self.high,
        }


@dataclass(frozen=True, eq=False)
class Information:
    """What data tell about unknowns, and what was known before.

    Attributes
    ----------
    scales : Scales
    places : array (unknowns,)
        Where it is asked, in deviations of what was known.
    matrix : array (unknowns, unknowns)
        Fisher's information of the data in those places: 1 tells as much as was known before.
    """

    scales: Scales
    places: Numbers
    matrix: Numbers

    @cached_property
    def _modes(self) -> tuple[Numbers, Numbers]:
        return _modes(self.matrix)

    @property
    def eigenvalues(self) -> Numbers:
        return self._modes[0]

    @property
    def rank(self) -> int:
        """How many directions the data tell: along which they leave less than half of what was known."""
        return int(numpy.sum(_left(self.eigenvalues) < TOLD))

    @property
    def condition(self) -> float:
        """Largest over smallest eigenvalue; inf where data do not see a direction at all."""
        values = self.eigenvalues
        return float(values[0] / values[-1]) if values[-1] > 1e-12 * values[0] else inf

    @cached_property
    def covariance(self) -> Numbers:
        """Covariance of the places: by the data, by means that were known, by the two ends of what is not told."""
        counts = [each.known or each.name in self.untold for each in self.scales.unknowns]
        return numpy.linalg.inv(self.matrix + numpy.diag(numpy.array(counts, dtype=float)))

    @cached_property
    def deviations(self) -> dict[str, float]:
        """What is left of the width that was known, by unknown: 1 is all of it."""
        values, vectors = self._modes
        left = numpy.sqrt(numpy.diagonal((vectors / (1 + values)) @ vectors.T))
        return dict(zip(self.scales.names, left.tolist(), strict=True))

    @property
    def untold(self) -> tuple[str, ...]:
        """Unknowns that the data do not tell apart, and of which no more was known than two ends."""
        left = self.deviations
        return tuple(each.name for each in self.scales.unknowns if not each.known and left[each.name] >= TOLD)

    @cached_property
    def products(self) -> tuple[Product, ...]:
        """What the data tell where they do not tell the unknowns: products of two or more, on scales of ratios."""
        values, vectors = self._modes
        told = [vectors[:, mode] for mode in range(len(values)) if _left(values[mode]) < TOLD]
        found = (self._product(vector) for vector in told if self.untold)
        return tuple(product for product in found if product is not None)

    def _product(self, vector: Numbers) -> Product | None:
        """A direction as a product of powers, the largest of which is 1."""
        unknowns = self.scales.unknowns
        powers = vector / [each.span for each in unknowns]
        shares = abs(vector)
        some = [place for place in range(len(unknowns)) if shares[place] > (1 - _ALONE**2) ** 0.5]
        mixed = set(self.untold) & {unknowns[place].name for place in some}
        if len(some) < 2 or not mixed or not all(unknowns[place].logarithmic for place in some):
            return None
        powers = powers / powers[some[numpy.argmax(abs(powers[some]))]]
        exponents = {unknowns[place].name: _round(float(powers[place])) for place in some}
        return self._band(exponents)

    def _band(self, exponents: dict[str, float]) -> Product:
        names = self.scales.names
        weight = numpy.array([exponents.get(name, 0.0) for name in names])
        values = dict(zip(names, self.scales.values(self.places).tolist(), strict=True))
        middle = sum(power * log(values[name]) for name, power in exponents.items())
        along = weight * [each.span for each in self.scales.unknowns]
        half = WIDE * float(along @ self.covariance @ along) ** 0.5
        units = {each.name: each.quantity.unit for each in self.scales.unknowns}
        unit = " ".join(
            units[name] if power == 1 else f"{units[name]}^{power:.3g}" for name, power in exponents.items()
        )
        return Product(exponents, unit, exp(middle), exp(middle - half), exp(middle + half))


def _modes(matrix: Numbers) -> tuple[Numbers, Numbers]:
    """Eigenvalues, the largest first, and their directions in columns."""
    values, vectors = numpy.linalg.eigh((matrix + matrix.T) / 2)
    return numpy.maximum(values[::-1], 0.0), vectors[:, ::-1]


def _left(information: Any) -> Any:
    """The share of a width that is left once so much information is added."""
    return (1 + information) ** -0.5


def _round(power: float) -> float:
    """A whole or a half number that is as near as the data could tell."""
    near = round(2 * power) / 2
    return near if abs(power - near) < 0.1 and near else power
