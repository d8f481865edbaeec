"""Commands `press` and `curve`: one joint under one load or under increasing loads."""

from __future__ import annotations

import sys
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees, pi
from typing import TYPE_CHECKING, Annotated, Any

import numpy
import typer

from ..comparison import Comparison, compare, successful_contacts
from ..contact import Contact, Model
from ..contact.verdict import assess_strength, error_bar
from ..core.arrays import to_list
from ..core.checks import known_name
from ..core.quantities import CONTACT
from ..core.validity import Status
from ..elasticity.off_axis import Preload, PullOut
from ..elasticity.off_axis import pull_out as compute_pull_out
from ..files.joint_file import JointFile, tilted_cup
from ..model_catalogue import catalogue, judge, off_axis, reference, with_gap
from ..problem import Joint
from ..problem.cup import UP, Cup
from ..problem.presets import long_term_note
from ..reports.terminal import print_curve, print_press
from ..reports.unit_systems import Units
from ..version import __version__
from .elasticity_options import (
    CupOptions,
    DirectionOptions,
    MeshOptions,
    TimedModel,
    mesh_remark,
    orientation_remark,
    orientation_summary,
    refuse_mesh_options,
    solve_mesh,
    sphere_remark,
)
from .json_answers import echo_json, several_joints
from .model_file import is_model_file, requested_model
from .options import (
    AsJson,
    GapName,
    JointName,
    JointNames,
    JointOptions,
    LoadOptions,
    UnitSystem,
    complete_model,
    expand_groups,
)
from .press_files import FigureOptions, ReportOptions
from .root import app, fail

if TYPE_CHECKING:
    from ..dynamics import Friction

DEFAULT_MODEL = "hess-forsbach"


@dataclass(frozen=True, kw_only=True)
class ModelOptions:
    """Options of the models that press a joint."""

    model: Annotated[
        list[str] | None,
        typer.Option(
            help="Name of a model (see `ballsocket models`), fem, sphere, or FILE.py:NAME for a custom model. "
            f"Repeat for several. Default: {DEFAULT_MODEL}.",
            autocompletion=complete_model,
        ),
    ] = None
    every: Annotated[bool, typer.Option("--all", help="Press by every model of the catalogue.")] = False
    gap: GapName = None

    @property
    def names(self) -> list[str]:
        """Names of the requested models, as in the catalogue; custom models as FILE.py:NAME."""
        known = (*catalogue, judge.name, off_axis.name)
        return [name if is_model_file(name) else known_name("model", name, known) for name in self.model or ()]

    @property
    def has_finite_elements(self) -> bool:
        """True if the finite elements are requested."""
        return judge.name in self.names

    def choose_gaps(self, models: Mapping[str, Model]) -> dict[str, Model]:
        """Return the models and the exact one, with the requested gap where they have a choice."""
        chosen = {**models, reference.name: models.get(reference.name, reference)}
        return {name: with_gap(model, self.gap if hasattr(model, "gap") else None) for name, model in chosen.items()}

    def models(self, default: str) -> dict[str, Model]:
        """Return the requested models by name, or the default one."""
        if self.every:
            custom = [requested_model(name) for name in self.names if is_model_file(name)]
            return {**{model.name: model for model in custom}, **catalogue}
        models = [requested_model(name) for name in self.names or [default]]
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

    def check_pull_out(self, models: Container[str], assumed_arc: bool) -> None:
        """Raise ValueError for a pull-out force without the model `sphere`, or without an arc of cover."""
        if self.pull_out and off_axis.name not in models:
            raise ValueError(f"--pull-out is solved by the model {off_axis.name}: add --model {off_axis.name}")
        if self.pull_out and assumed_arc:
            raise ValueError(
                "--pull-out needs the arc of cover: add --arc-of-cover, or arc_of_cover in [cup] of the file"
            )

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

    def remark(self, name: str, contact: Contact, units: Units) -> str:
        """Return one line with the friction torques of a contact."""
        torques = self.torques(contact)

        def text(kind: str) -> str:
            across, along = (units.torque(torques[f"{kind}_torque{axis}"]) for axis in ("", "_about_load"))
            return f"{kind} torque {across} about an axis across the load, {along} about the load"

        if torques["static_coefficient"] == torques["coefficient"]:
            return f"{name}: friction {torques['coefficient']:g}: {text('running')}; breakaway torque the same"
        return (
            f"{name}: friction {torques['coefficient']:g}, static {torques['static_coefficient']:g}: "
            f"{text('running')}; {text('breakaway')}"
        )


