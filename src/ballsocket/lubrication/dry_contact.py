"""Dry contact under a film: pressure on the cells of a mesh about the load, its edge, and the elastic displacements."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import ceil, cos, isfinite, pi, sin
from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Contact
from ..core.arrays import Numbers
from ..core.validity import Status
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.grid import Grid
from ..problem import Joint
from ..problem.cup import Cup
from .inlet import Edge, ElasticEdge, SpringEdge
from .mesh import FilmMesh, polar_mesh, thinned_meridians

if TYPE_CHECKING:
    from ..elasticity.off_axis.compliance import AxisymmetricOperator, Compliance
    from ..elasticity.off_axis.model import Sphere
    from ..elasticity.off_axis.surfaces import Surface

_SAMPLES = (0.25, 0.75)
"""Positions in a cell of the cup, as fractions of its width, at which the film's pressure is sampled."""

_RINGS_OUTSIDE = 2  # rings of lubricant around the contact
_MIN_RINGS = 8  # smallest number of rings in a contact

_CONTINUED_CELL_ERROR = 0.12
"""Relative error of the wave times the number of rings, where the pressure continues beyond the edge; measured."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DryContact:
    """Pressure of a dry contact on a mesh, with its edge."""

    mesh: FilmMesh  # cells of the bore at and around the contact, in the frame of the contact
    pressure: Numbers  # (cells,), dry pressure in MPa
    edge: Edge  # rise of the pressure at the edge
    axis: Numbers  # (3,), unit vector along the load
    half_angle: float  # half angle of the contact in rad
    radius: float  # radius of the bore in mm
    cut: bool = False  # True if the rim of the bore cuts the contact
    rings: int = 1  # number of rings of cells in the contact; 1 of a contact whose cells are not about its load
    region: Numbers | None = None  # (cells,), mask of the cells that count as contact; those under pressure by default
    # (cells,), pressure in MPa on springs, continued smoothly beyond the edge, where it is negative; 0 there by default
    continuation: Numbers | None = None
    # (cells,), field that is 0 at the edge and positive inside; the continued pressure by default
    level: Numbers | None = None

    @property
    def contact_radius(self) -> float:
        """Arc in mm from the load to the edge."""
        return self.radius * self.half_angle

    @property
    def inside(self) -> Numbers:
        """Mask of the cells in contact (cells,)."""
        return numpy.asarray(self.pressure > 0 if self.region is None else self.region)

    @property
    def interior(self) -> Numbers:
        """Mask of the cells in contact without those at its edge (cells,)."""
        mesh, interior = self.mesh, self.inside.copy()
        borders = interior[mesh.first] != interior[mesh.second]
        interior[mesh.first[borders]] = interior[mesh.second[borders]] = False
        return interior

    @property
    def signed_pressure(self) -> Numbers:
        """Pressure (cells,) in MPa, whose differences between cells have the right slope at the edge if continued."""
        return self.pressure if self.continuation is None else self.continuation

    @property
    def cell_error(self) -> float:
        """Relative error of the wave times the number of rings of cells in the contact."""
        return self.edge.cell_error if self.continuation is None else _CONTINUED_CELL_ERROR

    @cached_property
    def edge_distance(self) -> Numbers:
        """Estimated distance of each cell from the edge in mm; 0 outside."""
        return self.edge.distance(self.pressure)

    def speed(self, spin: Numbers) -> float:
        """Compute the speed in mm/s of the ball's surface at the pole of the load, across the load."""
        return self.radius * float(numpy.linalg.norm(numpy.cross(self.axis, spin)))

    def contains_axis(self, spin: Numbers) -> bool:
        """Check if the axis of a rotation passes through the contact; lubricant then circles there without an inlet."""
        along = abs(float(self.axis @ spin))
        return along > numpy.cos(self.half_angle) * float(numpy.linalg.norm(spin))

    def inward_speed(self, spin: Numbers, direction: Numbers) -> Numbers:
        """Compute the speed in mm/s of the ball's surface towards the load at directions (n, 3)."""
        velocity = self.radius * numpy.cross(spin, direction)
        towards = self.axis - (direction @ self.axis)[:, None] * direction
        length = numpy.linalg.norm(towards, axis=1)
        return numpy.einsum("ij,ij->i", velocity, towards) / numpy.where(length > 0, length, 1.0)


