"""Statistical models of the scatter of readings: normal, or heavy-tailed."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sqrt
from typing import Protocol

import numpy

from ..core.arrays import Numbers
from ..core.checks import require


class ScatterModel(Protocol):
    """Interface of a distribution of the standardised residual z = (result - value)/uncertainty."""

    def misfit(self, z: Numbers) -> Numbers:
        """Compute the least-squares residual r(z) from the standardised residual z.

        r²/2 is minus ln of the density, relative to the density at 0.
        """

    def slope(self, z: Numbers) -> Numbers:
        """Compute the derivative dr/dz of the least-squares residual r(z)."""

    def censored(self, z: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the least-squares residual of a saturated reading and its derivative, from z.

        r²/2 is minus ln of the probability of a reading above the limit.
        """

    @property
    def information(self) -> float:
        """Fisher information of one reading about the true value, in 1/uncertainty²."""

    def draw(self, count: int, random: numpy.random.Generator) -> Numbers:
        """Draw random readings about 0 with an uncertainty of 1."""


@dataclass(frozen=True)
class NormalScatter(ScatterModel):
    """Normal distribution of the readings about the true value."""

    @property
    def information(self) -> float:
        return 1.0

    def misfit(self, z: Numbers) -> Numbers:
        return z

    def slope(self, z: Numbers) -> Numbers:
        return numpy.ones_like(z)

    def censored(self, z: Numbers) -> tuple[Numbers, Numbers]:
        from scipy.special import log_ndtr

        log_probability = log_ndtr(z)
        return _censored_residual(log_probability, numpy.exp(-z * z / 2 - log_probability) / sqrt(2 * pi))

    def draw(self, count: int, random: numpy.random.Generator) -> Numbers:
        return random.standard_normal(count)


@dataclass(frozen=True, kw_only=True)
class HeavyTailed(ScatterModel):
    """Student's t distribution of the readings, which limits the influence of outliers.

    Parameters
    ----------
    degrees : float
        Degrees of freedom, above 0. With 4, 5 % of the readings lie beyond 2.8 uncertainties. The limit of infinitely
        many is normal scatter.

    Raises
    ------
    ValueError
        Degrees of freedom that are not above 0 and finite.

    References
    ----------
    Lange, Little & Taylor 1989, J. Am. Stat. Assoc. 84, 881.
    """

    degrees: float = 4.0

    def __post_init__(self) -> None:
        require("degrees", self.degrees, 0 < self.degrees < inf, "degrees of freedom are above 0 and finite")

    @property
    def information(self) -> float:
        return (self.degrees + 1) / (self.degrees + 3)

    def misfit(self, z: Numbers) -> Numbers:
        # r = ±sqrt((n + 1) ln(1 + z²/n)) for n degrees of freedom
        return numpy.sign(z) * numpy.sqrt((self.degrees + 1) * numpy.log1p(z * z / self.degrees))

    def slope(self, z: Numbers) -> Numbers:
        n, r = self.degrees, self.misfit(z)
        at_centre = abs(z) < 1e-6  # the limit of dr/dz at 0 is sqrt((n + 1)/n)
        slope = (n + 1) * z / (n + z * z) / numpy.where(at_centre, 1.0, r)
        return numpy.where(at_centre, ((n + 1) / n) ** 0.5, slope)

    def censored(self, z: Numbers) -> tuple[Numbers, Numbers]:
        from scipy.stats import t

        probability = numpy.maximum(t.cdf(z, self.degrees), 1e-300)
        return _censored_residual(numpy.log(probability), t.pdf(z, self.degrees) / probability)

    def draw(self, count: int, random: numpy.random.Generator) -> Numbers:
        return random.standard_t(self.degrees, count)


def _censored_residual(log_probability: Numbers, hazard: Numbers) -> tuple[Numbers, Numbers]:
    """Compute the least-squares residual sqrt(-2 ln P) of a saturated reading, and its derivative.

    P is the probability of a reading above the limit, and `hazard` the derivative of ln P by the standardised residual.
    """
    r = numpy.sqrt(-2 * numpy.minimum(log_probability, 0.0))
    return r, numpy.where(r > 1e-150, -hazard / numpy.maximum(r, 1e-150), 0.0)
