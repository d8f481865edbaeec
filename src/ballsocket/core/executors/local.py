"""Who computes: this process, or several on this machine. The same pieces of work, whoever does them."""

from __future__ import annotations

import os
import select
import signal
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context, parent_process
from threading import Thread
from typing import Any, Protocol

from ..checks import require

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

MOST = 1000
"""Processes, or workers, that are started."""

Work = Callable[[int], Any]
"""Does the piece of a number. Other processes must be able to receive it: no lambda, nothing local."""


class Engine(Protocol):
    """Does numbered pieces of work."""

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Each number with what its work returned, in any order, as soon as it is there."""
        ...


@dataclass(frozen=True)
class Serial:
    """This process, one piece after the other."""

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Each number with what its work returned, in order."""
        for number in numbers:
            yield number, work(number)


@dataclass(frozen=True, kw_only=True)
class Processes:
    """Processes of this machine, each with one thread of linear algebra.

    A process that dies takes its piece along, which is done anew. The script that starts this needs the guard
    `if __name__ == "__main__":`, as always with `multiprocessing`.

    Parameters
    ----------
    workers : int, optional
        As many as there are cores.
    retries : int
        How often a piece may lose its process before that is an error.

    Raises
    ------
    ValueError
        Fewer than one worker, or more than `MOST`.
    """

    workers: int | None = None
    retries: int = 3

    def __post_init__(self) -> None:
        if self.workers is not None:
            require("workers", self.workers, 1 <= self.workers <= MOST, f"at least one process, at most {MOST}")

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Each number with what its work returned, as soon as it is there.

        Raises
        ------
        RuntimeError
            A piece that lost its process too often.
        """
        left, lost = deque(numbers), Counter[int]()
        while left:
            with _pool(self._count, work) as pool:
                for number, answer in _answers(pool, left, 2 * self._count):
                    if answer is _LOST:
                        lost[number] += 1
                        left.append(number)
                    else:
                        yield number, answer.result()
            often = [number for number, times in lost.items() if times > self.retries]
            if often:
                raise RuntimeError(f"piece {often[0]} lost its process {lost[often[0]]} times; what is done is kept")

    @property
    def _count(self) -> int:
        return self.workers or available_cores()


def available_cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


_LOST: Any = object()


def _answers(pool: ProcessPoolExecutor, left: deque[int], most: int) -> Iterator[tuple[int, Any]]:
    """Takes numbers from `left`, a few at a time; ends when none is left, or when the pool has broken."""
    waiting: dict[Future[Any], int] = {}
    broken = False
    while waiting or (left and not broken):
        try:
            while left and len(waiting) < most and not broken:
                waiting[pool.submit(_call, left[0])] = left[0]
                left.popleft()
        except BrokenProcessPool:
            broken = True
        for future in wait(waiting, return_when=FIRST_COMPLETED).done:
            number = waiting.pop(future)
            broken |= isinstance(future.exception(), BrokenProcessPool)
            yield number, _LOST if isinstance(future.exception(), BrokenProcessPool) else future


@contextmanager
def _pool(workers: int, work: Work) -> Iterator[ProcessPoolExecutor]:
    with one_thread_each():
        pool = ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=_begin, initargs=(work,))
        try:
            yield pool
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


_THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


@contextmanager
def one_thread_each() -> Iterator[None]:
    """For processes that are started inside: linear algebra of two processes on the same cores is many times slower."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


_work: Work | None = None


def _begin(work: Work) -> None:
    """In each process, once: the work is sent there only once, and Ctrl-C is left to the process that asked."""
    global _work
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    leave_with_parent()
    _work = work


def leave_with_parent() -> None:
    """End this process when its parent ends, however that ends.

    The parent holds the other end of a pipe, which closes with it. The system then sends a signal that ends this
    process even where no Python thread can run. A thread does the same on systems without such signals.
    """
    Thread(target=_leave_with, args=(os.getppid(),), daemon=True).start()
    if fcntl is not None and hasattr(os, "O_ASYNC"):
        parent = parent_process()
        pipe = _STDIN if parent is None else parent.sentinel
        signal.signal(signal.SIGIO, signal.SIG_DFL)
        fcntl.fcntl(pipe, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)
        if any(events & select.POLLHUP for _, events in _polled(pipe)):
            os._exit(1)  # the parent has ended before the signal was set


def _polled(descriptor: int) -> list[tuple[int, int]]:
    poll = select.poll()
    poll.register(descriptor, select.POLLHUP)
    return poll.poll(0)


_STDIN = 0


def _leave_with(parent: int) -> None:
    """A process whose parent was killed has nobody to work for."""
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)


def _call(number: int) -> Any:
    assert _work is not None
    return _work(number)
