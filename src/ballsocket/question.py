"""One question and its answer: a joint under one load, what is assumed, the models that solve it, and their results.

The command line, the tools for assistants and the explorer ask the same question::

    answered = answer(PressQuestion(file=read_joint("hip.toml")))
    answered.comparison[answered.leading].max_pressure
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import degrees, pi
from time import perf_counter
from typing import TYPE_CHECKING, Any

from .comparison import Comparison, compare
from .contact import Contact, Model
from .contact.model import relative_rim_distance
from .files.joint_file import JointFile
from .model_catalogue import JUDGE, OFF_AXIS, catalogue, named_models, reference, with_gap
from .problem.cup import AXIAL_TILT
from .problem.presets import long_term_note

if TYPE_CHECKING:
    from .elasticity.off_axis.model import Sphere
    from .elasticity.off_axis.preload import PullOut

DEFAULT_MODEL = "hess-forsbach"  # name of the model that solves a load along the axis of the cup without a request


@dataclass(frozen=True, kw_only=True)
class PressQuestion:
    """Joint under one load, and the wanted results."""

    file: JointFile  # joint, load, cup and direction of the load, as they are stated
    models: Mapping[str, Model] = field(default_factory=dict)  # requested models by name; empty for the default
    sphere: Sphere | None = None  # the model `sphere`, by default that of the catalogue
    exact: Model | None = reference  # solution with which the others are compared
    gap: str | None = None  # name of the gap of the models that have a choice
    pull_out: float | None = None  # coefficient of friction while the ball is pulled out of its cup, if it is

    @cached_property
    def chosen(self) -> dict[str, Model]:
        """Models that solve the question, by name: the requested ones, or the default one."""
        needs_sphere = self.pull_out is not None or real_cup_reason(self.file)
        default = OFF_AXIS if needs_sphere else DEFAULT_MODEL
        models = self.models or {default: named_models[default]}
        return {name: (self.sphere or model) if name == OFF_AXIS else model for name, model in models.items()}


@dataclass(frozen=True, kw_only=True)
class PressAnswer:
    """Results of a question."""

    file: JointFile  # joint, load, cup and direction that were solved, with what was assumed
    assumptions: tuple[str, ...]  # sentences on what was assumed
    models: tuple[str, ...]  # names of the requested models, or of the default one
    comparison: Comparison  # contacts of these models and of the exact solution
    seconds: dict[str, float]  # time of each press
    wear_depth_to_loosen: float | None  # uniform wear of the bore in mm that ends a preload
    pulled: PullOut | None  # largest force while the ball is pulled out

    @property
    def leading(self) -> str:
        """Name of the model whose contact gets the verdict: `sphere` where needed, else the most exact valid one."""
        ordered = [name for name in (OFF_AXIS, JUDGE, reference.name, *self.models) if name in self.comparison]
        needed = [OFF_AXIS] if OFF_AXIS in ordered and real_cup_reason(self.file) else []
        return [*needed, *(name for name in ordered if self.comparison[name].valid), *ordered][0]


def complete(file: JointFile) -> tuple[JointFile, dict[str, str]]:
    """Assume what the description of a preloaded joint leaves open: rest without a load, and a cup that holds the ball.

    The result has a sentence on each assumption, by the name of the number. A joint with a clearance remains the same.
    """
    if file.joint.clearance >= 0:
        return file, {}
    cup, load = file.cup.around_ball(file.joint.clearance), file.load or {"force": 0.0}
    arc = f"arc of cover {degrees(cup.arc_of_cover):g}° assumed for a preloaded joint; set arc_of_cover"
    sentences = {
        "force": "" if file.load else "force 0 assumed, the ball is at rest in its socket; set force",
        "arc_of_cover": "" if cup is file.cup else arc,
        "young": long_term_note(file.joint.liner),
    }
    return replace(file, cup=cup, load=load), {name: sentence for name, sentence in sentences.items() if sentence}


def real_cup_reason(file: JointFile, contact: Contact | None = None) -> str:
    """Return the reason why only the model `sphere` solves a question; empty where models of a full sphere do.

    The contact of such a model tells if the rim is near: the models hold up to one liner thickness from it.
    """
    if file.joint.clearance < 0:
        return "the ball is preloaded"
    if file.tilt > AXIAL_TILT:
        return f"the load is tilted {degrees(file.tilt):.3g}° against the axis of the cup"
    cup, direction = file.cup.under_load(file.tilt)
    near_rim = (
        contact is not None
        and not contact.status.failed
        and relative_rim_distance(cup, direction, contact) < 1.0  # over the liner thickness
    )
    return "the contact ends near the rim of the cup" if near_rim else ""


def every_model(file: JointFile) -> dict[str, Model]:
    """Return the catalogue, and first the model `sphere` if no other one solves the question."""
    return {**({OFF_AXIS: named_models[OFF_AXIS]} if real_cup_reason(file) else {}), **catalogue}


def answer(question: PressQuestion) -> PressAnswer:
    """Press a joint by the requested models and by the exact solution.

    Raises ValueError: none of the requested models has a result for such a joint; no load; a pull-out force without the
    model `sphere`, or without an arc of cover.
    """
    file, assumptions = complete(question.file)
    models = question.chosen
    if question.pull_out is not None and OFF_AXIS not in models:
        raise ValueError(f"a pull-out force is solved by the model {OFF_AXIS}: add it to the models")
    if question.pull_out is not None and "arc_of_cover" in assumptions:
        raise ValueError("a pull-out force needs the arc of cover: set arc_of_cover")
    comparison, seconds = Comparison(file.joint, {}, {}), {}
    compared = {} if question.exact is None else {question.exact.name: question.exact}
    for name, model in {**models, **{name: model for name, model in compared.items() if name not in models}}.items():
        chosen, start = with_gap(model, question.gap if hasattr(model, "gap") else None), perf_counter()
        pressed = compare(file.joint, models={name: chosen}, cup=file.cup, **file.aim, **file.load)
        comparison.contacts.update(pressed.contacts)
        comparison.missing.update(pressed.missing)
        seconds[name] = perf_counter() - start
    if not any(name in comparison for name in models):
        raise ValueError("; ".join(reason for name, reason in comparison.missing.items() if name in models))
    sphere: Any = comparison[OFF_AXIS].model if OFF_AXIS in comparison else None
    wear_depth = pulled = None
    if question.pull_out is not None:
        from .elasticity.off_axis.preload import pull_out

        pulled = pull_out(sphere, file.joint, question.pull_out)
    if sphere is not None and file.joint.clearance < 0 and file.cup.arc_of_cover > pi:
        from .elasticity.off_axis.preload import Preload

        wear_depth = Preload(model=sphere, joint=file.joint).wear_depth_to_loosen()
    return PressAnswer(
        file=file,
        assumptions=tuple(assumptions.values()),
        models=tuple(models),
        comparison=comparison,
        seconds=seconds,
        wear_depth_to_loosen=wear_depth,
        pulled=pulled,
    )
