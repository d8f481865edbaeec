"""Command `study`: press a joint at every point of a study file, with a store that can be resumed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import timedelta
from math import ceil, inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from ..core.executors.processes import count_text
from ..core.storage.atomic_files import address_of
from ..core.storage.folders import folder_at
from ..core.unit_systems import Units
from ..model_catalogue import with_gap, with_yielding
from ..reports import study_plots
from ..reports.figure_files import check_format, save
from ..studies.file import StudyFile, read_study
from ..studies.file_formats import check_suffix, export
from ..studies.run import Listener
from ..studies.run import Progress as StudyProgress
from ..studies.run import study as run_study
from ..studies.study_answer import describe_study, study_summary
from .elasticity_options import Yielding
from .options import AsJson, GapName, Scheduler, UnitSystem, Workers, choose_executor, print_result
from .root import app, echo_path, print_message

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@app.command()
def study(
    file: Annotated[Path, typer.Argument(help="Study file (TOML).")],
    store: Annotated[
        Path | None,
        typer.Option(
            help="Folder that stores the results, also in a cloud store: 's3://bucket/hips.zarr'. "
            "Default: the store of the file."
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write all values to this file: NetCDF (.nc), CSV (.csv), Parquet (.parquet) or Zarr (.zarr), "
            "also in a cloud store: 's3://bucket/hips.parquet'."
        ),
    ] = None,
    gap: GapName = None,
    plastic: Yielding = False,
    workers: Workers = None,
    scheduler: Scheduler = None,
    figure: Annotated[
        Path | None,
        typer.Option(help="Write a figure (.png, .svg, .pdf): a map over two axes, or bands of samples over one axis."),
    ] = None,
    units: UnitSystem = Units.SI,
    as_json: AsJson = False,
) -> None:
    """Press a joint at every point of a study file.

    With a store, the same command resumes a stopped study.
    """
    if out is not None:
        check_suffix(out)
    study_file = read_study(file)
    draw = None if figure is None else _choose_plot(study_file, figure)
    model = with_gap(study_file.model, gap)
    model = with_yielding(model) if plastic else model
    folder = store or study_file.store
    with _progress_bar(folder) as progress:
        result = run_study(
            model,
            study_file.joint,
            study_file.design,
            quantities=study_file.quantities_of(model),
            store=folder,
            engine=choose_executor(workers, scheduler, study_file.engine),
            listen=progress,
        )
    print_result(
        lambda: {"joint": study_file.joint.summary(), **study_summary(result)},
        lambda: describe_study(result),
        units,
        as_json,
    )
    if out is not None:
        export(result, out)
    if draw is not None and figure is not None:
        save(draw(result, units=units), figure)
    for path in () if as_json else (folder, out, figure):
        if path is not None:
            echo_path(path)


def _choose_plot(study_file: StudyFile, path: Path) -> Callable[..., Figure]:
    """Return the plot of a study, before it runs.

    Raises ValueError: another file format, or a study without two axes.
    """
    check_format(path)
    axes = [axis.name for axis in study_file.design.axes if len(axis) > 1]
    if len(axes) != 2:
        raise ValueError(f"a figure needs two axes, or samples and an axis; this study has {', '.join(axes) or 'none'}")
    return study_plots.band_figure if "sample" in axes else study_plots.design_map


@contextmanager
def _progress_bar(store: str | Path | None) -> Iterator[Listener]:
    """Show a progress bar with rate and remaining time; after Ctrl-C, print the number of stored points."""
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[state]}"))
    progress = Progress(*columns, console=Console(stderr=True))
    task = progress.add_task("reading the store", total=None, state="")
    latest: list[StudyProgress] = []
    if store is not None and folder_at(store).exists():
        progress.start()

    def update(state: StudyProgress) -> None:
        """Update the bar, which starts with the first finished block."""
        progress.start()
        remaining = "" if state.seconds_left in (0.0, inf) else f", {timedelta(seconds=ceil(state.seconds_left))} left"
        text = f"{count_text(state.n_done)} of {count_text(state.n_points)}, {state.rate:.3g}/s{remaining}"
        progress.update(task, description="pressing", completed=state.n_done, total=state.n_points, state=text)
        latest[:] = [state]

    try:
        yield update
    except KeyboardInterrupt:
        _stop(progress)
        if store is not None and latest:
            counts = f"{count_text(latest[0].n_done)} of {count_text(latest[0].n_points)}"
            stored = f"points stored: {counts}, in {address_of(store) or store}"
            print_message(f"stopped; {stored}: run the command again to resume")
        raise
    finally:
        _stop(progress)


def _stop(progress: Progress) -> None:
    """Stop a progress bar that started; one that never started would print an empty line."""
    if progress.live.is_started:
        progress.stop()
