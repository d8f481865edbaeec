"""Descriptions of the wear of one hip or of several side by side, of bands of a cohort, and of a fitted coefficient."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import inf, isfinite, isnan
from typing import TYPE_CHECKING

import numpy

from ..contact.verdict import bar_text, ratio_text
from ..core.answers import PAGE, Answer, Cell, Column, Row, Table
from ..core.arrays import Numbers
from ..core.display import counted, plain_number
from ..core.kinds import (
    CUBIC_MILLIMETRES,
    MEGAPASCALS,
    MILLIMETRES,
    MILLIONS,
    NANOMETRES,
    NEWTON_METRES,
    NEWTONS,
    PERCENT,
    PLAIN,
    Unit,
)
from ..core.quantities import QUANTITIES, WEAR
from ..core.unit_systems import Amount, Sentence, holders_of
from ..lubrication.lubricant import Lubricant, Stribeck
from .bands import Bands
from .contact_checks import ContactCheck, largest_utilisation, worst_verdict
from .film import Film
from .history import History
from .variability import INFLUENCED_RESULTS

if TYPE_CHECKING:
    from .wear_fit import WearFit


def describe_history(history: History, name: str = "") -> Answer:
    """Describe a wear simulation, with the name of its hip at the start of the title."""
    use, film, first = history.use, history.film, history.use.first
    first_cycle = Sentence(
        "{}: slide {} a cycle, pressure times slide {}, cross-shear {}, up to {} and {}",
        f"{use.cycle.name} ({use.cycle.remark})" if use.cycle.remark else use.cycle.name,
        Amount(first.slide, MILLIMETRES),
        Amount(first.work, Unit("N m")),
        Amount(first.cross_shear, digits=3),
        Amount(first.max_force, NEWTONS),
        Amount(first.max_pressure, MEGAPASCALS),
    )
    rates = Amount(first.volume, CUBIC_MILLIMETRES), Amount(first.depth, MILLIMETRES)
    wear = history.table()._replace(lines=list(_wear_lines(history)))
    contacts = [contact_table(history)] if use.unworn_checks else []
    return Answer(
        title=Sentence("{}{}; {}", f"{name}: " if name else "", str(use.joint), use.cycle.name),
        lines=[first_cycle, Sentence("unworn: {} and {} a million cycles", *rates)],
        tables=[wear, *contacts, *([] if film is None else [film_table(film)])],
        notes=[note for note in history.notes if note != use.cycle.remark],
    )


def _wear_lines(history: History) -> Iterator[Sentence]:
    use, last, error = history.use, history.last, history.error
    after = Amount(last.cycles, MILLIONS)
    yield Sentence(
        "penetration in a radiograph from the front, {}: {} after {} cycles",
        "by wear" if use.creep is None else "by wear and creep",
        Amount(history.radiographic_penetration(last), MILLIMETRES),
        after,
    )
    for stage, nearest in {"unworn": history.worst, "at the end": last.edge.closest_approach(use.frame)}.items():
        if nearest is not None and nearest.distance > 0:
            distance = Amount(nearest.distance, MILLIMETRES)
            yield Sentence("{}, the contact comes within {} of the rim at {}", stage, distance, nearest.location)
        elif nearest is not None:
            yield Sentence("{}, the contact reaches the rim ({}) at {}", stage, nearest.kind, nearest.location)
    yield Sentence(
        "estimated numerical error {} of the volume and {} of the depth, {} of cycles",
        Amount(error.volume, PERCENT, 2),
        Amount(error.depth, PERCENT, 2),
        counted(history.steps, "block"),
    )


def contact_table(history: History) -> Table:
    """List the contacts of largest pressure of each activity, unworn and at each report."""
    columns = [
        *(Column.of_words(head) for head in ("cycles", "activity", "at")),
        Column.of(QUANTITIES["force"]),
        Column.of(QUANTITIES["max_pressure"]),
        Column.of_words("utilisation", "σv/σy"),
        *(Column.of_words(head) for head in ("strength", "valid")),
    ]
    counts = [plain_number(report.cycles) for report in history.reports]
    ends = ("unworn", counts[-1]) if len(history.use.unworn_checks) > 1 else ()  # of one activity, the line says all
    rows = []
    for stage, checks in zip(("unworn", *counts), (history.use.unworn_checks, *history.contact_checks), strict=True):
        for check in checks:
            words = stage, check.activity, check.instant
            result = _utilisation_text(check), check.verdict.word, check.valid
            rank = 0 if stage in ends else PAGE
            rows.append(Row([*words, check.force, check.max_pressure, *result], check.verdict, rank))
    return Table("contacts", "Validity of the contact", columns, rows, [contact_line(history)])


def contact_line(history: History) -> str:
    """Describe validity and largest utilisation of the contacts, unworn and of the last report, in one line."""
    validity = "valid" if history.contact_valid else "NOT VALID, see the notes"
    checks, last = history.use.unworn_checks, history.contact_checks[-1]
    if largest_utilisation(checks) is None or largest_utilisation(last) is None:
        strength = checks[0].utilisation_note if checks else "nothing is pressed"
    else:
        unworn, end = (
            _utilisation_text(max(stage, key=lambda check: check.utilisation or 0.0)) for stage in (checks, last)
        )
        after = f"{end} after {counted(history.last.cycles, 'cycle')}"
        ratios = [check.pressure_ratio for check in (*checks, *last) if check.pressure_ratio is not None]
        largest = max(ratios, key=lambda ratio: ratio.value, default=None)
        pressure = "" if largest is None else f"; pressure at most {ratio_text(largest)} the allowable pressure"
        limits = "yield" if largest is None else "yield and pressure"
        verdict = worst_verdict((*checks, *last)).word
        strength = f"{limits} {verdict}: utilisation σv/σy {unworn} unworn, {after}{pressure}"
    return f"contact ({history.use.contact_model.name}): {validity}; {strength}"


def _utilisation_text(check: ContactCheck) -> str:
    bar = bar_text(check.utilisation_bar, lambda ratio: f"{ratio:.3g}")
    return "not known" if check.utilisation is None else f"{check.utilisation:.3g}{f' ({bar})' if bar else ''}"


def film_table(film: Film) -> Table:
    """List film thicknesses and the film ratio over the cycle, with regime, friction and lubricant."""
    columns = [Column.of_words("film", "film over the cycle"), *map(Column.of_number, ("least", "mean", "largest"))]
    courses: list[tuple[str, Numbers | None, Unit]] = [
        ("smallest", film.least, NANOMETRES),
        ("at the load", film.central, NANOMETRES),
        ("mean of the refreshed part", film.refreshed_mean, NANOMETRES),
        ("mean of the core", film.core_mean, NANOMETRES),
        ("refreshed share of the contact", film.refreshed_share, PERCENT),
        ("λ, smallest film over roughness", film.ratio, PLAIN),
        ("Hamrock-Dowson, smallest", film.comparison, NANOMETRES),
    ]
    rows = [
        Row([name, *(Amount(number, unit, 3) for number in (known.min(), known.mean(), known.max()))])
        for name, values, unit in courses
        if values is not None and len(known := values[numpy.isfinite(values)])
    ]
    return Table("film", "Film and friction", columns, rows, list(_film_lines(film)))


_STATED = "viscosity", "ball_roughness", "cup_roughness"


def _film_lines(film: Film) -> Iterator[str]:
    summary, lubricant = film.summary(), film.lubricant
    if not summary:
        yield "no film: nothing is pressed"
    else:
        if summary["largest_nm"] is None:
            yield "no film thickness: without a clearance the surfaces do not converge, and no formula applies"
        else:
            state = "valid" if film.valid else "not valid"
            yield f"film by {film.method}: {summary['regime']} lubrication, {state}. {film.note}"
        law = lubricant.friction
        yield Sentence(
            "friction up to {}, {} W, with a coefficient {}",
            Amount(summary["moment_Nmm"], NEWTON_METRES, 3),
            f"{summary['power_W']:.2g}",
            f"of {law.boundary:g} where surfaces touch, by λ" if isinstance(law, Stribeck) else f"of {law:g}",
        )
    roughness = (Amount(size, Unit("µm", 1e3)) for size in (lubricant.ball_roughness, lubricant.cup_roughness))
    viscosity = f"{1e3 * lubricant.viscosity:g} mPa s"
    defaults = [name for name in _STATED if getattr(lubricant, name) == getattr(Lubricant(), name)]
    assumed = f"; by default: {', '.join(defaults)}" if defaults else ""
    yield Sentence(f"film with viscosity {{}}, roughness Ra {{}} (ball) and {{}} (cup){assumed}", viscosity, *roughness)


_COMPARED = ("volume", "depth", "penetration", "max_pressure")
_BANDED = ("volume", "penetration")


@dataclass(frozen=True, kw_only=True)
class HipRun:
    """Simulation of one hip with its bands, if any, and its name in tables and figures, such as that of its file."""

    name: str
    history: History
    bands: Bands | None = None


def describe_hips(runs: Sequence[HipRun]) -> Answer:
    """Describe several hips: one below the other at each report."""
    columns = [Column.of(QUANTITIES["cycles"], digits=6), Column.of_words("hip")]
    columns += [Column.of(QUANTITIES[name]) for name in _COMPARED] + [Column.of_words("edge_loading", "edge loading")]
    if any(run.bands is not None for run in runs):
        columns += [Column.of(QUANTITIES[name], head=f"{name} 95 %", digits=3) for name in _BANDED]
    rows = []
    for cycles in sorted({report.cycles for run in runs for report in run.history.reports}):
        for run in runs:
            for number, report in enumerate(run.history.reports):
                if report.cycles == cycles:
                    cells: list[Cell] = [cycles, run.name, *(float(getattr(report, name)) for name in _COMPARED)]
                    cells += [bool(report.edge_loaded.any()), *(_band(run, name, number) for name in _BANDED)]
                    rows.append(Row(cells[: len(columns)]))
    lines = [
        Sentence(
            "{}: contact {}; estimated numerical error of the volume {}",
            run.name,
            "valid" if run.history.valid else "NOT VALID, see its notes",
            Amount(run.history.error.volume, PERCENT, 2),
        )
        for run in runs
    ]
    named_uses = [(run.name, run.history.use) for run in runs]
    joints = [Sentence("{}: {}; {}", name, str(use.joint), use.cycle.name) for name, use in named_uses]
    noted = ((run.name, (*run.history.notes, *(run.bands.notes if run.bands else ()))) for run in runs)
    notes = [  # each with the names of the hips that have it, unless all have it
        note if len(names) == len(runs) else Sentence("{}: {}", ", ".join(names), note)
        for note, names in holders_of(noted).items()
    ]
    wear = Table("hips", "Wear", columns, rows, lines)
    return Answer(title="hips side by side", lines=joints, tables=[wear], notes=notes)


def _band(run: HipRun, name: str, report: int) -> Cell:
    return None if run.bands is None else tuple(float(end[report]) for end in run.bands.band(name))


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
    from ..studies.variance_shares import IndexEntry, share_table  # slow to import

    indices, names = bands.indices or {}, list(bands.variability.distributions)
    shares = indices.items()
    entries = [
        IndexEntry(result, [names[i].replace("_", " ")], {key: float(values[number, i]) for key, values in shares})
        for number, result in enumerate(INFLUENCED_RESULTS)
        for i in numpy.argsort(-numpy.nan_to_num(indices["total_order"][number], nan=-inf))
    ]
    return share_table("sobol", "Sobol indices: shares of the variance", ("result", "quantity"), entries)


def describe_wear_fit(fit: WearFit) -> Answer:
    """Describe a fitted wear coefficient."""
    use = fit.simulation
    law = str(getattr(use.wear, "name", type(use.wear).__name__))
    title, unit = "{}; {}: coefficient of the wear law {}", Unit(fit.unit)
    columns = [Column.of_words("coefficient"), Column.of_number("best", unit=unit)]
    columns += [Column.of_number("band", "95 %", unit)]
    rows = [Row(["coefficient", fit.coefficient, (fit.low, fit.high) if isfinite(fit.high) else None])]
    if len(fit.stations) > 1:
        rows += [Row([station, coefficient, None]) for station, coefficient in fit.stations.items()]
    tables = [Table("coefficient", "Coefficient", columns, rows)]
    if fit.readings:
        heads = [Column.of_words("rate", "the same as another rate"), Column.of_number("coefficient", unit=unit)]
        tables.append(Table("readings", "Rates of other kinds", heads, list(map(Row, fit.readings.items()))))
    return Answer(
        title=Sentence(title, str(use.joint), use.cycle.name, repr(law)),
        tables=[*tables, _measured(fit)],
        notes=fit.notes,
    )


def _measured(fit: WearFit) -> Table:
    several = len(fit.specimens) > 1
    columns = [Column.of_words("measured"), Column.of_number("value"), Column.of_number("fit")]
    columns += [Column.of_words("station")] if several else []
    stations = {int(row): station for station, indices in fit.specimens.items() for row in indices}
    rows: list[Row] = []
    for measured, results in zip(fit.data, fit.results, strict=True):
        factor = measured.density or 1.0
        unit = Unit(measured.unit if measured.density is None else measured.unit.replace("mm³", "mg"), factor)
        for number, (value, result) in enumerate(zip(measured.values, results, strict=True)):
            after = "" if measured.rate else f" after {counted(measured.cycles[number], 'cycle')}"
            title = measured.description if measured.rate else f"{measured.measured_quantity}{after}"
            cells: list[Cell] = [title, Amount(float(value), unit), Amount(float(result), unit)]
            rows.append(Row([*cells, stations[len(rows)]] if several else cells))
    return Table("measured", "Measured wear", columns, rows)
