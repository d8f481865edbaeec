"""A mix of activities: what a patient goes through in a year, as one cycle of them all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.deprecation import RenamedAttribute
from .cycle import Cycle, Frame


@dataclass(frozen=True, kw_only=True, eq=False)
class Activity:
    """What a patient does so often a year.

    Parameters
    ----------
    cycle : Cycle
    per_year : float
        How many of its cycles.
    """

    cycle: Cycle
    per_year: float

    def __post_init__(self) -> None:
        require("per_year", self.per_year, 0 < self.per_year < inf, "a number of cycles a year is positive and finite")


@dataclass(frozen=True, kw_only=True, eq=False)
class Mix:
    """Activities, each as often as a patient does it: a cycle of the mix is the mean of theirs.

    Every instant of every activity counts as its share of the cycles: it slides so much less, and lasts so much less.
    Wear that follows from pressures and slides is then that of all of them together.

    Parameters
    ----------
    activities : tuple of Activity

    Raises
    ------
    ValueError
        None at all, or loads in other frames, or with springs.

    Examples
    --------
    >>> from ballsocket.hip import Activity, Mix, flexion, iso_14242_1
    >>> mix = Mix(activities=(Activity(cycle=iso_14242_1(), per_year=1e6), Activity(cycle=flexion(), per_year=5e4)))
    >>> mix.per_year
    1050000.0
    """

    activities: tuple[Activity, ...]

    instants = RenamedAttribute("n_steps")
    sizes = RenamedAttribute("force_magnitudes")
    middles = RenamedAttribute("midpoint_rotations")
    turns = RenamedAttribute("rotation_increments")
    told = RenamedAttribute("describe_step")

    def __post_init__(self) -> None:
        if not self.activities:
            raise ValueError("a mix has at least one activity")
        for each in self._cycles:
            if each.frame is not Frame.BODY or each.spring is not None:
                raise ValueError(
                    f"{each.name} is in the frame of a cup, or has a spring: it cannot be mixed with others"
                )

    @property
    def _cycles(self) -> tuple[Cycle, ...]:
        return tuple(each.cycle for each in self.activities)

    @property
    def per_year(self) -> float:
        """Cycles of all activities together."""
        return sum(each.per_year for each in self.activities)

    @property
    def shares(self) -> tuple[float, ...]:
        """Shares of the activities in the cycles."""
        return tuple(each.per_year / self.per_year for each in self.activities)

    @property
    def name(self) -> str:
        return " + ".join(each.name for each in self._cycles)

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be said of the activities, each sentence once."""
        said = tuple(dict.fromkeys(note for each in self._cycles for note in each.notes))
        return said if len({each.cup_tilt for each in self._cycles}) == 1 else (*said, _AS_GIVEN)

    @property
    def cup_tilt(self) -> float | None:
        """The tilt of a standard, if all activities have the same."""
        found = {each.cup_tilt for each in self._cycles}
        return found.pop() if len(found) == 1 else None

    @property
    def frame(self) -> Frame:
        return Frame.BODY

    @property
    def spring(self) -> None:
        return None

    @property
    def n_steps(self) -> int:
        return sum(each.n_steps for each in self._cycles)

    @property
    def phases(self) -> Numbers:
        """The middle of each instant, 0 to 1, one activity after the other."""
        return (numpy.arange(self.n_steps) + 0.5) / self.n_steps

    @property
    def duration(self) -> float:
        """Seconds that the mean cycle lasts."""
        return float(self.seconds.sum())

    @cached_property
    def seconds(self) -> Numbers:
        """That each instant counts for: (instants,)."""
        return self._shared(lambda cycle: cycle.seconds)

    @cached_property
    def forces(self) -> Numbers:
        """In N: (instants, 3)."""
        return numpy.concatenate([each.forces for each in self._cycles])

    @cached_property
    def force_magnitudes(self) -> Numbers:
        """Sizes of the forces in N: (instants,)."""
        return numpy.linalg.norm(self.forces, axis=1)

    @cached_property
    def midpoint_rotations(self) -> Numbers:
        """Rotation matrices of the ball in the middle of the instants: (instants, 3, 3)."""
        return numpy.concatenate([each.midpoint_rotations for each in self._cycles])

    @cached_property
    def rotation_increments(self) -> Numbers:
        """How the ball turns during each instant, as often as that is: rotation vectors in rad, (instants, 3)."""
        return self._shared(lambda cycle: cycle.rotation_increments)

    def _shared(self, of: Callable[[Cycle], Numbers]) -> Numbers:
        return numpy.concatenate([share * of(each) for share, each in zip(self.shares, self._cycles, strict=True)])

    @property
    def rotations(self) -> Numbers:
        """Rotations of the ball in what is done most often: (n, 3, 3)."""
        return max(self.activities, key=lambda each: each.per_year).cycle.rotations

    @property
    def largest_force(self) -> float:
        """The largest force of all activities, in N."""
        return max(each.largest_force for each in self._cycles)

    @property
    def activity_slices(self) -> tuple[tuple[str, slice], ...]:
        """Name and instants of each activity."""
        begin, slices = 0, []
        for cycle in self._cycles:
            slices.append((cycle.name, slice(begin, begin + cycle.n_steps)))
            begin += cycle.n_steps
        return tuple(slices)

    def describe_step(self, instant: int) -> str:
        """Where in which activity an instant is, in words."""
        for each in self._cycles:
            if instant < each.n_steps:
                return f"{100 * each.phases[instant]:.1f} % of {each.name}"
            instant -= each.n_steps
        raise IndexError(instant)

    def finer(self) -> Mix:
        """This mix in twice as many instants."""
        return self._of(lambda cycle: cycle.finer())

    def mirrored(self) -> Mix:
        """What the other side of the body goes through."""
        return self._of(lambda cycle: cycle.mirrored())

    def scaled(self, factor: float) -> Mix:
        """A mix of these motions under forces that are larger by a factor."""
        return self._of(lambda cycle: cycle.scaled(factor))

    def _of(self, change: Callable[[Cycle], Cycle]) -> Mix:
        return Mix(activities=tuple(replace(each, cycle=change(each.cycle)) for each in self.activities))


_AS_GIVEN = "the cup faces as it is given: the activities have no tilt of a standard in common"
