"""Work of a page that takes long, in a process of its own: with a turn to wait for, and limits on time and memory."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any

from ..core.executors.processes import available_cores, exit_with_parent, limit_threads
from ..core.validity import OutsideDomainError

LONGEST = 60.0
"""Seconds that a run may take."""

MEMORY = 4_000_000_000
"""Bytes that its process may ask for."""

Told = Callable[[Any], None]
"""Takes what is known on the way: plain values."""

Work = Callable[[Told], Any]
"""What is done; the process must be able to receive it, and the page what it returns and tells."""


class RunQueue:
    """Runs in the order in which they came; so many of the first are at work."""

    def __init__(self, places: int) -> None:
        self._places = places
        self._runs: list[Run] = []

    def __len__(self) -> int:
        return len(self._runs)

    def turn(self, run: Run) -> bool:
        """Whether it may work; who is not in line stands behind the others."""
        if run not in self._runs:
            self._runs.append(run)
        return self._runs.index(run) < self._places

    def leave(self, run: Run) -> None:
        """Make room."""
        if run in self._runs:
            self._runs.remove(run)


LINE = RunQueue(max(1, available_cores()))
"""As many runs at once as there are cores, whoever asks."""


@dataclass(frozen=True, kw_only=True)
class Reached:
    """How far a run is: `share` from 0 to 1, and in words what is done now."""

    share: float
    words: str


@dataclass(frozen=True, kw_only=True)
class RunRefused:
    """Why there is no answer, in one sentence."""

    why: str


@dataclass(frozen=True)
class Done:
    """The last word of a run: what its work returned."""

    value: Any


@dataclass(eq=False)
class Run:
    """One run. Ask `news` now and then; it waits for a free place first, and is killed when it takes too long.

    Parameters
    ----------
    work : function
    longest : float
        Seconds it may take.
    """

    work: Work
    longest: float = LONGEST
    _process: Any = field(default=None, init=False)
    _pipe: Connection | None = field(default=None, init=False)
    _start: float = field(default=0.0, init=False)

    def news(self) -> Any:
        """What has happened since it was last asked, None if nothing; the last is `Done` or `Refused`."""
        if self._process is None:
            if not LINE.turn(self):
                return Reached(share=0.0, words="waiting for a free place: others are running")
            try:
                self._begin()
            except OSError as error:
                self.stop()
                return RunRefused(why=f"no process could be started: {error.strerror or error}")
        assert self._pipe is not None
        if self._pipe.poll():
            try:
                found = self._pipe.recv()
            except EOFError:
                found = RunRefused(why="its process died; it may have had too little memory")
            if isinstance(found, Done | RunRefused):
                self.stop()
            return found
        if time.monotonic() - self._start > self.longest:
            self.stop()
            return RunRefused(why=f"stopped after {self.longest:g} s, the longest that a run may take here")
        return None

    def _begin(self) -> None:
        context = get_context("spawn")
        pipe, there = context.Pipe(duplex=False)
        process = context.Process(target=_run, args=(there, self.work), daemon=True)
        with limit_threads():
            process.start()
        there.close()
        self._process, self._pipe, self._start = process, pipe, time.monotonic()

    def stop(self) -> None:
        """End it, wherever it is, and give its place to the next."""
        LINE.leave(self)
        if self._process is not None:
            self._process.kill()
            self._process.join()
        if self._pipe is not None:
            self._pipe.close()


def looked_at() -> bool:
    """Whether somebody still has the page open: nobody else waits for an answer."""
    from panel import state  # a run's process needs none of it

    document = state.curdoc
    context = None if document is None else document.session_context
    return context is None or context.session is None or context.session.connection_count > 0


def _run(pipe: Connection, work: Work) -> None:
    """In the process."""
    exit_with_parent()
    limit_memory()
    try:
        pipe.send(Done(work(pipe.send)))
    except (ValueError, OutsideDomainError, ImportError) as error:
        pipe.send(RunRefused(why=str(error)))
    except MemoryError:
        pipe.send(RunRefused(why=f"this takes more than {MEMORY / 1e9:g} GB, the most that a run may have here"))


def limit_memory() -> None:
    """Hold this process, and those that it starts, to `MEMORY` each."""
    try:
        import resource
    except ImportError:  # no such limits on this system: only the time is limited
        return
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
