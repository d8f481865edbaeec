"""`map`, `optimise` and `sensitivity`: questions that designers ask of many joints at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import ballsocket as bs

from ..catalogue import reference
from ..contact import Model
from ..core.checks import require
from ..io.joint_file import JointFile
from ..output import study_plots, study_summary, study_terminal
from ..output.save import check_format, save
from ..problem import Joint
from ..problem.cup import Cup
from ..studies.axes import Span
from ..studies.default_model import check_model_domain, default_model
from ..studies.design import grid
from ..studies.expressions import parse_choices, parse_distribution, parse_limit, parse_range
from ..studies.file import named_model
from ..studies.limits import Limit
from ..studies.optimisation import optimise as find_optimum
from ..studies.parameters import LOADS
from ..studies.pareto import pareto
from ..studies.sensitivity import sensitivity as find_sensitivity
from ..studies.task import DEFAULT_QUANTITIES, QUANTITIES
from .groups import grouped
from .root import app, complain
from .words import AsJson, JointWords, echo_json, given, load_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

JointName = Annotated[str | None, typer.Argument(help="A joint file or a preset's name.")]
_POINTS = "Values along each axis, 2 or more: by default 41, or 21 of a slow model."
Limits = Annotated[list[str] | None, typer.Option("--limit", help="'outer_radius<=26 mm'; repeat")]


@dataclass(frozen=True, kw_only=True)
class PressWords:
    """By what model and under what load joints are pressed."""

    model: Annotated[
        str | None, typer.Option(help="A model's name: tabulated (default), exact (where tables know no joint), ...")
    ] = None
    force: Annotated[str | None, typer.Option(help="'3 kN'; without a load that of the joint's file")] = None
    indentation: Annotated[str | None, typer.Option(help="'40 um' in place of a force")] = None

    def model_for(self, file: JointFile, ends: Mapping[str, Any]) -> Model:
        """The model by its name, or the default one with a word where it is not that of the tables; in the file's cup.

        Raises
        ------
        ValueError
            It has no answer for any joint between these ends.
        """
        if self.model is None:
            model = default_model(file.joint, ends)
            if model.name == reference.name:
                complain(f"{model.name} answers, since tabulated knows none of these joints")
        else:
            model = named_model(self.model)
            check_model_domain(model, file.joint, ends)
        return model.in_cup(file.cup)

    def load(self, file: JointFile, varied: Iterable[str]) -> dict[str, float]:
        """The load; none where it is among what varies."""
        words = {"force": self.force, "indentation": self.indentation}
        loads = [name for name in varied if name in LOADS]
        if loads and given(words):
            raise ValueError(f"{loads[0]} varies, and a load is given too; one is needed")
        return {} if loads else load_of(words, file)


@dataclass(frozen=True, kw_only=True)
class FormWords:
    """How an answer is shown."""

    figure: Annotated[Path | None, typer.Option(help="Write a picture (.png, .svg, .pdf).")] = None
    as_json: AsJson = False

    def check(self) -> None:
        """Raise ValueError for a picture's ending that is not written."""
        if self.figure is not None:
            check_format(self.figure)

    def print(self, summary: Callable[[], dict[str, Any]], table: Callable[[], None]) -> None:
        """Print the answer as JSON, or as a table."""
        if self.as_json:
            echo_json(summary())
        else:
            table()

    def draw(self, draw: Callable[[], Figure]) -> None:
        """Write the picture, if one is asked for."""
        if self.figure is not None:
            save(draw(), self.figure)


@app.command(name="map")
@grouped
def design_map(
    *,
    joint: JointName = None,
    words: JointWords,
    x: Annotated[str, typer.Option(help="The axis across, 'ball_radius=11..23 mm'.")] = "ball_radius=11..23 mm",
    y: Annotated[str, typer.Option(help="The axis upwards.")] = "liner_thickness=3..15 mm",
    points: Annotated[int | None, typer.Option(help=_POINTS)] = None,
    press: PressWords,
    limit: Limits = None,
    form: FormWords,
) -> None:
    """Map peak pressure, contact area and half angle over two numbers of a joint, with limits drawn."""
    form.check()
    _check_points(points)
    file = words.or_named(joint)
    limits = _limits(limit, file.cup)
    ends = _once((name, (low, high)) for name, low, high in map(parse_range, (x, y)))
    load, model = press.load(file, ends), press.model_for(file, ends)
    axes = {name: Span(low, high, points or _points_of(model)) for name, (low, high) in ends.items()}
    found = bs.study(model, file.joint, grid(**axes, **load), quantities=_quantities((), limits))
    form.print(lambda: study_summary.map_summary(found, limits), lambda: study_terminal.print_map(found, limits))
    form.draw(lambda: study_plots.design_map(found, limits))


