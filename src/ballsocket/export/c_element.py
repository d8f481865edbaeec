"""Force element as C99 source and header without other dependencies."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cached_property
from importlib.resources import files
from itertools import chain
from math import inf
from pathlib import Path
from string import Template
from typing import Any, cast

import numpy

from ..contact import Contact
from ..contact.coordinates import LIMIT
from ..contact.octave_curve import OctaveCurve, fit_octave_curve
from ..contact.strength import MAX_ELASTIC_UTILISATION
from ..contact.stress_ratio import von_mises_ratio
from ..core.arrays import isfinite, logical_not, where
from ..core.checks import known_name
from ..core.display import ascii_text
from ..core.storage.atomic_files import write_text
from ..core.validity import Status
from ..dynamics import ContactState, ForceElement, PreloadedElement, ball_centre, preloaded, reaction
from ..dynamics.ball_centre import BallCentre, Constants, Vector
from ..dynamics.bristles import Bristles, Deflections
from ..dynamics.load import Load, add_bristle_loads, contact_state_of
from ..dynamics.potential import CurvePotential, curve_potential
from ..dynamics.reaction import Elastic
from ..models.closed_form import ClosedFormSolution
from ..problem import Joint
from ..version import __version__
from .c_text import C, c_number
from .recorder import Part, Recorded, Tape, directional_derivatives
from .tunable import Tunable, joint_of_inputs, loss_tunables, reason_of_fixed_joint, tunables_of

ENERGY, HALF_ANGLE, MAX_PRESSURE = "energy_curve", "half_angle_curve", "max_pressure_curve"
STRESS_RATIO = "stress_ratio_curve"
STATE = ("position", "velocity", "spin")
BRISTLES = 4  # number of deflections of bristles
BEYOND = {
    "extend": "the indentation exceeds the wall thickness or the range of the model; the force has its last stiffness",
    "stop": ContactState.THROUGH_WALL.sentence,
}
"""What an exported element says of an indentation beyond the range of its law, by what it does there."""

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

    @property
    def deflection(self) -> Deflections | tuple[()]:
        """Deflections of bristles as inputs of the tape; empty without bristles."""
        return ()

    @cached_property
    def joint(self) -> Joint | None:
        """Joint with its tunable numbers as inputs of the tape; None if the law is that of one joint."""
        return None if reason_of_fixed_joint(self.element) else joint_of_inputs(self.element, self.tape)

    @cached_property
    def constants(self) -> Constants:
        """Constants of the force element, in which the tunable parameters are inputs of the tape."""
        tuned: dict[str, Any] = {
            parameter.constant: self.tape.input(f"p->{parameter.name}", tunable=True)
            for parameter in loss_tunables(self.element)
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

        They are those of half angle, largest pressure and energy of one joint, or the ratio of the largest von Mises
        stress to the largest pressure over the half angle.
        """
        if self.joint is not None:
            return (
                {} if self.joint.liner.yield_stress is None else {STRESS_RATIO: _stress_ratio_curve(self.element.joint)}
            )
        half_angle, max_pressure = self.element.curves
        curves = {HALF_ANGLE: half_angle, MAX_PRESSURE: max_pressure}
        potential = self.element.potential
        if isinstance(potential, CurvePotential):
            curves[ENERGY] = potential.curve
        else:
            try:
                potential(Tape().input("depth"))
            except (TypeError, AttributeError, ValueError):  # iterations and data-dependent branches are not recorded
                curves[ENERGY] = curve_potential(self.element.model, self.element.joint).curve
        return curves

    @cached_property
    def centre(self) -> BallCentre:
        """Recorded position of the ball centre."""
        return ball_centre.ball_centre_at(*self.state[0], self.constants.clearance)

    @cached_property
    def contact(self) -> Elastic:
        """Recorded elastic contact at the position of the ball."""
        constants = self.constants._replace(wall=inf) if self.beyond == "extend" else self.constants
        return reaction.elastic_contact(self._potential, self.centre, constants)

    def _potential(self, depth: Recorded) -> tuple[Part, Part, Part]:
        """Record energy, force and stiffness at an indentation."""
        inside, model = self._within_range(depth), self.element.model
        if self.joint is not None:
            energy, force, stiffness = (
                getattr(model, law)(self.joint, inside) for law in ("energy", "force", "stiffness")
            )
        elif ENERGY in self.curves:
            energy, force, stiffness = self.tape.curve(ENERGY, inside, 3)
        else:
            energy, force, stiffness = self.element.potential(inside)
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
        """Recorded force, moment and elastic energy, by C variable."""
        parts = reaction.force_and_moment(self.centre, self.contact, *self.state[1:], self.constants)
        return {
            **_by_array_element("force", parts[:3]),
            **_by_array_element("moment", parts[3:]),
            "*energy": self.contact.energy,
        }

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
        model, joint, contact = self.element.model, self.element.joint.with_floats(), self._pressed(self.joint, depth)
        first_touch, deepest = (model.press(joint, indentation=share * self.element.wall) for share in (1e-3, 1.0))
        valid = depth <= self.constants.wall
        for limit in model.validity:
            if limit.holds(first_touch) or not limit.holds(deepest):
                valid = valid & limit.holds(contact)
        if joint.strengths():
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
        return {"status": contact_state_of(self.centre, self.contact, isfinite(self.centre.distance), self.constants)}

    @cached_property
    def tangent(self) -> Outputs:
        """Recorded tangent stiffness ∂²U/∂r² in N/mm, nine components by C variable."""
        return _tangent_elements(reaction.tangent_stiffness(self.centre, self.contact, self.constants))

    @cached_property
    def slope(self) -> Outputs:
        """Recorded directional derivatives of load, half angle, pressure and rates with respect to the state."""
        inputs, load = (*chain(*self.state), *self.deflection), list(self.load.values())
        direction = {part: self.tape.input(f"way[{index}]") for index, part in enumerate(inputs)}
        outputs = [*load[:_LOADS], *self.contact_size.values(), *load[_LOADS:]]
        return _by_array_element("slope", directional_derivatives(outputs, direction))


