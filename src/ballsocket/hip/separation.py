"""A ball that a spring has pushed out of its bore: at rest on the rim, until the load brings it back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, sin
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.deprecation import RenamedAttribute, renamed_fields
from .cycle import Cycle, Spring
from .mix import Mix

_HALVINGS = 60


@renamed_fields(instants="steps", place="azimuth")
@dataclass(frozen=True, kw_only=True, eq=False)
class Separation:
    """The instants of a cycle in which the ball sits on the rim of its cup.

    Attributes
    ----------
    steps : array (n,)
        Of the cycle.
    displacement : array (n, 3)
        Of the ball's centre from the bore's in mm, in the cup's frame; NaN where nothing holds it.
    azimuth : array (n,)
        Of the rim where it is touched, in rad around the cup's axis from its uppermost point.
    """

    steps: Numbers
    displacement: Numbers
    azimuth: Numbers
    told = RenamedAttribute("describe")

    @property
    def largest(self) -> float:
        """How far the centres are apart at most, in mm."""
        return float(numpy.linalg.norm(self.displacement, axis=1).max(initial=0.0))

    @property
    def _furthest(self) -> int:
        return int(numpy.linalg.norm(self.displacement, axis=1).argmax())

    def _ends(self, whole: int) -> tuple[int, int]:
        """The first and the last of the instants of so many in a cycle, which may pass from one into the next."""
        away = numpy.diff(self.steps, append=self.steps[0] + whole)
        longest = int(away.argmax())
        return int(self.steps[(longest + 1) % len(away)]), int(self.steps[longest])

    def summary(self, cycle: Cycle | Mix) -> dict[str, Any]:
        """For JSON."""
        first, last = (cycle.describe_step(instant) for instant in self._ends(cycle.n_steps))
        return {
            "from": first,
            "to": last,
            "largest_mm": self.largest,
            "place_deg": degrees(self.azimuth[self._furthest]),
        }

    def describe(self, cycle: Cycle | Mix) -> str:
        """A sentence: when, where, how far."""
        seen = self.summary(cycle)
        return (
            f"microseparation from {seen['from']} to {seen['to']}: the ball sits on the rim, its centre up to "
            f"{seen['largest_mm']:.2g} mm off, {abs(seen['place_deg']):.0f}° from the cup's uppermost point; what it "
            "wears there is not counted"
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Pulled:
    """A rigid ball that a spring pulls to the side, on the edge of a rigid rim without friction.

    The load points from the ball's centre to the edge that it rests on: c = R2 r - R1 f, the spring being shorter by
    what the ball has followed it.

    Attributes
    ----------
    spring : Spring
    side : array (3,)
        A unit vector to the spring's right, in the cup's frame.
    reach : float
        Where the bore ends, in rad from the dome's pole.
    socket_radius, ball_radius : float
        In mm.
    """

    spring: Spring
    side: Numbers
    reach: float
    socket_radius: float
    ball_radius: float

    @cached_property
    def _aside(self) -> Numbers:
        """Where the spring pulls to: (3,)."""
        return numpy.sign(self.spring.mismatch) * self.side

    def beyond(self, forces: Numbers) -> Numbers:
        """Whether a ball under forces (n, 3) that point beyond the rim leaves its bore, where its spring lets it.

        It stays where the clearance alone lets it follow so far that it would be held.
        """
        followed = numpy.zeros(len(forces))
        out: Numbers = self._centre(forces, followed) @ self._aside <= followed
        return out

    def rest(self, forces: Numbers, steps: Numbers) -> Separation:
        """Where the ball rests in these instants under forces (n, 3), those of a spring that it has not followed."""
        furthest = abs(self.spring.mismatch)
        low, high = numpy.zeros(len(forces)), numpy.full(len(forces), furthest)
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            short = self._centre(forces, middle) @ self._aside > middle
            low, high = numpy.where(short, low, middle), numpy.where(short, middle, high)
        centre = self._centre(forces, high)
        held = abs(centre @ self._aside - high) <= 1e-6 * furthest
        loads = self._loads(forces, high)
        return Separation(
            steps=steps,
            displacement=numpy.where(held[:, None], centre, numpy.nan),
            azimuth=numpy.arctan2(loads[:, 1], loads[:, 0]),
        )

    def _loads(self, forces: Numbers, followed: Numbers) -> Numbers:
        """Forces of a ball that has followed its spring so far, in N: (n, 3)."""
        return forces - self.spring.stiffness * followed[:, None] * self._aside

    def _centre(self, forces: Numbers, followed: Numbers) -> Numbers:
        """The ball's centre in mm where it rests on the rim under these loads: (n, 3)."""
        loads = self._loads(forces, followed)
        along = loads / numpy.linalg.norm(loads, axis=1)[:, None]
        across = loads[:, :2] / numpy.linalg.norm(loads[:, :2], axis=1)[:, None]
        edge = numpy.column_stack([sin(self.reach) * across, numpy.full(len(loads), cos(self.reach))])
        return self.socket_radius * edge - self.ball_radius * along
