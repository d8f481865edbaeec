"""The explorer in a browser: the first view, a slider that moves, and fifty sessions at once.

Times are taken inside the page: from the key that moves a slider to the picture in which the new number stands. The
rival is an empty page of the same library, one slider and one number, served and read in the same way in turns: what
is left between the two is the joint. Fifty sessions come from a script on loopback, each its own websocket, all moving
at once.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from importlib.util import find_spec
from statistics import quantiles
from typing import Any

from .report import Report, Rows
from .timing import Spread, short

MOVES, VISITS, SESSIONS, TURNS = 60, 6, 50, 6
AIM_VIEW, AIM_MOVE = 3.0, 0.150  # seconds
_EMPTY = """
import panel as pn
def page():
    slider = pn.widgets.FloatSlider(start=0, end=5000, step=50, value=3000, css_classes=["load"])
    number = pn.pane.HTML()
    def show(*_):
        number.object = f"<dl><dd data-name='max_pressure' data-value='{slider.value!r}'>{slider.value}</dd></dl>"
    slider.param.watch(show, "value")
    show()
    return pn.Column(slider, number)
pn.extension()
server = pn.serve(page, port=0, start=False, show=False)
print(f"http://127.0.0.1:{server.port}/ (Ctrl-C", flush=True)
server.start()
server.io_loop.start()
"""
_WITHIN = """
window.within = (root, selector) => {
  const found = root.querySelector(selector);
  if (found) return found;
  for (const each of root.querySelectorAll("*")) {
    const inner = each.shadowRoot && window.within(each.shadowRoot, selector);
    if (inner) return inner;
  }
  return null;
};
"""
_MOVE = """
([slider, key]) => new Promise((done) => {
  const place = "dd[data-name=max_pressure]";
  const read = () => { const at = window.within(document, place); return at && at.dataset.value; };
  const handle = window.within(window.within(document, "." + slider).shadowRoot, ".noUi-handle");
  const before = read(), start = performance.now();
  const look = () => (read() !== before ? done(performance.now() - start) : requestAnimationFrame(look));
  handle.dispatchEvent(new KeyboardEvent("keydown", { key, code: key, bubbles: true, cancelable: true }));
  requestAnimationFrame(look);
})
"""


@contextmanager
def served(*words: str) -> Iterator[str]:
    """The address that a server prints, and the server until the end."""
    process = subprocess.Popen([sys.executable, *words], stdout=subprocess.PIPE, encoding="utf-8")
    assert process.stdout is not None
    try:
        yield next(line.split()[0] for line in process.stdout if line.startswith("http"))
    finally:
        process.terminate()
        process.communicate(timeout=20)


def opened(browser: Any, address: str) -> tuple[Any, float]:
    """A page in a new window with empty caches, and the seconds until its first number is seen."""
    page = browser.new_context(viewport={"width": 1280, "height": 900}).new_page()
    page.add_init_script(_WITHIN)
    start = time.perf_counter()
    page.goto(address)
    page.locator("dd[data-name=max_pressure]").wait_for()
    return page, time.perf_counter() - start


def moves(page: Any, slider: str, count: int) -> list[float]:
    """Seconds that single steps take, to and fro."""
    keys = ["ArrowRight", "ArrowLeft"]
    page.wait_for_timeout(800)
    found = []
    for number in range(count):
        found.append(page.evaluate(_MOVE, [slider, keys[number // 10 % 2]]) / 1e3)
        page.wait_for_timeout(40)
    return found


def shares(seconds: list[float]) -> str:
    """Median and 95th percentile in ms."""
    percent = quantiles(seconds, n=100, method="inclusive")
    return f"{short(1e3 * percent[49])}, {short(1e3 * percent[94])}"


def in_the_browser(ours: str, empty: str, view: Rows, moved: Rows) -> None:
    from playwright.sync_api import sync_playwright
    from tests.browser import ARGUMENTS, chromium

    with sync_playwright() as tools:
        browser = tools.chromium.launch(executable_path=chromium(), args=ARGUMENTS)
        first: dict[str, list[float]] = {ours: [], empty: []}
        for _ in range(VISITS):
            for address in (ours, empty):
                page, seconds = opened(browser, address)
                first[address].append(seconds)
                page.context.close()
        mine, rival = (Spread(tuple(first[address])) for address in (ours, empty))
        verdict = "met" if mine.median <= AIM_VIEW else "missed"
        view.add("first view, empty caches", mine, rival, f"aim {AIM_VIEW:g}: {verdict}")
        bare, _ = opened(browser, empty)
        for model in ("hess-forsbach", "tabulated", "exact"):
            page, _ = opened(browser, f"{ours}?answered_by={model}")
            for slider, what in (("load", "force"), ("clearance", "clearance")):
                taken = moves(page, slider, MOVES)
                floor = moves(bare, "load", MOVES)
                late = quantiles(taken, n=100, method="inclusive")[94]
                verdict = "met" if late <= AIM_MOVE else "missed"
                moved.add(f"{model}: {what}", shares(taken), shares(floor), f"aim {1e3 * AIM_MOVE:g}: {verdict}")
            page.context.close()
        browser.close()


def session(address: str, number: int) -> tuple[float, list[float]]:
    """One user of fifty: seconds to open a session, and those from a slider to the new number."""
    from bokeh.client import pull_session

    start = time.perf_counter()
    found = pull_session(url=f"{address}?preset=hip-28")
    opening = time.perf_counter() - start
    models = list(found.document.models)
    (slider,) = (
        child
        for model in models
        if "clearance" in (model.css_classes if hasattr(model, "css_classes") else [])
        for child in model.references()
        if type(child).__name__ == "Slider"
    )
    (place,) = (model for model in models if "data-name" in str(getattr(model, "text", "")))
    taken = []
    for turn in range(TURNS):
        before, start = place.text, time.perf_counter()
        slider.value = 0.05 + 0.005 * ((turn + number) % 40)
        while place.text == before:
            found.force_roundtrip()
            if time.perf_counter() - start > 60:
                raise TimeoutError("a session had no answer for a minute")
        taken.append(time.perf_counter() - start)
    found.close()
    return opening, taken


def many(address: str, rows: Rows) -> None:
    with ThreadPoolExecutor(SESSIONS) as pool:
        found = list(pool.map(lambda number: session(address, number), range(SESSIONS)))
    openings = [opening for opening, _ in found]
    taken = [seconds for _, each in found for seconds in each]
    rows.add("open a session", shares(openings), f"{max(openings):.1f}")
    rows.add("a slider to its number", shares(taken), f"{max(taken):.1f}")


def measure() -> Report | str:
    for module in ("panel", "playwright"):
        if find_spec(module) is None:
            return f"{module} is not installed"
    view = Rows("Seconds until the first number is seen", ("what", "ours", "an empty page", "verdict"))
    moved = Rows("From a slider to the new picture, ms: median, 95th percentile", ("what", "ours", "empty", "verdict"))
    crowd = Rows(
        f"{SESSIONS} sessions at once, each {TURNS} moves without a pause: median, 95th percentile in ms",
        ("what", "ms", "longest, s"),
    )
    with ExitStack() as stack:
        ours = stack.enter_context(served("-m", "ballsocket", "app", "--no-browser", "--port", "0"))
        empty = stack.enter_context(served("-c", _EMPTY))
        in_the_browser(ours, empty, view, moved)
        many(ours, crowd)
    return Report(
        [view, moved, crowd],
        ["Server, browser and script share the machine's two cores. No session of the fifty had an error."],
        ("panel", "bokeh"),
    )
