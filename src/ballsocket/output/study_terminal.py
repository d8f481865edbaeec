"""Studies in a terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy
from rich.console import Console
from rich.table import Table

from ..core.quantities import QUANTITIES
from ..studies.limits import Limit, allowed
from .study_summary import StudyReport, answers, coordinates, map_summary, varying

if TYPE_CHECKING:
    import xarray

    from ..studies.optimisation import Optimum


def print_study(study: xarray.Dataset) -> None:
    """Each answer with its least, median and largest value, and where the ends are."""
    shape = " x ".join(f"{size} {dim}" for dim, size in study.sizes.items())
    Console().print(f"{study.attrs['model']}, {shape or 'one point'}", highlight=False)
    table = _table("quantity", "unit", "least", "median", "largest", "least at", "largest at")
    seen = StudyReport.of(study)
    for name, (low, high) in seen.ends.items():
        if numpy.isnan(low.value):
            table.add_row(name, _unit(name), *["no answer"] * 3, "", "")
            continue
        middle = float(numpy.nanmedian(numpy.concatenate(seen.sampled[name])))
        numbers = (_shown(name, value) for value in (low.value, middle, high.value))
        table.add_row(name, _unit(name), *numbers, _place(study, low.place), _place(study, high.place))
    Console().print(table)
    failed = "".join(f"; {count} {one.sentence}" for one, count in seen.failed.items() if count)
    Console().print(f"{study.status.size} points, {seen.valid} of them valid{failed}", highlight=False)


def print_map(study: xarray.Dataset, limits: Sequence[Limit]) -> None:
    """The least and largest value of each answer among what the limits allow, and where."""
    heads, rows = map_rows(study, limits)
    table = _table(*heads)
    for row in rows:
        table.add_row(*row)
    Console().print(table)
    share = float(allowed(study, limits).mean())
    Console().print(
        f"{100 * share:.3g} % of the map is allowed" + "".join(f", {limit}" for limit in limits), highlight=False
    )


def map_rows(study: xarray.Dataset, limits: Sequence[Limit]) -> tuple[list[str], list[list[str]]]:
    """Heads and text of that table."""
    rows = []
    for name, ends in map_summary(study, limits)["quantities"].items():
        row = [name, _unit(name)]
        for end in ends:
            varied = {axis: end["at"][axis] for axis in varying(study)}
            row += [_shown(name, end["value"]), _words(varied)]
        rows.append(row)
    return ["quantity", "unit", "least", "at", "largest", "at"], rows


def print_front(front: xarray.Dataset, most: int = 12) -> None:
    """Designs that no other beats in both, at most so many of them, evenly chosen."""
    chosen = front.isel(point=numpy.unique(numpy.linspace(0, front.sizes["point"] - 1, most).round().astype(int)))
    names = [*(str(name) for name in front.coords if front[name].dims), *answers(front)]
    table = _table(*(_head(name) for name in names))
    for place in range(chosen.sizes["point"]):
        table.add_row(*(_shown(name, chosen[name].values[place].item()) for name in names))
    Console().print(table)
    Console().print(f"{front.sizes['point']} designs that no other beats in both", highlight=False)


def print_optimum(best: Optimum) -> None:
    """The best joint, what holds it back, and how the answer changes around it."""
    console = Console()
    console.print(
        f"{best.minimise} {_shown(best.minimise, best.value)} {_unit(best.minimise)}", style="bold", highlight=False
    )
    table = _table("number", "value", "unit", f"d {best.minimise} / d number")
    for name, value in best.point.items():
        slope = f"{best.slopes[name] * _factor(best.minimise) / _factor(name):.4g}" if name in best.slopes else "-"
        table.add_row(name, f"{value * _factor(name):.5g}", _unit(name), slope)
    for part, material in best.materials.items():
        table.add_row(part, material, "", "-")
    console.print(table)
    if not best.valid:
        console.print("the model does not trust itself there: ask another", highlight=False)
    if best.active:
        console.print(f"held by {', '.join(best.active)}", highlight=False)


def print_sensitivity(found: xarray.Dataset) -> None:
    """First and total indices with their intervals, and elasticities, by quantity."""
    console = Console()
    for quantity in found.quantity.values.tolist():
        part = found.sel(quantity=quantity)
        mean, deviation = (_shown(quantity, float(part[name])) for name in ("mean", "deviation"))
        console.print(f"{quantity}: {mean} ± {deviation} {_unit(quantity)}", style="bold", highlight=False)
        table = _table("number", "alone", "with others", "% per %")
        for name in part.parameter.values.tolist():
            row = part.sel(parameter=name)
            indices = (
                f"{float(row[f'{order}_order']):.2f} ({float(row[f'{order}_order_low']):.2f}.."
                f"{float(row[f'{order}_order_high']):.2f})"
                for order in ("first", "total")
            )
            table.add_row(name, *indices, f"{float(row.elasticity):+.2f}")
        console.print(table)


def _place(study: xarray.Dataset, flat: int) -> str:
    at = coordinates(study, flat)
    return _words({name: at[name] for name in varying(study)})


def _words(at: Mapping[str, Any]) -> str:
    return ", ".join(f"{_symbol(name)} {_shown(name, value)}" for name, value in at.items())


def _symbol(name: str) -> str:
    return QUANTITIES[name].symbol if name in QUANTITIES else name


def _head(name: str) -> str:
    return QUANTITIES[name].head() if name in QUANTITIES else name


def _unit(name: str) -> str:
    return QUANTITIES[name].shown.text


def _factor(name: str) -> float:
    return QUANTITIES[name].shown.factor


def _shown(name: str, value: float | str) -> str:
    return value if isinstance(value, str) else f"{value * _factor(name):.4g}"


def _table(*heads: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="dim")
    for head in heads:
        table.add_column(head, overflow="fold")
    return table
