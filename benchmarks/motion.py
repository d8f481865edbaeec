"""Force, moment, energy and tangent of a joint with damping and friction: in Python, compiled, in batches, and in C.

The rival is Hunt and Crossley's law with Coulomb friction, in Python and in numba: force and moment alone.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import partial
from math import sqrt, tanh
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numba
import numpy

import ballsocket as bs
from ballsocket.dynamics import Flores, Friction
from ballsocket.dynamics.compiled import CompiledElement, loads_at
from ballsocket.export import CElement
from ballsocket.export.compiler import LIBRARY_ENDING, NoCompiler, shared_library

from .report import Pair, Row, compare
from .timing import Job

JOINT = bs.joints["hip-28"]
LOSSES: dict[str, Any] = {
    "damping": Flores(restitution=0.8, impact_speed=100.0),
    "friction": Friction(coefficient=0.05),
}
MODELS = {"paper's model": bs.HessForsbach(), "tabulated": bs.Tabulated()}
CALLS, LOOP, MANY, RIVAL = 1000, 20_000, 100_000, "Hunt-Crossley in numba"
STIFFNESS, LOSS = 7e4, 0.004  # N/mm^1.5, s/mm

C_LOOP = """
#include "element.h"
double loop(const double *s, int n) {
    double out[7], sum = 0.0;
    for (int i = 0; i < n; i++, s += 9) {
        element_load(&element_defaults, s, s + 3, s + 6, out, out + 3, out + 6);
        for (int k = 0; k < 7; k++) sum += out[k];
    }
    return sum;
}
"""


def measure() -> list[Row]:
    states = _states()
    by_hand = _python(partial(_hunt_crossley, STIFFNESS, LOSS), states[:CALLS])
    pairs, in_numba = [], _loop(numba.njit(error_model="numpy")(_hunt_crossley), STIFFNESS, LOSS, states)
    with TemporaryDirectory() as folder:
        for name, model in MODELS.items():
            element = bs.ForceElement(model, JOINT, **LOSSES)
            fast, python = CompiledElement(element), _python(partial(_loads, element), states[:CALLS])
            compiled = _loop(loads_at, fast.potential, fast.constants, states)
            pairs += [
                Pair(f"force element, {name}, in Python", python, "Hunt-Crossley in Python", by_hand),
                Pair(f"force element, {name}, in a compiled loop", compiled, RIVAL, in_numba),
                Pair(f"force element, {name}, {MANY} states at once", _batch(fast, states), RIVAL, in_numba),
            ]
            try:
                job = _in_c(element, Path(folder) / name[:5], states)
            except NoCompiler:
                continue
            pairs.append(Pair(f"force element, {name}, in C, without tangent", job, RIVAL, in_numba))
        return compare(pairs)


def _states() -> numpy.ndarray:
    """Positions 1 to 60 µm deep, velocities and spins, a row of nine numbers each."""
    random = numpy.random.default_rng(1)
    way = random.normal(size=(MANY, 3))
    distance = JOINT.clearance + random.uniform(0.001, 0.06, MANY)
    way *= (distance / numpy.linalg.norm(way, axis=1))[:, None]
    motion = random.normal(size=(MANY, 6)) * ([50.0] * 3 + [1.0] * 3)
    return numpy.ascontiguousarray(numpy.hstack([way, motion]))


def _python(function: Callable[..., Any], states: numpy.ndarray) -> Job:
    rows = [[tuple(part) for part in row.reshape(3, 3).tolist()] for row in states]
    return Job(lambda: [function(*row) for row in rows], len(rows))


def _loads(element: bs.ForceElement, *state: Any) -> tuple[Any, ...]:
    load = element(*state)
    return load.force, load.moment, load.energy, load.tangent


def _hunt_crossley(stiffness, loss, position, velocity, spin):  # type: ignore[no-untyped-def]
    """Force and moment, F = k d^1.5 (1 + χ ḋ) with friction μ F tanh(q/v0) against the slip q; F and its direction."""
    (x, y, z), (vx, vy, vz), (wx, wy, wz) = position, velocity, spin
    e = sqrt(x * x + y * y + z * z)
    x, y, z = x / e, y / e, z / e
    speed = vx * x + vy * y + vz * z
    F = max(stiffness * max(e - 0.1, 0.0) ** 1.5 * (1 + loss * speed), 0.0)
    sx, sy, sz = vx - speed * x, vy - speed * y, vz - speed * z
    sx, sy, sz = sx + 14 * (wy * z - wz * y), sy + 14 * (wz * x - wx * z), sz + 14 * (wx * y - wy * x)
    q = sqrt(sx * sx + sy * sy + sz * sz) + 1e-12
    f = 0.05 * F * tanh(q / 0.1) / q
    sx, sy, sz = -f * sx, -f * sy, -f * sz
    moment = 14 * (y * sz - z * sy), 14 * (z * sx - x * sz), 14 * (x * sy - y * sx)
    return (sx - F * x, sy - F * y, sz - F * z), moment, F, (x, y, z)


def _batch(fast: CompiledElement, states: numpy.ndarray) -> Job:
    parts = [numpy.ascontiguousarray(states[:, first : first + 3]) for first in (0, 3, 6)]
    return Job(lambda: fast.loads(*parts), len(states))


def _loop(law: Any, first: Any, second: Any, states: numpy.ndarray) -> Job:
    """A compiled law over the states, with its first two arguments."""

    @numba.njit(error_model="numpy")
    def summed(first, second, states):  # type: ignore[no-untyped-def]
        total = 0.0
        for s in states:
            force, moment, energy, last = law(first, second, (s[0], s[1], s[2]), (s[3], s[4], s[5]), (s[6], s[7], s[8]))
            total += force[0] + moment[1] + energy + last[2]
        return total

    return Job(lambda: summed(first, second, states[:LOOP]), LOOP)


def _in_c(element: bs.ForceElement, folder: Path, states: numpy.ndarray) -> Job:
    """The exported functions, compiled with -O2 and called from another file."""
    folder.mkdir()
    CElement(element=element, name="element").write(folder)
    (folder / "loop.c").write_text(C_LOOP, encoding="ascii")
    library = shared_library(["element.c", "loop.c"], folder / f"loop{LIBRARY_ENDING}", folder)
    loop = ctypes.CDLL(str(library)).loop
    loop.restype = ctypes.c_double
    first = states.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
    return Job(lambda: loop(first, LOOP), LOOP)
