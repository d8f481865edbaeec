"""Does the exact solver answer whatever joint it is given? Random joints, far beyond any that is built.

There is no rival: the rows count how the presses ended and what they claim. Fair, because the joints are drawn over
decades in every number, the refusals and the misses are listed by number, and `python -m benchmarks random-joints`
draws the same joints each time. Joints are counted from 0; `joint_of(number)` gives any of them back. The environment
variable BALLSOCKET_RANDOM_JOINTS asks for another number of them.
"""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from multiprocessing import get_context

import numpy

import ballsocket as bs

from .report import Report, Rows
from .timing import short

SEED, COUNT, CHUNK, PROCESSES = 1882, 100_000, 500, 2
LISTED = 20
"""How many joints of each kind the notes name."""


def measure() -> Report:
    return report_of(run(int(os.environ.get("BALLSOCKET_RANDOM_JOINTS", COUNT))))


def joint_of(number: int) -> tuple[bs.Joint, float]:
    """The joint of that number, and its load in N."""
    random = numpy.random.default_rng((SEED, number))
    radius = _decades(random, 5.0, 50.0)
    clearance_ratio, thickness_ratio = _decades(random, 1e-5, 2e-2), _decades(random, 0.05, 50.0)
    liner = bs.Material(young=_decades(random, 1.0, 1e5), poisson=float(random.uniform(-0.5, 0.4999)))
    ball = bs.Material(young=_decades(random, 1.0, 1e6), poisson=float(random.uniform(-0.5, 0.5)))
    clearance = radius * clearance_ratio / (1 - clearance_ratio)  # the radius is the ball's, the ratio c/R2
    joint = bs.Joint(
        ball_radius=radius,
        clearance=clearance,
        liner_thickness=(radius + clearance) / thickness_ratio,
        liner=liner,
        ball=ball if random.random() < 0.5 else None,
    )
    return joint, liner.young * radius**2 * _decades(random, 1e-9, 1e-2)


def _decades(random: numpy.random.Generator, low: float, high: float) -> float:
    """Uniform in the logarithm."""
    return float(numpy.exp(random.uniform(numpy.log(low), numpy.log(high))))


@dataclass
class Found:
    """What a run of joints came to; `error` and `seconds` are the worst one and the joint that has it."""

    count: int = 0
    statuses: Counter[str] = field(default_factory=Counter)
    misses: list[tuple[int, str]] = field(default_factory=list)
    raised: list[tuple[int, str]] = field(default_factory=list)
    error: tuple[float, int] = (0.0, -1)
    seconds: tuple[float, int] = (0.0, -1)
    total: float = 0.0

    def add(self, other: Found) -> None:
        self.count += other.count
        self.statuses += other.statuses
        self.misses += other.misses
        self.raised += other.raised
        self.error, self.seconds = max(self.error, other.error), max(self.seconds, other.seconds)
        self.total += other.total


def run(count: int) -> Found:
    """The first `count` joints."""
    whole, start, shown = Found(), time.perf_counter(), 0.0
    chunks = [range(first, min(first + CHUNK, count)) for first in range(0, count, CHUNK)]
    # Each process keeps its linear algebra to one thread: the matrices are small.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with get_context("spawn").Pool(PROCESSES) as pool:
        for part in pool.imap(chunk, chunks):
            whole.add(part)
            now = time.perf_counter() - start
            if now - shown > 10:
                shown = now
                print(f"random-joints: {whole.count} of {count}, {now:.0f} s, {len(whole.raised)} raised", flush=True)
    return whole


def chunk(numbers: Iterable[int]) -> Found:
    """The joints of these numbers, one by one, in this process."""
    found, model = Found(), bs.Exact()
    model.press(joint_of(0)[0], force=1.0)  # what a first press makes once for all is not any joint's time
    for number in numbers:
        joint, load = joint_of(number)
        start = time.perf_counter()
        try:
            contact = model.press(joint, force=load)
            reported = float(contact.max_pressure), float(contact.half_angle), float(contact.indentation)
        except Exception as raised:
            found.raised.append((number, f"{type(raised).__name__}: {raised}"))
            found.statuses["raised"] += 1
            continue
        finally:
            taken = time.perf_counter() - start
            found.count += 1
            found.total += taken
            found.seconds = max(found.seconds, (taken, number))
        _judge(found, number, contact, reported)
    return found


def _judge(found: Found, number: int, contact: bs.Contact, reported: tuple[float, ...]) -> None:
    status = bs.Status(int(contact.status))
    found.statuses[status.name] += 1
    if status is bs.Status.OK:
        error = max(float(part) for part in contact.laws.error.values())  # type: ignore[attr-defined]
        found.error = max(found.error, (error, number))
        if not all(numpy.isfinite(value) and value > 0 for value in reported):
            found.misses.append((number, f"OK, but {reported}"))
    elif status is not bs.Status.NOT_REACHED:
        found.misses.append((number, status.name))


def report_of(found: Found) -> Report:
    rows = Rows(f"{found.count} random joints", ("what", "found"))
    for name, times in sorted(found.statuses.items()):
        rows.add(f"status {name}", times)
    rows.add("raised an exception, of which there must be none", len(found.raised))
    rows.add("largest estimated error of an answer", f"{found.error[0]:.1e} (joint {found.error[1]})")
    rows.add("mean time per joint, ms", short(1e3 * found.total / found.count))
    rows.add("longest, ms", f"{short(1e3 * found.seconds[0])} (joint {found.seconds[1]})")
    notes = [
        "R1 5 to 50 mm, c/R2 1e-5 to 2e-2, R2/L 0.05 to 50, liner E 1 to 1e5 MPa, force E R1² times 1e-9 to 1e-2, all "
        "uniform in the logarithm; nu -0.5 to 0.4999. Every second ball is rigid, on average; the others have E 1 to "
        "1e6 MPa and nu -0.5 to 0.5.",
        f"`Exact()` by force, with pressure, half angle and indentation, each joint new, in {PROCESSES} processes at "
        "once with one thread each. NOT_REACHED is a load that would need more than 85 degrees of contact.",
    ]
    for what, listed in (("Raised", found.raised), ("Not answered or not finite", found.misses)):
        if listed:
            named = "; ".join(f"{number}: {why}" for number, why in listed[:LISTED])
            more = f", and {len(listed) - LISTED} more" if len(listed) > LISTED else ""
            notes.append(f"{what}: {named}{more}.")
    return Report([rows], notes)
