"""A cycle of load and motion: what a hip goes through in a step, as a value."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property
from math import inf
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require, shown
from ..core.deprecation import RenamedAttribute, renamed_fields
from .sliding import rotation_matrices, rotation_vectors

DEFAULT_STEPS = 100
_FEWEST, _MOST = 8, 10_000
_FINE = 10_000

Course = Callable[[Numbers], Numbers]
"""From phases 0 to 1 of a cycle to a quantity, with the phases as the last axis."""


class Frame(Enum):
    """Whose directions forces have: the body's, or the cup's, x upwards along its rim, z to its dome."""

    BODY = "body"
    CUP = "cup"


@dataclass(frozen=True, kw_only=True)
class Spring:
    """A spring that pulls the ball to the side while the load is small, as of a socket that is set off from the ball.

    Attributes
    ----------
    stiffness : float
        In N/mm.
    mismatch : float
        Of the centres in mm, to the right: so far the ball would follow. Below 0 it is to the left.
    """

    stiffness: float
    mismatch: float

    def __post_init__(self) -> None:
        require("stiffness", self.stiffness, 0 < self.stiffness < inf, "a stiffness (N/mm) is positive and finite")
        require("mismatch", self.mismatch, 0 < abs(self.mismatch) < inf, "a mismatch (mm) is not zero, and finite")

    @property
    def force(self) -> float:
        """On a ball that is not displaced, to the right, in N."""
        return self.stiffness * self.mismatch


@renamed_fields(instants="n_steps")
@dataclass(frozen=True, kw_only=True, eq=False)
class Cycle:
    """A cycle of load and motion, cut into instants of equal length.

    Directions are those of the body, or of the machine: x to the side (lateral), y to the front, z upwards. The socket
    stands still and the ball turns by R = the product of three rotations, flexion about x, adduction about y,
    inward rotation about z. Lateral is to the right here; a hip in use whose cup is a left one mirrors the cycle.

    Parameters
    ----------
    name : str
    force : function
        From phases (n,) in 0 to 1 to forces of the ball on the socket (3, n) in N, or to their sizes (n,) upwards; what
        pulls the ball off, a size below 0, is no contact.
    angles : function
        From phases to flexion, adduction and rotation (3, n) in rad.
    n_steps : int
    order : str
        The axes as they are multiplied: "xyz" is R = Rx Ry Rz.
    duration : float
        In s.
    cup_tilt : float, optional
        In rad from the load, where a standard says how a socket is put in.
    notes : tuple of str
        What is to be said of it.
    frame : Frame
        Whose directions the forces have; the body's by default.
    spring : Spring, optional
        What pushes the ball to the side, beside the force.

    Raises
    ------
    ValueError
        Numbers that are not finite; a number of instants or an order that is none.
    """

    name: str
    force: Course
    angles: Course
    n_steps: int = DEFAULT_STEPS
    order: str = "xyz"
    duration: float = 1.0
    cup_tilt: float | None = None
    notes: tuple[str, ...] = ()
    frame: Frame = Frame.BODY
    spring: Spring | None = None

    sizes = RenamedAttribute("force_magnitudes")
    middles = RenamedAttribute("midpoint_rotations")
    turns = RenamedAttribute("rotation_increments")
    told = RenamedAttribute("describe_step")

    def __post_init__(self) -> None:
        check_step_count(self.n_steps)
        object.__setattr__(self, "order", order_of(self.order))
        for name, values in {"force": self.forces, "angle": self.rotations}.items():
            require(name, values, numpy.isfinite(values), "the numbers of a cycle are finite")

    @property
    def phases(self) -> Numbers:
        """The middle of each instant, 0 to 1."""
        return (numpy.arange(self.n_steps) + 0.5) / self.n_steps

    @cached_property
    def forces(self) -> Numbers:
        """In the middle of each instant, in N: (instants, 3)."""
        return self._forces_at(self.phases)

    def _forces_at(self, phases: Numbers) -> Numbers:
        found = numpy.asarray(self.force(phases), dtype=float)
        if found.ndim == 1:
            size = numpy.maximum(found, 0.0)
            found = numpy.stack([0 * size, 0 * size, size])
        if self.spring is not None:
            found = found + self.spring.force * _RIGHT
        return numpy.ascontiguousarray(found.T)

    @cached_property
    def largest_force(self) -> float:
        """In the whole cycle, between the instants too, in N."""
        return float(numpy.linalg.norm(self._forces_at(numpy.linspace(0.0, 1.0, _FINE + 1)), axis=1).max())

    @cached_property
    def force_magnitudes(self) -> Numbers:
        """Sizes of the forces in N: (instants,)."""
        return numpy.linalg.norm(self.forces, axis=1)

    @cached_property
    def rotations(self) -> Numbers:
        """Rotation matrices of the ball at the ends of the instants, the last one the first: (instants + 1, 3, 3)."""
        angles = numpy.asarray(self.angles(numpy.arange(self.n_steps) / self.n_steps), dtype=float).T
        turned = rotation_matrices(angles, self.order)
        return numpy.concatenate([turned, turned[:1]])

    @cached_property
    def midpoint_rotations(self) -> Numbers:
        """Rotation matrices of the ball in the middle of the instants: (instants, 3, 3)."""
        return rotation_matrices(numpy.asarray(self.angles(self.phases), dtype=float).T, self.order)

    @cached_property
    def rotation_increments(self) -> Numbers:
        """How the ball turns during each instant: rotation vectors in rad, (instants, 3)."""
        return rotation_vectors(self.rotations[1:] @ self.rotations[:-1].swapaxes(1, 2))

    @property
    def seconds(self) -> Numbers:
        """That each instant lasts: (instants,)."""
        return numpy.full(self.n_steps, self.duration / self.n_steps)

    @property
    def activity_slices(self) -> tuple[tuple[str, slice], ...]:
        """Name and instants of the only activity."""
        return ((self.name, slice(0, self.n_steps)),)

    def describe_step(self, instant: int) -> str:
        """Where in the cycle an instant is, in words."""
        return f"{100 * self.phases[instant]:.1f} % of the cycle"

    def finer(self) -> Cycle:
        """This cycle in twice as many instants, if so many are allowed."""
        return replace(self, n_steps=min(2 * self.n_steps, _MOST))

    def mirrored(self) -> Cycle:
        """What the other side of the body goes through: to the left what was to the right."""
        # M Rx(a) Ry(b) Rz(c) M = Rx(a) Ry(-b) Rz(-c), M = diag(-1, 1, 1)
        spring = self.spring
        if spring is not None and self.frame is Frame.BODY:
            spring = replace(spring, mismatch=-spring.mismatch)
        return replace(self, force=self._aside, angles=lambda phases: _OTHER_WAY * self.angles(phases), spring=spring)

    def _aside(self, phases: Numbers) -> Numbers:
        found = numpy.asarray(self.force(phases), dtype=float)
        return found if found.ndim == 1 or self.frame is Frame.CUP else _LEFT * found

    def scaled(self, factor: float) -> Cycle:
        """A cycle of this motion under forces that are larger by a factor."""
        return replace(self, force=lambda phases: factor * self.force(phases))


_RIGHT = numpy.array([[1.0], [0.0], [0.0]])
_LEFT = numpy.array([[-1.0], [1.0], [1.0]])
_OTHER_WAY = numpy.array([[1.0], [-1.0], [-1.0]])


def check_step_count(count: Any, name: str = "n_steps") -> int:
    """A number of instants, if it is one.

    Raises
    ------
    ValueError
        No whole number from 8 to 10 000.
    """
    if isinstance(count, bool) or not isinstance(count, int) or not _FEWEST <= count <= _MOST:
        raise ValueError(f"{name} = {shown(count)} is not allowed: a whole number from {_FEWEST} to {_MOST}")
    return count


_AXES = {
    **dict.fromkeys(("flexion", "flexion-extension", "fe", "f", "x"), "x"),
    **dict.fromkeys(("adduction", "abduction", "abduction-adduction", "adduction-abduction", "aa", "a", "y"), "y"),
    **dict.fromkeys(("rotation", "inward rotation", "inward-outward rotation", "ier", "ie", "r", "z"), "z"),
}


def order_of(text: Any) -> str:
    """The axes of "flexion, adduction, rotation", "FE-AA-IER" or "xyz" as they are multiplied: "xyz".

    Raises
    ------
    ValueError
        Not the three rotations, each of them once.
    """
    words = text if isinstance(text, list | tuple) else _words(text) if isinstance(text, str) else []
    axes = "".join(_AXES.get(str(word).strip().lower(), "?") for word in words)
    if sorted(axes) != ["x", "y", "z"]:
        known = "'flexion, adduction, rotation' in any order"
        raise ValueError(f"rotation_order = {shown(text)} is not allowed: {known} (R is their product from the left)")
    return axes


def _words(text: str) -> list[str]:
    parts = text.replace(";", ",").split(",") if "," in text else text.replace("-", " ").split()
    return list(parts[0].strip()) if len(parts) == 1 and len(parts[0].strip()) == 3 else parts
