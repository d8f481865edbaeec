"""Simulation of a ball in its socket, by energy-momentum steps or by integration of the contact's internal state."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from math import inf
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_number, require, shown
from . import stepping
from .ball_centre import Vector
from .element import ForceElement, components, internal_rates, state_arguments
from .load import ContactState, Load
from .motion import TONNE, Motion
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
    does not bound these errors; `position_error` of the motion estimates them. Bristles, a relaxing liner and adhesion
    have a state; with them the motion is integrated by LSODA, with a tolerance of 1e-10.

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
    h, start = duration / step_count, force_element(initial[:3], initial[3:6], initial[6:])
    ball: dict[str, Any] = {
        "mass": TONNE * checked_mass,
        "inertia": TONNE * checked_inertia,
        "initial": initial,
        "pull": pull,
    }
    if ContactState(int(start.status)).failed:
        states, none = numpy.array([initial]), numpy.zeros(1)
        results: dict[str, Any] = {
            "dissipated_energy": none,
            "work": none,
            "end_reason": _failure_note(force_element, states[0]),
        }
    elif force_element.internal_state:
        states, results = _integrate_contact_state(force_element, h, step_count, **ball)
    else:
        states, results = _march(element, force_element, h, step_count, **ball)
        thrown: dict[str, Any] = {"position": initial[:3], "velocity": initial[3:6], "spin": initial[6:]}
        if not results["end_reason"]:
            results["repeat"] = partial(
                simulate, element, mass=mass, **thrown, pull=pull, inertia=inertia, duration=duration
            )
    return Motion(
        element=force_element,
        mass=checked_mass,
        inertia=checked_inertia,
        time=h * numpy.arange(len(states)),
        position=states[:, :3],
        velocity=states[:, 3:6],
        spin=states[:, 6:],
        energy=force_element(states[:, :3], attached=results.get("attached", False)).energy,
        **results,
    )


_MAX_STEPS = 1e8  # largest number of steps of a simulation


def _march(
    element: Any,
    force_element: ForceElement,
    h: float,
    count: int,
    *,
    mass: float,
    inertia: float,
    initial: Any,
    pull: Any,
) -> tuple[Numbers, dict[str, Any]]:
    """Simulate `count` energy-momentum steps of h seconds; return the states and further fields of the motion."""
    states, dissipated = numpy.zeros((count + 1, 9)), numpy.zeros(count + 1)
    pulls = numpy.array(list(map(pull_function(pull), (h * (numpy.arange(count) + 0.5)).tolist())))
    is_uncompiled = isinstance(element, ForceElement)
    march, rows = (stepping.march, pulls.tolist()) if is_uncompiled else (element.march, pulls)
    n_converged = march(element.potential, element.constants, initial, mass, inertia, rows, h, states, dissipated)
    end_reason = ""
    if n_converged < count:
        end_reason = _failure_note(force_element, states[n_converged + 1], n_converged * h, h)
    states, dissipated, pulls = states[: n_converged + 1], dissipated[: n_converged + 1], pulls[:n_converged]
    position = states[:, :3]
    work = numpy.cumsum(numpy.sum(pulls * numpy.diff(position, axis=0), axis=1))
    moment = numpy.cumsum(h / 2 * numpy.cross(position[:-1] + position[1:], pulls), axis=0)
    return states, {
        "dissipated_energy": dissipated,
        "end_reason": end_reason,
        "work": numpy.append(0.0, work),
        "pull_moment": numpy.vstack([numpy.zeros(3), moment]),
    }


def _integrate_contact_state(
    element: ForceElement, h: float, count: int, *, mass: float, inertia: float, initial: Any, pull: Any
) -> tuple[Numbers, dict[str, Any]]:
    """Integrate the motion with an internal state by LSODA; return the states and further fields of the motion."""
    integrator = StatefulIntegrator(element=element, mass=mass, inertia=inertia, pull=pull_function(pull))
    state, end_reason = numpy.array([*initial, *(0.0,) * sum(element.internal_states.values()), 0.0, 0.0]), ""
    states, attachments = [state], [integrator.is_touching(state)]
    try:
        with element.validity_monitor.paused():
            for next_state, attached in integrator.iterate_states(state, h * numpy.arange(count + 1), h):
                states.append(next_state)
                attachments.append(attached)
    except _NoLoad as error:
        end_reason = f"after {h * (len(states) - 1):g} s: {str(error) or 'the integration failed'}"
    results = numpy.array(states)
    parts = state_arguments(element, results[:, :-2])
    return results[:, :9], {
        "dissipated_energy": results[:, -2],
        "work": results[:, -1],
        **{name: parts[name] for name in element.internal_states},
        "attached": numpy.array(attachments),
        "end_reason": end_reason,
    }


def _failure_note(element: ForceElement, state: Numbers, time: float = 0.0, step: float = 0.0) -> str:
    x, y, z, *rates = state.tolist()
    notes = element((x, y, z), rates[:3], rates[3:]).notes
    return f"after {time:g} s: {'; '.join(notes) or f'a step of {step:g} s did not converge'}"


_MASS_RANGE = (1e-100, 1e100)  # range of masses and moments of inertia whose products are neither zero nor infinite


def _check_mass_or_inertia(name: str, value: Any) -> float:
    checked, (low, high) = check_number(name, value), _MASS_RANGE
    require(name, checked, low <= checked <= high, f"{name} must be between {low:g} and {high:g}")
    return checked


def _check_positive_number(name: str, value: Any) -> float:
    checked = check_number(name, value)
    require(name, checked, 0.0 < checked < inf, "it must be above 0 and finite")
    return checked


_TOLERANCE = 1e-10  # relative and absolute tolerance of the integration


class _NoLoad(ArithmeticError):  # noqa: N818 - it ends the integration, and no caller sees it
    """Error at a state of the ball that has no load; its message has the notes of the load, or is empty."""

    def __init__(self, load: Load) -> None:
        super().__init__("; ".join(load.notes))


@dataclass(frozen=True, kw_only=True)
class StatefulIntegrator:
    """Time integrator for a ball with an internal contact state; `pull` in N is a function of the time in s.

    The unknowns are position, velocity, spin, the internal states with rates, the dissipated energy, and the work of
    the pull.
    """

    element: ForceElement
    mass: float  # in t
    inertia: float  # in t mm²
    pull: Callable[[float], Vector]

    def iterate_states(self, state: Numbers, times: Numbers, step: float) -> Iterator[tuple[Numbers, bool]]:
        """Yield the state, and True for an attached ball, at each time after the first, that of `state`.

        The steps have at most `step` seconds. The solver restarts at attachment or separation.
        """
        from scipy.integrate import LSODA

        time, attached, switch_time = float(times[0]), self.is_touching(state), 0.0
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
                state[-2] -= self._load_at(state, attached).energy

    def _equations_of_motion(self, attached: bool) -> Callable[[float, Numbers], list[float]]:
        """Make the right-hand side of the equations of motion, for an attached or a separate ball."""

        def time_derivatives(time: float, state: Numbers) -> list[float]:
            load, pull = self._load_at(state, attached), self.pull(time)
            if load.force[0] != load.force[0] or load.contact.rim_margin <= -1.0:
                raise _NoLoad(load)
            acceleration = [(a + b) / self.mass for a, b in zip(load.force, pull, strict=True)]
            angular_acceleration = [a / self.inertia for a in load.moment]
            powers = self._dissipated_power(load), _dot_product(pull, load.velocity)
            return [*load.velocity, *acceleration, *angular_acceleration, *internal_rates(load), *powers]

        return time_derivatives

    def _load_at(self, state: Numbers, attached: bool) -> Load:
        return self.element(**state_arguments(self.element, state[:-2].tolist()), attached=attached)

    def _dissipated_power(self, load: Load) -> float:
        """Compute the power in N mm/s of all loads that are not the gradient of the elastic energy."""
        contact, centre, relaxation = load.contact, load.centre, self.element.relaxation
        speed = _dot_product(load.velocity, (centre.x, centre.y, centre.z))
        polar_speed = _dot_product(load.velocity, (contact.px, contact.py, contact.pz))
        normal = contact.normal
        if relaxation is not None:
            normal = relaxation.long_term_share * self.element.potential(max(load.indentation, 0.0))[1]
        elastic_power = normal * speed - contact.polar * polar_speed
        return -(_dot_product(load.force, load.velocity) + elastic_power + _dot_product(load.moment, load.spin))

    def is_touching(self, state: Numbers) -> bool:
        """Check if the ball touches the socket at a state of the integrator."""
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


def _dot_product(a: Any, b: Any) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])
