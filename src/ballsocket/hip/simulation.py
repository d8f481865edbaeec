"""Wear simulation of a hip joint: joint, cup, cycle and laws, run to the requested cycle counts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from pathlib import Path

from ..core.checks import require
from ..core.deprecation import RenamedAttribute, renamed_arguments, renamed_names
from .film import Lubricant
from .hip_setup import MIN_RING_WIDTH, HipSetup
from .history import History, NumericalError
from .report_points import check_total_wear, make_checkpoint, run_to_report_points
from .wear_integrator import WearIntegrator


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
        stored, (volume, depth) = None if store is None else make_checkpoint(self, store), self.discretization_error
        integrator = WearIntegrator(setup=self)
        reports = run_to_report_points(integrator, counts, progress, stored)
        blocks = integrator.relative_volume_error
        error = NumericalError(blocks=blocks, volume=blocks + volume, depth=blocks + depth)
        return History(use=self, reports=reports, error=error, steps=integrator.steps, lubricant=lubricant)

    @cached_property
    def discretization_error(self) -> tuple[float, float]:
        """Estimated relative errors of volume and depth by time steps and rings, in the first cycle.

        The absolute differences are added and multiplied by 1.55, which holds for errors of order 1.5 or more.
        Rings are not narrower than 0.5°.
        """
        finer_steps = replace(self, cycle=self.cycle.finer())
        finer_rings = replace(finer_steps, ring_width=max(self.ring_width / 2, MIN_RING_WIDTH))
        first_cycles = (self.first, finer_steps.first, finer_rings.first)
        return _relative_discretization_error(
            [first_cycle.volume for first_cycle in first_cycles]
        ), _relative_discretization_error([first_cycle.depth for first_cycle in first_cycles])


_ERROR_RATIO = 1 / (1 - 2**-1.5)
"""Ratio of the error to the difference from half the step: 1 / (1 - 2^-p) for errors of order p = 1.5.

The order is 2 for a moving load. With wear by contact area and a stationary load it can be 1.6: halved rings divide
the error by 3.
"""


def _relative_discretization_error(values: list[float]) -> float:
    """Estimate the relative discretization error from results with coarse and halved steps and rings."""
    coarse, finer_steps, finer_rings = values
    if not finer_rings:
        return 0.0
    return _ERROR_RATIO * (abs(coarse - finer_steps) + abs(finer_steps - finer_rings)) / abs(finer_rings)


def check_cycles(cycles: float, report_at: Sequence[float]) -> list[float]:
    """Check the cycle counts of a run, and return the counts of its reports in ascending order.

    The last one is the total count.

    Raises
    ------
    ValueError
        A total count that is not positive and finite, or a report beyond it.
    """
    require("cycles", cycles, 0 < cycles < inf, "a number of cycles is positive and finite")
    for count in report_at:
        require("report_at", count, 0 <= count <= cycles, f"it lies between 0 and the {cycles:g} cycles of the run")
    return sorted({float(count) for count in (*report_at, cycles)})


__getattr__ = renamed_names(__name__, {"InUse": "HipSimulation"})
