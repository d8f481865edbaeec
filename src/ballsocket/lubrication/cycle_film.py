"""Film over a cycle of load and motion: by the kinematic wave until it repeats, and by Reynolds' equation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import acos, pi
from typing import TYPE_CHECKING

import numpy

from ..core.arrays import Numbers
from .dry_contact import DryContact
from .inlet import Edge
from .mesh import FilmMesh
from .wave import FilmWave

if TYPE_CHECKING:
    from .reynolds import FilmProblem, FilmState

REPEAT_TOLERANCE = 0.01
"""Largest mean change of the film from one cycle to the next, relative to the mean film."""

_FIRST_CYCLES, _LEAP, _LAST_CYCLES = 3, 94, 12
"""Cycles before a leap over others, number of cycles in the leap, and largest number of cycles after it."""

_FALLING = 0.05
"""Relative fall of the film in the third cycle from which a cell counts as out of reach of fresh lubricant."""

_NO_FILM = 1e-30
"""Film in mm, and area in mm², that count as none."""

_FLOODED = 3.0
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
    unreached : float
        Share of the last contact that fresh lubricant does not reach: there the film falls with the root of time.
    cycles : int
        Number of cycles from a flooded bore.
    converged : bool
        True if the film at the end of a cycle equals that at its start to 1 %.
    """

    thickness: Numbers
    central: Numbers
    minimum: Numbers
    error: Numbers
    unreached: float
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
    film = start = numpy.full(mesh.cells, waves[0].flood)
    thickness = numpy.full((len(waves), mesh.cells), numpy.nan)
    inside = waves[-1].contact.inside
    cycles, change, unreached = 0, numpy.inf, numpy.zeros(mesh.cells, dtype=bool)
    while change > REPEAT_TOLERANCE and cycles < _FIRST_CYCLES + _LEAP + _LAST_CYCLES:
        if cycles == _FIRST_CYCLES:
            unreached = inside & (film < (1 - _FALLING) * start)
            film, cycles = _leap(start, film), cycles + _LEAP
        start = film
        film = _carry_once(waves, instants, film, thickness)
        cycles += 1
        change = float(numpy.abs(film - start)[inside].sum() / max(float(film[inside].sum()), _NO_FILM))
    share = float(mesh.area[unreached].sum() / mesh.area[inside].sum(initial=_NO_FILM))
    return _summarise(waves, thickness, share, cycles, change <= REPEAT_TOLERANCE)


def _leap(start: Numbers, film: Numbers) -> Numbers:
    """Estimate the film after many more cycles from the films at both ends of one.

    Fresh lubricant repeats. A film out of its reach is squeezed: 1/h² grows by the same amount in each cycle.
    """
    with numpy.errstate(divide="ignore"):
        growth = numpy.maximum(film**-2.0 - start**-2.0, 0.0)
        later: Numbers = (film**-2.0 + _LEAP * growth) ** -0.5
    return numpy.where(film > 0, later, film)


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


def _summarise(
    waves: Sequence[FilmWave], thickness: Numbers, unreached: float, cycles: int, converged: bool
) -> CycleFilm:
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
        unreached=unreached,
        cycles=cycles,
        converged=converged,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadStep:
    """Load and motion of one step of a cycle on springs.

    Attributes
    ----------
    force : array (3,)
        Load on the ball in N.
    spin : array (3,)
        Rotation rate of the ball in rad/s.
    duration : float
        Duration in s.
    """

    force: Numbers
    spin: Numbers
    duration: float


def solve_cycle(
    problem: FilmProblem, start: FilmState, steps: Sequence[LoadStep], cycles: int = 1
) -> tuple[list[FilmState], bool]:
    """Solve Reynolds' equation over cycles of load and motion, by implicit Euler.

    Parameters
    ----------
    problem : FilmProblem
        Film, mesh and springs; its force and spin are replaced by those of the steps.
    start : FilmState
    steps : sequence of LoadStep
    cycles : int
        Number of cycles.

    Returns
    -------
    pair
        States at the end of each step of the last cycle, and True if all steps converged.
    """
    state, converged, states = start, True, [start]
    for _ in range(cycles):
        states = []
        for step in steps:
            state, has_converged = _solve_step(replace(problem, force=step.force, spin=step.spin), state, step.duration)
            converged &= has_converged
            states.append(state)
    return states, converged


def _solve_step(problem: FilmProblem, state: FilmState, duration: float) -> tuple[FilmState, bool]:
    """Solve one step, in parts if Newton's method does not converge."""
    from .reynolds import advance  # slow to import

    for parts in (1, 4):
        later, converged = state, True
        for _ in range(parts):
            volume = problem.thickness(later) * (1 - later.void)
            later = advance(problem, later, volume=volume, step=duration / parts, tolerance=1e-4, max_steps=25)
            converged = later.converged
            if not converged:
                break
        if converged:
            return later, True
    return later, False
