"""The explorer in a browser: the first view, a slider that moves, and fifty sessions at once.

Times are taken inside the page: from the key that moves a slider to the picture in which the new number stands. The
rival is an empty page of the same library, one slider and one number, served and read in the same way in turns: what
is left between the two is the joint. Fifty sessions come from a script on loopback, each its own websocket, all moving
at once.
"""

from __future__ import annotations

import asyncio
import json
import re
import subprocess
import sys
import time
from collections.abc import Iterator
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
  const place_of = window.within(document, `.${slider}, [data-name="${slider}"]`);
  const handle = window.within(place_of.shadowRoot || place_of, ".noUi-handle, input[type=range]");
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
    from tests.app.browser import ARGUMENTS, chromium

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


class Session:
    """One user of fifty, as the browser's script would be: Bokeh's protocol over a websocket."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._socket: Any = None
        self._ears, self._asked = "", 0

    async def open(self) -> None:
        """Until the numbers of the page are there."""
        from tornado.httpclient import AsyncHTTPClient, HTTPRequest
        from tornado.websocket import websocket_connect

        page = await AsyncHTTPClient(max_clients=SESSIONS).fetch(f"{self._address}?preset=hip-28", request_timeout=120)
        (token,) = re.findall(r'"token":"([^"]+)"', page.body.decode())
        place, headers = f"{self._address.replace('http', 'ws')}ws", {"Origin": self._address.rstrip("/")}
        request = HTTPRequest(place, headers=headers, connect_timeout=120, request_timeout=120)
        self._socket = await websocket_connect(request, subprotocols=["bokeh", token])
        await self._receive()
        await self._send("PULL-DOC-REQ", {})
        while '"doc":' not in (document := await self._receive())[:20]:
            pass
        (self._ears,) = (
            each["id"] for each in _models(json.loads(document)) if each["attributes"].get("name") == "asked"
        )
        ready = {"type": "event", "name": "document_ready", "values": {"type": "map"}}
        await self._patch({"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": ready})
        while _NUMBER not in await self._receive():
            pass

    async def move(self, value: float) -> float:
        """Seconds until the page has answered a move of the clearance."""
        start = time.perf_counter()
        self._asked += 1
        words = json.dumps({"n": self._asked, "do": "edit", "name": "clearance", "value": value})
        await self._patch({"kind": "ModelChanged", "model": {"id": self._ears}, "attr": "value", "new": words})
        while _NUMBER not in await self._receive():
            pass
        return time.perf_counter() - start

    async def _patch(self, event: dict[str, Any]) -> None:
        await self._send("PATCH-DOC", {"events": [event]})

    async def _send(self, kind: str, content: dict[str, Any]) -> None:
        for part in ({"msgid": str(time.time()), "msgtype": kind}, {}, content):
            await self._socket.write_message(json.dumps(part))

    async def _receive(self) -> str:
        """The content of the next message."""
        header = json.loads(await self._part())
        await self._part()
        content = await self._part()
        for _ in range(2 * header.get("num_buffers", 0)):
            await self._socket.read_message()
        return content

    async def _part(self) -> str:
        part = await asyncio.wait_for(self._socket.read_message(), 60)
        if part is None:
            raise ConnectionError("the server closed a session")
        return str(part)


_NUMBER = "data-name='max_pressure'"


def _models(part: Any) -> Iterator[dict[str, Any]]:
    """All in a document."""
    if isinstance(part, dict) and isinstance(part.get("attributes"), dict):
        yield part
    for inner in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        yield from _models(inner)


async def user(address: str, number: int) -> tuple[float, list[float]]:
    """Seconds to open a session, and those from a slider to the new number."""
    start, one = time.perf_counter(), Session(address)
    await one.open()
    opening = time.perf_counter() - start
    return opening, [await one.move(0.0512 + 0.005 * ((turn + number) % 40)) for turn in range(TURNS)]


async def crowd_of(address: str) -> list[tuple[float, list[float]]]:
    return await asyncio.gather(*(user(address, number) for number in range(SESSIONS)))


def many(address: str, rows: Rows) -> None:
    found = asyncio.run(crowd_of(address))
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
