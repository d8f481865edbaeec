"""Film over a cycle of load and motion: the kinematic wave carried from instant to instant until it repeats."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import acos, pi

import numpy

from ..core.arrays import Numbers
from .dry_contact import DryContact
from .inlet import Edge
from .mesh import FilmMesh
from .wave import FilmWave

REPEAT_TOLERANCE = 1e-3
"""Largest mean change of the film from one cycle to the next, relative to the mean film; its error is below 1 %."""

_MAX_CYCLES = 60
"""Number of cycles after which a film that does not repeat is returned as it is."""

_FLOODED = 4.0
"""Film around the contacts, relative to the largest inlet film of the cycle."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleInstant:
    """Dry contact and motion at one instant of a cycle.

    Attributes
    ----------
    pressure : array (cells,)
        Dry pressure in MPa.
    axis : array (3,)
        Unit vector along the load.
    edge : Edge
        Rise of the pressure at the edge.
    spin : array (3,)
        Rotation rate of the ball in rad/s.
    duration : float
        Duration of the instant in s.
    interrupted : bool
        True if the ball was unloaded before this instant, so that lubricant covers the bore.
    """

    pressure: Numbers
    axis: Numbers
    edge: Edge
    spin: Numbers
    duration: float
    interrupted: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleFilm:
    """Film over a cycle that repeats.

    Attributes
    ----------
    thickness : array (instants, cells)
        Film thickness in mm; NaN outside the contacts.
    central, minimum : array (instants,)
        Film in mm at the load, and the smallest in the contact.
    error : array (instants,)
        Estimated relative error of a steady film at each instant.
    cycles : int
        Number of computed cycles.
    converged : bool
        True if the film at the end of a cycle equals that at its start to 1 %.
    """

    thickness: Numbers
    central: Numbers
    minimum: Numbers
    error: Numbers
    cycles: int
    converged: bool


def carry_over_cycle(mesh: FilmMesh, viscosity: float, instants: Sequence[CycleInstant]) -> CycleFilm:
    """Carry the film over cycles until its end equals its start to 1 %.

    Parameters
    ----------
    mesh : FilmMesh
        Cells of the bore.
    viscosity : float
        Viscosity in MPa s.
    instants : sequence of CycleInstant
        Loaded instants in their order; the first follows the last.
    """
    waves = _waves(mesh, viscosity, instants)
    film, inside = numpy.full(mesh.cells, waves[0].flood), waves[-1].contact.inside
    thickness = numpy.full((len(waves), mesh.cells), numpy.nan)
    cycles, change = 0, numpy.inf
    while change > REPEAT_TOLERANCE and cycles < _MAX_CYCLES:
        start = thickness[-1].copy()
        film = _carry_once(waves, instants, film, thickness)
        cycles += 1
        if cycles > 1:
            change = float(numpy.abs(thickness[-1] - start)[inside].mean() / thickness[-1][inside].mean())
    return _summarise(waves, thickness, cycles, change <= REPEAT_TOLERANCE)


def _carry_once(
    waves: Sequence[FilmWave], instants: Sequence[CycleInstant], film: Numbers, thickness: Numbers
) -> Numbers:
    """Carry the film over one cycle, write it into rows of `thickness`, and return the film at the end."""
    inside = waves[-1].contact.inside
    for index, (wave, instant) in enumerate(zip(waves, instants, strict=True)):
        film = wave.advance(numpy.where(instant.interrupted | ~inside, wave.flood, film), instant.duration)
        inside = wave.contact.inside
        thickness[index] = numpy.where(inside, film, numpy.nan)
    return film


def _waves(mesh: FilmMesh, viscosity: float, instants: Sequence[CycleInstant]) -> list[FilmWave]:
    """Make the wave of each instant, with the film around the contacts of the whole cycle."""
    contacts = [_contact(mesh, instant) for instant in instants]
    speeds = [contact.speed(instant.spin) for contact, instant in zip(contacts, instants, strict=True)]
    films = [
        float(contact.edge.inlet_film(viscosity, numpy.asarray(speed)))
        for contact, speed in zip(contacts, speeds, strict=True)
    ]
    flood = _FLOODED * max(films)
    return [
        FilmWave(contact=contact, viscosity=viscosity, spin=instant.spin, flood=flood)
        for contact, instant in zip(contacts, instants, strict=True)
    ]


def _contact(mesh: FilmMesh, instant: CycleInstant) -> DryContact:
    """Make the dry contact of an instant; its half angle is that of a round contact of the same area."""
    area = float(mesh.area[instant.pressure > 0].sum())
    half_angle = acos(max(1 - area / (2 * pi * mesh.radius**2), -1.0))
    return DryContact(
        mesh=mesh,
        pressure=instant.pressure,
        edge=instant.edge,
        axis=instant.axis,
        half_angle=half_angle,
        radius=mesh.radius,
    )


def _smallest(wave: FilmWave, film: Numbers) -> float:
    """Compute the smallest film in mm; in elastic contacts that of cells off the edge, at the outlet's constriction."""
    mesh, inside = wave.contact.mesh, wave.contact.inside
    if not wave.contact.edge.prescribed:
        return float(film[inside].min(initial=numpy.inf))
    borders = inside[mesh.first] != inside[mesh.second]
    interior = inside.copy()
    interior[mesh.first[borders]] = interior[mesh.second[borders]] = False
    cells = interior if interior.any() else inside
    return wave.contact.edge.outlet_ratio * float(film[cells].min(initial=numpy.inf))


def _summarise(waves: Sequence[FilmWave], thickness: Numbers, cycles: int, converged: bool) -> CycleFilm:
    """Collect central and smallest films, and the errors, of the last cycle."""
    nearest = [int((wave.contact.mesh.direction @ wave.contact.axis).argmax()) for wave in waves]
    central = thickness[numpy.arange(len(waves)), nearest]
    minimum = [_smallest(wave, row) for wave, row in zip(waves, thickness, strict=True)]
    error = [
        wave.contact.edge.wave_error(
            wave.viscosity, wave.contact.speed(wave.spin), max(wave.contact.contact_radius, 1e-9)
        )
        for wave in waves
    ]
    return CycleFilm(
        thickness=thickness,
        central=central,
        minimum=numpy.array(minimum),
        error=numpy.array(error),
        cycles=cycles,
        converged=converged,
    )
