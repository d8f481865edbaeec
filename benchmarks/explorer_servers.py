"""Servers that benchmark `app` measures: explorers of checkouts, and an empty page in each of some known libraries."""

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

ROOT = Path(__file__).parents[1]
_START = 120.0
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
_NICEGUI = """
import sys
from nicegui import ui

@ui.page("/")
def page():
    number = ui.label("3000").classes("number")
    ui.slider(min=0, max=5000, step=50, value=3000, on_change=lambda event: number.set_text(str(event.value)))

ui.run(host="127.0.0.1", port=int(sys.argv[1]), show=False, reload=False)
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
_STREAMLIT = """
import sys
import streamlit

if streamlit.runtime.exists():
    value = streamlit.slider("load", 0, 5000, 3000, 50)
    streamlit.markdown(f"<b class='number'>{value}</b>", unsafe_allow_html=True)
else:
    from streamlit.web import cli
    sys.argv = ["streamlit", "run", __file__, "--server.headless=true", "--server.address=127.0.0.1",
                "--browser.gatherUsageStats=false", f"--server.port={sys.argv[1]}"]
    cli.main()
"""
LIBRARIES = {"panel": _PANEL, "nicegui": _NICEGUI, "dash": _DASH, "streamlit": _STREAMLIT}
"""Program of an empty page by its library: one slider and one number."""


@dataclass(frozen=True)
class Server:
    """Running server with its address and its process."""

    address: str
    process: int

    def cpu(self) -> float:
        """Return the seconds of processor time that the server and its child processes have used."""
        ticks = (_stat(process)[11:15] for process in self._processes())
        return sum(int(tick) for part in ticks for tick in part) / os.sysconf("SC_CLK_TCK")

    def memory(self) -> float:
        """Return the resident memory of the server and its child processes in MB."""
        pages = sum(int(_stat(process)[21]) for process in self._processes())
        return pages * os.sysconf("SC_PAGE_SIZE") / 1e6

    def _processes(self) -> list[int]:
        found = [self.process]
        for process in found:
            tasks = Path(f"/proc/{process}/task").glob("*/children")
            found += [int(child) for task in tasks for child in task.read_text().split()]
        return found


def _stat(process: int) -> list[str]:
    """Return the fields of /proc/PID/stat after the name of the command."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()


@contextmanager
def served_explorer(python: str = sys.executable, checkout: Path = ROOT) -> Iterator[Server]:
    """Serve the explorer of a checkout."""
    words = ["-m", "ballsocket", "app", "--no-browser", "--port"]
    with _running(python, words, {"PYTHONPATH": str(checkout / "src")}) as server:
        yield server


@contextmanager
def served_library(python: str, library: str) -> Iterator[Server]:
    """Serve the empty page of a library."""
    with TemporaryDirectory() as folder:
        script = Path(folder) / "page.py"
        script.write_text(LIBRARIES[library], encoding="utf-8")
        with _running(python, [str(script)], {}) as server:
            yield server


def is_installed(python: str, library: str) -> bool:
    """Return True if an interpreter can import a library."""
    test = f"import importlib.util, sys; sys.exit(importlib.util.find_spec({library!r}) is None)"
    return subprocess.run([python, "-c", test], check=False).returncode == 0


@contextmanager
def _running(python: str, words: Sequence[str], environment: dict[str, str]) -> Iterator[Server]:
    """Run a server, whose last word is a free port, until the end."""
    port = _free_port()
    process = subprocess.Popen(
        [python, *words, str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, **environment},
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
    deadline = time.monotonic() + _START
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
    raise RuntimeError(f"a server of the benchmark has not started within {_START:g} s")


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
