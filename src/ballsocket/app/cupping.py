"""A load in the cup as it stands, and in cups that stand otherwise: what the page asks of contact on the sphere."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, replace
from functools import lru_cache
from math import radians
from typing import Any

import numpy

from ..elasticity.finite_elements.progress import progress_to
from ..elasticity.off_axis import Orientations, Sphere, orient
from ..elasticity.off_axis.contact import OffAxisContact
from ..files.joint_file import JointFile
from ..output.html import drawn
from ..output.orientation_plot import orientation_figure
from ..problem.cup import Cup, Side
from .jobs import CachedRun
from .running import Reached, Told

INCLINATIONS = tuple(radians(angle) for angle in numpy.arange(20.0, 70.1, 5.0))
ANTEVERSIONS = tuple(radians(angle) for angle in numpy.arange(-10.0, 40.1, 5.0))
"""How the cup stands on the map."""

LEWINNEK = (30.0, 50.0, 5.0, 25.0)
"""Inclinations and anteversions in degrees between which Lewinnek (1978) saw the fewest dislocations."""

SOLVED: CachedRun = CachedRun(most=64)
"""Bores whose rings have been set up: a press in them takes a moment."""


def bore_of(file: JointFile) -> Hashable:
    """What the rings of a bore depend on: the joint and its cup, wherever that faces."""
    return file.joint, replace(file.cup, inclination=0.0, anteversion=0.0, side=Side.RIGHT)


@lru_cache(maxsize=32)
def _pressed(joint: Any, cup: Cup, load: Any, aim: Any) -> OffAxisContact:
    contact = Sphere(cup=cup).press(joint, **dict(load), **dict(aim))
    if not isinstance(contact, OffAxisContact) or contact.status.failed:
        raise ValueError("; ".join(contact.notes) or contact.status.sentence)
    return contact


def pressed_in_cup(file: JointFile) -> OffAxisContact:
    """The load of a joint file in its cup.

    Raises
    ------
    ValueError
        There is no answer, and why.
    """
    return _pressed(file.joint, file.cup, tuple(file.load.items()), tuple(file.aim.items()))


def set_up(file: JointFile, told: Told) -> None:
    """In a process: the rings of a bore, which are kept on disk for all."""
    told(Reached(share=0.1, words="setting up this bore by finite elements"))
    Sphere(cup=file.cup).press(file.joint, **file.load, **file.aim)


@dataclass(frozen=True, kw_only=True, eq=False)
class Stood:
    """How a cup may stand: angles in rad, distances to the rim in mm and pressures in MPa (inclinations, anteversions).

    `held` is where the bore holds the ball; `summary` is that of `Orientations`, `figure` its figure as PNG.
    """

    inclination: numpy.ndarray
    anteversion: numpy.ndarray
    edge_distance: numpy.ndarray
    max_pressure: numpy.ndarray
    held: numpy.ndarray
    summary: dict[str, Any]
    figure: bytes


def stand_of(file: JointFile) -> Hashable:
    """What a map of orientations depends on."""
    return bore_of(file), file.cup.side, tuple(file.load.items()), tuple(file.aim.items())


def stood(file: JointFile, told: Told) -> Stood:
    """In a process: one load of the body in cups that stand in many ways.

    Raises
    ------
    ValueError
        A load that is told by its tilt: it would turn with the cup.
    """
    if "tilt" in file.aim:
        raise ValueError("a load that is given by its tilt turns with the cup: give its direction in the body")
    model = Sphere(cup=file.cup, **file.aim)
    count = len(INCLINATIONS)

    def heard(words: str) -> None:
        number = words.removeprefix("inclination ").partition(" ")[0]
        if number.isdecimal():  # not what finite elements say
            told(Reached(share=int(number) / (count + 1), words=words))

    with progress_to(heard):
        found = orient(file.joint, model=model, inclination=INCLINATIONS, anteversion=ANTEVERSIONS, **file.load)
    return _plain(found)


def _plain(found: Orientations) -> Stood:
    return Stood(
        inclination=found.inclination,
        anteversion=found.anteversion,
        edge_distance=found.edge_distance,
        max_pressure=found.max_pressure,
        held=found.held,
        summary=found.summary(),
        figure=drawn(orientation_figure(found)),
    )
