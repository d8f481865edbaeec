"""Film over a cycle of load and motion by the kinematic wave, after a number of cycles, with its stated error.

Most of the contact is refreshed in every cycle: its film repeats after two or three. A core may stay in contact, and
its film changes over many cycles: `film_core` has its drift. The error is that of the wave, of the cells, and of
changes that cells and instants smear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import acos, pi

import numpy

from ..core.arrays import Numbers
from .dry_contact import DryContact
from .film_core import CycleInstant, FilmMotion
from .mesh import FilmMesh
from .wave import FilmWave

_CORE_CELL_ERROR = 0.5
"""Relative error of the film of the core times the number of rings of the drift's cells in it; measured."""

_REFRESHED_CELL_ERROR = 0.6
"""Relative error of the mean film of the refreshed part times the number of rings of cells; measured."""

_SMEARED_SHARE = 0.75
"""Error of a film that changes, relative to its change over a cell and in an instant; measured in a reversing cycle."""

_SMALL_CORE = 0.01  # share of a contact up to which the error of its core does not count


def film_errors(
    waves: Sequence[FilmWave], thickness: Numbers, core: Numbers, central: Numbers, motion: FilmMotion
) -> Numbers:
    """Estimate the relative error (instants,) of central and smallest film.

    `thickness` (instants, cells) in mm is NaN outside the contacts; `core` masks the film that fresh lubricant does not
    reach within a cycle, and `central` (instants,) is the film at the load in mm.
    """
    inside = numpy.isfinite(thickness)
    has_core = (core & inside) @ motion.mesh.area > _SMALL_CORE * (inside @ motion.mesh.area)
    core_error = numpy.where(has_core, _CORE_CELL_ERROR / _rings(motion.drifting.sum()), 0.0)
    cell_error = numpy.array([wave.contact.cell_error for wave in waves]) / _rings(inside.sum(axis=1))
    smeared = _SMEARED_SHARE * _changes_at_loads(waves, thickness, core, central)
    return _largest_in_passage(waves, motion) + numpy.maximum(cell_error, core_error) + smeared


def refreshed_mean_error(waves: Sequence[FilmWave], thickness: Numbers) -> float:
    """Estimate the relative error of the mean film of the refreshed part over the cycle."""
    rings = _rings(numpy.isfinite(thickness).sum(axis=1))
    return float((_wave_errors(waves) + _REFRESHED_CELL_ERROR / rings).mean())


def _rings(cells: Numbers) -> Numbers:
    """Estimate the number of rings in round regions of square cells; at least 1."""
    return numpy.sqrt(numpy.maximum(cells / pi, 1.0))


def _wave_errors(waves: Sequence[FilmWave]) -> Numbers:
    """Compute the error (instants,) of the wave in a steady contact with the load and motion of each instant."""
    return numpy.array(
        [
            wave.contact.edge.wave_error(
                wave.viscosity, wave.contact.speed(wave.spin), max(wave.contact.contact_radius, 1e-9)
            )
            for wave in waves
        ]
    )


def _largest_in_passage(waves: Sequence[FilmWave], motion: FilmMotion) -> Numbers:
    """Compute the largest error (instants,) of the wave since the lubricant entered that is now in the contact."""
    errors = _wave_errors(waves)
    paths = [
        instant.duration * wave.contact.speed(wave.spin) / 2
        for instant, wave in zip(motion.instants, waves, strict=True)
    ]
    largest = errors.copy()
    for index, wave in enumerate(waves):
        path, age = 0.0, 0
        while path < 2 * wave.contact.contact_radius and age < len(waves):
            path += paths[index - age]
            age += 1
            largest[index] = max(largest[index], errors[index - age])
    return largest


def _changes_at_loads(waves: Sequence[FilmWave], thickness: Numbers, core: Numbers, central: Numbers) -> Numbers:
    """Compute the relative change (instants,) of the film at the load over a cell and in an instant.

    It is 0 where it is not known, and in the core, which is carried from cycle to cycle without cells or instants.
    """
    mesh, instants = waves[0].contact.mesh, numpy.arange(len(waves))
    cells = numpy.array([numpy.argmax(mesh.direction @ wave.contact.axis) for wave in waves])
    slopes = [numpy.linalg.norm(mesh.gradient(thickness[index], cells[[index]])) for index in instants]
    over_cell = slopes * numpy.sqrt(mesh.area[cells])
    in_instant = numpy.abs(numpy.roll(central, -1) - numpy.roll(central, 1)) / 2
    change = numpy.nan_to_num((over_cell + in_instant) / numpy.where(central > 0, central, numpy.inf))
    return numpy.where(core[instants, cells], 0.0, change)


REPEAT_TOLERANCE = 0.01  # largest mean change of the film from one cycle to the next, relative to the mean film
SETTLED_CHANGE = 0.1  # largest relative change of a settled film of the core while the number of cycles doubles

