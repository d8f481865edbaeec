"""Cost against size: presses, tilted loads, a hip by its cells and instants, patients, and workers of a study.

Each curve measures the same work at several sizes on one core, in process time; workers are measured by the clock. The
rival of a curve is proportional growth: the exponent of the last doublings is stated beside it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import log, radians
from pathlib import Path
from time import process_time
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.compiled import Compiled
from ballsocket.core.executors import Processes
from ballsocket.hip import Archard, HipSimulation, iso_14242_1, population
from ballsocket.hip.config import read_hip

from .report import Report, Rows
from .studies import HIP, points
from .timing import _seconds, one_core, short

ROOT = Path(__file__).parents[1]
MILLION = 1e6
TILTED = bs.Sphere(cup=bs.Cup(inclination=radians(45.0), anteversion=radians(15.0)))
HIP_IN_USE = HipSimulation(
    joint=bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE),
    cup=bs.Cup(inclination=radians(30.0)),
    cycle=iso_14242_1(100),
    wear=Archard(coefficient=1.066e-6),
)


@dataclass(frozen=True)
class Curve:
    """Work at several sizes; `count(size)` is the number of presses, loads, cells, instants or patients of a size."""

    title: str
    noun: str
    sizes: tuple[int, ...]
    work: Callable[[int], object]
    count: Callable[[int], int] = int


@dataclass(frozen=True)
class Measured:
    """Seconds of a curve over its counts."""

    curve: Curve
    counts: tuple[int, ...]
    seconds: tuple[float, ...]

    @property
    def exponent(self) -> float:
        """Slope of log(seconds) over log(count) between the last two sizes: 1 for proportional growth."""
        return log(self.seconds[-1] / self.seconds[-2]) / log(self.counts[-1] / self.counts[-2])

    @property
    def hours_per_million(self) -> float:
        """Core-hours for a million of the counted things at the cost of the largest size."""
        return MILLION * self.seconds[-1] / self.counts[-1] / 3600


def random_joints(count: int) -> bs.Joint:
    """Joints of one liner whose radius and clearance differ."""
    rng = numpy.random.default_rng(1)
    radius, clearance = rng.uniform(11.0, 23.0, count), rng.uniform(0.05, 0.2, count)
    return bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=6.0, liner=bs.UHMWPE, ball=bs.COCR)


def press(model: Any) -> Callable[[int], object]:
    """Press as many joints by 3 kN and read the largest pressure."""
    return lambda count: numpy.sum(model.press(random_joints(count), force=numpy.array(3000.0)).max_pressure)


def press_tilted(count: int) -> object:
    """Press as many tilted loads on one real cup, without their fields."""
    force, tilt = numpy.linspace(500.0, 3500.0, count), numpy.linspace(0.0, 1.2, count)
    return TILTED.press(bs.joints["hip-36"], force=force, tilt=tilt, keep="summary")


def wear(use: HipSimulation) -> object:
    """Wear a hip for a million cycles, with nothing kept from other runs."""
    return replace(use).after(MILLION)


def cells_of(degrees: int) -> int:
    """Number of cells of a bore in rings of this width."""
    bore: Any = replace(HIP_IN_USE, ring_width=radians(degrees)).foundation
    return len(bore.areas)


def many_patients(count: int) -> object:
    """Wear the hips of as many patients for a million cycles."""
    uncertain = read_hip(ROOT / "examples" / "hip_of_many.toml").uncertain
    assert uncertain is not None
    return population(uncertain.variability, [MILLION], patients=count)


PRESSES = (10**3, 10**4, 10**5, 10**6)
CURVES = (
    Curve("paper's model, NumPy, a joint a press", "presses", PRESSES, press(bs.HessForsbach())),
    Curve("paper's model, compiled", "presses", (*PRESSES, 10**7), press(Compiled(model=bs.HessForsbach()))),
    Curve("tabulated, compiled", "presses", PRESSES, press(Compiled(model=bs.Tabulated()))),
    Curve("exact", "presses", (10, 100, 1000), press(bs.Exact())),
    Curve("real cup at a tilt, rings of 2°", "loads", (1, 8, 64, 512), press_tilted),
    Curve(
        "hip to 10⁶ cycles, 100 instants, by its cells",
        "cells",
        (8, 4, 2, 1),
        lambda width: wear(replace(HIP_IN_USE, ring_width=radians(width))),
        cells_of,
    ),
    Curve(
        "hip to 10⁶ cycles, rings of 4°, by its instants",
        "instants",
        (32, 64, 128, 256),
        lambda count: wear(replace(HIP_IN_USE, ring_width=radians(4.0), cycle=iso_14242_1(count))),
    ),
    Curve("patients to 10⁶ cycles", "patients", PRESSES, many_patients),
)
WORKERS = (1, 2)


def measure() -> Report:
    measured = [_measured(curve) for curve in CURVES]
    rows = Rows("Seconds of one core", ("what", "counted", "sizes", "seconds", "exponent"))
    for one in measured:
        counts = ", ".join(f"{count:.3g}" for count in one.counts)
        rows.add(
            one.curve.title,
            one.curve.noun,
            counts,
            ", ".join(f"{seconds:.2g}" for seconds in one.seconds),
            f"{one.exponent:.2f}",
        )
    cost = Rows("Cost of a million", ("what", "core-hours"))
    for one in measured:
        if one.curve.noun in ("presses", "loads", "patients"):
            cost.add(f"{one.curve.title}: {one.curve.noun}", f"{one.hours_per_million:.2g}")
    shared = Rows("2000 exact presses on workers, seconds by the clock", ("workers", "seconds"))
    for workers in WORKERS:
        shared.add(workers, short(_on_workers(workers)))
    _draw(measured)
    notes = ["Process time, the least of two runs; the first call, which compiles and fills caches, is not counted."]
    return Report([rows, cost, shared], [*notes, "docs/scaling.png shows the curves."], ("scipy",))


def _measured(curve: Curve) -> Measured:
    curve.work(curve.sizes[0])
    with one_core():
        seconds = [_least_seconds(curve, size) for size in curve.sizes]
    return Measured(curve, tuple(map(curve.count, curve.sizes)), tuple(seconds))


def _least_seconds(curve: Curve, size: int) -> float:
    return min(_seconds(lambda: curve.work(size), process_time) for _ in range(2))


def _on_workers(workers: int) -> float:
    engine = Processes(workers=workers)
    return min(_seconds(lambda: bs.study(bs.Exact(), HIP, points(2000, 1), engine=engine)) for _ in range(2))


def _draw(measured: list[Measured]) -> None:
    from matplotlib.figure import Figure

    from ballsocket.reports.figure_files import save
    from ballsocket.reports.style import finish, in_matplotlib, numbered

    figure = Figure(figsize=(9.6, 5.0), layout="constrained")
    many, one_hip = figure.subplots(1, 2)
    for axes, nouns, label in (
        (many, ("presses", "loads", "patients"), "presses, loads or patients"),
        (one_hip, ("cells", "instants"), "cells of the bore, or instants of the cycle"),
    ):
        for index, one in enumerate(one for one in measured if one.curve.noun in nouns):
            style = {**in_matplotlib(numbered(index)), "marker": _MARKERS[index]}
            axes.loglog(one.counts, one.seconds, label=one.curve.title, **style)
        finish(axes, label, "seconds of one core")
        axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), fontsize="small")
    save(figure, ROOT / "docs" / "scaling.png")


_MARKERS = "os^Dv*"
