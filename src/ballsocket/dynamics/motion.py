"""Simulation of a ball in its socket by energy-momentum steps: for demonstrations, tests and drop tests."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any, ClassVar

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_number, require, shown
from ..core.sources import Source
from . import stepping
from .carried import Carrier, pull_of
from .element import ForceElement, three
from .load import Load, Touch
from .stepping import Ball

TONNE = 1e-3
"""Of a kilogram, so that N, mm and s fit each other."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Motion:
    """Motion of a ball over time.

    Without bristles and adhesion it is computed by a method of order 2: errors of positions and phases fall with the
    square of the step. Energy and angular momentum are conserved to rounding at any step, see `drift` and
    `angular_drift`.

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
        What damping and friction took since the beginning, in N mm; what bristles hold is among it.
    work : array (steps,)
        What the pull on the ball did since then, in N mm.
    pull_moment : array (steps, 3) or None
        Integral of the moment r x pull over the time since then, in N mm s. None with bristles or adhesion.
    deflection : array (steps, 4), or four numbers
        Of bristles, in mm.
    attached : array (steps,) or bool
        Whether a ball that sticks does.
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
    pull_moment: Numbers | None = None
    deflection: Any = (0.0, 0.0, 0.0, 0.0)
    attached: Any = False
    ended: str = ""

    @cached_property
    def load(self) -> Load:
        """The load at each step."""
        return self.element(self.position, self.velocity, self.spin, self.deflection, self.attached)

    @cached_property
    def kinetic(self) -> Numbers:
        """In N mm: (steps,)."""
        with numpy.errstate(over="ignore"):
            turning = self.inertia * numpy.sum(self.spin**2, axis=1)
            return TONNE / 2 * (self.mass * numpy.sum(self.velocity**2, axis=1) + turning)

    @cached_property
    def total(self) -> Numbers:
        """Stored, moving and lost, less the work of the pull, in N mm: constant but for rounding. (steps,)."""
        return self.energy + self.kinetic + self.lost - self.work

    @property
    def drift(self) -> float:
        """How far the total strays, over the largest energy that moves or is stored."""
        with numpy.errstate(all="ignore"):
            return float(numpy.max(abs(self.total - self.total[0])) / max(self.kinetic.max(), self.energy.max()))

    @cached_property
    def angular_momentum(self) -> Numbers:
        """Angular momentum of the ball's centre about the socket's centre, in N mm s: (steps, 3)."""
        return TONNE * self.mass * numpy.cross(self.position, self.velocity)

    @property
    def angular_drift(self) -> float | None:
        """Largest change of the angular momentum less `pull_moment` over the largest product m r v; 0 but for rounding.

        In a cup it is the component about the dome axis. None where the angular momentum is not conserved: friction,
        bristles and a retarded liner have a moment about the socket's centre.
        """
        given, cup = self.element.constants, self.element.cup
        if self.pull_moment is None or given.static + given.viscous + given.time > 0.0:
            return None
        balance = self.angular_momentum - self.pull_moment
        change = numpy.linalg.norm(balance - balance[0], axis=1) if cup is None else (balance - balance[0]) @ cup.dome
        reach = numpy.linalg.norm(self.position, axis=1) * numpy.linalg.norm(self.velocity, axis=1)
        largest = TONNE * self.mass * float(reach.max())
        return float(abs(change).max()) / largest if largest > 0.0 else 0.0

    @cached_property
    def depth(self) -> Numbers:
        """The indentation in mm; below 0 it is the way to the touch-down. (steps,)."""
        return numpy.linalg.norm(self.position, axis=1) - float(self.element.joint.clearance)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON, in s, mm, N and N mm."""
        force = numpy.linalg.norm(self.load.force, axis=1)
        ends = {"stored": self.energy, "kinetic": self.kinetic, "lost": self.lost, "work": self.work}
        return {
            "duration": float(self.time[-1]),
            "steps": len(self.time) - 1,
            "bounces": self.bounces,
            "deepest": float(self.depth.max()),
            "largest_force": float(force.max()),
            **{name: float(values[-1]) for name, values in ends.items()},
            "drift": self.drift,
            "angular_drift": self.angular_drift,
            "ended": self.ended,
        }

    @property
    def bounces(self) -> int:
        """How often the ball left the socket."""
        touching = numpy.asarray(self.load.attached)
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
    """Simulate a ball in a socket at rest, by steps that conserve energy and angular momentum to rounding.

    The method is of order 2: halving the step divides the errors of positions and phases by four. Conserved energy
    does not bound these errors. Bristles and adhesion have a state of their own; with them the motion is integrated by
    LSODA, with a tolerance of 1e-10.

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
        What is no force element.
    """
    plain = getattr(element, "element", element)
    if not isinstance(plain, ForceElement):
        raise TypeError(f"element must be a ForceElement, got {shown(element)}")
    heavy = _inertial("mass", mass)
    turning = 0.4 * heavy * element.constants.ball_radius**2 if inertia is None else _inertial("inertia", inertia)
    duration = _above_nothing("duration", duration)
    steps = duration / _above_nothing("step", step)
    require("the number of steps", steps, steps <= _MOST, f"there is room for {_MOST:g}")
    count = max(int(numpy.ceil(steps - 1e-9)), 1)
    begun = Ball(*three(position), *three(velocity), *three(spin))
    ball = _Thrown(element, plain, heavy, turning, begun, pull, duration / count, count)
    if Touch(plain(begun[:3], begun[3:6], begun[6:]).status).failed:
        return ball.stopped()
    return ball.carried() if plain.remembers else ball.stepped()


