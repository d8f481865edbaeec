"""Cost against size, and its figure docs/scaling.png: presses, tilted loads, hips and patients.

Each curve times the same work at several sizes. A row has the time of one item at the largest size and
the growth there: 1 is proportional.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import log, radians
from pathlib import Path
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.compiled import Compiled
from ballsocket.hip import iso_14242_1, population
from ballsocket.hip.config import read_hip

from . import sphere, wear
from .report import Row, duration
from .timing import Job, in_turns

ROOT = Path(__file__).parents[1]
MILLION = 1e6
PRESSES_OR_LOADS, CELLS = "presses, loads or patients", "cells of the bore, or instants of the cycle"


@dataclass(frozen=True)
class Curve:
    """Work at several sizes; `count(size)` is the number of presses, loads, cells or patients of a size."""

    title: str
    sizes: tuple[float, ...]
    work: Callable[[Any], object]
    count: Callable[[Any], int] = int
    panel: str = PRESSES_OR_LOADS


def press(model: Any) -> Callable[[int], object]:
    """Press as many joints of one liner by 3 kN."""

    def work(count: int) -> object:
        random = numpy.random.default_rng(1)
        radius, clearance = random.uniform(11.0, 23.0, count), random.uniform(0.05, 0.2, count)
        joint = bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=6.0, liner=bs.UHMWPE, ball=bs.COCR)
        return model.press(joint, force=numpy.array(3000.0)).max_pressure

    return work


def press_tilted(count: int) -> object:
    force, tilt = numpy.linspace(500.0, 3500.0, count), numpy.linspace(0.0, 1.2, count)
    return sphere.TILTED.press(sphere.BATCHED, force=force, tilt=tilt, keep="summary")


def wear_on_rings(degrees: float) -> object:
    return replace(wear.SPRINGS, ring_width=radians(degrees)).after(MILLION)


def cells_of_bore(degrees: float) -> int:
    bore: Any = replace(wear.SPRINGS, ring_width=radians(degrees)).foundation
    return len(bore.areas)


def wear_in_instants(count: int) -> object:
    return replace(wear.SPRINGS, ring_width=radians(4.0), cycle=iso_14242_1(count)).after(MILLION)


def wear_patients(count: int) -> object:
    uncertain = read_hip(ROOT / "examples" / "hip_of_many.toml").uncertain
    assert uncertain is not None
    return population(uncertain.variability, [MILLION], patients=count)


PRESSES = (10**3, 10**4, 10**5, 10**6)
CURVES = (
    Curve("paper's model, NumPy, a joint a press", PRESSES, press(bs.HessForsbach())),
    Curve("paper's model, compiled", (*PRESSES, 10**7), press(Compiled(model=bs.HessForsbach()))),
    Curve("tabulated, compiled", PRESSES, press(Compiled(model=bs.Tabulated()))),
    Curve("exact", (10, 100, 1000), press(bs.Exact())),
    Curve("real cup at a tilt, rings of 2°", (1, 8, 64, 512), press_tilted),
    Curve("hip to 10⁶ cycles, 100 instants, by its cells", (8, 4, 2, 1), wear_on_rings, cells_of_bore, CELLS),
    Curve("hip to 10⁶ cycles, rings of 4°, by its instants", (32, 64, 128, 256), wear_in_instants, panel=CELLS),
    Curve("patients to 10⁶ cycles", PRESSES, wear_patients),
)


Times = dict[int, float]
"""Seconds by count."""


def measure() -> list[Row]:
    times = {curve: time_curve(curve) for curve in CURVES}
    draw(times, ROOT / "docs" / "scaling.png")
    return [_row(curve, seconds) for curve, seconds in times.items()]


def time_curve(curve: Curve) -> Times:
    curve.work(curve.sizes[0])  # compiles, and fills caches
    jobs = {curve.count(size): Job(partial(curve.work, size)) for size in curve.sizes}
    seconds = in_turns(jobs.values(), repeats=1)
    return {count: seconds[job].median for count, job in jobs.items()}


def _row(curve: Curve, times: Times) -> Row:
    (before, less), (count, seconds) = list(times.items())[-2:]
    growth = log(seconds / less) / log(count / before)
    return Row(f"{curve.title}, {count:.3g}", duration(seconds / count), ratio=f"growth {growth:.2f}")


def draw(times: dict[Curve, Times], path: Path) -> None:
    """Draw seconds over counts, a panel for each kind of count."""
    from matplotlib.figure import Figure

    from ballsocket.reports.figure_files import save
    from ballsocket.reports.style import finish, in_matplotlib, numbered

    figure = Figure(figsize=(9.6, 5.0), layout="constrained")
    for axes, panel in zip(figure.subplots(1, 2), (PRESSES_OR_LOADS, CELLS), strict=True):
        for index, curve in enumerate(curve for curve in times if curve.panel == panel):
            style = {**in_matplotlib(numbered(index)), "marker": "os^Dv*"[index]}
            axes.loglog(list(times[curve]), list(times[curve].values()), label=curve.title, **style)
        finish(axes, panel, "seconds of one core")
        axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), fontsize="small")
    save(figure, path)
