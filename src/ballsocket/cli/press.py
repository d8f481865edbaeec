"""Commands `press` and `curve`: one joint under one load or under increasing loads."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy
import typer

from ..catalogue import catalogue, judge, off_axis, reference
from ..compare import Comparison, compare, successful_contacts
from ..contact import Model
from ..core.checks import known_name
from ..core.validity import Status
from ..files.joint_file import JointFile
from ..problem.cup import UP
from ..reports.terminal import print_curve, print_press
from ..reports.unit_systems import Units
from ..version import __version__
from .elasticity_options import (
    CupOptions,
    DirectionOptions,
    MeshOptions,
    TimedModel,
    mesh_remark,
    refuse_mesh_options,
    solve_mesh,
    sphere_in_cup,
    sphere_remark,
    tilted_cup,
)
from .json_answers import echo_json
from .model_file import is_model_file, requested_model
from .options import AsJson, JointName, JointOptions, LoadOptions, expand_groups
from .press_files import FigureOptions, ReportOptions
from .root import FAILURE, app, print_message

DEFAULT_MODEL = "hess-forsbach"


@dataclass(frozen=True, kw_only=True)
class ModelOptions:
    """Options of the models that press a joint."""

    model: Annotated[
        list[str] | None,
        typer.Option(
            help="Name of a model (see `ballsocket models`), fem, sphere, or FILE.py:NAME for a custom model. "
            f"Repeat for several. Default: {DEFAULT_MODEL}."
        ),
    ] = None
    every: Annotated[bool, typer.Option("--all", help="Press by every model of the catalogue.")] = False

    @property
    def names(self) -> list[str]:
        """Names of the requested models, as in the catalogue; custom models as FILE.py:NAME."""
        known = (*catalogue, judge.name, off_axis.name)
        return [name if is_model_file(name) else known_name("model", name, known) for name in self.model or ()]

    @property
    def has_finite_elements(self) -> bool:
        """True if the finite elements are requested."""
        return judge.name in self.names

    def models(self, default: str) -> dict[str, Model]:
        """Return the requested models by name, or the default one."""
        if self.every:
            custom = [requested_model(name) for name in self.names if is_model_file(name)]
            return {**{model.name: model for model in custom}, **catalogue}
        models = [requested_model(name) for name in self.names or [default]]
        named = {model.name: model for model in models}
        if len(named) < len(set(self.names)):
            raise ValueError("two of the models have one name: give each custom model a name of its own")
        return named


@app.command()
@expand_groups
def press(
    *,
    joint: JointName = None,
    joint_options: JointOptions,
    load_options: LoadOptions,
    model_options: ModelOptions,
    units: Annotated[
        Units, typer.Option(case_sensitive=False, help="Units of the table; JSON is always in mm, N, MPa.")
    ] = Units.SI,
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

    Exit status: 0 success, 2 wrong input, 3 an iteration did not converge or no model has a result.
    """
    if not model_options.has_finite_elements:
        refuse_mesh_options({**vars(mesh), "meshes": meshes})
    files.check()
    report.check()
    file = joint_options.read(joint)
    load = load_options.read(file)
    direction, remarks = direction_options.read(file), []
    cup = tilted_cup(cup_options.apply_to(file.cup), direction)
    needs_sphere = direction or cup.tilt(UP) > 0 or file.joint.clearance < 0
    models = model_options.models(off_axis.name if needs_sphere else DEFAULT_MODEL)
    if model_options.has_finite_elements and direction:
        raise ValueError("fem solves axial loads only; for --tilt or --direction use --model sphere")
    files.check_models(models)
    if off_axis.name not in models:
        direction_options.refuse()
    if off_axis.name in models:
        timed: Any = TimedModel(sphere_in_cup(direction_options.model(), cup, direction))
        models[off_axis.name] = timed
    if model_options.has_finite_elements:
        fem = mesh.model(cup, meshes or 2)
        models[judge.name] = fem
        remarks.append(mesh_remark(*solve_mesh(fem, file.joint, load)))
    comparison = _compare(replace(file, cup=cup), load, models)
    if off_axis.name in comparison:
        remarks.append(sphere_remark(comparison[off_axis.name], timed.seconds))
    files.write(comparison, next(iter(models)))
    report.write(comparison, replace(file, cup=cup, load=load, aim=direction), units)
    if as_json:
        echo_json(comparison.summary())
    else:
        print_press(comparison, remarks, units)
    _exit_on_failure(comparison, models)


def _compare(file: JointFile, load: Mapping[str, float], models: Mapping[str, Model]) -> Comparison:
    """Press a joint by the models and the exact one.

    Raises
    ------
    ValueError
        None of the models has a result for such a joint.
    """
    comparison = compare(file.joint, models={**models, reference.name: reference}, cup=file.cup, **load)
    if not set(comparison) & set(models):
        raise ValueError("; ".join(reason for name, reason in comparison.missing.items() if name in models))
    return comparison


def _exit_on_failure(comparison: Comparison, models: Iterable[str]) -> None:
    """Exit with a message and a status if there is no result or no convergence."""
    failure = _failure(comparison, models)
    if failure:
        print_message(failure)
        raise typer.Exit(FAILURE)


def _failure(comparison: Comparison, models: Iterable[str]) -> str:
    """Return the message of a failed comparison; empty if one of the models has a result and all converged."""
    unconverged = [name for name, contact in comparison.items() if contact.status == Status.NOT_CONVERGED]
    if unconverged:
        return f"no convergence of {', '.join(unconverged)} (see the notes)"
    return (
        ""
        if set(successful_contacts(comparison)) & set(models)
        else f"no answer from {', '.join(models)} (see the notes)"
    )


@app.command()
@expand_groups
def curve(
    *,
    joint: JointName = None,
    joint_options: JointOptions,
    load_options: LoadOptions,
    model: Annotated[str, typer.Option(help="Name of a model (see `ballsocket models`), or FILE.py:NAME.")] = "exact",
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
    file, named = joint_options.read(joint), requested_model(model)
    fractions = numpy.linspace(0.0, 1.0, points)
    steps: dict[str, Any] = {name: end * fractions for name, end in load_options.read(file).items()}
    contact = named.in_cup(cup.apply_to(file.cup)).press(file.joint, **steps)
    if as_json:
        echo_json({"version": __version__, "joint": file.joint.summary(), **_curve_summary(contact)})
    else:
        print_curve(contact)
    if not numpy.isfinite(contact.indentation[1:]).any():
        print_message(f"no answer from {named.name} at any load (see the notes)")
        raise typer.Exit(FAILURE)


def _curve_summary(contact: Any) -> dict[str, Any]:
    """Return the values of a curve as lists; `valid` is true if every point is valid."""
    summary = contact.summary()
    return {**summary, "valid": all(summary["valid"]), "valid_at": summary["valid"]}
