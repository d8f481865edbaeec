"""A ball pressed into a cup at a tilt: set up, one displacement, one force, a cycle; beside CalculiX on the same.

Fair, because both have the same cup, a rigid ball, the same displacement and the limit of small displacements. CalculiX
runs on meshes as coarse as its force allows, on one core; the difference of the forces stands beside the times.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from dataclasses import replace
from math import degrees, pi, radians
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest import mock

import numpy

import ballsocket as bs
from ballsocket.elasticity.off_axis.deck import TiltedDeck, run

from .report import Report, Rows
from .timing import Spread, Work, interleaved, one_core

REPEATS, CYCLE = 2, 100
INDENTATION, TILT = 0.04, radians(45.0)
JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
WIDTHS = {"2°": radians(2.0), "1°": radians(1.0)}
RIVALS = (11.25, 9.0)
"""Elements of CalculiX, in degrees."""


def measure() -> Report:
    works: dict[str, tuple[Callable[[bs.Sphere], Work], str]] = {
        "set up": (set_up, "1500, 6000"),
        "by displacement": (displaced, "15, 80"),
        "by force": (forced, "45, 240"),
    }
    rows = Rows("Milliseconds", ("what", *(f"rings of {width}" for width in WIDTHS), "aims"))
    springs = bs.Sphere(surface=bs.Springs())
    with one_core() as pinned:
        for name, (work, aims) in works.items():
            rows.add(name, *_timed(*(work(bs.Sphere(ring_width=width)) for width in WIDTHS.values())), aims)
        one, cycle = _timed(displaced(springs), _cycle(springs))
        (loads,) = _timed(_cycle(bs.Sphere()))
    rows.add(f"a cycle of {CYCLE} loads", loads, "", "1000")
    rows.add("springs, by displacement", one, "", "3")
    rows.add(f"springs, a cycle of {CYCLE} loads", cycle, "", "")
    return Report([rows], ["Ours on one core." if pinned else "Not held to one core.", *_rival()])


def _timed(*work: Work) -> list[Spread]:
    _, seconds = interleaved(REPEATS, {str(number): each for number, each in enumerate(work)})
    return [each.per(1e-3) for each in seconds.values()]


def set_up(model: bs.Sphere) -> Work:
    def work() -> None:
        """A cup that nobody has asked for, and a folder that is empty."""
        joint = replace(JOINT, liner_thickness=6.75 + 1e-9 * numpy.random.default_rng().uniform())
        with TemporaryDirectory() as folder, mock.patch.dict(os.environ, BALLSOCKET_CACHE=folder):
            model.press(joint, indentation=INDENTATION)

    return work


def displaced(model: bs.Sphere) -> Work:
    return lambda: model.press(JOINT, indentation=INDENTATION, tilt=TILT)


def forced(model: bs.Sphere) -> Work:
    return lambda: model.press(JOINT, force=3000.0, tilt=TILT)


def _cycle(model: bs.Sphere) -> Work:
    """The instants of a step: a load that comes and goes, and swings."""
    time = 2 * pi * numpy.arange(CYCLE) / CYCLE
    swing = 0.4 + 0.3 * numpy.cos(time)
    direction = numpy.stack([numpy.sin(swing), 0.2 * numpy.sin(time), numpy.cos(swing)], axis=-1)
    return lambda: model.press(JOINT, force=1650.0 + 1350.0 * numpy.sin(time), direction=direction)


def _rival() -> list[str]:
    if shutil.which("ccx") is None:
        return ["CalculiX is not installed: no rival was run."]
    ours = displaced(bs.Sphere())
    truth: Any = ours()
    _, mine = interleaved(REPEATS, {"ours": ours})
    said = [
        f"Displaced at {degrees(TILT):g}°, rings of 2°: {mine['ours'].per(1e-3)} ms, {_text(truth.force_vector)}, "
        f"largest pressure {truth.max_pressure:.2f} MPa."
    ]
    for size in RIVALS:
        deck = TiltedDeck(joint=JOINT, cup=bs.Cup(), indentation=INDENTATION, tilt=TILT, element_size=radians(size))
        force, seconds = _calculix(deck)
        off = numpy.linalg.norm(numpy.subtract(force, truth.force_vector)) / truth.force
        said.append(
            f"CalculiX, elements of {size:g}°, {deck.ball.last_number} nodes: {seconds:.1f} s, {_text(force)}, "
            f"{100 * off:.2f} % from ours; {seconds / mine['ours'].median:.0f} times our time."
        )
    return said


def _calculix(deck: TiltedDeck) -> tuple[Any, float]:
    """The force, and the seconds of the second of two runs."""
    with TemporaryDirectory() as folder:
        deck.write(Path(folder))
        found: list[Any] = []
        first, _ = interleaved(1, {"ccx": lambda: found.append(run(Path(folder)))})
    return found[-1]["force_vector"], first["ccx"].median


def _text(force: Any) -> str:
    return f"force ({force[0]:.1f}, {force[2]:.1f}) N"
