"""Core of a contact that fresh lubricant does not reach within a cycle, and the slow drift of its film.

The film turns by half of each rotation of the ball. The ball returns after a cycle. Its film does not: half rotations
about several axes leave a net rotation. In the frame that turns with the film nothing slides, and the film changes
slowly. Averaged over a cycle, it obeys the same kinematic wave, with the mean pressure and the net rotation:

    ∂h/∂t + ∇·(V h - h³ ∇p_mean/(12 η)) = 0,  V = R Ω × n,  Ω = net rotation / duration.

Fresh lubricant around the core is drawn in by this drift. Without a net rotation the core is squeezed, h ~ t^(-1/2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, pi, radians

import numpy

from ..core.arrays import Numbers
from .dry_contact import DryContact, frame_about, square_mesh
from .inlet import Edge, SpringEdge
from .mesh import FilmMesh
from .wave import FilmWave

_IN_CONTACT = 0.5  # interpolated share of contact from which a point counts as in contact
_CELL_WIDTH = radians(1.0)  # width in rad of the cells of the drift, whatever the cells of the bore are
_MARGIN_CELLS = 3  # number of rings of these cells around the contact
_NO_ROTATION = 1e-9  # net rotation in rad that counts as none
_OUTSIDE = 1e-9  # distance from the triangles on their map, from which a point is certainly outside


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleInstant:
    """Dry contact and motion at one instant of a cycle."""

    pressure: Numbers  # (cells,), dry pressure in MPa
    axis: Numbers  # (3,), unit vector along the load
    edge: Edge  # rise of the pressure at the edge
    spin: Numbers  # (3,), rotation rate of the ball in rad/s
    duration: float  # duration of the instant in s
    interrupted: bool = False  # True if the ball was unloaded before this instant, so that lubricant covers the bore
    # (cells,), pressure in MPa on springs, continued smoothly beyond the edge, where it is negative; 0 there by default
    continuation: Numbers | None = None

    @property
    def signed_pressure(self) -> Numbers:
        """Pressure (cells,) in MPa, negative outside where its continuation is known."""
        return self.pressure if self.continuation is None else self.continuation


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmMotion:
    """Rotation of the film over a cycle, half of that of the ball."""

    mesh: FilmMesh
    instants: Sequence[CycleInstant]

    @cached_property
    def rotations(self) -> Numbers:
        """Rotations (instants, 3, 3) of the film from the start of the cycle to the end of each instant."""
        from scipy.spatial.transform import Rotation  # slow to import

        rotation = Rotation.identity()
        matrices = []
        for instant in self.instants:
            rotation = Rotation.from_rotvec(instant.spin * instant.duration / 2) * rotation
            matrices.append(rotation.as_matrix())
        return numpy.array(matrices)

    @cached_property
    def net_rotation(self) -> Numbers:
        """Rotation vector (3,) in rad by which the film turns in a cycle."""
        from scipy.spatial.transform import Rotation  # slow to import

        return numpy.asarray(Rotation.from_matrix(self.rotations[-1]).as_rotvec())

    @property
    def duration(self) -> float:
        return sum(instant.duration for instant in self.instants)

    @cached_property
    def triangles(self) -> Triangles:
        """Triangles between the centres of the cells that come into contact, and of two cells around them."""
        contact = numpy.zeros(self.mesh.cells, dtype=bool)
        for instant in self.instants:
            contact |= instant.pressure > 0
        return Triangles(self.mesh.direction, _with_neighbours(self.mesh, contact))

    @cached_property
    def drift_mesh(self) -> FilmMesh:
        """Cells about the axis of the net rotation, along whose rings the film of the core turns.

        The rings cover the first contact, turned back to the start of the cycle.
        """
        inside = numpy.flatnonzero(self.instants[0].pressure > 0)
        cells = inside if len(inside) else numpy.arange(1)  # without a first contact there is no core
        directions = self.mesh.direction[cells] @ self.rotations[0]
        middle = (self.mesh.area[cells, None] * directions).sum(axis=0)
        axis = self.net_rotation if numpy.linalg.norm(self.net_rotation) > _NO_ROTATION else middle
        axis = axis / numpy.linalg.norm(axis) * (1.0 if axis @ middle >= 0 else -1.0)
        angles = numpy.arccos(numpy.clip(directions @ axis, -1.0, 1.0))
        margin = _MARGIN_CELLS * _CELL_WIDTH
        first = max(float(angles.min()) - margin, 0.0)
        last = min(float(angles.max()) + margin, pi)
        start = 0.0 if first < margin else first
        edges = numpy.linspace(start, last, max(ceil((last - start) / _CELL_WIDTH), 1) + 1)
        return square_mesh(self.mesh.radius, edges, _CELL_WIDTH).in_frame(frame_about(axis))

    @cached_property
    def drifting(self) -> Numbers:
        """Mask (drift cells,) of the core, the film that stays in contact over the cycle, at the start of the cycle."""
        mask = numpy.zeros(self.drift_mesh.cells, dtype=bool)
        if any(instant.interrupted for instant in self.instants):
            return mask
        cells = numpy.arange(self.drift_mesh.cells)
        for rotation, instant in zip(self.rotations, self.instants, strict=True):
            nodes, weights = self.triangles.locate(self.drift_mesh.direction[cells] @ rotation.T)
            continued = instant.continuation is not None
            level = instant.signed_pressure if continued else (instant.pressure > 0) - _IN_CONTACT  # 0 at the edge
            cells = cells[(weights * level[nodes]).sum(axis=1) > 0]
        mask[cells] = True
        return mask

    @cached_property
    def _near_core(self) -> Numbers:
        """Numbers of the drift cells in the core, and of two cells around it."""
        return _with_neighbours(self.drift_mesh, self.drifting)

    def _interpolate(self, field: Numbers, directions: Numbers) -> Numbers:
        """Interpolate a field (cells,) in directions (n, 3) with its gradients; exact for quadratic fields."""
        nodes, weights = self.triangles.locate(directions)
        gradient = self.mesh.gradient(field, nodes.ravel()).reshape(*nodes.shape, 3)
        steps = self.mesh.radius * (directions[:, None, :] - self.mesh.direction[nodes])
        return numpy.asarray((weights * (field[nodes] + (gradient * steps).sum(axis=2) / 2)).sum(axis=1))

    @cached_property
    def _drift_triangles(self) -> Triangles:
        """Triangles between the centres of the drift cells near the core."""
        return Triangles(self.drift_mesh.direction, self._near_core)

    def to_drift_cells(self, film: Numbers) -> Numbers:
        """Interpolate a film (cells,) at the start of the cycle on the drift cells; 0 outside the core."""
        nodes, weights = self.triangles.locate(self.drift_mesh.direction)
        return numpy.where(self.drifting, (weights * film[nodes]).sum(axis=1), 0.0)

    def at_start(self, film: Numbers) -> Numbers:
        """Interpolate a film (drift cells,) of the core on the cells, at the start of the cycle; NaN outside."""
        return self._to_cells(film, numpy.arange(self.mesh.cells), numpy.eye(3))

    def core_film(self, film: Numbers, index: int) -> Numbers:
        """Carry a film (drift cells,) of the core from the start to the end of an instant: (cells,); NaN outside."""
        return self._to_cells(film, numpy.flatnonzero(self.instants[index].pressure > 0), self.rotations[index])

    def _to_cells(self, film: Numbers, cells: Numbers, rotation: Numbers) -> Numbers:
        """Interpolate a film (drift cells,) of the core, turned by a rotation, on some of the cells: (all cells,)."""
        carried = numpy.full(self.mesh.cells, numpy.nan)
        if not self.drifting.any():
            return carried
        nodes, weights = self._drift_triangles.locate(self.mesh.direction[cells] @ rotation)
        weights = weights * self.drifting[nodes]
        share = weights.sum(axis=1)
        mean = (weights * film[nodes]).sum(axis=1) / numpy.where(share > 0, share, 1.0)
        carried[cells] = numpy.where(share > _IN_CONTACT, mean, numpy.nan)
        return carried

    def drift_wave(self, viscosity: float, film: Numbers) -> FilmWave:
        """Make the wave of the film of the core, averaged over a cycle.

        The viscosity is in MPa s, and `film` (drift cells,) in mm at the start.
        """
        mesh, core = self.drift_mesh, self.drifting
        axis = (mesh.area[:, None] * mesh.direction)[core].sum(axis=0)
        axis /= numpy.linalg.norm(axis)
        half_angle = float(numpy.arccos(numpy.clip((mesh.direction[core] @ axis).min(), -1.0, 1.0)))
        # mean and least pressure in MPa over the cycle on the film near the core, 0 elsewhere
        cells, (mean, least) = self._near_core, numpy.zeros((2, mesh.cells))
        least[cells] = numpy.inf
        for rotation, instant in zip(self.rotations, self.instants, strict=True):
            pressure = self._interpolate(instant.signed_pressure, mesh.direction[cells] @ rotation.T)
            mean[cells] += instant.duration / self.duration * pressure
            least[cells] = numpy.minimum(least[cells], pressure)
        slope = 2 * float(mean[core].max()) / (mesh.radius * max(half_angle, 1e-3))
        contact = DryContact(
            mesh=mesh,
            pressure=mean,
            continuation=mean,
            level=least,
            edge=SpringEdge(slope=slope, modulus=0.0),
            axis=axis,
            half_angle=half_angle,
            radius=mesh.radius,
            region=core,
        )
        # the wave moves the film at half the rate of a ball: here the film itself turns
        spin = 2 * self.net_rotation / self.duration
        return FilmWave(contact=contact, viscosity=viscosity, spin=spin, flood=float(film[core].max()))


def _with_neighbours(mesh: FilmMesh, mask: Numbers) -> Numbers:
    """Return the numbers of the cells of a mask (cells,), and of two cells around them."""
    for _ in range(2):
        wider = mask.copy()
        wider[mesh.second[mask[mesh.first]]] = wider[mesh.first[mask[mesh.second]]] = True
        mask = wider
    return numpy.flatnonzero(mask)


class Triangles:
    """Linear interpolation between directions on a sphere, on triangles of their stereographic map.

    The triangles lie between the cells numbered by `nodes`; none of their directions (cells, 3) is opposite to z.
    """

    def __init__(self, directions: Numbers, nodes: Numbers) -> None:
        from scipy.spatial import ConvexHull, Delaunay  # slow to import

        points = _map(directions[nodes])
        self._mesh, self._nodes = Delaunay(points), nodes
        self._sides = ConvexHull(points).equations  # n_x x + n_y y + c, not above 0 inside

    def locate(self, directions: Numbers) -> tuple[Numbers, Numbers]:
        """Return numbers of three cells (n, 3) around each direction, and their weights: zeros outside."""
        points = _map(directions)
        distance = (points @ self._sides[:, :2].T + self._sides[:, 2]).max(axis=1)
        near = distance < _OUTSIDE  # SciPy compares each of the others with every triangle
        triangle = numpy.full(len(points), -1)
        triangle[near] = self._mesh.find_simplex(points[near])
        transform = self._mesh.transform[triangle]
        first = numpy.einsum("nij,nj->ni", transform[:, :2], points - transform[:, 2])
        weights = numpy.concatenate([first, 1 - first.sum(axis=1, keepdims=True)], axis=1)
        weights[triangle < 0] = 0.0
        return self._nodes[self._mesh.simplices[triangle]], weights


def _map(directions: Numbers) -> Numbers:
    """Map directions (n, 3) to a plane, stereographically about z."""
    return directions[:, :2] / (1 + directions[:, 2:])
