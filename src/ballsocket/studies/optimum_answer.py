"""Descriptions of the best design for one goal, and of the Pareto front of two."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy

from ..core.answers import Answer, Column, Row, Table
from ..core.kinds import Unit
from ..core.quantities import QUANTITIES
from ..core.unit_systems import Amount, Sentence
from .extremes import amount_of, plain_values, result_names
from .metadata import held_in, held_lines
from .optimisation import Optimum

if TYPE_CHECKING:
    import xarray

_MAX_ROWS = 12
"""Number of designs of a front in its table."""


def describe_optimum(best: Optimum) -> Answer:
    """Describe the best design, its active limits, and the derivatives of the objective."""
    columns = [
        Column.of_words("number"),
        Column.of_number("value", digits=5),
        Column.of_number("slope", f"d {best.minimise} / d number"),
    ]
    rows = [
        Row([name, Amount(value, QUANTITIES[name].shown, 5), _slope(best, name)]) for name, value in best.point.items()
    ]
    rows += [Row([part, material, None]) for part, material in best.materials.items()]
    return Answer(
        title=Sentence("{} {}", best.minimise, amount_of(best.minimise, best.value)),
        tables=[Table("optimum", "Optimum", columns, rows, [*held_lines(best.held), *_lines(best)])],
    )


def _slope(best: Optimum, name: str) -> Amount | None:
    if name not in best.slopes:
        return None
    over, under = QUANTITIES[best.minimise].shown, QUANTITIES[name].shown
    text = f"{over.text or 1}/{under.text}" if under.text else over.text
    return Amount(best.slopes[name], Unit(text, over.factor / under.factor))


def _lines(best: Optimum) -> Iterator[str]:
    if not best.valid:
        yield "the model is not valid there: use another model"
    if best.undecided:
        yield (
            f"{best.undecided} of {best.searched} searched joints are undecided: their error bar contains a limit, or "
            "a strength is missing; the best one keeps the limits by its whole error bar"
        )
    if best.active:
        yield Sentence(f"active limits: {', '.join(['{}'] * len(best.active))}", *best.active)


def describe_front(front: xarray.Dataset) -> Answer:
    """Describe a Pareto front by evenly chosen designs."""
    size = front.sizes["point"]
    chosen = front.isel(point=numpy.unique(numpy.linspace(0, size - 1, _MAX_ROWS).round().astype(int)))
    names = [*(str(name) for name in front.coords if front[name].dims), *result_names(front)]
    columns = [Column.of(QUANTITIES[name]) if name in QUANTITIES else Column.of_words(name) for name in names]
    rows = [Row(cells) for cells in zip(*(chosen[name].values.tolist() for name in names), strict=True)]
    lines = [f"{size} designs that no other beats in both", *held_lines(held_in(front))]
    return Answer(
        title=f"Pareto front, model {front.attrs['model']}",
        tables=[Table("front", "Pareto front", columns, rows, lines)],
    )


def front_summary(front: xarray.Dataset) -> dict[str, Any]:
    """Summarise a Pareto front as lists of numbers."""
    names = [str(name) for name in (*front.coords, *front.data_vars) if front[name].dims]
    return {
        "model": front.attrs["model"],
        "held": held_in(front),
        "points": {name: plain_values(front[name].values) for name in names},
    }
