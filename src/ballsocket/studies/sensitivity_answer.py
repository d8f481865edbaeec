"""Descriptions of sensitivities: shares of the variance with their intervals, elasticities, and local bands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from math import nan
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.arrays import to_list
from ..core.quantities import QUANTITIES
from ..core.unit_systems import Sentence, with_error
from .metadata import as_data, held_in, held_lines
from .study_answer import amount_of

if TYPE_CHECKING:
    import xarray

    from .derivatives import LocalUncertainty

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
        Sentence("{}: {} ± {}", name, *with_error(content["mean"], content["deviation"], QUANTITIES[name].shown))
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
    heads += [Column.of_number(name, QUANTITIES[name].title, digits=3) for name in names]
    changes = [
        Row([QUANTITIES[name].title, *(rounded(slopes[parameter]) for parameter in names)])
        for name, slopes in surroundings.changes.items()
    ]
    ends = (
        Column.of_words("quantity", "95 % band from the tolerances"),
        *map(Column.of_number, ("low", "median", "high")),
    )
    bands = [
        Row([QUANTITIES[name].title, *(amount_of(name, end) for end in band)])
        for name, band in surroundings.band.items()
    ]
    method = f"From {surroundings.presses} presses by {surroundings.model}: a quadratic of each tolerance."
    lines = [] if bands else ["No tolerances are stated."]
    return [
        Table("elasticities", "Elasticities", heads, changes),
        Table("bands", "Bands", ends, bands, [method] if surroundings.presses else lines),
    ]
