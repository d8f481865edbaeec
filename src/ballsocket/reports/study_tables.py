"""Results of studies as dictionaries for JSON and as tables in a terminal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy
from rich.table import Table
from rich.text import Text

from ..contact.verdict import Verdict
from ..core.arrays import to_list
from ..core.quantities import QUANTITIES
from ..core.storage.atomic_files import write_csv
from ..core.unit_systems import Units
from ..studies.file_formats import dimension_names, iterate_chunks
from ..studies.limits import Limit, allowed, count_verdicts, refusal_reason, undecided_reason
from ..studies.metadata import held_in, invalid_reasons, missing_reasons
from ..studies.parameters import MATERIAL_PARTS
from ..studies.task import BOUNDS, OUTCOMES, VERDICT
from .terminal import Terminal, print_columns

if TYPE_CHECKING:
    import xarray

    from ..studies.optimisation import Optimum


class End(NamedTuple):
    """Least or largest value of a result, and the index of its point."""

    value: float
    place: int


@dataclass
class StudyReport:
    """Least, largest and sampled values of a study, collected in parts: a study may exceed the memory."""

    ends: dict[str, tuple[End, End]]
    sampled: dict[str, list[numpy.ndarray]]
    invalid: Counter[tuple[int, int]]
    verdicts: dict[Verdict, int]
    valid: int = 0

    @classmethod
    def of(cls, study: xarray.Dataset) -> StudyReport:
        """Collect the values of a study."""
        names = result_names(study)
        nothing = (End(float("nan"), 0), End(float("nan"), 0))
        report = cls(
            dict.fromkeys(names, nothing),
            {name: [] for name in names},
            Counter(),
            {verdict: 0 for verdict in Verdict if VERDICT in study},
        )
        first, stride = 0, max(1, study.status.size // _MAX_SAMPLED)
        for part in iterate_chunks(study):
            for name in names:
                report._add(name, part[name].values.ravel(), first, stride)
            bad = ~part.valid.values
            codes = numpy.stack([part.status.values[bad], part.broken_limit.values[bad]], axis=-1)
            kinds, counts = numpy.unique(codes, axis=0, return_counts=True)
            report.invalid.update(dict(zip(map(tuple, kinds.tolist()), counts.tolist(), strict=True)))
            for verdict in report.verdicts:
                report.verdicts[verdict] += int((part[VERDICT].values == int(verdict)).sum())
            report.valid += int(part.valid.values.sum())
            first += part.status.size
        return report

    def notes(self, study: xarray.Dataset) -> list[str]:
        """List the reasons why points are not valid, with their number, and those of quantities without an answer."""
        reasons, counts = invalid_reasons(study), Counter[str]()
        for kind, count in self.invalid.items():
            counts[reasons[kind]] += count
        n_points = int(study.status.size)
        invalid = [f"{count} of {n_points}: {reason}" for reason, count in counts.most_common()]
        return invalid + [f"{name}: {reason}" for name, reason in missing_reasons(study).items()]

    def _add(self, name: str, values: numpy.ndarray, first: int, stride: int) -> None:
        """Add the values of one part of a result."""
        self.sampled[name].append(values[::stride].copy())
        if numpy.isnan(values).all():
            return
        low, high = self.ends[name]
        smallest, largest = int(numpy.nanargmin(values)), int(numpy.nanargmax(values))
        if not values[smallest] >= low.value:
            low = End(float(values[smallest]), first + smallest)
        if not values[largest] <= high.value:
            high = End(float(values[largest]), first + largest)
        self.ends[name] = low, high


_MAX_SAMPLED = 1_000_000
"""Points from which a median is computed."""

_MAX_LISTED = 5000
"""Points up to which a summary contains all values."""


def study_summary(study: xarray.Dataset) -> dict[str, Any]:
    """Summarise a study: least, median and largest value of each result with coordinates, and few points in full."""
    report, size = StudyReport.of(study), int(study.status.size)
    quantities = {name: _ends_of(study, name, report) for name in report.ends}
    return {
        "model": study.attrs["model"],
        "held": held_in(study),
        "points": size,
        "valid": report.valid == size,
        **({"verdicts": {verdict.word: n for verdict, n in report.verdicts.items()}} if report.verdicts else {}),
        "notes": [*filter(None, [study.attrs.get("comment")]), *report.notes(study)],
        "quantities": quantities,
        "values": _values(study) if size <= _MAX_LISTED else None,
    }


def _values(study: xarray.Dataset) -> dict[str, Any]:
    """Return the varied parameters and the results at all points, in the order of the axes."""
    flat = study.stack(point=dimension_names(study)) if dimension_names(study) else study.expand_dims("point")
    bounds = [name for name in BOUNDS if name in study.data_vars]
    values = {n: _plain(flat[n].values) for n in (*varying_parameters(study), *result_names(study), *bounds)}
    if VERDICT in study.data_vars:
        values[VERDICT] = [None if code < 0 else Verdict(code).word for code in flat[VERDICT].values.tolist()]
    return values


def _plain(values: numpy.ndarray) -> Any:
    return values.tolist() if values.dtype.kind in "OUS" else to_list(values)


def _ends_of(study: xarray.Dataset, name: str, report: StudyReport) -> dict[str, Any]:
    low, high = report.ends[name]
    if numpy.isnan(low.value):
        return {"least": None, "median": None, "largest": None}
    ends = {
        end: {"value": extreme.value, "at": coordinates(study, extreme.place)}
        for end, extreme in (("least", low), ("largest", high))
    }
    return {**ends, "median": float(numpy.nanmedian(numpy.concatenate(report.sampled[name])))}


def map_summary(study: xarray.Dataset, limits: Sequence[Limit]) -> dict[str, Any]:
    """Summarise the allowed points of a map: least and largest values with coordinates.

    Raises
    ------
    ValueError
        Every point exceeds a limit or has no result.
    """
    good, counts = allowed(study, limits), count_verdicts(study, limits)
    if not counts[Verdict.KEPT.word] + counts[Verdict.UNDECIDED.word]:
        raise ValueError(refusal_reason(study, limits, "no point of the map is allowed", "at any point of the map"))
    quantities = {}
    for name in result_names(study) if counts[Verdict.KEPT.word] else ():
        values = study[name].where(good).transpose(*dimension_names(study)).values
        ends = (int(numpy.nanargmin(values)), int(numpy.nanargmax(values)))
        quantities[name] = [{"value": float(values.flat[end]), "at": coordinates(study, end)} for end in ends]
    return {
        "model": study.attrs["model"],
        "held": held_in(study),
        "limits": [str(limit) for limit in limits],
        "verdicts": counts,
        "valid": bool(study.valid.where(good, True).all()),
        "quantities": quantities,
    }


def front_summary(front: xarray.Dataset) -> dict[str, Any]:
    """Summarise a Pareto front as lists of numbers."""
    names = [str(name) for name in (*front.coords, *front.data_vars) if front[name].dims]
    return {
        "model": front.attrs["model"],
        "held": held_in(front),
        "points": {name: to_list(front[name].values) for name in names},
    }


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


def write_sensitivity(indices: xarray.Dataset, path: Path) -> None:
    """Write the shares of the variance with their intervals, and elasticities, to a CSV file, one value in a row."""
    rows: list[Sequence[str]] = [("quantity", "index", "parameter", "other_parameter", "value", "low", "high")]
    for quantity, content in sensitivity_summary(indices)["quantities"].items():
        parts = [([name], numbers) for name, numbers in content["numbers"].items()]
        parts += [(pair["parameters"], pair) for pair in content.get("pairs", ())]
        for parameters, numbers in parts:
            for name in (name for name in _INDEX_NAMES if name in numbers):
                values = (numbers.get(f"{name}{end}") for end in ("", "_low", "_high"))
                cells = ("" if value is None else repr(value) for value in values)
                rows.append([quantity, name, *(*parameters, "")[:2], *cells])
    write_csv(path, rows)


_INDEX_NAMES = {
    "first_order": "first order",
    "total_order": "total order",
    "shapley": "Shapley effect",
    "second_order": "second order",
    "elasticity": "% per %",
}
"""Heads of tables for the variables of a sensitivity."""


def varying_parameters(study: xarray.Dataset) -> list[str]:
    """Return the names of the parameters that vary; a material is one name."""
    return [
        str(name)
        for name, variable in study.coords.items()
        if variable.dims and (name in variable.dims or not set(variable.dims) & set(MATERIAL_PARTS))
    ]


def held_text(held: Mapping[str, float], units: Units = Units.SI) -> str:
    """List lengths that are held while others vary, with titles and units."""
    named = {"interference" if name == "clearance" and value < 0 else name: abs(value) for name, value in held.items()}
    return ", ".join(
        f"{QUANTITIES[name].title} {_value_text(name, value, units)} {_unit(name, units)}"
        for name, value in named.items()
    )


def _print_held(held: Mapping[str, float], units: Units = Units.SI) -> None:
    """Print a line with the lengths that a study holds, if there are any."""
    if held:
        Terminal().print(f"held: {held_text(held, units)}")


def result_names(study: xarray.Dataset) -> list[str]:
    """Return the names of the results of a study."""
    return [str(name) for name in study.data_vars if name not in (*OUTCOMES, VERDICT, *BOUNDS)]


def coordinates(study: xarray.Dataset, flat: int) -> dict[str, Any]:
    """Return the parameters at a point, by its index in the order of the dimensions; None is an unknown strength."""
    dims = dimension_names(study)
    index = dict(zip(dims, numpy.unravel_index(flat, [study.sizes[dim] for dim in dims]), strict=True))
    values = {}
    for name, variable in study.coords.items():
        value = variable.isel({dim: int(index[dim]) for dim in variable.dims}).values.item()
        values[str(name)] = None if value != value else value
    return values


def print_study(study: xarray.Dataset, units: Units = Units.SI) -> None:
    """Print least, median and largest value of each result, with the coordinates of the ends."""
    shape = " x ".join(f"{size} {dim}" for dim, size in study.sizes.items())
    remark = f"; {study.attrs['comment']}" if "comment" in study.attrs else ""
    Terminal().print(f"{study.attrs['model']}, {shape or 'one point'}{remark}")
    _print_held(held_in(study), units)
    table = _table("quantity", "unit", "least", "median", "largest", "least at", "largest at")
    report = StudyReport.of(study)
    for name, (low, high) in report.ends.items():
        if numpy.isnan(low.value):
            table.add_row(name, _unit(name, units), *["no answer"] * 3, "", "")
            continue
        middle = float(numpy.nanmedian(numpy.concatenate(report.sampled[name])))
        numbers = (_value_text(name, value, units) for value in (low.value, middle, high.value))
        points = (_point_text(study, end.place, units) for end in (low, high))
        table.add_row(name, _unit(name, units), *numbers, *points)
    print_columns(Terminal(), table)
    verdicts = ", ".join(f"{count} {verdict.word}" for verdict, count in report.verdicts.items() if count)
    yields = f"; yield stress: {verdicts}" if verdicts else ""
    Terminal().print(f"{study.status.size} points, {report.valid} of them valid{yields}")
    for note in report.notes(study):
        Terminal().print(f"  {note}")


def print_map(study: xarray.Dataset, limits: Sequence[Limit]) -> None:
    """Print least and largest value of each result within the limits, with coordinates."""
    heads, rows = map_rows(study, limits)
    table = _table(*heads)
    for row in rows:
        table.add_row(*row)
    print_columns(Terminal(), table)
    counts = count_verdicts(study, limits)
    shares = ", ".join(f"{100 * n / study.status.size:.3g} % {word}" for word, n in counts.items() if n)
    Terminal().print(f"of the map: {shares}" + "".join(f"; {limit}" for limit in limits))
    if counts[Verdict.UNDECIDED.word]:
        reason = undecided_reason(study, limits)
        Terminal().print(f"undecided: {reason}; the table has the kept designs only")
    _print_held(held_in(study))


def map_rows(study: xarray.Dataset, limits: Sequence[Limit]) -> tuple[list[str], list[list[str]]]:
    """Return heads and rows of the table of a map."""
    rows = []
    for name, ends in map_summary(study, limits)["quantities"].items():
        row = [name, _unit(name)]
        for end in ends:
            varied = {axis: end["at"][axis] for axis in varying_parameters(study)}
            row += [_value_text(name, end["value"]), _parameter_text(varied)]
        rows.append(row)
    return ["quantity", "unit", "least", "at", "largest", "at"], rows


def print_front(front: xarray.Dataset, max_rows: int = 12) -> None:
    """Print evenly chosen designs of a Pareto front."""
    chosen = front.isel(point=numpy.unique(numpy.linspace(0, front.sizes["point"] - 1, max_rows).round().astype(int)))
    names = [*(str(name) for name in front.coords if front[name].dims), *result_names(front)]
    table = _table(*(QUANTITIES[name].head() if name in QUANTITIES else name for name in names))
    for index in range(chosen.sizes["point"]):
        table.add_row(*(_value_text(name, chosen[name].values[index].item()) for name in names))
    print_columns(Terminal(), table)
    Terminal().print(f"{front.sizes['point']} designs that no other beats in both")
    _print_held(held_in(front))


def print_optimum(best: Optimum) -> None:
    """Print the best design, its active limits, and the derivatives of the objective."""
    terminal = Terminal()
    terminal.print(f"{best.minimise} {_value_text(best.minimise, best.value)} {_unit(best.minimise)}", style="bold")
    table = _table("number", "value", "unit", f"d {best.minimise} / d number")
    for name, value in best.point.items():
        slope = f"{best.slopes[name] * _factor(best.minimise) / _factor(name):.4g}" if name in best.slopes else "-"
        table.add_row(name, f"{value * _factor(name):.5g}", _unit(name), slope)
    for part, material in best.materials.items():
        table.add_row(part, material, "", "-")
    print_columns(terminal, table)
    _print_held(best.held)
    if not best.valid:
        terminal.print("the model is not valid there: use another model")
    if best.undecided:
        terminal.print(
            f"{best.undecided} of {best.searched} searched joints are undecided: their error bar contains a limit, or "
            "a strength is missing; the best one keeps the limits by its whole error bar",
        )
    if best.active:
        terminal.print(f"active limits: {', '.join(best.active)}")


def print_sensitivity(indices: xarray.Dataset) -> None:
    """Print the shares of the variance with their intervals, and elasticities, by quantity."""
    terminal = Terminal()
    orders = [name for name in ("shapley", "first_order", "total_order") if name in indices]
    with_intervals = orders[:1] if "shapley" in orders else orders  # a line has 80 columns
    for quantity, content in sensitivity_summary(indices)["quantities"].items():
        mean, deviation = (_value_text(quantity, content[name]) for name in ("mean", "deviation"))
        terminal.print(f"{quantity}: {mean} ± {deviation} {_unit(quantity)}", style="bold")
        table = _table("number", *(_INDEX_NAMES[name] for name in orders), _INDEX_NAMES["elasticity"])
        for parameter, numbers in content["numbers"].items():
            cells = (
                _interval_text(numbers, name) if name in with_intervals else _number_text(numbers[name])
                for name in orders
            )
            table.add_row(parameter, *cells, f"{numbers['elasticity']:+.2f}")
        print_columns(terminal, table)
        if "pairs" in content:
            pairs = _table("pair", _INDEX_NAMES["second_order"])
            for pair in content["pairs"]:
                pairs.add_row(" x ".join(pair["parameters"]), _interval_text(pair, "second_order"))
            print_columns(terminal, pairs)
    _print_held(held_in(indices))
    if "correlation" in indices.attrs:
        terminal.print(f"rank correlations: {indices.attrs['correlation']}")


def _interval_text(numbers: Mapping[str, Any], name: str) -> str:
    value, low, high = (_number_text(numbers.get(f"{name}{end}")) for end in ("", "_low", "_high"))
    return f"{value} ({low}..{high})" if f"{name}_low" in numbers else value


def _number_text(value: float | None) -> str:
    return "nan" if value is None else f"{round(value, 2) + 0.0:.2f}"  # without the sign of -0.00


def _point_text(study: xarray.Dataset, flat: int, units: Units) -> str:
    at = coordinates(study, flat)
    return _parameter_text({name: at[name] for name in varying_parameters(study)}, units)


def _parameter_text(at: Mapping[str, Any], units: Units = Units.SI) -> str:
    return ", ".join(
        f"{QUANTITIES[name].symbol if name in QUANTITIES else name} {_value_text(name, value, units)}"
        for name, value in at.items()
    )


def _unit(name: str, units: Units = Units.SI) -> str:
    return units.unit_of(QUANTITIES[name]).text


def _factor(name: str, units: Units = Units.SI) -> float:
    return units.unit_of(QUANTITIES[name]).factor


def _value_text(name: str, value: float | str, units: Units = Units.SI) -> str:
    return value if isinstance(value, str) else f"{value * _factor(name, units):.4g}"


def _table(*heads: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="dim")
    for head in heads:
        table.add_column(Text(head), no_wrap=not table.columns)
    return table
