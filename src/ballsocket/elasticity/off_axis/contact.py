"""Contact of `Sphere`: a contact with its position in the cup."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import degrees, pi
from typing import TYPE_CHECKING, Any, ClassVar

import numpy

from ...contact.outcome import Finding
from ...contact.per_joint import JointContacts, SolvedContact, joint_at
from ...contact.strength import WORN_ERRORS, rim_errors
from ...contact.stress_ratio import von_mises_ratio
from ...contact.verdict import Bounded
from ...core import arrays
from ...core.arrays import Array, Numbers
from ...core.kinds import MILLIMETRES
from ...core.records import cached_array
from ...core.unit_systems import Amount, Sentence
from ...core.validity import RIGID_BACKING, Status
from .directions import TILT_TOLERANCE, check_direction, polar_angle

if TYPE_CHECKING:
    from .contact_patch import ContactPatch
    from .contact_states import ContactStates


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class OffAxisContact(SolvedContact):
    """Contact at any position in a cup.

    Vectors have a last axis of 3, in the cup's own frame. Its origin is the centre of the bore. x leans towards the
    rim, and z points to the pole of the dome. `cup.frame` has these axes in the body's frame.

    `force` is the magnitude of the load, and `indentation` the displacement of the ball's centre beyond the clearance.
    `half_angle` is that of a round contact of the same area. Angles start at the load. In a preloaded joint force and
    indentation are components along the load's axis, and a negative force is tension.
    """

    model: Any

    _inside: ClassVar[str] = "pressure maps"

    def _joint_von_mises(self, indices: Numbers, contacts: JointContacts) -> Numbers:
        joint, state = joint_at(self.joint, self.laws.shape, int(indices[0])), contacts.state
        ratio = von_mises_ratio(state.half_angle, joint.liner.poisson, joint.thickness_ratio)
        if not joint.backing_ratio <= RIGID_BACKING.high:
            from ..exact.exact_curve import exact_stress_ratio  # slow to import

            ratio = exact_stress_ratio(joint, state.half_angle)
        return numpy.asarray(ratio * state.max_pressure)

    @property
    def quick_von_mises(self) -> Bounded:
        """Largest von Mises stress in the liner in MPa with its bounds; it needs no solution for stresses."""
        low, high = self._stress_errors
        stress = self.von_mises
        bounds = stress, (1 - low) * stress, arrays.where(stress > 0, 1 + high, 1.0) * stress
        return Bounded(*map(self._match_load, bounds))

    @property
    def _stress_errors(self) -> tuple[Array, Array]:
        """Relative errors, below and above, of the von Mises stress at the largest pressure."""
        margin = self.laws.combine(lambda contacts: contacts.state.edge_margin)
        low, high = rim_errors(self.joint, arrays.where(self.edge_loaded, 0.0, margin) * self.joint.socket_radius)
        if self.model.worn is None:
            return low, high
        worn_low, worn_high = WORN_ERRORS
        return arrays.where(low > worn_low, low, worn_low), high + worn_high

    @cached_array
    def force_vector(self) -> Array:
        """Force of the ball on the cup in N: components towards the rim, across, towards the dome."""
        return self._collect_vector("force_vector")

    @cached_array
    def displacement(self) -> Array:
        """Displacement of the ball's centre from the centre of the bore, in mm."""
        return self._collect_vector("displacement")

    @cached_array
    def moment(self) -> Array:
        """Moment of the contact on the ball about the ball's centre, without friction, in N mm."""
        return arrays.namespace(self.force_vector).linalg.cross(self.displacement, self.force_vector)

    @cached_array
    def edge_slope(self) -> Array:
        """Mean slope of the pressure along the edge of the contact in MPa/mm; NaN unless the bore is of springs."""
        return self._mean_edge_constant(1.0)

    @cached_array
    def edge_coefficient(self) -> Array:
        """Mean of p/sqrt(s) along the edge of the contact in MPa/mm^(1/2), with the arc s; NaN on springs."""
        return self._mean_edge_constant(0.5)

    def _mean_edge_constant(self, exponent: float) -> Array:
        """Compute the mean of p/s^exponent along the edge; NaN if the surface has another exponent."""
        if self.model.surface.edge_exponent != exponent:
            return self._match_load(self.half_angle * numpy.nan)
        constants = self.laws.combine(
            lambda contacts: numpy.array([patch.edge_constant(exponent) for patch in contacts.state.patches])
        )
        return self._mask_failed(lambda: constants / self.joint.socket_radius**exponent)

    def friction_torque(self, coefficient: Array, axis_angle: float = pi / 2) -> Array:
        """Compute the Coulomb friction torque in N mm of a ball that slides about an axis through its centre.

        Parameters
        ----------
        coefficient : float or array
            Coefficient of friction, zero or more.
        axis_angle : float
            Angle (rad) between the axis of rotation and the load: π/2 is across it, 0 along it.

        Returns
        -------
        float or array
            μ R1 ∫ p sin(angle between axis and radius) dA over the bore, the mean of axes around the load.

        Raises
        ------
        ValueError, TypeError
            As `Contact.friction_torque`.
        """
        coefficient = self._check_friction(coefficient, axis_angle)
        lever = self.laws.combine(lambda contacts: contacts.state.friction_levers(axis_angle))
        return self._match_load(coefficient * self.joint.ball_radius * self.joint.socket_radius**2 * lever)

    @cached_array
    def stiffness_matrix(self) -> Array:
        """Tangent stiffness: derivative of the force vector by the displacement in N/mm, (..., 3, 3), symmetric."""
        rows = self.laws.combine(lambda contacts: contacts.state.tangent.reshape(9, -1), (9,))
        rows = arrays.where(self._failed, numpy.nan, rows)
        return arrays.namespace(rows).moveaxis(rows, 0, -1).reshape((*rows.shape[1:], 3, 3))

    @cached_array
    def max_pressure_at(self) -> Array:
        """Unit vector from the centre of the bore to the point of the largest pressure."""
        return self._collect_vector("max_pressure_at")

    @cached_array
    def edge_loaded(self) -> Array:
        """True where the contact reaches the end of the bore."""
        loaded = self.laws.combine(lambda contacts: contacts.state.edge_loaded) == 1
        return bool(loaded) if self._is_plain else loaded

    @cached_array
    def edge_margin(self) -> Array:
        """Angle in rad from the edge of the contact to the end of the bore, negative for edge loading.

        It is `edge_distance` over the radius of the bore, and 0 without a contact.
        """
        from .load_cases import edge_margins  # slow to import

        return self._mask_failed(lambda: self.laws.combine(lambda contacts: edge_margins(contacts.state)))

    @cached_array
    def error(self) -> dict[str, Array]:
        """Estimated relative errors, one array for each quantity name; `edge_margin` has its error in rad.

        The edge of the contact has the error of the half angle. Where the rim cuts the contact off, the margin is a
        rotation of the load: its error grows with the tilt, and includes the tolerance of the search.
        """
        errors = super().error
        relative = errors["half_angle"]
        cut = _CUT_ERROR * relative * (self.half_angle + self.tilt) + TILT_TOLERANCE
        return {
            **errors,
            "von_mises": self._match_load(self._stress_errors[1] + 0.0 * self.half_angle),
            "edge_margin": self._match_load(arrays.where(self.edge_loaded, cut, relative * self.half_angle)),
        }

    @property
    def edge_distance(self) -> Array:
        """Arc in mm from the edge of the contact to the end of the bore (contact patch edge to rim, CPER).

        A contact that the rim cuts off has a negative distance: the arc by which its load would have to rotate back
        towards the dome until the contact ends at the rim.
        """
        return self.edge_margin * self.joint.socket_radius

    @property
    def rim_distance(self) -> Array:
        """Arc in mm from the direction of the load to the end of the bore (contact patch centre to rim, CPCR)."""
        return self._match_load((self.model.reach_of(self.joint) - self.tilt) * self.joint.socket_radius)

    @property
    def tilt(self) -> Array:
        """Angle in rad between the pole of the dome and the direction of the load."""
        return self._match_load(self.laws.combine(lambda contacts: polar_angle(contacts.state.axes.T)))

    @property
    def _patch(self) -> ContactPatch:
        state: ContactStates = self.single_state
        return state.patches[0]

    @property
    def outline(self) -> Numbers:
        """Edge of a single contact, as unit vectors (rays, 3) from the centre of the bore."""
        return self._patch.outline

    def pressure_at(self, direction: Array) -> Array:
        """Interpolate the pressure of a single contact in MPa in directions of the cup's frame; 0 outside of it.

        Parameters
        ----------
        direction : array (..., 3)
            Directions of any length.

        Raises
        ------
        ValueError
            More than one contact; a direction of length 0.
        """
        pressure = self._patch.pressure_at(check_direction(direction))
        return float(pressure) if pressure.shape == () else pressure

    @property
    def pressure_map(self) -> tuple[Numbers, Numbers, Numbers]:
        """Polar angles (rings,), azimuths (meridians,) and pressures (rings, meridians) of a single contact."""
        patch = self._patch
        return patch.grid.polar, patch.grid.azimuth, patch.pressure

    def findings(self) -> Iterator[Finding]:
        """Yield sentences about loads without a solution, limits of validity and contact with the rim."""
        yield from super().findings()
        if self.model.worn is not None and self.joint.liner.strengths:
            yield Finding(False, _WORN_NOTE.format(*reversed(WORN_ERRORS)))
        if self._is_plain and self.status is Status.DISLOCATED:
            yield Finding(False, self._dislocation_note)
        if not self._all_points_failed:
            unbounded = self.laws.combine(lambda contacts: contacts.state.unbounded) == 1
            yield Finding(~(arrays.to_numpy(unbounded)), _SHARP_RIM_NOTE)
            bounded = arrays.to_numpy(self.edge_loaded) & ~arrays.to_numpy(unbounded)
            preloaded = arrays.to_numpy(self.joint.clearance) < 0
            yield Finding(~(bounded & ~preloaded), _RIM_NOTE)
            yield Finding(~(bounded & preloaded), _PRELOADED_RIM_NOTE)

    @property
    def _dislocation_note(self) -> str:
        """Note on a dislocated ball: the tilt of a load that points beyond the bore, else the displacement."""
        tilt, reach = (degrees(float(angle)) for angle in (self.tilt, self.model.reach_of(self.joint)))
        if tilt > reach:
            outside = f"the load points {tilt:.1f}° from the dome's pole, and the bore ends at {reach:.1f}°"
            return f"{outside}{_REVERSED_NOTE if 180.0 - tilt < reach else ''}"
        (_, contacts), *_ = self.laws.pieces
        centre = contacts.state.displacement[:, 0]
        distance, polar = float(numpy.linalg.norm(centre)), degrees(float(polar_angle(centre)))
        text = f"the ball's centre moved {{}} from the bore's, {polar:.1f}° from the dome's pole"
        return Sentence(text, Amount(distance, MILLIMETRES, 3))

    def _collect_vector(self, name: str) -> Array:
        """Collect a named vector of all contacts: (..., 3), NaN where there is no solution."""
        rows = self.laws.combine(lambda contacts: getattr(contacts.state, name), (3,))
        rows = arrays.where(self._failed, numpy.nan, rows)
        return arrays.namespace(rows).moveaxis(rows, 0, -1)

    def summary(self) -> dict[str, Any]:
        """Return the contact as a dictionary for JSON, with vectors in the cup's frame.

        `max_pressure_at_deg` has the polar angle and the azimuth. A cup with an orientation adds `force_vector_in_body`
        (right, front, up).
        """
        at = arrays.to_numpy(self.max_pressure_at)
        angles = numpy.stack([polar_angle(numpy.moveaxis(at, -1, 0)), numpy.arctan2(at[..., 1], at[..., 0])], axis=-1)
        status = arrays.to_numpy(self.status)
        names = [Status(int(number)).name for number in status.ravel()]
        summary = super().summary()
        summary["error"]["edge_margin_deg"] = arrays.to_list(self.error["edge_margin"] * degrees(1.0))
        del summary["error"]["edge_margin"]
        in_body = arrays.to_numpy(self.force_vector) @ numpy.asarray(self.model.cup.frame)
        return {
            **summary,
            "status": names[0] if status.ndim == 0 else names,
            "force_vector": arrays.to_list(self.force_vector),
            "displacement": arrays.to_list(self.displacement),
            "moment": arrays.to_list(self.moment),
            "max_pressure_at_deg": arrays.to_list(numpy.degrees(angles)),
            "edge_distance": arrays.to_list(self.edge_distance),
            "edge_margin_deg": arrays.to_list(self.edge_margin * degrees(1.0)),
            "rim_distance": arrays.to_list(self.rim_distance),
            "edge_loaded": self.edge_loaded if self._is_plain else arrays.to_numpy(self.edge_loaded).tolist(),
            "stiffness_matrix": arrays.to_list(self.stiffness_matrix),
            **({"force_vector_in_body": arrays.to_list(in_body)} if self.model.cup.oriented else {}),
        }


_CUT_ERROR = 2.0  # factor of the error of the margin of contacts that the rim cuts off, measured against rings of 0.75°

_REVERSED_NOTE = "; if it is the force on the ball, such as a measured joint reaction, give the opposite direction"
_UNBOUNDED = "so its stress has no known bound"
_RIM_NOTE = f"edge loading: the contact reaches the rim, {_UNBOUNDED}"
_PRELOADED_RIM_NOTE = f"the contact reaches the rim, as is normal in a preloaded joint, {_UNBOUNDED}"
_WORN_NOTE = (
    "stress in a worn bore: up to {:.0%} above the stress by its largest pressure in a sphere, and up to {:.0%} below "
    "it at a narrow peak of pressure"
)
_SHARP_RIM_NOTE = (
    "edge loading: the end of the bore indents the ball like the edge of a punch, where the pressure is unbounded; "
    "force and indentation are valid"
)
