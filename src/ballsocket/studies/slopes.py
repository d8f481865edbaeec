"""How answers change with the numbers of a joint: derivatives and elasticities at one point."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.checks import check_names, needs
from ..problem import Joint
from .parameters import LOADS, PARAMETERS, check_aims, pressable
from .task import QUANTITIES

Slopes = dict[str, dict[str, float]]
"""By quantity, then by parameter."""


def differences(
    model: Model, joint: Joint, quantities: Iterable[str], at: Mapping[str, float]
) -> tuple[dict[str, float], Slopes]:
    """Answers at one point and their derivatives, by differences of second order in one press of arrays: for any model.

    They are central, and to one side where a number is at an end of what it may be, such as a clearance of zero. Good
    to 1e-7 for closed forms and 1e-5 for `Exact`; to a few percent for finite elements, whose mesh changes with the
    joint.

    Parameters
    ----------
    model : Model
    joint : Joint
        Plain numbers.
    quantities : iterable of str
    at : mapping of str to float
        The point: parameters, one load among them, in mm, N, MPa, rad.

    Returns
    -------
    answers : dict of str to float
    slopes : dict of str to dict of str to float
        By quantity and parameter, in their units.

    Raises
    ------
    ValueError
        A name that is not known; no load, or one of zero, where answers start steeply.
    """
    wanted = _checked(quantities, at)
    steps = {name: _steps(name, float(value), model.smooth_step) for name, value in at.items()}
    # row 0 is the point itself, rows 2i + 1 and 2i + 2 are beside it in the i-th number
    rows = {name: numpy.full(2 * len(at) + 1, float(value)) for name, value in at.items()}
    for place, name in enumerate(at):
        rows[name][2 * place + 1 : 2 * place + 3] += steps[name]
    found = pressed(model, joint, rows, wanted)
    answers = {quantity: float(values[0]) for quantity, values in found.items()}
    return answers, {
        quantity: {
            name: _slope(values[2 * place + 1 : 2 * place + 3] - values[0], steps[name])
            for place, name in enumerate(at)
        }
        for quantity, values in found.items()
    }


def _steps(name: str, value: float, step: float) -> tuple[float, float]:
    """To either side, or both to the one where the number is allowed."""
    size = step * abs(value) or step
    for steps in ((size, -size), (size, 2 * size), (-size, -2 * size)):
        if PARAMETERS[name].allows(value + numpy.array(steps)).all():
            return steps
    raise ValueError(f"{name} = {value:g} is not allowed for a {PARAMETERS[name].title}")


def _slope(rises: Numbers, steps: tuple[float, float]) -> float:
    """Slope at a point of the parabola through it and two more."""
    (one, other), (a, b) = rises, steps
    return float((b * b * one - a * a * other) / (a * b * (b - a)))


def traced(
    model: Model, joint: Joint, quantities: Iterable[str], at: Mapping[str, float]
) -> tuple[dict[str, float], Slopes]:
    """Values and slopes by JAX, exact to rounding, for a `differentiable` model; compiled when first asked.

    Raises
    ------
    ValueError
        A model that JAX cannot trace; a name that is not known; no load.
    ImportError
        JAX is not installed.
    """
    wanted = _checked(quantities, at)
    if not model.differentiable:
        raise ValueError(f"{model.name} cannot be traced by JAX: ask `differences`")
    needs("jax", "jax")
    import jax

    with jax.enable_x64(True):
        here, there = _compiled(model, joint, wanted)({name: float(value) for name, value in at.items()})
    return (
        {name: float(here[name]) for name in wanted},
        {quantity: {name: float(there[quantity][name]) for name in at} for quantity in wanted},
    )


@lru_cache(maxsize=16)
def _compiled(model: Model, joint: Joint, quantities: tuple[str, ...]) -> Callable[[dict[str, float]], Any]:
    import jax

    def answers(values: dict[str, Any]) -> dict[str, Any]:
        check_aims(model, values)
        made, load, _ = pressable(joint, values)
        contact = model.press(made, **load)
        return {name: getattr(contact, name) for name in quantities}

    compiled: Callable[[dict[str, float]], Any] = jax.jit(lambda values: (answers(values), jax.jacfwd(answers)(values)))
    return compiled


Derive = Callable[[Model, Joint, Iterable[str], Mapping[str, float]], tuple[dict[str, float], Slopes]]
"""`differences` or `traced`."""


def _checked(quantities: Iterable[str], at: Mapping[str, float]) -> tuple[str, ...]:
    check_names(at, PARAMETERS, "among the numbers that vary")
    wanted = tuple(quantities)
    check_names(wanted, QUANTITIES, "among the quantities")
    if not any(name in at for name in LOADS):
        raise ValueError(f"one load is needed: {', '.join(LOADS)}")
    for name in LOADS:
        if at.get(name) == 0:
            raise ValueError(f"{name} = 0 is first touch, where answers have no slope; it must be above 0")
    return wanted


def elasticities(
    model: Model, joint: Joint, quantities: Iterable[str], at: Mapping[str, float], derive: Derive = differences
) -> Slopes:
    """Percent of change in each quantity for one percent in each number: (x/y) dy/dx; see `differences`."""
    answers, found = derive(model, joint, quantities, at)
    return {
        quantity: {name: slope * at[name] / answers[quantity] for name, slope in each.items()}
        for quantity, each in found.items()
    }


def pressed(model: Model, joint: Joint, values: Mapping[str, Any], quantities: Iterable[str]) -> dict[str, Any]:
    """Quantities of a press at values that broadcast; NaN where these make no joint."""
    check_aims(model, values)
    made, load, possible = pressable(joint, values)
    contact = model.press(made, **load)
    return {name: numpy.where(possible, getattr(contact, name), numpy.nan) for name in quantities}
