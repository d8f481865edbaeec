"""Runge-Kutta-Chebyshev steps: explicit, second order, stable over long steps of decaying processes.

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

from .arrays import Numbers

Rate = Callable[[Numbers], Numbers]  # function from values to their rate of change per unit of length

_DAMPING = 2 / 13
_STABILITY = 1.54  # stability constant β: a step h with s stages is stable up to h ρ = ((s - 1)² - 1)/β

_MAX_STAGES = 60


@dataclass(frozen=True, kw_only=True, eq=False)
class ChebyshevStep:
    """Result of one Runge-Kutta-Chebyshev step."""

    # values and their rate of change at the end of the step
    values: Numbers
    rate: Numbers
    error: Numbers  # estimated local error of the values


def stage_count(length: float, spectral_radius: float) -> int:
    """Compute the number of stages, 2 to 60, for a stable step; `spectral_radius` is the largest decay rate."""
    return min(max(2, 1 + int(sqrt(1 + _STABILITY * length * spectral_radius)) + 1), _MAX_STAGES)


def max_step_length(spectral_radius: float) -> float:
    """Compute the length of the longest stable step; infinite for a decay rate of 0."""
    return ((_MAX_STAGES - 2) ** 2 - 1) / (_STABILITY * spectral_radius) if spectral_radius > 0 else float("inf")


@lru_cache(maxsize=_MAX_STAGES)
def _stage_coefficients(stages: int) -> tuple[tuple[float, ...], ...]:
    """Compute the coefficients (μ, ν, μ~, γ~) of all Runge-Kutta-Chebyshev stages."""
    w0 = 1 + _DAMPING / stages**2
    T, D, S = [1.0, w0], [0.0, 1.0], [0.0, 0.0]  # Chebyshev polynomials at w0, their first and second derivatives
    for _ in range(2, stages + 1):
        T.append(2 * w0 * T[-1] - T[-2])
        D.append(2 * w0 * D[-1] - D[-2] + 2 * T[-2])
        S.append(2 * w0 * S[-1] - S[-2] + 4 * D[-2])
    w1 = D[-1] / S[-1]
    b = [S[j] / D[j] ** 2 if j > 1 else S[2] / D[2] ** 2 for j in range(stages + 1)]
    rows: list[tuple[float, ...]] = [(0.0, 0.0, b[1] * w1, 0.0)]
    for j in range(2, stages + 1):
        mu_tilde = 2 * b[j] * w1 / b[j - 1]
        rows.append((2 * b[j] * w0 / b[j - 1], -b[j] / b[j - 2], mu_tilde, -(1 - b[j - 1] * T[j - 1]) * mu_tilde))
    return tuple(rows)


def integrate_step(rate: Rate, values: Numbers, slope: Numbers, length: float, stages: int) -> ChebyshevStep:
    """Integrate a differential equation over one Runge-Kutta-Chebyshev step, with an error estimate.

    `values` and `slope` are the values and their rate of change at the beginning; `stages` as of `stage_count`.
    """
    (_, _, first_mu_tilde, _), *further_stages = _stage_coefficients(stages)
    previous, current = values, values + first_mu_tilde * length * slope
    for mu, nu, mu_tilde, gamma in further_stages:
        following = (
            (1 - mu - nu) * values + mu * current + nu * previous + length * (mu_tilde * rate(current) + gamma * slope)
        )
        previous, current = current, following
    end_rate = rate(current)
    # (12 (y_n - y_n+1) + 6 h (f_n + f_n+1))/15
    error = 0.8 * (values - current) + 0.4 * length * (slope + end_rate)
    return ChebyshevStep(values=current, rate=end_rate, error=numpy.asarray(error))
