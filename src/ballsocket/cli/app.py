"""`app`: the explorer, in a browser on this machine."""

from __future__ import annotations

import signal
import sys
from typing import Annotated, Any

import typer

from ..core.checks import needs
from .root import app


@app.command(name="app")
def explorer(
    port: Annotated[int, typer.Option(help="0 takes any that is free.")] = 5006,
    address: Annotated[str, typer.Option(help="Listen here; anything but 127.0.0.1 opens it to others.")] = "127.0.0.1",
    origin: Annotated[
        list[str] | None, typer.Option(help="'host:port' under which browsers reach it from elsewhere; repeat.")
    ] = None,
    browser: Annotated[bool, typer.Option(help="Open a browser.")] = True,
) -> None:
    """Open the explorer: sliders, drawings, maps and finite elements in a browser."""
    needs("app", "panel", "tomli_w", "skfem", "xarray")
    from ..app.serve import EVERYWHERE, LOOPBACK, server  # takes its time to import

    served = server(port, address, origin or (), show=browser)
    name = LOOPBACK if address == EVERYWHERE else address
    typer.echo(f"http://{name}:{served.port}/ (Ctrl-C ends it)")
    if address not in (LOOPBACK, "localhost"):
        typer.echo("ballsocket: others can reach this page; it has no passwords", err=True)
    if address == EVERYWHERE and not origin:
        typer.echo("ballsocket: browsers elsewhere need the name that they use: --origin host:port", err=True)
    served.start()
    _until_ended(served.io_loop)


def _until_ended(loop: Any) -> None:
    """Serve until somebody ends the process, between two steps: what is raised inside one could be caught there."""
    asked: list[int] = []

    def end(number: int, frame: Any) -> None:
        asked.append(number)
        loop.asyncio_loop.call_soon_threadsafe(loop.stop)

    for ending in (signal.SIGTERM, signal.SIGINT):
        signal.signal(ending, end)
    loop.start()
    sys.exit(128 + asked[0] if asked else 0)
