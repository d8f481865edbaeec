"""Description of a sensitivity: shares of the variance with their intervals, and elasticities."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.arrays import to_list
from ..core.unit_systems import Sentence
from .extremes import amount_of
from .metadata import held_in, held_lines

if TYPE_CHECKING:
    import xarray

_HEADS = {
    "shapley": "Shapley effect",
    "first_order": "first order",
    "total_order": "total order",
    "elasticity": "% per %",
    "second_order": "second order",
}
"""Heads of tables for the variables of a sensitivity."""

_DATA_ORDER = ("first_order", "total_order", "shapley", "second_order", "elasticity")


def describe_sensitivity(indices: xarray.Dataset) -> Answer:
    """Describe the scatter of each result, and the parts of the parameters and of their pairs in it."""
    summary = sensitivity_summary(indices)
    results = summary["quantities"]
    means = (
        Sentence("{}: {} ± {}", name, *(amount_of(name, content[key]) for key in ("mean", "deviation")))
        for name, content in results.items()
    )
    numbers = [(name, number, values) for name, each in results.items() for number, values in each["numbers"].items()]
    pairs = [
        (name, " x ".join(pair["parameters"]), pair)
        for name, content in results.items()
        for pair in content.get("pairs", ())
    ]
    correlation = summary.get("correlation")
    return Answer(
        title=f"sensitivity, model {indices.attrs['model']}",
        lines=[*means, *held_lines(summary["held"])],
        tables=[
            _index_table("sensitivity", "Sensitivity", "number", numbers),
            *([_index_table("pairs", "Pairs of parameters", "pair", pairs)] if pairs else []),
        ],
        notes=[f"rank correlations: {correlation}"] if correlation else [],
    )


def _index_table(key: str, title: str, label: str, entries: Sequence[tuple[str, str, dict[str, Any]]]) -> Table:
    """List indices with their intervals, if known; a narrow terminal has the interval of the main index only."""
    first, several = entries[0][2], len({quantity for quantity, _, _ in entries}) > 1
    names = [name for name in _HEADS if name in first]
    columns = [Column.of_words(word) for word in (*["quantity"] * several, label)]
    main = next(name for name in ("shapley", "total_order", "second_order") if name in first)
    for name in names:
        columns.append(Column.of_number(name, _HEADS[name], digits=3 if name == "elasticity" else 2))
        if f"{name}_low" in first:
            rank = 0 if name == main else 1
            columns.append(Column.of_number(f"{name}_interval", "95 %", digits=2, rank=rank))
    rows = []
    for quantity, number, values in entries:
        cells: list[Cell] = [*[quantity] * several, number]
        for name in names:
            cells.append(values[name])
            if f"{name}_low" in first:
                low, high = (values[f"{name}_{end}"] for end in ("low", "high"))
                cells.append(None if low is None else (low, high))
        rows.append(Row(cells))
    return Table(key, title, columns, rows)


def index_table(indices: xarray.Dataset) -> Table:
    """List all indices with their intervals, one in a row, as data for CSV."""
    words, ends = ("quantity", "index", "parameter", "other_parameter"), ("value", "low", "high")
    rows = []
    for quantity, content in sensitivity_summary(indices)["quantities"].items():
        parts = [([name], numbers) for name, numbers in content["numbers"].items()]
        parts += [(pair["parameters"], pair) for pair in content.get("pairs", ())]
        for parameters, numbers in parts:
            for name in (name for name in _DATA_ORDER if name in numbers):
                values = (numbers.get(f"{name}{end}") for end in ("", "_low", "_high"))
                rows.append(Row([quantity, name, *(*parameters, "")[:2], *values]))
    columns = [*map(Column.of_words, words), *map(Column.of_number, ends)]
    return Table("indices", "Indices", columns, rows)


def sensitivity_summary(indices: xarray.Dataset) -> dict[str, Any]:
    """Summarise the shares of the variance with their intervals, and elasticities, by quantity and parameter."""
    names = [str(name) for name, values in indices.data_vars.items() if values.dims == ("quantity", "parameter")]
    summary: dict[str, Any] = {
        "held": held_in(indices),
        "samples": indices.attrs["samples"],
        "quantities": {
            quantity: {
                "mean": float(indices["mean"].sel(quantity=quantity)),
                "deviation": float(indices["deviation"].sel(quantity=quantity)),
                "numbers": {
                    parameter: {
                        name: to_list(indices[name].sel(quantity=quantity, parameter=parameter).values)
                        for name in names
                    }
                    for parameter in indices.parameter.values.tolist()
                },
                **_pairs_summary(indices.sel(quantity=quantity)),
            }
            for quantity in indices.quantity.values.tolist()
        },
    }
    return summary | {key: indices.attrs[key] for key in ("confidence", "correlation") if key in indices.attrs}


def _pairs_summary(part: xarray.Dataset) -> dict[str, Any]:
    """Summarise the indices of pairs of parameters for one quantity; empty without them."""
    names = [str(name) for name, values in part.data_vars.items() if "other_parameter" in values.dims]
    pairs = [
        {
            "parameters": [one, other],
            **{name: to_list(part[name].sel(parameter=one, other_parameter=other).values) for name in names},
        }
        for one, other in combinations(part.parameter.values.tolist(), 2)
    ]
    return {"pairs": pairs} if names else {}
