"""A hip in use: a joint, how its cup stands, what it goes through, and how that wears it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from .blocks import Run
from .checkpoint import checkpoint
from .film import Lubricant
from .history import Error, History
from .looks import check_cycles, check_meant, looks
from .set_up import FINEST, SetUp


@dataclass(frozen=True, kw_only=True, eq=False)
class InUse(SetUp):
    """A hip in use.

    Parameters
    ----------
    joint : Joint
        Of plain numbers.
    cycle : Cycle or Mix
        In the body's frame, as the cup's orientation is. On a left cup it is mirrored.
    wear : Law
        `Archard`, `ContactAreaWear`, `CrossShear` or `CustomWearLaw`.
    cup : Cup
        Arc of cover and orientation. A cup without a given orientation takes the tilt of the cycle's standard.
    surface : Springs, ClosedShell or RealCup
        How the bore gives way; the paper's springs by default.
    ring_width : float
        Of the rings of the wear map in rad, 3° by default.
    ball_wear : Law, optional
        How the ball wears too, as hard ones do, in its own frame; not at all by default.
    creep : KelvinVoigtChain, optional
        How the liner creeps; not at all by default.
    seconds_per_cycle : float, optional
        In which creep goes on; those that the cycle lasts by default.
    tolerance : float
        Of a block, over the largest depth so far. Default 4e-3.

    Raises
    ------
    ValueError
        A load that pushes the ball over the rim, with its instant; a number that is not allowed.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.hip import Archard, InUse, iso_14242_1
    >>> joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    >>> use = InUse(joint=joint, cycle=iso_14242_1(), wear=Archard(coefficient=1e-6))
    >>> round(use.first.volume, 1)
    30.1
    """

    def after(
        self,
        cycles: float,
        report_at: Sequence[float] = (),
        listen: Callable[[float], None] = lambda done: None,
        lubricant: Lubricant = Lubricant(),  # noqa: B008 (frozen)
        store: Path | None = None,
    ) -> History:
        """The hip after so many cycles.

        Parameters
        ----------
        cycles : float
        report_at : sequence of float
            Cycles at which to look; the end is always looked at.
        listen : function
            Called with the number of cycles done after each block.
        lubricant : Lubricant
            Of the film that `summary` tells of.
        store : Path, optional
            A folder to keep the run in after each block: one that was stopped goes on from there.

        Raises
        ------
        ValueError
            Numbers of cycles that are not allowed, or cannot be meant; a store that keeps another run.
        """
        counts = check_cycles(cycles, report_at)
        check_meant(self, cycles)
        kept, volume, depth = None if store is None else checkpoint(self, store), *self.halved
        run = Run(use=self)
        reports = looks(run, counts, listen, kept)
        error = Error(blocks=run.missed, volume=run.missed + volume, depth=run.missed + depth)
        return History(use=self, reports=reports, error=error, steps=run.steps, lubricant=lubricant)

    @cached_property
    def halved(self) -> tuple[float, float]:
        """Relative errors of volume and depth of the first cycle, estimated with halved instants and halved rings.

        The absolute differences are added and multiplied by 1.55, which holds for errors of order 1.5 or more.
        Rings are not halved below 0.5°.
        """
        instants = replace(self, cycle=self.cycle.finer())
        rings = replace(instants, ring_width=max(self.ring_width / 2, FINEST))
        firsts = (self.first, instants.first, rings.first)
        return _halving_error([first.volume for first in firsts]), _halving_error([first.depth for first in firsts])


def _halving_error(values: list[float]) -> float:
    """Estimate the relative error of the first value from those with halved instants, and then with halved rings."""
    given, instants, rings = values
    return _ERROR_RATIO * (abs(given - instants) + abs(instants - rings)) / abs(rings) if rings else 0.0


_ERROR_RATIO = 1 / (1 - 2**-1.5)
"""Ratio of the error to the difference from half the step: 1 / (1 - 2^-p) for errors of order p = 1.5.

The order is 2 for a moving load. With the law `area` and a stationary load it can be 1.6: halved rings divide the
error by 3.
"""
