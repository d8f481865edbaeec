"""`study`: a study file is run, resumed, and put into a file for other programs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

import ballsocket as bs

from .. import study_tables
from ..engines import Engine, Processes
from ..studies.distributed import Distributed
from ..studies.export import check_suffix, export
from ..studies.file import StudyFile, read_study
from ..studies.run import Listener
from ..studies.run import Progress as Reached
from .root import app


@app.command()
def study(
    file: Annotated[Path, typer.Argument(help="A study file (TOML).")],
    store: Annotated[Path | None, typer.Option(help="The folder of the store, in place of the file's.")] = None,
    out: Annotated[Path | None, typer.Option(help="Also write all numbers as NetCDF (.nc) or CSV (.csv).")] = None,
    workers: Annotated[int | None, typer.Option(help="So many processes on this machine.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="The address of a Dask scheduler, 'tcp://host:8786'.")] = None,
) -> None:
    """Press a joint at every point of a study file, into a store that can be resumed."""
    if out is not None:
        check_suffix(out)
        if not out.parent.is_dir():
            raise ValueError(f"{str(out.parent)!r} is no folder to write {out.name} into")
    given = read_study(file)
    kept = store or given.store
    with _shown() as listen:
        found = bs.study(
            given.model,
            given.joint,
            given.design,
            quantities=given.quantities,
            store=kept,
            engine=_engine(given, workers, scheduler),
            listen=listen,
        )
    study_tables.print_study(found)
    if kept is not None:
        typer.echo(str(kept))
    if out is not None:
        export(found, out)
        typer.echo(str(out))


def _engine(given: StudyFile, workers: int | None, scheduler: str | None) -> Engine:
    if scheduler is not None:
        return Distributed(address=scheduler, workers=workers)
    return given.engine if workers is None else Processes(workers=workers)


@contextmanager
def _shown() -> Iterator[Listener]:
    """A bar with the rate and the remaining time."""
    columns = (TextColumn("pressing"), BarColumn(), TextColumn("{task.fields[rate]}"), TimeRemainingColumn())
    progress = Progress(*columns, console=Console(stderr=True))
    task = progress.add_task("pressing", total=None, rate="")

    def listen(reached: Reached) -> None:
        progress.start()  # not before there is something to tell
        rate = f"{reached.done:.4g} of {reached.points:.4g}, {reached.rate:.3g}/s"
        progress.update(task, completed=reached.done, total=reached.points, rate=rate)

    try:
        yield listen
    finally:
        progress.stop()
