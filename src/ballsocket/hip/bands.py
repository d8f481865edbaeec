"""Uncertainty bands of a wear prediction over patients, and the influence of each sampled quantity."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from math import degrees
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.display import finite_or_none
from ..core.kinds import Unit
from ..core.unit_systems import Amount, Sentence
from .contact_checks import list_check_notes
from .series_accuracy import SeriesAccuracy
from .variability import (
    DEFAULT_LEVEL,
    INFLUENCED_RESULTS,
    RESULT_COLUMNS,
    RESULT_UNITS,
    CohortResult,
    PatientVariability,
    summarize_distributions,
)
from .wear_law import COEFFICIENT, coefficient_field

CONVERTED = ("volume", "depth", "penetration")  # results that are converted to shared coefficients


@dataclass(frozen=True, kw_only=True, eq=False)
class SharedCoefficient:
    """Results of a cohort whose patients all have the same wear coefficient: low, median or high."""

    # coefficients at the lower end, the middle and the upper end of the band of the coefficient
    values: Mapping[str, float]
    results: Mapping[str, Numbers]  # (patients, reports, results), results of `CONVERTED`, by the names in `values`

    def quantile(self, coefficient: str, name: str, fraction: float) -> Numbers:
        """Compute a quantile of a result over the patients at each report, for one wear coefficient."""
        key = coefficient, name, fraction
        if key not in self._quantiles:
            self._quantiles[key] = quantile_of_known(self.results[coefficient][:, :, CONVERTED.index(name)], fraction)
        return self._quantiles[key]

    @cached_property
    def _quantiles(self) -> dict[tuple[str, str, float], Numbers]:
        return {}


@dataclass(frozen=True, kw_only=True, eq=False)
class Bands:
    """Uncertainty bands (quantiles) of the results of a patient cohort.

    Attributes
    ----------
    variability : PatientVariability
        Distributions of the patients.
    counts : tuple of float
        Cycles of the nominal patient at the reports.
    cohort : CohortResult
        Results of the patients.
    seed : int
        Seed of the samples.
    level : float
        Fraction of the predictions within a band, and of the patients within a band for one coefficient.
    indices : mapping of str to array (results, sampled quantities), optional
        Sobol indices of `INFLUENCED_RESULTS`: `first_order`, `total_order`, and the ends of their intervals with the
        suffixes `_low` and `_high`.
    quick_run_errors : mapping of str to float
        Relative difference between the nominal patient's coarse and full simulations.
    members : str
        Noun for the members of the bands; by default that of the variability.
    shared : SharedCoefficient, optional
        Results of the patients for a shared wear coefficient; None without a sampled coefficient and another quantity.
    accuracy : SeriesAccuracy, optional
        Accuracy of the series that the results of a cohort come from; None if each patient was simulated.
    obstacle : str
        Reason in one clause why the cohort has no series; empty if it has one, or none was needed.
    """

    variability: PatientVariability
    counts: tuple[float, ...]
    cohort: CohortResult
    seed: int = 0
    level: float = DEFAULT_LEVEL
    indices: Mapping[str, Numbers] | None = None
    quick_run_errors: Mapping[str, float] = field(default_factory=dict)
    shared: SharedCoefficient | None = None
    members: str = ""
    accuracy: SeriesAccuracy | None = None
    obstacle: str = ""

    @property
    def noun(self) -> str:
        """Noun for the simulated members: "patients", or "samples" of a simulator."""
        return self.members or self.variability.noun

    @property
    def subject(self) -> str:
        """Noun for the members of the bands: "predictions" if the wear coefficient is unknown, else `noun`."""
        return "predictions" if COEFFICIENT in self.variability.distributions else self.noun

    @property
    def n_patients(self) -> int:
        """Number of simulated patients."""
        return len(self.cohort.refused)

    @property
    def n_failed(self) -> int:
        """Number of patients whose simulation has no result."""
        return int((self.cohort.refused != "").sum())

    @property
    def ends(self) -> tuple[float, float]:
        """Probabilities of the lower and upper end of each band, such as 0.025 and 0.975."""
        low_probability = (1 - self.level) / 2
        return low_probability, 1 - low_probability

    @property
    def _probabilities_by_name(self) -> dict[str, float]:
        low, high = self.ends
        return {"low": low, "median": 0.5, "high": high}

    def quantile(self, name: str, fraction: float) -> Numbers:
        """Compute a quantile of one result over the patients at each report; NaN without results.

        Parameters
        ----------
        name : str
            Name in `RESULT_UNITS`.
        fraction : float
            Fraction of the patients below the quantile.
        """
        if self.n_failed == self.n_patients:
            return numpy.full(len(self.counts), numpy.nan)
        if (name, fraction) not in self._quantiles:
            values = self.cohort.table[:, :, RESULT_COLUMNS[name]]
            self._quantiles[name, fraction] = quantile_of_known(values, fraction)
        return self._quantiles[name, fraction]

    @cached_property
    def _quantiles(self) -> dict[tuple[str, float], Numbers]:
        return {}

    def band(self, name: str) -> tuple[Numbers, Numbers]:
        """Compute the lower and upper end of the band of one result at each report, such as "volume"."""
        low, high = (self.quantile(name, fraction) for fraction in self.ends)
        return low, high

    def population_band(self, name: str, coefficient: str = "median") -> tuple[Numbers, Numbers]:
        """Compute the lower and upper end of the band of patients who share one wear coefficient.

        Parameters
        ----------
        name : str
            "volume", "depth" or "penetration".
        coefficient : str
            "low", "median" or "high": the ends and the middle of the band of the coefficient.

        Raises
        ------
        ValueError
            An unknown name or coefficient, or bands without a shared coefficient.
        """
        if self.shared is None:
            raise ValueError("a band for one coefficient needs [uncertainty] with coefficient and another quantity")
        if coefficient not in self.shared.values:
            raise ValueError(f"coefficient = {coefficient!r} is not allowed: {', '.join(self.shared.values)}")
        if name not in CONVERTED:
            raise ValueError(f"{name!r} has no band for one coefficient: {', '.join(CONVERTED)}")
        low, high = (self.shared.quantile(coefficient, name, fraction) for fraction in self.ends)
        return low, high

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the assumptions and limits of the bands."""
        return tuple(self._list_notes())

    def _list_notes(self) -> Iterator[str]:
        variability, noun, count = self.variability, self.noun, self.n_patients
        patients = variability.coarse_simulation
        if self.accuracy is not None:
            yield from self.accuracy.notes(noun, count)
        elif self.obstacle:
            yield f"each of the {noun} was simulated, without a series: {self.obstacle}"
        yield f"assumed: given and independent distributions of {', '.join(variability.distributions)}"
        if COEFFICIENT in variability.distributions:
            low, high = variability.distributions[COEFFICIENT].frozen.ppf(self.ends)
            coefficient = coefficient_field(variability.use.wear)
            unit = Unit("" if coefficient is None else coefficient.unit.text)
            text = f"the wear coefficient is unknown, but the same for all {noun}: {100 * self.level:g} % between"
            yield Sentence(f"{text} {{}} and {{}}", Amount(float(low), unit, 3), Amount(float(high), unit, 3))
        if not patients.uses_springs:
            rings = degrees(patients.ring_width)
            yield f"the bands are for full elasticity ({type(patients.surface).__name__}) on rings of {rings:.2g}°"
        elif not variability.use.uses_springs:
            yield "the bands are for radial springs"
        if self.n_failed:
            reasons = Counter(str(error).split(":")[0] for error in self.cohort.refused if error)
            failed = f"{self.n_failed} of {count} {noun} have no result, most often: {reasons.most_common(1)[0][0]}"
            yield f"{failed}; the bands are for the others"
        depth = self.cohort.table[:, -1, RESULT_COLUMNS["depth"]]
        if n_worn_through := int((depth > variability.use.joint.liner_thickness).sum()):
            yield f"{n_worn_through} of {count} {noun} wear their liner through"
        if n_invalid := int((self.cohort.valid[:, -1] == 0).sum()):
            model = patients.contact_model.name
            yield f"{n_invalid} of {count} {noun} have contacts outside the validity of the contact model ({model})"

    @property
    def nominal_notes(self) -> tuple[str, ...]:
        """Sentences on the simulation of the nominal patient: contact model, cycle, cup and laws."""
        stage = f"nominal {self.noun.removesuffix('s')}, in the first cycle"
        checks = self.variability.coarse_simulation.unworn_checks
        return (*list_check_notes([(stage, checks)]), *self.variability.use.notes)

    def _mean_of_known(self, values: Numbers) -> float:
        known = values[self.cohort.refused == ""]
        return float(known.mean()) if len(known) else numpy.nan

    def valid_fraction(self, report: int) -> float:
        """Compute the fraction of patients whose contacts are valid from the first cycle to a report."""
        return self._mean_of_known(self.cohort.valid[:, report])

    @property
    def valid(self) -> bool:
        """True if the contacts of all patients with a result are valid from the first cycle to the last report."""
        valid = self.cohort.valid[self.cohort.refused == ""]
        return bool(valid.size and (valid == 1).all())

    def utilisation_quantile(self, fraction: float) -> Numbers:
        """Compute a quantile of the patients' largest ratio of von Mises to yield stress at each report."""
        utilisations = self.cohort.peak_utilisation
        known_utilisations = utilisations[~numpy.isnan(utilisations).any(axis=1)]
        if not len(known_utilisations):
            return numpy.full(len(self.counts), numpy.nan)
        return numpy.quantile(known_utilisations, fraction, axis=0)

    def edge_loading(self, report: int) -> float:
        """Compute the fraction of patients whose contact reaches the rim during the cycle, at a report."""
        return self._mean_of_known(self.cohort.table[:, report, RESULT_COLUMNS["edge_distance"]] <= 0)

    def edge_loaded_fraction(self, report: int) -> float:
        """Compute the fraction of patients with edge loading at a report; see `RimDistance.edge_loaded`.

        A bore that is worn to the rim is not edge loading: `edge_loading` counts it, this method does not.
        """
        return self._mean_of_known(self.cohort.edge_loaded[:, report])

    def table(self) -> list[dict[str, float]]:
        """Return the bands at each report, as dictionaries of numbers by column name with unit: "volume_low_mm3"."""
        columns = {
            f"{name}_{end_name}_{RESULT_UNITS[name]}": self.quantile(name, fraction)
            for name in CONVERTED
            for end_name, fraction in self._probabilities_by_name.items()
        }
        return [{head: float(values[report]) for head, values in columns.items()} for report in range(len(self.counts))]

    def summary(self) -> dict[str, Any]:
        """Return the bands as a dictionary for JSON."""
        sobol = (
            None
            if self.indices is None
            else {
                result: {
                    name: {order: finite_or_none(values[row, column]) for order, values in self.indices.items()}
                    for column, name in enumerate(self.variability.distributions)
                }
                for row, result in enumerate(INFLUENCED_RESULTS)
            }
        )
        return {
            "bands": [self._summarize_report(report) for report in range(len(self.counts))],
            "sobol": sobol,
            "uncertainty": {
                "patients": self.n_patients,
                "without_answer": self.n_failed,
                "seed": self.seed,
                "level": self.level,
                "scatter": summarize_distributions(self.variability),
                "coefficient": None if self.shared is None else dict(self.shared.values),
                "quick_run_off": dict(self.quick_run_errors),
                "method": "runs" if self.accuracy is None else "series",
                "series": None if self.accuracy is None else self.accuracy.summary(),
            },
        }

    def _summarize_report(self, report: int) -> dict[str, Any]:

        def values(quantile: Callable[[float], Numbers]) -> dict[str, Any]:
            """Return a quantile at the report for the ends and the middle of a band."""
            probabilities = self._probabilities_by_name.items()
            return {end_name: finite_or_none(quantile(fraction)[report]) for end_name, fraction in probabilities}

        bands = {name: values(partial(self.quantile, name)) for name in RESULT_UNITS}
        if self.shared is not None:
            for name in CONVERTED:
                bands[name]["given_coefficient"] = {
                    coefficient: values(partial(self.shared.quantile, coefficient, name))
                    for coefficient in self.shared.values
                }
        year = self.variability.cycles_per_year
        return {
            "cycles": self.counts[report],
            **({} if year is None else {"years": self.counts[report] / year}),
            **bands,
            "edge_loading": finite_or_none(self.edge_loading(report)),
            "edge_loaded": finite_or_none(self.edge_loaded_fraction(report)),
            "peak_utilisation": values(self.utilisation_quantile),
            "valid": finite_or_none(self.valid_fraction(report)),
        }


def quantile_of_known(values: Numbers, fraction: float) -> Numbers:
    """Compute a quantile of the values (patients, reports) that are not NaN at each report."""
    reports = (column[~numpy.isnan(column)] for column in values.T)
    return numpy.array([numpy.quantile(known, fraction) if len(known) else numpy.nan for known in reports])
