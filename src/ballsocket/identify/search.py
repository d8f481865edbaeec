"""Search for the best point: a global search over the priors, then least squares."""

from __future__ import annotations

import numpy

from ..core.arrays import Numbers
from .misfit import FitResult, Misfit

_SEARCH_SECONDS = 3.0  # time limit of the global search
_MIN_POINTS, _MAX_POINTS = 16, 128  # points of the global search
_SAME_POINT = 1e-2  # distance in theta below which two searches have one end
_RIVAL_COST = 2.0  # excess of the cost below which another end counts as a rival
_MAX_EVALUATIONS = 60
_EQUAL_COST = 1e-6  # difference of cost that counts as equal


def find_best_fit(misfit: Misfit, seed: int) -> FitResult:
    """Find the best fit of the unknowns: a global search, then least squares from its best points.

    Raises
    ------
    ValueError
        The model has no result for all data at any point within the ranges.
    """
    ends = [minimise_misfit(misfit, start) for start in _choose_starting_points(misfit, seed)]
    best = _choose_best_fit(misfit, ends)
    distant = [end for end in ends if numpy.max(abs(end.theta - best.theta)) > _SAME_POINT]
    rivals = tuple(end.theta for end in distant if end.cost < best.cost + _RIVAL_COST)
    return FitResult(best.theta, best.cost, best.converged, rivals)


def _choose_best_fit(misfit: Misfit, ends: list[FitResult]) -> FitResult:
    """Choose the fit with the smallest misfit; among equal ones, that nearest to the middle of the ranges.

    Among fits of equal cost it is the one nearest to the middle of the ranges.
    """
    least_cost, range_middle = min(end.cost for end in ends), (misfit.transform.low + misfit.transform.high) / 2
    lowest_ends = [end for end in ends if end.cost <= least_cost + _EQUAL_COST]
    return min(lowest_ends, key=lambda end: float(numpy.max(abs(end.theta - range_middle))))


def _choose_starting_points(misfit: Misfit, seed: int) -> list[Numbers]:
    """Choose one or two starting points of the fit from a Sobol sequence over the search ranges.

    They are the point of lowest cost, and the best point far from it.
    """
    from scipy.stats import qmc

    low, high = misfit.transform.low, misfit.transform.high
    model = misfit.forward.model
    seconds_per_point = model.seconds_a_press * len(misfit.value)
    point_count = 1 << (int(numpy.clip(_SEARCH_SECONDS / seconds_per_point, _MIN_POINTS, _MAX_POINTS)).bit_length() - 1)
    fractions = qmc.Sobol(len(low), rng=numpy.random.default_rng(seed)).random(point_count)
    points = low + fractions * (high - low)
    costs = misfit.costs(points)
    if not numpy.isfinite(costs).any():
        raise ValueError(
            f"{model.name} has no result for all the data anywhere within the ranges: check the measured values, the "
            "ranges and the model"
        )
    best_index = int(numpy.argmin(costs))
    distant_mask = numpy.max(abs(points - points[best_index]), axis=1) > 0.25 * numpy.max(high - low)
    distant_index = int(numpy.argmin(numpy.where(distant_mask, costs, numpy.inf)))
    return (
        [points[best_index], points[distant_index]]
        if numpy.isfinite(costs[distant_index]) and distant_mask[distant_index]
        else [points[best_index]]
    )


def minimise_misfit(misfit: Misfit, start: Numbers) -> FitResult:
    """Minimise the misfit from a starting point theta by least squares."""
    from scipy.optimize import least_squares

    cache: dict[bytes, tuple[Numbers, Numbers]] = {}

    def residuals_and_slopes(theta: Numbers) -> tuple[Numbers, Numbers]:
        """Compute residuals and derivatives, and cache those of the last point."""
        key = theta.tobytes()
        if key not in cache:
            cache.clear()
            cache[key] = misfit.residuals_and_slopes(theta)
        return cache[key]

    solution = least_squares(
        lambda theta: residuals_and_slopes(theta)[0],
        start,
        jac=lambda theta: residuals_and_slopes(theta)[1],
        bounds=(misfit.transform.low, misfit.transform.high),
        x_scale=1.0,
        ftol=1e-10,
        xtol=1e-8,
        gtol=1e-8,
        max_nfev=_MAX_EVALUATIONS,
    )
    return FitResult(solution.x, float(solution.cost), bool(solution.success))
