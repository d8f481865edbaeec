"""Credibility levels that a record reaches, one function for each factor of ASME V&V 40-2018."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from ..core.display import counted
from ..studies.parameters import LOADS
from .code_checks import ORDER_OF_ELEMENTS, OWN_TOLERANCE
from .comparators import APPLIES, APPLIES_IN_PART, DOES_NOT_APPLY, IN_PART, MEASURED, WITHIN
from .matrix import NAMES, input_title, limit_text

Record = Mapping[str, Any]  # record of a pack, as in its JSON file


@dataclass(frozen=True)
class ReachedLevel:
    """Level that a record reaches in a gradation: its letter, its support, and the missing evidence."""

    level: str
    supported: str
    missing: str


def _software_level(record: Record) -> ReachedLevel:
    run = [check for check in record["code_verification"] if check["passed"] is not None]
    failed = [check["name"] for check in run if not check["passed"]]
    supported = f"ballsocket {record['version']}, its libraries and {counted(len(run), 'check')} run on this machine"
    missing = "the list of known faults, judged for this context of use by a quality system of the user"
    if failed:
        return ReachedLevel("a", supported, f"failed checks: {', '.join(failed)}; {missing}")
    return ReachedLevel("b", supported, missing)


def _code_level(record: Record) -> ReachedLevel:
    checks = {check["name"]: check["passed"] for check in record["code_verification"]}
    passed, failed, absent = ([name for name, state in checks.items() if state is s] for s in (True, False, None))
    supported = f"{len(passed)} of {counted(len(passed) + len(failed), 'check')} passed on this machine"
    missing = [f"failed: {', '.join(failed)}"] if failed else []
    missing += [f"not run: {', '.join(absent)}"] if absent else []
    if failed or not passed:
        return ReachedLevel("a", supported, "; ".join(missing) or "any check")
    off_axis = record["model"]["name"] == "sphere"
    if off_axis or not checks.get(OWN_TOLERANCE):
        missing.append("an order of convergence of the solver in use, against an exact solution")
        return ReachedLevel("b", supported, "; ".join(missing))
    elements = any(method["name"].startswith("finite elements") for method in _valid_methods(record))
    if not (checks.get(ORDER_OF_ELEMENTS) and elements):
        missing.append("the observed order of a second method that solves the worst cases (finite elements)")
        return ReachedLevel("c", supported, "; ".join(missing))
    return ReachedLevel("d", supported, "; ".join(missing))


def absolute_error(row: Record, key: str) -> float | None:
    """Return the error of a number of a case, the larger of its error and its error bar; None if neither is known."""
    value = row["numbers"].get(key)
    if value is None:
        return None
    known = [abs(value) * row["errors"][key]] if key in row["errors"] else []
    for low, high in [row["bars"][key]] if key in row["bars"] else ():
        known += [value - low, inf if high is None else high - value]
    return max(known, default=None)


def error_margins(record: Record) -> list[dict[str, Any]]:
    """Compute the largest error bar of each limited number as a share of its margin to the limit.

    The share is None where the number has no error bar, or no value. Above 1 the error could change a verdict.
    """
    margins = []
    for limit in (limit for limit in record["limits"] if limit["name"] in NAMES):
        key, ratios = NAMES[limit["name"]].key, []
        for row in record["matrix"]:
            value, error = row["numbers"].get(key), absolute_error(row, key)
            if value is None or error is None:
                ratios = [inf]
                break
            margin = min(abs(value - end) for end in (limit["low"], limit["high"]) if end is not None)
            ratios.append(error / margin if margin else inf)
        share = max(ratios, default=inf)
        margins.append({"limit": limit_text(limit), "name": limit["name"], "share": None if share == inf else share})
    return margins


def _titles(names: Sequence[str]) -> str:
    return ", ".join(map(input_title, names))


def _discretization_level(record: Record) -> ReachedLevel:
    errors = [error for row in record["matrix"] for error in row["errors"].values()]
    required, margins = record["required"]["accuracy"], error_margins(record)
    if not errors:
        return ReachedLevel("a", "no error bars", "an estimate of the discretization error")
    supported = f"error bars in every case of the matrix, at most {_percent(max(errors))}"
    known = [margin["share"] for margin in margins if margin["share"] is not None]
    supported += f", and at most {_percent(max(known))} of the margin to a limit" if known else ""
    without = [margin["name"] for margin in margins if margin["share"] is None]
    if max(errors) > required:
        return ReachedLevel("b", supported, f"error bars within the required {_percent(required)}")
    if without:
        return ReachedLevel("b", supported, f"an error bar for the {_titles(without)}, or a margin to the limit")
    if not margins:
        return ReachedLevel("c", supported, "limits against which the error could be judged")
    if max(known) > 1:
        return ReachedLevel("c", supported, "error bars below the margin to every limit: a verdict could change")
    return ReachedLevel("d", supported, "")


def _solver_level(record: Record) -> ReachedLevel:
    calculations, required = record["calculation"], record["required"]["accuracy"]
    largest = max((max(calculation["deviation"].values(), default=0.0) for calculation in calculations), default=0.0)
    alone = [calculation["worst_of"] for calculation in calculations if not calculation["deviation"]]
    count = len(calculations)
    supported = (
        f"other methods of the same body differ by {_percent(largest)} at most, at {counted(count, 'worst case')}"
    )
    if len(alone) == count:
        missing = "a second method or other settings of the solver at the worst cases"
        return ReachedLevel("a", "one method only", missing)
    if alone or largest > required:
        return ReachedLevel("b", supported, f"agreement within the required {_percent(required)} at every worst case")
    if not any(method["name"].startswith("CalculiX") for method in _valid_methods(record)):
        return ReachedLevel("c", supported, "another program at the worst case (CalculiX, with finite_elements = true)")
    return ReachedLevel("d", supported, "")


def _valid_methods(record: Record) -> Iterator[Mapping[str, Any]]:
    return (method for calculation in record["calculation"] for method in calculation["methods"] if method["valid"])


def _use_level(record: Record) -> ReachedLevel:
    without = [item["name"] for item in record["inputs"] if not item["source"]]
    supported = "the question file, which is checked on reading, and the call for every number"
    missing = "a second person who compares drawing, inputs and the text of the question"
    if without:
        return ReachedLevel("a", supported, f"a source for the {_titles(without)}; {missing}")
    return ReachedLevel("b", supported, missing)


def _form_level(record: Record) -> ReachedLevel:
    bodies = {method["name"].split(" (")[0].split(",")[0] for method in _valid_methods(record)} - {"tabulated"}
    rows = record["matrix"]
    utilisations = [row["numbers"].get("utilisation") for row in rows]
    invalid = sum(not row["valid"] for row in rows)
    supported = f"linear elasticity of the bodies that the notes name, by {', '.join(sorted(bodies)) or 'no method'}"
    unknown = "plasticity, creep and friction in the contact itself; see limits and assumptions"
    missing = []
    if invalid:
        missing.append(f"outside the range of the model: {invalid} of {counted(len(rows), 'case')}")
    if None in utilisations:
        missing.append("strength not checked: no yield stress, or no result")
    elif max(utilisations, default=0.0) > 1:
        missing.append("von Mises stress exceeds the yield stress: the material is not elastic there")
    elif not all(high is not None and high <= 1 for _, high in (row["bars"]["utilisation"] for row in rows)):
        missing.append("the error bar of the von Mises stress contains the yield stress")
    level = "a" if len(bodies) < 2 else "b" if missing else "c"
    if len(bodies) < 2:
        missing.insert(0, "a second body or method at the worst cases")
    return ReachedLevel(level, supported, "; ".join([*missing, unknown]))


_KEY_INPUTS = ("ball_radius", "clearance", "liner_thickness", "liner_young", "liner_poisson")


def _inputs_level(record: Record) -> ReachedLevel:
    known = {item["name"]: item for item in record["inputs"]}
    fixed = [name for name in _KEY_INPUTS if name in known and not known[name]["tolerance"]]
    without = [name for name, item in known.items() if not item["source"]]
    missing = [f"a tolerance for the {_titles(fixed)}"] if fixed else []
    missing += [f"a source for the {_titles(without)}"] if without else []
    if not record["uncertainty"]:
        return ReachedLevel("a", "sources of the inputs as stated", "; ".join(["tolerances, propagated", *missing]))
    supported = "tolerances propagated about the worst case, with Sobol indices"
    if missing:
        return ReachedLevel("b", supported, "; ".join(missing))
    return ReachedLevel("c", supported, "measured distributions, and the correlation of the inputs")


def _applying(record: Record, *verdicts: str) -> list[Mapping[str, Any]]:
    """Return claims of others and comparators with a verdict on their applicability; by default all that apply."""
    verdicts, compared = verdicts or (APPLIES, APPLIES_IN_PART), [*record["claims"], *record["comparators"]]
    return [comparator for comparator in compared if comparator["applicability"]["verdict"] in verdicts]


def _samples_level(record: Record) -> ReachedLevel:
    applying = _applying(record)
    measured = [comparator for comparator in applying if MEASURED in comparator.get("kind", "")]
    count = len(record["claims"]) + len(record["comparators"])
    supported = f"{counted(count, 'published result')}, {len(measured)} of them measured on joints like these"
    missing = "measurements of the device itself"
    return ReachedLevel("b" if measured else "a", supported, missing)


def _conditions_level(record: Record) -> ReachedLevel:
    where = [comparator["applicability"]["where"].get("F/(E R1²)") for comparator in _applying(record)]
    count = {reach: where.count(reach) for reach in (WITHIN, IN_PART)}
    supported = f"the loads of the question lie within those of the comparators that apply: {count[WITHIN]}"
    supported += f", in part: {count[IN_PART]}" if count[IN_PART] else ""
    missing = "conditions of the device's own use, measured with their uncertainty"
    if count[WITHIN]:
        return ReachedLevel("c", supported, missing)
    missing = f"a comparator at the loads of the question; {missing}"
    return ReachedLevel("b" if count[IN_PART] else "a", supported, missing)


def _equivalency_level(record: Record) -> ReachedLevel:
    applying = _applying(record)
    assumed = [comparator for comparator in applying if comparator.get("assumed")]
    supported = f"all inputs are stated by {len(applying) - len(assumed)} of {counted(len(applying), 'comparator')}"
    if not applying or len(assumed) == len(applying):
        return ReachedLevel("a", supported, "a comparator that applies and states all of its inputs")
    if assumed or _applying(record, APPLIES_IN_PART):
        return ReachedLevel("b", supported, "inputs of the same kind and range for every comparator")
    return ReachedLevel("c", supported, "")


def _outputs_level(record: Record) -> ReachedLevel:
    compared = [comparator for comparator in _applying(record) if comparator.get("numbers") or comparator.get("ours")]
    supported = f"differences of {counted(len(compared), 'published result')}, as numbers"
    missing = "an experiment with stated uncertainty at the loads of the question"
    return ReachedLevel("b" if compared else "a", supported, missing)


_COMPARED = ("max_pressure", "half_angle", "area", "indentation")  # quantities that comparators publish


def _quantities_level(record: Record) -> ReachedLevel:
    limited = [limit["name"] for limit in record["limits"] if limit["name"] in NAMES] or list(record["worst"])
    names = list(dict.fromkeys(name for name in limited if name not in LOADS))
    shared = [name for name in names if name in _COMPARED]
    unpublished = [name for name in names if name not in _COMPARED]
    supported = f"also published: {_titles(shared) or 'none of the limited numbers'}"
    missing = f"a comparator for the {_titles(unpublished)}" if unpublished else ""
    return ReachedLevel("c" if not unpublished and shared else "b" if shared else "a", supported, missing)


def _relevance_level(record: Record) -> ReachedLevel:
    full, partial = _applying(record, APPLIES), _applying(record, APPLIES_IN_PART)
    foreign = [_name(comparator) for comparator in _applying(record, DOES_NOT_APPLY)]
    applying = [f"{_name(comparator)} ({comparator['applicability']['verdict']})" for comparator in (*full, *partial)]
    missing = [f"not of these joints: {', '.join(foreign)}"] if foreign else []
    supported = "; ".join(applying) or "no comparator has joints like these"
    if not applying:
        return ReachedLevel("a", supported, "; ".join(["a comparator of joints like these", *missing]))
    missing.append("an argument that the comparators are relevant for the context of use")
    if not full:
        missing.insert(0, "a comparator whose range includes all cases of the question")
    return ReachedLevel("c" if full else "b", supported, "; ".join(missing))


def _name(comparator: Mapping[str, Any]) -> str:
    return str(comparator.get("title") or comparator["where"])


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %"


LEVELS_REACHED: Mapping[str, Callable[[Record], ReachedLevel]] = {
    "software quality assurance": _software_level,
    "numerical code verification": _code_level,
    "discretization error": _discretization_level,
    "numerical solver error": _solver_level,
    "use error": _use_level,
    "model form": _form_level,
    "model inputs": _inputs_level,
    "test samples": _samples_level,
    "test conditions": _conditions_level,
    "equivalency of input parameters": _equivalency_level,
    "output comparison": _outputs_level,
    "relevance of the quantities of interest": _quantities_level,
    "relevance of the validation activities to the context of use": _relevance_level,
}
"""Assessments by factor."""
