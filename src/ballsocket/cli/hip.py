"""`hip`: a hip in use over millions of cycles."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

import ballsocket as bs

from ..hip.file import read_hip
from ..output.hip_report import check_page, write_hip_report
from ..output.hip_terminal import print_hip
from .root import FAILURE, app
from .words import AsJson, echo_json


@app.command()
def hip(
    file: Annotated[Path, typer.Argument(help="A file about a hip in use (TOML).")],
    as_json: AsJson = False,
    report: Annotated[Path | None, typer.Option(help="Also write a page with figures (.html).")] = None,
    store: Annotated[
        Path | None, typer.Option(help="A folder to keep the run in: one that was stopped goes on from there.")
    ] = None,
) -> None:
    """Wear a hip over millions of cycles of load and motion, as its file tells.

    Exit status: 0 done, 2 misuse, 3 a contact that did not balance its load.
    """
    if report is not None:
        check_page(report)
    given = read_hip(file)
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:,.0f} cycles")
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("wearing", total=given.cycles)
        history = given.use.after(
            given.cycles,
            given.report_at,
            listen=lambda done: progress.update(task, completed=done),
            lubricant=given.lubricant,
            store=store,
        )
    if report is not None:
        write_hip_report(history, report)
    if as_json:
        echo_json({"version": bs.__version__, **history.summary()})
    else:
        print_hip(history)
    if not history.settled:
        typer.echo("ballsocket: a contact did not balance its load (see the notes)", err=True)
        raise typer.Exit(FAILURE)
