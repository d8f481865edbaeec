"""Description of the bands of a cohort: quantiles at each report, shares at the rim, and influences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import inf, isnan

import numpy

from ..core.answers import Answer, Column, Row, Table
from ..core.arrays import Numbers
from ..core.kinds import MILLIONS, PERCENT
from ..core.quantities import WEAR
from ..core.unit_systems import Amount, Sentence
from .bands import Bands
from .variability import INFLUENCED_RESULTS

_ANY = "any"  # wear coefficient of a row that holds for all coefficients


def describe_bands(bands: Bands) -> Answer:
    """Describe the bands of patients who differ."""
    share, patients = f"{100 * bands.level:g} %", bands.n_patients - bands.n_failed
    among = "predictions from " if bands.subject == "predictions" else ""
    held = f"{share} of {among}{patients} {bands.noun}"
    if bands.shared is not None:
        held = (
            f"{share} of {patients} {bands.noun} for a low, median and high wear coefficient, and {share} of the "
            f"predictions for {_ANY} coefficient,"
        )
    tables = [band_table(bands)] + ([] if bands.indices is None else [_influence_table(bands)])
    return Answer(title=f"{held} lie between", tables=tables, notes=bands.notes)


def describe_cohort(bands: Bands) -> Answer:
    """Describe the bands of a cohort, with the notes on its nominal patient."""
    answer = describe_bands(bands)
    return replace(answer, notes=[*answer.notes, *bands.nominal_notes])


def band_table(bands: Bands) -> Table:
    """List the band of each result at each report, and its median in data; a shared coefficient has rows of its own."""
    per_year, shared, (low, high) = bands.variability.cycles_per_year, bands.shared, bands.ends
    columns = [
        Column.of(WEAR["cycles"]),
        *([] if shared is None else [Column.of_words("coefficient")]),
        *([] if per_year is None else [Column.of(WEAR["years"], digits=3, rank=1)]),
        *(Column.of(WEAR[name], digits=3) for name in INFLUENCED_RESULTS),
        Column.of_number("edge_loading", "edge loading", PERCENT, digits=3),
    ]

    def row(report: int, coefficient: str, quantile: Callable[[str, float], Numbers], edge: float | None) -> Row:
        count, years = bands.counts[report], [] if per_year is None else [bands.counts[report] / per_year]
        ranges = [(quantile(name, low)[report], quantile(name, high)[report]) for name in INFLUENCED_RESULTS]
        return Row([count, *([] if shared is None else [coefficient]), *years, *ranges, edge])

    rows = []
    for report in range(len(bands.counts)):
        if shared is not None:
            rows += [row(report, name, partial(shared.quantile, name), None) for name in shared.values]
        rows.append(row(report, _ANY, bands.quantile, bands.edge_loaded_fraction(report)))
    text = "contact at the rim, worn to it or edge loading: {} after {} cycles"
    lines: list[str] = [
        Sentence(text, Amount(bands.edge_loading(report), PERCENT, 3), Amount(count, MILLIONS))
        for report, count in enumerate(bands.counts)
    ]
    least, largest = (bands.utilisation_quantile(share)[-1] for share in bands.ends)
    patients = bands.variability.coarse_simulation
    reasons = [check.utilisation_note for check in patients.unworn_checks] or ["nothing is pressed"]
    peak = reasons[0] if isnan(least) else f"estimated utilisation σv/σy {least:.3g} to {largest:.3g}"
    model, valid = patients.contact_model.name, f"{100 * bands.valid_fraction(-1):.3g} % of the {bands.subject}"
    lines.append(f"contact ({model}): valid in {valid}; {peak}")
    return Table("bands", "Bands of different patients", columns, rows, lines)


def _influence_table(bands: Bands) -> Table:
    """List the first and total Sobol indices of each result with their intervals, the largest total first."""
    from ..studies.sensitivity_answer import IndexEntry, share_table  # slow to import

    indices, names = bands.indices or {}, list(bands.variability.distributions)
    shares = indices.items()
    entries = [
        IndexEntry(result, [names[i].replace("_", " ")], {key: float(values[number, i]) for key, values in shares})
        for number, result in enumerate(INFLUENCED_RESULTS)
        for i in numpy.argsort(-numpy.nan_to_num(indices["total_order"][number], nan=-inf))
    ]
    return share_table("sobol", "Sobol indices: shares of the variance", ("result", "quantity"), entries)
