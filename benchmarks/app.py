"""The explorer in a browser beside its rivals: first load, sliders, many sessions, floods, frames of the viewer.

The rivals are the explorer of another checkout (option `--other`), and an empty page with one slider and one number in
each known library that is installed (for the interpreter of option `--python`). All take turns. Times are taken inside
the page: from the key that moves a slider to the frame in which the new text stands.
"""

from __future__ import annotations

import asyncio
import resource
import sys
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from statistics import median, quantiles
from typing import Any

from . import explorer_browser as browser_measures
from .explorer_servers import LIBRARIES, Server, is_installed, served_explorer, served_library
from .explorer_sessions import PanelSession, Session, SocketSession
from .report import Report, Rows
from .timing import short

_VISITS, _MOVES, _SESSIONS, _MEMORY_SESSIONS, _FLOOD, _IDLE = 3, 50, 50, 300, 10_000, 1000
_SLIDERS = ("load", "liner_thickness")
_HEADLINE, _TABLE = "dd[data-name=max_pressure]", ".models"
_EXPLORER_READY = "fieldset#inputs:not([disabled]) [data-name=load] input[type=range]"
_EMPTY_SLIDER, _EMPTY_NUMBER = (
    "[role=slider][tabindex], [role=slider] [tabindex], .noUi-handle, input[type=range]",
    ".number",
)


@dataclass(frozen=True)
class Explorer:
    """Explorer of a checkout, and the way to open a session of it."""

    server: Server
    session: Callable[[str], Session]

    def new_session(self) -> Session:
        return self.session(self.server.address)


def measure(other: str | None = None, python: str = sys.executable) -> Report | str:
    """Measure the explorer beside that of the checkout `other` and beside empty pages; `python` runs the rivals."""
    if find_spec("playwright") is None:
        return "playwright is not installed"
    _allow_files(3000)
    with ExitStack() as stack:
        explorers = {"ours": Explorer(stack.enter_context(served_explorer()), SocketSession)}
        if other is not None:
            served = stack.enter_context(served_explorer(python, Path(other)))
            explorers["other"] = Explorer(served, PanelSession)
        installed = [library for library in LIBRARIES if is_installed(python, library)]
        empty = {library: stack.enter_context(served_library(python, library)) for library in installed}
        with browser_measures.opened_browser() as browser:
            tables = [
                _first_loads(browser, explorers, empty),
                _slider_moves(browser, explorers, empty),
                _frames(browser, explorers),
            ]
        tables.append(_crowd(explorers))
    missing = [
        f"{library} is not installed: its empty page is missing." for library in LIBRARIES if library not in empty
    ]
    return Report(tables, [*_NOTES, *missing], ("tornado", *installed))


_NOTES = (
    "Servers, browser and script share the machine's cores.",
    "Other: the explorer of the checkout that --other names. Empty pages have one slider and one number.",
    "Slow line: 50 kB/s with 150 ms latency, by Chromium. Messages count as plain text in both numbers of bytes.",
    "Median, 95th percentile of 50 moves by key of each slider. The table counts from the key to its last change.",
    "Processor time is that of the server and its child processes, from /proc.",
)


