"""Parameters of losses and joint that stay adjustable in exported elements."""

from __future__ import annotations

import math
from dataclasses import dataclass
from operator import attrgetter
from typing import cast

from ..dynamics import Bristles, ForceElement, PreloadedElement
from ..dynamics.potential import FormulaPotential, SpringPotential
from ..models.closed_form import ClosedForm, ClosedFormSolution
from ..problem import Joint
from .recorder import Tape


@dataclass(frozen=True)
class Tunable:
    """Adjustable parameter of an exported element."""

    name: str
    path: str  # attribute of a force element that has the value
    # unit in this package and in the International System
    unit: str
    si_unit: str
    si: float  # size of `unit` in `si_unit`
    meaning: str
    above: bool = False  # True for a parameter above 0; false for 0 or more

    def value(self, element: ForceElement | PreloadedElement) -> float:
        """Return the value of the parameter in an element."""
        return float(attrgetter(self.path)(element))


# name, attribute of the element, unit here, unit and factor in the International System, meaning
DAMPING_TUNABLES = (
    Tunable("hysteresis", "constants.hysteresis", "s/mm", "s/m", 1e3, "damping force per contact force and speed"),
    Tunable("retardation_time", "constants.time", "s", "s", 1.0, "retardation time of the liner"),
)
TUNABLES = (
    *DAMPING_TUNABLES,
    Tunable("friction_coefficient", "constants.sliding", "1", "1", 1.0, "coefficient of sliding friction"),
    Tunable(
        "static_coefficient",
        "constants.static",
        "1",
        "1",
        1.0,
        "static coefficient of friction, at least that of sliding",
    ),
    Tunable(
        "transition_speed",
        "constants.transition_speed",
        "mm/s",
        "m/s",
        1e-3,
        "slip speed at which friction reaches 71 %",
        above=True,
    ),
    Tunable(
        "stribeck_speed",
        "constants.stribeck_speed",
        "mm/s",
        "m/s",
        1e-3,
        "slip speed of the transition from static to sliding friction",
        above=True,
    ),
    Tunable(
        "viscous_friction", "constants.viscous", "s/mm", "s/m", 1e3, "viscous friction per contact force and speed"
    ),
)
"""Adjustable parameters of damping and friction, in the order of the C structure."""

JOINT_TUNABLES = (
    Tunable("ball_radius", "joint.ball_radius", "mm", "m", 1e-3, "radius of the ball", above=True),
    Tunable("clearance", "joint.clearance", "mm", "m", 1e-3, "radial clearance"),
    Tunable("liner_thickness", "joint.liner_thickness", "mm", "m", 1e-3, "thickness of the liner", above=True),
    Tunable("liner_modulus", "joint.liner.young", "MPa", "Pa", 1e6, "Young's modulus of the liner", above=True),
)
"""Further parameters of elements whose law is a formula: the first numbers of a joint, in its order."""


def joint_tunables(element: ForceElement | PreloadedElement) -> tuple[Tunable, ...]:
    """List the numbers of the joint that are finite: only a massive socket has an infinite liner."""
    return tuple(number for number in JOINT_TUNABLES if math.isfinite(number.value(element)))


def joint_of_inputs(element: ForceElement | PreloadedElement, tape: Tape) -> Joint:
    """Return the joint of an element with its tunable numbers as inputs of a tape."""
    joint, tunables = element.joint.with_floats(), joint_tunables(element)
    numbers = list(joint.numbers())
    for index, number in enumerate(JOINT_TUNABLES):
        if number in tunables:
            numbers[index] = tape.input(f"p->{number.name}")
    return joint.with_numbers(numbers)


def has_formulas(element: ForceElement | PreloadedElement, joint: Joint, tape: Tape) -> bool:
    """Check if the law of an element can be recorded for a joint: a closed form without iterations and branches."""
    if not isinstance(element, ForceElement) or not isinstance(element.potential, FormulaPotential | SpringPotential):
        return False
    law = ClosedFormSolution(model=cast(ClosedForm, element.model), joint=joint, indentation=tape.input("depth"))
    try:
        law.energy, law.stiffness, law.half_angle, law.max_pressure  # noqa: B018 - records them
    except (TypeError, AttributeError, ValueError):
        return False
    return True


def reason_of_fixed_joint(element: ForceElement | PreloadedElement) -> str:
    """Say why the numbers of the joint cannot be tuned in the exported element; empty if they can."""
    tape = Tape()
    if not has_formulas(element, joint_of_inputs(element, tape), tape):
        return f"the law of {element.model.name} is computed for this joint"
    return "the film of the lubricant is computed for this joint" if element.constants.film_damping > 0.0 else ""


def tunables_of(element: ForceElement | PreloadedElement) -> tuple[Tunable, ...]:
    """List the adjustable parameters of an exported element, in the order of the C structure.

    The numbers of bristles are constants.
    """
    losses = DAMPING_TUNABLES if isinstance(element.friction, Bristles) else TUNABLES
    return losses if reason_of_fixed_joint(element) else (*losses, *joint_tunables(element))
