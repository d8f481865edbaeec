"""Force element: contact model, joint, damping and friction, evaluated at states of the ball."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import inf
from typing import Any

import numpy

from ..contact import Model
from ..contact.assembly import check_joint
from ..contact.joint_curve import joint_curve
from ..contact.octave_curve import OctaveCurve
from ..core import arrays
from ..core.arrays import Array, is_plain_number, to_common_arrays, where
from ..core.checks import check_number, check_vectors, require, shown
from ..core.display import OneLine
from ..lubrication import Lubricant
from ..models.adhesion import AdhesiveSocket
from ..problem import Joint
from ..problem.cup import Cup
from .ball_centre import BallCentre, Constants, Vector, ball_centre_at
from .bristles import DEFLECTIONS, Bristles
from .damping import Damping
from .film import film_constants
from .friction import Friction
from .load import Load, add_bristle_loads, split_internal_state, vector_components
from .matrices import join_vector
from .potential import Potential, adhesion_potential, evaluate_curve, potential_of
from .reaction import NO_CONTACT, Elastic, elastic_contact, force_and_moment, remove_tension_damping
from .validity_monitor import ValidityMonitor
from .viscoelastic import Prony, relaxed_contact

_DEPTHS = 129  # number of indentations at which validity is evaluated

_ZERO_VECTOR = (0.0, 0.0, 0.0)
_ZERO_DEFLECTION = (0.0,) * DEFLECTIONS
_STATE_NOTES = {"deflection": "bristles have a state", "relaxed_force": "a relaxing liner has a state"}
_PARTS: dict[str, Any] = {
    "model": Model,
    "damping": Damping,
    "friction": Friction | Bristles,
    "cup": Cup,
    "lubricant": Lubricant,
    "relaxation": Prony,
}
"""Types of the parts of a force element by their names."""

_SEQUENCES = (tuple, list)
_NUMPY_FLOAT = numpy.float64


@dataclass(frozen=True, eq=False, repr=False)
class ForceElement(OneLine):
    """Force element of a ball joint for time-stepping programs.

    Parameters
    ----------
    model : Model
        Any model with a force law: closed forms, `Tabulated`, `Refined`, `Exact`, ...
    joint : Joint
        Joint of plain numbers.
    damping : Damping, optional
        `Damping(...)`, or a relation: `Flores(restitution=..., impact_speed=...)`. None, the default, has no losses.
    friction : Friction or Bristles, optional
        Bristles have a state, an argument of each call. None, the default, has no friction.
    cup : Cup, optional
        Cup with a rim, at which the force falls to zero. None, the default, is a full sphere.
    smoothing : float
        Indentation in mm on both sides of first touch over which the law is rounded off. The force is then twice
        continuously differentiable, as optimal control needs it. 0, the default, is the law of the model.
    lubricant : Lubricant, optional
        Adds squeeze, wedge and spin forces of the film between a rigid ball and a rigid socket. The film is never
        thinner than the combined roughness of the surfaces, also where they touch. Dry friction is that of `friction`;
        the coefficient of the lubricant is not used. None, the default, is a dry socket.
    film_tension : float
        Largest tension of the lubricant in MPa, above 0, for a ball that leaves the wall: about 0.1 for a fluid at
        atmospheric pressure, which cavitates. Infinite, the default, is Reynolds' equation without cavitation.
    relaxation : Prony, optional
        Relaxing liner, whose instantaneous modulus is that of the joint. Each term has a relaxed force, an argument of
        each call. The force is exact while the contact grows at one place of the socket (Lee & Radok). While it
        shrinks, the same integral ends at zero force; Ting's force, `Viscoelastic.cycle_force`, is larger. Half angle
        and pressure are those of the instantaneous modulus. None, the default, is an elastic liner.

    Raises
    ------
    ValueError
        A joint outside the domain of the model; a smoothing below 0 or above the clearance; a lubricant in a joint
        with a clearance below twice its combined roughness, or without roughness; a `film_tension` that is not above
        0, or without a lubricant.
    TypeError
        A model without a force law, arrays in the joint, or a wrong type of damping, friction, cup or lubricant.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.dynamics import Flores, Friction
    >>> damping = Flores(restitution=0.8, impact_speed=100.0)
    >>> friction = Friction(coefficient=0.05)
    >>> element = bs.ForceElement(bs.HessForsbach(), bs.joints["hip-28"], damping=damping, friction=friction)
    >>> load = element((0.0, 0.0, 0.12), velocity=(0.0, 0.0, 20.0), spin=(0.0, 1.0, 0.0))
    >>> [round(part, 1) for part in load.force[::2]], [round(part, 1) for part in load.moment]
    ([-40.6, -789.8], [0.0, -569.3, 0.0])
    """

    model: Model
    joint: Joint
    damping: Damping | None = None
    friction: Friction | Bristles | None = None
    cup: Cup | None = None
    smoothing: float = 0.0
    lubricant: Lubricant | None = None
    film_tension: float = inf
    relaxation: Prony | None = None
    potential: Potential = field(init=False, repr=False)
    constants: Constants = field(init=False, repr=False)

    def __post_init__(self) -> None:
        check_joint(self.joint)
        for name, kind in _PARTS.items():
            value = getattr(self, name)
            if not (isinstance(value, kind) or (value is None and name != "model")):
                raise TypeError(f"{name} must be a {getattr(kind, '__name__', kind)}, got {shown(value)}")
        if is_plain_number(self.joint.clearance) and self.joint.clearance < 0:
            raise ValueError(f"interference = {self.joint.interference:g}: a preloaded joint needs a PreloadedElement")
        smoothing = check_number("smoothing", self.smoothing)
        if not isinstance(self.model, AdhesiveSocket):
            potential = potential_of(self.model, self.joint)
        elif self.friction or self.cup or self.smoothing or self.lubricant or self.relaxation:
            raise TypeError("friction, cup, smoothing, lubricant and relaxation are not supported with AdhesiveSocket")
        else:
            potential = adhesion_potential(self.model, self.joint)
        if self.relaxation and (self.cup or self.smoothing):
            raise TypeError("cup and smoothing are not supported with relaxation")
        clearance = float(self.joint.clearance)
        valid = 0.0 <= smoothing <= clearance
        require("smoothing", smoothing, valid, f"it must be between 0 and the clearance, {clearance:g} mm")
        object.__setattr__(self, "potential", potential)
        object.__setattr__(self, "constants", self._collect_constants(smoothing))

    def __str__(self) -> str:
        parts = {name: getattr(self, name) for name in _PARTS if name != "model"}
        named = [f"{name} {type(part).__name__}" for name, part in parts.items() if part is not None]
        smoothing = [f"smoothing {self.smoothing:g} mm"] if self.smoothing else []
        return "; ".join([f"{self.model.name} on {self.joint.name or self.joint.dimensions}", *named, *smoothing])

    @cached_property
    def stretch(self) -> float:
        """Stretch u_c in mm of a spring at which an adhesive ball separates; 0 for other models."""
        return getattr(self.potential, "stretch", 0.0)

    @cached_property
    def internal_states(self) -> Mapping[str, int]:
        """Numbers of components of the internal states with rates: `deflection` of bristles, `relaxed_force`."""
        deflections = {"deflection": DEFLECTIONS} if isinstance(self.friction, Bristles) else {}
        return deflections | ({"relaxed_force": len(self.relaxation.terms)} if self.relaxation else {})

    @property
    def internal_state(self) -> str:
        """Note on the internal state of the contact (bristles, relaxation or adhesion); empty without one."""
        if self.stretch > 0.0:
            return "an adhesive ball has a state"
        return " and ".join(_STATE_NOTES[name] for name in self.internal_states)

    def _collect_constants(self, smoothing: float) -> Constants:
        joint, cup = self.joint.with_floats(), self.cup
        friction = self.friction if isinstance(self.friction, Friction) else None
        tension = check_number("film_tension", self.film_tension)
        require("film_tension", tension, tension > 0.0, "a tension (MPa) must be above 0")
        return Constants(
            ball_radius=joint.ball_radius,
            socket_radius=joint.socket_radius,
            clearance=joint.clearance - self.stretch,
            wall=min(joint.liner_thickness, joint.socket_radius, self.potential.deepest) + self.stretch,
            smoothing=smoothing,
            **loss_constants(self.damping, friction),
            rim=0.0 if cup is None else cup.rim,
            **dict(zip(("dome_x", "dome_y", "dome_z"), (Cup() if cup is None else cup).dome, strict=True)),
            **film_constants(self.lubricant, tension, joint),
        )

    def __call__(
        self,
        position: Any,
        velocity: Any = _ZERO_VECTOR,
        spin: Any = _ZERO_VECTOR,
        deflection: Any = _ZERO_DEFLECTION,
        attached: Any = False,
        relaxed_force: Any = None,
    ) -> Load:
        """Compute force, moment and energy at a state of the ball, with axes fixed to the socket.

        Parameters
        ----------
        position : (3,) or array (..., 3)
            Position of the ball centre relative to the socket centre in mm. Tuples and lists of numbers return tuples,
            which is fastest; arrays of any library, and lists of vectors, return arrays for all states at once.
        velocity : (3,) or array (..., 3)
            Velocity of the ball centre relative to the socket in mm/s.
        spin : (3,) or array (..., 3)
            Angular velocity of the ball relative to the socket in rad/s.
        deflection : (4,) or array (..., 4)
            Deflections of the bristles in mm: the integral of the `deflection_rate` of the load.
        attached : bool or array
            True for an adhesive ball that was attached: `attached` of the previous load.
        relaxed_force : (terms,) or array (..., terms)
            Relaxed forces of the liner in N: the integral of the `relaxed_force_rate` of the load. None, the default,
            is a liner that has not relaxed.

        Raises
        ------
        ValueError
            A vector without three components; an internal state with a wrong number of components.
        """
        if is_one_vector(position):
            motion = components(position), components(velocity), components(spin)
            load = self._load_of_numbers(*motion, attached, relaxed_force)
        else:
            load = self._load_of_arrays(position, velocity, spin, attached, relaxed_force)
        if not isinstance(self.friction, Bristles):
            return load
        with numpy.errstate(all="ignore"):
            return add_bristle_loads(load, self.friction, deflection)

    def _load_of_numbers(
        self, position: Vector, velocity: Vector, spin: Vector, attached: bool, relaxed_force: Any
    ) -> Load:
        constants = self.constants
        centre = ball_centre_at(*position, constants.clearance)
        is_adhesive = self.stretch > 0.0
        if is_adhesive:
            centre = self._centre_if_attached(centre, attached)
        is_free = centre.indentation <= -constants.smoothing and centre.distance > 0.0
        if is_free and constants.film_damping == 0.0 and self.relaxation is None:
            return Load(_ZERO_VECTOR, _ZERO_VECTOR, 0.0, self, centre, NO_CONTACT, position, velocity, spin)
        if centre.indentation > self.validity_monitor.limit:
            self.validity_monitor.check(centre.indentation)
        contact = elastic_contact(self.potential, centre, constants)
        if is_adhesive:
            contact = remove_tension_damping(contact)
        contact, liner = self._relax(contact, relaxed_force)
        fx, fy, fz, mx, my, mz = force_and_moment(centre, contact, velocity, spin, constants)
        force, moment = (fx, fy, fz), (mx, my, mz)
        return Load(force, moment, contact.energy, self, centre, contact, position, velocity, spin, **liner)

    def _load_of_arrays(self, position: Any, velocity: Any, spin: Any, attached: Any, relaxed_force: Any) -> Load:
        r, v, w = split_states(position, velocity, spin)
        with numpy.errstate(all="ignore"):  # states without a result have a status
            centre = self._centre_if_attached(ball_centre_at(*r, self.constants.clearance), attached)
            self.validity_monitor.check_array(centre.indentation)
            contact = elastic_contact(self.potential, centre, self.constants)
            contact = remove_tension_damping(contact) if self.stretch > 0.0 else contact
            contact, liner = self._relax(contact, relaxed_force, r[0])
            loads = force_and_moment(centre, contact, v, w, self.constants)
        force, moment = join_vector(object, *loads[:3]), join_vector(object, *loads[3:])
        return Load(force, moment, contact.energy, self, centre, contact, r, v, w, **liner)

    def _relax(self, contact: Elastic, relaxed_force: Any, like: Any = None) -> tuple[Elastic, dict[str, Any]]:
        """Return the contact of a relaxing liner, and its fields of the load; `like` is an array, None for numbers."""
        if self.relaxation is None:
            return contact, {}
        count = len(self.relaxation.terms)
        given = (0.0,) * count if relaxed_force is None else relaxed_force
        relaxed_forces = split_internal_state(given, count, like, f"a relaxing liner must have {count} relaxed forces")
        contact, rates = relaxed_contact(contact, relaxed_forces, self.relaxation)
        kind = tuple if like is None else object
        return contact, {"relaxed_forces": relaxed_forces, "relaxed_force_rate": join_vector(kind, *rates)}

    def relaxation_loss(self, load: Load) -> Array:
        """Compute the power in N mm/s that the relaxing liner dissipates; 0 for an elastic one.

        It is Σ g_i s_i' (d(E) - d(s_i)) with the indentation d(F) of the instantaneous law, see `relaxed_contact`.
        """
        if self.relaxation is None:
            return 0.0
        joint, terms = self.joint.with_floats(), self.relaxation.terms
        relaxed, rates = load.relaxed_forces, vector_components(load.relaxed_force_rate)
        forces = (relaxed[0] + terms[0][1] * rates[0], *relaxed)  # E and s_i; states without a load have no number
        depth, *depths = (self.model.press(joint, force=where(force > 0.0, force, 0.0)).indentation for force in forces)
        rows = zip(terms, rates, depths, strict=True)
        return sum((share * rate * (depth - relaxed_depth) for (share, _), rate, relaxed_depth in rows), 0.0)

    def _centre_if_attached(self, centre: BallCentre, attached: Any) -> BallCentre:
        """Return the ball centre; an adhesive ball that is not attached gets a negative indentation.

        Before first touch an adhesive ball has no contact unless it is attached.
        """
        if self.stretch == 0.0:
            return centre
        in_contact = attached | (centre.indentation >= self.stretch)
        return centre._replace(indentation=where(in_contact, centre.indentation, 0.0 * centre.indentation - 1.0))

    @property
    def wall(self) -> float:
        """Largest indentation in mm that the wall thickness and the model's range allow."""
        return self.constants.wall - self.stretch

    @cached_property
    def valid_depth(self) -> float:
        """Largest indentation in mm at which the model is valid; 0 if it is below a thousandth of the wall.

        Lower limits of the contact size are ignored: every contact passes through them at first touch.
        """
        depths = numpy.geomspace(1e-3 * self.wall, self.wall, _DEPTHS)
        valid = self.model.press(self.joint.with_floats(), indentation=depths).valid
        return float(max(depths[valid], default=0.0))

    @cached_property
    def validity_monitor(self) -> ValidityMonitor:
        """Monitor that logs a warning when an indentation leaves the validity of the model."""
        return ValidityMonitor(model=self.model, joint=self.joint.with_floats(), wall=self.wall)

    @cached_property
    def curves(self) -> tuple[OctaveCurve, OctaveCurve]:
        """Curves of half angle (rad) and largest pressure (MPa) over the indentation (mm)."""
        curve = joint_curve(self.model, self.joint.with_floats(), "indentation")
        return curve.select([1]), curve.select([2])

    def half_angle(self, indentation: Array) -> Array:
        """Compute the half angle of the contact in rad at an indentation in mm; 0 without contact."""
        return evaluate_curve(self.curves[0], indentation)

    def max_pressure(self, indentation: Array) -> Array:
        """Compute the largest contact pressure in MPa at an indentation in mm; 0 without contact."""
        return evaluate_curve(self.curves[1], indentation)


