"""Reynolds' equation of a pressed contact: mesh, deformation, gap and start, and the way to its steady film."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil, degrees, pi, radians
from typing import TYPE_CHECKING, Any, cast

import numpy

from ..contact import Contact
from ..core.arrays import Numbers
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.grid import Grid
from ..problem.gaps import LinearGap, select_gap
from .dry_contact import CupCorrection, DryContact, ElasticSoftness, frame_about, outline_angles
from .inlet import SpringEdge
from .mesh import FilmMesh, graded_rings, polar_mesh
from .reynolds import FilmProblem, FilmState, develop_film, solve_steady

if TYPE_CHECKING:
    from ..elasticity.off_axis.surfaces import Surface

ELASTIC_MODELS = ("exact", "tabulated")  # models of axial contacts whose elastic operator Reynolds' equation has


@dataclass(frozen=True, kw_only=True)
class _MeshSettings:
    """Mesh of Reynolds' equation: rings in the inlet length, angles in rad, cells in a ring, and the error it has.

    The error is the largest relative change of the films when rings and meridians are halved.
    """

    rings_of_inlet: float
    coarsest: float
    growth: float
    margin: float
    meridians: int
    first_turn: float
    error: float


_ON_SPRINGS = _MeshSettings(
    rings_of_inlet=6.0, coarsest=radians(2.0), growth=1.12, margin=pi, meridians=64, first_turn=1e-3, error=0.005
)
_ELASTIC = _MeshSettings(
    rings_of_inlet=5.0,
    coarsest=radians(3.0),
    growth=1.25,
    margin=radians(12.0),
    meridians=40,
    first_turn=5e-3,
    error=0.03,
)

_CELLS_OF_SIDES, _MAX_MERIDIANS = 9.0, 72
"""Number of cells in a ring times the angle of the sides in rad, and the largest number of cells."""

_LEAST_MARGIN = radians(3.0)  # smallest angle in rad between the contact and the end of the mesh
_MAX_OUT_OF_ROUND = radians(5.0)  # largest difference in rad of the angles from the load to the edge of a contact

_MAX_EDGE_RINGS, _MIN_RINGS_OF_INLET = 150, 2.0
"""Largest number of finest rings between the edges of all contacts, and the smallest number in an inlet length."""

_THICK, _THINNING = 4.0, 4.0
"""First film over the roughness of the dry gap on the mesh, and the ratio of the viscosities on the way to thinner."""

_THINNING_STEPS = 30  # largest number of Newton steps from one viscosity to the next


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactFilm:
    """Reynolds' equation of a contact, with its start."""

    problem: FilmProblem
    start: FilmState  # dry contact with the ball lifted to a film
    inside: Numbers  # (cells,), mask of the cells within the edge of the dry contact, where it is widest
    first_ring: int  # number of cells at the load
    thickening: float  # viscosity at which the start is a good estimate, over that of the lubricant
    settings: _MeshSettings

    def central(self, thickness: Numbers) -> Numbers:
        """Compute the mean film in mm at the load from films (..., cells)."""
        return numpy.asarray(thickness[..., : self.first_ring].mean(axis=-1))

    def minimum(self, thickness: Numbers) -> Numbers:
        """Compute the smallest film in mm within the edge of the dry contact from films (..., cells)."""
        return numpy.asarray(thickness[..., self.inside].min(axis=-1))

    def solve_steady(self) -> FilmState:
        """Solve for the steady film, from thick films to thin ones.

        A thin film is found from a thicker one of a higher viscosity, by Newton's method or by time steps. The result
        is not converged if one of them is not found.
        """
        rate = float(numpy.linalg.norm(self.problem.spin))
        steps = (self.settings.first_turn / rate, 3 / rate)
        ratio = self.thickening
        state = develop_film(self._thickened(ratio), self.start, *steps)
        while ratio > 1 and state.converged:
            ratio = max(ratio / _THINNING, 1.0)
            thinner = solve_steady(self._thickened(ratio), state, max_steps=_THINNING_STEPS)
            state = thinner if thinner.converged else develop_film(self._thickened(ratio), state, *steps)
        return state

    def _thickened(self, ratio: float) -> FilmProblem:
        return replace(self.problem, viscosity=ratio * self.problem.viscosity)


