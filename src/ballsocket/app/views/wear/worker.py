"""Wear of a hip, computed in a separate process as plain data."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy

from ....elasticity.off_axis.grid import Grid
from ....files.joint_file import JointFile
from ....hip import HipSimulation, History, PatientVariability, population
from ....hip.cycle_registry import CYCLES
from ....problem.cup import Cup
from ....reports.figure_files import figure_bytes
from ....reports.hip_plots import penetration_curve
from ....studies.distributions import LogNormal
from ...running import Reached, Report
from ...state.use import Use, hip_of

WEAR_SECONDS = 300.0
"""Seconds that a run of wear may take."""

_REPORTS = 10
_PATIENTS = 64


@dataclass(frozen=True, kw_only=True, eq=False)
class WearResult:
    """Design after millions of cycles; courses (reports,) begin at zero cycles."""

    cycles: numpy.ndarray  # millions
    penetration: numpy.ndarray  # mm
    deepest: numpy.ndarray  # mm
    volume: numpy.ndarray  # mm³
    low: numpy.ndarray  # mm, band of the penetration from the coefficient's scatter or the numerical error
    high: numpy.ndarray
    band: str  # description of the band
    depth: numpy.ndarray  # mm, final wear of the cells (rings, meridians)
    grid: Grid
    cup: Cup  # in the frame of the cycle
    load: numpy.ndarray  # (3,), direction of the largest load in the cup's frame
    summary: dict[str, Any]  # of `History`, for JSON
    notes: tuple[str, ...]
    figure: bytes  # penetration as PNG


def wear_key(file: JointFile, use: Use) -> Hashable:
    """Return a key of the inputs of a wear result."""
    weight = use.body_weight if CYCLES[use.cycle].per_body_weight else 0.0
    numbers = tuple((name, use.law_number(name)) for name in use.used_inputs)
    plain = replace(use, instant=None, law_numbers=numbers)
    return file.joint, file.cup, file.cup.oriented, replace(plain, body_weight=weight or 1.0)


def simulate_wear(files: Sequence[JointFile], use: Use, report: Report) -> list[WearResult]:
    """Simulate the wear of each design in turn, in a separate process."""
    results = []
    for number, file in enumerate(files):
        start, fraction = number / len(files), 1.0 / len(files)
        of = f" of design {number + 1}" if len(files) > 1 else ""

        def reached(share: float, words: str, start: float = start, fraction: float = fraction, of: str = of) -> None:
            report(Reached(share=start + fraction * share, words=f"{words}{of}"))

        reached(0.02, "setting up the bore")
        results.append(_simulate_design(hip_of(file, use), use, reached))
    return results


def _simulate_design(hip: HipSimulation, use: Use, reached: Any) -> WearResult:
    cycles = 1e6 * use.millions
    report_cycles = [share * cycles / _REPORTS for share in range(1, _REPORTS + 1)]
    history = hip.after(
        cycles, report_cycles, lambda count: reached(0.05 + 0.65 * count / cycles, f"{count / 1e6:.3g} million cycles")
    )
    bands = None
    if use.spread > 1 and use.coefficient > 0 and use.coefficient_field is not None:
        reached(0.72, "the band of the wear coefficient")
        wear = {"coefficient": LogNormal(median=use.coefficient, factor=use.spread)}
        counts = [report.cycles for report in history.reports]
        _, bands = population(PatientVariability(use=hip, distributions=wear), counts, patients=_PATIENTS)
    reached(0.95, "drawing")
    return _wear_result(hip, history, bands)


def _wear_result(hip: HipSimulation, history: History, bands: Any) -> WearResult:
    reports = history.reports
    courses = {
        name: numpy.array([0.0, *(getattr(report, name) for report in reports)])
        for name in ("penetration", "depth", "volume")
    }
    penetration = courses["penetration"]
    if bands is None:
        low, high = (penetration * (1 + sign * history.error.depth) for sign in (-1, 1))
        band = f"band: what the run may be off by, {100 * history.error.depth:.2g} %"
    else:
        low, high = (numpy.array([0.0, *ends]) for ends in bands.band("penetration"))
        share = f"{100 * bands.level:g} % of the predictions for {bands.n_patients} patients"
        band = f"band: {share}, for a wear coefficient known within a factor"
    largest = hip.loads[hip.largest_load_index[0]]
    return WearResult(
        cycles=numpy.array([0.0, *(report.cycles / 1e6 for report in reports)]),
        penetration=penetration,
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
        figure=figure_bytes(penetration_curve(history, bands)),
    )
