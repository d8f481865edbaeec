"""The explorer in headless Chromium: first load and slider moves; beside an empty page of each installed library.

An empty page has one slider and one number. Times are taken inside the page, from the key that moves a slider to the
frame in which the new text stands: median, and 95th percentile in brackets. Servers, browser and this program share
the machine.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from statistics import median, quantiles
from typing import Any

from .explorer_pages import LIBRARIES, Server, served_explorer, served_library
from .report import Row, digits
from .timing import MissingError

VISITS, MOVES, PATIENCE = 3, 50, 120.0
SLOW_LINE = {"offline": False, "latency": 150, "downloadThroughput": 50_000, "uploadThroughput": 50_000}
READY = "fieldset#inputs:not([disabled]) [data-name=load] input[type=range]"
SLIDER, NUMBER, TABLE = "[data-name=load] input[type=range]", "dd[data-name=max_pressure]", ".models"
EMPTY_SLIDER = "[role=slider][tabindex], [role=slider] [tabindex], input[type=range]"

WATCH = """
window.inside = (root, selector) => root.querySelector(selector) ??
  [...root.querySelectorAll("*")].filter((node) => node.shadowRoot)
    .map((node) => window.inside(node.shadowRoot, selector)).find(Boolean) ?? null;
window.textOf = (selector) => {
  const element = window.inside(document, selector);
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


@dataclass
class Load:
    """First load of a page: seconds to its inputs, and kB as sent."""

    seconds: float = 0.0
    sent: float = 0.0


def measure() -> list[Row]:
    missing = [library for library in LIBRARIES if find_spec(library) is None]
    with ExitStack() as stack:
        browser = stack.enter_context(_opened_browser())
        ours = stack.enter_context(served_explorer())
        empty = {name: stack.enter_context(served_library(name)) for name in LIBRARIES if name not in missing}
        pages = {"": (ours.address, READY), **{name: (server.address, EMPTY_SLIDER) for name, server in empty.items()}}
        loads = {name: _first_load(browser, *page) for name, page in pages.items()}
        slow = {name: _first_load(browser, *page, line=SLOW_LINE) for name, page in pages.items()}
        number, cpu = _moves(browser, ours, SLIDER, NUMBER)
        table, _ = _moves(browser, ours, SLIDER, TABLE, final=True)
        moves = {name: _moves(browser, server, EMPTY_SLIDER, ".number") for name, server in empty.items()}
    rows = []
    for work, found in (
        ("first load, sent", {name: f"{digits(load.sent)} kB" for name, load in loads.items()}),
        ("first load, to the inputs", {name: f"{digits(load.seconds)} s" for name, load in loads.items()}),
        ("first load, 50 kB/s and 150 ms", {name: f"{digits(load.seconds)} s" for name, load in slow.items()}),
        ("move of a slider, to the number", {"": number, **{name: move for name, (move, _) in moves.items()}}),
        ("move of a slider, processor time", {"": cpu, **{name: its for name, (_, its) in moves.items()}}),
    ):
        rows += [Row(work, found[""], f"empty page of {name}: {found[name]}") for name in empty]
        rows += [
            Row(work, found[""], f"empty page of {name}: skipped, not installed", skipped=True) for name in missing
        ]
        if not empty:
            rows.append(Row(work, found[""]))
    return [*rows, Row("move of a slider, to the table", table)]


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


def _first_load(browser: Any, address: str, ready: str, line: dict[str, Any] | None = None) -> Load:
    """Median of some visits; one by a slow line."""
    visits = [_visit(browser, address, ready, line) for _ in range(1 if line else VISITS)]
    return sorted(visits, key=lambda load: load.seconds)[len(visits) // 2]


def _visit(browser: Any, address: str, ready: str, line: dict[str, Any] | None) -> Load:
    page, load = _new_page(browser), Load()
    tools = page.context.new_cdp_session(page)
    tools.send("Network.enable")
    if line:
        tools.send("Network.emulateNetworkConditions", line)

    def finished(event: dict[str, Any]) -> None:
        load.sent += 1e-3 * event["encodedDataLength"]

    def message(event: dict[str, Any]) -> None:
        load.sent += 1e-3 * len(event["response"]["payloadData"].encode())

    tools.on("Network.loadingFinished", finished)
    tools.on("Network.webSocketFrameReceived", message)
    start = time.perf_counter()
    page.goto(address, wait_until="commit", timeout=1e3 * PATIENCE)
    page.locator(ready).first.wait_for(timeout=1e3 * PATIENCE)
    load.seconds = time.perf_counter() - start
    page.wait_for_timeout(0 if line else 2000)  # for bytes that come after the inputs
    page.context.close()
    return load


def _moves(browser: Any, server: Server, slider: str, text: str, final: bool = False) -> tuple[str, str]:
    """Move a slider by keys, to and fro: ms to the first or the final change of a text, and of the processor."""
    page = _new_page(browser)
    page.add_init_script(WATCH)
    page.goto(server.address)
    page.locator(text).first.wait_for()
    page.wait_for_timeout(1500)
    page.locator(slider).first.focus()
    before, found = server.processor_time(), []
    for number in range(MOVES):
        page.evaluate("(selector) => window.watch(selector)", text)
        page.keyboard.press(("ArrowRight", "ArrowLeft")[number // 10 % 2])
        moment = page.evaluate("window.reaction")[final]
        found.append(float("inf") if moment is None else float(moment))
    taken = 1e3 * (server.processor_time() - before) / MOVES
    page.context.close()
    late = quantiles(found, n=100, method="inclusive")[94]
    return f"{digits(median(found))} ms ({digits(late)})", f"{digits(taken)} ms"
