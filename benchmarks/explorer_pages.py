"""Servers that `explorer` measures: this checkout's explorer, and an empty page of each known library."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPException
from pathlib import Path
from tempfile import TemporaryDirectory

from .start import checkout_environment

PATIENCE = 120.0
"""Seconds that a server may take until its page is there."""

_PANEL = """
import sys
import panel as pn

def page():
    slider, number = pn.widgets.FloatSlider(start=0, end=5000, step=50, value=3000), pn.pane.HTML()
    slider.param.watch(lambda event: setattr(number, "object", f"<b class='number'>{event.new}</b>"), "value")
    number.object = "<b class='number'>3000</b>"
    return pn.Column(slider, number)

pn.extension()
pn.serve(page, port=int(sys.argv[1]), show=False)
"""
_DASH = """
import sys
from dash import Dash, Input, Output, dcc, html

app = Dash(__name__)
slider = dcc.Slider(0, 5000, 50, value=3000, marks=None, id="slider")
app.layout = html.Div([slider, html.B(id="number", className="number")])
app.callback(Output("number", "children"), Input("slider", "value"))(str)
app.run(port=int(sys.argv[1]), debug=False)
"""
LIBRARIES = {"panel": _PANEL, "dash": _DASH}
"""Program of an empty page by its library: one slider and one number."""


@dataclass(frozen=True)
class Server:
    """Running server with its address and its process."""

    address: str
    process: int

    def processor_time(self) -> float:
        """Processor time of the server and its child processes, in seconds."""
        processes = [self.process]
        for process in processes:
            tasks = Path(f"/proc/{process}/task").glob("*/children")
            processes += [int(child) for task in tasks for child in task.read_text().split()]
        stats = (Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split() for process in processes)
        return sum(int(tick) for stat in stats for tick in stat[11:15]) / os.sysconf("SC_CLK_TCK")


@contextmanager
def served_explorer() -> Iterator[Server]:
    with _running(["-m", "ballsocket", "app", "--no-browser", "--port"]) as server:
        yield server


@contextmanager
def served_library(library: str) -> Iterator[Server]:
    """Serve the empty page of a library."""
    with TemporaryDirectory() as folder:
        script = Path(folder) / "page.py"
        script.write_text(LIBRARIES[library], encoding="utf-8")
        with _running([str(script)]) as server:
            yield server


@contextmanager
def _running(words: Sequence[str]) -> Iterator[Server]:
    """Run a server of this checkout, whose last word is a free port, until the end."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = int(probe.getsockname()[1])
    process = subprocess.Popen(
        [sys.executable, *words, str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=checkout_environment(),
    )
    try:
        _wait_for_page(port, process)
        yield Server(f"http://127.0.0.1:{port}/", process.pid)
    finally:
        process.terminate()
        try:
            process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()


def _wait_for_page(port: int, process: subprocess.Popen[bytes]) -> None:
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline and process.poll() is None:
        connection = HTTPConnection("127.0.0.1", port, timeout=60)
        try:
            connection.request("GET", "/")
            connection.getresponse().read()
            return
        except (OSError, HTTPException):
            time.sleep(0.1)
        finally:
            connection.close()
    raise RuntimeError(f"a server of the benchmark has not started within {PATIENCE:g} s")
