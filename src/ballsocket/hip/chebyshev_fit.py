"""Polynomials of several variables in a box, fitted to values at scattered points by least squares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy
from numpy.polynomial.chebyshev import chebvander

from ..core.arrays import Numbers
from ..core.chebyshev import chebyshev_coefficients
from ..studies.sampling import draw_points

_ROUNDING = 1e-9  # margin of the ends of a box, whose numbers are logarithms and angles


@dataclass(frozen=True, kw_only=True, eq=False)
class Box:
    """Ranges of named variables."""

    ranges: Mapping[str, tuple[float, float]]  # lower and upper end of each variable

    @cached_property
    def axes(self) -> tuple[str, ...]:
        """Names of the variables whose ends differ."""
        return tuple(name for name, (low, high) in self.ranges.items() if high > low)

    def contains(self, numbers: Mapping[str, Numbers]) -> Numbers:
        """Return the mask of the points inside the box, up to rounding; NaN is outside."""
        masks = [
            (numbers[name] >= low - _ROUNDING) & (numbers[name] <= high + _ROUNDING)
            for name, (low, high) in self.ranges.items()
        ]
        inside: Numbers = numpy.logical_and.reduce(masks)
        return inside

    def scale(self, numbers: Mapping[str, Numbers]) -> Numbers:
        """Map points to -1 to 1 on each axis, and those outside to its ends: (axes, points)."""
        count = len(next(iter(numbers.values())))
        scaled = numpy.zeros((len(self.axes), count))
        for row, name in zip(scaled, self.axes, strict=True):
            low, high = self.ranges[name]
            row[:] = numpy.clip((2 * numbers[name] - low - high) / (high - low), -1.0, 1.0)
        return scaled

    def sample(self, count: int) -> list[dict[str, float]]:
        """Return points of a Sobol sequence, denser at the ends like Chebyshev points.

        A larger count has the same first points. A box without axes has a single point.
        """
        from scipy.stats.qmc import Sobol

        if not self.axes:
            return [{name: low for name, (low, _) in self.ranges.items()}][:count]
        scaled = -numpy.cos(numpy.pi * draw_points(Sobol(len(self.axes), rng=0), count))
        points = [{name: low for name, (low, _) in self.ranges.items()} for _ in range(count)]
        for column, name in zip(scaled.T, self.axes, strict=True):
            low, high = self.ranges[name]
            for point, position in zip(points, column, strict=True):
                point[name] = float((low + high + (high - low) * position) / 2)
        return points


def exponents_of(weights: Sequence[int], degree: int) -> Numbers:
    """List the exponents of all terms up to a total degree, in which each axis has a weight: (terms, axes)."""
    powers = product(*(range(degree // weight + 1) for weight in weights))
    terms = [power for power in powers if sum(a * weight for a, weight in zip(power, weights, strict=True)) <= degree]
    return numpy.array(terms, dtype=int).reshape(len(terms), len(weights))


def basis(scaled: Numbers, exponents: Numbers) -> Numbers:
    """Compute products of Chebyshev polynomials at points (axes, points) from -1 to 1: (points, terms)."""
    columns = numpy.ones((len(exponents), scaled.shape[1]))
    for row, powers in zip(scaled, exponents.T, strict=True):
        columns *= chebvander(row, int(powers.max(initial=0))).T[powers]
    return columns.T


def interpolation_weights(points: Numbers, low: float, high: float, count: int) -> Numbers:
    """Compute weights (points, count) that interpolate values at Chebyshev points of a range to other points."""
    if count == 1:
        return numpy.ones((len(points), 1))
    scaled = numpy.clip((2 * points - low - high) / (high - low), -1.0, 1.0)
    weights: Numbers = chebvander(scaled, count - 1) @ chebyshev_coefficients(numpy.eye(count), 0)
    return weights
