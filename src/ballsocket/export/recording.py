"""A force element written down: its own formulas, on a state and on parameters that are not known yet."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain
from typing import Any

from ..contact.law import CurveLaw
from ..core.arrays import isfinite, where
from ..dynamics import ForceElement, reaction
from ..dynamics.load import status_of
from ..dynamics.potential import CurvePotential, energy_curve
from ..dynamics.reaction import Constants, Elastic, Place, Three
from .recorder import Part, Recorded, Tape
from .slopes import slopes_of
from .tunable import TUNABLES

ENERGY, HALF_ANGLE, MAX_PRESSURE = "energy_curve", "half_angle_curve", "max_pressure_curve"
STATE = ("position", "velocity", "spin")
Targets = dict[str, Part]


@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """The formulas of a force element as steps of a tape.

    Attributes
    ----------
    element : ForceElement
    tape : Tape
    """

    element: ForceElement
    tape: Tape = field(default_factory=Tape)

    @cached_property
    def state(self) -> tuple[Three, Three, Three]:
        """Position, velocity and spin."""
        x, v, w = (tuple(self.tape.input(f"{name}[{axis}]") for axis in range(3)) for name in STATE)
        return x, v, w  # type: ignore[return-value]

    @cached_property
    def constants(self) -> Constants:
        """The constants of the element, of which some may be tuned."""
        tuned: dict[str, Any] = {each.constant: self.tape.input(f"p->{each.name}", tunable=True) for each in TUNABLES}
        tuned["static"] = where(tuned["static"] > tuned["sliding"], tuned["static"], tuned["sliding"])
        return self.element.constants._replace(**tuned)

    @cached_property
    def curves(self) -> dict[str, CurveLaw]:
        """The curves that are looked up, by name."""
        half_angle, max_pressure = self.element.curves
        curves = {HALF_ANGLE: half_angle, MAX_PRESSURE: max_pressure}
        potential = self.element.potential
        if isinstance(potential, CurvePotential):
            curves[ENERGY] = potential.curve
        elif not _can_be_recorded(potential):
            law = self.element.model.law(self.element.joint)
            curves[ENERGY] = energy_curve(law, half_angle.shallowest, self.element.wall)
        return curves

    @cached_property
    def place(self) -> Place:
        return reaction.place_of(*self.state[0], self.constants.clearance)

    @cached_property
    def contact(self) -> Elastic:
        return reaction.elastic(self._potential, self.place, self.constants)

    def _potential(self, depth: Recorded) -> tuple[Part, Part, Part]:
        if ENERGY in self.curves:
            energy, force, stiffness = self.tape.curve(ENERGY, depth, 3)
            return energy, force, stiffness
        return self.element.potential(depth)

    @cached_property
    def load(self) -> Targets:
        """Force, moment and energy."""
        parts = reaction.reaction(self.place, self.contact, *self.state[1:], self.constants)
        return {**_numbered("force", parts[:3]), **_numbered("moment", parts[3:]), "*energy": self.contact.energy}

    @cached_property
    def pressed(self) -> Targets:
        """Half angle and largest pressure."""
        depth = self.place.indentation
        angle, pressure = (self.tape.curve(name, depth, 1)[0] for name in (HALF_ANGLE, MAX_PRESSURE))
        return {"*half_angle": angle, "*max_pressure": pressure}

    @cached_property
    def status(self) -> Targets:
        """A code of `Touch`."""
        return {"status": status_of(self.place, self.contact, isfinite(self.place.distance), self.constants)}

    @cached_property
    def tangent(self) -> Targets:
        """∂²U/∂r², nine numbers."""
        xx, yy, zz, xy, yz, zx = reaction.tangent(self.place, self.contact, self.constants)
        return _numbered("tangent", (xx, xy, zx, xy, yy, yz, zx, yz, zz))

    @cached_property
    def slope(self) -> Targets:
        """How the load, half angle and pressure change along a way of the state."""
        names = (f"way[{number}]" for number in range(9))
        ways = {part: self.tape.input(name) for part, name in zip(chain(*self.state), names, strict=True)}
        return _numbered("slope", slopes_of([*self.load.values(), *self.pressed.values()], ways))


def _numbered(name: str, parts: Any) -> Targets:
    return {f"{name}[{number}]": part for number, part in enumerate(parts)}


def _can_be_recorded(potential: Any) -> bool:
    try:
        potential(Tape().input("depth"))
    except (TypeError, AttributeError, ValueError):  # it solves, or goes different ways
        return False
    return True
