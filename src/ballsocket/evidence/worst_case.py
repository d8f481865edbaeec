"""Calculations for the worst cases: other methods, bands over the tolerances, and wear."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.util import find_spec
from math import isfinite
from pathlib import Path
from typing import Any

import numpy

from ..catalogue import reference, with_gap
from ..contact import Contact, Model
from ..core.arrays import Numbers, to_numpy
from ..core.deprecation import renamed_names
from ..core.quantities import CONTACT, QUANTITIES
from ..core.validity import OutsideDomainError
from ..elasticity.exact.tabulated.model import Tabulated
from ..elasticity.finite_elements.model import FiniteElement
from ..elasticity.off_axis.model import Sphere
from ..hip.config import HipFile, read_hip
from ..hip.simulation import HipSimulation
from ..hip.uncertainty import uncertainty
from ..problem import Joint
from ..studies.axes import Method
from ..studies.design import sample
from ..studies.parameters import AIMS, LOADS, PARAMETERS, press_arguments
from ..studies.run import default_model
from ..studies.sensitivity import sensitivity
from .matrix import Case, known_errors
from .question import ALMOST_ALL, Question

ALONG = " (along the axis)"
"""Suffix of the name of a method that aligns the load with the axis."""

_COMPARED = ("max_pressure", "half_angle", "area", "indentation", "force")
_BANDED = ("max_pressure", "half_angle", "area", "indentation")

_PERCENTILES = (2.5, 50.0, 97.5)
_TABULATED_SAMPLES, _EXACT_SAMPLES = 1024, 64
_SEED = 1


@dataclass(frozen=True, kw_only=True)
class CalculationMethod:
    """Result of one method for a case.

    Attributes
    ----------
    name : str
    numbers, errors : mapping of str to float
        Numbers and known relative errors, by quantity.
    valid : bool
        True in the range of the method.
    notes : tuple of str
    aligned : bool
        True for a load along the axis of the cup.
    """

    name: str
    numbers: Mapping[str, float]
    errors: Mapping[str, float]
    valid: bool
    notes: tuple[str, ...] = ()
    aligned: bool = True

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON, with the units of files."""
        return {
            "name": self.name,
            "numbers": {
                CONTACT[name].key: value * CONTACT[name].written.factor
                for name, value in self.numbers.items()
                if isfinite(value)
            },
            "errors": {CONTACT[name].key: value for name, value in self.errors.items() if isfinite(value)},
            "valid": self.valid,
            "notes": list(self.notes),
            "aligned": self.aligned,
        }


def compare_methods(question: Question, case: Case) -> list[CalculationMethod]:
    """Solve a case by every method for a load along the axis; a tilted load also by the off-axis solver."""
    joint, load, _ = press_arguments(question.file.joint, case)
    aligned = list(_solve_aligned(question, joint, _size(load)))
    return [*_solve_off_axis(question, joint, load), *aligned] if len(_size(load)) < len(load) else aligned


def _size(load: Mapping[str, Any]) -> dict[str, Any]:
    """Return a load without its direction."""
    return {name: value for name, value in load.items() if name not in AIMS}


def _suffix(question: Question) -> str:
    """Return the suffix of methods that align the load of a question."""
    return ALONG if question.model.off_axis else ""


def _solve_off_axis(question: Question, joint: Joint, load: Mapping[str, Any]) -> Iterator[CalculationMethod]:
    """Solve a case off the axis, on rings of the default width and of half the width."""
    model = question.model
    assert isinstance(model, Sphere)
    fine = replace(model, ring_width=model.ring_width / 2)
    for name, solver in {"sphere": model, "sphere, rings of half the width": fine}.items():
        yield replace(_solve(name, solver, joint, load), aligned=False)


def _solve_aligned(question: Question, joint: Joint, load: Mapping[str, Any]) -> Iterator[CalculationMethod]:
    """Solve a case with its load along the axis, by every method that can."""
    cup, suffix = question.file.cup, _suffix(question)
    models: dict[str, Model] = {
        f"exact{suffix}": with_gap(reference, question.gap).in_cup(cup),
        f"tabulated{suffix}": Tabulated().in_cup(cup),
        f"sphere{ALONG}": with_gap(Sphere(cup=cup), question.gap),
    }
    if question.finite_elements and find_spec("skfem") is not None:
        models[f"finite elements{suffix}"] = with_gap(FiniteElement(cup=cup), question.gap)
    for name, model in models.items():
        try:
            yield _solve(name, model, joint, load)
        except OutsideDomainError:
            continue


