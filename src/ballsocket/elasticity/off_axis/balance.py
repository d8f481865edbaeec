"""Balls under loads side by side: Newton's method downhill, each with a tangent that learns from its steps.

What springs and elastic bodies store less the work of the load is least where the forces balance; a step that leads
uphill and away from balance is taken back and shortened. Tangents are solved for at first and where a step gained
little; elsewhere the forces that were found mend them (Broyden, Fletcher, Goldfarb, Shanno).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy

from ...core.arrays import Numbers
from .solver import TOLERANCE, pressed

if TYPE_CHECKING:
    from .search import Bed

_ROUNDS, _FEW = 80, 15
_LOOSE, _ROUGH = 1e-2, 1e-3
_CLOSE = 1e-6  # of the load: where the balance is good, and _ROUGH where wide cells begin
_GAIN = 0.2  # of what was missing: a step that leaves more asks for a new tangent
_NOISE = 5.0  # what may be missing by as much as the pressures are not settled
_SHARE = 0.02  # of what is missing: as far the next pressures are settled
_SOLID = 1e-12
"""Of the trace of a stiffness, added to each direction: one in which nothing pushes back stays solvable."""

_DAMPED, _FREE = 1e-6, 1e-10
"""Of the trace: after a step that was taken back, and where a shortening ends."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Balanced:
    """Balls side by side, as far as their loads are balanced.

    Attributes
    ----------
    place : array (batch, 3)
        Of the ball's centre in mm.
    pressure : array (batch, rings, meridians)
        In MPa.
    found : array of bool (batch,)
    stretched : array (batch, 3, rings, meridians)
        About the change of the pressure by the displacement, in MPa/mm.
    tangent : array (batch, 3, 3)
        About the stiffness, in N/mm.
    """

    place: Numbers
    pressure: Numbers
    found: Numbers
    stretched: Numbers
    tangent: Numbers

    def take(self, some: Numbers, run: _Run, these: Numbers) -> None:
        """Write what is done of a search to its places."""
        for name in ("place", "pressure", "found", "stretched", "tangent"):
            getattr(self, name)[some] = getattr(run, name)[these]


def balanced(bed: Bed, load: Numbers, size: Numbers, start: Numbers, pressure: Numbers | None) -> Balanced:
    """Balls that are balanced under their loads, or as near to it as the search came.

    Parameters
    ----------
    bed : Bed
    load : array (batch, 3)
    size : array (batch,)
        Of what the balance is measured in, in N.
    start : array (batch, 3)
        Displacements to begin with.
    pressure : array (batch, rings, meridians), optional
        Pressures to begin with, none of them negative; without them cells twice as wide are asked first.
    """
    known = None if pressure is not None or bed.coarser is None else _coarsely(bed, bed.coarser, load, size, start)
    return _searched(_Run(bed, load, size, start, pressure, known), _ROUNDS)


def _coarsely(bed: Bed, coarser: Bed, load: Numbers, size: Numbers, start: Numbers) -> Balanced:
    """What cells twice as wide say, in the cells of the bed."""
    found = _searched(_Run(coarser, load, size, start, None, None, _ROUGH), _FEW)
    p, q = (bed.spread(each) for each in (found.pressure, found.stretched))
    place = numpy.where(found.found[:, None], found.place, start)
    return replace(found, place=place, pressure=p, stretched=q)


def _searched(run: _Run, rounds: int) -> Balanced:
    end = Balanced(
        place=run.place.copy(),
        pressure=run.pressure.copy(),
        found=numpy.zeros(len(run.load), dtype=bool),
        stretched=run.stretched.copy(),
        tangent=run.tangent.copy(),
    )
    places = numpy.arange(len(run.load))
    for number in range(rounds):
        run.look()
        done = run.found | (number == rounds - 1)
        end.take(places[done], run, done)
        run.keep(~done)
        places = places[~done]
        if not len(places):
            break
        run.advance()
    return end


