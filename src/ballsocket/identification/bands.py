"""Bands of 95 %: uncertainties widened by the scatter, profile likelihood intervals, and their coverage of a truth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .fit import FittedModel, find_best_fit, minimise_misfit
from .information import QUANTILE_95, QUANTILE_99, Information, ProfileEnd, ProfileInterval
from .measured import Measured
from .misfit import FitResult, Misfit

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
    """Compute the 95 % bands of all unknowns; excessive scatter of the data widens the uncertainties.

    The factor is Birge's ratio, the root of χ² over the degrees of freedom, if above 1. Student's quantile
    replaces the normal quantile if the probability of the scatter is below 5 %.

    Returns the misfit with the widened uncertainties, the best point for them, and the information there.

    References
    ----------
    Birge 1932, Phys. Rev. 40, 207; Particle Data Group 2024, Phys. Rev. D 110, 030001, section 5.2.2.
    """
    from scipy.stats import chi2, t

    widening_factor = scatter_ratio(misfit, best)
    if widening_factor > 1:
        misfit = replace(misfit, widening=widening_factor)
        best = replace(minimise_misfit(misfit, best.theta), rivals=best.rivals)
    freedom, quantile = misfit.freedom, QUANTILE_95
    if isfinite(misfit.noise_freedom):  # of estimated uncertainties
        quantile = float(t.ppf(0.975, misfit.noise_freedom))
    elif widening_factor > 1 and chi2.sf(widening_factor**2 * freedom, freedom) < _SIGNIFICANCE:
        quantile = float(t.ppf(0.975, freedom))
    chi_squared_limits = (quantile**2, (quantile * QUANTILE_99 / QUANTILE_95) ** 2)
    for _ in range(_MAX_RESTARTS):
        rivals = [
            rival for rival in best.rivals if misfit.costs(rival[None])[0] < best.cost + chi_squared_limits[0] / 2
        ]
        profiles = profile_ends(misfit, [best.theta, *rivals], best.cost, chi_squared_limits)
        if profiles.cost > best.cost - _MIN_DECREASE:
            break
        best = replace(minimise_misfit(misfit, profiles.lowest), rivals=best.rivals)
    intervals = []
    for index, unknown in enumerate(misfit.transform.unknowns):
        ends_95, ends_99 = (pairs[index] for pairs in profiles.ends)
        ends_and_sides = zip(ends_99, (-1, 1), strict=True)
        closed = all(end.closed or unknown.is_physical(side, float(end.theta[index])) for end, side in ends_and_sides)
        intervals.append(ProfileInterval(*ends_95, closed))
    slopes, weighted = misfit.weighted_slopes(best.theta)
    return misfit, best, Information(misfit.transform, best.theta, weighted @ slopes, tuple(intervals), quantile)


def scatter_ratio(misfit: Misfit, best: FitResult) -> float:
    """Compute the ratio of the scatter of the data to their stated uncertainties, at least 1.

    This is the most likely factor for the distribution of the scatter, with the degrees of freedom as the number of
    values. For a normal scatter it is the root of χ² over the degrees of freedom.
    """
    from scipy.optimize import brentq

    residuals = misfit.standardised_residuals(misfit.results_at(best.theta[None])[0])
    residuals = numpy.where(misfit.saturated, numpy.minimum(residuals, 0.0), residuals)

    def excess_of_squares(factor: float) -> float:
        """Compute the sum of squared residuals minus the degrees of freedom, for a factor on uncertainties."""
        z = residuals / factor
        return float(numpy.sum(z * misfit.scatter.misfit(z) * misfit.scatter.slope(z))) - misfit.freedom

    if misfit.freedom <= 0 or excess_of_squares(1.0) <= 0:
        return 1.0
    upper = 2.0
    while excess_of_squares(upper) > 0:
        upper *= 2
    return float(brentq(excess_of_squares, 1.0, upper, rtol=1e-6))


@dataclass(frozen=True, eq=False)
class Profiles:
    """Ends of all profile likelihood intervals, and the best point of the search for them."""

    # lower and upper end, by the limit on the rise of χ² and by unknown
    ends: list[list[tuple[ProfileEnd, ProfileEnd]]]
    lowest: Numbers  # (unknowns,), point of the smallest misfit on all paths
    cost: float  # misfit at that point, half of χ²


@dataclass(eq=False)
class _EndSearch:
    """State of the search for one end of a profile likelihood interval."""

    index: int
    side: int
    rise: float
    theta: Numbers
    previous: Numbers
    step: float = _FIRST_STEP
    end: ProfileEnd | None = None


@dataclass(frozen=True, eq=False)
class _QuadraticModel:
    """Quadratic approximation of χ² about the present point of a search path."""

    rise: float
    gradient: Numbers
    hessian: Numbers


def profile_ends(misfit: Misfit, starts: Sequence[Numbers], cost: float, rises: Sequence[float]) -> Profiles:
    """Find both ends of the profile likelihood interval of each unknown, for each limit on the rise of χ².

    All ends are computed together: an iteration needs one array call of the model.

    The `starts` (unknowns,) are the best point and others with nearly the same misfit; `cost` is the misfit of the best
    point, half of χ², and `rises` are limits on the rise of χ² above it.

    References
    ----------
    Venzon & Moolgavkar 1988, Appl. Stat. 37, 87; Raue et al. 2009, Bioinformatics 25, 1923.
    """
    indices = range(len(starts[0]))
    paths = [
        _EndSearch(index, side, rise, start, start)
        for rise in rises
        for index in indices
        for side in (-1, 1)
        for start in starts
    ]
    low, high = misfit.transform.low, misfit.transform.high
    lowest, least_cost = starts[0], cost
    for _ in range(_MAX_ITERATIONS):
        active = [path for path in paths if path.end is None]
        if not active:
            break
        residuals, slopes = misfit.residuals_and_slopes(numpy.stack([path.theta for path in active]))
        costs = numpy.nan_to_num(numpy.sum(residuals**2, axis=1) / 2, nan=numpy.inf)
        if costs.min() < least_cost:
            lowest, least_cost = active[int(costs.argmin())].theta, float(costs.min())
        for path, residual, slope in zip(active, residuals, slopes, strict=True):
            _advance_end_search(path, residual, slope, cost, low, high)

    def outermost_end(rise: float, index: int, side: int) -> ProfileEnd:
        own = [path for path in paths if (path.rise, path.index, path.side) == (rise, index, side)]
        ends = [path.end or ProfileEnd(path.previous, False, (index,)) for path in own]
        return max(ends, key=lambda end: side * float(end.theta[index]))

    ends = [[(outermost_end(rise, index, -1), outermost_end(rise, index, 1)) for index in indices] for rise in rises]
    return Profiles(ends, lowest, least_cost)


def _limiting_unknowns(
    path: _EndSearch, point: _QuadraticModel, theta_step: Numbers, low: Numbers, high: Numbers
) -> tuple[int, ...]:
    """Find the other unknowns whose search range limits an interval at its end, where the gradient points outward."""
    theta = numpy.clip(path.theta + theta_step, low, high)
    new_gradient = point.gradient + point.hessian @ theta_step
    limited_mask = _mask_limited_by_range(theta, new_gradient, low, high)
    others = [index for index in range(len(theta)) if index != path.index]
    inner = [index for index in others if not limited_mask[index]]
    limiting = []
    for index in others:
        if not limited_mask[index]:
            continue
        free = [*inner, index]
        # decrease of χ² if the free unknowns minimise its quadratic approximation
        decrease = new_gradient[free] @ numpy.linalg.solve(point.hessian[numpy.ix_(free, free)], new_gradient[free])
        if decrease > _MIN_LIMIT_GAIN * path.rise:
            limiting.append(index)
    return tuple(limiting)


def _mask_limited_by_range(theta: Numbers, gradient: Numbers, low: Numbers, high: Numbers) -> Numbers:
    """Return a mask of the unknowns at an end of their range, beyond which χ² would decrease."""
    return ((theta - low < _LIMIT_TOLERANCE) & (gradient > 0)) | ((high - theta < _LIMIT_TOLERANCE) & (gradient < 0))


def _advance_end_search(
    path: _EndSearch, residual: Numbers, slope: Numbers, best_cost: float, low: Numbers, high: Numbers
) -> None:
    """Advance a search path by a Newton step; cut its last step to a quarter if the model failed there."""
    if not (numpy.isfinite(residual).all() and numpy.isfinite(slope).all()):
        path.step /= 4
        path.theta = path.previous + (path.theta - path.previous) / 4
        if path.step < _MIN_STEP:
            path.end = ProfileEnd(path.previous, False, (path.index,))
        return
    theta = path.theta
    hessian = slope.T @ slope + _DAMPING * numpy.eye(len(theta))
    point = _QuadraticModel(float(residual @ residual) - 2 * best_cost, slope.T @ residual, hessian)
    theta_step, profile_rise, decrease = _newton_step(path, point, low, high)
    distance_to_range_end = (
        high[path.index] - theta[path.index] if path.side > 0 else theta[path.index] - low[path.index]
    )
    path.previous = theta
    others_fitted = decrease < _RELATIVE_TOLERANCE * path.rise
    if others_fitted and abs(profile_rise - path.rise) < _RELATIVE_TOLERANCE * path.rise:
        end = numpy.clip(theta + theta_step, low, high)
        path.end = ProfileEnd(end, True, _limiting_unknowns(path, point, theta_step, low, high))
    elif others_fitted and distance_to_range_end < _LIMIT_TOLERANCE and profile_rise < path.rise:
        limits = _limiting_unknowns(path, point, numpy.zeros(len(theta)), low, high)
        path.end = ProfileEnd(theta, False, (path.index, *limits))
    else:
        path.step = max(path.step / 2, _MIN_CURVED_STEP) if decrease > path.rise else path.step
        path.theta = numpy.clip(theta + theta_step, low, high)


def _newton_step(path: _EndSearch, point: _QuadraticModel, low: Numbers, high: Numbers) -> tuple[Numbers, float, float]:
    """Compute the Newton step towards an interval end: change of theta, rise of χ² and decrease by the others."""
    index, theta = path.index, path.theta
    fixed_mask = _mask_limited_by_range(theta, point.gradient, low, high)
    fixed_mask[index] = True
    range_shift = numpy.zeros(len(theta))
    while True:
        new_gradient = point.gradient + point.hessian @ range_shift
        shifted_rise = point.rise + float(range_shift @ (point.gradient + new_gradient))
        free_indices = numpy.flatnonzero(~fixed_mask)
        right_sides = numpy.stack([new_gradient[free_indices], point.hessian[free_indices, index]], axis=1)
        solution = (
            numpy.linalg.solve(point.hessian[numpy.ix_(free_indices, free_indices)], right_sides)
            if len(free_indices)
            else right_sides
        )
        decrease = float(new_gradient[free_indices] @ solution[:, 0])
        slope, curvature = (
            numpy.array([new_gradient[index], point.hessian[index, index]])
            - point.hessian[index, free_indices] @ solution
        )
        index_step = 0.0
        if decrease < path.rise:  # χ² rises by 2 slope δ + curvature δ² along the profile
            square_root = max(slope * slope + curvature * (path.rise - shifted_rise + decrease), 0.0) ** 0.5
            index_step = float(numpy.clip((path.side * square_root - slope) / curvature, -path.step, path.step))
        index_step = float(numpy.clip(theta[index] + index_step, low[index], high[index]) - theta[index])
        theta_step = range_shift.copy()
        theta_step[index] = index_step
        theta_step[free_indices] = -solution[:, 0] - solution[:, 1] * index_step
        range_excess = numpy.where(fixed_mask, 0.0, numpy.maximum(low - theta - theta_step, theta + theta_step - high))
        worst_index = int(numpy.argmax(range_excess))
        if range_excess[worst_index] <= 0:
            return theta_step, shifted_rise - decrease, decrease
        fixed_mask[worst_index] = True
        range_shift[worst_index] = (
            numpy.clip(theta[worst_index] + theta_step[worst_index], low[worst_index], high[worst_index])
            - theta[worst_index]
        )


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
