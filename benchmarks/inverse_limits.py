"""How near the compiled pass comes to what the machine can do with as many bytes.

The limit is a copy of five arrays (`numpy.copyto`): 80 bytes read or written per solve, where a solve reads 48 and
writes 25. Copies run one after the other, which need not be the fastest way to move bytes, so sums of the inputs, two
by two, into the same outputs are measured as well: a compiled pass over the very same arrays that computes next to
nothing. The kernel again on arrays that stay in cache tells how much of its time is arithmetic, and its divisions and
roots alone there how much of that no order of the formulas saves.
"""

from __future__ import annotations

import math
from time import process_time
from typing import Any

import numpy

import ballsocket as bs

from .inverse_rivals import joint_of
from .report import Rows
from .timing import Spread, interleaved

REPEATS, AIM = 15, 2.0
COPY, SUMS = "copy of five arrays", "compiled sums, same arrays"
KERNEL, IN_CACHE, PRESS = "compiled kernel", "compiled kernel, arrays in cache", "Compiled(...).press"
DIVISIONS = "its seven divisions and two roots alone, arrays in cache"
NOTES = (
    "The copy (`numpy.copyto`) reads or writes 80 bytes per solve; a solve reads 48 and writes 25. The sums read and "
    "write exactly the arrays of a solve, in one compiled pass that computes next to nothing.",
    "Limits are in processor time, which other work on the machine hardly disturbs. Where the kernel takes as long on "
    "arrays that stay in cache, its time is arithmetic and not memory: for eight solves at once 7 divisions, 2 roots "
    "and some 130 other operations on vectors of eight, most of which wait for the one before. Cut into a loop for "
    "each formula over blocks of 1024 solves, the arithmetic took 4.3 in place of 6.0 ns in cache, but no longer ran "
    "while memory was waited for: 6.6 in place of 6.4 ns in all.",
    "Kernel, sums and copy write into arrays that were used before. `press` checks its input and takes new memory for "
    "its answer, whose pages the system hands out inside the pass: dearest in a first call, where a virtual machine "
    "has given its free memory back meanwhile.",
)


def table(inputs: list[numpy.ndarray], chunk: int) -> Rows:
    import numba

    from ballsocket.compiled import Compiled
    from ballsocket.compiled.kernels import foundation_kernel as kernel_of

    kernel: Any = kernel_of(bs.hess_forsbach.formula, bs.linear_kinematics)
    fast, joint, points = Compiled(model=bs.HessForsbach()), joint_of(inputs), inputs[0].size
    targets = [numpy.zeros(points) for _ in range(5)]
    passed = [*inputs, *targets[:3], numpy.zeros(points, dtype=numpy.int8)]
    first = [part[:chunk] for part in passed]

    @numba.njit
    def sums(R1, c, L, E, nu, F, d, p0, angle, status):  # type: ignore[no-untyped-def]
        for i in range(d.size):
            d[i], p0[i], angle[i], status[i] = R1[i] + c[i], L[i] + E[i], nu[i] + F[i], 0

    @numba.njit(error_model="numpy")
    def divisions(R1, c, L, E, nu, F, d, p0, angle, status):  # type: ignore[no-untyped-def]
        for i in range(d.size):
            d[i] = E[i] / R1[i] + F[i] / L[i] + math.sqrt(c[i] / nu[i])
            p0[i], angle[i] = R1[i] / L[i] + F[i] / E[i], nu[i] / E[i] + math.sqrt(c[i] / F[i])
            status[i] = 0

    def copy() -> None:
        for source, target in zip(inputs, targets, strict=False):
            numpy.copyto(target, source)

    def in_cache(work: Any) -> None:
        for _ in range(points // chunk):
            work(*first)

    _, seconds = interleaved(
        REPEATS,
        {
            COPY: copy,
            SUMS: lambda: sums(*passed),
            KERNEL: lambda: kernel(*passed),
            IN_CACHE: lambda: in_cache(kernel),
            DIVISIONS: lambda: in_cache(divisions),
            PRESS: lambda: fast.press(joint, force=inputs[5]),
        },
        process_time,
    )
    times = {name: spread.per(1e-9 * points) for name, spread in seconds.items()}
    rows = Rows("Against the machine's limit, ns per solve", ("what", "ours", "limit", "ratio"))
    for name, limit, aim in (
        (KERNEL, COPY, AIM),
        (PRESS, COPY, AIM),
        (IN_CACHE, COPY, None),
        (DIVISIONS, COPY, None),
        (KERNEL, SUMS, None),
    ):
        ratio = times[name].over(times[limit])
        rows.add(f"{name} / {limit}", times[name], times[limit], f"{ratio} times the limit{_verdict(ratio, aim)}")
    return rows


def _verdict(ratio: Spread, aim: float | None) -> str:
    if aim is None:
        return ""
    return f"; aim {aim:g}: {'met' if ratio.median <= aim else 'missed'}"
