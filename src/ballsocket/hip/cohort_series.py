"""Cohorts of similar patients by a series: its ranges, its refinement, its error, and the patients outside."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import log, pi

import numpy

from ..contact.roots import bisect
from ..core.arrays import Numbers
from ..core.checks import known_name
from ..core.executors.processes import Engine
from ..core.storage.folders import ArrayPieceStore
from ..core.storage.pieces import PieceRun
from ..studies.axes import SampleAxis
from ..studies.variance_indices import sobol_indices
from .cohort import CohortRun, CohortStore, ProgressCallback
from .patient_series import MEMBERS_PER_PIECE, Box, FamilyRun, NoSeriesError, PatientSeries, fit_series, members_of
from .series_accuracy import SeriesAccuracy, estimate_accuracy
from .similarity import CLEARANCE, Similarity, find_obstacle
from .variability import DEFAULT_LEVEL, INFLUENCED_RESULTS, RESULT_COLUMNS, CohortResult

N_HELD_OUT = 64  # number of patients that are simulated to estimate the error of a series: the first of the cohort

_REFERENCE_COUNT = 65_536  # number of samples that set the ranges of a series, for a cohort of any size
_FIRST_DEGREES = (0, 12, 10, 7, 6)  # degree of the first series by the number of its variables besides the clearance
_DEGREE_STEP = 2  # increase of the degree by a refinement
_MAX_MEMBERS = 2048  # largest number of simulations of a refined series
_MEMBER_COST = 3  # ratio of the time of a family member, which has many reports, to that of a patient
_LEAST_IMPROVEMENT = 0.9  # ratio of errors above which a refinement counts as useless

_ANGLE_LIMITS = {"tilt": (0.0, pi / 2), "inclination": (0.0, pi / 2), "anteversion": (-pi / 2, pi / 2)}
"""Lowest and highest angle of a cup in rad."""

_GRID_COUNT = 9  # number of orientations that are checked along each angle of a range
_BISECTIONS = 12  # number of bisections for the end of a covered range
_LEAST_WIDTH = 1e-9  # relative width below which a range is one number
_MAX_CUT = 1e-3  # largest fraction of patients outside the covered orientations for which Sobol indices are computed
_SOBOL_COUNT = 4096  # samples in each set of the Sobol indices

METHODS = ("series", "runs")  # methods of a cohort: a series of polynomials, or a simulation of each patient


@dataclass(frozen=True, kw_only=True, eq=False)
class CohortSolution:
    """Results of a cohort, with the accuracy of the series that they come from."""

    result: CohortResult
    accuracy: SeriesAccuracy | None = None  # None if each patient was simulated
    # Sobol indices; see `Bands`. None without a series, or if it does not cover the orientations of the cup.
    indices: Mapping[str, Numbers] | None = None
    obstacle: str = ""  # reason in one clause why there is no series; empty if there is one, or none was needed

    @property
    def is_acceptable(self) -> bool:
        """True without a series, within the tolerances, or if simulating each patient would take much longer."""
        if self.accuracy is None:
            return True
        return self.accuracy.within_tolerance or len(self.result.table) > _MEMBER_COST * _MAX_MEMBERS


def solve_cohort(
    run: CohortRun, seed: int, method: str | None, engine: Engine, store: CohortStore | None, progress: ProgressCallback
) -> CohortSolution:
    """Compute the results of a cohort by a series where the patients are similar, else by simulating each of them.

    By default (method None) a series is used if it holds and needs fewer simulations than there are patients. For the
    progress, it counts patients in proportion to its simulations.

    Raises ValueError: an unknown method, or a series of patients that are not similar.
    """
    method = None if method is None else known_name("method", method, METHODS)
    obstacle = "" if method == "runs" else find_obstacle(run.variability, run.counts)
    series = CohortSeries(run=run, seed=seed, engine=engine, store=store)
    try:
        if obstacle:
            raise NoSeriesError(obstacle)
        if method == "series" or (method is None and len(run) > series.cost):
            solution = series.solve(progress)
            if method == "series" or solution.is_acceptable:
                return solution
            obstacle = "its error exceeds the tolerance"
    except NoSeriesError as error:
        if method == "series":
            raise ValueError(f"the method 'series' does not hold: {error}; use the method 'runs'") from error
        obstacle = str(error)
    return CohortSolution(result=run.simulate(engine, store, progress), obstacle=obstacle)


@dataclass(frozen=True, kw_only=True, eq=False)
class CohortSeries:
    """Series for the patients of a cohort."""

    run: CohortRun  # patients
    seed: int  # seed of the samples
    engine: Engine  # executor of the simulations
    store: CohortStore | None = None  # store of the simulations

    @cached_property
    def family(self) -> FamilyRun:
        """Family that covers the patients, except those whose loads point to the rim."""
        patients, counts = self.run.variability, self.run.counts
        coarse = replace(patients, use=patients.coarse_simulation)  # workers need a cycle of tables
        similarity, distributions = Similarity(variability=coarse), tuple(patients.distributions.items())
        reference = SampleAxis(count=_REFERENCE_COUNT, distributions=distributions, seed=self.seed).values_in()
        ranges = {name: _range(values) for name, values in similarity.numbers(reference).items()}
        centre = {name: float(numpy.median(reference[name])) for name in similarity.angles}
        ranges |= cover_orientations(similarity, {name: ranges[name] for name in similarity.angles}, centre)
        low, high = _range(similarity.log_exposure(reference))
        exposures = low + log(counts[0]), high + log(counts[-1])
        return FamilyRun(similarity=similarity, box=Box(ranges=ranges), log_exposures=exposures)

    @property
    def first_degree(self) -> int:
        return _FIRST_DEGREES[len(set(self.family.box.axes) - {CLEARANCE})]

    @property
    def cost(self) -> int:
        """Number of patients whose simulation takes as long as the first series."""
        return _MEMBER_COST * members_of(self.family.box, self.first_degree) + N_HELD_OUT

    def solve(self, progress: ProgressCallback) -> CohortSolution:
        """Fit a series, estimate its error, refine it, and compute the results of all patients."""
        held_out = self._select(numpy.arange(min(N_HELD_OUT, len(self.run))))
        expected = held_out.simulate(self.engine, self.store)
        series, accuracy = self._refine(held_out, expected, progress)
        result, inside = series.results(self.run.values, self.run.counts)
        outside = numpy.flatnonzero(~inside)
        if len(outside):
            store = self.store
            if store is not None:
                store = replace(store, prefix="outside", identity=f"{store.identity} degree {series.degree}")
            simulated = self._select(outside).simulate(self.engine, store)
            merged = {name: getattr(result, name).copy() for name in ("table", "contact", "refused")}
            for name, values in merged.items():
                values[outside] = getattr(simulated, name)
            result = replace(result, **merged)
        progress(len(self.run))
        return CohortSolution(
            result=result, accuracy=replace(accuracy, n_outside=len(outside)), indices=self._indices(series)
        )

    def _select(self, patients: Numbers) -> CohortRun:
        return replace(self.run, values={name: samples[patients] for name, samples in self.run.values.items()})

    def _refine(
        self, held_out: CohortRun, expected: CohortResult, progress: ProgressCallback
    ) -> tuple[PatientSeries, SeriesAccuracy]:
        """Fit series of increasing degree until the error is allowed, or falls no more."""
        max_members = min(_MAX_MEMBERS, len(self.run) // _MEMBER_COST)  # less time than all patients
        degree, pieces = self.first_degree, dict[int, Mapping[str, Numbers]]()
        best: tuple[PatientSeries, SeriesAccuracy] | None = None
        while True:
            series = fit_series(self.family, self._simulate_members(degree, pieces, progress), degree)
            result, inside = series.results(held_out.values, held_out.counts)
            compared = inside & (expected.refused == "")
            if not compared.any():
                raise NoSeriesError("no simulated patient is within the ranges of the series")
            names, n_members = self.family.similarity.results, series.n_members
            accuracy = estimate_accuracy(result.select(compared), expected.select(compared), names, n_members, degree)
            improved = best is None or accuracy.tolerance_ratio < _LEAST_IMPROVEMENT * best[1].tolerance_ratio
            if best is None or accuracy.tolerance_ratio < best[1].tolerance_ratio:
                best = series, accuracy
            degree += _DEGREE_STEP
            if accuracy.within_tolerance or not improved or members_of(self.family.box, degree) > max_members:
                return best

    def _simulate_members(
        self, degree: int, pieces: dict[int, Mapping[str, Numbers]], progress: ProgressCallback
    ) -> list[Mapping[str, Numbers]]:
        """Simulate the members of a family for a degree that `pieces` does not have; return all of them."""
        numbers = range(members_of(self.family.box, degree) // MEMBERS_PER_PIECE)
        missing = [number for number in numbers if number not in pieces]
        store = None
        if self.store is not None:
            store = ArrayPieceStore(folder=self.store.folder, identity=self.store.identity, prefix="series")
        run = PieceRun(self.family, missing, store)
        pieces |= run.stored
        for number, piece in run.compute_missing(self.engine):
            pieces[number] = piece
            progress(int(len(self.run) * min(len(pieces) / (len(numbers) + 1), 1.0)))
        return [pieces[number] for number in numbers]

    def _indices(self, series: PatientSeries) -> Mapping[str, Numbers] | None:
        """Compute the Sobol indices of the results at the last report; None if orientations are not covered."""
        run = self.run
        names, counts, box = list(run.variability.distributions), run.counts[-1:], self.family.box
        for name in self.family.similarity.angles:
            low, high = box.ranges[name]
            if ((run.values[name] < low) | (run.values[name] > high)).mean() > _MAX_CUT:
                return None
        columns = [RESULT_COLUMNS[name] for name in INFLUENCED_RESULTS]

        def evaluate(samples: Numbers) -> Numbers:
            return series.results(dict(zip(names, samples, strict=True)), counts)[0].table[:, 0, columns].T

        distributions = list(run.variability.distributions.values())
        return sobol_indices(evaluate, distributions, _SOBOL_COUNT, self.seed, DEFAULT_LEVEL)


def _range(values: Numbers) -> tuple[float, float]:
    """Return the smallest and the largest finite value."""
    finite = values[numpy.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    return (low, high) if high - low > _LEAST_WIDTH * max(abs(low), abs(high)) else (low, low)


def cover_orientations(
    similarity: Similarity, ranges: Mapping[str, tuple[float, float]], centre: Mapping[str, float]
) -> dict[str, tuple[float, float]]:
    """Reduce ranges of the cup's angles in rad about a centre until no load in them points to the rim.

    Raises NoSeriesError: a load at the centre points to the rim.
    """
    if not similarity.keeps_loads_inside(centre):
        raise NoSeriesError("a load of the median patient points to the rim")
    limited = {
        name: (max(low, _ANGLE_LIMITS[name][0]), min(high, _ANGLE_LIMITS[name][1]))
        for name, (low, high) in ranges.items()
    }
    covered, ends = {name: (centre[name], centre[name]) for name in limited}, list(product(limited, (0, 1)))
    for moved_ends in (ends, *([end] for end in ends)):  # all ends together, then each alone
        covered = _extend(similarity, covered, limited, moved_ends)
    return covered


def _extend(
    similarity: Similarity,
    covered: Mapping[str, tuple[float, float]],
    limited: Mapping[str, tuple[float, float]],
    moved_ends: Sequence[tuple[str, int]],
) -> dict[str, tuple[float, float]]:
    """Move some ends of covered ranges towards those of the limited ranges, until a load points to the rim."""

    def move_ends(fraction: float) -> dict[str, tuple[float, float]]:
        ends = {name: list(pair) for name, pair in covered.items()}
        for name, end in moved_ends:
            ends[name][end] += fraction * (limited[name][end] - ends[name][end])
        return {name: (low, high) for name, (low, high) in ends.items()}

    if _keeps_loads_inside(similarity, move_ends(1.0)):
        return move_ends(1.0)
    return move_ends(bisect(0.0, 1.0, lambda share: _keeps_loads_inside(similarity, move_ends(share)), _BISECTIONS))


def _keeps_loads_inside(similarity: Similarity, ranges: Mapping[str, tuple[float, float]]) -> bool:
    """Check on a grid if no load points to the rim for angles within ranges."""
    axes = [numpy.linspace(low, high, _GRID_COUNT) for low, high in ranges.values()]
    return all(
        similarity.keeps_loads_inside(dict(zip(ranges, map(float, angles), strict=True))) for angles in product(*axes)
    )
