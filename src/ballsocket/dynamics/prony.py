"""A modulus that relaxes: the generalised Maxwell model, with its creep and its answer to vibration."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy

from ..core.arrays import Numbers
from ..core.checks import require


@dataclass(frozen=True, kw_only=True)
class Prony:
    """The modulus of a liner over time as a share of that at once: g(t) = g∞ + Σ g_i exp(-t/τ_i), g(0) = 1.

    Parameters
    ----------
    terms : tuple of (float, float)
        Shares g_i, above 0 and less than 1 in all, and times τ_i in s. What the shares leave is g∞.

    Raises
    ------
    ValueError
        No terms; a share or a time that is not above 0; shares of 1 or more in all.
    """

    terms: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        terms = tuple((float(share), float(time)) for share, time in self.terms)
        require("the number of terms", len(terms), len(terms) > 0, "a modulus that relaxes has at least one")
        for share, time in terms:
            require("a share", share, 0.0 < share < 1.0, "each is above 0 and below 1")
            require("a time", time, 0.0 < time < inf, "a time of relaxation (s) is above 0 and finite")
        total = sum(share for share, _ in terms)
        require("the sum of the shares", total, total < 1.0, "some of the modulus has to stay")
        object.__setattr__(self, "terms", terms)

    @property
    def shares(self) -> Numbers:
        return numpy.array([share for share, _ in self.terms])

    @property
    def times(self) -> Numbers:
        return numpy.array([time for _, time in self.terms])

    @property
    def rest(self) -> float:
        """g∞, what stays."""
        return 1.0 - sum(share for share, _ in self.terms)

    def relaxed(self, time: Numbers) -> Numbers:
        """g(t) of times in s, 0 or more."""
        ages = numpy.asarray(time, dtype=float)[..., None]
        return self.rest + numpy.sum(self.shares * numpy.exp(-ages / self.times), axis=-1)

    def mean(self, early: Numbers, late: Numbers) -> Numbers:
        """The mean of g between two times in s, the first below the second."""
        first, span = early[..., None] / self.times, (late - early)[..., None] / self.times
        return self.rest + numpy.sum(self.shares * numpy.exp(-first) * -numpy.expm1(-span) / span, axis=-1)

    def complex_modulus(self, frequency: Numbers) -> Numbers:
        """g∞ + Σ g_i iωτ/(1 + iωτ) of frequencies in Hz; its imaginary part is what is lost."""
        turned = 2j * numpy.pi * numpy.asarray(frequency, dtype=float)[..., None] * self.times
        return self.rest + numpy.sum(self.shares * turned / (1 + turned), axis=-1)

    def crept(self, time: Numbers) -> Numbers:
        """J(t), the strain of a stress that stays 1: from 1 to 1/g∞."""
        rates, weights = self._retardation
        return 1.0 / self.rest - numpy.sum(weights * numpy.exp(-numpy.asarray(time)[..., None] * rates), axis=-1)

    @cached_property
    def _retardation(self) -> tuple[Numbers, Numbers]:
        # strains of the dashpots r: τ r' = 1 + g·r - r, made symmetric by sqrt(g τ); J = 1 + g·r
        g, tau = self.shares, self.times
        root = numpy.sqrt(g / tau)
        rates, modes = numpy.linalg.eigh(numpy.diag(1.0 / tau) - root[:, None] * root)
        return rates, (modes.T @ root) ** 2 / rates
