"""Dry contact under a film: pressure on the cells of a mesh about the load, and its edge."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, isfinite, pi, sin

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

_RINGS_OUTSIDE = 2
"""Rings of lubricant around the contact."""

_MIN_RINGS = 8
"""Smallest number of rings in a contact."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DryContact:
    """Pressure of a dry contact on a mesh, with its edge.

    Attributes
    ----------
    mesh : FilmMesh
        Cells of the bore at and around the contact, in the frame of the contact.
    pressure : array (cells,)
        Dry pressure in MPa.
    edge : Edge
        Rise of the pressure at the edge.
    axis : array (3,)
        Unit vector along the load.
    half_angle : float
        Half angle of the contact in rad.
    radius : float
        Radius of the bore in mm.
    cut : bool
        True if the rim of the bore cuts the contact.
    """

    mesh: FilmMesh
    pressure: Numbers
    edge: Edge
    axis: Numbers
    half_angle: float
    radius: float
    cut: bool = False

    @property
    def contact_radius(self) -> float:
        """Arc in mm from the load to the edge."""
        return self.radius * self.half_angle

    @property
    def inside(self) -> Numbers:
        """Mask of the cells in contact (cells,)."""
        mask: Numbers = self.pressure > 0
        return mask

    @cached_property
    def edge_distance(self) -> Numbers:
        """Estimated distance of each cell from the edge in mm; 0 outside."""
        return self.edge.distance(self.pressure)

    def speed(self, spin: Numbers) -> float:
        """Compute the speed in mm/s of the ball's surface at the pole of the load, across the load."""
        return self.radius * float(numpy.linalg.norm(numpy.cross(self.axis, spin)))

    def inward_speed(self, spin: Numbers, direction: Numbers) -> Numbers:
        """Compute the speed in mm/s of the ball's surface towards the load at directions (n, 3)."""
        velocity = self.radius * numpy.cross(spin, direction)
        towards = self.axis - (direction @ self.axis)[:, None] * direction
        length = numpy.linalg.norm(towards, axis=1)
        return numpy.einsum("ij,ij->i", velocity, towards) / numpy.where(length > 0, length, 1.0)


def find_edge(contact: Contact) -> Edge:
    """Find the kind of edge of a single contact, and its constants.

    Raises
    ------
    ValueError
        A contact whose pressure rises neither linearly nor as a square root at its edge.
    """
    slope, coefficient = float(contact.edge_slope), float(contact.edge_coefficient)
    if isfinite(slope):
        return SpringEdge(slope=slope, modulus=float(contact.foundation_modulus))
    if isfinite(coefficient):
        return ElasticEdge(coefficient=coefficient, modulus=float(contact.joint.effective_modulus))
    raise ValueError(f"the pressure of {contact.model.name} has no edge that a film can enter")


def check_single_contact(contact: Contact) -> Contact:
    """Return a contact that a film can separate.

    Raises
    ------
    TypeError
        Another object than a contact.
    ValueError
        More than one contact; a contact that failed or carries no load; a joint without clearance.
    """
    if not isinstance(contact, Contact):
        raise TypeError(f"contact must be a pressed contact, got {type(contact).__name__}")
    if not isinstance(contact.force, float):
        raise ValueError("a film needs a single contact: press one joint with one load")
    if contact.status is not Status.OK:
        raise ValueError(f"a film needs a contact with a result, got status {Status(contact.status).name}")
    if contact.joint.clearance <= 0:
        raise ValueError(
            f"clearance = {float(contact.joint.clearance):.6g} mm is not allowed: without clearance no lubricant enters"
        )
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
    mesh = _mesh(radius, edges, half_angle / rings)
    theta = numpy.arccos(numpy.clip(mesh.direction[:, 2], -1.0, 1.0))
    pressure = numpy.where(theta < half_angle, contact.pressure(numpy.minimum(theta, half_angle)), 0.0)
    return DryContact(
        mesh=mesh,
        pressure=pressure,
        edge=find_edge(contact),
        axis=numpy.array([0.0, 0.0, 1.0]),
        half_angle=half_angle,
        radius=radius,
    )


def _off_axis(contact: OffAxisContact, half_angle: float, radius: float, rings: int) -> DryContact:
    """Evaluate a contact of `Sphere` on a mesh about its force, as far as its outline."""
    axis = numpy.asarray(contact.force_vector) / numpy.linalg.norm(contact.force_vector)
    outline = contact.outline / numpy.linalg.norm(contact.outline, axis=1)[:, None]
    reach = float(numpy.arccos(numpy.clip((outline @ axis).min(), -1.0, 1.0)))
    width = half_angle / rings
    edges = width * numpy.arange(ceil(reach / width) + _RINGS_OUTSIDE + 1)
    mesh = _mesh(radius, edges, width).in_frame(_frame(axis))
    return DryContact(
        mesh=mesh,
        pressure=numpy.asarray(contact.pressure_at(mesh.direction)),
        edge=find_edge(contact),
        axis=axis,
        half_angle=half_angle,
        radius=radius,
        cut=bool(contact.edge_loaded),
    )


def _mesh(radius: float, edges: Numbers, width: float) -> FilmMesh:
    """Make a polar mesh whose cells are about square."""
    edges = edges[edges < pi]
    meridians = 12 * max(round(2 * pi * sin(min(edges[-1], pi / 2)) / width / 12), 4)
    return polar_mesh(radius, edges, thinned_meridians(edges, meridians))


def _frame(axis: Numbers) -> Numbers:
    """Make a right-handed frame (3, 3) whose third row is an axis, and whose first row lies near x."""
    helper = numpy.array([1.0, 0.0, 0.0]) if abs(axis[0]) < cos(0.1) else numpy.array([0.0, 1.0, 0.0])
    second = numpy.cross(axis, helper)
    second /= numpy.linalg.norm(second)
    return numpy.stack([numpy.cross(second, axis), second, axis])


def elastic_softness(joint: Joint, ring_edges: Numbers, meridians: int) -> Numbers:
    """Compute the matrix (cells, cells) of displacements per pressure in mm/MPa of a closed shell and its ball.

    Cells are numbered as in `polar_mesh`, with the same number in every ring.
    """
    from ..elasticity.off_axis.compliance import make_compliance  # slow to import
    from ..elasticity.off_axis.surfaces import ClosedShell

    grid = Grid(edges=ring_edges, meridians=meridians)
    softness = make_compliance(ClosedShell(), joint, Cup(), grid).softness
    unit = numpy.zeros((grid.rings, grid.rings, meridians))
    unit[numpy.arange(grid.rings), numpy.arange(grid.rings), 0] = 1.0
    response = softness(unit)  # of a unit pressure at the first meridian: (loaded ring, ring, meridian)
    turn = (numpy.arange(meridians)[:, None] - numpy.arange(meridians)) % meridians
    return response.transpose(1, 2, 0)[:, turn].transpose(0, 1, 3, 2).reshape(2 * (grid.rings * meridians,))
