"""What a model is: a frozen value that answers to `press`, from a few short laws; and one model around another."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Any, ClassVar

import numpy

from ..core import arrays
from ..core.arrays import Array, where
from ..core.checks import check_vectors, reject_unnamed_loads, require
from ..core.validity import NON_NEGATIVE_CLEARANCE, NeverValid, Range, check_domain
from ..problem import Joint
from ..problem.cup import Cup, Interface
from .assembly import (
    SolverResult,
    as_arrays,
    broadcast_load,
    check_joint,
    check_load,
    make_contact,
    make_scalar_contact,
)
from .contact import Contact, Laws
from .law import CurveLaw, ForceLaw, curve_law
from .model_info import ModelInfo


class Model(ModelInfo):
    """Anything that answers `press(joint, force=... | indentation=... | half_angle=...)` with a `Contact`.

    Most of what follows is the same for every value of a kind of model, and then a class variable.

    Attributes
    ----------
    domain : tuple of Range
        Open ranges outside of which there is no formula.
    planar : bool
        Whether the contact is a flat circle, whose pressure has one direction; otherwise it acts along the radius.
    fits : tuple of Range
        As the domain, of how ball and socket fit: without interference, except where a model knows better.
    parameters : tuple of array
        Numbers of the model's own that may be arrays and broadcast against joint and load.
    off_axis : bool
        Whether a press takes where the load points and where the cup faces: `tilt`, `inclination`, `anteversion`.
    differentiable : bool
        Whether JAX can trace a press.
    smooth_step : float
        A share of a number over which answers change by more than they are uncertain: for differences.
    seconds_a_press : float
        Roughly, for one of many points on one core: studies cut their work by it.
    contact_type : type
        What `press` answers with: `Contact`, or a kind of it that knows more.
    of_numbers : bool
        Whether the formulas take Python numbers as they are, which is quicker than arrays of one.
    """

    planar: ClassVar[bool] = False
    fits: ClassVar[tuple[Range, ...]] = (NON_NEGATIVE_CLEARANCE,)
    off_axis: ClassVar[bool] = False
    differentiable: ClassVar[bool] = True
    smooth_step: ClassVar[float] = 1e-4
    seconds_a_press: ClassVar[float] = 4e-7
    contact_type: ClassVar[type[Contact]] = Contact
    accepts_floats: ClassVar[bool] = False

    @property
    def domain(self) -> tuple[Range, ...]:
        return ()

    @property
    def parameters(self) -> tuple[Array, ...]:
        return ()

    def press(
        self,
        joint: Joint,
        *unnamed: Any,
        force: Array | None = None,
        indentation: Array | None = None,
        half_angle: Array | None = None,
    ) -> Contact:
        """Press the ball into the socket by exactly one of three loads.

        Parameters
        ----------
        joint : Joint
        force : float or array, optional
            Axial load in N, zero or more, finite.
        indentation : float or array, optional
            Approach of the centres from first touch in mm, zero or more, finite.
        half_angle : float or array, optional
            Contact half-angle in rad, from 0 to below π/2.

        Returns
        -------
        Contact
            Of the shape that joint and load broadcast to, in their array library, dtype and device.

        Raises
        ------
        ValueError
            Not exactly one load; a load that is not allowed; no point at all inside the model's domain.
        TypeError
            What is no joint; a load without its name.
        """
        reject_unnamed_loads(unnamed)
        check_joint(joint)
        kind, given = check_load(force=force, indentation=indentation, half_angle=half_angle)
        given = broadcast_load(given, joint.strengths())
        if self._takes_numbers(joint, given):
            try:
                return self._press_numbers(joint, kind, float(given))
            except ArithmeticError:
                pass  # where Python's numbers raise, NumPy's become infinite or NaN
        plain, whole, load = as_arrays(joint, given, *self.parameters)
        points = check_domain((*self.fits, *self.domain), whole, self.name)
        with numpy.errstate(all="ignore"):  # a point without an answer becomes a status, not a warning
            answer = self._solve(whole, kind, load)
            return make_contact(self, joint if plain else whole, kind, load, points, answer, plain)

    def _takes_numbers(self, joint: Joint, load: Array) -> bool:
        """Whether these are Python numbers, or such as can be made them, and the model has formulas for those."""
        own = (type(number) in (float, int) for number in self.parameters)
        return self.accepts_floats and all(map(arrays.is_plain, (*joint.numbers(), load))) and all(own)

    def _press_numbers(self, joint: Joint, kind: str, load: float) -> Contact:
        """`press` with nothing but Python numbers."""
        whole = joint.with_floats()
        check_domain((*self.fits, *self.domain), whole, self.name)
        return make_scalar_contact(self, joint, kind, load, self._solve(whole, kind, load))

    def numpy_laws(self, joint: Joint, indentation: float) -> Laws:
        """The laws of a contact of Python numbers in those of NumPy, which become infinite or NaN where those raise."""
        _, whole, d = as_arrays(joint, indentation)
        with numpy.errstate(all="ignore"):
            return self._solve(whole, "indentation", d).laws

    @abstractmethod
    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        """The answer to a load of one kind ("force", "indentation", "half_angle"), all numbers being arrays.

        Where the model is one `of_numbers` they may all be Python numbers instead, and then so is the answer.
        """

    def law(self, joint: Joint) -> ForceLaw:
        """Force and tangent of a joint, bound to it once: for programs that ask at one indentation after the other.

        Parameters
        ----------
        joint : Joint
            Of plain numbers.

        Returns
        -------
        Law
            `law(indentation)` is (force, stiffness) in N and N/mm, as a press has them; 0 below an indentation of 0,
            NaN where a press has no answer. A closed form says its formulas. Any other model says a curve in ln d that
            was put through some hundred of its presses, which is what binding costs: with a relative error of 1e-9 in
            the force and 1e-7 in the stiffness from a millionth of the clearance on, a power of d below, and NaN
            beyond the socket's radius.

        Raises
        ------
        TypeError
            Arrays; a model that is too noisy for a curve.
        ValueError
            A joint outside the model's domain.
        """
        if not all(map(arrays.is_plain, (*joint.numbers(), *self.parameters))):
            raise TypeError("a law is bound to one joint: its numbers, and those of the model, must be plain")
        whole = joint.with_floats()
        check_domain((*self.fits, *self.domain), whole, self.name)
        return self._law(whole)

    def _law(self, joint: Joint) -> ForceLaw:
        """The law of a joint of floats inside the domain."""
        return self.curve(joint)

    def curve(self, joint: Joint) -> CurveLaw:
        """The law of a joint as a curve through its presses, up to an indentation of the socket's radius."""
        shallowest = 1e-6 * (joint.clearance or joint.socket_radius)
        return curve_law(lambda d: self.press(joint, indentation=d).force, shallowest, joint.socket_radius)

    def in_cup(self, cup: Cup) -> Model:
        """This model in a cup; one that takes the socket for a whole sphere is trusted away from the rim alone."""
        return self if cup == Cup() else RimLimited(model=self, cup=cup)

    def force_vector(self, joint: Joint, displacement: Array) -> Array:
        """Force in N on the ball when its centre sits at `displacement` (mm) from the centre of the socket.

        Parameters
        ----------
        joint : Joint
        displacement : array (..., 3)
            Any direction; within the clearance nothing touches and the force is zero.

        Returns
        -------
        array (..., 3)
            Points back to the centre of the socket. The rim of the socket is not part of the model.

        Raises
        ------
        ValueError
            A displacement whose last axis is not of length 3, or that is not finite.
        """
        displacement = check_vectors("displacement", displacement, "x, y, z (mm)")
        require("displacement", displacement, arrays.isfinite(displacement), "a displacement (mm) is finite")
        xp = arrays.namespace(displacement)
        square = xp.sum(displacement * displacement, axis=-1)
        length = arrays.sqrt(arrays.safe_divisor(square))
        depth = length - joint.clearance
        touching = (square > 0) & (depth > 0)
        force = where(touching, self.press(joint, indentation=where(touching, depth, 0.0)).force, 0.0)
        return -displacement * (force / length)[..., None]


