"""Models given by closed-form laws of the indentation, with one common inversion."""

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
    """Contact model with closed-form laws of the indentation, evaluated elementwise.

    A new model states `force`, `stiffness`, `energy`, `half_angle`, `pole_pressure`, `pressure` and the indentation of
    a half angle. The base class solves for the indentation of a force; a model with a closed inverse overrides that. A
    model with the largest pressure off the pole states its angle and value. All laws take a joint of arrays, or of
    Python numbers, and d >= 0.
    """

    accepts_floats: ClassVar[bool] = True

    @abstractmethod
    def force(self, joint: Joint, indentation: Array) -> Array:
        """Compute the contact force F in N at an indentation in mm."""

    @abstractmethod
    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        """Compute the contact stiffness dF/dd in N/mm at an indentation in mm."""

    @abstractmethod
    def energy(self, joint: Joint, indentation: Array) -> Array:
        """Compute the elastic energy in N mm, the integral of the force over the indentation."""

    @abstractmethod
    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        """Compute the half angle ε of the contact in rad at an indentation in mm."""

    @abstractmethod
    def indentation_of_half_angle(self, joint: Joint, half_angle: Array) -> Array:
        """Compute the indentation d in mm of a half angle in rad; NaN where no indentation gives this half angle."""

    @abstractmethod
    def pole_pressure(self, joint: Joint, indentation: Array) -> Array:
        """Compute the pressure p0 at the pole in MPa at an indentation in mm."""

    @abstractmethod
    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        """Compute the contact pressure p(φ) in MPa at a polar angle in rad; 0 outside the contact."""

    def max_pressure(self, joint: Joint, indentation: Array) -> Array:
        """Compute the largest contact pressure in MPa; by default the pressure at the pole."""
        return self.pole_pressure(joint, indentation)

    def max_pressure_angle(self, joint: Joint, indentation: Array) -> Array:
        """Compute the polar angle in rad at which the pressure is largest; by default 0, the pole."""
        return 0.0 * indentation

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        """Compute the foundation modulus K = p0/d in MPa/mm, Eq. (16) of the paper."""
        quotient = self.pole_pressure(joint, indentation) / arrays.safe_divisor(indentation)
        return where(indentation == 0, numpy.inf, quotient)  # a point contact: p0 ~ d^(1/2n), n >= 1

    def pressure_integral(self, joint: Joint, indentation: Array) -> Array:
        """Compute the integral of the pressure over the contact area in N.

        On a sphere by quadrature; models of planar contact return their force.
        """
        if self.planar:
            return self.force(joint, indentation)
        edge = self.half_angle(joint, indentation)

        def ring_integrand(x: float) -> Array:
            """Compute the integrand p sin φ d(φ/ε)/dx on the ring at φ = ε sin(πx/2)."""
            angle = edge * sin(pi / 2 * x)  # removes the square root at the edge
            return self.pressure(joint, indentation, angle) * arrays.sin(angle) * (pi / 2 * cos(pi / 2 * x))

        return 2 * pi * joint.socket_radius**2 * edge * arrays.integral(ring_integrand, 40)

    def indentation(self, joint: Joint, force: Array) -> Array:
        """Compute the indentation d in mm of a contact force in N, by Newton's method.

        Force laws of contact are close to power laws: the slope of ln F over ln d lies between 1 and 2 (0.4 and 2.5
        with a margin). One point of the curve therefore brackets every other one, and Newton's method in the logarithms
        converges fast.
        """
        scale = joint.clearance + 1e-3 * joint.socket_radius
        known = arrays.log(self.force(joint, scale))
        goal = arrays.log(arrays.safe_divisor(force)) - known
        steep, flat = goal / 2.5, goal / 0.4

        def log_force(log_ratio: Array) -> tuple[Array, Array]:
            """Compute ln of the force F(d)/F(scale) and its slope by ln d, at d = `scale` exp(log_ratio)."""
            d = scale * arrays.exp(log_ratio)
            F = self.force(joint, d)
            return arrays.log(F) - known, d * self.stiffness(joint, d) / F

        shape = (steep, flat, known)
        low = arrays.broadcast(where(goal > 0, steep, flat), *shape)
        high = arrays.broadcast(where(goal > 0, flat, steep), *shape)
        root = increasing_root(log_force, arrays.broadcast(goal, *shape), low, high, low + (high - low) / 4)
        return where(force > 0, scale * arrays.exp(root), 0.0 * root)

    def for_joint(self, joint: Joint) -> ClosedForm:
        """Return the model for a joint of NumPy arrays, with what its laws share computed once; by default itself."""
        return self

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        # compilers compute once what laws have in common, and floats are cached
        model = self.for_joint(joint) if isinstance(load, numpy.ndarray) else self
        if kind == "force":
            d, F = model.indentation(joint, load), load
        else:
            d = load
            if kind == "half_angle":
                d = where(load > 0, model.indentation_of_half_angle(joint, load), 0.0 * load)
            F = model.force(joint, d)
        safe = where(arrays.isfinite(d), d, 0.0)
        failures = {Status.BEYOND_EQUATOR: model.half_angle(joint, safe) > pi / 2 * (1 + 1e-6)}
        if kind == "force":
            # rounding error of d; |F| alone is too small a scale where F is a difference of large terms (adhesion)
            scale = abs(F) + safe * model.stiffness(joint, safe)
            converged = abs(model.force(joint, safe) - F) <= 1e3 * arrays.machine_epsilon(safe) * scale
            failures[Status.NOT_CONVERGED] = arrays.logical_not(converged)
        laws = ClosedFormSolution(model=model, joint=joint, indentation=d)
        return SolverResult(laws=laws, force=F, indentation=d, failures=failures)

    def _law(self, joint: Joint) -> ForceLaw:
        return ClosedLaw(model=self, joint=joint)


@dataclass(frozen=True, kw_only=True)
class ClosedLaw:
    """Force law of a closed-form model for one joint: force in N and stiffness in N/mm over the indentation in mm."""

    model: ClosedForm
    joint: Joint

    def __call__(self, indentation: float) -> tuple[float, float]:
        """Compute the force in N and the stiffness in N/mm at an indentation in mm; 0 without contact."""
        if indentation < 0:
            return 0.0, 0.0
        try:
            F, stiffness = self.model.force(self.joint, indentation), self.model.stiffness(self.joint, indentation)
        except ArithmeticError:
            contact = self.model.press(self.joint, indentation=indentation)
            F, stiffness = contact.force, contact.stiffness
        return finite_or_nan(F, stiffness)


def _law_property(law: str) -> Any:
    """Make a property that evaluates one law of the model for the solved joint and indentation."""

    def evaluate_law(self: ClosedFormSolution) -> Array:
        return getattr(self.model, law)(self.joint, self.indentation)

    evaluate_law.__doc__ = getattr(ClosedForm, law).__doc__
    return property(evaluate_law)


@dataclass(frozen=True, kw_only=True, eq=False)
class ClosedFormSolution:
    """Solution of a closed-form model: contact quantities for a joint of arrays and its indentations in mm."""

    model: ClosedForm
    joint: Joint
    indentation: Array

    half_angle = _law_property("half_angle")
    max_pressure = _law_property("max_pressure")
    max_pressure_angle = _law_property("max_pressure_angle")
    pole_pressure = _law_property("pole_pressure")
    stiffness = _law_property("stiffness")
    energy = _law_property("energy")
    foundation_modulus = _law_property("foundation_modulus")
    pressure_integral = _law_property("pressure_integral")

    def pressure(self, angle: Array) -> Array:
        return self.model.pressure(self.joint, self.indentation, angle)