@dataclass(kw_only=True)
class PressedJoint:
    """Results of one joint of the command, with remarks on their computation.

    For a preloaded joint, `assumptions` are sentences, and `wear_depth_to_loosen` is the uniform wear of the bore in mm
    that ends the preload. `orientation` has the angles of the cup in degrees by each definition, if it has any.
    """

    file: JointFile
    comparison: Comparison
    models: Mapping[str, Model]
    remarks: list[str]
    assumptions: list[str]
    wear_depth_to_loosen: float | None
    orientation: dict[str, Any]
    pulled: PullOut | None

    def summary(self, friction: FrictionOptions) -> dict[str, Any]:
        """Return the results as plain data, with the friction torques and the pull-out force if requested."""
        summary = self.comparison.summary()
        for result in summary["results"]:
            result.update(_strength_summary(self.comparison.get(result["model"])))
        for result in summary["results"] if friction.friction is not None else ():
            contact = self.comparison.get(result["model"])
            result["friction"] = None if contact is None else friction.torques(contact)
        pull_out = None if self.pulled is None else self.pulled.summary()
        preload = {} if self.wear_depth_to_loosen is None else {"wear_depth_to_loosen": self.wear_depth_to_loosen}
        further = {"assumptions": self.assumptions, "preload": preload, "orientation": self.orientation}
        return {**summary, **{key: part for key, part in {**further, "pull_out": pull_out}.items() if part}}


def _strength_summary(contact: Contact | None) -> dict[str, Any]:
    """Return the verdict on the strengths with its reason, and the bar of the utilisation; empty without a contact."""
    if contact is None:
        return {}
    strength, bar = assess_strength(contact), map(to_list, error_bar(contact, "utilisation")[1:])
    ends = dict(zip(("utilisation_low", "utilisation_high"), bar, strict=True))
    return {**ends, "verdict": strength.verdict.word, "verdict_reason": strength.words}


