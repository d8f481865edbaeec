"""Claims of a publication: statements with the computed quantity, the expected values and the tolerance."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from math import inf
from typing import Any

from ...contact import Model
from ...core.arrays import Numbers
from ...problem import Joint

Computed = Mapping[str, float]
"""Computed numbers by name; a name ends in its unit."""

Interval = tuple[float, float]
"""Smallest and largest expected value."""

ZERO: Interval = (0.0, 0.0)
"""Expected value of a relative difference."""

VERY_WELL: Interval = (2.0, 5.0)
"""Tolerances in percent of "very well", "almost nothing", "a little", "about constant": the default.

Up to the first number a claim holds, up to the second it holds within its deviation.
"""

ACCEPTABLY: Interval = (2.0, 15.0)
"""Tolerances in percent of "acceptable", "slightly higher", "within limits"; the second is the promise of springs."""

CONSIDERABLE: Interval = (ACCEPTABLY[1], inf)
"""Expected deviation in percent of "considerable", "noticeable", "not adequate"."""

SCALE = (
    f"One scale for all claims: a difference up to {VERY_WELL[1]:g} % is very good agreement, "
    f"up to {ACCEPTABLY[1]:g} % acceptable, above that considerable."
)
"""The scale of words in one sentence."""

STATED: Interval = (0.5, 5.0)
"""Tolerances of a number that a publication states without decimals."""

EXACTLY = (0.0, 0.0)
"""Tolerances of a claim that is true or false."""


class Judgement(Enum):
    """Verdict on a claim."""

    HOLDS = "holds"
    WITHIN = "holds within"
    FAILS = "does not hold"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Result of a claim: its computed numbers and its verdict."""

    name: str  # short, for links
    where: str  # section or figure of the paper, or source of the numbers
    sentence: str  # statement in our words
    numbers: Computed
    verdict: Judgement
    miss: float = 0.0  # largest deviation from the expected values, in `unit`
    unit: str = "%"
    comment: str = ""  # reason of the verdict, or conditions of the computation
    code: str = ""  # Python expression of the claim

    @property
    def text(self) -> str:
        """Verdict in words: "holds", "holds within 3.3 %", "does not hold: 11 %"."""
        if self.verdict is Judgement.HOLDS or self.miss == inf:
            return self.verdict.value
        separator = "" if self.verdict is Judgement.WITHIN else ":"
        return f"{self.verdict.value}{separator} {self.miss:.2g} {self.unit}"

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return {
            "name": self.name,
            "where": self.where,
            "sentence": self.sentence,
            "numbers": dict(self.numbers),
            "verdict": self.verdict.value,
            "text": self.text,
            "comment": self.comment,
            "code": self.code,
        }


@dataclass(frozen=True)
class Evaluation:
    """Computed numbers of a claim whose condition needs more than these numbers."""

    numbers: Computed
    holds: bool


Expected = Interval | Mapping[str, Interval] | Callable[[Computed], bool]
"""Interval of all numbers, intervals of some numbers by name, or a condition on the numbers."""

BY_EVALUATION: Expected = {}
"""Expected values of a claim whose `Evaluation` states the condition."""


@dataclass(frozen=True, kw_only=True)
class Claim:
    """Computable statement about contacts: one row of a table of claims."""

    name: str  # short, for links
    source: str  # section or figure of the paper, or another publication
    statement: str  # in our words
    # computes the numbers with a reference model in place of the paper's finite elements
    quantity: Callable[[Model], Computed | Evaluation]
    expected: Expected = ZERO
    tolerance: Interval = VERY_WELL  # largest deviations for "holds" and for "holds within", in `unit`
    unit: str = "%"  # of the deviation
    comment: str | Callable[[Computed], str] = ""  # reason of the verdict, or a function of the numbers that states it
    joints: Callable[[], tuple[Joint, Numbers]] | None = None  # joints and forces in N behind the claim, as arrays

    @property
    def identifier(self) -> str:
        """Name of the claim as a Python identifier."""
        return self.name.replace("-", "_").replace(".", "_")

    def __call__(self, reference: Model) -> Finding:
        return judge(self, reference)


def judge(claim: Claim, reference: Model) -> Finding:
    """Compute the numbers of a claim and compare them with the expected values."""
    result = claim.quantity(reference)
    evaluation = result if isinstance(result, Evaluation) else Evaluation(result, True)
    miss = _deviation(claim.expected, evaluation)
    if claim.tolerance == EXACTLY and miss > 0.0:
        miss = inf
    close, wide = claim.tolerance
    comment = claim.comment(evaluation.numbers) if callable(claim.comment) else claim.comment
    return Finding(
        name=claim.name,
        where=claim.source,
        sentence=claim.statement,
        numbers=evaluation.numbers,
        verdict=Judgement.HOLDS if miss <= close else Judgement.WITHIN if miss <= wide else Judgement.FAILS,
        miss=miss,
        unit=claim.unit,
        comment=comment,
        code=f"ballsocket.paper.claims.claim({claim.name!r})",
    )


def _deviation(expected: Expected, evaluation: Evaluation) -> float:
    """Compute the largest distance of the numbers from the expected intervals; infinity for a false condition."""
    if not evaluation.holds:
        return inf
    if callable(expected):
        return 0.0 if expected(evaluation.numbers) else inf
    numbers = evaluation.numbers
    intervals = expected if isinstance(expected, Mapping) else dict.fromkeys(numbers, expected)
    deviations = (max(low - numbers[name], numbers[name] - high, 0.0) for name, (low, high) in intervals.items())
    return float(max(deviations, default=0.0))


def percent(ratio: Any) -> float:
    """Convert a ratio to percent."""
    return 100.0 * float(ratio)


def quantity_title(quantity: str) -> str:
    """Return the name of a quantity in the words of the paper."""
    return {"max_pressure": "peak pressure"}.get(quantity, quantity.replace("_", " "))
