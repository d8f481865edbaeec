"""Gait cycle of a hip, computed in a separate process as plain data."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy

from ....elasticity.off_axis.directions import unit_vectors
from ....files.joint_file import JointFile
from ....hip import Lubricant
from ....hip.ball_wear import interpolation_at
from ....hip.contact_checks import largest_utilisation, list_check_notes
from ....hip.cycle_registry import CYCLES
from ...running import Reached, Report
from ...state.use import UploadedCycle, Use, hip_of

RINGS, MERIDIANS = 24, 60
"""Cells of the bore that moves on the page."""

_LEVELS = 255


@dataclass(frozen=True, kw_only=True, eq=False)
class GaitResult:
    """Courses over the instants of a cycle on an unworn bore, NaN in unloaded instants."""

    name: str
    phase: numpy.ndarray  # % of the cycle
    force: numpy.ndarray  # N
    pressure: numpy.ndarray  # MPa
    film: numpy.ndarray  # nm
    edge: numpy.ndarray  # mm from the edge of the contact to the rim
    load: numpy.ndarray  # (instants, 3), unit vectors in the cup's frame; 0 without load
    cells: bytes  # relative pressures of the moving bore's cells in each instant, 0 to 255
    polar: numpy.ndarray  # edges of its rings in rad
    worst: str  # instant and direction of the smallest edge distance
    regime: str  # lubrication regime
    utilisation: float | None  # von Mises stress over yield stress; None without a yield stress
    valid: bool
    numbers: dict[str, Any]  # for JSON
    notes: tuple[str, ...]

    @property
    def heaviest(self) -> int:
        """Instant of the largest force."""
        return int(self.force.argmax())


def gait_key(file: JointFile, use: Use, upload: UploadedCycle | None) -> Hashable:
    """Return a key of the inputs of a gait result."""
    weight = use.body_weight if upload is not None or CYCLES[use.cycle].per_body_weight else None
    return file.joint, file.cup, file.cup.oriented, weight, use.contact, upload or use.cycle


def simulate_gait(file: JointFile, use: Use, upload: UploadedCycle | None, report: Report) -> GaitResult:
    """Compute the courses over a cycle, in a separate process; raise ValueError for an invalid hip."""
    report(Reached(share=0.1, words="setting up the bore"))
    hip = hip_of(file, use, upload)
    report(Reached(share=0.3, words="pressing through the cycle"))
    unworn, lubricant = hip.unworn, Lubricant()
    report(Reached(share=0.7, words="film and edge"))
    lubrication, edge = hip.film(lubricant), hip.edge(unworn)
    worst, first = edge.closest_approach(hip), hip.first
    checks = hip.unworn_checks
    utilisation, valid = largest_utilisation(checks), all(check.valid for check in checks)
    polar = numpy.linspace(0.0, hip.reach, RINGS + 1)
    sizes = hip.cycle.force_magnitudes

    def course(values: numpy.ndarray) -> numpy.ndarray:
        series = numpy.full(hip.cycle.n_steps, numpy.nan)
        series[hip.loaded] = values
        return series

    return GaitResult(
        name=hip.cycle.name,
        phase=100 * hip.cycle.phases,
        force=sizes,
        pressure=course(unworn.pressure.max(axis=1, initial=0.0)),
        film=course(1e6 * lubrication.least),
        edge=course(edge.distance),
        load=numpy.divide(hip.forces, sizes[:, None], out=numpy.zeros_like(hip.forces), where=sizes[:, None] > 0),
        cells=_cells(hip, polar),
        polar=polar,
        worst="nothing is pressed" if worst is None else worst.location,
        regime=lubrication.regime,
        utilisation=utilisation,
        valid=valid,
        numbers={
            "valid": valid,
            "utilisation": utilisation,
            "slide_mm": first.slide,
            **lubrication.summary(),
            "edge": None if worst is None else worst.summary(),
        },
        notes=(*hip.notes, *list_check_notes([("in the first cycle", checks)])),
    )


def _cells(hip: Any, polar: numpy.ndarray) -> bytes:
    """Compute relative cell pressures (0 to 255) of the moving bore in each instant."""
    azimuth = 2 * pi * (numpy.arange(MERIDIANS) + 0.5) / MERIDIANS
    middles = unit_vectors(((polar[1:] + polar[:-1]) / 2)[:, None], azimuth)
    interpolation = interpolation_at(hip.grid, numpy.asarray(middles).reshape(3, 1, -1))
    pressure = hip.unworn.pressure
    largest = float(pressure.max(initial=0.0)) or 1.0
    frames = numpy.zeros((hip.cycle.n_steps, RINGS * MERIDIANS), dtype=numpy.uint8)
    for instant, field in zip(hip.loaded, pressure, strict=True):
        frames[instant] = numpy.rint(_LEVELS * interpolation.interpolate(field[None])[0] / largest)
    return frames.tobytes()
