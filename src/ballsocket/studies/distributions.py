"""How a number scatters: what a drawing's tolerance means."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log
from typing import Any

from ..core.checks import require
from ..core.kinds import Unit


@dataclass(frozen=True, kw_only=True)
class Rectangular:
    """Anything from `low` to `high`, equally likely: uniform.

    Raises
    ------
    ValueError
        Ends that are not finite, or the wrong way round.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        require("low", self.low, -inf < self.low < self.high, f"it is finite and below high = {self.high:g}")
        require("high", self.high, self.high < inf, "it is finite")

    @property
    def frozen(self) -> Any:
        """The distribution of `scipy.stats`."""
        from scipy.stats import uniform

        return uniform(self.low, self.high - self.low)


@dataclass(frozen=True, kw_only=True)
class Normal:
    """Normal, cut off at `low` and `high` where these are given: a process with inspection.

    Parameters
    ----------
    mean, deviation : float
        Of the distribution before it is cut off; the deviation is positive.
    low, high : float

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """

    mean: float
    deviation: float
    low: float = -inf
    high: float = inf

    def __post_init__(self) -> None:
        require("mean", self.mean, abs(self.mean) < inf, "it is finite")
        require("deviation", self.deviation, 0 < self.deviation < inf, "a standard deviation is above 0 and finite")
        require("low", self.low, self.low < self.high, f"it is below high = {self.high:g}")

    @property
    def frozen(self) -> Any:
        """The distribution of `scipy.stats`."""
        from scipy.stats import norm, truncnorm

        if (self.low, self.high) == (-inf, inf):
            return norm(self.mean, self.deviation)
        ends = ((end - self.mean) / self.deviation for end in (self.low, self.high))
        return truncnorm(*ends, loc=self.mean, scale=self.deviation)


@dataclass(frozen=True, kw_only=True)
class LogNormal:
    """A number whose logarithm is normal: it scatters by a factor, as wear coefficients do.

    Parameters
    ----------
    median : float
        Positive.
    factor : float
        Of one standard deviation, above 1: 68 % lie between median / factor and median · factor.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.

    Examples
    --------
    >>> round(float(LogNormal(median=1e-6, factor=1.5).frozen.ppf(0.975)), 9)
    2.214e-06
    """

    median: float
    factor: float

    def __post_init__(self) -> None:
        require("median", self.median, 0 < self.median < inf, "it is positive and finite")
        require("factor", self.factor, 1 < self.factor < inf, "that of one standard deviation is above 1, and finite")

    @property
    def frozen(self) -> Any:
        """The distribution of `scipy.stats`."""
        from scipy.stats import lognorm

        return lognorm(log(self.factor), scale=self.median)


Distribution = Rectangular | Normal | LogNormal


_ALMOST_NONE = 1e-3
"""Tail probability at which an unbounded distribution is cut for the check of a nominal value."""


def check_nominal(name: str, nominal: float, spread: Distribution, unit: Unit) -> None:
    """Raise ValueError for a nominal value outside the distribution of the same quantity.

    Its result would lie outside the band of the distribution.
    """
    bounded = all(abs(float(end)) < inf for end in spread.frozen.support())
    shares = (0.0, 1.0) if bounded else (_ALMOST_NONE, 1 - _ALMOST_NONE)
    low, high = (float(spread.frozen.ppf(share)) for share in shares)
    slack = _ROUNDING * max(abs(low), abs(high))
    if not low - slack <= nominal <= high + slack:
        value, least, most = (f"{number * unit.factor:.6g}" for number in (nominal, low, high))
        text = f" {unit.text}".rstrip()
        raise ValueError(
            f"{name} = {value}{text} lies outside its tolerance of {least} to {most}{text}: change one of them"
        )


_ROUNDING = 1e-9


def tolerance(nominal: float, plus_minus: float) -> Normal:
    """The usual reading of 0.10 ± 0.05: three standard deviations to each limit, nothing beyond.

    Examples
    --------
    >>> tolerance(0.10, 0.06).deviation
    0.02
    """
    require("plus_minus", plus_minus, 0 < plus_minus < inf, "a tolerance is above 0 and finite")
    low, high = nominal - plus_minus, nominal + plus_minus
    return Normal(mean=nominal, deviation=plus_minus / 3, low=low, high=high)
