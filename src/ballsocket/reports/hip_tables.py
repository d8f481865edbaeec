"""Tables and sentences about a wear simulation, for its page and for a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from math import inf, isnan
from typing import Any

import numpy
from rich.table import Table
from rich.text import Text

from ..contact.verdict import bar_text
from ..core.arrays import Numbers
from ..core.display import plain_number
from ..hip.bands import Bands
from ..hip.contact_checks import ContactCheck, largest_utilisation, worst_verdict
from ..hip.film import Film
from ..hip.history import History
from ..hip.variability import INFLUENCED_RESULTS
from ..lubrication.friction import Stribeck
from .terminal import Terminal, print_columns, print_folded, print_joint, text_table
from .unit_systems import Units

_WEAR_UNITS = {
    "cycles": "million",
    "volume": "mm³",
    "depth": "mm",
    "penetration": "mm",
    "pmax": "MPa",
    "creep": "mm",
    "to the rim": "mm",
}
"""Units of the columns of the wear table by their heads."""

CONTACT_HEADS = ("cycles", "activity", "at", "F [N]", "pmax [MPa]", "σv/σy", "yield", "valid")
"""Heads of `contact_rows`."""

_BAND_UNITS = {
    "cycles": "million",
    "years": "",
    "volume": "mm³",
    "depth": "mm",
    "penetration": "mm",
    "edge loading": "",
}
"""Units of the columns of `band_rows` by their heads."""

_ANY = "any"
"""Wear coefficient of a row that holds for all coefficients."""


def contact_line(history: History) -> str:
    """Describe validity and largest utilisation of the contacts in one line."""
    model = history.use.contact_model.name
    validity = "valid" if history.contact_valid else "NOT VALID, see the notes"
    return f"contact ({model}): {validity}; {_utilisation_words(history)}"


def _utilisation_words(history: History) -> str:
    """Describe the largest utilisation of the unworn hip and of the last report, with the verdict on both."""
    checks, last = history.use.unworn_checks, history.contact_checks[-1]
    if largest_utilisation(checks) is None or largest_utilisation(last) is None:
        return checks[0].utilisation_note if checks else "nothing is pressed"
    worst = (max(stage, key=lambda check: check.utilisation or 0.0) for stage in (checks, last))
    unworn, end = map(_utilisation_text, worst)
    verdict = worst_verdict((*checks, *last)).word
    return f"yield {verdict}: utilisation σv/σy {unworn} unworn, {end} after {plain_number(history.last.cycles)} cycles"


def _utilisation_text(check: ContactCheck) -> str:
    bar = bar_text(check.utilisation_bar, lambda ratio: f"{ratio:.3g}")
    return "not known" if check.utilisation is None else f"{check.utilisation:.3g}{f' ({bar})' if bar else ''}"


def contact_rows(history: History) -> Iterator[tuple[str, ...]]:
    """List the checked contacts, unworn and at each report: the cells below `CONTACT_HEADS`."""
    stages = [("unworn", history.use.unworn_checks)]
    stages += [
        (plain_number(report.cycles), checks)
        for report, checks in zip(history.reports, history.contact_checks, strict=True)
    ]
    for stage, checks in stages:
        for check in checks:
            numbers = f"{check.force:.4g}", f"{check.max_pressure:.4g}", _utilisation_text(check)
            yield stage, check.activity, check.instant, *numbers, check.verdict.word, "yes" if check.valid else "no"


def band_summary(bands: Bands) -> str:
    """Describe what a band holds: the share of the patients or of the predictions."""
    share, patients = f"{100 * bands.level:g} %", bands.n_patients - bands.n_failed
    if bands.shared is None:
        among = "predictions from " if bands.subject == "predictions" else ""
        return f"{share} of {among}{patients} {bands.noun}"
    return (
        f"{share} of {patients} {bands.noun} for a low, median and high wear coefficient, and {share} of the "
        f"predictions for {_ANY} coefficient,"
    )


def band_units(bands: Bands) -> dict[str, str]:
    """Return table heads with units; a shared coefficient has a column, and edge loading has a separate line."""
    if bands.shared is None:
        return _BAND_UNITS
    (cycles, million), (years, no_unit), *more, _ = _BAND_UNITS.items()
    return {cycles: million, years: no_unit, "coefficient": "", **dict(more)}


def band_heads(bands: Bands) -> list[str]:
    """Return table heads with units in brackets."""
    return [f"{head} [{unit}]" if unit else head for head, unit in band_units(bands).items()]


def band_rows(bands: Bands, quantiles: Sequence[float]) -> Iterator[tuple[str, ...]]:
    """List the quantiles of each result at each report; `shares` are the shares of patients below each quantile."""
    cycles_per_year = bands.variability.cycles_per_year
    for report, count in enumerate(bands.counts):
        years = "-" if cycles_per_year is None else f"{count / cycles_per_year:.3g}"
        time = f"{count / 1e6:g}", years
        ranges = [
            _range_text(bands.quantile(name, level)[report] for level in quantiles) for name in INFLUENCED_RESULTS
        ]
        if bands.shared is None:
            yield (*time, *ranges, f"{100 * bands.edge_loaded_fraction(report):.3g} %")
            continue
        for coefficient in bands.shared.values:
            quantile = partial(bands.shared.quantile, coefficient)
            yield (
                *time,
                coefficient,
                *(_range_text(quantile(name, level)[report] for level in quantiles) for name in INFLUENCED_RESULTS),
            )
        yield (*time, _ANY, *ranges)


def _range_text(numbers: Iterable[float]) -> str:
    return " to ".join(f"{number:.3g}" for number in numbers)


def rim_lines(bands: Bands) -> Iterator[str]:
    """Describe the shares with a contact at the rim, and with edge loading where the table has no column for it."""
    shares = {"contact at the rim, worn to it or edge loading": bands.edge_loading}
    if bands.shared is not None:
        shares["edge loading"] = bands.edge_loaded_fraction
    counts = [f"after {count / 1e6:g} million cycles" for count in bands.counts]
    for title, share in shares.items():
        percentages = [f"{100 * share(report):.3g} %" for report in range(len(counts))]
        yield f"{title}: {', '.join(map(' '.join, zip(percentages, counts, strict=True)))}"


def band_contact_line(bands: Bands) -> str:
    """Describe validity and utilisation of the contacts from the first cycle to the last report."""
    tail = (1 - bands.level) / 2
    low, high = (bands.utilisation_quantile(share)[-1] for share in (tail, 1 - tail))
    reasons = [check.utilisation_note for check in bands.variability.coarse_simulation.unworn_checks] or [
        "nothing is pressed"
    ]
    peak = reasons[0] if isnan(low) else f"estimated utilisation σv/σy {low:.3g} to {high:.3g}"
    model = bands.variability.coarse_simulation.contact_model.name
    return f"contact ({model}): valid in {100 * bands.valid_fraction(-1):.3g} % of the {bands.subject}; {peak}"


def sobol_lines(bands: Bands) -> Iterator[str]:
    """Describe the first-order and total Sobol indices of each result in one line, largest total first."""
    if bands.indices is None:
        return
    for row, result in enumerate(INFLUENCED_RESULTS):
        first, values = (bands.indices[f"{order}_order"][row] for order in ("first", "total"))
        low, high = (bands.indices[f"total_order_{end}"][row] for end in ("low", "high"))
        order = numpy.argsort(-numpy.nan_to_num(values, nan=-inf))
        names = list(bands.variability.distributions)
        indices = ", ".join(
            f"{names[i]} {first[i]:.2f} and {values[i]:.2f} ({low[i]:.2f} to {high[i]:.2f})" for i in order
        )
        yield f"Sobol indices of {result} (first and total order): {indices}"


def print_hip(history: History, units: Units = Units.SI, name: str = "") -> None:
    """Print the name of a hip, if any, the first cycle, the wear at each report, contacts, film, accuracy and notes."""
    terminal, use, first = Terminal(units), history.use, history.use.first
    print_joint(terminal, use.joint, start=f"{name}: " if name else "")
    remark = f" ({use.cycle.remark})" if use.cycle.remark else ""
    print_folded(
        terminal,
        f"{use.cycle.name}{remark}: slide {first.slide:.4g} mm a cycle, pressure times slide {first.work:.4g} N m, "
        f"cross-shear {first.cross_shear:.3g}, up to {plain_number(first.max_force)} N and "
        f"{first.max_pressure:.4g} MPa",
        "",
    )
    print_folded(terminal, f"unworn: {first.volume:.4g} mm³ and {first.depth:.4g} mm a million cycles", "")
    print_columns(terminal, _wear_table(history))
    print_folded(terminal, radiograph_line(history), "")
    if history.use.ball_wear is not None:
        last = history.last
        ball_wear = f"{last.ball_volume:.4g} mm³ and {last.ball_depth:.3g} mm"
        print_folded(terminal, f"the ball: {ball_wear} after {last.cycles / 1e6:g} million cycles", "")
    print_folded(terminal, contact_line(history), "")
    if len(use.unworn_checks) > 1:
        rows, count = list(contact_rows(history)), len(use.unworn_checks)
        shown = (*rows[:count], *rows[-count:])  # unworn and at the end
        print_columns(terminal, text_table(CONTACT_HEADS, shown, left=CONTACT_HEADS[1:3], folded=("at",)))
    if history.film is not None:
        _print_film(terminal, history.film)
    accuracy = f"estimated numerical error of the volume {100 * history.error.volume:.2g} %"
    print_folded(terminal, f"{accuracy}, {history.steps} blocks of cycles", "dim")
    print_notes([note for note in history.notes if note != use.cycle.remark], units)


def print_bands(bands: Bands, units: Units = Units.SI) -> None:
    """Print the bands of patients who differ as a table, the Sobol indices of each result, and notes."""
    terminal = Terminal(units)
    print_folded(terminal, f"{band_summary(bands)} lie between", "bold")
    table = table_with_units(band_units(bands))
    tail = (1 - bands.level) / 2
    for row in band_rows(bands, (tail, 1 - tail)):
        table.add_row(*row)
    print_columns(terminal, table)
    for line in (*rim_lines(bands), band_contact_line(bands), *sobol_lines(bands)):
        print_folded(terminal, line, "")
    print_notes(bands.notes, units)


def table_with_units(heads: Mapping[str, str], left: Sequence[str] = ()) -> Table:
    """Make an empty table from heads and their units; columns in `left` are aligned to the left."""
    return text_table(heads, [[Text(unit, style="dim") for unit in heads.values()]], left)


def radiograph_line(history: History) -> str:
    """Describe the penetration of the last report in the plane of a radiograph."""
    share = "by wear" if history.use.creep is None else "by wear and creep"
    penetration = (
        f"{history.radiographic_penetration(history.last):.4g} mm after {history.last.cycles / 1e6:g} million cycles"
    )
    return f"penetration in a radiograph from the front, {share}: {penetration}"


def print_notes(notes: Iterable[str], units: Units = Units.SI) -> None:
    """Print notes, each on its own line."""
    terminal = Terminal(units)
    for note in notes:
        print_folded(terminal, note, "dim")


def _wear_table(history: History) -> Table:
    cycles_per_year = history.use.cycle.per_year
    table = table_with_units({**({} if cycles_per_year is None else {"time": "years"}), **wear_units(history)})
    for report, (*cells, rim) in zip(history.reports, wear_rows(history), strict=True):
        time = () if cycles_per_year is None else (f"{report.cycles / cycles_per_year:.4g}",)
        table.add_row(*time, *cells, f"{rim:.4g}")
    return table


def wear_units(history: History) -> dict[str, str]:
    """Return the heads of the wear table with their units, without creep for a liner that does not creep."""
    return {head: unit for head, unit in _WEAR_UNITS.items() if history.use.creep is not None or head != "creep"}


def wear_rows(history: History) -> Iterator[tuple[Any, ...]]:
    """Yield cycles and wear of each report as texts, with the creep of a liner that creeps, and the edge distance."""
    for report in history.reports:
        creep = () if history.use.creep is None else (report.creep_depth,)
        numbers = (report.volume, report.depth, report.penetration, report.max_pressure, *creep)
        rim = report.edge_distance.min(initial=inf)
        yield (f"{report.cycles / 1e6:g}", *(f"{number:.4g}" for number in numbers), rim)


def _print_film(terminal: Terminal, film: Film) -> None:
    """Print the film over the cycle with thicknesses in nm, its regime and friction, and its lubricant."""
    if len(film.phases):
        heads = ("film over the cycle", "least", "mean", "largest")
        rows = [
            (name, *(f"{number:.3g}" for number in (known.min(), known.mean(), known.max())))
            for name, values in _film_rows(film)
            if len(known := values[numpy.isfinite(values)])
        ]
        print_columns(terminal, text_table(heads, rows, left=heads[:1], gap=1))
    for line in _film_lines(film):
        print_folded(terminal, line, "")
    lubricant = film.lubricant
    ball, cup = (f"{1e3 * roughness:g} µm" for roughness in (lubricant.ball_roughness, lubricant.cup_roughness))
    viscosity = f"viscosity {1e3 * lubricant.viscosity:g} mPa s"
    print_folded(terminal, f"assumed for the film: {viscosity}, roughness Ra {ball} (ball) and {cup} (cup)", "dim")


def _film_rows(film: Film) -> Iterator[tuple[str, Numbers]]:
    """Yield the names of the rows of the film table, and their values over the cycle."""
    yield "smallest [nm]", 1e6 * film.least
    yield "at the load [nm]", 1e6 * film.central
    if film.refreshed_mean is not None and film.core_mean is not None and film.refreshed_share is not None:
        yield "mean of the refreshed part [nm]", 1e6 * film.refreshed_mean
        yield "mean of the core [nm]", 1e6 * film.core_mean
        yield "refreshed share of the contact [%]", 100 * film.refreshed_share
    yield "λ, smallest film over roughness", film.ratio
    yield "Hamrock-Dowson, smallest [nm]", 1e6 * film.comparison


def _film_lines(film: Film) -> Iterator[str]:
    summary = film.summary()
    if not summary:
        yield "no film: nothing is pressed"
        return
    if summary["largest_nm"] is None:
        yield "no film thickness: without a clearance the surfaces do not converge, and no formula applies"
    else:
        state = "valid" if film.valid else "not valid"
        yield f"film by {film.method}: {summary['regime']} lubrication, {state}. {film.note}"
    law = film.lubricant.friction
    coefficient = f"of {law.boundary:g} where surfaces touch, by λ" if isinstance(law, Stribeck) else f"of {law:g}"
    friction = f"friction up to {summary['moment_Nmm'] / 1e3:.3g} N m, {summary['power_W']:.2g} W"
    yield f"{friction}, with a coefficient {coefficient}"