_MARCHED, _MOST_MARCHED = 3, 10
"""Least and largest number of cycles that are followed instant by instant: one before the core's drift."""

_NO_FILM = 1e-30  # film in mm, and area in mm², that count as none
_FLOODED = 3.0  # film around the contacts, relative to the largest inlet film of the cycle


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleFilm:
    """Film over a cycle, after a number of cycles."""

    area: Numbers  # (cells,), areas of the cells in mm²
    thickness: Numbers  # (instants, cells), film thickness in mm; NaN outside the contacts
    core: Numbers  # (instants, cells), mask of the film that fresh lubricant does not reach within a cycle
    central: Numbers  # (instants,), film in mm at the load
    minimum: Numbers  # (instants,), smallest film in mm in the contact
    # (instants,), estimated relative error of the central and the smallest film: of the wave, of the cells, and of
    # changes that cells and instants smear
    error: Numbers
    # estimated relative error of the mean of `refreshed_mean` over the cycle; it contains the cells at the edge
    refreshed_mean_error: float
    drift: float  # angle in rad by which the film turns in a cycle, while the ball returns
    cycles: int  # number of cycles from a flooded bore
    change: float  # mean change of the film in the last cycle, relative to the mean film
    # True if the mean film of the core is expected to fall by at most 10 % while the number of cycles doubles
    settled: bool
    # the same for the smallest film of the core, which falls where the film turns about a point of the core
    smallest_settled: bool

    @property
    def converged(self) -> bool:
        """True if the film at the end of a cycle equals that at its start to 1 %."""
        return self.change <= REPEAT_TOLERANCE

    @property
    def inside(self) -> Numbers:
        """Mask (instants, cells) of the contacts."""
        return numpy.isfinite(self.thickness)

    @cached_property
    def refreshed_share(self) -> Numbers:
        """Share (instants,) of the contact that fresh lubricant reaches within a cycle."""
        contact = self.inside @ self.area
        return 1 - (self.core & self.inside) @ self.area / numpy.where(contact > 0, contact, 1.0)

    @cached_property
    def refreshed_mean(self) -> Numbers:
        """Mean film (instants,) in mm of the refreshed part; NaN without one."""
        return self._mean(self.inside & ~self.core)

    @cached_property
    def core_mean(self) -> Numbers:
        """Mean film (instants,) in mm of the core; NaN without one."""
        return self._mean(self.inside & self.core)

    def _mean(self, mask: Numbers) -> Numbers:
        """Compute the mean film (instants,) in mm over the cells of a mask (instants, cells)."""
        area = mask @ self.area
        total = numpy.where(mask, self.thickness, 0.0) @ self.area
        return numpy.where(area > 0, total / numpy.where(area > 0, area, 1.0), numpy.nan)


def carry_over_cycle(mesh: FilmMesh, viscosity: float, instants: Sequence[CycleInstant], cycles: int) -> CycleFilm:
    """Carry the film over a number of uninterrupted cycles from a flooded bore; the viscosity is in MPa s.

    The first cycle is followed instant by instant. The film of the core then drifts over the others, averaged over a
    cycle. Beside the core of the last cycles, the refreshed part is followed instant by instant until it repeats to
    1 %. The first of the loaded instants follows the last.
    """
    waves = _waves(mesh, viscosity, instants)
    motion = FilmMotion(mesh=mesh, instants=instants)
    thickness = numpy.full((len(waves), mesh.cells), numpy.nan)
    start = numpy.full(mesh.cells, waves[0].flood)
    film = _carry_once(waves, instants, start, thickness)
    core_start = numpy.isfinite(motion.at_start(motion.drifting))
    refreshed = waves[-1].contact.inside & ~core_start
    marched, change = 1, _mean_change(mesh, start, film, refreshed)
    drifts = bool(motion.drifting.any()) and cycles > _MARCHED
    if drifts:
        drift = _drift(motion, viscosity, motion.to_drift_cells(film), cycles)
        film = numpy.where(core_start, motion.at_start(drift.before_marching), film)
    while marched < min(cycles, _MOST_MARCHED) and (marched < _MARCHED or change > REPEAT_TOLERANCE):
        start, film = film, _carry_once(waves, instants, film, thickness)
        marched += 1
        change = _mean_change(mesh, start, film, refreshed)
    if not drifts:
        drift = _undrifted(motion, start, film)
    carried = numpy.array([motion.core_film(drift.film, index) for index in range(len(waves))])
    core = numpy.isfinite(carried) & numpy.isfinite(thickness)
    if drifts:
        thickness = numpy.where(core, carried, thickness)
    central = _at_loads(motion, waves, thickness)
    return CycleFilm(
        area=mesh.area,
        thickness=thickness,
        core=core,
        central=central,
        minimum=numpy.array([_smallest(wave, row) for wave, row in zip(waves, thickness, strict=True)]),
        error=film_errors(waves, thickness, core, central, motion),
        refreshed_mean_error=refreshed_mean_error(waves, thickness),
        drift=float(numpy.linalg.norm(motion.net_rotation)),
        cycles=cycles,
        change=max(change, drift.change),
        settled=drift.settled,
        smallest_settled=drift.smallest_settled,
    )


