"""Search of contacts by their load, between a few contacts of one surface pair."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from ...problem.gaps import Gap
from .round_contact import PartialContact, partial_contact
from .surfaces import SurfacePair

_SAMPLES = 10
_SECANT_STEPS = 4
_LOAD_TOLERANCE = 1e-10  # relative


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactBracket:
    """Contacts of a surface pair between two half angles (rad), searched by their load."""

    pair: SurfacePair
    gap: Gap
    low: float
    high: float

    @cached_property
    def _samples_and_fit(self) -> tuple[list[PartialContact], bool]:
        """Sample contacts of increasing load, and True if the perfect fit lies beyond the last one.

        The samples may end earlier. If the rim is so compliant that a wider contact has less force, the ball leaves the
        pole and its contact area is not round any more.
        """
        angles = numpy.geomspace(self.low, self.high, _SAMPLES)
        angles[-1] = self.high
        samples: list[PartialContact] = []
        for angle in angles:
            contact = partial_contact(self.pair, self.gap, float(angle))
            if not is_pressed(contact):
                return samples, True
            if samples and not (contact.force > samples[-1].force and contact.indentation > samples[-1].indentation):
                return samples, False
            samples.append(contact)
        return samples, False

    @property
    def _samples(self) -> list[PartialContact]:
        """Sample contacts of increasing force and indentation."""
        return self._samples_and_fit[0]

    @cached_property
    def _interpolators(self) -> dict[str, PchipInterpolator]:
        """Interpolating functions from ln(load) to ln ε, by the kind of load."""
        angles = numpy.log([contact.half_angle for contact in self._samples])
        return {
            kind: PchipInterpolator(numpy.log([getattr(contact, kind) for contact in self._samples]), angles)
            for kind in ("force", "indentation")
        }

    def lies_below(self, kind: str, load: float) -> bool:
        """Return True if the load exceeds that of the widest contact and no sample is missing."""
        return len(self._samples) == _SAMPLES and bool(getattr(self._samples[-1], kind) < load)

    def estimate_angle(self, kind: str, load: float) -> float | None:
        """Estimate the half angle in rad under a load; None for a load outside the range."""
        if len(self._samples) < 2 or load < getattr(self._samples[0], kind) or self.lies_below(kind, load):
            return None
        if load > getattr(self._samples[-1], kind):  # the perfect fit lies before the next sample
            return self._samples[-1].half_angle * (self.high / self.low) ** (0.5 / (_SAMPLES - 1))
        return float(numpy.exp(self._interpolators[kind](numpy.log(load))))

    def solve(self, kind: str, load: float) -> PartialContact | None:
        """Solve the contact under a "force" or "indentation"; None for a load outside the range."""
        if len(self._samples) < 2 or load < getattr(self._samples[0], kind) or self.lies_below(kind, load):
            return None
        above = sum(getattr(sample, kind) <= load for sample in self._samples)
        if above == len(self._samples):
            _, fits = self._samples_and_fit  # the load is infinite at the perfect fit
            return self._solve_by_brent(kind, load, self._samples[-1].half_angle, self.high) if fits else None
        return self._solve_by_secant(kind, load) or self._solve_by_brent(
            kind, load, self._samples[above - 1].half_angle, self._samples[above].half_angle
        )

    def _solve_by_secant(self, kind: str, load: float) -> PartialContact | None:
        """Solve the contact under a load by the secant method; None if it does not converge in a few steps.

        The unknown is the logarithm of the half angle.
        """
        goal = numpy.log(load)
        angle, rise = float(self._interpolators[kind](goal)), float(self._interpolators[kind](goal, 1))
        contact, residual = self._solve_residual(kind, goal, angle)
        for _ in range(_SECANT_STEPS):
            if abs(residual) < _LOAD_TOLERANCE:
                return contact
            step, previous = residual * rise, residual
            angle += step
            contact, residual = self._solve_residual(kind, goal, angle)
            rise = step / (previous - residual) if residual != previous else 0.0
        return None

    def _solve_residual(self, kind: str, goal: float, log_angle: float) -> tuple[PartialContact, float]:
        """Solve the contact of a half angle; return it and the logarithm of target load over its load."""
        contact = partial_contact(self.pair, self.gap, min(float(numpy.exp(log_angle)), self.high))
        return contact, goal - float(numpy.log(getattr(contact, kind)))

    def _solve_by_brent(self, kind: str, load: float, low: float, high: float) -> PartialContact:
        """Solve the contact under a load by Brent's method between two half angles (rad)."""

        def residual(angle: float) -> float:
            """Compute the difference between 1 and a power of the load ratio at a half angle; 1 without contact."""
            contact = partial_contact(self.pair, self.gap, angle)
            return float(1 - (load / getattr(contact, kind)) ** 0.25) if is_pressed(contact) else 1.0

        return partial_contact(self.pair, self.gap, brentq(residual, low, high, xtol=1e-14, rtol=1e-14))


def is_pressed(contact: PartialContact) -> bool:
    """Return True for a contact with positive indentation and force; beyond the perfect fit there is none."""
    return bool(contact.indentation > 0 and contact.force > 0)
