"""Description of a study: least, median and largest value of each result, and the reasons of points without one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..contact.verdict import Verdict
from ..core.answers import Answer
from .extremes import StudyReport, end_table, plain_values, result_names, varying_parameters
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
    verdicts = ", ".join(f"{count} {verdict.word}" for verdict, count in report.verdicts.items() if count)
    line = f"{study.status.size} points, {report.valid} of them valid"
    table = end_table(study, report.quantities(study), "study", "Study")
    return Answer(
        title="; ".join([f"{study.attrs['model']}, {shape or 'one point'}", *_comments(study)]),
        lines=held_lines(held_in(study)),
        tables=[table._replace(lines=[f"{line}; yield stress: {verdicts}" if verdicts else line])],
        notes=report.notes(study),
    )


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
        "quantities": report.quantities(study),
        "values": _values(study) if size <= _MAX_LISTED else None,
    }


def _values(study: xarray.Dataset) -> dict[str, Any]:
    """Return the varied parameters and the results at all points, in the order of the axes."""
    flat = study.stack(point=dimension_names(study)) if dimension_names(study) else study.expand_dims("point")
    bounds = [name for name in BOUNDS if name in study.data_vars]
    values = {n: plain_values(flat[n].values) for n in (*varying_parameters(study), *result_names(study), *bounds)}
    if VERDICT in study.data_vars:
        values[VERDICT] = [None if code < 0 else Verdict(code).word for code in flat[VERDICT].values.tolist()]
    return values
