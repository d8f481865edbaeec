"""What is to be found: numbers of a joint or a machine, what was known of them, and the scales they are sought on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf, log, sqrt
from typing import Any

import numpy

from ..core.arrays import Array, Numbers
from ..core.checks import check_names, require, shown
from ..core.kinds import Kind
from ..core.quantities import Quantity
from ..studies.distributions import Distribution, LogNormal, Normal, Rectangular
from ..studies.parameters import AIMS, LOADS, PARAMETERS
from .measured import MACHINE, Measured

Given = Any
"""Of an unknown: two ends, (0.02, 0.3), or a distribution of what was known."""

_FAR = 8.0  # deviations from a mean that is known: as good as infinitely far


@dataclass(frozen=True, kw_only=True)
class Unknown:
    """A number that is to be found.

    Attributes
    ----------
    name : str
        "clearance", "liner_young", "machine.offset".
    quantity : Quantity
        Its title and unit.
    prior : Rectangular, Normal or LogNormal
        What was known before.
    low, high : float
        Where it is sought.
    logarithmic : bool
        Whether it is sought on a scale of ratios: where both ends are above 0, or a logarithm was known.
    """

    name: str
    quantity: Quantity
    prior: Distribution
    low: float
    high: float
    logarithmic: bool

    @property
    def known(self) -> bool:
        """Whether more than two ends were known."""
        return not isinstance(self.prior, Rectangular)

    @property
    def middle(self) -> float:
        """The mean that was known, in deviations on the scale; 0 of two ends."""
        if isinstance(self.prior, Rectangular):
            return 0.0
        return (self.prior.mean if isinstance(self.prior, Normal) else log(self.prior.median)) / self.span

    @property
    def span(self) -> float:
        """The deviation of what was known, on the scale it is sought on."""
        if isinstance(self.prior, Normal):
            return self.prior.deviation
        if isinstance(self.prior, LogNormal):
            return log(self.prior.factor)
        return (self.to_scale(self.high) - self.to_scale(self.low)) / sqrt(12)

    def is_physical(self, side: int, place: float) -> bool:
        """Check if a value lies at a physical limit of the range, such as a compliance of 0."""
        end = self.high if side > 0 else self.low
        beyond = end + side * 1e-6 * max(abs(end), 1e-12)
        return abs(place - self.to_scale(end) / self.span) < 1e-6 and not self.quantity.allows(beyond)

    def to_scale(self, value: Array) -> Array:
        return numpy.log(value) if self.logarithmic else value

    def from_scale(self, place: Array) -> Array:
        return numpy.exp(place) if self.logarithmic else place

    def growth(self, place: Array) -> Array:
        """The number's slope along its scale."""
        return numpy.exp(place) if self.logarithmic else numpy.ones_like(place)


def unknowns_of(free: Mapping[str, Given], data: Iterable[Measured]) -> tuple[Unknown, ...]:
    """What is to be found: numbers of the joint by their names in studies, "liner_young" or "liner.young"; machines.

    Raises
    ------
    ValueError
        A name that is not known, given twice, or of a load; ends that are not allowed.
    """
    known = {name: each for name, each in PARAMETERS.items() if name not in LOADS and name not in AIMS}
    plain = {name.replace(".", "_"): value for name, value in free.items()}
    if len(plain) < len(free):
        raise ValueError(f"an unknown is given twice: {', '.join(free)}")
    check_names(plain, known, "among what can be found")
    own = [_unknown(name, known[name], value) for name, value in plain.items()]
    return (*own, *_of_machines(data))


def _of_machines(data: Iterable[Measured]) -> list[Unknown]:
    machines = {each.machine.name: each.machine for each in data}
    for each in data:
        if each.machine != machines[each.machine.name]:
            raise ValueError(f"two machines are called {shown(each.machine.name)}: give each a name of its own")
    return [
        _unknown(key, MACHINE[key.rsplit(".", 1)[1]], ends)
        for machine in machines.values()
        for key, ends in machine.unknowns.items()
    ]


