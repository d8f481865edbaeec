"""What a view has done in a process beside the server: started, heard of, and stopped."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any

import panel as pn

from .channel import Channel
from .running import Done, Reached, Run, RunRefused, Work, looked_at
from .words import alert, progress

LONGEST = 60.0  # s, of work that nobody gave longer
_EVERY = 150  # ms between two questions for news


class Job:
    """The long work of one view: at most one process, for what is wanted now.

    Parameters
    ----------
    heard : callable
        Told news of the work by its key: `Reached`, whatever it tells, and at last `Done` or `Refused`.
    longest : float
        Seconds that it may take.
    """

    def __init__(self, heard: Callable[[Hashable, Any], None], longest: float = LONGEST) -> None:
        self._heard, self._longest = heard, longest
        self._key: Hashable = None
        self._run: Run | None = None
        self._asking: Any = None

    @property
    def works(self) -> bool:
        """Whether something is being done."""
        return self._run is not None

    def ask(self, key: Hashable, work: Work) -> None:
        """Have this done, and nothing else; what is being done already goes on."""
        if self._run is not None and key == self._key:
            return
        self.stop()
        self._key, self._run = key, Run(work, longest=self._longest)
        self._asking = pn.state.add_periodic_callback(self.hear, period=_EVERY)

    def hear(self) -> None:
        """Ask for news; the first time the process is started."""
        if self._run is None:
            return
        if not looked_at():
            self.stop()
            return
        news, key = self._run.news(), self._key
        if isinstance(news, Done | RunRefused):
            self.stop()
        if news is not None:
            self._heard(key, news)

    def stop(self) -> None:
        """End what is being done."""
        if self._asking is not None:
            self._asking.stop()
        if self._run is not None:
            self._run.stop()
        self._key = self._run = self._asking = None


class ViewJob(Job):
    """The long work of a view that is told in its places on the page: `progress`, `trouble`, and what it fills itself.

    Parameters
    ----------
    channel : Channel
    view : str
        What the names of its places begin with.
    done : callable
        Takes the outcome by its key, and shows it.
    longest : float
        Seconds that the work may take.
    """

    def __init__(self, channel: Channel, view: str, done: Callable[[Any, Any], None], longest: float = LONGEST) -> None:
        super().__init__(self._told, longest)
        self._channel, self._view, self._done = channel, view, done

    def put(self, place: str, html: str) -> None:
        """Fill a place of the view."""
        self._channel.put(f"#{self._view}-{place}", html)

    def _told(self, key: Hashable, news: Any) -> None:
        """News, which the page is told of its own accord."""
        if isinstance(news, Reached):
            self.put("progress", progress(news.words, news.share, stop=f"{self._view}.stop"))
        elif isinstance(news, RunRefused):
            self.put("progress", "")
            self.put("trouble", alert(news.why))
        elif isinstance(news, Done):
            self.put("progress", "")
            self._done(key, news.value)
        self._channel.send()


class CachedRun:
    """The latest outcomes by what they are of, for every page."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._found: OrderedDict[Hashable, Any] = OrderedDict()

    def get(self, key: Hashable) -> Any:
        """The outcome; None where there is none."""
        return self._found.get(key)

    def put(self, key: Hashable, found: Any) -> None:
        """Keep one, and forget the oldest where there are too many."""
        self._found[key] = found
        while len(self._found) > self._most:
            self._found.popitem(last=False)
