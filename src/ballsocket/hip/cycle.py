"""Cycles of load and motion, and the definition of a cycle by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from math import inf
from typing import Any, ClassVar

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_whole_number, require
from ..core.kinds import Kind
from ..core.records import cached_array
from .kinematics import parse_rotation_order, rotation_matrices, rotation_vectors

DEFAULT_STEPS = 100  # number of time steps of a cycle, unless another is set

MIN_STEPS, MAX_STEPS = 8, 10_000
_PEAK_SAMPLES = 10_000  # number of intervals in which the largest force of a cycle is searched

PhaseFunction = Callable[[Numbers], Numbers]
"""Function from phases 0 to 1 of a cycle to a quantity, with the phases as the last axis."""


class Frame(Enum):
    """Reference frame of the forces of a cycle: the body or the cup.

    In the cup, x points upwards along the rim's plane and z to the dome.
    """

    BODY = "body"
    CUP = "cup"


@dataclass(frozen=True, kw_only=True)
class Spring:
    """Lateral spring between ball and socket, which pulls their centres apart by a mismatch.

    It pulls the ball to the side while the load is small.

    Attributes
    ----------
    stiffness : float
        Stiffness in N/mm.
    mismatch : float
        Offset of the centres in mm that the ball would follow: positive to the right, negative to the left.
    """

    stiffness: float
    mismatch: float

    def __post_init__(self) -> None:
        require("stiffness", self.stiffness, 0 < self.stiffness < inf, "a stiffness (N/mm) is positive and finite")
        require("mismatch", self.mismatch, 0 < abs(self.mismatch) < inf, "a mismatch (mm) is not zero, and finite")

    @property
    def force(self) -> float:
        """Spring force in N on an undisplaced ball, to the right."""
        return self.stiffness * self.mismatch


@dataclass(frozen=True, kw_only=True, eq=False)
class Cycle:
    """Cycle of load and motion, divided into time steps of equal length.

    Directions are those of the body, or of the machine: x to the side (lateral), y to the front, z upwards. The socket
    stands still. The ball rotates by R, the product of flexion about x, adduction about y and inward rotation about z.
    Lateral is to the right here; a simulation of a left hip mirrors the cycle.

    Parameters
    ----------
    name : str
    force : function
        Function from phases (n,) in 0 to 1 to forces of the ball on the socket (3, n) in N, or to upward forces (n,).
        An upward force below 0 counts as no contact.
    angles : function
        Function from phases to flexion, adduction and rotation (3, n) in rad.
    n_steps : int
        Number of time steps.
    order : str
        Order in which the rotations are multiplied: "xyz" is R = Rx Ry Rz.
    duration : float
        Duration in s.
    cup_tilt : float, optional
        Angle in rad between cup axis and load that a standard prescribes.
    notes : tuple of str
        Notes for reports.
    remark : str
        Rows of the file that were read, and lines that were left out; empty without such lines.
    frame : Frame
        Reference frame of the forces; the body's by default.
    spring : Spring, optional
        Spring that pushes the ball to the side, in addition to the force.

    Raises
    ------
    ValueError
        A force or angle is not finite, or the number of steps or the order is invalid.
    """

    name: str
    force: PhaseFunction
    angles: PhaseFunction
    n_steps: int = DEFAULT_STEPS
    order: str = "xyz"
    duration: float = 1.0
    cup_tilt: float | None = None
    notes: tuple[str, ...] = ()
    frame: Frame = Frame.BODY
    spring: Spring | None = None
    remark: str = ""

    per_year: ClassVar[None] = None  # number of cycles a year, which only a `Mix` states

    def __post_init__(self) -> None:
        check_step_count(self.n_steps)
        object.__setattr__(self, "order", parse_rotation_order(self.order))
        for name, values in {"force": self.forces, "angle": self.rotations}.items():
            require(name, values, numpy.isfinite(values), "the numbers of a cycle are finite")

    @property
    def phases(self) -> Numbers:
        """Phases from 0 to 1 at the midpoints of the steps: (steps,)."""
        return (numpy.arange(self.n_steps) + 0.5) / self.n_steps

    @cached_array
    def forces(self) -> Numbers:
        """Force vectors in N at the midpoints of the steps: (steps, 3)."""
        return self._forces_at(self.phases)

    def _forces_at(self, phases: Numbers) -> Numbers:
        """Compute the force vectors (n, 3) in N at phases from 0 to 1, including the force of the spring."""
        force = numpy.asarray(self.force(phases), dtype=float)
        if force.ndim == 1:
            upward_force = numpy.maximum(force, 0.0)
            force = numpy.stack([0 * upward_force, 0 * upward_force, upward_force])
        if self.spring is not None:
            force = force + self.spring.force * _RIGHT
        return numpy.ascontiguousarray(force.T)

    @cached_property
    def largest_force(self) -> float:
        """Largest magnitude of the force in N during the cycle, also between the midpoints of steps."""
        return float(numpy.linalg.norm(self._forces_at(numpy.linspace(0.0, 1.0, _PEAK_SAMPLES + 1)), axis=1).max())

    @cached_array
    def force_magnitudes(self) -> Numbers:
        """Magnitudes of the forces in N at the midpoints of the steps: (steps,)."""
        return numpy.linalg.norm(self.forces, axis=1)

    @cached_array
    def rotations(self) -> Numbers:
        """Rotation matrices of the ball at the ends of the steps (steps + 1, 3, 3); the last equals the first."""
        angles = numpy.asarray(self.angles(numpy.arange(self.n_steps) / self.n_steps), dtype=float).T
        matrices = rotation_matrices(angles, self.order)
        return numpy.concatenate([matrices, matrices[:1]])

    @cached_array
    def midpoint_rotations(self) -> Numbers:
        """Rotation matrices of the ball at the midpoints of the steps: (steps, 3, 3)."""
        return rotation_matrices(numpy.asarray(self.angles(self.phases), dtype=float).T, self.order)

    @cached_array
    def rotation_increments(self) -> Numbers:
        """Rotation vectors in rad of the ball during each step: (steps, 3)."""
        return rotation_vectors(self.rotations[1:] @ self.rotations[:-1].swapaxes(1, 2))

    @property
    def seconds(self) -> Numbers:
        """Duration of each step in s: (steps,)."""
        return numpy.full(self.n_steps, self.duration / self.n_steps)

    @property
    def activity_cycles(self) -> tuple[Cycle, ...]:
        """Cycles of all activities: this cycle alone, because only a `Mix` has several."""
        return (self,)

    @property
    def activity_slices(self) -> tuple[tuple[str, slice], ...]:
        """Name and range of steps of each activity: one entry, because only a `Mix` has several."""
        return ((self.name, slice(0, self.n_steps)),)

    def describe_step(self, step: int) -> str:
        """Describe the time of a step in words, such as "12.5 % of the cycle"."""
        return f"{100 * self.phases[step]:.1f} % of the cycle"

    def finer(self) -> Cycle:
        """Return this cycle with twice as many time steps, up to the largest allowed number."""
        return replace(self, n_steps=min(2 * self.n_steps, MAX_STEPS))

    def transformed(self, transform: Callable[[Cycle], Cycle]) -> Cycle:
        """Return the result of a function of this cycle; a `Mix` applies it to each of its cycles."""
        return transform(self)

    def mirrored(self) -> Cycle:
        """Return this cycle for the other side of the body: lateral forces and rotations change sign."""

        def mirrored_force(phases: Numbers) -> Numbers:
            force = numpy.asarray(self.force(phases), dtype=float)
            return force if force.ndim == 1 or self.frame is Frame.CUP else _MIRRORED_FORCE * force

        # M Rx(a) Ry(b) Rz(c) M = Rx(a) Ry(-b) Rz(-c), M = diag(-1, 1, 1)
        spring = self.spring
        if spring is not None and self.frame is Frame.BODY:
            spring = replace(spring, mismatch=-spring.mismatch)
        return replace(
            self, force=mirrored_force, angles=lambda phases: _MIRRORED_ANGLES * self.angles(phases), spring=spring
        )

    def scaled(self, factor: float) -> Cycle:
        """Return this cycle with all forces multiplied by a factor."""
        return replace(self, force=lambda phases: factor * self.force(phases))


_RIGHT = numpy.array([[1.0], [0.0], [0.0]])
_MIRRORED_FORCE = numpy.array([[-1.0], [1.0], [1.0]])
_MIRRORED_ANGLES = numpy.array([[1.0], [-1.0], [-1.0]])


def check_step_count(count: Any) -> int:
    """Check a number of time steps and return it; ValueError if it is not allowed."""
    return check_whole_number("n_steps", count, MIN_STEPS, MAX_STEPS)


@dataclass(frozen=True, kw_only=True)
class CycleParameter:
    """Adjustable number of a named cycle: its key in files, argument and kind of quantity.

    Attributes
    ----------
    key : str
        Name in files.
    argument : str
        Name of the argument of the function.
    kind : Kind
        Kind of quantity, which sets the allowed units.
    meaning : str
        Noun phrase for the reference of hip files and for editors; by default the key.
    """

    key: str
    argument: str
    kind: Kind
    meaning: str = ""


@dataclass(frozen=True, kw_only=True)
class CycleDefinition:
    """Definition of a named cycle: function, source and parameters.

    Attributes
    ----------
    name : str
        Name in Python, files, JSON and the explorer, in small letters with hyphens.
    make : function
        Function from the number of steps, the rotation order and the parameters to a `Cycle`. If `per_body_weight`, it
        also takes `body_weight` in N.
    source : str
        Publication, standard or assumption that the cycle is based on.
    parameters : tuple of CycleParameter
        Numbers that a file may set; their defaults are those of the function.
    per_body_weight : bool
        True if loads are multiples of the body weight, which is then required; False if loads are in N.
    """

    name: str
    make: Callable[..., Cycle]
    source: str
    parameters: tuple[CycleParameter, ...] = ()
    per_body_weight: bool = False
