"""Credibility of a record: the 13 factors of ASME V&V 40-2018, the matrix of requirements, and the adequacy.

The names of the factors and the rule are those of ASME V&V 40-2018 and of the FDA guidance "Assessing the Credibility
of Computational Modeling and Simulation in Medical Device Submissions" (17 November 2023): a gradation of activities
for each factor, a goal set by the model risk, and the level reached. Both leave gradations and goals to the user. The
gradations here follow the examples of the standard, reworded. The goals are a proposal and open to discussion.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from ..contact.verdict import Verdict
from .credibility_levels import LEVELS_REACHED, ReachedLevel, Record, error_margins
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


_TABLE = (files("ballsocket") / "data" / "credibility.csv").read_text(encoding="utf-8").splitlines()[1:]
FACTORS: Sequence[Factor] = tuple(
    Factor(
        activity=row["activity"],
        name=row["factor"],
        gradation=tuple(row[level] for level in "abcd" if row[level]),
        goals=row["goals"],
        assess=LEVELS_REACHED[row["factor"]],
    )
    for row in csv.DictReader(_TABLE)
)
"""Credibility factors in the order of the standard."""

MET, NOT_MET, UNKNOWN = "met", "not met", "not known"  # states of a requirement


def assess(record: Record) -> dict[str, Any]:
    """Return the credibility factors, the matrix of requirements and the adequacy of a record."""
    factors = [factor.summary(record) for factor in FACTORS]
    rows = [*_limit_rows(record), *_error_rows(record), *_band_rows(record), *_source_rows(record)]
    for index, factor in enumerate(factors):
        goal, where = factor["goal"], f"credibility[{index}]"
        text = f"{factor['factor']}: level {goal}, {factor['gradation'][goal]}"
        evidence = f"level {factor['reached']}: {factor['supported_by']}"
        rows.append(_row(f"F{index + 1}", text, evidence, factor["adequate"], where, factor["missing"]))
    short = [factor["factor"] for factor in factors if not factor["adequate"]]
    met, risk = len(factors) - len(short), record["risk"]["level"]
    adequacy = {
        "risk": risk,
        "met": met,
        "of": len(factors),
        "adequate": not short,
        "not_met": short,
        "text": f"{met} of {len(factors)} credibility factors reach the level that a {risk} model risk requires",
    }
    return {"credibility": factors, "requirements": rows, "adequacy": adequacy}


def _row(
    identifier: str, requirement: str, evidence: str, met: bool | None, where: str, gap: str = ""
) -> dict[str, Any]:
    """Create one row of the matrix; `met` is None for an unknown state."""
    return {
        "id": identifier,
        "requirement": requirement,
        "evidence": evidence,
        "status": {None: UNKNOWN, True: MET, False: NOT_MET}[met],
        "gap": "" if met else gap,
        "where": where,
    }


def _limit_rows(record: Record) -> Iterator[dict[str, Any]]:
    for index, limit in enumerate(record["limits"]):
        within = {Verdict.EXCEEDED.word: False, Verdict.UNDECIDED.word: None}.get(limit["verdict"], True)
        identifier, text = f"L{index + 1}", f"limit: {limit_text(limit)}"
        yield _row(identifier, text, limit["verdict"], within, f"limits[{index}]", limit["reason"])


def _error_rows(record: Record) -> Iterator[dict[str, Any]]:
    """Compare errors and deviations with the required accuracy, and the errors with the margin to each limit."""
    accurate = record["accurate"]
    largest = accurate["largest"]
    evidence = "no error bar and no second method" if largest is None else f"{100 * largest:.2g} % at most"
    met = None if largest is None else accurate["holds"]
    text = f"error bars and deviations of methods within {100 * accurate['required']:.3g} %"
    yield _row("A1", text, evidence, met, "accurate", "a more exact method, or a wider accuracy")
    for index, margin in enumerate(error_margins(record)):
        text, share = f"numerical error below the margin to the limit: {margin['limit']}", margin["share"]
        if share is None:
            evidence, gap = "no error bar", f"an error bar of the {NAMES[margin['name']].title}"
        else:
            evidence, gap = f"{100 * share:.2g} % of the margin", "a smaller error"
        yield _row(f"E{index + 1}", text, evidence, None if share is None else share < 1, "matrix[].errors", gap)


def _band_rows(record: Record) -> Iterator[dict[str, Any]]:
    """Compare the band over the tolerances with each limit, one row for each."""
    bands = {} if record["uncertainty"] is None else record["uncertainty"]["bands"]
    for index, limit in enumerate(record["limits"]):
        if limit["name"] not in NAMES:
            continue
        quantity = NAMES[limit["name"]]
        band = bands.get(quantity.key)
        text = f"band of 95 % over the tolerances within the limit: {limit_text(limit)}"
        if band is None:
            gap = f"tolerances propagated to the {quantity.title}"
            yield _row(f"U{index + 1}", text, "not propagated", None, "uncertainty", gap)
            continue
        above = limit["low"] is None or band["low"] >= limit["low"]
        below = limit["high"] is None or band["high"] <= limit["high"]
        evidence = f"{number(band['low'])} to {number(band['high'])} {quantity.written.text}".strip()
        yield _row(f"U{index + 1}", text, evidence, above and below, "uncertainty.bands", "narrower tolerances")


def _source_rows(record: Record) -> Iterator[dict[str, Any]]:
    for index, check in enumerate(record["code_verification"]):
        evidence = "not run" if check["observed"] is None else f"{check['observed']:.2g}"
        text, where, gap = f"code check {check['name']}", f"code_verification[{index}]", "a check that passes"
        yield _row(f"V{index + 1}", text, evidence, check["passed"], where, check["why"] or gap)
    for index, item in enumerate(record["inputs"]):
        text, source = f"source of the {input_title(item['name'])}", item["source"]
        yield _row(f"I{index + 1}", text, source or "none", bool(source), f"inputs[{index}]", "a source in [sources]")
