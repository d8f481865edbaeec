"""Commands `app` and `serve-mcp`: servers for a browser and for AI assistants."""

from __future__ import annotations

import asyncio
import signal
import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.checks import needs
from ..core.executors.processes import exit_with_parent
from .root import app, load_commands, main

LIMITED_PROGRAM = ("-P", "-c", "from ballsocket.cli.servers import run_limited; run_limited()")
"""Arguments of Python for a call of a tool; -P: a file in the folder that is named like a module is not imported."""


@app.command(name="app")
def explorer(
    file: Annotated[Path | None, typer.Argument(help="Joint file (TOML) to open. Default: a preset.")] = None,
    port: Annotated[int, typer.Option(help="Port of the page; 0 selects a free one.")] = 5006,
    address: Annotated[
        str, typer.Option(help="Address of the server; any other than 127.0.0.1 opens it to other machines.")
    ] = "127.0.0.1",
    origin: Annotated[
        list[str] | None,
        typer.Option(
            help="Address 'host:port' that browsers on other machines use. Repeat for several. Default: none."
        ),
    ] = None,
    logo: Annotated[
        Path | None, typer.Option(help="Picture (PNG, SVG) on top of the client view and of reports. Default: none.")
    ] = None,
    browser: Annotated[bool, typer.Option(help="Open the page in a browser.")] = True,
) -> None:
    """Open the explorer, an interactive page, in a browser."""
    needs("app", "tornado", "tomli_w", "skfem", "xarray")
    from ..app.server import EVERYWHERE, LOOPBACK, server  # slow to import
    from ..app.state.screen import link_of_file
    from ..files.joint_file import read_joint

    link = "" if file is None else link_of_file(read_joint(file))
    page = server(port, address, origin or (), show=browser, link=link, logo=logo)
    name = LOOPBACK if address == EVERYWHERE else address
    typer.echo(f"http://{name}:{page.port}/{link} (Ctrl-C ends it)")
    if address not in (LOOPBACK, "localhost"):
        typer.echo("ballsocket: other machines can open this page; it has no passwords", err=True)
    if address == EVERYWHERE and not origin:
        typer.echo("ballsocket: for browsers on other machines give the address they use: --origin host:port", err=True)
    page.start()
    _run_until_signal(page.io_loop)


def _run_until_signal(loop: Any) -> None:
    """Run the event loop until SIGTERM or SIGINT, which stop it between two callbacks, and exit."""
    signals: list[int] = []

    def stop(number: int, frame: Any) -> None:
        """Stop the loop after the present callback; an exception inside it could be caught there."""
        signals.append(number)
        loop.asyncio_loop.call_soon_threadsafe(loop.stop)

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, stop)
    loop.start()
    sys.exit(128 + signals[0] if signals else 0)


@app.command()
def serve_mcp(
    folder: Annotated[
        Path, typer.Option(help="Folder of the server; files outside are neither read nor written.")
    ] = Path(),
    longest: Annotated[
        float, typer.Option(min=1.0, max=3600.0, help="Time limit of one call in seconds; a longer call is stopped.")
    ] = 120.0,
) -> None:
    """Offer the commands to AI assistants (MCP).

    The server speaks the Model Context Protocol on standard input and output. The assistant's program starts and ends
    it.
    """
    needs("mcp", "mcp", "mcp_types")
    if not folder.is_dir():
        raise ValueError(f"folder {str(folder)!r} does not exist")
    from ..mcp import serve

    asyncio.run(serve(folder.resolve(), longest, load_commands(), LIMITED_PROGRAM))


def run_limited() -> None:
    """Run the program with a limit on its memory, until its parent process ends: for calls of tools."""
    from ..app.running import limit_memory

    exit_with_parent()
    limit_memory()
    main()
