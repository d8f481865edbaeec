"""A pack of evidence: everything gathered, piece by piece, so that a killed run goes on where it stopped."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from datetime import date
from functools import partial
from hashlib import sha256
from math import degrees
from pathlib import Path
from shutil import rmtree
from typing import Any

from ..core.executors.processes import Engine, Serial
from ..core.storage.fingerprint import fingerprint
from ..paper.plan import Piece, Plan, Results, Summary
from ..studies.parameters import press_arguments
from . import matrix
from .calculation import beside, largest_deviation, rival
from .code_checks import CHECKS
from .comparator import applicability, reach_asked
from .comparators import CLAIMS, PUBLISHED, claim
from .credibility import model_risk
from .inputs import inputs, made_with
from .question import Question
from .requirements import assessed
from .scatter import scattered
from .wear import rates, worn

_HERE = Serial()

Listener = Callable[[str], None]


def silent(name: str) -> None:
    """Nobody listens."""


def gathered(question: Question, folder: Path, listen: Listener = silent, engine: Engine = _HERE) -> dict[str, Any]:
    """Everything that the pack says, as one dictionary for JSON.

    Parameters
    ----------
    question : Question
    folder : Path
        Where pieces are kept: what lies there of the same question by the same code is not computed anew.
    listen : callable
        Told the name of each piece when it is there.
    engine : Engine

    Raises
    ------
    OSError
        A folder that cannot be written to.
    """
    first = plan(question).results(folder, listen, engine)
    found = [matrix.Row.of(row) for block in first["matrix"] for row in block]
    worn_away = [rate for block in first["wear_rates"] for rate in block]
    found = [row.with_wear(rate) for row, rate in zip(found, worn_away, strict=True)] if worn_away else found
    worst = matrix.worst(found)
    second = later(question, worst).results(folder, listen, engine)
    return _record(question, found, worst, {**first, **second})


def count_kept(question: Question, folder: Path) -> int:
    """Count the stored results of a question from a stopped run."""
    return sum(1 for name in _folders(question) for path in (folder / name).glob("*.json"))


def remove_kept(folder: Path) -> None:
    """Remove the stored results of all questions from a folder, and the empty folder."""
    for path in folder.glob("*-*"):
        if _KEPT.fullmatch(path.name):
            rmtree(path, ignore_errors=True)
    with suppress(OSError):
        folder.rmdir()


def _folders(question: Question) -> tuple[str, str]:
    return f"{_FIRST}-{_digest(question)}", f"{_LATER}-{_digest(question)}"


_FIRST, _LATER, _LENGTH = "first", "later", 12
_KEPT = re.compile(rf"({_FIRST}|{_LATER})-[0-9a-f]{{{_LENGTH}}}")


def plan(question: Question) -> Plan:
    """What does not depend on where the worst cases are."""
    cases = matrix.cases(question)
    first = next(iter(question.axes))
    blocks = [tuple(case for case in cases if case[first] == value) for value in question.axes[first]]
    return Plan(
        name=_folders(question)[0],
        parts={
            "matrix": {f"block {number}": partial(_block, question, block) for number, block in enumerate(blocks)},
            "wear_rates": {
                f"block {number}": partial(rates, question, block)
                for number, block in enumerate(blocks)
                if question.hip is not None
            },
            "code_verification": {name: Summary(check) for name, check in CHECKS.items()},
            "claims": {name: partial(claim, name) for name in CLAIMS},
            "comparators": {name: Summary(found) for name, found in PUBLISHED.items()},
        },
    )


def later(question: Question, places: Mapping[str, matrix.Row]) -> Plan:
    """What is asked of the worst cases."""
    pressed = places.get("max_pressure", next(iter(places.values()), None))
    worst = None if pressed is None else pressed.case
    parts: dict[str, Mapping[str, Piece]] = {
        "rival": {} if worst is None else {"": partial(_rival, question, worst)},
        "calculation": {
            f"case {number}": partial(_beside, question, case) for number, case in enumerate(_distinct(places))
        },
        "uncertainty": {},
        "wear": {},
    }
    if question.tolerances and worst is not None:
        parts["uncertainty"] = {"": partial(scattered, question, worst)}
    if matrix.WEAR.name in places:
        parts["wear"] = {"": partial(worn, question, places[matrix.WEAR.name].case)}
    return Plan(name=_folders(question)[1], parts=parts)


def _digest(question: Question) -> str:
    """A digest of what is asked, and of the files that it names."""
    digest = sha256()
    for path in question.files:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:_LENGTH]


def _block(question: Question, those: Sequence[matrix.Case]) -> list[dict[str, Any]]:
    return [row.summary() for row in matrix.rows(question, those)]


def _beside(question: Question, case: matrix.Case) -> list[dict[str, Any]]:
    return [method.summary() for method in beside(question, case)]


def _rival(question: Question, case: matrix.Case) -> list[dict[str, Any]]:
    return [method.summary() for method in rival(question, case)]


def _distinct(places: Mapping[str, matrix.Row]) -> list[matrix.Case]:
    """The cases in which some number of a press is worst, each once."""
    pressed = [row.case for name, row in places.items() if name != matrix.WEAR.name]
    return list({tuple(case.items()): case for case in pressed}.values())


def _compared(names: list[str], methods: list[Any], others: list[Any]) -> dict[str, Any]:
    """A case that is the worst of some numbers, by all methods; where the pressure is worst by another program too."""
    listed = [*methods, *(others if "max_pressure" in names else [])]
    return {
        "worst_of": names,
        "methods": listed,
        "deviation": largest_deviation(listed),
        "call": "ballsocket.evidence.calculation.beside(question, case)",
    }


def _record(
    question: Question,
    found: Sequence[matrix.Row],
    worst: Mapping[str, matrix.Row],
    results: Results,
) -> dict[str, Any]:
    others: list[Any] = next(iter(results["rival"]), [])
    calculation = [
        _compared([name for name, row in worst.items() if row.case == one and name != matrix.WEAR.name], piece, others)
        for one, piece in zip(_distinct(worst), results["calculation"], strict=True)
    ]
    record: dict[str, Any] = {
        "version": fingerprint(),
        "made_with": made_with(),
        "made_on": date.today().isoformat(),
        "question": question.text,
        "context_of_use": question.context,
        "risk": model_risk(question.influence, question.consequence),
        "required": {"accuracy": question.accuracy, "limits": [str(limit) for limit in question.limits]},
        "inputs": inputs(question),
        "recentred": [each.summary() for each in question.recentred],
        "model": {"name": question.model.name, "call": _CALL},
        "matrix": [row.summary() for row in found],
        "worst": {name: row.summary() for name, row in worst.items()},
        "drawn": _drawn(question, worst),
        "limits": [matrix.kept(limit, found, question.accuracy).summary() for limit in question.limits],
        "code_verification": results["code_verification"],
        "calculation": calculation,
        "claims": [dict(each) for each in results["claims"]],
        "comparators": [dict(each) for each in results["comparators"]],
        "uncertainty": next(iter(results["uncertainty"]), None),
        "wear": next(iter(results["wear"]), None),
    }
    tilted, asked = question.model.off_axis, reach_asked(question, found)
    for each in (*record["claims"], *record["comparators"]):
        each["applicability"] = applicability(each["reaches"], asked, tilted)
    record["accurate"] = _accurate(record)
    return {**record, **assessed(record)}


def _drawn(question: Question, worst: Mapping[str, matrix.Row]) -> dict[str, Any] | None:
    """The joint and its contact where the pressure is worst, for a drawing; None where nothing answered."""
    row = worst.get("max_pressure")
    if row is None:
        return None
    joint, _, _ = press_arguments(question.file.joint, row.case)
    return {
        "joint": joint.summary(),
        "arc_of_cover_deg": degrees(question.file.cup.arc_of_cover),
        "half_angle_deg": None if question.model.off_axis else degrees(row.numbers["half_angle"]),
    }


_CALL = "question = read_question('question.toml'); rows(question, cases(question))"


def _accurate(record: Mapping[str, Any]) -> dict[str, Any]:
    """Whether bars and deviations stay within the required accuracy."""
    bars = [bar for row in record["matrix"] for bar in row["errors"].values()]
    apart = [value for piece in record["calculation"] for value in piece["deviation"].values()]
    largest = max([*bars, *apart], default=None)
    return {
        "largest": largest,
        "required": record["required"]["accuracy"],
        "holds": largest is not None and largest <= record["required"]["accuracy"],
    }
