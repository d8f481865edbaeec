"""Command `hip`: wear of a hip over millions of gait cycles, for one patient or a cohort."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from ..core.executors.processes import Engine, Serial
from ..version import __version__
from .json_answers import echo_json
from .options import AsJson, Scheduler, Workers, choose_executor
from .root import FAILURE, app, echo_path

if TYPE_CHECKING:  # imported on use: the solver of wear is slow to import
    from ..hip.bands import Bands
    from ..hip.config import HipFile
    from ..hip.history import History


@app.command()
def hip(
    file: Annotated[Path, typer.Argument(help="Hip file (TOML): joint, gait cycle, wear law.")],
    as_json: AsJson = False,
    report: Annotated[Path | None, typer.Option(help="Write a report with figures to this file (.html).")] = None,
    store: Annotated[
        Path | None,
        typer.Option(help="Folder that stores the run; the same command resumes a stopped run. Default: not stored."),
    ] = None,
    patients: Annotated[
        int | None,
        typer.Option(
            help="Number of patients of a cohort that differ by the [uncertainty] of the file. "
            "Default: one hip, as in the file."
        ),
    ] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
) -> None:
    """Simulate wear of a hip over millions of gait cycles.

    Exit status: 0 success, 2 wrong input, 3 a contact does not balance its load.
    """
    from ..hip.config import read_hip
    from ..reports.hip_report import check_page, write_hip_report
    from ..reports.hip_tables import print_bands, print_hip

    if report is not None:
        check_page(report)
    hip_file, engine = read_hip(file), choose_executor(workers, scheduler, Serial())
    if patients is not None:
        if report is not None:
            raise ValueError("a report shows one hip: leave out --report or --patients")
        _simulate_cohort(hip_file, patients, engine, store, as_json)
        return
    history = _simulate(hip_file, store)
    bands = _uncertainty_bands(hip_file, history, engine)
    if as_json:
        _echo_history(history, bands)
    else:
        print_hip(history)
        if bands is not None:
            print_bands(bands)
    if report is not None:  # last: if the page cannot be written, the result is already printed
        write_hip_report(history, report, bands)
    if not history.converged:
        typer.echo("ballsocket: a contact did not balance its load (see the notes)", err=True)
        raise typer.Exit(FAILURE)


def _simulate(hip_file: HipFile, store: Path | None) -> History:
    """Simulate the hip of a file with a progress bar."""
    with _progress_bar("wearing", hip_file.cycles, "cycles") as progress:
        return hip_file.use.after(
            hip_file.cycles, hip_file.report_at, progress=progress, lubricant=hip_file.lubricant, store=store
        )


def _uncertainty_bands(hip_file: HipFile, history: History, engine: Engine) -> Bands | None:
    """Compute uncertainty bands of a simulation; None if the file has no uncertainty."""
    from ..hip.uncertainty import uncertainty

    scatter = hip_file.uncertain
    if scatter is None:
        return None
    patients = scatter.count * (len(scatter.variability.distributions) + 2)
    with _progress_bar("other patients", patients, "patients") as progress:
        return uncertainty(
            scatter.variability, history, count=scatter.count, seed=scatter.seed, engine=engine, progress=progress
        )


def _echo_history(history: History, bands: Bands | None) -> None:
    """Print a simulation and its bands as JSON."""
    valid = history.valid and (bands is None or bands.valid)
    answer = {"version": __version__, "valid": valid, **history.summary()}
    if bands is not None:
        answer |= bands.summary()
        answer["notes"] = [*answer["notes"], *bands.notes]
    echo_json(answer)


def _simulate_cohort(hip_file: HipFile, patients: int, engine: Engine, store: Path | None, as_json: bool) -> None:
    """Simulate and print a patient cohort; with a store, also write a table of the patients."""
    from ..hip.cohort import cohort_store, write_csv
    from ..hip.uncertainty import population
    from ..reports.hip_tables import print_bands, print_notes

    scatter = hip_file.uncertain
    if scatter is None:
        raise ValueError("--patients needs a table [uncertainty] in the file: the scatter between patients")
    counts = tuple(sorted({*hip_file.report_at, hip_file.cycles}))
    folder = None if store is None else cohort_store(store, scatter.variability, counts, scatter.seed)
    with _progress_bar("patients", patients, "patients") as progress:
        cohort, bands = population(
            scatter.variability,
            counts,
            patients=patients,
            seed=scatter.seed,
            engine=engine,
            store=folder,
            progress=progress,
        )
    if as_json:
        notes = [*bands.nominal_notes, *bands.notes]
        echo_json({"version": __version__, "valid": bands.valid, **bands.summary(), "notes": notes})
    else:
        print_bands(bands)
        print_notes(bands.nominal_notes)
    if store is not None:
        path = write_csv(store / "patients.csv", cohort, bands.cohort)
        if not as_json:
            echo_path(path)


@contextmanager
def _progress_bar(task_name: str, total: float, unit: str) -> Iterator[Callable[[float], None]]:
    """Show a progress bar if stderr is a terminal."""
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:,.0f} " + unit)
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task(task_name, total=total)
        yield lambda completed: progress.update(task, completed=completed)
