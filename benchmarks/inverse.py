"""Ten million inverse solves of the paper's model: six arrays in; indentation, pressure, half angle and status out.

Measured against the machine's own speed of copying as many bytes, and against the ways to the same numbers without a
compiled pass: NumPy, JAX, SciPy. Fair, because all of them run on the same inputs, in float64, on the same one core
(the compiled pass has one thread; JAX would take more), in turns, and what they answer is compared as well.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from typing import Any

import numpy

import ballsocket as bs

from . import inverse_limits as limits
from . import inverse_rivals as rivals
from .report import Report, Rows
from .timing import Work, interleaved, one_core

POINTS, CHUNK, SAMPLE, REPEATS = 10**7, 2**14, 10**4, 7
PRESS = "Compiled(...).press"
WHOLE, CHUNKED, JAX = "NumPy, whole arrays", f"NumPy, chunks of {CHUNK}", "JAX, jit"
BRENTQ, FIND_ROOT = "SciPy, brentq", "SciPy, elementwise.find_root"
_RANGES = ((11.0, 23.0), (0.01, 0.2), (3.0, 15.0), (500.0, 3000.0), (0.3, 0.49), (10.0, 10000.0))

Inputs = list[numpy.ndarray]
"""Ball radius, clearance, liner thickness, Young's modulus, Poisson's ratio, force."""


def measure() -> Report | str:
    if importlib.util.find_spec("numba") is None:
        return "numba is not installed"
    random = numpy.random.default_rng(2021)
    inputs = [random.uniform(low, high, POINTS) for low, high in _RANGES]  # Table 1 of the paper, and beyond
    with one_core() as pinned:
        against_limits = limits.table(inputs, CHUNK)
        work = _paths(inputs)
        speeds, answers = _speeds(work), _answers(work, inputs)
    notes = [
        "All on one core, JAX too." if pinned else "Not held to one core: JAX may have used several.",
        *limits.NOTES,
        "NumPy is this package without numba. Joints are made beforehand, for each chunk too; JAX holds its inputs "
        f"beforehand. SciPy solves the first {SAMPLE} of the same problems, modulus included.",
        *(() if JAX in work else ("JAX is not installed: skipped.",)),
    ]
    return Report([against_limits, speeds, answers], notes, ("numba", "jax", "scipy"))


def _paths(inputs: Inputs) -> dict[str, Work]:
    from ballsocket.compiled import Compiled

    model, fast = bs.HessForsbach(), Compiled(model=bs.HessForsbach())
    joint, force = rivals.joint_of(inputs), inputs[5]
    parts = [[part[start : start + CHUNK] for part in inputs] for start in range(0, POINTS, CHUNK)]
    chunks = [(rivals.joint_of(part), part[5]) for part in parts]
    sample = [part[:SAMPLE] for part in inputs]
    jax_solve = rivals.jax_solver(inputs)

    def chunked() -> None:
        for part, load in chunks:
            _answer(model.press(part, force=load))

    return {
        PRESS: lambda: _answer(fast.press(joint, force=force)),
        CHUNKED: chunked,
        WHOLE: lambda: _answer(model.press(joint, force=force)),
        **({JAX: jax_solve} if jax_solve else {}),
        BRENTQ: lambda: rivals.brentq_solve(sample),
        FIND_ROOT: lambda: rivals.find_root_solve(sample),
    }


def _answer(contact: bs.Contact) -> rivals.Answer:
    return contact.indentation, contact.max_pressure, contact.half_angle


def _speeds(work: dict[str, Work]) -> Rows:
    first, again = interleaved(REPEATS, work)
    rows = Rows(f"{PRESS} against other paths, ns per solve", ("what", "ours", "rival", "ratio"))
    for name in list(work)[1:]:
        points = SAMPLE if name in (BRENTQ, FIND_ROOT) else POINTS
        ours, rival = again[PRESS].per(1e-9 * POINTS), again[name].per(1e-9 * points)
        rows.add(name, ours, rival, f"{rival.over(ours)} times faster")
    cold, warm = first[PRESS].per(1e-9 * POINTS), again[PRESS].per(1e-9 * POINTS)
    rows.add("ours, first call after the others, against a second call", cold, warm, f"{cold.over(warm)} times slower")
    return rows


def _answers(work: dict[str, Work], inputs: Inputs) -> Rows:
    """What the paths answer, beside ours; `work[PRESS]` is one of them and differs from itself by nothing."""
    ours: Any = work[PRESS]()
    columns = ("path", "indentation", "max pressure", "half angle", "Eq. (13) against the force asked for", "no answer")
    rows = Rows(f"Answers: largest relative difference from {PRESS}", columns)
    for name in work:
        if name != CHUNKED:
            found: Any = work[name]()
            rows.add(name, *_differences(found, ours), *_force_error(inputs, found[0]))
    return rows


def _differences(found: Sequence[Any], ours: Sequence[Any]) -> list[str]:
    pairs = [(numpy.asarray(part), mine[: len(part)]) for part, mine in zip(found, ours, strict=True)]
    return [_largest(part, mine) for part, mine in pairs]


def _force_error(inputs: Inputs, indentation: Any) -> tuple[str, str]:
    d = numpy.asarray(indentation)
    some = [part[: d.size] for part in inputs]
    force = bs.HessForsbach().force(rivals.joint_of(some), d)
    return _largest(force, some[5]), f"{numpy.count_nonzero(~numpy.isfinite(d))} of {d.size}"


def _largest(found: numpy.ndarray, known: numpy.ndarray) -> str:
    return f"{float(numpy.max(numpy.abs(found / known - 1))):.1e}"
