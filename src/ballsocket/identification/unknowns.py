"""Unknowns of an identification, their prior distributions, and the scaled parameters of the search."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf, log, sqrt
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Array, Numbers
from ..core.checks import check_names, require, shown
from ..core.kinds import Kind
from ..core.quantities import Quantity
from ..model_catalogue import catalogue
from ..studies.distributions import Distribution, LogNormal, Normal, Rectangular
from .measured import Machine
from .registry import FREE_NUMBERS, MACHINE_ERRORS, MODEL_NUMBERS

Prior = Any
"""Prior of an unknown as a caller states it: two ends, (0.02, 0.3), or a distribution."""

_SEARCH_DEVIATIONS = 8.0  # half width of the search range about a known mean, in standard deviations


@dataclass(frozen=True, kw_only=True)
class Unknown:
    """Unknown number of an identification, with its prior and search range."""

    name: str  # "clearance", "liner_young", "work_of_adhesion", "machine.offset"
    quantity: Quantity  # title, unit and allowed range
    prior: Distribution  # prior distribution
    # ends of the search range
    low: float
    high: float
    logarithmic: bool  # True for a logarithmic scale: both ends are above 0, or the prior is log-normal
    of_machine: bool = False  # True for an error of a machine, False for a number of the joint or of the model

    @property
    def has_distribution(self) -> bool:
        """True if the prior is a distribution, False if it is only a range."""
        return not isinstance(self.prior, Rectangular)

    @property
    def prior_mean(self) -> float:
        """Mean of the prior on the search scale, in standard deviations of the prior; 0 for a range."""
        if isinstance(self.prior, Rectangular):
            return 0.0
        return (self.prior.mean if isinstance(self.prior, Normal) else log(self.prior.median)) / self.prior_deviation

    @property
    def prior_deviation(self) -> float:
        """Standard deviation of the prior on the search scale."""
        if isinstance(self.prior, Normal):
            return self.prior.deviation
        if isinstance(self.prior, LogNormal):
            return log(self.prior.factor)
        return (self.to_scale(self.high) - self.to_scale(self.low)) / sqrt(12)

    def is_physical(self, side: int, theta: float) -> bool:
        """Check if theta is at an end of the range that is a physical limit, such as a compliance of 0."""
        end = self.high if side > 0 else self.low
        beyond = end + side * 1e-6 * max(abs(end), 1e-12)
        return abs(theta - self.to_scale(end) / self.prior_deviation) < 1e-6 and not self.quantity.allows(beyond)

    def to_scale(self, value: Array) -> Array:
        """Convert a value of the unknown to the search scale: its logarithm, or the value itself."""
        return numpy.log(value) if self.logarithmic else value


def collect_unknowns(free: Mapping[str, Prior], machines: Iterable[Machine], model: Model) -> tuple[Unknown, ...]:
    """List all unknowns of an identification: free numbers, and machine errors with ranges.

    Free are names of `registry.FREE_NUMBERS`; "liner.young" is the same as "liner_young".

    Raises ValueError: a name that is not known or is stated twice; a number that the model does not have; ends that are
    not allowed; two machines with the same name.
    """
    priors = {name.replace(".", "_"): prior for name, prior in free.items()}
    if len(priors) < len(free):
        raise ValueError(f"an unknown is stated twice: {', '.join(free)}")
    check_names(priors, FREE_NUMBERS, "among the unknowns")
    for name in priors:
        if name in MODEL_NUMBERS and not MODEL_NUMBERS[name].belongs_to(model):
            models = ", ".join(key for key, known in catalogue.items() if MODEL_NUMBERS[name].belongs_to(known))
            raise ValueError(f"{name} is not a number of the model {model.name}; models that have it: {models}")
    number_unknowns = [_make_unknown(name, FREE_NUMBERS[name], prior) for name, prior in priors.items()]
    machines_by_name: dict[str, Machine] = {}
    for machine in machines:
        if machines_by_name.setdefault(machine.name, machine) != machine:
            raise ValueError(f"two machines have the name {shown(machine.name)}; use different names")
    machine_unknowns = [
        _make_unknown(machine.key(error), MACHINE_ERRORS[error].quantity, size, of_machine=True)
        for machine in machines_by_name.values()
        for error, size in machine.errors
        if isinstance(size, tuple)
    ]
    return (*number_unknowns, *machine_unknowns)


def _make_unknown(name: str, quantity: Quantity, stated_prior: Prior, of_machine: bool = False) -> Unknown:
    if isinstance(stated_prior, Distribution):
        prior = stated_prior
    else:
        try:
            least, largest = map(float, stated_prior)
        except (TypeError, ValueError) as error:
            raise ValueError(
                f"{name} = {shown(stated_prior)} must be two ends, such as (0.02, 0.3), or a distribution"
            ) from error
        if not -inf < least < largest < inf:
            raise ValueError(f"{name} = {shown(stated_prior)} is not allowed: two finite ends in ascending order")
        prior = Rectangular(low=least, high=largest)
    low, high = _search_range(prior, quantity)
    for end in (low, high):
        require(name, end, quantity.allows(end), quantity.allowed)
    logarithmic_range = isinstance(prior, Rectangular) and low > 0 and quantity.kind is not Kind.NUMBER
    return Unknown(
        name=name,
        quantity=quantity,
        prior=prior,
        low=low,
        high=high,
        logarithmic=logarithmic_range or isinstance(prior, LogNormal),
        of_machine=of_machine,
    )


def _search_range(prior: Distribution, quantity: Quantity) -> tuple[float, float]:
    """Return the ends of the search range: those of a range, or eight deviations about a mean, if allowed."""
    if isinstance(prior, Rectangular):
        return prior.low, prior.high
    if isinstance(prior, LogNormal):
        factor = prior.factor**_SEARCH_DEVIATIONS
        return prior.median / factor, prior.median * factor
    low, high = (prior.mean + side * _SEARCH_DEVIATIONS * prior.deviation for side in (-1, 1))
    low, high = max(low, prior.low), min(high, prior.high)
    if not quantity.allows(low):
        low = 1e-3 * prior.mean
    return low, high if quantity.allows(high) else 0.5


@dataclass(frozen=True)
class ParameterTransform:
    """Transform between values of the unknowns and scaled parameters theta.

    Theta is the value, or its logarithm, over the standard deviation of the prior.
    """

    unknowns: tuple[Unknown, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the unknowns."""
        return tuple(unknown.name for unknown in self.unknowns)

    @cached_property
    def has_distribution(self) -> Numbers:
        """Mask (unknowns,) of the unknowns whose prior is a distribution, not only a range."""
        return numpy.array([unknown.has_distribution for unknown in self.unknowns])

    @cached_property
    def deviations(self) -> Numbers:
        """Standard deviations (unknowns,) of the priors on the search scale."""
        return numpy.array([unknown.prior_deviation for unknown in self.unknowns])

    @cached_property
    def _logarithmic(self) -> Numbers:
        return numpy.array([unknown.logarithmic for unknown in self.unknowns])

    @property
    def low(self) -> Numbers:
        """Lower ends of the search ranges, as scaled parameters theta (unknowns,)."""
        return self.to_theta([unknown.low for unknown in self.unknowns])

    @property
    def high(self) -> Numbers:
        """Upper ends of the search ranges, as scaled parameters theta (unknowns,)."""
        return self.to_theta([unknown.high for unknown in self.unknowns])

    def to_theta(self, values: Any) -> Numbers:
        """Convert values of the unknowns (..., unknowns) to scaled parameters theta."""
        scaled = numpy.array(values, dtype=float)
        scaled[..., self._logarithmic] = numpy.log(scaled[..., self._logarithmic])
        return scaled / self.deviations

    def to_values(self, theta: Numbers) -> Numbers:
        """Convert scaled parameters theta (..., unknowns) to values of the unknowns."""
        values: Numbers = theta * self.deviations
        values[..., self._logarithmic] = numpy.exp(values[..., self._logarithmic])
        return values

    def derivatives(self, theta: Numbers) -> Numbers:
        """Compute the derivative of each unknown's value with respect to its theta: (..., unknowns)."""
        return numpy.where(self._logarithmic, self.to_values(theta), 1.0) * self.deviations

    def prior_residuals(self, theta: Numbers) -> Numbers:
        """Compute the deviation of each theta from its prior mean, in standard deviations.

        It is 0 for a range.
        """
        return numpy.where(self.has_distribution, theta - [unknown.prior_mean for unknown in self.unknowns], 0.0)


def log_prior(transform: ParameterTransform, theta: Numbers) -> Numbers:
    """Compute the logarithm of the prior density of theta, up to a constant; -inf outside the search ranges.

    All values in a range are equally likely.
    """
    in_range = numpy.all((theta >= transform.low) & (theta <= transform.high), axis=-1)
    log_jacobian = numpy.sum(numpy.log(transform.derivatives(theta))[..., ~transform.has_distribution], axis=-1)
    half_squares = numpy.sum(transform.prior_residuals(theta) ** 2, axis=-1) / 2
    return numpy.where(in_range, log_jacobian - half_squares, -inf)
