"""Search of contacts by their load on one pair of surfaces, their tangent stiffness and their work."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from ...core.arrays import gauss_legendre
from ...problem.gaps import Gap
from .bodies import SurfacePair
from .pair_contact import FullContact, PartialContact, partial_contact

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
    def samples(self) -> list[PartialContact]:
        return self._samples_and_fit[0]

    @cached_property
    def _interpolators(self) -> dict[str, PchipInterpolator]:
        """Interpolating functions from ln(load) to ln ε, by the kind of load."""
        angles = numpy.log([contact.half_angle for contact in self.samples])
        loads = {kind: [getattr(contact, kind) for contact in self.samples] for kind in ("force", "indentation")}
        return {kind: PchipInterpolator(numpy.log(values), angles) for kind, values in loads.items()}

    def lies_below(self, kind: str, load: float) -> bool:
        """Return True if the load exceeds that of the widest contact and no sample is missing."""
        return len(self.samples) == _SAMPLES and bool(getattr(self.samples[-1], kind) < load)

    def estimate_angle(self, kind: str, load: float) -> float | None:
        """Estimate the half angle in rad under a load; None for a load outside the range."""
        if len(self.samples) < 2 or load < getattr(self.samples[0], kind) or self.lies_below(kind, load):
            return None
        if load > getattr(self.samples[-1], kind):  # the perfect fit lies before the next sample
            return self.samples[-1].half_angle * (self.high / self.low) ** (0.5 / (_SAMPLES - 1))
        return float(numpy.exp(self._interpolators[kind](numpy.log(load))))

    def solve(self, kind: str, load: float) -> PartialContact | None:
        """Solve the contact under a "force" or "indentation"; None for a load outside the range."""
        if len(self.samples) < 2 or load < getattr(self.samples[0], kind) or self.lies_below(kind, load):
            return None
        above = sum(getattr(sample, kind) <= load for sample in self.samples)
        if above == len(self.samples):
            _, fits = self._samples_and_fit  # the load is infinite at the perfect fit
            return self._solve_by_brent(kind, load, self.samples[-1].half_angle, self.high) if fits else None
        low, high = (self.samples[number].half_angle for number in (above - 1, above))
        return self._solve_by_secant(kind, load) or self._solve_by_brent(kind, load, low, high)

    def _solve_by_secant(self, kind: str, load: float) -> PartialContact | None:
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
        def residual(angle: float) -> float:
            """Compute the difference between 1 and a power of the load ratio at a half angle; 1 without contact."""
            contact = partial_contact(self.pair, self.gap, angle)
            return float(1 - (load / getattr(contact, kind)) ** 0.25) if is_pressed(contact) else 1.0

        return partial_contact(self.pair, self.gap, brentq(residual, low, high, xtol=1e-14, rtol=1e-14))


def is_pressed(contact: PartialContact) -> bool:
    """Return True for a contact with positive indentation and force; beyond the perfect fit there is none."""
    return bool(contact.indentation > 0 and contact.force > 0)


Solved = PartialContact | FullContact
"""Contact on one mesh: with its edge inside the socket, or filling the socket."""

_RELATIVE_STEPS = 0.02 * numpy.arange(-3, 4)
_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(12))
_DEPTHS = numpy.geomspace(1 / 30, 1.0, 12)


def stiffness(contact: Solved) -> float:
    """Compute the tangent stiffness dF/dd in N/mm from slightly narrower and wider contacts.

    A single step is not enough, because the edge moves unevenly through the elements.

    With q = ln(F/d) and v = 1/d, both smooth in ε even where d goes to infinity: F' = (F/d) (1 - v q'/v').
    """
    if isinstance(contact, FullContact):
        return contact.stiffness
    angles = numpy.minimum(_RELATIVE_STEPS, contact.pair.angle[-1] / contact.half_angle - 1)
    half_angles = contact.half_angle * (1 + numpy.unique(angles))
    neighbours = [partial_contact(contact.pair, contact.gap, float(half_angle)) for half_angle in half_angles]
    valid = [neighbour for neighbour in neighbours if is_pressed(neighbour)]
    if len(valid) < _DEGREE + 1:
        return numpy.nan
    x = numpy.array([neighbour.half_angle / contact.half_angle - 1 for neighbour in valid])
    q = numpy.log([neighbour.force / neighbour.indentation for neighbour in valid])
    v = numpy.array([contact.indentation / neighbour.indentation for neighbour in valid])
    dq, dv = (numpy.polynomial.Polynomial.fit(x, values, _DEGREE).deriv()(0.0) for values in (q, v))
    return float(contact.force / contact.indentation * (1 - dq / dv))


_DEGREE = 3


def work(contact: Solved) -> float:
    """Compute the work of the load in N mm, which is the strain energy if the gap has a potential."""
    if contact.gap.conservative:
        return contact.strain_energy
    if isinstance(contact, FullContact):
        return _partial_work(partial_contact(contact.pair, contact.gap, contact.half_angle)) + _rim_work(contact)
    return _partial_work(contact)


def _partial_work(contact: PartialContact) -> float:
    """Compute the work ∫ F dd in N mm up to a partial contact, from a polynomial fit of ln F over ln d."""
    bracket = ContactBracket(pair=contact.pair, gap=contact.gap, low=0.2 * contact.half_angle, high=contact.half_angle)
    narrower = [bracket.solve("indentation", float(depth * contact.indentation)) for depth in _DEPTHS[:-1]]
    known = [neighbour for neighbour in narrower if neighbour is not None] + [contact]
    x = numpy.log([neighbour.indentation / contact.indentation for neighbour in known])
    y = numpy.log([neighbour.force / contact.force for neighbour in known])
    law = numpy.polynomial.Polynomial.fit(x, y, min(6, len(x) - 1))
    depths = x[0] * (1 - _NODES)  # ln d
    narrow = numpy.exp(law(x[0]) + x[0]) / (law.deriv()(x[0]) + 1)
    return float(contact.force * contact.indentation * (narrow - x[0] * (_WEIGHTS @ numpy.exp(law(depths) + depths))))


def _rim_work(contact: FullContact) -> float:
    """Compute the work ∫ F dd in N mm from the indentation at which the contact reaches the rim."""
    start = partial_contact(contact.pair, contact.gap, contact.half_angle).indentation
    depth = contact.indentation - start
    forces = [replace(contact, indentation=start + depth * node).force for node in _NODES]
    return float(depth * (_WEIGHTS @ forces))
