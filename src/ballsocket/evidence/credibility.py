"""The 13 credibility factors of ASME V&V 40-2018 with the required and the reached level.

The names of the factors and the rule are those of ASME V&V 40-2018 and of the FDA guidance "Assessing the Credibility
of Computational Modeling and Simulation in Medical Device Submissions" (17 November 2023): a gradation of activities
for each factor, a goal set by the model risk, and the level reached. Both leave gradations and goals to the user. The
gradations here follow the examples of the standard, reworded. The goals are a proposal and open to discussion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from ..studies.parameters import LOADS
from .matrix import NAMES
from .question import LEVELS
from .terms import input_title, limit_text

Record = Mapping[str, Any]
"""What was gathered, as it stands in JSON."""

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
class ReachedLevel:
    """Level that a record reaches in a gradation: its letter, its support, and the missing evidence."""

    level: str
    supported: str
    missing: str


@dataclass(frozen=True)
class Factor:
    """A credibility factor.

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


def _software(record: Record) -> ReachedLevel:
    run = [check for check in record["code_verification"] if check["passed"] is not None]
    failed = [check["name"] for check in run if not check["passed"]]
    supported = f"ballsocket {record['version']}, its libraries and {len(run)} checks run on this machine"
    missing = "the list of known faults, judged for this context of use by a quality system of the user"
    if failed:
        return ReachedLevel("a", supported, f"failed checks: {', '.join(failed)}; {missing}")
    return ReachedLevel("b", supported, missing)


def _code(record: Record) -> ReachedLevel:
    checks = {check["name"]: check["passed"] for check in record["code_verification"]}
    run, passed = [p for p in checks.values() if p is not None], [n for n, p in checks.items() if p]
    failed, absent = ([n for n, p in checks.items() if p is wrong] for wrong in (False, None))
    supported = f"{len(passed)} of {len(run)} checks passed on this machine"
    missing = [f"failed: {', '.join(failed)}"] if failed else []
    missing += [f"not run: {', '.join(absent)}"] if absent else []
    if failed or not passed:
        return ReachedLevel("a", supported, "; ".join(missing) or "any check")
    off_axis = record["model"]["name"] == "sphere"
    if off_axis or not checks.get("own-tolerance"):
        missing.append("an order of convergence of the solver in use, against an exact solution")
        return ReachedLevel("b", supported, "; ".join(missing))
    if not (checks.get("order-of-elements") and _elements(record)):
        missing.append("the observed order of a second method that solves the worst cases (finite elements)")
        return ReachedLevel("c", supported, "; ".join(missing))
    return ReachedLevel("d", supported, "; ".join(missing))


def _elements(record: Record) -> bool:
    names = [method["name"] for piece in record["calculation"] for method in piece["methods"] if method["valid"]]
    return any(name.startswith("finite elements") for name in names)


def error_margins(record: Record) -> list[dict[str, Any]]:
    """Compute the largest error bar of each limited number as a share of its margin to the limit.

    The share is None where the number has no error bar, or no value. Above 1 the error could change a verdict.
    """
    return [_margin(limit, record) for limit in record["limits"] if limit["name"] in NAMES]


def _margin(limit: Mapping[str, Any], record: Record) -> dict[str, Any]:
    key, ratios = NAMES[limit["name"]].key, []
    for row in record["matrix"]:
        value, error = row["numbers"].get(key), row["errors"].get(key)
        if value is None or error is None:
            return {"limit": limit_text(limit), "name": limit["name"], "share": None}
        ends = [abs(value - end) for end in (limit["low"], limit["high"]) if end is not None]
        ratios.append(error * abs(value) / min(ends) if min(ends) else inf)
    largest = max(ratios, default=None)
    return {"limit": limit_text(limit), "name": limit["name"], "share": None if largest == inf else largest}


def _titles(names: Sequence[str]) -> str:
    return ", ".join(NAMES[name].title for name in names)


def _discretization(record: Record) -> ReachedLevel:
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


def _solver(record: Record) -> ReachedLevel:
    pieces, required = record["calculation"], record["required"]["accuracy"]
    largest = max((max(piece["deviation"].values(), default=0.0) for piece in pieces), default=0.0)
    alone = [piece["worst_of"] for piece in pieces if not piece["deviation"]]
    supported = f"other methods of the same body differ by {_percent(largest)} at most, at {len(pieces)} worst cases"
    if not pieces or len(alone) == len(pieces):
        return ReachedLevel(
            "a", "one method only", "a second method or other settings of the solver at the worst cases"
        )
    if alone or largest > required:
        return ReachedLevel("b", supported, f"agreement within the required {_percent(required)} at every worst case")
    names = [method["name"] for method in _valid_methods(record)]
    if not any(name.startswith("CalculiX") for name in names):
        return ReachedLevel("c", supported, "another program at the worst case (CalculiX, with finite_elements = true)")
    return ReachedLevel("d", supported, "")


def _valid_methods(record: Record) -> Iterator[Mapping[str, Any]]:
    return (method for piece in record["calculation"] for method in piece["methods"] if method["valid"])


def _use(record: Record) -> ReachedLevel:
    without = [item["name"] for item in record["inputs"] if not item["source"]]
    supported = "the question file, which is checked on reading, and the call for every number"
    missing = "a second person who compares drawing, inputs and the text of the question"
    if without:
        return ReachedLevel("a", supported, f"a source for the {_listed(without)}; {missing}")
    return ReachedLevel("b", supported, missing)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(map(input_title, names))


