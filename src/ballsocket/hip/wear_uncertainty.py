"""Uncertainty of a wear prediction: bands over sampled patients, and Sobol indices of the sampled quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.executors.processes import Engine, Serial
from ..studies.variance_indices import check_sample_memory, sobol_indices
from .bands import CONVERTED, Bands, SharedCoefficient
from .cohort import CohortRun, CohortStore, ProgressCallback, check_cohort_memory, sample_patients
from .cohort_series import solve_cohort
from .history import History, Report
from .variability import (
    DEFAULT_COUNT,
    DEFAULT_LEVEL,
    INFLUENCED_RESULTS,
    RESULT_COLUMNS,
    CohortResult,
    Patient,
    PatientVariability,
    join_results,
    result_table,
)
from .wear_law import COEFFICIENT

_CONVERTED_COLUMNS = [RESULT_COLUMNS[name] for name in CONVERTED]
_NODES = 12  # number of runs of the nominal patient over the range of the coefficient
_SERIAL = Serial()


def uncertainty(
    variability: PatientVariability,
    history: History,
    *,
    count: int = DEFAULT_COUNT,
    seed: int = 0,
    engine: Engine = _SERIAL,
    progress: ProgressCallback = lambda finished: None,
) -> Bands:
    """Compute uncertainty bands of a wear simulation, and Sobol indices of the sampled quantities.

    Parameters
    ----------
    variability : PatientVariability
        Distributions of the patients.
    history : History
        Simulation of the nominal patient. The bands have the same reports.
    count : int
        Number of samples in each sample set, 2 or more; a power of two fills the space most evenly. There are two sets
        more than sampled quantities. The bands are those of the first two sets.
    seed : int
        Seed of the samples. The same seed gives the same results.
    engine : Engine
        Executor of the simulations.
    progress : function
        Called with the number of finished patients.

    Raises
    ------
    ValueError
        A count below 2, or a negative seed.
    """
    require("count", count, count >= 2, "it must be at least 2")
    require("seed", seed, seed >= 0, "it must be at least 0")
    check_sample_memory(count, len(INFLUENCED_RESULTS) * (2 * len(variability.distributions) + 2))
    counts = tuple(report.cycles for report in history.reports)
    results: list[CohortResult] = []
    sampled_sets: list[Mapping[str, Numbers]] = []

    def simulate(samples: Numbers) -> Numbers:
        """Simulate samples (quantities, points); return `INFLUENCED_RESULTS` at the last report: (results, points)."""
        values = dict(zip(variability.distributions, samples.reshape(len(samples), -1), strict=True))
        n_finished = sum(len(result.refused) for result in results)
        run = CohortRun(variability=variability, counts=counts, values=values)
        results.append(run.simulate(engine, None, lambda finished: progress(n_finished + finished)))
        sampled_sets.append(values)
        last_results = results[-1].table[:, -1, [RESULT_COLUMNS[name] for name in INFLUENCED_RESULTS]]
        return last_results.T.reshape(len(INFLUENCED_RESULTS), *samples.shape[1:]).copy()

    distributions = list(variability.distributions.values())
    indices: Mapping[str, Numbers] | None = sobol_indices(simulate, distributions, count, seed, DEFAULT_LEVEL)
    if any((result.refused != "").any() for result in results):
        indices = None
    cohort = join_results(results[:2])
    sampled = {
        name: numpy.concatenate([values[name] for values in sampled_sets[:2]]) for name in variability.distributions
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


def population(
    variability: PatientVariability,
    counts: Sequence[float],
    *,
    patients: int,
    seed: int = 0,
    engine: Engine = _SERIAL,
    store: CohortStore | None = None,
    progress: ProgressCallback = lambda finished: None,
    method: str | None = None,
) -> tuple[CohortRun, Bands]:
    """Compute the results of a sampled patient cohort, and their bands.

    Patients on springs are similar: a few hundred simulations and a series of polynomials give the results of all of
    them. `Bands.accuracy` has the error of the series, from patients that were simulated.

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
    method : str, optional
        "series", or "runs" to simulate each patient. By default a series, if patients are similar and many enough.

    Raises
    ------
    ValueError
        Fewer than one patient, too many for the memory, a negative seed, an unknown method, or a series of patients
        that are not similar.
    OSError
        The store is not writable or the disk is full.
    """
    values = sample_patients(variability, patients, seed)
    check_cohort_memory(patients, len(values), len(counts))
    run = CohortRun(variability=variability, counts=tuple(sorted(counts)), values=values)
    reports = Patient(use=variability.use, cycle_ratio=1.0).simulate(run.counts)
    solution = solve_cohort(run, seed, method, engine, store, progress)
    cohort = solution.result
    bands = Bands(
        variability=variability,
        counts=run.counts,
        cohort=cohort,
        indices=solution.indices,
        accuracy=solution.accuracy,
        obstacle=solution.obstacle,
        seed=seed,
        members="patients",
        quick_run_errors=_quick_run_errors(variability, reports),
        shared=share_coefficient(variability, run.counts, run.values, cohort.table, DEFAULT_LEVEL, engine),
    )
    return run, bands


def _quick_run_errors(variability: PatientVariability, reports: Sequence[Report]) -> dict[str, float]:
    columns = [RESULT_COLUMNS[name] for name in INFLUENCED_RESULTS]
    coarse_reports = variability.patient({}).simulate([report.cycles for report in reports])
    coarse, full = result_table(coarse_reports)[:, columns], result_table(reports)[:, columns]
    ratios = numpy.divide(coarse, full, out=numpy.ones_like(coarse), where=full > 0)
    return dict(zip(INFLUENCED_RESULTS, abs(ratios - 1).max(axis=0).tolist(), strict=True))


def share_coefficient(
    variability: PatientVariability,
    counts: tuple[float, ...],
    sampled: Mapping[str, Numbers],
    table: Numbers,
    level: float,
    engine: Engine,
) -> SharedCoefficient | None:
    """Compute the results if all patients have the same wear coefficient: low, median or high.

    Each result of the table (patients, reports, results) is multiplied by the ratio of the nominal patient's results at
    both coefficients. Twice the cycles wear as much as twice the coefficient. The ratio is therefore taken at the
    coefficient times the patient's cycle ratio. `level` is the fraction of the coefficients inside their band.

    Returns None without a sampled coefficient and another sampled quantity, for a coefficient of 0, or without results.
    """
    if COEFFICIENT not in variability.distributions or len(variability.distributions) == 1:
        return None
    low_probability = (1 - level) / 2
    coefficients = variability.distributions[COEFFICIENT].frozen.ppf([low_probability, 0.5, 1 - low_probability])
    values = dict(zip(("low", "median", "high"), map(float, coefficients), strict=True))
    sampled_coefficients, cycle_ratios = sampled[COEFFICIENT], numpy.ones(len(sampled[COEFFICIENT]))
    if "cycles_per_year" in sampled and variability.cycles_per_year:
        cycle_ratios = sampled["cycles_per_year"] / variability.cycles_per_year
    low = min(sampled_coefficients.min(), coefficients[0]) * cycle_ratios.min()
    high = max(sampled_coefficients.max(), coefficients[-1]) * cycle_ratios.max()
    if not 0 < low < high or numpy.isnan(table).all():
        return None
    exposures = numpy.geomspace(low, high, _NODES)
    nominal = CohortRun(variability=variability, counts=counts, values={COEFFICIENT: exposures}).simulate(engine)
    has_result = nominal.refused == ""
    if not has_result.any():
        return None
    log_nodes = numpy.log(exposures[has_result])
    with numpy.errstate(divide="ignore"):
        log_results = numpy.log(nominal.table[has_result][:, :, _CONVERTED_COLUMNS])

    def nominal_results(coefficients: Numbers | float) -> Numbers:
        """Interpolate the nominal results (patients, reports, results) on logarithmic axes; NaN for no wear."""
        log_exposures = numpy.log(coefficients * cycle_ratios)
        columns = log_results.reshape(len(log_nodes), -1).T
        rows = numpy.exp(numpy.stack([numpy.interp(log_exposures, log_nodes, column) for column in columns], axis=-1))
        return numpy.where(rows > 0, rows, numpy.nan).reshape(len(log_exposures), *log_results.shape[1:])

    patient_factors = table[:, :, _CONVERTED_COLUMNS] / nominal_results(sampled_coefficients)
    results = {name: patient_factors * nominal_results(value) for name, value in values.items()}
    return SharedCoefficient(values=MappingProxyType(values), results=MappingProxyType(results))
