"""A model bound once to a joint: force and tangent at one indentation after the other, as a program in time asks."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Protocol

import numpy

from ..core.arrays import Numbers

PolynomialPieces = Sequence[Sequence[float]]


class ForceLaw(Protocol):
    """What `model.law(joint)` returns: a function of one indentation.

    Parameters
    ----------
    indentation : float
        Approach of the centres from first touch in mm; below 0 nothing touches.

    Returns
    -------
    float, float
        Axial load in N and tangent stiffness in N/mm; both NaN where the model has no answer.
    """

    def __call__(self, indentation: float) -> tuple[float, float]: ...


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveLaw:
    """The load of one joint as polynomials of ln d, piece by piece; the tangent is the slope of these.

    Below `shallowest` the load goes on as a power of the indentation, beyond `deepest` there is none.

    Attributes
    ----------
    shallowest, deepest : float
        Ends of the curve in mm.
    first, density : float
        ln d where the first piece begins, and pieces per unit of ln d.
    pieces : array (pieces, coefficients)
        ln F in powers of a place that runs from -1 to 1 along a piece, the highest power first.
    """

    shallowest: float
    deepest: float
    first: float
    density: float
    pieces: Numbers

    @cached_property
    def _numbers(self) -> tuple[float, float, float, float, PolynomialPieces]:
        rows = tuple(map(tuple, self.pieces.tolist()))
        return self.shallowest, self.deepest, self.first, self.density, rows

    def __call__(self, indentation: float) -> tuple[float, float]:
        return force_and_tangent(indentation, *self._numbers)


def force_and_tangent(
    indentation: float, shallowest: float, deepest: float, first: float, density: float, pieces: PolynomialPieces
) -> tuple[float, float]:
    """A `CurveLaw` as a function of its numbers: what it says of an indentation."""
    if indentation <= 0.0:
        return 0.0, 0.0
    if not indentation <= deepest:
        return math.nan, math.nan
    along = (math.log(max(indentation, shallowest)) - first) * density
    number = min(max(int(along), 0), len(pieces) - 1)
    place = 2.0 * (along - number) - 1.0
    value, slope = 0.0, 0.0
    for coefficient in pieces[number]:
        slope = slope * place + value
        value = value * place + coefficient
    force, power = math.exp(value), 2.0 * density * slope
    if indentation < shallowest:
        force *= (indentation / shallowest) ** power
    return force, power * force / indentation


def finite_or_nan(force: float, stiffness: float) -> tuple[float, float]:
    """Force and stiffness, both NaN where one of them is no number or infinite."""
    return (force, stiffness) if math.isfinite(force + stiffness) else (math.nan, math.nan)


_DEGREE = 9
_COUNTS = (24, 48, 96)
_SMOOTH = 1e-11
"""Of ln F: what the last terms of a curve may amount to."""

_TO_THE_END = 1e-6


def curve_law(force: Callable[[Numbers], Numbers], shallowest: float, deepest: float) -> CurveLaw:
    """The law through the loads of many indentations: more of them until the last terms of ln F are small.

    Parameters
    ----------
    force : function
        From indentations in mm to loads in N, NaN where there is none.
    shallowest, deepest : float
        Where the curve begins, and where it ends at the latest: it ends with the loads, in mm.

    Raises
    ------
    TypeError
        A load at the shallowest indentation that is not above 0.
    """
    end = _end(force, shallowest, deepest)
    for count in _COUNTS:
        series = _series(force, shallowest, end, count)
        if numpy.max(abs(series[:, -1])) <= _SMOOTH:
            break
    return CurveLaw(
        shallowest=shallowest,
        deepest=end,
        first=math.log(shallowest),
        density=count / math.log(end / shallowest),
        pieces=numpy.ascontiguousarray((series @ _powers())[:, ::-1]),
    )


def _end(force: Callable[[Numbers], Numbers], low: float, high: float) -> float:
    """The deepest indentation that has a load; a millionth less, since a solver finds that end to its tolerance."""
    if not force(numpy.array([low]))[0] > 0:
        raise TypeError(f"no curve of ln F, since a load is not above 0 N: that of {low:.3g} mm")
    while high / low > 1 + _TO_THE_END:
        tried = numpy.geomspace(low, high, 17)
        last = max(numpy.flatnonzero(numpy.isfinite(force(tried))), default=0)
        if last == 16:
            return high
        low, high = float(tried[last]), float(tried[last + 1])
    return low * (1 - _TO_THE_END)


def _series(force: Callable[[Numbers], Numbers], low: float, high: float, count: int) -> Numbers:
    """Chebyshev coefficients (pieces, terms) of ln F over ln d; neighbours share the load where they meet."""
    places = -numpy.cos(math.pi * numpy.arange(_DEGREE + 1) / _DEGREE)
    along = (numpy.arange(count)[:, None] + (1 + places[:-1]) / 2).ravel() / count
    depths = low * numpy.exp(math.log(high / low) * numpy.append(along, 1.0))
    depths[-1] = high
    logs = numpy.log(force(depths))
    inside, ends = logs[:-1].reshape(count, _DEGREE), logs[_DEGREE::_DEGREE, None]
    values = numpy.concatenate([inside, ends], axis=1)
    return numpy.linalg.solve(numpy.polynomial.chebyshev.chebvander(places, _DEGREE), values.T).T


@cache
def _powers() -> Numbers:
    """The matrix from Chebyshev coefficients to those of powers."""
    square = numpy.zeros((_DEGREE + 1, _DEGREE + 1))
    for term in range(_DEGREE + 1):
        square[term, : term + 1] = numpy.polynomial.chebyshev.cheb2poly(numpy.eye(term + 1)[term])
    return square
