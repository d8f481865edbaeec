"""Identification from measurements, in a terminal."""

from __future__ import annotations

from rich.table import Table

from ..core.kinds import Unit
from ..identify.measured import MEASURED
from ..identify.posterior import CONVERGED, Posterior
from ..identify.result import IdentificationResult
from ..identify.sensitivity import Sensitivity
from .terminal import console, print_folded

_ROWS = 5


def print_identified(found: IdentificationResult, drawn: Posterior | None) -> None:
    """Print the unknowns with their bands, products, fit, sensitivity to machine errors, and the next measurement."""
    terminal, information = console(), found.information
    print_folded(terminal, f"{found.model.name} through {_counted(found)}", "bold")
    terminal.print(_table(found, drawn))
    rank = f"rank {information.rank} of {len(found.transform.names)}, condition {information.condition:.2g}"
    print_folded(terminal, f"information of {rank}; {_scatter(found)}", "")
    if drawn is not None:
        print_folded(terminal, _chains(drawn), "")
    if found.sensitivity:
        terminal.print(_sensitivity(found))
    terminal.print(_next(found))
    for note in found.notes:
        print_folded(terminal, note, "dim")


def _counted(found: IdentificationResult) -> str:
    sets = ", ".join(f"{len(each)} x {each.quantity}" for each in found.data)
    return f"{len(found.misfit.value)} values ({sets})"


def _scatter(found: IdentificationResult) -> str:
    if found.freedom <= 0:
        return "as many values as unknowns: the quality of the fit cannot be tested"
    return f"the data scatter {found.spread:.2f} times as far as their uncertainties say"


def _chains(drawn: Posterior) -> str:
    worst, fewest = max(drawn.r_hat.values()), min(drawn.effective.values())
    verdict = "converged" if drawn.converged else f"not converged, which is up to {CONVERGED}"
    return (
        f"{len(drawn.samples)} samples, as good as {fewest:.0f} independent ones; acceptance {drawn.acceptance:.2f}, "
        f"R-hat {worst:.4f}: {verdict}"
    )


def _table(found: IdentificationResult, drawn: Posterior | None) -> Table:
    table = _plain_table("", "best", "95 %", "unit", *(("posterior",) if drawn else ()))
    for unknown, each in zip(found.transform.unknowns, found.estimates.values(), strict=True):
        unit = unknown.quantity.shown
        best = _numbers(unit.factor, each.value) if each.identifiable else "not identifiable"
        band = _band(unit.factor, each.low, each.high)
        table.add_row(each.name, best, band, unit.text, *_drawn(drawn, each.name, unit))
    for product in found.information.products:
        table.add_row(product.name, _numbers(1.0, product.value), _band(1.0, product.low, product.high), product.unit)
    return table


def _plain_table(*heads: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for place, head in enumerate(heads):
        table.add_column(head, justify="left" if place == 0 or head == "unit" else "right", no_wrap=place == 0)
    return table


def _drawn(drawn: Posterior | None, name: str, unit: Unit) -> tuple[str, ...]:
    return () if drawn is None else (_band(unit.factor, *drawn.band(name)),)


def _band(factor: float, low: float, high: float) -> str:
    return f"{_numbers(factor, low)} to {_numbers(factor, high)}"


def _numbers(factor: float, number: float) -> str:
    return f"{factor * number:.4g}"


def _sensitivity(found: IdentificationResult) -> Table:
    """Make the table of shifts by machine errors, with ratios to half bands."""
    unknowns = found.transform.unknowns
    heads = [f"Δ{each.quantity.symbol}, {each.quantity.shown.text}".removesuffix(", ") for each in unknowns]
    table = _plain_table("if the machine had", *heads)
    for error in found.sensitivity:
        shifts = [_shift(found, error, index) for index in range(len(unknowns))]
        table.add_row(error.title, *shifts)
    return table


def _shift(found: IdentificationResult, error: Sensitivity, index: int) -> str:
    """Format a shift and its ratio to half a band."""
    unknown = found.transform.unknowns[index]
    ratio = found.shift_ratio(error, unknown.name)
    if not found.estimates[unknown.name].identifiable:
        return "-"
    return f"{unknown.quantity.shown.factor * error.shifts[unknown.name]:+.3g} ({ratio:.1f}x)" if ratio > 5e-3 else "0"


def _next(found: IdentificationResult) -> Table:
    """The best load of each quantity."""
    unknowns = found.transform.unknowns
    table = _plain_table(
        "measure next", "at", "to within", "bits", *(f"{each.quantity.symbol} left" for each in unknowns)
    )
    for gain in found.next.best_by_quantity[:_ROWS]:
        candidate, quantity = gain.candidate, MEASURED[gain.candidate.quantity]
        within = f"{_short(candidate.uncertainty * quantity.shown.factor)} {quantity.shown.text}"
        load = "-" if candidate.force is None else f"{candidate.force:.4g} N"
        left = [f"{100 * gain.uncertainty_ratio[each.name]:.0f} %" for each in unknowns]
        table.add_row(quantity.title, load, within, f"{gain.bits:.2f}", *left)
    return table


def _short(number: float) -> str:
    """Two digits, without an exponent where they are few."""
    return f"{float(f'{number:.2g}'):g}"