def check_reynolds(contact: Contact, dry: DryContact) -> None:
    """Check that Reynolds' equation can be solved for a contact.

    Raises ValueError: a model without a known elastic operator; a contact that the rim cuts, or that is far from round.
    """
    known = contact.model.name in ELASTIC_MODELS or isinstance(contact, OffAxisContact)
    if not (known or isinstance(dry.edge, SpringEdge)):
        raise ValueError(
            f"method = 'reynolds' is not possible for {contact.model.name}: it needs a contact on springs, such as "
            f"hess-forsbach, or that of {', '.join(ELASTIC_MODELS)} or sphere; use method='wave'"
        )
    if dry.cut and isinstance(contact, OffAxisContact):
        raise ValueError(
            f"method = 'reynolds' is not possible for an edge margin of {degrees(float(contact.edge_margin)):.1f} deg: "
            "the rim cuts the contact, and the film's mesh does not resolve its corner; use method='wave'"
        )
    low, high = _edge_bounds(contact)
    if high - low > _MAX_OUT_OF_ROUND:
        raise ValueError(
            f"method = 'reynolds' is not possible for a contact whose edge lies {degrees(low):.0f} to "
            f"{degrees(high):.0f} deg from its load: it needs a rounder one, within "
            f"{degrees(_MAX_OUT_OF_ROUND):.0f} deg; use method='wave'"
        )


def make_contact_film(
    contacts: Sequence[Contact], dry_contacts: Sequence[DryContact], spin: Numbers, viscosity: float
) -> ContactFilm:
    """Make Reynolds' equation of a contact; the viscosity is in MPa s.

    The contacts are those of one joint under loads along one axis, from the smallest to the largest. The mesh resolves
    the edges of all, and the first one is the start. `spin` (3,) is the rotation rate of the ball in rad/s, the largest
    one if it changes.

    Raises ValueError: an edge that moves too far for its short inlet.
    """
    contact, dry = contacts[0], dry_contacts[0]
    on_springs = isinstance(dry.edge, SpringEdge)
    settings = _ON_SPRINGS if on_springs else _ELASTIC
    bounds = [_edge_bounds(pressed) for pressed in contacts]
    low, high = min(bound[0] for bound in bounds), max(bound[1] for bound in bounds)
    rings = graded_rings(
        low,
        finest=_finest_ring(dry_contacts, spin, viscosity, settings, high - low),
        coarsest=settings.coarsest,
        rim=min(high + settings.margin, max(pi / 2, high + _LEAST_MARGIN)),
        growth=settings.growth,
        last_edge=high,
    )
    speed = dry.speed(spin)
    sides = dry.edge.side_speed(viscosity, speed, dry.contact_radius) / speed  # several cells lie in the sides
    meridians = min(max(settings.meridians, 8 * ceil(_CELLS_OF_SIDES / sides / 8)), _MAX_MERIDIANS)
    grid, frame = Grid(edges=rings, meridians=meridians), frame_about(dry.axis)
    mesh = polar_mesh(dry.radius, rings, meridians)
    in_bore = numpy.ones(mesh.cells, dtype=bool)
    if isinstance(contact, OffAxisContact):  # where the rim cuts the mesh, the film ends
        mesh = mesh.in_frame(frame)
        in_bore = numpy.asarray(mesh.direction[:, 2] > numpy.cos(float(contact.model.reach_of(contact.joint))))
    compliance, softness = _yielding(contact, dry, grid, frame, in_bore)
    mesh = mesh if in_bore.all() else mesh.within(in_bore)
    angle = numpy.arccos(numpy.clip(mesh.direction @ dry.axis, -1.0, 1.0))
    in_first = angle < bounds[0][1]
    if isinstance(contact, OffAxisContact):
        pressure, displacement = contact.pressure_at(mesh.direction), numpy.asarray(contact.displacement)
    else:
        pressure = contact.pressure(numpy.minimum(angle, bounds[0][1]))
        displacement = (float(contact.joint.clearance) + float(contact.indentation)) * dry.axis
    problem = FilmProblem(
        mesh=mesh,
        viscosity=viscosity,
        spin=spin,
        gap=_gap(contact, mesh, displacement),
        compliance=numpy.full(mesh.cells, compliance),
        rim_pressure=numpy.zeros(len(mesh.rim_cell)),
        force=float(contact.force) * dry.axis,
        softness=softness,
    )
    state = FilmState(
        pressure=numpy.where(in_first, pressure, 0.0), void=numpy.zeros(mesh.cells), eccentricity=displacement
    )
    gap = problem.thickness(state)
    thickening = _thickening(dry, spin, viscosity, gap[in_first])
    film = float(dry.edge.inlet_film(thickening * viscosity, numpy.asarray(speed)))
    # from the dry contact to this mean film; no film is below a third of it
    lift = max(film - float(gap[in_first].mean()), film / 3 - float(gap.min()))
    return ContactFilm(
        problem=problem,
        start=replace(state, eccentricity=displacement - lift * dry.axis),
        inside=angle < high,
        first_ring=meridians,
        thickening=thickening,
        settings=settings,
    )


