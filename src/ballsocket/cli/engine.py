"""Who computes, in words of a command."""

from __future__ import annotations

from typing import Annotated

import typer

from ..core.executors.dask import Distributed
from ..core.executors.processes import Engine, Processes

Workers = Annotated[int | None, typer.Option(help="So many processes on this machine.")]
Scheduler = Annotated[str | None, typer.Option(help="The address of a Dask scheduler, 'tcp://host:8786'.")]


def engine_of(workers: int | None, scheduler: str | None, otherwise: Engine) -> Engine:
    """The engine that the words name, or another one."""
    if scheduler is not None:
        return Distributed(address=scheduler, workers=workers)
    return otherwise if workers is None else Processes(workers=workers)
