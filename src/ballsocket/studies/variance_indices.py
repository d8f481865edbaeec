"""Shares of the variance of a function of scattered parameters: Sobol indices and Shapley effects, with intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations
from math import comb

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.executors.processes import check_memory
from .distributions import Distribution, draw_points, normal_quantiles

SampledFunction = Callable[[Numbers], Numbers]
"""Function from samples, shape (n_parameters, n_points), to quantities, shape (n_quantities, n_points)."""

MAX_CORRELATED = 10
"""Largest number of parameters with Shapley effects, which need a set of samples for each subset of parameters."""

_RESAMPLES = 999  # number of bootstrap resamples
_CHUNK_SIZE = 1 << 21  # number of values in a chunk of resamples


def check_sample_memory(count: int, n_terms: int) -> None:
    """Check that the averaged terms of `count` samples fit into the memory; raise ValueError otherwise."""
    check_memory(f"indices of {count} samples", 24 * count * n_terms)  # values, terms, and a copy of one of them


def sobol_indices(
    evaluate: SampledFunction,
    distributions: Sequence[Distribution],
    count: int,
    seed: int,
    confidence: float | None,
    second_order: bool = False,
) -> dict[str, Numbers]:
    """Compute Sobol indices of independent parameters, and the ends of their bootstrap intervals.

    Parameters
    ----------
    evaluate : callable
        The first two of its calls are for sets of independent samples.
    distributions : sequence of Distribution
    count : int
        Number of samples in each of n_parameters + 2 sets, or 2 n_parameters + 2 with second order.
    seed : int
    confidence : float or None
        Confidence level of the intervals; None for no intervals.
    second_order : bool
        True for the indices of pairs, too.

    Returns
    -------
    dict of str to array of shape (n_quantities, n_parameters)
        `first_order`, `total_order`, and both with `_low` and `_high`. NaN if there are too few samples.
        `second_order` has the shape (n_quantities, n_parameters, n_parameters), with NaN on its diagonal.

    References
    ----------
    Saltelli et al. 2010, Comput. Phys. Commun. 181, 259, for first and total order; Saltelli 2002, Comput. Phys.
    Commun. 145, 280, for second order.
    """
    dimension = len(distributions)
    sets = [
        numpy.stack([distribution.frozen.ppf(row) for distribution, row in zip(distributions, half, strict=True)])
        for half in _two_sets(dimension, count, seed)
    ]
    f_a, f_b = (evaluate(samples) for samples in sets)
    f_ab = _evaluate_mixed(evaluate, *sets)
    mean = numpy.mean([f_a, f_b], axis=(0, -1))[:, None]
    f_a, f_b, f_ab = f_a - mean, f_b - mean, f_ab - mean
    terms = [(f_a + f_b) / 2, (f_a**2 + f_b**2) / 2, *(f_b * (f_ab - f_a)), *((f_a - f_ab) ** 2 / 2)]
    pairs = list(combinations(range(dimension), 2)) if second_order else []
    if second_order:
        f_ba = _evaluate_mixed(evaluate, *reversed(sets)) - mean
        terms += [(f_ba[i] * f_ab[j] + f_ba[j] * f_ab[i]) / 2 - f_a * f_b for i, j in pairs]

    def indices(means: Numbers) -> Numbers:
        """Compute the indices from means of the terms (..., quantities, terms).

        Their rows (..., quantities, rows, parameters) are first order, total order, and those of the matrix of pairs.
        """
        shares = means[..., 2:] / (means[..., 1] - means[..., 0] ** 2)[..., None]
        first, total, closed = numpy.split(shares, [dimension, 2 * dimension], axis=-1)
        matrix = numpy.full((*first.shape, dimension if second_order else 0), numpy.nan)
        for k, (i, j) in enumerate(pairs):
            matrix[..., i, j] = matrix[..., j, i] = closed[..., k] - first[..., i] - first[..., j]
        return numpy.concatenate([first[..., None], total[..., None], matrix], axis=-1).swapaxes(-2, -1)

    arrays: dict[str, Numbers] = {}
    for end, rows in _with_intervals(numpy.stack(terms), indices, confidence, seed).items():
        arrays |= {f"first_order{end}": rows[:, 0], f"total_order{end}": rows[:, 1]}
        if second_order:
            arrays[f"second_order{end}"] = rows[:, 2:]
    return arrays


def shapley_effects(
    evaluate: SampledFunction,
    distributions: Sequence[Distribution],
    correlation: Numbers,
    count: int,
    seed: int,
    confidence: float | None,
) -> dict[str, Numbers]:
    """Compute Shapley effects and Kucherenko indices of correlated parameters, and their bootstrap intervals.

    A Shapley effect shares the variance that parameters explain together, by interaction or by correlation, equally
    among them; the effects are 0 or more and add up to 1. Kucherenko's first-order index is the share of the variance
    that knowledge of one parameter removes, including what it tells about correlated ones. The index of total order is
    the share that remains if all other parameters are known; it can be below that of first order.

    Parameters
    ----------
    evaluate : callable
        The first two of its calls are for sets of independent samples.
    distributions : sequence of Distribution
    correlation : array of shape (n_parameters, n_parameters)
        Correlation matrix of the normal variables of a Gaussian copula.
    count : int
        Number of samples in each of 2**n_parameters sets.
    seed, confidence
        As for `sobol_indices`.

    Returns
    -------
    dict of str to array of shape (n_quantities, n_parameters)
        `first_order`, `total_order`, `shapley`, and each with `_low` and `_high`.

    Raises
    ------
    ValueError
        More than `MAX_CORRELATED` parameters.

    References
    ----------
    Owen 2014, SIAM/ASA J. Uncertain. Quantif. 2, 245; Song, Nelson & Staum 2016, SIAM/ASA J. Uncertain. Quantif. 4,
    1060; Kucherenko, Tarantola & Annoni 2012, Comput. Phys. Commun. 183, 937.
    """
    dimension = len(distributions)
    require(
        "number of parameters", dimension, dimension <= MAX_CORRELATED, f"correlated ones are at most {MAX_CORRELATED}"
    )
    from scipy.special import ndtr

    normal = [normal_quantiles(half) for half in _two_sets(dimension, count, seed)]
    subsets = [subset for size in range(1, dimension) for subset in combinations(range(dimension), size)]

    def values(shared: tuple[int, ...]) -> Numbers:
        """Evaluate samples that have some parameters of the first set, and the others conditionally independent."""
        order = [*shared, *(index for index in range(dimension) if index not in shared)]
        factor = numpy.linalg.cholesky(correlation[numpy.ix_(order, order)])
        first = numpy.linalg.cholesky(correlation) @ normal[0]
        innovations = numpy.linalg.solve(factor, first[order])
        innovations[len(shared) :] = normal[1][order[len(shared) :]]
        correlated = numpy.empty_like(first)
        correlated[order] = factor @ innovations
        rows = zip(distributions, ndtr(correlated), strict=True)
        return evaluate(numpy.stack([distribution.frozen.ppf(row) for distribution, row in rows]))

    f_a, f_b = values(tuple(range(dimension))), values(())
    mean = numpy.mean([f_a, f_b], axis=(0, -1))[:, None]
    terms = [(f_a + f_b) / 2 - mean, ((f_a - mean) ** 2 + (f_b - mean) ** 2) / 2]
    terms += [(f_a - values(subset)) ** 2 / 2 for subset in subsets]

    def indices(means: Numbers) -> Numbers:
        """Compute the three kinds of indices (..., quantities, kinds, parameters) from means of the terms."""
        unexplained = means[..., 2:] / (means[..., 1] - means[..., 0] ** 2)[..., None]
        explained = {subset: 1 - unexplained[..., k] for k, subset in enumerate(subsets)}
        explained |= {(): 0 * unexplained[..., 0], tuple(range(dimension)): 1 + 0 * unexplained[..., 0]}
        columns = []
        for index in range(dimension):
            gains = [
                (share - explained[_without(subset, index)]) / (dimension * comb(dimension - 1, len(subset) - 1))
                for subset, share in explained.items()
                if index in subset
            ]
            total = 1 - explained[_without(range(dimension), index)]
            columns.append(numpy.stack([explained[(index,)], total, numpy.sum(gains, axis=0)], axis=-1))
        return numpy.stack(columns, axis=-1)

    return {
        f"{kind}{end}": rows[:, number]
        for end, rows in _with_intervals(numpy.stack(terms), indices, confidence, seed).items()
        for number, kind in enumerate(("first_order", "total_order", "shapley"))
    }


def _without(indices: Sequence[int], removed: int) -> tuple[int, ...]:
    return tuple(index for index in indices if index != removed)


def _two_sets(dimension: int, count: int, seed: int) -> Numbers:
    """Return two independent sets of Sobol points, shape (2, dimension, count)."""
    from scipy.stats.qmc import Sobol

    points = draw_points(Sobol(2 * dimension, bits=64, rng=numpy.random.default_rng(seed)), count)
    return numpy.ascontiguousarray(points.T).reshape(2, dimension, count)


def _evaluate_mixed(evaluate: SampledFunction, base: Numbers, other: Numbers) -> Numbers:
    """Evaluate the base samples with each parameter of the other set: (n_parameters, n_quantities, n_points)."""
    dimension, count = base.shape
    mixed = numpy.where(numpy.eye(dimension, dtype=bool)[:, :, None], other[:, None], base[:, None])
    results = evaluate(mixed.reshape(dimension, dimension * count))
    return numpy.ascontiguousarray(results.reshape(-1, dimension, count).swapaxes(0, 1))


def _with_intervals(
    terms: Numbers, statistic: Callable[[Numbers], Numbers], confidence: float | None, seed: int
) -> dict[str, Numbers]:
    """Compute a statistic of the means of terms, and the ends of its interval by the BCa bootstrap.

    Resamples are drawn in chunks: the memory grows only linearly with the number of points. The terms have the shape
    (n_terms, n_quantities, n_points); the statistic maps means (..., n_quantities, n_terms) to values (...,
    n_quantities, ...). The result has the statistic under "", and the ends under "_low" and "_high". Efron & Tibshirani
    1993, An Introduction to the Bootstrap, section 14.3.
    """
    from scipy.special import ndtr, ndtri

    with numpy.errstate(all="ignore"):  # too few samples: NaN
        means = numpy.moveaxis(terms.mean(axis=-1), 0, -1)
        estimate = statistic(means)
        if confidence is None:
            return {"": estimate}
        resampled = statistic(_resampled_means(terms, seed))
        below = ((resampled < estimate).mean(axis=0) + (resampled <= estimate).mean(axis=0)) / 2
        bias, acceleration = ndtri(below), _acceleration(terms, means, estimate, statistic)
        tails = ndtri(numpy.array([(1 - confidence) / 2, (1 + confidence) / 2]))
        shifted = bias[..., None] + tails
        levels = ndtr(bias[..., None] + shifted / (1 - acceleration[..., None] * shifted))
        low, high = (numpy.empty_like(estimate) for _ in range(2))
        for place in numpy.ndindex(estimate.shape):
            known = numpy.isfinite(levels[place]).all() and numpy.isfinite(resampled[:, *place]).all()
            low[place], high[place] = (
                numpy.quantile(resampled[:, *place], levels[place]) if known else (numpy.nan, numpy.nan)
            )
    return {"": estimate, "_low": low, "_high": high}


def _resampled_means(terms: Numbers, seed: int) -> Numbers:
    """Compute the means of terms over resampled points, shape (n_resamples, n_quantities, n_terms)."""
    n_terms, n_quantities, count = terms.shape
    table = terms.reshape(-1, count)
    rng = numpy.random.default_rng([seed, _RESAMPLES])
    size = max(1, _CHUNK_SIZE // count)
    parts = []
    for first in range(0, _RESAMPLES, size):
        rows = min(size, _RESAMPLES - first)
        chosen = rng.integers(0, count, size=(rows, count)) + count * numpy.arange(rows)[:, None]
        weights = numpy.bincount(chosen.ravel(), minlength=rows * count).reshape(rows, count)
        parts.append(weights.astype(float) @ table.T / count)
    return numpy.swapaxes(numpy.concatenate(parts).reshape(_RESAMPLES, n_terms, n_quantities), 1, 2)


def _acceleration(
    terms: Numbers, means: Numbers, estimate: Numbers, statistic: Callable[[Numbers], Numbers]
) -> Numbers:
    """Compute the acceleration of the BCa bootstrap from the statistic without each point."""
    count = terms.shape[-1]
    size = max(1, _CHUNK_SIZE // terms[..., 0].size)
    moments = [numpy.zeros_like(estimate) for _ in range(3)]
    for first in range(0, count, size):
        points = numpy.moveaxis(terms[..., first : first + size], -1, 0).swapaxes(1, 2)
        deviations = statistic((count * means - points) / (count - 1)) - estimate
        for power, moment in enumerate(moments, 1):
            moment += (deviations**power).sum(axis=0)
    mean, square, cube = (moment / count for moment in moments)
    variance, third = square - mean**2, cube - 3 * mean * square + 2 * mean**3
    acceleration: Numbers = -third / (6 * numpy.sqrt(count) * variance**1.5)
    return acceleration
