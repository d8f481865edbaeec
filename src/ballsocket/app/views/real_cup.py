"""Contact in a real cup and its map over orientations, computed in separate processes."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import replace
from functools import lru_cache, partial
from math import radians
from typing import Any

import numpy

from ...comparison import Comparison
from ...elasticity.finite_elements.mesh import socket_shape
from ...elasticity.finite_elements.progress import progress_to
from ...elasticity.off_axis.contact import OffAxisContact
from ...elasticity.off_axis.grid import rim_grid
from ...elasticity.off_axis.model import Sphere
from ...elasticity.off_axis.orientations import Orientations, orient
from ...elasticity.off_axis.ring_matrices import are_cup_rings_cached
from ...files.joint_file import JointFile
from ...model_catalogue import OFF_AXIS, named_models
from ...problem import Joint
from ...problem.cup import Cup, Side
from ...question import PressQuestion, answer, complete
from ...reports.cup_plots import cup_figure
from ...reports.figure_files import figure_bytes
from ...reports.press_report import press_lede, press_sections
from ..long_view import LongView
from ..results import RESULTS, without_name
from ..running import Reached, Report, Work
from ..state.screen import Screen
from ..view import Document

INCLINATIONS = tuple(radians(angle) for angle in numpy.arange(20.0, 70.1, 5.0))
ANTEVERSIONS = tuple(radians(angle) for angle in numpy.arange(-10.0, 40.1, 5.0))  # orientations of the map

LEWINNEK = (30.0, 50.0, 5.0, 25.0)
"""Inclinations and anteversions in degrees between which Lewinnek (1978) saw the fewest dislocations."""


def bore_of(file: JointFile) -> tuple[Joint, Cup]:
    """Return the inputs of the bore's ring matrices: joint and cup without orientation."""
    return without_name(file.joint), replace(complete(file)[0].cup, inclination=0.0, anteversion=0.0, side=Side.RIGHT)


def is_prepared(file: JointFile) -> bool:
    """Return True if the ring matrices of a bore are known, in memory or on disk: a press then takes a moment."""
    bore = bore_of(file)
    if RESULTS.get(("cup", bore)) is not None:
        return True
    try:
        prepared = are_cup_rings_cached(*bore, rim_grid(socket_shape(*bore).reach, Sphere.ring_width))
    except ValueError:  # a cup that does not fit the joint: the press states why
        return False
    if prepared:
        RESULTS.put(("cup", bore), True)
    return prepared


@lru_cache(maxsize=32)
def _pressed(joint: Any, cup: Cup, load: Any, aim: Any) -> OffAxisContact:
    file = JointFile(joint, dict(load), cup, dict(aim))
    answered = answer(PressQuestion(file=file, models={OFF_AXIS: named_models[OFF_AXIS]}, exact=None))
    contact: Any = answered.comparison[OFF_AXIS]
    if contact.status.failed:
        raise ValueError("; ".join(contact.notes) or contact.status.sentence)
    return contact


def pressed_in_cup(file: JointFile) -> OffAxisContact:
    """Press the load of a joint file in its cup; raise ValueError without a result."""
    file, _ = complete(file)
    return _pressed(file.joint, file.cup, tuple(file.load.items()), tuple(file.aim.items()))


def cup_document(
    screen: Screen,
    rows: Callable[[OffAxisContact], list[list[Any]]],
    sections: Callable[[], Mapping[str, tuple[str, str]]] = dict,
) -> Document:
    """Return the content of a file for the contact in the real cup; raise ValueError while it is prepared."""
    if not is_prepared(screen.file):
        raise ValueError("the real cup is still being prepared: wait until its pressure is there")
    contact, units = pressed_in_cup(screen.file), screen.reading.units
    pressed = Comparison(screen.file.joint, {contact.model.name: contact}, {})
    return Document(
        picture=lambda form: figure_bytes(cup_figure(contact, units), form),
        rows=lambda: rows(contact),
        sections=lambda: {**press_sections(pressed, units), **sections()},
        lede=lambda: press_lede(contact, screen.file.cup, units),
        contact=contact,
    )


def set_up(joint: Joint, cup: Cup, report: Report) -> bool:
    """Compute the ring matrices of a bore in a separate process; they are cached on disk."""
    report(Reached(share=0.1, words="Preparing the real cup ..."))
    Sphere(cup=cup).press(joint, force=1.0)
    return True


class RealCupView(LongView):
    """View that prepares the bore of the real cup by itself; its views share the result."""

    automatic, result_kind = True, "cup"

    def question_of(self, screen: Screen) -> Hashable:
        return bore_of(screen.file)

    def work(self, screen: Screen) -> Work:
        return partial(set_up, *bore_of(screen.file))


def orientation_key(file: JointFile) -> Hashable:
    """Return a key of a map over orientations."""
    return bore_of(file), file.cup.side, tuple(file.load.items()), tuple(file.aim.items())


def map_orientations(file: JointFile, report: Report) -> Orientations:
    """Press one load of the body in cups of many orientations, in a separate process; leave out the contacts."""
    if "tilt" in file.aim:
        raise ValueError("a load that is given by its tilt turns with the cup: give its direction in the body")
    model = Sphere(cup=complete(file)[0].cup, **file.aim)
    count = len(INCLINATIONS)

    def heard(words: str) -> None:
        number = words.removeprefix("inclination ").partition(" ")[0]
        if number.isdecimal():  # messages of the finite elements have no number
            report(Reached(share=int(number) / (count + 1), words=words))

    with progress_to(heard):
        orientations = orient(file.joint, model=model, inclination=INCLINATIONS, anteversion=ANTEVERSIONS, **file.load)
    return replace(orientations, contacts=())
