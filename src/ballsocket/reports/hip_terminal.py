"""A hip in use in a terminal."""

from __future__ import annotations

from rich.table import Table

from ..hip.history import History
from .hip_contact import HEADS, contact_line, contact_rows
from .terminal import console, print_folded

_HEADS = {
    "cycles": "million",
    "volume": "mm³",
    "depth": "mm",
    "penetration": "mm",
    "pmax": "MPa",
    "creep": "mm",
    "to the rim": "mm",
}


def print_hip(history: History) -> None:
    """The first cycle in a line, what is seen later on in a table, how sure it is, and remarks."""
    terminal, use, first = console(), history.use, history.use.first
    print_folded(terminal, str(use.joint), "bold")
    print_folded(
        terminal,
        f"{use.cycle.name}: slide {first.slide:.4g} mm a cycle, pressure times slide {first.work:.4g} N m, "
        f"cross-shear {first.cross_shear:.3g}, up to {first.max_force:.4g} N and {first.max_pressure:.4g} MPa",
        "",
    )
    print_folded(terminal, f"unworn: {first.volume:.4g} mm³ and {first.depth:.4g} mm a million cycles", "")
    terminal.print(_table(history))
    if history.use.ball_wear is not None:
        last = history.last
        worn = f"{last.ball_volume:.4g} mm³ and {last.ball_depth:.3g} mm"
        print_folded(terminal, f"the ball: {worn} after {last.cycles / 1e6:g} million cycles", "")
    print_folded(terminal, contact_line(history), "")
    if len(history.use.unworn_checks) > 1:
        terminal.print(_contacts(history))
    print_folded(terminal, _film(history), "")
    off = f"volume within {100 * history.error.volume:.2g} % of the same model in the finest steps"
    print_folded(terminal, f"{off}, in {history.steps} blocks", "dim")
    for note in history.notes:
        print_folded(terminal, note, "dim")


def _contacts(history: History) -> Table:
    """Lay out the worst contact of each activity, unworn and at the end."""
    shown = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for head in HEADS:
        shown.add_column(head, justify="left" if head in HEADS[1:3] else "right", no_wrap=head != "at")
    rows = list(contact_rows(history))
    count = len(history.use.unworn_checks)
    for row in (*rows[:count], *rows[-count:]):
        shown.add_row(*row)
    return shown


def _table(history: History) -> Table:
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    years = history.use.cycle.per_year
    heads = _HEADS if years is None else {"time": "years", **_HEADS}
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_row(*heads.values(), style="dim")
    for each in history.reports:
        rim = each.edge_distance.min(initial=float("inf"))
        numbers = (each.volume, each.depth, each.penetration, each.max_pressure, each.creep_depth, rim)
        time = () if years is None else (f"{each.cycles / years:.4g}",)
        table.add_row(*time, f"{each.cycles / 1e6:.6g}", *(f"{number:.4g}" for number in numbers))
    return table


def _film(history: History) -> str:
    """The film and the friction of the first cycle, in a line."""
    film = history.use.film(history.lubricant)
    if not len(film.phases):
        return "no film: nothing is pressed"
    told = film.summary()
    thick = f"film {1e6 * film.least.min():.3g} to {1e6 * film.least.max():.3g} nm, λ up to {film.ratio.max():.2g}"
    rubs = f"friction up to {told['moment_Nmm'] / 1e3:.3g} N m, {told['power_W']:.2g} W"
    return f"{thick}, {told['regime']} lubrication; {rubs}"