def _form(record: Record) -> ReachedLevel:
    bodies = {method["name"].split(" (")[0].split(",")[0] for method in _valid_methods(record)} - {"tabulated"}
    rows = record["matrix"]
    utilisations = [row["numbers"].get("utilisation") for row in rows]
    invalid = sum(not row["valid"] for row in rows)
    supported = f"linear elasticity of the bodies that the notes name, by {', '.join(sorted(bodies)) or 'no method'}"
    never = "plasticity, creep and friction in the contact itself; see limits and assumptions"
    missing = []
    if invalid:
        missing.append(f"{invalid} of {len(rows)} cases lie outside the range of the model")
    if None in utilisations:
        missing.append("strength not checked: no yield stress, or no result")
    elif max(utilisations, default=0.0) > 1:
        missing.append("von Mises stress exceeds the yield stress: the material is not elastic there")
    level = "a" if len(bodies) < 2 else "b" if missing else "c"
    if len(bodies) < 2:
        missing.insert(0, "a second body or method at the worst cases")
    return ReachedLevel(level, supported, "; ".join([*missing, never]))


_KEY_INPUTS = ("ball_radius", "clearance", "liner_thickness", "liner_young", "liner_poisson")


def _inputs(record: Record) -> ReachedLevel:
    known = {item["name"]: item for item in record["inputs"]}
    fixed = [name for name in _KEY_INPUTS if name in known and not known[name]["tolerance"]]
    without = [name for name, item in known.items() if not item["source"]]
    missing = [f"a tolerance for the {_listed(fixed)}"] if fixed else []
    missing += [f"a source for the {_listed(without)}"] if without else []
    if not record["uncertainty"]:
        return ReachedLevel("a", "sources of the inputs as stated", "; ".join(["tolerances, propagated", *missing]))
    supported = "tolerances propagated about the worst case, with Sobol indices"
    if missing:
        return ReachedLevel("b", supported, "; ".join(missing))
    return ReachedLevel("c", supported, "measured distributions, and the correlation of the inputs")


def _comparators(record: Record) -> Sequence[Mapping[str, Any]]:
    return [*record["claims"], *record["comparators"]]


def _applying(record: Record, *verdicts: str) -> list[Mapping[str, Any]]:
    return [comparator for comparator in _comparators(record) if comparator["applicability"]["verdict"] in verdicts]


def _samples(record: Record) -> ReachedLevel:
    applying = _applying(record, "applies", "applies in part")
    measured = [comparator for comparator in applying if "measured" in comparator.get("kind", "")]
    supported = f"{len(_comparators(record))} published results, {len(measured)} of them measured on joints like these"
    missing = "measurements of the device itself"
    return ReachedLevel("b" if measured else "a", supported, missing)


_FORCE = "F/(E R1²)"


def _conditions(record: Record) -> ReachedLevel:
    where = [
        comparator["applicability"]["where"].get(_FORCE)
        for comparator in _applying(record, "applies", "applies in part")
    ]
    count = {reach: where.count(reach) for reach in ("within", "in part")}
    supported = f"the loads of the question lie within those of {count['within']} comparators that apply"
    supported += f", in part within those of {count['in part']}" if count["in part"] else ""
    missing = "conditions of the device's own use, measured with their uncertainty"
    if count["within"]:
        return ReachedLevel("c", supported, missing)
    return ReachedLevel(
        "b" if count["in part"] else "a", supported, f"a comparator at the loads of the question; {missing}"
    )


def _equivalency(record: Record) -> ReachedLevel:
    applying = _applying(record, "applies", "applies in part")
    assumed = [comparator for comparator in applying if comparator.get("assumed")]
    supported = f"{len(applying) - len(assumed)} of {len(applying)} comparators that apply state all of their inputs"
    if not applying or len(assumed) == len(applying):
        return ReachedLevel("a", supported, "a comparator that applies and states all of its inputs")
    if assumed or _applying(record, "applies in part"):
        return ReachedLevel("b", supported, "inputs of the same kind and range for every comparator")
    return ReachedLevel("c", supported, "")


def _outputs(record: Record) -> ReachedLevel:
    compared = [
        comparator
        for comparator in _applying(record, "applies", "applies in part")
        if comparator.get("numbers") or comparator.get("ours")
    ]
    supported = f"differences of {len(compared)} published results that apply, as numbers"
    missing = "an experiment with stated uncertainty at the loads of the question"
    return ReachedLevel("b" if compared else "a", supported, missing)


_COMPARED = ("max_pressure", "half_angle", "area", "indentation")
"""Quantities published by comparators."""


def _quantities(record: Record) -> ReachedLevel:
    limited = [limit["name"] for limit in record["limits"] if limit["name"] in NAMES] or list(record["worst"])
    names = list(dict.fromkeys(name for name in limited if name not in LOADS))
    shared = [name for name in names if name in _COMPARED]
    unpublished = [name for name in names if name not in _COMPARED]
    supported = f"also published: {_titles(shared) or 'none of the limited numbers'}"
    missing = f"a comparator for the {_titles(unpublished)}" if unpublished else ""
    return ReachedLevel("c" if not unpublished and shared else "b" if shared else "a", supported, missing)


def _relevance(record: Record) -> ReachedLevel:
    full, partial = _applying(record, "applies"), _applying(record, "applies in part")
    not_at_all = [_name(comparator) for comparator in _applying(record, "does not apply")]
    applying = [f"{_name(comparator)} ({comparator['applicability']['verdict']})" for comparator in (*full, *partial)]
    missing = [f"not of these joints: {', '.join(not_at_all)}"] if not_at_all else []
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
        _software,
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
        _code,
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
        _discretization,
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
        _solver,
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
        _use,
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
        _form,
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
        _inputs,
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
        _samples,
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
        _conditions,
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
        _equivalency,
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
        _outputs,
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
        _quantities,
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
        _relevance,
    ),
)
