"""Ten million inverse solves of the paper's model: six arrays in; indentation, pressure, half angle and status out.

Measured against the machine's own speed of copying as many bytes, and against the ways to the same numbers without a
compiled pass: NumPy, JAX, SciPy. Fair, because all of them run on the same inputs, in float64, on the same one core
(the compiled pass has one thread; JAX and BLAS would take more), in turns, and what they answer is compared as well.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from typing import Any

import numpy

import ballsocket as bs

from . import inverse_rivals as rivals
from .report import Report, Rows
from .timing import Spread, Work, interleaved, one_core

POINTS, CHUNK, SAMPLE, REPEATS = 10**7, 2**14, 10**4, 7
KERNEL, PRESS, COPY = "compiled kernel, outputs at hand", "Compiled(...).press", "copy of the bytes"
IN_CACHE, WHOLE, CHUNKED = "compiled kernel, arrays in cache", "NumPy, whole arrays", f"NumPy, chunks of {CHUNK}"
JAX, BRENTQ, FIND_ROOT = "JAX, jit", "SciPy, brentq", "SciPy, find_root"
_RANGES = ((11.0, 23.0), (0.01, 0.2), (3.0, 15.0), (500.0, 3000.0), (0.3, 0.49), (10.0, 10000.0))


def inputs_of(points: int) -> list[numpy.ndarray]:
    """Ball radius, clearance, liner thickness, Young's modulus, Poisson's ratio, force: over Table 1 and beyond."""
    random = numpy.random.default_rng(2021)
    return [random.uniform(low, high, points) for low, high in _RANGES]


def measure() -> Report | str:
    if importlib.util.find_spec("numba") is None:
        return "numba is not installed"
    with one_core() as pinned:
        return _measure(inputs_of(POINTS), pinned)


def _measure(inputs: list[numpy.ndarray], pinned: bool) -> Report:
    from ballsocket.compiled import Compiled, _kernel

    model, fast = bs.HessForsbach(), Compiled(model=bs.HessForsbach())
    kernel: Any = _kernel(model)
    outputs = [numpy.zeros(POINTS) for _ in range(5)]
    status = numpy.zeros(POINTS, dtype=numpy.int8)
    joint, force = rivals.joint_of(inputs), inputs[5]
    first = [part[:CHUNK] for part in (*inputs, *outputs[:3], status)]
    sample = [part[:SAMPLE].copy() for part in inputs]
    parts = [[part[i : i + CHUNK] for part in inputs] for i in range(0, POINTS, CHUNK)]
    chunks = [(rivals.joint_of(part), part[5]) for part in parts]
    jax_solve = rivals.jax_solver(inputs)

    def copy() -> None:
        for source, target in zip(inputs[:5], outputs, strict=True):
            numpy.copyto(target, source)

    def in_cache() -> None:
        for _ in range(POINTS // CHUNK):
            kernel(*first)

    def chunked() -> None:
        for part, load in chunks:
            _answer(model.press(part, force=load))

    work: dict[str, Work] = {
        COPY: copy,
        KERNEL: lambda: kernel(*inputs, *outputs[:3], status),
        IN_CACHE: in_cache,
        PRESS: lambda: _answer(fast.press(joint, force=force)),
        CHUNKED: chunked,
        WHOLE: lambda: _answer(model.press(joint, force=force)),
        **({JAX: jax_solve} if jax_solve else {}),
        BRENTQ: lambda: rivals.brentq_solve(sample),
        FIND_ROOT: lambda: rivals.find_root_solve(sample),
    }
    ours = fast.press(joint, force=force)
    answers = Rows(
        "Answers: largest relative difference from Compiled(...).press",
        ("path", "indentation", "max pressure", "half angle", "its Eq. (13) against the force asked for"),
    )
    answers.add(PRESS, "", "", "", _force_error(joint, force, ours.indentation))
    for name in (WHOLE, JAX, BRENTQ, FIND_ROOT):
        if name in work:
            _compare(answers, name, work[name](), joint, force, _answer(ours))
    failed = int(numpy.count_nonzero(ours.status))
    del ours
    return Report(
        [_table(interleaved(REPEATS, work)), answers],
        [
            "Pinned to one core, JAX's threads too." if pinned else "Not pinned to a core: JAX may have used several.",
            f"{failed} of {POINTS} solves ended with a status other than OK.",
            "The limit is `numpy.copyto` of five arrays: 80 bytes read or written per solve; a solve itself reads 48 "
            "and writes 25. The copy may write past the cache, which compiled loops do not: they fetch each line of "
            "the outputs before they overwrite it.",
            f"`Compiled(...).press` also checks its input and allocates its output, whose pages are touched first "
            f"inside the pass. In cache: {CHUNK} solves again and again, which is what the arithmetic alone takes.",
            "NumPy is this package without numba. Joints are made beforehand, for each chunk too; JAX's arrays are "
            "JAX's own beforehand.",
            f"SciPy: {SAMPLE} of the same solves, modulus included, Eq. (13) as printed.",
            *(() if jax_solve else ("JAX is not installed: skipped.",)),
        ],
        ("numba", "jax", "scipy"),
    )


def _answer(contact: bs.Contact) -> rivals.Answer:
    return contact.indentation, contact.max_pressure, contact.half_angle


def _table(seconds: dict[str, Spread]) -> Rows:
    times = {
        name: spread.per(1e-9 * (SAMPLE if name in (BRENTQ, FIND_ROOT) else POINTS)) for name, spread in seconds.items()
    }
    table = Rows("ns per solve", ("what", "ours", "rival", "ratio"))
    for name in (KERNEL, PRESS, IN_CACHE):
        ratio = f"{times[name].over(times[COPY])} times the limit" + ("; aim 2" if name == KERNEL else "")
        table.add(f"{name}, against a {COPY}", times[name], times[COPY], ratio)
    for name in (CHUNKED, WHOLE, JAX, BRENTQ, FIND_ROOT):
        if name in times:
            ratio = f"{times[name].over(times[PRESS])} times faster"
            table.add(f"{PRESS}, against {name}", times[PRESS], times[name], ratio)
    return table


def _force_error(joint: bs.Joint, force: numpy.ndarray, d: numpy.ndarray) -> str:
    return f"{_largest(bs.HessForsbach().force(joint, d), force):.1e}"


def _largest(found: numpy.ndarray, known: numpy.ndarray) -> float:
    return float(numpy.max(numpy.abs(found / known - 1)))


def _compare(rows: Rows, name: str, found: Any, joint: bs.Joint, force: numpy.ndarray, ours: Sequence[Any]) -> None:
    theirs = [numpy.asarray(part) for part in found]
    size = theirs[0].size
    differences = [f"{_largest(part, mine[:size]):.1e}" for part, mine in zip(theirs, ours, strict=True)]
    whole = joint.with_numbers([part[:size] for part in joint.numbers()])
    rows.add(name, *differences, _force_error(whole, force[:size], theirs[0]))
