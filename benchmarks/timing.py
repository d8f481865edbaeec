"""Repeated, interleaved timing: ours, rival, ours, rival, ..., so that a machine that slows down slows both."""

from __future__ import annotations

import gc
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from statistics import median
from typing import Any

from threadpoolctl import threadpool_limits

Work = Callable[[], object]


@dataclass(frozen=True)
class Spread:
    """The same number measured again and again."""

    values: tuple[float, ...]

    @property
    def median(self) -> float:
        return median(self.values)

    def over(self, other: Spread) -> Spread:
        """The quotient, round by round."""
        return Spread(tuple(mine / its for mine, its in zip(self.values, other.values, strict=True)))

    def less(self, other: Spread) -> Spread:
        """The difference, round by round."""
        return Spread(tuple(mine - its for mine, its in zip(self.values, other.values, strict=True)))

    def per(self, unit: float) -> Spread:
        """In other units: seconds `per(1e-9 * n)` are nanoseconds for one of n."""
        return Spread(tuple(value / unit for value in self.values))

    def __str__(self) -> str:
        return f"{short(self.median)} ({short(min(self.values))}..{short(max(self.values))})"


def short(value: float) -> str:
    """Three digits, without an exponent."""
    digits = 0 if abs(value) >= 99.95 else 1 if abs(value) >= 9.995 else 2 if abs(value) >= 0.9995 else 3
    return f"{value:.{digits}f}"


Spreads = dict[str, Spread]


Clock = Callable[[], float]


def interleaved(repeats: int, work: dict[str, Work], clock: Clock = time.perf_counter) -> tuple[Spreads, Spreads]:
    """Seconds that each piece of work takes, in `repeats` rounds in which all take turns; one more is not counted.

    A turn is two calls, kept apart: the first finds the caches and the free memory as the others left them, the
    second as its like did. The second is what a program that keeps calling sees. Where the work neither waits nor has
    more than one thread the clock may be `time.process_time`, which other programs on the machine hardly disturb.
    """
    first: dict[str, list[float]] = {name: [] for name in work}
    again: dict[str, list[float]] = {name: [] for name in work}
    for _ in range(1 + repeats):
        for name, each in work.items():
            gc.collect()
            first[name].append(_seconds(each, clock))
            again[name].append(_seconds(each, clock))
    return _counted(first), _counted(again)


def _seconds(work: Work, clock: Clock = time.perf_counter) -> float:
    start = clock()
    work()
    return clock() - start


def _counted(seconds: dict[str, list[float]]) -> Spreads:
    return {name: Spread(tuple(values[1:])) for name, values in seconds.items()}


@contextmanager
def one_core() -> Iterator[bool]:
    """Keeps this process on one core, with one thread of linear algebra; False where the system cannot do that.

    Two threads that wait for each other on one core would double the process time of small products.
    """
    with threadpool_limits(1):
        if not hasattr(os, "sched_setaffinity"):
            yield False
            return
        before = os.sched_getaffinity(0)
        os.sched_setaffinity(0, {max(before)})
        try:
            yield True
        finally:
            os.sched_setaffinity(0, before)


def apart(work: Callable[[], Any], **environment: str) -> Any:
    """What the work answers in a fresh process with that environment."""
    before = {name: os.environ.get(name) for name in environment}
    os.environ.update(environment)
    try:
        with get_context("spawn").Pool(1) as pool:
            return pool.apply(work)
    finally:
        for name, value in before.items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value
