"""Record of an evidence pack: the plan of its pieces, their results, the inputs, and the assessment."""

from __future__ import annotations

import platform
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from datetime import date
from functools import partial
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from math import degrees, inf
from pathlib import Path
from shutil import rmtree
from typing import Any

from ..contact.strength import unchecked_strength_reason
from ..contact.verdict import EDGE_DISTANCE
from ..core.executors.processes import Engine, Serial
from ..core.quantities import JOINT, MATERIAL, QUANTITIES, STRESS_LIMITS
from ..core.storage.pieces import Piece, Plan, Results, Summary, fingerprint
from ..problem import Material
from ..problem.dimensions import DIAMETERS, STORED_LENGTHS, canonical
from ..studies.parameters import hold, press_arguments
from .code_checks import CHECKS
from .comparators import CLAIMS, PUBLISHED, applicability, claim, question_ranges
from .credibility import assess, model_risk
from .credibility_levels import Record, absolute_error
from .matrix import NAMES, WEAR, Case, MatrixRow, check_limit, compute_rows, list_cases, worst_rows
from .question import Question
from .worst_case import (
    compare_methods,
    largest_deviation,
    propagate_tolerances,
    solve_with_calculix,
    wear_history,
    wear_rates,
)

_SERIAL = Serial()

Listener = Callable[[str], None]  # function that is called with the name of each completed piece


def gather_evidence(
    question: Question, folder: Path, progress: Listener = lambda name: None, engine: Engine = _SERIAL
) -> dict[str, Any]:
    """Compute the record of a pack, as one dictionary for JSON.

    Parameters
    ----------
    question : Question
    folder : Path
        Folder of the stored results. Results of the same question by the same code are not computed again.
    progress : callable
        Called with the name of each completed piece.
    engine : Engine

    Raises
    ------
    OSError
        The folder is not writable.
    """
    first = plan(question).results(folder, progress, engine)
    rows = [MatrixRow.of(row) for block in first["matrix"] for row in block]
    rates = [rate for block in first["wear_rates"] for rate in block]
    rows = [row.with_wear(rate) for row, rate in zip(rows, rates, strict=True)] if rates else rows
    worst = worst_rows(rows)
    second = plan_worst_cases(question, worst).results(folder, progress, engine)
    return _record(question, rows, worst, {**first, **second})


# Pieces of work with stored results, so that a stopped run is resumed

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


def plan_worst_cases(question: Question, worst: Mapping[str, MatrixRow]) -> Plan:
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


def distinct_cases(worst: Mapping[str, MatrixRow]) -> list[Case]:
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


def _record(
    question: Question, rows: Sequence[MatrixRow], worst: Mapping[str, MatrixRow], results: Results
) -> dict[str, Any]:
    """Assemble the record from the results of all pieces, and assess it."""
    call = "question = read_question('question.toml'); compute_rows(question, list_cases(question))"
    missing = {"utilisation": unchecked_strength_reason(question.file.joint)}
    record: dict[str, Any] = {
        "version": fingerprint(),
        "made_with": _made_with(),
        "made_on": date.today().isoformat(),
        "question": question.text,
        "context_of_use": question.context,
        "risk": model_risk(question.influence, question.consequence),
        "required": {"accuracy": question.accuracy, "limits": [str(limit) for limit in question.limits]},
        "inputs": list_inputs(question),
        "held": hold(question.file.joint, (*question.axes, *question.tolerances)),
        "recentred": [entry.summary() for entry in question.recentred],
        "model": {"name": question.model.name, "call": call},
        "matrix": [row.summary() for row in rows],
        "worst": {name: row.summary() for name, row in worst.items()},
        "drawn": _drawn_joint(question, worst),
        "limits": [
            check_limit(limit, rows, question.accuracy, missing.get(limit.name, "")).summary()
            for limit in question.limits
        ],
        "code_verification": results["code_verification"],
        "calculation": _calculations(worst, results),
        "claims": [dict(entry) for entry in results["claims"]],
        "comparators": [dict(entry) for entry in results["comparators"]],
        "uncertainty": next(iter(results["uncertainty"]), None),
        "wear": next(iter(results["wear"]), None),
    }
    ranges = question_ranges(question, rows)
    for entry in (*record["claims"], *record["comparators"]):
        entry["applicability"] = applicability(entry["reaches"], ranges, question.model.off_axis)
    record["accurate"] = _accuracy(record)
    return {**record, **assess(record)}


