"""Credibility of a record: the 13 factors of ASME V&V 40-2018, the matrix of requirements, and the adequacy.

The names of the factors and the rule are those of ASME V&V 40-2018 and of the FDA guidance "Assessing the Credibility
of Computational Modeling and Simulation in Medical Device Submissions" (17 November 2023): a gradation of activities
for each factor, a goal set by the model risk, and the level reached. Both leave gradations and goals to the user. The
gradations here follow the examples of the standard, reworded. The goals are a proposal and open to discussion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..contact.verdict import Verdict
from . import credibility_levels
from .credibility_levels import ReachedLevel, Record, error_margins
from .matrix import NAMES, input_title, limit_text, number
from .question import LEVELS

RISKS = ("low", "low to medium", "medium", "medium to high", "high")
"""Levels of model risk by rank, 1 to 5: one step of influence or consequence is one step of risk."""


def model_risk(influence: str, consequence: str) -> dict[str, Any]:
    """Combine the influence of the model and the consequence of a wrong decision into the model risk.

    Examples
    --------
    >>> model_risk("medium", "high")
    {'influence': 'medium', 'consequence': 'high', 'level': 'medium to high', 'rank': 4}
    """
    rank = LEVELS.index(influence) + LEVELS.index(consequence) + 1
    return {"influence": influence, "consequence": consequence, "level": RISKS[rank - 1], "rank": rank}


@dataclass(frozen=True)
class Factor:
    """Credibility factor of ASME V&V 40-2018 with its gradation, goals and assessment.

    Attributes
    ----------
    activity, name : str
        Names of ASME V&V 40-2018.
    gradation : tuple of str
        Activities of increasing rigour, for the levels a, b, c, ...
    goals : str
        Five letters: the goal for each rank of the model risk.
    assess : callable
        Function from a record to the reached level.
    """

    activity: str
    name: str
    gradation: tuple[str, ...]
    goals: str
    assess: Callable[[Record], ReachedLevel]

    def summary(self, record: Record) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        reached, goal = self.assess(record), self.goals[record["risk"]["rank"] - 1]
        return {
            "activity": self.activity,
            "factor": self.name,
            "supported_by": reached.supported,
            "missing": reached.missing or "nothing",
            "gradation": dict(zip("abcde", self.gradation, strict=False)),
            "goal": goal,
            "reached": reached.level,
            "adequate": reached.level >= goal,
        }


_CODE, _CALCULATION = "code verification", "calculation verification"
_MODEL, _COMPARATOR, _ASSESSMENT = (
    f"validation: {part}" for part in ("computational model", "comparator", "assessment")
)
FACTORS: Sequence[Factor] = (
    Factor(
        _CODE,
        "software quality assurance",
        (
            "no tests, or tests that failed",
            "versions and tests of the code are recorded, and all passed",
            "also: known faults are listed and judged for the context of use",
        ),
        "bbbcc",
        credibility_levels.software_level,
    ),
    Factor(
        _CODE,
        "numerical code verification",
        (
            "none, or a check that failed",
            "agreement with exact solutions at single points",
            "also: the error shrinks as the solver's tolerance does",
            "also: a second method of the worst cases has the order of convergence that theory states",
        ),
        "bbcdd",
        credibility_levels.code_level,
    ),
    Factor(
        _CALCULATION,
        "discretization error",
        (
            "not estimated",
            "estimated for some of the limited numbers, or larger than the required accuracy",
            "estimated for every limited number, and within the required accuracy",
            "also: smaller than the margin to every limit, so that it changes no verdict",
        ),
        "bccdd",
        credibility_levels.discretization_level,
    ),
    Factor(
        _CALCULATION,
        "numerical solver error",
        (
            "not estimated",
            "other methods or settings at some worst cases",
            "other methods at every worst case agree within the required accuracy",
            "also: another program agrees",
        ),
        "bbccd",
        credibility_levels.solver_level,
    ),
    Factor(
        _CALCULATION,
        "use error",
        (
            "inputs are checked by the file reader only",
            "inputs have sources, and every number states its call",
            "also: a second person has reviewed inputs and outputs",
            "also: an independent person has reproduced them",
        ),
        "abbcd",
        credibility_levels.use_level,
    ),
    Factor(
        _MODEL,
        "model form",
        (
            "the influence of assumptions is not explored",
            "the main assumptions are explored by other bodies or methods at the worst cases",
            "also: every case lies in the range of the model, below the yield stress",
            "also: plasticity, creep and friction in the contact are shown to be negligible",
        ),
        "abbcd",
        credibility_levels.form_level,
    ),
    Factor(
        _MODEL,
        "model inputs",
        (
            "uncertainty is not quantified",
            "tolerances of some inputs are propagated, with sensitivities",
            "tolerances of all main inputs are propagated, and all inputs have sources",
            "also: the distributions were measured",
        ),
        "abbcd",
        credibility_levels.inputs_level,
    ),
    Factor(
        _COMPARATOR,
        "test samples",
        (
            "published computations",
            "published measurements of similar joints",
            "measured samples of the device itself",
            "also: enough samples for statistics, over the range of sizes",
        ),
        "aabcd",
        credibility_levels.samples_level,
    ),
    Factor(
        _COMPARATOR,
        "test conditions",
        (
            "other loads than those of the question",
            "loads that the question shares in part",
            "all loads of the question",
            "also: measured, with their uncertainty",
        ),
        "aabcd",
        credibility_levels.conditions_level,
    ),
    Factor(
        _ASSESSMENT,
        "equivalency of input parameters",
        (
            "inputs of the comparators are assumed",
            "some comparators state all of their inputs",
            "inputs of all comparators are stated and of the same range",
        ),
        "aabbc",
        credibility_levels.equivalency_level,
    ),
    Factor(
        _ASSESSMENT,
        "output comparison",
        (
            "none, or by eye",
            "differences in numbers",
            "also: the uncertainty of the comparator or of the model",
            "also: the uncertainty of both",
        ),
        "abbcd",
        credibility_levels.outputs_level,
    ),
    Factor(
        "applicability",
        "relevance of the quantities of interest",
        (
            "the comparators have none of the limited quantities",
            "some of the limited quantities are the same",
            "all of them are the same",
        ),
        "abbcc",
        credibility_levels.quantities_level,
    ),
    Factor(
        "applicability",
        "relevance of the validation activities to the context of use",
        (
            "no comparator has joints similar to those of the question",
            "comparators share a part of the question's range",
            "a comparator covers the full range of the question",
            "also: an argument that the comparators represent the context of use",
        ),
        "abbcd",
        credibility_levels.relevance_level,
    ),
)
"""Credibility factors in the order of the standard."""

MET, NOT_MET, UNKNOWN = "met", "not met", "not known"
"""States of a requirement."""


def assess(record: Record) -> dict[str, Any]:
    """Return the credibility factors, the matrix of requirements and the adequacy of a record."""
    factors = [factor.summary(record) for factor in FACTORS]
    rows = [
        *_limit_rows(record),
        *_accuracy_rows(record),
        *_margin_rows(record),
        *_band_rows(record),
        *_check_rows(record),
        *_input_rows(record),
        *_factor_rows(factors),
    ]
    return {"credibility": factors, "requirements": rows, "adequacy": _adequacy(record, factors)}


def _row(
    identifier: str, requirement: str, evidence: str, met: bool | None, where: str, gap: str = ""
) -> dict[str, Any]:
    """Create one row of the matrix; `met` is None for an unknown state."""
    status = UNKNOWN if met is None else MET if met else NOT_MET
    return {
        "id": identifier,
        "requirement": requirement,
        "evidence": evidence,
        "status": status,
        "gap": "" if met else gap,
        "where": where,
    }


def _limit_rows(record: Record) -> Iterator[dict[str, Any]]:
    """Compare the matrix with each limit, one row for each."""
    for index, limit in enumerate(record["limits"]):
        within = {Verdict.EXCEEDED.word: False, Verdict.UNDECIDED.word: None}.get(limit["verdict"], True)
        identifier, text = f"L{index + 1}", f"limit: {limit_text(limit)}"
        yield _row(identifier, text, limit["verdict"], within, f"limits[{index}]", limit["reason"])


def _accuracy_rows(record: Record) -> Iterator[dict[str, Any]]:
    """Compare errors and deviations with the required accuracy, in one row."""
    accurate = record["accurate"]
    largest = accurate["largest"]
    evidence = "no error bar and no second method" if largest is None else f"{100 * largest:.2g} % at most"
    met = None if largest is None else accurate["holds"]
    text = f"error bars and deviations of methods within {100 * accurate['required']:.3g} %"
    yield _row("A1", text, evidence, met, "accurate", "a more exact method, or a wider accuracy")


def _margin_rows(record: Record) -> Iterator[dict[str, Any]]:
    """Compare the numerical error with the margin to each limit, one row for each."""
    for index, margin in enumerate(error_margins(record)):
        share = margin["share"]
        evidence = "no error bar" if share is None else f"{100 * share:.2g} % of the margin"
        yield _row(
            f"E{index + 1}",
            f"numerical error below the margin to the limit: {margin['limit']}",
            evidence,
            None if share is None else share < 1,
            "matrix[].errors",
            f"an error bar of the {NAMES[margin['name']].title}" if share is None else "a smaller error",
        )


def _band_rows(record: Record) -> Iterator[dict[str, Any]]:
    """Compare the band over the tolerances with each limit, one row for each."""
    bands = {} if record["uncertainty"] is None else record["uncertainty"]["bands"]
    for index, limit in enumerate(record["limits"]):
        if limit["name"] not in NAMES:
            continue
        band = bands.get(NAMES[limit["name"]].key)
        text = f"band of 95 % over the tolerances within the limit: {limit_text(limit)}"
        if band is None:
            gap = f"tolerances propagated to the {NAMES[limit['name']].title}"
            yield _row(f"U{index + 1}", text, "not propagated", None, "uncertainty", gap)
            continue
        above = limit["low"] is None or band["low"] >= limit["low"]
        below = limit["high"] is None or band["high"] <= limit["high"]
        unit = NAMES[limit["name"]].written.text
        evidence = f"{number(band['low'])} to {number(band['high'])} {unit}".strip()
        yield _row(f"U{index + 1}", text, evidence, above and below, "uncertainty.bands", "narrower tolerances")


def _check_rows(record: Record) -> Iterator[dict[str, Any]]:
    """List the code checks, one row for each."""
    for index, check in enumerate(record["code_verification"]):
        evidence = "not run" if check["observed"] is None else f"{check['observed']:.2g}"
        gap = check["why"] or "a check that passes"
        where = f"code_verification[{index}]"
        yield _row(f"V{index + 1}", f"code check {check['name']}", evidence, check["passed"], where, gap)


def _input_rows(record: Record) -> Iterator[dict[str, Any]]:
    """List the sources of the inputs, one row for each."""
    for index, item in enumerate(record["inputs"]):
        text, source = f"source of the {input_title(item['name'])}", item["source"]
        yield _row(f"I{index + 1}", text, source or "none", bool(source), f"inputs[{index}]", "a source in [sources]")


def _factor_rows(factors: list[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """List the credibility factors, one row for each."""
    for index, factor in enumerate(factors):
        goal, level = factor["goal"], factor["reached"]
        yield _row(
            f"F{index + 1}",
            f"{factor['factor']}: level {goal}, {factor['gradation'][goal]}",
            f"level {level}: {factor['supported_by']}",
            factor["adequate"],
            f"credibility[{index}]",
            factor["missing"],
        )


def _adequacy(record: Record, factors: list[dict[str, Any]]) -> dict[str, Any]:
    """Count the factors that reach the goal set by the model risk."""
    short = [factor["factor"] for factor in factors if not factor["adequate"]]
    met, risk = len(factors) - len(short), record["risk"]["level"]
    text = f"{met} of {len(factors)} credibility factors reach the level that a {risk} model risk requires"
    return {
        "risk": risk,
        "met": met,
        "of": len(factors),
        "adequate": not short,
        "not_met": short,
        "text": text,
    }


def gaps(record: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the rows with the status not met or not known."""
    return [row for row in record["requirements"] if row["status"] != MET]
