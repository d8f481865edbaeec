"""Calculations for the worst cases: other methods, bands over the tolerances, and wear."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib.util import find_spec
from math import isfinite
from pathlib import Path
from typing import Any

import numpy

from ..contact import Contact, Model
from ..core.arrays import Numbers, to_numpy
from ..core.quantities import CONTACT, QUANTITIES
from ..core.unit_systems import Amount, Sentence, to_json
from ..core.validity import OutsideDomainError
from ..elasticity.exact.tabulated.model import Tabulated
from ..elasticity.finite_elements.model import FiniteElement
from ..elasticity.off_axis.model import Sphere
from ..hip.config import HipFile, read_hip
from ..hip.simulation import HipSimulation
from ..hip.wear_uncertainty import uncertainty
from ..model_catalogue import reference, with_gap
from ..problem import Joint
from ..problem.gaps import GAP_KINDS, CircularGap, select_gap
from ..studies.axes import Method
from ..studies.design import sample
from ..studies.parameters import AIMS, LOADS, PARAMETERS, press_arguments
from ..studies.run import default_model
from ..studies.variance_shares import sensitivity
from .matrix import Case, known_errors
from .question import ALMOST_ALL, Question

ALONG = " (along the axis)"  # suffix of the name of a method that aligns the load with the axis

_COMPARED = ("max_pressure", "half_angle", "area", "indentation", "force")
_BANDED = ("max_pressure", "half_angle", "area", "indentation")

_TABULATED_SAMPLES, _EXACT_SAMPLES = 1024, 64
_SEED = 1


@dataclass(frozen=True, kw_only=True)
class CalculationMethod:
    """Result of one method for a case."""

    name: str
    # numbers and known relative errors, by quantity
    numbers: Mapping[str, float]
    errors: Mapping[str, float]
    valid: bool  # True in the range of the method
    notes: tuple[str, ...] = ()
    aligned: bool = True  # True for a load along the axis of the cup

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
            "notes": list(map(to_json, self.notes)),
            "aligned": self.aligned,
        }


def compare_methods(question: Question, case: Case) -> list[CalculationMethod]:
    """Solve a case by every method for a load along the axis; a tilted load also by the off-axis solver.

    The off-axis solver has rings of its width, and of half the width. Methods that cannot solve the case are omitted,
    and `Tabulated`, whose gap is linear, where the others take the circular gap.
    """
    joint, load, size = _joint_and_load(question, case)
    methods = []
    if len(size) < len(load):
        model = question.model
        assert isinstance(model, Sphere)
        fine = replace(model, ring_width=model.ring_width / 2)
        for name, solver in {"sphere": model, "sphere, rings of half the width": fine}.items():
            methods.append(replace(_solve(name, solver, joint, load), aligned=False))
    cup, suffix = question.file.cup, ALONG if question.model.off_axis else ""
    models: dict[str, Model] = {
        f"exact{suffix}": with_gap(reference, question.gap).in_cup(cup),
        f"tabulated{suffix}": Tabulated().in_cup(cup),
        f"sphere{ALONG}": with_gap(Sphere(cup=cup), question.gap),
    }
    if question.finite_elements and find_spec("skfem") is not None:
        models[f"finite elements{suffix}"] = with_gap(FiniteElement(cup=cup), question.gap)
    if select_gap(None if question.gap is None else GAP_KINDS[question.gap], joint) is CircularGap:
        del models[f"tabulated{suffix}"]
    for name, model in models.items():
        with suppress(OutsideDomainError):
            methods.append(_solve(name, model, joint, size))
    return methods


def _joint_and_load(question: Question, case: Case) -> tuple[Joint, dict[str, Any], dict[str, Any]]:
    """Return the joint of a case, its load, and the load without its direction."""
    joint, load, _ = press_arguments(question.file.joint, case)
    return joint, load, {name: value for name, value in load.items() if name not in AIMS}


def _solve(name: str, model: Model, joint: Joint, load: Mapping[str, Any]) -> CalculationMethod:
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
    from ..elasticity.finite_elements.calculix import run
    from ..elasticity.finite_elements.deck import deck_of

    joint, _, size = _joint_and_load(question, case)
    model = with_gap(FiniteElement(cup=question.file.cup, meshes=1), question.gap)
    contact: Contact = model.press(joint, **size)
    name = f"CalculiX{ALONG if question.model.off_axis else ''}"
    failed = CalculationMethod(name=name, numbers={}, errors={}, valid=False, notes=tuple(contact.notes))
    if contact.status.failed:
        return [failed]
    with tempfile.TemporaryDirectory() as folder:
        deck_of(contact, steps=4).write(Path(folder))  # type: ignore[arg-type]
        try:
            result = run(Path(folder))
        except RuntimeError as error:
            return [replace(failed, notes=(str(error),))]
    numbers = {key: float(getattr(result, key)[-1]) for key in ("indentation", "force", "half_angle")}
    numbers["max_pressure"] = float(result.pole_pressure[-1])
    return [CalculationMethod(name=name, numbers=numbers, errors={}, valid=True)]


def largest_deviation(methods: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """Compute the largest relative deviation of the methods from the first, by quantity.

    Of the summaries of `CalculationMethod`, only valid ones with the load direction of the first are compared.
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
    results = {
        name: numpy.where(to_numpy(possible), numpy.broadcast_to(to_numpy(getattr(contact, name)), count), numpy.nan)
        for name in _BANDED
    }
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
        "notes": list(map(to_json, _outside_notes(question, case))),
        "call": "ballsocket.evidence.worst_case.propagate_tolerances(question, case)",
    }


