"""Executors of numbered pieces of work on this machine, with its memory, disk space and processor cores."""

from __future__ import annotations

import os
import select
import shutil
import signal
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from dataclasses import dataclass
from multiprocessing import get_context, parent_process
from pathlib import Path
from threading import Thread
from typing import Any, Protocol

from ..checks import require
from ..threads import limit_threads

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

MAX_WORKERS = 1000  # largest number of worker processes

Work = Callable[[int], Any]
"""Function that computes the piece with a given number. It must be picklable: no lambda, no local function."""

_QUEUED_PER_WORKER = 2  # submitted pieces per worker: one is computed while the next one waits
_PARENT_CHECK_INTERVAL = 0.5  # seconds between two checks that the parent process still runs
_PARENT_ENDED = 1  # exit status of a process whose parent process has ended

_WORKER_DIED: Any = object()  # result of a piece whose worker process died


class Engine(Protocol):
    """Protocol of an executor of numbered pieces of work."""

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Compute pieces of work; yield (number, result) in the order of completion."""
        ...


@dataclass(frozen=True)
class Serial:
    """Executor that computes one piece after another in this process."""

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Compute pieces of work; yield (number, result) in the order of `numbers`."""
        for number in numbers:
            yield number, work(number)


@dataclass(frozen=True, kw_only=True)
class Processes:
    """Executor that distributes pieces over worker processes of this machine.

    Each process uses one thread of linear algebra.

    If a worker process dies, its piece is computed again. As always with `multiprocessing`, a script that uses this
    executor needs the guard `if __name__ == "__main__":`.

    Parameters
    ----------
    workers : int, optional
        Number of processes. Default: number of available cores.
    retries : int
        Number of times that the worker process of one piece may die before an error is raised.

    Raises ValueError: fewer than one worker, or more than `MAX_WORKERS`.
    """

    workers: int | None = None
    retries: int = 3

    def __post_init__(self) -> None:
        if self.workers is not None:
            require("workers", self.workers, 1 <= self.workers <= MAX_WORKERS, f"it must be 1 to {MAX_WORKERS}")

    def run(self, work: Work, numbers: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Compute pieces of work in worker processes; yield (number, result) in the order of completion.

        Raises RuntimeError: the worker process of a piece died more than `retries` times.
        """
        workers = self.workers or available_cores()
        pending, deaths = deque(numbers), Counter[int]()
        while pending:
            with limit_threads(), ExitStack() as at_end:
                pool = ProcessPoolExecutor(
                    workers, mp_context=get_context("spawn"), initializer=_initialize_worker, initargs=(work,)
                )
                at_end.callback(pool.shutdown, cancel_futures=True)
                for number, future in _submit_until_worker_dies(pool, pending, _QUEUED_PER_WORKER * workers):
                    if future is _WORKER_DIED:
                        deaths[number] += 1
                        pending.append(number)
                    else:
                        yield number, future.result()
            failed = [number for number, count in deaths.items() if count > self.retries]
            if failed:
                raise RuntimeError(
                    f"the worker process of piece {failed[0]} died {deaths[failed[0]]} times; run again to resume"
                )


def available_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _submit_until_worker_dies(
    pool: ProcessPoolExecutor, pending: deque[int], max_queued: int
) -> Iterator[tuple[int, Any]]:
    """Submit pending pieces to worker processes; yield the number and completed future of each piece.

    It stops when a worker process has died. The affected pieces have `_WORKER_DIED` in place of a future.
    """
    submitted: dict[Future[Any], int] = {}
    broken = False
    while submitted or (pending and not broken):
        try:
            while pending and len(submitted) < max_queued and not broken:
                submitted[pool.submit(_compute_piece, pending[0])] = pending[0]
                pending.popleft()
        except BrokenProcessPool:
            broken = True
        for future in wait(submitted, return_when=FIRST_COMPLETED).done:
            number = submitted.pop(future)
            died = isinstance(future.exception(), BrokenProcessPool)
            broken |= died
            yield number, _WORKER_DIED if died else future


_work: Work | None = None  # work of this worker process


def _initialize_worker(work: Work) -> None:
    """Store the work function of a worker process, and ignore Ctrl-C, which the parent process handles."""
    global _work
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    exit_with_parent()
    _work = work


def _compute_piece(number: int) -> Any:
    assert _work is not None
    return _work(number)


def exit_with_parent() -> None:
    """End this process when its parent process ends or is killed.

    The parent holds the other end of a pipe, which closes with it. The system then sends a signal that ends this
    process even while no Python thread can run. A thread does the same on systems without such signals.
    """
    Thread(target=_watch_parent, args=(os.getppid(),), daemon=True).start()
    if fcntl is not None and hasattr(os, "O_ASYNC"):
        parent = parent_process()
        pipe = 0 if parent is None else parent.sentinel  # 0 is the standard input
        signal.signal(signal.SIGIO, signal.SIG_DFL)
        fcntl.fcntl(pipe, fcntl.F_SETOWN, os.getpid())
        fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)
        poll = select.poll()
        poll.register(pipe, select.POLLHUP)
        if any(events & select.POLLHUP for _, events in poll.poll(0)):
            os._exit(_PARENT_ENDED)  # the parent ended before the signal was set


def _watch_parent(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_PARENT_CHECK_INTERVAL)
    os._exit(_PARENT_ENDED)


_ASSUMED_MEMORY = 4_000_000_000  # memory in bytes that is assumed if the system does not state it


def check_memory(subject: str, size: float) -> None:
    """Check that `size` bytes fit into the available memory.

    Raises ValueError: the memory is too small; the message begins with `subject`, a plural noun.
    """
    free = available_memory()
    if size > free:
        raise ValueError(f"{subject} take about {size_text(size)}, and there are {size_text(free)} of memory")


def available_memory() -> int:
    """Return the available memory in bytes; half of the installed memory if the system does not state it."""
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
    except (OSError, ValueError, AttributeError):
        return _ASSUMED_MEMORY


def available_disk_space(path: Path) -> int:
    """Return the free bytes of the disk on which a path lies, or will lie."""
    folder = path.absolute()
    while not folder.exists():
        folder = folder.parent
    return shutil.disk_usage(folder).free


def count_text(count: int) -> str:
    """Format a count with spaces between groups of three digits, such as "14 800"; plain below 10000."""
    return str(count) if abs(count) < 10_000 else f"{count:,}".replace(",", " ")


def size_text(size: float) -> str:
    """Format a size in bytes with three digits, such as "1.5 GB"."""
    units = ["B", "kB", "MB", "GB", "TB"]
    while size >= 1000 and len(units) > 1:
        size /= 1000
        units.pop(0)
    return f"{size:.3g} {units[0]}"
