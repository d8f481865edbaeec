"""Matrix of requirements and evidence: one row for each requirement with its gap, and the adequacy."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..core.deprecation import renamed_names
from .credibility import FACTORS
from .credibility_levels import Record, error_margins
from .matrix import NAMES, input_title, limit_text, number

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
        within = {"not kept": False, "not known": None}.get(limit["verdict"], True)
        gap = f"cases beyond the limit: {limit['beyond']}; without a result: {limit['unknown']}"
        identifier = f"L{index + 1}"
        yield _row(identifier, f"limit: {limit_text(limit)}", f"{limit['verdict']}", within, f"limits[{index}]", gap)


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


__getattr__ = renamed_names(__name__, {"assessed": "assess"})
