"""Measures of a page in headless Chromium: first load, reaction to a slider, frames a second."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

SLOW_LINE = {"offline": False, "latency": 150, "downloadThroughput": 50_000, "uploadThroughput": 50_000}
"""Network of 50 kB/s, with 150 ms latency, in the words of Chromium."""

PATIENCE = 120.0
"""Seconds until a page counts as one that never appears."""

_SETTLED, _SEEN = 400, 4000
"""ms without a change after which a text counts as final, and the longest time that one is watched."""

_WATCH = """
window.inside = (root, selector) => {
  const direct = root.querySelector(selector);
  if (direct) return direct;
  for (const element of root.querySelectorAll("*")) {
    const inner = element.shadowRoot && window.inside(element.shadowRoot, selector);
    if (inner) return inner;
  }
  return null;
};
window.everywhere = (root, selector) => [
  ...root.querySelectorAll(selector),
  ...[...root.querySelectorAll("*")].filter((node) => node.shadowRoot)
    .flatMap((node) => window.everywhere(node.shadowRoot, selector)),
];
window.textOf = (selector) => {
  const element = window.inside(document, selector);
  return element && (element.dataset.value || element.textContent);
};
window.watch = (selectors) => {
  window.reaction = new Promise((resolve) => {
    const watched = performance.now();
    let start = null;
    const last = selectors.map(window.textOf), first = selectors.map(() => null), final = [...first];
    window.addEventListener("keydown", () => { start = performance.now(); }, { once: true, capture: true });
    const look = () => {
      const now = performance.now();
      selectors.forEach((selector, number) => {
        const text = window.textOf(selector);
        if (start === null || text === last[number]) return;
        last[number] = text;
        if (first[number] === null) first[number] = now - start;
        final[number] = now - start;
      });
      const changed = first.every((moment) => moment !== null);
      const waited = now - (start ?? watched); // a key that no element has received is no reaction
      if ((changed && waited - Math.max(...final) > SETTLED) || waited > SEEN) resolve({ first, final });
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
};
""".replace("SETTLED", str(_SETTLED)).replace("SEEN", str(_SEEN))
_FRAMES = """
(selector) => new Promise((resolve) => {
  const canvas = window.everywhere(document, selector).find((element) => element.clientWidth);
  const box = canvas.getBoundingClientRect(), frames = [];
  const send = (kind, x, target) => target.dispatchEvent(new PointerEvent(kind, {
    clientX: x, clientY: box.top + box.height / 2, bubbles: true, pointerId: 1, isPrimary: true, buttons: 1,
  }));
  canvas.setPointerCapture = () => {};
  send("pointerdown", box.left + 10, canvas);
  const draw = (moment) => {
    frames.push(moment);
    send("pointermove", box.left + 10 + (frames.length % 200), canvas);
    if (moment - frames[0] < 3000) requestAnimationFrame(draw);
    else { send("pointerup", box.left, canvas); resolve(1000 * (frames.length - 1) / (moment - frames[0])); }
  };
  requestAnimationFrame(draw);
})
"""


@dataclass
class Load:
    """First load of a page: seconds to its inputs, requests, and bytes as sent and as read."""

    seconds: float = 0.0
    requests: int = 0
    sent: int = 0
    plain: int = 0


@contextmanager
def opened_browser() -> Iterator[Any]:
    """Open headless Chromium."""
    from playwright.sync_api import sync_playwright
    from tests.app.browser import ARGUMENTS, chromium

    with sync_playwright() as tools:
        browser = tools.chromium.launch(executable_path=chromium(), args=ARGUMENTS)
        yield browser
        browser.close()


def open_page(browser: Any, address: str) -> Any:
    """Return a page in a new window with empty caches."""
    page = browser.new_context(viewport={"width": 1280, "height": 900}).new_page()
    page.add_init_script(_WATCH)
    page.goto(address)
    return page


def first_load(browser: Any, address: str, ready: str, slow: bool) -> Load:
    """Measure the first load of a page until the element `ready` is there, on a slow line or on a quick one."""
    from playwright.sync_api import TimeoutError as LateError

    page = browser.new_context(viewport={"width": 1280, "height": 900}).new_page()
    load, tools = Load(), page.context.new_cdp_session(page)
    tools.send("Network.enable")
    if slow:
        tools.send("Network.emulateNetworkConditions", SLOW_LINE)
    _count_bytes(tools, load)
    start = time.perf_counter()
    try:
        page.goto(address, wait_until="commit", timeout=1e3 * PATIENCE)
        page.locator(ready).first.wait_for(timeout=1e3 * (PATIENCE + start - time.perf_counter()))
        load.seconds = time.perf_counter() - start
        page.wait_for_timeout(0 if slow else 2000)  # for bytes that come after the inputs
    except LateError:
        load.seconds = float("inf")
    finally:
        page.context.close()
    return load


def _count_bytes(tools: Any, load: Load) -> None:
    """Count the bytes of requests and of messages."""

    def count(name: str, size: Callable[[dict[str, Any]], tuple[int, int, int]]) -> None:
        def add(event: dict[str, Any]) -> None:
            requests, sent, plain = size(event)
            load.requests += requests
            load.sent += sent
            load.plain += plain

        tools.on(f"Network.{name}", add)

    def message(event: dict[str, Any]) -> tuple[int, int, int]:
        size = len(event["response"]["payloadData"].encode())
        return 0, size, size

    count("loadingFinished", lambda event: (1, int(event["encodedDataLength"]), 0))
    count("dataReceived", lambda event: (0, 0, int(event["dataLength"])))
    count("webSocketFrameReceived", message)


def reactions(page: Any, slider: str, watched: Sequence[str], moves: int) -> list[tuple[list[float], list[float]]]:
    """Move a slider by keys, to and fro; return the ms to the first and to the last change of each watched text."""
    handle = page.locator(slider).first
    handle.focus()
    results = []
    for number in range(moves):
        page.evaluate("(selectors) => window.watch(selectors)", list(watched))
        page.keyboard.press(("ArrowRight", "ArrowLeft")[number // 10 % 2])
        moment = page.evaluate("window.reaction")
        results.append((moment["first"], moment["final"]))
    return results


def frames_per_second(page: Any, canvas: str) -> float:
    """Turn a picture in three dimensions for 3 s by the pointer, and count the frames."""
    page.locator(canvas).first.wait_for(timeout=1e3 * PATIENCE)
    page.wait_for_timeout(500)
    return float(page.evaluate(_FRAMES, canvas))