def _allow_files(count: int) -> None:
    """Allow this process and its servers to open a number of files."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = count if hard == resource.RLIM_INFINITY else min(count, hard)
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, wanted), hard))


def _aim(value: float, limit: float) -> str:
    return f"aim {limit:g}: {'met' if value <= limit else 'missed'}"


def _first_loads(browser: Any, explorers: dict[str, Explorer], empty: dict[str, Server]) -> Rows:
    rows = Rows(
        "First load with empty caches",
        ("page", "requests", "kB sent", "kB plain", "s to inputs", "s, slow line", "verdict"),
    )
    pages = {name: (explorer.server.address, _EXPLORER_READY) for name, explorer in explorers.items()}
    pages |= {f"empty, {name}": (server.address, _EMPTY_SLIDER) for name, server in empty.items()}
    quick: dict[str, list[browser_measures.Load]] = {name: [] for name in pages}
    for _ in range(_VISITS):
        for name, page in pages.items():
            _announce(f"{name}: first load")
            quick[name].append(browser_measures.first_load(browser, *page, slow=False))
    for name, page in pages.items():
        _announce(f"{name}: first load by a slow line")
        slow = browser_measures.first_load(browser, *page, slow=True)
        load = quick[name][-1]
        verdict = f"kB: {_aim(load.sent / 1e3, 300)}; slow: {_aim(slow.seconds, 3)}" if name == "ours" else ""
        seconds = median(visit.seconds for visit in quick[name])
        cells = (load.requests, short(load.sent / 1e3), short(load.plain / 1e3), short(seconds), short(slow.seconds))
        rows.add(name, *cells, verdict)
    return rows


def _slider_moves(browser: Any, explorers: dict[str, Explorer], empty: dict[str, Server]) -> Rows:
    rows = Rows(
        "Moves of a slider", ("page", "to the number, ms", "to the table, ms", "server CPU a move, ms", "verdict")
    )
    for slider in _SLIDERS:
        for name, explorer in explorers.items():
            _announce(f"{name}: slider {slider}")
            numbers, tables, cpu = _moved(
                browser, explorer.server, f"[data-name={slider}] input[type=range]", (_HEADLINE, _TABLE)
            )
            verdicts = (_aim(_late(numbers), 100), _aim(_late(tables), 200), _aim(cpu, 15)) if name == "ours" else ()
            rows.add(f"{name}: {slider}", _shares(numbers), _shares(tables), short(cpu), "; ".join(verdicts))
    for name, server in empty.items():
        numbers, _, cpu = _moved(browser, server, _EMPTY_SLIDER, (_EMPTY_NUMBER,))
        rows.add(f"empty, {name}", _shares(numbers), "", short(cpu), "")
    return rows


def _moved(browser: Any, server: Server, slider: str, watched: Sequence[str]) -> tuple[list[float], list[float], float]:
    """Return the ms to the first text, those to the last change of the last text, and ms of the server for a move."""
    page = browser_measures.open_page(browser, server.address)
    page.locator(watched[-1]).first.wait_for()
    page.wait_for_timeout(1500)
    before = server.cpu()
    moments = browser_measures.reactions(page, slider, watched, _MOVES)
    cpu = 1e3 * (server.cpu() - before) / _MOVES
    page.context.close()
    never = float("inf")
    numbers = [never if first[0] is None else first[0] for first, _ in moments]
    tables = [never if final[-1] is None else final[-1] for _, final in moments]
    return numbers, tables, cpu


def _late(values: Sequence[float]) -> float:
    return quantiles(values, n=100, method="inclusive")[94]


def _shares(values: Sequence[float]) -> str:
    """Format the median and the 95th percentile."""
    return f"{short(median(values))}, {short(_late(values))}"


def _frames(browser: Any, explorers: dict[str, Explorer]) -> Rows:
    rows = Rows("Frames a second of the picture in three dimensions, turned by the pointer", ("page", "frames/s"))
    for name, explorer in explorers.items():
        _announce(f"{name}: frames a second")
        page = browser_measures.open_page(browser, f"{explorer.server.address}?view=cup")
        rows.add(name, short(browser_measures.frames_per_second(page, "canvas")))
        page.context.close()
    return rows


def _crowd(explorers: dict[str, Explorer]) -> Rows:
    rows = Rows("Many sessions, without a browser", ("what", *explorers, "verdict"))
    aims = {
        f"server CPU to open {_SESSIONS} sessions at once, s": (_opening, 12),
        f"another user's slowest answer in a flood of {_FLOOD} messages, s": (_flooded, 1),
        f"another user's slowest answer beside {_IDLE} idle connections, s": (_idle, 1),
        f"memory of {_MEMORY_SESSIONS} sessions over the first, MB": (_memory, 100),  # last: a server may refuse more
    }
    for what, (work, limit) in aims.items():
        values = {name: _measured(what, name, work, explorer) for name, explorer in explorers.items()}
        cells = (short(value) if value == value else "refused" for value in values.values())
        rows.add(what, *cells, _aim(values["ours"], limit))
    return rows


def _measured(what: str, name: str, work: Callable[[Explorer], Any], explorer: Explorer) -> float:
    """Return a measure of sessions; NaN if the server refuses so many of them."""
    _announce(f"{name}: {what}")
    try:
        return float(asyncio.run(work(explorer)))
    except ConnectionError:
        return float("nan")


def _announce(words: str) -> None:
    """Write the present measure: some take minutes, most of which are pauses between two moves."""
    print(f"measuring {words}", file=sys.stderr, flush=True)


async def _opened(explorer: Explorer, count: int) -> list[Session]:
    sessions = [explorer.new_session() for _ in range(count)]
    outcomes = await asyncio.gather(*(session.open() for session in sessions), return_exceptions=True)
    for failure in filter(None, outcomes):
        raise failure
    return sessions


async def _opening(explorer: Explorer) -> float:
    before = explorer.server.cpu()
    sessions = await _opened(explorer, _SESSIONS)
    seconds = explorer.server.cpu() - before
    _close(sessions)
    return seconds


async def _memory(explorer: Explorer) -> float:
    """Return the memory of many sessions over that of one, in MB."""
    sessions = await _opened(explorer, 1)
    await sessions[0].move(0.06)
    before = explorer.server.memory()
    try:
        for _ in range(_MEMORY_SESSIONS // 20):
            sessions += await _opened(explorer, 20)
        return explorer.server.memory() - before
    finally:
        _close(sessions)


async def _flooded(explorer: Explorer) -> float:
    flooding, user = await _opened(explorer, 2)
    flood = asyncio.create_task(flooding.flood(_FLOOD))
    slowest = await _slowest_answer(user)
    flooding.close()
    flood.cancel()
    user.close()
    return slowest


async def _idle(explorer: Explorer) -> float:
    silent = [explorer.new_session() for _ in range(_IDLE)]
    for part in range(0, _IDLE, 50):
        await asyncio.gather(*(session.connect() for session in silent[part : part + 50]))
    (user,) = await _opened(explorer, 1)
    slowest = await _slowest_answer(user)
    _close([user, *silent])
    return slowest


async def _slowest_answer(user: Session) -> float:
    return max([await user.move(0.05 + 0.01 * number) for number in range(10)])


def _close(sessions: Sequence[Session]) -> None:
    for session in sessions:
        session.close()
