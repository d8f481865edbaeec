"""Tabulated functions of joints, the contact quantities from them at a half angle, and the inverse.

Under the linear gap everything is proportional to c + d. With the compliance C = 2 (1 - ν²) R2/E (1 + β) of liner
and ball, the contact follows from three functions of the half angle, ν, R2/L and the ball:

    ln of d/(c + d)/(1 - cos ε),     ln of F C/(R2² (c + d) ε³),     ln of p0 C/((c + d) ε).

Slopes are those by ln ε.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from typing import NamedTuple

import numpy

from ....contact.roots import Increasing, increasing_root
from ....core import arrays
from ....core.arrays import Array, cos, exp, log, log1p, sin, where
from ....problem import Joint
from .chebyshev import (
    ANGLE_SCALE,
    LIMIT,
    WITH_BALL,
    ChebyshevTable,
    angle_root,
    ball_coordinate,
    ball_shrinkage,
    chebyshev_polynomials,
    chebyshev_values,
    convert_like,
    load_tables,
    poisson_coordinate,
    thickness_coordinate,
)

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


@dataclass(frozen=True, eq=False)
class JointCurves:
    """Tabulated functions of joints (joints,): one joint, or one for each contact (contacts,).

    If many contacts share few joints, `shared` holds the functions of these joints and `indices` the joint of each
    contact.
    """

    file: str
    joint: Joint
    shared: JointCurves | None = None
    indices: Array | None = None

    def _take_shared(self, values: Array) -> Array:
        """Select the column of each contact's joint from shared values."""
        return arrays.namespace(values).take(values, self.indices, axis=-1)

    @cached_property
    def ratio(self) -> Array:
        """Ratio R2/L of socket radius and liner thickness."""
        return self.joint.thickness_ratio

    @cached_property
    def _softness(self) -> Array:
        """Ratio β of the compliance of the ball to that of the liner at high degrees."""
        ball, liner = self.joint.ball, self.joint.liner
        if ball is None:
            return 0.0 * self.ratio
        plane = (1 - ball.poisson**2) * liner.young / ((1 - liner.poisson**2) * ball.young)
        return plane * self.joint.ball_radius / self.joint.socket_radius

    @cached_property
    def compliance(self) -> Array:
        """Compliance C of liner and ball together in mm/MPa, the limit at high degrees."""
        liner = self.joint.liner
        return 2 * (1 - liner.poisson**2) * self.joint.socket_radius / liner.young * (1 + self._softness)

    @property
    def _has_plain_joint(self) -> bool:
        """True for one joint of Python numbers, whose coefficients have no axis of joints."""
        return type(self.joint.clearance) is float

    def table_series(self, name: str) -> Array:
        """Compute coefficients (functions, angles, joints) of the table `name`, with the change by an elastic ball."""
        if self.shared is not None:
            return self._take_shared(self.shared.table_series(name))
        nu, stored = self.joint.liner.poisson, load_tables(self.file)
        coordinates = [poisson_coordinate(nu), thickness_coordinate(self.ratio)]
        evaluate_coefficients = (
            ChebyshevTable.coefficients_of_one if self._has_plain_joint else ChebyshevTable.coefficients_at
        )
        coefficients = evaluate_coefficients(stored[name], coordinates)
        if self.joint.ball is not None:
            share = self._softness / (1 + self._softness)
            soft = ball_coordinate(share, nu, self.ratio)
            added = evaluate_coefficients(
                stored[WITH_BALL[name]], [*coordinates, soft, ball_shrinkage(self.joint.ball.poisson)]
            )
            coefficients = coefficients + (1 + soft) / 2 * added
        return coefficients

    @cached_property
    def functions(self) -> Array:
        """Chebyshev coefficients of the three tabulated functions: opening, force and pole pressure."""
        return self.table_series("rigid") if self.shared is None else self._take_shared(self.shared.functions)

    @cached_property
    def slopes(self) -> Array:
        """Chebyshev coefficients of the derivatives of the three tabulated functions."""
        if self.shared is not None:
            return self._take_shared(self.shared.slopes)
        xp = arrays.namespace(self.functions)
        derivative = convert_like(_derivative_matrix(self.functions.shape[1]), self.functions)
        return xp.stack([derivative @ self.functions[row, ...] for row in range(3)])

    @cached_property
    def curve(self) -> CurveCoefficients:
        """Chebyshev coefficients of the tabulated functions and of their derivatives."""
        if self._has_plain_joint:
            stacked = numpy.concatenate(
                [self.functions, self.functions @ _derivative_matrix(self.functions.shape[1]).T]
            )
            return CurveCoefficients(self.ratio, stacked, stacked)
        return CurveCoefficients(self.ratio, self.functions, self.slopes)

    @cached_property
    def scale(self) -> Scale:
        """Length, area and compliance that turn the tabulated functions into mm, N and MPa."""
        R2 = self.joint.socket_radius
        return Scale(self.joint.clearance, R2 * R2, self.compliance)

    def contact_quantities(self, angle: Array) -> tuple[Array, ...]:
        """Compute the quantities of `contact_quantities` at half angles above 0."""
        return contact_quantities(angle, self.curve, self.scale)

    def scaled_load(self, kind: str, load: Array) -> Array:
        """Compute the dimensionless load: F C/(R2² c) of a force, d/c of an indentation."""
        c, area, compliance = self.scale
        return load * compliance / (area * c) if kind == "force" else load / c

    def angle(self, kind: str, load: Array) -> Array:
        """Solve for the half angle in rad under a positive load; NaN beyond the tables."""
        return (angle_of_force if kind == "force" else angle_of_indentation)(self.scaled_load(kind, load), self.curve)


@lru_cache(maxsize=256)
def plain_joint_curves(file: str, joint: Joint) -> JointCurves:
    """Return the tabulated functions of a joint of Python numbers, from a cache."""
    return JointCurves(file, joint)


@cache
def _derivative_matrix(count: int) -> numpy.ndarray:
    """Compute the matrix from the Chebyshev coefficients of a function to those of its derivative."""
    square = numpy.zeros((count, count))
    square[:-1] = numpy.polynomial.chebyshev.chebder(numpy.eye(count))
    return square


SMALL_LOAD = 1e-3
"""Load in place of one that is not positive."""
