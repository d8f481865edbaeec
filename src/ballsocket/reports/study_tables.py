"""Results of studies as dictionaries for JSON and as tables in a terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy
from rich.console import Console
from rich.table import Table

from ..core.arrays import to_list
from ..core.quantities import QUANTITIES
from ..core.validity import Status
from ..studies.limits import Limit, allowed, refusal
from ..studies.parameters import PARTS_OF
from ..studies.pieces import dims_of, pieces

if TYPE_CHECKING:
    import xarray

    from ..studies.optimum import Optimum


class End(NamedTuple):
    """A least or largest value, and the number of its point."""

    value: float
    place: int


@dataclass
class StudyReport:
    """What is told of a study, gathered part by part: it may be larger than the memory."""

    ends: dict[str, tuple[End, End]]
    sampled: dict[str, list[numpy.ndarray]]
    failed: dict[Status, int]
    valid: int = 0

    @classmethod
    def of(cls, study: xarray.Dataset) -> StudyReport:
        names = answers(study)
        nothing = (End(float("nan"), 0), End(float("nan"), 0))
        seen = cls(
            dict.fromkeys(names, nothing), {name: [] for name in names}, {one: 0 for one in Status if one.failed}
        )
        first, stride = 0, max(1, study.status.size // _SAMPLED)
        for part in pieces(study):
            for name in names:
                seen._add(name, part[name].values.ravel(), first, stride)
            for one in seen.failed:
                seen.failed[one] += int((part.status.values == int(one)).sum())
            seen.valid += int(part.valid.values.sum())
            first += part.status.size
        return seen

    def _add(self, name: str, values: numpy.ndarray, first: int, stride: int) -> None:
        self.sampled[name].append(values[::stride].copy())
        if numpy.isnan(values).all():
            return
        low, high = self.ends[name]
        least, most = int(numpy.nanargmin(values)), int(numpy.nanargmax(values))
        if not values[least] >= low.value:
            low = End(float(values[least]), first + least)
        if not values[most] <= high.value:
            high = End(float(values[most]), first + most)
        self.ends[name] = low, high


_SAMPLED = 1_000_000  # points over which a median is taken
_LISTED = 5000  # points up to which all values are told


def study_summary(study: xarray.Dataset) -> dict[str, Any]:
    """Least, median and largest value of each answer with their places, and all values where these are few."""
    seen, size = StudyReport.of(study), int(study.status.size)
    quantities = {name: _ends_of(study, name, seen) for name in seen.ends}
    return {
        "model": study.attrs["model"],
        "points": size,
        "valid": seen.valid == size,
        "notes": [f"{count} of {size}: {one.sentence}" for one, count in seen.failed.items() if count],
        "quantities": quantities,
        "values": _values(study) if size <= _LISTED else None,
    }


def _values(study: xarray.Dataset) -> dict[str, Any]:
    """What varies and what was answered, point by point in the order of the axes."""
    flat = study.stack(point=dims_of(study)) if dims_of(study) else study.expand_dims("point")
    names = [*varying(study), *answers(study)]
    return {name: _plain(flat[name].values) for name in names}


def _plain(values: numpy.ndarray) -> Any:
    return values.tolist() if values.dtype.kind in "OUS" else to_list(values)


def _ends_of(study: xarray.Dataset, name: str, seen: StudyReport) -> dict[str, Any]:
    low, high = seen.ends[name]
    if numpy.isnan(low.value):
        return {"least": None, "median": None, "largest": None}
    told = {
        end: {"value": one.value, "at": coordinates(study, one.place)}
        for end, one in (("least", low), ("largest", high))
    }
    return {**told, "median": float(numpy.nanmedian(numpy.concatenate(seen.sampled[name])))}


def map_summary(study: xarray.Dataset, limits: Sequence[Limit]) -> dict[str, Any]:
    """Least and largest values with their places.

    Raises
    ------
    ValueError
        Nothing is allowed.
    """
    good = allowed(study, limits)
    if not bool(good.any()):
        raise ValueError(refusal(study, limits, "no point of the map is allowed", "at any point of the map"))
    quantities = {}
    for name in answers(study):
        values = study[name].where(good).transpose(*dims_of(study)).values
        ends = (int(numpy.nanargmin(values)), int(numpy.nanargmax(values)))
        quantities[name] = [{"value": float(values.flat[end]), "at": coordinates(study, end)} for end in ends]
    return {
        "model": study.attrs["model"],
        "limits": [str(limit) for limit in limits],
        "valid": bool(study.valid.where(good, True).all()),
        "quantities": quantities,
    }


def front_summary(front: xarray.Dataset) -> dict[str, Any]:
    """Columns of numbers."""
    names = [str(name) for name in (*front.coords, *front.data_vars) if front[name].dims]
    return {"model": front.attrs["model"], "points": {name: to_list(front[name].values) for name in names}}


def sensitivity_summary(found: xarray.Dataset) -> dict[str, Any]:
    """By quantity, then by number."""
    orders = ("first_order", "first_order_low", "first_order_high", "total_order", "elasticity")
    return {
        "samples": found.attrs["samples"],
        "quantities": {
            quantity: {
                "mean": float(found["mean"].sel(quantity=quantity)),
                "deviation": float(found["deviation"].sel(quantity=quantity)),
                "numbers": {
                    name: {
                        order: to_list(found[order].sel(quantity=quantity, parameter=name).values) for order in orders
                    }
                    for name in found.parameter.values.tolist()
                },
            }
            for quantity in found.quantity.values.tolist()
        },
    }


def varying(study: xarray.Dataset) -> list[str]:
    """The parameters that vary, materials by their names alone."""
    return [
        str(name)
        for name, variable in study.coords.items()
        if variable.dims and (name in variable.dims or not set(variable.dims) & set(PARTS_OF))
    ]


def answers(study: xarray.Dataset) -> list[str]:
    """What a study holds of the contacts, by name."""
    return [str(name) for name in study.data_vars if name not in ("status", "valid")]


def coordinates(study: xarray.Dataset, flat: int) -> dict[str, Any]:
    """The parameters at a point, by its number in the order of the dimensions."""
    dims = dims_of(study)
    place = dict(zip(dims, numpy.unravel_index(flat, [study.sizes[dim] for dim in dims]), strict=True))
    found = {}
    for name, variable in study.coords.items():
        here = variable.isel({dim: int(place[dim]) for dim in variable.dims})
        found[str(name)] = here.values.item()
    return found


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
