"""Simulation of a ball whose contact has an internal state: the deflection of bristles, or adhesion."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import inf
from typing import Any, NamedTuple

import numpy

from ..core.arrays import Numbers
from .element import ForceElement, components
from .load import Load
from .reaction import Vector

_TOLERANCE = 1e-10
"""Relative and absolute tolerance of the integration."""

_STATE_SIZE = 15
"""Number of unknowns: position, velocity, spin, four deflections, dissipated energy, and the work of the pull."""


class StatefulTrajectory(NamedTuple):
    """Computed states of a ball. `failure` is the load that ended the motion early, or None."""

    states: Numbers
    deflection: Numbers
    attached: Numbers
    dissipated: Numbers
    work: Numbers
    failure: Load | None


class _NoLoad(ArithmeticError):  # noqa: N818 - it ends the integration, and no caller sees it
    """Error at a state of the ball that has no load."""

    def __init__(self, load: Load) -> None:
        super().__init__("; ".join(load.notes))
        self.load = load


@dataclass(frozen=True, kw_only=True)
class StatefulIntegrator:
    """Time integrator for a ball with an internal contact state, under a pull.

    `mass` is in t, `inertia` in t mm², `pull` in N as a function of time in s.
    """

    element: ForceElement
    mass: float
    inertia: float
    pull: Callable[[float], Vector]

    def integrate(self, initial: Any, times: Numbers, step: float) -> StatefulTrajectory:
        """Integrate the motion of a ball from an initial state, with steps of at most `step` seconds.

        `times` increase; the initial state is that at the first time.
        """
        state = numpy.zeros(_STATE_SIZE)
        state[:9] = initial
        states, attachments, failure = [state], [self._is_touching(state)], None
        try:
            for next_state, attached in self._iterate_states(state, times, step):
                states.append(next_state)
                attachments.append(attached)
        except _NoLoad as error:
            failure = error.load
        state_array = numpy.array(states)
        return StatefulTrajectory(
            state_array[:, :9],
            state_array[:, 9:13],
            numpy.array(attachments),
            state_array[:, 13],
            state_array[:, 14],
            failure,
        )

    def _iterate_states(self, state: Numbers, times: Numbers, step: float) -> Iterator[tuple[Numbers, bool]]:
        """Yield the state at each time after the first; restart the solver at attachment or separation."""
        from scipy.integrate import LSODA

        time, attached, switch_time = float(times[0]), self._is_touching(state), 0.0
        options = {"max_step": step, "rtol": _TOLERANCE, "atol": _TOLERANCE}
        while time < times[-1]:
            solver = LSODA(self._equations_of_motion(attached), time, state, float(times[-1]), **options)
            while solver.status == "running":
                solver.step()
                if solver.status == "failed":
                    raise _NoLoad(self._load_at(solver.y, attached))
                interpolant = solver.dense_output()
                switch_time = self._switch_time(interpolant, attached)
                for time in times[
                    slice(*numpy.searchsorted(times, (interpolant.t_old, min(interpolant.t, switch_time)), "right"))
                ]:
                    yield interpolant(time), attached
                time = solver.t
                if switch_time < inf:
                    time, state, attached = switch_time, interpolant(switch_time), not attached
                    break
            if attached and switch_time < inf:  # the jump of the energy is dissipated
                state[13] -= self._load_at(state, attached).energy

    def _equations_of_motion(self, attached: bool) -> Callable[[float, Numbers], list[float]]:
        """Make the right-hand side of the equations of motion, for an attached or a separate ball."""

        def time_derivatives(time: float, state: Numbers) -> list[float]:
            """Compute the time derivatives of the unknowns; raise `_NoLoad` at a state without a load."""
            load, pull = self._load_at(state, attached), self.pull(time)
            if load.force[0] != load.force[0] or load.contact.rim_margin <= -1.0:
                raise _NoLoad(load)
            acceleration = [(a + b) / self.mass for a, b in zip(load.force, pull, strict=True)]
            angular_acceleration = [a / self.inertia for a in load.moment]
            work = _dot_product(pull, load.velocity)
            return [
                *load.velocity,
                *acceleration,
                *angular_acceleration,
                *load.deflection_rate,
                _dissipated_power(load),
                work,
            ]

        return time_derivatives

    def _load_at(self, state: Numbers, attached: bool) -> Load:
        """Compute the load at a state of the integrator."""
        s = state.tolist()
        return self.element(s[:3], s[3:6], s[6:9], s[9:13], attached)

    def _is_touching(self, state: Numbers) -> bool:
        """Check if the ball touches the socket."""
        return bool(self._indentation_at(state) >= 0.0)

    def _indentation_at(self, state: Numbers) -> float:
        """Compute the indentation in mm at a state of the integrator; negative without contact."""
        return float(numpy.linalg.norm(state[:3])) - float(self.element.joint.clearance)

    def _switch_time(self, interpolant: Any, attached: bool) -> float:
        """Find the time in a step at which an adhesive ball attaches or separates; infinity if none."""
        from scipy.optimize import brentq

        stretch = self.element.stretch
        if stretch == 0.0:
            return inf

        def switch_distance(time: float) -> float:
            return self._indentation_at(interpolant(time)) + (stretch if attached else 0.0)

        start_distance, end_distance = switch_distance(interpolant.t_old), switch_distance(interpolant.t)
        state_changes = start_distance > 0.0 >= end_distance if attached else start_distance < 0.0 <= end_distance
        return float(brentq(switch_distance, interpolant.t_old, interpolant.t, xtol=1e-15)) if state_changes else inf


def pull_function(pull: Any) -> Callable[[float], Vector]:
    """Return the pull on the ball in N as a function of the time in s."""
    if callable(pull):
        return lambda time: components(pull(time), "a pull")
    constant = components(pull, "a pull")
    return lambda time: constant


def _dissipated_power(load: Load) -> float:
    """Compute the power in N mm/s of all loads that are not elastic."""
    contact, centre = load.contact, load.centre
    speed = _dot_product(load.velocity, (centre.x, centre.y, centre.z))
    polar_speed = _dot_product(load.velocity, (contact.px, contact.py, contact.pz))
    elastic_power = contact.normal * speed - contact.polar * polar_speed
    return -(_dot_product(load.force, load.velocity) + elastic_power + _dot_product(load.moment, load.spin))


def _dot_product(a: Any, b: Any) -> float:
    """Compute the dot product of two vectors."""
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])
