"""Presses by force under `jax.jit` on one device: the paper's model, the tables and the refined model.

The limit is a copy of seven arrays: joint, load and three answers. Fair, because both run on the same device with
arrays of the same length, in turns, each waited for.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import ballsocket as bs

from .inverse_of_solved import MANY, ONE, jax_press
from .report import Rows
from .timing import Clock, interleaved

REPEATS = 5
ARRAYS = 7  # R1, c, L, F in; d, ε, p0 out
GOALS = {
    ("hess-forsbach", ONE): "",
    ("hess-forsbach", MANY): "0.089",
    ("tabulated", ONE): "0.15",
    ("tabulated", MANY): "1.5",
    ("refined", ONE): "1",
    ("refined", MANY): "1",
}
"""Goals on an H100 in ns a press; that of the paper's model is what it took before."""


def jax_rates(device: Any, count: int, clock: Clock = time.perf_counter) -> Rows:
    """Presses of one joint and of a joint a press, beside a copy: ns a press, and seconds of the first call."""
    import jax

    rows = Rows(
        f"Presses by force through JAX, d, ε, p0, {count:,} at once, ns a press",
        ("what", "ours", "goal", "copy", "ratio", "first call, s"),
    )
    with jax.enable_x64(True), jax.default_device(device):
        numbers = jax.random.uniform(jax.random.key(0), (4, count), dtype="float64")
        source = jax.numpy.zeros((ARRAYS, count))
        copy = _waited(jax.jit(lambda values: values + 1.0), source)
        for model in (bs.HessForsbach(), bs.Tabulated(), bs.Refined()):
            for joints in (ONE, MANY):
                press = _waited(jax_press(model, joints), numbers)
                first_call = _seconds(press)
                _, seconds = interleaved(REPEATS, {"copy": copy, "press": press}, clock)
                ours, limit = (seconds[name].per(1e-9 * count) for name in ("press", "copy"))
                goal = GOALS[model.name, joints]
                rows.add(
                    f"{model.name}, {joints}", ours, goal, limit, f"{ours.over(limit)} copies", f"{first_call:.1f}"
                )
    return rows


def _waited(work: Callable[[Any], Any], inputs: Any) -> Callable[[], object]:
    import jax

    return lambda: jax.block_until_ready(work(inputs))


def _seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start
