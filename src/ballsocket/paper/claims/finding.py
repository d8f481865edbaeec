"""A claim: a sentence of the paper or of somebody else, the numbers behind it, and a verdict."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

from ...contact import Model


class Verdict(Enum):
    """What became of a sentence."""

    HOLDS = "holds"
    WITHIN = "holds within"
    FAILS = "does not hold"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A claim with its number.

    Attributes
    ----------
    name : str
        Short, for links.
    where : str
        Section or figure of the paper, or whose numbers they are.
    sentence : str
        What is said, in our own words.
    numbers : dict of str to float
        What was computed, by name with its unit.
    verdict : Verdict
    miss : float
        By how much the sentence is off at worst, in `unit`; where it holds within that, the verdict says so.
    unit : str
    comment : str
        Why, where the verdict is not plain.
    code : str
        The function that found it, for readers who want to see how; set by `ledger`.
    """

    name: str
    where: str
    sentence: str
    numbers: dict[str, float]
    verdict: Verdict
    miss: float = 0.0
    unit: str = "%"
    comment: str = ""
    code: str = ""

    @property
    def text(self) -> str:
        """The verdict in words: "holds", "holds within 3.3 %", "does not hold"."""
        within = f" {self.miss:.2g} {self.unit}" if self.verdict is Verdict.WITHIN else ""
        return self.verdict.value + within

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "name": self.name,
            "where": self.where,
            "sentence": self.sentence,
            "numbers": self.numbers,
            "verdict": self.verdict.value,
            "text": self.text,
            "comment": self.comment,
            "code": self.code,
        }


Claim = Callable[[Model], Finding]
"""Judged by a reference that plays the part of the paper's finite elements."""

SHOWN = ("indentation", "max_pressure", "half_angle")

CLOSE, WIDE = 2.0, 5.0
"""In percent: what is called equal holds up to the first, and holds within its miss up to the second."""


def graded(miss: float, close: float = CLOSE, wide: float = WIDE) -> dict[str, Any]:
    """Verdict and miss of a sentence that is off by so much: fields of a `Finding`."""
    verdict = Verdict.HOLDS if miss <= close else Verdict.WITHIN if miss <= wide else Verdict.FAILS
    return {"verdict": verdict, "miss": float(miss)}


def true(good: Any) -> dict[str, Any]:
    """Verdict of a sentence that is true or not."""
    return {"verdict": Verdict.HOLDS if bool(good) else Verdict.FAILS}


def percent(share: Any) -> float:
    """A share as a plain number of percents."""
    return 100.0 * float(share)


def named(quantity: str) -> str:
    """A quantity as the paper calls it."""
    return {"max_pressure": "peak pressure"}.get(quantity, quantity.replace("_", " "))
