"""Sensitivity of contact quantities to scattered parameters: shares of the variance, elasticities, descriptions."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from math import nan
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy

from ..contact import Model
from ..core import arrays
from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.arrays import Numbers, to_list
from ..core.checks import check_names, needs, require
from ..core.quantities import QUANTITIES as ALL_QUANTITIES
from ..core.unit_systems import Sentence, with_error
from ..problem import Joint
from .derivatives import elasticities, press_quantities
from .distributions import Correlation, Distribution, copula_matrix, correlation_text
from .metadata import HELD, as_data, held_in, held_lines, variable_attributes
from .parameters import PARAMETERS, check_contradictions, hold
from .study_answer import amount_of
from .task import QUANTITIES
from .variance_indices import check_sample_memory, shapley_effects, sobol_indices

if TYPE_CHECKING:
    import xarray

    from .derivatives import LocalUncertainty


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


_HEADS = {
    "shapley": "Shapley effect",
    "first_order": "first order",
    "total_order": "total order",
    "elasticity": "% per %",
    "second_order": "second order",
}
"""Heads of tables for the variables of a sensitivity."""

_TABLES = {1: ("sensitivity", "Sensitivity", "number"), 2: ("pairs", "Pairs of parameters", "pair")}
"""Key, title and head of the table of single parameters, and of pairs."""


def describe_sensitivity(indices: xarray.Dataset) -> Answer:
    """Describe the scatter of each result, and the parts of the parameters and of their pairs in it."""
    means = (
        Sentence("{}: {} ± {}", name, *with_error(content["mean"], content["deviation"], ALL_QUANTITIES[name].shown))
        for name, content in _contents(indices).items()
    )
    entries = list(_entries(indices))
    correlation = indices.attrs.get("correlation")
    return Answer(
        title=f"sensitivity, model {indices.attrs['model']}",
        lines=[*means, *held_lines(held_in(indices))],
        tables=[
            share_table(key, title, ("quantity", head), chosen)
            for count, (key, title, head) in _TABLES.items()
            if (chosen := [entry for entry in entries if len(entry.parameters) == count])
        ],
        notes=[f"rank correlations: {correlation}"] if correlation else [],
    )


class IndexEntry(NamedTuple):
    """Indices of one parameter or of a pair, with the ends of their intervals by names in `_low` and `_high`."""

    quantity: str
    parameters: list[str]
    numbers: dict[str, Any]


def _entries(indices: xarray.Dataset) -> Iterator[IndexEntry]:
    for quantity, content in _contents(indices).items():
        yield from (IndexEntry(quantity, [name], numbers) for name, numbers in content["numbers"].items())
        yield from (IndexEntry(quantity, pair["parameters"], pair) for pair in content.get("pairs", ()))


def share_table(key: str, title: str, heads: tuple[str, str], entries: Sequence[IndexEntry]) -> Table:
    """List indices with their intervals, if known; a narrow terminal has the interval of the main index only."""
    known, several = entries[0].numbers, len({entry.quantity for entry in entries}) > 1
    names = [name for name in _HEADS if name in known]
    columns = [Column.of_words(word) for word in heads[not several :]]
    rows: list[list[Cell]] = [[*[entry.quantity] * several, " x ".join(entry.parameters)] for entry in entries]
    main = next(name for name in ("shapley", "total_order", "second_order") if name in known)
    for name in names:
        columns.append(Column.of_number(name, _HEADS[name], digits=3))
        if f"{name}_low" in known:
            columns.append(Column.of_number(f"{name}_interval", "95 %", digits=3, rank=int(name != main)))
        for cells, (_, _, numbers) in zip(rows, entries, strict=True):
            cells.append(rounded(numbers[name]))
            if f"{name}_low" in known:
                cells.append(tuple(rounded(numbers[f"{name}_{end}"]) for end in ("low", "high")))
    return Table(key, title, columns, [Row(cells) for cells in rows])


def rounded(share: float | None) -> float:
    """Round a share of the variance or an elasticity, of which smaller parts are noise; NaN for none."""
    return nan if share is None else round(share, 2) + 0.0


def index_table(indices: xarray.Dataset) -> Table:
    """List all indices with their intervals, one in a row, as data for CSV."""
    words, ends = ("quantity", "index", "parameter", "other_parameter"), ("value", "low", "high")
    rows = [
        Row([quantity, name, *(*parameters, "")[:2], *(numbers.get(f"{name}{end}") for end in ("", "_low", "_high"))])
        for quantity, parameters, numbers in _entries(indices)
        for name in _HEADS
        if name in numbers
    ]
    return Table("indices", "Indices", [*map(Column.of_words, words), *map(Column.of_number, ends)], rows)


def sensitivity_summary(indices: xarray.Dataset) -> dict[str, Any]:
    """Summarise the shares of the variance with their intervals, and elasticities, by quantity and parameter."""
    quantities: dict[str, Any] = {}
    for name, content in _contents(indices).items():
        scatter = {key: content[key] for key in ("mean", "deviation")}
        for key, written in as_data({name: scatter}).items():
            quantities[key] = {**content, **written}
    options = {key: indices.attrs[key] for key in ("confidence", "correlation") if key in indices.attrs}
    return {"held": held_in(indices), "samples": indices.attrs["samples"], "quantities": quantities, **options}


def _contents(indices: xarray.Dataset) -> dict[str, dict[str, Any]]:
    """Return mean and deviation of each quantity, and the indices of single parameters and of pairs."""
    parameters = indices.parameter.values.tolist()
    single, paired = ([str(name) for name in indices.data_vars if indices[name].ndim == count] for count in (2, 3))
    quantities: dict[str, dict[str, Any]] = {}
    for quantity in indices.quantity.values.tolist():
        part = indices.sel(quantity=quantity)
        content: dict[str, Any] = {name: float(part[name]) for name in ("mean", "deviation")}
        quantities[quantity] = content
        content["numbers"] = {name: _numbers(part[single].sel(parameter=name)) for name in parameters}
        if paired:
            content["pairs"] = [
                {"parameters": [one, other], **_numbers(part[paired].sel(parameter=one, other_parameter=other))}
                for one, other in combinations(parameters, 2)
            ]
    return quantities


def _numbers(part: xarray.Dataset) -> dict[str, Any]:
    return {str(name): to_list(value.values) for name, value in part.data_vars.items()}


def uncertainty_tables(surroundings: LocalUncertainty) -> list[Table]:
    """List the elasticities of a contact, and its bands."""
    names = list(next(iter(surroundings.changes.values())))
    heads = [Column.of_words("quantity", "change in % if 1 % is added to the")]
    heads += [Column.of_number(name, ALL_QUANTITIES[name].title, digits=3) for name in names]
    changes = [
        Row([ALL_QUANTITIES[name].title, *(rounded(slopes[parameter]) for parameter in names)])
        for name, slopes in surroundings.changes.items()
    ]
    ends = (
        Column.of_words("quantity", "95 % band from the tolerances"),
        *map(Column.of_number, ("low", "median", "high")),
    )
    bands = [
        Row([ALL_QUANTITIES[name].title, *(amount_of(name, end) for end in band)])
        for name, band in surroundings.band.items()
    ]
    method = f"From {surroundings.presses} presses by {surroundings.model}: a quadratic of each tolerance."
    lines = [] if bands else ["No tolerances are stated."]
    return [
        Table("elasticities", "Elasticities", heads, changes),
        Table("bands", "Bands", ends, bands, [method] if surroundings.presses else lines),
    ]
