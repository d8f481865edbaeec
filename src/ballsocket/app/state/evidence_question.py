"""Question for an evidence pack as typed on the page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

from ...core.checks import check_names, check_text
from ...evidence.question import LEVELS

_CHOICES = {"influence": LEVELS, "consequence": LEVELS, "elements": ("no", "yes"), "wear": ("no", "yes")}


@dataclass(frozen=True, kw_only=True)
class EvidenceQuestion:
    """Inputs of the evidence view, as typed; `write_question` checks their meaning."""

    question: str = "Does this joint keep its limits?"
    context: str = "A design review before tests. Not for loosening, impingement or fracture."
    influence: str = "medium"
    consequence: str = "medium"
    accuracy: str = "10 %"
    limits: str = ""  # phrases separated by ;, also in matrix and tolerances
    matrix: str = "force = 2, 3 kN"
    tolerances: str = ""
    friction: str = ""
    elements: str = "no"
    wear: str = "no"

    def __post_init__(self) -> None:
        for entry in fields(self):
            check_text(entry.name, getattr(self, entry.name))
        for name, known in _CHOICES.items():
            check_names([getattr(self, name)], known, f"as {name}")


DEFAULT_QUESTION = EvidenceQuestion()  # question of a page without a link


def question_pairs(inputs: EvidenceQuestion) -> list[tuple[str, str]]:
    """List the differences from `DEFAULT_QUESTION` as pairs of a link."""
    return [(f"ask.{name}", value) for name, value in vars(inputs).items() if value != getattr(DEFAULT_QUESTION, name)]


def question_of(pairs: Mapping[str, str]) -> EvidenceQuestion:
    """Read a question from pairs of a link, without their prefix."""
    check_names(pairs, [entry.name for entry in fields(EvidenceQuestion)], "of a question in the link")
    return EvidenceQuestion(**pairs)
