"""Integrals of the kernel over [-ε, ε]: what half angles and a grid ask for, whatever joint they belong to.

½ ∫ k(t - s) f(s) ds for even f and for odd f, as matrices (loads, points + 1, points) from f at the points to the
integral at the points and at t = ε. They are linear in the kernel: in a_1 .. a_6 and in the rest r_n, see `kernel`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from math import ceil, pi, prod
from threading import local

import numpy

from ...core.arrays import Numbers
from .closed_forms import ORDER, logarithmic, modular, smooth
from .grid import QuadratureGrid

Operators = tuple[Numbers, Numbers]
"""Operators of even functions and of odd ones."""

_BLOCK = 16_384  # waves at a time: what stays in the cache
_PANEL_STEP = 8
_LONGEST_PANEL = 96
_KEPT = (32, 64, 128)  # so many waves are kept


_MOST = 1 << 18  # bytes that are kept of each


class _Held(local):
    """What this thread holds, by name."""

    def __init__(self) -> None:
        self.arrays: dict[str, numpy.ndarray] = {}


_held = _Held()


def scratch(name: str, shape: tuple[int, ...], dtype: type = float) -> numpy.ndarray:
    """An array with whatever was in it, good until the same thread asks for that name again."""
    size = prod(shape)
    if size * numpy.dtype(dtype).itemsize > _MOST:
        return numpy.empty(shape, dtype)
    if name not in _held.arrays:
        _held.arrays[name] = numpy.empty(_MOST, numpy.uint8)
    return _held.arrays[name].view(dtype)[:size].reshape(shape)


@dataclass(frozen=True, kw_only=True, eq=False)
class Intervals:
    """[-ε, ε] for half angles ε (loads,) on a grid."""

    half_angle: Numbers
    grid: QuadratureGrid

    def closed(self, a: Numbers) -> Operators:
        """The operators of the closed forms with the coefficients a_1 .. a_6."""
        grid, edge = self.grid, self.half_angle[:, None, None]
        square = numpy.multiply(edge, grid.distance, out=scratch("square", (edge.size, *grid.distance.shape)))
        square *= square
        log_weights = grid.weights * numpy.log(edge)
        weights = _horner("logarithmic", logarithmic(a), square)
        weights *= numpy.add(log_weights, grid.log_weights, out=scratch("log weights", weights.shape))
        part = _horner("other", modular(a), square)
        part *= numpy.multiply(edge, grid.modulus_weights, out=scratch("modulus weights", weights.shape))
        weights += part
        part = _horner("other", smooth(a, 2 * float(self.half_angle.max(initial=0.0))), square)
        part *= grid.weights
        weights += part
        weights *= edge * (grid.slope / 2)
        left, right = weights[..., : grid.points][..., ::-1], weights[..., grid.points :]
        return left + right, right - left

    def add_rest(self, rest: Numbers, operators: Operators) -> None:
        """Adds those of the rest r_n, in place."""
        size = max(1, _BLOCK // (_fine(self.half_angle, self.grid, len(rest)).count * len(rest)))
        for first in range(0, len(self.half_angle), size):
            block = slice(first, first + size)
            waves = _waves_between(self.half_angle[block], self.grid, len(rest))
            _add(waves, rest, (operators[0][block], operators[1][block]))


@dataclass(frozen=True, kw_only=True, eq=False)
class CachedIntervals:
    """`Intervals` that many joints ask for: what does not depend on the joint is computed once."""

    half_angle: Numbers
    grid: QuadratureGrid

    @cached_property
    def _fresh(self) -> Intervals:
        return Intervals(half_angle=self.half_angle, grid=self.grid)

    @cached_property
    def _closed(self) -> Operators:
        """The operators of each of the six closed forms, along a new last axis."""
        parts = zip(*(self._fresh.closed(unit) for unit in numpy.eye(ORDER)), strict=True)
        even, odd = (numpy.stack(part, axis=-1) for part in parts)
        return even, odd

    @cached_property
    def _known(self) -> dict[int, tuple[Numbers, Numbers, Numbers, Numbers]]:
        return {}

    def closed(self, a: Numbers) -> Operators:
        even, odd = self._closed
        return even @ a, odd @ a

    def add_rest(self, rest: Numbers, operators: Operators) -> None:
        if len(rest) > _KEPT[-1]:
            self._fresh.add_rest(rest, operators)
            return
        count = min(kept for kept in _KEPT if kept >= len(rest))
        if count not in self._known:
            even, odd, even_back, odd_back = _waves_between(self.half_angle, self.grid, count)
            self._known[count] = even.copy(), odd.copy(), even_back.copy(), odd_back.copy()
        even, odd, even_back, odd_back = self._known[count]
        some = slice(len(rest))
        _add((even[..., some], odd[..., some], even_back[:, some], odd_back[:, some]), rest, operators)


def _add(waves: tuple[Numbers, Numbers, Numbers, Numbers], rest: Numbers, operators: Operators) -> None:
    even, odd, even_back, odd_back = waves
    for whole, there, back in zip(operators, (even, odd), (even_back, odd_back), strict=True):
        strong = numpy.multiply(there, rest, out=scratch("strong waves", there.shape))
        whole += numpy.matmul(strong, back, out=scratch("rest", whole.shape))


def _waves_between(half_angle: Numbers, grid: QuadratureGrid, count: int) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """The waves cos and sin of (n + ½) t at the targets (loads, points + 1, count), and the integrals of functions at
    the points against them (loads, count, points). They are good until the next call.

    Waves are shorter than what the pressure needs, so they are integrated at points of their own.
    """
    edge = half_angle[:, None]
    fine = _fine(half_angle, grid, count)
    even, odd = _waves("targets", edge * grid.place, count)
    odd *= edge[..., None]
    even *= edge[..., None]
    fine_even, fine_odd = _waves("sources", edge * fine.place, count)
    shape = (len(half_angle), count, grid.points)
    back = numpy.matmul(fine_even.swapaxes(-1, -2), _even_between(grid, fine), out=scratch("even back", shape))
    odd_back = numpy.matmul(fine_odd.swapaxes(-1, -2), _odd_between(grid, fine), out=scratch("odd back", shape))
    return even, odd, back, odd_back


def _fine(half_angle: Numbers, grid: QuadratureGrid, count: int) -> _Panels:
    """Points for that many waves."""
    return _panels(grid.points / 2 + count * float(half_angle.max(initial=0.0)) * pi / 4)


def _waves(name: str, angle: Numbers, count: int) -> tuple[Numbers, Numbers]:
    """cos and sin of (n + ½) angle for n below count, along a new last axis, good until that name is asked for."""
    waves = scratch("waves", (*angle.shape, count), complex)
    waves[..., 0] = numpy.exp(0.5j * angle)
    waves[..., 1:] = numpy.exp(1j * angle)[..., None]
    numpy.multiply.accumulate(waves, axis=-1, out=waves)
    parts = scratch(f"cos at {name}", waves.shape), scratch(f"sin at {name}", waves.shape)
    parts[0][...], parts[1][...] = waves.real, waves.imag
    return parts


def _horner(name: str, coefficients: Numbers, x: Numbers) -> Numbers:
    total = scratch(name, x.shape)
    total[...] = coefficients[-1]
    for coefficient in coefficients[-2::-1]:
        total *= x
        total += coefficient
    return total


@dataclass(frozen=True, kw_only=True, eq=False)
class _Panels:
    """Gauss-Legendre points in equal panels of y from 0 to 1."""

    panels: int
    points: int

    @property
    def count(self) -> int:
        return self.panels * self.points

    @cached_property
    def nodes(self) -> tuple[Numbers, Numbers]:
        """y and weights."""
        x, w = numpy.polynomial.legendre.leggauss(self.points)
        y = (numpy.arange(self.panels)[:, None] + (1 + x) / 2).ravel() / self.panels
        return y, numpy.tile(w / (2 * self.panels), self.panels)

    @property
    def place(self) -> Numbers:
        """t/ε."""
        return numpy.sin(pi / 2 * self.nodes[0])

    @property
    def width(self) -> Numbers:
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
def _even_between(grid: QuadratureGrid, fine: _Panels) -> Numbers:
    """From an even function at the points of a grid to its weighted values at those of the panels."""
    return _between(grid, fine, 0)


@cache
def _odd_between(grid: QuadratureGrid, fine: _Panels) -> Numbers:
    return _between(grid, fine, 1)


def _between(grid: QuadratureGrid, fine: _Panels, parity: int) -> Numbers:
    y, w = grid.right
    degree = 2 * numpy.arange(grid.points) + parity
    P, Q = (numpy.polynomial.legendre.legvander(part, 2 * grid.points)[:, degree] for part in (y, fine.nodes[0]))
    return fine.width[:, None] * (Q @ ((2 * degree[:, None] + 1) * (w[:, None] * P).T))
