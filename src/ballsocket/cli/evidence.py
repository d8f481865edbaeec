"""`evidence`: why a computed number may be trusted, as a folder that can be handed in."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress

import ballsocket as bs

from ..checks import needs
from ..engines.local import Engine, Processes
from ..evidence.folder import differences, made_by, write
from ..evidence.pack import Listener, gathered
from ..evidence.question import read_question
from ..fingerprint import fingerprint
from ..output.evidence_page import conclusions, evidence_page
from .root import FAILURE, app, echo_path
from .words import AsJson, echo_json


@app.command()
def evidence(
    question: Annotated[Path | None, typer.Argument(help="A question file (TOML).")] = None,
    out: Annotated[Path, typer.Option(help="The folder to write into; made if it is not there.")] = Path("evidence"),
    check: Annotated[
        Path | None, typer.Option(help="A folder of evidence: compute all of it again, and say what differs.")
    ] = None,
    as_json: AsJson = False,
    workers: Annotated[int | None, typer.Option(help="Processes at work; as many as there are cores.")] = None,
) -> None:
    """Gather the evidence that a question asks for, verified, compared and with its uncertainty, as one page and JSON.

    What is finished is kept: a run that was stopped goes on where it was.

    Exit status: 0 done, 2 misuse, 3 a pack that does not say what is computed now.
    """
    needs("study", "xarray")
    if (question is None) == (check is None):
        raise ValueError("either a question file is needed, or --check with a folder of evidence")
    if check is not None:
        _again(check, Processes(workers=workers), as_json)
        return
    assert question is not None
    asked = read_question(question)
    with _told() as listen:
        record = gathered(asked, out / "data", listen, Processes(workers=workers))
    path = write(asked, record, evidence_page(record), out)
    if as_json:
        echo_json({**record, "folder": str(out), "valid": record["accurate"]["holds"], "notes": conclusions(record)})
    else:
        echo_path(path)


def _again(folder: Path, engine: Engine, as_json: bool) -> None:
    with _told() as listen:
        count, found = differences(folder, listen, engine, evidence_page)
    if as_json:
        told = [each.summary() for each in found]
        echo_json(
            {
                "version": bs.__version__,
                "valid": not found,
                "made_by": made_by(folder),
                "compared": count,
                "differences": told,
            }
        )
    else:
        for each in found:
            typer.echo(str(each))
        typer.echo(f"{count - len(found)} of {count} numbers, words and files are as they were written")
        typer.echo(f"written by ballsocket {made_by(folder)}, computed again by {fingerprint()}")
    if found:
        raise typer.Exit(FAILURE)


@contextmanager
def _told() -> Iterator[Listener]:
    """A line that says what is at work, where somebody looks."""
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("gathering", total=None)
        yield lambda name: progress.update(task, description=name)