def shortest_inlet(dry_contacts: Sequence[DryContact], spin: Numbers, viscosity: float) -> float:
    """Compute the shortest inlet length in mm of contacts, at one rotation rate."""
    return min(float(dry.edge.inlet_length(viscosity, numpy.asarray(dry.speed(spin)))) for dry in dry_contacts)


def _finest_ring(
    dry_contacts: Sequence[DryContact], spin: Numbers, viscosity: float, settings: _MeshSettings, band: float
) -> float:
    """Choose the width in rad of the finest rings, which lie in a band (rad) of edges."""
    inlet = shortest_inlet(dry_contacts, spin, viscosity) / dry_contacts[0].radius
    finest = max(min(inlet / settings.rings_of_inlet, settings.coarsest), band / _MAX_EDGE_RINGS)
    if finest > inlet / _MIN_RINGS_OF_INLET:
        raise ValueError(
            f"the edge of the contact moves by {degrees(band):.3g} deg, which is not allowed for an inlet length of "
            f"{degrees(inlet):.3g} deg: Reynolds' equation needs loads that change less, or thicker films"
        )
    return finest


def _edge_bounds(contact: Contact) -> tuple[float, float]:
    """Compute the smallest and the largest angle in rad from the load to the edge of a contact."""
    if not isinstance(contact, OffAxisContact):
        return float(contact.half_angle), float(contact.half_angle)
    _, angles = outline_angles(contact)
    return float(angles.min()), float(angles.max())


def _yielding(
    contact: Contact, dry: DryContact, grid: Grid, frame: Numbers, in_bore: Numbers
) -> tuple[float, ElasticSoftness | None]:
    """Return the compliance of the springs in mm/MPa, and the displacements of elastic bodies."""
    from ..elasticity.off_axis.surfaces import ClosedShell  # slow to import

    off_axis, model = isinstance(contact, OffAxisContact), cast("Any", contact.model)
    if isinstance(dry.edge, SpringEdge) and not (off_axis and contact.joint.ball is not None):
        return 1 / dry.edge.modulus, None
    surface: Surface = model.surface if off_axis else ClosedShell()
    softness = replace(ElasticSoftness.of(surface.isotropic, contact.joint, grid), mask=in_bore)
    if surface.isotropic == surface:
        return 0.0, softness
    correction = CupCorrection.of(model, contact.joint, grid, frame)
    return 0.0, replace(softness, correction=correction.within(in_bore))


def _gap(contact: Contact, mesh: FilmMesh, displacement: Numbers) -> Numbers:
    """Compute the film (cells,) in mm of the centred ball on the undeformed bore, worn or not."""
    clearance, radius = float(contact.joint.clearance), float(contact.joint.socket_radius)
    depth = contact.model.worn_depth(mesh.direction.T, radius) if isinstance(contact, OffAxisContact) else 0.0
    kind = select_gap(contact.model.gap, contact.joint) if hasattr(contact.model, "gap") else LinearGap
    length = float(numpy.linalg.norm(displacement))
    reach = mesh.direction @ displacement
    shape = kind(clearance=clearance, socket_radius=radius)
    angle = numpy.arccos(numpy.clip(reach / length, -1.0, 1.0))
    return numpy.asarray(reach - shape.displacement(angle, length - clearance) + depth)


def _thickening(dry: DryContact, spin: Numbers, viscosity: float, gap: Numbers) -> float:
    """Choose the first viscosity, relative to that of the lubricant, for a dry contact with an uneven gap in mm."""
    roughness, speed, ratio = float(gap.mean() - gap.min()), numpy.asarray(dry.speed(spin)), 1.0
    while float(dry.edge.inlet_film(ratio * viscosity, speed)) < _THICK * roughness:
        ratio *= _THINNING
    return ratio
