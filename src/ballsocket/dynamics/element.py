"""The force element: a model, a joint, what it loses, bound once and asked at one state after the other."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy

from ..contact import Model
from ..contact.assembly import check_joint
from ..contact.law import CurveLaw, curve_law
from ..core import arrays
from ..core.arrays import Array, to_common_arrays, where
from ..core.checks import check_number, check_vectors, require, shown
from ..models.adhesion import AdhesiveSocket
from ..problem import Joint
from ..problem.cup import Cup
from .bristles import Bristles
from .damping import Damping
from .friction import Friction
from .load import Load, brushed
from .matrices import vector
from .potential import Potential, potential_of, slopes_of_array
from .reaction import APART, Constants, Place, Three, elastic, place_of, reaction
from .sticking import sticking_potential, undamped_pull
from .watch import Watch

_REST = (0.0, 0.0, 0.0)
_UNBENT = (0.0, 0.0, 0.0, 0.0)
_LISTS = (tuple, list)
_OF_NUMPY = numpy.float64


@dataclass(frozen=True, eq=False)
class ForceElement:
    """A ball joint as a force element for programs that step through time.

    Parameters
    ----------
    model : Model
        Any that has a law: closed forms, `Tabulated`, `Refined`, `Exact`, ...
    joint : Joint
        Of plain numbers.
    damping : Damping, optional
        `Flores(restitution=..., impact_speed=...)` and its kin, or `Damping(...)`. None, the default, loses nothing.
    friction : Friction or Bristles, optional
        Bristles have a state, which is asked and answered with the rest. None, the default, rubs nowhere.
    cup : Cup, optional
        With a rim, over which the force dies out. None, the default, is a whole sphere.
    smoothing : float
        In mm: the touch-down is rounded off over this depth on both sides of first touch, so that the force is twice
        continuously differentiable, as optimal control needs it. 0, the default, is the model's own law.

    Raises
    ------
    ValueError
        A joint outside the model's domain; a smoothing that is negative, or wider than the clearance.
    TypeError
        A model without a law, arrays in the joint, or what is no damping, friction or cup.

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
    potential: Potential = field(init=False, repr=False)
    constants: Constants = field(init=False, repr=False)

    def __post_init__(self) -> None:
        check_joint(self.joint)
        for name, kind in (("model", Model), ("damping", Damping), ("friction", Friction | Bristles), ("cup", Cup)):
            given = getattr(self, name)
            if not (isinstance(given, kind) or (given is None and name != "model")):
                raise TypeError(f"{name} must be a {getattr(kind, '__name__', kind)}, got {shown(given)}")
        smoothing = check_number("smoothing", self.smoothing)
        potential = self._potential()
        clearance = float(self.joint.clearance)
        good = 0.0 <= smoothing <= clearance
        require("smoothing", smoothing, good, f"it is 0 or more, and at most the clearance, {clearance:g} mm")
        object.__setattr__(self, "potential", potential)
        object.__setattr__(self, "constants", self._constants(smoothing))

    def _potential(self) -> Potential:
        if not isinstance(self.model, AdhesiveSocket):
            return potential_of(self.model, self.joint)
        if self.friction or self.cup or self.smoothing:
            raise TypeError("an adhesive socket takes a damping, but no friction, cup or smoothing: nobody knows those")
        return sticking_potential(self.model, self.joint)

    @cached_property
    def stretch(self) -> float:
        """How far a ball that sticks is pulled back before it is free, in mm: u_c; 0 for all other models."""
        return getattr(self.potential, "stretch", 0.0)

    @property
    def remembers(self) -> str:
        """What of the contact has a state of its own, in words; empty where nothing does."""
        if isinstance(self.friction, Bristles):
            return "bristles have a state"
        return "a ball that sticks has a state" if self.stretch > 0.0 else ""

    def _constants(self, smoothing: float) -> Constants:
        joint, cup = self.joint.with_floats(), self.cup
        damping = self.damping or Damping()
        friction = self.friction if isinstance(self.friction, Friction) else Friction(coefficient=0.0)
        return Constants(
            ball_radius=joint.ball_radius,
            socket_radius=joint.socket_radius,
            clearance=joint.clearance - self.stretch,
            wall=min(joint.liner_thickness, joint.socket_radius, self.potential.deepest) + self.stretch,
            smoothing=smoothing,
            hysteresis=damping.hysteresis,
            time=damping.time,
            sliding=friction.coefficient,
            static=friction.static,
            transition_speed=friction.transition_speed,
            stribeck_speed=friction.stribeck_speed,
            viscous=friction.viscous,
            rim=0.0 if cup is None else cup.rim,
            **dict(zip(("dome_x", "dome_y", "dome_z"), (Cup() if cup is None else cup).dome, strict=True)),
        )

    def __call__(
        self,
        position: Any,
        velocity: Any = _REST,
        spin: Any = _REST,
        deflection: Any = _UNBENT,
        attached: Any = False,
    ) -> Load:
        """The load at a state, in axes that are fixed to the socket.

        Parameters
        ----------
        position : (3,) or array (..., 3)
            Of the ball's centre from the socket's, in mm. Tuples and lists of numbers are answered in tuples, and
            quickest; arrays of any library in arrays, all states at once.
        velocity : (3,) or array (..., 3)
            Of the ball's centre as it is seen from the socket, in mm/s.
        spin : (3,) or array (..., 3)
            Angular velocity of the ball less that of the socket, in rad/s.
        deflection : (4,) or array (..., 4)
            Of the bristles in mm, where the friction has such: the integral of the load's `deflection_rate`.
        attached : bool or array
            Whether a ball that sticks already did: the `attached` of the load before.

        Raises
        ------
        ValueError
            What does not have three components.
        """
        if type(position) in _LISTS:
            load = self._of_numbers(three(position), three(velocity), three(spin), attached)
        else:
            load = self._of_arrays(position, velocity, spin, attached)
        if not isinstance(self.friction, Bristles):
            return load
        with numpy.errstate(all="ignore"):
            return brushed(load, self.friction, deflection)

    def _of_numbers(self, position: Three, velocity: Three, spin: Three, attached: bool) -> Load:
        given = self.constants
        place = place_of(*position, given.clearance)
        sticks = self.stretch > 0.0
        if sticks:
            place = self._held(place, attached)
        if place.indentation <= -given.smoothing and place.distance > 0.0:
            return Load(_REST, _REST, 0.0, self, place, APART, position, velocity, spin)
        if place.indentation > self._watch.limit:
            self._watch.at(place.indentation)
        contact = elastic(self.potential, place, given)
        if sticks:
            contact = undamped_pull(contact)
        fx, fy, fz, mx, my, mz = reaction(place, contact, velocity, spin, given)
        return Load((fx, fy, fz), (mx, my, mz), contact.energy, self, place, contact, position, velocity, spin)

    def _of_arrays(self, position: Any, velocity: Any, spin: Any, attached: Any) -> Load:
        names = ("position", "velocity", "spin")
        axes = ("x, y, z (mm)", "x, y, z (mm/s)", "x, y, z (rad/s)")
        position = check_vectors("position", position, axes[0])
        checked = map(check_vectors, names, [_beside(position, each) for each in (position, velocity, spin)], axes)
        r, v, w = (_components(each) for each in to_common_arrays(*checked))
        with numpy.errstate(all="ignore"):  # a state without an answer has a status
            place = self._held(place_of(*r, self.constants.clearance), attached)
            self._watch.look(place.indentation)
            contact = elastic(self.potential, place, self.constants)
            contact = undamped_pull(contact) if self.stretch > 0.0 else contact
            parts = reaction(place, contact, v, w, self.constants)
        force, moment = vector(object, *parts[:3]), vector(object, *parts[3:])
        return Load(force, moment, contact.energy, self, place, contact, r, v, w)

    def _held(self, place: Place, attached: Any) -> Place:
        """The place of a ball that sticks: apart before first touch, unless it is attached."""
        if self.stretch == 0.0:
            return place
        held = attached | (place.indentation >= self.stretch)
        return place._replace(indentation=where(held, place.indentation, 0.0 * place.indentation - 1.0))

    @property
    def wall(self) -> float:
        """The deepest indentation that the socket's wall and the model leave room for, in mm."""
        return self.constants.wall - self.stretch

    @cached_property
    def _watch(self) -> Watch:
        return Watch(model=self.model, joint=self.joint.with_floats(), wall=self.wall)

    @cached_property
    def curves(self) -> tuple[CurveLaw, CurveLaw]:
        """Half angle (rad) and largest pressure (MPa) over the indentation, as curves of ln over ln."""
        return _curve_of(self.model, self.joint, "half_angle"), _curve_of(self.model, self.joint, "max_pressure")

    def half_angle(self, indentation: Array) -> Array:
        """ε in rad of an indentation in mm; 0 where nothing touches."""
        return _read(self.curves[0], indentation)

    def max_pressure(self, indentation: Array) -> Array:
        """In MPa of an indentation in mm; 0 where nothing touches."""
        return _read(self.curves[1], indentation)


