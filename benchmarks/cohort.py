"""A million similar patients by a series, beside a simulation of each; and the error of held-out patients."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ballsocket.core.executors import Serial
from ballsocket.hip import PatientVariability, logarithmic
from ballsocket.hip.cohort import CohortRun, sample_patients
from ballsocket.hip.cohort_series import CohortSeries, solve_cohort
from ballsocket.hip.config import read_hip

from .report import Pair, Row, compare
from .timing import Job

PATIENTS, CREEPING, FEW, SAMPLE, COUNTS = 1_000_000, 20_000, 200, 16, (5e5, 1e6)
FILE = Path(__file__).parents[1] / "examples" / "hip_of_many.toml"
QUANTITIES = ("volume", "depth", "penetration", "creep_depth")


def measure() -> list[Row]:
    settings = read_hip(FILE).uncertain
    assert settings is not None
    tilted = settings.variability
    creeping = replace(tilted, use=replace(tilted.use, creep=logarithmic(), seconds_per_cycle=20.0))
    rows = compare([Pair(f"a cohort of {FEW} patients, wear", _cohort_job(tilted, FEW))], repeats=1)
    for name, patients, number in (("wear", tilted, PATIENTS), ("wear and creep", creeping, CREEPING)):
        rows += _compared(name, patients, number)
    return rows


def _cohort_job(patients: PatientVariability, number: int) -> Job:
    """A cohort too small for a series: each patient is simulated."""
    run = CohortRun(variability=patients, counts=COUNTS, values=sample_patients(patients, number, 0))
    return Job(lambda: solve_cohort(run, 0, None, Serial(), None, lambda finished: None))


def _compared(name: str, patients: PatientVariability, number: int) -> list[Row]:
    """Seconds a patient, and what 95 % of the results of held-out patients are within."""
    errors: dict[str, float] = {}

    def solve() -> None:
        run = CohortRun(variability=patients, counts=COUNTS, values=sample_patients(patients, number, 0))
        accuracy = CohortSeries(run=run, seed=0, engine=Serial()).solve(lambda finished: None).accuracy
        assert accuracy is not None
        errors.update(accuracy.relative)

    few = CohortRun(variability=patients, counts=COUNTS, values=sample_patients(patients, SAMPLE, 1))

    each = Pair(f"one of {number} patients, {name}", Job(solve, number), "each simulated", Job(few.simulate, SAMPLE))
    times = compare([each], repeats=1)
    shown = (f"{word.replace('_', ' ')} {100 * errors[word]:.2g} %" for word in QUANTITIES if word in errors)
    return [*times, Row(f"patients, {name}: 95 % of the errors within", ", ".join(shown))]
