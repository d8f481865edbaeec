"""Descriptions of studies, design maps, optima and Pareto fronts: ends of their results, verdicts and reasons."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy

from ..contact.verdict import Verdict
from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.arrays import to_list
from ..core.display import counted
from ..core.kinds import PERCENT, Unit
from ..core.quantities import QUANTITIES
from ..core.unit_systems import Amount, Sentence
from .file_formats import iterate_chunks
from .limits import Limit, allowed, count_verdicts, refusal_reason, undecided_reason
from .metadata import as_data, held_in, held_lines, invalid_reasons, missing_reasons
from .parameters import MATERIAL_PARTS
from .task import BOUNDS, OUTCOMES, VERDICT

if TYPE_CHECKING:
    import xarray

    from .optimisation import Optimum

_ENDS = ("least", "median", "largest")
_MAX_SAMPLED = 1_000_000  # points from which a median is computed
_MAX_LISTED = 5000  # points up to which a summary contains all values
_MAX_ROWS = 12  # designs of a front in its table


# Studies


class _StudyReport:
    """Least, median and largest values of a study, collected in chunks: a study may exceed the memory."""

    def __init__(self, study: xarray.Dataset) -> None:
        self.study = study
        self.ends: dict[str, dict[str, tuple[float, int]]] = {}  # value and index of the point, by result and end
        self.sampled: dict[str, list[numpy.ndarray]] = {name: [] for name in _result_names(study)}
        self.invalid: Counter[tuple[int, int]] = Counter()
        self.verdicts = {verdict: 0 for verdict in Verdict if VERDICT in study}
        self.valid = 0
        first, stride = 0, max(1, study.status.size // _MAX_SAMPLED)
        for part in iterate_chunks(study):
            for name in self.sampled:
                values = part[name].values.ravel()
                self.sampled[name].append(values[::stride].copy())
                if numpy.isnan(values).all():
                    continue
                places = {"least": int(numpy.nanargmin(values)), "largest": int(numpy.nanargmax(values))}
                found = {end: (float(values[place]), first + place) for end, place in places.items()}
                known = self.ends.setdefault(name, found)
                known["least"] = min(known["least"], found["least"])
                known["largest"] = max(known["largest"], found["largest"], key=itemgetter(0))
            bad = ~part.valid.values
            codes = numpy.stack([part.status.values[bad], part.broken_limit.values[bad]], axis=-1)
            kinds, counts = numpy.unique(codes, axis=0, return_counts=True)
            self.invalid.update(dict(zip(map(tuple, kinds.tolist()), counts.tolist(), strict=True)))
            for verdict in self.verdicts:
                self.verdicts[verdict] += int((part[VERDICT].values == int(verdict)).sum())
            self.valid += int(part.valid.values.sum())
            first += part.status.size

    def quantities(self) -> dict[str, dict[str, Any]]:
        """Return least and largest value of each result with coordinates, and its median; None without an answer."""
        quantities: dict[str, dict[str, Any]] = {}
        for name, samples in self.sampled.items():
            if name not in self.ends:
                quantities[name] = dict.fromkeys(_ENDS)
                continue
            ends = self.ends[name].items()
            quantities[name] = {end: {"value": value, "at": _coordinates(self.study, n)} for end, (value, n) in ends}
            quantities[name]["median"] = float(numpy.nanmedian(numpy.concatenate(samples)))
        return quantities

    def notes(self) -> list[str]:
        """List the reasons why points are not valid, with their number, and those of quantities without an answer."""
        reasons, counts = invalid_reasons(self.study), Counter[str]()
        for kind, count in self.invalid.items():
            counts[reasons[kind]] += count
        invalid = [f"{count} of {self.study.status.size}: {reason}" for reason, count in counts.most_common()]
        return invalid + [f"{name}: {reason}" for name, reason in missing_reasons(self.study).items()]


def describe_study(study: xarray.Dataset) -> Answer:
    """Describe a study by the ends of its results, with the coordinates of the ends."""
    report = _StudyReport(study)
    sizes = {str(dim): size for dim, size in study.sizes.items()}
    shape = " x ".join(f"{size} {dim}" if dim in QUANTITIES else counted(size, dim) for dim, size in sizes.items())
    verdicts = ", ".join(f"{count} {verdict.word}" for verdict, count in report.verdicts.items() if count)
    line = f"{counted(study.status.size, 'point')}, {report.valid} of them valid"
    table = _end_table(study, report.quantities(), "study", "Study")
    return Answer(
        title="; ".join([f"{study.attrs['model']}, {shape or 'one point'}", *_comments(study)]),
        lines=held_lines(held_in(study)),
        tables=[table._replace(lines=[f"{line}; yield stress: {verdicts}" if verdicts else line])],
        notes=report.notes(),
    )


def _comments(study: xarray.Dataset) -> list[str]:
    return [comment] if (comment := study.attrs.get("comment")) else []


def study_summary(study: xarray.Dataset) -> dict[str, Any]:
    """Summarise a study: least, median and largest value of each result with coordinates, and few points in full."""
    report, size = _StudyReport(study), int(study.status.size)
    return {
        "model": study.attrs["model"],
        "held": held_in(study),
        "points": size,
        "valid": report.valid == size,
        **({"verdicts": {verdict.word: n for verdict, n in report.verdicts.items()}} if report.verdicts else {}),
        "notes": [*_comments(study), *report.notes()],
        "quantities": as_data(report.quantities()),
        "values": as_data(_values(study)) if size <= _MAX_LISTED else None,
    }


def _values(study: xarray.Dataset) -> dict[str, Any]:
    """Return the varied parameters and the results at all points, in the order of the axes."""
    flat = study.stack(point=study.status.dims) if study.status.dims else study.expand_dims("point")
    bounds = [name for name in BOUNDS if name in study.data_vars]
    values = {n: to_list(flat[n].values) for n in (*_varying_parameters(study), *_result_names(study), *bounds)}
    if VERDICT in study.data_vars:
        values[VERDICT] = [None if code < 0 else Verdict(code).word for code in flat[VERDICT].values.tolist()]
    return values


# Design maps


def describe_map(study: xarray.Dataset, limits: Sequence[Limit]) -> Answer:
    """Describe the kept designs of a map; ValueError as of `map_table`."""
    return Answer(title=f"design map, model {study.attrs['model']}", tables=[map_table(study, limits)])


def map_table(study: xarray.Dataset, limits: Sequence[Limit]) -> Table:
    """List the ends of each result of the kept designs.

    Raises ValueError: every point exceeds a limit or has no result.
    """
    counts, found = _kept_ends(study, limits)
    ends = {name: dict(zip(("least", "largest"), pair, strict=True)) for name, pair in found.items()}
    table = _end_table(study, ends, "map", "Design map")
    shares = [(Amount(n / study.status.size, PERCENT, 3), word) for word, n in counts.items() if n]
    template = ", ".join(["{} {}"] * len(shares)) + "; {}" * len(limits)
    lines = [Sentence(f"of the map: {template}", *(part for share in shares for part in share), *map(str, limits))]
    if counts[Verdict.UNDECIDED.word]:
        reason = undecided_reason(study, limits)
        lines.append(Sentence("undecided: {}; the table has the kept designs only", reason))
    return table._replace(lines=lines + held_lines(held_in(study)))


def map_summary(study: xarray.Dataset, limits: Sequence[Limit]) -> dict[str, Any]:
    """Summarise the kept points of a map: least and largest values with coordinates; ValueError as of `map_table`."""
    counts, ends = _kept_ends(study, limits)
    return {
        "model": study.attrs["model"],
        "held": held_in(study),
        "limits": [str(limit) for limit in limits],
        "verdicts": counts,
        "valid": bool(study.valid.where(allowed(study, limits), True).all()),
        "quantities": as_data(ends),
    }


def _kept_ends(study: xarray.Dataset, limits: Sequence[Limit]) -> tuple[dict[str, int], dict[str, list[Any]]]:
    """Return the numbers of points by verdict, and least and largest value of each result of the kept ones."""
    good, counts = allowed(study, limits), count_verdicts(study, limits)
    if not counts[Verdict.KEPT.word] + counts[Verdict.UNDECIDED.word]:
        raise ValueError(refusal_reason(study, limits, "no point of the map is allowed", "at any point of the map"))
    quantities = {}
    for name in _result_names(study) if counts[Verdict.KEPT.word] else ():
        values = study[name].where(good).transpose(*study.status.dims).values
        ends = (int(numpy.nanargmin(values)), int(numpy.nanargmax(values)))
        quantities[name] = [{"value": float(values.flat[end]), "at": _coordinates(study, end)} for end in ends]
    return counts, quantities


# Optima and Pareto fronts


def describe_optimum(best: Optimum) -> Answer:
    """Describe the best design, its active limits, and the derivatives of the objective."""
    columns = [
        Column.of_words("number"),
        Column.of_number("value", digits=5),
        Column.of_number("slope", f"d {best.minimise} / d number"),
    ]
    rows = []
    for name, value in best.point.items():
        unit, over = QUANTITIES[name].shown, QUANTITIES[best.minimise].shown
        slope: Cell = None
        if name in best.slopes:
            text = f"{over.text or 1}/{unit.text}" if unit.text else over.text
            slope = Amount(best.slopes[name], Unit(text, over.factor / unit.factor))
        rows.append(Row([name, Amount(value, unit, 5), slope]))
    rows += [Row([part, material, None]) for part, material in best.materials.items()]
    lines: list[str] = [*held_lines(best.held)]
    if not best.valid:
        lines.append("the model is not valid there: use another model")
    if best.undecided:
        lines.append(
            f"undecided: {best.undecided} of {counted(best.searched, 'searched joint')}: their error bar contains a "
            "limit, or a strength is missing; the best one keeps the limits by its whole error bar"
        )
    if best.active:
        lines.append(Sentence(f"active limits: {', '.join(['{}'] * len(best.active))}", *best.active))
    return Answer(
        title=Sentence("{} {}", best.minimise, amount_of(best.minimise, best.value)),
        tables=[Table("optimum", "Optimum", columns, rows, lines)],
    )


def describe_front(front: xarray.Dataset) -> Answer:
    """Describe a Pareto front by evenly chosen designs."""
    size = front.sizes["point"]
    chosen = front.isel(point=numpy.unique(numpy.linspace(0, size - 1, _MAX_ROWS).round().astype(int)))
    names = [*(str(name) for name in front.coords if front[name].dims), *_result_names(front)]
    columns = [Column.of(QUANTITIES[name]) if name in QUANTITIES else Column.of_words(name) for name in names]
    rows = [Row(cells) for cells in zip(*(chosen[name].values.tolist() for name in names), strict=True)]
    lines = [f"{counted(size, 'design')} that no other beats in both", *held_lines(held_in(front))]
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
        "points": as_data({name: to_list(front[name].values) for name in names}),
    }


# Parts of these


def _varying_parameters(study: xarray.Dataset) -> list[str]:
    """Return the names of the parameters that vary; a material is one name."""
    return [
        str(name)
        for name, variable in study.coords.items()
        if variable.dims and (name in variable.dims or not set(variable.dims) & set(MATERIAL_PARTS))
    ]


def _result_names(study: xarray.Dataset) -> list[str]:
    return [str(name) for name in study.data_vars if name not in (*OUTCOMES, VERDICT, *BOUNDS)]


def _coordinates(study: xarray.Dataset, flat: int) -> dict[str, Any]:
    """Return the parameters at a point, by its index in the order of the dimensions; None is an unknown strength."""
    dims = study.status.dims
    index = dict(zip(dims, numpy.unravel_index(flat, [study.sizes[dim] for dim in dims]), strict=True))
    values = {}
    for name, variable in study.coords.items():
        value = variable.isel({dim: int(index[dim]) for dim in variable.dims}).values.item()
        values[str(name)] = None if value != value else value
    return values


def _end_table(study: xarray.Dataset, quantities: Mapping[str, Mapping[str, Any]], key: str, title: str) -> Table:
    """List least and largest value of each result with the varying parameters there, and the median if there is one."""
    ends = [end for end in _ENDS if any(end in content for content in quantities.values())]
    columns = [Column.of_words("quantity"), *map(Column.of_number, ends)]
    columns += [Column.of_words(f"{end}_at", f"{end} at") for end in ends if end != "median"]
    rows = []
    for name, content in quantities.items():
        found = [content[end] for end in ends]
        values = (entry["value"] if isinstance(entry, dict) else entry for entry in found)
        places = (_point_text(study, content[end]) for end in ends if end != "median")
        rows.append(Row([name, *(amount_of(name, value) for value in values), *places]))
    return Table(key, title, columns, rows)


def _point_text(study: xarray.Dataset, end: Mapping[str, Any] | None) -> Sentence | None:
    """List the varying parameters at an end with symbols and units."""
    if end is None:
        return None
    at = {name: end["at"][name] for name in _varying_parameters(study)}
    heads = (QUANTITIES[name].symbol or name if name in QUANTITIES else name for name in at)
    return Sentence(", ".join(f"{head} {{}}" for head in heads), *map(amount_of, at, at.values()))


def amount_of(name: str, value: Any) -> Any:
    """Return a number with the unit of its quantity; a material is its name, and None stays."""
    return Amount(value, QUANTITIES[name].shown) if isinstance(value, float) else value
