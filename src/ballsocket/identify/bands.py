"""Bands of 95 %: uncertainties widened by the scatter of the data, and profile intervals."""

from __future__ import annotations

from dataclasses import replace

import numpy

from .information import SURE, WIDE, Information, Interval
from .misfit import Misfit
from .profile import ProfileEnd, profile_ends
from .search import Found, descended
from .unknowns import Unknown

_SIGNIFICANT = 0.05  # probability of the scatter below which Student's quantile applies
_LOWER = 1e-3  # decrease of χ²/2 on a profile that restarts the search
_RESTARTS = 3


def banded(misfit: Misfit, best: Found) -> tuple[Misfit, Found, Information]:
    """Widen the uncertainties by the observed scatter, and compute the information with its profile intervals.

    The factor is Birge's ratio, the root of χ² over the degrees of freedom, if above 1. Student's quantile
    replaces the normal quantile if the probability of the scatter is below 5 %.

    References
    ----------
    Birge 1932, Phys. Rev. 40, 207; Particle Data Group 2024, Phys. Rev. D 110, 030001, section 5.2.2.
    """
    factor = scatter_ratio(misfit, best)
    if factor > 1:
        misfit = replace(misfit, widening=factor)
        best = replace(descended(misfit, best.places), rivals=best.rivals)
    quantile = _quantile(factor, misfit.freedom)
    rises = (quantile**2, (quantile * SURE / WIDE) ** 2)
    for _ in range(_RESTARTS):
        rivals = [rival for rival in best.rivals if misfit.costs(rival[None])[0] < best.cost + rises[0] / 2]
        profiles = profile_ends(misfit, [best.places, *rivals], best.cost, rises)
        if profiles.cost > best.cost - _LOWER:
            break
        best = replace(descended(misfit, profiles.lowest), rivals=best.rivals)
    rows = enumerate(zip(misfit.scales.unknowns, *profiles.ends, strict=True))
    intervals = tuple(_interval(index, *row) for index, row in rows)
    matrix = misfit.information(best.places)
    return misfit, best, Information(misfit.scales, best.places, matrix, intervals, quantile)


def _interval(
    index: int, unknown: Unknown, band: tuple[ProfileEnd, ProfileEnd], wide: tuple[ProfileEnd, ProfileEnd]
) -> Interval:
    ends = zip(wide, (-1, 1), strict=True)
    closed = all(end.closed or unknown.is_physical(side, float(end.theta[index])) for end, side in ends)
    return Interval(*band, closed)


def scatter_ratio(misfit: Misfit, best: Found) -> float:
    """Compute the factor, 1 or more, by which the scatter of the data exceeds the stated uncertainties.

    This is the most likely factor for the distribution of the scatter, with the degrees of freedom as the number of
    values. For a normal scatter it is the root of χ² over the degrees of freedom.
    """
    from scipy.optimize import brentq

    z = misfit.standard(misfit.answers.at(misfit.scales.values(best.places[None]))[0])
    z = numpy.where(misfit.cut_off, numpy.minimum(z, 0.0), z)

    def excess(factor: float) -> float:
        u = z / factor
        return float(numpy.sum(u * misfit.scatter.misfit(u) * misfit.scatter.slope(u))) - misfit.freedom

    if misfit.freedom <= 0 or excess(1.0) <= 0:
        return 1.0
    upper = 2.0
    while excess(upper) > 0:
        upper *= 2
    return float(brentq(excess, 1.0, upper, rtol=1e-6))


def _quantile(factor: float, freedom: int) -> float:
    from scipy.stats import chi2, t

    improbable = freedom > 0 and chi2.sf(factor**2 * freedom, freedom) < _SIGNIFICANT
    return float(t.ppf(0.975, freedom)) if factor > 1 and improbable else WIDE