def _passed_on(name: str) -> Any:
    """What the wrapped model says of itself."""
    return property(attrgetter(f"model.{name}"))


@dataclass(frozen=True, kw_only=True)
class ModelWrapper(Model):
    """A model around another: whatever it does not say itself is what that one says.

    Parameters
    ----------
    model : Model
    """

    model: Model

    name = _passed_on("name")
    title = _passed_on("title")
    sources = _passed_on("sources")
    fits = _passed_on("fits")
    domain = _passed_on("domain")
    validity = _passed_on("validity")
    promise = _passed_on("promise")
    remarks = _passed_on("remarks")
    reach = _passed_on("reach")
    parameters = _passed_on("parameters")
    planar = _passed_on("planar")
    differentiable = _passed_on("differentiable")
    smooth_step = _passed_on("smooth_step")
    seconds_a_press = _passed_on("seconds_a_press")
    contact_type = _passed_on("contact_type")
    of_numbers = _passed_on("of_numbers")

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        return self.model._solve(joint, kind, load)

    def _law(self, joint: Joint) -> ForceLaw:
        return self.model._law(joint)


@dataclass(frozen=True, kw_only=True)
class RimLimited(ModelWrapper):
    """A model in a cup that it knows nothing of: its own answers, with a validity that ends before the rim.

    Parameters
    ----------
    model : Model
    cup : Cup
        Pressed by a force that points upwards in its frame.
    """

    cup: Cup

    @property
    def validity(self) -> tuple[Range, ...]:
        rim = Range(quantity=partial(_from_rim, self.cup), symbol="distance to the rim over L", low=1.0, why=_RIM)
        slides = NeverValid(why="the liner slides on its backing, which this model knows as bonded: ask fem or sphere")
        return (*self.model.validity, rim, *((slides,) if self.cup.interface is Interface.SLIDING else ()))

    def in_cup(self, cup: Cup) -> Model:
        return self.model.in_cup(cup)


_RIM = "the model takes the socket for a whole sphere; near the rim, which gives way, ask fem or sphere"


def _from_rim(cup: Cup, contact: Contact) -> Array:
    """The arc from the edge of a contact to the rim over the liner's thickness, or a massive socket's radius.

    At 1, d is up to 2 % more than in a whole sphere and the largest pressure 1 % (ν 0.46), at 0.3 they are 9 and 4 %.
    """
    joint = contact.joint
    L, R2 = joint.liner_thickness, joint.socket_radius
    return cup.edge_distance(R2, contact.half_angle) / where(L < R2, L, R2)