def find_edge(contact: Contact) -> Edge:
    """Find the kind of edge of a single contact, and its constants.

    Raises ValueError: a contact whose pressure rises neither linearly nor as a square root at its edge.
    """
    slope, coefficient = float(contact.edge_slope), float(contact.edge_coefficient)
    if isfinite(slope):
        return SpringEdge(slope=slope, modulus=float(contact.foundation_modulus))
    if isfinite(coefficient):
        return ElasticEdge(coefficient=coefficient, modulus=float(contact.joint.effective_modulus))
    raise ValueError(f"the pressure of {contact.model.name} has no edge that a film can enter")


def check_single_contact(contact: Contact) -> Contact:
    """Return a contact that a film can separate.

    Raises TypeError: another object than a contact.
    Raises ValueError: more than one contact; a contact that failed or carries no load; a joint without clearance.
    """
    if not isinstance(contact, Contact):
        raise TypeError(f"contact must be a pressed contact, got {type(contact).__name__}")
    if not isinstance(contact.force, float):
        raise ValueError("a film needs a single contact: press one joint with one load")
    if contact.status is not Status.OK:
        raise ValueError(f"a film needs a contact with a result, got status {Status(contact.status).name}")
    clearance = float(contact.joint.clearance)
    if clearance <= 0:
        name = "clearance" if clearance == 0 else "interference"
        raise ValueError(f"{name} = {abs(clearance):.6g} mm is not allowed: without clearance no lubricant enters")
    if not contact.force > 0:
        raise ValueError(f"force = {contact.force:.6g} N is not allowed: a film needs a load")
    return contact


def dry_contact(contact: Contact, width: float) -> DryContact:
    """Evaluate a single contact on a mesh about its load, of cells of about this width in rad."""
    half_angle, radius = float(contact.half_angle), float(contact.joint.socket_radius)
    rings = max(ceil(half_angle / width), _MIN_RINGS)
    if isinstance(contact, OffAxisContact):
        return _off_axis(contact, half_angle, radius, rings)
    edges = half_angle / rings * numpy.arange(rings + _RINGS_OUTSIDE + 1)
    mesh = square_mesh(radius, edges, half_angle / rings)
    theta = numpy.arccos(numpy.clip(mesh.direction[:, 2], -1.0, 1.0))
    pressure = numpy.where(theta < half_angle, contact.pressure(numpy.minimum(theta, half_angle)), 0.0)
    edge = find_edge(contact)
    continuation = None
    if isinstance(edge, SpringEdge):  # the pressure at a distance -s outside is p(-s) = p(s) - 2 G s, a parabola
        mirrored = contact.pressure(numpy.clip(2 * half_angle - theta, 0.0, half_angle))
        outside = radius * (theta - half_angle)
        continuation = numpy.where(pressure > 0, pressure, numpy.minimum(mirrored - 2 * edge.slope * outside, 0.0))
    return DryContact(
        mesh=mesh,
        pressure=pressure,
        continuation=continuation,
        edge=edge,
        axis=numpy.array([0.0, 0.0, 1.0]),
        half_angle=half_angle,
        radius=radius,
        rings=rings,
    )


def _off_axis(contact: OffAxisContact, half_angle: float, radius: float, rings: int) -> DryContact:
    """Evaluate a contact of `Sphere` on a mesh about its force, as far as its outline."""
    axis, angles = outline_angles(contact)
    width = half_angle / rings
    edges = width * numpy.arange(ceil(float(angles.max()) / width) + _RINGS_OUTSIDE + 1)
    mesh = square_mesh(radius, edges, width).in_frame(frame_about(axis))
    return DryContact(
        mesh=mesh,
        pressure=numpy.asarray(contact.pressure_at(mesh.direction)),
        edge=find_edge(contact),
        axis=axis,
        half_angle=half_angle,
        radius=radius,
        cut=bool(contact.edge_loaded),
        rings=rings,
    )


def outline_angles(contact: OffAxisContact) -> tuple[Numbers, Numbers]:
    """Return the unit vector (3,) along the force of a contact, and the angles (n,) in rad from it to the outline."""
    axis = numpy.asarray(contact.force_vector) / numpy.linalg.norm(contact.force_vector)
    outline = contact.outline / numpy.linalg.norm(contact.outline, axis=1)[:, None]
    return axis, numpy.arccos(numpy.clip(outline @ axis, -1.0, 1.0))


def square_mesh(radius: float, edges: Numbers, width: float) -> FilmMesh:
    """Make a polar mesh whose cells are about square, between rings at angles in rad; the width is in rad."""
    edges = edges[edges < pi]
    meridians = 12 * max(round(2 * pi * sin(min(edges[-1], pi / 2)) / width / 12), 4)
    return polar_mesh(radius, edges, thinned_meridians(edges, meridians))


