"""Description of a sensitivity: shares of the variance with their intervals, and elasticities."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

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
    means = (
        Sentence("{}: {} ± {}", name, *(amount_of(name, float(part[key])) for key in ("mean", "deviation")))
        for name in indices.quantity.values.tolist()
        for part in [indices.sel(quantity=name)]
    )
    entries = list(_entries(indices))
    pairs = [entry for entry in entries if len(entry.parameters) == 2]
    correlation = indices.attrs.get("correlation")
    return Answer(
        title=f"sensitivity, model {indices.attrs['model']}",
        lines=[*means, *held_lines(held_in(indices))],
        tables=[
            _table("sensitivity", "Sensitivity", "number", [entry for entry in entries if entry not in pairs]),
            *([_table("pairs", "Pairs of parameters", "pair", pairs)] if pairs else []),
        ],
        notes=[f"rank correlations: {correlation}"] if correlation else [],
    )


class _Entry(NamedTuple):
    """Indices of one parameter or of a pair, with the ends of their intervals by names in `_low` and `_high`."""

    quantity: str
    parameters: list[str]
    numbers: dict[str, Any]


def _entries(indices: xarray.Dataset) -> Iterator[_Entry]:
    for quantity, content in sensitivity_summary(indices)["quantities"].items():
        yield from (_Entry(quantity, [name], numbers) for name, numbers in content["numbers"].items())
        yield from (_Entry(quantity, pair["parameters"], pair) for pair in content.get("pairs", ()))


def _table(key: str, title: str, label: str, entries: Sequence[_Entry]) -> Table:
    """List indices with their intervals, if known; a narrow terminal has the interval of the main index only."""
    known, several = entries[0].numbers, len({entry.quantity for entry in entries}) > 1
    names = [name for name in _HEADS if name in known]
    columns = [Column.of_words(word) for word in (*["quantity"] * several, label)]
    rows: list[list[Cell]] = [[*[entry.quantity] * several, " x ".join(entry.parameters)] for entry in entries]
    main = next(name for name in ("shapley", "total_order", "second_order") if name in known)
    for name in names:
        columns.append(Column.of_number(name, _HEADS[name], digits=3 if name == "elasticity" else 2))
        if f"{name}_low" in known:
            columns.append(Column.of_number(f"{name}_interval", "95 %", digits=2, rank=int(name != main)))
        for cells, (_, _, numbers) in zip(rows, entries, strict=True):
            low, high = (numbers.get(f"{name}_{end}") for end in ("low", "high"))
            cells.append(numbers[name])
            if f"{name}_low" in known:
                cells.append(None if low is None or high is None else (low, high))
    return Table(key, title, columns, [Row(cells) for cells in rows])


def index_table(indices: xarray.Dataset) -> Table:
    """List all indices with their intervals, one in a row, as data for CSV."""
    words, ends = ("quantity", "index", "parameter", "other_parameter"), ("value", "low", "high")
    rows = [
        Row([quantity, name, *(*parameters, "")[:2], *(numbers.get(f"{name}{end}") for end in ("", "_low", "_high"))])
        for quantity, parameters, numbers in _entries(indices)
        for name in _DATA_ORDER
        if name in numbers
    ]
    return Table("indices", "Indices", [*map(Column.of_words, words), *map(Column.of_number, ends)], rows)


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
