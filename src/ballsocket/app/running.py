"""Long work of a page in a separate process, with a queue and limits of time and memory."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from importlib import import_module
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any

from ..core.executors.processes import available_cores, exit_with_parent
from ..core.threads import limit_threads
from ..core.validity import OutsideDomainError

MAX_SECONDS = 60.0  # processor time of a run in s
MAX_WAITING_SECONDS = 600.0  # longer than its processor time that a run may take: on a busy machine it waits
MAX_MEMORY = 4_000_000_000  # bytes that its process may ask for
MAX_KEPT_MEMORY = 2_000_000_000  # bytes that a process which waits for the next run has asked for
Report = Callable[[Any], None]  # callback for intermediate results, as plain values
Work = Callable[[Report], Any]  # function that a process runs; it, its result and its reports must be picklable


QUEUE: list[Run] = []  # runs of all pages, of which the first `MAX_AT_WORK` are at work
MAX_AT_WORK = max(1, available_cores())


@dataclass(frozen=True, kw_only=True)
class Reached:
    """Progress of a run: `share` from 0 to 1, and the present step in words."""

    share: float
    words: str


@dataclass(frozen=True, kw_only=True)
class RunRefused:
    """Reason for a missing result, in one sentence."""

    why: str


@dataclass(frozen=True)
class RunFinished:
    """Last news of a run: the value that its work returned."""

    value: Any


class Workers:
    """Processes for one run at a time, of which one waits for the next run: a new one takes seconds for its imports."""

    def __init__(self) -> None:
        self._ready: tuple[Any, Connection] | None = None

    def prepare(self) -> None:
        """Start a process that waits for its work, unless one waits already."""
        self._ready = self._ready or self._started()

    def take(self) -> tuple[Any, Connection]:
        """Return a process and the connection to it, which takes the work and brings the news."""
        ready, self._ready = self._ready, None
        return ready if ready is not None and ready[0].is_alive() else self._started()

    def give_back(self, process: Any, pipe: Connection) -> None:
        """Let a process that has finished its run wait for the next, unless one waits already or it has grown large."""
        if self._ready is None and reserved_memory(process.pid) < MAX_KEPT_MEMORY:
            self._ready = process, pipe
        else:
            end(process, pipe)

    def close(self) -> None:
        """End the process that waits."""
        if self._ready is not None:
            end(*self._ready)
            self._ready = None

    def _started(self) -> tuple[Any, Connection]:
        context = get_context("spawn")
        pipe, there = context.Pipe()
        process = context.Process(target=_run, args=(there,), daemon=True)
        with limit_threads():
            process.start()
        there.close()
        return process, pipe


WORKERS = Workers()  # of all pages


def end(process: Any, pipe: Connection) -> None:
    """Kill the process of a run and close the connection to it."""
    process.kill()
    process.join()
    pipe.close()


@dataclass(eq=False)
class Run:
    """Run of some work, at most `longest` seconds of processor time; poll `news`, which first waits in the queue."""

    work: Work
    longest: float = MAX_SECONDS
    _process: Any = field(default=None, init=False)
    _pipe: Connection | None = field(default=None, init=False)
    _start: float = field(default=0.0, init=False)
    _before: float = field(default=0.0, init=False)

    def news(self) -> Any:
        """Return the news since the last call, or None; the last news is `RunFinished` or `RunRefused`."""
        if self._process is None:
            if self not in QUEUE:
                QUEUE.append(self)
            if QUEUE.index(self) >= MAX_AT_WORK:
                return Reached(share=0.0, words="waiting: other computations are running")
            try:
                self._process, self._pipe = WORKERS.take()
            except OSError as error:
                self.stop()
                return RunRefused(why=f"no process could be started: {error.strerror or error}")
            self._start, self._before = time.monotonic(), processor_seconds(self._process.pid)  # of its start
            with suppress(ConnectionError):  # of a worker that has ended: its pipe says so below
                self._pipe.send(self.work)
        assert self._pipe is not None
        if self._pipe.poll():
            try:
                message = self._pipe.recv()
            except (EOFError, ConnectionError):
                message = RunRefused(why="the process ended unexpectedly, perhaps for lack of memory")
            if isinstance(message, RunFinished):
                WORKERS.give_back(self._process, self._pipe)
                self._process = self._pipe = None
            if isinstance(message, RunFinished | RunRefused):
                self.stop()
            return message
        taken = time.monotonic() - self._start
        if taken > self.longest and processor_seconds(self._process.pid) - self._before > self.longest:
            self.stop()
            return RunRefused(why=f"stopped after {self.longest:g} s of processor time, the limit of a run")
        if taken > self.longest + MAX_WAITING_SECONDS:
            self.stop()
            return RunRefused(why=f"stopped after {taken:.0f} s without a result")
        return None

    def stop(self) -> None:
        """End the run, and free its place for the next."""
        if self in QUEUE:
            QUEUE.remove(self)
        if self._process is not None and self._pipe is not None:
            end(self._process, self._pipe)


PREPARE_AFTER = 2.0  # s after the opening of a page, or after a run
_IMPORTED = (".views.hip_runs", ".views.finite_elements", ".views.real_cup")  # modules of most runs


def processor_seconds(pid: int) -> float:
    """Processor time in s of a process and of its children, ended ones included; 0 for a process that has ended."""
    import psutil

    total = 0.0
    with suppress(psutil.Error):
        worker = psutil.Process(pid)
        for process in (worker, *worker.children(recursive=True)):
            times = process.cpu_times()
            total += times.user + times.system + times.children_user + times.children_system
    return total


def reserved_memory(pid: int) -> int:
    """Memory in bytes that a process has asked for, in use or not; 0 for a process that has ended."""
    import psutil

    with suppress(psutil.Error):
        return psutil.Process(pid).memory_info().vms
    return 0


def _run(pipe: Connection) -> None:
    exit_with_parent()
    limit_memory()
    for module in _IMPORTED:
        if not pipe.poll():
            import_module(module, __package__)
    while True:
        try:
            work: Work = pipe.recv()
        except EOFError:  # nothing more is to be done
            return
        try:
            pipe.send(RunFinished(work(pipe.send)))
        except (ValueError, OutsideDomainError, ImportError) as error:
            pipe.send(RunRefused(why=str(error)))
        except MemoryError:
            pipe.send(RunRefused(why=f"this needs more than {MAX_MEMORY / 1e9:g} GB, the memory limit of a run"))
        except Exception as error:
            pipe.send(RunRefused(why=f"this run failed: {type(error).__name__}: {error}"))
            raise


def limit_memory() -> None:
    """Limit the memory of this process and of its children to `MAX_MEMORY` each."""
    try:
        import resource
    except ImportError:  # no such limits on this system: only the time is limited
        return
    resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY, MAX_MEMORY))
