"""Timing in turns: ours, rival, ours, rival, ..., so that a machine that slows down slows both.

Times are processor time on one core with one thread of linear algebra, which other programs hardly disturb. Child
processes count.
"""

from __future__ import annotations

import gc
import os
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from statistics import median

from threadpoolctl import threadpool_limits

Call = Callable[[], object]
Clock = Callable[[], float]
wall_time = time.perf_counter


class MissingError(Exception):
    """A benchmark cannot run here: a program or a device is missing."""


@dataclass(frozen=True, eq=False)
class Job:
    """A call to time; `count` is the number of presses, steps or patients in one call."""

    call: Call
    count: int = 1


@dataclass(frozen=True)
class Spread:
    """Seconds of one item, measured in several rounds."""

    values: tuple[float, ...]

    @property
    def median(self) -> float:
        return median(self.values)

    def over(self, other: Spread) -> Spread:
        """Divide round by round."""
        return Spread(tuple(mine / its for mine, its in zip(self.values, other.values, strict=True)))


def processor_time() -> float:
    """Processor time of this process and of its finished child processes."""
    try:
        from resource import RUSAGE_CHILDREN, getrusage
    except ImportError:  # Windows
        return time.process_time()
    children = getrusage(RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def in_turns(jobs: Iterable[Job], repeats: int, clock: Clock = processor_time) -> dict[Job, Spread]:
    """Time each job once a round; the first round does not count unless it is the only one.

    `wall_time` may use all cores.
    """
    seconds: dict[Job, list[float]] = {job: [] for job in jobs}
    with nullcontext() if clock is wall_time else one_core():
        for _ in range(1 + repeats):
            for job, times in seconds.items():
                gc.collect()
                start = clock()
                job.call()
                times.append((clock() - start) / job.count)
    return {job: Spread(tuple(times[1:] if repeats else times)) for job, times in seconds.items()}


@contextmanager
def one_core() -> Iterator[None]:
    """Keep this process on one core where the system can, with one thread of linear algebra."""
    with threadpool_limits(1):
        if not hasattr(os, "sched_setaffinity"):
            yield
            return
        before = os.sched_getaffinity(0)
        os.sched_setaffinity(0, {max(before)})
        try:
            yield
        finally:
            os.sched_setaffinity(0, before)
