"""Estimated changes on a hemisphere with a free rim and half a ball (`contact.hemisphere`) against finite elements.

Random joints with layers over decades of modulus and thickness, at random half angles of the closed sphere; the finite
elements press the hemisphere with the same force. There is no rival. The environment variable
BALLSOCKET_HEMISPHERE_JOINTS sets another number of joints (about a second each).
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, log, nan, radians
from multiprocessing import get_context
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.elasticity.exact.hemisphere import CHANGES
from ballsocket.elasticity.exact.subsurface import von_mises_change

from .report import Report, Rows

KINDS = ("liner", "ball", "layers", "infinite")
"""A liner on a rigid backing, the same with an elastic ball, layers fixed outside, and an infinite last layer."""
_PROBABILITIES = (0.3, 0.2, 0.3, 0.2)


def joint_of(seed: int, number: int) -> tuple[str, bs.Joint, float]:
    """Kind, joint and half angle (rad) of one row."""
    random = numpy.random.default_rng((seed, number))
    kind = str(random.choice(KINDS, p=_PROBABILITIES))
    radius, young = 14.1, 1000.0

    def spread(low: float, high: float) -> float:
        return float(numpy.exp(random.uniform(log(low), log(high))))

    def poisson() -> float:
        return float(random.uniform(0.0, 0.45) if random.random() < 0.5 else 0.5 - spread(1e-3, 0.1))

    def layer(thickness: float) -> bs.Layer:
        material = bs.Material(young=young * spread(0.05, 300.0), poisson=float(random.uniform(0.1, 0.45)))
        return bs.Layer(thickness=thickness, material=material)

    backing: list[bs.Layer] = []
    thickness = radius / spread(0.3, 20.0)
    if kind == "layers":
        backing = [layer(radius * spread(0.05, 3.0)) for _ in range(int(random.integers(1, 4)))]
    if kind == "infinite":
        backing = [layer(radius * spread(0.05, 1.0)) for _ in range(int(random.integers(-1, 3)))]
        if random.random() < 0.3:
            backing, thickness = [], inf
        else:
            backing.append(layer(inf))
    soft = kind == "ball" or (kind != "liner" and random.random() < 0.3)
    ball = bs.Material(young=young * spread(1.0, 500.0), poisson=float(random.uniform(0.15, 0.49))) if soft else None
    joint = bs.Joint(
        ball_radius=14.0,
        clearance=0.1,
        liner_thickness=thickness,
        liner=bs.Material(young=young, poisson=poisson()),
        ball=ball,
        backing=tuple(backing),
    )
    return kind, joint, float(random.uniform(radians(4.0), radians(84.0)))


QUANTITIES = (*CHANGES, "von_mises")
SEED, COUNT, PROCESSES = 1, 60, 2
LIMIT, _LIMITED = 0.15, ("indentation", "max_pressure")


@dataclass(frozen=True, kw_only=True)
class Judged:
    """Change of each quantity by finite elements and as estimated, and the note and validity of `exact`."""

    kind: str
    true: tuple[float, ...]
    estimated: tuple[float, ...]
    noted: bool
    valid: bool


def judged(number: int) -> Judged | None:
    """One joint; None where one of the two bodies has no result."""
    kind, joint, angle = joint_of(SEED, number)
    closed: Any = bs.Exact().press(joint, half_angle=angle)
    if closed.status.failed:
        return None
    free = bs.FiniteElement(meshes=1).press(joint, force=closed.force)
    if free.status is not bs.Status.OK:
        return None
    estimated = [float(closed.hemisphere[name]) for name in CHANGES]
    wider = closed.half_angle * (1 + estimated[1])
    estimated.append(von_mises_change(closed.single_state.alone(0), wider) if wider == wider else nan)
    return Judged(
        kind=kind,
        true=tuple(getattr(free, name) / getattr(closed, name) - 1 for name in QUANTITIES),
        estimated=tuple(estimated),
        noted=any(note.startswith("closed sphere") for note in closed.notes),
        valid=not any("on a hemisphere ≤" in note for note in closed.notes),
    )


def measure() -> Report:
    count = int(os.environ.get("BALLSOCKET_HEMISPHERE_JOINTS", COUNT))
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with get_context("spawn").Pool(PROCESSES) as pool:
        return report_of([joint for joint in pool.imap(judged, range(count)) if joint is not None])


def report_of(joints: list[Judged]) -> Report:
    notes = Rows(
        "Notes and validity of `exact`",
        (
            "joints",
            "number",
            "true change above 1 %",
            "of these noted",
            "false notes",
            "d or pmax above 15 %",
            "invalid",
        ),
    )
    for kind in (*KINDS, "all"):
        chosen = [joint for joint in joints if kind in (joint.kind, "all")]
        true, large = (
            numpy.array([_largest(joint, names) for joint in chosen])
            for names in (CHANGES, ("indentation", "max_pressure"))
        )
        noted, valid = (
            numpy.array([getattr(joint, name) for joint in chosen], dtype=bool) for name in ("noted", "valid")
        )
        above, different = true > 0.01, large > LIMIT
        notes.add(
            kind,
            len(chosen),
            int(above.sum()),
            int((above & noted).sum()),
            int((~above & noted).sum()),
            int(different.sum()),
            f"{int((different & ~valid).sum())}, and {int((~different & ~valid).sum())} others",
        )
    errors = Rows(
        "Estimate of the change",
        (
            "quantity",
            "largest true change",
            "error, median",
            "95 %",
            "99 %",
            "estimate over change above 1 %: 5 %, median, 95 %",
        ),
    )
    true, estimated = (numpy.array([getattr(joint, name) for joint in joints]) for name in ("true", "estimated"))
    for column, name in enumerate(QUANTITIES):
        known = numpy.isfinite(estimated[:, column])
        change, estimate = true[known, column], estimated[known, column]
        error = numpy.percentile(abs(estimate - change), (50, 95, 99))
        ratio = (
            numpy.percentile((estimate / change)[abs(change) > 0.01], (5, 50, 95)) if (abs(change) > 0.01).any() else ()
        )
        largest = change[numpy.argmax(abs(change))]
        errors.add(
            name,
            f"{100 * largest:+.0f} %",
            *(f"{100 * value:.2g} %" for value in error),
            ", ".join(f"{value:.2f}" for value in ratio),
        )
    beyond = int((~numpy.isfinite(estimated[:, 0])).sum())
    return Report(
        [notes, errors],
        [
            "liner: on a rigid backing, R2/L 0.3 to 20, nu 0 to 0.499; ball: the same with E_ball/E 1 to 500; layers: "
            "one to three behind the liner, 0.05 to 300 times as stiff, 0.05 to 3 radii thick, fixed outside; "
            "infinite: the last layer, or the liner, is infinite. Half angles of the closed sphere 4 to 84 degrees.",
            f"{beyond} contacts of the hemisphere would be wider than the estimate reaches: they count as noted, and "
            "are not valid. Ratios are of changes above 1 %.",
        ],
    )


def _largest(joint: Judged, names: Sequence[str]) -> float:
    return max(abs(change) for name, change in zip(QUANTITIES, joint.true, strict=True) if name in names)
