"""Quadrature of the kernel: points, weights of singular integrals, and closed forms of the singular parts.

The substitution t = ε sin(πy/2) removes the end singularities of an integral over [-ε, ε]. The integral becomes a
sum over Gauss-Legendre points in y with product weights for ln|y - y'| and |y - y'|.

The closed forms are those of Σ (n + ½)^-j cos((n + ½) x), j = 1..6, the expansion of the kernel in 1/(n + ½):
Σ_j a_j Σ_n (n + ½)^-j cos((n + ½) x) = g(x²) ln|x| + h(x²) |x| + s(x²), polynomials g and h and a power series s.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from math import ceil, factorial, fsum, log, pi, prod

import numpy

from ...core.arrays import Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class QuadratureGrid:
    """Quadrature points of functions on [0, ε], and the weights of integrals with singular kernels.

    The points are t = ε sin(πy/2) with y in (0, 1); t = ε is one more target.

    Arrays over sources have 2 * points entries from -ε to ε; arrays over targets have points + 1, from 0 to ε.
    """

    points: int

    @cached_property
    def nodes(self) -> tuple[Numbers, Numbers]:
        """Gauss-Legendre points y in (-1, 1), the sources of an integral, and their weights."""
        return numpy.polynomial.legendre.leggauss(2 * self.points)

    @property
    def positive_nodes(self) -> tuple[Numbers, Numbers]:
        """Positive Gauss-Legendre points y and their weights."""
        y, w = self.nodes
        return y[self.points :], w[self.points :]

    @cached_property
    def integral_to_edge(self) -> Numbers:
        """Matrix that integrates an odd function, known at the points, from each point to y = 1."""
        y, w = self.positive_nodes
        degree = 2 * numpy.arange(self.points) + 1
        P = numpy.polynomial.legendre.legvander(y, 2 * self.points)
        return (P[:, degree - 1] - P[:, degree + 1]) @ (w[:, None] * P[:, degree]).T

    @cached_property
    def slope(self) -> Numbers:
        """Derivative of the relative position, d(t/ε)/dy, at the sources."""
        return pi / 2 * numpy.cos(pi / 2 * self.nodes[0])

    @cached_property
    def _target_points(self) -> Numbers:
        """Coordinates y of the targets: the positive sources, then 1."""
        return numpy.append(self.nodes[0][self.points :], 1.0)

    @cached_property
    def position(self) -> Numbers:
        """Relative positions t/ε of the targets."""
        return numpy.sin(pi / 2 * self._target_points)

    @cached_property
    def _distance_ratio(self) -> Numbers:
        """Ratio of the distances in t/ε and in y, (t - s)/(y - y')/ε, between targets and sources."""
        y, z = self._target_points[:, None], self.nodes[0]
        return pi / 2 * numpy.cos(pi / 4 * (y + z)) * numpy.sinc((y - z) / 4)

    @cached_property
    def distance(self) -> Numbers:
        """Relative distance |t - s|/ε between targets and sources."""
        return abs(self._target_points[:, None] - self.nodes[0]) * self._distance_ratio

    @cached_property
    def log_weights(self) -> Numbers:
        """Weights of integrals over y with the kernel ln(|t - s|/ε): (targets, sources)."""
        return _product_weights(_log_moments, self) + self.nodes[1] * numpy.log(self._distance_ratio)

    @cached_property
    def distance_weights(self) -> Numbers:
        """Weights of integrals over y with the kernel |t - s|/ε: (targets, sources)."""
        return _product_weights(_distance_moments, self) * self._distance_ratio


cached_grid = cache(QuadratureGrid)
"""Function that returns the quadrature grid with this number of `points`, from a cache."""


def _product_weights(moments, grid: QuadratureGrid) -> Numbers:  # type: ignore[no-untyped-def]
    """Compute the weights of integrals with a kernel, exact for polynomials in y.

    `moments` computes ∫ kernel(y, y') P_l(y') dy' for the Legendre polynomials P_l.
    """
    size = 2 * grid.points
    z, w = grid.nodes
    projection = (numpy.arange(size)[:, None] + 0.5) * numpy.polynomial.legendre.legvander(z, size - 1).T * w
    return moments(grid._target_points, size) @ projection


def _log_moments(y: Numbers, size: int) -> Numbers:
    """Compute the integrals of ln|y - z| times Legendre polynomials P_l(z) over [-1, 1]: (targets, size).

    They are 2 (Q_l+1 - Q_l-1)/(2l + 1), with Legendre functions Q_l of the second kind.
    """
    inside = y < 1
    Q = numpy.zeros((size + 1, len(y)))
    Q[0, inside] = numpy.arctanh(y[inside])
    Q[1] = y * Q[0] - 1
    for n in range(1, size):
        Q[n + 1] = ((2 * n + 1) * y * Q[n] - n * Q[n - 1]) / (n + 1)
    degree = numpy.arange(1, size)
    moments = numpy.empty((len(y), size))
    moments[:, 1:] = (2 * (Q[2:] - Q[:-2]) / (2 * degree[:, None] + 1)).T
    moments[:, 0] = (1 + y) * numpy.log1p(y) - 2
    moments[inside, 0] += (1 - y[inside]) * numpy.log1p(-y[inside])
    moments[~inside, 1:] = -2 / (degree * (degree + 1))
    return moments


def _distance_moments(y: Numbers, size: int) -> Numbers:
    """Compute the integrals of |y - z| times Legendre polynomials P_l(z) over [-1, 1]: (targets, size)."""
    P = numpy.polynomial.legendre.legvander(y, size + 1)
    degree = numpy.arange(2, size)
    moments = numpy.empty((len(y), size))
    moments[:, 0] = y * y + 1
    moments[:, 1] = y**3 / 3 - y
    up = (P[:, 4:] - P[:, 2:-2]) / ((2 * degree + 1) * (2 * degree + 3))
    down = (P[:, 2:-2] - P[:, :-4]) / ((2 * degree + 1) * (2 * degree - 1))
    moments[:, 2:] = 2 * (up - down)
    return moments


ORDER = 6  # number of terms of the kernel's expansion that are summed in closed form
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
