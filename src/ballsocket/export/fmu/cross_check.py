"""Files of the FMI cross-check: inputs, reference results of the Python element, and simulation options."""

from __future__ import annotations

from pathlib import Path

import numpy

from ...core.arrays import Numbers
from ...core.storage.atomic_files import write_text
from ...dynamics import ForceElement
from .description import STEP, STOP
from .variables import Variable, variables

_MM, _MPA = 1e-3, 1e6


def write_cross_check(element: ForceElement, path: Path) -> tuple[Path, Path, Path]:
    """Write the files of the FMI cross-check, NAME_in.csv, NAME_ref.csv and NAME_ref.opt, beside NAME.fmu.

    Raises
    ------
    OSError
        A folder that cannot be written to.
    """
    time = numpy.arange(round(STOP / STEP) + 1) * STEP
    state = trajectory(element, time)
    listed = variables(element)
    stem = path.with_suffix("")
    tables = (("in", "input", in_si(state)), ("ref", "output", reference_loads(element, state)))
    inputs, reference = (
        write_text(Path(f"{stem}_{ending}.csv"), _csv(_names(listed, causality), time, values))
        for ending, causality, values in tables
    )
    options = f"StartTime, 0\nStopTime, {STOP}\nStepSize, {STEP}\nRelTol, 1e-6\n"
    return inputs, reference, write_text(Path(f"{stem}_ref.opt"), options)


def trajectory(element: ForceElement, time: Numbers) -> Numbers:
    """Compute a test trajectory of a ball that touches, slides, spins and separates: states (times, 9).

    The units are mm, mm/s and rad/s.
    """
    constants = element.constants
    depth = 0.01 * min(constants.clearance, constants.wall) or 0.001 * constants.socket_radius
    phase = 2 * numpy.pi * time / STOP
    distance = constants.clearance + depth * (1.0 - 2.0 * numpy.cos(phase))
    rate = depth * 2.0 * numpy.sin(phase) * 2 * numpy.pi / STOP
    angle, angular_speed = 0.3 * numpy.sin(phase), 0.3 * numpy.cos(phase) * 2 * numpy.pi / STOP
    normal = numpy.stack([numpy.sin(angle), 0.0 * angle, numpy.cos(angle)], axis=-1)
    tangent = numpy.stack([numpy.cos(angle), 0.0 * angle, -numpy.sin(angle)], axis=-1)
    velocity = rate[:, None] * normal + (distance * angular_speed)[:, None] * tangent
    spin = numpy.stack([0.0 * phase, 2.0 * numpy.sin(phase), 1.0 + 0.0 * phase], axis=-1)
    return numpy.hstack([distance[:, None] * normal, velocity, spin])


def in_si(state: Numbers) -> Numbers:
    """Convert states from mm, mm/s and rad/s to m, m/s and rad/s."""
    return numpy.hstack([_MM * state[:, :6], state[:, 6:]])


def reference_loads(element: ForceElement, state: Numbers) -> Numbers:
    """Compute the reference outputs of the Python element at states, in the order and units of the FMU."""
    load = element(state[:, :3], state[:, 3:6], state[:, 6:])
    scalars = (_MM * load.energy, load.half_angle, _MPA * load.max_pressure)
    return numpy.hstack([load.force, _MM * load.moment, numpy.stack(scalars, axis=-1)])


def _names(listed: tuple[Variable, ...], causality: str) -> list[str]:
    return [variable.name for variable in listed if variable.causality == causality]


def _csv(names: list[str], time: Numbers, values: Numbers) -> str:
    head = ",".join(f'"{name}"' for name in ("time", *names))
    rows = numpy.hstack([time[:, None], values]).tolist()
    return "\n".join([head, *(",".join(map(repr, row)) for row in rows)]) + "\n"