def _calculations(worst: Mapping[str, MatrixRow], results: Results) -> list[dict[str, Any]]:
    """Return the methods of each worst case, with CalculiX for the largest pressure."""
    calculix: list[Any] = next(iter(results["rival"]), [])
    calculations = []
    for case, methods in zip(distinct_cases(worst), results["calculation"], strict=True):
        names = [name for name, row in worst.items() if row.case == case and name != WEAR.name]
        listed = [*methods, *(calculix if "max_pressure" in names else [])]
        call = "ballsocket.evidence.worst_case.compare_methods(question, case)"
        calculations.append(
            {"worst_of": names, "methods": listed, "deviation": largest_deviation(listed), "call": call}
        )
    return calculations


def _drawn_joint(question: Question, worst: Mapping[str, MatrixRow]) -> dict[str, Any] | None:
    """Return the joint and the contact with the largest pressure for a drawing; None without a result."""
    row = worst.get("max_pressure")
    if row is None:
        return None
    joint, _, _ = press_arguments(question.file.joint, row.case)
    return {
        "joint": joint.summary(),
        "arc_of_cover_deg": degrees(question.file.cup.arc_of_cover),
        "half_angle_deg": None if question.model.off_axis else degrees(row.numbers["half_angle"]),
    }


def _accuracy(record: Record) -> dict[str, Any]:
    """Compare error bars and deviations of methods with the required accuracy."""
    errors = [error for row in record["matrix"] for error in row["errors"].values()]
    limited = {NAMES[limit["name"]].key for limit in record["limits"] if limit["name"] in NAMES} - {EDGE_DISTANCE}
    for key in limited:  # a distance may be 0: its error is compared with the margin to its limit
        bars = [(row["numbers"][key], absolute_error(row, key)) for row in record["matrix"]]
        errors += [error / abs(value) for value, error in bars if value and error is not None]
    deviations = [value for calculation in record["calculation"] for value in calculation["deviation"].values()]
    largest = max([*errors, *deviations], default=inf)
    required = record["required"]["accuracy"]
    return {"largest": largest if largest < inf else None, "required": required, "holds": largest <= required}


def list_inputs(question: Question) -> list[dict[str, Any]]:
    """List every number of the input, with unit, tolerance and source."""
    joint = question.file.joint
    follows = "follows from the other lengths"
    given = {canonical(name) for name in joint.given_lengths}
    lengths = dict.fromkeys((*STORED_LENGTHS, *(name for name in JOINT if name in given)))
    rows = [
        ("joint" if name in given else "", name, getattr(joint, name), "mm", joint.source if name in given else follows)
        for name in lengths
    ]
    rows += _material_inputs("liner", joint.liner) + _material_inputs("ball", joint.ball)
    for number, layer in enumerate(joint.backing):
        rows.append(("backing", f"backing[{number}].thickness", layer.thickness, "mm", joint.source))
        rows += _material_inputs("backing", layer.material, f"backing[{number}].")
    if question.friction is not None:
        rows.append(("friction", "friction.coefficient", question.friction, "", ""))
    recentred = {canonical(entry.name) for entry in question.recentred}
    return [
        {
            "name": name,
            "value": value if abs(value) < inf else "inf",
            "unit": unit,
            "tolerance": _tolerance(question, name),
            "source": question.sources.get(name)
            or ("nominal value of its tolerance in the question" if name in recentred else "")
            or question.sources.get(body)
            or source,
        }
        for body, name, value, unit, source in rows
    ]


def _material_inputs(body: str, material: Material | None, prefix: str = "") -> list[tuple[str, str, Any, str, str]]:
    """List body, name, value, unit and source of each known number of a material."""
    if material is None:
        return []
    known = {name: getattr(material, name) for name in (*MATERIAL, *STRESS_LIMITS)}
    return [
        (body, f"{prefix or f'{body}_'}{name}", value, QUANTITIES[name].written.text, material.source)
        for name, value in known.items()
        if value is not None
    ]


def _tolerance(question: Question, name: str) -> str | list[float]:
    """Return the ends of the tolerance of an input, or a remark in its place; empty without one."""
    spreads = {canonical(stated): (stated, spread) for stated, spread in question.tolerances.items()}
    if name not in spreads:
        varied = {canonical(axis) for axis in question.axes}
        return "varied in the matrix" if name in varied else ""
    stated, spread = spreads[name]
    factor = 0.5 if stated in DIAMETERS else 1.0
    return [factor * float(spread.frozen.ppf(end)) for end in (0.0, 1.0)]


_LIBRARIES = ("numpy", "scipy", "scikit-fem", "array-api-compat", "matplotlib")
STATED = ("python", "system", *_LIBRARIES)  # names of the entries in `made_with`


def _made_with() -> dict[str, str]:
    versions = {"python": platform.python_version(), "system": f"{sys.platform} {platform.machine()}"}
    for name in _LIBRARIES:
        with suppress(PackageNotFoundError):
            versions[name] = version(name)
    return versions
