"""Calculation verification: the error bar of a worst case, and every other method that can answer it beside."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.util import find_spec
from math import isfinite
from pathlib import Path
from typing import Any

from ..catalogue import reference
from ..contact import Contact, Model
from ..core.quantities import CONTACT
from ..core.validity import OutsideDomainError
from ..elasticity.exact.tabulated.model import Tabulated
from ..elasticity.finite_elements.model import FiniteElement
from ..elasticity.off_axis.model import Sphere
from ..problem import Joint
from ..studies.parameters import AIMS, press_arguments
from .matrix import Case, known_errors
from .question import Question

ALONG = " (along the axis)"
SHOWN = ("max_pressure", "half_angle", "area", "indentation", "force")


@dataclass(frozen=True, kw_only=True)
class CalculationMethod:
    """What one method answers.

    Attributes
    ----------
    name : str
    numbers, errors : mapping of str to float
        By quantity; errors are relative, those that the method knows of itself.
    valid : bool
    notes : tuple of str
    aligned : bool
        Whether the load is along the cup's axis.
    """

    name: str
    numbers: Mapping[str, float]
    errors: Mapping[str, float]
    valid: bool
    notes: tuple[str, ...] = ()
    aligned: bool = True

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON, with the units of files."""
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


def beside(question: Question, case: Case) -> list[CalculationMethod]:
    """A case by every method that can answer it along the axis; off the axis by the solver on finer rings too."""
    joint, load, _ = press_arguments(question.file.joint, case)
    aim = {name: value for name, value in load.items() if name in AIMS}
    plain = {name: value for name, value in load.items() if name not in AIMS}
    methods = list(_along(question, joint, plain))
    if aim:
        methods = [*_off_axis(question, joint, load), *methods]
    return methods


def _off_axis(question: Question, joint: Joint, load: Mapping[str, Any]) -> Iterator[CalculationMethod]:
    model = question.model
    assert isinstance(model, Sphere)
    half = replace(model, ring_width=model.ring_width / 2)
    for name, one in {"sphere": model, "sphere, rings of half the width": half}.items():
        yield replace(_method(name, one, joint, load), aligned=False)


def _along(question: Question, joint: Joint, load: Mapping[str, Any]) -> Iterator[CalculationMethod]:
    """By name what can answer; off the axis these are the same joint and load along the axis."""
    cup = question.file.cup
    turned = ALONG if question.model.off_axis else ""
    models: dict[str, Model] = {
        f"exact{turned}": reference.in_cup(cup),
        f"tabulated{turned}": Tabulated().in_cup(cup),
        f"sphere{ALONG}": Sphere(cup=cup),
    }
    if question.finite_elements and find_spec("skfem") is not None:
        models[f"finite elements{turned}"] = FiniteElement(cup=cup)
    for name, model in models.items():
        try:
            yield _method(name, model, joint, load)
        except OutsideDomainError:
            continue


def rival(question: Question, case: Case) -> list[CalculationMethod]:
    """A case along the axis by another program's elements; none where that is not installed, or not asked for."""
    if not (question.finite_elements and shutil.which("ccx") and find_spec("skfem")):
        return []
    joint, load, _ = press_arguments(question.file.joint, case)
    turned = ALONG if question.model.off_axis else ""
    plain = {name: value for name, value in load.items() if name not in AIMS}
    return [_calculix(f"CalculiX{turned}", FiniteElement(cup=question.file.cup, meshes=1), joint, plain)]


def _method(name: str, model: Model, joint: Joint, load: Mapping[str, Any]) -> CalculationMethod:
    contact = model.press(joint, **load)
    errors = {each: float(value) for each, value in known_errors(contact).items() if each in SHOWN}
    return CalculationMethod(
        name=name,
        numbers={each: float(getattr(contact, each)) for each in SHOWN},
        errors=errors,
        valid=bool(contact.valid),
        notes=tuple(contact.notes),
    )


def _calculix(name: str, model: FiniteElement, joint: Joint, load: Mapping[str, Any]) -> CalculationMethod:
    """Another program's elements, run here on our deck."""
    from ..elasticity.finite_elements.decks.calculix import run
    from ..elasticity.finite_elements.decks.deck import deck_of

    contact: Contact = model.press(joint, **load)
    if contact.status.failed:
        return CalculationMethod(name=name, numbers={}, errors={}, valid=False, notes=tuple(contact.notes))
    with tempfile.TemporaryDirectory() as folder:
        deck_of(contact, steps=4).write(Path(folder))  # type: ignore[arg-type]
        try:
            found = run(Path(folder))
        except RuntimeError as error:
            return CalculationMethod(name=name, numbers={}, errors={}, valid=False, notes=(str(error),))
    numbers = {"indentation": found.indentation, "force": found.force, "half_angle": found.half_angle}
    numbers["max_pressure"] = found.pole_pressure
    return CalculationMethod(
        name=name, numbers={each: float(value[-1]) for each, value in numbers.items()}, errors={}, valid=True
    )


def largest_deviation(methods: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """How far the others are from the first at most, relative and by quantity: those that answer the same question.

    Parameters
    ----------
    methods : sequence of mapping
        Summaries of `Method`, the one that answers first. What was pressed along the axis is not compared with what
        was not.
    """
    first, *others = methods
    same = [one for one in others if one["valid"] and one["aligned"] == first["aligned"]]
    found = {}
    for name, value in first["numbers"].items():
        known = [one["numbers"][name] for one in same if name in one["numbers"]]
        if known and value:
            found[name] = max(abs(each / value - 1) for each in known)
    return found
