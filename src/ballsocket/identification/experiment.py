"""The next measurement: the quantity and the load from which the data would gain most information."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import log
from typing import Any

import numpy

from ..core.arrays import Numbers
from .fit import FittedModel
from .forward_model import ForwardModel
from .information import MAX_WIDTH_RATIO
from .measured import IDEAL_MACHINE, OF_JOINT, Machine, Measured

STANDARD_QUANTITIES = ("indentation", "half_angle", "max_pressure", "diametral_clearance")
"""Quantities of the default candidates: the last is the free play of a joint, and needs no load."""

_RELATIVE_UNCERTAINTY = 0.02  # of a quantity that has not been measured yet
_N_LOADS = 6
_LOAD_FACTOR = 1.5  # largest load of a candidate over the largest load of the data
_DEFAULT_FORCE = 2000.0  # largest load in N for data without forces


@dataclass(frozen=True)
class Candidate:
    """Possible next measurement: quantity, load and uncertainty.

    Attributes
    ----------
    quantity : str
        One of `ballsocket.identification.MEASURED`.
    uncertainty : float
        Standard uncertainty in the unit of the quantity.
    force : float or None
        Load in N; None for a number of the joint.
    machine : Machine
        Machine that would read an indentation.
    order : float
        Number of the reading, for a machine with a drifting zero.
    """

    quantity: str
    uncertainty: float
    force: float | None = None
    machine: Machine = IDEAL_MACHINE
    order: float = 0.0

    def measured(self, value: float) -> Measured:
        """Return a data set for this candidate, with an assumed measured value."""
        return Measured(
            quantity=self.quantity,
            values=value,
            uncertainty=self.uncertainty,
            force=self.force,
            machine=self.machine,
            order=self.order,
        )


@dataclass(frozen=True)
class Gain:
    """Expected information gain of a candidate measurement.

    Attributes
    ----------
    candidate : Candidate
    bits : float
        Half log2 of the growth of the information's determinant (D-optimal).
    uncertainty_ratio : dict of str to float
        Uncertainty of each unknown after the measurement over its present uncertainty.
    identifies : tuple of str
        Unknowns that this measurement would make identifiable.
    """

    candidate: Candidate
    bits: float
    uncertainty_ratio: dict[str, float]
    identifies: tuple[str, ...]

    def summary(self) -> dict[str, Any]:
        """Return the information gain of the candidate as a dictionary for JSON."""
        return {
            "quantity": self.candidate.quantity,
            "force": self.candidate.force,
            "uncertainty": self.candidate.uncertainty,
            "bits": self.bits,
            "left": self.uncertainty_ratio,
        }


@dataclass(frozen=True, eq=False)
class Experiment:
    """Candidates for the next measurement, in descending order of their information gain.

    Attributes
    ----------
    gains : tuple of Gain
    unidentifiable : tuple of str
        Unknowns that are unidentifiable at present.
    """

    gains: tuple[Gain, ...]
    unidentifiable: tuple[str, ...]

    @property
    def best(self) -> Gain:
        """Candidate with the largest information gain."""
        return self.gains[0]

    @property
    def best_by_quantity(self) -> tuple[Gain, ...]:
        """Best candidate of each quantity, in descending order of information gain."""
        best: dict[str, Gain] = {}
        for gain in self.gains:
            best.setdefault(gain.candidate.quantity, gain)
        return tuple(best.values())

    @property
    def sufficient_quantities(self) -> tuple[str, ...]:
        """Quantities for which one measurement would make every unknown identifiable."""
        if not self.unidentifiable:
            return ()
        wanted = set(self.unidentifiable)
        sufficient = {gain.candidate.quantity for gain in self.gains if set(gain.identifies) == wanted}
        return tuple(name for name in STANDARD_QUANTITIES if name in sufficient)

    def summary(self) -> list[dict[str, Any]]:
        """Return the information gains of all candidates as a list for JSON."""
        return [gain.summary() for gain in self.gains]


def experiment(fitted: FittedModel, candidates: Iterable[Candidate] | None = None) -> Experiment:
    """Compute the expected information gain of each candidate for the next measurement.

    Parameters
    ----------
    fitted : IdentificationResult
    candidates : iterable of Candidate
        By default the standard quantities at loads up to one and a half times those of the data. Their uncertainties
        are those of the data, or 2 % for a new quantity.

    References
    ----------
    Chaloner & Verdinelli 1995, Stat. Sci. 10, 273.
    """
    candidate_list = standard_candidates(fitted) if candidates is None else tuple(candidates)
    forward = _candidate_model(fitted, candidate_list)
    slope_rows = fitted.misfit.slopes(forward, fitted.transform, fitted.best.theta)[1]
    gains = [
        _compute_gain(fitted, candidate, slopes)
        for candidate, slopes in zip(candidate_list, slope_rows, strict=True)
        if numpy.isfinite(slopes).all()
    ]
    return Experiment(tuple(sorted(gains, key=lambda gain: -gain.bits)), fitted.information.unidentifiable)


def standard_candidates(fitted: FittedModel) -> tuple[Candidate, ...]:
    """List the default candidates for the next measurement: the standard quantities at several loads."""
    force_arrays = [measured.loads for measured in fitted.data if measured.load == "force"]
    force_arrays += [
        forces for measured, forces in zip(fitted.data, fitted.results, strict=True) if measured.quantity == "force"
    ]
    largest = float(numpy.max(numpy.concatenate(force_arrays), initial=0.0)) if force_arrays else 0.0
    forces = numpy.linspace(0.0, _LOAD_FACTOR * (largest or _DEFAULT_FORCE), _N_LOADS + 1)[1:].tolist()
    quantities_and_forces = [
        (quantity, None) if quantity in OF_JOINT else (quantity, force)
        for quantity in STANDARD_QUANTITIES
        for force in forces
    ]
    candidates = [
        Candidate(quantity, 1.0, force, *_choose_indentation_machine(fitted, quantity))
        for quantity, force in dict.fromkeys(quantities_and_forces)
    ]
    best_values = numpy.atleast_2d(fitted.transform.to_values(fitted.best.theta))
    values = _candidate_model(fitted, candidates).results_at(best_values)[0]
    return tuple(
        replace(candidate, uncertainty=_estimate_uncertainty(fitted, candidate.quantity, value))
        for candidate, value in zip(candidates, values.tolist(), strict=True)
        if value > 0
    )


def _choose_indentation_machine(fitted: FittedModel, quantity: str) -> tuple[Machine, float]:
    """Choose the machine of the measured indentations, and the number of its next reading."""
    reading_numbers = {
        measured.machine: measured.order for measured in fitted.data if measured.machine is not IDEAL_MACHINE
    }
    if quantity != "indentation" or not reading_numbers:
        return IDEAL_MACHINE, 0.0
    machine, numbers = next(iter(reading_numbers.items()))
    return machine, float(numbers.max()) + 1


def _estimate_uncertainty(fitted: FittedModel, quantity: str, value: float) -> float:
    """Estimate the uncertainty of a new measurement: absolute or relative, whichever varies less in the data."""
    uncertainties_and_values = [
        (uncertainty if measured.has_unknown_noise else measured.uncertainty, abs(measured.values))
        for measured, uncertainty in zip(fitted.data, fitted.uncertainties, strict=True)
        if measured.quantity == quantity
    ]
    if not uncertainties_and_values:
        return _RELATIVE_UNCERTAINTY * value
    absolute, values = (numpy.concatenate(columns) for columns in zip(*uncertainties_and_values, strict=True))
    relative = absolute / numpy.maximum(values, 1e-300)
    use_absolute = numpy.std(numpy.log(absolute)) <= numpy.std(numpy.log(relative))
    return float(numpy.median(absolute) if use_absolute else numpy.median(relative) * value)


def _candidate_model(fitted: FittedModel, candidates: Sequence[Candidate]) -> ForwardModel:
    return replace(fitted.misfit.forward, data=tuple(candidate.measured(1.0) for candidate in candidates))


def _compute_gain(fitted: FittedModel, candidate: Candidate, slopes: Numbers) -> Gain:
    old_covariance = fitted.information.covariance
    weighted_slopes = slopes * (fitted.misfit.scatter.information**0.5 / candidate.uncertainty)
    cross_covariance = old_covariance @ weighted_slopes
    variance_ratio = float(weighted_slopes @ cross_covariance)
    new_variances = numpy.diagonal(old_covariance) - cross_covariance**2 / (1 + variance_ratio)
    names, ratios = fitted.transform.names, numpy.sqrt(new_variances / numpy.diagonal(old_covariance))
    is_narrow = dict(zip(names, new_variances**0.5 < MAX_WIDTH_RATIO, strict=True))
    return Gain(
        candidate=candidate,
        bits=log(1 + variance_ratio) / log(4),
        uncertainty_ratio=dict(zip(names, ratios.tolist(), strict=True)),
        identifies=tuple(name for name in fitted.information.unidentifiable if is_narrow[name]),
    )