_LOADS = 7  # number of components of force, moment and energy


@dataclass(frozen=True, kw_only=True, eq=False)
class BristleRecording(Recording):
    """Recorded formulas of a force element with bristles, whose deflections are part of the state."""

    @cached_property
    def deflection(self) -> Deflections:
        """Deflections of the bristles as inputs of the tape."""
        return tuple(self.tape.input(f"deflection[{index}]") for index in range(BRISTLES))  # type: ignore[return-value]

    @cached_property
    def load(self) -> Outputs:
        """Recorded force, moment, elastic energy and rates of the deflections, by C variable."""
        parts = reaction.force_and_moment(self.centre, self.contact, *self.state[1:], self.constants)
        recorded: Any = self  # it has the constants of the element
        smooth = Load(parts[:3], parts[3:], self.contact.energy, recorded, self.centre, self.contact, *self.state)
        load = add_bristle_loads(smooth, cast(Bristles, self.element.friction), self.deflection)
        return {
            **_by_array_element("force", load.force),
            **_by_array_element("moment", load.moment),
            "*energy": load.energy,
            **_by_array_element("rate", load.deflection_rate),
        }


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


@dataclass(frozen=True, kw_only=True, eq=False)
class CElement:
    """Force element as C99 source and header.

    Parameters
    ----------
    element : ForceElement or PreloadedElement
    name : str
        Prefix of all names in the program, so that one program can hold two joints: letters, digits and _.
    beyond : str
        What follows an indentation beyond the wall thickness or the range of the model: "extend" continues the force
        with its last stiffness, "stop" gives NaN. The status is THROUGH_WALL in both.

    Raises
    ------
    ValueError
        A name that C does not allow; an unknown `beyond`; an element with a state (bristles or adhesion).

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.export import CElement
    >>> element = CElement(element=bs.ForceElement(bs.HessForsbach(), bs.joints["hip-28"]), name="hip")
    >>> "int hip_load(" in element.header
    True
    """

    element: ForceElement | PreloadedElement
    name: str = "ballsocket"
    beyond: str = "extend"

    def __post_init__(self) -> None:
        object.__setattr__(self, "beyond", known_name("beyond", self.beyond, BEYOND))
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,40}", self.name):
            raise ValueError(
                f"name must start with a letter or _ and hold letters, digits and _, got {self.name!r:.60}"
            )
        if self.element.internal_state and not self.has_bristles:
            raise ValueError(f"{self.element.internal_state}; exported elements do not have it")

    @property
    def has_bristles(self) -> bool:
        """True if the deflections of bristles are part of the state."""
        return isinstance(self.element.friction, Bristles)

    @cached_property
    def recording(self) -> Recording:
        """Recorded formulas of the force element."""
        if isinstance(self.element, PreloadedElement):
            return PreloadRecording(element=self.element, beyond=self.beyond)
        if self.has_bristles:
            return BristleRecording(element=self.element, beyond=self.beyond)
        return Recording(element=self.element, beyond=self.beyond)

    @cached_property
    def tunables(self) -> tuple[Tunable, ...]:
        """Adjustable parameters in the order of the C structure."""
        return tunables_of(self.element)

    @property
    def header(self) -> str:
        """Text of the C header that other programs include."""
        fields = "\n".join(
            f"    double {parameter.name}; /* {parameter.unit}: {parameter.meaning} */" for parameter in self.tunables
        )
        codes = "\n".join(f"    {self.name.upper()}_{state.name} = {state.value}," for state in ContactState)
        names = {"name": self.name, "NAME": self.name.upper()}
        return fill_template(
            "element.h",
            fields=fields,
            codes=codes,
            failed=str(self.first_failure.value),
            through_wall=f"{ContactState.THROUGH_WALL.value}: {BEYOND[self.beyond]}",
            **names,
            **self._arguments,
            **self.about,
        )

    @property
    def source(self) -> str:
        """Text of the C source file of the force element."""
        recording, constants = self.recording, self.element.constants
        # distance in mm; a lubricated ball has a force at all distances, and bristles a rate
        always = constants.film_damping > 0.0 or self.has_bristles
        unloaded = -1.0 if always else recording.constants.clearance - constants.smoothing
        domain = {f"allowed[{index}]": holds for index, holds in enumerate(recording.domain.values())}
        checks = [_range_check_statement(parameter.name, parameter.above) for parameter in self.tunables]
        if domain:
            checks += ["    {", f"    int allowed[{len(domain)}];", C.statements(domain)]
            checks += [
                f'    if (!{name}) return "{text}";' for name, text in zip(domain, recording.domain, strict=True)
            ]
            checks.append("    }")
        sentences = {state: state.sentence for state in ContactState}
        sentences[ContactState.THROUGH_WALL] = BEYOND[self.beyond]
        return fill_template(
            "element.c",
            name=self.name,
            NAME=self.name.upper(),
            along=_read_template("curve.c") if recording.curves else "",
            curves="\n".join(_curve_function_code(name, curve) for name, curve in sorted(recording.curves.items())),
            defaults=", ".join(c_number(parameter.value(self.element)) for parameter in self.tunables),
            checks="\n".join(checks),
            unloaded=C.statements({"unloaded": unloaded}),
            valid=C.statements(recording.validity),
            load=C.statements({**recording.status, **recording.load}),
            pressed=C.statements({**recording.status, **recording.contact_size}),
            tangent=C.statements({**recording.status, **recording.tangent}),
            slope=C.statements({**recording.status, **recording.slope}),
            no_rate=f"\n        fill(rate, {BRISTLES}, NAN, 0);" if self.has_bristles else "",
            **self._arguments,
            sentences="\n".join(f'    case {state.value}: return "{text}";' for state, text in sentences.items()),
            **self.about,
        )

    @property
    def _arguments(self) -> dict[str, str]:
        """Further arguments of the functions in C for the deflections of bristles, and the sizes of their arrays."""
        count = BRISTLES if self.has_bristles else 0
        return {
            "deflection": f", const double deflection[{count}]" if count else "",
            "not_finite": " || !is_finite(deflection) || !is_finite(deflection + 1)" if count else "",
            "rate": f", double rate[{count}]" if count else "",
            "count": str(9 + count),
        }

    @property
    def first_failure(self) -> ContactState:
        """First status without a load; the statuses after it have none either."""
        return ContactState.NO_NUMBER if self.beyond == "extend" else ContactState.THROUGH_WALL

    def write(self, folder: Path) -> tuple[Path, Path]:
        """Write the header and source files into a folder, and return their paths.

        Raises OSError: a folder that cannot be written to.
        """
        folder = Path(folder)
        header = write_text(folder / f"{self.name}.h", self.header)
        return header, write_text(folder / f"{self.name}.c", self.source)

    @property
    def about(self) -> dict[str, str]:
        """Version, model and joint as texts for the comments in generated files."""
        joint = self.element.joint
        description = f"{joint}; {joint.source}" if joint.source else str(joint)
        comment = re.sub(r"\*/|/\*|--|\\", "?", ascii_text(description))
        return {"version": __version__, "model": self.element.model.name, "joint": comment}


