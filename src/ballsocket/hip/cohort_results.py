"""Results of simulated patients as arrays: wear, penetration, pressure, and validity of the contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf

import numpy

from ..core.arrays import Numbers
from .contact_checks import utilisation_and_validity
from .history import Report
from .simulation import HipSimulation

RESULT_UNITS: Mapping[str, str] = {
    "volume": "mm3",
    "depth": "mm",
    "penetration": "mm",
    "max_pressure": "MPa",
    "creep_depth": "mm",
    "edge_distance": "mm",
}
"""Results of each patient with their units; see `Report`."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CohortResult:
    """Results of several patients.

    Attributes
    ----------
    table : array (patients, reports, results)
        Results by `RESULT_UNITS`; NaN for a patient without a result.
    refused : array of str (patients,)
        Error messages of the patients without a result; empty for the others.
    contact : array (patients, 1 + reports, 2)
        Utilisation and validity (1 or 0) of the contact, unworn and at each report.
    """

    table: Numbers
    refused: Numbers
    contact: Numbers

    @property
    def peak_utilisation(self) -> Numbers:
        """Largest utilisation from the first cycle to each report: (patients, reports), NaN if unknown."""
        return numpy.maximum.accumulate(self.contact[:, :, 0], axis=1)[:, 1:]

    @property
    def valid(self) -> Numbers:
        """Validity from the first cycle to each report, 1 or 0: (patients, reports)."""
        return numpy.minimum.accumulate(self.contact[:, :, 1], axis=1)[:, 1:]


def join_results(results: Sequence[CohortResult]) -> CohortResult:
    """Join the results of consecutive groups of patients."""
    return CohortResult(
        table=numpy.concatenate([result.table for result in results]),
        refused=numpy.concatenate([result.refused for result in results]),
        contact=numpy.concatenate([result.contact for result in results]),
    )


def result_table(reports: Sequence[Report]) -> Numbers:
    """Return the results of `RESULT_UNITS` as an array (reports, results)."""
    return numpy.array([[_result_number(report, name) for name in RESULT_UNITS] for report in reports])


def contact_table(use: HipSimulation, reports: Sequence[Report]) -> Numbers:
    """Compute utilisation and validity of the contact, unworn and at each report: (1 + reports, 2)."""
    return utilisation_and_validity(
        use.contact_model, use.joint, [use.unworn_worst, *(report.worst_contacts for report in reports)]
    )


def _result_number(report: Report, name: str) -> float:
    """Return a result of a report as one number; the edge distance is the least one of the cycle."""
    value = getattr(report, name)
    return float(value.min(initial=inf)) if name == "edge_distance" else float(value)
