"""Resumable runs: numbered pieces of work whose results are stored one by one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ..executors.processes import Engine, Work


class PieceStore(ABC):
    """Base class of stores for the results of numbered pieces of work.

    Each worker process receives a copy of the store.
    """

    @abstractmethod
    def load(self, numbers: Sequence[int]) -> dict[int, Any]:
        """Load the stored results of some pieces, by number.

        Missing or damaged pieces and those of another run are omitted.
        """

    @abstractmethod
    def save(self, number: int, result: Any) -> Any:
        """Store the result of a piece of work; return the value to send back to the calling process.

        Raises
        ------
        OSError
            The store is not writable or the disk is full.
        """


@dataclass(frozen=True, eq=False)
class PieceRun:
    """Resumable run of numbered pieces of work: only pieces without a stored result are computed.

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
        """Results of earlier runs, by number of the piece."""
        return {} if self.store is None else self.store.load(self.numbers)

    @cached_property
    def missing(self) -> list[int]:
        """Numbers of the pieces without a stored result, in the order of `numbers`."""
        return [number for number in self.numbers if number not in self.stored]

    def compute_missing(self, engine: Engine) -> Iterator[tuple[int, Any]]:
        """Compute and store the missing pieces; yield (number, result) in the order of completion."""
        return engine.run(self.work if self.store is None else _StoringWork(self.work, self.store), self.missing)


@dataclass(frozen=True, eq=False)
class _StoringWork:
    """Work function that also stores each result, in the process that computed it."""

    work: Work
    store: PieceStore

    def __call__(self, number: int) -> Any:
        return self.store.save(number, self.work(number))
