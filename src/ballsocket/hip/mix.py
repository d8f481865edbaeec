"""Mix of activities, as one mean cycle of load and motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import ClassVar

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .cycle import Cycle, Frame


@dataclass(frozen=True, kw_only=True, eq=False)
class Activity:
    """Activity of a patient: a cycle of load and motion, and the number of these cycles a year.

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


@dataclass(frozen=True, kw_only=True, eq=False)
class Mix:
    """Mix of activities of a patient, weighted by their numbers of cycles a year.

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

    frame: ClassVar[Frame] = Frame.BODY  # reference frame of the forces
    spring: ClassVar[None] = None  # activities of a mix have no lateral spring

    def __post_init__(self) -> None:
        if not self.activities:
            raise ValueError("a mix needs at least one activity")
        for cycle in self.activity_cycles:
            if cycle.frame is not Frame.BODY or cycle.spring is not None:
                raise ValueError(f"{cycle.name} has forces in the cup's frame, or a spring: it cannot be part of a mix")

    @property
    def activity_cycles(self) -> tuple[Cycle, ...]:
        return tuple(activity.cycle for activity in self.activities)

    @property
    def per_year(self) -> float:
        """Number of cycles of all activities a year."""
        return sum(activity.per_year for activity in self.activities)

    @property
    def fractions(self) -> tuple[float, ...]:
        """Number of cycles of each activity divided by that of all activities."""
        return tuple(activity.per_year / self.per_year for activity in self.activities)

    @property
    def name(self) -> str:
        """Names of the activities, joined by "+"."""
        return " + ".join(cycle.name for cycle in self.activity_cycles)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the activities for reports, without repetitions."""
        notes = dict.fromkeys(note for cycle in self.activity_cycles for note in cycle.notes)
        if len({cycle.cup_tilt for cycle in self.activity_cycles}) > 1:
            notes["no standard tilt of the cup is applied: the activities have different ones"] = None
        return tuple(notes)

    @property
    def remark(self) -> str:
        """Lines of the files of the activities that were left out."""
        return "; ".join(cycle.remark for cycle in self.activity_cycles if cycle.remark)

    @property
    def cup_tilt(self) -> float | None:
        """Tilt of the cup in rad by a standard; None if the activities have different ones."""
        tilts = {cycle.cup_tilt for cycle in self.activity_cycles}
        return tilts.pop() if len(tilts) == 1 else None

    @property
    def n_steps(self) -> int:
        """Number of time steps of all activities together."""
        return sum(cycle.n_steps for cycle in self.activity_cycles)

    @property
    def phases(self) -> Numbers:
        """Phases from 0 to 1 at the midpoints of all steps, one activity after the other: (steps,)."""
        return (numpy.arange(self.n_steps) + 0.5) / self.n_steps

    @property
    def duration(self) -> float:
        """Duration of the mean cycle in s."""
        return float(self.seconds.sum())

    @cached_property
    def seconds(self) -> Numbers:
        """Duration of each step in s, multiplied by the fraction of its activity: (steps,)."""
        return self._join_weighted_values(lambda cycle: cycle.seconds)

    @cached_property
    def forces(self) -> Numbers:
        """Force vectors in N at the midpoints of the steps: (steps, 3)."""
        return numpy.concatenate([cycle.forces for cycle in self.activity_cycles])

    @cached_property
    def force_magnitudes(self) -> Numbers:
        """Magnitudes of the forces in N at the midpoints of the steps: (steps,)."""
        return numpy.linalg.norm(self.forces, axis=1)

    @cached_property
    def midpoint_rotations(self) -> Numbers:
        """Rotation matrices of the ball at the midpoints of the steps: (steps, 3, 3)."""
        return numpy.concatenate([cycle.midpoint_rotations for cycle in self.activity_cycles])

    @cached_property
    def rotation_increments(self) -> Numbers:
        """Rotation vectors in rad of the steps, multiplied by the fraction of the activity: (steps, 3)."""
        return self._join_weighted_values(lambda cycle: cycle.rotation_increments)

    def _join_weighted_values(self, values_of: Callable[[Cycle], Numbers]) -> Numbers:
        """Join values of the steps of all activities, each multiplied by the fraction of its activity."""
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
        """Describe activity and time of a step in words, such as "12.5 % of walking"."""
        for cycle in self.activity_cycles:
            if step < cycle.n_steps:
                return f"{100 * cycle.phases[step]:.1f} % of {cycle.name}"
            step -= cycle.n_steps
        raise IndexError(step)

    def finer(self) -> Mix:
        """Return this mix with twice as many time steps in each activity."""
        return self.transformed(lambda cycle: cycle.finer())

    def mirrored(self) -> Mix:
        """Return this mix for the other side of the body: lateral forces and rotations change sign."""
        return self.transformed(lambda cycle: cycle.mirrored())

    def scaled(self, factor: float) -> Mix:
        """Return this mix with all forces multiplied by a factor."""
        return self.transformed(lambda cycle: cycle.scaled(factor))

    def transformed(self, transform: Callable[[Cycle], Cycle]) -> Mix:
        """Return this mix with each cycle replaced by the result of a function of that cycle."""
        return Mix(activities=tuple(replace(activity, cycle=transform(activity.cycle)) for activity in self.activities))
