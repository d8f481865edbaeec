"""Coverage of the bands: identification of a known joint from many synthetic sets of data."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.deprecation import renamed_arguments, renamed_names
from .bands import compute_bands
from .fit import FittedModel
from .measured import Measured
from .search import find_best_fit


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
    def half_widths(self) -> Numbers:
        """Half widths of the 95 % bands, in standard deviations of the priors."""
        return (self.high - self.low) / 2

    @property
    def coverage(self) -> dict[str, float]:
        """Fraction of the bands that contain the true value, by unknown; 0.95 is expected."""
        covered = (self.low <= self.truth) & (self.truth <= self.high)
        return dict(zip(self.names, covered.mean(axis=0).tolist(), strict=True))

    @property
    def bias(self) -> dict[str, float]:
        """Mean error of the estimates over the mean band width, by unknown; 0 is expected."""
        bias = (self.middle - self.truth).mean(axis=0) / (2 * self.half_widths.mean(axis=0))
        return dict(zip(self.names, bias.tolist(), strict=True))

    def summary(self) -> dict[str, Any]:
        """Return a dictionary of the trials for JSON."""
        return {"trials": len(self.middle), "coverage": self.coverage, "bias": self.bias}


@renamed_arguments(found="fitted")
def trials(fitted: FittedModel, count: int = 200, seed: int = 0) -> Trials:
    """Identify many synthetic data sets about the best fit, to test coverage and bias of the bands.

    Parameters
    ----------
    fitted : IdentificationResult
        Its best point is the truth.
    count : int
        Sets of data, 1 or more.
    seed : int

    Returns
    -------
    Trials

    Raises
    ------
    ValueError
        A count below 1.
    """
    require("count", count, count > 0, "1 trial or more")
    random = numpy.random.default_rng(seed)
    widened = fitted.misfit.widening * fitted.misfit.uncertainty
    stated = replace(fitted.misfit, uncertainty=widened, widening=1.0)
    middle, low, high = [], [], []
    for number in range(count):
        misfit = replace(stated, forward=replace(stated.forward, data=draw_data_sets(fitted, random)))
        _, best, information = compute_bands(misfit, find_best_fit(misfit, seed + number))
        middle.append(best.theta)
        low.append([interval.low.theta[index] for index, interval in enumerate(information.intervals)])
        high.append([interval.high.theta[index] for index, interval in enumerate(information.intervals)])
    return Trials(fitted.transform.names, fitted.best.theta, *map(numpy.array, (middle, low, high)))


@renamed_arguments(found="fitted")
def draw_data_sets(fitted: FittedModel, random: numpy.random.Generator) -> tuple[Measured, ...]:
    """Draw synthetic measurements about the results of the best fit.

    The values include the errors of the loads.
    """
    widened = fitted.misfit.widening * fitted.misfit.uncertainty
    uncertainties = numpy.split(widened, numpy.cumsum([len(measured) for measured in fitted.data])[:-1])
    scatter = fitted.misfit.scatter
    return tuple(
        replace(measured, values=_add_noise(measured, results, uncertainty * scatter.draw(len(measured), random)))
        for measured, results, uncertainty in zip(fitted.data, fitted.results, uncertainties, strict=True)
    )


def _add_noise(measured: Measured, results: Numbers, noise: Numbers) -> Numbers:
    """Add noise to results; limit the readings by the saturation, and by 0 for an ideal machine."""
    readings = results + noise
    return numpy.minimum(readings if measured.machine.name else numpy.maximum(readings, 0.0), measured.saturation)


__getattr__ = renamed_names(__name__, {"drawn": "draw_data_sets"})
