"""Runge-Kutta-Chebyshev steps: explicit, second order, stable over long blocks of what decays without swinging.

References
----------
Sommeijer, Shampine & Verwer 1998, doi 10.1016/S0377-0427(97)00219-7.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import sqrt

import numpy

from ..core.arrays import Numbers

Rate = Callable[[Numbers], Numbers]

_DAMPING = 2 / 13
_STABLE = 1.54  # a block h of s stages is stable up to h ρ = ((s - 1)² - 1)/1.54
_MOST = 60


@dataclass(frozen=True, kw_only=True, eq=False)
class Step:
    """A block that was taken.

    Attributes
    ----------
    values, rate : array
        At its end.
    error : array
        The estimate of what the block missed.
    """

    values: Numbers
    rate: Numbers
    error: Numbers


def stages_of(length: float, fastest: float) -> int:
    """How many stages make a block of this length stable where nothing decays faster."""
    return min(max(2, 1 + int(sqrt(1 + _STABLE * length * fastest)) + 1), _MOST)


def longest(fastest: float) -> float:
    """The longest block that is stable at all."""
    return ((_MOST - 2) ** 2 - 1) / (_STABLE * fastest) if fastest > 0 else float("inf")


@lru_cache(maxsize=_MOST)
def _coefficients(stages: int) -> tuple[tuple[float, ...], ...]:
    """(μ, ν, μ~, γ~) of stages 1, 2, ..."""
    w0 = 1 + _DAMPING / stages**2
    T, D, S = [1.0, w0], [0.0, 1.0], [0.0, 0.0]  # Chebyshev polynomials at w0, their slopes and second slopes
    for _ in range(2, stages + 1):
        T.append(2 * w0 * T[-1] - T[-2])
        D.append(2 * w0 * D[-1] - D[-2] + 2 * T[-2])
        S.append(2 * w0 * S[-1] - S[-2] + 4 * D[-2])
    w1 = D[-1] / S[-1]
    b = [S[j] / D[j] ** 2 if j > 1 else S[2] / D[2] ** 2 for j in range(stages + 1)]
    rows: list[tuple[float, ...]] = [(0.0, 0.0, b[1] * w1, 0.0)]
    for j in range(2, stages + 1):
        along = 2 * b[j] * w1 / b[j - 1]
        rows.append((2 * b[j] * w0 / b[j - 1], -b[j] / b[j - 2], along, -(1 - b[j - 1] * T[j - 1]) * along))
    return tuple(rows)


def step(rate: Rate, values: Numbers, slope: Numbers, length: float, stages: int) -> Step:
    """One block.

    Parameters
    ----------
    rate : function
        From values to their change per unit of length.
    values, slope : array
        At the beginning.
    length : float
    stages : int
    """
    (_, _, along, _), *rest = _coefficients(stages)
    before, now = values, values + along * length * slope
    for mu, nu, along, back in rest:
        following = (1 - mu - nu) * values + mu * now + nu * before + length * (along * rate(now) + back * slope)
        before, now = now, following
    end = rate(now)
    # 12 (y_n - y_n+1) + 6 h (f_n + f_n+1), over 15
    error = 0.8 * (values - now) + 0.4 * length * (slope + end)
    return Step(values=now, rate=end, error=numpy.asarray(error))
