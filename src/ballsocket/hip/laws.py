"""Laws of wear: how deep a cycle of pressures and slides wears each point of a socket."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .kinematics import SurfaceSliding

_NUDGE = 1e-6  # of the largest pressure, for the slope of a law
METRE = 1e-3
"""Of a wear factor: per metre of sliding, in mm."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Pass:
    """A cycle of contacts: what every point of the socket goes through.

    Attributes
    ----------
    pressure : array (instants, points)
        In MPa.
    sliding : SurfaceSliding
    shares : function, optional
        Function that computes `contact`. Without it, a cell with a positive pressure is in contact completely.
    """

    pressure: Numbers
    sliding: SurfaceSliding
    shares: Callable[[], Numbers] | None = None

    @cached_property
    def contact(self) -> Numbers:
        """Share of each point's cell that is in contact, from 0 to 1: (instants, points)."""
        return (self.pressure > 0).astype(float) if self.shares is None else self.shares()

    @cached_property
    def work(self) -> Numbers:
        """∫ p v dt of each point, in N/mm: (points,)."""
        return numpy.einsum("tp,tp->p", self.pressure, self.sliding.distances)

    @cached_property
    def cross_shear(self) -> Numbers:
        """Cross-shear of each point: (points,)."""
        return self.sliding.cross_shear(self.pressure)


class Law(Protocol):
    """What wears how deep."""

    def depth(self, cycle: Pass) -> Numbers:
        """The depth in mm that a cycle wears away at each point: (points,)."""
        ...

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be said of its coefficients."""
        ...


def _check_coefficient(value: Any) -> None:
    good = isinstance(value, int | float) and not isinstance(value, bool)
    if not good:
        raise TypeError(f"coefficient must be one number, got {value!r:.60}")
    require("coefficient", value, 0 <= value < float("inf"), "a wear coefficient is at least 0, and finite")


_USUAL = 1e-9, 1e-4  # mm³/(N m), of whatever slides in a joint


def _unusual(*coefficients: float) -> tuple[str, ...]:
    odd = next((each for each in coefficients if each > 0 and not _USUAL[0] <= each <= _USUAL[1]), None)
    if odd is None:
        return ()
    return (
        f"a wear factor of {odd:g} mm^3/(N m) is out of the usual range of {_USUAL[0]:g} to {_USUAL[1]:g}; "
        "one in mm^3/(N mm) is 1000 times smaller",
    )


@dataclass(frozen=True, kw_only=True)
class Archard:
    """dh = k p v dt, v being the speed of sliding.

    Parameters
    ----------
    coefficient : float
        k in mm³/(N m): 1.066e-6 for conventional UHMWPE, some 1e-7 to 4e-7 where it is cross-linked.
    """

    coefficient: float

    def __post_init__(self) -> None:
        _check_coefficient(self.coefficient)

    def depth(self, cycle: Pass) -> Numbers:
        return METRE * self.coefficient * cycle.work

    @property
    def notes(self) -> tuple[str, ...]:
        return _unusual(self.coefficient)


@dataclass(frozen=True, kw_only=True)
class EnergyLaw:
    """dh = e μ p v dt: what friction's work wears away.

    Parameters
    ----------
    coefficient : float
        e in mm³ per joule of friction.
    friction : float
        μ, the coefficient of friction.
    """

    coefficient: float
    friction: float

    def __post_init__(self) -> None:
        _check_coefficient(self.coefficient)
        require("friction", self.friction, 0 <= self.friction < 10, "a coefficient of friction is 0 to 10")

    def depth(self, cycle: Pass) -> Numbers:
        return METRE * self.coefficient * self.friction * cycle.work

    @property
    def notes(self) -> tuple[str, ...]:
        return _unusual(self.coefficient * self.friction)


@dataclass(frozen=True, kw_only=True)
class AreaLaw:
    """dh = C v dt, v being the speed of sliding, wherever there is contact, whatever the pressure.

    A cell at the edge of the contact wears in proportion to its contact share.

    Parameters
    ----------
    coefficient : float
        C in mm per mm of sliding, mm³/(mm² mm).
    """

    coefficient: float

    def __post_init__(self) -> None:
        _check_coefficient(self.coefficient)

    def depth(self, cycle: Pass) -> Numbers:
        return self.coefficient * numpy.einsum("tp,tp->p", cycle.contact, cycle.sliding.distances)

    @property
    def notes(self) -> tuple[str, ...]:
        return ()


@dataclass(frozen=True, kw_only=True)
class CrossShear:
    """dh = k p v dt with a k that grows with the cross-shear, and may fall with the pressure.

    k = [straight + 2 CS (circular - straight)] (p/reference)^exponent, p being the mean pressure of a point while it
    slides in contact.

    Parameters
    ----------
    straight, circular : float
        k in mm³/(N m) on a straight track, CS = 0, and on a circle, CS = 1/2.
    exponent : float
        Of the pressure; 0 (default) has none.
    reference : float
        The pressure in MPa at which k has the values above. Default 1.
    """

    straight: float
    circular: float
    exponent: float = 0.0
    reference: float = 1.0

    def __post_init__(self) -> None:
        for value in (self.straight, self.circular):
            _check_coefficient(value)
        require("exponent", self.exponent, -1 < self.exponent < 3, "it lies between -1 and 3")
        require("reference", self.reference, 0 < self.reference < float("inf"), "a pressure (MPa) is positive")

    def depth(self, cycle: Pass) -> Numbers:
        factor = self.straight + 2 * cycle.cross_shear * (self.circular - self.straight)
        if self.exponent != 0:
            way = cycle.sliding.distances.sum(axis=0, where=cycle.pressure > 0)
            mean = numpy.divide(cycle.work, way, out=numpy.zeros_like(way), where=way > 0)
            factor = factor * numpy.where(mean > 0, mean / self.reference, 1.0) ** self.exponent
        return METRE * factor * cycle.work

    @property
    def notes(self) -> tuple[str, ...]:
        return _unusual(self.straight, self.circular)


@dataclass(frozen=True, kw_only=True)
class OwnLaw:
    """A law of one's own.

    Parameters
    ----------
    of : function
        From a `Pass` (its `pressure`, `sliding.distances`, `work`, `cross_shear`) to depths in mm (points,), at
        least 0.

    Raises
    ------
    ValueError
        When it is asked, and gives something else.

    Examples
    --------
    Archard's law with a pressure below which nothing wears:

    >>> law = OwnLaw(of=lambda cycle: 1e-9 * ((cycle.pressure - 0.5).clip(0) * cycle.sliding.distances).sum(axis=0))
    """

    of: Callable[[Pass], Numbers]

    def depth(self, cycle: Pass) -> Numbers:
        found, points = numpy.asarray(self.of(cycle), dtype=float), cycle.pressure.shape[1:]
        if found.shape != points:
            raise ValueError(f"a law of one's own gave depths of shape {found.shape}, and the points have {points}")
        good = (found >= 0) & (found < numpy.inf)
        if not good.all():
            raise ValueError(f"a law of one's own gave a depth of {found[~good][0]:g} mm: it is at least 0, and finite")
        return found

    @property
    def notes(self) -> tuple[str, ...]:
        return ()


def steepest(law: Law, done: Pass) -> float:
    """The most that a law adds to a depth for a larger pressure, in mm/MPa."""
    nudge = _NUDGE * float(done.pressure.max(initial=0.0))
    if not nudge > 0:
        return 0.0
    more = Pass(pressure=done.pressure + nudge * (done.pressure > 0), sliding=done.sliding, shares=lambda: done.contact)
    return float((law.depth(more) - law.depth(done)).max() / nudge)
