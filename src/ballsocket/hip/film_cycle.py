"""Instants of a cycle for the film by the kinematic wave: pressures, edges and motion on cells of the bore."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from ..elasticity.off_axis.grid import Grid
from ..lubrication.cycle_film import CycleFilm, carry_over_cycle
from ..lubrication.film_core import CycleInstant
from ..lubrication.inlet import Edge, ElasticEdge, SpringEdge
from ..lubrication.mesh import FilmMesh, polar_mesh, thinned_meridians
from .cup_frame import CupFrame
from .socket_foundation import CycleEquilibrium, SocketFoundation


@dataclass(frozen=True, kw_only=True, eq=False)
class CarriedFilm:
    """Film by the wave in the loaded instants of all activities of a cycle."""

    films: tuple[CycleFilm, ...]  # film of each activity, on the merged cells
    mesh: FilmMesh  # cells of the bore in the cup's frame, merged near the pole
    merged: Numbers  # int (cells,), number of the merged cell of each cell of the bore

    def joined(self, name: str) -> Numbers:
        """Join a value (instants,) of all activities."""
        return numpy.concatenate([getattr(film, name) for film in self.films])

    def mapped(self, name: str) -> Numbers:
        """Join a map (instants, cells) of all activities, on the cells of the bore."""
        return self.joined(name)[:, self.merged]


def carry_film(
    frame: CupFrame,
    foundation: SocketFoundation,
    equilibrium: CycleEquilibrium,
    depth: Numbers,
    viscosity: float,
    grid: Grid,
    cycles: int,
) -> CarriedFilm:
    """Carry the film over cycles of each activity, on cells of the grid merged near the pole.

    `depth` (cells,) is the worn depth in mm, and the viscosity is in MPa s.
    """
    meridians = thinned_meridians(grid.edges, grid.meridians)
    mesh = polar_mesh(foundation.socket_radius, grid.edges, meridians)
    starts = numpy.concatenate([[0], numpy.cumsum(meridians)[:-1]])
    merged = (starts[:, None] + numpy.arange(grid.meridians) * meridians[:, None] // grid.meridians).ravel()
    pressure, levels = _merge(equilibrium.pressure, merged), foundation.edge_field(equilibrium, depth)
    forces = frame.socket_forces(equilibrium.displacement)
    axes = forces / numpy.linalg.norm(forces, axis=1)[:, None]
    durations = frame.cycle.seconds[frame.loaded]
    spins = frame.rotation_increments / durations[:, None]
    continuation: Sequence[Numbers | None] = [None] * len(pressure)
    if foundation.edge_exponent == 1:
        outside = numpy.minimum(foundation.max_stiffness * _merge(levels, merged), 0.0)
        signed = numpy.where(pressure > 0, pressure, outside)
        continuation, edges = list(signed), _spring_edges(mesh, signed, foundation.max_stiffness)
    else:
        edges = _elastic_edges(frame, foundation, equilibrium, levels, grid, axes)
    gaps = numpy.diff(frame.loaded, prepend=frame.loaded[-1] - frame.cycle.n_steps)
    instants = [
        CycleInstant(
            pressure=pressure[index],
            continuation=continuation[index],
            axis=axes[index],
            edge=edges[index],
            spin=spins[index],
            duration=float(durations[index]),
            interrupted=bool(gaps[index] != 1),
        )
        for index in range(len(axes))
    ]
    films = [
        carry_over_cycle(mesh, viscosity, [instants[index] for index in loads], cycles) for _, loads in frame.activities
    ]
    return CarriedFilm(films=tuple(films), mesh=mesh, merged=merged)


def _merge(fields: Numbers, merged: Numbers) -> Numbers:
    """Compute means of fields (instants, cells of the bore) over the merged cells."""
    means: Numbers = numpy.stack([numpy.bincount(merged, row) for row in fields]) / numpy.bincount(merged)
    return means


def _spring_edges(mesh: FilmMesh, pressure: Numbers, modulus: float) -> list[Edge]:
    """Find the mean slope at the edge of each contact, from pressures (instants, cells) continued beyond the edge."""
    edges: list[Edge] = []
    for row in pressure:
        faces = numpy.flatnonzero((row[mesh.first] > 0) != (row[mesh.second] > 0))
        gradient = (mesh.gradient(row, mesh.first[faces]) + mesh.gradient(row, mesh.second[faces])) / 2
        slopes = numpy.linalg.norm(gradient, axis=1)
        slope = float(slopes @ mesh.width[faces]) / float(mesh.width[faces].sum()) if len(faces) else float(row.max())
        edges.append(SpringEdge(slope=slope, modulus=modulus))
    return edges


def _elastic_edges(
    frame: CupFrame,
    foundation: SocketFoundation,
    equilibrium: CycleEquilibrium,
    levels: Numbers,
    grid: Grid,
    axes: Numbers,
) -> list[Edge]:
    """Find the edge of each contact of elastic bodies; contacts of few rings have the median of the others."""
    from ..elasticity.off_axis.contact_patch import ContactPatch  # slow to import

    exponent, radius = foundation.edge_exponent, foundation.socket_radius
    shape = (len(axes), grid.rings, grid.meridians)
    rows = zip(equilibrium.pressure.reshape(shape), levels.reshape(shape), axes, strict=True)
    inset = foundation.edge_inset
    constants = numpy.array(
        [
            ContactPatch(grid=grid, pressure=pressure, level=level, axis=axis, inset=inset).edge_constant(exponent)
            for pressure, level, axis in rows
        ]
    )
    known = constants[numpy.isfinite(constants) & (constants > 0)]
    median = float(numpy.median(known)) if len(known) else float(equilibrium.pressure.max())
    values = numpy.where(numpy.isfinite(constants) & (constants > 0), constants, median) / radius**exponent
    modulus = float(frame.joint.effective_modulus)
    return [ElasticEdge(coefficient=float(value), modulus=modulus) for value in values]
