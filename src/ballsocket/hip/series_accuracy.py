"""Accuracy of a series, from patients that were simulated but not fitted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy

from ..core.display import counted
from .variability import RESULT_COLUMNS, RESULT_UNITS, CohortResult

TOLERANCES: Mapping[str, float] = {
    "volume": 1e-3,
    "depth": 1e-2,
    "penetration": 5e-3,
    "max_pressure": 5e-3,
    "creep_depth": 1e-2,
}
"""Relative errors that a series is refined to, for 95 % of the results of the held-out patients."""

_FRACTION = 0.95  # fraction of the held-out results within the stated error


@dataclass(frozen=True, kw_only=True)
class SeriesAccuracy:
    """Accuracy of a series, from patients that were simulated but not fitted.

    Attributes
    ----------
    n_simulations : int
        Simulations that the series is fitted to.
    degree : int
        Total degree of its polynomials.
    n_held_out : int
        Number of held-out patients within the ranges of the series.
    relative : mapping of str to float
        Relative error that 95 % of the held-out results are within, by result.
    largest : mapping of str to float
        Largest relative error of the held-out results, by result.
    edge_distance : float
        Error of the distance from the rim in mm that 95 % of them are within.
    utilisation : float
        Absolute error of the utilisation that 95 % of them are within.
    wrong_edge_loading, wrong_validity : float
        Fractions of held-out results with another edge loading or validity.
    n_outside : int
        Patients of the cohort outside the ranges of the series, which were simulated.
    """

    n_simulations: int
    degree: int
    n_held_out: int
    relative: Mapping[str, float]
    largest: Mapping[str, float]
    edge_distance: float
    utilisation: float
    wrong_edge_loading: float
    wrong_validity: float
    n_outside: int = 0

    @property
    def tolerance_ratio(self) -> float:
        """Largest ratio of an error to its tolerance."""
        return max(error / TOLERANCES[name] for name, error in self.relative.items())

    @property
    def within_tolerance(self) -> bool:
        """True if all errors are within `TOLERANCES`."""
        return self.tolerance_ratio <= 1

    def summary(self) -> dict[str, Any]:
        """Return the error as a dictionary for JSON."""
        return {
            "simulations": self.n_simulations,
            "degree": self.degree,
            "held_out": self.n_held_out,
            "level": _FRACTION,
            "error": dict(self.relative),
            "largest_error": dict(self.largest),
            "tolerance": {name: TOLERANCES[name] for name in self.relative},
            "within_tolerance": self.within_tolerance,
            "edge_distance_error_mm": self.edge_distance,
            "utilisation_error": self.utilisation,
            "wrong_edge_loading": self.wrong_edge_loading,
            "wrong_validity": self.wrong_validity,
            "outside": self.n_outside,
        }

    def notes(self, noun: str, n_patients: int) -> tuple[str, ...]:
        """Describe the series, its error and the patients outside its ranges, for reports of a cohort."""
        errors = ", ".join(f"{100 * error:.2g} % in {name}" for name, error in self.relative.items())
        described = (
            f"series of {counted(self.n_simulations, 'simulation')} in place of {n_patients}: {100 * _FRACTION:g} % of "
            f"the results of {self.n_held_out} simulated {noun} are within {errors.replace('_', ' ')}"
        )
        if not self.within_tolerance:
            limits = ", ".join(f"{100 * TOLERANCES[name]:g} % in {name}" for name in self.relative)
            described += (
                f"; this exceeds the tolerance of {limits.replace('_', ' ')}: the method 'runs' has no such error"
            )
        if self.wrong_edge_loading > 1 - _FRACTION:
            described += f"; edge loading differs in {100 * self.wrong_edge_loading:.2g} % of these results"
        outside = f"{self.n_outside} of {n_patients} {noun} are outside the range of the series and were simulated"
        return (described, outside) if self.n_outside else (described,)


def estimate_accuracy(
    result: CohortResult, expected: CohortResult, names: Sequence[str], n_simulations: int, degree: int
) -> SeriesAccuracy:
    """Compare the results of a series with simulations of the same patients; errors of `names` are relative."""
    ratios = {
        name: abs(result.table[:, :, column] / expected.table[:, :, column] - 1)
        for column, name in enumerate(RESULT_UNITS)
        if name in names
    }
    edge = RESULT_COLUMNS["edge_distance"]
    differences = abs(result.contact - expected.contact)
    known = differences[:, :, 0][numpy.isfinite(differences[:, :, 0])]
    return SeriesAccuracy(
        n_simulations=n_simulations,
        degree=degree,
        n_held_out=len(result.table),
        relative={name: float(numpy.quantile(errors, _FRACTION)) for name, errors in ratios.items()},
        largest={name: float(errors.max()) for name, errors in ratios.items()},
        edge_distance=float(numpy.quantile(abs(result.table - expected.table)[:, :, edge], _FRACTION)),
        utilisation=float(numpy.quantile(known, _FRACTION)) if len(known) else 0.0,
        wrong_edge_loading=float((differences[:, :, 2] > 0).mean()),
        wrong_validity=float((differences[:, :, 1] > 0).mean()),
    )
