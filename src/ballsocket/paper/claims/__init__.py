"""Checkable statements of the paper and of other authors, each computed and judged.

The tables hold the claims as data. A claim is judged with a reference model in place of the paper's finite elements:
`Exact()`, or `FiniteElement()`, which has the same rim and the same half ball.
"""

from __future__ import annotations

from collections.abc import Iterable

from ...contact import Model
from ...core.checks import nearest, shown
from .evaluation import SCALE, Claim, Finding, Judgement, judge
from .table import CLAIMS, ELSEWHERE, MESHED_CLAIMS, MESHED_ELSEWHERE

_BY_NAME = {claim.name: claim for claim in (*CLAIMS, *MESHED_CLAIMS, *ELSEWHERE, *MESHED_ELSEWHERE)}


def claim(name: str) -> Claim:
    """Return a claim by its name; call it with a reference model to judge it.

    Raises KeyError: an unknown name.
    """
    if name not in _BY_NAME:
        raise KeyError(f"claim {shown(name)} is not known{nearest(name, tuple(_BY_NAME))}")
    return _BY_NAME[name]


def ledger(reference: Model, claims: Iterable[Claim] = CLAIMS) -> tuple[Finding, ...]:
    """Judge claims with a reference model."""
    return tuple(judge(claim, reference) for claim in claims)


__all__ = [
    "CLAIMS",
    "ELSEWHERE",
    "MESHED_CLAIMS",
    "MESHED_ELSEWHERE",
    "SCALE",
    "Claim",
    "Finding",
    "Judgement",
    "claim",
    "judge",
    "ledger",
]
