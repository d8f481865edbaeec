"""Identification of synthetic data: what counts as identifiable, and coverage of the bands with wrong data or machines.

The truth is a joint that no test has. Half angles and pressures depend on clearance times modulus alone, so that no
set of them may report a clearance and a modulus. Indentations are read with a perfect machine, or with one that has an
error that the identification leaves out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy

import ballsocket as bs
from ballsocket.identify import HeavyTailed, IdentificationResult, Machine, Measured

from .report import Report, Rows

MODEL = bs.Tabulated()
TRUTH = bs.Joint(ball_radius=15.3, clearance=0.12, liner_thickness=7.4, liner=bs.Material(young=780.0, poisson=0.42))
VALUES = {"clearance": 0.12, "liner_young": 780.0, "liner_poisson": 0.42}
FREE: dict[str, Any] = {"clearance": (0.02, 0.4), "liner_young": (300.0, 2500.0)}
POISSON: dict[str, Any] = {"liner_poisson": (0.3, 0.48)}
PRESS, FORCE = numpy.linspace(250.0, 3000.0, 12), numpy.linspace(500.0, 3000.0, 6)
DEPTH, ANGLE, SHARE = 4e-4, 0.008, 0.02  # standard uncertainties: mm, rad, relative
RANGES: dict[str, dict[str, Any]] = {
    "0.02..0.4 mm, 300..2500 MPa": FREE,
    "0.02..0.4 mm, 100..8000 MPa": {**FREE, "liner_young": (100.0, 8000.0)},
    "0.05..0.3 mm, 400..2000 MPa": {"clearance": (0.05, 0.3), "liner_young": (400.0, 2000.0)},
    "0.05..0.3 mm, 600..1000 MPa": {"clearance": (0.05, 0.3), "liner_young": (600.0, 1000.0)},
}
SETS, TABLE = 100, 60

Read = Callable[[numpy.random.Generator], list[Measured]]


@dataclass(frozen=True)
class Case:
    """One row of the table of coverage: errors of the data, and what is unknown."""

    title: str
    factor: float = 1.0
    outliers: int = 0
    offset: float = 0.0
    compliance: float = 0.0
    drift: float = 0.0
    alone: bool = False
    heavy: bool = False
    sought: dict[str, Any] = field(default_factory=dict)


ANY: dict[str, Any] = {"compliance": (0.0, 2e-5), "offset": (-0.02, 0.02)}
DRIFT: dict[str, Any] = {"drift": (-2e-3, 2e-3)}
CASES = (
    Case("no error"),
    Case("no error, heavy-tailed option", heavy=True),
    Case("noise 1.5x the stated", factor=1.5),
    Case("noise 2x the stated", factor=2.0),
    Case("noise 1.5x, heavy-tailed option", factor=1.5, heavy=True),
    Case("noise 2x, heavy-tailed option", factor=2.0, heavy=True),
    Case("an outlier of 20 uncertainties", outliers=1),
    Case("an outlier, heavy-tailed option", outliers=1, heavy=True),
    Case("three outliers, heavy-tailed option", outliers=3, heavy=True),
    Case("zero off by 2 µm", offset=2e-3),
    Case("zero off by 2 µm, indentations only", offset=2e-3, alone=True),
    Case("compliance 2 µm/kN", compliance=2e-6),
    Case("compliance 2 µm/kN, indentations only", compliance=2e-6, alone=True),
    Case("drift 0.2 µm per reading", drift=2e-4),
    Case("drift 0.2 µm per reading, indentations only", drift=2e-4, alone=True),
    Case("zero and compliance off, both sought", offset=2e-3, compliance=2e-6, sought=ANY),
    Case("drift, zero and compliance sought", drift=2e-4, sought=ANY),
    Case("drift, drift sought", drift=2e-4, sought=DRIFT),
    Case("drift, drift sought, indentations only", drift=2e-4, alone=True, sought=DRIFT),
)


def measure() -> Report:
    pairs = Rows(
        f"Six half angles and six pressures, {SETS} sets: what is reported as identifiable",
        ("ranges", "neither", "clearance alone", "modulus alone", "both", "both, and wrong", "bands hold c, E"),
    )
    for title, free in RANGES.items():
        pairs.add(title, *_pairs(free))
    table = Rows(
        f"Twelve indentations, half angles, pressures, {TABLE} sets: coverage and remarks",
        ("error", "band holds c", "band holds E", "wrong", "a remark on it", "wrong and silent", "width of c"),
    )
    for case in CASES:
        if "drift" not in case.sought or hasattr(Machine(), "drift"):
            table.add(case.title, *_coverage(case))
    return Report(
        [pairs, table, _bands()],
        [
            "A remark is one on outliers, on scatter, on an error of the machine that would move a result by more "
            "than its band, or on an unknown that is not identifiable.",
            "Truth: R1 15.3, c 0.12, L 7.4 mm, E 780 MPa, ν 0.42; model tabulated; ν is known but in the last table.",
        ],
        ("scipy",),
    )


def half_angles_and_pressures(random: numpy.random.Generator, factor: float = 1.0) -> list[Measured]:
    contact = MODEL.press(TRUTH, force=FORCE)
    angle, pressure = numpy.asarray(contact.half_angle), numpy.asarray(contact.max_pressure)
    angles = angle + factor * ANGLE * random.standard_normal(len(FORCE))
    pressures = pressure * (1 + factor * SHARE * random.standard_normal(len(FORCE)))
    return [
        Measured(quantity="half_angle", values=angles, uncertainty=ANGLE, force=FORCE),
        Measured(quantity="max_pressure", values=pressures, uncertainty=SHARE * pressure, force=FORCE),
    ]


def _indentations(random: numpy.random.Generator, case: Case) -> Measured:
    depth = numpy.asarray(MODEL.press(TRUTH, force=PRESS).indentation)
    wrong = case.offset + case.compliance * PRESS + case.drift * numpy.arange(len(PRESS))
    noise = case.factor * random.standard_normal(len(PRESS))
    noise[random.permutation(len(PRESS))[: case.outliers]] += 20.0
    machine: dict[str, Any] = {"machine": Machine(**case.sought)} if case.sought else {}
    return Measured(
        quantity="indentation", values=depth + wrong + DEPTH * noise, uncertainty=DEPTH, force=PRESS, **machine
    )


def _identified(data: Sequence[Measured], free: dict[str, Any], heavy: bool = False) -> IdentificationResult:
    option: Any = {"scatter": HeavyTailed()} if heavy else {}
    return bs.identify(MODEL, TRUTH, data, free, **option)


def _holds(fit: IdentificationResult, name: str) -> bool:
    return fit[name].low * (1 - 1e-9) <= VALUES[name] <= fit[name].high * (1 + 1e-9)


def _pairs(free: dict[str, Any]) -> list[str]:
    counts, wrong, held = [0, 0, 0, 0], 0, [0, 0]
    for seed in range(SETS):
        fit = _identified(half_angles_and_pressures(numpy.random.default_rng(1000 + seed)), free)
        identifiable = [fit[name].identifiable for name in FREE]
        holds = [_holds(fit, name) for name in FREE]
        counts[identifiable[0] + 2 * identifiable[1]] += 1
        wrong += all(identifiable) and not all(holds)
        held = [count + hold for count, hold in zip(held, holds, strict=True)]
    return [*map(str, counts), str(wrong), f"{held[0]}, {held[1]}"]


def _coverage(case: Case) -> list[str]:
    held, wrong, warned, silent, width = [0, 0], 0, 0, 0, []
    for seed in range(TABLE):
        random = numpy.random.default_rng(5000 + seed)
        data = [_indentations(random, case), *([] if case.alone else half_angles_and_pressures(random, case.factor))]
        fit = _identified(data, FREE, case.heavy)
        holds = [_holds(fit, name) for name in FREE]
        held = [count + hold for count, hold in zip(held, holds, strict=True)]
        remark = any(_is_remark(note) for note in fit.notes)
        wrong, warned, silent = wrong + (not all(holds)), warned + remark, silent + (not all(holds) and not remark)
        width.append(numpy.log(fit["clearance"].high / fit["clearance"].low))
    percentages = [f"{100 * count / TABLE:.0f} %" for count in held]
    return [*percentages, str(wrong), str(warned), str(silent), f"{100 * numpy.expm1(numpy.median(width)):.0f} %"]


def _is_remark(note: str) -> bool:
    words = ("uncertainties from the result", "data scatter", "half its band", "as wide as the stated", "identifiable")
    return any(word in note for word in words)


def _bands() -> Rows:
    rows = Rows("200 sets without an error: share of the bands of 95 % that hold the truth", ("data", "c", "E", "ν"))
    for title, alone, free in (
        ("indentations, half angles, pressures; three unknowns", False, {**FREE, **POISSON}),
        ("indentations alone; two unknowns", True, FREE),
    ):
        held = dict.fromkeys(free, 0)
        for seed in range(200):
            random = numpy.random.default_rng(9000 + seed)
            data = [_indentations(random, Case("")), *([] if alone else half_angles_and_pressures(random))]
            fit = _identified(data, free)
            held = {name: count + _holds(fit, name) for name, count in held.items()}
        rows.add(title, *(f"{held[name] / 2:.1f} %" if name in held else "known" for name in VALUES))
    return rows
