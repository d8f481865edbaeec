"""Wear simulation of a hip joint: joint, cup, cycle and laws, run to the requested cycle counts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from pathlib import Path

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.deprecation import RenamedAttribute, renamed_arguments, renamed_names
from .ball_wear import map_counterface
from .checkpoint import Checkpoint, checkpoint
from .film import Lubricant
from .hip_setup import MIN_RING_WIDTH, HipSetup
from .history import History, NumericalError, Report
from .socket_foundation import CycleEquilibrium
from .wear_integrator import WearIntegrator

_MAX_WORN_LINERS = 10.0
"""Largest wear by the rate of the first cycle, in liner thicknesses."""


@dataclass(frozen=True, kw_only=True, eq=False)
class HipSimulation(HipSetup):
    """Wear simulation of a hip joint.

    Parameters
    ----------
    joint : Joint
        Joint of single numbers.
    cycle : Cycle or Mix
        Loads and rotations in the body's frame, as the cup's orientation is. On a left cup it is mirrored.
    wear : WearLaw
        `Archard`, `ContactAreaWear`, `CrossShear`, `FrictionEnergyWear` or `CustomWearLaw`.
    cup : Cup
        Arc of cover and orientation. A cup without a given orientation takes the tilt of the cycle's standard.
    surface : Springs, ClosedShell or RealCup
        Foundation of the socket; the paper's springs by default.
    ring_width : float
        Width of the rings of the wear map in rad, 3° by default.
    ball_wear : WearLaw, optional
        Wear law of the ball, for hard surfaces that both wear; no wear of the ball by default.
    creep : CreepLaw, optional
        Creep law of the liner; no creep by default.
    seconds_per_cycle : float, optional
        Time in s that a cycle stands for in the creep of the liner; the duration of the cycle by default.
    tolerance : float
        Allowed error of a block of cycles, relative to the largest depth so far. Default 4e-3.

    Raises
    ------
    ValueError
        A load that pushes the ball over the rim, with its instant; a number that is not allowed.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.hip import Archard, HipSimulation, iso_14242_1
    >>> joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    >>> simulation = HipSimulation(joint=joint, cycle=iso_14242_1(), wear=Archard(coefficient=1e-6))
    >>> round(simulation.first.volume, 1)
    30.1
    """

    halved = RenamedAttribute("discretization_error")

    @renamed_arguments(listen="progress")
    def after(
        self,
        cycles: float,
        report_at: Sequence[float] = (),
        progress: Callable[[float], None] = lambda cycles: None,
        lubricant: Lubricant = Lubricant(),  # noqa: B008 (frozen)
        store: Path | None = None,
    ) -> History:
        """Simulate wear and creep up to a number of cycles.

        Parameters
        ----------
        cycles : float
        report_at : sequence of float
            Cycle counts of the reports; the last report is always at `cycles`.
        progress : function
            Called with the number of cycles so far after each block.
        lubricant : Lubricant
            Lubricant for the film in the summary.
        store : Path, optional
            Folder that stores the run after each block: a stopped run resumes from there.

        Raises
        ------
        ValueError
            Numbers of cycles that are not allowed or would wear the liner through many times; a store with another
            run.
        """
        counts = check_cycles(cycles, report_at)
        check_total_wear(self, cycles)
        stored, (volume, depth) = None if store is None else checkpoint(self, store), self.discretization_error
        integrator = WearIntegrator(setup=self)
        reports = run_to_report_points(integrator, counts, progress, stored)
        blocks = integrator.relative_volume_error
        error = NumericalError(blocks=blocks, volume=blocks + volume, depth=blocks + depth)
        return History(use=self, reports=reports, error=error, steps=integrator.steps, lubricant=lubricant)

    @cached_property
    def discretization_error(self) -> tuple[float, float]:
        """Relative errors of volume and depth of the first cycle, estimated with half the time steps and ring widths.

        The absolute differences are added and multiplied by 1.55, which holds for errors of order 1.5 or more.
        Rings are not narrower than 0.5°.
        """
        finer_steps = replace(self, cycle=self.cycle.finer())
        finer_rings = replace(finer_steps, ring_width=max(self.ring_width / 2, MIN_RING_WIDTH))
        firsts = (self.first, finer_steps.first, finer_rings.first)
        return _halving_error([first.volume for first in firsts]), _halving_error([first.depth for first in firsts])


_ERROR_RATIO = 1 / (1 - 2**-1.5)
"""Ratio of the error to the difference from half the step: 1 / (1 - 2^-p) for errors of order p = 1.5.

