"""The tabulated functions of joints: what one joint's curve looks like, for every bonded liner there is."""

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
    poisson_coordinate,
    roundness,
    tables,
    thickness_coordinate,
)
from .formulas import CurveCoefficients, Scale, angle_of_force, angle_of_indentation, contact


@dataclass(frozen=True, eq=False)
class JointCurves:
    """The curves of joints (joints,), one or as many as there are contacts (contacts,).

    Where many contacts share few joints, `shared` are the curves of these, and `which` of them each contact has.
    """

    file: str
    joint: Joint
    shared: JointCurves | None = None
    which: Array | None = None

    def _taken(self, values: Array) -> Array:
        """Columns of the shared joints, for each contact."""
        return arrays.namespace(values).take(values, self.which, axis=-1)

    @cached_property
    def ratio(self) -> Array:
        return self.joint.thickness_ratio

    @cached_property
    def _softness(self) -> Array:
        """β: compliance of the ball over that of the liner, at high degrees."""
        ball, liner = self.joint.ball, self.joint.liner
        if ball is None:
            return 0.0 * self.ratio
        plane = (1 - ball.poisson**2) * liner.young / ((1 - liner.poisson**2) * ball.young)
        return plane * self.joint.ball_radius / self.joint.socket_radius

    @cached_property
    def compliance(self) -> Array:
        """C in mm/MPa."""
        liner = self.joint.liner
        return 2 * (1 - liner.poisson**2) * self.joint.socket_radius / liner.young * (1 + self._softness)

    @property
    def _is_one(self) -> bool:
        """Whether they are of a joint of Python numbers, whose coefficients have no axis of joints."""
        return type(self.joint.clearance) is float

    def series(self, name: str) -> Array:
        """Coefficients (functions, angles, joints) of the table of that name and of what an elastic ball adds."""
        if self.shared is not None:
            return self._taken(self.shared.series(name))
        nu, shelf = self.joint.liner.poisson, tables(self.file)
        places, of = (
            [poisson_coordinate(nu), thickness_coordinate(self.ratio)],
            ChebyshevTable.of_one if self._is_one else ChebyshevTable.of,
        )
        total = of(shelf[name], places)
        if self.joint.ball is not None:
            share = self._softness / (1 + self._softness)
            soft = ball_coordinate(share, nu, self.ratio)
            added = of(shelf[WITH_BALL[name]], [*places, soft, roundness(self.joint.ball.poisson)])
            total = total + (1 + soft) / 2 * added
        return total

    @cached_property
    def functions(self) -> Array:
        return self.series("rigid") if self.shared is None else self._taken(self.shared.functions)

    @cached_property
    def slopes(self) -> Array:
        """Coefficients of the derivatives."""
        if self.shared is not None:
            return self._taken(self.shared.slopes)
        xp = arrays.namespace(self.functions)
        flow = as_like(_derivative(self.functions.shape[1]), self.functions)
        return xp.stack([flow @ self.functions[row, ...] for row in range(3)])

    @cached_property
    def curve(self) -> CurveCoefficients:
        """The functions."""
        if self._is_one:
            both = numpy.concatenate([self.functions, self.functions @ _derivative(self.functions.shape[1]).T])
            return CurveCoefficients(self.ratio, both, both)
        return CurveCoefficients(self.ratio, self.functions, self.slopes)

    @cached_property
    def scale(self) -> Scale:
        R2 = self.joint.socket_radius
        return Scale(self.joint.clearance, R2 * R2, self.compliance)

    def contact(self, angle: Array) -> tuple[Array, ...]:
        """d, F, p0, dF/dd and dd/d(ln ε) at ε > 0."""
        return contact(angle, self.curve, self.scale)

    def scaled(self, kind: str, load: Array) -> Array:
        """F C/(R2² c) or d/c."""
        c, area, compliance = self.scale
        return load * compliance / (area * c) if kind == "force" else load / c

    def angle(self, kind: str, load: Array) -> Array:
        """ε > 0 that belongs to a load > 0; NaN beyond the tables."""
        return (angle_of_force if kind == "force" else angle_of_indentation)(self.scaled(kind, load), self.curve)


@lru_cache(maxsize=256)
def curves_of_one(file: str, joint: Joint) -> JointCurves:
    """JointCurves of a joint of Python numbers; kept, since more loads on it are likely."""
    return JointCurves(file, joint)


@cache
def _derivative(count: int) -> numpy.ndarray:
    """From the Chebyshev coefficients of a function to those of its derivative."""
    square = numpy.zeros((count, count))
    square[:-1] = numpy.polynomial.chebyshev.chebder(numpy.eye(count))
    return square


SMALL_LOAD = 1e-3
