"""The explorer in headless Chromium: first load and slider moves.

Times are taken inside the page, from the key that moves a slider to the frame in which the new text stands: median, and
95th percentile in brackets. Server, browser and this program share the machine.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from statistics import median, quantiles
from typing import Any

from .report import Row, digits
from .start import checkout_environment
from .timing import MissingError

VISITS, MOVES, PATIENCE = 3, 50, 120.0
SLOW_LINE = {"offline": False, "latency": 150, "downloadThroughput": 50_000, "uploadThroughput": 50_000}
READY = "fieldset#inputs:not([disabled]) [data-name=load] input[type=range]"
SLIDER, NUMBER, TABLE = "[data-name=load] input[type=range]", "dd[data-name=max_pressure]", ".models"

WATCH = """
window.textOf = (selector) => {
  const element = document.querySelector(selector);
  return element && (element.dataset.value || element.textContent);
};
window.watch = (selector) => {
  window.reaction = new Promise((resolve) => {
    const watched = performance.now();
    let start = null, last = window.textOf(selector), first = null, final = null;
    window.addEventListener("keydown", () => { start = performance.now(); }, { once: true, capture: true });
    const look = () => {
      const now = performance.now(), text = window.textOf(selector);
      if (start !== null && text !== last) {
        last = text;
        final = now - start;
        if (first === null) first = final;
      }
      const waited = now - (start ?? watched); // a key that no element has received is no reaction
      if ((first !== null && waited - final > 400) || waited > 4000) resolve([first, final]);
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
};
"""


@dataclass(frozen=True)
class Server:
    """Running explorer with its address and its process."""

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


def measure() -> list[Row]:
    with _opened_browser() as browser, _served_explorer() as server:
        visits = [_visit(browser, server.address) for _ in range(VISITS)]
        seconds, sent, requests = sorted(visits)[VISITS // 2]
        slow, *_ = _visit(browser, server.address, SLOW_LINE)
        number, cpu, moved = _moves(browser, server, NUMBER)
        table, *_ = _moves(browser, server, TABLE, final=True)
    return [
        Row("first load, sent", f"{digits(sent)} kB"),
        Row("first load, requests", str(requests)),
        Row("first load, to the inputs", f"{digits(seconds)} s"),
        Row("first load, 50 kB/s and 150 ms", f"{digits(slow)} s"),
        Row("move of a slider, to the number", number),
        Row("move of a slider, processor time", cpu),
        Row("move of a slider, sent before compression", moved),
        Row("move of a slider, to the table", table),
    ]


@contextmanager
def _served_explorer() -> Iterator[Server]:
    """Run the explorer of this checkout on a free port, which its first line states."""
    words = [sys.executable, "-m", "ballsocket", "app", "--no-browser", "--port", "0"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=checkout_environment()) as process:
        assert process.stdout is not None
        try:
            yield Server(process.stdout.readline().split()[0], process.pid)
        finally:
            process.terminate()


@contextmanager
def _opened_browser() -> Iterator[Any]:
    path = os.environ.get("BALLSOCKET_CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
    if path is None:
        raise MissingError("no chromium")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as tools:
        browser = tools.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-gpu"])
        yield browser
        browser.close()


def _new_page(browser: Any) -> Any:
    """A page in a new window with empty caches."""
    return browser.new_context(viewport={"width": 1280, "height": 900}).new_page()


def _visit(browser: Any, address: str, line: dict[str, Any] | None = None) -> tuple[float, float, int]:
    """Load the page for the first time: seconds to its inputs, kB as sent, and number of requests."""
    page = _new_page(browser)
    sent: list[float] = []
    requests: list[Any] = []
    tools = page.context.new_cdp_session(page)
    tools.send("Network.enable")
    if line:
        tools.send("Network.emulateNetworkConditions", line)

    tools.on("Network.loadingFinished", lambda event: sent.append(event["encodedDataLength"]))
    tools.on(
        "Network.webSocketFrameReceived", lambda event: sent.append(len(event["response"]["payloadData"].encode()))
    )
    for kind in ("request", "websocket"):
        page.on(kind, lambda one: requests.append(one))
    start = time.perf_counter()
    page.goto(address, wait_until="commit", timeout=1e3 * PATIENCE)
    page.locator(READY).first.wait_for(timeout=1e3 * PATIENCE)
    seconds = time.perf_counter() - start
    page.wait_for_timeout(0 if line else 2000)  # for bytes that come after the inputs
    page.context.close()
    return seconds, 1e-3 * sum(sent), len(requests)


def _moves(browser: Any, server: Server, text: str, final: bool = False) -> tuple[str, str, str]:
    """Move the slider by keys, to and fro: ms to the first or the final change of a text, ms of the processor, kB."""
    page, sent = _new_page(browser), list[int]()
    page.add_init_script(WATCH)
    page.on("websocket", lambda line: line.on("framereceived", lambda frame: sent.append(len(frame))))
    page.goto(server.address)
    page.locator(text).first.wait_for()
    page.wait_for_timeout(1500)
    page.locator(SLIDER).first.focus()
    sent.clear()
    before, found = server.processor_time(), []
    for number in range(MOVES):
        page.evaluate("(selector) => window.watch(selector)", text)
        page.keyboard.press(("ArrowRight", "ArrowLeft")[number // 10 % 2])
        moment = page.evaluate("window.reaction")[final]
        found.append(float("inf") if moment is None else float(moment))
    taken = 1e3 * (server.processor_time() - before) / MOVES
    page.context.close()
    late = quantiles(found, n=100, method="inclusive")[94]
    moved = f"{digits(median(found))} ms ({digits(late)})"
    return moved, f"{digits(taken)} ms", f"{digits(1e-3 * sum(sent) / MOVES)} kB"
