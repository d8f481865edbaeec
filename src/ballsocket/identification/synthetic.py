"""Coverage of the bands: identification of a known joint from many synthetic sets of data."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .bands import compute_bands
from .fit import FittedModel, find_best_fit
from .measured import Measured


@dataclass(frozen=True, eq=False)
class Trials:
    """Estimates and bands from repeated identifications of synthetic data.

    Attributes
    ----------
    names : tuple of str
    truth : array (unknowns,)
        True values in standard deviations of the priors, as all that follows.
    middle, low, high : array (trials, unknowns)
        Estimates, and the ends of their bands of 95 %.
    """

    names: tuple[str, ...]
    truth: Numbers
    middle: Numbers
    low: Numbers
    high: Numbers

    @property
    def coverage(self) -> dict[str, float]:
        """Fraction of 95 % bands that contain the true value, for each unknown by name."""
        covered = (self.low <= self.truth) & (self.truth <= self.high)
        return dict(zip(self.names, covered.mean(axis=0).tolist(), strict=True))

    @property
    def bias(self) -> dict[str, float]:
        """Mean error of the estimates divided by the mean band width, for each unknown by name."""
        half_widths = (self.high - self.low) / 2
        bias = (self.middle - self.truth).mean(axis=0) / (2 * half_widths.mean(axis=0))
        return dict(zip(self.names, bias.tolist(), strict=True))

    def summary(self) -> dict[str, Any]:
        """Return coverage and bias of the trials as a dictionary for JSON."""
        return {"trials": len(self.middle), "coverage": self.coverage, "bias": self.bias}


def trials(fitted: FittedModel, count: int = 200, seed: int = 0) -> Trials:
    """Identify the unknowns from many synthetic data sets, to test coverage and bias of the bands.

    Parameters
    ----------
    fitted : IdentificationResult
        Its best point is the truth.
    count : int
        Sets of data, 1 or more.
    seed : int

    Raises
    ------
    ValueError
        A count below 1.
    """
    require("count", count, count > 0, "1 trial or more")
    random = numpy.random.default_rng(seed)
    widened_uncertainty = fitted.misfit.widening * fitted.misfit.uncertainty
    trial_misfit = replace(fitted.misfit, uncertainty=widened_uncertainty, widening=1.0)
    best_points, low_ends, high_ends = [], [], []
    for trial in range(count):
        misfit = replace(trial_misfit, forward=replace(trial_misfit.forward, data=draw_data_sets(fitted, random)))
        _, best, information = compute_bands(misfit, find_best_fit(misfit, seed + trial))
        best_points.append(best.theta)
        low_ends.append([interval.low.theta[index] for index, interval in enumerate(information.intervals)])
        high_ends.append([interval.high.theta[index] for index, interval in enumerate(information.intervals)])
    return Trials(fitted.transform.names, fitted.best.theta, *map(numpy.array, (best_points, low_ends, high_ends)))


def draw_data_sets(fitted: FittedModel, random: numpy.random.Generator) -> tuple[Measured, ...]:
    """Draw synthetic data sets with random scatter about the results of the best fit.

    The values include the errors of the loads.
    """
    sets = []
    for measured, results, uncertainty in zip(fitted.data, fitted.results, fitted.uncertainties, strict=True):
        deviations = fitted.misfit.scatter.draw(len(measured), random)
        readings = results + fitted.misfit.widening * uncertainty * deviations
        least = -inf if measured.machine.name else 0.0
        sets.append(replace(measured, values=numpy.clip(readings, least, measured.saturation)))
    return tuple(sets)
