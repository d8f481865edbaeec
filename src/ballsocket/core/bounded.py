"""Numbers with an error bar, and their comparison with a limit: kept, undecided or exceeded."""

from __future__ import annotations

from enum import IntEnum
from math import inf
from typing import Any, NamedTuple

from .arrays import all_true, logical_not

_ESTIMATE_WIDTH = 0.06  # width of an error bar, relative to its value, above which a number is named as an estimate


class Verdict(IntEnum):
    """Result of the comparison of a number and its error bar with a limit.

    Arrays of verdicts have the integer codes. The largest of several verdicts holds for all limits together.
    """

    KEPT = 0
    UNDECIDED = 1
    EXCEEDED = 2

    @property
    def word(self) -> str:
        """Verdict in one word."""
        return self.name.lower()

    @property
    def sign(self) -> str:
        """Sign that stands before the word, for readers without colours."""
        return "✓?✗"[self]


class Bounded(NamedTuple):
    """Number, or array of numbers, with a lower and an upper bound: its error bar."""

    value: Any
    low: Any
    high: Any

    @property
    def is_estimate(self) -> bool:
        """True if the bar of a number is wider than 6 % of it, such as ±3 %."""
        return all_true(logical_not(self.high - self.low > _ESTIMATE_WIDTH * abs(self.value))) is False

    def verdict(self, *, low: float = -inf, high: float = inf) -> Verdict:
        """Compare a single number with a closed range, limits included."""
        return Verdict(int(self.decide(low=low, high=high)))

    def decide(self, *, low: Any = -inf, high: Any = inf) -> Any:
        """Compare numbers with a closed range, limits included.

        Returns
        -------
        int or array
            Codes of `Verdict`: kept if the whole bar lies inside the range, exceeded if it lies outside, else
            undecided. A missing number is undecided.
        """
        kept = (self.low >= low) & (self.high <= high)
        exceeded = (self.high < low) | (self.low > high)
        return (1 - kept) + exceeded

    def scaled(self, factor: float, error: float = 0.0) -> Bounded:
        """Multiply a number that is not negative by a positive factor with a relative error."""
        return Bounded(factor * self.value, factor * (1 - error) * self.low, factor * (1 + error) * self.high)


def exact_number(value: Any) -> Bounded:
    """Return a number without an error, such as a dimension."""
    return Bounded(value, value, value)
