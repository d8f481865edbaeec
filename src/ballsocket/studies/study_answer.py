"""Description of a study: least, median and largest value of each result, and the reasons of points without one."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING, Any

from ..contact.verdict import Verdict
from ..core.answers import Answer, Cell, Column, Row, Table
from .extremes import StudyReport, amount_of, coordinates, plain_values, point_text, result_names, varying_parameters
from .file_formats import dimension_names
from .metadata import held_in, held_lines
from .task import BOUNDS, VERDICT

if TYPE_CHECKING:
    import xarray

_MAX_LISTED = 5000
"""Points up to which a summary contains all values."""


def describe_study(study: xarray.Dataset) -> Answer:
    """Describe a study by the ends of its results, with the coordinates of the ends."""
    report = StudyReport.of(study)
    shape = " x ".join(f"{size} {dim}" for dim, size in study.sizes.items())
    return Answer(
        title="; ".join([f"{study.attrs['model']}, {shape or 'one point'}", *_comments(study)]),
        lines=held_lines(held_in(study)),
        tables=[_table(study, report)],
        notes=report.notes(study),
    )


def _table(study: xarray.Dataset, report: StudyReport) -> Table:
    columns = [
        Column.of_words("quantity"),
        *map(Column.of_number, ("least", "median", "largest")),
        *(Column.of_words(f"{end}_at", f"{end} at") for end in ("least", "largest")),
    ]
    rows = []
    for name, ends in report.ends.items():
        cells: list[Cell] = [None] * 5
        if not isnan(ends[0].value):
            values = ends[0].value, report.median(name), ends[1].value
            places = (point_text(study, coordinates(study, end.place)) for end in ends)
            cells = [*(amount_of(name, value) for value in values), *places]
        rows.append(Row([name, *cells]))
    verdicts = ", ".join(f"{count} {verdict.word}" for verdict, count in report.verdicts.items() if count)
    yields = f"; yield stress: {verdicts}" if verdicts else ""
    line = f"{study.status.size} points, {report.valid} of them valid{yields}"
    return Table("study", "Study", columns, rows, [line])


def _comments(study: xarray.Dataset) -> list[str]:
    return [comment] if (comment := study.attrs.get("comment")) else []


def study_summary(study: xarray.Dataset) -> dict[str, Any]:
    """Summarise a study: least, median and largest value of each result with coordinates, and few points in full."""
    report, size = StudyReport.of(study), int(study.status.size)
    return {
        "model": study.attrs["model"],
        "held": held_in(study),
        "points": size,
        "valid": report.valid == size,
        **({"verdicts": {verdict.word: n for verdict, n in report.verdicts.items()}} if report.verdicts else {}),
        "notes": [*_comments(study), *report.notes(study)],
        "quantities": {name: _ends_of(study, name, report) for name in report.ends},
        "values": _values(study) if size <= _MAX_LISTED else None,
    }


def _ends_of(study: xarray.Dataset, name: str, report: StudyReport) -> dict[str, Any]:
    low, high = report.ends[name]
    if isnan(low.value):
        return {"least": None, "median": None, "largest": None}
    ends = {
        end: {"value": extreme.value, "at": coordinates(study, extreme.place)}
        for end, extreme in (("least", low), ("largest", high))
    }
    return {**ends, "median": report.median(name)}


def _values(study: xarray.Dataset) -> dict[str, Any]:
    """Return the varied parameters and the results at all points, in the order of the axes."""
    flat = study.stack(point=dimension_names(study)) if dimension_names(study) else study.expand_dims("point")
    bounds = [name for name in BOUNDS if name in study.data_vars]
    values = {n: plain_values(flat[n].values) for n in (*varying_parameters(study), *result_names(study), *bounds)}
    if VERDICT in study.data_vars:
        values[VERDICT] = [None if code < 0 else Verdict(code).word for code in flat[VERDICT].values.tolist()]
    return values