def _outside_notes(question: Question, case: Case) -> Iterator[str]:
    """Note the inputs of the worst case that lie outside their tolerance."""
    for name in (name for name in question.tolerances if name in case):
        low, high = (float(question.tolerances[name].frozen.ppf(end)) for end in (0.0, 1.0))
        if not low <= case[name] <= high:
            quantity = PARAMETERS[name]
            amounts = (Amount(number, quantity.written, 6) for number in (case[name], low, high))
            text = (
                "{} {} of the worst case lies outside its tolerance of {} to {}: the bands cover the tolerance and do "
                "not include the worst case"
            )
            yield Sentence(text, quantity.title, *amounts)


def _band(name: str, values: Numbers) -> Mapping[str, float]:
    """Compute low end, median and high end of a quantity over the samples with a result, in the unit of files."""
    known = values[numpy.isfinite(values)]
    low, median, high = (
        float(end) for end in numpy.percentile(known, (2.5, 50.0, 97.5)) * QUANTITIES[name].written.factor
    )
    return {"low": low, "median": median, "high": high, "answered": len(known)}


def wear_rates(question: Question, cases: Sequence[Case]) -> list[float | None]:
    """Compute the wear rate of a new bore in mm³ per million cycles for several cases; None without a contact.

    The loads are those of the cycle: cases that differ only in their load are computed once.
    """
    assert question.hip is not None
    file, known = read_hip(question.hip), dict[tuple[Any, ...], float | None]()
    rates = []
    for case in cases:
        geometry = tuple((name, value) for name, value in case.items() if name not in LOADS)
        if geometry not in known:
            try:
                known[geometry] = float(_simulation(question, file, case).first.volume)
            except ValueError:  # no contact in the cycle, or a contact over the rim
                known[geometry] = None
        rates.append(known[geometry])
    return rates


def _simulation(question: Question, file: HipFile, case: Case) -> HipSimulation:
    geometry = {name: value for name, value in case.items() if name not in LOADS}
    joint, _, _ = press_arguments(question.file.joint, geometry)
    angles: dict[str, Any] = {name: case[name] for name in ("inclination", "anteversion") if name in case}
    return replace(file.use, joint=joint, cup=replace(file.use.cup, **angles))


def wear_history(question: Question, case: Case) -> dict[str, Any]:
    """Simulate the wear of a case over the cycles of the hip file, with bands of 95 % for an uncertainty table."""
    assert question.hip is not None
    file = read_hip(question.hip)
    hip = _simulation(question, file, case)
    history = hip.after(file.cycles, file.report_at, lubricant=file.lubricant)
    call = "ballsocket.evidence.worst_case.wear_history(question, case)"
    notes = list(map(to_json, history.notes))
    result: dict[str, Any] = {**history.summary(), "notes": notes, "file": question.hip.name, "call": call}
    if file.uncertain is not None:
        variability = replace(file.uncertain.variability, use=hip)
        result |= uncertainty(variability, history, count=file.uncertain.count, seed=file.uncertain.seed).summary()
    return result
