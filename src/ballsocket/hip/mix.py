"""Mix of activities, as one mean cycle of load and motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.deprecation import renamed_fields
from .cycle import Cycle, Frame


@dataclass(frozen=True, kw_only=True, eq=False)
class Activity:
    """Activity of a patient: a cycle of load and motion, and its number a year.

    Parameters
    ----------
    cycle : Cycle
        Cycle of the activity.
    per_year : float
        Number of its cycles a year.
    """

    cycle: Cycle
    per_year: float

    def __post_init__(self) -> None:
        require("per_year", self.per_year, 0 < self.per_year < inf, "a number of cycles a year is positive and finite")


@renamed_fields(
    instants="n_steps",
    sizes="force_magnitudes",
    middles="midpoint_rotations",
    turns="rotation_increments",
    told="describe_step",
    shares="fractions",
)
@dataclass(frozen=True, kw_only=True, eq=False)
class Mix:
    """Mix of activities, weighted by their numbers of cycles a year.

    A cycle of the mix is the mean cycle. Rotation increment and duration of each step are multiplied by the fraction
    of its activity in all cycles. Wear from pressures and sliding distances is then the wear of all activities.

    Parameters
    ----------
    activities : tuple of Activity
        Activities of the mix.

    Raises
    ------
    ValueError
        The mix is empty, or a cycle has forces in the cup's frame or a spring.

    Examples
    --------
    >>> from ballsocket.hip import Activity, Mix, flexion, iso_14242_1
    >>> mix = Mix(activities=(Activity(cycle=iso_14242_1(), per_year=1e6), Activity(cycle=flexion(), per_year=5e4)))
    >>> mix.per_year
    1050000.0
    """

    activities: tuple[Activity, ...]

    def __post_init__(self) -> None:
        if not self.activities:
            raise ValueError("a mix needs at least one activity")
        for cycle in self.activity_cycles:
            if cycle.frame is not Frame.BODY or cycle.spring is not None:
                raise ValueError(f"{cycle.name} has forces in the cup's frame, or a spring: it cannot be part of a mix")

    @property
    def activity_cycles(self) -> tuple[Cycle, ...]:
        """Cycles of the activities."""
        return tuple(activity.cycle for activity in self.activities)

    @property
    def per_year(self) -> float:
        """Total number of cycles a year."""
        return sum(activity.per_year for activity in self.activities)

    @property
    def fractions(self) -> tuple[float, ...]:
        """Fraction of each activity in all cycles."""
        return tuple(activity.per_year / self.per_year for activity in self.activities)

    @property
    def name(self) -> str:
        """Names of the activities, joined by +."""
        return " + ".join(cycle.name for cycle in self.activity_cycles)

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of the activities for reports, without repetitions."""
        notes = tuple(dict.fromkeys(note for cycle in self.activity_cycles for note in cycle.notes))
        return notes if len({cycle.cup_tilt for cycle in self.activity_cycles}) == 1 else (*notes, _NO_COMMON_TILT)

    @property
    def cup_tilt(self) -> float | None:
        """Tilt of the cup in rad by a standard, if it is the same for all activities."""
        tilts = {cycle.cup_tilt for cycle in self.activity_cycles}
        return tilts.pop() if len(tilts) == 1 else None

    @property
    def frame(self) -> Frame:
        """Reference frame of the forces: the body."""
        return Frame.BODY

    @property
    def spring(self) -> None:
        """Lateral spring: always None."""
        return None

    @property
    def n_steps(self) -> int:
        """Number of steps of all activities."""
        return sum(cycle.n_steps for cycle in self.activity_cycles)

    @property
    def phases(self) -> Numbers:
        """Phases from 0 to 1 at the midpoints of the steps, one activity after the other: (steps,)."""
        return (numpy.arange(self.n_steps) + 0.5) / self.n_steps

    @property
    def duration(self) -> float:
        """Duration of the mean cycle in s."""
        return float(self.seconds.sum())

    @cached_property
    def seconds(self) -> Numbers:
        """Duration of each step in s, times the fraction of its activity: (steps,)."""
        return self._weighted(lambda cycle: cycle.seconds)

    @cached_property
    def forces(self) -> Numbers:
        """Forces at the midpoints of the steps in N: (steps, 3)."""
        return numpy.concatenate([cycle.forces for cycle in self.activity_cycles])

    @cached_property
    def force_magnitudes(self) -> Numbers:
        """Magnitudes of the forces in N: (steps,)."""
        return numpy.linalg.norm(self.forces, axis=1)

    @cached_property
    def midpoint_rotations(self) -> Numbers:
        """Rotation matrices of the ball at the midpoints of the steps: (steps, 3, 3)."""
        return numpy.concatenate([cycle.midpoint_rotations for cycle in self.activity_cycles])

    @cached_property
    def rotation_increments(self) -> Numbers:
        """Rotation of the ball during each step in rad, times the fraction of its activity: (steps, 3)."""
        return self._weighted(lambda cycle: cycle.rotation_increments)

    def _weighted(self, values_of: Callable[[Cycle], Numbers]) -> Numbers:
        """Concatenate values of all steps, each multiplied by the fraction of its activity."""
        return numpy.concatenate(
            [fraction * values_of(cycle) for fraction, cycle in zip(self.fractions, self.activity_cycles, strict=True)]
        )

    @property
    def rotations(self) -> Numbers:
        """Rotation matrices of the ball in the most frequent activity: (steps + 1, 3, 3)."""
        return max(self.activities, key=lambda activity: activity.per_year).cycle.rotations

    @property
    def largest_force(self) -> float:
        """Largest force of all activities in N."""
        return max(cycle.largest_force for cycle in self.activity_cycles)

    @property
    def activity_slices(self) -> tuple[tuple[str, slice], ...]:
        """Name and range of steps of each activity."""
        begin, slices = 0, []
        for cycle in self.activity_cycles:
            slices.append((cycle.name, slice(begin, begin + cycle.n_steps)))
            begin += cycle.n_steps
        return tuple(slices)

    def describe_step(self, step: int) -> str:
        """Describe the activity and phase of a step in words."""
        for cycle in self.activity_cycles:
            if step < cycle.n_steps:
                return f"{100 * cycle.phases[step]:.1f} % of {cycle.name}"
            step -= cycle.n_steps
        raise IndexError(step)

    def finer(self) -> Mix:
        """Return this mix with twice as many steps."""
        return self.transformed(lambda cycle: cycle.finer())

    def mirrored(self) -> Mix:
        """Return this mix for the other side of the body."""
        return self.transformed(lambda cycle: cycle.mirrored())

    def scaled(self, factor: float) -> Mix:
        """Return this mix with all forces multiplied by a factor."""
        return self.transformed(lambda cycle: cycle.scaled(factor))

    def transformed(self, transform: Callable[[Cycle], Cycle]) -> Mix:
        """Return this mix with a function applied to the cycle of each activity."""
        return Mix(activities=tuple(replace(activity, cycle=transform(activity.cycle)) for activity in self.activities))


_NO_COMMON_TILT = "no standard tilt of the cup is applied: the activities have different ones"
