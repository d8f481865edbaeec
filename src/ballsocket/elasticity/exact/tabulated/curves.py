"""Tabulated functions of joints, and the contact quantities from them at a half angle.

Under the linear gap everything is proportional to c + d. With the compliance C = 2 (1 - ν²) R2/E (1 + β) of liner
and ball, the contact follows from three functions of the half angle, ν, R2/L and the ball:

    ln of d/(c + d)/(1 - cos ε),     ln of F C/(R2² (c + d) ε³),     ln of p0 C/((c + d) ε).

Slopes are those by ln ε.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy

from ....contact.coordinates import LIMIT, angle_root, log_angle_derivative
from ....core import arrays
from ....core.arrays import Array, convert_like, exp, short_sine, sqrt
from ....core.chebyshev import Pair, chebyshev_polynomials, derivative_matrix, sum_series, traced_series
from ....core.lazy import cached_property
from ....problem import Joint
from .chebyshev import (
    WITH_BALL,
    ball_coordinate,
    ball_shrinkage,
    chebyshev_values,
    load_tables,
    poisson_coordinate,
    thickness_coordinate,
)

ONE, TWO, ALL = (0,), (0, 1), (0, 1, 2)  # indices of the functions to evaluate


class CurveCoefficients(NamedTuple):
    """Chebyshev coefficients of the functions of joints (joints,): one, or one for each contact.

    `functions` and `slopes` have the shape (functions, angles, joints); slopes are derivatives by the coordinate. A
    joint of Python numbers has one matrix for both: functions and then derivatives by angles.
    """

    ratio: Array  # R2/L
    functions: Array
    slopes: Array


class Scale(NamedTuple):
    """Scales that turn the functions into lengths, forces and pressures."""

    clearance: Array  # c in mm
    area: Array  # R2² in mm²
    compliance: Array  # C in mm/MPa


class Widest(NamedTuple):
    """Contact at the largest half angle of the tables."""

    opening: Array  # relative indentation d/(c + d)
    force: Array  # dimensionless force F C/(R2² (c + d))

    @classmethod
    def of(cls, functions: Array) -> Widest:
        """Sum the series (functions, angles, joints) of the tables, whose polynomials are all 1 at this half angle."""
        share, force = (arrays.namespace(functions).sum(functions[row, ...], axis=0) for row in TWO)
        return cls(2 * math.sin(LIMIT / 2) ** 2 * exp(share), LIMIT**3 * exp(force))


def evaluate_table_functions(angle: Array, curve: CurveCoefficients, rows: tuple[int, ...]) -> tuple[Pair, ...]:
    """Evaluate the tabulated functions in `rows`, with their slopes by ln ε, at half angles above 0."""
    root = angle_root(angle, curve.ratio)
    coordinate, spacing = 2 * root - 1, log_angle_derivative(angle, root, curve.ratio)
    if type(angle) is float:
        values = curve.functions.dot(chebyshev_values(coordinate, curve.functions.shape[1])).tolist()
        return tuple([(values[k], values[k + 3] / spacing) for k in rows])
    if arrays.all_true(coordinate == coordinate) is None:  # XLA stores a quotient, but repeats sums for each use
        series = (traced_series(curve.functions[k, ...], coordinate) for k in rows)
        return tuple((value, slope / spacing) for value, slope in series)
    waves = chebyshev_polynomials(coordinate, curve.functions.shape[1])
    return tuple(
        (sum_series(curve.functions[k, ...], waves), sum_series(curve.slopes[k, ...], waves) / spacing) for k in rows
    )


def opening(angle: Array, share: Pair) -> Pair:
    """Compute the relative indentation σ = d/(c + d) and its log slope by ln ε from the first tabulated function."""
    half = short_sine(angle / 2)
    return exp(share[0]) * 2 * half * half, share[1] + angle * sqrt(1 - half * half) / half


class TabulatedState(NamedTuple):
    """Dimensionless contact at a half angle, with the derivatives of the logarithms by ln ε (rates)."""

    angle: Array  # ε in rad
    opening: Array  # σ = d/(c + d)
    force: Array  # h = F C/(R2² (c + d))
    pole: Array  # p0 C/(c + d)
    opening_rate: Array
    force_rate: Array
    pole_rate: Array


def tabulated_state(angle: Array, curve: CurveCoefficients) -> TabulatedState:
    """Evaluate the tabulated functions at half angles above 0."""
    share, force, pole = evaluate_table_functions(angle, curve, ALL)
    sigma, rate = opening(angle, share)
    return TabulatedState(
        angle=angle,
        opening=sigma,
        force=exp(force[0]) * angle * angle * angle,
        pole=exp(pole[0]) * angle,
        opening_rate=rate,
        force_rate=force[1] + 3,
        pole_rate=pole[1] + 1,
    )


def shift_state(state: TabulatedState, shift: Array) -> TabulatedState:
    """Move a state by a small shift of ln ε; the relative error is of the order of the squared shift."""
    return TabulatedState(
        angle=state.angle * (1 + shift),
        opening=state.opening * (1 + state.opening_rate * shift),
        force=state.force * (1 + state.force_rate * shift),
        pole=state.pole * (1 + state.pole_rate * shift),
        opening_rate=state.opening_rate,
        force_rate=state.force_rate,
        pole_rate=state.pole_rate,
    )


def contact_quantities(state: TabulatedState, scale: Scale) -> tuple[Array, Array, Array, Array, Array]:
    """Compute d in mm, F in N, p0 in MPa, dF/dd in N/mm and the slope dd/d(ln ε) in mm."""
    growth = 1 / (1 - state.opening)
    reach, outer = scale.clearance * growth, state.opening * state.opening_rate * growth
    modulus = reach / scale.compliance
    F = state.force * scale.area * modulus
    slope = reach * outer
    return reach * state.opening, F, state.pole * modulus, F * (state.force_rate + outer) / slope, slope


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
        coefficients = self._evaluate_table(name, [])
        if self.joint.ball is None:
            return coefficients
        share = ball_coordinate(self._softness / (1 + self._softness), self.joint.liner.poisson, self.ratio)
        ball = [share, ball_shrinkage(self.joint.ball.poisson)]
        return coefficients + (1 + share) / 2 * self._evaluate_table(WITH_BALL[name], ball)

    def _evaluate_table(self, name: str, ball_coordinates: list[Array]) -> Array:
        table = load_tables(self.file)[name]
        if self.has_plain_joint:
            return table.coefficients_of_one([*self.coordinates, *ball_coordinates])
        ball = [chebyshev_polynomials(*pair) for pair in zip(ball_coordinates, table.counts[2:], strict=False)]
        return table.coefficients_of_polynomials([*self.liner_polynomials, *ball])

    @cached_property
    def functions(self) -> Array:
        """Chebyshev coefficients of the three tabulated functions: opening, force and pole pressure."""
        return self.table_series("rigid") if self.shared is None else self.take_shared(self.shared.functions)

    @cached_property
    def slopes(self) -> Array:
        """Chebyshev coefficients of the derivatives of the three tabulated functions."""
        return derivative_series(self.functions) if self.shared is None else self.take_shared(self.shared.slopes)

    @cached_property
    def curve(self) -> CurveCoefficients:
        """Chebyshev coefficients of the tabulated functions and of their derivatives."""
        if self.has_plain_joint:
            stacked = numpy.concatenate([self.functions, self.functions @ derivative_matrix(self.functions.shape[1]).T])
            return CurveCoefficients(self.ratio, stacked, stacked)
        return CurveCoefficients(self.ratio, self.functions, self.slopes)

    @cached_property
    def widest(self) -> Widest:
        """Opening and force at the largest half angle of the tables."""
        widest = Widest.of(self.functions)
        return Widest(*map(float, widest)) if self.has_plain_joint else widest

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
        return contact_quantities(tabulated_state(angle, self.curve), self.scale)

    def load_scale(self, kind: str) -> Array:
        """Compute the ratio of the dimensionless load, F C/(R2² c) or d/c, to a force in N or an indentation in mm."""
        c, area, compliance = self.scale
        return compliance / (area * c) if kind == "force" else 1 / c


@lru_cache(maxsize=256)
def plain_joint_curves(file: str, joint: Joint) -> JointCurves:
    """Return the tabulated functions of a joint of Python numbers, from a cache."""
    return JointCurves(file, joint)


def derivative_series(functions: Array) -> Array:
    """Compute the Chebyshev coefficients (functions, angles, joints) of the derivatives of series of that shape."""
    derivative = convert_like(derivative_matrix(functions.shape[1]), functions)
    return arrays.namespace(functions).stack([derivative @ functions[row, ...] for row in range(functions.shape[0])])


SMALL_LOAD = 1e-3  # load in place of one that is not positive