def frame_about(axis: Numbers) -> Numbers:
    """Make a right-handed frame (3, 3) whose third row is an axis, and whose first row lies near x."""
    helper = numpy.array([1.0, 0.0, 0.0]) if abs(axis[0]) < cos(0.1) else numpy.array([0.0, 1.0, 0.0])
    second = numpy.cross(axis, helper)
    second /= numpy.linalg.norm(second)
    return numpy.stack([numpy.cross(second, axis), second, axis])


@dataclass(frozen=True, kw_only=True, eq=False)
class CupCorrection:
    """Displacements of a real cup less those of a closed shell, between the cells of a film.

    A closed shell and a ball have the same compliance about every axis through the centre of the bore, so also about
    that of the film's mesh. The rim of a real cup, a chamfer or an interface that slides change the displacements by a
    field that is smooth in the contact. It is computed on the rings about the axis of the cup.
    """

    # from pressures in MPa on the grid of the cup to the difference of both displacements in mm
    operator: AxisymmetricOperator
    grid: Grid  # rings about the axis of the cup
    to_cup: Any  # sparse (cells of the cup, cells of the film), mean pressures of the cells of the cup
    to_film: Any  # sparse (cells of the film, cells of the cup), interpolation of the displacements

    @classmethod
    def of(cls, model: Sphere, joint: Joint, film_grid: Grid, frame: Numbers) -> CupCorrection:
        """Compute the correction for a film on a grid about the third row of `frame`, with the rings of a model."""
        from ..elasticity.off_axis.compliance import AxisymmetricOperator, cached_compliance  # slow to import

        surfaces = (model.surface, model.surface.isotropic)
        pair: Any = [cached_compliance(kind, joint, model.cup, model.ring_width) for kind in surfaces]
        real, closed = pair
        difference = real.softness.matrices - closed.softness.matrices
        samples = [real.grid.points(*shares) @ frame.T for shares in product(_SAMPLES, _SAMPLES)]
        return cls(
            operator=AxisymmetricOperator(matrices=difference),
            grid=real.grid,
            to_cup=sum(film_grid.interpolation_matrix(directions) for directions in samples) / len(samples),
            to_film=real.grid.interpolation_matrix(film_grid.middles.reshape(3, -1).T @ frame),
        )

    def within(self, mask: Numbers) -> CupCorrection:
        """Keep the cells of a film in a mask (cells of the film,)."""
        return replace(self, to_cup=self.to_cup.tocsc()[:, mask].tocsr(), to_film=self.to_film[mask])

    def __call__(self, pressure: Numbers) -> Numbers:
        """Compute the difference of the displacements in mm (cells,) under pressures in MPa (cells,)."""
        on_cup = (self.to_cup @ pressure).reshape(1, self.grid.rings, self.grid.meridians)
        return numpy.asarray(self.to_film @ self.operator(on_cup).ravel())


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticSoftness:
    """Displacements of bore and ball per pressure, on cells numbered as in `polar_mesh`."""

    # compliance about the axis of the mesh, on a grid with the same number of cells in every ring
    compliance: Compliance
    mask: Numbers  # (cells of the grid,), mask of the cells of the film; the others lie beyond the end of the bore
    correction: CupCorrection | None = None  # further displacements of a cup that is not a closed shell

    @classmethod
    def of(cls, surface: Surface, joint: Joint, grid: Grid) -> ElasticSoftness:
        """Compute the compliance of one joint on rings about any axis; `surface` is the same about each."""
        from ..elasticity.off_axis.compliance import make_compliance  # slow to import

        compliance = make_compliance(surface, joint, Cup(), grid)
        return cls(compliance=compliance, mask=numpy.ones(grid.rings * grid.meridians, dtype=bool))

    @property
    def _shape(self) -> tuple[int, int]:
        return self.compliance.grid.rings, self.compliance.grid.meridians

    @cached_property
    def diagonal(self) -> Numbers:
        """Displacement of each cell in mm per pressure on it in MPa (cells,), without the correction."""
        rings, meridians = self._shape
        unit = numpy.zeros((rings, rings, meridians))
        unit[numpy.arange(rings), numpy.arange(rings), 0] = 1.0
        response = self.compliance.softness(unit)
        return numpy.repeat(response[numpy.arange(rings), numpy.arange(rings), 0], meridians)[self.mask]

    def __call__(self, pressure: Numbers) -> Numbers:
        """Compute the displacements in mm (cells,) under pressures in MPa (cells,)."""
        everywhere = numpy.zeros(len(self.mask))
        everywhere[self.mask] = pressure
        displacement = self.compliance.softness(everywhere.reshape(1, *self._shape)).ravel()[self.mask]
        return displacement if self.correction is None else displacement + self.correction(pressure)