def _stress_ratio_curve(joint: Joint) -> OctaveCurve:
    """Fit a curve to the ratio of the largest von Mises stress to the largest pressure, over the half angle in rad."""
    return fit_octave_curve(
        lambda angles: von_mises_ratio(angles, joint.liner.poisson, joint.thickness_ratio)[None], _SMALL_ANGLE, LIMIT
    )


_SMALL_ANGLE = 0.01  # half angle in rad at which the curve of the stresses begins


def _range_check_statement(name: str, is_positive: bool) -> str:
    operator, allowed = (">", "above 0") if is_positive else (">=", "0 or more")
    condition = f"p->{name} {operator} 0.0 && p->{name} < INFINITY"
    return f'    if (!({condition})) return "{name} must be finite and {allowed}";'


def _curve_function_code(name: str, curve: OctaveCurve) -> str:
    """Return the C code of a fitted curve: its coefficients and the function that evaluates it."""
    rows = numpy.column_stack([curve.origins, curve.coefficients[0].T])
    row_lines = ",\n".join("    " + ", ".join(map(c_number, row)) for row in rows.tolist())
    ends = f"{c_number(curve.low)}, {c_number(curve.high)}, {curve.first}, {curve.density}"
    return (
        f"static const double {name}_rows[] = {{\n{row_lines}\n}};\n"
        f"static const curve {name}_data = {{{ends}, {rows.shape[0]}, {rows.shape[1]}, {name}_rows}};\n"
        f"static void {name}(double d, double out[4]) {{ along_curve(&{name}_data, d, out); }}\n"
    )


def _read_template(name: str) -> str:
    return (files(__package__) / "templates" / name).read_text(encoding="utf-8")


def fill_template(template_name: str, **values: str) -> str:
    """Fill a template file of this package with values, and return the resulting text."""
    return Template(_read_template(template_name)).substitute(values)
