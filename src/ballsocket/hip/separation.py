"""A ball that a spring has pushed out of its bore: at rest on the rim, until the load brings it back."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import TYPE_CHECKING, Any

import numpy

from ..arrays import Numbers
from .cycle import Spring

if TYPE_CHECKING:
    from .placing import Placed

_HALVINGS = 60


@dataclass(frozen=True, kw_only=True, eq=False)
class Separation:
    """The instants of a cycle in which the ball sits on the rim of its cup.

    Attributes
    ----------
    instants : array (n,)
        Of the cycle.
    displacement : array (n, 3)
        Of the ball's centre from the bore's in mm, in the cup's frame; NaN where nothing holds it.
    place : array (n,)
        Of the rim where it is touched, in rad around the cup's axis from its uppermost point.
    """

    instants: Numbers
    displacement: Numbers
    place: Numbers

    @property
    def largest(self) -> float:
        """How far the centres are apart at most, in mm."""
        return float(numpy.linalg.norm(self.displacement, axis=1).max(initial=0.0))

    @property
    def _furthest(self) -> int:
        return int(numpy.linalg.norm(self.displacement, axis=1).argmax())

    def summary(self, use: Placed) -> dict[str, Any]:
        """For JSON."""
        first, last = (use.cycle.told(int(instant)) for instant in self.instants[[0, -1]])
        return {"from": first, "to": last, "largest_mm": self.largest, "place_deg": degrees(self.place[self._furthest])}

    def told(self, use: Placed) -> str:
        """A sentence: when, where, how far."""
        seen = self.summary(use)
        return (
            f"microseparation from {seen['from']} to {seen['to']}: the ball sits on the rim, its centre up to "
            f"{seen['largest_mm']:.2g} mm off, {abs(seen['place_deg']):.0f}° from the cup's uppermost point; what it "
            "wears there is not counted"
        )


def on_the_rim(use: Placed, instants: Numbers) -> Separation:
    """Where the ball rests in these instants, rigid and without friction on the edge of a rigid rim.

    The load points from the ball's centre to the edge that it rests on: c = R2 r - R1 f, the spring being shorter by
    what the ball has followed it.
    """
    spring = use.moved.spring
    assert spring is not None
    aside = numpy.sign(spring.mismatch) * numpy.array(use.placed.frame)[:, 0]
    low, high = numpy.zeros(len(instants)), numpy.full(len(instants), abs(spring.mismatch))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        short = _centre(use, instants, spring, aside, middle) @ aside > middle
        low, high = numpy.where(short, low, middle), numpy.where(short, middle, high)
    centre = _centre(use, instants, spring, aside, high)
    held = abs(centre @ aside - high) <= 1e-6 * abs(spring.mismatch)
    loads = _loads(use, instants, spring, aside, high)
    return Separation(
        instants=instants,
        displacement=numpy.where(held[:, None], centre, numpy.nan),
        place=numpy.arctan2(loads[:, 1], loads[:, 0]),
    )


def _loads(use: Placed, instants: Numbers, spring: Spring, aside: Numbers, followed: Numbers) -> Numbers:
    """Forces of a ball that has followed its spring so far, in N, in the cup's frame."""
    return use.forces[instants] - spring.stiffness * followed[:, None] * aside


def _centre(use: Placed, instants: Numbers, spring: Spring, aside: Numbers, followed: Numbers) -> Numbers:
    """The ball's centre in mm where it rests on the rim under these loads: (n, 3)."""
    loads = _loads(use, instants, spring, aside, followed)
    along = loads / numpy.linalg.norm(loads, axis=1)[:, None]
    across = loads[:, :2] / numpy.linalg.norm(loads[:, :2], axis=1)[:, None]
    edge = numpy.column_stack([numpy.sin(use.reach) * across, numpy.full(len(loads), numpy.cos(use.reach))])
    return float(use.joint.socket_radius) * edge - float(use.joint.ball_radius) * along
