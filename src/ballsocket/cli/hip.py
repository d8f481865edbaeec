"""`hip`: a hip in use over millions of cycles, of one patient or of many."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

import ballsocket as bs

from ..core.executors.processes import Engine, Serial
from ..hip.bands import Bands
from ..hip.cohort import cohort_store, write_csv
from ..hip.config import HipFile, read_hip
from ..hip.history import History
from ..hip.uncertainty import population, uncertainty
from ..reports.hip_report import check_page, write_hip_report
from ..reports.hip_tables import print_bands, print_hip, print_notes
from .engine import Scheduler, Workers, engine_of
from .root import FAILURE, app, echo_path
from .words import AsJson, echo_json


@app.command()
def hip(
    file: Annotated[Path, typer.Argument(help="A file about a hip in use (TOML).")],
    as_json: AsJson = False,
    report: Annotated[Path | None, typer.Option(help="Also write a page with figures (.html).")] = None,
    store: Annotated[
        Path | None, typer.Option(help="A folder to keep the run in: one that was stopped goes on from there.")
    ] = None,
    patients: Annotated[
        int | None, typer.Option(help="Wear so many patients' hips, who differ as the file's [uncertainty] says.")
    ] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
) -> None:
    """Wear a hip over millions of cycles of load and motion, as its file tells.

    Exit status: 0 done, 2 misuse, 3 a contact that did not balance its load.
    """
    if report is not None:
        check_page(report)
    given, engine = read_hip(file), engine_of(workers, scheduler, Serial())
    if patients is not None:
        if report is not None:
            raise ValueError("a report shows one hip: leave out --report or --patients")
        _many(given, patients, engine, store, as_json)
        return
    history = _worn(given, store)
    bands = _bands(given, history, engine)
    if as_json:
        _echo(history, bands)
    else:
        print_hip(history)
        if bands is not None:
            print_bands(bands)
    if report is not None:  # last: what was computed is told, should the page not be written
        write_hip_report(history, report, bands)
    if not history.converged:
        typer.echo("ballsocket: a contact did not balance its load (see the notes)", err=True)
        raise typer.Exit(FAILURE)


def _worn(given: HipFile, store: Path | None) -> History:
    with _bar("wearing", given.cycles, "cycles") as listen:
        return given.use.after(given.cycles, given.report_at, progress=listen, lubricant=given.lubricant, store=store)


def _bands(given: HipFile, history: History, engine: Engine) -> Bands | None:
    """How sure it is, where the file says what scatters."""
    said = given.uncertain
    if said is None:
        return None
    patients = said.count * (len(said.variability.distributions) + 2)
    with _bar("other patients", patients, "patients") as listen:
        return uncertainty(said.variability, history, count=said.count, seed=said.seed, engine=engine, progress=listen)


def _echo(history: History, bands: Bands | None) -> None:
    valid = history.valid and (bands is None or bands.valid)
    answer = {"version": bs.__version__, "valid": valid, **history.summary()}
    if bands is not None:
        answer |= bands.summary()
        answer["notes"] = [*answer["notes"], *bands.notes]
    echo_json(answer)


def _many(given: HipFile, patients: int, engine: Engine, store: Path | None, as_json: bool) -> None:
    said = given.uncertain
    if said is None:
        raise ValueError("--patients needs a table [uncertainty] that says what differs between them")
    counts = tuple(sorted({*given.report_at, given.cycles}))
    where = None if store is None else cohort_store(store, said.variability, counts, said.seed)
    with _bar("patients", patients, "patients") as listen:
        lives, bands = population(
            said.variability, counts, patients=patients, seed=said.seed, engine=engine, store=where, progress=listen
        )
    if as_json:
        notes = [*bands.nominal_notes, *bands.notes]
        echo_json({"version": bs.__version__, "valid": bands.valid, **bands.summary(), "notes": notes})
    else:
        print_bands(bands)
        print_notes(bands.nominal_notes)
    if store is not None:
        path = write_csv(store / "patients.csv", lives, bands.cohort)
        if not as_json:
            echo_path(path)


@contextmanager
def _bar(what: str, total: float, unit: str) -> Iterator[Callable[[float], None]]:
    """A bar where somebody looks."""
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:,.0f} " + unit)
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task(what, total=total)
        yield lambda done: progress.update(task, completed=done)
