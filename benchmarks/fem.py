"""The finite elements: the default mesh and the paper's mesh; beside CalculiX at equal error.

The paper's mesh has bilinear elements of 0.05 mm. CalculiX takes a quarter of an hour for its 20 steps there
(BALLSOCKET_PAPERS_MESH=1 runs it).
"""

from __future__ import annotations

import os
import shutil
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.elasticity.finite_elements import bodies, solver
from ballsocket.elasticity.finite_elements.calculix import run
from ballsocket.elasticity.finite_elements.deck import deck_of

from .calculix_rival import calculix
from .exact import COARSE, RIGID
from .report import Pair, Row, compare
from .timing import Job, wall_time

HIP = bs.joints["hess-forsbach"]
PAPER = bs.Joint(ball_radius=12.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE, ball=bs.STEEL)
PAPERS_MESH: dict[str, Any] = {"spacing": bs.Uniform(size=0.05), "element": bs.Element.BILINEAR, "meshes": 1}
ADAPTED: dict[str, Any] = {
    "cup": bs.Cup(arc_of_cover=numpy.radians(240.0)),
    "spacing": bs.Adapted(elements=24),
    "meshes": 1,
}
STEPS = 20


def measure() -> list[Row]:
    depths = numpy.linspace(0.01, 0.045, STEPS)
    with TemporaryDirectory() as folder:
        theirs = calculix(RIGID, COARSE, depths, Path(folder))
        ours = Job(lambda: _first(ADAPTED, RIGID, indentation=depths))
        rows = compare(
            [
                Pair("finite elements, default mesh, first load", Job(lambda: _first({}, HIP, force=3000.0))),
                Pair(f"finite elements, {STEPS} steps to 0.3 %", ours, "CalculiX, 84 elements", theirs),
            ],
            repeats=3,
        )
    return [*rows, *_on_the_papers_mesh()]


def _first(settings: dict[str, Any], joint: bs.Joint, **load: Any) -> None:
    """Press a joint that was never seen."""
    for cached in (solver.load_curve_of, bodies.socket_compliance, bodies.ball_compliance):
        cached.cache_clear()
    contact = bs.FiniteElement(**settings).press(joint, **load)
    _ = contact.max_pressure, contact.half_angle


def _on_the_papers_mesh() -> list[Row]:
    """Steps to 3 kN by both programs, by the clock on two cores: CalculiX once, with two threads."""
    pressed: Any = bs.FiniteElement(**PAPERS_MESH).press(PAPER, force=3000.0)
    deck = deck_of(pressed, steps=STEPS)
    ours = Job(partial(_first, PAPERS_MESH, PAPER, indentation=deck.expected["indentation"]))
    with TemporaryDirectory() as folder:
        theirs: Job | str = "no command ccx" if shutil.which("ccx") is None else "BALLSOCKET_PAPERS_MESH is not set"
        if shutil.which("ccx") and os.environ.get("BALLSOCKET_PAPERS_MESH"):
            deck.write(Path(folder))
            theirs = Job(partial(run, Path(folder), threads=2))
        work = f"the paper's mesh, 71 440 elements, {STEPS} steps, by the clock"
        return compare([Pair(work, ours, "CalculiX", theirs)], repeats=1, clock=wall_time)
