"""Reference results of an FMU: inputs, and outputs of the element in Python."""

from __future__ import annotations

import math
from contextlib import nullcontext
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy

from ...core.arrays import Numbers
from ...core.storage.atomic_files import write_text
from ...dynamics import ForceElement, PreloadedElement
from ...dynamics.element import internal_rates, state_arguments
from ...dynamics.motion import TONNE
from .variables import variables

_MM, _MPA = 1e-3, 1e6

_STOP, _STEP = 0.1, 1e-3  # suggested end and step of a simulation in s
_STOP_OF_BALL, _STEPS_OF_BALL = 0.02, 20  # suggested end in s with a ball of 1 kg inside, and number of steps
_TOUCH = 0.22  # time of the first touch of a pushed ball over the simulated time; between two outputs
_TOLERANCE = 1e-10  # relative and absolute tolerance of the integration of states, as in `simulate`


def suggested_times(ball_mass: float | None) -> tuple[float, float]:
    """Return the suggested end and step of a simulation in s; a bounce takes a time as the root of the mass in kg."""
    if ball_mass is None:
        return _STOP, _STEP
    stop = _STOP_OF_BALL * math.sqrt(ball_mass)
    return stop, stop / _STEPS_OF_BALL


def write_cross_check(
    element: ForceElement | PreloadedElement, path: Path, ball_mass: float | None = None
) -> tuple[Path, Path, Path]:
    """Write the files of the FMI cross-check, NAME_in.csv, NAME_ref.csv and NAME_ref.opt, beside NAME.fmu.

    Raises OSError: a folder that cannot be written to.
    """
    stem, (given, reference) = path.with_suffix(""), reference_tables(element, ball_mass)
    stop, step = suggested_times(ball_mass)
    options = f"StartTime, 0\nStopTime, {stop}\nStepSize, {step}\nRelTol, 1e-6\n"
    texts = {"in.csv": given, "ref.csv": reference, "ref.opt": options}
    inputs, results, chosen = (write_text(Path(f"{stem}_{ending}"), text) for ending, text in texts.items())
    return inputs, results, chosen


@lru_cache(maxsize=1)  # of the archive, and of the files beside it
def reference_tables(element: ForceElement | PreloadedElement, ball_mass: float | None) -> tuple[str, str]:
    """Return inputs and outputs over the time as CSV tables in SI units.

    Without a ball inside, the inputs are a prescribed motion, which is constant with internal states: hosts differ in
    how inputs vary in a step. With a ball they are a force, which pushes it through its clearance, and a torque.
    """
    stop, step = suggested_times(ball_mass)
    time = numpy.arange(round(stop / step) + 1) * step
    if ball_mass is None:
        held = trajectory(element, numpy.array([_STOP / 2]))[0]
        states = _integrate(element, time, held) if element.internal_states else trajectory(element, time)
        given, results = states_in_si(states[:, :9]), reference_loads(element, states)
    else:
        distance = max(_MM * element.constants.clearance, 1e-6 * element.constants.socket_radius)
        acceleration = 2.0 * distance / (_TOUCH * time[-1]) ** 2
        applied = numpy.array([0.3, 0.0, 1.0]) * acceleration, numpy.array([0.0, 50.0, 100.0])  # m/s², rad/s²
        inertia = 0.4 * ball_mass * (_MM * element.constants.ball_radius) ** 2
        given = numpy.tile([*(ball_mass * applied[0]), *(inertia * applied[1])], (len(time), 1))
        rest = [*(element.rest_position if isinstance(element, PreloadedElement) else (0.0, 0.0, 0.0)), *(0.0,) * 6]
        states = _integrate(element, time, rest, ball_mass, applied)
        results = numpy.hstack([states_in_si(states[:, :9]), reference_loads(element, states)])
    listed = variables(element, ball_mass)
    inputs, outputs = (
        [variable.name for variable in listed if variable.causality == kind] for kind in ("input", "output")
    )
    return _csv_text(inputs, time, given), _csv_text(outputs, time, results)


