"""Least, median and largest values of the results of a study, and the points that have them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy

from ..contact.verdict import Verdict
from ..core.answers import Column, Row, Table
from ..core.arrays import to_list
from ..core.quantities import QUANTITIES
from ..core.unit_systems import Amount, Sentence
from .file_formats import dimension_names, iterate_chunks
from .metadata import invalid_reasons, missing_reasons
from .parameters import MATERIAL_PARTS
from .task import BOUNDS, OUTCOMES, VERDICT

if TYPE_CHECKING:
    import xarray


@dataclass
class StudyReport:
    """Least, largest and sampled values of a study, collected in parts: a study may exceed the memory."""

    ends: dict[str, dict[str, tuple[float, int]]]  # value and index of the point, by result and "least" or "largest"
    sampled: dict[str, list[numpy.ndarray]]
    invalid: Counter[tuple[int, int]]
    verdicts: dict[Verdict, int]
    valid: int = 0

    @classmethod
    def of(cls, study: xarray.Dataset) -> StudyReport:
        """Collect the values of a study."""
        names = result_names(study)
        verdicts = {verdict: 0 for verdict in Verdict if VERDICT in study}
        report = cls({}, {name: [] for name in names}, Counter(), verdicts)
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

    def quantities(self, study: xarray.Dataset) -> dict[str, dict[str, Any]]:
        """Return least and largest value of each result with coordinates, and its median; None without an answer."""
        return {
            name: {
                **{end: {"value": value, "at": coordinates(study, n)} for end, (value, n) in self.ends[name].items()},
                "median": float(numpy.nanmedian(numpy.concatenate(samples))),
            }
            if name in self.ends
            else dict.fromkeys(_ENDS)
            for name, samples in self.sampled.items()
        }

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
        if not numpy.isnan(values).all():
            places = {"least": int(numpy.nanargmin(values)), "largest": int(numpy.nanargmax(values))}
            found = {end: (float(values[place]), first + place) for end, place in places.items()}
            known = self.ends.setdefault(name, found)
            known["least"] = min(known["least"], found["least"])
            known["largest"] = max(known["largest"], found["largest"], key=itemgetter(0))


_ENDS = ("least", "median", "largest")

_MAX_SAMPLED = 1_000_000
"""Points from which a median is computed."""


def varying_parameters(study: xarray.Dataset) -> list[str]:
    """Return the names of the parameters that vary; a material is one name."""
    return [
        str(name)
        for name, variable in study.coords.items()
        if variable.dims and (name in variable.dims or not set(variable.dims) & set(MATERIAL_PARTS))
    ]


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


def plain_values(values: numpy.ndarray) -> Any:
    """Return numbers, with None for missing ones, or names of materials as lists for JSON."""
    return values.tolist() if values.dtype.kind in "OUS" else to_list(values)


def end_table(study: xarray.Dataset, quantities: Mapping[str, Mapping[str, Any]], key: str, title: str) -> Table:
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
    at = {name: end["at"][name] for name in varying_parameters(study)}
    heads = (QUANTITIES[name].symbol or name if name in QUANTITIES else name for name in at)
    return Sentence(", ".join(f"{head} {{}}" for head in heads), *map(amount_of, at, at.values()))


def amount_of(name: str, value: Any) -> Any:
    """Return a number with the unit of its quantity; a material is its name, and None stays."""
    return Amount(value, QUANTITIES[name].shown) if isinstance(value, float) else value
