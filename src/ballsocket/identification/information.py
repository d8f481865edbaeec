"""Identifiability: information of the data, unidentifiable unknowns, and identifiable products."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import exp, inf, log, sqrt
from typing import Any

import numpy

from ..core.arrays import Numbers
from .unknowns import ParameterTransform

MAX_WIDTH_RATIO = 0.5
"""Largest width of the band of an identifiable unknown over its prior range."""

MAX_SHIFT = 0.1
"""Largest shift of an identifiable unknown by an unidentifiable one, as a fraction of the prior range."""

QUANTILE_95 = 1.959963984540054
"""Half width of a band of 95 % in standard deviations."""

QUANTILE_99 = 2.5758293035489004
"""Half width of an interval of 99 % in standard deviations; it ends inside the range of an identifiable unknown."""

_MIN_MIXED_COMPONENT = (1 - 0.97**2) ** 0.5  # smallest component of a direction that counts as a factor of a product
_MIN_SINGULAR_VALUE = 0.5  # smallest singular value of independent unit directions


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
        return {"name": self.name, **vars(self)}


@dataclass(frozen=True, eq=False)
class ProfileEnd:
    """Lower or upper end of a profile likelihood interval."""

    theta: Numbers  # (unknowns,), scaled parameters at the end; all other unknowns are fitted
    closed: bool  # True where χ² reaches its limit; False where the range of the unknown ends first
    limited_by: tuple[int, ...]  # indices of the unknowns at an end of their ranges that increase χ² there


@dataclass(frozen=True, eq=False)
class ProfileInterval:
    """Profile likelihood interval of an unknown."""

    # ends of the band of 95 %
    low: ProfileEnd
    high: ProfileEnd
    closed: bool  # True where the interval of 99 % ends inside the range, or at a physical limit

    @property
    def limiting_indices(self) -> frozenset[int]:
        """Indices of the unknowns whose search ranges limit the 95 % interval."""
        return frozenset((*self.low.limited_by, *self.high.limited_by))


@dataclass(frozen=True, eq=False)
class Information:
    """Fisher information of the data about the unknowns, with identifiability and covariance.

    Attributes
    ----------
    transform : ParameterTransform
    theta : array (unknowns,)
        Best point, in standard deviations of the priors.
    matrix : array (unknowns, unknowns)
        Fisher information of the data there; 1 is the information of the prior.
    intervals : tuple of ProfileInterval
        Profile intervals over the ranges of the unknowns; `matrix` is local.
    quantile : float
        Standard deviations to either side of a band of 95 %; more than 1.96 where the scatter is too large.
    """

    transform: ParameterTransform
    theta: Numbers
    matrix: Numbers
    intervals: tuple[ProfileInterval, ...]
    quantile: float = QUANTILE_95

    @cached_property
    def _eigenvalues_and_vectors(self) -> tuple[Numbers, Numbers]:
        """Eigenvalues (descending) and eigenvectors (columns) of the Fisher information matrix."""
        values, vectors = numpy.linalg.eigh((self.matrix + self.matrix.T) / 2)
        return numpy.maximum(values[::-1], 0.0), vectors[:, ::-1]

    @property
    def eigenvalues(self) -> Numbers:
        """Eigenvalues of the Fisher information matrix, in descending order."""
        return self._eigenvalues_and_vectors[0]

    @cached_property
    def rank(self) -> int:
        """Number of independent directions in the space of unknowns that the data identify.

        It is full if every unknown is identifiable.
        """
        unidentifiable = [self.transform.names.index(name) for name in self.unidentifiable]
        if not unidentifiable:
            return len(self.transform.names)
        directions = numpy.stack([self._band_vector(index) for index in unidentifiable], axis=1)
        directions /= numpy.linalg.norm(directions, axis=0)
        n_unidentifiable = int(numpy.linalg.matrix_rank(directions, tol=_MIN_SINGULAR_VALUE))
        return len(self.transform.names) - max(1, n_unidentifiable)

    @property
    def condition(self) -> float:
        """Ratio of largest to smallest eigenvalue of the information; infinite if the smallest is 0."""
        values = self.eigenvalues
        return float(values[0] / values[-1]) if values[-1] > 1e-12 * values[0] else inf

    @cached_property
    def deviations(self) -> Mapping[str, float]:
        """Width of each 95 % band divided by the width of the prior range, by unknown."""
        # the prior width is that of the range, or of the 95 % band of a distribution
        return {
            unknown.name: float(self._band_vector(index)[index])
            / (2 * QUANTILE_95 if unknown.has_distribution else sqrt(12))
            for index, unknown in enumerate(self.transform.unknowns)
        }

    @cached_property
    def unidentifiable(self) -> tuple[str, ...]:
        """Names of the unknowns that the data do not identify and that have no prior distribution.

        One of three conditions holds. The profile interval of 99 % leaves the range. The band of 95 % takes half of the
        range or more. The range of another unidentifiable unknown limits the band and shifts it by a tenth or more.
        """
        width_ratios, unknowns = self.deviations, self.transform.unknowns
        range_indices = [index for index, unknown in enumerate(unknowns) if not unknown.has_distribution]
        wide_indices = {
            index
            for index in range_indices
            if not self.intervals[index].closed or width_ratios[unknowns[index].name] >= MAX_WIDTH_RATIO
        }
        # the range of another unknown limits the band, and shifts it by 10 % or more
        shifted_indices = {
            index
            for index in range_indices
            if any(
                limiting in self.intervals[index].limiting_indices
                and abs(self._band_vector(limiting)[index]) >= MAX_SHIFT * sqrt(12)
                for limiting in wide_indices - {index}
            )
        }
        return tuple(unknown.name for index, unknown in enumerate(unknowns) if index in wide_indices | shifted_indices)

    def _band_vector(self, index: int) -> Numbers:
        """Compute the change of all thetas from the lower to the upper end of one unknown's 95 % band."""
        interval = self.intervals[index]
        return interval.high.theta - interval.low.theta

    def limited_by(self, name: str) -> tuple[str, ...]:
        """List the names of the unknowns whose search ranges limit the band of an unknown.

        The name of the unknown itself may be one of them.
        """
        limiting_indices = self.intervals[self.transform.names.index(name)].limiting_indices
        unknowns = enumerate(self.transform.unknowns)
        return tuple(
            unknown.name for index, unknown in unknowns if index in limiting_indices and not unknown.has_distribution
        )

    @cached_property
    def _identifiable_information(self) -> Numbers:
        values, vectors = self._eigenvalues_and_vectors
        return (vectors[:, : self.rank] * values[: self.rank]) @ vectors[:, : self.rank].T

    @cached_property
    def covariance(self) -> Numbers:
        """Covariance matrix of theta from the data and the prior distributions.

        In unidentifiable directions the ranges count as priors.
        """
        has_prior = self.transform.has_distribution | numpy.isin(self.transform.names, self.unidentifiable)
        return numpy.linalg.inv(self._identifiable_information + numpy.diag(has_prior.astype(float)))

    @cached_property
    def products(self) -> tuple[Product, ...]:
        """Identifiable products of powers of unknowns that are unidentifiable separately."""
        if not self.unidentifiable:
            return ()
        vectors = self._eigenvalues_and_vectors[1][:, : self.rank]
        return tuple(filter(None, map(self._product_from_eigenvector, vectors.T)))

    def _product_from_eigenvector(self, vector: Numbers) -> Product | None:
        """Convert an eigenvector to a product of powers, of which the largest is 1; None if it is not identifiable."""
        unknowns = self.transform.unknowns
        prior_deviations = self.transform.deviations
        powers = vector / prior_deviations
        factor_indices = [index for index in range(len(unknowns)) if abs(vector)[index] > _MIN_MIXED_COMPONENT]
        unidentifiable_factors = set(self.unidentifiable) & {unknowns[index].name for index in factor_indices}
        are_logarithmic = all(unknowns[index].logarithmic for index in factor_indices)
        if len(factor_indices) < 2 or not unidentifiable_factors or not are_logarithmic:
            return None
        powers = powers / powers[factor_indices[numpy.argmax(abs(powers[factor_indices]))]]
        exponents = {}
        for index in factor_indices:
            power = float(powers[index])
            half_integer = round(2 * power) / 2
            is_near = abs(power - half_integer) < 0.1 and half_integer
            exponents[unknowns[index].name] = half_integer if is_near else power
        product = self._product_band(exponents)
        band_widths = [
            abs(self._band_vector(index)[index]) * prior_deviations[index]
            for index in factor_indices
            if unknowns[index].name in unidentifiable_factors
        ]
        return product if log(product.high / product.low) < MAX_WIDTH_RATIO * min(band_widths) else None

    def _product_band(self, exponents: dict[str, float]) -> Product:
        """Compute a product of powers and its 95 % band, which includes those of the unidentifiable unknowns."""
        exponent_vector = numpy.array([exponents.get(name, 0.0) for name in self.transform.names])
        direction = exponent_vector * self.transform.deviations
        prior_information = numpy.diag(self.transform.has_distribution.astype(float))
        covariance = numpy.linalg.pinv(self._identifiable_information + prior_information, rcond=1e-9, hermitian=True)
        half_width = self.quantile * float(direction @ covariance @ direction) ** 0.5

        def log_product(theta: Numbers) -> float:
            values = dict(zip(self.transform.names, self.transform.to_values(theta).tolist(), strict=True))
            return sum(power * log(values[name]) for name, power in exponents.items())

        log_value = log_product(self.theta)
        intervals = [self.intervals[self.transform.names.index(name)] for name in self.unidentifiable]
        log_ends = [log_product(end.theta) for interval in intervals for end in (interval.low, interval.high)]
        low, high = min(log_value - half_width, *log_ends), max(log_value + half_width, *log_ends)
        units = {unknown.name: unknown.quantity.unit for unknown in self.transform.unknowns}
        unit = " ".join(
            units[name] if power == 1 else f"{units[name]}^{power:.3g}" for name, power in exponents.items()
        )
        return Product(exponents, unit, exp(log_value), exp(low), exp(high))
