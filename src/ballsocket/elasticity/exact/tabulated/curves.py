"""Tabulated functions of joints, and the contact quantities from them at a half angle.

Under the linear gap everything is proportional to c + d. With the compliance C = 2 (1 - ν²) R2/E (1 + β) of liner
and ball, the contact follows from three functions of the half angle, ν, R2/L and the ball:

    ln of d/(c + d)/(1 - cos ε),     ln of F C/(R2² (c + d) ε³),     ln of p0 C/((c + d) ε).

Slopes are those by ln ε.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import NamedTuple

import numpy

from ....core import arrays
from ....core.arrays import Array, cos, exp, log1p, sin
from ....core.lazy import cached_property
from ....problem import Joint
from .chebyshev import (
    ANGLE_SCALE,
    LIMIT,
    WITH_BALL,
    Pair,
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


class Widest(NamedTuple):
    """Contact at the largest half angle of the tables."""

    opening: Array
    """Relative indentation d/(c + d)."""
    force: Array
    """Dimensionless force F C/(R2² (c + d))."""

    @classmethod
    def of(cls, functions: Array) -> Widest:
        """Sum the series (functions, angles, joints) of the tables, whose polynomials are all 1 at this half angle."""
        share, force = (arrays.namespace(functions).sum(functions[row, ...], axis=0) for row in TWO)
        return cls(2 * math.sin(LIMIT / 2) ** 2 * exp(share), LIMIT**3 * exp(force))


def evaluate_table_functions(angle: Array, curve: CurveCoefficients, rows: tuple[int, ...]) -> tuple[Pair, ...]:
    """Evaluate the tabulated functions in `rows`, with their slopes by ln ε, at half angles above 0."""
    root = angle_root(angle, curve.ratio)
    coordinate, widening = 2 * root - 1, angle_derivative(angle, root, curve.ratio)
    if type(angle) is float:
        values = (curve.functions @ chebyshev_values(coordinate, curve.functions.shape[1])).tolist()
        return tuple((values[k], widening * values[k + 3]) for k in rows)
    if arrays.all_true(coordinate == coordinate) is None:
        series = (traced_series(curve.functions[k, ...], coordinate) for k in rows)
        return tuple((value, widening * slope) for value, slope in series)
    waves = chebyshev_polynomials(coordinate, curve.functions.shape[1])
    return tuple(
        (sum_series(curve.functions[k, ...], waves), widening * sum_series(curve.slopes[k, ...], waves)) for k in rows
    )


def traced_series(coefficients: Array, x: Array) -> Pair:
    """Evaluate a Chebyshev series and its slope at x inside `jax.jit` or `torch.compile`.

    `coefficients` has the shape (angles, joints or 1), x (..., contacts).
    """
    return (_jax_clenshaw_sum() if arrays.is_jax_array(x) else clenshaw_sum)(coefficients, x)


@cache
def _jax_clenshaw_sum() -> Callable[[Array, Array], Pair]:
    """Return `clenshaw_sum` for JAX, with the derivatives of `stored_series`, which compile faster."""
    import jax

    series = jax.custom_jvp(clenshaw_sum)

    @series.defjvp
    def _series_tangent(values: tuple[Array, Array], tangents: tuple[Array, Array]) -> tuple[Pair, Pair]:
        """Compute the series and its directional derivative."""
        return series(*values), jax.jvp(stored_series, values, tangents)[1]

    return series


def stored_series(coefficients: Array, x: Array) -> Pair:
    """Evaluate a Chebyshev series and its slope at x from all polynomials; shapes as in `traced_series`."""
    waves, xp = chebyshev_polynomials(x, coefficients.shape[0]), arrays.namespace(x)
    shape = (coefficients.shape[0], *(1 for _ in x.shape[1:]), coefficients.shape[1])
    slopes = convert_like(_derivative_matrix(shape[0]), x) @ coefficients
    value, slope = (xp.sum(xp.reshape(series, shape) * waves, axis=0) for series in (coefficients, slopes))
    return value, slope


def clenshaw_sum(coefficients: Array, x: Array) -> Pair:
    """Evaluate a Chebyshev series and its slope at x by one recurrence of Clenshaw, which stores nothing.

    Compilers fuse it with the formulas around it. `coefficients` has the shape (angles, joints or 1).
    """
    twice = 2 * x
    value = previous = slope = previous_slope = 0.0 * x
    for k in range(coefficients.shape[0] - 1, 0, -1):
        slope, previous_slope = 2 * value + twice * slope - previous_slope, slope
        value, previous = coefficients[k, ...] + twice * value - previous, value
    return coefficients[0, ...] + x * value - previous, value + x * slope - previous_slope


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

    def take_shared(self, values: Array) -> Array:
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
    def has_plain_joint(self) -> bool:
        """True for one joint of Python numbers, whose coefficients have no axis of joints."""
        return type(self.joint.clearance) is float

    def table_series(self, name: str) -> Array:
        """Compute coefficients (functions, angles, joints) of the table `name`, with the change by an elastic ball."""
        if self.shared is not None:
            return self.take_shared(self.shared.table_series(name))
        table = load_tables(self.file)[name]
        coefficients = (
            table.coefficients_of_one(self.coordinates)
            if self.has_plain_joint
            else table.coefficients_of_polynomials(self.liner_polynomials)
        )
        ball = self._ball_coordinates
        if ball is not None:
            coefficients = coefficients + (1 + ball[0]) / 2 * self._ball_series(WITH_BALL[name], ball)
        return coefficients

    def _ball_series(self, name: str, coordinates: list[Array]) -> Array:
        """Compute coefficients (functions, angles, joints) of the table `name` of elastic balls."""
        table = load_tables(self.file)[name]
        if self.has_plain_joint:
            return table.coefficients_of_one([*self.coordinates, *coordinates])
        ball = [chebyshev_polynomials(*pair) for pair in zip(coordinates, table.counts[2:], strict=True)]
        return table.coefficients_of_polynomials([*self.liner_polynomials, *ball])

    @cached_property
    def _ball_coordinates(self) -> list[Array] | None:
        """Table coordinates of the elastic ball: its share of the compliance and its ν; None for a rigid ball."""
        if self.joint.ball is None:
            return None
        share = self._softness / (1 + self._softness)
        return [
            ball_coordinate(share, self.joint.liner.poisson, self.ratio),
            ball_shrinkage(self.joint.ball.poisson),
        ]

    @cached_property
    def functions(self) -> Array:
        """Chebyshev coefficients of the three tabulated functions: opening, force and pole pressure."""
        return self.table_series("rigid") if self.shared is None else self.take_shared(self.shared.functions)

    @cached_property
    def slopes(self) -> Array:
        """Chebyshev coefficients of the derivatives of the three tabulated functions."""
        if self.shared is not None:
            return self.take_shared(self.shared.slopes)
        return derivative_series(self.functions)

    @cached_property
    def curve(self) -> CurveCoefficients:
        """Chebyshev coefficients of the tabulated functions and of their derivatives."""
        if self.has_plain_joint:
            stacked = numpy.concatenate(
                [self.functions, self.functions @ _derivative_matrix(self.functions.shape[1]).T]
            )
            return CurveCoefficients(self.ratio, stacked, stacked)
        return CurveCoefficients(self.ratio, self.functions, self.slopes)

    @cached_property
    def widest(self) -> Widest:
        """Opening and force at the largest half angle of the tables."""
        return Widest.of(self.functions)

    @cached_property
    def coordinates(self) -> list[Array]:
        """Table coordinates of Poisson's ratio and of R2/L."""
        return [poisson_coordinate(self.joint.liner.poisson), thickness_coordinate(self.ratio)]

    @cached_property
    def liner_polynomials(self) -> list[Array]:
        """Chebyshev polynomials (orders, joints) of the coordinates of ν and R2/L, in the largest number."""
        counts = load_tables(self.file)["rigid"].counts
        return [chebyshev_polynomials(*pair) for pair in zip(self.coordinates, counts, strict=False)]

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


@lru_cache(maxsize=256)
def plain_joint_curves(file: str, joint: Joint) -> JointCurves:
    """Return the tabulated functions of a joint of Python numbers, from a cache."""
    return JointCurves(file, joint)


def derivative_series(functions: Array) -> Array:
    """Compute the Chebyshev coefficients (functions, angles, joints) of the derivatives of series of that shape."""
    derivative = convert_like(_derivative_matrix(functions.shape[1]), functions)
    return arrays.namespace(functions).stack([derivative @ functions[row, ...] for row in range(functions.shape[0])])


@cache
def _derivative_matrix(count: int) -> numpy.ndarray:
    """Compute the matrix from the Chebyshev coefficients of a function to those of its derivative."""
    square = numpy.zeros((count, count))
    square[:-1] = numpy.polynomial.chebyshev.chebder(numpy.eye(count))
    return square


SMALL_LOAD = 1e-3
"""Load in place of one that is not positive."""
