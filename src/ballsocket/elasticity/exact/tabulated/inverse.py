"""Half angles of forces and indentations: a start from a fitted series, a Newton step, and a linear correction.

With y = ε/LIMIT, the relative indentation σ = d/(c + d) and h = F C/(R2² (c + d)) are about σ1 y² and h1 y³, with σ1
and h1 at LIMIT. An indentation has σ = (d/c)/(1 + d/c), so y² is about σ/σ1. A force has q = F C/(R2² c) = h/(1 - σ),
so y³ is about q/(h1 + q σ1). What is left, a factor of ε, is a smooth function of ν, R2/L and the coordinate of y.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy

from ....contact.coordinates import LIMIT, angle_root, half_angle_at
from ....contact.roots import Increasing, implicit_root, scalar_increasing_root
from ....core import arrays
from ....core.arrays import Array, Numbers, convert_like, exp, log, where
from ....core.chebyshev import Pair, chebyshev_coefficients, chebyshev_points, contract_factors, series_values
from .chebyshev import load_tables, thickness_ratio_at
from .curves import (
    ONE,
    TWO,
    CurveCoefficients,
    JointCurves,
    TabulatedState,
    Widest,
    derivative_series,
    evaluate_table_functions,
    opening,
    shift_state,
    tabulated_state,
)

_LOG_OFFSET = -1.0  # value of the unknown, a shifted ln ε, at the widest contact; the shift keeps it away from zero
_END = _LOG_OFFSET + 1e-12  # upper end of the unknown, which includes the widest contact itself

RIGID_STEPS, ELASTIC_STEPS = 1, 3
"""Newton steps from the start to errors below 1e-6, with a rigid ball and with an elastic one; the start has none."""

_START_COUNTS = (12, 13, 20)  # numbers of Chebyshev polynomials of ν, R2/L and half angle in the start
_FIT_STEPS = 8  # Newton steps to the half angles that the start is fitted to


def solve_state(curves: JointCurves, kind: str, load: Array) -> tuple[TabulatedState, Array]:
    """Solve for the dimensionless contact under a positive load, and its last correction; NaN beyond the tables."""
    inverse, scaled = INVERSES[kind], load * curves.load_scale(kind)
    steps = RIGID_STEPS if curves.joint.ball is None else ELASTIC_STEPS

    def residual(root: Array) -> Pair:
        return inverse.residual(root, scaled, curves.curve)

    def solve(root: Array) -> Array:
        for _ in range(steps):
            root = limited_newton_step(root, *residual(root))
        return root

    if curves.has_plain_joint:  # without the series of the start, which costs more than the steps that it saves
        start = min(inverse.log_share(scaled, curves.widest) + _LOG_OFFSET, _END)
        arguments = (scaled, curves.curve), _SCALAR_STEPS, _SCALAR_TOLERANCE
        root = scalar_increasing_root(inverse.residual, 0.0, start - 6.0, _END, start, *arguments)
    else:
        log_share = arrays.stop_gradient(inverse.log_share(scaled, curves.widest))
        series = arrays.stop_gradient(start_series(curves, kind))  # the fitted series of each joint
        start = start_root(log_share, series_values(series, start_coordinate(log_share, curves.ratio)))
        root = implicit_root(residual, solve, start)
    state = tabulated_state(half_angle_of_root(root), curves.curve)
    shift = inverse.shift(state, scaled)
    return shift_state(state, shift), shift


_SCALAR_STEPS = 16  # largest number of Newton steps from the estimate for a single press
_SCALAR_TOLERANCE = 1e-4  # Newton step of a single press after which its error is below 1e-7


def half_angle_of_root(root: Array) -> Array:
    """Compute the half angle in rad from the solved unknown; NaN beyond the tables."""
    return where(root < _END, exp(root - _LOG_OFFSET) * LIMIT, math.nan)


def start_coordinate(log_share: Array, ratio: Array) -> Array:
    """Compute the table coordinate of a half angle, at most that of LIMIT, from the logarithm of its share of LIMIT."""
    return 2 * angle_root(LIMIT * exp(where(log_share < 0, log_share, 0.0)), ratio) - 1


def start_root(log_share: Array, correction: Array) -> Array:
    """Compute the first value of the unknown from the estimated ln(ε/LIMIT) and its correction."""
    root = where(log_share < 0, log_share, 0.0) + correction + _LOG_OFFSET
    return where(root < _END, root, _END)


def limited_newton_step(root: Array, value: Array, slope: Array) -> Array:
    """Compute the next value of the unknown by Newton's method, at most the end of the tables."""
    next_root = root - value / slope
    return where(next_root < _END, next_root, _END)


