"""What a design map holds: a study over two numbers of the joint on the screen, and what its limits leave."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from html import escape
from typing import Any

import numpy

from ..catalogue import catalogue
from ..compare import THIN_LINER_RATIO
from ..contact import Model
from ..core.kinds import Kind
from ..core.quantities import PARTS, QUANTITIES, Quantity
from ..core.validity import OutsideDomainError, check_domain
from ..files.joint_file import JointFile
from ..problem import Joint
from ..studies.design import Span, grid
from ..studies.limits import Limit, allowed, margin_on_plane
from ..studies.parameters import LOADS, PARAMETERS, press_arguments
from ..studies.run import default_model, joint_of_arrays, study
from .screen import MAP_MODELS, MAPPED, QUICK, START, MapAxis, Screen

_POINTS = 61
_FEW = 17
"""Values along an axis where every joint is solved: a second in all."""


@lru_cache(maxsize=16)
def _mapped(joint: Joint, load: tuple[tuple[str, float], ...], across: MapAxis, up: MapAxis, model: str) -> Any:
    asked = _asked(joint, {axis.name: [axis.low, axis.high] for axis in (across, up)}, model)
    count = _FEW if asked.name not in QUICK else _POINTS
    axes: dict[str, Any] = {axis.name: Span(axis.low, axis.high, count) for axis in (across, up)}
    varied = any(name in axes for name in LOADS)
    design = grid(**axes, **({} if varied else dict(load)))
    return study(asked, joint, design, quantities=MAPPED)


def _asked(joint: Joint, ends: Mapping[str, Any], name: str) -> Model:
    """The model of that name; for tables that know none of the joints the one behind them, where it is quick enough."""
    model = default_model(joint, ends) if name == START.map_model else catalogue[name]
    if model.name in QUICK or not bool(numpy.any(joint_of_arrays(joint, ends).thickness_ratio > THIN_LINER_RATIO)):
        return model
    if name not in QUICK:
        raise ValueError(
            f"{name} takes minutes where R2/L is above {THIN_LINER_RATIO:g}: choose another model for this map"
        )
    return catalogue[name]


def models_of(screen: Screen) -> list[str]:
    """The models that know the joint on the screen, and the one that is chosen."""
    return [name for name in MAP_MODELS if name == screen.map_model or _knows(name, screen.file.joint)]


def _knows(name: str, joint: Joint) -> bool:
    try:
        return bool(check_domain(catalogue[name].domain, joint, name))
    except OutsideDomainError:
        return False


def mapped(file: JointFile, across: MapAxis, up: MapAxis, model: str) -> Any:
    """The study behind a map."""
    return _mapped(file.joint, tuple(file.load.items()), across, up, model)


def limits_of(screen: Screen) -> tuple[Limit, ...]:
    """The limits on the screen, with the cup that is there: distances from the edge are those of its rim."""
    return tuple(replace(limit, cup=screen.file.cup) for limit in screen.limits)


def good(found: Any, screen: Screen) -> Any:
    """Where there is an answer that no limit forbids."""
    return allowed(found, limits_of(screen)).broadcast_like(found.max_pressure)


def margin(found: Any, screen: Screen) -> numpy.ndarray:
    """How far inside the nearest limit each point is; far where there is none."""
    nearest = numpy.ones((found.sizes[screen.up.name], found.sizes[screen.across.name]))
    for limit in limits_of(screen):
        values = margin_on_plane(found, limit, screen.across.name, screen.up.name)
        nearest = numpy.minimum(nearest, values / max(float(numpy.nanmax(numpy.abs(values))), 1e-300))
    return nearest


def head(name: str, screen: Screen) -> tuple[str, float]:
    """The label of a quantity with the unit that is chosen for it, and the factor to it from that of a study."""
    unit = screen.reading.unit(QUANTITIES[name])
    return QUANTITIES[name].label(unit), unit.factor


def best(found: Any, screen: Screen) -> dict[str, float] | None:
    """The parameters of the point with the least value among those that are allowed, if any is."""
    fine = good(found, screen)
    if not bool(fine.any()):
        return None
    place = found[screen.quantity].where(fine).argmin(...)
    return {axis: float(found[axis].isel({axis: place[axis]})) for axis in (screen.across.name, screen.up.name)}


def told(found: Any, screen: Screen) -> str:
    """What the map says, as HTML: the share that is allowed, and the least value there."""
    fine, point, name = good(found, screen), best(found, screen), screen.quantity
    words = []
    if found.attrs["model"] != screen.map_model:
        words.append(f"{found.attrs['model']} answers, since {screen.map_model} knows none of these joints.")
    if screen.limits:
        words.append(f"{100 * float(fine.mean()):.3g} % of the map is allowed by the limits.")
    if point is not None:
        where = ", ".join(_said(QUANTITIES[axis], value, screen) for axis, value in point.items())
        title, turn = head(name, screen)
        least = float(found[name].sel(point)) * turn
        steps = ", ".join(
            f"{(axis.high - axis.low) / (found.sizes[axis.name] - 1) * head(axis.name, screen)[1]:.2g}"
            for axis in (screen.across, screen.up)
        )
        words.append(f"Smallest value of {title} there: <b>{least:.4g}</b> at {escape(where)} (in steps of {steps}).")
    if not bool(found.valid.all()):
        words.append("Crosses: the model is not to be trusted there.")
    if not bool(fine.all()):
        words.append("Faded: a limit is broken, or there is no answer.")
    words.append("Click a point to press the joint that is there; the circle is the joint now.")
    return f"<p class='quiet'>{' '.join(words)}</p>"


def _said(quantity: Quantity, value: float, screen: Screen) -> str:
    return f"{quantity.symbol} {screen.reading.said(quantity, value)}".strip()


def now(file: JointFile, name: str) -> float:
    """What the joint on the screen has there; NaN where it has no such number."""
    part, _, number = name.partition("_") if name in PARTS else ("", "", "")
    value = getattr(getattr(file.joint, part), number, None) if part else getattr(file.joint, name, file.load.get(name))
    return float("nan") if value is None else float(value)


def around(name: str, middle: float) -> MapAxis:
    """A range for a parameter: half to twice what it is now, where that is a number."""
    if PARAMETERS[name].kind is Kind.NUMBER:
        return MapAxis(name=name, low=0.3, high=0.48)
    middle = middle if 0 < middle < 1e9 else {"force": 3000.0, "indentation": 0.05, "clearance": 0.1}.get(name, 10.0)
    return MapAxis(name=name, low=float(f"{middle / 2:.2g}"), high=float(f"{2 * middle:.2g}"))


def joint_at(file: JointFile, chosen: Mapping[str, float]) -> JointFile:
    """The joint of a point of the map, to four digits; its load, where that is an axis."""
    rounded = {name: float(f"{value:.4g}") for name, value in chosen.items()}
    made, load, possible = press_arguments(file.joint, rounded)
    if not bool(possible):
        raise ValueError("these numbers make no joint: no liner or no clearance is left")
    plain = replace(
        made,
        ball_radius=round(float(made.ball_radius), 9),
        clearance=round(float(made.clearance), 9),
        liner_thickness=round(float(made.liner_thickness), 9),
        name="",
        source="",
    )
    return replace(file, joint=plain, load={name: float(value) for name, value in load.items()} or file.load)
