"""`reproduce`: the whole paper, from the geometry up."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress

from ..core.checks import needs
from ..core.executors.processes import Processes
from ..paper.plan import full_plan, quick_plan
from ..reports.paper_report import write_report
from .root import app, echo_path


@app.command()
def reproduce(
    out: Annotated[Path, typer.Option(help="The folder to write into; made if it is not there.")] = Path("reproduced"),
    quick: Annotated[bool, typer.Option("--quick", help="The exact solution alone, without finite elements.")] = False,
    workers: Annotated[int | None, typer.Option(help="Processes at work; as many as there are cores.")] = None,
) -> None:
    """Compute every table, figure and claim of Heß & Forsbach 2021 again, and write a report with a verdict on each.

    What is finished is kept: a run that was stopped goes on where it was.
    """
    if not quick:
        needs("fem", "skfem", "meshio", "psutil")
    engine = Processes(workers=workers)
    plan = quick_plan() if quick else full_plan()
    with Progress(console=Console(stderr=True)) as progress:
        task = progress.add_task("reproducing", total=len(plan))
        listen = partial(progress.update, task, advance=1)
        results = plan.results(out / "data", lambda name: listen(description=name), engine)
        listen(advance=0, description="drawing")
        report = write_report(results, out, engine)
    echo_path(report)
