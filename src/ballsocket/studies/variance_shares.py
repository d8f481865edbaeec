"""Sensitivity of contact quantities to scattered parameters: shares of the variance, and elasticities."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Model
from ..core import arrays
from ..core.arrays import Numbers
from ..core.checks import check_names, needs, require
from ..problem import Joint
from .derivatives import elasticities, press_quantities
from .distributions import Correlation, Distribution, copula_matrix, correlation_text
from .metadata import HELD, variable_attributes
from .parameters import PARAMETERS, check_contradictions, hold
from .task import QUANTITIES
from .variance_indices import check_sample_memory, shapley_effects, sobol_indices

if TYPE_CHECKING:
    import xarray


MAX_SAMPLES = 1 << 30
"""Largest number of samples."""

_POINTS_PER_PRESS = 1 << 16  # number of samples that are pressed at once


def sensitivity(
    model: Model,
    joint: Joint,
    distributions: Mapping[str, Distribution],
    *,
    quantities: Iterable[str] = ("indentation", "half_angle", "max_pressure", "area"),
    count: int = 1024,
    seed: int = 0,
    confidence: float | None = 0.95,
    load: Mapping[str, float] | None = None,
    second_order: bool = False,
    correlation: Correlation = MappingProxyType({}),
) -> xarray.Dataset:
    """Compute the contributions of scattered parameters to the variance of contact quantities.

    Independent parameters have Sobol indices, correlated ones Shapley effects and the indices of Kucherenko: see
    `ballsocket.studies.variance_indices`.

    Parameters
    ----------
    model : Model
    joint : Joint
        Values of the parameters that are not in `distributions`.
    distributions : mapping of str to Rectangular, Normal or LogNormal
        Distributions by parameter.
    quantities : iterable of str
        Quantities of a contact.
    count : int
        Number of samples in each set, 2 or more; a power of two fills the space most evenly. There are
        `len(distributions) + 2` sets, `2 * len(distributions) + 2` with second order, `2**len(distributions)` with
        correlations.
    seed : int
        The same seed gives the same indices and intervals.
    confidence : float or None
        Confidence level of the bootstrap intervals, between 0 and 1; None for no intervals.
    load : mapping of str to float
        One of force (N), indentation (mm), half_angle (rad), unless the load has a distribution.
    second_order : bool
        True for the indices of pairs of independent parameters, too.
    correlation : mapping of (str, str) to float
        Rank correlations (Spearman) of pairs of parameters, by a Gaussian copula. Other pairs are independent.

    Returns
    -------
    xarray.Dataset
        Along `quantity` and `parameter`: `first_order` (share of the variance from this parameter alone),
        `total_order` (with its interactions), with correlations `shapley` (shared among correlated parameters, sum 1),
        the ends `_low` and `_high` of their intervals, and `elasticity` (percent for one percent, at the medians).
        Along `quantity`, `parameter` and `other_parameter`: `second_order`. Along `quantity`: `mean` and `deviation`.

    Raises
    ------
    ValueError
        An unknown name, a count below 2 or one that needs too much memory, samples without a result, a quantity that
        does not change, correlations that are not possible, or second order of correlated parameters.
    """
    needs("study", "xarray")
    import xarray

    names, fixed = tuple(quantities), dict(load or {})
    check_names(distributions, PARAMETERS, "among what scatters")
    check_names(names, QUANTITIES, "among the quantities")
    if not distributions:
        raise ValueError("at least one number must scatter")
    check_contradictions({**distributions, **fixed})
    for name in fixed:
        if name in distributions:
            raise ValueError(f"{name} scatters and is given as a load too; one is needed")
    require("count", count, 2 <= count <= MAX_SAMPLES, f"the number of samples is 2 to {MAX_SAMPLES}")
    if confidence is not None:
        require("confidence", confidence, 0 < confidence < 1, "a confidence level is between 0 and 1")
    if second_order and correlation:
        raise ValueError(
            "second-order indices need independent parameters: leave out the correlations, whose Shapley effects share "
            "interactions among the parameters"
        )
    matrix = copula_matrix(tuple(distributions), correlation)
    n = len(distributions)
    n_sets = 2**n if correlation else 2 * n + 2 + n * n // 2 if second_order else 2 * n + 2
    check_sample_memory(count, len(names) * n_sets)
    independent_sets: list[Numbers] = []

    def evaluate(samples: Numbers) -> Numbers:
        results = _press_samples(model, joint, dict(zip(distributions, samples, strict=True)), fixed, names)
        if len(independent_sets) < 2:
            independent_sets.append(results)
        return results

    spreads = list(distributions.values())
    if correlation:
        indices = shapley_effects(evaluate, spreads, matrix, count, seed, confidence)
    else:
        indices = sobol_indices(evaluate, spreads, count, seed, confidence, second_order)
    medians = {name: float(distribution.frozen.median()) for name, distribution in distributions.items()}
    local = elasticities(model, joint, names, {**medians, **fixed})
    samples = numpy.concatenate(independent_sets, axis=1)
    dims = ("quantity", "parameter", "other_parameter")
    held = hold(joint, (*distributions, *fixed))
    attributes: dict[str, Any] = {"model": model.name, "samples": count, HELD: json.dumps(held)}
    attributes |= {} if confidence is None else {"confidence": confidence}
    attributes |= {"correlation": correlation_text(correlation)} if correlation else {}
    return xarray.Dataset(
        {
            **{name: (dims[: values.ndim], arrays.read_only(values)) for name, values in indices.items()},
            "elasticity": (dims[:2], [[local[quantity][name] for name in distributions] for quantity in names]),
            "mean": ("quantity", samples.mean(axis=1)),
            "deviation": ("quantity", samples.std(axis=1)),
            "units": ("quantity", [variable_attributes(name)["units"] for name in names]),
        },
        coords={
            "quantity": list(names),
            "parameter": list(distributions),
            **({"other_parameter": list(distributions)} if second_order else {}),
        },
        attrs=attributes,
    )


def _press_samples(
    model: Model, joint: Joint, samples: Mapping[str, Numbers], load: Mapping[str, float], quantities: Sequence[str]
) -> Numbers:
    """Compute the quantities of samples, shape (n_quantities, n_points).

    Raises ValueError: samples without a result, or a quantity that does not change.
    """
    count = len(next(iter(samples.values())))
    table = numpy.empty((len(quantities), count))
    for first in range(0, count, _POINTS_PER_PRESS):
        part = slice(first, first + _POINTS_PER_PRESS)
        values = {name: column[part] for name, column in samples.items()}
        results = press_quantities(model, joint, {**values, **load}, quantities)
        for name, row in zip(quantities, table, strict=True):
            row[part] = results[name]
    n_bad = int((~numpy.isfinite(table)).any(axis=0).sum())
    if n_bad:
        raise ValueError(f"{model.name} has no answer for {n_bad} of {count} samples: narrow the distributions")
    for name, row in zip(quantities, table, strict=True):
        if numpy.ptp(row) == 0:
            raise ValueError(f"{name} does not change with {' and '.join(samples)}: its variance is zero")
    return table