@app.command()
@expand_groups
def press(
    *,
    joint: JointNames = None,
    joint_options: JointOptions,
    load_options: LoadOptions,
    friction_options: FrictionOptions,
    model_options: ModelOptions,
    units: UnitSystem = Units.SI,
    as_json: AsJson = False,
    files: FigureOptions,
    report: ReportOptions,
    direction_options: DirectionOptions,
    cup_options: CupOptions,
    mesh: Annotated[MeshOptions, "fem"],
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
        refuse_mesh_options({**vars(mesh), "meshes": meshes})
    files.check()
    report.check()
    friction_options.check()
    names: Sequence[str | None] = joint or [None]
    files.check_single(len(names))

    def press_joint(name: str | None) -> PressedJoint:
        """Press one joint by the requested models."""
        file = joint_options.read(name)
        is_at_rest = file.joint.clearance < 0 and load_options.are_missing(file)
        load = {"force": 0.0} if is_at_rest else load_options.read(file)
        direction, remarks = direction_options.read(file), []
        stated_cup = cup_options.apply_to(file.cup)
        held_cup = stated_cup.around_ball(file.joint.clearance)
        assumed_arc = held_cup is not stated_cup
        assumptions = ["force 0 assumed, the ball is at rest in its socket; set --force"] if is_at_rest else []
        assumptions += _preload_assumptions(file.joint, held_cup if assumed_arc else None)
        orientation = {} if "tilt" in direction else orientation_summary(stated_cup)
        remarks += [orientation_remark(stated_cup)] if orientation and joint_options.orients else []
        cup = tilted_cup(held_cup, direction)
        needs_sphere = friction_options.pull_out or direction or cup.tilt(UP) > 0 or file.joint.clearance < 0
        models = model_options.models(off_axis.name if needs_sphere else DEFAULT_MODEL)
        if model_options.has_finite_elements and direction:
            raise ValueError("fem solves axial loads only; for --tilt or --direction use --model sphere")
        files.check_models(models)
        friction_options.check_pull_out(models, assumed_arc)
        if off_axis.name not in models:
            direction_options.refuse()
        else:
            sphere = replace(direction_options.model(), cup=cup).with_direction(**direction)
            timed: Any = TimedModel(with_gap(sphere, model_options.gap))
            models[off_axis.name] = timed
        if model_options.has_finite_elements:
            fem: Any = with_gap(mesh.model(cup, meshes or 2), model_options.gap)
            models[judge.name] = fem
            remarks.append(mesh_remark(*solve_mesh(fem, file.joint, load)))
        comparison = _compare(replace(file, cup=cup), load, models, model_options.choose_gaps(models))
        if off_axis.name in comparison:
            remarks.append(sphere_remark(comparison[off_axis.name], timed.seconds, units))
        if friction_options.friction is not None:
            contacts = successful_contacts(comparison)
            remarks += [friction_options.remark(name, contacts[name], units) for name in models if name in contacts]
        remarks += assumptions
        wear_depth = None
        if off_axis.name in comparison and file.joint.clearance < 0 and held_cup.arc_of_cover > pi:
            wear_depth = Preload(model=timed.model, joint=file.joint).wear_depth_to_loosen()
            remarks.append(f"uniform wear of the bore by {units.length(wear_depth)} ends the preload")
        pulled = None
        if friction_options.pull_out:
            pulled = compute_pull_out(timed.model, file.joint, friction_options.friction or 0.0)
            remarks += _pull_out_remarks(pulled, units)
        return PressedJoint(
            file=replace(file, cup=held_cup, load=load, aim=direction),
            comparison=comparison,
            models=models,
            remarks=remarks,
            assumptions=assumptions,
            wear_depth_to_loosen=wear_depth,
            orientation=orientation,
            pulled=pulled,
        )

    joints = [press_joint(name) for name in names]
    for pressed in joints:
        files.write(pressed.comparison, next(iter(pressed.models)), units)
    designs = [
        report.design(pressed.comparison, pressed.file, pressed.models, units, pressed.remarks) for pressed in joints
    ]
    report.write(designs, units)
    if as_json:
        summaries = [pressed.summary(friction_options) for pressed in joints]
        single = len(summaries) == 1
        echo_json(summaries[0] if single else several_joints(summaries, joint or (), sys.argv[1:]))
    else:
        for pressed in joints:
            print_press(pressed.comparison, pressed.remarks, units)
    for pressed in joints:
        _exit_on_failure(pressed.comparison, pressed.models)


def _preload_assumptions(joint: Joint, assumed_cup: Cup | None) -> list[str]:
    """Return sentences on an assumed cup and on the long-term modulus of a preloaded joint; empty for a clearance."""
    if joint.clearance >= 0:
        return []
    arc = "" if assumed_cup is None else f"{degrees(assumed_cup.arc_of_cover):g}°"
    cover = f"arc of cover {arc} assumed for a preloaded joint; set --arc-of-cover" if arc else ""
    return list(filter(None, (cover, long_term_note(joint.liner))))


def _pull_out_remarks(pulled: PullOut, units: Units) -> list[str]:
    """Return lines with the pull-out force, its displacement and its limits."""
    if not pulled.force >= 0.0:
        return list(pulled.notes)
    force, displacement = units.text_of(CONTACT["force"], pulled.force), units.length(pulled.displacement)
    return [f"pull-out force {force}, {displacement} out of the cup's centre", *pulled.notes]


def _compare(
    file: JointFile, load: Mapping[str, float], names: Container[str], models: Mapping[str, Model]
) -> Comparison:
    """Press a joint by models, of which those with some names are requested.

    Raises
    ------
    ValueError
        None of the models has a result for such a joint.
    """
    comparison = compare(file.joint, models=models, cup=file.cup, **load)
    if not any(name in names for name in comparison):
        raise ValueError("; ".join(reason for name, reason in comparison.missing.items() if name in names))
    return comparison


def _exit_on_failure(comparison: Comparison, models: Iterable[str]) -> None:
    """Exit with a message and a status if there is no result or no convergence."""
    unconverged = [name for name, contact in comparison.items() if contact.status == Status.NOT_CONVERGED]
    if unconverged:
        fail(f"no convergence of {', '.join(unconverged)} (see the notes)")
    if not set(successful_contacts(comparison)) & set(models):
        fail(f"no answer from {', '.join(models)} (see the notes)")


@app.command()
@expand_groups
def curve(
    *,
    joint: JointName = None,
    joint_options: JointOptions,
    load_options: LoadOptions,
    model: Annotated[str, typer.Option(help="Name of a model (see `ballsocket models`), or FILE.py:NAME.")] = "exact",
    gap: GapName = None,
    points: Annotated[
        int, typer.Option(min=2, max=500, help="Number of loads in equal steps from zero to the given load.")
    ] = 21,
    cup: CupOptions,
    as_json: AsJson = False,
) -> None:
    """Press a joint in equal steps from zero to a load.

    The table shows force, indentation, stiffness, pressure and area of one model at each step.

    Exit status: 0 success, 2 wrong input, 3 no result at any load.
    """
    file, named = joint_options.read(joint), with_gap(requested_model(model), gap)
    fractions = numpy.linspace(0.0, 1.0, points)
    steps: dict[str, Any] = {name: end * fractions for name, end in load_options.read(file).items()}
    contact = named.in_cup(cup.apply_to(file.cup)).press(file.joint, **steps)
    if as_json:
        summary: Any = contact.summary()
        valid = {"valid": all(summary["valid"]), "valid_at": summary["valid"]}
        echo_json({"version": __version__, "joint": file.joint.summary(), **summary, **valid})
    else:
        print_curve(contact)
    if not numpy.isfinite(contact.indentation[1:]).any():
        fail(f"no answer from {named.name} at any load (see the notes)")
