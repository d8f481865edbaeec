"""Motion of a ball in its socket over time, with its balances of energy and angular momentum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy

from ..core.arrays import Numbers
from ..core.records import Record
from ..core.sources import Source
from .element import ForceElement
from .load import Load

_MAX_REPEATED = 1_000_000  # steps

TONNE = 1e-3  # tonnes in a kilogram: N, mm, s and t form a consistent system


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion(Record):
    """Simulated motion of a ball over time.

    Without an internal state (bristles, relaxation, adhesion) it is computed by a method of order 2: errors of
    positions and phases fall with the square of the step, see `position_error`. Energy and angular momentum are
    conserved to rounding at any step, see `drift` and `angular_drift`.

    Attributes
    ----------
    element : ForceElement
    mass, inertia : float
        Mass in kg and moment of inertia in kg mm².
    time : array (steps,)
        Time in s.
    position, velocity, spin : array (steps, 3)
        Position in mm, velocity in mm/s and angular velocity in rad/s.
    energy : array (steps,)
        Elastic energy of the contact in N mm; of a relaxing liner that of its long-time modulus.
    dissipated_energy : array (steps,)
        Energy dissipated by damping, friction and relaxation since the beginning in N mm, with that stored in bristles
        and in the terms of a relaxing liner.
    work : array (steps,)
        Work of the pull on the ball since the beginning in N mm.
    pull_moment : array (steps, 3) or None
        Integral of the moment r x pull over the time in N mm s. None with an internal state.
    deflection : array (steps, 4), or four numbers
        Deflections of bristles in mm.
    attached : array (steps,) or bool
        True for an attached adhesive ball.
    relaxed_force : array (steps, terms) or None
        Relaxed forces of the liner in N. None without relaxation.
    end_reason : str
        Reason for an early end, with the state; empty for a complete motion.
    repeat : function or None
        Repeats the motion with another `step` in s. None with an internal state, and for an early end.
    """

    sources: ClassVar[tuple[Source, ...]] = (Source("gonzalez1996"),)

    element: ForceElement
    mass: float
    inertia: float
    time: Numbers
    position: Numbers
    velocity: Numbers
    spin: Numbers
    energy: Numbers
    dissipated_energy: Numbers
    work: Numbers
    pull_moment: Numbers | None = None
    deflection: Any = (0.0, 0.0, 0.0, 0.0)
    attached: Any = False
    relaxed_force: Any = None
    end_reason: str = ""
    repeat: Callable[..., Motion] | None = None

    @cached_property
    def position_error(self) -> float | None:
        """Estimated largest error of the position in mm by the phase error of the method.

        None without `repeat`, and above a million steps.

        It is 4/3 of the difference from a repetition with half the step, since the method is of order 2.
        """
        if self.repeat is None or len(self.time) > _MAX_REPEATED:
            return None
        finer = self.repeat(step=0.5 * float(self.time[1])).position[::2]
        if len(finer) < len(self.position):
            return None
        return 4.0 / 3.0 * float(numpy.linalg.norm(finer - self.position, axis=1).max())

    @cached_property
    def load(self) -> Load:
        """Contact load at each time, computed from the states of the ball."""
        motion = self.position, self.velocity, self.spin
        return self.element(*motion, self.deflection, self.attached, self.relaxed_force)

    @cached_property
    def kinetic_energy(self) -> Numbers:
        """Kinetic energy of translation and rotation in N mm: (steps,)."""
        with numpy.errstate(over="ignore"):
            rotation = self.inertia * numpy.sum(self.spin**2, axis=1)
            return TONNE / 2 * (self.mass * numpy.sum(self.velocity**2, axis=1) + rotation)

    @cached_property
    def total_energy(self) -> Numbers:
        """Total energy in N mm at each time (steps,), constant to rounding: the check of the balance.

        It is the elastic, kinetic and dissipated energy minus the work of the pull.
        """
        return self.energy + self.kinetic_energy + self.dissipated_energy - self.work

    @property
    def drift(self) -> float:
        """Largest change of the total energy over time, divided by the largest kinetic or elastic energy."""
        with numpy.errstate(all="ignore"):
            return float(
                numpy.max(abs(self.total_energy - self.total_energy[0]))
                / max(self.kinetic_energy.max(), self.energy.max())
            )

    @cached_property
    def angular_momentum(self) -> Numbers:
        """Angular momentum m r x v of the ball about the socket's centre in N mm s: (steps, 3)."""
        return TONNE * self.mass * numpy.cross(self.position, self.velocity)

    @property
    def angular_drift(self) -> float | None:
        """Largest relative error of the balance of angular momentum; only rounding differs from 0.

        It is the largest change of the angular momentum less `pull_moment`, over the largest product m r v.

        In a cup it is the component about the dome axis. None where the angular momentum is not conserved: friction,
        bristles, a retarded liner and a lubricant have a moment about the socket's centre.
        """
        constants, cup = self.element.constants, self.element.cup
        moments = constants.static + constants.viscous + constants.time + constants.film_damping
        if self.pull_moment is None or moments > 0.0:
            return None
        balance = self.angular_momentum - self.pull_moment
        change = numpy.linalg.norm(balance - balance[0], axis=1) if cup is None else (balance - balance[0]) @ cup.dome
        momentum_arm = numpy.linalg.norm(self.position, axis=1) * numpy.linalg.norm(self.velocity, axis=1)
        largest = TONNE * self.mass * float(momentum_arm.max())
        return float(abs(change).max()) / largest if largest > 0.0 else 0.0

    @cached_property
    def indentation(self) -> Numbers:
        """Indentation in mm at each time (steps,); negative values are the distance to first touch."""
        return numpy.linalg.norm(self.position, axis=1) - float(self.element.joint.clearance)

    def summary(self) -> dict[str, Any]:
        """Return the main results of the motion as a dictionary for JSON, in s, mm, N and N mm."""
        force = numpy.linalg.norm(self.load.force, axis=1)
        return {
            "duration": float(self.time[-1]),
            "steps": len(self.time) - 1,
            "bounces": self.bounces,
            "deepest": float(self.indentation.max()),
            "largest_force": float(force.max()),
            "stored": float(self.energy[-1]),
            "kinetic": float(self.kinetic_energy[-1]),
            "lost": float(self.dissipated_energy[-1]),
            "work": float(self.work[-1]),
            "drift": self.drift,
            "angular_drift": self.angular_drift,
            "ended": self.end_reason,
        }

    @property
    def bounces(self) -> int:
        """Number of times that the ball left the socket."""
        touching = numpy.asarray(self.load.attached)
        return int(numpy.sum(touching[:-1] & ~touching[1:]))
