"""Elastic energy of a joint over the indentation, with its first and second derivatives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from ..contact import Model
from ..contact.octave_curve import OctaveCurve, derivatives_at, derivatives_of_array
from ..core.arrays import Array, where
from ..core.checks import require
from ..models.adhesion import AdhesiveSocket
from ..models.closed_form import ClosedForm, ClosedLaw
from ..models.foundation import FoundationLaw
from ..problem import Joint

Slopes = tuple[Array, Array, Array]  # energy U in N mm, force F = dU/dd in N, and stiffness k = dF/dd in N/mm


class Potential(Protocol):
    """Elastic energy of a joint and its two derivatives at an indentation in mm, 0 or more: a number or an array.

    `deepest` is the largest indentation in mm with a result.
    """

    @property
    def deepest(self) -> float: ...

    def __call__(self, indentation: Array) -> Slopes: ...


@dataclass(frozen=True, kw_only=True)
class SpringPotential:
    """Elastic energy of a radial foundation by its formulas."""

    springs: FoundationLaw
    deepest: float = math.inf

    def __call__(self, indentation: Array) -> Slopes:
        springs = self.springs
        motion, numbers = springs.kinematics, (springs.socket_radius, springs.clearance, springs.modulus, indentation)
        return motion.energy(*numbers), motion.force(*numbers), motion.stiffness(*numbers)


@dataclass(frozen=True, kw_only=True)
class FormulaPotential:
    """Elastic energy of a closed-form model by its formulas."""

    model: ClosedForm
    joint: Joint
    deepest: float = math.inf

    def __call__(self, indentation: Array) -> Slopes:
        arguments = self.joint, indentation
        return self.model.energy(*arguments), self.model.force(*arguments), self.model.stiffness(*arguments)


@dataclass(frozen=True, kw_only=True, eq=False)
class CurvePotential:
    """Elastic energy U of a joint by its curve over the indentation d, whose derivatives give force and stiffness.

    Below the low end of the curve U is a power of d. Beyond its high end U is NaN.
    """

    curve: OctaveCurve

    @property
    def deepest(self) -> float:
        """Largest indentation in mm of the curve."""
        return self.curve.high

    def __call__(self, indentation: Array) -> Slopes:
        if type(indentation) is float:
            return derivatives_at(indentation, *self.curve.plain_numbers)
        return derivatives_of_array(indentation, self.curve)


def potential_of(model: Model, joint: Joint) -> Potential:
    """Return the elastic energy of a joint as a function of the indentation, for a model with a force law."""
    law = model.law(joint)
    if isinstance(law, FoundationLaw):
        return SpringPotential(springs=law)
    if isinstance(law, ClosedLaw):
        return FormulaPotential(model=law.model, joint=law.joint)
    return curve_potential(model, joint)


def curve_potential(model: Model, joint: Joint) -> CurvePotential:
    """Integrate the curve of the force over the indentation to the elastic energy."""
    return CurvePotential(curve=model.curve(joint.with_floats()).curve.integral())


@dataclass(frozen=True, kw_only=True)
class AdhesionPotential:
    """Elastic energy of an adhesive socket over d + u_c, zero at separation (d = -u_c) and negative at first touch."""

    model: AdhesiveSocket
    joint: Joint
    deepest: float

    @cached_property
    def stretch(self) -> float:
        """Largest stretch u_c of a spring in mm."""
        return float(self.model.critical_stretch(self.joint))

    @cached_property
    def _separation_energy(self) -> float:
        return float(self.model.energy(self.joint, -self.stretch))

    def __call__(self, indentation: Array) -> Slopes:
        arguments = self.joint, indentation - self.stretch
        return (
            self.model.energy(*arguments) - self._separation_energy,
            self.model.force(*arguments),
            self.model.stiffness(*arguments),
        )


def adhesion_potential(model: AdhesiveSocket, joint: Joint) -> AdhesionPotential:
    """Return the elastic energy of an adhesive joint, measured from the separation of the ball.

    Raises ValueError: an adhesion number η = u_c/c of 1 or more: the hemisphere sticks as a unit and never separates
    gradually.
    """
    model.law(joint)  # raises for arrays and for joints outside the domain
    joint = joint.with_floats()
    number, sticks = float(model.adhesion_number(joint)), "otherwise the entire hemisphere sticks"
    allowed = f"it must be below 1; {sticks}, and the rim determines the separation"
    require("the adhesion number", number, number < 1.0, allowed)
    return AdhesionPotential(model=model, joint=joint, deepest=joint.socket_radius)


def evaluate_curve(curve: OctaveCurve, indentation: Array) -> Array:
    """Evaluate a fitted curve at indentations in mm; 0 without contact, NaN beyond the end of the curve."""
    if type(indentation) is float:
        return derivatives_at(indentation, *curve.plain_numbers)[0]
    return where(indentation > 0.0, derivatives_of_array(indentation, curve)[0], 0.0)
