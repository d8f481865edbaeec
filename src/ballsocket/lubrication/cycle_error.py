"""Stated error of the film over a cycle: of the wave, of the cells, and of changes that cells and instants smear."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

import numpy

from ..core.arrays import Numbers
from .film_core import FilmMotion
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
