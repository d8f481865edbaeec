"""Force, moment, energy and tangent of a joint with damping and friction: in Python, compiled, in batches, and in C.

OpenSim's ElasticFoundationForce returns the force alone, on its coarsest mesh.
"""

from __future__ import annotations

import ctypes
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.dynamics import Flores, Friction
from ballsocket.dynamics.compiled import CompiledElement, loads_at
from ballsocket.export import CElement
from ballsocket.export.compiler import LIBRARY_ENDING, NoCompiler, shared_library

from .opensim_model import force_job
from .report import Pair, Row, compare, if_installed, with_version
from .timing import Job

JOINT = bs.joints["hip-28"]
LOSSES: dict[str, Any] = {
    "damping": Flores(restitution=0.8, impact_speed=100.0),
    "friction": Friction(coefficient=0.05),
}
MODELS = {"paper's model": bs.HessForsbach(), "tabulated": bs.Tabulated()}
CALLS, LOOP, MANY = 100, 20_000, 100_000

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
    modulus = float(bs.hess_forsbach(JOINT))
    opensim = if_installed("opensim", partial(force_job, JOINT, modulus, 1000, 0.02, CALLS))
    rival = f"{with_version('opensim')}, a force, 924 faces"
    states = _states()
    pairs = []
    with TemporaryDirectory() as folder:
        for name, model in MODELS.items():
            element = bs.ForceElement(model, JOINT, **LOSSES)
            fast, python = CompiledElement(element), _python(element, states[:CALLS])
            batch = _batch(fast, states)
            pairs += [
                Pair(f"force element, {name}, in Python", python, rival, opensim),
                Pair(f"force element, {name}, in a compiled loop", _compiled(fast, states), "in Python", python),
                Pair(f"force element, {name}, {MANY} states at once", batch, "in Python", python),
            ]
            try:
                job = _in_c(element, Path(folder) / name[:5], states)
            except NoCompiler:
                continue
            pairs.append(Pair(f"force element, {name}, in C, without tangent", job, "in Python", python))
        return compare(pairs)


def _states() -> numpy.ndarray:
    """Positions 1 to 60 µm deep, velocities and spins, a row of nine numbers each."""
    random = numpy.random.default_rng(1)
    way = random.normal(size=(MANY, 3))
    distance = JOINT.clearance + random.uniform(0.001, 0.06, MANY)
    way *= (distance / numpy.linalg.norm(way, axis=1))[:, None]
    motion = random.normal(size=(MANY, 6)) * ([50.0] * 3 + [1.0] * 3)
    return numpy.ascontiguousarray(numpy.hstack([way, motion]))


def _python(element: bs.ForceElement, states: numpy.ndarray) -> Job:
    rows = [[tuple(part) for part in row.reshape(3, 3).tolist()] for row in states]

    def call() -> None:
        for row in rows:
            load = element(*row)
            _ = load.force, load.moment, load.energy, load.tangent

    return Job(call, len(rows))


def _batch(fast: CompiledElement, states: numpy.ndarray) -> Job:
    parts = [numpy.ascontiguousarray(states[:, first : first + 3]) for first in (0, 3, 6)]
    return Job(lambda: fast.loads(*parts), len(states))


def _compiled(fast: CompiledElement, states: numpy.ndarray) -> Job:
    return Job(lambda: _summed()(fast.potential, fast.constants, states[:LOOP]), LOOP)


@cache
def _summed() -> Any:
    import numba

    @numba.njit(error_model="numpy")
    def summed(potential, constants, states):  # type: ignore[no-untyped-def]
        total = 0.0
        for s in states:
            force, moment, energy, tangent = loads_at(
                potential, constants, (s[0], s[1], s[2]), (s[3], s[4], s[5]), (s[6], s[7], s[8])
            )
            total += force[0] + moment[1] + energy + tangent[2]
        return total

    return summed


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
