"""`serve-mcp`: the same verbs for assistants, by the Model Context Protocol."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Annotated

import typer

from ..core.checks import needs
from .root import app


@app.command()
def serve_mcp(
    folder: Annotated[Path, typer.Option(help="Files are read and written in this folder only.")] = Path(),
    longest: Annotated[
        float, typer.Option(min=1.0, max=3600.0, help="Seconds that a call may take; it is stopped then.")
    ] = 120.0,
) -> None:
    """Offer press, curve, study, wear, identify, evidence and more to assistants, by the Model Context Protocol.

    It speaks on standard input and output: a program that asks starts it, and ends it.
    """
    needs("mcp", "mcp", "mcp_types")
    if not folder.is_dir():
        raise ValueError(f"{str(folder)!r} is no folder")
    from .tools.server import serve

    asyncio.run(serve(folder.resolve(), longest))
