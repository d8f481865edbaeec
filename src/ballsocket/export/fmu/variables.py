"""Variables of an FMU in SI units, and their values in the FMI cross-check: inputs and reference results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy

from ...core.arrays import Numbers
from ...core.storage.atomic_files import write_text
from ...dynamics import ContactState, ForceElement, PreloadedElement
from ..tunable import Tunable, joint_tunables, reason_of_fixed_joint, tunables_of

UNITS: Mapping[str, Mapping[str, int]] = {
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "rad/s": {"rad": 1, "s": -1},
    "rad": {"rad": 1},
    "s": {"s": 1},
    "s/m": {"s": 1, "m": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "1": {},
}
"""Powers of the base units for each unit."""

STOP, STEP = 0.1, 1e-3  # suggested end and step of a simulation in s


@dataclass(frozen=True, kw_only=True)
class Variable:
    """Input, output, parameter or constant of the FMU.

    `reference` is its number in the standard, and `needs` are the inputs that it depends on.
    """

    reference: int
    name: str
    causality: str
    unit: str
    description: str
    start: float | None = None
    needs: tuple[int, ...] = ()


_STATUSES = [f"{state.value} {state.name.lower().replace('_', ' ')}" for state in ContactState]
_VECTORS = {
    "position": ("m", "position of the ball centre relative to the socket centre, in axes fixed to the socket"),
    "velocity": ("m/s", "velocity of the ball centre relative to the socket"),
    "spin": ("rad/s", "angular velocity of the ball relative to the socket"),
}
_LOADS = {
    "force": ("N", "force on the ball at its centre"),
    "moment": ("N.m", "moment on the ball about its centre"),
}
_SCALARS = {
    "energy": ("J", "elastic energy of the contact"),
    "half_angle": ("rad", "half angle of the contact"),
    "max_pressure": ("Pa", "largest contact pressure"),
    "status": ("1", f"status of the contact: {', '.join(_STATUSES)}"),
}
_STATE, _POSITION = tuple(range(1, 10)), (1, 2, 3)


def variables(element: ForceElement | PreloadedElement) -> tuple[Variable, ...]:
    """List all variables of an FMU in the order of their reference numbers, from 1."""
    return tuple(
        Variable(reference=reference, **properties) for reference, properties in enumerate(_properties(element), 1)
    )


def start_inputs(element: ForceElement | PreloadedElement) -> tuple[float, ...]:
    """Return the start values of position, velocity and spin in SI units: the ball at rest."""
    position = element.rest_position if isinstance(element, PreloadedElement) else (0.0, 0.0, 0.0)
    return (*(_MM * component for component in position), *(0.0,) * 6)


def _properties(element: ForceElement | PreloadedElement) -> Iterator[dict]:
    """Yield the properties of all inputs, outputs and tunable parameters."""
    starts = iter(start_inputs(element))
    for name, (unit, meaning) in _VECTORS.items():
        for axis in (1, 2, 3):
            properties = {"causality": "input", "unit": unit, "description": meaning, "start": next(starts)}
            yield {"name": f"{name}[{axis}]", **properties}
    for name, (unit, meaning) in _LOADS.items():
        for axis in (1, 2, 3):
            described = {"name": f"{name}[{axis}]", "unit": unit, "description": meaning}
            yield {**described, "causality": "output", "needs": _STATE}
    for name, (unit, meaning) in _SCALARS.items():
        yield {"name": name, "causality": "output", "unit": unit, "description": meaning, "needs": _POSITION}
    for parameter in tunables_of(element):
        yield {**_parameter_properties(parameter, element), "causality": "parameter"}
    if reason := reason_of_fixed_joint(element):
        for parameter in joint_tunables(element):
            described = _parameter_properties(parameter, element)
            yield {**described, "causality": "local", "description": f"{described['description']}; fixed: {reason}"}


def _parameter_properties(parameter: Tunable, element: ForceElement | PreloadedElement) -> dict:
    """Return name, unit, meaning and start value of a parameter in SI units."""
    start = parameter.value(element) * parameter.si
    return {"name": parameter.name, "unit": parameter.si_unit, "description": parameter.meaning, "start": start}


_MM, _MPA = 1e-3, 1e6


def write_cross_check(element: ForceElement | PreloadedElement, path: Path) -> tuple[Path, Path, Path]:
    """Write the files of the FMI cross-check, NAME_in.csv, NAME_ref.csv and NAME_ref.opt, beside NAME.fmu.

    Raises OSError: a folder that cannot be written to.
    """
    time = numpy.arange(round(STOP / STEP) + 1) * STEP
    state = trajectory(element, time)
    fmu_variables = variables(element)
    stem = path.with_suffix("")
    tables = (("in", "input", states_in_si(state)), ("ref", "output", reference_loads(element, state)))
    names = {kind: [variable.name for variable in fmu_variables if variable.causality == kind] for _, kind, _ in tables}
    inputs, reference = (
        write_text(Path(f"{stem}_{ending}.csv"), _csv_text(names[kind], time, values))
        for ending, kind, values in tables
    )
    options = f"StartTime, 0\nStopTime, {STOP}\nStepSize, {STEP}\nRelTol, 1e-6\n"
    return inputs, reference, write_text(Path(f"{stem}_ref.opt"), options)


def trajectory(element: ForceElement | PreloadedElement, time: Numbers) -> Numbers:
    """Compute the states (times, 9) in mm, mm/s and rad/s of a ball that touches, slides, spins and separates."""
    constants = element.constants
    clearance = constants.clearance
    depth = 0.01 * min(clearance, constants.wall) or 0.001 * constants.socket_radius
    if clearance < 0.0:  # a preloaded ball touches at every position
        clearance = depth = -0.2 * clearance
    phase = 2 * numpy.pi * time / STOP
    distance = clearance + depth * (1.0 - 2.0 * numpy.cos(phase))
    rate = depth * 2.0 * numpy.sin(phase) * 2 * numpy.pi / STOP
    angle, angular_speed = 0.3 * numpy.sin(phase), 0.3 * numpy.cos(phase) * 2 * numpy.pi / STOP
    normal = numpy.stack([numpy.sin(angle), 0.0 * angle, numpy.cos(angle)], axis=-1)
    tangent = numpy.stack([numpy.cos(angle), 0.0 * angle, -numpy.sin(angle)], axis=-1)
    velocity = rate[:, None] * normal + (distance * angular_speed)[:, None] * tangent
    spin = numpy.stack([0.0 * phase, 2.0 * numpy.sin(phase), 1.0 + 0.0 * phase], axis=-1)
    return numpy.hstack([distance[:, None] * normal, velocity, spin])


def states_in_si(state: Numbers) -> Numbers:
    """Convert states (position, velocity, spin) from mm, mm/s and rad/s to m, m/s and rad/s."""
    return numpy.hstack([_MM * state[:, :6], state[:, 6:]])


def reference_loads(element: ForceElement | PreloadedElement, state: Numbers) -> Numbers:
    """Compute the outputs of the Python element at given states, in the order and units of the FMU."""
    load = element(state[:, :3], state[:, 3:6], state[:, 6:])
    scalars = (_MM * load.energy, load.half_angle, _MPA * load.max_pressure, numpy.asarray(load.status, dtype=float))
    return numpy.hstack([load.force, _MM * load.moment, numpy.stack(scalars, axis=-1)])


def _csv_text(names: list[str], time: Numbers, values: Numbers) -> str:
    head = ",".join(f'"{name}"' for name in ("time", *names))
    rows = numpy.hstack([time[:, None], values]).tolist()
    return "\n".join([head, *(",".join(map(repr, row)) for row in rows)]) + "\n"
