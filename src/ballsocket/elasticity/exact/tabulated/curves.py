"""Tabulated functions of joints."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property, lru_cache

import numpy

from ....core import arrays
from ....core.arrays import Array
from ....problem import Joint
from .chebyshev import (
    WITH_BALL,
    ChebyshevTable,
    ball_coordinate,
    ball_shrinkage,
    convert_like,
    load_tables,
    poisson_coordinate,
    thickness_coordinate,
)
from .formulas import CurveCoefficients, Scale, angle_of_force, angle_of_indentation, contact_quantities


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
        """Compute indentation d, force, pole pressure, stiffness and the slope dd/d(ln ε) at half angles above 0.

        The units are mm, N, MPa, N/mm and mm.
        """
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
