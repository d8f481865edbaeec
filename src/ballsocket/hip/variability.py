"""Variability between patients: distributions of their quantities, simulation of one patient, tables of results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import degrees, inf, isfinite, radians
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_names, require
from ..core.records import Record
from ..elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
from ..problem.cup import Cup
from ..studies.distributions import Distribution
from .contact_checks import check_rows
from .cup_frame import ANGLES
from .cycle import Cycle
from .cycle_registry import CYCLES
from .history import Report
from .simulation import HipSimulation, check_total_wear, make_report
from .wear_integrator import WearIntegrator
from .wear_law import with_coefficient

SAMPLED_QUANTITIES = (
    "coefficient",
    "clearance",
    "inclination",
    "anteversion",
    "tilt",
    "body_weight",
    "cycles_per_year",
)
"""Quantities that may differ between patients: mm³/(N m), mm, rad, rad, rad, N, and a number."""

DEFAULT_COUNT = 64  # default number of samples in each sample set of an uncertainty analysis

_COARSE_RINGS = radians(8.0)  # least ring width of a patient on springs; its error is below the variability
_COARSE_ELASTIC_RINGS = radians(6.0)  # ring width of a patient with full elasticity, the largest of `Sphere`
_COARSE_INSTANTS = 32  # largest number of instants of a cycle in a patient's simulation

DEFAULT_LEVEL = 0.95  # default fraction of the predictions within a band

INFLUENCED_RESULTS = ("volume", "depth", "penetration")
"""Results whose variance is divided among the sampled quantities."""

RESULT_UNITS: Mapping[str, str] = {
    "volume": "mm3",
    "depth": "mm",
    "penetration": "mm",
    "max_pressure": "MPa",
    "creep_depth": "mm",
    "edge_distance": "mm",
}
"""Results of each patient with their units; see `Report`."""

RESULT_COLUMNS = {name: column for column, name in enumerate(RESULT_UNITS)}  # of a table of results


@dataclass(frozen=True, kw_only=True, eq=False)
class PatientVariability:
    """Independent distributions of the quantities that vary between patients.

    Parameters
    ----------
    use : HipSimulation
        Hip of the nominal patient. The other patients have rings of 8° (springs) or 6° and 32 instants a cycle.
    distributions : mapping of str to Rectangular, Normal or LogNormal
        Distributions by name of `SAMPLED_QUANTITIES`. Forces are proportional to `body_weight`, cycles in a given time
        to `cycles_per_year`. `coefficient` is that of the wear law. Of a law with two coefficients it is that on a
        straight track, and their ratio stays the same.
    body_weight : float, optional
        Body weight in N that the cycle's forces belong to. Default: the median.
    surface : Springs, ClosedShell or RealCup, optional
        Foundation of the patients' sockets. Default: the springs of `use`, or the paper's. A patient with `RealCup()`
        takes some 80 times as long as one on springs. Patients with the same joint share the compliance of their cup.

    Raises
    ------
    ValueError
        No distribution, an unknown quantity, a tilt with another orientation, or a law without a coefficient.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.hip import Archard, HipSimulation, PatientVariability, iso_14242_1
    >>> from ballsocket.studies import LogNormal
    >>> joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    >>> use = HipSimulation(joint=joint, cycle=iso_14242_1(), wear=Archard(coefficient=1e-6))
    >>> distributions = {"coefficient": LogNormal(median=1e-6, factor=1.5)}
    >>> variability = PatientVariability(use=use, distributions=distributions)
    >>> reports = variability.patient({"coefficient": 2e-6}).simulate([1e6])
    >>> round(reports[0].volume / variability.patient({}).simulate([1e6])[0].volume, 1)
    2.1
    """

    use: HipSimulation
    distributions: Mapping[str, Distribution]
    body_weight: float | None = None
    surface: Springs | ClosedShell | RealCup | None = None

    def __post_init__(self) -> None:
        check_names(self.distributions, SAMPLED_QUANTITIES, "among the quantities of patients")
        if not self.distributions:
            raise ValueError("no quantity differs between patients: give one of " + ", ".join(SAMPLED_QUANTITIES))
        if "tilt" in self.distributions:
            for name in ("inclination", "anteversion"):
                if name in self.distributions:
                    raise ValueError(f"tilt and {name} both orient the cup: give one of them")
        if "coefficient" in self.distributions:
            with_coefficient(self.use.wear, 0.0)
        for name in ("body_weight", "cycles_per_year"):
            if name in self.distributions:
                median = float(self.distributions[name].frozen.median())
                require(f"the median of {name}", median, 0 < median < inf, "it must be positive")

    @property
    def noun(self) -> str:
        """Noun for those who differ: "patients", or "samples" of a simulator whose loads belong to no patient."""
        quantities_of_patients = {"body_weight", "cycles_per_year"} & set(self.distributions)
        of_patients = self.use.cycle.per_year is not None or any(
            cycle.name in CYCLES and CYCLES[cycle.name].per_body_weight for cycle in self.use.cycle.activity_cycles
        )
        return "patients" if quantities_of_patients or of_patients else "samples"

    @cached_property
    def _medians_by_name(self) -> dict[str, float]:
        return {name: float(distribution.frozen.median()) for name, distribution in self.distributions.items()}

    @property
    def cycles_per_year(self) -> float | None:
        """Number of cycles of the nominal patient a year; None if unknown."""
        per_year = self.use.cycle.per_year
        return self._medians_by_name.get("cycles_per_year") if per_year is None else per_year

    @cached_property
    def coarse_simulation(self) -> HipSimulation:
        """Simulation of the nominal patient with few time steps and wide rings."""
        use, surface = self.use, self.surface
        if surface is None:
            surface = self.use.surface if self.use.uses_springs else Springs()
        on_springs = isinstance(surface, Springs)
        return replace(
            use,
            surface=surface,
            ring_width=max(use.ring_width, _COARSE_RINGS) if on_springs else _COARSE_ELASTIC_RINGS,
            cycle=use.cycle.transformed(_tabulate_cycle),
            cup=use.frame.placed,
        )

    def patient(self, values: Mapping[str, float]) -> Patient:
        """Create a patient from a value of each sampled quantity.

        Parameters
        ----------
        values : mapping of str to float
            Values by name of `SAMPLED_QUANTITIES`. The nominal patient has the others.

        Raises
        ------
        ValueError
            A value that is not allowed, or an orientation in which the cup does not hold the ball.
        """
        use, cup = self.coarse_simulation, self.orient_cup(values)
        cycle_ratio = self._ratio_to_nominal(values, "cycles_per_year")
        force_ratio = self._ratio_to_nominal(values, "body_weight")
        wear = use.wear
        if "coefficient" in values:
            require("coefficient", values["coefficient"], values["coefficient"] >= 0, "it must be at least 0")
            wear = with_coefficient(wear, values["coefficient"])
        seconds = use.seconds_per_cycle
        return Patient(
            use=replace(
                use,
                joint=replace(use.joint, clearance=values.get("clearance", use.joint.clearance)),
                cup=cup,
                wear=wear,
                cycle=use.cycle.scaled(force_ratio) if force_ratio != 1 else use.cycle,
                seconds_per_cycle=None if seconds is None else seconds / cycle_ratio,
            ),
            cycle_ratio=cycle_ratio,
        )

    def _ratio_to_nominal(self, values: Mapping[str, float], name: str) -> float:
        if name not in values:
            return 1.0
        require(name, values[name], 0 < values[name] < inf, "it must be positive")
        return values[name] / self.nominal_value(name)

    def nominal_value(self, name: str) -> float:
        """Return the body weight in N, or the cycles a year, that the cycle of the nominal patient belongs to."""
        stated = self.body_weight if name == "body_weight" else self.cycles_per_year
        return stated or self._medians_by_name[name]

    def orient_cup(self, values: Mapping[str, float]) -> Cup:
        """Return the cup of a patient, with the angles in rad among the values; ValueError for angles not allowed."""
        cup = self.coarse_simulation.cup
        cup = cup.tilted(values["tilt"]) if "tilt" in values else cup
        orientation: Any = {name: values[name] for name in ("inclination", "anteversion") if name in values}
        return replace(cup, **orientation)


@dataclass(frozen=True, kw_only=True, eq=False)
class Patient:
    """Wear simulation of one patient of a cohort, with the ratio of the patient's cycles to the nominal ones."""

    use: HipSimulation  # hip of the patient
    cycle_ratio: float  # ratio of the patient's cycles to those of the nominal patient in the same time

    def simulate(self, counts: Sequence[float]) -> tuple[Report, ...]:
        """Simulate the wear of this patient, and return reports at the nominal patient's cycle counts."""
        check_total_wear(self.use, self.cycle_ratio * counts[-1])
        integrator = WearIntegrator(setup=self.use)
        reports = tuple(
            make_report(integrator.run_until(self.cycle_ratio * report_count, lambda cycles: None))
            for report_count in counts
        )
        if not all(report.converged for report in reports):
            raise ValueError("a contact did not balance its load")
        return reports


