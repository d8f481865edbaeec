"""Plan of an evidence pack: pieces of work with stored results, so that a stopped run is resumed."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from hashlib import sha256
from pathlib import Path
from shutil import rmtree
from typing import Any

from ..core.storage.pieces import Piece, Plan, Summary
from .code_checks import CHECKS
from .comparators import CLAIMS, PUBLISHED, claim
from .matrix import WEAR, Case, Row, compute_rows, list_cases
from .question import Question
from .worst_case import compare_methods, propagate_tolerances, solve_with_calculix, wear_history, wear_rates

_STORE_NAME = re.compile(r"(first|later)-[0-9a-f]{12}")


def plan(question: Question) -> Plan:
    """Return the plan of the pieces that do not depend on the worst cases."""
    cases = list_cases(question)
    first = next(iter(question.axes))
    blocks = [tuple(case for case in cases if case[first] == value) for value in question.axes[first]]
    return Plan(
        name=_store_names(question)[0],
        parts={
            "matrix": {
                f"block {number}": partial(_summaries, compute_rows, question, block)
                for number, block in enumerate(blocks)
            },
            "wear_rates": {
                f"block {number}": partial(wear_rates, question, block)
                for number, block in enumerate(blocks)
                if question.hip is not None
            },
            "code_verification": {name: Summary(check) for name, check in CHECKS.items()},
            "claims": {name: partial(claim, name) for name in CLAIMS},
            "comparators": {name: Summary(comparator) for name, comparator in PUBLISHED.items()},
        },
    )


def plan_worst_cases(question: Question, worst: Mapping[str, Row]) -> Plan:
    """Return the plan of the pieces for the worst cases."""
    row = worst.get("max_pressure", next(iter(worst.values()), None))
    parts: dict[str, Mapping[str, Piece]] = {
        "rival": {} if row is None else {"": partial(_summaries, solve_with_calculix, question, row.case)},
        "calculation": {
            f"case {number}": partial(_summaries, compare_methods, question, case)
            for number, case in enumerate(distinct_cases(worst))
        },
        "uncertainty": {},
        "wear": {},
    }
    if question.tolerances and row is not None:
        parts["uncertainty"] = {"": partial(propagate_tolerances, question, row.case)}
    if WEAR.name in worst:
        parts["wear"] = {"": partial(wear_history, question, worst[WEAR.name].case)}
    return Plan(name=_store_names(question)[1], parts=parts)


def distinct_cases(worst: Mapping[str, Row]) -> list[Case]:
    """Return the cases in which some number of a contact is worst, without repetition."""
    cases = [row.case for name, row in worst.items() if name != WEAR.name]
    return list({tuple(case.items()): case for case in cases}.values())


def _summaries(compute: Callable[[Question, Any], Sequence[Any]], question: Question, cases: Any) -> list[Any]:
    return [result.summary() for result in compute(question, cases)]


def count_stored_pieces(question: Question, folder: Path) -> int:
    """Count the stored results of a question from a stopped run."""
    return sum(1 for name in _store_names(question) for path in (folder / name).glob("*.json"))


def remove_stored_pieces(folder: Path) -> None:
    """Remove the stored results of all questions from a folder, and the empty folder."""
    for path in folder.glob("*-*"):
        if _STORE_NAME.fullmatch(path.name):
            rmtree(path, ignore_errors=True)
    with suppress(OSError):
        folder.rmdir()


def _store_names(question: Question) -> tuple[str, str]:
    """Return the folder names of both plans, with a digest of the question and of the files that it names."""
    digest = sha256()
    for path in question.files:
        digest.update(path.read_bytes())
    text = digest.hexdigest()[:12]
    return f"first-{text}", f"later-{text}"
