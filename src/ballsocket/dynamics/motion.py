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
from .element import ForceElement, components
from .load import ContactState, Load
from .stateful_motion import StatefulIntegrator, pull_of
from .stepping import Ball

TONNE = 1e-3
"""Tonnes in a kilogram: N, mm, s and t form a consistent system."""


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
        Mass in kg and moment of inertia in kg mm².
    time : array (steps,)
        Time in s.
    position, velocity, spin : array (steps, 3)
        Position in mm, velocity in mm/s and angular velocity in rad/s.
    energy : array (steps,)
        Elastic energy of the contact in N mm.
    lost : array (steps,)
        Energy dissipated by damping and friction since the beginning in N mm, with that stored in bristles.
    work : array (steps,)
        Work of the pull on the ball since the beginning in N mm.
    pull_moment : array (steps, 3) or None
        Integral of the moment r x pull over the time in N mm s. None with bristles or adhesion.
    deflection : array (steps, 4), or four numbers
        Deflections of bristles in mm.
    attached : array (steps,) or bool
        True for an attached adhesive ball.
    ended : str
        Reason for an early end, with the state; empty for a complete motion.
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
        """Load at each step."""
        return self.element(self.position, self.velocity, self.spin, self.deflection, self.attached)

    @cached_property
    def kinetic(self) -> Numbers:
        """Kinetic energy in N mm: (steps,)."""
        with numpy.errstate(over="ignore"):
            rotation = self.inertia * numpy.sum(self.spin**2, axis=1)
            return TONNE / 2 * (self.mass * numpy.sum(self.velocity**2, axis=1) + rotation)

    @cached_property
    def total(self) -> Numbers:
        """Elastic, kinetic and dissipated energy minus the work of the pull in N mm: (steps,), constant to rounding."""
        return self.energy + self.kinetic + self.lost - self.work

    @property
    def drift(self) -> float:
        """Largest change of the total energy relative to the largest kinetic or elastic energy."""
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
        constants, cup = self.element.constants, self.element.cup
        if self.pull_moment is None or constants.static + constants.viscous + constants.time > 0.0:
            return None
        balance = self.angular_momentum - self.pull_moment
        change = numpy.linalg.norm(balance - balance[0], axis=1) if cup is None else (balance - balance[0]) @ cup.dome
        reach = numpy.linalg.norm(self.position, axis=1) * numpy.linalg.norm(self.velocity, axis=1)
        largest = TONNE * self.mass * float(reach.max())
        return float(abs(change).max()) / largest if largest > 0.0 else 0.0

    @cached_property
    def depth(self) -> Numbers:
        """Indentation in mm: (steps,); negative values are the distance to first touch."""
        return numpy.linalg.norm(self.position, axis=1) - float(self.element.joint.clearance)

    def summary(self) -> dict[str, Any]:
        """Return a dictionary for JSON, in s, mm, N and N mm."""
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
        """Number of times that the ball left the socket."""
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
    does not bound these errors. Bristles and adhesion have a state; with them the motion is integrated by
    LSODA, with a tolerance of 1e-10.

    Parameters
    ----------
    element : ForceElement
    mass : float
        Mass in kg.
    position, velocity, spin : (3,)
        Initial position in mm, velocity in mm/s and angular velocity in rad/s.
    pull : (3,) or function
        Force on the ball in N, for example its weight, or a function of the time in s.
    inertia : float, optional
        Moment of inertia about any axis through the centre in kg mm²; None is that of a solid ball.
    duration, step : float
        Duration and step in s. A contact should last at least twenty steps.

    Returns
    -------
    Motion
        It ends early at a state without force or a step that does not converge; `ended` gives the reason.

    Raises
    ------
    ValueError
        A number out of range.
    TypeError
        An element of another type.
    """
    plain = getattr(element, "element", element)
    if not isinstance(plain, ForceElement):
        raise TypeError(f"element must be a ForceElement, got {shown(element)}")
    checked_mass = _check_inertia("mass", mass)
    solid_ball = 0.4 * checked_mass * element.constants.ball_radius**2
    checked_inertia = solid_ball if inertia is None else _check_inertia("inertia", inertia)
    duration = _check_positive("duration", duration)
    steps = duration / _check_positive("step", step)
    require("the number of steps", steps, steps <= _MAX_STEPS, f"at most {_MAX_STEPS:g}")
    count = max(int(numpy.ceil(steps - 1e-9)), 1)
    initial = Ball(*components(position), *components(velocity), *components(spin))
    ball = _InitialValueProblem(element, plain, checked_mass, checked_inertia, initial, pull, duration / count, count)
    if ContactState(plain(initial[:3], initial[3:6], initial[6:]).status).failed:
        return ball.failure()
    return ball.with_contact_state() if plain.remembers else ball.advance()


_MAX_STEPS = 1e8
"""Largest number of steps of a simulation."""


@dataclass(frozen=True)
class _InitialValueProblem:
    """Initial state of a ball, and `count` steps of `step` seconds."""

    element: Any
    plain: ForceElement
    mass: float
    inertia: float
    initial: Ball
    pull: Any
    step: float
    count: int

    def failure(self) -> Motion:
        """Return the motion of a ball whose initial state has no load."""
        states, none = numpy.array([self.initial]), numpy.zeros(1)
        return self._motion(
            states, self.plain(states[:, :3]), lost=none, work=none, ended=_failure_note(self.plain, states[0])
        )

    def advance(self) -> Motion:
        """Simulate by energy-momentum steps."""
        h, count, constants = self.step, self.count, (self.element.potential, self.element.constants)
        states, lost = numpy.zeros((count + 1, 9)), numpy.zeros(count + 1)
        pulls = _pulls(self.pull, h * (numpy.arange(count) + 0.5))
        plain = isinstance(self.element, ForceElement)
        march, rows = (stepping.march, pulls.tolist()) if plain else (self.element.march, pulls)
        converged = march(*constants, self.initial, TONNE * self.mass, TONNE * self.inertia, rows, h, states, lost)
        ended = "" if converged == count else _failure_note(self.plain, states[converged + 1], converged * h, h)
        states, lost, pulls = states[: converged + 1], lost[: converged + 1], pulls[:converged]
        position = states[:, :3]
        work = numpy.cumsum(numpy.sum(pulls * numpy.diff(position, axis=0), axis=1))
        moment = numpy.cumsum(h / 2 * numpy.cross(position[:-1] + position[1:], pulls), axis=0)
        sums = {"work": numpy.append(0.0, work), "pull_moment": numpy.vstack([numpy.zeros(3), moment])}
        return self._motion(states, self.plain(position), lost=lost, ended=ended, **sums)

    def with_contact_state(self) -> Motion:
        """Simulate by LSODA a contact with bristles or adhesion."""
        ball = StatefulIntegrator(
            element=self.plain, mass=TONNE * self.mass, inertia=TONNE * self.inertia, pull=pull_of(self.pull)
        )
        results = ball.integrate(self.initial, self.step * numpy.arange(self.count + 1), self.step)
        load = self.plain(results.states[:, :3], attached=results.attached)
        ended = ""
        if results.failure is not None:
            notes = "; ".join(results.failure.notes) or "the integration failed"
            ended = f"after {self.step * (len(results.states) - 1):g} s: {notes}"
        contact_state = {"deflection": results.deflection, "attached": results.attached, "ended": ended}
        return self._motion(results.states, load, lost=results.dissipated, work=results.work, **contact_state)

    def _motion(self, states: Numbers, load: Load, **results: Any) -> Motion:
        return Motion(
            element=self.plain,
            mass=self.mass,
            inertia=self.inertia,
            time=self.step * numpy.arange(len(states)),
            position=states[:, :3],
            velocity=states[:, 3:6],
            spin=states[:, 6:],
            energy=load.energy,
            **results,
        )


def _pulls(pull: Any, time: Numbers) -> Numbers:
    """Return the pull at times: (times, 3)."""
    if callable(pull):
        return numpy.array([components(pull(instant), "a pull") for instant in time.tolist()])
    return numpy.tile(numpy.array(components(pull, "a pull")), (len(time), 1))


def _failure_note(element: ForceElement, state: Numbers, time: float = 0.0, step: float = 0.0) -> str:
    """Describe the reason for the end of a motion, with the state after the last step."""
    x, y, z, *rates = state.tolist()
    notes = element((x, y, z), rates[:3], rates[3:]).notes
    return f"after {time:g} s: {'; '.join(notes) or f'a step of {step:g} s did not converge'}"


_MASS_RANGE = (1e-100, 1e100)
"""Range of masses and moments of inertia whose products are neither zero nor infinite."""


def _check_inertia(name: str, value: Any) -> float:
    number = check_number(name, value)
    low, high = _MASS_RANGE
    require(name, number, low <= number <= high, f"{name} must be between {low:g} and {high:g}")
    return number


def _check_positive(name: str, value: Any) -> float:
    number = check_number(name, value)
    require(name, number, 0.0 < number < inf, "it must be above 0 and finite")
    return number
