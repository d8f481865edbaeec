"""Description of a wear simulation: its first cycle, its wear, its contacts and its film."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy

from ..contact.verdict import bar_text
from ..core.answers import PAGE, Answer, Column, Row, Table
from ..core.arrays import Numbers
from ..core.display import plain_number
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
from ..core.quantities import QUANTITIES
from ..core.unit_systems import Amount, Sentence, joint_sentence
from ..lubrication.friction import Stribeck
from ..lubrication.lubricant import Lubricant
from .contact_checks import ContactCheck, largest_utilisation, worst_verdict
from .film import Film
from .history import History


def describe_history(history: History, name: str = "") -> Answer:
    """Describe a wear simulation, with the name of its hip at the start of the title."""
    use, film = history.use, history.film
    wear = history.table()._replace(lines=list(_wear_lines(history)))
    contacts = [contact_table(history)] if use.unworn_checks else []
    return Answer(
        title=Sentence("{}{}; {}", f"{name}: " if name else "", joint_sentence(use.joint), use.cycle.name),
        lines=list(_first_cycle(history)),
        tables=[wear, *contacts, *([] if film is None else [film_table(film)])],
        notes=[note for note in history.notes if note != use.cycle.remark],
    )


def _first_cycle(history: History) -> Iterator[Sentence]:
    cycle, first = history.use.cycle, history.use.first
    yield Sentence(
        "{}: slide {} a cycle, pressure times slide {}, cross-shear {}, up to {} and {}",
        f"{cycle.name} ({cycle.remark})" if cycle.remark else cycle.name,
        Amount(first.slide, MILLIMETRES),
        Amount(first.work, Unit("N m")),
        Amount(first.cross_shear, digits=3),
        Amount(first.max_force, NEWTONS),
        Amount(first.max_pressure, MEGAPASCALS),
    )
    rates = Amount(first.volume, CUBIC_MILLIMETRES), Amount(first.depth, MILLIMETRES)
    yield Sentence("unworn: {} and {} a million cycles", *rates)


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
        "estimated numerical error {} of the volume and {} of the depth, {} blocks of cycles",
        Amount(error.volume, PERCENT, 2),
        Amount(error.depth, PERCENT, 2),
        str(history.steps),
    )


def contact_table(history: History) -> Table:
    """List the contacts of largest pressure of each activity, unworn and at each report."""
    columns = [
        *(Column.of_words(head) for head in ("cycles", "activity", "at")),
        Column.of(QUANTITIES["force"]),
        Column.of(QUANTITIES["max_pressure"]),
        Column.of_words("utilisation", "σv/σy"),
        *(Column.of_words(head) for head in ("yield", "valid")),
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
    """Describe validity and largest utilisation of the contacts in one line."""
    model = history.use.contact_model.name
    validity = "valid" if history.contact_valid else "NOT VALID, see the notes"
    return f"contact ({model}): {validity}; {_utilisation_words(history)}"


def _utilisation_words(history: History) -> str:
    """Describe the largest utilisation of the unworn hip and of the last report, with the verdict on both."""
    checks, last = history.use.unworn_checks, history.contact_checks[-1]
    if largest_utilisation(checks) is None or largest_utilisation(last) is None:
        return checks[0].utilisation_note if checks else "nothing is pressed"
    unworn, end = (
        _utilisation_text(max(stage, key=lambda check: check.utilisation or 0.0)) for stage in (checks, last)
    )
    verdict = worst_verdict((*checks, *last)).word
    return f"yield {verdict}: utilisation σv/σy {unworn} unworn, {end} after {plain_number(history.last.cycles)} cycles"


def _utilisation_text(check: ContactCheck) -> str:
    bar = bar_text(check.utilisation_bar, lambda ratio: f"{ratio:.3g}")
    return "not known" if check.utilisation is None else f"{check.utilisation:.3g}{f' ({bar})' if bar else ''}"


def film_table(film: Film) -> Table:
    """List film thicknesses and the film ratio over the cycle, with regime, friction and lubricant."""
    columns = [Column.of_words("film", "film over the cycle"), *map(Column.of_number, ("least", "mean", "largest"))]
    rows = [
        Row([name, *(Amount(number, unit, 3) for number in (known.min(), known.mean(), known.max()))])
        for name, values, unit in _film_courses(film)
        if len(known := values[numpy.isfinite(values)])
    ]
    return Table("film", "Film and friction", columns, rows, list(_film_lines(film)))


def _film_courses(film: Film) -> Sequence[tuple[str, Numbers, Unit]]:
    """Return the names of the rows of the film table, their values over the cycle, and their units."""
    parts: list[tuple[str, Numbers, Unit]] = []
    if film.refreshed_mean is not None and film.core_mean is not None and film.refreshed_share is not None:
        parts = [
            ("mean of the refreshed part", film.refreshed_mean, NANOMETRES),
            ("mean of the core", film.core_mean, NANOMETRES),
            ("refreshed share of the contact", film.refreshed_share, PERCENT),
        ]
    return [
        ("smallest", film.least, NANOMETRES),
        ("at the load", film.central, NANOMETRES),
        *parts,
        ("λ, smallest film over roughness", film.ratio, PLAIN),
        ("Hamrock-Dowson, smallest", film.comparison, NANOMETRES),
    ]


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
