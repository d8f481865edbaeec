"""What follows from the three tabulated functions at a half angle: d, F, p0, their slopes, and the way back.

Under the linear gap everything is proportional to c + d, so with the compliance C = 2 (1 - ν²) R2/E (1 + β) of
liner and ball, three functions of the half angle, ν, R2/L and the ball alone are all there is to know:

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

_END = -1.0
"""The unknown is ln ε, shifted so that it has this value at the widest contact and is zero nowhere."""

ONE, TWO, ALL = (0,), (0, 1), (0, 1, 2)
"""Which of the functions are asked for."""


class CurveCoefficients(NamedTuple):
    """The functions of joints (joints,): one, or as many as there are contacts.

    Chebyshev coefficients (functions, angles, joints) of the functions and of their derivatives by the place. Those of
    a joint of Python numbers are one matrix, `both`: functions and then derivatives by angles.
    """

    ratio: Array
    """R2/L"""
    functions: Array
    slopes: Array


class Scale(NamedTuple):
    """What makes the functions lengths, forces and pressures."""

    clearance: Array
    """c in mm."""
    area: Array
    """R2² in mm²."""
    compliance: Array
    """C in mm/MPa."""


def at(angle: Array, curve: CurveCoefficients, rows: tuple[int, ...]) -> tuple[Pair, ...]:
    """The functions in `rows` at ε > 0, and their slopes."""
    root = angle_root(angle, curve.ratio)
    place, widening = 2 * root - 1, angle_derivative(angle, root, curve.ratio)
    if type(angle) is float:
        both = (curve.functions @ chebyshev_values(place, curve.functions.shape[1])).tolist()
        return tuple((both[k], widening * both[k + 3]) for k in rows)
    waves = chebyshev_polynomials(place, curve.functions.shape[1])
    return tuple(
        (sum_series(curve.functions[k, ...], waves), widening * sum_series(curve.slopes[k, ...], waves)) for k in rows
    )


def sum_series(coefficients: Array, waves: Array) -> Array:
    """Series (angles, joints or 1) at chebyshev_polynomials (angles, contacts)."""
    xp = arrays.namespace(waves)
    if coefficients.shape[-1] == 1:
        return coefficients[:, 0] @ waves
    return numpy.einsum("ij,ij->j", coefficients, waves) if xp is numpy else xp.sum(coefficients * waves, axis=0)


def angle_derivative(angle: Array, root: Array, ratio: Array) -> Array:
    """d(place)/d(ln ε)."""
    near = ANGLE_SCALE * (1 + ratio)
    return near * angle / ((1 + near * angle) * log1p(near * LIMIT) * root)


def opening(angle: Array, share: Pair) -> Pair:
    """σ = d/(c + d) and the slope of its logarithm, from the first function."""
    half = sin(angle / 2)
    return exp(share[0]) * 2 * half * half, share[1] + angle * cos(angle / 2) / half


def contact(angle: Array, curve: CurveCoefficients, scale: Scale) -> tuple[Array, Array, Array, Array, Array]:
    """d, F, p0, dF/dd and dd/d(ln ε) at ε > 0."""
    share, load, pole = at(angle, curve, ALL)
    sigma, rate = opening(angle, share)
    reach = scale.clearance / (1 - sigma)
    outer = sigma * rate / (1 - sigma)
    F = exp(load[0]) * angle * angle * angle * scale.area * reach / scale.compliance
    p0 = exp(pole[0]) * angle * reach / scale.compliance
    return reach * sigma, F, p0, F * (load[1] + 3 + outer) / (reach * outer), reach * outer


def angle_of_indentation(load: Array, curve: CurveCoefficients) -> Array:
    """ε > 0 that belongs to d/c; NaN beyond the tables."""
    return _angle_of(_indentation_miss, load, log(1.5 * load / (1 + load)) / 2, curve)


def angle_of_force(load: Array, curve: CurveCoefficients) -> Array:
    """ε > 0 that belongs to F C/(R2² c); NaN beyond the tables."""
    return _angle_of(_force_miss, load, log(load / (3 + load)) / 3, curve)


def _angle_of(miss: Increasing, load: Array, start: Array, curve: CurveCoefficients) -> Array:
    """By Newton's method from ln ε = `start`, which is near: F ~ ε³ and d ~ ε² as in Hertz, but never wide."""
    start = start + (_END - math.log(LIMIT))
    end = 0.0 * start + (_END + 1e-12)  # the widest contact itself is answered
    root = increasing_root(miss, 0.0 * start, start - 6.0, end, start, given=(load, curve), steps=16)
    return where(root < end, exp(root - _END) * LIMIT, math.nan)


def _indentation_miss(unknown: Array, load: Array, curve: CurveCoefficients) -> Pair:
    """ln d/(c + d) at a half angle less that of the load d/c, and its slope."""
    angle = exp(unknown - _END) * LIMIT
    sigma, rate = opening(angle, at(angle, curve, ONE)[0])
    return log(sigma * (1 + 1 / load)), rate


def _force_miss(unknown: Array, load: Array, curve: CurveCoefficients) -> Pair:
    """ln d/(c + d) at a half angle less that of the indentation by the secant F/d there, and its slope."""
    angle = exp(unknown - _END) * LIMIT
    share, force = at(angle, curve, TWO)
    sigma, rate = opening(angle, share)
    secant = exp(force[0]) * angle * angle * angle / sigma
    return log(sigma * (1 + secant / load)), rate + (force[1] + 3 - rate) * secant / (secant + load)
