"""`map`, `optimise` and `sensitivity`: questions that designers ask of many joints at once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import ballsocket as bs

from .. import figures, study_figures, study_tables
from ..studies.design import grid
from ..studies.file import named_model
from ..studies.optimum import optimise as find_optimum
from ..studies.pareto import pareto
from ..studies.sensitivity import sensitivity as find_sensitivity
from .phrases import axis_of, limit_of, range_of, spread_of
from .root import app
from .words import echo_json, load_of, named_joint

JointName = Annotated[str, typer.Argument(help="A joint file or a preset's name.")]
ModelName = Annotated[str, typer.Option(help="A model's name: tabulated, exact, hess-forsbach, ...")]
Force = Annotated[str | None, typer.Option(help="'3 kN'; without a load that of the joint's file")]
Indentation = Annotated[str | None, typer.Option(help="'40 um' in place of a force")]
Limits = Annotated[list[str] | None, typer.Option("--limit", help="'outer_radius<=26 mm'; repeat")]
Picture = Annotated[Path | None, typer.Option(help="Write a picture (.png, .svg, .pdf).")]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object instead of the table.")]


def _load(force: str | None, indentation: str | None, joint: Any) -> dict[str, float]:
    return load_of({"force": force, "indentation": indentation}, joint)


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
        figures.check_format(figure)
    given = named_joint(joint)
    limits = [limit_of(phrase) for phrase in limit or []]
    design = grid(**dict([axis_of(x, points), axis_of(y, points)]), **_load(force, indentation, given))
    found = bs.study(named_model(model), given.joint, design)
    if as_json:
        echo_json(study_tables.map_summary(found, limits))
    else:
        study_tables.print_map(found, limits)
    if figure is not None:
        figures.save(study_figures.design_map(found, limits), figure)


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
        figures.check_format(figure)
    given, chosen = named_joint(joint), minimise or ["max_pressure"]
    limits = [limit_of(phrase) for phrase in limit or []]
    load = _load(force, indentation, given)
    answers = named_model(model)
    if len(chosen) == 2:
        design = grid(**dict(axis_of(phrase, points) for phrase in vary), **load)
        found = bs.study(answers, given.joint, design)
        front = pareto(found, (chosen[0], chosen[1]), limits)
        if as_json:
            echo_json(study_tables.front_summary(front))
        else:
            study_tables.print_front(front)
        if figure is not None:
            figures.save(study_figures.front_figure(found, front, (chosen[0], chosen[1]), limits), figure)
        return
    if len(chosen) != 1:
        raise ValueError(f"one answer or two are minimised, got {len(chosen)}")
    ranges = {name: (low, high) for name, low, high in map(range_of, vary)}
    best = find_optimum(answers, given.joint, ranges, minimise=chosen[0], limits=limits, load=load)
    if as_json:
        echo_json({"version": bs.__version__, **best.summary()})
    else:
        study_tables.print_optimum(best)
    if figure is not None:
        axes = dict(axis_of(phrase, points) for phrase in vary)
        found = bs.study(answers, given.joint, grid(**axes, **load))
        figures.save(study_figures.design_map(found, limits, best=best.point), figure)


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
        figures.check_format(figure)
    given = named_joint(joint)
    load = _load(force, indentation, given)
    scattered = dict(map(spread_of, spread))
    found = find_sensitivity(named_model(model), given.joint, scattered, count=count, load=load)
    if as_json:
        echo_json({"version": bs.__version__, "model": found.attrs["model"], **study_tables.sensitivity_summary(found)})
    else:
        study_tables.print_sensitivity(found)
    if figure is not None:
        figures.save(study_figures.sensitivity_figure(found), figure)