def start_series(curves: JointCurves, kind: str) -> Array:
    """Compute the Chebyshev coefficients (angles, joints) of the correction of the start, for each joint."""
    if curves.shared is not None:
        return curves.take_shared(start_series(curves.shared, kind))
    pairs = zip(curves.liner_polynomials, _START_COUNTS[:2], strict=True)
    first, second = (polynomials[:count, ...] for polynomials, count in pairs)
    contracted, products = contract_factors(convert_like(_start_table(curves.file, kind), first), first, second)
    return contracted @ products


@cache
def _start_table(file: str, kind: str) -> Numbers:
    """Fit the correction of the start for rigid balls: Chebyshev coefficients (angles, products of ν and R2/L)."""
    poisson, thickness, angle = (
        grid.ravel() for grid in numpy.meshgrid(*map(chebyshev_points, _START_COUNTS), indexing="ij")
    )
    ratio = thickness_ratio_at(thickness)
    functions = load_tables(file)["rigid"].coefficients_at([poisson, thickness])
    curve = CurveCoefficients(ratio, functions, derivative_series(functions))
    inverse, start = INVERSES[kind], half_angle_at(angle, ratio)
    load = inverse.load_at(start / LIMIT, Widest.of(functions))
    root = first = numpy.log(start / LIMIT) + _LOG_OFFSET
    for _ in range(_FIT_STEPS):
        value, slope = inverse.residual(root, load, curve)
        root = root - value / slope
    coefficients = (root - first).reshape(_START_COUNTS)
    for axis in range(3):
        coefficients = chebyshev_coefficients(coefficients, axis)
    return numpy.ascontiguousarray(coefficients.reshape(-1, _START_COUNTS[2]).T)


def _indentation_residual(log_angle: Array, load: Array, curve: CurveCoefficients) -> Pair:
    """Compute the residual ln d/(c + d), minus that of the load d/c, at a trial half angle, and its slope by ln ε."""
    angle = exp(log_angle - _LOG_OFFSET) * LIMIT
    sigma, rate = opening(angle, evaluate_table_functions(angle, curve, ONE)[0])
    return log(sigma * (1 + 1 / load)), rate


def _force_residual(log_angle: Array, load: Array, curve: CurveCoefficients) -> Pair:
    """Compute the residual ln(σ + h/q), 0 for the force q = h/(1 - σ), at a trial half angle, and its slope by ln ε."""
    angle = exp(log_angle - _LOG_OFFSET) * LIMIT
    share, force = evaluate_table_functions(angle, curve, TWO)
    sigma, rate = opening(angle, share)
    part = exp(force[0]) * angle * angle * angle / load
    total = sigma + part
    return log(total), (sigma * rate + part * (force[1] + 3)) / total


def indentation_shift(state: TabulatedState, load: Array) -> Array:
    """Compute the change of ln ε to a relative indentation d/c, by a Newton step for σ = (d/c)/(1 + d/c)."""
    return (load / (1 + load) / state.opening - 1) / state.opening_rate


def force_shift(state: TabulatedState, load: Array) -> Array:
    """Compute the change of ln ε to a dimensionless force q, by a Newton step for σ + h/q = 1."""
    part = state.force / load
    return (1 - state.opening - part) / (state.opening * state.opening_rate + part * state.force_rate)


def force_log_share(load: Array, widest: Widest) -> Array:
    """Estimate ln(ε/LIMIT) under a dimensionless force q = F C/(R2² c)."""
    return log(load / (widest.force + widest.opening * load)) / 3


def indentation_log_share(load: Array, widest: Widest) -> Array:
    """Estimate ln(ε/LIMIT) under a relative indentation d/c."""
    return log(load / ((1 + load) * widest.opening)) / 2


class _Inverse(NamedTuple):
    """Functions that invert one kind of load."""

    residual: Increasing  # residual and its slope by ln ε at a trial value of the unknown
    shift: Callable[[TabulatedState, Array], Array]  # change of ln ε from a state near the root to the root
    log_share: Callable[[Array, Widest], Array]  # estimate of ln(ε/LIMIT) from a dimensionless load
    # dimensionless load of an estimated ε/LIMIT; negative beyond the perfect fit
    load_at: Callable[[Array, Widest], Array]


INVERSES = {
    "force": _Inverse(
        residual=_force_residual,
        shift=force_shift,
        log_share=force_log_share,
        load_at=lambda share, widest: widest.force / (1 / share**3 - widest.opening),
    ),
    "indentation": _Inverse(
        residual=_indentation_residual,
        shift=indentation_shift,
        log_share=indentation_log_share,
        load_at=lambda share, widest: 1 / (1 / (share * share * widest.opening) - 1),
    ),
}
"""Functions of the inverse by kind of load."""
