"""A cycle as a cup finds it: loads and turns in the cup's own frame, and where the ball is held."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import degrees

import numpy

from ..core.arrays import Numbers
from ..core.deprecation import RenamedAttribute
from ..problem import Joint
from ..problem.cup import Cup, Side
from .cycle import Cycle, Frame
from .kinematics import sliding_distance
from .mix import Mix
from .rim import Microseparation, SpringLoadedBall

_LIFTED = 1e-6
"""Of the largest force: below, the ball is taken to be lifted off."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Placed:
    """A joint in a cup that goes through a cycle.

    Attributes
    ----------
    joint : Joint
        Of plain numbers.
    cycle : Cycle or Mix
        In the body's frame, as the cup's orientation is. On a left cup it is mirrored.
    cup : Cup
        Arc of cover and orientation. A cup without a given orientation takes the tilt of the cycle's standard.
    """

    joint: Joint
    cycle: Cycle | Mix
    cup: Cup = Cup()  # noqa: RUF009 (frozen)
    turns = RenamedAttribute("rotation_increments")

    def _check_held(self) -> None:
        out = self._over
        if self.separation is not None:
            out = out[numpy.isnan(self.separation.displacement[:, 0])]
        if len(out):
            first = out[0]
            raise ValueError(
                f"dislocated at {self.cycle.describe_step(first)}: the load of "
                f"{numpy.linalg.norm(self.forces[first]):.0f} N points "
                f"{degrees(self._tilts[first]):.1f}° from the dome's pole, and the bore ends at "
                f"{degrees(self.reach):.1f}°"
            )

    @cached_property
    def moved(self) -> Cycle | Mix:
        """The cycle on the side of the body that the cup belongs to."""
        return self.cycle.mirrored() if self.cup.side is Side.LEFT else self.cycle

    @cached_property
    def forces(self) -> Numbers:
        """Forces of the ball on the socket in N, in the cup's frame: (instants, 3)."""
        given = self.moved.forces
        return given if self.cycle.frame is Frame.CUP else _in_cup(self.placed, given)

    @property
    def _tilts(self) -> Numbers:
        """Angles of the forces from the dome's pole, in rad: (instants,)."""
        return numpy.arctan2(numpy.hypot(self.forces[:, 0], self.forces[:, 1]), self.forces[:, 2])

    @cached_property
    def _pressed(self) -> Numbers:
        """Whether there is a load at all: (instants,)."""
        sizes = self.cycle.force_magnitudes
        return numpy.asarray(sizes > _LIFTED * max(float(sizes.max()), 1e-300))

    @cached_property
    def _pulled(self) -> SpringLoadedBall | None:
        """The ball on its spring; None where it has none."""
        spring = self.moved.spring
        if spring is None:
            return None
        return SpringLoadedBall(
            spring=spring,
            side=self._side,
            reach=self.reach,
            socket_radius=float(self.joint.socket_radius),
            ball_radius=float(self.joint.ball_radius),
        )

    @property
    def _side(self) -> Numbers:
        """The first axis of the frame that forces and springs are told in, in the cup's own: (3,)."""
        return numpy.array([1.0, 0.0, 0.0] if self.cycle.frame is Frame.CUP else numpy.array(self.placed.frame)[:, 0])

    @cached_property
    def tether(self) -> Numbers:
        """The stiffness of the cycle's spring in N/mm: what it pulls less by what the ball has moved, (3, 3)."""
        spring = self.moved.spring
        return numpy.outer(self._side, self._side) * (0.0 if spring is None else spring.stiffness)

    def carried(self, displacement: Numbers) -> Numbers:
        """What bores carry of the loads in N, with balls displaced so far in mm: (loaded, 3)."""
        return self.loads - displacement @ self.tether

    @cached_property
    def _over(self) -> Numbers:
        """The instants in which the load pushes the ball over the rim."""
        found = numpy.flatnonzero(self._pressed & (self._tilts >= self.reach))
        return found if self._pulled is None else found[self._pulled.leaves_bore(self.forces[found])]

    @cached_property
    def separation(self) -> Microseparation | None:
        """The instants in which a spring has pushed the ball onto the rim; None where it never does."""
        over = self._over
        return None if self._pulled is None or not len(over) else self._pulled.solve_separation(self.forces[over], over)

    @cached_property
    def placed(self) -> Cup:
        """Cup of the run: with its own orientation if set, else with the tilt of the cycle's standard."""
        tilt = self.cycle.cup_tilt
        return self.cup if self.cup.oriented or tilt is None else self.cup.tilted(tilt)

    @property
    def reach(self) -> float:
        """Where the bore ends, in rad from the dome's pole."""
        return float(self.cup.rim - self.cup.chamfer / self.joint.socket_radius)

    @cached_property
    def loaded(self) -> Numbers:
        """The instants in which the ball is pressed into the bore."""
        within = self._pressed.copy()
        within[self._over] = False
        return numpy.flatnonzero(within)

    @cached_property
    def loads(self) -> Numbers:
        """The forces of those instants in the cup's frame: (loaded, 3)."""
        return numpy.ascontiguousarray(self.forces[self.loaded])

    @property
    def largest(self) -> Numbers:
        """Which of the loads is the largest: one number, or none where there are no loads."""
        sizes = numpy.linalg.norm(self.loads, axis=1)
        return numpy.flatnonzero(sizes == sizes.max(initial=0.0))[:1]

    @cached_property
    def rotation_increments(self) -> Numbers:
        """How the ball turns in those instants, in the cup's frame: (loaded, 3)."""
        return _in_cup(self.placed, self.moved.rotation_increments[self.loaded])

    @property
    def slide(self) -> float:
        """How far the ball slides past the loads' line in a cycle, in mm."""
        sizes = self.cycle.force_magnitudes[:, None]
        along = numpy.divide(self.forces, sizes, out=numpy.zeros_like(self.forces), where=sizes > 0)
        return sliding_distance(
            float(self.joint.ball_radius),
            _in_cup(self.placed, self.moved.rotation_increments),
            _held(along, self.loaded),
        )

    @property
    def _placing_notes(self) -> tuple[str, ...]:
        """What is to be said of where the cup faces, and of a ball that is not in it all the time."""
        placed = () if self.placed == self.cup else (_PLACED.format(degrees(self.cycle.cup_tilt or 0.0)),)
        apart = () if self.separation is None else (self.separation.describe(self.cycle),)
        return (*placed, *self._lifted, *apart)

    @property
    def _lifted(self) -> tuple[str, ...]:
        """When the ball is lifted off, in a sentence."""
        off = numpy.flatnonzero(~self._pressed)
        if len(off) == self.cycle.n_steps:
            return (_NEVER,)
        return (_LIFTS.format(self.cycle.describe_step(int(off[0])), len(off), self.cycle.n_steps),) if len(off) else ()


_PLACED = "the cup is tilted by {:g}° from the load, as the cycle's standard has it"
_NEVER = "nothing is ever pressed or worn: the loads are zero, or pull the ball off its socket all the time"
_LIFTS = "the ball lifts off, first at {}, and comes down again: in {} of {} instants nothing is pressed or worn"


def _in_cup(cup: Cup, vectors: Numbers) -> Numbers:
    """Vectors (n, 3) of the body in the cup's own frame."""
    return numpy.ascontiguousarray(vectors @ numpy.array(cup.frame).T)


def _held(along: Numbers, loaded: Numbers) -> Numbers:
    """Directions of the loads; where there is none, the last one that was."""
    if not len(loaded):
        return along
    last = numpy.searchsorted(loaded, numpy.arange(len(along)), side="right") - 1
    return along[loaded[last]]
