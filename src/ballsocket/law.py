"""A model bound once to a joint: force and tangent at one indentation after the other, as a program in time asks."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Protocol

import numpy

from .arrays import Numbers

Pieces = Sequence[Sequence[float]]


class Law(Protocol):
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
    def _numbers(self) -> tuple[float, float, float, float, Pieces]:
        rows = tuple(map(tuple, self.pieces.tolist()))
        return self.shallowest, self.deepest, self.first, self.density, rows

    def __call__(self, indentation: float) -> tuple[float, float]:
        return force_and_tangent(indentation, *self._numbers)


def force_and_tangent(
    indentation: float, shallowest: float, deepest: float, first: float, density: float, pieces: Pieces
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


_DEGREE = 9
_COUNTS = (24, 48, 96)
_SCANNED = 200


def curve_law(force: Callable[[Numbers], Numbers], shallowest: float, deepest: float, tolerance: float) -> CurveLaw:
    """The law through the loads of many indentations: more of them until the last terms of ln F are below a tolerance.

    Parameters
    ----------
    force : function
        From indentations in mm to loads in N, NaN where there is none.
    shallowest, deepest : float
        Where the curve begins and ends, in mm; nearer together where loads are missing.
    tolerance : float
        Of ln F.
    """
    low, high = _answered(force, shallowest, deepest)
    for count in _COUNTS:
        series = _series(force, low, high, count)
        if numpy.max(abs(series[:, -1])) <= tolerance:
            break
    return CurveLaw(
        shallowest=low,
        deepest=high,
        first=math.log(low),
        density=count / math.log(high / low),
        pieces=numpy.ascontiguousarray((series @ _powers())[:, ::-1]),
    )


def _answered(force: Callable[[Numbers], Numbers], low: float, high: float) -> tuple[float, float]:
    """The part of the range that has loads."""
    if numpy.isfinite(force(numpy.array([low, high]))).all():
        return low, high
    tried = numpy.geomspace(low, high, _SCANNED)
    good = tried[numpy.isfinite(force(tried))]
    return float(good[0]), float(good[-1])


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
