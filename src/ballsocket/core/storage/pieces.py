"""Resumable runs: numbered pieces of work whose results are stored one by one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ..executors.processes import Engine, Work


class PieceStore(ABC):
    """Store of the results of numbered pieces of work; worker processes receive a copy of it."""

    @abstractmethod
    def load(self, numbers: Sequence[int]) -> dict[int, Any]:
        """Load the stored results by number, without the pieces that are missing, damaged or from another run."""

    @abstractmethod
    def save(self, number: int, result: Any) -> Any:
        """Store the result of a piece, and return the value to send to the calling process.

        Raises
        ------
        OSError
            The store is not writable or the disk is full.
        """


@dataclass(frozen=True, eq=False)
class PieceRun:
    """Run of numbered pieces of work that computes only the pieces without a stored result.

    Parameters
    ----------
    work : function
        Computes the result of a piece from its number. Worker processes must be able to import it.
    numbers : sequence of int
        Numbers of the pieces.
    store : PieceStore, optional
        Each result is stored by the process that computed it. A killed run loses only unfinished pieces.
    """

    work: Work
    numbers: Sequence[int]
    store: PieceStore | None = None

    @cached_property
    def stored(self) -> dict[int, Any]:
        """Results that were stored before this run, by number."""
        return {} if self.store is None else self.store.load(self.numbers)

    @cached_property
    def missing(self) -> list[int]:
        """Numbers of the pieces without a stored result, in the order of `numbers`."""
        return [number for number in self.numbers if number not in self.stored]

    def compute_missing(self, engine: Engine) -> Iterator[tuple[int, Any]]:
        """Compute and store the missing pieces, and yield each number with its result as soon as it is finished."""
        return engine.run(self.work if self.store is None else _StoringWork(self.work, self.store), self.missing)


@dataclass(frozen=True, eq=False)
class _StoringWork:
    """Work that stores each result in the process that computed it."""

    work: Work
    store: PieceStore

    def __call__(self, number: int) -> Any:
        return self.store.save(number, self.work(number))