def is_one_vector(value: Any) -> bool:
    """Check if a value is a tuple or list of numbers; arrays, and lists of vectors, hold many vectors."""
    if type(value) not in _SEQUENCES:
        return False
    return not value or not (type(value[0]) in _SEQUENCES or getattr(value[0], "ndim", 0) > 0)


def components(value: Any, name: str = "a state") -> Vector:
    """Convert a vector to three numbers; raise ValueError for anything but three real numbers."""
    try:
        x, y, z = value
        if isinstance(x + y + z, complex):
            raise TypeError("complex numbers")
        if type(x) is _NUMPY_FLOAT:  # Python numbers are faster
            return float(x), float(y), float(z)
        return x + 0.0, y + 0.0, z + 0.0
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(
            f"{name} must have three components, x, y and z, all real numbers, got {shown(value)}"
        ) from error


def split_states(position: Any, velocity: Any, spin: Any) -> tuple[Vector, Vector, Vector]:
    """Split states of a ball, arrays (..., 3), into components in arrays of the position's library."""
    position = check_vectors("position", position, "x, y, z (mm)")
    vectors = [position]
    for name, axes, value in (("velocity", "x, y, z (mm/s)", velocity), ("spin", "x, y, z (rad/s)", spin)):
        if type(value) in _SEQUENCES:
            like = to_common_arrays(position)[0]
            value = arrays.namespace(like).asarray(value, dtype=like.dtype, device=arrays.device(like))
        vectors.append(check_vectors(name, value, axes))
    r, v, w = ((vector[..., 0], vector[..., 1], vector[..., 2]) for vector in to_common_arrays(*vectors))
    return r, v, w


def state_arguments(element: Any, state: Any) -> dict[str, Any]:
    """Split the motion and the internal states of an element by its arguments: a list, or an array (..., 9 + n)."""
    arguments, first = {}, 0
    for name, count in {"position": 3, "velocity": 3, "spin": 3, **element.internal_states}.items():
        part = slice(first, first + count)
        arguments[name] = state[part] if type(state) is list else state[..., part]
        first += count
    return arguments


def internal_rates(load: Any) -> list[float]:
    """List the rates of the internal states of a load at one state, in the order of `internal_states`."""
    return [rate for name in load.element.internal_states for rate in getattr(load, f"{name}_rate")]


def loss_constants(damping: Damping | None, friction: Friction | None) -> dict[str, float]:
    """Return the constants of damping and friction by their names in `Constants`; None has no losses."""
    damping = damping or Damping()
    friction = friction or Friction(coefficient=0.0)
    return {
        "hysteresis": damping.hysteresis,
        "time": damping.time,
        "sliding": friction.coefficient,
        "static": friction.breakaway_coefficient,
        "transition_speed": friction.transition_speed,
        "stribeck_speed": friction.stribeck_speed,
        "viscous": friction.viscous,
    }
