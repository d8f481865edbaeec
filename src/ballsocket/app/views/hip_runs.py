"""Gait cycle and wear of a hip, computed in separate processes as plain data."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy

from ...contact.verdict import EDGE_DISTANCE, Bounded, exact_number
from ...core.answers import Check
from ...core.display import counted
from ...core.unit_systems import Units
from ...design_checks import checks_at, sorted_checks, wear_check
from ...elasticity.off_axis.grid import Grid
from ...files.joint_file import JointFile
from ...hip import HipSimulation, History, Lubricant, PatientVariability, population
from ...hip.ball_wear import interpolation_at
from ...hip.contact_checks import ContactCheck, largest_utilisation, list_check_notes
from ...hip.cycle_registry import CYCLES
from ...problem.cup import Cup
from ...reports.hip_plots import penetration_curve
from ...reports.style import bytes_by_units
from ...studies.distributions import LogNormal
from ..pictures.bore import node_directions, relative_bytes
from ..results import without_name
from ..running import Reached, Report
from ..state.use import UploadedCycle, Use, hip_of

RINGS, MERIDIANS = 30, 90  # rings and meridians of the field that moves on the page
_INSIDE = 0.5  # share of the neighbouring cells with a value, from which a node has one


@dataclass(frozen=True, kw_only=True, eq=False)
class Frames:
    """Field on the bore in each instant: relative values 0 to 255 at the nodes of the moving bore."""

    cells: numpy.ndarray  # (instants, RINGS + 1, MERIDIANS)
    highest: float  # value of 255


@dataclass(frozen=True, kw_only=True, eq=False)
class GaitResult:
    """Courses over the instants of a cycle on an unworn bore, NaN in unloaded instants."""

    name: str
    phase: numpy.ndarray  # % of the cycle
    force: numpy.ndarray  # N
    pressure: numpy.ndarray  # MPa
    edge: numpy.ndarray  # mm from the edge of the contact to the rim
    load: numpy.ndarray  # (instants, 3), unit vectors in the cup's frame; 0 without load
    frames: Frames  # pressure
    reach: float  # angle of the bore's rim in rad
    worst: str  # instant and direction of the smallest edge distance
    valid: bool
    checks: tuple[Check, ...]
    numbers: dict[str, Any]  # for JSON
    notes: tuple[str, ...]

    @property
    def heaviest(self) -> int:
        """Instant of the largest force."""
        return int(self.force.argmax())

    @property
    def rim(self) -> numpy.ndarray:
        """Instants in which the contact reaches the rim."""
        return numpy.asarray(self.edge <= 0)


@dataclass(frozen=True, kw_only=True, eq=False)
class GaitFilm:
    """Film over the instants of a cycle by the wave method, NaN in unloaded instants."""

    least: numpy.ndarray  # nm
    central: numpy.ndarray  # nm
    ratio: numpy.ndarray  # film ratio λ
    frames: Frames  # thickness in nm; 0 outside the contact
    regime: str
    valid: bool
    note: str
    figures: dict[Units, bytes]  # film over the cycle and maps of it as PNG
    numbers: dict[str, Any]  # for JSON


def gait_key(file: JointFile, use: Use, upload: UploadedCycle | None) -> Hashable:
    """Return a key of the inputs of a gait result."""
    weight = use.body_weight if upload is not None or CYCLES[use.cycle].per_body_weight else None
    return without_name(file.joint), file.cup, file.cup.oriented, weight, use.contact, upload or use.table or use.cycle


def simulate_gait(file: JointFile, use: Use, upload: UploadedCycle | None, report: Report) -> GaitResult:
    """Compute the courses over a cycle, in a separate process; raise ValueError for an invalid hip."""
    report(Reached(share=0.1, words="preparing the bore"))
    hip = hip_of(file, use, upload)
    report(Reached(share=0.3, words="computing the contact at each instant"))
    unworn = hip.unworn
    report(Reached(share=0.7, words="distance to the rim"))
    edge = hip.edge(unworn)
    worst, first, checks = edge.closest_approach(hip.frame), hip.first, hip.unworn_checks
    valid = all(check.valid for check in checks)
    sizes = hip.cycle.force_magnitudes
    forces = hip.frame.forces
    return GaitResult(
        name=hip.cycle.name,
        phase=100 * hip.cycle.phases,
        force=sizes,
        pressure=_course(hip, unworn.pressure.max(axis=1, initial=0.0)),
        edge=_course(hip, edge.distance),
        load=numpy.divide(forces, sizes[:, None], out=numpy.zeros_like(forces), where=sizes[:, None] > 0),
        frames=_frames(hip, unworn.pressure, float(unworn.pressure.max(initial=0.0))),
        reach=hip.frame.reach,
        worst="no contact in this cycle" if worst is None else worst.location,
        valid=valid,
        checks=checks_in_use(hip, checks, edge.distance),
        numbers={
            "valid": valid,
            "utilisation": largest_utilisation(checks),
            "slide_mm": first.slide,
            "edge": None if worst is None else worst.summary(),
        },
        notes=(*hip.notes, *list_check_notes([("in the first cycle", checks)])),
    )


def checks_in_use(hip: HipSimulation, contacts: Sequence[ContactCheck], distances: numpy.ndarray) -> tuple[Check, ...]:
    """List the checks of the worst contact of a cycle, and of the smallest of its edge distances (mm)."""
    if not contacts:
        return ()
    worst = max(contacts, key=lambda check: check.max_pressure)
    return checks_at(
        hip.joint,
        pressure=worst.pressure,
        von_mises=worst.von_mises,
        edge=(hip.frame.reach, exact_number(float(distances.min()))) if len(distances) else None,
        trusted=all(check.valid for check in contacts),
    )


def simulate_film(file: JointFile, use: Use, upload: UploadedCycle | None, report: Report) -> GaitFilm:
    """Compute the film over a cycle by the wave method, in a separate process."""
    report(Reached(share=0.1, words="computing the contact at each instant"))
    hip = hip_of(file, use, upload)
    report(Reached(share=0.2, words="computing the film over cycles until it repeats"))
    film = hip.film(Lubricant(), method="wave")
    thickness = numpy.full(hip.unworn.pressure.shape, numpy.nan) if film.thickness is None else 1e6 * film.thickness
    known = thickness[numpy.isfinite(thickness)]
    return GaitFilm(
        least=_course(hip, 1e6 * film.least),
        central=_course(hip, 1e6 * film.central),
        ratio=_course(hip, film.ratio),
        frames=_frames(hip, thickness, float(numpy.percentile(known, _SHOWN_SHARE)) if len(known) else 0.0),
        regime=film.regime,
        valid=film.valid,
        note=film.note,
        figures=bytes_by_units(film.plot()),
        numbers=film.summary(),
    )


_SHOWN_SHARE = 95.0
"""Percentage of the film below the end of its colour scale: at the edges of the contact it is far thicker."""


def _course(hip: HipSimulation, values: numpy.ndarray) -> numpy.ndarray:
    """Return values of the loaded instants over all instants, NaN in the others."""
    series = numpy.full(hip.cycle.n_steps, numpy.nan)
    series[hip.frame.loaded] = values
    return series


def _frames(hip: HipSimulation, fields: numpy.ndarray, highest: float) -> Frames:
    """Interpolate fields (loaded, cells) to the moving bore; NaN cells are outside, and 0."""
    nodes = node_directions(hip.frame.reach, RINGS, MERIDIANS).reshape(3, 1, -1)
    interpolation = interpolation_at(hip.grid, nodes)
    cells = numpy.zeros((hip.cycle.n_steps, RINGS + 1, MERIDIANS), dtype=numpy.uint8)
    inside = numpy.isfinite(fields)
    for instant, field, known in zip(
        hip.frame.loaded, numpy.where(inside, fields, 0.0), inside.astype(float), strict=True
    ):
        share = interpolation.interpolate(known[None])[0]
        values = interpolation.interpolate(field[None])[0] / numpy.where(share > 0, share, 1.0)
        scaled = numpy.where(share >= _INSIDE, relative_bytes(values, highest), 0)
        cells[instant] = scaled.reshape(RINGS + 1, MERIDIANS)
    return Frames(cells=cells, highest=highest)


WEAR_SECONDS = 300.0  # processor time in s of a run of wear
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
    figures: dict[Units, bytes]  # penetration as PNG
    checks: tuple[Check, ...]  # of the worn bore


def wear_key(file: JointFile, use: Use) -> Hashable:
    """Return a key of the inputs of a wear result."""
    weight = use.body_weight if CYCLES[use.cycle].per_body_weight else 0.0
    numbers = tuple((name, use.law_number(name)) for name in use.used_inputs)
    plain = replace(use, instant=None, law_numbers=numbers, table="")
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
        share = f"{100 * bands.level:g} % of the predictions for {counted(bands.n_patients, 'patient')}"
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
        figures=bytes_by_units(penetration_curve(history, bands)),
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
