"""Description of a design map: least and largest values within the limits, and the shares of the verdicts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy

from ..contact.verdict import Verdict
from ..core.answers import Answer, Table
from ..core.kinds import PERCENT
from ..core.unit_systems import Amount, Sentence
from .extremes import coordinates, end_table, result_names
from .file_formats import dimension_names
from .limits import Limit, allowed, count_verdicts, refusal_reason, undecided_reason
from .metadata import held_in, held_lines

if TYPE_CHECKING:
    import xarray


def describe_map(study: xarray.Dataset, limits: Sequence[Limit]) -> Answer:
    """Describe the kept designs of a map; ValueError as of `map_summary`."""
    return Answer(
        title=f"design map, model {study.attrs['model']}",
        tables=[map_table(study, limits)],
    )


def map_table(study: xarray.Dataset, limits: Sequence[Limit]) -> Table:
    """List the ends of each result of the kept designs; ValueError as of `map_summary`."""
    summary = map_summary(study, limits)
    ends = {name: dict(zip(("least", "largest"), pair, strict=True)) for name, pair in summary["quantities"].items()}
    table = end_table(study, ends, "map", "Design map")
    counts = summary["verdicts"]
    shares = [(Amount(n / study.status.size, PERCENT, 3), word) for word, n in counts.items() if n]
    template = ", ".join(["{} {}"] * len(shares)) + "; {}" * len(limits)
    lines = [Sentence(f"of the map: {template}", *(part for share in shares for part in share), *map(str, limits))]
    if counts[Verdict.UNDECIDED.word]:
        reason = undecided_reason(study, limits)
        lines.append(Sentence("undecided: {}; the table has the kept designs only", reason))
    return table._replace(lines=lines + held_lines(held_in(study)))


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
