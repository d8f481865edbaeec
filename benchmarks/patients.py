"""Hips of patients who differ, to a million cycles: what one takes, how far it is off, and ten thousand on paper.

The rival of the compiled pass is the path of NumPy, which runs without numba.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import radians
from pathlib import Path
from time import process_time
from unittest.mock import patch

import numpy

import ballsocket as bs
from ballsocket.hip import HipSimulation, PatientVariability, logarithmic, socket_foundation
from ballsocket.hip.cohort import CohortRun, sample_patients
from ballsocket.hip.config import read_hip
from ballsocket.hip.spring_equilibrium import solve_in_blocks
from ballsocket.hip.variability import RESULT_UNITS, Patient, result_table

from .report import Report, Rows
from .timing import Work, interleaved, one_core

REPEATS, SAMPLE, ON_CUPS, WHOLE, MILLION, PATIENTS = 2, 24, 4, 16, 1e6, 10_000
FILE = Path(__file__).parents[1] / "examples" / "hip_of_many.toml"


def measure() -> Report:
    said = read_hip(FILE).uncertain
    assert said is not None
    plain = said.variability
    crept = replace(plain, use=replace(plain.use, creep=logarithmic()))
    cups = replace(plain, surface=bs.RealCup())
    runs: dict[str, tuple[Work, int]] = {
        "wear": (_sample(plain), SAMPLE),
        "wear, without numba": (_in_numpy(_sample(plain)), SAMPLE),
        "wear and creep": (_sample(crept), SAMPLE),
        "wear and creep, without numba": (_in_numpy(_sample(crept)), SAMPLE),
        "wear in the real cup, a clearance each": (_sample(cups, ON_CUPS), ON_CUPS),
    }
    with one_core() as pinned:
        _, seconds = interleaved(REPEATS, {name: work for name, (work, _) in runs.items()}, process_time)
    rows = Rows("To a million cycles", ("what", "ms a patient", f"{PATIENTS} patients on two cores, min"))
    for name, spread in seconds.items():
        one = spread.median / runs[name][1]
        rows.add(name, f"{1e3 * one:.3g}", f"{PATIENTS * one / 2 / 60:.2g}")
    off = Rows(f"Quick runs beside rings of 3° and 100 instants, {WHOLE} patients", ("what", "median %", "most %"))
    for name, values in _off(plain).items():
        off.add(name, f"{numpy.median(values):.2g}", f"{values.max():.2g}")
    return Report([rows, off], ["On one core." if pinned else "Not held to one core.", "The aim is 240 minutes."])


def _sample(scatter: PatientVariability, count: int = SAMPLE) -> Callable[[], object]:
    run = CohortRun(variability=scatter, counts=(MILLION,), values=sample_patients(scatter, count, 0))
    return run.simulate


def _in_numpy(work: Callable[[], object]) -> Callable[[], object]:
    """Run work with the solver of NumPy, as without numba."""
    return patch.object(socket_foundation, "spring_solver", lambda: solve_in_blocks)(work)


def _off(scatter: PatientVariability) -> dict[str, numpy.ndarray]:
    """How far quick runs are from whole ones, in %."""
    each = sample_patients(scatter, WHOLE, 3)
    found = []
    for number in range(WHOLE):
        values = {name: float(column[number]) for name, column in each.items()}
        quick = scatter.patient(values)
        one, other = (result_table(run.simulate([MILLION]))[0] for run in (quick, _whole(scatter, quick, values)))
        found.append(100 * abs(one / numpy.where(other > 0, other, numpy.nan) - 1))
    names = [name for name in RESULT_UNITS if name in ("volume", "depth", "penetration", "max_pressure")]
    return {name: numpy.array(found)[:, list(RESULT_UNITS).index(name)] for name in names}


def _whole(scatter: PatientVariability, quick: Patient, values: dict[str, float]) -> Patient:
    heavier = values["body_weight"] / float(scatter.distributions["body_weight"].frozen.median())
    use: HipSimulation = replace(quick.use, ring_width=radians(3.0), cycle=scatter.use.cycle.scaled(heavier))
    return replace(quick, use=use)