@dataclass(frozen=True, eq=False)
class _CycleTable:
    """Periodic function of the phase, linear between values (..., n) at phases (n,) in parts of the cycle."""

    phases: Numbers
    values: Numbers

    def __call__(self, phases: Numbers) -> Numbers:
        """Interpolate the tabulated values at phases (n,) from 0 to 1: (..., n)."""
        interpolated_rows = [
            numpy.interp(phases, self.phases, row_values, period=1.0) for row_values in numpy.atleast_2d(self.values)
        ]
        return numpy.reshape(interpolated_rows, (*self.values.shape[:-1], -1))


def _tabulate_cycle(cycle: Cycle) -> Cycle:
    """Convert a cycle to one with few time steps, whose forces and angles are tabulated."""
    coarse = replace(cycle, n_steps=min(cycle.n_steps, _COARSE_INSTANTS))
    midpoints, starts = coarse.phases, numpy.arange(coarse.n_steps) / coarse.n_steps
    force = numpy.asarray(coarse.force(midpoints), dtype=float)
    angles = numpy.asarray(coarse.angles(starts), dtype=float)
    return replace(coarse, force=_CycleTable(midpoints, force), angles=_CycleTable(starts, angles))


@dataclass(frozen=True, kw_only=True, eq=False)
class CohortResult(Record):
    """Results of several patients as arrays."""

    table: Numbers  # (patients, reports, results), results by `RESULT_UNITS`; NaN for a patient without a result
    refused: Numbers  # str (patients,), error messages of the patients without a result; empty for the others
    # (patients, 1 + reports, 3), utilisation, validity (1 or 0) and edge loading (1 or 0) of the contact, unworn
    # and at each report
    contact: Numbers

    def select(self, patients: Numbers) -> CohortResult:
        """Return the results of some patients by their mask or indices."""
        return CohortResult(table=self.table[patients], refused=self.refused[patients], contact=self.contact[patients])

    @property
    def peak_utilisation(self) -> Numbers:
        """Largest ratio of von Mises to yield stress up to each report: (patients, reports)."""
        return numpy.maximum.accumulate(self.contact[:, :, 0], axis=1)[:, 1:]

    @property
    def valid(self) -> Numbers:
        """Validity of all contacts up to each report, 1 or 0: (patients, reports)."""
        return numpy.minimum.accumulate(self.contact[:, :, 1], axis=1)[:, 1:]

    @property
    def edge_loaded(self) -> Numbers:
        """Edge loading in any instant of the cycle, 1 or 0: (patients, reports)."""
        return self.contact[:, 1:, 2]