def three(value: Any, name: str = "a state") -> Three:
    try:
        x, y, z = value
        if isinstance(x + y + z, complex):
            raise TypeError("complex numbers")
        if type(x) is _OF_NUMPY:  # numbers of Python are quicker
            return float(x), float(y), float(z)
        return x + 0.0, y + 0.0, z + 0.0
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"{name} has three components, x, y and z, all real numbers, got {shown(value)}") from error


def _beside(position: Any, value: Any) -> Any:
    """A list as an array of the position's library."""
    if type(value) not in _LISTS:
        return value
    place = to_common_arrays(position)[0]
    return arrays.namespace(place).asarray(value, dtype=place.dtype, device=arrays.device(place))


def _components(value: Any) -> Three:
    return value[..., 0], value[..., 1], value[..., 2]


def _curve_of(model: Model, joint: Joint, quantity: str) -> CurveLaw:
    """A quantity of a contact over the indentation, up to the socket's radius."""
    whole = joint.with_floats()
    shallowest = 1e-6 * (whole.clearance or whole.socket_radius)
    return curve_law(
        lambda depths: getattr(model.press(whole, indentation=depths), quantity), shallowest, whole.socket_radius
    )


def _read(curve: CurveLaw, indentation: Array) -> Array:
    """The curve at indentations of any sign: 0 where nothing touches, NaN beyond its end."""
    if type(indentation) is float:
        return curve(indentation)[0]
    ends = curve.shallowest, curve.deepest, curve.first, curve.density
    return where(indentation > 0.0, slopes_of_array(indentation, *ends, curve.pieces)[0], 0.0)
