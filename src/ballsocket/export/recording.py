"""Recorded formulas of a force element: an unknown state, unknown parameters, and the numbers that follow from them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain
from math import inf
from typing import Any, cast

from ..contact import Contact
from ..contact.coordinates import LIMIT
from ..contact.octave_curve import OctaveCurve, fit_octave_curve
from ..contact.strength import MAX_ELASTIC_UTILISATION
from ..contact.stress_ratio import von_mises_ratio
from ..core.arrays import isfinite, logical_not, where
from ..core.display import ascii_text
from ..core.validity import Status
from ..dynamics import ForceElement, PreloadedElement, ball_centre, preloaded, reaction
from ..dynamics.ball_centre import BallCentre, Constants, Vector
from ..dynamics.bristles import Bristles
from ..dynamics.load import Load, add_bristle_loads, contact_state_of
from ..dynamics.potential import CurvePotential, curve_potential
from ..dynamics.reaction import Elastic
from ..dynamics.validity_monitor import FIRST_TOUCH, is_lower_limit
from ..dynamics.viscoelastic import relaxed_contact
from ..models.closed_form import ClosedFormSolution
from ..problem import Joint
from .recorder import Part, Recorded, Tape, directional_derivatives
from .tunable import TUNABLES, has_formulas, joint_of_inputs, reason_of_fixed_joint, tunables_of

ENERGY, HALF_ANGLE, MAX_PRESSURE = "energy_curve", "half_angle_curve", "max_pressure_curve"
STRESS_RATIO = "stress_ratio_curve"
STATE = ("position", "velocity", "spin")

Outputs = dict[str, Part]  # recorded quantities by the C expression that receives them


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class _RecordedContact(Contact):
    """Contact of recorded numbers, whose von Mises stress is that of a curve."""

    def _compute_von_mises(self) -> Part:
        angle = where(self.half_angle < LIMIT, self.half_angle, LIMIT)
        return angle.tape.curve(STRESS_RATIO, angle, 1)[0] * self.max_pressure


@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """Recorded formulas of a force element, for an unknown state and tunable parameters."""

    element: ForceElement
    beyond: str = "extend"
    tape: Tape = field(default_factory=Tape)

    @cached_property
    def state(self) -> tuple[Vector, Vector, Vector]:
        """Position, velocity and spin of the ball as inputs of the tape."""
        x, v, w = (tuple(self.tape.input(f"{name}[{axis}]") for axis in range(3)) for name in STATE)
        return x, v, w  # type: ignore[return-value]

    @cached_property
    def internal(self) -> dict[str, tuple[Part, ...]]:
        """Components of the internal states of the element by name, as inputs of the tape."""
        states = self.element.internal_states
        return {name: tuple(self.tape.input(f"{name}[{i}]") for i in range(count)) for name, count in states.items()}

    @cached_property
    def joint(self) -> Joint | None:
        """Joint of the formulas, with its tunable numbers as inputs of the tape; None if the law is a curve."""
        is_fixed = bool(reason_of_fixed_joint(self.element))
        joint = self.element.joint.with_floats() if is_fixed else joint_of_inputs(self.element, self.tape)
        return joint if has_formulas(self.element, joint, Tape()) else None

    @cached_property
    def constants(self) -> Constants:
        """Constants of the force element, in which the tunable parameters are inputs of the tape."""
        tuned: dict[str, Any] = {
            parameter.path.removeprefix("constants."): self.tape.input(f"p->{parameter.name}", tunable=True)
            for parameter in tunables_of(self.element)
            if parameter in TUNABLES
        }
        if "static" in tuned:
            tuned["static"] = where(tuned["static"] > tuned["sliding"], tuned["static"], tuned["sliding"])
        if self.joint is not None:
            R2, L = self.joint.socket_radius, self.joint.liner_thickness
            tuned |= {"ball_radius": self.joint.ball_radius, "socket_radius": R2, "clearance": self.joint.clearance}
            tuned["wall"] = where(L < R2, L, R2)
        return self.element.constants._replace(**tuned)

    def _pressed(self, joint: Joint, indentation: Part) -> _RecordedContact:
        """Return the contact of a joint at an indentation by the formulas of the model."""
        model: Any = self.element.model
        return _RecordedContact(
            model=model,
            joint=joint,
            laws=ClosedFormSolution(model=model, joint=joint, indentation=indentation),
            force=model.force(joint, indentation),
            indentation=indentation,
            status=Status.OK,
        )

    @cached_property
    def curves(self) -> dict[str, OctaveCurve]:
        """Fitted curves that the C program evaluates, by name.

        A law that is no formula has curves of energy, half angle and largest pressure over the indentation. A formula
        has one of the ratio of von Mises stress to largest pressure over the half angle, for its validity.
        """
        element = self.element
        if self.joint is not None:
            yields = element.joint.liner.yield_stress is not None
            return {STRESS_RATIO: _stress_ratio_curve(element.joint)} if yields else {}
        half_angle, max_pressure = element.curves
        energy = element.potential
        if not isinstance(energy, CurvePotential):
            energy = curve_potential(element.model, element.joint)
        return {HALF_ANGLE: half_angle, MAX_PRESSURE: max_pressure, ENERGY: energy.curve}

    @cached_property
    def centre(self) -> BallCentre:
        """Recorded position of the ball centre."""
        return ball_centre.ball_centre_at(*self.state[0], self.constants.clearance)

    @cached_property
    def elastic(self) -> Elastic:
        """Recorded elastic contact at the position of the ball, with the instantaneous modulus."""
        constants = self.constants._replace(wall=inf) if self.beyond == "extend" else self.constants
        return reaction.elastic_contact(self._potential, self.centre, constants)

    @cached_property
    def relaxed(self) -> tuple[Elastic, tuple[Part, ...]]:
        """Recorded contact of a liner that may relax, and the rates of its relaxed forces."""
        if self.element.relaxation is None:
            return self.elastic, ()
        return relaxed_contact(self.elastic, self.internal["relaxed_force"], self.element.relaxation)

    def _potential(self, depth: Recorded) -> tuple[Part, Part, Part]:
        """Record energy, force and stiffness at an indentation."""
        inside = self._within_range(depth)
        if self.joint is None:
            energy, force, stiffness = self.tape.curve(ENERGY, inside, 3)
        else:
            contact = self._pressed(self.joint, inside)
            energy, force, stiffness = contact.energy, contact.force, contact.stiffness
        return self._continued((energy, force, stiffness), depth - inside)

    def _within_range(self, depth: Part) -> Part:
        """Record the indentation at which the law is evaluated: the last one of its range for deeper ones."""
        wall = self.constants.wall
        return where(depth < wall, depth, wall) if self.beyond == "extend" else depth

    def _continued(self, derivatives: tuple[Part, ...], excess: Part) -> tuple[Part, Part, Part]:
        """Record energy, force and stiffness at an indentation beyond the range: the stiffness stays the last one."""
        energy, force, stiffness = derivatives
        if self.beyond != "extend":
            return energy, force, stiffness
        return energy + excess * (force + 0.5 * stiffness * excess), force + stiffness * excess, stiffness

    @cached_property
    def load(self) -> Outputs:
        """Recorded force, moment, elastic energy and rates of the internal states, by C variable."""
        contact, rates = self.relaxed
        parts = reaction.force_and_moment(self.centre, contact, *self.state[1:], self.constants)
        recorded: Any = self  # it has the constants of the element
        load = Load(parts[:3], parts[3:], contact.energy, recorded, self.centre, contact, *self.state)
        load = load._replace(relaxed_force_rate=rates)
        if isinstance(self.element.friction, Bristles):
            load = add_bristle_loads(load, self.element.friction, self.internal["deflection"])
        outputs = {**_by_array_element("force", load.force), **_by_array_element("moment", load.moment)}
        outputs["*energy"] = load.energy
        for name in self.internal:
            outputs |= _by_array_element(f"{name}_rate", getattr(load, f"{name}_rate"))
        return outputs

    @cached_property
    def contact_size(self) -> Outputs:
        """Recorded half angle and largest pressure, by C variable."""
        depth = self.centre.indentation
        if self.joint is None:
            angle, pressure = (self.tape.curve(name, depth, 1)[0] for name in (HALF_ANGLE, MAX_PRESSURE))
        else:
            touching = depth > 0.0
            contact = self._pressed(self.joint, where(touching, depth, self.constants.ball_radius))
            angle, pressure = where(touching, contact.half_angle, 0.0), where(touching, contact.max_pressure, 0.0)
        return {"*half_angle": angle, "*max_pressure": pressure}

    @cached_property
    def validity(self) -> Outputs:
        """Recorded truth that the model is valid for the joint and its indentation, by C variable.

        Contacts that are only too small for the model count as valid: every contact passes through them.
        """
        depth = self.centre.indentation
        if self.joint is None:
            return {"valid": depth <= self.element.valid_depth}
        wall = self.constants.wall
        contact, first_touch, deepest = (self._pressed(self.joint, each) for each in (depth, FIRST_TOUCH * wall, wall))
        valid = depth <= wall
        for limit in self.element.model.validity:
            valid = valid & (limit.holds(contact) | is_lower_limit(limit, first_touch, deepest))
        if self.joint.strengths():
            valid = valid & logical_not(contact.utilisation > MAX_ELASTIC_UTILISATION)
        return {"valid": (depth <= 0.0) | valid}

    @cached_property
    def domain(self) -> dict[str, Part]:
        """Recorded truths that the joint has a contact law, by the messages on joints without one."""
        if self.joint is None:
            return {}
        model, smoothing = self.element.model, self.element.constants.smoothing
        contact = self._pressed(self.joint, self.centre.indentation)
        holds = {f"{model.name} has no answer outside {each}": each.strictly_holds(contact) for each in model.domain}
        if smoothing > 0.0:
            holds[f"clearance must be at least the smoothing, {smoothing!r} mm"] = self.joint.clearance >= smoothing
        return {ascii_text(message): truth for message, truth in holds.items() if isinstance(truth, Recorded)}

    @cached_property
    def status(self) -> Outputs:
        """Recorded code of the `ContactState` (free, contact, at the rim, ...)."""
        return {"status": contact_state_of(self.centre, self.elastic, isfinite(self.centre.distance), self.constants)}

    @cached_property
    def tangent(self) -> Outputs:
        """Recorded tangent stiffness ∂²U/∂r² in N/mm, nine components by C variable."""
        return _tangent_elements(reaction.tangent_stiffness(self.centre, self.relaxed[0], self.constants))

    @cached_property
    def slope(self) -> Outputs:
        """Recorded directional derivatives of load, half angle, pressure and rates with respect to the state."""
        inputs, load = (*chain(*self.state), *chain(*self.internal.values())), list(self.load.values())
        direction = {part: self.tape.input(f"way[{index}]") for index, part in enumerate(inputs)}
        outputs = [*load[:_LOADS], *self.contact_size.values(), *load[_LOADS:]]
        return _by_array_element("slope", directional_derivatives(outputs, direction))


_LOADS = 7  # number of components of force, moment and energy


@dataclass(frozen=True, kw_only=True, eq=False)
class PreloadRecording(Recording):
    """Recorded formulas of the force element of a preloaded joint."""

    element: PreloadedElement  # type: ignore[assignment]

    @cached_property
    def curves(self) -> dict[str, OctaveCurve]:
        """Tabulated curves of each quantity in each direction, by name."""
        tabulated = self.element.table.curves
        return {_curve_name(name, index): curve for name, rows in tabulated.items() for index, curve in enumerate(rows)}

    def _tabulated(self, quantity: str, order: int) -> list[tuple[Part, ...]]:
        """Record the curves of a quantity in all directions, with derivatives up to an order."""
        names, distance = (_curve_name(quantity, index) for index in range(preloaded.NODES)), self._displacement[0]
        inside = self._within_range(distance)
        rows = [self.tape.curve(name, inside, order + 1) for name in names]
        return rows if order == 0 else [self._continued(row, distance - inside) for row in rows]

    @cached_property
    def _displacement(self) -> tuple[Part, ...]:
        """Recorded displacement from equilibrium: distance, direction and cosine."""
        return preloaded.displacement_from_equilibrium(*self.state[0], self.constants, self.element.table.offset)

    @cached_property
    def _elastic(self) -> preloaded.PreloadedForce:
        """Recorded elastic energy with its derivatives."""
        return preloaded.preloaded_force(self._tabulated("energy", 2), self._displacement, self.constants)

    def _interpolated(self, quantity: str) -> Part:
        """Record the interpolation of a quantity between the directions."""
        values = [value for (value,) in self._tabulated(quantity, 0)]
        return preloaded.interpolate(values, self._elastic.cosine)

    @cached_property
    def load(self) -> Outputs:
        """Recorded force, moment and elastic energy, by C variable."""
        lever = self._interpolated("friction_lever")
        parts = preloaded.preloaded_load(self._elastic, lever, *self.state[1:], self.constants, self.element.table)
        moved = {**_by_array_element("force", parts[:3]), **_by_array_element("moment", parts[3:])}
        return {**moved, "*energy": self._elastic.energy}

    @cached_property
    def contact_size(self) -> Outputs:
        """Recorded half angle and largest pressure, by C variable."""
        return {f"*{name}": self._interpolated(name) for name in ("half_angle", "max_pressure")}

    @cached_property
    def status(self) -> Outputs:
        """Recorded code of the `ContactState`: contact, or a displacement beyond the table."""
        distance = self._displacement[0]
        return {"status": preloaded.preloaded_state(distance, isfinite(distance), self.element.wall)}

    @cached_property
    def tangent(self) -> Outputs:
        """Recorded tangent stiffness ∂²U/∂r² in N/mm, nine components by C variable."""
        return _tangent_elements(preloaded.preloaded_tangent(self._elastic))


def _curve_name(quantity: str, index: int) -> str:
    return f"{quantity}_{index}"


def _tangent_elements(components: tuple[Part, ...]) -> Outputs:
    """Return the nine components of a symmetric matrix by their C array elements."""
    xx, yy, zz, xy, yz, zx = components
    return _by_array_element("tangent", (xx, xy, zx, xy, yy, yz, zx, yz, zz))


def _by_array_element(name: str, parts: Any) -> Outputs:
    """Return recorded parts by their C array elements, such as "force[0]"."""
    return {f"{name}[{index}]": part for index, part in enumerate(parts)}


def _stress_ratio_curve(joint: Joint) -> OctaveCurve:
    """Fit a curve to the ratio of the largest von Mises stress to the largest pressure, over the half angle in rad."""
    return fit_octave_curve(
        lambda angles: von_mises_ratio(angles, joint.liner.poisson, joint.thickness_ratio)[None], _SMALL_ANGLE, LIMIT
    )


_SMALL_ANGLE = 0.01  # half angle in rad at which the curve of the stresses begins


def recording_of(element: ForceElement | PreloadedElement, beyond: str) -> Recording:
    """Record the formulas of a force element; `beyond` is as in `CElement`."""
    kind = PreloadRecording if isinstance(element, PreloadedElement) else Recording
    return kind(element=cast(Any, element), beyond=beyond)
