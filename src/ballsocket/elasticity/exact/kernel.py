"""Kernel of the contact equation, and its integrals over [-ε, ε] for half angles on a grid.

In Abel space (see `abel`) the ball and the socket act through the kernel of the distance x = t - s of two angles,

    k(x) = Σ ρ_n cos((n + ½) x),   ρ_n = c_n (n + ½)/C - 1,   (1)

with the compliance c_n of both bodies for the Legendre polynomial of degree n, and the limit C of c_n (n + ½), where
they act like a row of independent springs. Since ρ_n ~ Σ a_j (n + ½)^-j at high degrees, the sum is split into

    k(x) = g(x²) ln|x| + h(x²) |x| + s(x²) + Σ r_n cos((n + ½) x),   (2)

closed forms of Σ (n + ½)^-j cos((n + ½) x), j = 1..6, see `grid`, and a remainder whose r_n decrease like n^-7 or
faster. The integrals over a contact of half angle ε,

    ½ ∫ k(t - s) f(s) ds,   s from -ε to ε,   (3)

of even f and of odd f are matrices (loads, points + 1, points): from f at the points to the integral at the points and
at t = ε. They are linear in a_1 .. a_6 and in the remainders r_n.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from math import ceil, pi

import numpy

from ...core.arrays import Numbers
from .grid import ORDER, QuadratureGrid, distance_coefficients, logarithm_coefficients, smooth_coefficients
from .modes import ElasticBall, Socket

Operators = tuple[Numbers, Numbers]
"""Matrices of the integral (3) of even functions and of odd ones."""

_BLOCK = 16_384  # waves in one block, which fits into the cache
_PANEL_STEP = 8
_LONGEST_PANEL = 96
_CACHED_COUNTS = (32, 64, 128)  # numbers of waves that are cached


@dataclass(frozen=True, kw_only=True, eq=False)
class Intervals:
    """Integration intervals [-ε, ε] of half angles ε (loads,), with the points of a grid."""

    half_angle: Numbers
    grid: QuadratureGrid

    def closed_form_operators(self, a: Numbers) -> Operators:
        """Compute the operators of the closed forms in (2), from the coefficients a_1 .. a_6."""
        grid, edge = self.grid, self.half_angle[:, None, None]
        square = edge * grid.distance
        square *= square
        weights = _evaluate_polynomial(logarithm_coefficients(a), square)
        weights *= grid.nodes[1] * numpy.log(edge) + grid.log_weights
        term = _evaluate_polynomial(distance_coefficients(a), square)
        term *= edge * grid.distance_weights
        weights += term
        term = _evaluate_polynomial(smooth_coefficients(a, 2 * float(self.half_angle.max(initial=0.0))), square)
        term *= grid.nodes[1]
        weights += term
        weights *= edge * (grid.slope / 2)
        left, right = weights[..., : grid.points][..., ::-1], weights[..., grid.points :]
        return left + right, right - left

    def add_remainder(self, remainder: Numbers, operators: Operators) -> None:
        """Add the integral operators of the kernel's remainder, a sum of cosines with weights r_n, in place."""
        size = max(1, _BLOCK // (_wave_panels(self.half_angle, self.grid, len(remainder)).count * len(remainder)))
        for first in range(0, len(self.half_angle), size):
            block = slice(first, first + size)
            waves = _waves_and_integration_matrices(self.half_angle[block], self.grid, len(remainder))
            _add_products(waves, remainder, (operators[0][block], operators[1][block]))


@dataclass(frozen=True, kw_only=True, eq=False)
class CachedIntervals(Intervals):
    """Integration intervals shared by many joints: what does not depend on the joint is computed once."""

    @cached_property
    def _unit_operators(self) -> Operators:
        operators = zip(*(Intervals.closed_form_operators(self, unit) for unit in numpy.eye(ORDER)), strict=True)
        even, odd = (numpy.stack(stack, axis=-1) for stack in operators)
        return even, odd

    @cached_property
    def _cached_waves(self) -> dict[int, tuple[Numbers, Numbers, Numbers, Numbers]]:  # by their number
        return {}

    def closed_form_operators(self, a: Numbers) -> Operators:
        """Compute the operators of `Intervals.closed_form_operators` from those of unit coefficients."""
        even, odd = self._unit_operators
        return even @ a, odd @ a

    def add_remainder(self, remainder: Numbers, operators: Operators) -> None:
        """Add the integral operators of the kernel's remainder, a sum of cosines with weights r_n, in place."""
        if len(remainder) > _CACHED_COUNTS[-1]:
            super().add_remainder(remainder, operators)
            return
        count = min(cached for cached in _CACHED_COUNTS if cached >= len(remainder))
        if count not in self._cached_waves:
            self._cached_waves[count] = _waves_and_integration_matrices(self.half_angle, self.grid, count)
        even, odd, even_integrals, odd_integrals = self._cached_waves[count]
        first = slice(len(remainder))
        waves = even[..., first], odd[..., first], even_integrals[:, first], odd_integrals[:, first]
        _add_products(waves, remainder, operators)


def _add_products(waves: tuple[Numbers, Numbers, Numbers, Numbers], remainder: Numbers, operators: Operators) -> None:
    """Add the operators of the remainder in place: cosines and sines times their integrals times r_n."""
    even, odd, even_integrals, odd_integrals = waves
    for operator, wave, integrals in zip(operators, (even, odd), (even_integrals, odd_integrals), strict=True):
        operator += (wave * remainder) @ integrals


def _waves_and_integration_matrices(
    half_angle: Numbers, grid: QuadratureGrid, count: int
) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """Compute the cosines and sines of (n + ½) t, and the matrices that integrate functions times them.

    The cosines and sines at the targets have the shape (loads, points + 1, count), the matrices (loads, count, points).
    The waves are shorter than the variations of the pressure, so they are integrated at their own points.
    """
    edge = half_angle[:, None]
    panels = _wave_panels(half_angle, grid, count)
    even, odd = _cosines_and_sines(edge * grid.position, count)
    odd *= edge[..., None]
    even *= edge[..., None]
    even_integrals, odd_integrals = (
        waves.swapaxes(-1, -2) @ _interpolation_matrix(grid, panels, parity)
        for parity, waves in enumerate(_cosines_and_sines(edge * panels.position, count))
    )
    return even, odd, even_integrals, odd_integrals


def _wave_panels(half_angle: Numbers, grid: QuadratureGrid, count: int) -> _Panels:
    """Choose panels that resolve `count` cosines and sines, with points rounded up so that few rules are built."""
    points = grid.points / 2 + count * float(half_angle.max(initial=0.0)) * pi / 4
    if points <= _LONGEST_PANEL:
        return _panels_of(panels=1, points=_PANEL_STEP * ceil(points / _PANEL_STEP))
    return _panels_of(panels=ceil(points / _LONGEST_PANEL), points=_LONGEST_PANEL)


def _cosines_and_sines(angle: Numbers, count: int) -> tuple[Numbers, Numbers]:
    """Compute cos and sin of (n + ½) angle for n below count."""
    waves = numpy.empty((*angle.shape, count), complex)
    waves[..., 0] = numpy.exp(0.5j * angle)
    waves[..., 1:] = numpy.exp(1j * angle)[..., None]
    numpy.multiply.accumulate(waves, axis=-1, out=waves)
    return numpy.ascontiguousarray(waves.real), numpy.ascontiguousarray(waves.imag)


def _evaluate_polynomial(coefficients: Numbers, x: Numbers) -> Numbers:
    total = numpy.full(x.shape, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        total *= x
        total += coefficient
    return total


@dataclass(frozen=True, kw_only=True, eq=False)
class _Panels:
    """Composite Gauss-Legendre rule: points in equal panels of y from 0 to 1."""

    panels: int
    points: int

    @property
    def count(self) -> int:
        """Number of points."""
        return self.panels * self.points

    @cached_property
    def nodes(self) -> tuple[Numbers, Numbers]:
        """Points y and their weights."""
        x, w = numpy.polynomial.legendre.leggauss(self.points)
        y = (numpy.arange(self.panels)[:, None] + (1 + x) / 2).ravel() / self.panels
        return y, numpy.tile(w / (2 * self.panels), self.panels)

    @property
    def position(self) -> Numbers:
        """Relative position t/ε of the points."""
        return numpy.sin(pi / 2 * self.nodes[0])

    @property
    def weights(self) -> Numbers:
        """Quadrature weights of integrals over t/ε."""
        y, w = self.nodes
        return pi / 2 * numpy.cos(pi / 2 * y) * w


_panels_of = cache(_Panels)


@cache
def _interpolation_matrix(grid: QuadratureGrid, panels: _Panels, parity: int) -> Numbers:
    """Compute the matrix that interpolates a function (parity 0 even, 1 odd) to panels, times their weights."""
    y, w = grid.positive_nodes
    degree = 2 * numpy.arange(grid.points) + parity
    P, Q = (numpy.polynomial.legendre.legvander(points, 2 * grid.points)[:, degree] for points in (y, panels.nodes[0]))
    return panels.weights[:, None] * (Q @ ((2 * degree[:, None] + 1) * (w[:, None] * P).T))


@dataclass(frozen=True, kw_only=True)
class Kernel:
    """Kernel k(x) of a socket and a ball (None is rigid), to an absolute error of `tolerance`."""

    socket: Socket
    ball: ElasticBall | None = None
    tolerance: float = 1e-14

    @cached_property
    def compliance(self) -> float:
        """Compliance C of socket and ball together in mm/MPa, the limit of c_n (n + ½) at high degrees."""
        return self.socket.asymptote + (0.0 if self.ball is None else self.ball.asymptote)

    def excess(self, degrees: Numbers) -> Numbers:
        """Compute the excess ρ_n (1) of the modal compliance of both bodies together."""
        return self._mix(lambda body: body.excess(degrees))

    @cached_property
    def expansion(self) -> Numbers:
        """Coefficients a_1 .. a_8 of the expansion of ρ_n in 1/(n + ½)."""
        return self._mix(lambda body: body.expansion(ORDER + 2))

    def _mix(self, quantity: Callable[[Socket | ElasticBall], Numbers]) -> Numbers:
        """Compute the mean of a quantity of both bodies, weighted with their shares of the compliance C."""
        if self.ball is None:
            return quantity(self.socket)
        share = self.ball.asymptote / self.compliance
        return (1 - share) * quantity(self.socket) + share * quantity(self.ball)

    @cached_property
    def remainder(self) -> Numbers:
        """Remainders r_n (2) after the closed forms, from n = 0 to the last one above the tolerance."""
        a = self.expansion
        tail = (abs(a[ORDER]) / (ORDER * self.tolerance)) ** (1 / ORDER)
        q = numpy.arange(max(ceil(tail), self.socket.backing_degree(self.tolerance), 24)) + 0.5
        return self.excess((q - 0.5).astype(int)) - sum(a[j] * q ** -(j + 1.0) for j in range(ORDER))

    def operators(self, intervals: Intervals) -> Operators:
        """Compute the operators of the integral (3) for even and for odd functions f."""
        operators = intervals.closed_form_operators(self.expansion[:ORDER])
        intervals.add_remainder(self.remainder, operators)
        return operators
