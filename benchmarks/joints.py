"""A million presses by force, each of a joint of its own: indentation, half angle and largest pressure.

The exact solution solves the first of the same problems. Newton's method by hand shares with this package only the
printed numbers of Table 3.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy
from scipy.interpolate import PchipInterpolator

import ballsocket as bs
from ballsocket.compiled import Compiled
from ballsocket.models.table_3 import table_3

from .report import Pair, Row, compare, if_installed
from .timing import Job

POINTS, FEW = 10**6, 100
RANGES = ((11.0, 23.0), (0.02, 0.2), (3.0, 15.0), (500.0, 3000.0), (0.3, 0.49), (10.0, 4000.0))
"""Ball radius, clearance, liner thickness, Young's modulus, Poisson's ratio, force."""

Inputs = Sequence[Any]


def measure() -> list[Row]:
    random = numpy.random.default_rng(2021)
    inputs = [random.uniform(low, high, POINTS) for low, high in RANGES]
    one_liner = [*inputs[:3], 750.0, 0.46, inputs[5]]
    closed = bs.HessForsbach()
    fast = _press(Compiled(model=closed), inputs)

    def in_jax(*numbers: Any) -> tuple[Any, ...]:
        return results(closed.press(joint_of(numbers), force=numbers[5]))

    source, target = numpy.ones((10, POINTS)), numpy.empty((10, POINTS))  # as many bytes as a press reads and writes
    in_numpy, by_hand = _press(closed, inputs), Job(lambda: newton(*_constants(inputs)), POINTS)
    rivals: dict[str, Job | str] = {
        "copy of the same bytes": Job(lambda: numpy.copyto(target, source), 2 * POINTS),
        "the same in NumPy": in_numpy,
        "the same in JAX": if_installed("jax", lambda: jax_job(in_jax, inputs, POINTS)),
    }
    pairs = [Pair("paper's model, a joint a press", fast, rival, job) for rival, job in rivals.items()]
    pairs.append(Pair("paper's model in NumPy, a joint a press", in_numpy, "Newton by hand in NumPy", by_hand))
    exact = _press(bs.Exact(), [part[:FEW] for part in inputs])
    tabulated, compiled = bs.Tabulated(), Compiled(model=bs.Tabulated())
    one_material = _press(compiled, one_liner), "the same in NumPy", _press(tabulated, one_liner)
    pairs += [
        Pair("tabulated, a joint a press, one liner material", *one_material),
        Pair("tabulated, a joint a press, a material each", _press(compiled, inputs), "exact", exact),
        Pair("refined, a joint a press, a material each", _press(bs.Refined(), inputs), "exact", exact),
    ]
    return compare(pairs)


def joint_of(inputs: Inputs) -> bs.Joint:
    radius, clearance, thickness, young, poisson = inputs[:5]
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=thickness, liner=liner)


def _press(model: bs.Model, inputs: Inputs) -> Job:
    joint = joint_of(inputs)
    return Job(lambda: results(model.press(joint, force=inputs[5])), len(inputs[5]))


def results(contact: bs.Contact) -> tuple[Any, ...]:
    return contact.indentation, contact.half_angle, contact.max_pressure


def jax_job(function: Callable[..., Any], inputs: Inputs, count: int) -> Job:
    """A function compiled by JAX, in double precision, on arrays that JAX holds."""
    import jax

    with jax.enable_x64(True):
        held = [jax.numpy.asarray(part) for part in inputs]
    compiled = jax.jit(function)

    def call() -> object:
        with jax.enable_x64(True):
            return jax.block_until_ready(compiled(*held))

    return Job(call, count)


def _constants(inputs: Inputs) -> tuple[Any, ...]:
    """R2, c, K and F, with K by Eq. (18)."""
    radius, clearance, thickness, young, poisson, force = inputs
    table = table_3()
    c1, c2, c3 = PchipInterpolator(table["poisson"], [table[name] for name in ("C1", "C2", "C3")], axis=1)(poisson)
    socket = radius + clearance
    ratio = socket / thickness
    return socket, clearance, young / socket * (c1 + c2 * ratio + c3 * ratio**2), force


def newton(R2, c, K, F, arccos=numpy.arccos):  # type: ignore[no-untyped-def]
    """Indentation, half angle and largest pressure by four steps for Eq. (13), in floats or arrays: errors of 1e-12."""
    s = 1.5 * F / (numpy.pi * R2**2 * K)
    d = s + (s * c) ** 0.5
    for _ in range(4):
        x = c / (c + d)
        d = d - (2 * (d - s) - c + c * x**2) / (2 - 2 * x**3)
    return d, arccos(c / (c + d)), K * d
