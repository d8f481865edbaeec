"""Closed forms of Σ (n + ½)^-j cos((n + ½) x), j = 1..6: sums of the kernel's expansion in 1/(n + ½).

Σ_j a_j Σ_n (n + ½)^-j cos((n + ½) x) = g(x²) ln|x| + h(x²) |x| + s(x²), polynomials g and h and a power series s.
"""

from __future__ import annotations

from functools import cache
from math import ceil, factorial, fsum, log, pi, prod

import numpy

from ...core.arrays import Numbers

ORDER = 6
"""Number of terms of the kernel's expansion that are summed in closed form."""

_MAX_TERMS = 30  # of the power series, which converge like (x/2π)²


def logarithm_coefficients(a: Numbers) -> Numbers:
    """Compute the coefficients of g(x²), the factor of ln|x| in the closed form of the kernel."""
    return numpy.array([-a[0], a[2] / 2, -a[4] / 24])


def distance_coefficients(a: Numbers) -> Numbers:
    """Compute the coefficients of h(x²), the factor of |x| in the closed form of the kernel."""
    return -pi / 2 * numpy.array([a[1], -a[3] / 6, a[5] / 120])


def smooth_coefficients(a: Numbers, reach: float) -> Numbers:
    """Compute the coefficients of s(x²), the smooth part of the closed form, accurate for x up to `reach`."""
    terms = min(_MAX_TERMS, 4 + ceil(log(1e-17) / log(max((reach / (2 * pi)) ** 2, 1e-9))))
    return _power_series_matrix()[:terms] @ a


_BERNOULLI_NUMBERS = (1 / 6, -1 / 30, 1 / 42, -1 / 30, 5 / 66, -691 / 2730, 7 / 6)  # B_2, B_4, ...
_SUMMED_TERMS = 20  # of the series of zeta, before the Euler-Maclaurin remainder


def _zeta(s: int) -> float:
    """Compute Riemann's zeta function of an integer from 2 (Euler-Maclaurin); importing scipy.special takes longer."""
    n = float(_SUMMED_TERMS)
    terms = [k ** -float(s) for k in range(1, _SUMMED_TERMS)] + [n ** (1.0 - s) / (s - 1), 0.5 * n**-s]
    for j, bernoulli in enumerate(_BERNOULLI_NUMBERS, start=1):
        rising = prod(s + i for i in range(2 * j - 1))
        terms.append(bernoulli / factorial(2 * j) * rising * n ** (1.0 - s - 2 * j))
    return fsum(terms)


@cache
def _power_series_matrix() -> Numbers:
    """Compute the matrix that converts the kernel's coefficients a_1 .. a_6 to those of the power series s."""
    k = numpy.arange(1, _MAX_TERMS - 2)
    series = (1 - 2.0 ** (1 - 2 * k)) * numpy.array([_zeta(2 * int(n)) for n in k]) / k * (2 * pi) ** (-2.0 * k)
    twice = series / ((2 * k + 1) * (2 * k + 2))
    s = numpy.zeros((_MAX_TERMS, ORDER))
    s[:3, 0] = log(4), 0, 0
    s[:3, 1] = pi**2 / 2, 0, 0
    s[:3, 2] = 7 * _zeta(3), -3 / 4 - log(4) / 2, 0
    s[:3, 3] = pi**4 / 6, -(pi**2) / 4, 0
    s[:3, 4] = 31 * _zeta(5), -7 / 2 * _zeta(3), 1 / 16 + log(4) / 24 + 7 / 288
    s[:3, 5] = pi**6 / 15, -(pi**4) / 12, pi**2 / 48
    s[k, 0] -= series
    s[k + 1, 2] += twice
    s[k + 2, 4] -= twice / ((2 * k + 3) * (2 * k + 4))
    return s
