"""Results of long work, stored by their question for a day."""

from __future__ import annotations

import pickle
import time
from collections import OrderedDict
from collections.abc import Hashable
from dataclasses import dataclass, field
from typing import Any

from ..problem import Joint

SECONDS = 86_400.0  # seconds that a result is stored


def without_name(joint: Joint) -> Joint:
    """Return a joint without its name and source, on which no result depends."""
    return joint.replace(name="", source="")


@dataclass(eq=False)
class ResultStore:
    """Latest results by their question, shared by all pages."""

    max_count: int = 400
    max_bytes: int = 200_000_000  # total size, as they come from another process
    seconds: float = SECONDS
    _results: OrderedDict[Hashable, tuple[Any, int, float]] = field(default_factory=OrderedDict, init=False)
    _bytes: int = field(default=0, init=False)

    def get(self, question: Hashable) -> Any:
        """Return a stored result; None without one."""
        oldest = time.monotonic() - self.seconds
        for name in [name for name, (_, _, stored) in self._results.items() if stored < oldest]:
            self._remove(name)
        if question not in self._results:
            return None
        self._results.move_to_end(question)
        return self._results[question][0]

    def put(self, question: Hashable, result: Any) -> None:
        """Store a result; beyond the limits, remove those that were not shown for the longest time."""
        self._remove(question)
        size = len(pickle.dumps(result))
        self._results[question] = result, size, time.monotonic()
        self._bytes += size
        while len(self._results) > self.max_count or self._bytes > self.max_bytes:
            self._remove(next(iter(self._results)))

    def _remove(self, question: Hashable) -> None:
        self._bytes -= self._results.pop(question, (None, 0, 0.0))[1]


RESULTS = ResultStore()  # results of the long views of all pages