_MOST = 1e8


@dataclass(frozen=True)
class _Thrown:
    """A ball that begins to move, `count` steps of `step` seconds."""

    element: Any
    plain: ForceElement
    mass: float
    inertia: float
    begun: Ball
    pull: Any
    step: float
    count: int

    def stopped(self) -> Motion:
        """Where it began: there is no load to go on with."""
        states, none = numpy.array([self.begun]), numpy.zeros(1)
        return self._moved(states, self.plain(states[:, :3]), lost=none, work=none, ended=_why(self.plain, states[0]))

    def stepped(self) -> Motion:
        """Simulate by energy-momentum steps."""
        h, count, given = self.step, self.count, (self.element.potential, self.element.constants)
        states, lost = numpy.zeros((count + 1, 9)), numpy.zeros(count + 1)
        pulls = _pulls(self.pull, h * (numpy.arange(count) + 0.5))
        plain = isinstance(self.element, ForceElement)
        march, rows = (stepping.march, pulls.tolist()) if plain else (self.element.march, pulls)
        good = march(*given, self.begun, TONNE * self.mass, TONNE * self.inertia, rows, h, states, lost)
        ended = "" if good == count else _why(self.plain, states[good + 1], good * h, h)
        states, lost, pulls = states[: good + 1], lost[: good + 1], pulls[:good]
        position = states[:, :3]
        work = numpy.cumsum(numpy.sum(pulls * numpy.diff(position, axis=0), axis=1))
        moment = numpy.cumsum(h / 2 * numpy.cross(position[:-1] + position[1:], pulls), axis=0)
        sums = {"work": numpy.append(0.0, work), "pull_moment": numpy.vstack([numpy.zeros(3), moment])}
        return self._moved(states, self.plain(position), lost=lost, ended=ended, **sums)

    def carried(self) -> Motion:
        """With what the contact carries along."""
        ball = Carrier(
            element=self.plain, mass=TONNE * self.mass, inertia=TONNE * self.inertia, pull=pull_of(self.pull)
        )
        found = ball.moved(self.begun, self.step * numpy.arange(self.count + 1), self.step)
        load = self.plain(found.states[:, :3], attached=found.attached)
        ended = ""
        if found.stopped is not None:
            notes = "; ".join(found.stopped.notes) or "the integration does not get any further"
            ended = f"after {self.step * (len(found.states) - 1):g} s: {notes}"
        kept = {"deflection": found.deflection, "attached": found.attached, "ended": ended}
        return self._moved(found.states, load, lost=found.lost, work=found.work, **kept)

    def _moved(self, states: Numbers, load: Load, **found: Any) -> Motion:
        return Motion(
            element=self.plain,
            mass=self.mass,
            inertia=self.inertia,
            time=self.step * numpy.arange(len(states)),
            position=states[:, :3],
            velocity=states[:, 3:6],
            spin=states[:, 6:],
            energy=load.energy,
            **found,
        )


def _pulls(pull: Any, time: Numbers) -> Numbers:
    """The force at times: (times, 3)."""
    if callable(pull):
        return numpy.array([three(pull(instant), "a pull") for instant in time.tolist()])
    return numpy.tile(numpy.array(three(pull, "a pull")), (len(time), 1))


def _why(element: ForceElement, state: Numbers, time: float = 0.0, step: float = 0.0) -> str:
    """What stopped a motion, with the state that the last step led to."""
    x, y, z, *rates = state.tolist()
    notes = element((x, y, z), rates[:3], rates[3:]).notes
    return f"after {time:g} s: {'; '.join(notes) or f'a step of {step:g} s did not converge'}"


_MASSES = (1e-100, 1e100)
"""Range of masses and moments of inertia whose products are neither zero nor infinite."""


def _inertial(name: str, value: Any) -> float:
    number = check_number(name, value)
    low, high = _MASSES
    require(name, number, low <= number <= high, f"{name} must lie between {low:g} and {high:g}")
    return number


def _above_nothing(name: str, value: Any) -> float:
    number = check_number(name, value)
    require(name, number, 0.0 < number < inf, "it is above 0 and finite")
    return number
