"""Results of a wear simulation in a terminal."""

from __future__ import annotations

from collections.abc import Iterable

from rich.table import Table

from ..hip.bands import Bands
from ..hip.history import History
from .hip_tables import (
    CONTACT_HEADS,
    band_contact_line,
    band_rows,
    band_summary,
    band_units,
    contact_line,
    contact_rows,
    rim_lines,
    sobol_lines,
)
from .terminal import console, print_folded

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


def print_hip(history: History) -> None:
    """Print the first cycle, the wear at each report, contacts, film, accuracy and notes."""
    terminal, use, first = console(), history.use, history.use.first
    print_folded(terminal, str(use.joint), "bold")
    print_folded(
        terminal,
        f"{use.cycle.name}: slide {first.slide:.4g} mm a cycle, pressure times slide {first.work:.4g} N m, "
        f"cross-shear {first.cross_shear:.3g}, up to {first.max_force:.4g} N and {first.max_pressure:.4g} MPa",
        "",
    )
    print_folded(terminal, f"unworn: {first.volume:.4g} mm³ and {first.depth:.4g} mm a million cycles", "")
    terminal.print(_wear_table(history))
    if history.use.ball_wear is not None:
        last = history.last
        ball_wear = f"{last.ball_volume:.4g} mm³ and {last.ball_depth:.3g} mm"
        print_folded(terminal, f"the ball: {ball_wear} after {last.cycles / 1e6:g} million cycles", "")
    print_folded(terminal, contact_line(history), "")
    if len(history.use.unworn_checks) > 1:
        terminal.print(_contact_table(history))
    print_folded(terminal, _film_line(history), "")
    accuracy = f"volume within {100 * history.error.volume:.2g} % of the same model in the finest steps"
    print_folded(terminal, f"{accuracy}, in {history.steps} blocks", "dim")
    print_notes(history.notes)


def print_bands(bands: Bands) -> None:
    """Print the bands of patients who differ as a table, the Sobol indices of each result, and notes."""
    terminal = console()
    print_folded(terminal, f"{band_summary(bands)} lie between", "bold")
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for head in band_units(bands):
        table.add_column(head, justify="right", overflow="fold")
    table.add_row(*band_units(bands).values(), style="dim")
    tail = (1 - bands.level) / 2
    for row in band_rows(bands, (tail, 1 - tail)):
        table.add_row(*row)
    terminal.print(table)
    for line in (*rim_lines(bands), band_contact_line(bands), *sobol_lines(bands)):
        print_folded(terminal, line, "")
    print_notes(bands.notes)


def print_notes(notes: Iterable[str]) -> None:
    """Print notes, each on its own line."""
    terminal = console()
    for note in notes:
        print_folded(terminal, note, "dim")


def _contact_table(history: History) -> Table:
    """Lay out the worst contact of each activity, unworn and at the end."""
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for head in CONTACT_HEADS:
        table.add_column(head, justify="left" if head in CONTACT_HEADS[1:3] else "right", no_wrap=head != "at")
    rows = list(contact_rows(history))
    count = len(history.use.unworn_checks)
    for row in (*rows[:count], *rows[-count:]):
        table.add_row(*row)
    return table


def _wear_table(history: History) -> Table:
    """Lay out the wear at each report."""
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    cycles_per_year = history.use.cycle.per_year
    heads = _WEAR_UNITS if cycles_per_year is None else {"time": "years", **_WEAR_UNITS}
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_row(*heads.values(), style="dim")
    for report in history.reports:
        rim = report.edge_distance.min(initial=float("inf"))
        numbers = (report.volume, report.depth, report.penetration, report.max_pressure, report.creep_depth, rim)
        time = () if cycles_per_year is None else (f"{report.cycles / cycles_per_year:.4g}",)
        table.add_row(*time, f"{report.cycles / 1e6:.6g}", *(f"{number:.4g}" for number in numbers))
    return table


def _film_line(history: History) -> str:
    """Describe film thickness, lubrication and friction of the first cycle in one line."""
    film = history.use.film(history.lubricant)
    if not len(film.phases):
        return "no film: nothing is pressed"
    summary = film.summary()
    thickness = f"film {1e6 * film.least.min():.3g} to {1e6 * film.least.max():.3g} nm, λ up to {film.ratio.max():.2g}"
    friction = f"friction up to {summary['moment_Nmm'] / 1e3:.3g} N m, {summary['power_W']:.2g} W"
    return f"{thickness}, {summary['regime']} lubrication; {friction}"
