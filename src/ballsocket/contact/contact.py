"""Result of a press: force, indentation and every other quantity of a contact, with status and validity."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import cos, inf, pi, sin
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.bounded import Bounded
from ..core.checks import check_numeric, check_vectors, degrees_hint, require, shown
from ..core.display import load_plot
from ..core.kinds import Unit
from ..core.lazy import cached_property
from ..core.quantities import QUANTITIES
from ..core.validity import Range
from ..problem import Joint
from . import describe, strength
from .outcome import Finding, ModelInfo, Outcome
from .stress_ratio import von_mises_ratio

if TYPE_CHECKING:
    import pandas


class Laws(Protocol):
    """Interface of the formulas or the solution of a contact: quantities beyond force and indentation.

    Closed forms bound to the joint, and numerical solutions, have these attributes.
    """

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


class PressModel(ModelInfo):
    """Base class of models whose result is a `Contact`."""

    @abstractmethod
    def numpy_laws(self, joint: Joint, indentation: Array) -> Laws:
        """Solve a contact at an indentation in mm with NumPy numbers, and return its formulas or solution.

        These become infinite or NaN where Python floats raise ArithmeticError.
        """


def _quantity_property(name: str) -> Any:
    """Make a cached property of `Contact` that evaluates one quantity of its laws."""

    def compute_quantity(self: Contact) -> Array:
        """Compute the quantity and set failed points to NaN."""
        return self._evaluate(read_quantity)

    def read_quantity(laws: Laws) -> Array:
        """Read the quantity of formulas or a solution; `torch.compile` does not trace an `attrgetter`."""
        return getattr(laws, name)

    quantity = QUANTITIES[name]
    compute_quantity.__doc__ = f"{quantity.input_label(Unit(''))} in {quantity.unit}. {quantity.meaning}"
    compute_quantity.__name__ = name
    return cached_property(compute_quantity)


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class Contact(Outcome):
    """Contact of a joint under load: the result of `model.press(joint, ...)`.

    Every quantity has the shape that joint and load broadcast to.

    Points without a result are NaN and have a `status` other than `Status.OK`. Points outside the model's `validity`
    have numbers, and `valid` is false there. `notes` describes both.

    Attributes
    ----------
    force, indentation : float or array
        Axial load F in N; approach d of the centres from first touch in mm.
    status : Status or array of int
        Success, or the reason of the failure, of each point.
    model : PressModel
        The model that computed the contact.
    joint : Joint
        The joint that was pressed.
    laws : Laws
        Closed forms bound to joint and indentation, or a solution, which give the other quantities.
    """

    model: PressModel
    laws: Laws
    force: Array
    indentation: Array

    stress_error: ClassVar[float | None] = None
    """Relative error of a von Mises stress that is solved for; None if it is that of `quick_von_mises`."""

    half_angle = _quantity_property("half_angle")
    max_pressure = _quantity_property("max_pressure")
    max_pressure_angle = _quantity_property("max_pressure_angle")
    pole_pressure = _quantity_property("pole_pressure")
    stiffness = _quantity_property("stiffness")
    energy = _quantity_property("energy")
    foundation_modulus = _quantity_property("foundation_modulus")
    pressure_integral = _quantity_property("pressure_integral")

    @property
    def _load(self) -> Array:
        return self.indentation

    @cached_property
    def von_mises(self) -> Array:
        """Largest von Mises stress in the liner in MPa.

        A ratio of the largest pressure from a table of the exact solution, see `stress_ratio`, with an error of 0.5 %
        of its own for liners on a rigid backing. Models that solve for the stresses compute it.
        """
        return self._mask_failed(self._compute_von_mises)

    @cached_property
    def utilisation(self) -> Array:
        """Ratio of largest von Mises stress to yield stress, the larger of liner and ball.

        It is NaN if neither has a yield stress.

        From 1 on the material yields somewhere. A linear result is invalid above 1.3
        (`strength.MAX_ELASTIC_UTILISATION`).
        """
        is_liner_checked = self.joint.liner.yield_stress is not None
        return self._compute_utilisation(self.von_mises if is_liner_checked else self.max_pressure)

    def utilisation_at(self, mask: Array) -> Array:
        """Compute the ratio of von Mises to yield stress at the points of a mask; other points may be NaN.

        Models that solve for the stresses skip the other points.
        """
        return self.utilisation

    def _compute_utilisation(self, von_mises: Array) -> Array:
        """Compute the ratio of von Mises to yield stress from the von Mises stress of the liner in MPa."""
        return self._match_load(strength.utilisation(self.joint, von_mises, self.max_pressure))

    @cached_property
    def quick_von_mises(self) -> Bounded:
        """Largest von Mises stress in the liner in MPa with its bounds, from the table instead of solved stresses.

        An error of the largest pressure comes on top, see `verdict.error_bar`.
        """
        stress = self._mask_failed(lambda: Contact._compute_von_mises(self))
        return Bounded(*map(self._match_load, strength.bounded_von_mises(self, stress)))

    @cached_property
    def _rim_error(self) -> Array:
        """Bound of the relative increase of the von Mises stress by a free rim; 0 if the model includes the rim."""
        return strength.free_rim_error(self)

    @property
    def error(self) -> dict[str, Array]:
        """Estimated relative errors as of `Outcome`; that of the stress contains the error of the pressure."""
        errors = super().error
        if "max_pressure" in errors:
            ratio = self._mask_failed(lambda: strength.von_mises_error(self))
            errors["von_mises"] = arrays.read_only((1 + ratio) * (1 + errors["max_pressure"]) - 1)
        return errors

    def _compute_von_mises(self) -> Array:
        """Compute the largest von Mises stress in the liner in MPa from the tabulated ratio."""
        liner = self.joint.liner
        return von_mises_ratio(self.half_angle, liner.poisson, self.joint.thickness_ratio) * self.max_pressure

    @property
    def _validity_ranges(self) -> tuple[Range, ...]:
        """Ranges of quantities in which a contact is valid, with the elastic limit if a strength is known."""
        return (*self.model.validity, ELASTIC) if self.joint.strengths() and not self.yields else self.model.validity

    @property
    def yields(self) -> bool:
        """True if the model lets the liner yield, so that no elastic limit applies."""
        return False

    @property
    def quick_notes(self) -> tuple[str, ...]:
        """Notes without those that take longer to compute than the contact."""
        return self.notes

    def findings(self) -> Iterator[Finding]:
        """Yield messages on failed points, points outside the model's validity, and exceeded material limits."""
        yield from super().findings()
        if self.utilisation_note and arrays.all_true(self._failed) is not True:
            yield Finding(False, self.utilisation_note)
        for acceptable, text in strength.strength_remarks(self):
            yield Finding(acceptable | self._failed, text)

    @property
    def utilisation_note(self) -> str:
        """Reason why the strength of the liner is not checked; empty if the liner has a yield stress."""
        if self.yields and self.joint.liner.yield_stress is None:
            return "the utilisation leaves out the liner: its yielding by the hardening curve is solved for"
        return strength.unchecked_strength_reason(self.joint)

    @cached_property
    def area(self) -> Array:
        """Contact area on the ball in mm², A = 2π R1² (1 - cos ε), Eq. (19), with ball radius R1 and half angle ε."""
        half_sine = arrays.sin(arrays.clip(self.half_angle, 0.0, pi) / 2)
        with numpy.errstate(all="ignore"):
            return self._match_load(4 * pi * self.joint.ball_radius * self.joint.ball_radius * half_sine * half_sine)

    @property
    def indentation_ratio(self) -> Array:
        """Ratio of indentation to liner thickness, d/L."""
        return self.indentation / self.joint.liner_thickness

    @property
    def depth_ratio(self) -> Array:
        """Ratio of indentation to the smaller of liner thickness and socket radius, a measure of the strains."""
        R2, L = self.joint.socket_radius, self.joint.liner_thickness
        return self.indentation / arrays.where(L < R2, L, R2)

    @property
    def width_ratio(self) -> Array:
        """Ratio of contact radius to liner thickness, R2 sin ε / L (R2 socket radius, ε half angle)."""
        return arrays.sin(self.half_angle) * self.joint.thickness_ratio

    @property
    def conformity(self) -> Array:
        """Ratio of clearance to indentation, c/d; 0 if ball and socket have equal radii."""
        quotient = self.joint.clearance / arrays.safe_divisor(self.indentation)
        return self._match_load(arrays.where(self.indentation == 0, numpy.inf, quotient))

    @cached_property
    def edge_slope(self) -> Array:
        """Slope of the pressure at the edge of the contact in MPa/mm, G in p = G s with the arc s from the edge.

        Radial springs have a slope. It is NaN where the pressure rises as a square root, and without contact.
        """
        return self._edge_constant(1.0)

    @cached_property
    def edge_coefficient(self) -> Array:
        """Coefficient of the pressure at the edge of an elastic contact, A in p = A sqrt(s), in MPa/mm^(1/2).

        The arc s along the bore starts at the edge. It is NaN where the pressure rises linearly, and without contact.
        """
        return self._edge_constant(0.5)

    def _edge_constant(self, exponent: float) -> Array:
        """Compute the limit of p/s^exponent at the edge of the contact; NaN where p rises with another exponent."""
        arc = _EDGE_ARC * self.half_angle
        near, far = (self.pressure(self.half_angle - factor * arc) for factor in (1.0, 2.0))
        distance = arc * self.joint.socket_radius
        with numpy.errstate(all="ignore"):
            growth = far / arrays.safe_divisor(near)
            rises = abs(growth - 2**exponent) < _EDGE_TOLERANCE
            # p/s^n is linear in s near the edge: its limit from two points
            constant = (2 - 0.5**exponent * growth) * near / arrays.safe_divisor(distance**exponent)
            return self._match_load(arrays.where(rises, constant, numpy.nan))

    def pressure(self, angle: Array) -> Array:
        """Compute the contact pressure in MPa at polar angles from the load axis; 0 outside the contact.

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
            An angle beyond ±π, probably in degrees.
        TypeError
            An angle that is not numeric.
        """
        angle = check_numeric("angle", angle)
        # the angle at the edge is NaN where there is no contact
        QUANTITIES["angle"].check(arrays.where(angle == angle, angle, 0.0))
        if self._is_plain and arrays.is_plain_number(angle):
            return self._evaluate(lambda laws: laws.pressure(float(angle)))
        _, angle = arrays.to_common_arrays(self.indentation, angle)
        return self._evaluate(lambda laws: laws.pressure(angle))

    def pressure_at(self, direction: Array) -> Array:
        """Compute the contact pressure in MPa along directions from the centre of the socket; 0 outside the contact.

        Parameters
        ----------
        direction : array (..., 3)
            Unit vectors x, y, z; z is the axis of the load and points to the pole. Their leading axes broadcast
            against the contact's shape as the angles of `pressure` do.

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
        require(
            "direction", length, (length - 1) ** 2 < _UNIT_TOLERANCE, "a direction is a unit vector, x² + y² + z² = 1"
        )
        return self.pressure(arrays.atan2(across, z))

    def friction_torque(self, coefficient: Array, axis_angle: float = pi / 2) -> Array:
        """Compute the Coulomb friction torque in N mm of a ball that slides about an axis through its centre.

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
            A coefficient that is negative or not finite; an angle beyond ±2π.
        TypeError
            A coefficient that is not numeric.
        """
        coefficient = self._check_friction(coefficient, axis_angle)

        def ring_torque(fraction: float) -> Array:
            """Compute the friction torque density of the ring at a fraction x of the half angle."""
            angle = self.half_angle * sin(pi / 2 * fraction)  # removes the square root singularity at the edge
            width = self.half_angle * (pi / 2 * cos(pi / 2 * fraction))
            arc = angle if self.model.planar else arrays.sin(angle)
            return self.pressure(angle) * _mean_friction_lever(angle, axis_angle) * arc * width

        socket_radius = self.joint.socket_radius
        friction_lever = coefficient * self.joint.ball_radius
        return self._match_load(
            friction_lever * 2 * pi * socket_radius * socket_radius * arrays.integral(ring_torque, 24)
        )

    @staticmethod
    def _check_friction(coefficient: Array, axis_angle: float) -> Array:
        if isinstance(coefficient, tuple | list):
            raise TypeError(
                f"coefficient must be a number or an array, got the {type(coefficient).__name__} {shown(coefficient)}"
            )
        coefficient = check_numeric("coefficient", coefficient)
        allowed = "a coefficient of friction is 0 or more and finite"
        require("coefficient", coefficient, (coefficient >= 0) & (coefficient < inf), allowed)
        require("axis_angle", axis_angle, abs(axis_angle) <= 2 * pi, f"it is in radians; {degrees_hint(axis_angle)}")
        return coefficient

    def _evaluate(self, read_quantity: Callable[[Laws], Array]) -> Array:
        """Evaluate one quantity of the laws, with NumPy numbers where Python floats raise; NaN at failed points."""

        def evaluate_quantity() -> Array:
            try:
                return read_quantity(self.laws)
            except ArithmeticError:
                return read_quantity(self.model.numpy_laws(self.joint, self.indentation))

        return self._mask_failed(evaluate_quantity)

    def summary(self) -> dict[str, Any]:
        """Return the contact as a dictionary for JSON in N, mm, MPa and degrees; missing numbers become None.

        Arrays become lists.
        """
        return describe.to_summary(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the contact as a dictionary for JSON, equal to `summary()`."""
        return self.summary()

    def to_frame(self) -> pandas.DataFrame:
        """Return a pandas data frame with one row per point.

        Column names end in units, such as "half_angle_deg".

        Raises ImportError: pandas is not installed.
        """
        return describe.to_frame(self)

    def plot(self) -> Any:
        """Plot pressure over angle and force over indentation of a single contact.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        ValueError
            More than one contact, or a contact without a result.
        """
        return load_plot("contacts")({self.model.name: self})

    def __repr__(self) -> str:
        return describe.to_text(self)

    def _repr_html_(self) -> str:
        return describe.to_html(self)


ELASTIC = strength.ElasticLimit()  # range of the utilisation in which the result of a material with a strength is valid

_EDGE_ARC = 1e-5  # distance from the edge at which the rise of the pressure is read, relative to the half angle

_EDGE_TOLERANCE = 0.1
"""Allowed difference of the pressure ratio at double distance from 2 (springs) or from the root of 2 (elastic)."""

_UNIT_TOLERANCE = 1e-10  # tolerance of the square of (x² + y² + z² - 1) of a unit vector


def _mean_friction_lever(angle: Array, axis_angle: float) -> Array:
    """Compute the mean sine of the angle between radius and axis of rotation, on the circle at a polar angle in rad."""
    azimuths = [pi * (k + 0.5) / 64 for k in range(64)]
    axial_part, transverse_part = (
        arrays.cos(angle) * float(numpy.cos(axis_angle)),
        arrays.sin(angle) * float(numpy.sin(axis_angle)),
    )
    sines = [
        arrays.sqrt(arrays.clip(1 - (axial_part + transverse_part * float(numpy.cos(azimuth))) ** 2, 0.0, 1.0))
        for azimuth in azimuths
    ]
    return arrays.weighted_sum(sines, [1 / 64] * 64)
