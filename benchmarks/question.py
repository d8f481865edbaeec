"""One question at a time, in plain floats: a press, a joint, a force law in Python and compiled; and formulas by hand.

A press returns indentation, largest pressure and half angle; a law returns force and tangent.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import count
from math import acos
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.compiled import compiled_law
from ballsocket.models.kinematics import linear_force, linear_stiffness

from .joints import newton, results
from .report import Pair, Row, compare
from .timing import Job

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
FORCE, DEPTH, CALLS, POINTS, FRESH = 1000.0, 0.02, 1000, 10**5, count(1)  # N, mm
MODELS = {"paper's model": bs.HessForsbach(), "tabulated": bs.Tabulated(), "exact": bs.Exact()}


def measure() -> list[Row]:
    modulus = float(bs.hess_forsbach(JOINT))
    formula = "Eq. (13) and slope in Python"
    bare = _repeated(lambda depth: _formula(modulus, depth), DEPTH)
    by_hand = _repeated(lambda force: newton(JOINT.socket_radius, JOINT.clearance, modulus, force, acos), FORCE)
    newtons = "Newton by hand in Python"
    pairs = [Pair(f"{name}, a press", _press(model), newtons, by_hand) for name, model in MODELS.items()]
    parts: dict[str, Any] = {"ball_radius": 17.9, "liner_thickness": 6.75, "liner": bs.UHMWPE, "ball": bs.STEEL}
    pairs += [
        Pair("a new joint", _repeated(lambda clearance: bs.Joint(clearance=clearance, **parts), 0.1)),
        Pair("replace the clearance of a joint", _repeated(lambda clearance: JOINT.replace(clearance=clearance), 0.1)),
    ]
    for name in ("paper's model", "tabulated"):
        law = MODELS[name].law(JOINT)
        pairs.append(Pair(f"{name}, a law in a compiled loop", _compiled(compiled_law(law)), formula, bare))
        if name == "tabulated":
            pairs.append(Pair(f"{name}, a law in Python", _repeated(law, DEPTH), formula, bare))
    for name in ("tabulated", "exact"):
        pairs.append(Pair(f"{name}, binding the law of a new joint", Job(partial(_bind, MODELS[name]))))
    return compare(pairs)


def _formula(modulus: float, depth: float) -> tuple[Any, Any]:
    """Eq. (13) and its slope."""
    radius, clearance = JOINT.socket_radius, JOINT.clearance
    return linear_force(radius, clearance, modulus, depth), linear_stiffness(radius, clearance, modulus, depth)


def _press(model: bs.Model) -> Job:
    return _repeated(lambda force: results(model.press(JOINT, force=force)), FORCE)


def _repeated(function: Callable[[float], object], value: float) -> Job:
    def call() -> None:
        for number in range(CALLS):
            function(value * (1 + 1e-6 * (number % 2)))

    return Job(call, CALLS)


def _compiled(law: Any) -> Job:
    import numba

    depths = DEPTH * numpy.random.default_rng(1).uniform(0.9, 1.1, POINTS)

    @numba.njit
    def total(law, depths):  # type: ignore[no-untyped-def]
        both = 0.0
        for depth in depths:
            force, tangent = law(depth)
            both += force + tangent
        return both

    return Job(lambda: total(law, depths), POINTS)


def _bind(model: bs.Model) -> object:
    return model.law(JOINT.replace(liner_thickness=6.75 + 1e-6 * next(FRESH)))
