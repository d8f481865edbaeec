"""The kernel of the contact equation and how it is integrated.

In Abel space (see `abel`) the ball and the socket act through k(x) = Σ ρ_n cos((n + ½) x), where ρ_n tells how far mode
n departs from a row of independent springs. Since ρ_n ~ Σ a_j (n + ½)^-j, the sum is split into

    k(x) = g(x²) ln|x| + h(x²) |x| + s(x²) + Σ r_n cos((n + ½) x),

closed forms of Σ (n + ½)^-j cos((n + ½) x), j = 1..6, and a rest whose r_n fall like n^-7 or faster. An integral over
[-ε, ε] with t = ε sin(πy/2), which tames the ends, is a sum over Gauss-Legendre points in y with product weights for
ln|y - y'| and |y - y'|.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from math import ceil, log, pi

import numpy

from .modes import Ball, Socket

Array = numpy.ndarray

_ORDER = 6
_BLOCK = 5_000  # waves at a time: what stays in the cache
_PANEL_STEP = 8
_LONGEST_PANEL = 96
_TERMS = 30  # of the power series of the closed forms, which converge like (x/2π)²


@dataclass(frozen=True, kw_only=True)
class Kernel:
    """k(x) of a socket and a ball (None is rigid), to an absolute error of `tolerance`."""

    socket: Socket
    ball: Ball | None = None
    tolerance: float = 1e-14

    @cached_property
    def compliance(self) -> float:
        """C in mm/MPa: the common limit of c_n (n + ½) at high degrees."""
        return self.socket.asymptote + (0.0 if self.ball is None else self.ball.asymptote)

    def excess(self, degrees: Array) -> Array:
        """ρ_n."""
        socket = self.socket.excess(degrees)
        if self.ball is None:
            return socket
        share = self.ball.asymptote / self.compliance
        return (1 - share) * socket + share * self.ball.excess(degrees)

    @cached_property
    def _expansion(self) -> Array:
        """a_1 .. a_8."""
        socket = self.socket.expansion(_ORDER + 2)
        if self.ball is None:
            return socket
        share = self.ball.asymptote / self.compliance
        return (1 - share) * socket + share * self.ball.expansion(_ORDER + 2)

    @cached_property
    def rest(self) -> Array:
        """r_n, from n = 0 up to where it no longer counts."""
        a = self._expansion
        tail = (abs(a[_ORDER]) / (_ORDER * self.tolerance)) ** (1 / _ORDER)
        q = numpy.arange(max(ceil(tail), self.socket.reach(self.tolerance), 24)) + 0.5
        return self.excess((q - 0.5).astype(int)) - sum(a[j] * q ** -(j + 1.0) for j in range(_ORDER))

    @cached_property
    def _logarithm(self) -> Array:
        """g as a polynomial in x²."""
        a = self._expansion
        return numpy.array([-a[0], a[2] / 2, -a[4] / 24])

    @cached_property
    def _modulus(self) -> Array:
        """h as a polynomial in x²."""
        a = self._expansion
        return -pi / 2 * numpy.array([a[1], -a[3] / 6, a[5] / 120])

    @cached_property
    def _smooth(self) -> Array:
        """s as a polynomial in x²: what is left of the closed forms."""
        from scipy.special import zeta  # would double the time that importing the package takes

        a, k = self._expansion, numpy.arange(1, _TERMS - 2)
        series = (1 - 2.0 ** (1 - 2 * k)) * zeta(2 * k) / k * (2 * pi) ** (-2.0 * k)
        s = numpy.zeros(_TERMS)
        s[:3] += a[0] * numpy.array([log(4), 0, 0])
        s[:3] += a[1] * numpy.array([pi**2 / 2, 0, 0])
        s[:3] += a[2] * numpy.array([7 * zeta(3), -3 / 4 - log(4) / 2, 0])
        s[:3] += a[3] * numpy.array([pi**4 / 6, -(pi**2) / 4, 0])
        s[:3] += a[4] * numpy.array([31 * zeta(5), -7 / 2 * zeta(3), 1 / 16 + log(4) / 24 + 7 / 288])
        s[:3] += a[5] * numpy.array([pi**6 / 15, -(pi**4) / 12, pi**2 / 48])
        twice = series / ((2 * k + 1) * (2 * k + 2))
        s[k] -= a[0] * series
        s[k + 1] += a[2] * twice
        s[k + 2] -= a[4] * twice / ((2 * k + 3) * (2 * k + 4))
        return s

    def operators(self, half_angle: Array, grid: Grid) -> tuple[Array, Array]:
        """½ ∫ k(t - s) f(s) ds over [-ε, ε] for even f and for odd f, as matrices.

        Parameters
        ----------
        half_angle : array (loads,)
            ε.
        grid : Grid

        Returns
        -------
        array (loads, points + 1, points), twice
            From f at the points to the integral at the points and at t = ε.
        """
        edge = half_angle[:, None, None]
        x = edge * grid.distance
        square = x * x
        weights = _horner(self._logarithm, square) * (grid.log_weights + grid.weights * numpy.log(edge))
        weights += _horner(self._modulus, square) * (edge * grid.modulus_weights)
        terms = _terms(2 * float(half_angle.max(initial=0.0)))
        weights += _horner(self._smooth[:terms], square) * grid.weights
        weights *= edge * grid.slope
        left, right = weights[..., : grid.points][..., ::-1], weights[..., grid.points :]
        even, odd = (left + right) / 2, (right - left) / 2
        size = max(1, _BLOCK // (grid.points * len(self.rest)))
        for first in range(0, len(half_angle), size):
            block = slice(first, first + size)
            self._add_rest(half_angle[block, None], grid, even[block], odd[block])
        return even, odd

    def _add_rest(self, edge: Array, grid: Grid, even: Array, odd: Array) -> None:
        """Adds the rest of the modes to the operators in place.

        Their waves are shorter than what the pressure needs, so they are integrated at points of their own.
        """
        fine = _panels(grid.points / 2 + len(self.rest) * float(edge.max()) * pi / 4)
        even_waves, odd_waves = _waves(edge * grid.place, len(self.rest))
        fine_even, fine_odd = _waves(edge * fine.place, len(self.rest))
        strength = edge[..., None] * self.rest
        even += (even_waves * strength) @ (fine_even.swapaxes(-1, -2) @ _even_between(grid, fine))
        odd += (odd_waves * strength) @ (fine_odd.swapaxes(-1, -2) @ _odd_between(grid, fine))


@dataclass(frozen=True, kw_only=True, eq=False)
class Grid:
    """Points t = ε sin(πy/2), y in (0, 1), at which functions on [0, ε] are known; and t = ε as one more target.

    Arrays over sources have 2 * points entries from -ε to ε; arrays over targets have points + 1, from 0 to ε.
    """

    points: int

    @cached_property
    def nodes(self) -> tuple[Array, Array]:
        """y of the sources, in (-1, 1), and their weights."""
        return numpy.polynomial.legendre.leggauss(2 * self.points)

    @property
    def right(self) -> tuple[Array, Array]:
        """y of the points and their weights."""
        y, w = self.nodes
        return y[self.points :], w[self.points :]

    @property
    def weights(self) -> Array:
        """Of the sources, in y."""
        return self.nodes[1]

    @cached_property
    def to_edge(self) -> Array:
        """From an odd function of y at the points to its integral from there to y = 1."""
        y, w = self.right
        degree = 2 * numpy.arange(self.points) + 1
        P = numpy.polynomial.legendre.legvander(y, 2 * self.points)
        return (P[:, degree - 1] - P[:, degree + 1]) @ (w[:, None] * P[:, degree]).T

    @cached_property
    def slope(self) -> Array:
        """dt/dy/ε of the sources."""
        return pi / 2 * numpy.cos(pi / 2 * self.nodes[0])

    @cached_property
    def _targets(self) -> Array:
        return numpy.append(self.nodes[0][self.points :], 1.0)

    @cached_property
    def place(self) -> Array:
        """t/ε of the targets."""
        return numpy.sin(pi / 2 * self._targets)

    @cached_property
    def _stretch(self) -> Array:
        """(t - s)/(y - y')/ε of targets and sources."""
        y, z = self._targets[:, None], self.nodes[0]
        return pi / 2 * numpy.cos(pi / 4 * (y + z)) * numpy.sinc((y - z) / 4)

    @cached_property
    def distance(self) -> Array:
        """|t - s|/ε."""
        return abs(self._targets[:, None] - self.nodes[0]) * self._stretch

    @cached_property
    def log_weights(self) -> Array:
        """Of ln(|t - s|/ε), in y."""
        return _from_moments(_log_moments, self) + self.weights * numpy.log(self._stretch)

    @cached_property
    def modulus_weights(self) -> Array:
        """Of |t - s|/ε, in y."""
        return _from_moments(_modulus_moments, self) * self._stretch


@cache
def grid(points: int) -> Grid:
    return Grid(points=points)


def _waves(angle: Array, count: int) -> tuple[Array, Array]:
    """cos and sin of (n + ½) angle for n below count, along a new last axis."""
    waves = numpy.empty((*angle.shape, count), dtype=complex)
    waves[..., 0] = numpy.exp(0.5j * angle)
    waves[..., 1:] = numpy.exp(1j * angle)[..., None]
    numpy.multiply.accumulate(waves, axis=-1, out=waves)
    return numpy.ascontiguousarray(waves.real), numpy.ascontiguousarray(waves.imag)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Panels:
    """Gauss-Legendre points in equal panels of y from 0 to 1."""

    panels: int
    points: int

    @cached_property
    def nodes(self) -> tuple[Array, Array]:
        """y and weights."""
        x, w = numpy.polynomial.legendre.leggauss(self.points)
        y = (numpy.arange(self.panels)[:, None] + (1 + x) / 2).ravel() / self.panels
        return y, numpy.tile(w / (2 * self.panels), self.panels)

    @property
    def place(self) -> Array:
        """t/ε."""
        return numpy.sin(pi / 2 * self.nodes[0])

    @property
    def width(self) -> Array:
        """Weights of integrals over t/ε."""
        y, w = self.nodes
        return pi / 2 * numpy.cos(pi / 2 * y) * w


def _panels(points: float) -> _Panels:
    """At least that many points, in steps so that few different sets are made."""
    if points <= _LONGEST_PANEL:
        return _panels_of(1, _PANEL_STEP * ceil(points / _PANEL_STEP))
    return _panels_of(ceil(points / _LONGEST_PANEL), _LONGEST_PANEL)


@cache
def _panels_of(panels: int, points: int) -> _Panels:
    return _Panels(panels=panels, points=points)


@cache
def _even_between(grid: Grid, fine: _Panels) -> Array:
    """From an even function at the points of a grid to its weighted values at those of the panels."""
    return _between(grid, fine, 0)


@cache
def _odd_between(grid: Grid, fine: _Panels) -> Array:
    return _between(grid, fine, 1)


def _between(grid: Grid, fine: _Panels, parity: int) -> Array:
    y, w = grid.right
    degree = 2 * numpy.arange(grid.points) + parity
    P, Q = (numpy.polynomial.legendre.legvander(part, 2 * grid.points)[:, degree] for part in (y, fine.nodes[0]))
    return fine.width[:, None] * (Q @ ((2 * degree[:, None] + 1) * (w[:, None] * P).T))


def _terms(reach: float) -> int:
    """How many terms of the power series are needed up to x = reach."""
    return min(_TERMS, 4 + ceil(log(1e-17) / log(max((reach / (2 * pi)) ** 2, 1e-9))))


def _horner(coefficients: Array, x: Array) -> Array:
    total = numpy.full_like(x, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        total *= x
        total += coefficient
    return total


def _from_moments(moments, grid: Grid) -> Array:  # type: ignore[no-untyped-def]
    """Product weights: exact for polynomials in y, from ∫ kernel(y, y') P_l(y') dy'."""
    size = 2 * grid.points
    z, w = grid.nodes
    projection = (numpy.arange(size)[:, None] + 0.5) * numpy.polynomial.legendre.legvander(z, size - 1).T * w
    return moments(grid._targets, size) @ projection


def _log_moments(y: Array, size: int) -> Array:
    """∫ ln|y - z| P_l(z) dz over [-1, 1]: 2 (Q_l+1 - Q_l-1)/(2l + 1)."""
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


def _modulus_moments(y: Array, size: int) -> Array:
    """∫ |y - z| P_l(z) dz over [-1, 1]: twice the second antiderivative of P_l."""
    P = numpy.polynomial.legendre.legvander(y, size + 1)
    degree = numpy.arange(2, size)
    moments = numpy.empty((len(y), size))
    moments[:, 0] = y * y + 1
    moments[:, 1] = y**3 / 3 - y
    up = (P[:, 4:] - P[:, 2:-2]) / ((2 * degree + 1) * (2 * degree + 3))
    down = (P[:, 2:-2] - P[:, :-4]) / ((2 * degree + 1) * (2 * degree - 1))
    moments[:, 2:] = 2 * (up - down)
    return moments
