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
    as_like,
    ball_coordinate,
    ball_shrinkage,
    poisson_coordinate,
    tables,
    thickness_coordinate,
)
from .formulas import CurveCoefficients, Scale, angle_of_force, angle_of_indentation, contact


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
        """Select the column of each contact's joint."""
        return arrays.namespace(values).take(values, self.indices, axis=-1)

    @cached_property
    def ratio(self) -> Array:
        """Ratio R2/L."""
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
    def _is_one(self) -> bool:
        """True for one joint of Python numbers, whose coefficients have no axis of joints."""
        return type(self.joint.clearance) is float

    def series(self, name: str) -> Array:
        """Compute coefficients (functions, angles, joints) of the table `name`, with the change by an elastic ball."""
        if self.shared is not None:
            return self._take_shared(self.shared.series(name))
        nu, stored = self.joint.liner.poisson, tables(self.file)
        coordinates = [poisson_coordinate(nu), thickness_coordinate(self.ratio)]
        evaluate = ChebyshevTable.coefficients_of_one if self._is_one else ChebyshevTable.coefficients_at
        total = evaluate(stored[name], coordinates)
        if self.joint.ball is not None:
            share = self._softness / (1 + self._softness)
            soft = ball_coordinate(share, nu, self.ratio)
            added = evaluate(stored[WITH_BALL[name]], [*coordinates, soft, ball_shrinkage(self.joint.ball.poisson)])
            total = total + (1 + soft) / 2 * added
        return total

    @cached_property
    def functions(self) -> Array:
        """Coefficients of the three functions."""
        return self.series("rigid") if self.shared is None else self._take_shared(self.shared.functions)

    @cached_property
    def slopes(self) -> Array:
        """Coefficients of the derivatives of the three functions."""
        if self.shared is not None:
            return self._take_shared(self.shared.slopes)
        xp = arrays.namespace(self.functions)
        flow = as_like(_derivative(self.functions.shape[1]), self.functions)
        return xp.stack([flow @ self.functions[row, ...] for row in range(3)])

    @cached_property
    def curve(self) -> CurveCoefficients:
        """Coefficients of the functions and their derivatives."""
        if self._is_one:
            stacked = numpy.concatenate([self.functions, self.functions @ _derivative(self.functions.shape[1]).T])
            return CurveCoefficients(self.ratio, stacked, stacked)
        return CurveCoefficients(self.ratio, self.functions, self.slopes)

    @cached_property
    def scale(self) -> Scale:
        """Scales that give the functions their units."""
        R2 = self.joint.socket_radius
        return Scale(self.joint.clearance, R2 * R2, self.compliance)

    def contact(self, angle: Array) -> tuple[Array, ...]:
        """Compute d, F, p0, dF/dd and dd/d(ln ε) at ε > 0."""
        return contact(angle, self.curve, self.scale)

    def scaled_load(self, kind: str, load: Array) -> Array:
        """Compute the dimensionless load F C/(R2² c) or d/c."""
        c, area, compliance = self.scale
        return load * compliance / (area * c) if kind == "force" else load / c

    def angle(self, kind: str, load: Array) -> Array:
        """Solve for ε > 0 of a load > 0; NaN beyond the tables."""
        return (angle_of_force if kind == "force" else angle_of_indentation)(self.scaled_load(kind, load), self.curve)


@lru_cache(maxsize=256)
def curves_of_one(file: str, joint: Joint) -> JointCurves:
    """Return the functions of a joint of Python numbers, cached for further loads."""
    return JointCurves(file, joint)


@cache
def _derivative(count: int) -> numpy.ndarray:
    """Compute the matrix from the Chebyshev coefficients of a function to those of its derivative."""
    square = numpy.zeros((count, count))
    square[:-1] = numpy.polynomial.chebyshev.chebder(numpy.eye(count))
    return square


SMALL_LOAD = 1e-3
"""Load in place of one that is not positive."""
