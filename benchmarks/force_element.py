"""The force element at one state after the other in Python, in a compiled loop, and at many states in one pass.

Force, moment and tangent of a joint with damping and friction, at states that alternate. Fair, because all take turns
on one core in one run, and the rival is asked for less: the ElasticFoundationForce of OpenSim, with its coarsest mesh,
says the force.
"""

from __future__ import annotations

import importlib.util
from functools import cache
from time import process_time
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.dynamics import Flores, Friction
from ballsocket.dynamics.compiled import CompiledElement, loads_at

from . import opensim_rival
from .report import Report, Rows
from .timing import Spread, Work, apart, interleaved, one_core

JOINT = bs.joints["hip-28"]
MODELS = {"hess-forsbach": bs.HessForsbach(), "refined": bs.Refined(), "tabulated": bs.Tabulated()}
LOSSES = {"damping": Flores(restitution=0.8, impact_speed=100.0), "friction": Friction(coefficient=0.05)}
STATES = [((0.01, 0.02 + 1e-7 * turn, 0.12), (1.0, 2.0, 20.0), (0.1, 1.0, 0.2)) for turn in range(2)]
CALLS, LOOP, MANY, REPEATS = 100, 20_000, 100_000, 15
PLAIN, COMPILED, BATCH = 8.0, 500.0, 100.0  # µs, ns, ns: what is aimed at
NOTES = (
    "Processor time, all of it on one core. Each is force and moment on the ball, energy and the 3 x 3 tangent.",
    "Plain: tuples of floats. Compiled: one state after the other inside a compiled loop. Batch: 100 000 states in one "
    "compiled pass over arrays; 100 ns are ten million a second.",
    "`refined` and `tabulated` are followed by a curve of ln U, which takes a logarithm and an exponential.",
)


def measure() -> Report:
    """In a process of its own, whose linear algebra has one thread."""
    return apart(_measured, OPENBLAS_NUM_THREADS="1")


def _measured() -> Report:
    work: dict[str, Work] = {}
    for name, model in MODELS.items():
        for losses, what in (({}, "elastic"), (LOSSES, "lossy")):
            element = bs.ForceElement(model, JOINT, **losses)  # type: ignore[arg-type]
            fast = CompiledElement(element)
            work |= {f"{name} {what} plain": _plain(element), f"{name} {what} loop": _loop(fast)}
            work[f"{name} {what} batch"] = _batch(fast)
    if importlib.util.find_spec("opensim") is not None:
        work["opensim"] = _opensim()
    with one_core():
        _, seconds = interleaved(REPEATS, work, process_time)
    rows = Rows("Force, moment and tangent", ("element", "plain, µs", "compiled, ns", "batch, ns a state"))
    for name in MODELS:
        for what in ("elastic", "lossy"):
            key = f"{name} {what}"
            plain = _judged(seconds[f"{key} plain"].per(1e-6 * CALLS), PLAIN)
            loop = _judged(seconds[f"{key} loop"].per(1e-9 * LOOP), COMPILED)
            batch = _judged(seconds[f"{key} batch"].per(1e-9 * MANY), BATCH)
            rows.add(f"`{name}`{', damping and friction' if what == 'lossy' else ''}", plain, loop, batch)
    if "opensim" in seconds:
        rows.add("OpenSim, coarsest mesh: force", seconds["opensim"].per(1e-6 * CALLS), "", "")
    return Report([rows], NOTES, ("opensim",))


def _plain(element: bs.ForceElement) -> Work:
    def work() -> None:
        for call in range(CALLS):
            load = element(*STATES[call % 2])
            _ = load.force, load.moment, load.energy, load.tangent

    return work


def _loop(fast: CompiledElement) -> Work:
    summed, numbers = _summed(), numpy.array(STATES)
    return lambda: summed(fast.potential, fast.constants, numbers, LOOP)


@cache
def _summed() -> Any:
    import numba

    @numba.njit(error_model="numpy")
    def summed(potential, constants, states, count):  # type: ignore[no-untyped-def]
        total = 0.0
        for call in range(count):
            s = states[call % 2]
            r, v, w = (s[0, 0], s[0, 1], s[0, 2]), (s[1, 0], s[1, 1], s[1, 2]), (s[2, 0], s[2, 1], s[2, 2])
            force, moment, energy, tangent = loads_at(potential, constants, r, v, w)
            total += force[0] + moment[1] + energy + tangent[2]
        return total

    return summed


def _batch(fast: CompiledElement) -> Work:
    random = numpy.random.default_rng(1)
    way = random.normal(size=(MANY, 3))
    depth = JOINT.clearance + random.uniform(0.0, 0.06, MANY)
    position = way * (depth / numpy.linalg.norm(way, axis=1))[:, None]
    velocity, spin = 50.0 * random.normal(size=(MANY, 3)), random.normal(size=(MANY, 3))
    return lambda: fast.loads(position, velocity, spin)


def _opensim() -> Work:
    from .opensim_model import build

    rival, faces = opensim_rival.JOINT, min(opensim_rival.FACES)
    force = build(rival.ball_radius, rival.clearance, opensim_rival.K, faces).force

    def work() -> None:
        for call in range(CALLS):
            force(0.02 * (1 + 1e-6 * (call % 2)))

    return work


def _judged(found: Spread, aim: float) -> str:
    return f"{found}; aim {aim:g}: {'met' if found.median <= aim else 'missed'}"