def _integrate(
    element: ForceElement | PreloadedElement,
    time: Numbers,
    motion: Any,
    mass: float = math.inf,
    applied: tuple[Any, Any] = (0.0, 0.0),
) -> Numbers:
    """Integrate motion and internal states (times, 9 + n) of a solid ball (kg) from a motion at the first time.

    Applied force and torque give it the accelerations `applied` in m/s² and rad/s². A ball of infinite mass is held at
    its first position, velocity and spin.
    """
    from scipy.integrate import solve_ivp  # slow to import

    count, inertia = sum(element.internal_states.values()), 0.4 * TONNE * mass * element.constants.ball_radius**2

    def rates(now: float, state: Numbers) -> Any:
        load = load_at(element, state)
        velocity = state[3:6] if mass < math.inf else numpy.zeros(3)
        acceleration = numpy.array(load.force) / (TONNE * mass) + applied[0] / _MM
        turning = numpy.array(load.moment) / inertia + applied[1]
        return [*velocity, *acceleration, *turning, *internal_rates(load)]

    options = {"method": "LSODA", "rtol": _TOLERANCE, "atol": _TOLERANCE, "max_step": time[1]}
    with element.validity_monitor.paused() if isinstance(element, ForceElement) else nullcontext():
        return solve_ivp(rates, (0.0, time[-1]), [*motion, *(0.0,) * count], t_eval=time, **options).y.T


def load_at(element: ForceElement | PreloadedElement, state: Numbers) -> Any:
    """Compute the load at states (..., 9 + n) of motion and internal states."""
    return element(**state_arguments(element, state.tolist() if state.ndim == 1 else state))


def trajectory(element: ForceElement | PreloadedElement, time: Numbers) -> Numbers:
    """Compute the states (times, 9) in mm, mm/s and rad/s of a ball that touches, slides, spins and separates."""
    constants = element.constants
    clearance = constants.clearance
    depth = 0.01 * min(clearance, constants.wall) or 0.001 * constants.socket_radius
    if clearance < 0.0:  # a preloaded ball touches at every position
        clearance = depth = -0.2 * clearance
    phase = 2 * numpy.pi * time / _STOP
    distance = clearance + depth * (1.0 - 2.0 * numpy.cos(phase))
    rate = depth * 2.0 * numpy.sin(phase) * 2 * numpy.pi / _STOP
    angle, angular_speed = 0.3 * numpy.sin(phase), 0.3 * numpy.cos(phase) * 2 * numpy.pi / _STOP
    normal = numpy.stack([numpy.sin(angle), 0.0 * angle, numpy.cos(angle)], axis=-1)
    tangent = numpy.stack([numpy.cos(angle), 0.0 * angle, -numpy.sin(angle)], axis=-1)
    velocity = rate[:, None] * normal + (distance * angular_speed)[:, None] * tangent
    spin = numpy.stack([0.0 * phase, 2.0 * numpy.sin(phase), 1.0 + 0.0 * phase], axis=-1)
    return numpy.hstack([distance[:, None] * normal, velocity, spin])


def states_in_si(state: Numbers) -> Numbers:
    """Convert states (position, velocity, spin) from mm, mm/s and rad/s to m, m/s and rad/s."""
    return numpy.hstack([_MM * state[:, :6], state[:, 6:]])


def reference_loads(element: ForceElement | PreloadedElement, state: Numbers) -> Numbers:
    """Compute the outputs of the Python element at states of `load_at`, in the order and units of the FMU."""
    load = load_at(element, state)
    scalars = (_MM * load.energy, load.half_angle, _MPA * load.max_pressure, numpy.asarray(load.status, dtype=float))
    return numpy.hstack([load.force, _MM * load.moment, numpy.stack(scalars, axis=-1)])


def _csv_text(names: list[str], time: Numbers, values: Numbers) -> str:
    head = ",".join(f'"{name}"' for name in ("time", *names))
    rows = numpy.hstack([time[:, None], values]).tolist()
    return "\n".join([head, *(",".join(map(repr, row)) for row in rows)]) + "\n"
