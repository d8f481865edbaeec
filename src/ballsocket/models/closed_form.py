"""Models that are given by their laws: what happens at an indentation, in closed form, inverted once for all."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any, ClassVar

import numpy

from ..contact import Model
from ..contact.assembly import SolverResult
from ..contact.law import ForceLaw, finite_or_nan
from ..contact.roots import increasing_root
from ..core import arrays
from ..core.arrays import Array, where
from ..core.validity import Status
from ..problem import Joint


class ClosedForm(Model):
    """A model given by its laws: what happens at an indentation, element by element.

    A new model states `force`, `stiffness`, `energy`, `half_angle`, `pole_pressure` and `pressure`, and the
    indentation that belongs to a half angle. The indentation that belongs to a force is found here, once for all;
    a model with a closed inverse states that too, and one whose pressure is highest off the pole says where and how
    high. All laws take a joint of arrays, or of Python numbers, and d > 0 or d = 0.
    """

    accepts_floats: ClassVar[bool] = True

    @abstractmethod
    def force(self, joint: Joint, indentation: Array) -> Array:
        """F in N."""

    @abstractmethod
    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        """dF/dd in N/mm."""

    @abstractmethod
    def energy(self, joint: Joint, indentation: Array) -> Array:
        """Integral of F over d from first touch, in N mm."""

    @abstractmethod
    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        """ε in rad."""

    @abstractmethod
    def indentation_of_half_angle(self, joint: Joint, half_angle: Array) -> Array:
        """d in mm; NaN where no indentation gives this half angle."""

    @abstractmethod
    def pole_pressure(self, joint: Joint, indentation: Array) -> Array:
        """Pressure at the pole, p0 in MPa."""

    @abstractmethod
    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        """p(φ) in MPa, 0 outside the contact."""

    def max_pressure(self, joint: Joint, indentation: Array) -> Array:
        """Largest pressure in MPa: that at the pole."""
        return self.pole_pressure(joint, indentation)

    def max_pressure_angle(self, joint: Joint, indentation: Array) -> Array:
        """Where the pressure is largest, in rad from the pole."""
        return 0.0 * indentation

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        """K = p0/d in MPa/mm, Eq. (16) of the paper."""
        quotient = self.pole_pressure(joint, indentation) / arrays.safe_divisor(indentation)
        return where(indentation == 0, numpy.inf, quotient)  # a point contact: p0 ~ d^(1/2n), n >= 1

    def pressure_integral(self, joint: Joint, indentation: Array) -> Array:
        """∫ p dA in N over the spherical contact, by quadrature."""
        edge = self.half_angle(joint, indentation)

        def ring(x: float) -> Array:
            angle = edge * sin(pi / 2 * x)  # tames a square root at the edge
            return self.pressure(joint, indentation, angle) * arrays.sin(angle) * (pi / 2 * cos(pi / 2 * x))

        return 2 * pi * joint.socket_radius**2 * edge * arrays.integral(ring, 40)

    def indentation(self, joint: Joint, force: Array) -> Array:
        """d in mm that belongs to F.

        Force laws of contact are close to power laws, ln F against ln d has a slope between 1 and 2 (0.4 and 2.5 to
        be safe), so one point of the curve brackets every other one, and Newton's method in the logarithms is quick.
        """
        scale = joint.clearance + 1e-3 * joint.socket_radius
        known = arrays.log(self.force(joint, scale))
        goal = arrays.log(arrays.safe_divisor(force)) - known
        steep, flat = goal / 2.5, goal / 0.4

        def law(log_ratio: Array) -> tuple[Array, Array]:
            d = scale * arrays.exp(log_ratio)
            F = self.force(joint, d)
            return arrays.log(F) - known, d * self.stiffness(joint, d) / F

        shape = (steep, flat, known)
        low = arrays.broadcast(where(goal > 0, steep, flat), *shape)
        high = arrays.broadcast(where(goal > 0, flat, steep), *shape)
        root = increasing_root(law, arrays.broadcast(goal, *shape), low, high, low + (high - low) / 4)
        return where(force > 0, scale * arrays.exp(root), 0.0 * root)

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        if kind == "force":
            d = self.indentation(joint, load)
            F = load
        elif kind == "half_angle":
            d = where(load > 0, self.indentation_of_half_angle(joint, load), 0.0 * load)
            F = self.force(joint, d)
        else:
            d, F = load, self.force(joint, load)
        safe = where(arrays.isfinite(d), d, 0.0)
        # an error of rounding in d: F alone is no measure where it is a small difference of large parts (adhesion)
        scale = abs(F) + safe * self.stiffness(joint, safe)
        near = abs(self.force(joint, safe) - F) <= 1e3 * arrays.machine_epsilon(safe) * scale
        return SolverResult(
            laws=Bound(model=self, joint=joint, indentation=d),
            force=F,
            indentation=d,
            failures={
                Status.NOT_CONVERGED: arrays.logical_not(near),
                Status.BEYOND_EQUATOR: self.half_angle(joint, safe) > pi / 2 * (1 + 1e-6),
            },
        )

    def _law(self, joint: Joint) -> ForceLaw:
        return ClosedLaw(model=self, joint=joint)


@dataclass(frozen=True, kw_only=True)
class ClosedLaw:
    """The force and the stiffness of a closed form, bound to a joint of floats."""

    model: ClosedForm
    joint: Joint

    def __call__(self, indentation: float) -> tuple[float, float]:
        if indentation < 0:
            return 0.0, 0.0
        try:
            F, stiffness = self.model.force(self.joint, indentation), self.model.stiffness(self.joint, indentation)
        except ArithmeticError:
            contact = self.model.press(self.joint, indentation=indentation)
            F, stiffness = contact.force, contact.stiffness
        return finite_or_nan(F, stiffness)


def _bound(law: str) -> Any:
    """A law of the model at the joint and the indentation that it is bound to."""

    def value(self: Bound) -> Array:
        return getattr(self.model, law)(self.joint, self.indentation)

    value.__doc__ = getattr(ClosedForm, law).__doc__
    return property(value)


@dataclass(frozen=True, kw_only=True, eq=False)
class Bound:
    """The laws of a closed form, bound to a joint of arrays and an indentation (mm)."""

    model: ClosedForm
    joint: Joint
    indentation: Array

    half_angle = _bound("half_angle")
    max_pressure = _bound("max_pressure")
    max_pressure_angle = _bound("max_pressure_angle")
    pole_pressure = _bound("pole_pressure")
    stiffness = _bound("stiffness")
    energy = _bound("energy")
    foundation_modulus = _bound("foundation_modulus")
    pressure_integral = _bound("pressure_integral")

    def pressure(self, angle: Array) -> Array:
        """p(φ) in MPa, 0 outside the contact."""
        return self.model.pressure(self.joint, self.indentation, angle)
