"""Base classes of models: `Model`, which presses a joint, `ModelWrapper` around another model, and `RimLimited`."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import lru_cache, partial
from operator import attrgetter
from typing import Any, ClassVar

import numpy

from ..core import arrays
from ..core.arrays import Array, where
from ..core.checks import check_vectors, reject_unnamed_loads, require
from ..core.validity import NON_NEGATIVE_CLEARANCE, NeverValid, Range, check_domain
from ..problem import Joint
from ..problem.cup import DEFAULT_CUP, UP, Cup, Direction, Interface
from .assembly import (
    SolverResult,
    as_arrays,
    broadcast_load,
    check_joint,
    make_contact,
    make_scalar_contact,
    select_and_check_load,
)
from .contact import Contact, Laws, PressModel
from .joint_curve import joint_curve, solve_by_curve
from .law import CurveLaw, ForceLaw

_PLAIN_TYPES = {float, int, numpy.float64}  # of the numbers of a press by Python floats


class Model(PressModel):
    """Base class of contact models: `press` computes the `Contact` of a joint under one load.

    Attributes that are equal for all instances of a model are class variables.

    Attributes
    ----------
    fits : tuple of Range
        Part of the domain that limits the fit of ball and socket: by default a clearance of 0 or more.
    off_axis : bool
        True if a press takes the direction of the load and of the cup: `tilt`, `inclination`, `anteversion`.
    differentiable : bool
        True if JAX can trace a press.
    smooth_step : float
        Relative step of finite differences that is larger than the noise of the results.
    seconds_a_press : float
        Approximate time of one point on one core in s; studies divide their work by it.
    contact_type : type
        Class of the result of `press`: `Contact` or a subclass.
    accepts_floats : bool
        True if the formulas take Python floats, which is faster than arrays of one element.
    has_curve : bool
        True if many loads on one joint are read from a curve through some hundred contacts, see `joint_curve`.
    """

    fits: ClassVar[tuple[Range, ...]] = (NON_NEGATIVE_CLEARANCE,)
    off_axis: ClassVar[bool] = False
    differentiable: ClassVar[bool] = True
    smooth_step: ClassVar[float] = 1e-4
    seconds_a_press: ClassVar[float] = 4e-7
    contact_type: ClassVar[type[Contact]] = Contact
    accepts_floats: ClassVar[bool] = False
    has_curve: ClassVar[bool] = False

    @property
    def domain(self) -> tuple[Range, ...]:
        """Open ranges outside of which the model has no formula."""
        return ()

    @property
    def further_quantities(self) -> tuple[str, ...]:
        """Names of quantities that only contacts of this model have."""
        return ()

    @property
    def parameters(self) -> tuple[Array, ...]:
        """Parameters of the model that may be arrays and broadcast with joint and load."""
        return ()

    def press(
        self,
        joint: Joint,
        *unnamed: Any,
        force: Array | None = None,
        indentation: Array | None = None,
        half_angle: Array | None = None,
    ) -> Contact:
        """Compute the contact of a joint under exactly one load: force, indentation or half angle.

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
            Contact of the shape that joint and load broadcast to, in their array library, dtype and device.

        Raises
        ------
        ValueError
            Not exactly one load; a load that is not allowed; no point inside the model's domain.
        TypeError
            A `joint` that is not a Joint; a load without its name.
        """
        reject_unnamed_loads(unnamed)
        check_joint(joint)
        kind, value = select_and_check_load(force=force, indentation=indentation, half_angle=half_angle)
        types = {*map(type, (*joint.numbers(), value))}
        if self.accepts_floats and types <= _PLAIN_TYPES and {*map(type, self.parameters)} <= {float, int}:
            contact = self._press_with_floats(joint, kind, float(value))
            if contact is not None:
                return contact
        value = broadcast_load(value, joint.strengths())
        is_plain, array_joint, load = as_arrays(joint, value, *self.parameters)
        points = check_domain((*self.fits, *self.domain), array_joint, self.name)
        with arrays.silent_numpy(load):  # a failed point gets a status, not a warning
            result = self._solve_by_curve(joint, kind, load) or self._solve(array_joint, kind, load)
            contact_joint = joint if is_plain else array_joint
            return make_contact(self, self.contact_type, contact_joint, kind, load, points, result, is_plain)

    def _press_with_floats(self, joint: Joint, kind: str, load: float) -> Contact | None:
        """Press by Python floats, which are faster than arrays; None where these are needed."""
        try:
            float_joint = _float_joint(self, joint)
        except TypeError:  # a strength is an array, or a field of the model has no hash
            return None
        if float_joint is None:
            return None
        try:
            result = self._solve(float_joint, kind, load)
            return make_scalar_contact(self, self.contact_type, joint, kind, load, result)
        except ArithmeticError:  # where Python floats raise, NumPy numbers become infinite or NaN
            return None

    def numpy_laws(self, joint: Joint, indentation: Array) -> Laws:
        _, array_joint, d = as_arrays(joint, indentation)
        with numpy.errstate(all="ignore"):
            return self._solve(array_joint, "indentation", d).laws

    @abstractmethod
    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        """Solve the contact of a joint under a load of one kind ("force", "indentation" or "half_angle").

        All numbers are arrays.

        If the model `accepts_floats`, all numbers may be Python floats instead, and the result has floats too.
        """

    def _solve_by_curve(self, joint: Joint, kind: str, load: Array) -> SolverResult | None:
        """Read the contacts of many loads on one joint from its curve; None if they must be solved."""
        return solve_by_curve(self, joint, kind, load) if self.has_curve else None

    def _solve_curve_points(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        """Solve the contacts that the curve of a joint interpolates; a model may have a faster solution for many."""
        return self._solve(joint, kind, load)

    def law(self, joint: Joint) -> ForceLaw:
        """Return a fast function of the indentation in mm: force in N and stiffness in N/mm, for time integration.

        Parameters
        ----------
        joint : Joint
            Joint of plain numbers.

        Returns
        -------
        ForceLaw
            `law(indentation)` is (force, stiffness) in N and N/mm, equal to those of a press. It is 0 below an
            indentation of 0 and NaN where a press has no result. Closed forms evaluate their formulas. Any other model
            has a curve through some hundred presses. The relative error of that curve is 1e-9 in the force and
            1e-7 in the stiffness above a millionth of the clearance. Below, it is a power of d; beyond the socket's
            radius, NaN.

        Raises
        ------
        TypeError
            A joint or model of arrays; a model whose forces are too noisy for a curve.
        ValueError
            A joint outside the model's domain.
        """
        if not all(map(arrays.is_plain_number, (*joint.numbers(), *self.parameters))):
            raise TypeError("a law needs one joint: the numbers of joint and model must be plain, not arrays")
        float_joint = joint.with_floats()
        check_domain((*self.fits, *self.domain), float_joint, self.name)
        return self._law(float_joint)

    def _law(self, joint: Joint) -> ForceLaw:
        """Return the force law (force and stiffness over indentation) of a joint of floats inside the domain."""
        return self.curve(joint)

    def curve(self, joint: Joint) -> CurveLaw:
        """Return the force law of the curve of a joint of floats, up to an indentation of one socket radius.

        Raises TypeError: a force at the beginning of the curve that is not above 0.
        """
        curve = joint_curve(self, joint, "indentation").select([0])
        if not curve(numpy.array([curve.low]))[0, 0] > 0.0:
            raise TypeError(f"no force law: the load at an indentation of {curve.low:.3g} mm must be above 0 N")
        return CurveLaw(curve=curve)

    def in_cup(self, cup: Cup, **aim: Any) -> Model:
        """Return a model for this joint in a cup with a rim.

        By default, its validity then ends near the rim (`RimLimited`).

        Parameters
        ----------
        cup : Cup
        **aim
            Direction of the load, upwards by default: `direction` in the body, or `tilt` from the cup's axis in rad.
            A model of a full sphere is loaded along its axis: the cup is tilted against the load.

        Raises
        ------
        OutsideDomainError
            A load at an angle to the axis of the cup, of a model with a rim for axial loads only.
        """
        if aim:
            cup, direction = cup.under_load(cup.load_tilt(**aim))
        else:
            direction = UP
        return self if cup == DEFAULT_CUP and direction == UP else RimLimited(model=self, cup=cup, direction=direction)

    def force_vector(self, joint: Joint, displacement: Array) -> Array:
        """Compute the force vector in N on the ball from the displacement of its centre in mm.

        Parameters
        ----------
        joint : Joint
        displacement : array (..., 3)
            Displacement in mm in any direction; within the clearance the force is zero.

        Returns
        -------
        array (..., 3)
            Force in N, towards the centre of the socket. The rim of the socket is not modelled.

        Raises
        ------
        ValueError
            A displacement whose last axis is not of length 3, or that is not finite.
        """
        displacement = check_vectors("displacement", displacement, "x, y, z (mm)")
        require("displacement", displacement, arrays.isfinite(displacement), "a displacement (mm) is finite")
        xp = arrays.namespace(displacement)
        squared_length = xp.sum(displacement * displacement, axis=-1)
        length = arrays.sqrt(arrays.safe_divisor(squared_length))
        depth = length - joint.clearance
        touching = (squared_length > 0) & (depth > 0)
        force = where(touching, self.press(joint, indentation=where(touching, depth, 0.0)).force, 0.0)
        return -displacement * (force / length)[..., None]


@lru_cache(maxsize=256)
def _float_joint(model: Model, joint: Joint) -> Joint | None:
    """Return a joint of plain numbers with floats, for a press that is faster than with arrays; from a cache.

    The result is None if a strength is an array.

    Raises OutsideDomainError: a joint outside the domain of the model.
    """
    if not all(map(arrays.is_plain_number, joint.strengths())):
        return None
    float_joint = joint.with_floats()
    check_domain((*model.fits, *model.domain), float_joint, model.name)
    return float_joint


_DECLARED = {name for base in Model.__mro__ for name in vars(base).get("__annotations__", {})}
_DECLARED |= {name for base in Model.__mro__ for name, value in vars(base).items() if isinstance(value, property)}

_Delegation: Any = type(
    "_Delegation", (), {name: property(attrgetter(f"model.{name}")) for name in _DECLARED - {"off_axis"}}
)
"""Class whose properties read every declared attribute of a model from `self.model`."""


@dataclass(frozen=True, kw_only=True)
class ModelWrapper(_Delegation, Model):
    """Base class of models that wrap another model: every attribute that it does not override is the wrapped one."""

    model: Model

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        return self.model._solve(joint, kind, load)

    def _law(self, joint: Joint) -> ForceLaw:
        return self.model._law(joint)


def bonded_liner(cup: Cup) -> tuple[Range, ...]:
    """Return the range of validity of a model whose liner is bonded to its backing: empty if it slides in the cup."""
    why = "the liner slides on its backing, but this model takes it as bonded: use fem, sphere, or in hips the cup"
    return (NeverValid(why=why),) if cup.interface is Interface.SLIDING else ()


@dataclass(frozen=True, kw_only=True)
class BondedLiner(ModelWrapper):
    """Model of a bonded liner in a cup, without limits by its rim."""

    cup: Cup

    @property
    def validity(self) -> tuple[Range, ...]:
        """Ranges of validity of the wrapped model, plus a bonded liner."""
        return (*self.model.validity, *bonded_liner(self.cup))


@dataclass(frozen=True, kw_only=True)
class RimLimited(ModelWrapper):
    """Model of a full sphere, used in a cup: its contact is valid only at a distance from the rim.

    `direction` is that of the force on the cup, in the body.
    """

    cup: Cup
    direction: Direction = UP

    @property
    def validity(self) -> tuple[Range, ...]:
        """Ranges of validity of the wrapped model, plus a bonded liner and a minimum distance from the rim.

        The rim must be one liner thickness or more away.
        """
        rim_range = Range(
            quantity=partial(relative_rim_distance, self.cup, self.direction),
            symbol="distance to the rim over L",
            low=1.0,
            why=_RIM,
        )
        return (*self.model.validity, rim_range, *bonded_liner(self.cup))

    def in_cup(self, cup: Cup, **aim: Any) -> Model:
        """Return the wrapped model for another cup."""
        return self.model.in_cup(cup, **aim)


_RIM = "the model takes the socket as a full sphere; near the rim, which is softer, use fem or sphere"


def relative_rim_distance(cup: Cup, direction: Direction, contact: Contact) -> Array:
    """Compute the distance from contact edge to rim, divided by the liner thickness.

    R2 replaces a larger thickness.

    At 1, the indentation is up to 2 % larger than in a full sphere and the largest pressure 1 % (ν 0.46); at 0.3,
    9 % and 4 %.
    """
    joint = contact.joint
    L, R2 = joint.liner_thickness, joint.socket_radius
    return cup.edge_distance(R2, contact.half_angle, direction) / where(L < R2, L, R2)
