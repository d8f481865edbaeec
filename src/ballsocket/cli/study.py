"""`study`: a study file is run, resumed, and put into a file for other programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import timedelta
from math import ceil, inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

import ballsocket as bs

from ..output import study_plots, study_summary, study_terminal
from ..output.save import check_format, save
from ..studies.export import check_suffix, export
from ..studies.file import StudyFile, read_study
from ..studies.run import Listener
from ..studies.run import Progress as Reached
from .engine import Scheduler, Workers, engine_of
from .root import app, complain, echo_path
from .words import AsJson, echo_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@app.command()
def study(
    file: Annotated[Path, typer.Argument(help="A study file (TOML).")],
    store: Annotated[Path | None, typer.Option(help="The folder of the store, in place of the file's.")] = None,
    out: Annotated[Path | None, typer.Option(help="Also write all numbers as NetCDF (.nc) or CSV (.csv).")] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    figure: Annotated[
        Path | None, typer.Option(help="A map of two axes, or bands of samples over one (.png, .svg, .pdf).")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Press a joint at every point of a study file, into a store that can be resumed."""
    if out is not None:
        check_suffix(out)
    given = read_study(file)
    draw = None if figure is None else _drawing(given, figure)
    kept = store or given.store
    with _shown(kept) as listen:
        found = bs.study(
            given.model,
            given.joint,
            given.design,
            quantities=given.quantities,
            store=kept,
            engine=engine_of(workers, scheduler, given.engine),
            listen=listen,
        )
    if as_json:
        echo_json({"version": bs.__version__, "joint": given.joint.summary(), **study_summary.study_summary(found)})
    else:
        study_terminal.print_study(found)
    if out is not None:
        export(found, out)
    if draw is not None and figure is not None:
        save(draw(found), figure)
    for path in () if as_json else (kept, out, figure):
        if path is not None:
            echo_path(path)


def _drawing(given: StudyFile, path: Path) -> Callable[[Any], Figure]:
    """How the study is drawn, asked before it is run."""
    check_format(path)
    long = [axis.name for axis in given.design.axes if len(axis) > 1]
    if len(long) != 2:
        raise ValueError(f"a figure needs two axes, or samples and an axis; this study has {', '.join(long) or 'none'}")
    return study_plots.band_figure if "sample" in long else study_plots.design_map


@contextmanager
def _shown(store: Path | None) -> Iterator[Listener]:
    """A bar with the rate and the remaining time; after Ctrl-C, what is kept."""
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[state]}"))
    progress = Progress(*columns, console=Console(stderr=True))
    task = progress.add_task("looking at what is there", total=None, state="")
    last: list[Reached] = []
    if store is not None and store.exists():
        progress.start()

    def listen(reached: Reached) -> None:
        progress.start()  # not before there is something to tell
        progress.update(
            task, description="pressing", completed=reached.n_done, total=reached.n_points, state=_state(reached)
        )
        last[:] = [reached]

    try:
        yield listen
    except KeyboardInterrupt:
        _end(progress)
        if store is not None and last:
            done = f"{last[0].n_done:.4g} of {last[0].n_points:.4g} points are kept in {store}"
            complain(f"stopped; {done}: run it again to go on")
        raise
    finally:
        _end(progress)


def _end(progress: Progress) -> None:
    """One that never began would leave an empty line."""
    if progress.live.is_started:
        progress.stop()


def _state(reached: Reached) -> str:
    left = "" if reached.seconds_left in (0.0, inf) else f", {timedelta(seconds=ceil(reached.seconds_left))} left"
    return f"{reached.n_done:.4g} of {reached.n_points:.4g}, {reached.rate:.3g}/s{left}"
