"""Description of an identification: estimates with their bands, machine errors, and the next measurement."""

from __future__ import annotations

from dataclasses import replace

from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.display import counted
from ..core.kinds import PERCENT, Unit
from ..core.quantities import LOADS
from ..core.unit_systems import Amount
from .measured import MEASURED
from .posterior import CONVERGED, Posterior
from .result import IdentificationResult

_MAX_PROPOSALS = 5
_LEAST_SHIFT_RATIO = 5e-3  # shift over half a band, below which a shift is listed as zero


def describe_identification(result: IdentificationResult, posterior: Posterior | None = None) -> Answer:
    """Describe the unknowns with their bands, products, fit, neglected machine errors, and the next measurement."""
    sets = ", ".join(f"{len(data)} x {data.quantity}" for data in result.data)
    remarks = dict.fromkeys(data.remark for data in result.data if data.remark)
    return Answer(
        title="; ".join(
            [f"{result.model.name} fitted to {counted(len(result.misfit.value), 'value')} ({sets})", *remarks]
        ),
        tables=[
            _estimates(result, posterior),
            *([_machine_errors(result)] if result.sensitivity else []),
            _proposals(result),
        ],
        notes=[note for note in result.notes if note not in remarks],
    )


def _estimates(result: IdentificationResult, posterior: Posterior | None) -> Table:
    heads = ["best", "95 % from", "95 % to", *(["posterior from", "posterior to"] if posterior else [])]
    columns = [Column.of_words("unknown"), *map(Column.of_number, heads)]
    rows = []
    for unknown, estimate in zip(result.transform.unknowns, result.estimates.values(), strict=True):
        unit, ends = unknown.quantity.shown, [estimate.low, estimate.high]
        ends += [] if posterior is None else posterior.band(estimate.name)
        best: Cell = Amount(estimate.value, unit) if estimate.identifiable else "not identifiable"
        rows.append(Row([estimate.name, best, *(Amount(end, unit) for end in ends)]))
    missing = [None] * (len(heads) - 3)
    for product in result.information.products:
        numbers = (product.value, product.low, product.high)
        rows.append(Row([product.name, *(Amount(number, Unit(product.unit)) for number in numbers), *missing]))
    information = result.information
    rank = f"rank {information.rank} of {len(result.transform.names)}, condition {information.condition:.2g}"
    if result.freedom <= 0:
        scatter = "as many values as unknowns: the quality of the fit cannot be tested"
    elif all(data.has_unknown_noise for data in result.data):
        scatter = "uncertainty of the data estimated from their scatter"
    else:
        widening = result.misfit.widening
        widened = f"; the bands are {widening:.2f} times as wide" if widening > 1 else ""
        scatter = f"scatter of the data {result.spread:.2f} times the stated uncertainties{widened}"
    lines = [f"information of {rank}; {scatter}"]
    if posterior is not None:
        worst, fewest = max(posterior.r_hat.values()), min(posterior.effective.values())
        verdict = "converged" if posterior.converged else f"not converged, which is up to {CONVERGED}"
        lines.append(
            f"{len(posterior.samples)} samples, as good as {fewest:.0f} independent ones; "
            f"acceptance {posterior.acceptance:.2f}, R-hat {worst:.4f}: {verdict}"
        )
    return Table("estimates", "Estimates", columns, rows, lines)


def _machine_errors(result: IdentificationResult) -> Table:
    columns, rows = [Column.of_words("error", "if the machine had")], []
    for name, unknown in zip(result.transform.names, result.transform.unknowns, strict=True):
        head = f"Δ{unknown.quantity.symbol}"
        columns.append(replace(Column.of(unknown.quantity, head=head, digits=3), key=name, name=name))
        columns.append(Column.of_number(f"{name}_ratio", "ratio", digits=2))
    for error in result.sensitivity:
        cells: list[Cell] = [error.title]
        for name in result.transform.names:
            ratio = result.shift_ratio(error, name)
            if not result.estimates[name].identifiable:
                cells += [None, None]
            else:
                cells += [error.shifts[name], ratio] if ratio > _LEAST_SHIFT_RATIO else [0.0, 0.0]
        rows.append(Row(cells))
    lines = ["ratio: of the shift to half the band"]
    return Table("sensitivity", "Neglected errors of the machine", columns, rows, lines)


def _proposals(result: IdentificationResult) -> Table:
    columns = [Column.of_words("quantity", "measure next"), replace(Column.of(LOADS["force"], head="at"), title="at")]
    columns += [Column.of_number("uncertainty", "to within"), Column.of_number("bits", digits=3)]
    for name, unknown in zip(result.transform.names, result.transform.unknowns, strict=True):
        columns.append(Column.of_number(f"{name}_left", f"{unknown.quantity.symbol} left", PERCENT, digits=3))
    rows = []
    for gain in result.next.best_by_quantity[:_MAX_PROPOSALS]:
        candidate, quantity = gain.candidate, MEASURED[gain.candidate.quantity]
        within = Amount(candidate.uncertainty, quantity.shown, 2)
        ratios = [gain.uncertainty_ratio[name] for name in result.transform.names]
        rows.append(Row([quantity.title, candidate.force, within, gain.bits, *ratios]))
    return Table("experiment", "Next measurement", columns, rows)
