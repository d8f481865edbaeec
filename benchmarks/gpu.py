"""Presses, tilted loads and patients on a GPU through JAX, beside a copy of the same bytes and one processor core.

All results stay on the device, and each call is waited for. Presses are in double precision, tilted loads in single.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import date
from typing import Any

import ballsocket as bs

from . import sphere
from .curve import JOINT
from .joints import jax_job, results
from .report import Pair, Row, compare
from .timing import MissingError, wall_time
from .wear import patients_jobs

COUNT, ARRAYS = 10_000_000, 7  # R1, c, L, F in; d, ε, p0 out
LOADS, PATIENTS = 512, 8192


def measure() -> list[Row]:
    import jax

    try:
        device = jax.devices("gpu")[0]
    except RuntimeError as missing:
        raise MissingError("JAX finds no GPU") from missing
    return rows_of(device)


def rows_of(device: Any, count: int = COUNT) -> list[Row]:
    """Rows of a device with so many presses at once."""
    import jax

    with jax.default_device(device):
        with jax.enable_x64(True):
            rows = compare(_presses(count), clock=wall_time)
        for text, tolerance in (("1e-4", 1e-4), ("2e-5", 2e-5)):
            cup = Pair(f"tilted load in a real cup to {text}, {LOADS} at once", sphere.jax_job(LOADS, tolerance))
            rows += compare([cup], clock=wall_time)
        ours, one = patients_jobs(PATIENTS)
        work = f"springs of a patient, a cycle of 32 instants, {PATIENTS} at once"
        rows += compare([Pair(work, ours, "numba on one core", one)], repeats=2, clock=wall_time)
    where = f"{device.device_kind}, {date.today().isoformat()}"
    return [replace(row, machine=where) for row in rows]


def _presses(count: int) -> list[Pair]:
    import jax

    numbers = jax.random.uniform(jax.random.key(0), (4, count), dtype="float64")
    zeros = jax.numpy.zeros((ARRAYS, count))
    copy = jax_job(lambda values: values + 1.0, [zeros], count)
    return [
        Pair(f"{model.name}, {title}", jax_job(_press(model, joint), [numbers], count), "copy of seven arrays", copy)
        for model in (bs.HessForsbach(), bs.Tabulated())
        for title, joint in (("one joint", lambda numbers: JOINT), ("a joint a press", _joint_each))
    ]


def _press(model: bs.Model, joint: Callable[[Any], bs.Joint]) -> Callable[[Any], Any]:
    return lambda numbers: results(model.press(joint(numbers), force=500.0 + 3500.0 * numbers[3]))


def _joint_each(numbers: Any) -> bs.Joint:
    return bs.Joint(
        ball_radius=11.0 + 12.0 * numbers[0],
        clearance=0.05 + 0.15 * numbers[1],
        liner_thickness=4.0 + 8.0 * numbers[2],
        liner=bs.UHMWPE,
    )
