"""A pack of evidence: everything gathered, piece by piece, so that a killed run goes on where it stopped."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..engines.local import Engine, Serial
from ..fingerprint import fingerprint
from ..paper.plan import Piece, Plan, Results
from . import matrix
from .calculation import beside, largest_deviation, rival
from .code_checks import CHECKS
from .comparators import CLAIMS, PUBLISHED, claim
from .credibility import FACTORS
from .inputs import inputs, made_with
from .question import Question
from .scatter import scattered
from .wear import worn

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
    rows = [row for block in first["matrix"] for row in block]
    found = [matrix.Row.of(each) for each in rows]
    places = {name: row.case for name, row in matrix.worst(found).items()}
    second = later(question, places).results(folder, listen, engine)
    return _record(question, rows, found, places, {**first, **second})


def plan(question: Question) -> Plan:
    """What does not depend on where the worst cases are."""
    cases = matrix.cases(question)
    first = next(iter(question.axes))
    blocks = {f"{first} {value:g}": [case for case in cases if case[first] == value] for value in question.axes[first]}
    return Plan(
        name=f"first-{_digest(question)}",
        parts={
            "matrix": {name: partial(_block, question, tuple(block)) for name, block in blocks.items()},
            "code_verification": {name: partial(_check, name) for name in CHECKS},
            "claims": {name: partial(claim, name) for name in CLAIMS},
            "comparators": {name: partial(_published, name) for name in PUBLISHED},
        },
    )


def later(question: Question, places: Mapping[str, matrix.Case]) -> Plan:
    """What is asked of the worst cases."""
    distinct = {_told_case(case): case for case in places.values()}
    worst = places.get("max_pressure", next(iter(places.values()), None))
    parts: dict[str, Mapping[str, Piece]] = {
        "rival": {} if worst is None else {"": partial(_rival, question, worst)},
        "calculation": {name: partial(_beside, question, case) for name, case in distinct.items()},
        "uncertainty": {},
        "wear": {},
    }
    if question.tolerances and worst is not None:
        parts["uncertainty"] = {"": partial(scattered, question, worst)}
    if question.hip is not None:
        parts["wear"] = {"": partial(worn, question.hip)}
    return Plan(name=f"later-{_digest(question)}", parts=parts)


def _digest(question: Question) -> str:
    """A digest of what is asked, and of the files that it names."""
    digest = sha256()
    for path in question.files:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def _block(question: Question, those: Sequence[matrix.Case]) -> list[dict[str, Any]]:
    return [row.summary() for row in matrix.rows(question, those)]


def _check(name: str) -> dict[str, Any]:
    return CHECKS[name]().summary()


def _published(name: str) -> dict[str, Any]:
    return PUBLISHED[name]().summary()


def _beside(question: Question, case: matrix.Case) -> list[dict[str, Any]]:
    return [method.summary() for method in beside(question, case)]


def _rival(question: Question, case: matrix.Case) -> list[dict[str, Any]]:
    return [method.summary() for method in rival(question, case)]


def _told_case(case: matrix.Case) -> str:
    return ", ".join(f"{name} {value:.6g}" for name, value in case.items())


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
    rows: Sequence[Mapping[str, Any]],
    found: Sequence[matrix.Row],
    places: Mapping[str, matrix.Case],
    results: Results,
) -> dict[str, Any]:
    distinct = list({_told_case(case): case for case in places.values()}.values())
    others: list[Any] = next(iter(results["rival"]), [])
    calculation = [
        _compared([name for name, case in places.items() if case == one], piece, others)
        for one, piece in zip(distinct, results["calculation"], strict=True)
    ]
    record: dict[str, Any] = {
        "version": fingerprint(),
        "made_with": made_with(),
        "question": question.text,
        "context_of_use": question.context,
        "risk": {"influence": question.influence, "consequence": question.consequence},
        "required": {"accuracy": question.accuracy, "limits": [str(limit) for limit in question.limits]},
        "inputs": inputs(question),
        "model": {"name": question.model.name, "call": _CALL},
        "matrix": list(rows),
        "worst": {name: row.summary() for name, row in matrix.worst(found).items()},
        "limits": [matrix.kept(limit, found, question.accuracy).summary() for limit in question.limits],
        "code_verification": results["code_verification"],
        "calculation": calculation,
        "claims": results["claims"],
        "comparators": results["comparators"],
        "uncertainty": next(iter(results["uncertainty"]), None),
        "wear": next(iter(results["wear"]), None),
    }
    record["accurate"] = _accurate(record)
    record["credibility"] = [factor.summary(record) for factor in FACTORS]
    return record


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
