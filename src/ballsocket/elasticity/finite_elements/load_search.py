"""Contacts of one pair found by their load, from a few that are known."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from ...problem.gaps import Gap
from .round_contact import PartialContact, partial_contact
from .surfaces import SurfacePair

_RUNGS = 10
_STEPS = 4
_CLOSE = 1e-10  # of a load


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactBracket:
    """The contacts of a pair between two half angles (rad)."""

    pair: SurfacePair
    gap: Gap
    low: float
    high: float

    @cached_property
    def _climbed(self) -> tuple[list[PartialContact], bool]:
        """Contacts, each with more force and indentation than the one before; whether then comes the perfect fit.

        They may end earlier: where the rim gives way so much that a wider contact has less force, the ball leaves the
        pole, and the contact is a partial_contact no more.
        """
        angles = numpy.geomspace(self.low, self.high, _RUNGS)
        angles[-1] = self.high
        rungs: list[PartialContact] = []
        for angle in angles:
            one = partial_contact(self.pair, self.gap, float(angle))
            if not is_pressed(one):
                return rungs, True
            if rungs and not (one.force > rungs[-1].force and one.indentation > rungs[-1].indentation):
                return rungs, False
            rungs.append(one)
        return rungs, False

    @property
    def _rungs(self) -> list[PartialContact]:
        return self._climbed[0]

    @cached_property
    def _curves(self) -> dict[str, PchipInterpolator]:
        """ln ε by ln(load)."""
        angles = numpy.log([one.half_angle for one in self._rungs])
        return {
            kind: PchipInterpolator(numpy.log([getattr(one, kind) for one in self._rungs]), angles)
            for kind in ("force", "indentation")
        }

    def falls_short(self, kind: str, load: float) -> bool:
        """Whether even the widest contact has less than the load."""
        return len(self._rungs) == _RUNGS and bool(getattr(self._rungs[-1], kind) < load)

    def guess(self, kind: str, load: float) -> float | None:
        """About the half angle under a load; None where it lies outside the ladder."""
        if len(self._rungs) < 2 or load < getattr(self._rungs[0], kind) or self.falls_short(kind, load):
            return None
        if load > getattr(self._rungs[-1], kind):  # short of the perfect fit, that is of the next rung
            return self._rungs[-1].half_angle * (self.high / self.low) ** (0.5 / (_RUNGS - 1))
        return float(numpy.exp(self._curves[kind](numpy.log(load))))

    def find(self, kind: str, load: float) -> PartialContact | None:
        """The contact under a load, "force" or "indentation"; None where it lies outside the ladder."""
        if len(self._rungs) < 2 or load < getattr(self._rungs[0], kind) or self.falls_short(kind, load):
            return None
        above = sum(getattr(rung, kind) <= load for rung in self._rungs)
        if above == len(self._rungs):
            _, fits = self._climbed  # before the perfect fit the load goes to infinity
            return self._bracketed(kind, load, self._rungs[-1].half_angle, self.high) if fits else None
        return self._quickly(kind, load) or self._bracketed(
            kind, load, self._rungs[above - 1].half_angle, self._rungs[above].half_angle
        )

    def _quickly(self, kind: str, load: float) -> PartialContact | None:
        """By the secant method in the logarithms, from the curve through the rungs; None if that is slow."""
        goal = numpy.log(load)
        angle, rise = float(self._curves[kind](goal)), float(self._curves[kind](goal, 1))
        one, miss = self._missed(kind, goal, angle)
        for _ in range(_STEPS):
            if abs(miss) < _CLOSE:
                return one
            step, before = miss * rise, miss
            angle += step
            one, miss = self._missed(kind, goal, angle)
            rise = step / (before - miss) if miss != before else 0.0
        return None

    def _missed(self, kind: str, goal: float, log_angle: float) -> tuple[PartialContact, float]:
        """The contact of a half angle, and by how much the logarithm of its load falls short."""
        one = partial_contact(self.pair, self.gap, min(float(numpy.exp(log_angle)), self.high))
        return one, goal - float(numpy.log(getattr(one, kind)))

    def _bracketed(self, kind: str, load: float, low: float, high: float) -> PartialContact:
        def miss(angle: float) -> float:
            one = partial_contact(self.pair, self.gap, angle)
            return float(1 - (load / getattr(one, kind)) ** 0.25) if is_pressed(one) else 1.0

        return partial_contact(self.pair, self.gap, brentq(miss, low, high, xtol=1e-14, rtol=1e-14))


def is_pressed(one: PartialContact) -> bool:
    """Whether anything presses: the contact is not wider than the perfect fit's."""
    return bool(one.indentation > 0 and one.force > 0)
