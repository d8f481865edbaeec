"""The answer of `Sphere`: a contact that knows where it lies in its cup."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import degrees
from typing import Any, ClassVar

import numpy

from ...contact.per_joint import JointContacts, SolvedContact, joint_at
from ...contact.strength import von_mises_ratio
from ...core import arrays
from ...core.arrays import Array, Numbers
from ...core.validity import Status
from .directions import checked_direction, polar_angle


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class OffAxisContact(SolvedContact):
    """A contact anywhere in a cup.

    Vectors have a last axis of 3, in the cup's own frame: from the centre of the bore x leans towards the rim, z points
    to the dome's pole (`cup.frame` gives them in the body's). `force` is the size of the load, `indentation` how far
    the ball's centre is displaced beyond the clearance, `half_angle` that of a round contact of the same area;
    angles count from the load. In a preloaded joint force and indentation are those along the load's axis: a force
    below 0 pulls.
    """

    model: Any

    _inside: ClassVar[str] = "pressure maps"

    def _joint_von_mises(self, place: Numbers, piece: JointContacts) -> Numbers:
        """An estimate as of a closed form, from half angle and largest pressure: only the surface is solved."""
        joint, state = joint_at(self.joint, self.laws.shape, int(place[0])), piece.state
        estimate = von_mises_ratio(state.half_angle, joint.liner.poisson, joint.thickness_ratio)
        return numpy.asarray(estimate * state.max_pressure)

    @property
    def von_mises_bounds(self) -> tuple[Array, Array]:
        """What `von_mises` lies between, which is quickly told."""
        return self.von_mises, self.von_mises

    @cached_property
    def force_vector(self) -> Array:
        """The load that the ball puts on the cup in N: towards the rim, across, towards the dome."""
        return self._vector("force_vector")

    @cached_property
    def displacement(self) -> Array:
        """Place of the ball's centre from the centre of the bore, in mm."""
        return self._vector("displacement")

    @cached_property
    def moment(self) -> Array:
        """Moment of the contact on the ball about its own centre, without friction, in N mm."""
        return arrays.namespace(self.force_vector).linalg.cross(self.displacement, self.force_vector)

    @cached_property
    def stiffness_matrix(self) -> Array:
        """Change of the load by the displacement in N/mm, (..., 3, 3), symmetric."""
        rows = self.laws.spread(lambda piece: piece.state.tangent.reshape(9, -1), (9,))
        rows = arrays.where(self._failed, numpy.nan, rows)
        return arrays.namespace(rows).moveaxis(rows, 0, -1).reshape((*rows.shape[1:], 3, 3))

    @cached_property
    def max_pressure_at(self) -> Array:
        """Unit vector to where the pressure is largest."""
        return self._vector("max_pressure_at")

    @cached_property
    def edge_loaded(self) -> Array:
        """Whether the contact reaches the end of the bore."""
        loaded = self.laws.spread(lambda piece: piece.state.edge_loaded) == 1
        return bool(loaded) if self._is_plain else loaded

    @cached_property
    def edge_margin(self) -> Array:
        """The angle in rad that belongs to `edge_distance`."""
        return self._scalar("edge_margin")

    @property
    def edge_distance(self) -> Array:
        """The arc in mm from the edge of the contact to the end of the bore (contact patch edge to rim).

        Below 0 it is cut off there: so far would the load have to turn back towards the dome for it to end at the rim.
        """
        return self.edge_margin * self.joint.socket_radius

    @property
    def rim_distance(self) -> Array:
        """The arc in mm from where the load points to the end of the bore (contact patch centre to rim)."""
        return self._match_load((self.model.reach_of(self.joint) - self.tilt) * self.joint.socket_radius)

    @property
    def tilt(self) -> Array:
        """The angle in rad from the dome's pole to where the load points."""
        return self._match_load(self.laws.spread(lambda piece: polar_angle(piece.state.axes.T)))

    @property
    def outline(self) -> Numbers:
        """Unit vectors (rays, 3) to the edge of a single contact."""
        edge: Numbers = self.single_state.patches[0].outline
        return edge

    def pressure_at(self, direction: Array) -> Array:
        """Contact pressure in MPa in directions of the cup's frame, of a single contact; 0 outside of it.

        Parameters
        ----------
        direction : array (..., 3)
            Of any length.

        Raises
        ------
        ValueError
            More than one contact; what is no direction.
        """
        at: Numbers = self.single_state.patches[0].at(checked_direction(direction))
        return float(at) if at.shape == () else at

    @property
    def pressure_map(self) -> tuple[Numbers, Numbers, Numbers]:
        """The grid of one contact: polar angles (rings,), azimuths (meridians,), pressures (rings, meridians)."""
        patch = self.single_state.patches[0]
        return patch.grid.polar, patch.grid.azimuth, patch.pressure

    @property
    def notes(self) -> tuple[str, ...]:
        """What has no answer or lies outside the validity, and what happens at the rim, in words."""
        notes = list(super().notes)
        if self._is_plain and self.status is Status.DISLOCATED:
            notes.append(self._where_lost)
        if not self._failed_everywhere:
            unbounded = self.laws.spread(lambda piece: piece.state.unbounded) == 1
            notes += self._note(~(arrays.to_numpy(unbounded)), _DIGS)
            notes += self._note(~(arrays.to_numpy(self.edge_loaded) & ~arrays.to_numpy(unbounded)), _REACHES)
        return tuple(notes)

    @property
    def _where_lost(self) -> str:
        """The angle at which a ball has left its bore; where the load points into that, how far it went."""
        tilt, reach = (degrees(float(each)) for each in (self.tilt, self.model.reach_of(self.joint)))
        if tilt > reach:
            return f"the load points {tilt:.1f}° from the dome's pole, and the bore ends at {reach:.1f}°"
        (_, piece), *_ = self.laws.pieces
        place = piece.state.displacement[:, 0]
        far, swung = float(numpy.linalg.norm(place)), degrees(float(polar_angle(place)))
        return f"the ball's centre went {far:.3g} mm from the bore's, {swung:.1f}° from the dome's pole"

    def _scalar(self, name: str) -> Array:
        return self._mask_failed(lambda: self.laws.spread(lambda piece: getattr(piece.state, name)))

    def _vector(self, name: str) -> Array:
        """A vector of every contact (..., 3); NaN where there is no answer."""
        rows = self.laws.spread(lambda piece: getattr(piece.state, name), (3,))
        rows = arrays.where(self._failed, numpy.nan, rows)
        return arrays.namespace(rows).moveaxis(rows, 0, -1)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON: vectors in the cup's frame, `max_pressure_at_deg` as polar angle and azimuth.

        `force_vector_in_body` (to the right, to the front, up) where the cup's orientation is known.
        """
        at = arrays.to_numpy(self.max_pressure_at)
        angles = numpy.stack([polar_angle(numpy.moveaxis(at, -1, 0)), numpy.arctan2(at[..., 1], at[..., 0])], axis=-1)
        status = arrays.to_numpy(self.status)
        names = [Status(int(each)).name for each in status.ravel()]
        return {
            **super().summary(),
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
            **self._in_body(),
        }

    def _in_body(self) -> dict[str, Any]:
        """Return the load in the body's axes, for a cup whose orientation is given."""
        cup = self.model.cup
        if not cup.oriented:
            return {}
        return {"force_vector_in_body": (arrays.to_numpy(self.force_vector) @ numpy.asarray(cup.frame)).tolist()}


_REACHES = "edge loading: the contact reaches the rim"
_DIGS = (
    "edge loading: the end of the bore digs in like the edge of a punch, where the pressure is unbounded; "
    "force and indentation hold"
)
