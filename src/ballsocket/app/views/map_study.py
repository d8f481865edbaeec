"""Design maps: a study over two numbers of a joint, its limits, and the lines of the limits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from html import escape
from math import isfinite
from typing import Any

import numpy

from ...comparison import THIN_LINER_RATIO
from ...contact import Model
from ...core.kinds import Kind
from ...core.quantities import JOINT, QUANTITIES
from ...core.validity import OutsideDomainError, check_domain
from ...files.joint_file import JointFile
from ...model_catalogue import catalogue
from ...problem import Joint
from ...problem.dimensions import give
from ...studies.design import Span, grid
from ...studies.limits import Limit, allowed, count_verdicts, undecided_reason
from ...studies.metadata import held_in, held_text
from ...studies.parameters import LOADS, PARAMETERS, press_arguments
from ...studies.run import default_model, joint_of_arrays, study
from ...studies.task import with_bounds
from ..state.screen import MAP_MODELS, MAPPED, QUICK, START, MapAxis, Screen
from ..widgets.controls import parameter

_POINTS = 61
_SOLVED_POINTS = 17  # values along an axis where every joint is solved: a second in all


@lru_cache(maxsize=16)
def _studied(
    joint: Joint, given: tuple[str, ...], load: tuple[tuple[str, float], ...], ends: tuple[MapAxis, ...], model: str
) -> Any:
    """Press the joint over axes, with the lengths that it gives, which joints of equal numbers may differ in."""
    chosen = _map_model(joint, {axis.name: [axis.low, axis.high] for axis in ends}, model)
    count = _SOLVED_POINTS if chosen.name not in QUICK else _POINTS
    axes: dict[str, Any] = {axis.name: Span(axis.low, axis.high, count) for axis in ends}
    varied = any(name in axes for name in LOADS)
    design = grid(**axes, **({} if varied else dict(load)))
    return study(chosen, replace(joint, given=given), design, quantities=with_bounds(MAPPED))


def _map_model(joint: Joint, ends: Mapping[str, Any], name: str) -> Model:
    """Return the model of a name, or a quick model behind the tables if the joints are outside them."""
    model = default_model(joint, ends) if name == START.map_model else catalogue[name]
    if model.name in QUICK or not bool(numpy.any(joint_of_arrays(joint, ends).thickness_ratio > THIN_LINER_RATIO)):
        return model
    if name not in QUICK:
        raise ValueError(
            f"{name} takes minutes where R2/L is above {THIN_LINER_RATIO:g}: choose another model for this map"
        )
    return catalogue[name]


def check_map(screen: Screen, axes: Iterable[MapAxis]) -> None:
    """Check that a study over these axes can be computed; raise ValueError otherwise."""
    ends = {axis.name: numpy.array([axis.low, axis.high]) for axis in axes}
    _map_model(screen.file.joint, ends, screen.map_model)
    press_arguments(screen.file.joint, ends)


def models_of(screen: Screen) -> list[str]:
    """List the models whose domain holds the joint on the screen, and the chosen one."""
    return [name for name in MAP_MODELS if name == screen.map_model or _in_domain(name, screen.file.joint)]


def _in_domain(name: str, joint: Joint) -> bool:
    try:
        return bool(check_domain(catalogue[name].domain, joint, name))
    except OutsideDomainError:
        return False


def mapped(screen: Screen) -> Any:
    """Compute the study behind a map."""
    return _study_over(screen, screen.across, screen.up)


def swept(screen: Screen) -> Any:
    """Compute the study of one parameter, that across the map."""
    return _study_over(screen, screen.across)


def _study_over(screen: Screen, *axes: MapAxis) -> Any:
    joint = _joint_on(screen.file.joint, [axis.name for axis in axes])
    return _studied(joint, joint.given, tuple(screen.file.load.items()), axes, screen.map_model)


def _joint_on(joint: Joint, names: Iterable[str]) -> Joint:
    """Return a joint whose given lengths make way for those that vary on a map."""
    given = tuple(joint.given_lengths)
    for name in names:
        given = give(name, given) if name in JOINT else given
    return replace(joint, given=given)


def limits_of(screen: Screen) -> tuple[Limit, ...]:
    """Return the limits on the screen, with the cup and its load on the screen for edge distances."""
    cup, direction = screen.file.cup.under_load(screen.file.tilt)
    return tuple(replace(limit, cup=cup, direction=direction) for limit in screen.limits)


def allowed_points(results: Any, screen: Screen) -> Any:
    """Return True at points with a result that no limit forbids."""
    return allowed(results, limits_of(screen)).broadcast_like(results.max_pressure)


def best_point(results: Any, screen: Screen) -> dict[str, float] | None:
    """Return the parameters of the allowed point with the least value; None without one."""
    fine = allowed_points(results, screen)
    if not bool(fine.any()):
        return None
    indices = results[screen.quantity].where(fine).argmin(...)
    return {axis: float(results[axis].isel({axis: indices[axis]})) for axis in (screen.across.name, screen.up.name)}


def map_summary(results: Any, screen: Screen) -> str:
    """Describe the map as HTML: its allowed part, its smallest value there, and its marks."""
    fine, point, reading = allowed_points(results, screen), best_point(results, screen), screen.reading
    mapped_quantity, words = QUANTITIES[screen.quantity], []
    if results.attrs["model"] != screen.map_model:
        words.append(f"Model {results.attrs['model']}, since {screen.map_model} covers none of these joints.")
    if screen.limits:
        counts = count_verdicts(results, limits_of(screen))
        shares = ", ".join(f"{100 * count / fine.size:.3g} % {word}" for word, count in counts.items() if count)
        words.append(f"Limits on this map: {shares}.")
    if point is not None:
        axes = map(QUANTITIES.__getitem__, point)
        position = " and ".join(f"{axis.title} {reading.with_unit(axis, point[axis.name])}" for axis in axes)
        smallest = reading.with_unit(mapped_quantity, float(results[screen.quantity].sel(point)))
        within = " within the limits" if screen.limits else ""
        words.append(f"Minimum of the {mapped_quantity.title}{within}: <b>{smallest}</b> at {escape(position)}.")
    if held := held_in(results):
        words.append(f"Held: {reading.units.sentence(held_text(held))}.")
    if not bool(results.valid.all()):
        words.append("Crosses: the model is not valid there.")
    if not bool(fine.all()):
        reason = escape(undecided_reason(results, limits_of(screen)))
        words.append(f"Faded: a limit is exceeded. Half faded: undecided, {reason}. Grey: no result.")
    return f"<p class='quiet'>{' '.join(words)}</p>"


def default_axis(name: str, middle: float) -> MapAxis:
    """Return a range of half to twice the present value of a parameter."""
    if PARAMETERS[name].kind is Kind.NUMBER:
        return MapAxis(name=name, low=0.3, high=0.48)
    middle = middle if 0 < middle < 1e9 else {"force": 3000.0, "indentation": 0.05, "clearance": 0.1}.get(name, 10.0)
    return MapAxis(name=name, low=float(f"{middle / 2:.2g}"), high=float(f"{2 * middle:.2g}"))


def joint_at(file: JointFile, chosen: Mapping[str, float]) -> JointFile:
    """Return the joint at a point of the map, rounded to four digits, with its load."""
    rounded = {name: float(f"{value:.4g}") for name, value in chosen.items()}
    made, load, possible = press_arguments(_joint_on(file.joint, rounded), rounded)
    if not bool(possible):
        raise ValueError("invalid geometry: the clearance would be negative, or the liner would have no thickness")
    lengths: dict[str, Any] = {
        name: round(float(getattr(made, name)), 9) for name in ("ball_radius", "clearance", "liner_thickness")
    }
    plain = replace(made, **lengths, name="", source="")
    return replace(file, joint=plain, load={name: float(value) for name, value in load.items()} or file.load)


def move_limit(results: Any, screen: Screen, number: int, point: tuple[float, float]) -> tuple[Limit, ...]:
    """Change one limit of the screen so that its line runs through a point of the map."""
    limit = limits_of(screen)[number]
    across, up = screen.across, screen.up
    x, y = (min(max(at, axis.low), axis.high) for at, axis in zip(point, (across, up), strict=True))
    field = limit.bar(results).value + 0.0 * results[across.name] + 0.0 * results[up.name]
    value = float(field.interp({across.name: x, up.name: y}))
    if not isfinite(value):
        raise ValueError(f"{limit.name} has no number there: the limit stays where it was")
    end: dict[str, Any] = {"high" if isfinite(limit.high) else "low": float(f"{value:.3g}")}
    return (*screen.limits[:number], replace(screen.limits[number], **end), *screen.limits[number + 1 :])


def picked_point(screen: Screen) -> dict[str, float] | None:
    """Return the parameters of the chosen point of the map; None without one."""
    return None if screen.picked is None else {screen.across.name: screen.picked[0], screen.up.name: screen.picked[1]}


def catalogue_sizes(point: Mapping[str, float]) -> dict[str, float]:
    """Replace each number of a point by the nearest catalogue size, where there are sizes."""
    return {
        name: min(parameter(name).typical.sizes, key=lambda size: abs(size - value), default=value)
        for name, value in point.items()
    }
