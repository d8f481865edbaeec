"""How readings scatter about the truth: normally, or with tails in which an outlier is nothing unheard of."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, lgamma, log, pi
from typing import Protocol

import numpy

from ..core.arrays import Numbers
from ..core.checks import require


class Scatter(Protocol):
    """What is asked of a scatter: z is (answer - value)/uncertainty."""

    def misfit(self, z: Numbers) -> Numbers:
        """r with r²/2 = -ln of the density over the density at 0."""

    def slope(self, z: Numbers) -> Numbers:
        """dr/dz."""

    def beyond(self, z: Numbers) -> tuple[Numbers, Numbers]:
        """Misfit and slope of a reading that was cut off: r with r²/2 = -ln P(reading above answer - z), and dr/dz."""

    @property
    def told(self) -> float:
        """Fisher information of a reading about its centre, in 1/uncertainty²."""

    @property
    def constant(self) -> float:
        """ln of the density at 0, for an uncertainty of 1."""

    def draw(self, count: int, random: numpy.random.Generator) -> Numbers:
        """Readings about 0 with an uncertainty of 1."""


@dataclass(frozen=True)
class NormalScatter:
    """Readings that scatter normally about the truth."""

    @property
    def told(self) -> float:
        return 1.0

    @property
    def constant(self) -> float:
        return -log(2 * pi) / 2

    def misfit(self, z: Numbers) -> Numbers:
        return z

    def slope(self, z: Numbers) -> Numbers:
        return numpy.ones_like(z)

    def beyond(self, z: Numbers) -> tuple[Numbers, Numbers]:
        from scipy.special import log_ndtr

        logarithm = log_ndtr(z)
        return _cut_off(logarithm, numpy.exp(self.constant - z * z / 2 - logarithm))

    def draw(self, count: int, random: numpy.random.Generator) -> Numbers:
        return random.standard_normal(count)


@dataclass(frozen=True, kw_only=True)
class HeavyTailed:
    """Readings with Student's t about the truth: an outlier far off costs little, and moves little.

    Parameters
    ----------
    degrees : float
        Of freedom, above 0; 4 holds 5 % of the readings beyond 2.8 uncertainties, and many are the normal scatter.

    References
    ----------
    Lange, Little & Taylor 1989, J. Am. Stat. Assoc. 84, 881.
    """

    degrees: float = 4.0

    def __post_init__(self) -> None:
        require("degrees", self.degrees, 0 < self.degrees < inf, "degrees of freedom are above 0 and finite")

    @property
    def told(self) -> float:
        return (self.degrees + 1) / (self.degrees + 3)

    @property
    def constant(self) -> float:
        n = self.degrees
        return lgamma((n + 1) / 2) - lgamma(n / 2) - log(n * pi) / 2

    def misfit(self, z: Numbers) -> Numbers:
        return numpy.sign(z) * numpy.sqrt((self.degrees + 1) * numpy.log1p(z * z / self.degrees))

    def slope(self, z: Numbers) -> Numbers:
        n, r = self.degrees, self.misfit(z)
        near = abs(z) < 1e-6
        return numpy.where(near, ((n + 1) / n) ** 0.5, (n + 1) * z / (n + z * z) / numpy.where(near, 1.0, r))

    def beyond(self, z: Numbers) -> tuple[Numbers, Numbers]:
        from scipy.special import stdtr

        share = numpy.maximum(stdtr(self.degrees, z), 1e-300)
        return _cut_off(numpy.log(share), numpy.exp(self.constant - self.misfit(z) ** 2 / 2) / share)

    def draw(self, count: int, random: numpy.random.Generator) -> Numbers:
        return random.standard_t(self.degrees, count)


def _cut_off(logarithm: Numbers, hazard: Numbers) -> tuple[Numbers, Numbers]:
    """r and dr/dz from ln P and its slope."""
    r = numpy.sqrt(-2 * numpy.minimum(logarithm, 0.0))
    return r, numpy.where(r > 1e-150, -hazard / numpy.maximum(r, 1e-150), 0.0)
