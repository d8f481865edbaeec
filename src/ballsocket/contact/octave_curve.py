"""Quantities over a positive number as piecewise polynomials, with equally many pieces in each octave.

An octave reaches from one power of two to the next. The binary exponent and the mantissa of a number give its piece,
without a logarithm, and the relative accuracy is the same for small and large numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import frexp
from typing import Any

import numpy

from ..core import arrays
from ..core.arrays import Array, Numbers, clip, convert_like, exp, log, where
from ..core.lazy import cached_property

_DEGREE = 6  # degree of the polynomial of a piece
_DENSITIES = (4, 8)  # numbers of pieces of an octave that are tried in turn
_TOLERANCE = 1e-9  # largest relative error of a curve with enough pieces
_BLOCK = 8192  # numbers in one block, which fits into the cache


@dataclass(frozen=True, kw_only=True, eq=False)
class OctaveCurve:
    """Piecewise polynomials of some quantities over a positive number x, such as a load.

    Attributes
    ----------
    low, high : float
        Ends of the curve.
    density : int
        Number of pieces of an octave.
    first : int
        Number of the first piece, see `piece_number`.
    origins : array (pieces,)
        Number in each piece from which its polynomials are counted.
    coefficients : array (quantities, terms, pieces)
        Coefficients of each quantity in x less the origin of the piece, the highest power first.
    error : array (quantities,)
        Largest relative error at points between the fitted ones.
    """

    low: float
    high: float
    density: int
    first: int
    origins: Numbers
    coefficients: Numbers
    error: Numbers

    def __call__(self, x: Numbers) -> Numbers:
        """Evaluate all quantities (quantities, n) at numbers (n,) between both ends."""
        values = numpy.empty((len(self.coefficients), len(x)))
        for start in range(0, len(x), _BLOCK):
            block = x[start : start + _BLOCK]
            mantissa, exponent = numpy.frexp(block)
            piece = (2 * self.density * mantissa).astype(numpy.intp)
            piece += self.density * exponent - self.first
            offset = block - self.origins.take(piece, mode="clip")
            for row, terms in zip(values, self.coefficients, strict=True):
                total = terms[0].take(piece, mode="clip")
                for term in terms[1:]:
                    total *= offset
                    total += term.take(piece, mode="clip")
                row[start : start + _BLOCK] = total
        return values

    def select(self, indices: Sequence[int]) -> OctaveCurve:
        """Return the curve of some of the quantities."""
        return replace(
            self,
            coefficients=numpy.ascontiguousarray(self.coefficients[list(indices)]),
            error=self.error[list(indices)],
        )

    @property
    def numbers(self) -> tuple[float, float, int, int, Numbers, Numbers]:
        """Numbers of the first quantity for `derivatives_at` in compiled code, with rows (pieces, terms)."""
        rows = numpy.ascontiguousarray(self.coefficients[0].T)
        return self.low, self.high, self.first, self.density, self.origins, rows

    @cached_property
    def plain_numbers(self) -> tuple[Any, ...]:
        """Numbers of the first quantity as Python numbers and tuples, for fast evaluation."""
        *ends, origins, rows = self.numbers
        return *ends, tuple(origins.tolist()), tuple(map(tuple, rows.tolist()))

    def integral(self) -> OctaveCurve:
        """Integrate the first quantity over x; below the low end it is a power of x."""
        value, slope, _ = derivatives_at(self.low, *self.plain_numbers)
        powers = numpy.arange(self.coefficients.shape[1], 0, -1)
        rising = numpy.append(self.coefficients[0] / powers[:, None], numpy.zeros((1, len(self.origins))), axis=0)
        edges = piece_edges(self.low, self.high, self.density)
        left, right = (numpy.polyval(rising, ends - self.origins) for ends in (edges[:-1], edges[1:]))
        first_integral = value * self.low / (1.0 + slope * self.low / value)
        rising[-1] = first_integral + numpy.append(0.0, numpy.cumsum(right - left)[:-1]) - left
        return replace(self, coefficients=rising[None], error=self.error[:1])


def piece_number(x: float, density: int) -> int:
    """Return the number of the piece of a number x = m 2^e with 1/2 <= m < 1: the integer part of 2 m n, plus e n."""
    mantissa, exponent = frexp(x)
    return int(2 * density * mantissa) + density * exponent


def piece_edges(low: float, high: float, density: int) -> Numbers:
    """Compute the ends of pieces (pieces + 1,) from an edge at or below `low`; the last piece is not a narrow one."""
    octave, part = numpy.divmod(numpy.arange(piece_number(low, density), piece_number(high, density) + 1), density)
    edges = numpy.ldexp(1 + part / density, octave - 2)
    return numpy.append(edges[edges < high * (1 - 1 / (8 * density))], high)


def derivatives_at(
    x: float,
    low: float,
    high: float,
    first: int,
    density: int,
    origins: Sequence[float],
    rows: Sequence[Sequence[float]],
) -> tuple[float, float, float]:
    """Evaluate one quantity and its first two derivatives at a number x.

    They are 0 for x of 0 or less, a power of x below `low`, and NaN beyond `high`.
    """
    if x <= 0.0:
        return 0.0, 0.0, 0.0
    if not x <= high:
        return math.nan, math.nan, math.nan
    inside = low if x < low else x  # `max` and `min` take longer than the polynomials
    mantissa, exponent = frexp(inside)
    piece = int(2 * density * mantissa) + density * exponent - first
    if piece == len(rows):
        piece -= 1
    offset = inside - origins[piece]
    value, slope, bend = 0.0, 0.0, 0.0
    for coefficient in rows[piece]:
        bend = bend * offset + slope
        slope = slope * offset + value
        value = value * offset + coefficient
    if x < low:
        power = slope * low / value
        value *= (x / low) ** power
        slope = power * value / x
        return value, slope, (power - 1.0) * slope / x
    return value, slope, 2.0 * bend


_SMALLEST = 1e-150  # number whose powers do not underflow in an intermediate result


def derivatives_of_array(x: Array, curve: OctaveCurve) -> tuple[Array, Array, Array]:
    """Evaluate the first quantity of a curve and its first two derivatives at an array of any library.

    They are a power of x below the low end, and NaN beyond the high one.
    """
    xp = arrays.namespace(x)
    d = where(x == x, clip(x, _SMALLEST, curve.high), curve.high)
    inside = clip(d, curve.low, curve.high)
    fixed = arrays.stop_gradient(inside)
    octave = xp.floor(xp.log2(fixed))
    number = xp.floor(curve.density * fixed / 2.0**octave) + curve.density * (octave + 1.0) - curve.first
    piece = xp.astype(clip(number, 0.0, len(curve.origins) - 1.0), xp.int64)

    def take(values: Numbers) -> Array:
        return xp.reshape(xp.take(convert_like(values, x), xp.reshape(piece, (-1,))), tuple(x.shape))

    offset = inside - take(curve.origins)
    value = slope = bend = 0.0 * offset
    for terms in curve.coefficients[0]:
        bend = bend * offset + slope
        slope = slope * offset + value
        value = value * offset + take(terms)
    below = d < curve.low
    power = slope * curve.low / value
    value = value * exp(where(below, power * log(where(below, d, curve.low) / curve.low), 0.0))
    slope = where(below, power * value / d, slope)
    bend = where(below, (power - 1.0) * slope / d, 2.0 * bend)
    is_solved = x <= curve.high
    return tuple(where(is_solved, part, math.nan) for part in (value, slope, bend))


@numpy.errstate(all="ignore")  # quantities without a value have an infinite error
def fit_octave_curve(quantities: Callable[[Numbers], Numbers], low: float, high: float) -> OctaveCurve:
    """Fit a curve to computed quantities, with more pieces until their error is small.

    The function returns quantities (quantities, n) at numbers (n,). The curve begins at the edge of a piece, at or
    below `low`.
    """
    nodes, checks = -numpy.cos(math.pi * numpy.arange(_DEGREE + 1) / _DEGREE), math.cos(math.pi * 5 / 12)
    for density in _DENSITIES:
        edges = piece_edges(low, high, density)
        centres, halves = (edges[1:] + edges[:-1]) / 2, numpy.diff(edges) / 2
        inner = centres[:, None] + halves[:, None] * nodes[1:-1]
        points = numpy.append(numpy.column_stack([edges[:-1], inner]).ravel(), high)
        between = numpy.concatenate([centres - checks * halves, centres + checks * halves])
        values = quantities(numpy.concatenate([points, between]))
        fitted, checked = values[:, : len(points)], values[:, len(points) :]
        ends = fitted[:, _DEGREE::_DEGREE, None]
        samples = numpy.concatenate([fitted[:, :-1].reshape(len(values), -1, _DEGREE), ends], axis=2)
        scaled = samples @ _interpolation_matrix().T / halves[:, None] ** numpy.arange(_DEGREE, -1, -1)
        curve = OctaveCurve(
            low=float(edges[0]),
            high=high,
            density=density,
            first=piece_number(low, density),
            origins=centres,
            coefficients=numpy.ascontiguousarray(scaled.transpose(0, 2, 1)),
            error=numpy.full(len(values), numpy.inf),
        )
        error = numpy.max(abs(curve(between) / checked - 1), axis=1)
        if numpy.all(error <= _TOLERANCE):
            break
    return replace(curve, error=error)


@cache
def _interpolation_matrix() -> Numbers:
    """Compute the matrix from values at the nodes to the coefficients of the polynomial, the highest power first."""
    nodes = -numpy.cos(math.pi * numpy.arange(_DEGREE + 1) / _DEGREE)
    return numpy.linalg.inv(numpy.vander(nodes))
