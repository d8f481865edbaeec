"""Identifiability: information of the data, unidentifiable unknowns, and identifiable products."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import exp, inf, log, sqrt
from typing import Any

import numpy

from ..core.arrays import Numbers
from .profile import ProfileEnd
from .unknowns import Scales, Unknown

TOLD = 0.5
"""Share of the prior range; a wider band makes an unknown unidentifiable."""

MOVED = 0.1
"""Largest shift of an identifiable unknown by an unidentifiable one, as a share of the prior range."""

WIDE = 1.959963984540054
"""Standard deviations to either side of a band of 95 %."""

SURE = 2.5758293035489004
"""Standard deviations to either side of an interval of 99 %, which ends inside the range of an identifiable unknown."""

_ALONE = 0.97  # share of a direction, from which on it is one number and no mix
_APART = 0.5  # smallest singular value of independent unit directions


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
class Interval:
    """Profile interval of an unknown.

    Attributes
    ----------
    low, high : ProfileEnd
        Ends of the band of 95 %.
    closed : bool
        True where the interval of 99 % ends inside the range, or at a physical limit.
    """

    low: ProfileEnd
    high: ProfileEnd
    closed: bool

    @property
    def limits(self) -> frozenset[int]:
        """Indices of the unknowns whose ranges limit the band."""
        return frozenset((*self.low.limited_by, *self.high.limited_by))


@dataclass(frozen=True, eq=False)
class Information:
    """Information of the data about the unknowns, and its limits over their ranges.

    Attributes
    ----------
    scales : Scales
    places : array (unknowns,)
        The best point, in deviations of the prior.
    matrix : array (unknowns, unknowns)
        Fisher's information of the data there; 1 is the information of the prior.
    intervals : tuple of Interval
        Profile intervals over the ranges of the unknowns; `matrix` is local.
    quantile : float
        Standard deviations to either side of a band of 95 %; more than 1.96 where the scatter is too large.
    """

    scales: Scales
    places: Numbers
    matrix: Numbers
    intervals: tuple[Interval, ...]
    quantile: float = WIDE

    @cached_property
    def _modes(self) -> tuple[Numbers, Numbers]:
        return _modes(self.matrix)

    @property
    def eigenvalues(self) -> Numbers:
        return self._modes[0]

    @cached_property
    def rank(self) -> int:
        """Number of identifiable directions; full if every unknown is identifiable."""
        lost = [self.scales.names.index(name) for name in self.unidentifiable]
        if not lost:
            return len(self.scales.names)
        directions = numpy.stack([self._band_direction(index) for index in lost], axis=1)
        sizes = numpy.linalg.svd(directions / numpy.linalg.norm(directions, axis=0), compute_uv=False)
        return len(self.scales.names) - max(1, int(numpy.sum(sizes > _APART)))

    @property
    def condition(self) -> float:
        """Largest over smallest eigenvalue; inf where data do not see a direction at all."""
        values = self.eigenvalues
        return float(values[0] / values[-1]) if values[-1] > 1e-12 * values[0] else inf

    @cached_property
    def deviations(self) -> Mapping[str, float]:
        """Width of the band of 95 % over the prior range, by unknown."""
        pairs = zip(self.scales.unknowns, self.intervals, range(len(self.intervals)), strict=True)
        return {each.name: _share(each, interval, index) for each, interval, index in pairs}

    @cached_property
    def unidentifiable(self) -> tuple[str, ...]:
        """Unidentifiable unknowns for which only a range is stated.

        One of three conditions holds. The profile interval of 99 % leaves the range. The band of 95 % takes half of the
        range or more. The range of another unidentifiable unknown limits the band and shifts it by a tenth or more.
        """
        left, unknowns = self.deviations, self.scales.unknowns
        free = [index for index, each in enumerate(unknowns) if not each.known]
        lost = [i for i in free if not self.intervals[i].closed or left[unknowns[i].name] >= TOLD]
        moved = [i for i in free if any(self._is_moved(i, other) for other in set(lost) - {i})]
        return tuple(each.name for index, each in enumerate(unknowns) if index in {*lost, *moved})

    def _is_moved(self, index: int, other: int) -> bool:
        return other in self.intervals[index].limits and abs(self._band_direction(other)[index]) >= MOVED * sqrt(12)

    def _band_direction(self, index: int) -> Numbers:
        """Compute the change of all unknowns from the lower to the upper end of the band of one unknown."""
        interval = self.intervals[index]
        return interval.high.theta - interval.low.theta

    @property
    def untold(self) -> tuple[str, ...]:
        """Earlier name of `unidentifiable`."""
        return self.unidentifiable

    def limited_by(self, name: str) -> tuple[str, ...]:
        """Return the names of the unknowns whose ranges limit a band, its own name included."""
        limits = self.intervals[self.scales.names.index(name)].limits
        return tuple(each.name for index, each in enumerate(self.scales.unknowns) if index in limits and not each.known)

    @cached_property
    def _determined(self) -> Numbers:
        """Information in the identifiable directions."""
        values, vectors = self._modes
        return (vectors[:, : self.rank] * values[: self.rank]) @ vectors[:, : self.rank].T

    @cached_property
    def covariance(self) -> Numbers:
        """Covariance of the scaled unknowns from data, prior distributions, and ranges in unidentifiable directions."""
        counts = [each.known or each.name in self.unidentifiable for each in self.scales.unknowns]
        return numpy.linalg.inv(self._determined + numpy.diag(numpy.array(counts, dtype=float)))

    @cached_property
    def products(self) -> tuple[Product, ...]:
        """Identifiable products of powers of unidentifiable unknowns."""
        if not self.unidentifiable:
            return ()
        found = (self._product(vector) for vector in self._modes[1][:, : self.rank].T)
        return tuple(product for product in found if product is not None)

    def _product(self, vector: Numbers) -> Product | None:
        """Write a direction as a product of powers, the largest of which is 1."""
        unknowns = self.scales.unknowns
        powers = vector / [each.span for each in unknowns]
        shares = abs(vector)
        some = [place for place in range(len(unknowns)) if shares[place] > (1 - _ALONE**2) ** 0.5]
        mixed = set(self.unidentifiable) & {unknowns[place].name for place in some}
        if len(some) < 2 or not mixed or not all(unknowns[place].logarithmic for place in some):
            return None
        powers = powers / powers[some[numpy.argmax(abs(powers[some]))]]
        exponents = {unknowns[place].name: _round(float(powers[place])) for place in some}
        product = self._band(exponents)
        spans = [each.span for each in unknowns]
        factors = [abs(self._band_direction(i)[i]) * spans[i] for i in some if unknowns[i].name in mixed]
        return product if log(product.high / product.low) < TOLD * min(factors) else None

    def _band(self, exponents: dict[str, float]) -> Product:
        """Compute a product with its band, at the best point and over the bands of the unidentifiable unknowns."""
        weight = numpy.array([exponents.get(name, 0.0) for name in self.scales.names])
        along = weight * [each.span for each in self.scales.unknowns]
        known = numpy.diag([float(each.known) for each in self.scales.unknowns])
        left = numpy.linalg.pinv(self._determined + known, rcond=1e-9, hermitian=True)
        half = self.quantile * float(along @ left @ along) ** 0.5
        middle = self._logarithm(exponents, self.places)
        lost = [self.intervals[self.scales.names.index(name)] for name in self.unidentifiable]
        ends = [self._logarithm(exponents, end.theta) for interval in lost for end in (interval.low, interval.high)]
        low, high = min(middle - half, *ends), max(middle + half, *ends)
        units = {each.name: each.quantity.unit for each in self.scales.unknowns}
        unit = " ".join(
            units[name] if power == 1 else f"{units[name]}^{power:.3g}" for name, power in exponents.items()
        )
        return Product(exponents, unit, exp(middle), exp(low), exp(high))

    def _logarithm(self, exponents: Mapping[str, float], theta: Numbers) -> float:
        values = dict(zip(self.scales.names, self.scales.values(theta).tolist(), strict=True))
        return sum(power * log(values[name]) for name, power in exponents.items())


def _share(unknown: Unknown, interval: Interval, index: int) -> float:
    """Compute the width of a band over that of the range, or over the band of 95 % of a distribution."""
    width = float(interval.high.theta[index] - interval.low.theta[index])
    return width / (2 * WIDE if unknown.known else sqrt(12))


def _modes(matrix: Numbers) -> tuple[Numbers, Numbers]:
    """Eigenvalues, the largest first, and their directions in columns."""
    values, vectors = numpy.linalg.eigh((matrix + matrix.T) / 2)
    return numpy.maximum(values[::-1], 0.0), vectors[:, ::-1]


def _round(power: float) -> float:
    """A whole or a half number that is as near as the data could tell."""
    near = round(2 * power) / 2
    return near if abs(power - near) < 0.1 and near else power
