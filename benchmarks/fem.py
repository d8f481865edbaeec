"""The finite elements: the default mesh, the paper's mesh, cost against size; and CalculiX at equal error.

The paper's mesh is that of R1 12 and L 8 mm with bilinear elements of 0.05 mm along both surfaces, about 67 000 of
them. CalculiX on that mesh is the benchmark `papers-mesh`.
"""

from __future__ import annotations

import os
import resource
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy
from matplotlib.figure import Figure

import ballsocket as bs
from ballsocket.reports.style import finish, line_of

from .fem_rival import PAPER, PAPERS_MESH, at_equal_error, forget
from .report import Report, Rows
from .timing import Spread

HIP = bs.joints["hess-forsbach"]
CURVE = numpy.linspace(200.0, 4000.0, 20)
SIZES = (0.6, 0.4, 0.2, 0.1, 0.05, 0.035)
DRAWN = Path(__file__).parents[1] / "docs" / "fem_cost.png"
REPEATS = 5
"""Of everything that takes less than a second."""

COARSE: dict[str, Any] = {"spacing": bs.Adapted(elements=24), "meshes": 1}


def measure() -> Report:
    """Each row in a process of its own, so that its memory is its own."""
    tables = [_alone(), _by_size(), at_equal_error()]
    notes = [
        f"{os.cpu_count()} cores. A press includes mesh, condensation, force, indentation, half angle and peak "
        "pressure. Memory is the largest of the process, Python and its libraries (about 0.1 GiB) included.",
        "At equal error: CalculiX 2.20, CAX8R, face-to-face penalty, a ball without unknowns, one thread; errors are "
        "the worst of the steps against the exact answer.",
    ]
    return Report(tables, notes, ("scipy", "scikit-fem"))


@dataclass(frozen=True, kw_only=True)
class Case:
    """A joint, its loads and the settings of the elements; `repeats` times."""

    joint: bs.Joint
    force: Any
    settings: dict[str, Any]
    repeats: int = 1


def _apart(case: Case) -> tuple[list[float], float, int]:
    """Seconds of each repetition, GiB at the most, and elements: in a process of its own."""
    with get_context("spawn").Pool(1) as pool:
        return pool.apply(_timed, (case,))


def _timed(case: Case) -> tuple[list[float], float, int]:
    _press(HIP, {"spacing": bs.Adapted(elements=24), "meshes": 1}, 100.0)  # imports and warm libraries
    seconds = []
    for _ in range(case.repeats):
        forget()
        start = perf_counter()
        _press(case.joint, case.settings, case.force)
        seconds.append(perf_counter() - start)
    largest = float(numpy.max(case.force))
    pressed: Any = bs.FiniteElement(**case.settings).press(case.joint, force=largest)
    return seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20, pressed.mesh.elements


def _press(joint: bs.Joint, settings: dict[str, Any], force: Any) -> bs.Contact:
    contact = bs.FiniteElement(**settings).press(joint, force=force)
    _ = contact.max_pressure, contact.half_angle
    return contact


def _further() -> list[float]:
    """Seconds of loads on a joint whose mesh is there."""
    _press(HIP, {}, 3000.0)
    seconds = []
    for force in numpy.linspace(2500.0, 3500.0, 20):
        start = perf_counter()
        _press(HIP, {}, float(force))
        seconds.append(perf_counter() - start)
    return seconds


def _alone() -> Rows:
    plan = {
        "default mesh, a first load on a new joint": (Case(joint=HIP, force=3000.0, settings={}, repeats=REPEATS), 0.5),
        "default mesh, a curve of 20 loads": (Case(joint=HIP, force=CURVE, settings={}, repeats=REPEATS), None),
        "coarse mesh (0.3 %), a curve of 20 loads": (
            Case(joint=HIP, force=CURVE, settings=COARSE, repeats=REPEATS),
            None,
        ),
        "the paper's mesh, a curve of 20 loads": (Case(joint=PAPER, force=CURVE, settings=PAPERS_MESH), 4.0),
    }
    table = Rows("The finite elements alone", ("what", "elements", "s", "GiB", "aim, s"))
    for name, (case, aim) in plan.items():
        seconds, memory, elements = _apart(case)
        table.add(name, elements, Spread(tuple(seconds)), f"{memory:.2f}", "" if aim is None else f"{aim:g}")
    with get_context("spawn").Pool(1) as pool:
        further = pool.apply(_further)
    table.add("default mesh, each further load", "", Spread(tuple(further)), "", "")
    return table


def _by_size() -> Rows:
    table = Rows("Cost against size, bilinear, one load on R1 12, L 8 mm", ("size, mm", "elements", "s", "GiB"))
    counts, times = [], []
    for size in SIZES:
        settings = {"spacing": bs.Uniform(size=size), "element": bs.Element.BILINEAR, "meshes": 1}
        seconds, memory, elements = _apart(Case(joint=PAPER, force=3000.0, settings=settings))
        table.add(f"{size:g}", elements, f"{seconds[0]:.3g}", f"{memory:.2f}")
        counts.append(elements)
        times.append(seconds[0])
    line = numpy.polynomial.Polynomial.fit(numpy.log(counts[-4:]), numpy.log(times[-4:]), 1).convert()
    table.add("exponent of the last four", "", f"{line.coef[1]:.2f}", "")
    _draw(numpy.array(counts), numpy.array(times), line)
    return table


def _draw(elements: numpy.ndarray, seconds: numpy.ndarray, line: numpy.polynomial.Polynomial) -> None:
    """The cost as a figure for the docs."""
    figure = Figure(figsize=(5.5, 3.6), layout="constrained")
    axes = figure.subplots()
    axes.loglog(elements, seconds, "o", color=line_of("fem").colour)
    fitted = elements[-4:]
    axes.loglog(fitted, numpy.exp(line(numpy.log(fitted))), color="0.4", label=f"(elements)$^{{{line.coef[1]:.2f}}}$")
    finish(axes, "bilinear elements", "one load on a new joint [s]")
    axes.legend(frameon=False)
    figure.savefig(DRAWN, dpi=150)