def _solve(name: str, model: Model, joint: Joint, load: Mapping[str, Any]) -> CalculationMethod:
    """Solve a case with one model; return its numbers, known errors and notes."""
    contact = model.press(joint, **load)
    return CalculationMethod(
        name=name,
        numbers={quantity: float(getattr(contact, quantity)) for quantity in _COMPARED},
        errors={quantity: float(error) for quantity, error in known_errors(contact).items() if quantity in _COMPARED},
        valid=bool(contact.valid),
        notes=tuple(contact.notes),
    )


def solve_with_calculix(question: Question, case: Case) -> list[CalculationMethod]:
    """Solve a case along the axis with CalculiX; return an empty list if it is not installed or not required."""
    if not (question.finite_elements and shutil.which("ccx") and find_spec("skfem")):
        return []
    joint, load, _ = press_arguments(question.file.joint, case)
    model = with_gap(FiniteElement(cup=question.file.cup, meshes=1), question.gap)
    return [_run_calculix(f"CalculiX{_suffix(question)}", model, joint, _size(load))]


def _run_calculix(name: str, model: FiniteElement, joint: Joint, load: Mapping[str, Any]) -> CalculationMethod:
    """Run CalculiX on the input deck of a contact."""
    from ..elasticity.finite_elements.calculix import run
    from ..elasticity.finite_elements.deck import deck_of

    contact: Contact = model.press(joint, **load)
    failed = CalculationMethod(name=name, numbers={}, errors={}, valid=False, notes=tuple(contact.notes))
    if contact.status.failed:
        return failed
    with tempfile.TemporaryDirectory() as folder:
        deck_of(contact, steps=4).write(Path(folder))  # type: ignore[arg-type]
        try:
            result = run(Path(folder))
        except RuntimeError as error:
            return replace(failed, notes=(str(error),))
    numbers = {
        "indentation": result.indentation,
        "force": result.force,
        "half_angle": result.half_angle,
        "max_pressure": result.pole_pressure,
    }
    last = {quantity: float(value[-1]) for quantity, value in numbers.items()}
    return CalculationMethod(name=name, numbers=last, errors={}, valid=True)