def join_results(results: Sequence[CohortResult]) -> CohortResult:
    """Join the results of consecutive groups of patients to one `CohortResult`."""
    return CohortResult(
        table=numpy.concatenate([result.table for result in results]),
        refused=numpy.concatenate([result.refused.astype(object) for result in results]),
        contact=numpy.concatenate([result.contact for result in results]),
    )


def result_table(reports: Sequence[Report]) -> Numbers:
    """Tabulate the results named in `RESULT_UNITS` at each report: (reports, results)."""
    # of the edge distances of a cycle the least
    return numpy.array([[numpy.min(getattr(report, name), initial=inf) for name in RESULT_UNITS] for report in reports])


def contact_table(use: HipSimulation, reports: Sequence[Report]) -> Numbers:
    """Tabulate ratio of von Mises to yield stress, validity and edge loading of the first cycle and each report."""
    worst = numpy.stack([use.unworn_worst_contacts, *(report.worst_contacts for report in reports)])
    utilisation, valid = numpy.full(len(worst), numpy.nan), numpy.ones(len(worst))
    if worst.size:  # something is pressed
        checked = check_rows(use.contact_model, use.joint, worst.reshape(-1, worst.shape[-1]))
        by_stage = checked.reshape(2, *worst.shape[:2])
        utilisation, valid = by_stage[0].max(axis=1), by_stage[1].min(axis=1)
    at_rim = use.edge(use.unworn).distance <= 0
    edge_loaded = [float(mask.any()) for mask in (at_rim, *(report.edge_loaded for report in reports))]
    return numpy.column_stack([utilisation, valid, edge_loaded])


def summarize_distributions(variability: PatientVariability) -> dict[str, Any]:
    """Return type and parameters of all distributions as a dictionary for JSON, angles in degrees."""
    summary = {}
    for name, distribution in variability.distributions.items():
        factor = degrees(1.0) if name in ANGLES else 1.0
        parameters = {parameter.name: getattr(distribution, parameter.name) for parameter in fields(distribution)}
        shown_parameters = {key: factor * value for key, value in parameters.items() if isfinite(value)}
        summary[name] = {"distribution": type(distribution).__name__, **shown_parameters}
    return summary