@app.command()
@grouped
def optimise(
    *,
    joint: JointName = None,
    words: JointWords,
    vary: Annotated[
        list[str],
        typer.Option(help="'clearance=50..200 um', 'head_diameter=28,32,36 mm', 'liner=uhmwpe,pom'; repeat"),
    ],
    minimise: Annotated[
        list[str] | None, typer.Option(help="max_pressure (default), area, ...; twice for the front between two")
    ] = None,
    press: PressWords,
    limit: Limits = None,
    points: Annotated[int | None, typer.Option(help=f"For a front or a map: {_POINTS}")] = None,
    form: FormWords,
) -> None:
    """Find the joint with the smallest answer within limits; with two answers, the joints that none beats in both."""
    form.check()
    _check_points(points)
    file, chosen = words.or_named(joint), minimise or ["max_pressure"]
    limits = _limits(limit, file.cup)
    lists = [parse_choices(phrase) for phrase in vary]
    among = _once(choice for choice in lists if choice is not None)
    phrases = [phrase for phrase, choice in zip(vary, lists, strict=True) if choice is None]
    ranges = _once((name, (low, high)) for name, low, high in map(parse_range, phrases))
    if form.figure is not None and len(chosen) == 1 and len(ranges) != 2:
        raise ValueError(f"a map has two axes, and {len(ranges)} numbers vary: no figure")
    load, model = press.load(file, {**ranges, **among}), press.model_for(file, {**ranges, **among})

    def everywhere(joint: Joint, fixed: Mapping[str, Any]) -> Any:
        """The study of all the ranges."""
        count = points or _points_of(model)
        axes = {name: Span(low, high, count) for name, (low, high) in ranges.items()}
        design = grid(**axes, **fixed, **load)
        return bs.study(model, joint, design, quantities=_quantities(chosen, limits))

    if len(chosen) == 2:
        _front(everywhere(file.joint, among), (chosen[0], chosen[1]), limits, form)
        return
    if len(chosen) != 1:
        raise ValueError(f"one answer or two are minimised, got {len(chosen)}")
    best = find_optimum(model, file.joint, ranges, choices=among, minimise=chosen[0], limits=limits, load=load)
    form.print(
        lambda: {"version": bs.__version__, "model": model.name, **best.summary()},
        lambda: study_terminal.print_optimum(best),
    )
    sizes = {name: value for name, value in best.point.items() if name in among}
    form.draw(lambda: study_plots.design_map(everywhere(best.joint, sizes), limits, _shown(chosen), best=best.point))


def _front(found: Any, wishes: tuple[str, str], limits: list[Limit], form: FormWords) -> None:
    """Show the joints that none beats in both wishes."""
    front = pareto(found, wishes, limits)
    form.print(lambda: study_summary.front_summary(front), lambda: study_terminal.print_front(front))
    form.draw(lambda: study_plots.front_figure(found, front, wishes, limits))


@app.command()
@grouped
def sensitivity(
    *,
    joint: JointName = None,
    words: JointWords,
    spread: Annotated[
        list[str],
        typer.Option(help="'clearance=0.10±0.05 mm' (typed +- or ±), or ends, 'liner_poisson=0.38..0.46'; repeat"),
    ],
    press: PressWords,
    count: Annotated[int, typer.Option(help="Samples, a power of two.")] = 1024,
    form: FormWords,
) -> None:
    """Tell which number's scatter matters: Sobol indices with intervals, and elasticities."""
    form.check()
    file = words.or_named(joint)
    scattered = _once(map(parse_distribution, spread))
    middle = {name: [float(each.frozen.mean())] for name, each in scattered.items()}
    load, model = press.load(file, scattered), press.model_for(file, middle)
    found = find_sensitivity(model, file.joint, scattered, count=count, load=load)
    form.print(
        lambda: {
            "version": bs.__version__,
            "model": found.attrs["model"],
            **study_summary.sensitivity_summary(found),
        },
        lambda: study_terminal.print_sensitivity(found),
    )
    form.draw(lambda: study_plots.sensitivity_figure(found))


def _check_points(points: int | None) -> None:
    if points is not None:
        require("points", points, points > 1, "an axis has 2 values or more")


def _points_of(model: Model) -> int:
    """Values along an axis, so that a map takes seconds."""
    return 41 if model.seconds_a_press < 1e-3 else 21


def _limits(phrases: list[str] | None, cup: Cup) -> list[Limit]:
    """Limits in words; distances from the edge are those of the cup."""
    return [replace(parse_limit(phrase), cup=cup) for phrase in phrases or []]


def _once(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Pairs as a dictionary, if no name comes twice."""
    found: dict[str, Any] = {}
    for name, value in pairs:
        if name in found:
            raise ValueError(f"{name} is given twice; one is needed")
        found[name] = value
    return found


def _shown(wishes: list[str]) -> list[str]:
    """What a map shows: first what is wished for."""
    return list(dict.fromkeys((*wishes, *study_plots.SHOWN)))


def _quantities(wishes: Iterable[str], limits: Iterable[Limit]) -> list[str]:
    """What is shown, wished for, or limited."""
    limited = (limit.name for limit in limits if limit.name in QUANTITIES)
    return list(dict.fromkeys((*DEFAULT_QUANTITIES, *wishes, *limited)))
