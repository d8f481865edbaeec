"""Command `hip`: wear of one or several hips over millions of gait cycles, for one patient or a cohort."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from ..core.executors.processes import Engine, Serial
from ..core.storage.atomic_files import check_ending
from ..core.unit_systems import Units
from .json_answers import echo_json
from .options import AsJson, Scheduler, UnitSystem, Workers, choose_executor, print_result, write_figure
from .root import app, echo_path, fail

if TYPE_CHECKING:  # imported on use: the solver of wear is slow to import
    from ..hip.answers import HipRun
    from ..hip.bands import Bands
    from ..hip.config import HipFile
    from ..hip.history import History


@app.command()
def hip(
    files: Annotated[
        list[Path],
        typer.Argument(metavar="FILE...", help="Hip files (TOML): joint, gait cycle, wear law. Several are compared."),
    ],
    units: UnitSystem = Units.SI,
    as_json: AsJson = False,
    figure: Annotated[
        Path | None, typer.Option(help="Write a figure of volume and penetration over cycles (.png, .svg, .pdf).")
    ] = None,
    csv: Annotated[Path | None, typer.Option(help="Write a table with a row for each report (.csv).")] = None,
    report: Annotated[
        Path | None, typer.Option(help="Write a report with figures to this file (.html, or .pdf with the extra pdf).")
    ] = None,
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
    method: Annotated[
        str | None,
        typer.Option(
            help="Method of --patients: series (polynomials from a few hundred simulations) or runs (a simulation of "
            "each patient). Default: series, where it holds and is quicker."
        ),
    ] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
) -> None:
    """Simulate wear of a hip over millions of gait cycles.

    Exit status: 0 success, 2 wrong input, 3 a contact does not balance its load.
    """
    from ..hip.answers import HipRun, describe_bands, describe_hips, describe_history
    from ..hip.config import read_hip
    from ..reports.figure_files import check_format
    from ..reports.hip_comparison import comparison_figure, write_table
    from ..reports.hip_report import hip_report
    from ..reports.pages import check_page_path, letterhead, write_page
    from ..reports.terminal import print_answer

    check_format(figure)
    if report is not None:
        check_page_path(report)
    if csv is not None:
        check_ending("table", csv, ".csv")
    if method is not None and patients is None:
        raise ValueError("--method is the method of a cohort: add --patients, or leave out --method")
    hip_files, engine = [read_hip(path) for path in files], choose_executor(workers, scheduler, Serial())
    several = len(files) > 1
    if patients is not None:
        for option, value in {"--report": report, "--figure": figure, "--csv": csv}.items():
            if value is not None:
                raise ValueError(f"{option} shows one hip: leave out {option} or --patients")
        if several:
            raise ValueError(f"--patients needs one file, got {len(files)}")
        _simulate_cohort(hip_files[0], patients, method, engine, store, as_json, units)
        return
    if several and report is not None:
        raise ValueError(f"--report shows one hip, got {len(files)} files: use --figure or --csv to compare them")
    if report is not None:
        letterhead(hip_files[0].report)  # a logo that cannot be shown is refused before the run
    runs = []
    stems = _short_names(files)
    for stem, name, hip_file in zip(stems, _titles(hip_files, stems), hip_files, strict=True):
        folder, shown_name = (store and store / stem, f" {name}") if several else (store, "")
        with _progress_bar(f"wearing{shown_name}", hip_file.cycles, "cycles") as progress:
            history = hip_file.use.after(
                hip_file.cycles, hip_file.report_at, progress=progress, lubricant=hip_file.lubricant, store=folder
            )
        runs.append(HipRun(name=name, history=history, bands=_uncertainty_bands(hip_file, history, engine)))
    if as_json:
        _echo_runs(runs, files)
    elif several:
        print_answer(describe_hips(runs), units)
    else:
        print_answer(describe_history(runs[0].history, runs[0].name), units)
        if runs[0].bands is not None:
            print_answer(describe_bands(runs[0].bands), units)
    if report is not None:  # last: if a file cannot be written, the result is already printed
        page = hip_report(runs[0].history, runs[0].bands, runs[0].name, hip_files[0].report, units)
        write_page(page, report, units.paper)
    write_figure(figure, lambda: comparison_figure(runs), units)
    if csv is not None:
        write_table(csv, runs)
    if not all(run.history.converged for run in runs):
        fail("a contact did not balance its load (see the notes)")


def _short_names(files: Sequence[Path]) -> list[str]:
    """Return the name of each file without folder and ending; its whole path if two files have the same name."""
    names = [path.stem for path in files]
    if len(set(names)) == len(names):
        return names
    if len(set(files)) < len(files):
        raise ValueError("two files are the same: give each file once")
    return [str(path.with_suffix("")) for path in files]


def _titles(hip_files: Sequence[HipFile], stems: Sequence[str]) -> list[str]:
    """Return the name that each file states, else its short name; equal names have the short name beside."""
    names = [hip_file.name or stem for hip_file, stem in zip(hip_files, stems, strict=True)]
    return [f"{name} ({stem})" if names.count(name) > 1 else name for name, stem in zip(names, stems, strict=True)]


def _uncertainty_bands(hip_file: HipFile, history: History, engine: Engine) -> Bands | None:
    scatter = hip_file.uncertain
    if scatter is None:
        return None
    from ..hip.wear_uncertainty import uncertainty

    samples, noun = scatter.count * (len(scatter.variability.distributions) + 2), scatter.variability.noun
    with _progress_bar(f"other {noun}", samples, noun) as progress:
        return uncertainty(
            scatter.variability, history, count=scatter.count, seed=scatter.seed, engine=engine, progress=progress
        )


def _echo_runs(runs: Sequence[HipRun], files: Sequence[Path]) -> None:
    """Print simulations as JSON: the result of one file, or `results` with an entry for each of several files."""
    answers = []
    for run in runs:
        history, bands = run.history, run.bands
        answer = {"name": run.name, "valid": history.valid and (bands is None or bands.valid), **history.summary()}
        if bands is not None:
            answer |= bands.summary()
            answer["notes"] = [*answer["notes"], *bands.notes]
        answers.append(answer)
    if len(answers) == 1:
        echo_json(answers[0])
        return
    results = [{"file": str(path), **answer} for path, answer in zip(files, answers, strict=True)]
    notes = [f"{run.name}: {note}" for run, answer in zip(runs, answers, strict=True) for note in answer["notes"]]
    valid = all(answer["valid"] for answer in answers)
    echo_json({"valid": valid, "results": results, "notes": notes})


def _simulate_cohort(
    hip_file: HipFile,
    patients: int,
    method: str | None,
    engine: Engine,
    store: Path | None,
    as_json: bool,
    units: Units,
) -> None:
    """Simulate and print a patient cohort; with a store, also write a table of the patients."""
    from ..hip.answers import describe_cohort
    from ..hip.cohort import cohort_store, write_csv
    from ..hip.wear_uncertainty import population

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
            method=method,
        )
    print_result(
        lambda: {"valid": bands.valid, **bands.summary(), "notes": [*bands.nominal_notes, *bands.notes]},
        lambda: describe_cohort(bands),
        units,
        as_json,
    )
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
