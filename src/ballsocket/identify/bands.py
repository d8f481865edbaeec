"""Bands of 95 %: uncertainties widened by the scatter of the data, and profile likelihood intervals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy

from ..core.arrays import Numbers
from ..core.deprecation import renamed_names
from .information import QUANTILE_95, QUANTILE_99, Information, Interval, ProfileEnd
from .misfit import FitResult, Misfit
from .search import minimise
from .unknowns import Unknown

_SIGNIFICANCE = 0.05  # probability of the scatter below which Student's quantile applies
_MIN_DECREASE = 1e-3  # decrease of χ²/2 on a profile that restarts the search
_MAX_RESTARTS = 3
_MAX_ITERATIONS = 40
_FIRST_STEP = 0.5  # largest step of an unknown, in deviations of its prior
_MIN_STEP = 1e-3
_MIN_CURVED_STEP = 0.02  # lower limit of the step on a curved profile
_RELATIVE_TOLERANCE = 0.02  # relative tolerance of the rise in χ² at an end
_DAMPING = 1e-6  # damping that is added to the curvature, in units of the prior's information
_MIN_LIMIT_GAIN = 0.1  # smallest gain, over the rise in χ², for which the end of a range limits an interval
_LIMIT_TOLERANCE = 1e-9  # distance from the end of a range, in deviations of the prior


def compute_bands(misfit: Misfit, best: FitResult) -> tuple[Misfit, FitResult, Information]:
    """Compute the 95 % bands of all unknowns, with uncertainties widened by the observed scatter.

    The factor is Birge's ratio, the root of χ² over the degrees of freedom, if above 1. Student's quantile
    replaces the normal quantile if the probability of the scatter is below 5 %.

    Parameters
    ----------
    misfit : Misfit
        Misfit with the stated uncertainties.
    best : FitResult

    Returns
    -------
    misfit : Misfit
        Misfit with the widened uncertainties.
    best : FitResult
        Best point for them.
    information : Information

    References
    ----------
    Birge 1932, Phys. Rev. 40, 207; Particle Data Group 2024, Phys. Rev. D 110, 030001, section 5.2.2.
    """
    factor = scatter_ratio(misfit, best)
    if factor > 1:
        misfit = replace(misfit, widening=factor)
        best = replace(minimise(misfit, best.theta), rivals=best.rivals)
    quantile = _band_quantile(factor, misfit.freedom)
    rises = (quantile**2, (quantile * QUANTILE_99 / QUANTILE_95) ** 2)
    for _ in range(_MAX_RESTARTS):
        rivals = [rival for rival in best.rivals if misfit.costs(rival[None])[0] < best.cost + rises[0] / 2]
        profiles = profile_ends(misfit, [best.theta, *rivals], best.cost, rises)
        if profiles.cost > best.cost - _MIN_DECREASE:
            break
        best = replace(minimise(misfit, profiles.lowest), rivals=best.rivals)
    rows = enumerate(zip(misfit.transform.unknowns, *profiles.ends, strict=True))
    intervals = tuple(_combine_ends(index, *row) for index, row in rows)
    matrix = misfit.fisher_information(best.theta)
    return misfit, best, Information(misfit.transform, best.theta, matrix, intervals, quantile)


def _combine_ends(
    index: int, unknown: Unknown, band: tuple[ProfileEnd, ProfileEnd], wide: tuple[ProfileEnd, ProfileEnd]
) -> Interval:
    """Make the interval of an unknown from the ends of its 95 % band and its 99 % interval.

    The 99 % interval may be open.
    """
    ends = zip(wide, (-1, 1), strict=True)
    closed = all(end.closed or unknown.is_physical(side, float(end.theta[index])) for end, side in ends)
    return Interval(*band, closed)


def scatter_ratio(misfit: Misfit, best: FitResult) -> float:
    """Compute the ratio of observed scatter to stated uncertainties, at least 1.

    This is the most likely factor for the distribution of the scatter, with the degrees of freedom as the number of
    values. For a normal scatter it is the root of χ² over the degrees of freedom.
    """
    from scipy.optimize import brentq

    z = misfit.standardised_residuals(misfit.forward.results_at(misfit.transform.to_values(best.theta[None]))[0])
    z = numpy.where(misfit.saturated, numpy.minimum(z, 0.0), z)

    def excess(factor: float) -> float:
        """Compute the excess of the sum of squares over the degrees of freedom; 0 at the most likely factor."""
        u = z / factor
        return float(numpy.sum(u * misfit.scatter.misfit(u) * misfit.scatter.slope(u))) - misfit.freedom

    if misfit.freedom <= 0 or excess(1.0) <= 0:
        return 1.0
    upper = 2.0
    while excess(upper) > 0:
        upper *= 2
    return float(brentq(excess, 1.0, upper, rtol=1e-6))


def _band_quantile(factor: float, freedom: int) -> float:
    """Return the half width of a 95 % band in standard deviations.

    It is Student's quantile for an improbably large scatter, else the normal quantile.
    """
    from scipy.stats import chi2, t

    improbable = freedom > 0 and chi2.sf(factor**2 * freedom, freedom) < _SIGNIFICANCE
    return float(t.ppf(0.975, freedom)) if factor > 1 and improbable else QUANTILE_95


@dataclass(frozen=True, eq=False)
class Profiles:
    """Ends of all profile likelihood intervals, and the best point found on the way.

    Attributes
    ----------
    ends : list of list of pairs of ProfileEnd
        Lower and upper end, by the limit on the rise of χ² and by unknown.
    lowest : array (unknowns,)
        Point of the smallest misfit on all paths.
    cost : float
        Misfit at that point, half of χ².
    """

    ends: list[list[tuple[ProfileEnd, ProfileEnd]]]
    lowest: Numbers
    cost: float


@dataclass(eq=False)
class _Path:
    """State of the search for one end of a profile interval."""

    index: int
    side: int
    rise: float
    theta: Numbers
    previous: Numbers
    step: float = _FIRST_STEP
    end: ProfileEnd | None = None


@dataclass(frozen=True, eq=False)
class _Point:
    """Quadratic approximation of χ² about a point of a path."""

    rise: float
    gradient: Numbers
    hessian: Numbers


def profile_ends(misfit: Misfit, starts: Sequence[Numbers], cost: float, rises: Sequence[float]) -> Profiles:
    """Find both ends of the profile likelihood interval of each unknown.

    All ends are computed together: an iteration needs one array call of the model.

    Parameters
    ----------
    misfit : Misfit
    starts : sequence of array (unknowns,)
        Best point, and other points with nearly the same misfit.
    cost : float
        Misfit of the best point, half of χ².
    rises : sequence of float
        Limits on the rise of χ² above that of the best point.

    References
    ----------
    Venzon & Moolgavkar 1988, Appl. Stat. 37, 87; Raue et al. 2009, Bioinformatics 25, 1923.
    """
    indices = range(len(starts[0]))
    paths = [
        _Path(index, side, rise, start, start)
        for rise in rises
        for index in indices
        for side in (-1, 1)
        for start in starts
    ]
    low, high = misfit.transform.low, misfit.transform.high
    lowest, least = starts[0], cost
    for _ in range(_MAX_ITERATIONS):
        active = [path for path in paths if path.end is None]
        if not active:
            break
        residuals, slopes = misfit.residuals_and_slopes(numpy.stack([path.theta for path in active]))
        costs = numpy.nan_to_num(numpy.sum(residuals**2, axis=1) / 2, nan=numpy.inf)
        if costs.min() < least:
            lowest, least = active[int(costs.argmin())].theta, float(costs.min())
        for path, residual, slope in zip(active, residuals, slopes, strict=True):
            _advance_path(path, residual, slope, cost, low, high)
    ends = iter([path.end or ProfileEnd(path.previous, False, (path.index,)) for path in paths])
    rows = [
        [
            (_next_outermost_end(ends, len(starts), index, -1), _next_outermost_end(ends, len(starts), index, 1))
            for index in indices
        ]
        for _ in rises
    ]
    return Profiles(rows, lowest, least)


def _next_outermost_end(ends: Iterator[ProfileEnd], count: int, index: int, side: int) -> ProfileEnd:
    """Return the outermost of the next `count` ends, one for each start."""
    return max([next(ends) for _ in range(count)], key=lambda end: side * float(end.theta[index]))


def _limiting_unknowns(path: _Path, point: _Point, move: Numbers, low: Numbers, high: Numbers) -> tuple[int, ...]:
    """Find the other unknowns whose range limits an interval, at its end.

    The gradient of χ² points outward there.
    """
    theta = numpy.clip(path.theta + move, low, high)
    new_gradient = point.gradient + point.hessian @ move
    outward = _is_limited_by_range(theta, new_gradient, low, high)
    inner = set(numpy.flatnonzero(~outward).tolist()) - {path.index}
    at_limit = [index for index in numpy.flatnonzero(outward).tolist() if index != path.index]
    gains = {index: _misfit_decrease(point.hessian, new_gradient, [*inner, index]) for index in at_limit}
    return tuple(index for index, gain in gains.items() if gain > _MIN_LIMIT_GAIN * path.rise)


def _is_limited_by_range(theta: Numbers, gradient: Numbers, low: Numbers, high: Numbers) -> Numbers:
    """Return a mask of the unknowns at an end of their range beyond which χ² would decrease."""
    return ((theta - low < _LIMIT_TOLERANCE) & (gradient > 0)) | ((high - theta < _LIMIT_TOLERANCE) & (gradient < 0))


def _misfit_decrease(hessian: Numbers, gradient: Numbers, free: list[int]) -> float:
    """Compute the decrease of χ² to its minimum over the free unknowns, in the quadratic approximation."""
    return float(gradient[free] @ numpy.linalg.solve(hessian[numpy.ix_(free, free)], gradient[free]))


def _advance_path(path: _Path, residual: Numbers, slope: Numbers, best: float, low: Numbers, high: Numbers) -> None:
    """Compute the next Newton step of a path, or cut the last step to a quarter if the model failed."""
    if not (numpy.isfinite(residual).all() and numpy.isfinite(slope).all()):
        path.step /= 4
        path.theta = path.previous + (path.theta - path.previous) / 4
        if path.step < _MIN_STEP:
            path.end = ProfileEnd(path.previous, False, (path.index,))
        return
    theta = path.theta
    hessian = slope.T @ slope + _DAMPING * numpy.eye(len(theta))
    point = _Point(float(residual @ residual) - 2 * best, slope.T @ residual, hessian)
    move, excess, gain = _newton_step(path, point, low, high)
    limit = high[path.index] - theta[path.index] if path.side > 0 else theta[path.index] - low[path.index]
    path.previous = theta
    others_fitted = gain < _RELATIVE_TOLERANCE * path.rise
    if others_fitted and abs(excess - path.rise) < _RELATIVE_TOLERANCE * path.rise:
        end = numpy.clip(theta + move, low, high)
        path.end = ProfileEnd(end, True, _limiting_unknowns(path, point, move, low, high))
    elif others_fitted and limit < _LIMIT_TOLERANCE and excess < path.rise:
        limits = _limiting_unknowns(path, point, numpy.zeros(len(theta)), low, high)
        path.end = ProfileEnd(theta, False, (path.index, *limits))
    else:
        path.step = max(path.step / 2, _MIN_CURVED_STEP) if gain > path.rise else path.step
        path.theta = numpy.clip(theta + move, low, high)


def _newton_step(path: _Path, point: _Point, low: Numbers, high: Numbers) -> tuple[Numbers, float, float]:
    """Compute the Newton step towards the end of a profile interval.

    Returns the step, the rise of χ² on the profile, and the gain.

    The other unknowns minimise χ² within their ranges.
    """
    index, theta = path.index, path.theta
    fixed = _is_limited_by_range(theta, point.gradient, low, high)
    fixed[index] = True
    shift = numpy.zeros(len(theta))
    while True:
        new_gradient = point.gradient + point.hessian @ shift
        level = point.rise + float(shift @ (point.gradient + new_gradient))
        free = numpy.flatnonzero(~fixed)
        sides = numpy.stack([new_gradient[free], point.hessian[free, index]], axis=1)
        solution = numpy.linalg.solve(point.hessian[numpy.ix_(free, free)], sides) if len(free) else sides
        gain = float(new_gradient[free] @ solution[:, 0])
        slope, curvature = (
            numpy.array([new_gradient[index], point.hessian[index, index]]) - point.hessian[index, free] @ solution
        )
        along = 0.0
        if gain < path.rise:  # χ² rises by 2 slope δ + curvature δ² along the profile
            root = max(slope * slope + curvature * (path.rise - level + gain), 0.0) ** 0.5
            along = float(numpy.clip((path.side * root - slope) / curvature, -path.step, path.step))
        along = float(numpy.clip(theta[index] + along, low[index], high[index]) - theta[index])
        move = shift.copy()
        move[index] = along
        move[free] = -solution[:, 0] - solution[:, 1] * along
        beyond = numpy.where(fixed, 0.0, numpy.maximum(low - theta - move, theta + move - high))
        worst = int(numpy.argmax(beyond))
        if beyond[worst] <= 0:
            return move, level - gain, gain
        fixed[worst] = True
        shift[worst] = numpy.clip(theta[worst] + move[worst], low[worst], high[worst]) - theta[worst]


__getattr__ = renamed_names(__name__, {"banded": "compute_bands"})
