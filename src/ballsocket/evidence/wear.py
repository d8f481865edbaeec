"""Wear in the evidence: what the named hip goes through, by every joint of the matrix, and to its end by the worst."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ..hip.config import HipFile, read_hip
from ..hip.simulation import HipSimulation
from ..hip.uncertainty import uncertainty
from ..studies.parameters import LOADS, press_arguments
from .matrix import Case
from .question import Question

_FACING = ("inclination", "anteversion")
"""What of a case is the cup's; the cycle says where its own loads point."""


def rates(question: Question, those: Sequence[Case]) -> list[float | None]:
    """Wear of a new bore in mm³ a million cycles, for each of some cases; None where the hip cannot be worn.

    Loads are those of the cycle: cases that differ in their load alone are worn once.
    """
    assert question.hip is not None
    given, known = read_hip(question.hip), dict[tuple[Any, ...], float | None]()
    for case in those:
        if _shape(case) not in known:
            known[_shape(case)] = _rate(question, given, case)
    return [known[_shape(case)] for case in those]


def _shape(case: Case) -> tuple[Any, ...]:
    return tuple((name, value) for name, value in case.items() if name not in LOADS)


def _rate(question: Question, given: HipFile, case: Case) -> float | None:
    try:
        return float(_use(question, given, case).first.volume)
    except ValueError:  # pressed together, or pushed over the rim
        return None


def _use(question: Question, given: HipFile, case: Case) -> HipSimulation:
    """The hip of the file with the joint of a case, its cup as the case turns it."""
    joint, _, _ = press_arguments(question.file.joint, dict(_shape(case)))
    facing: dict[str, Any] = {name: case[name] for name in _FACING if name in case}
    return replace(given.use, joint=joint, cup=replace(given.use.cup, **facing))


def worn(question: Question, case: Case) -> dict[str, Any]:
    """What becomes of a case over the cycles of the hip's file, with bands of 95 % where that says what scatters."""
    assert question.hip is not None
    given = read_hip(question.hip)
    use = _use(question, given, case)
    history = use.after(given.cycles, given.report_at, lubricant=given.lubricant)
    answer: dict[str, Any] = {**history.summary(), "file": question.hip.name, "call": _CALL}
    if given.uncertain is not None:
        said = given.uncertain
        scatter = replace(said.variability, use=use)
        answer |= uncertainty(scatter, history, count=said.count, seed=said.seed).summary()
    return answer


_CALL = "ballsocket.evidence.wear.worn(question, case)"
