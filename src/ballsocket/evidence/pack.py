"""Record of an evidence pack: the results of its plan, the inputs, and the assessment."""

from __future__ import annotations

import platform
import sys
from collections.abc import Callable, Mapping, Sequence
from datetime import date
from importlib.metadata import PackageNotFoundError, version
from math import degrees, inf
from pathlib import Path
from typing import Any

from ..contact.strength import unchecked_strength_reason
from ..core.executors.processes import Engine, Serial
from ..core.quantities import JOINT, MATERIAL, QUANTITIES, STRESS_LIMITS
from ..core.storage.pieces import Results, fingerprint
from ..problem import Material
from ..problem.dimensions import DIAMETERS, EQUIVALENTS, STORED_LENGTHS
from ..studies.parameters import hold, press_arguments
from .comparators import applicability, question_ranges
from .credibility import assess, model_risk
from .credibility_levels import Record
from .matrix import WEAR, Row, check_limit, worst_rows
from .plan import distinct_cases, plan, plan_worst_cases
from .question import Question
from .worst_case import largest_deviation

_SERIAL = Serial()

Listener = Callable[[str], None]
"""Function that is called with the name of each completed piece."""


def ignore_progress(name: str) -> None:
    """Ignore the name of a completed piece."""


def gather_evidence(
    question: Question, folder: Path, progress: Listener = ignore_progress, engine: Engine = _SERIAL
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
    rows = [Row.of(row) for block in first["matrix"] for row in block]
    rates = [rate for block in first["wear_rates"] for rate in block]
    rows = [row.with_wear(rate) for row, rate in zip(rows, rates, strict=True)] if rates else rows
    worst = worst_rows(rows)
    second = plan_worst_cases(question, worst).results(folder, progress, engine)
    return _record(question, rows, worst, {**first, **second})


def _record(question: Question, rows: Sequence[Row], worst: Mapping[str, Row], results: Results) -> dict[str, Any]:
    """Assemble the record from the results of all pieces, and assess it."""
    missing = {"utilisation": unchecked_strength_reason(question.file.joint)}
    record: dict[str, Any] = {
        "version": fingerprint(),
        "made_with": made_with(),
        "made_on": date.today().isoformat(),
        "question": question.text,
        "context_of_use": question.context,
        "risk": model_risk(question.influence, question.consequence),
        "required": {"accuracy": question.accuracy, "limits": [str(limit) for limit in question.limits]},
        "inputs": list_inputs(question),
        "held": hold(question.file.joint, (*question.axes, *question.tolerances)),
        "recentred": [entry.summary() for entry in question.recentred],
        "model": {"name": question.model.name, "call": _CALL},
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


_CALL = "question = read_question('question.toml'); compute_rows(question, list_cases(question))"


def _calculations(worst: Mapping[str, Row], results: Results) -> list[dict[str, Any]]:
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


def _drawn_joint(question: Question, worst: Mapping[str, Row]) -> dict[str, Any] | None:
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
    deviations = [value for calculation in record["calculation"] for value in calculation["deviation"].values()]
    largest = max([*errors, *deviations], default=None)
    required = record["required"]["accuracy"]
    return {"largest": largest, "required": required, "holds": largest is not None and largest <= required}


FOLLOWS = "follows from the other lengths"
"""Source of a length that the joint does not give."""


def list_inputs(question: Question) -> list[dict[str, Any]]:
    """List every number of the input, with unit, tolerance and source."""
    joint = question.file.joint
    given = {EQUIVALENTS.get(name, name) for name in joint.given_lengths}
    lengths = dict.fromkeys((*STORED_LENGTHS, *(name for name in JOINT if name in given)))
    rows = [
        ("joint" if name in given else "", name, getattr(joint, name), "mm", joint.source if name in given else FOLLOWS)
        for name in lengths
    ]
    rows += _material_inputs("liner", joint.liner) + _material_inputs("ball", joint.ball)
    for number, layer in enumerate(joint.backing):
        rows.append(("backing", f"backing[{number}].thickness", layer.thickness, "mm", joint.source))
        rows += _material_inputs("backing", layer.material, f"backing[{number}].")
    if question.friction is not None:
        rows.append(("friction", "friction.coefficient", question.friction, "", ""))
    return [
        {
            "name": name,
            "value": value if abs(value) < inf else "inf",
            "unit": unit,
            "tolerance": _tolerance_text(question, name),
            "source": _source_text(question, name, body) or source,
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


def _source_text(question: Question, name: str, body: str) -> str:
    """Return the source that the question states for an input; empty without one."""
    recentred = {DIAMETERS.get(entry.name, entry.name) for entry in question.recentred}
    by_tolerance = "nominal value of its tolerance in the question" if name in recentred else ""
    return question.sources.get(name) or by_tolerance or question.sources.get(body, "")


def _tolerance_text(question: Question, name: str) -> str:
    """Format the tolerance of an input; empty without one."""
    spreads = {DIAMETERS.get(stated, stated): (stated, spread) for stated, spread in question.tolerances.items()}
    if name not in spreads:
        varied = {DIAMETERS.get(axis, axis) for axis in question.axes}
        return "varied in the matrix" if name in varied else ""
    stated, spread = spreads[name]
    factor = 0.5 if stated in DIAMETERS else 1.0
    low, high = (factor * float(spread.frozen.ppf(end)) for end in (0.0, 1.0))
    return f"{low:g} to {high:g}"


_LIBRARIES = ("numpy", "scipy", "scikit-fem", "array-api-compat", "matplotlib", "pillow")
DRAWING = ("matplotlib", "pillow", "freetype", "zlib")
"""Libraries that decide the bytes of a figure."""

STATED = ("python", "system", *_LIBRARIES, "freetype", "zlib")
"""Names of the entries in `made_with`."""


def made_with() -> dict[str, str]:
    """Return the machine and the versions of the libraries that compute and draw."""
    from matplotlib.ft2font import __freetype_version__
    from PIL import features

    versions = {}
    for name in _LIBRARIES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            continue
    drawing = {"freetype": __freetype_version__, "zlib": str(features.version("zlib"))}
    machine = f"{sys.platform} {platform.machine()}"
    return {"python": platform.python_version(), "system": machine, **versions, **drawing}
