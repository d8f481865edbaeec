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
        `Archard`, `AreaLaw`, `CrossShear` or `OwnLaw`.
    cup : Cup
        Arc of cover and where it faces; where the cycle's standard says a tilt, that of a cup that faces down.
    surface : Springs, ClosedShell or RealCup
        How the bore gives way; the paper's springs by default.
    ring_width : float
        Of the rings of the wear map in rad, 3° by default.
    ball_wear : Law, optional
        How the ball wears too, as hard ones do, in its own frame; not at all by default.
    creep : Ladder, optional
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
        """How far volume and depth of the first cycle are from those with rings and instants halved, relative to them.

        As far as they may be halved.
        """
        finer = replace(self, ring_width=max(self.ring_width / 2, FINEST), cycle=self.cycle.finer())
        mine, other = self.first, finer.first
        return _off(mine.volume, other.volume), _off(mine.depth, other.depth)


def _off(mine: float, other: float) -> float:
    return abs(mine / other - 1) if other else 0.0
