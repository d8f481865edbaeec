"""Simulation of a ball in its socket, by energy-momentum steps or by integration of the contact's internal state."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_number, require, shown
from . import stepping
from .element import ForceElement, components
from .load import ContactState, Load
from .motion import TONNE, Motion
from .stateful_motion import StatefulIntegrator, pull_function
from .stepping import BallState


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
    """Simulate a ball in a fixed socket, by time steps that conserve energy and angular momentum.

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
        It ends early at a state without force or a step that does not converge; `end_reason` gives the reason.

    Raises
    ------
    ValueError
        A number out of range.
    TypeError
        An element of another type.
    """
    force_element = getattr(element, "element", element)
    if not isinstance(force_element, ForceElement):
        raise TypeError(f"element must be a ForceElement, got {shown(element)}")
    checked_mass = _check_mass_or_inertia("mass", mass)
    solid_ball = 0.4 * checked_mass * element.constants.ball_radius**2
    checked_inertia = solid_ball if inertia is None else _check_mass_or_inertia("inertia", inertia)
    duration = _check_positive_number("duration", duration)
    steps = duration / _check_positive_number("step", step)
    require("the number of steps", steps, steps <= _MAX_STEPS, f"at most {_MAX_STEPS:g}")
    step_count = max(int(numpy.ceil(steps - 1e-9)), 1)
    initial = BallState(*components(position), *components(velocity), *components(spin))
    problem = _InitialValueProblem(
        element, force_element, checked_mass, checked_inertia, initial, pull, duration / step_count, step_count
    )
    if ContactState(force_element(initial[:3], initial[3:6], initial[6:]).status).failed:
        return problem.motion_without_steps()
    return problem.simulate_with_contact_state() if force_element.internal_state else problem.simulate_by_energy_steps()


_MAX_STEPS = 1e8
"""Largest number of steps of a simulation."""


@dataclass(frozen=True)
class _InitialValueProblem:
    """Initial value problem of a ball: initial state, pull, and `count` time steps of `step` seconds."""

    element: Any
    force_element: ForceElement
    mass: float
    inertia: float
    initial: BallState
    pull: Any
    step: float
    count: int

    def motion_without_steps(self) -> Motion:
        """Return a motion that ends at the initial state, because this state has no load."""
        states, none = numpy.array([self.initial]), numpy.zeros(1)
        return self._build_motion(
            states,
            self.force_element(states[:, :3]),
            dissipated_energy=none,
            work=none,
            end_reason=_failure_note(self.force_element, states[0]),
        )

    def simulate_by_energy_steps(self) -> Motion:
        """Simulate the motion by energy-momentum steps."""
        step, step_count, potential_and_constants = (
            self.step,
            self.count,
            (self.element.potential, self.element.constants),
        )
        states, dissipated = numpy.zeros((step_count + 1, 9)), numpy.zeros(step_count + 1)
        pulls = _pull_forces_at(self.pull, step * (numpy.arange(step_count) + 0.5))
        is_uncompiled = isinstance(self.element, ForceElement)
        march, pull_rows = (stepping.march, pulls.tolist()) if is_uncompiled else (self.element.march, pulls)
        converged = march(
            *potential_and_constants,
            self.initial,
            TONNE * self.mass,
            TONNE * self.inertia,
            pull_rows,
            step,
            states,
            dissipated,
        )
        end_reason = (
            ""
            if converged == step_count
            else _failure_note(self.force_element, states[converged + 1], converged * step, step)
        )
        states, dissipated, pulls = states[: converged + 1], dissipated[: converged + 1], pulls[:converged]
        position = states[:, :3]
        work = numpy.cumsum(numpy.sum(pulls * numpy.diff(position, axis=0), axis=1))
        moment = numpy.cumsum(step / 2 * numpy.cross(position[:-1] + position[1:], pulls), axis=0)
        sums = {"work": numpy.append(0.0, work), "pull_moment": numpy.vstack([numpy.zeros(3), moment])}
        return self._build_motion(
            states, self.force_element(position), dissipated_energy=dissipated, end_reason=end_reason, **sums
        )

    def simulate_with_contact_state(self) -> Motion:
        """Simulate the motion with bristles or adhesion by the integrator LSODA."""
        ball = StatefulIntegrator(
            element=self.force_element,
            mass=TONNE * self.mass,
            inertia=TONNE * self.inertia,
            pull=pull_function(self.pull),
        )
        results = ball.integrate(self.initial, self.step * numpy.arange(self.count + 1), self.step)
        load = self.force_element(results.states[:, :3], attached=results.attached)
        end_reason = ""
        if results.failure is not None:
            notes = "; ".join(results.failure.notes) or "the integration failed"
            end_reason = f"after {self.step * (len(results.states) - 1):g} s: {notes}"
        contact_state = {"deflection": results.deflection, "attached": results.attached, "end_reason": end_reason}
        return self._build_motion(
            results.states, load, dissipated_energy=results.dissipated, work=results.work, **contact_state
        )

    def _build_motion(self, states: Numbers, load: Load, **results: Any) -> Motion:
        """Build a `Motion` from states (steps, 9), the contact load, and other results."""
        return Motion(
            element=self.force_element,
            mass=self.mass,
            inertia=self.inertia,
            time=self.step * numpy.arange(len(states)),
            position=states[:, :3],
            velocity=states[:, 3:6],
            spin=states[:, 6:],
            energy=load.energy,
            **results,
        )


def _pull_forces_at(pull: Any, time: Numbers) -> Numbers:
    """Evaluate the pull on the ball in N at some times in s: (times, 3)."""
    if callable(pull):
        return numpy.array([components(pull(instant), "a pull") for instant in time.tolist()])
    return numpy.tile(numpy.array(components(pull, "a pull")), (len(time), 1))


def _failure_note(element: ForceElement, state: Numbers, time: float = 0.0, step: float = 0.0) -> str:
    """Describe the reason for the early end of a motion, with time and state of the ball."""
    x, y, z, *rates = state.tolist()
    notes = element((x, y, z), rates[:3], rates[3:]).notes
    return f"after {time:g} s: {'; '.join(notes) or f'a step of {step:g} s did not converge'}"


_MASS_RANGE = (1e-100, 1e100)
"""Range of masses and moments of inertia whose products are neither zero nor infinite."""


def _check_mass_or_inertia(name: str, value: Any) -> float:
    """Check that a mass or moment of inertia lies in the allowed range, and return it."""
    checked = check_number(name, value)
    low, high = _MASS_RANGE
    require(name, checked, low <= checked <= high, f"{name} must be between {low:g} and {high:g}")
    return checked


def _check_positive_number(name: str, value: Any) -> float:
    """Check that a number is above 0 and finite, and return it."""
    checked = check_number(name, value)
    require(name, checked, 0.0 < checked < inf, "it must be above 0 and finite")
    return checked
