"""Force and tangent stiffness of one joint as a function of the indentation, for time integration."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Protocol

import numpy

from ..core.arrays import Numbers
from ..core.lazy import cached_property

PolynomialPieces = Sequence[Sequence[float]]  # coefficients of each piece of a curve, the highest power first


class ForceLaw(Protocol):
    """Interface of the function `model.law(joint)`: force and stiffness from the indentation.

    Parameters
    ----------
    indentation : float
        Approach of the centres from first touch in mm; below 0 there is no contact.

    Returns
    -------
    float, float
        Axial load in N and tangent stiffness in N/mm; both NaN where the model has no result.
    """

    def __call__(self, indentation: float) -> tuple[float, float]: ...


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveLaw:
    """Fitted force law of one joint: ln F is a piecewise polynomial of ln d.

    The tangent stiffness is the slope of the force.

    Below `shallowest` the load is a power of the indentation; beyond `deepest` it is NaN.

    Attributes
    ----------
    shallowest, deepest : float
        Ends of the curve in mm.
    first, density : float
        ln d at the start of the first piece, and pieces per unit of ln d.
    pieces : array (pieces, coefficients)
        Coefficients of ln F in a coordinate from -1 to 1 along each piece, the highest power first.
    """

    shallowest: float
    deepest: float
    first: float
    density: float
    pieces: Numbers

    @cached_property
    def _plain_attributes(self) -> tuple[float, float, float, float, PolynomialPieces]:
        """Attributes of the curve as Python floats and tuples, for fast evaluation."""
        coefficient_rows = tuple(map(tuple, self.pieces.tolist()))
        return self.shallowest, self.deepest, self.first, self.density, coefficient_rows

    def __call__(self, indentation: float) -> tuple[float, float]:
        return force_and_tangent(indentation, *self._plain_attributes)


def force_and_tangent(
    indentation: float, shallowest: float, deepest: float, first: float, density: float, pieces: PolynomialPieces
) -> tuple[float, float]:
    """Evaluate a fitted `CurveLaw` at an indentation in mm: force in N and tangent stiffness in N/mm."""
    if indentation <= 0.0:
        return 0.0, 0.0
    if not indentation <= deepest:
        return math.nan, math.nan
    piece_position = (math.log(max(indentation, shallowest)) - first) * density
    piece_index = min(max(int(piece_position), 0), len(pieces) - 1)
    coordinate = 2.0 * (piece_position - piece_index) - 1.0
    log_force, log_force_slope = 0.0, 0.0
    for coefficient in pieces[piece_index]:
        log_force_slope = log_force_slope * coordinate + log_force
        log_force = log_force * coordinate + coefficient
    force, exponent = math.exp(log_force), 2.0 * density * log_force_slope
    if indentation < shallowest:
        force *= (indentation / shallowest) ** exponent
    return force, exponent * force / indentation


def finite_or_nan(force: float, stiffness: float) -> tuple[float, float]:
    """Return force in N and stiffness in N/mm; NaN for both if one of them is not finite."""
    return (force, stiffness) if math.isfinite(force + stiffness) else (math.nan, math.nan)


_DEGREE = 9  # degree of the polynomial of a piece
_PIECE_COUNTS = (24, 48, 96)  # numbers of pieces that are tried in turn
_SERIES_TOLERANCE = 1e-11  # largest last term of ln F of a curve with enough pieces
_END_TOLERANCE = 1e-6  # relative tolerance of the deepest indentation that has a load


def fit_curve_law(force: Callable[[Numbers], Numbers], shallowest: float, deepest: float) -> CurveLaw:
    """Fit a `CurveLaw` to computed forces; increase the number of pieces until ln F has converged (F in N).

    The function returns loads in N of indentations in mm, NaN where there is none; the curve ends where the loads end.

    Raises TypeError: a load at the shallowest indentation that is not above 0.
    """
    last_indentation = _deepest_indentation(force, shallowest, deepest)
    for piece_count in _PIECE_COUNTS:
        chebyshev_coefficients = _chebyshev_coefficients(force, shallowest, last_indentation, piece_count)
        if numpy.max(abs(chebyshev_coefficients[:, -1])) <= _SERIES_TOLERANCE:
            break
    return CurveLaw(
        shallowest=shallowest,
        deepest=last_indentation,
        first=math.log(shallowest),
        density=piece_count / math.log(last_indentation / shallowest),
        pieces=numpy.ascontiguousarray((chebyshev_coefficients @ _chebyshev_to_power_matrix())[:, ::-1]),
    )


def _deepest_indentation(force: Callable[[Numbers], Numbers], low: float, high: float) -> float:
    """Find the indentation in mm up to which forces are finite, less 1e-6 of it, by repeated refinement of a grid."""
    if not force(numpy.array([low]))[0] > 0:
        raise TypeError(f"no force law: the load at an indentation of {low:.3g} mm must be above 0 N")
    while high / low > 1 + _END_TOLERANCE:
        depths = numpy.geomspace(low, high, 17)
        first_missing = min(numpy.flatnonzero(~numpy.isfinite(force(depths))), default=len(depths))
        if first_missing == len(depths):
            return high
        low, high = float(depths[first_missing - 1]), float(depths[first_missing])
    return low * (1 - _END_TOLERANCE)


def _chebyshev_coefficients(force: Callable[[Numbers], Numbers], low: float, high: float, piece_count: int) -> Numbers:
    """Compute the Chebyshev coefficients (pieces, terms) of ln F (N) over ln d (mm), with continuous pieces."""
    nodes = -numpy.cos(math.pi * numpy.arange(_DEGREE + 1) / _DEGREE)
    piece_positions = (numpy.arange(piece_count)[:, None] + (1 + nodes[:-1]) / 2).ravel() / piece_count
    depths = low * numpy.exp(math.log(high / low) * numpy.append(piece_positions, 1.0))
    depths[-1] = high
    log_forces = numpy.log(force(depths))
    interior_values, end_values = log_forces[:-1].reshape(piece_count, _DEGREE), log_forces[_DEGREE::_DEGREE, None]
    values = numpy.concatenate([interior_values, end_values], axis=1)
    return numpy.linalg.solve(numpy.polynomial.chebyshev.chebvander(nodes, _DEGREE), values.T).T


@cache
def _chebyshev_to_power_matrix() -> Numbers:
    matrix = numpy.zeros((_DEGREE + 1, _DEGREE + 1))
    for term in range(_DEGREE + 1):
        matrix[term, : term + 1] = numpy.polynomial.chebyshev.cheb2poly(numpy.eye(term + 1)[term])
    return matrix