def largest_deviation(methods: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """Compute the largest relative deviation of the methods from the first, by quantity.

    Parameters
    ----------
    methods : sequence of mapping
        Summaries of `CalculationMethod`. Only valid methods with the load direction of the first are compared.
    """
    first, *candidates = methods
    compared = [method for method in candidates if method["valid"] and method["aligned"] == first["aligned"]]
    deviations = {}
    for name, value in first["numbers"].items():
        known = [method["numbers"][name] for method in compared if name in method["numbers"]]
        if known and value:
            deviations[name] = max(abs(number / value - 1) for number in known)
    return deviations


def propagate_tolerances(question: Question, case: Case) -> dict[str, Any]:
    """Compute the bands of a case over the tolerances, and the Sobol index of each tolerance.

    An input with a tolerance follows the tolerance, also if the matrix varies it. Loads off the axis are aligned.
    """
    spreads = question.tolerances
    load = {name: value for name, value in case.items() if name in LOADS and name not in spreads}
    fixed = {name: value for name, value in case.items() if name not in (*AIMS, *load, *spreads)}
    joint, _, _ = press_arguments(question.file.joint, fixed)
    ends = {
        name: [float(spread.frozen.ppf(share)) for share in ALMOST_ALL]
        for name, spread in spreads.items()
        if name not in LOADS
    }
    model = default_model(joint, ends) if question.gap is None else with_gap(reference, question.gap)
    count = _EXACT_SAMPLES if model.name == reference.name else _TABULATED_SAMPLES
    drawn = sample(count, seed=_SEED, method=Method.SOBOL, **dict[str, Any](spreads)).values_in([slice(None)])
    made, loads, possible = press_arguments(joint, {**drawn, **load})
    contact = model.press(made, **loads)
    results = {name: _finite_results(getattr(contact, name), to_numpy(possible), count) for name in _BANDED}
    indices = sensitivity(
        model, joint, spreads, quantities=_BANDED[:2], count=count // 4, confidence=None, load=load
    ).total_order
    return {
        "model": model.name,
        "samples": count,
        "seed": _SEED,
        "bands": {QUANTITIES[name].key: _band(name, values) for name, values in results.items()},
        "sobol": {
            QUANTITIES[name].key: {spread: float(indices.sel(quantity=name, parameter=spread)) for spread in spreads}
            for name in _BANDED[:2]
        },
        "aligned": any(name in AIMS for name in case),
        "notes": list(_outside_notes(question, case)),
        "call": "ballsocket.evidence.worst_case.propagate_tolerances(question, case)",
    }


def _outside_notes(question: Question, case: Case) -> Iterator[str]:
    """Note the inputs of the worst case that lie outside their tolerance."""
    for name in (name for name in question.tolerances if name in case):
        low, high = (float(question.tolerances[name].frozen.ppf(end)) for end in (0.0, 1.0))
        if not low <= case[name] <= high:
            quantity = PARAMETERS[name]
            value, smallest, largest = (f"{number * quantity.written.factor:g}" for number in (case[name], low, high))
            unit = f" {quantity.written.text}".rstrip()
            yield (
                f"{quantity.title} {value}{unit} of the worst case lies outside its tolerance of {smallest} to "
                f"{largest}{unit}: the bands cover the tolerance and do not include the worst case"
            )


def _finite_results(values: Any, possible: Numbers, count: int) -> Numbers:
    """Return the results of the samples that are possible joints and have a result."""
    results: Numbers = numpy.where(possible, numpy.broadcast_to(to_numpy(values), count), numpy.nan)
    return results[numpy.isfinite(results)]


def _band(name: str, values: Numbers) -> Mapping[str, float]:
    """Compute low end, median and high end of a quantity over the samples, in the unit of files."""
    factor = QUANTITIES[name].written.factor
    ends = numpy.percentile(values, _PERCENTILES) * factor
    return {"low": float(ends[0]), "median": float(ends[1]), "high": float(ends[2]), "answered": len(values)}


_CUP_ANGLES = ("inclination", "anteversion")


def wear_rates(question: Question, cases: Sequence[Case]) -> list[float | None]:
    """Compute the wear rate of a new bore in mm³ per million cycles for several cases; None without a contact.

    The loads are those of the cycle: cases that differ only in their load are computed once.
    """
    assert question.hip is not None
    file, known = read_hip(question.hip), dict[tuple[Any, ...], float | None]()
    for case in cases:
        if _geometry(case) not in known:
            known[_geometry(case)] = _wear_rate(question, file, case)
    return [known[_geometry(case)] for case in cases]


def _geometry(case: Case) -> tuple[Any, ...]:
    """Return the parameters of a case without its load."""
    return tuple((name, value) for name, value in case.items() if name not in LOADS)


def _wear_rate(question: Question, file: HipFile, case: Case) -> float | None:
    """Compute the wear rate of the first cycle; None if the hip cannot be simulated."""
    try:
        return float(_simulation(question, file, case).first.volume)
    except ValueError:  # no contact in the cycle, or a contact over the rim
        return None


def _simulation(question: Question, file: HipFile, case: Case) -> HipSimulation:
    """Create the simulation of the hip file with the joint and the cup angles of a case."""
    joint, _, _ = press_arguments(question.file.joint, dict(_geometry(case)))
    angles: dict[str, Any] = {name: case[name] for name in _CUP_ANGLES if name in case}
    return replace(file.use, joint=joint, cup=replace(file.use.cup, **angles))


def wear_history(question: Question, case: Case) -> dict[str, Any]:
    """Simulate the wear of a case over the cycles of the hip file, with bands of 95 % for an uncertainty table."""
    assert question.hip is not None
    file = read_hip(question.hip)
    hip = _simulation(question, file, case)
    history = hip.after(file.cycles, file.report_at, lubricant=file.lubricant)
    call = "ballsocket.evidence.worst_case.wear_history(question, case)"
    result: dict[str, Any] = {**history.summary(), "file": question.hip.name, "call": call}
    if file.uncertain is not None:
        variability = replace(file.uncertain.variability, use=hip)
        result |= uncertainty(variability, history, count=file.uncertain.count, seed=file.uncertain.seed).summary()
    return result


__getattr__ = renamed_names(
    __name__,
    {
        "beside": "compare_methods",
        "scattered": "propagate_tolerances",
        "rates": "wear_rates",
        "worn": "wear_history",
    },
)
