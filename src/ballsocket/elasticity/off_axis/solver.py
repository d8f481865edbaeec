"""Contact without friction: pressures that push, a gap that is open, one or the other in every cell.

The least energy under p >= 0 by conjugate gradients that drop the cells which would pull and take up those that would
overlap (Polonsky & Keer 1999, doi 10.1016/S0043-1648(99)00113-1). The preconditioner is the stiffness of a bore that is
under pressure all over, which is known exactly for each harmonic. Many contacts of one joint are solved side by side.
Steps are taken in single precision; what is said to be settled was judged in double.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ...core.arrays import Numbers
from .compliance import Compliance

TOLERANCE = 1e-6
"""The largest gap in the contact and overlap outside, over the ball's largest overlap with the undeformed bore."""

_STEPS = 200

_CLOSE, _ROUGH = 1e-5, 1e-3
"""Tolerances of overlap and of pressure, below which single precision does not judge."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Pressed:
    """Pressures side by side.

    Attributes
    ----------
    pressure : array (batch, rings, meridians)
        In MPa.
    settled : array of bool (batch,)
        Whether the tolerance was reached.
    energy : array (batch,)
        That is stored, on a sphere of radius 1, in MPa mm: as good as the square of the tolerance.
    steps : int
        Of the longest.
    """

    pressure: Numbers
    settled: Numbers
    energy: Numbers
    steps: int


def pressed(
    compliance: Compliance, overlap: Numbers, start: Numbers | None = None, tolerance: Numbers | float = TOLERANCE
) -> Pressed:
    """The pressures that push bore and ball apart by the overlap where they touch, and leave a gap elsewhere.

    Parameters
    ----------
    compliance : Compliance
    overlap : array (batch, rings, meridians)
        In mm, below 0 where the undeformed surfaces are apart.
    start : array (batch, rings, meridians), optional
        Pressures to begin with, none of them negative.
    tolerance : float or array (batch,)
        Of the complementarity residual, relative.
    """
    p = _guess(compliance, overlap) if start is None else start
    tolerances = numpy.broadcast_to(tolerance, len(overlap))
    answer, settled = numpy.zeros_like(overlap), numpy.zeros(len(overlap), dtype=bool)
    energy = numpy.zeros(len(overlap))
    places = numpy.flatnonzero(overlap.max(axis=(1, 2)) > 0)
    settled[overlap.max(axis=(1, 2)) <= 0] = True
    run = _Run(compliance, overlap[places], p[places])
    for step in range(_STEPS):
        done = run.settled(tolerances[places])
        if done.any() or step == _STEPS - 1:
            answer[places], settled[places], energy[places] = run.pressure, done, run.energy
            places = places[~done]
            run.keep(~done)
        if not len(places):
            break
        run.advance()
    return Pressed(pressure=answer, settled=settled, energy=energy, steps=step)


def _guess(compliance: Compliance, overlap: Numbers) -> Numbers:
    """Where they overlap, the pressure that would do this all over the bore."""
    asked = numpy.maximum(overlap, 0.0)
    return numpy.where(asked > 0, numpy.maximum(compliance.pressure(asked), 0.0), 0.0)


class _Run:
    """Conjugate gradients under way, for contacts side by side."""

    def __init__(self, compliance: Compliance, overlap: Numbers, pressure: Numbers) -> None:
        self.compliance, self.overlap, self.pressure = compliance, overlap, pressure
        self.deepest = overlap.max(axis=(1, 2), initial=0.0)
        self.given = compliance.roughly(pressure)
        self.rough = numpy.ones(len(overlap), dtype=bool)
        self.direction = self.before = numpy.zeros_like(overlap, dtype=numpy.float32)
        self.gain = numpy.full(len(overlap), numpy.inf)
        self._look()

    def _look(self) -> None:
        """What is still to be given way, in the cells that touch or overlap."""
        rest = self.overlap - self.given
        self.touching = self.pressure > 0
        self.rest = numpy.where(self.touching | (rest > 0), rest, 0.0).astype(numpy.float32)
        self.residual = abs(self.rest).max(axis=(1, 2), initial=0.0) / self.deepest

    @property
    def energy(self) -> Numbers:
        """∫ p u - ∫ p S p/2, the largest at the solution."""
        return self.compliance.grid.total(self.pressure, self.overlap + self.rest) / 2

    def settled(self, tolerance: Numbers) -> Numbers:
        """Which contacts are within their tolerances; close ones in double precision."""
        doubtful = self.rough & (tolerance < _CLOSE) & (self.residual <= tolerance)
        if doubtful.any():
            self.given[doubtful] = self.compliance.displacement(self.pressure[doubtful])
            self.rough &= ~doubtful
            self._look()
        done: Numbers = self.residual <= tolerance
        return done

    def keep(self, some: Numbers) -> None:
        """Go on with some of the contacts."""
        if some.all():
            return
        for name in ("overlap", "pressure", "deepest", "given", "rough", "direction", "before", "gain"):
            setattr(self, name, getattr(self, name)[some])
        for name in ("touching", "rest", "residual"):
            setattr(self, name, getattr(self, name)[some])

    def advance(self) -> None:
        """One step: along the preconditioned rest, as far as the energy falls, and no pressure below 0."""
        total = self.compliance.grid.total
        uphill = numpy.where(self.rest != 0, self.compliance.pressure(self.rest), 0)
        uphill = numpy.where(self.touching, uphill, numpy.maximum(uphill, 0))
        turned = numpy.maximum(total(self.rest - self.before, uphill) / self.gain, 0.0)
        self.gain = total(self.rest, uphill)
        self.direction = numpy.where(self.rest != 0, uphill + turned[:, None, None] * self.direction, 0)
        gives = self.compliance.roughly(self.direction)
        length = total(self.rest, self.direction) / total(self.direction, gives)
        self.before = self.rest
        self._go(length[:, None, None], gives)

    def _go(self, length: Numbers, gives: Numbers) -> None:
        pressure = self.pressure + length * self.direction
        self.given = self.given + length * gives
        pulling = (pressure < 0).any(axis=(1, 2))
        self.pressure = numpy.maximum(pressure, 0.0)
        if pulling.any():
            self.given[pulling] = self.compliance.roughly(self.pressure[pulling])
        self.rough[:] = True
        self._look()


def answers(
    compliance: Compliance, touching: Numbers, asked: Numbers, start: Numbers | None = None, tolerance: float = 1e-3
) -> Numbers:
    """The change of pressure in the cells that touch when their surface has to give way further by what is asked.

    Parameters
    ----------
    compliance : Compliance
    touching : array of bool (batch, rings, meridians)
    asked : array (batch, rings, meridians)
        Further overlap in mm, or per mm of something.
    start : array (batch, rings, meridians), optional
        A guess.
    tolerance : float
        Relative, of the energy.

    Returns
    -------
    array (batch, rings, meridians)
        In MPa, or MPa per mm.
    """
    total = compliance.grid.total
    rough = tolerance > _ROUGH
    displacement = compliance.roughly if rough else compliance.displacement
    asked = numpy.where(touching, asked.astype(numpy.float32) if rough else asked, 0)
    q = numpy.where(touching, compliance.pressure(asked) if start is None else start, 0)
    rest = numpy.where(touching, asked - displacement(q), 0)
    whole = abs(total(asked, q))
    direction, gain = numpy.zeros_like(q), numpy.full(len(q), numpy.inf)
    for _ in range(_STEPS):
        uphill = numpy.where(touching, compliance.pressure(rest), 0)
        new = total(rest, uphill)
        if (new <= tolerance**2 * whole).all():
            break
        direction = uphill + _ratio(new, gain)[:, None, None] * direction
        gives = numpy.where(touching, displacement(direction), 0)
        length = _ratio(new, total(direction, gives))[:, None, None]
        q, rest, gain = q + length * direction, rest - length * gives, new
    return q


def _ratio(above: Numbers, below: Numbers) -> Numbers:
    quotient: Numbers = numpy.divide(above, below, out=numpy.zeros_like(above), where=below > 0)
    return quotient
