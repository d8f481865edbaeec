"""Command `reproduce`: all results of Heß & Forsbach 2021, computed again."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress

from ..core.checks import needs
from ..core.executors.processes import Processes
from ..output.report import write_report
from ..paper.plan import full_plan, quick_plan
from .root import app, echo_path


@app.command()
def reproduce(
    out: Annotated[Path, typer.Option(help="Output folder; created if it does not exist.")] = Path("reproduced"),
    quick: Annotated[bool, typer.Option("--quick", help="Only the exact solution, without finite elements.")] = False,
    workers: Annotated[int | None, typer.Option(help="Number of worker processes. Default: number of cores.")] = None,
) -> None:
    """Recompute the results of Heß & Forsbach 2021.

    The report shows every table, figure and claim of the paper with a verdict. The same command resumes a stopped run.
    """
    if not quick:
        needs("fem", "skfem", "meshio", "psutil")
    engine = Processes(workers=workers)
    plan = quick_plan() if quick else full_plan()
    with Progress(console=Console(stderr=True)) as progress:
        task = progress.add_task("reproducing", total=len(plan))
        advance = partial(progress.update, task, advance=1)
        results = plan.results(out / "data", lambda name: advance(description=name), engine)
        advance(advance=0, description="drawing")
        report = write_report(results, out, engine)
    echo_path(report)
