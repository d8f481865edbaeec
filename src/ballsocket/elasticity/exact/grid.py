"""Quadrature points of the contact equation, and the weights of its singular integrals.

The substitution t = ε sin(πy/2) removes the end singularities of an integral over [-ε, ε]. The integral becomes a
sum over Gauss-Legendre points in y with product weights for ln|y - y'| and |y - y'|.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from math import pi

import numpy

from ...core.arrays import Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class QuadratureGrid:
    """Points t = ε sin(πy/2), y in (0, 1), where functions on [0, ε] are known; t = ε is one more target.

    Arrays over sources have 2 * points entries from -ε to ε; arrays over targets have points + 1, from 0 to ε.
    """

    points: int

    @cached_property
    def nodes(self) -> tuple[Numbers, Numbers]:
        """Source points y in (-1, 1) and their weights."""
        return numpy.polynomial.legendre.leggauss(2 * self.points)

    @property
    def right(self) -> tuple[Numbers, Numbers]:
        """Positive source points y and their weights."""
        y, w = self.nodes
        return y[self.points :], w[self.points :]

    @property
    def weights(self) -> Numbers:
        """Weights of the source points, in y."""
        return self.nodes[1]

    @cached_property
    def to_edge(self) -> Numbers:
        """Matrix from an odd function of y at the points to its integral from there to y = 1."""
        y, w = self.right
        degree = 2 * numpy.arange(self.points) + 1
        P = numpy.polynomial.legendre.legvander(y, 2 * self.points)
        return (P[:, degree - 1] - P[:, degree + 1]) @ (w[:, None] * P[:, degree]).T

    @cached_property
    def slope(self) -> Numbers:
        """Derivative dt/dy/ε at the sources."""
        return pi / 2 * numpy.cos(pi / 2 * self.nodes[0])

    @cached_property
    def _targets(self) -> Numbers:
        """Target points y: the positive sources, then 1."""
        return numpy.append(self.nodes[0][self.points :], 1.0)

    @cached_property
    def position(self) -> Numbers:
        """Relative position t/ε of the targets."""
        return numpy.sin(pi / 2 * self._targets)

    @cached_property
    def _stretch(self) -> Numbers:
        """Ratio (t - s)/(y - y')/ε for targets and sources."""
        y, z = self._targets[:, None], self.nodes[0]
        return pi / 2 * numpy.cos(pi / 4 * (y + z)) * numpy.sinc((y - z) / 4)

    @cached_property
    def distance(self) -> Numbers:
        """Distance |t - s|/ε between targets and sources."""
        return abs(self._targets[:, None] - self.nodes[0]) * self._stretch

    @cached_property
    def log_weights(self) -> Numbers:
        """Product weights of ln(|t - s|/ε), in y."""
        return _product_weights(_log_moments, self) + self.weights * numpy.log(self._stretch)

    @cached_property
    def modulus_weights(self) -> Numbers:
        """Product weights of |t - s|/ε, in y."""
        return _product_weights(_modulus_moments, self) * self._stretch


@cache
def cached_grid(points: int) -> QuadratureGrid:
    """Return the grid with this number of points, built once."""
    return QuadratureGrid(points=points)


def _product_weights(moments, grid: QuadratureGrid) -> Numbers:  # type: ignore[no-untyped-def]
    """Compute product weights that are exact for polynomials in y, from ∫ kernel(y, y') P_l(y') dy'."""
    size = 2 * grid.points
    z, w = grid.nodes
    projection = (numpy.arange(size)[:, None] + 0.5) * numpy.polynomial.legendre.legvander(z, size - 1).T * w
    return moments(grid._targets, size) @ projection


def _log_moments(y: Numbers, size: int) -> Numbers:
    """Compute ∫ ln|y - z| P_l(z) dz over [-1, 1]: 2 (Q_l+1 - Q_l-1)/(2l + 1)."""
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


def _modulus_moments(y: Numbers, size: int) -> Numbers:
    """Compute ∫ |y - z| P_l(z) dz over [-1, 1]: twice the second antiderivative of P_l."""
    P = numpy.polynomial.legendre.legvander(y, size + 1)
    degree = numpy.arange(2, size)
    moments = numpy.empty((len(y), size))
    moments[:, 0] = y * y + 1
    moments[:, 1] = y**3 / 3 - y
    up = (P[:, 4:] - P[:, 2:-2]) / ((2 * degree + 1) * (2 * degree + 3))
    down = (P[:, 2:-2] - P[:, :-4]) / ((2 * degree + 1) * (2 * degree - 1))
    moments[:, 2:] = 2 * (up - down)
    return moments
