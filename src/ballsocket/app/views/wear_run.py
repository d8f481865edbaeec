"""Wear of a hip, computed in a separate process as plain data."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy

from ...contact.verdict import EDGE_DISTANCE, Bounded, exact_number
from ...elasticity.off_axis.grid import Grid
from ...files.joint_file import JointFile
from ...hip import HipSimulation, History, PatientVariability, population
from ...hip.cycle_registry import CYCLES
from ...problem.cup import Cup
from ...reports.check_table import Check, sorted_checks, wear_check
from ...reports.figure_files import figure_bytes
from ...reports.hip_plots import penetration_curve
from ...studies.distributions import LogNormal
from ..results import without_name
from ..running import Reached, Report
from ..state.use import Use, hip_of
from .gait_cycle import checks_in_use

WEAR_SECONDS = 300.0  # seconds that a run of wear may take
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
    checks: tuple[Check, ...]  # of the worn bore


def wear_key(file: JointFile, use: Use) -> Hashable:
    """Return a key of the inputs of a wear result."""
    weight = use.body_weight if CYCLES[use.cycle].per_body_weight else 0.0
    numbers = tuple((name, use.law_number(name)) for name in use.used_inputs)
    plain = replace(use, instant=None, law_numbers=numbers)
    return without_name(file.joint), file.cup, file.cup.oriented, replace(plain, body_weight=weight or 1.0)


def simulate_designs(
    files: Mapping[Hashable, JointFile], use: Use, known: Mapping[Hashable, WearResult], report: Report
) -> dict[Hashable, WearResult]:
    """Simulate the wear of each design that is not known, by the key of its inputs, in a separate process."""
    results = dict(known)
    missing = {key: file for key, file in files.items() if key not in known}
    for number, (key, file) in enumerate(missing.items()):
        start, fraction = number / len(missing), 1.0 / len(missing)
        of = f" of design {number + 1}" if len(missing) > 1 else ""

        def reached(share: float, words: str, start: float = start, fraction: float = fraction, of: str = of) -> None:
            report(Reached(share=start + fraction * share, words=f"{words}{of}"))

        reached(0.02, "Preparing the bore")
        results[key] = _simulate_design(hip_of(file, use), use, reached)
    return {key: results[key] for key in files}


def _simulate_design(hip: HipSimulation, use: Use, reached: Callable[[float, str], None]) -> WearResult:
    cycles = 1e6 * use.millions
    report_cycles = [share * cycles / _REPORTS for share in range(1, _REPORTS + 1)]
    history = hip.after(
        cycles, report_cycles, lambda count: reached(0.05 + 0.65 * count / cycles, f"{count / 1e6:.3g} million cycles")
    )
    bands: Any = None
    if use.spread > 1 and use.coefficient > 0 and use.coefficient_field is not None:
        reached(0.72, "the band of the wear coefficient")
        wear = {"coefficient": LogNormal(median=use.coefficient, factor=use.spread)}
        counts = [report.cycles for report in history.reports]
        _, bands = population(PatientVariability(use=hip, distributions=wear), counts, patients=_PATIENTS)
    reached(0.95, "drawing")
    reports = history.reports
    penetration, deepest, volume = (
        numpy.array([0.0, *(getattr(report, name) for report in reports)])
        for name in ("penetration", "depth", "volume")
    )
    if bands is None:
        low, high = (penetration * (1 + sign * history.error.depth) for sign in (-1, 1))
        band = f"band: numerical error of the run, {100 * history.error.depth:.2g} %"
    else:
        low, high = (numpy.array([0.0, *ends]) for ends in bands.band("penetration"))
        share = f"{100 * bands.level:g} % of the predictions for {bands.n_patients} patients"
        band = f"band: {share}, for the scatter of the wear coefficient"
    largest = hip.frame.loads[hip.frame.largest_load_index[0]]
    return WearResult(
        cycles=numpy.array([0.0, *(report.cycles / 1e6 for report in reports)]),
        penetration=penetration,
        deepest=deepest,
        volume=volume,
        low=low,
        high=high,
        band=band,
        depth=history.last.wear,
        grid=hip.grid,
        cup=hip.frame.placed,
        load=largest / numpy.linalg.norm(largest),
        summary=history.summary(),
        notes=history.notes,
        figure=figure_bytes(penetration_curve(history, bands)),
        checks=_checks(hip, history),
    )


def _checks(hip: HipSimulation, history: History) -> tuple[Check, ...]:
    last = history.last
    worn = worn_rim_rows(hip, last.edge_distance, last.edge_loaded)
    rows = [*checks_in_use(hip, history.contact_checks[-1], last.edge_distance[: 0 if worn else None]), *worn]
    depth = Bounded(*(float(last.depth) * (1 + sign * history.error.depth) for sign in (0, -1, 1)))
    return sorted_checks([*rows, wear_check(hip.joint, depth)])


def worn_rim_rows(hip: HipSimulation, distances: numpy.ndarray, edge_loaded: numpy.ndarray) -> list[Check]:
    """Return the row of a bore that is worn to its rim without edge loading, which has no limit; else no row."""
    if edge_loaded.any() or not (distances <= 0).any():
        return []
    check = Check(
        title="reach of the contact",
        quantity=EDGE_DISTANCE,
        demand=exact_number(hip.frame.reach * float(hip.joint.socket_radius)),
        capacity=None,
        limit="arc from pole to rim",
        source="worn to the rim, which is not edge loading: see the notes",
    )
    return [check]
