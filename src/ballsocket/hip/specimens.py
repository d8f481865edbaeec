"""Mean of a quantity over several specimens, by a random-effects model."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.arrays import Numbers


@dataclass(frozen=True, kw_only=True)
class SpecimenMean:
    """Mean over specimens that differ from each other."""

    mean: float
    # standard uncertainty of the mean, for Student's quantile with one degree of freedom less than specimens
    standard_error: float
    scatter: float  # standard deviation between specimens, without the errors of their readings


def mean_of_specimens(values: Numbers, variances: Numbers, min_ratio: float) -> SpecimenMean:
    """Compute the mean over specimens whose values have different variances by their readings; two or more.

    The variance between specimens is by Paule & Mandel 1982 (doi:10.6028/jres.087.022), the standard error by Hartung &
    Knapp 2001 (doi:10.1002/sim.791). For equal variances they are mean and standard error of the values themselves.
    `min_ratio` is the least ratio of the observed scatter to the scatter that the variances explain: 1 for stated
    errors, below which chance is no reason for a narrower band; 0 for errors that are estimated from the same readings.
    """
    from scipy.optimize import brentq

    freedom = len(values) - 1

    def ratio(between: float) -> float:
        """Compute the ratio of observed to explained scatter for a variance between specimens."""
        weights = 1 / (variances + between)
        return float(weights @ (values - weights @ values / weights.sum()) ** 2) / freedom

    squares = float(((values - values.mean()) ** 2).sum())
    negligible = 1e-12 * squares + 1e-30 * float((values**2).max()) + 1e-300  # at least the rounding of the mean
    between, observed = negligible, ratio(negligible)
    if observed > 1:
        between, observed = float(brentq(lambda v: ratio(v) - 1, negligible, 2 * squares, xtol=negligible)), 1.0
    weights = 1 / (variances + between)
    return SpecimenMean(
        mean=float(weights @ values / weights.sum()),
        standard_error=float((max(observed, min_ratio) / weights.sum()) ** 0.5),
        scatter=0.0 if between == negligible else between**0.5,
    )
