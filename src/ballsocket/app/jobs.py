"""Long work of a page: threads for drawings and files, processes for simulations."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Hashable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextvars import Context, ContextVar, copy_context
from typing import Any

from .running import MAX_SECONDS, Run, RunFinished, RunRefused, Work

_POLL_INTERVAL = 0.15  # s between two questions for news
_SHARED: dict[Hashable, tuple[Run, list[Job]]] = {}  # runs by the key of their work, with the jobs that wait for them
_MAX_WAITING = 8


def call_later(seconds: float, function: Callable[[], None]) -> asyncio.TimerHandle | None:
    """Call a function later in the running event loop; return None without a loop."""
    try:
        return asyncio.get_running_loop().call_later(seconds, function)
    except RuntimeError:
        return None


class Job:
    """Long work of one view in at most one process; its news go to `heard` with the key of the work.

    Jobs that ask for work with equal keys share one process.
    """

    def __init__(self, heard: Callable[[Hashable, Any], None], longest: float = MAX_SECONDS) -> None:
        self._heard, self._longest = heard, longest
        self._key: Hashable = None
        self._run: Run | None = None
        self._context = Context()
        self._timer: asyncio.TimerHandle | None = None

    @property
    def works(self) -> bool:
        return self._run is not None

    def ask(self, key: Hashable, work: Work) -> None:
        """Start this work unless it runs already, and stop any other."""
        if self._run is not None and key == self._key:
            return
        self.stop()
        self._key, self._context = key, copy_context()
        if key not in _SHARED:
            _SHARED[key] = Run(work, longest=self._longest), []
        self._run, jobs = _SHARED[key]
        jobs.append(self)
        self._timer = call_later(0.0, self._poll)

    def _poll(self) -> None:
        self.hear()
        if self._run is not None:
            self._timer = call_later(_POLL_INTERVAL, self._poll)

    def hear(self) -> None:
        """Read the news; the first call starts the process."""
        if self._run is None:
            return
        run, news = self._run, self._run.news()
        if news is not None:
            for job in list(_SHARED[self._key][1]):
                if job._run is run:
                    job._context.run(job._receive, news)

    def _receive(self, news: Any) -> None:
        key = self._key
        if isinstance(news, RunFinished | RunRefused):
            self.stop()
        self._heard(key, news)

    def stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        if self._run is not None:
            jobs = _SHARED[self._key][1]
            jobs.remove(self)
            if not jobs:
                del _SHARED[self._key]
                self._run.stop()
        self._key = self._run = self._timer = None


_DRAWING_THREAD = ThreadPoolExecutor(max_workers=1, thread_name_prefix="drawing")
"""One at a time: they share what a figure is drawn with, and leave the other core to the pages."""


Outcome = Future[Any] | asyncio.Future[Any]  # of a function that has run: its result, or what it raised


class PageThread:
    """Drawings and files of one page, of which at most one waits for the shared thread: pages take turns."""

    current: ContextVar[PageThread | None] = ContextVar("current", default=None)
    """Thread of the page whose request is handled; None without a browser."""

    def __init__(self) -> None:
        self._turn = asyncio.Lock()
        self._tasks: set[asyncio.Task[None]] = set()

    def add(self, work: Callable[[], Any], on_done: Callable[[Outcome], None]) -> None:
        """Run a function after those that wait, and pass its outcome to the page unless it is closed."""
        if len(self._tasks) > _MAX_WAITING:
            raise ValueError(f"{_MAX_WAITING} drawings of this page wait already: try again in a moment")
        task = asyncio.create_task(self._run(work, on_done))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _run(self, work: Callable[[], Any], on_done: Callable[[Outcome], None]) -> None:
        async with self._turn:
            outcome = asyncio.get_running_loop().run_in_executor(_DRAWING_THREAD, work)
            await asyncio.wait([outcome])
        on_done(outcome)

    def close(self) -> None:
        """Forget all that waits."""
        for task in self._tasks:
            task.cancel()


def run_in_thread(work: Callable[[], Any], on_done: Callable[[Outcome], None]) -> None:
    """Run a function in a thread and pass its outcome to an open page; wait for it without a browser."""
    thread = PageThread.current.get()
    if thread is None:
        future = _DRAWING_THREAD.submit(work)
        wait([future])
        on_done(future)
    else:
        thread.add(work, on_done)
