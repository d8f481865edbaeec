"""A million presses by force, each of a joint of its own: indentation, half angle and largest pressure.

The exact solution and SciPy's `brentq` solve the first of the same problems, one after the other. SciPy's rivals share
with this package only the printed numbers of Table 3.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

import ballsocket as bs
from ballsocket.compiled import Compiled
from ballsocket.models.table_3 import table_3

from .report import Pair, Row, compare, if_installed, with_version
from .timing import Job

POINTS, SAMPLE, FEW = 10**6, 10**4, 100
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
    rivals: dict[str, Job | str] = {
        "copy of the same bytes": Job(lambda: numpy.copyto(target, source), 2 * POINTS),
        "the same in NumPy": _press(closed, inputs),
        "the same in JAX": if_installed("jax", lambda: jax_job(in_jax, inputs, POINTS)),
        f"{with_version('scipy')} brentq": Job(partial(_brentq, _first(inputs, SAMPLE)), SAMPLE),
    }
    pairs = [Pair("paper's model, a joint a press", fast, rival, job) for rival, job in rivals.items()]
    exact = _press(bs.Exact(), _first(inputs, FEW))
    tabulated, compiled = bs.Tabulated(), Compiled(model=bs.Tabulated())
    one_material, in_numpy = _press(compiled, one_liner), _press(tabulated, one_liner)
    pairs += [
        Pair("tabulated, a joint a press, one liner material", one_material, "the same in NumPy", in_numpy),
        Pair("tabulated, a joint a press, a material each", _press(compiled, inputs), "exact", exact),
        Pair("refined, a joint a press, a material each", _press(bs.Refined(), inputs), "exact", exact),
    ]
    return compare(pairs)


def joint_of(inputs: Inputs) -> bs.Joint:
    radius, clearance, thickness, young, poisson = inputs[:5]
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=thickness, liner=liner)


def _first(inputs: Inputs, count: int) -> Inputs:
    return [part[:count] for part in inputs]


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


def _excess(d, R2, c, K, F):  # type: ignore[no-untyped-def]
    """Eq. (13) as printed, less the force."""
    return numpy.pi * R2**2 * K / 3 * (2 * d - c + c * (c / (c + d)) ** 2) - F


def _brentq(inputs: Inputs) -> object:
    """One root after the other, in plain floats."""
    constants = _constants(inputs)
    rows = zip(*(part.tolist() for part in (*constants, inputs[2])), strict=True)
    roots = [brentq(_excess, 0.0, thickness, args=tuple(four), xtol=1e-15, rtol=1e-15) for *four, thickness in rows]
    d, (_, clearance, modulus, _) = numpy.array(roots), constants
    return d, numpy.arccos(clearance / (clearance + d)), modulus * d
