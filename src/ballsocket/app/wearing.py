"""Years of a hip for a page: what its process makes of a design or of two, as plain numbers."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy

from ..elasticity.off_axis.grid import Grid
from ..files.joint_file import JointFile
from ..hip import HipSimulation, History, PatientVariability, population
from ..hip.cycle_registry import CYCLES
from ..output.hip_plots import penetration_curve
from ..output.html import drawn
from ..problem.cup import Cup
from ..studies.distributions import LogNormal
from .in_use import Use, hip_of
from .running import Reached, Told

LONGEST = 300.0
"""Seconds that a run of wear may take."""

_LOOKS = 10
_PATIENTS = 64


@dataclass(frozen=True, kw_only=True, eq=False)
class Worn:
    """A design after millions of cycles; courses begin with none.

    Attributes
    ----------
    cycles, penetration, deepest, volume : array (looks,)
        In millions, mm, mm, mm³.
    low, high : array (looks,)
        Ends of the band of penetration in mm, from the uncertain coefficient or from the error of the run.
    band : str
        What it is of, in words.
    depth : array (rings, meridians)
        Worn away at the end, in mm.
    grid : Grid
        The cells of that.
    cup : Cup
        As the cycle finds it.
    load : array (3,)
        Where the largest load points, in the cup's frame.
    summary : dict
        Of `History`, for JSON.
    notes : tuple of str
    figure : bytes
        The penetration, as PNG.
    """

    cycles: numpy.ndarray
    penetration: numpy.ndarray
    deepest: numpy.ndarray
    volume: numpy.ndarray
    low: numpy.ndarray
    high: numpy.ndarray
    band: str
    depth: numpy.ndarray
    grid: Grid
    cup: Cup
    load: numpy.ndarray
    summary: dict[str, Any]
    notes: tuple[str, ...]
    figure: bytes


def life_of(file: JointFile, use: Use) -> Hashable:
    """What the years of a design depend on."""
    weight = use.body_weight if CYCLES[use.cycle].per_body_weight else 0.0
    numbers = tuple((name, use.law_number(name)) for name in use.used_inputs)
    plain = replace(use, instant=None, law_numbers=numbers)
    return file.joint, file.cup, file.cup.oriented, replace(plain, body_weight=weight or 1.0)


def worn(files: Sequence[JointFile], use: Use, told: Told) -> list[Worn]:
    """In a process: the years of each design, one after the other.

    Raises
    ------
    ValueError
        There is no such hip, and why.
    """
    found = []
    for number, file in enumerate(files):
        start, whole = number / len(files), 1.0 / len(files)
        of = f" of design {number + 1}" if len(files) > 1 else ""

        def reached(share: float, words: str, start: float = start, whole: float = whole, of: str = of) -> None:
            told(Reached(share=start + whole * share, words=f"{words}{of}"))

        reached(0.02, "setting up the bore")
        found.append(_life(hip_of(file, use), use, reached))
    return found


def _life(hip: HipSimulation, use: Use, reached: Any) -> Worn:
    cycles = 1e6 * use.millions
    looks = [share * cycles / _LOOKS for share in range(1, _LOOKS + 1)]
    history = hip.after(
        cycles, looks, lambda done: reached(0.05 + 0.65 * done / cycles, f"{done / 1e6:.3g} million cycles")
    )
    bands = None
    if use.spread > 1 and use.coefficient > 0 and use.coefficient_field is not None:
        reached(0.72, "the band of the wear coefficient")
        wear = {"coefficient": LogNormal(median=use.coefficient, factor=use.spread)}
        counts = [report.cycles for report in history.reports]
        _, bands = population(PatientVariability(use=hip, distributions=wear), counts, patients=_PATIENTS)
    reached(0.95, "drawing")
    return _plain(hip, history, bands)


def _plain(hip: HipSimulation, history: History, bands: Any) -> Worn:
    reports = history.reports
    courses = {
        name: numpy.array([0.0, *(getattr(report, name) for report in reports)])
        for name in ("penetration", "depth", "volume")
    }
    whole = courses["penetration"]
    if bands is None:
        low, high = (whole * (1 + sign * history.error.depth) for sign in (-1, 1))
        band = f"band: what the run may be off by, {100 * history.error.depth:.2g} %"
    else:
        low, high = (numpy.array([0.0, *ends]) for ends in bands.band("penetration"))
        share = f"{100 * bands.level:g} % of the predictions for {bands.n_patients} patients"
        band = f"band: {share}, for a wear coefficient known within a factor"
    largest = hip.loads[hip.largest_load_index[0]]
    return Worn(
        cycles=numpy.array([0.0, *(report.cycles / 1e6 for report in reports)]),
        penetration=whole,
        deepest=courses["depth"],
        volume=courses["volume"],
        low=low,
        high=high,
        band=band,
        depth=history.last.wear,
        grid=hip.grid,
        cup=hip.placed,
        load=largest / numpy.linalg.norm(largest),
        summary=history.summary(),
        notes=history.notes,
        figure=drawn(penetration_curve(history, bands)),
    )
