"""The answer: what a load does to a joint, with its status and validity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from math import cos, inf, pi, sin
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Protocol

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.checks import check_numeric, check_vectors, degrees_hint, require
from ..core.kinds import Unit
from ..core.quantities import QUANTITIES
from ..core.validity import Range
from ..problem import Joint
from . import describe, strength
from .outcome import Answerer, Outcome

if TYPE_CHECKING:
    import pandas


class Pressed(Answerer, Protocol):
    """What a contact knows of the model that made it."""

    @property
    def planar(self) -> bool: ...
    def numpy_laws(self, joint: Joint, indentation: float) -> Laws: ...


class Laws(Protocol):
    """Where a contact's further quantities come from: a closed form bound to its joint, or what a solver found."""

    @property
    def half_angle(self) -> Array: ...
    @property
    def max_pressure(self) -> Array: ...
    @property
    def max_pressure_angle(self) -> Array: ...
    @property
    def pole_pressure(self) -> Array: ...
    @property
    def stiffness(self) -> Array: ...
    @property
    def energy(self) -> Array: ...
    @property
    def foundation_modulus(self) -> Array: ...
    @property
    def pressure_integral(self) -> Array: ...
    def pressure(self, angle: Array) -> Array: ...


def _law(name: str) -> Any:
    """A quantity of the contact, computed by the law of that name when it is first asked for."""

    def quantity(self: Contact) -> Array:
        return self._evaluate(law)

    law = attrgetter(name)

    said = QUANTITIES[name]
    quantity.__doc__ = f"{said.capital(Unit(''))} in {said.unit}. {said.meaning}"
    quantity.__name__ = name
    return cached_property(quantity)


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class Contact(Outcome):
    """What `model.press(joint, ...)` answers. Every quantity has the shape that joint and load broadcast to.

    Points without an answer are NaN and have a `status` other than `Status.OK`; points whose joint or answer lies
    outside the model's `validity` keep their numbers and have `valid` false. `notes` says both in words.

    Attributes
    ----------
    force, indentation : float or array
        Axial load F in N; approach d of the centres from first touch in mm.
    status : Status or array of int
        How the press ended, point by point.
    model, joint
        What answered, and what was pressed.
    laws
        Where the further quantities come from: a closed form bound to its joint and indentation, or a solution.
    """

    model: Pressed
    laws: Laws
    force: Array
    indentation: Array

    half_angle = _law("half_angle")
    max_pressure = _law("max_pressure")
    max_pressure_angle = _law("max_pressure_angle")
    pole_pressure = _law("pole_pressure")
    stiffness = _law("stiffness")
    energy = _law("energy")
    foundation_modulus = _law("foundation_modulus")
    pressure_integral = _law("pressure_integral")

    @property
    def _load(self) -> Array:
        return self.indentation

    @cached_property
    def von_mises(self) -> Array:
        """Largest von Mises stress in the liner in MPa.

        A share of the largest pressure that is fitted to the exact answer for liners on a rigid backing, typically 6 %
        off (`strength.share`); models that know the inside of the socket say what is there.
        """
        return self._mask_failed(self._compute_von_mises)

    @cached_property
    def utilisation(self) -> Array:
        """Largest von Mises stress over yield stress, of liner or ball, whichever is more; NaN where none is known.

        From 1 on the material yields somewhere; a linear answer is not valid beyond 1.38 (`strength.ELASTIC`).
        """
        known = any(part is not None and part.yield_stress is not None for part in (self.joint.liner, self.joint.ball))
        return self._compute_utilisation(self.von_mises if known else self.max_pressure)

    def utilisation_at(self, asked: Array) -> Array:
        """`utilisation`, at the least where it is asked for (a mask): for models that take long to know it."""
        return self.utilisation

    def _compute_utilisation(self, von_mises: Array) -> Array:
        return self._match_load(strength.utilisation(self.joint, von_mises, self.max_pressure))

    @property
    def von_mises_bounds(self) -> tuple[Array, Array]:
        """What `von_mises` lies between, as far as that is known at once."""
        return self.von_mises, self.von_mises

    @property
    def utilisation_bounds(self) -> tuple[Array, Array]:
        """What `utilisation` lies between, as far as that is known at once."""
        least, most = self.von_mises_bounds
        pressure = self.max_pressure
        return strength.utilisation(self.joint, least, pressure), strength.utilisation(self.joint, most, pressure)

    def _compute_von_mises(self) -> Array:
        liner = self.joint.liner
        return strength.von_mises_ratio(self.half_angle, liner.poisson, self.joint.thickness_ratio) * self.max_pressure

    @property
    def _limits(self) -> tuple[Range, ...]:
        return (*self.model.validity, _ELASTIC) if self.joint.strengths() else self.model.validity

    @property
    def notes(self) -> tuple[str, ...]:
        """What has no answer, what lies outside the model's validity, and what a material does not bear, in words."""
        unchecked = (
            [self.utilisation_note] if self.utilisation_note and arrays.all_true(self._failed) is not True else []
        )
        compared = (note for good, said in strength.remarks(self) for note in self._note(good | self._failed, said))
        return (*super().notes, *unchecked, *compared)

    @property
    def utilisation_note(self) -> str:
        """Reason why `utilisation` does not cover the liner; empty where the liner has a yield stress."""
        return strength.unchecked_strength_reason(self.joint)

    @cached_property
    def area(self) -> Array:
        """Contact area on the ball, A = 2π R1² (1 - cos ε) in mm², Eq. (19)."""
        half_sine = arrays.sin(arrays.clip(self.half_angle, 0.0, pi) / 2)
        with numpy.errstate(all="ignore"):
            return self._match_load(4 * pi * self.joint.ball_radius * self.joint.ball_radius * half_sine * half_sine)

    @property
    def indentation_ratio(self) -> Array:
        """Indentation over liner thickness, d/L."""
        return self.indentation / self.joint.liner_thickness

    @property
    def depth_ratio(self) -> Array:
        """Indentation over liner thickness or socket radius, whichever is less, which is how large strains are."""
        R2, L = self.joint.socket_radius, self.joint.liner_thickness
        return self.indentation / arrays.where(L < R2, L, R2)

    @property
    def width_ratio(self) -> Array:
        """Contact radius over liner thickness, R2 sin ε / L."""
        return arrays.sin(self.half_angle) * self.joint.thickness_ratio

    @property
    def conformity(self) -> Array:
        """Clearance over indentation, c/d; 0 is a ball of the socket's own radius."""
        quotient = self.joint.clearance / arrays.safe_divisor(self.indentation)
        return self._match_load(arrays.where(self.indentation == 0, numpy.inf, quotient))

    def pressure(self, angle: Array) -> Array:
        """Contact pressure in MPa at polar angles from the load axis; 0 outside the contact.

        Parameters
        ----------
        angle : float or array
            In rad; broadcasts against the contact's shape. For a profile of each of many contacts give it a leading
            axis, `contact.pressure(angle[:, None])`.

        Returns
        -------
        float or array
            Of the shape that angle and contact broadcast to.

        Raises
        ------
        ValueError
            An angle of more than half a turn: degrees are no radians.
        TypeError
            What is neither a number nor an array.
        """
        angle = check_numeric("angle", angle)
        QUANTITIES["angle"].checked(
            arrays.where(angle == angle, angle, 0.0)
        )  # where there is no edge angles are missing
        if self._is_plain and arrays.is_plain(angle):
            return self._evaluate(lambda laws: laws.pressure(float(angle)))
        _, angle = arrays.to_common_arrays(self.indentation, angle)
        return self._evaluate(lambda laws: laws.pressure(angle))

    def pressure_at(self, direction: Array) -> Array:
        """Contact pressure in MPa where a ray from the centre of the socket meets its surface; 0 outside the contact.

        Parameters
        ----------
        direction : array (..., 3)
            Unit vectors x, y, z; z is the axis of the load and points to the pole. Their leading axes broadcast
            against the contact's shape as those of the angles of `pressure` do.

        Returns
        -------
        float or array
            Of the shape that directions and contact broadcast to.

        Raises
        ------
        ValueError
            A direction whose last axis is not of length 3, or that is not of length 1.
        """
        direction = check_vectors("direction", direction, "x, y, z of a unit vector")
        x, y, z = (direction[..., i] for i in range(3))
        across = arrays.sqrt(x * x + y * y)
        length = across * across + z * z
        require("direction", length, (length - 1) ** 2 < _UNIT, "a direction is a unit vector, x² + y² + z² = 1")
        return self.pressure(arrays.atan2(across, z))

    def friction_torque(self, coefficient: Array, axis_angle: float = pi / 2) -> Array:
        """Torque in N mm about an axis through the centre of the ball, sliding everywhere with Coulomb friction.

        Parameters
        ----------
        coefficient : float or array
            Coefficient of friction, zero or more.
        axis_angle : float
            Angle (rad) between the axis of rotation and the load: π/2 is flexion under an axial load, 0 is spin
            about the load axis.

        Returns
        -------
        float or array
            μ R1 ∫ p sin(angle between axis and radius) dA over the spherical contact, or the flat circle of a planar
            model: at most μ R1 times `pressure_integral`.

        Raises
        ------
        ValueError
            A coefficient that is negative or not finite; an angle of more than a turn.
        TypeError
            What is neither a number nor an array.
        """
        coefficient = check_numeric("coefficient", coefficient)
        allowed = "a coefficient of friction is 0 or more and finite"
        require("coefficient", coefficient, (coefficient >= 0) & (coefficient < inf), allowed)

        require("axis_angle", axis_angle, abs(axis_angle) <= 2 * pi, f"it is in radians; {degrees_hint(axis_angle)}")

        def ring(x: float) -> Array:
            angle = self.half_angle * sin(pi / 2 * x)  # tames a square root at the edge
            width = self.half_angle * (pi / 2 * cos(pi / 2 * x))
            arc = angle if self.model.planar else arrays.sin(angle)
            return self.pressure(angle) * _mean_lever(angle, axis_angle) * arc * width

        R2 = self.joint.socket_radius
        lever = coefficient * self.joint.ball_radius
        return self._match_load(lever * 2 * pi * R2 * R2 * arrays.integral(ring, 24))

    def _evaluate(self, law: Callable[[Laws], Array]) -> Array:
        """What a law says, in NumPy's numbers where Python's raise."""

        def value() -> Array:
            try:
                return law(self.laws)
            except ArithmeticError:
                return law(self.model.numpy_laws(self.joint, self.indentation))

        return self._mask_failed(value)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON in N, mm, MPa and degrees; arrays become (nested) lists, a missing number None."""
        return describe.summary(self)

    def to_dict(self) -> dict[str, Any]:
        """The contact as a dictionary, which is its `summary()`."""
        return self.summary()

    def to_frame(self) -> pandas.DataFrame:
        """A row a point; the names of the columns end in their units, "max_pressure_MPa", "half_angle_deg".

        Raises
        ------
        ImportError
            pandas is not installed.
        """
        return describe.frame(self)

    def plot(self) -> Any:
        """The pressure over the angle beside the force over the indentation, of a single contact.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        ValueError
            More than one contact, or one that has no answer.
        """
        # pictures are made floors above, where contacts are known: looked up when they are asked for, never imported
        return import_module("ballsocket.output.quick_plot").plot({self.model.name: self})

    def __repr__(self) -> str:
        return describe.text(self)

    def _repr_html_(self) -> str:
        return describe.html(self)


_ELASTIC = strength.ElasticLimit()

_UNIT = 1e-10  # square of how far the square of a unit vector may miss 1


def _mean_lever(angle: Array, axis_angle: float) -> Array:
    """Mean over the circle at polar `angle` of the sine between the radius and an axis at `axis_angle`."""
    turns = [pi * (k + 0.5) / 64 for k in range(64)]
    polar, across = arrays.cos(angle) * float(numpy.cos(axis_angle)), arrays.sin(angle) * float(numpy.sin(axis_angle))
    sines = [arrays.sqrt(arrays.clip(1 - (polar + across * float(numpy.cos(turn))) ** 2, 0.0, 1.0)) for turn in turns]
    return arrays.weighted_sum(sines, [1 / 64] * 64)
