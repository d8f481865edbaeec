"""`map`, `optimise` and `sensitivity`: questions that designers ask of many joints at once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

import ballsocket as bs

from ..io.joint_file import JointFile
from ..model import Model
from ..output import study_plots, study_summary, study_terminal
from ..output.save import check_format, save
from ..studies.design import grid
from ..studies.file import named_model
from ..studies.limits import Limit
from ..studies.optimum import optimise as find_optimum
from ..studies.parameters import LOADS
from ..studies.pareto import pareto
from ..studies.phrases import axis_of, limit_of, range_of, spread_of
from ..studies.sensitivity import sensitivity as find_sensitivity
from ..studies.task import QUANTITIES, USUAL
from .root import app
from .words import echo_json, given, load_of, named_joint

JointName = Annotated[str, typer.Argument(help="A joint file or a preset's name.")]
ModelName = Annotated[str, typer.Option(help="A model's name: tabulated, exact, hess-forsbach, ...")]
Force = Annotated[str | None, typer.Option(help="'3 kN'; without a load that of the joint's file")]
Indentation = Annotated[str | None, typer.Option(help="'40 um' in place of a force")]
Limits = Annotated[list[str] | None, typer.Option("--limit", help="'outer_radius<=26 mm'; repeat")]
Picture = Annotated[Path | None, typer.Option(help="Write a picture (.png, .svg, .pdf).")]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object instead of the table.")]


def _load(force: str | None, indentation: str | None, joint: JointFile, named: Iterable[str]) -> dict[str, float]:
    """The load; none where it is among what varies."""
    words = {"force": force, "indentation": indentation}
    varied = [name for name in named if name in LOADS]
    if varied and given(words):
        raise ValueError(f"{varied[0]} varies, and a load is given too; one is needed")
    return {} if varied else load_of(words, joint)


def _model(name: str, joint: JointFile) -> Model:
    """A model by its name, in the cup of the joint's file."""
    return named_model(name).in_cup(joint.cup)


def _limits(phrases: list[str] | None, joint: JointFile) -> list[Limit]:
    return [replace(limit_of(phrase), cup=joint.cup) for phrase in phrases or []]


def _once(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """As a dictionary, if no name comes twice."""
    found: dict[str, Any] = {}
    for name, value in pairs:
        if name in found:
            raise ValueError(f"{name} is given twice; one is needed")
        found[name] = value
    return found


def _shown(wishes: list[str]) -> list[str]:
    return list(dict.fromkeys((*wishes, *study_plots.SHOWN)))


def _quantities(wishes: Iterable[str], limits: Iterable[Limit]) -> list[str]:
    """What is shown, wished for, or limited."""
    limited = (limit.name for limit in limits if limit.name in QUANTITIES)
    return list(dict.fromkeys((*USUAL, *wishes, *limited)))


@app.command(name="map")
def design_map(
    joint: JointName,
    x: Annotated[str, typer.Option(help="The axis across, 'ball_radius=11..23 mm'.")] = "ball_radius=11..23 mm",
    y: Annotated[str, typer.Option(help="The axis upwards.")] = "liner_thickness=3..15 mm",
    points: Annotated[int, typer.Option(help="Values along each axis.")] = 41,
    model: ModelName = "tabulated",
    force: Force = None,
    indentation: Indentation = None,
    limit: Limits = None,
    figure: Picture = None,
    as_json: AsJson = False,
) -> None:
    """Map peak pressure, contact area and half angle over two numbers of a joint, with limits drawn."""
    if figure is not None:
        check_format(figure)
    file = named_joint(joint)
    limits = _limits(limit, file)
    axes = _once([axis_of(x, points), axis_of(y, points)])
    design = grid(**axes, **_load(force, indentation, file, axes))
    found = bs.study(_model(model, file), file.joint, design, quantities=_quantities((), limits))
    if as_json:
        echo_json(study_summary.map_summary(found, limits))
    else:
        study_terminal.print_map(found, limits)
    if figure is not None:
        save(study_plots.design_map(found, limits), figure)


@app.command()
def optimise(
    joint: JointName,
    vary: Annotated[list[str], typer.Option(help="'ball_radius=11..23 mm'; repeat")],
    minimise: Annotated[
        list[str] | None, typer.Option(help="max_pressure (default), area, ...; twice for the front between two")
    ] = None,
    model: ModelName = "tabulated",
    force: Force = None,
    indentation: Indentation = None,
    limit: Limits = None,
    points: Annotated[int, typer.Option(help="Values along each range, for a front of two.")] = 41,
    figure: Picture = None,
    as_json: AsJson = False,
) -> None:
    """Find the joint with the smallest answer within limits; with two answers, the joints that none beats in both."""
    if figure is not None:
        check_format(figure)
    file, chosen = named_joint(joint), minimise or ["max_pressure"]
    limits = _limits(limit, file)
    ranges = _once((name, (low, high)) for name, low, high in map(range_of, vary))
    if figure is not None and len(chosen) == 1 and len(ranges) != 2:
        raise ValueError(f"a map has two axes, and {len(ranges)} numbers vary: no figure")
    load = _load(force, indentation, file, ranges)
    answers, quantities = _model(model, file), _quantities(chosen, limits)
    if len(chosen) == 2:
        design = grid(**dict(axis_of(phrase, points) for phrase in vary), **load)
        found = bs.study(answers, file.joint, design, quantities=quantities)
        front = pareto(found, (chosen[0], chosen[1]), limits)
        if as_json:
            echo_json(study_summary.front_summary(front))
        else:
            study_terminal.print_front(front)
        if figure is not None:
            save(study_plots.front_figure(found, front, (chosen[0], chosen[1]), limits), figure)
        return
    if len(chosen) != 1:
        raise ValueError(f"one answer or two are minimised, got {len(chosen)}")
    best = find_optimum(answers, file.joint, ranges, minimise=chosen[0], limits=limits, load=load)
    if as_json:
        echo_json({"version": bs.__version__, **best.summary()})
    else:
        study_terminal.print_optimum(best)
    if figure is not None:
        axes = dict(axis_of(phrase, points) for phrase in vary)
        found = bs.study(answers, file.joint, grid(**axes, **load), quantities=quantities)
        save(study_plots.design_map(found, limits, _shown(chosen), best=best.point), figure)


@app.command()
def sensitivity(
    joint: JointName,
    spread: Annotated[list[str], typer.Option(help="'clearance=0.10+-0.05 mm' or 'liner_poisson=0.38..0.46'; repeat")],
    model: ModelName = "tabulated",
    force: Force = None,
    indentation: Indentation = None,
    count: Annotated[int, typer.Option(help="Samples, a power of two.")] = 1024,
    figure: Picture = None,
    as_json: AsJson = False,
) -> None:
    """Tell which number's scatter matters: Sobol indices with intervals, and elasticities."""
    if figure is not None:
        check_format(figure)
    file = named_joint(joint)
    scattered = _once(map(spread_of, spread))
    load = _load(force, indentation, file, scattered)
    found = find_sensitivity(_model(model, file), file.joint, scattered, count=count, load=load)
    if as_json:
        echo_json(
            {"version": bs.__version__, "model": found.attrs["model"], **study_summary.sensitivity_summary(found)}
        )
    else:
        study_terminal.print_sensitivity(found)
    if figure is not None:
        save(study_plots.sensitivity_figure(found), figure)
