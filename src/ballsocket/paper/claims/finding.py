"""A claim: a sentence of the paper or of somebody else, the numbers behind it, and a verdict."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

from ...models.base import Model


class Verdict(Enum):
    """What became of a sentence."""

    HOLDS = "holds"
    NEARLY = "holds nearly"
    FAILS = "does not hold"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A claim with its number.

    Attributes
    ----------
    name : str
        Short, for links.
    where : str
        Section or figure of the paper.
    sentence : str
        What the paper says, in our own words.
    numbers : dict of str to float
        What was computed, by name with its unit.
    verdict : Verdict
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
    comment: str = ""
    code: str = ""

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "name": self.name,
            "where": self.where,
            "sentence": self.sentence,
            "numbers": self.numbers,
            "verdict": self.verdict.value,
            "comment": self.comment,
            "code": self.code,
        }


Claim = Callable[[Model], Finding]
"""Judged by a reference that plays the part of the paper's finite elements."""

SHOWN = ("indentation", "max_pressure", "half_angle")


def graded(good: bool, nearly: bool) -> Verdict:
    """The best verdict that is true."""
    return Verdict.HOLDS if good else Verdict.NEARLY if nearly else Verdict.FAILS


def percent(share: Any) -> float:
    """A share as a plain number of percents."""
    return 100.0 * float(share)
