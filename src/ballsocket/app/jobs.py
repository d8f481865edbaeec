"""Long work of a page: threads for drawings and files, processes for simulations."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import panel as pn
from tornado.ioloop import IOLoop

from .channel import Channel
from .running import Reached, Run, RunFinished, RunRefused, Work, looked_at
from .widgets.words import alert, progress

LONGEST = 60.0  # s, of work that nobody gave longer
_EVERY = 150  # ms between two questions for news


class Job:
    """Long work of one view in at most one process; its news go to `handle_news` with the key of the work."""

    def __init__(self, heard: Callable[[Hashable, Any], None], longest: float = LONGEST) -> None:
        self._heard, self._longest = heard, longest
        self._key: Hashable = None
        self._run: Run | None = None
        self._asking: Any = None

    @property
    def works(self) -> bool:
        """State of the job: True while a process runs."""
        return self._run is not None

    def ask(self, key: Hashable, work: Work) -> None:
        """Start this work unless it runs already, and stop any other."""
        if self._run is not None and key == self._key:
            return
        self.stop()
        self._key, self._run = key, Run(work, longest=self._longest)
        self._asking = pn.state.add_periodic_callback(self.hear, period=_EVERY)

    def hear(self) -> None:
        """Poll for news; the first call starts the process."""
        if self._run is None:
            return
        if not looked_at():
            self.stop()
            return
        news, key = self._run.news(), self._key
        if isinstance(news, RunFinished | RunRefused):
            self.stop()
        if news is not None:
            self._heard(key, news)

    def stop(self) -> None:
        """End the process."""
        if self._asking is not None:
            self._asking.stop()
        if self._run is not None:
            self._run.stop()
        self._key = self._run = self._asking = None


class ViewJob(Job):
    """Long work of a view, reported in the elements `progress` and `trouble` of the view."""

    def __init__(
        self, channel: Channel, view: str, show_result: Callable[[Any, Any], None], longest: float = LONGEST
    ) -> None:
        super().__init__(self._show_news, longest)
        self._channel, self._view, self._done = channel, view, show_result

    def put(self, element: str, html: str) -> None:
        """Fill an element of the view."""
        self._channel.put(f"#{self._view}-{element}", html)

    def _show_news(self, key: Hashable, news: Any) -> None:
        """Show news of the work on the page."""
        if isinstance(news, Reached):
            self.put("progress", progress(news.words, news.share, stop=f"{self._view}.stop"))
        elif isinstance(news, RunRefused):
            self.put("progress", "")
            self.put("trouble", alert(news.why))
        elif isinstance(news, RunFinished):
            self.put("progress", "")
            self._done(key, news.value)
        self._channel.send()


_DRAWING_THREAD = ThreadPoolExecutor(max_workers=1, thread_name_prefix="drawing")
"""One at a time: they share what a figure is drawn with, and leave the other core to the pages."""


def run_in_thread(work: Callable[[], Any], on_done: Callable[[Future[Any]], None]) -> None:
    """Run a function in a thread and pass its outcome to an open page; run it at once without a page."""
    document = pn.state.curdoc
    context = None if document is None else document.session_context
    if context is None:
        on_done(_completed(work))
        return
    loop = IOLoop.current()

    def report(future: Future[Any]) -> None:
        if not context.destroyed:
            document.add_next_tick_callback(lambda: on_done(future))

    _DRAWING_THREAD.submit(work).add_done_callback(lambda future: loop.add_callback(report, future))


def _completed(work: Callable[[], Any]) -> Future[Any]:
    future: Future[Any] = Future()
    try:
        future.set_result(work())
    except Exception as error:
        future.set_exception(error)
    return future