The order is 2 for a moving load. With wear by contact area and a stationary load it can be 1.6: halved rings divide
the error by 3.
"""


def _halving_error(values: list[float]) -> float:
    """Estimate the relative error of a value from three results: given steps, half steps, and half steps and rings."""
    value, finer_steps, finer_rings = values
    if not finer_rings:
        return 0.0
    return _ERROR_RATIO * (abs(value - finer_steps) + abs(finer_steps - finer_rings)) / abs(finer_rings)


def check_cycles(cycles: float, report_at: Sequence[float]) -> list[float]:
    """Return the cycle counts of all reports in order, with the total count as the last one.

    Raises
    ------
    ValueError
        A total count that is not positive and finite, or a report beyond it.
    """
    require("cycles", cycles, 0 < cycles < inf, "a number of cycles is positive and finite")
    for count in report_at:
        require("report_at", count, 0 <= count <= cycles, f"it lies between 0 and the {cycles:g} cycles of the run")
    return sorted({float(count) for count in (*report_at, cycles)})


def check_total_wear(setup: HipSetup, cycles: float) -> None:
    """Raise ValueError for cycles that would wear away more than ten liner thicknesses at the initial wear rate.

    Raises
    ------
    ValueError
        The extrapolated wear of the first cycle exceeds ten liner thicknesses.
    """
    exposure = setup.exposure(setup.unworn)
    thickness = float(min(setup.joint.liner_thickness, setup.joint.socket_radius))
    laws = (law for law in (setup.wear, setup.ball_wear) if law is not None)
    worn = cycles * max(float(law.depth(exposure).max(initial=0.0)) for law in laws)
    if not worn <= _MAX_WORN_LINERS * thickness:
        raise ValueError(
            f"{cycles:g} cycles at the rate of the first one would wear {worn:.3g} mm away, more than "
            f"{_MAX_WORN_LINERS:g} times the {thickness:g} mm of the liner: reduce the wear coefficient or the cycles"
        )


def run_to_report_points(
    integrator: WearIntegrator, counts: Sequence[float], progress: Callable[[float], None], stored: Checkpoint | None
) -> tuple[Report, ...]:
    """Run a simulation to the requested cycle counts, resuming from a checkpoint."""
    reports: tuple[Report, ...] = ()
    checkpointed = stored.read() if stored else None
    if checkpointed is not None:
        state, reports = checkpointed
        integrator.resume(state)
        reports = tuple(report for report in reports if report.cycles in counts)
    reported = {report.cycles for report in reports}
    for count in counts:
        if count in reported:
            continue
        if count < integrator.cycles:
            raise ValueError(
                f"the store has reached {integrator.cycles:g} cycles without a report at {count:g}; give another folder"
            )

        def store_block(cycles: float) -> None:
            """Store the state after a block, and report the progress."""
            if stored is not None and cycles < count:  # noqa: B023 (called before the next)
                stored.write(integrator.state, reports)  # noqa: B023
            progress(cycles)

        reports = (*reports, make_report(integrator.run_until(count, store_block)))
        if stored is not None:
            stored.write(integrator.state, reports)
    return reports


def make_report(integrator: WearIntegrator) -> Report:
    """Report the state of a simulation."""
    setup, creep_depth, shape = integrator.setup, integrator.creep_depth, (integrator.setup.grid.rings, -1)
    depth = integrator.depth + creep_depth
    if setup.ball_wear is not None:
        counterface = map_counterface(setup, numpy.arange(len(depth)))
        depth = depth + counterface.on_socket.interpolate(integrator.ball[None])
    combined = setup.solve_equilibrium(depth, integrator.equilibrium)
    worn = combined if setup.creep is None else _solve_or_unworn(setup, integrator.depth)
    states = (combined, worn, _solve_or_unworn(setup, creep_depth))
    displacements = [(state.displacement - setup.unworn.displacement)[setup.largest].sum(axis=0) for state in states]
    edge = setup.edge(combined, depth)
    return Report(
        cycles=integrator.cycles,
        wear=integrator.depth.reshape(shape),
        volume=integrator.volume,
        depth=float(integrator.depth.max()),
        work=integrator.work,
        displacement=displacements[0],
        wear_displacement=displacements[1],
        creep_displacement=displacements[2],
        max_pressure=float(combined.pressure.max(initial=0.0)),
        edge_distance=edge.distance,
        edge_place=edge.azimuth,
        edge_pressure=edge.pressure,
        crept=creep_depth.reshape(shape),
        creep_depth=float(creep_depth.max()),
        ball_wear=integrator.ball,
        ball_volume=integrator.ball_volume,
        ball_depth=float(integrator.ball.max(initial=0.0)),
        worst_contacts=setup.worst_contacts(combined, depth),
        converged=integrator.converged and all(state.converged for state in states),
    )


def _solve_or_unworn(setup: HipSetup, depth: Numbers) -> CycleEquilibrium:
    """Solve the contacts on a worn bore, or return those of the unworn bore for zero depth."""
    return setup.solve_equilibrium(depth) if depth.any() else setup.unworn


__getattr__ = renamed_names(__name__, {"InUse": "HipSimulation"})
