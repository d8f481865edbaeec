"""Extent of the suite: everything with `pytest --long`; without it a few spread cases of each kind."""

from collections.abc import Iterable
from typing import TypeVar

One = TypeVar("One")

whole = False
"""Whether every case runs; set by `conftest.py` before the tests are read."""


def some(cases: Iterable[One], few: int = 3) -> list[One]:
    """All cases, or in a quick run a few of them: the first, the last, and evenly between."""
    every = list(cases)
    if whole or len(every) <= few:
        return every
    return [every[round(place * (len(every) - 1) / max(few - 1, 1))] for place in range(few)]


def either(quick: One, long: One) -> One:
    """A number of points, repeats or examples: that of a quick run, or that of a long one."""
    return long if whole else quick
