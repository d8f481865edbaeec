"""Commands `map`, `optimise` and `sensitivity`: design studies of a joint without a study file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import typer

from ..contact import Model
from ..core.checks import require, unique
from ..core.kinds import Choice
from ..core.storage.atomic_files import check_ending, write_csv
from ..files.joint_file import JointFile
from ..files.joint_options import PARTS
from ..model_catalogue import JUDGE, reference, with_gap, with_yielding
from ..problem import Joint
from ..reports import study_plots
from ..studies.axes import Span
from ..studies.design import grid
from ..studies.expressions import parse_choices, parse_correlations, parse_distribution, parse_limit, parse_range
from ..studies.limits import Limit, limited_quantities
from ..studies.optimisation import optimise as find_optimum
from ..studies.optimisation import pareto
from ..studies.parameters import LOADS
from ..studies.run import check_model_domain, default_model, study
from ..studies.study_answer import describe_front, describe_map, describe_optimum, front_summary, map_summary
from ..studies.task import DEFAULT_QUANTITIES
from ..studies.variance_shares import describe_sensitivity, index_table, sensitivity_summary
from ..studies.variance_shares import sensitivity as find_sensitivity
from .elasticity_options import Yielding
from .options import (
    GapName,
    JointName,
    JointOptions,
    ModelName,
    OutputOptions,
    expand_groups,
    needed_load,
    requested_model,
)
from .root import app, print_message

_POINTS_HELP = "Number of values along each axis, 2 or more. Default: 41, or 21 for a slow model."
LimitOption = Annotated[
    list[str] | None,
    typer.Option(
        "--limit", help="Limit of a result or dimension: 'outer_radius<=26 mm'. Repeat for several. Default: no limit."
    ),
]


@dataclass(frozen=True, kw_only=True)
class PressOptions:
    """Options of the model of a design study."""

    model: ModelName = None
    gap: GapName = None
    plastic: Yielding = False

    def choose_model(self, file: JointFile, ends: Mapping[str, Any]) -> Model:
        """Return the requested model, or the default one for joints between some ends, in the cup of the file.

        Raises ValueError: the requested model has no result for any of these joints.
        """
        if self.model is None and not self.plastic:
            model = default_model(file.joint, ends) if self.gap is None else reference
            if self.gap is None and model.name == reference.name:
                print_message(f"model {model.name} is used, since tabulated is valid for none of these joints")
        else:
            model = requested_model(self.model or JUDGE)
            check_model_domain(model, file.joint, ends)
            model = with_yielding(model) if self.plastic else model
        return with_gap(model, self.gap).in_cup(file.cup, **file.aim)


@app.command(name="map")
@expand_groups
def design_map(
    *,
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*PARTS, "cup", "load")],
    x: Annotated[
        str, typer.Option(help="Parameter and range of the horizontal axis: 'ball_radius=11..23 mm'.")
    ] = "ball_radius=11..23 mm",
    y: Annotated[
        str, typer.Option(help="Parameter and range of the vertical axis: 'clearance=50..200 um'.")
    ] = "liner_thickness=3..15 mm",
    points: Annotated[int | None, typer.Option(help=_POINTS_HELP)] = None,
    press_options: PressOptions,
    limit: LimitOption = None,
    output: OutputOptions,
) -> None:
    """Map the contact over two parameters of a joint.

    The table shows the smallest and largest peak pressure, contact area and half angle, and the share within the
    limits. --figure draws the map.
    """
    output.check()
    _check_points(points)
    file = joint_options.read(joint)
    limits = _limits(limit, file)
    ends = unique((name, (low, high)) for name, low, high in map(parse_range, (x, y)))
    stated = joint_options.stated(file, ends)
    sizes = {name: [value] for name, value in stated.items()}
    load, model = _load(joint_options, file, ends), press_options.choose_model(file, {**ends, **sizes})
    axes = {name: Span(low, high, points or _default_points(model)) for name, (low, high) in ends.items()}
    result = study(model, file.joint, grid(**axes, **stated, **load), quantities=_quantities((), limits, model))
    output.print(lambda: map_summary(result, limits), lambda: describe_map(result, limits))
    output.draw(lambda: study_plots.design_map(result, limits, units=output.units))


@app.command()
@expand_groups
def optimise(
    *,
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*PARTS, "cup", "load")],
    vary: Annotated[
        list[str],
        typer.Option(
            help="Parameter and its range, sizes or materials: 'clearance=50..200 um', 'head_diameter=28,32,36 mm', "
            "'liner=uhmwpe,pom'. Repeat for several."
        ),
    ],
    minimise: Annotated[
        list[str] | None,
        typer.Option(help="Result to minimise. Default: max_pressure. Twice: the Pareto front of two results."),
    ] = None,
    press_options: PressOptions,
    limit: LimitOption = None,
    points: Annotated[int | None, typer.Option(help=f"For a front or a figure. {_POINTS_HELP}")] = None,
    output: OutputOptions,
) -> None:
    """Find the best joint within limits, for one goal or two.

    With two goals the result is the Pareto front: the joints that no other joint beats in both.
    """
    output.check()
    _check_points(points)
    file, goals = joint_options.read(joint), minimise or ["max_pressure"]
    limits = _limits(limit, file)
    lists = [parse_choices(phrase) for phrase in vary]
    choices = unique(choice for choice in lists if choice is not None)
    phrases = [phrase for phrase, choice in zip(vary, lists, strict=True) if choice is None]
    ranges = unique((name, (low, high)) for name, low, high in map(parse_range, phrases))
    choices |= {name: [value] for name, value in joint_options.stated(file, {**ranges, **choices}).items()}
    if output.figure is not None and len(goals) == 1 and len(ranges) != 2:
        raise ValueError(f"a map has two axes, and {len(ranges)} numbers vary: no figure")
    load = _load(joint_options, file, {**ranges, **choices})
    model = press_options.choose_model(file, {**ranges, **choices})

    def study_ranges(joint: Joint, fixed: Mapping[str, Any]) -> Any:
        count = points or _default_points(model)
        axes = {name: Span(low, high, count) for name, (low, high) in ranges.items()}
        design = grid(**axes, **fixed, **load)
        return study(model, joint, design, quantities=_quantities(goals, limits, model))

    if len(goals) == 2:
        result, both = study_ranges(file.joint, choices), (goals[0], goals[1])
        front = pareto(result, both, limits)
        output.print(lambda: front_summary(front), lambda: describe_front(front))
        output.draw(lambda: study_plots.front_figure(result, front, both, limits))
        return
    if len(goals) != 1:
        raise ValueError(f"one result or two are minimised, got {len(goals)}")
    best = find_optimum(model, file.joint, ranges, choices=choices, minimise=goals[0], limits=limits, load=load)
    output.print(lambda: {"model": model.name, **best.summary()}, lambda: describe_optimum(best))
    sizes = {name: value for name, value in best.point.items() if name in choices}
    names = list(dict.fromkeys((*goals, *study_plots.SHOWN)))
    output.draw(
        lambda: study_plots.design_map(study_ranges(best.joint, sizes), limits, names, best.point, output.units)
    )


class IntervalMethod(Choice):
    """Methods of computing intervals."""

    BOOTSTRAP = "bootstrap"
    NONE = "none"


_SENSITIVITY_RESULTS = ("indentation", "half_angle", "max_pressure", "area")
"""Results whose variance is shared by default."""


@app.command()
@expand_groups
def sensitivity(
    *,
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*PARTS, "cup", "load")],
    spread: Annotated[
        list[str],
        typer.Option(
            help="Scatter of a parameter: tolerance 'clearance=0.10+-0.05 mm' (or ±; normal distribution, 3 "
            "standard deviations to each end) or range 'liner_poisson=0.38..0.46' (uniform distribution). Repeat for "
            "several."
        ),
    ],
    press_options: PressOptions,
    count: Annotated[
        int, typer.Option(help="Number of samples in each set, 2 or more; a power of two fills the space most evenly.")
    ] = 1024,
    of: Annotated[
        list[str] | None,
        typer.Option(
            help="Result whose variance is shared: 'max_pressure'. Repeat for several. Default: indentation, "
            "half_angle, max_pressure and area."
        ),
    ] = None,
    correlation: Annotated[
        list[str] | None,
        typer.Option(
            help="Rank correlation of two scattered parameters: 'clearance, liner_young = 0.5'. Repeat for several. "
            "The result then has Shapley effects. Default: independent parameters."
        ),
    ] = None,
    second_order: Annotated[
        bool, typer.Option("--second-order", help="Also compute the indices of pairs of parameters.")
    ] = False,
    intervals: Annotated[
        IntervalMethod, typer.Option(help="Method of the 95 % intervals: bootstrap, or none to save time.")
    ] = IntervalMethod.BOOTSTRAP,
    seed: Annotated[int, typer.Option(help="Seed of the samples, 0 or more.")] = 0,
    csv: Annotated[
        Path | None, typer.Option("--csv", help="Write all indices with their intervals to this file (.csv).")
    ] = None,
    output: OutputOptions,
) -> None:
    """Compute which parameter's scatter matters most.

    The table shows Sobol indices with their intervals, and elasticities (relative change of a result per relative
    change of a parameter). Correlated parameters have Shapley effects, which add up to 1.
    """
    output.check()
    if csv is not None:
        check_ending("", csv, ".csv")
    require("seed", seed, seed >= 0, "a seed is 0 or more")
    file = joint_options.read(joint)
    distributions = unique(map(parse_distribution, spread))
    stated = joint_options.stated(file, distributions)
    means = {name: [float(distribution.frozen.mean())] for name, distribution in distributions.items()}
    means |= {name: [value] for name, value in stated.items()}
    load, model = _load(joint_options, file, distributions), press_options.choose_model(file, means)
    result = find_sensitivity(
        model,
        file.joint,
        distributions,
        quantities=list(dict.fromkeys(of or _SENSITIVITY_RESULTS)),
        count=count,
        seed=seed,
        confidence=0.95 if intervals is IntervalMethod.BOOTSTRAP else None,
        load={**load, **stated},
        second_order=second_order,
        correlation=parse_correlations(correlation or ()),
    )
    output.print(
        lambda: {"model": result.attrs["model"], **sensitivity_summary(result)}, lambda: describe_sensitivity(result)
    )
    output.draw(lambda: study_plots.sensitivity_figure(result))
    if csv is not None:
        table = index_table(result)
        write_csv(csv, [[column.name for column in table.columns], *(row.cells for row in table.rows)])


def _load(options: JointOptions, file: JointFile, parameters: Iterable[str]) -> dict[str, float]:
    """Return the load in N, mm or rad; empty if the load is one of the varied parameters."""
    loads = [name for name in parameters if name in LOADS]
    if loads and set(LOADS) & set(options.tables.get("load", {})):
        raise ValueError(f"{loads[0]} varies, and a load is given too; one is needed")
    return {} if loads else needed_load(file)


def _check_points(points: int | None) -> None:
    if points is not None:
        require("points", points, points > 1, "an axis has 2 values or more")


def _default_points(model: Model) -> int:
    """Return the number of values along an axis with which a map takes seconds."""
    return 41 if model.seconds_a_press < 1e-3 else 21


def _limits(phrases: list[str] | None, file: JointFile) -> list[Limit]:
    """Parse limits from text; distances from the edge are for the cup and the load's direction of a file."""
    cup, direction = file.cup.under_load(file.tilt)
    return [replace(parse_limit(phrase), cup=cup, direction=direction) for phrase in phrases or []]


def _quantities(goals: Iterable[str], limits: Iterable[Limit], model: Model) -> list[str]:
    """Return the results to compute: the default ones, the goals and the limited ones."""
    return list(dict.fromkeys((*DEFAULT_QUANTITIES, *goals, *limited_quantities(limits, model))))
