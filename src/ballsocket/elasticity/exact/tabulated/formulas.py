"""Contact quantities from the three tabulated functions at a half angle: d, F, p0, their slopes and the inverse.

Under the linear gap everything is proportional to c + d. With the compliance C = 2 (1 - ν²) R2/E (1 + β) of liner
and ball, the contact follows from three functions of the half angle, ν, R2/L and the ball:

    ln of d/(c + d)/(1 - cos ε),     ln of F C/(R2² (c + d) ε³),     ln of p0 C/((c + d) ε).

Slopes are those by ln ε.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy

from ....contact.roots import Increasing, increasing_root
from ....core import arrays
from ....core.arrays import Array, cos, exp, log, log1p, sin, where
from .chebyshev import ANGLE_SCALE, LIMIT, angle_root, chebyshev_polynomials, chebyshev_values

Pair = tuple[Array, Array]
"""A value and its slope."""

_LOG_OFFSET = -1.0
"""Value of the unknown, a shifted ln ε, at the widest contact; the shift keeps it away from zero."""

ONE, TWO, ALL = (0,), (0, 1), (0, 1, 2)
"""Indices of the functions to evaluate."""


class CurveCoefficients(NamedTuple):
    """Chebyshev coefficients of the functions of joints (joints,): one, or one for each contact.

    `functions` and `slopes` have the shape (functions, angles, joints); slopes are derivatives by the coordinate. A
    joint of Python numbers has one matrix for both: functions and then derivatives by angles.
    """

    ratio: Array
    """R2/L"""
    functions: Array
    slopes: Array


class Scale(NamedTuple):
    """Scales that turn the functions into lengths, forces and pressures."""

    clearance: Array
    """c in mm."""
    area: Array
    """R2² in mm²."""
    compliance: Array
    """C in mm/MPa."""


def evaluate_table_functions(angle: Array, curve: CurveCoefficients, rows: tuple[int, ...]) -> tuple[Pair, ...]:
    """Evaluate the tabulated functions in `rows`, with their slopes by ln ε, at half angles above 0."""
    root = angle_root(angle, curve.ratio)
    coordinate, widening = 2 * root - 1, angle_derivative(angle, root, curve.ratio)
    if type(angle) is float:
        values = (curve.functions @ chebyshev_values(coordinate, curve.functions.shape[1])).tolist()
        return tuple((values[k], widening * values[k + 3]) for k in rows)
    waves = chebyshev_polynomials(coordinate, curve.functions.shape[1])
    return tuple(
        (sum_series(curve.functions[k, ...], waves), widening * sum_series(curve.slopes[k, ...], waves)) for k in rows
    )


def sum_series(coefficients: Array, waves: Array) -> Array:
    """Evaluate Chebyshev series at contacts, from coefficients and polynomials.

    `coefficients` has the shape (angles, joints or 1), `waves` (angles, contacts).
    """
    xp = arrays.namespace(waves)
    if coefficients.shape[-1] == 1:
        return coefficients[:, 0] @ waves
    return numpy.einsum("ij,ij->j", coefficients, waves) if xp is numpy else xp.sum(coefficients * waves, axis=0)


def angle_derivative(angle: Array, root: Array, ratio: Array) -> Array:
    """Compute the derivative of the table coordinate 2 root - 1 with respect to ln ε."""
    near = ANGLE_SCALE * (1 + ratio)
    return near * angle / ((1 + near * angle) * log1p(near * LIMIT) * root)


def opening(angle: Array, share: Pair) -> Pair:
    """Compute the relative indentation σ = d/(c + d) and its log slope by ln ε from the first tabulated function."""
    half = sin(angle / 2)
    return exp(share[0]) * 2 * half * half, share[1] + angle * cos(angle / 2) / half


def contact_quantities(
    angle: Array, curve: CurveCoefficients, scale: Scale
) -> tuple[Array, Array, Array, Array, Array]:
    """Compute indentation d, force, pole pressure, stiffness and the slope dd/d(ln ε) at half angles above 0.

    The units are mm, N, MPa, N/mm and mm.
    """
    share, load, pole = evaluate_table_functions(angle, curve, ALL)
    sigma, rate = opening(angle, share)
    reach = scale.clearance / (1 - sigma)
    outer = sigma * rate / (1 - sigma)
    F = exp(load[0]) * angle * angle * angle * scale.area * reach / scale.compliance
    p0 = exp(pole[0]) * angle * reach / scale.compliance
    return reach * sigma, F, p0, F * (load[1] + 3 + outer) / (reach * outer), reach * outer


def angle_of_indentation(load: Array, curve: CurveCoefficients) -> Array:
    """Solve for the half angle in rad at a relative indentation d/c; NaN beyond the tables."""
    return _solve_angle(_indentation_residual, load, log(1.5 * load / (1 + load)) / 2, curve)


def angle_of_force(load: Array, curve: CurveCoefficients) -> Array:
    """Solve for the half angle in rad under a dimensionless force F C/(R2² c); NaN beyond the tables."""
    return _solve_angle(_force_residual, load, log(load / (3 + load)) / 3, curve)


def _solve_angle(residual: Increasing, load: Array, log_estimate: Array, curve: CurveCoefficients) -> Array:
    """Solve for the half angle in rad by Newton's method, from an estimate of ln ε."""
    start = log_estimate + (_LOG_OFFSET - math.log(LIMIT))
    end = 0.0 * start + (_LOG_OFFSET + 1e-12)  # includes the widest contact itself
    root = increasing_root(residual, 0.0 * start, start - 6.0, end, start, arguments=(load, curve), steps=16)
    return where(root < end, exp(root - _LOG_OFFSET) * LIMIT, math.nan)


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
