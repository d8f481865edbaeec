"""The credibility factors of ASME V&V 40, each with what supports it here and what is missing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Results = Mapping[str, Any]
"""What was gathered, as it stands in JSON."""


@dataclass(frozen=True)
class Factor:
    """A factor: its activity and name, and from the results what supports it and what is missing."""

    activity: str
    name: str
    supported: Callable[[Results], str]
    missing: Callable[[Results], str]

    def summary(self, found: Results) -> dict[str, str]:
        """One dictionary for JSON."""
        return {
            "activity": self.activity,
            "factor": self.name,
            "supported_by": self.supported(found),
            "missing": self.missing(found),
        }


def _always(text: str) -> Callable[[Results], str]:
    return lambda found: text


def _checks(found: Results) -> str:
    run = [each for each in found["code_verification"] if each["passed"] is not None]
    passed = sum(bool(each["passed"]) for each in run)
    return f"{passed} of {len(run)} checks run here and now passed"


def _not_run(found: Results) -> str:
    names = [each["name"] for each in found["code_verification"] if each["passed"] is None]
    failed = [each["name"] for each in found["code_verification"] if each["passed"] is False]
    said = ([f"failed: {', '.join(failed)}"] if failed else []) + ([f"not run: {', '.join(names)}"] if names else [])
    return "; ".join(said) or "nothing"


def _deviation(found: Results) -> str:
    worst = max((max(each["deviation"].values(), default=0.0) for each in found["calculation"]), default=0.0)
    return f"other methods at every worst case; those of the same body differ by {100 * worst:.2g} % at most"


def _bars(found: Results) -> str:
    errors = [each for row in found["matrix"] for each in row["errors"].values()]
    return f"error bars of every number of the matrix, at most {100 * max(errors, default=0.0):.2g} %"


def _inputs(found: Results) -> str:
    without = [each["name"] for each in found["inputs"] if not each["source"]]
    return f"without a source: {', '.join(without)}" if without else "nothing"


def _scatter(found: Results) -> str:
    return "tolerances propagated, with Sobol indices" if found["uncertainty"] else "sources of the inputs as stated"


def _comparators(found: Results) -> str:
    return f"{len(found['claims'])} published results judged, {len(found['comparators'])} more beside ours"


def _applicable(found: Results) -> str:
    return "; ".join(_named(found, "applies", "applies in part")) or "no comparator speaks of these joints"


def _not_applicable(found: Results) -> str:
    told = _named(found, "does not apply")
    others = f"not of these joints: {', '.join(told)}; " if told else ""
    return f"{others}to be argued by whoever signs"


def _named(found: Results, *verdicts: str) -> list[str]:
    """Comparators by their verdict on the question."""
    listed = [(each.get("title") or each["where"], each["applicability"]["verdict"]) for each in _all(found)]
    return [f"{name} ({verdict})" if len(verdicts) > 1 else name for name, verdict in listed if verdict in verdicts]


def _all(found: Results) -> Sequence[Mapping[str, Any]]:
    return [*found["claims"], *found["comparators"]]


FACTORS: Sequence[Factor] = (
    Factor(
        "code verification",
        "software quality assurance",
        _always("tests with every change, versions and a fingerprint of the code in this pack"),
        _always("a quality system of the one who uses it"),
    ),
    Factor("code verification", "numerical code verification", _checks, _not_run),
    Factor("calculation verification", "discretization error", _bars, _always("nothing")),
    Factor("calculation verification", "numerical solver error", _deviation, _always("nothing")),
    Factor(
        "calculation verification",
        "use error",
        _always("the question file, checked when it is read, and the call behind every number"),
        _always("a second person who reads the inputs"),
    ),
    Factor(
        "validation: computational model",
        "model form",
        _always("full linear elasticity of the bodies that the notes name; closed forms are not used"),
        _always("plasticity, creep and friction in the contact itself; see limits and assumptions"),
    ),
    Factor("validation: computational model", "model inputs", _scatter, _inputs),
    Factor("validation: comparator", "test samples", _comparators, _always("measurements of the device itself")),
    Factor(
        "validation: comparator",
        "test conditions",
        _always("loads and sizes of the publications, as far as they state them"),
        _always("conditions of the device's own use"),
    ),
    Factor(
        "validation: assessment",
        "equivalency of input parameters",
        _always("published and assumed inputs are listed apart for every comparator"),
        _always("inputs that the publications do not state"),
    ),
    Factor(
        "validation: assessment",
        "output comparison",
        _comparators,
        _always("an experiment with stated uncertainty at the loads of the question"),
    ),
    Factor(
        "applicability",
        "relevance of the quantities of interest",
        _always("contact pressure, half angle and area are those of the comparators"),
        _always("wear, torque and distance to the rim have no comparator among them"),
    ),
    Factor(
        "applicability",
        "relevance of the validation activities to the context of use",
        _applicable,
        _not_applicable,
    ),
)
