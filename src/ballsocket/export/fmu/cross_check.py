"""The files of FMI's cross-check beside a unit: what goes in, what the Python element answers, and how it is run."""

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
    """Write NAME_in.csv, NAME_ref.csv and NAME_ref.opt beside the unit NAME.fmu.

    Raises
    ------
    OSError
        A folder that cannot be written to.
    """
    time = numpy.arange(round(STOP / STEP) + 1) * STEP
    state = trajectory(element, time)
    names = variables(element)
    begin = path.with_suffix("")
    tables = (("in", "input", in_si(state)), ("ref", "output", answers(element, state)))
    inside, reference = (
        write_text(Path(f"{begin}_{end}.csv"), _csv(_of(names, causality), time, values))
        for end, causality, values in tables
    )
    options = f"StartTime, 0\nStopTime, {STOP}\nStepSize, {STEP}\nRelTol, 1e-6\n"
    return inside, reference, write_text(Path(f"{begin}_ref.opt"), options)


def trajectory(element: ForceElement, time: Numbers) -> Numbers:
    """A ball that comes, is pressed, slides around its socket, spins and leaves: (times, 9) in mm, mm/s, rad/s."""
    constants = element.constants
    depth = 0.01 * min(constants.clearance, constants.wall) or 0.001 * constants.socket_radius
    phase = 2 * numpy.pi * time / STOP
    distance = constants.clearance + depth * (1.0 - 2.0 * numpy.cos(phase))
    rate = depth * 2.0 * numpy.sin(phase) * 2 * numpy.pi / STOP
    lean, turning = 0.3 * numpy.sin(phase), 0.3 * numpy.cos(phase) * 2 * numpy.pi / STOP
    way = numpy.stack([numpy.sin(lean), 0.0 * lean, numpy.cos(lean)], axis=-1)
    across = numpy.stack([numpy.cos(lean), 0.0 * lean, -numpy.sin(lean)], axis=-1)
    velocity = rate[:, None] * way + (distance * turning)[:, None] * across
    spin = numpy.stack([0.0 * phase, 2.0 * numpy.sin(phase), 1.0 + 0.0 * phase], axis=-1)
    return numpy.hstack([distance[:, None] * way, velocity, spin])


def in_si(state: Numbers) -> Numbers:
    """States in m, m/s and rad/s."""
    return numpy.hstack([_MM * state[:, :6], state[:, 6:]])


def answers(element: ForceElement, state: Numbers) -> Numbers:
    """What the Python element answers, in the order of the outputs and in SI units."""
    load = element(state[:, :3], state[:, 3:6], state[:, 6:])
    scalars = (_MM * load.energy, load.half_angle, _MPA * load.max_pressure)
    return numpy.hstack([load.force, _MM * load.moment, numpy.stack(scalars, axis=-1)])


def _of(names: tuple[Variable, ...], causality: str) -> list[str]:
    return [each.name for each in names if each.causality == causality]


def _csv(names: list[str], time: Numbers, values: Numbers) -> str:
    head = ",".join(f'"{name}"' for name in ("time", *names))
    rows = numpy.hstack([time[:, None], values]).tolist()
    return "\n".join([head, *(",".join(map(repr, row)) for row in rows)]) + "\n"
