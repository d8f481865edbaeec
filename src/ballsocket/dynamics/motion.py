"""A ball that moves in its socket, by steps that keep its energy: for demonstrations, tests and drop tests."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any, ClassVar

import numpy

from ..arrays import Numbers
from ..checks import require
from ..sources import Source
from . import stepping
from .bristles import Bristles
from .damping import one_number
from .element import ForceElement, three
from .stepping import Ball

TONNE = 1e-3
"""Of a kilogram, so that N, mm and s fit each other."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """A ball over time.

    Attributes
    ----------
    element : ForceElement
    mass, inertia : float
        In kg and kg mm².
    time : array (steps,)
        In s.
    position, velocity, spin : array (steps, 3)
        In mm, mm/s and rad/s.
    energy : array (steps,)
        Stored in the contact, in N mm.
    lost : array (steps,)
        What damping and friction took since the beginning, in N mm.
    work : array (steps,)
        What the pull on the ball did since then, in N mm.
    ended : str
        Why it ended before its time, with the state; empty if it did not.
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
    lost: Numbers
    work: Numbers
    ended: str = ""

    @cached_property
    def kinetic(self) -> Numbers:
        """In N mm: (steps,)."""
        turning = self.inertia * numpy.sum(self.spin**2, axis=1)
        return TONNE / 2 * (self.mass * numpy.sum(self.velocity**2, axis=1) + turning)

    @cached_property
    def total(self) -> Numbers:
        """Stored, moving and lost, less the work of the pull, in N mm: constant but for rounding. (steps,)."""
        return self.energy + self.kinetic + self.lost - self.work

    @property
    def drift(self) -> float:
        """How far the total strays, over the largest kinetic energy."""
        return float(numpy.max(abs(self.total - self.total[0])) / max(self.kinetic.max(), self.energy.max()))

    @cached_property
    def depth(self) -> Numbers:
        """The indentation in mm; below 0 it is the way to the touch-down. (steps,)."""
        return numpy.linalg.norm(self.position, axis=1) - self.element.constants.clearance

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON, in s, mm, N and N mm."""
        force = numpy.linalg.norm(self.element(self.position, self.velocity, self.spin).force, axis=1)
        ends = {"stored": self.energy, "kinetic": self.kinetic, "lost": self.lost, "work": self.work}
        return {
            "duration": float(self.time[-1]),
            "steps": len(self.time) - 1,
            "bounces": self.bounces,
            "deepest": float(self.depth.max()),
            "largest_force": float(force.max()),
            **{name: float(values[-1]) for name, values in ends.items()},
            "drift": self.drift,
            "ended": self.ended,
        }

    @property
    def bounces(self) -> int:
        """How often the ball left the socket."""
        touching = self.depth > 0
        return int(numpy.sum(touching[:-1] & ~touching[1:]))


def simulate(
    element: ForceElement,
    *,
    mass: float,
    position: Any,
    velocity: Any = (0.0, 0.0, 0.0),
    spin: Any = (0.0, 0.0, 0.0),
    pull: Any = (0.0, 0.0, 0.0),
    inertia: float | None = None,
    duration: float,
    step: float,
) -> Motion:
    """A ball in a socket at rest.

    Parameters
    ----------
    element : ForceElement
    mass : float
        In kg.
    position, velocity, spin : (3,)
        At the beginning, in mm, mm/s and rad/s.
    pull : (3,) or function
        The force on the ball in N: its weight for instance, or a function of the time in s.
    inertia : float, optional
        About any axis through its centre in kg mm²; None is that of a solid ball.
    duration, step : float
        In s. A contact should last some twenty steps.

    Returns
    -------
    Motion
        It ends where a state has no force or a step does not converge, and says so.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    TypeError
        An element with bristles, or one that sticks.
    """
    if isinstance(getattr(element, "friction", None), Bristles):
        raise TypeError(
            "bristles have a state that these steps do not carry: integrate the element's `deflection_rate`"
        )
    if getattr(element, "stretch", 0.0) > 0.0:
        raise TypeError("a ball that sticks has a state that these steps do not carry: integrate the element's force")
    heavy = _above_nothing("mass", mass)
    turning = 0.4 * heavy * element.constants.ball_radius**2 if inertia is None else _above_nothing("inertia", inertia)
    count = int(numpy.ceil(_above_nothing("duration", duration) / _above_nothing("step", step) - 1e-9))
    begun = Ball(*three(position), *three(velocity), *three(spin))
    states, lost = numpy.zeros((count + 1, 9)), numpy.zeros(count + 1)
    march = getattr(element, "march", stepping.march)
    h = duration / count
    pulls = _pulls(pull, h * (numpy.arange(count) + 0.5))
    good = march(element.potential, element.constants, begun, TONNE * heavy, TONNE * turning, pulls, h, states, lost)
    ended = "" if good == count else _why(element, states[good + 1], good * h, h)
    states, lost = states[: good + 1], lost[: good + 1]
    return Motion(
        element=element,
        mass=heavy,
        inertia=turning,
        time=h * numpy.arange(good + 1),
        position=states[:, :3],
        velocity=states[:, 3:6],
        spin=states[:, 6:],
        energy=element(states[:, :3]).energy,
        lost=lost,
        work=numpy.append(0.0, numpy.cumsum(numpy.sum(pulls[:good] * numpy.diff(states[:, :3], axis=0), axis=1))),
        ended=ended,
    )


def _pulls(pull: Any, time: Numbers) -> Numbers:
    """The force at times: (times, 3)."""
    if callable(pull):
        return numpy.array([three(pull(instant)) for instant in time.tolist()])
    return numpy.tile(numpy.array(three(pull)), (len(time), 1))


def _why(element: ForceElement, state: Numbers, time: float, step: float) -> str:
    """What stopped a motion, with the state that the last step led to."""
    x, y, z, *rates = state.tolist()
    notes = element((x, y, z), rates[:3], rates[3:]).notes
    return f"after {time:g} s: {'; '.join(notes) or f'a step of {step:g} s did not converge'}"


def _above_nothing(name: str, value: Any) -> float:
    number = one_number(name, value)
    require(name, number, 0.0 < number < inf, "it is above 0 and finite")
    return number
