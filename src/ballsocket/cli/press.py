"""Commands `press` and `curve`: one joint under one load or under increasing loads."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Annotated, Any

import numpy
import typer

from ..comparison import successful_contacts
from ..contact import Contact, Model
from ..contact.verdict import error_bar
from ..core.arrays import Numbers, to_list
from ..core.checks import known_name
from ..core.kinds import NEWTON_METRES
from ..core.unit_systems import Amount, Sentence, Units
from ..core.validity import Status
from ..design_checks import assess_strength
from ..files.joint_file import JointFile
from ..files.joint_options import PARTS
from ..model_catalogue import JUDGE, OFF_AXIS, catalogue, reference, with_gap, with_yielding
from ..press_answer import describe_curve, design_verdict, press_remarks
from ..problem import Joint
from ..question import PressAnswer, PressQuestion, answer, complete, every_model
from ..reports.terminal import print_press
from .elasticity_options import (
    MeshTable,
    ModelNames,
    RingTable,
    Yielding,
    orientation_remark,
    orientation_summary,
    refuse_mesh_options,
    solver_progress,
)
from .json_answers import echo_json, several_joints
from .options import (
    AsJson,
    GapName,
    JointName,
    JointNames,
    JointOptions,
    UnitSystem,
    expand_groups,
    is_model_file,
    needed_load,
    print_result,
    requested_model,
)
from .press_files import FigureOptions, ReportOptions
from .root import app, fail

if TYPE_CHECKING:
    from ..dynamics import Friction


@dataclass(frozen=True, kw_only=True)
class ModelOptions:
    """Options of the models that press a joint."""

    model: ModelNames = None
    every: Annotated[bool, typer.Option("--all", help="Press by every model of the catalogue.")] = False
    gap: GapName = None
    plastic: Yielding = False

    @property
    def names(self) -> list[str]:
        """Names of the requested models, as in the catalogue; custom models as FILE.py:NAME."""
        known = (*catalogue, JUDGE, OFF_AXIS)
        names = [name if is_model_file(name) else known_name("model", name, known) for name in self.model or ()]
        return names if JUDGE in names or not self.plastic else [*names, JUDGE]

    @property
    def has_finite_elements(self) -> bool:
        """True if the finite elements are requested."""
        return JUDGE in self.names

    def models(self, file: JointFile, mesh: MeshTable, meshes: int) -> dict[str, Model]:
        """Return the requested models by name: empty for the default, and every one that presses the joint for all."""
        if self.every:
            custom = [requested_model(name) for name in self.names if is_model_file(name)]
            yielding = {JUDGE: mesh.model(meshes, self.plastic)} if self.plastic else {}
            return {**{model.name: model for model in custom}, **every_model(file), **yielding}
        models = [mesh.model(meshes, self.plastic) if name == JUDGE else requested_model(name) for name in self.names]
        named = {model.name: model for model in models}
        if len(named) < len(set(self.names)):
            raise ValueError("two of the models have one name: give each custom model a different name")
        return named


@dataclass(frozen=True, kw_only=True)
class FrictionOptions:
    """Options of the friction torque."""

    friction: Annotated[
        float | None,
        typer.Option(
            help="Coefficient of sliding friction. Adds running and breakaway torque to the results. "
            "Default: no torques."
        ),
    ] = None
    static_friction: Annotated[
        float | None,
        typer.Option(help="Coefficient of static friction, for the breakaway torque. Default: --friction."),
    ] = None

    pull_out: Annotated[
        bool,
        typer.Option("--pull-out", help="sphere: add the largest force while the ball is pulled out of its cup."),
    ] = False

    def check(self) -> None:
        """Raise ValueError for a negative coefficient, and for static friction without, or below, sliding friction."""
        if self.friction is not None:
            self._law(self.friction)
        elif self.static_friction is not None:
            raise ValueError("--static-friction needs the coefficient of sliding friction: add --friction")

    def _law(self, coefficient: float) -> Friction:
        from ..dynamics import Friction

        return Friction(coefficient=coefficient, static_coefficient=self.static_friction)

    def torques(self, contact: Contact) -> dict[str, Any]:
        """Compute the friction torques of a contact in N mm, with their coefficients; empty without friction."""
        if self.friction is None:
            return {}
        friction = self._law(self.friction)
        sliding, static = friction.coefficient, friction.breakaway_coefficient
        across, along = (contact.friction_torque(1.0, axis_angle) for axis_angle in (pi / 2, 0.0))
        return {
            "coefficient": sliding,
            "static_coefficient": static,
            "running_torque": sliding * across,
            "breakaway_torque": static * across,
            "running_torque_about_load": sliding * along,
            "breakaway_torque_about_load": static * along,
        }

    def remark(self, name: str, contact: Contact) -> Sentence:
        """Return one line with the friction torques of a contact."""
        torques = self.torques(contact)

        def words(kind: str) -> Sentence:
            amounts = (Amount(torques[f"{kind}_torque{axis}"], NEWTON_METRES, 3) for axis in ("", "_about_load"))
            return Sentence(f"{kind} torque {{}} about an axis across the load, {{}} about the load", *amounts)

        coefficients, breakaway = f"{torques['coefficient']:g}", "breakaway torque the same"
        if torques["static_coefficient"] != torques["coefficient"]:
            coefficients, breakaway = f"{coefficients}, static {torques['static_coefficient']:g}", words("breakaway")
        return Sentence("{}: friction {}: {}; {}", name, coefficients, words("running"), breakaway)


@dataclass(kw_only=True)
class PressedJoint:
    """Results of one joint of the command, with remarks on their computation.

    `orientation` has the angles of the cup in degrees by each definition, if it has any.
    """

    answer: PressAnswer
    remarks: list[str]
    orientation: dict[str, Any]

    def summary(self, friction: FrictionOptions) -> dict[str, Any]:
        """Return the results as plain data, with the friction torques and the pull-out force if requested."""
        comparison, pulled, wear_depth = self.answer.comparison, self.answer.pulled, self.answer.wear_depth_to_loosen
        summary = comparison.summary()
        for result in summary["results"]:
            contact: Any = comparison.get(result["model"])  # with its limits, if its liner yields
            if contact is not None:
                ends = map(to_list, error_bar(contact, "utilisation")[1:])
                result.update(zip(("utilisation_low", "utilisation_high"), ends, strict=True))
                if contact.yields:
                    result["collapse_load"] = to_list(contact.collapse_load)
                strength = assess_strength(contact)
                result.update(strength_verdict=strength.verdict.word, strength_reason=strength.words)
            if friction.friction is not None:
                result["friction"] = None if contact is None else friction.torques(contact)
        verdict, reason = design_verdict(self.answer)
        further = {
            "design_verdict": {"model": self.answer.leading, "verdict": verdict.word, "reason": reason},
            "assumptions": list(self.answer.assumptions),
            "preload": {} if wear_depth is None else {"wear_depth_to_loosen": wear_depth},
            "orientation": self.orientation,
            "pull_out": None if pulled is None else pulled.summary(),
        }
        return {**summary, **{key: part for key, part in further.items() if part}}


@app.command()
@expand_groups
def press(
    *,
    joint: JointNames = None,
    joint_options: Annotated[JointOptions, (*PARTS, "cup", "load")],
    friction_options: FrictionOptions,
    model_options: ModelOptions,
    units: UnitSystem = Units.SI,
    as_json: AsJson = False,
    files: FigureOptions,
    report: ReportOptions,
    rings: Annotated[RingTable, "sphere"],
    mesh: Annotated[MeshTable, "fem"],
    meshes: Annotated[
        int | None, typer.Option(min=1, max=2, help="fem: number of meshes; 1 gives no error estimate. Default: 2.")
    ] = None,
) -> None:
    """Press a ball into its socket under one load.

    The table compares the chosen models with the exact solution. The finite elements (--model fem) also include rims,
    chamfers and sliding liners. The model sphere solves loads at an angle to the cup's axis (--tilt, --direction).
    Several joints are pressed one after the other; --report puts them on one page.
    A preloaded joint (--interference) without a load is solved at rest, with force 0.

    Exit status: 0 success, 2 wrong input, 3 an iteration did not converge or no model has a result.
    """
    if not model_options.has_finite_elements:
        refuse_mesh_options({**mesh.stated(), "meshes": meshes})
    files.check()
    report.check()
    friction_options.check()
    names: Sequence[str | None] = joint or [None]
    files.check_single(len(names))

    def press_joint(name: str | None) -> PressedJoint:
        """Press one joint by the requested models."""
        file = joint_options.read(name)
        needed_load(complete(file)[0])
        question = PressQuestion(
            file=file,
            models=model_options.models(file, mesh, meshes or 2),
            sphere=rings.model(),
            gap=model_options.gap,
            pull_out=(friction_options.friction or 0.0) if friction_options.pull_out else None,
        )
        files.check_models(question.chosen)
        if OFF_AXIS not in question.chosen:
            rings.refuse()
        with solver_progress("finite elements") if model_options.has_finite_elements else nullcontext():
            answered = answer(question)
        orientation = {} if "tilt" in file.aim else orientation_summary(file.cup)
        remarks = [orientation_remark(file.cup)] if orientation and joint_options.orients else []
        remarks += press_remarks(answered)
        if friction_options.friction is not None:
            contacts = successful_contacts(answered.comparison)
            named = [name for name in answered.models if name in contacts]
            remarks += [friction_options.remark(name, contacts[name]) for name in named]
        return PressedJoint(answer=answered, remarks=remarks, orientation=orientation)

    joints = [press_joint(name) for name in names]
    for pressed in joints:
        files.write(pressed.answer.comparison, pressed.answer.models[0], units)
    designs = [report.design(pressed.answer, units, pressed.remarks) for pressed in joints]
    report.write(designs, units)
    if as_json:
        summaries = [pressed.summary(friction_options) for pressed in joints]
        single = len(summaries) == 1
        echo_json(summaries[0] if single else several_joints(summaries, joint or (), sys.argv[1:]))
    else:
        for pressed in joints:
            print_press(pressed.answer.comparison, pressed.remarks, units)
    for pressed in joints:
        comparison, requested = pressed.answer.comparison, pressed.answer.models
        unconverged = [name for name, contact in comparison.items() if contact.status == Status.NOT_CONVERGED]
        if unconverged:
            fail(f"no convergence of {', '.join(unconverged)} (see the notes)")
        if not set(successful_contacts(comparison)) & set(requested):
            fail(f"no answer from {', '.join(requested)} (see the notes)")


@app.command()
@expand_groups
def curve(
    *,
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*PARTS, "cup", "load")],
    model: Annotated[
        str | None,
        typer.Option(
            help=f"Name of a model (see `ballsocket models`), or FILE.py:NAME. Default: exact; {JUDGE} with --plastic, "
            f"{OFF_AXIS} with --both-signs."
        ),
    ] = None,
    gap: GapName = None,
    plastic: Yielding = False,
    points: Annotated[
        int, typer.Option(min=2, max=500, help="Number of loads in equal steps from zero to the given load.")
    ] = 21,
    both_signs: Annotated[
        bool, typer.Option("--both-signs", help="Begin with the opposite load; the table adds the displacement.")
    ] = False,
    units: UnitSystem = Units.SI,
    as_json: AsJson = False,
) -> None:
    """Press a joint in equal steps from zero to a load.

    The table shows force, indentation, stiffness, pressure and area of one model at each step.

    Exit status: 0 success, 2 wrong input, 3 no result at any load.
    """
    default = JUDGE if plastic else OFF_AXIS if both_signs else reference.name
    named = with_gap(requested_model(model or default), gap)
    file, named = joint_options.read(joint), with_yielding(named) if plastic else named
    ((name, end),), in_cup = needed_load(file).items(), named.in_cup(file.cup, **file.aim)
    signed: dict[str, Numbers] = {}
    if both_signs:
        contact, signed = _press_both_ways(in_cup, file.joint, name, end * numpy.linspace(-1.0, 1.0, points))
    else:
        contact = in_cup.press(file.joint, **{name: end * numpy.linspace(0.0, 1.0, points)})

    def summarise() -> dict[str, Any]:
        summary = {**contact.summary(), **{key: to_list(numbers) for key, numbers in signed.items()}}
        valid = {"valid": all(summary["valid"]), "valid_at": summary["valid"]}
        return {"joint": file.joint.summary(), **summary, **valid}

    print_result(summarise, lambda: describe_curve(contact, signed), units, as_json)
    if not numpy.isfinite(contact.indentation[1:]).any():
        fail(f"no answer from {named.name} at any load (see the notes)")


def _press_both_ways(model: Model, joint: Joint, kind: str, loads: Numbers) -> tuple[Contact, dict[str, Numbers]]:
    """Press along the direction of a load, and against it for negative loads; return force and displacement with signs.

    Raises ValueError: a model that presses towards the dome only.
    """
    from ..elasticity.off_axis.model import Sphere  # slow to import

    if not isinstance(model, Sphere):
        raise ValueError(f"{model.name} presses towards the dome only: for --both-signs use {OFF_AXIS}")
    signs, clearance = numpy.where(loads < 0.0, -1.0, 1.0), float(joint.clearance)
    if kind == "indentation":  # a displacement from the centre; within the clearance there is no contact
        displacement = loads + numpy.sign(loads) * max(clearance, 0.0)
        loads = numpy.maximum(abs(displacement) - clearance, 0.0)
    pressed: dict[str, Any] = {kind: abs(loads), "direction": signs[:, None] * model.direction}
    contact = model.press(joint, **pressed)
    if kind != "indentation":
        moved = signs * (contact.indentation + clearance)
        displacement = numpy.where(numpy.isfinite(moved), moved, numpy.nan)
    return contact, {"force": signs * contact.force, "displacement_along_load": displacement}
