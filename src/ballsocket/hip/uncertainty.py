"""Uncertainty of a wear prediction: bands over sampled patients, and Sobol indices of the sampled quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.deprecation import renamed_arguments, renamed_names
from ..core.executors.processes import Engine, Serial
from ..studies.room import check_samples
from ..studies.sobol import sobol
from .bands import DEFAULT_LEVEL, INFLUENCED_RESULTS, Bands
from .cohort import CohortResult, CohortRun, CohortStore, ProgressCallback, join_results, sample_patients
from .history import History, Report
from .shared_coefficient import share_coefficient
from .variability import RESULT_UNITS, Patient, PatientVariability, result_table

DEFAULT_COUNT = 64
"""Default number of samples in each of the sample sets, whose number is that of the quantities plus two."""

_SERIAL = Serial()


def _ignore_progress(finished: int) -> None:
    pass


@renamed_arguments(scatter="variability", listen="progress")
def uncertainty(
    variability: PatientVariability,
    history: History,
    *,
    count: int = DEFAULT_COUNT,
    seed: int = 0,
    engine: Engine = _SERIAL,
    progress: ProgressCallback = _ignore_progress,
) -> Bands:
    """Compute the uncertainty bands of a wear simulation, and the Sobol indices of the sampled quantities.

    Parameters
    ----------
    variability : PatientVariability
        Distributions of the patients.
    history : History
        Simulation of the nominal patient. The bands have the same reports.
    count : int
        Number of samples in each sample set, a power of two. There are two sets more than sampled quantities. The bands
        are those of the first two sets.
    seed : int
        Seed of the samples. The same seed gives the same results.
    engine : Engine
        Executor of the simulations.
    progress : function
        Called with the number of finished patients.

    Raises
    ------
    ValueError
        A count that is not a power of two, or a negative seed.
    """
    require("count", count, count >= 2 and count & (count - 1) == 0, "it must be a power of two")
    require("seed", seed, seed >= 0, "it must be at least 0")
    check_samples(count)
    counts = tuple(report.cycles for report in history.reports)
    simulation = _SampleSimulation(variability, counts, engine, progress)
    distributions = list(variability.distributions.values())
    indices: Mapping[str, Numbers] | None = sobol(simulation, distributions, count, seed, DEFAULT_LEVEL)
    if any((result.refused != "").any() for result in simulation.results):
        indices = None
    cohort = join_results(simulation.results[:2])
    sampled = {
        name: numpy.concatenate([values[name] for values in simulation.sampled[:2]])
        for name in variability.distributions
    }
    return Bands(
        variability=variability,
        counts=counts,
        cohort=cohort,
        seed=seed,
        indices=indices,
        quick_run_errors=_quick_run_errors(variability, history.reports),
        shared=share_coefficient(variability, counts, sampled, cohort.table, DEFAULT_LEVEL, engine),
    )


@renamed_arguments(scatter="variability", listen="progress")
def population(
    variability: PatientVariability,
    counts: Sequence[float],
    *,
    patients: int,
    seed: int = 0,
    engine: Engine = _SERIAL,
    store: CohortStore | None = None,
    progress: ProgressCallback = _ignore_progress,
) -> tuple[CohortRun, Bands]:
    """Simulate a sampled patient cohort, and compute its bands.

    Parameters
    ----------
    variability : PatientVariability
        Distributions of the patients.
    counts : sequence of float
        Cycles of the nominal patient at the reports.
    patients : int
        Number of patients. A larger number keeps the first patients.
    seed : int
        Seed of the samples.
    engine : Engine
        Executor of the simulations: `Serial()`, `Processes()`, `Distributed()`. A task is a piece of sixteen patients.
    store : CohortStore, optional
        Store of the patients' results. Stored patients are not simulated again.
    progress : function
        Called with the number of finished patients.

    Raises
    ------
    ValueError
        Fewer than one patient, too many, or a negative seed.
    OSError
        The store is not writable or the disk is full.
    """
    run = CohortRun(
        variability=variability, counts=tuple(sorted(counts)), values=sample_patients(variability, patients, seed)
    )
    reports = Patient(use=variability.use, cycle_ratio=1.0).simulate(run.counts)
    cohort = run.simulate(engine, store, progress)
    bands = Bands(
        variability=variability,
        counts=run.counts,
        cohort=cohort,
        seed=seed,
        quick_run_errors=_quick_run_errors(variability, reports),
        shared=share_coefficient(variability, run.counts, run.values, cohort.table, DEFAULT_LEVEL, engine),
    )
    return run, bands


@dataclass
class _SampleSimulation:
    """Function of samples (quantities, points) for Sobol indices that stores the results of all samples.

    It returns `INFLUENCED_RESULTS` at the last report, with the shape (results, points).
    """

    variability: PatientVariability
    counts: tuple[float, ...]
    engine: Engine
    progress: ProgressCallback
    results: list[CohortResult] = field(default_factory=list)
    sampled: list[Mapping[str, Numbers]] = field(default_factory=list)
    n_finished: int = 0

    def __call__(self, samples: Numbers) -> Numbers:
        values = dict(zip(self.variability.distributions, samples.reshape(len(samples), -1), strict=True))
        run = CohortRun(variability=self.variability, counts=self.counts, values=values)
        result = run.simulate(self.engine, None, lambda finished: self.progress(self.n_finished + finished))
        self.n_finished += len(run)
        self.results.append(result)
        self.sampled.append(values)
        last = result.table[:, -1, [list(RESULT_UNITS).index(name) for name in INFLUENCED_RESULTS]]
        return last.T.reshape(len(INFLUENCED_RESULTS), *samples.shape[1:]).copy()


def _quick_run_errors(variability: PatientVariability, reports: Sequence[Report]) -> dict[str, float]:
    """Compute the largest relative difference between the nominal patient's coarse simulation and the full one."""
    coarse_reports = variability.patient({}).simulate([report.cycles for report in reports])
    coarse, full = result_table(coarse_reports), result_table(reports)
    errors = {}
    for name in INFLUENCED_RESULTS:
        column = list(RESULT_UNITS).index(name)
        value, reference = coarse[:, column], full[:, column]
        ratio = numpy.divide(value, reference, out=numpy.ones_like(value), where=reference > 0)
        errors[name] = float(abs(ratio - 1).max())
    return errors


__getattr__ = renamed_names(
    __name__,
    {
        "LEVEL": "ballsocket.hip.bands.DEFAULT_LEVEL",
        "SHARED": "ballsocket.hip.bands.INFLUENCED_RESULTS",
        "COUNT": "DEFAULT_COUNT",
    },
)