class _Run:
    """The search under way."""

    def __init__(
        self,
        bed: Bed,
        load: Numbers,
        size: Numbers,
        start: Numbers,
        pressure: Numbers | None,
        known: Balanced | None = None,
        close: float = _CLOSE,
    ) -> None:
        self.bed, self.load, self.size, self.close = bed, load, size, close
        count = len(load)
        self.place, self.trial, self.begin = start.copy(), start, pressure
        self.pressure = numpy.zeros((count, *self._cells))
        self.stretched = numpy.zeros((count, 3, *self._cells), dtype=numpy.float32)
        self.force, self.tangent = numpy.zeros((count, 3)), numpy.zeros((count, 3, 3))
        self.miss, self.work = numpy.full(count, numpy.inf), numpy.full(count, numpy.inf)
        self.tolerance, self.damping = numpy.full(count, _LOOSE), numpy.zeros(count)
        self.apart, self.known = numpy.zeros(count), numpy.full(count, _LOOSE)
        self.found, self.stale = numpy.zeros(count, dtype=bool), numpy.ones(count, dtype=bool)
        if known is not None:
            self._know(known)

    def _know(self, known: Balanced) -> None:
        """Begin where another search ended."""
        self.trial, self.begin, self.stale = known.place, known.pressure, ~known.found
        self.stretched, self.tangent = known.stretched, known.tangent
        self.tolerance = numpy.where(known.found, _ROUGH, _LOOSE)

    @property
    def _cells(self) -> tuple[int, int]:
        grid = self.bed.compliance.grid
        return grid.rings, grid.meridians

    def look(self) -> None:
        """Press where the trial is, and take it where that is better."""
        overlap = self.bed.separation.overlap(self.trial)
        made = pressed(self.bed.compliance, overlap, self.begin, self.tolerance)
        back = self.trial @ self.bed.tether
        force = self.bed.force(made.pressure) + back
        miss = numpy.linalg.norm(self.load - force, axis=1) / self.size
        work = self.bed.area * made.energy - numpy.einsum("bk,bk->b", self.trial, self.load - back / 2)
        gap = numpy.minimum(overlap.max(axis=(1, 2)), 0.0)
        first = numpy.isinf(self.work)
        less = (work <= self.work) | (miss < self.miss) | (miss < _NOISE * self.known)
        better = first | ((gap == 0) & less) | (gap > self.apart)  # which was below 0
        close = made.settled & (miss <= self.close) & (self.tolerance <= max(self.close, TOLERANCE))
        self.found = better & close
        self.stale = better & numpy.where(first, self.stale, miss > _GAIN * self.miss)
        self._learn(better & ~first, force)
        shorter = numpy.maximum(30 * self.damping, _DAMPED)
        self.damping = numpy.where(better, numpy.where(self.damping > _FREE, self.damping / 10, 0.0), shorter)
        self._take(better, force=force, miss=miss, work=work, pressure=made.pressure, apart=gap)

    def _take(self, better: Numbers, **found: Numbers) -> None:
        """Stand where the trials are that are better, with what was found there."""
        for name, each in {**found, "place": self.trial, "known": self.tolerance}.items():
            getattr(self, name)[better] = each[better]

    def _learn(self, some: Numbers, force: Numbers) -> None:
        """Tangents that know what the last step did."""
        s, y, J = self.trial - self.place, force - self.force, self.tangent
        Js = numpy.einsum("bkl,bl->bk", J, s)
        sy, sJs = (numpy.einsum("bk,bk->b", s, each) for each in (y, Js))
        some = some & (sy > 1e-3 * sJs) & (sJs > 0)
        for sign, vector, scale in ((1, y, sy), (-1, Js, sJs)):
            outer = vector[some, :, None] * vector[some, None, :]
            J[some] += sign * outer / scale[some, None, None]

    def keep(self, some: Numbers) -> None:
        """Go on with some of the loads."""
        if some.all():
            return
        names = ("load", "size", "place", "pressure", "stretched", "force", "tangent", "miss", "work")
        for name in (*names, "tolerance", "damping", "apart", "known", "found", "stale"):
            setattr(self, name, getattr(self, name)[some])

    def advance(self) -> None:
        """The next trial: Newton's step, or back to the bore where the ball has lost it."""
        if self.stale.any():
            some = self.stale
            begin = self.stretched[some] if self.stretched[some].any() else None
            self.stretched[some] = self.bed.stretched(self.place[some], self.pressure[some], begin)
            self.tangent[some] = self.bed.tangent(self.stretched[some])
        step = numpy.where(self.apart[:, None] < 0, -1.1 * self.apart[:, None] * self._along, self._step())
        self.trial = self.place + step
        more = numpy.einsum("bk,bkij->bij", step.astype(numpy.float32), self.stretched)
        self.begin = numpy.maximum(self.pressure + more, 0.0)
        self.tolerance = numpy.clip(_SHARE * self.miss, max(self.close, TOLERANCE), _LOOSE)

    @property
    def _along(self) -> Numbers:
        return self.load / self.size[:, None]

    def _step(self) -> Numbers:
        trace = numpy.trace(self.tangent, axis1=1, axis2=2)
        solid = numpy.where(trace > 0, (_SOLID + self.damping) * trace, 1.0)
        matrices = self.tangent + solid[:, None, None] * numpy.eye(3)
        step: Numbers = numpy.linalg.solve(matrices, (self.load - self.force)[:, :, None])[:, :, 0]
        return step
