"""Half angles of forces and indentations: a start from a fitted series, then a few Newton steps.

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

from ....contact.roots import Increasing, increasing_root
from ....core import arrays
from ....core.arrays import Array, Numbers, exp, log, where
from .chebyshev import (
    LIMIT,
    angle_root,
    chebyshev_coefficients,
    chebyshev_points,
    chebyshev_polynomials,
    convert_like,
    half_angle_at,
    load_tables,
    multiply_factors,
    thickness_ratio_at,
)
from .curves import (
    ONE,
    TWO,
    CurveCoefficients,
    JointCurves,
    Pair,
    Widest,
    derivative_series,
    evaluate_table_functions,
    opening,
    sum_series,
    traced_series,
)

_LOG_OFFSET = -1.0
"""Value of the unknown, a shifted ln ε, at the widest contact; the shift keeps it away from zero."""

_END = _LOG_OFFSET + 1e-12
"""Upper end of the unknown, which includes the widest contact itself."""

RIGID_STEPS, ELASTIC_STEPS = 2, 5
"""Newton steps from the start to rounding errors, with a rigid ball and with an elastic one, which the start omits."""

_START_COUNTS = (10, 11, 16)
"""Numbers of Chebyshev polynomials of ν, R2/L and half angle in the start."""

_FIT_STEPS = 8
"""Newton steps to the half angles that the start is fitted to."""


def solve_half_angle(curves: JointCurves, kind: str, load: Array) -> Array:
    """Solve for the half angle in rad under a positive load; NaN beyond the tables."""
    inverse, scaled = INVERSES[kind], curves.scaled_load(kind, load)
    if curves.has_plain_joint:
        start, steps = inverse.estimate(scaled) + (_LOG_OFFSET - math.log(LIMIT)), _SCALAR_STEPS
    else:
        start = _start_from_series(curves, kind, scaled)
        steps = RIGID_STEPS if curves.joint.ball is None else ELASTIC_STEPS
    end = 0.0 * start + _END
    arguments = (scaled, curves.curve)
    root = increasing_root(inverse.residual, 0.0 * start, start - 6.0, end, start, arguments=arguments, steps=steps)
    return half_angle_of_root(root)


_SCALAR_STEPS = 16
"""Largest number of Newton steps from the estimate for a single press."""


def half_angle_of_root(root: Array) -> Array:
    """Compute the half angle in rad from the solved unknown; NaN beyond the tables."""
    return where(root < _END, exp(root - _LOG_OFFSET) * LIMIT, math.nan)


def _start_from_series(curves: JointCurves, kind: str, load: Array) -> Array:
    """Compute the first value of the unknown under a dimensionless load, from the fitted series of each joint."""
    log_share = arrays.stop_gradient(INVERSES[kind].log_share(load, curves.widest))
    coordinate = start_coordinate(log_share, curves.ratio)
    series = arrays.stop_gradient(start_series(curves, kind))
    if arrays.all_true(load == load) is None:
        correction = traced_series(series, coordinate)[0]
    else:
        correction = sum_series(series, chebyshev_polynomials(coordinate, series.shape[0]))
    return start_root(log_share, correction)


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
    first, second = (
        polynomials[:count, ...] for polynomials, count in zip(curves.liner_polynomials, _START_COUNTS[:2], strict=True)
    )
    return multiply_factors(convert_like(_start_table(curves.file, kind), first), first, second)


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
    """Compute the residual of the relative indentation d/c at a trial half angle, and its slope by ln ε.

    The residual is ln d/(c + d) minus that of the load.
    """
    angle = exp(log_angle - _LOG_OFFSET) * LIMIT
    sigma, rate = opening(angle, evaluate_table_functions(angle, curve, ONE)[0])
    return log(sigma * (1 + 1 / load)), rate


def _force_residual(log_angle: Array, load: Array, curve: CurveCoefficients) -> Pair:
    """Compute the residual of the dimensionless force at a trial half angle, and its slope by ln ε.

    The residual is ln d/(c + d) minus that of the indentation F/secant, where secant is the ratio F/d.
    """
    angle = exp(log_angle - _LOG_OFFSET) * LIMIT
    share, force = evaluate_table_functions(angle, curve, TWO)
    sigma, rate = opening(angle, share)
    secant = exp(force[0]) * angle * angle * angle / sigma
    return log(sigma * (1 + secant / load)), rate + (force[1] + 3 - rate) * secant / (secant + load)


def force_log_share(load: Array, widest: Widest) -> Array:
    """Estimate ln(ε/LIMIT) under a dimensionless force q = F C/(R2² c)."""
    return log(load / (widest.force + widest.opening * load)) / 3


def indentation_log_share(load: Array, widest: Widest) -> Array:
    """Estimate ln(ε/LIMIT) under a relative indentation d/c."""
    return log(load / ((1 + load) * widest.opening)) / 2


class _Inverse(NamedTuple):
    """Functions that invert one kind of load."""

    residual: Increasing
    """Residual and its slope by ln ε at a trial value of the unknown."""
    log_share: Callable[[Array, Widest], Array]
    """Estimate of ln(ε/LIMIT) from a dimensionless load."""
    load_at: Callable[[Array, Widest], Array]
    """Dimensionless load of an estimated ε/LIMIT; negative beyond the perfect fit."""
    estimate: Callable[[Array], Array]
    """Estimate of ln ε for a single press, which needs no fit."""


INVERSES = {
    "force": _Inverse(
        residual=_force_residual,
        log_share=force_log_share,
        load_at=lambda share, widest: widest.force / (1 / share**3 - widest.opening),
        estimate=lambda load: log(load / (3 + load)) / 3,
    ),
    "indentation": _Inverse(
        residual=_indentation_residual,
        log_share=indentation_log_share,
        load_at=lambda share, widest: 1 / (1 / (share * share * widest.opening) - 1),
        estimate=lambda load: log(1.5 * load / (1 + load)) / 2,
    ),
}
"""Functions of the inverse by kind of load."""