@dataclass(frozen=True, kw_only=True)
class _Drift:
    """Film (drift cells,) in mm of the core before the last marched cycles and at the end, and its state.

    `change` is the mean change in the last cycle; for the others see `CycleFilm`.
    """

    before_marching: Numbers
    film: Numbers
    change: float
    settled: bool
    smallest_settled: bool


def _undrifted(motion: FilmMotion, start: Numbers, film: Numbers) -> _Drift:
    """Collect the core of films (cells,) at start and end of the last cycle, all of which were marched."""
    before, last = motion.to_drift_cells(start), motion.to_drift_cells(film)
    settled = not motion.drifting.any()
    return _Drift(
        before_marching=before,
        film=last,
        change=_mean_change(motion.drift_mesh, before, last, motion.drifting),
        settled=settled,
        smallest_settled=settled,
    )


def _mean_change(mesh: FilmMesh, start: Numbers, film: Numbers, mask: Numbers) -> float:
    """Compute the mean change between two films over a mask, relative to their mean."""
    change = (numpy.abs(film - start) * mesh.area)[mask].sum()
    return float(change / max(float((film * mesh.area)[mask].sum()), _NO_FILM))


def _drift(motion: FilmMotion, viscosity: float, film: Numbers, cycles: int) -> _Drift:
    """Carry a film (drift cells,) of the core from the end of the first cycle over all the others."""
    wave, core = motion.drift_wave(viscosity, film), motion.drifting
    films, done = [film], 1
    for end in (max(cycles // 4, 1), cycles // 2, cycles - _MARCHED + 1, cycles - 1, cycles):
        films.append(wave.advance(films[-1], (end - done) * motion.duration))
        done = end
    _, quarter, halfway, before_marching, before, last = films
    area = motion.drift_mesh.area * core
    return _Drift(
        before_marching=before_marching,
        film=last,
        change=_mean_change(motion.drift_mesh, before, last, core),
        settled=_is_settled(*(float(area @ film) for film in (quarter, halfway, last))),
        smallest_settled=_is_settled(*(float(film[core].min()) for film in (quarter, halfway, last))),
    )


def _is_settled(quarter: float, halfway: float, last: float) -> bool:
    """Check if a film is expected to fall by at most 10 % while the number of cycles doubles.

    From one doubling to the next its fall shrinks by the same factor. A film that is squeezed, h ~ N^(-1/2), falls by
    the same share.
    """
    before, fall = quarter / max(halfway, _NO_FILM) - 1, halfway / max(last, _NO_FILM) - 1
    shrinks = min(fall / before, 1.0) if before > 0 else 1.0
    return shrinks * fall <= SETTLED_CHANGE


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
    waves = []
    for instant in instants:
        area = float(mesh.area[instant.pressure > 0].sum())
        contact = DryContact(
            mesh=mesh,
            pressure=instant.pressure,
            edge=instant.edge,
            axis=instant.axis,
            half_angle=acos(max(1 - area / (2 * pi * mesh.radius**2), -1.0)),  # of a round contact of the same area
            radius=mesh.radius,
            continuation=instant.continuation,
        )
        waves.append(FilmWave(contact=contact, viscosity=viscosity, spin=instant.spin))
    flood = _FLOODED * max(wave.inlet_film for wave in waves)
    return [replace(wave, flood=flood) for wave in waves]


def _smallest(wave: FilmWave, film: Numbers) -> float:
    """Compute the smallest film in mm; in elastic contacts that of cells off the edge, at the outlet's constriction."""
    contact = wave.contact
    if not contact.edge.prescribed:
        return float(film[contact.inside].min(initial=numpy.inf))
    cells = contact.interior if contact.interior.any() else contact.inside
    return contact.edge.outlet_ratio * float(film[cells].min(initial=numpy.inf))


def _at_loads(motion: FilmMotion, waves: Sequence[FilmWave], thickness: Numbers) -> Numbers:
    """Interpolate films (instants, cells) at the loads: (instants,); NaN where a load lies outside its contact."""
    nodes, weights = motion.triangles.locate(numpy.array([wave.contact.axis for wave in waves]))
    values = numpy.take_along_axis(thickness, nodes, axis=1)
    weights = numpy.where(numpy.isfinite(values), weights, 0.0)
    total = weights.sum(axis=1)
    weighted = (weights * numpy.nan_to_num(values)).sum(axis=1)
    return numpy.where(total > 0, weighted / numpy.where(total > 0, total, 1.0), numpy.nan)
