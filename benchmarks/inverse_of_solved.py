"""A million presses by force of `Tabulated` and `Refined`: NumPy, compiled by numba, and compiled by JAX, on one core.

The answers are indentation, half angle and largest pressure. Fair, because all run on the same inputs in float64 with
one thread, in turns. Times are those of the processor, which other programs disturb less; what JAX holds is made
beforehand.
"""

from __future__ import annotations

import importlib.util
import os
import time
from collections.abc import Callable
from typing import Any

import numpy

import ballsocket as bs

from .report import Report, Rows
from .timing import Work, interleaved, one_core

POINTS, REPEATS = 10**6, 5
ONE, MANY = "one joint", "a joint a press"
GOALS = {("tabulated", ONE): 60.0, ("tabulated", MANY): 400.0, ("refined", ONE): 150.0, ("refined", MANY): 150.0}
"""Goals of numba in ns a press; those of JAX are twice as large."""


def measure() -> Report | str:
    if importlib.util.find_spec("numba") is None:
        return "numba is not installed"
    os.environ.setdefault("XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1")
    has_jax = importlib.util.find_spec("jax") is not None
    numbers = numpy.random.default_rng(2021).random((4, POINTS))
    work: dict[str, Work] = {}
    for model in (bs.Tabulated(), bs.Refined()):
        for joints in (ONE, MANY):
            work |= _paths(model, joints, numbers, has_jax)
    with one_core() as pinned:
        _, seconds = interleaved(REPEATS, work, clock=time.process_time)
    rows = Rows("A press by force: d, ε, p0, ns of the processor", ("what", "compiled", "goal", "NumPy", "JAX", "goal"))
    for (name, joints), goal in GOALS.items():
        cells = [
            str(seconds[key].per(1e-9 * POINTS)) if (key := f"{path}, {name}, {joints}") in seconds else "-"
            for path in ("numba", "NumPy", "JAX")
        ]
        rows.add(f"{name}, {joints}", cells[0], f"{goal:g}", cells[1], cells[2], f"{2 * goal:g}")
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    notes = ["All on one core." if pinned else "Not held to one core.", f"{load:.1f} programs ran at the end."]
    return Report([rows], notes, ("numba", "jax"))


def _paths(model: bs.Tabulated | bs.Refined, joints: str, numbers: numpy.ndarray, has_jax: bool) -> dict[str, Work]:
    """The same presses by NumPy, numba and, where it is installed, JAX."""
    from ballsocket.compiled import Compiled

    name, force = f"{model.name}, {joints}", 500.0 + 3500.0 * numbers[3]
    joint = _joint_of(joints, numbers)
    paths: dict[str, Work] = {
        f"NumPy, {name}": lambda: _answer(model.press(joint, force=force)),
        f"numba, {name}": lambda: _answer(Compiled(model=model).press(joint, force=force)),
    }
    return paths | ({f"JAX, {name}": _jax_path(model, joints, numbers)} if has_jax else {})


def _jax_path(model: bs.Model, joints: str, numbers: numpy.ndarray) -> Callable[[], object]:
    import jax

    with jax.enable_x64(True):
        held = jax.numpy.asarray(numbers)
        compiled = jax_press(model, joints)

    def press() -> object:
        with jax.enable_x64(True):
            return jax.block_until_ready(compiled(held))

    return press


def jax_press(model: bs.Model, joints: str) -> Callable[[Any], Any]:
    """Compiled presses of rows of random numbers: R1, c, L and F."""
    import jax

    return jax.jit(lambda numbers: _answer(model.press(_joint_of(joints, numbers), force=500.0 + 3500.0 * numbers[3])))


def _joint_of(joints: str, numbers: Any) -> bs.Joint:
    if joints == ONE:
        return bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)
    return bs.Joint(
        ball_radius=11.0 + 12.0 * numbers[0],
        clearance=0.05 + 0.15 * numbers[1],
        liner_thickness=4.0 + 8.0 * numbers[2],
        liner=bs.UHMWPE,
    )


def _answer(contact: bs.Contact) -> tuple[Any, Any, Any]:
    return contact.indentation, contact.half_angle, contact.max_pressure
