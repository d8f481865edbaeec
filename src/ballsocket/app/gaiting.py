"""A cycle of a hip for a page: what its process makes of it, as plain numbers."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy

from ..elasticity.off_axis.directions import unit_vectors
from ..files.joint_file import JointFile
from ..hip import Lubricant
from ..hip.ball_wear import interpolation_at
from ..hip.contact_checks import largest_utilisation, list_check_notes
from ..hip.cycle_registry import CYCLES
from ..hip.film import film
from .in_use import Own, Use, hip_of
from .running import Reached, Told

RINGS, MERIDIANS = 24, 60
"""Cells of the bore that moves on the page."""

_LEVELS = 255


@dataclass(frozen=True, kw_only=True, eq=False)
class Gaited:
    """A cycle on a bore that is not worn; courses are over its instants, NaN where nothing is pressed.

    Attributes
    ----------
    name : str
    phase : array (instants,)
        In % of the cycle.
    force, pressure, film, edge : array (instants,)
        In N, MPa, nm, and mm from the contact's edge to the rim.
    load : array (instants, 3)
        Unit vectors in the cup's frame; 0 without load.
    cells : bytes
        Pressures of the cells of the moving bore in each instant, over the largest, 0 to 255.
    polar : array (RINGS + 1,)
        Edges of its rings in rad.
    worst : str
        The instant in which the contact comes nearest to the rim, and where.
    regime : str
        Of the film.
    utilisation : float, optional
        Largest von Mises stress over yield stress in the cycle; None where no yield stress is known.
    valid : bool
        Whether the contact with the largest pressure is inside its model's validity.
    numbers : dict
        For JSON.
    notes : tuple of str
    """

    name: str
    phase: numpy.ndarray
    force: numpy.ndarray
    pressure: numpy.ndarray
    film: numpy.ndarray
    edge: numpy.ndarray
    load: numpy.ndarray
    cells: bytes
    polar: numpy.ndarray
    worst: str
    regime: str
    utilisation: float | None
    valid: bool
    numbers: dict[str, Any]
    notes: tuple[str, ...]

    @property
    def heaviest(self) -> int:
        """The instant of the largest force."""
        return int(self.force.argmax())


def gait_of(file: JointFile, use: Use, own: Own | None) -> Hashable:
    """What the courses over a cycle depend on."""
    weight = use.body_weight if own is not None or CYCLES[use.cycle].per_body_weight else None
    return file.joint, file.cup, file.cup.oriented, weight, use.contact, own or use.cycle


def gaited(file: JointFile, use: Use, own: Own | None, told: Told) -> Gaited:
    """In a process: the courses over a cycle.

    Raises
    ------
    ValueError
        There is no such hip, and why.
    """
    told(Reached(share=0.1, words="setting up the bore"))
    hip = hip_of(file, use, own)
    told(Reached(share=0.3, words="pressing through the cycle"))
    rest, lubricant = hip.unworn, Lubricant()
    told(Reached(share=0.7, words="film and edge"))
    found, edge = film(hip.frame, hip.foundation, hip.sliding, rest, lubricant), hip.edge(rest)
    worst, first = edge.closest_approach(hip), hip.first
    checks = hip.unworn_checks
    utilisation, valid = largest_utilisation(checks), all(check.valid for check in checks)
    polar = numpy.linspace(0.0, hip.reach, RINGS + 1)
    sizes = hip.cycle.force_magnitudes

    def course(values: numpy.ndarray) -> numpy.ndarray:
        whole = numpy.full(hip.cycle.n_steps, numpy.nan)
        whole[hip.loaded] = values
        return whole

    return Gaited(
        name=hip.cycle.name,
        phase=100 * hip.cycle.phases,
        force=sizes,
        pressure=course(rest.pressure.max(axis=1, initial=0.0)),
        film=course(1e6 * found.least),
        edge=course(edge.distance),
        load=numpy.divide(hip.forces, sizes[:, None], out=numpy.zeros_like(hip.forces), where=sizes[:, None] > 0),
        cells=_cells(hip, polar),
        polar=polar,
        worst="nothing is pressed" if worst is None else worst.location,
        regime=found.regime,
        utilisation=utilisation,
        valid=valid,
        numbers={
            "valid": valid,
            "utilisation": utilisation,
            "slide_mm": first.slide,
            **found.summary(),
            "edge": None if worst is None else worst.summary(),
        },
        notes=(*hip.notes, *list_check_notes([("in the first cycle", checks)])),
    )


def _cells(hip: Any, polar: numpy.ndarray) -> bytes:
    """Pressures of the cells of the moving bore over the largest, as bytes: instant by instant."""
    around = 2 * pi * (numpy.arange(MERIDIANS) + 0.5) / MERIDIANS
    middles = unit_vectors(((polar[1:] + polar[:-1]) / 2)[:, None], around)
    spots = interpolation_at(hip.grid, numpy.asarray(middles).reshape(3, 1, -1))
    pressure = hip.unworn.pressure
    most = float(pressure.max(initial=0.0)) or 1.0
    frames = numpy.zeros((hip.cycle.n_steps, RINGS * MERIDIANS), dtype=numpy.uint8)
    for instant, field in zip(hip.loaded, pressure, strict=True):
        frames[instant] = numpy.rint(_LEVELS * spots.interpolate(field[None])[0] / most)
    return frames.tobytes()