def _unknown(name: str, quantity: Quantity, given: Given) -> Unknown:
    prior = _prior(name, given)
    low, high = _ends(prior, quantity)
    for end in (low, high):
        require(name, end, quantity.allows(end), quantity.allowed)
    ratios = isinstance(prior, Rectangular) and low > 0 and quantity.kind is not Kind.NUMBER
    logarithmic = ratios or isinstance(prior, LogNormal)
    return Unknown(name=name, quantity=quantity, prior=prior, low=low, high=high, logarithmic=logarithmic)


def _prior(name: str, given: Given) -> Distribution:
    if isinstance(given, Distribution):
        return given
    try:
        low, high = map(float, given)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} = {shown(given)} must be two ends, such as (0.02, 0.3), or a distribution") from error
    if not -inf < low < high < inf:
        raise ValueError(f"{name} = {shown(given)} is not allowed: two finite ends that go upwards")
    return Rectangular(low=low, high=high)


def _ends(prior: Distribution, quantity: Quantity) -> tuple[float, float]:
    """Where it is sought: between the ends, or a few deviations about a mean, as far as that is allowed."""
    if isinstance(prior, Rectangular):
        return prior.low, prior.high
    if isinstance(prior, LogNormal):
        return prior.median / prior.factor**_FAR, prior.median * prior.factor**_FAR
    low, high = (prior.mean + side * _FAR * prior.deviation for side in (-1, 1))
    low, high = max(low, prior.low), min(high, prior.high)
    if not quantity.allows(low):
        low = 1e-3 * prior.mean
    return low, high if quantity.allows(high) else 0.5


@dataclass(frozen=True)
class Scales:
    """Between the numbers that are sought and their places on scales that run over what was known."""

    unknowns: tuple[Unknown, ...]

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(each.name for each in self.unknowns)

    @property
    def low(self) -> Numbers:
        return self.places([each.low for each in self.unknowns])

    @property
    def high(self) -> Numbers:
        return self.places([each.high for each in self.unknowns])

    def places(self, values: Any) -> Numbers:
        """From numbers (..., unknowns) to places, in deviations of what was known."""
        columns = numpy.moveaxis(numpy.asarray(values, dtype=float), -1, 0)
        pairs = zip(self.unknowns, columns, strict=True)
        return numpy.stack([each.to_scale(column) / each.span for each, column in pairs], axis=-1)

    def values(self, places: Numbers) -> Numbers:
        """The way back."""
        pairs = zip(self.unknowns, numpy.moveaxis(places, -1, 0), strict=True)
        return numpy.stack([each.from_scale(column * each.span) for each, column in pairs], axis=-1)

    def growth(self, places: Numbers) -> Numbers:
        """The slopes of the numbers along their places."""
        pairs = zip(self.unknowns, numpy.moveaxis(places, -1, 0), strict=True)
        return numpy.stack([each.growth(column * each.span) * each.span for each, column in pairs], axis=-1)

    def surprise(self, places: Numbers) -> Numbers:
        """How many deviations each number is from a mean that was known, 0 of the others; (..., unknowns)."""
        known = numpy.array([each.known for each in self.unknowns])
        return numpy.where(known, places - [each.middle for each in self.unknowns], 0.0)


def log_prior(scales: Scales, places: Numbers) -> Numbers:
    """ln of the density of what was known, by places; -inf beyond the ends, between which all is equally likely."""
    inside = numpy.all((places >= scales.low) & (places <= scales.high), axis=-1)
    flat = numpy.array([0.0 if each.known else 1.0 for each in scales.unknowns])
    stretch = numpy.sum(flat * numpy.log(scales.growth(places)), axis=-1)
    surprise = numpy.sum(scales.surprise(places) ** 2, axis=-1) / 2
    return numpy.where(inside, stretch - surprise, -inf)
