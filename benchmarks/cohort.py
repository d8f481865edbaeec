"""A million patients by a series beside a simulation of each: time and error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import radians
from pathlib import Path
from time import process_time

from ballsocket.core.executors import Serial
from ballsocket.hip import PatientVariability, logarithmic, population
from ballsocket.hip.cohort import CohortRun, sample_patients
from ballsocket.hip.cohort_series import CohortSeries
from ballsocket.hip.config import read_hip
from ballsocket.studies import Normal

from .report import Report, Rows
from .timing import one_core

PATIENTS, SAMPLE, COUNTS = 1_000_000, 32, (5e5, 1e6)
FILE = Path(__file__).parents[1] / "examples" / "hip_of_many.toml"
GOAL = 12.0
"""Seconds of one core for a million patients whose cups tilt."""


def measure() -> Report:
    rows = Rows(
        f"{PATIENTS} patients, two reports to a million cycles, seconds of one core",
        ("cohort", "simulations", "series and results", "with bands", "rival: each simulated, h", "ratio"),
    )
    errors = Rows(
        "95 % of the results of held-out patients within, %; and the largest",
        ("cohort", "volume", "depth", "penetration", "max pressure", "creep depth"),
    )
    with one_core() as pinned:
        for name, patients in _cohorts().items():
            _add(rows, errors, name, patients)
    held = "On one core." if pinned else "Not held to one core."
    return Report([rows, errors], [held, "Process time, one run each.", f"Goal with tilted cups: {GOAL:g} s."])


def _cohorts() -> dict[str, PatientVariability]:
    """Return the cohort of the example, with two angles in place of the tilt, and with creep."""
    settings = read_hip(FILE).uncertain
    assert settings is not None
    tilted = settings.variability
    angles = {
        "inclination": Normal(mean=radians(42.0), deviation=radians(7.0), low=radians(20.0), high=radians(65.0)),
        "anteversion": Normal(mean=radians(15.0), deviation=radians(7.0), low=radians(-10.0), high=radians(40.0)),
    }
    others = {name: value for name, value in tilted.distributions.items() if name != "tilt"}
    oriented = replace(tilted, distributions={**others, **angles})
    creeping = replace(tilted, use=replace(tilted.use, creep=logarithmic(), seconds_per_cycle=20.0))
    return {"tilt": tilted, "inclination and anteversion": oriented, "tilt and creep": creeping}


def _add(rows: Rows, errors: Rows, name: str, patients: PatientVariability) -> None:
    """Measure one cohort: some simulated patients, the series, and the same with bands."""
    few = CohortRun(variability=patients, counts=COUNTS, values=sample_patients(patients, SAMPLE, 1))
    each = _seconds(few.simulate) / SAMPLE
    start = process_time()
    run = CohortRun(variability=patients, counts=COUNTS, values=sample_patients(patients, PATIENTS, 0))
    solution = CohortSeries(run=run, seed=0, engine=Serial()).solve(lambda finished: None)
    seconds = process_time() - start
    accuracy = solution.accuracy
    assert accuracy is not None
    whole = _seconds(lambda: population(patients, COUNTS, patients=PATIENTS)[1].summary()) if name == "tilt" else None
    shown = "" if whole is None else f"{whole:.3g}"
    hours = PATIENTS * each / 3600
    rows.add(name, accuracy.n_simulations, f"{seconds:.3g}", shown, f"{hours:.3g}", f"{3600 * hours / seconds:.3g}")
    names = ("volume", "depth", "penetration", "max_pressure", "creep_depth")
    known = [column if column in accuracy.relative else None for column in names]
    errors.add(
        name,
        *(
            "" if column is None else f"{100 * accuracy.relative[column]:.2g}; {100 * accuracy.largest[column]:.2g}"
            for column in known
        ),
    )


def _seconds(work: Callable[[], object]) -> float:
    """Return the processor time of a function."""
    start = process_time()
    work()
    return process_time() - start
