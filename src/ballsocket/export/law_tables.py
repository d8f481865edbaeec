"""Tables of a force law: for splines and power laws of other programs, and for pivots of rotor bearings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy

from ..core.arrays import Numbers
from ..dynamics import ForceElement, PreloadedElement
from ..models.half_space import Hertz
from ..version import __version__
from .job import ExportJob, Texts
from .law_fit import PowerFit


def table_texts(job: ExportJob) -> Texts:
    """Return the texts of the table of the force law and of the fitted power law, by file name.

    The force of a preloaded joint is no power law: it has only the table with both signs along two axes.
    """
    if isinstance(job.element, PreloadedElement):
        return {f"{job.name}_law.csv": _axes_table(job, job.element.wall)}
    element, depths = job.central_element, numpy.linspace(0.0, job.depth, _TABLE_ROWS)
    energy, force, stiffness = element.potential(depths)
    angle = numpy.degrees(element.half_angle(depths))
    return {
        f"{job.name}_axes.csv": _axes_table(job, job.element.constants.clearance + job.depth),
        f"{job.name}_law.csv": _csv_text(
            _COLUMNS, (depths, force, stiffness, energy, angle, element.max_pressure(depths))
        ),
        f"{job.name}_power.txt": _power_law_text(element, job.fitted_power_law),
    }


_TABLE_ROWS = 201  # number of indentations in a table of the law

_COLUMNS = ("indentation_mm", "force_N", "stiffness_N/mm", "energy_N_mm", "half_angle_deg", "max_pressure_MPa")


_AXIS_COLUMNS = (
    "displacement_mm",
    *(f"{name}_{axis}" for axis in ("along", "across") for name in ("force_N", "max_pressure_MPa")),
)


def _axes_table(job: ExportJob, limit: float) -> str:
    """Return a CSV table over the displacement from rest in mm, along the axis of the dome or the load and across it.

    The rest position of a joint with clearance is the socket's centre. The force on the ball is in the direction of
    the displacement, negative for a positive one.
    """
    element, distances = job.element, numpy.linspace(-limit, limit, _TABLE_ROWS) * (1 - 1e-9)
    constants, columns = element.constants, [distances]
    rest = element.rest_position if isinstance(element, PreloadedElement) else numpy.zeros(3)
    dome = numpy.array([constants.dome_x, constants.dome_y, constants.dome_z])
    across = numpy.cross(dome, numpy.eye(3)[numpy.argmin(abs(dome))])
    across /= numpy.linalg.norm(across)
    cosine, sine = numpy.cos(job.tilt), numpy.sin(job.tilt)
    for axis in (cosine * dome + sine * across, cosine * across - sine * dome):
        load = element(rest + distances[:, None] * axis)
        columns += [load.force @ axis, load.max_pressure]
    return _csv_text(_AXIS_COLUMNS, columns)


_PIVOT_COLUMNS = (
    "force_N",
    "indentation_m",
    "secant_stiffness_N/m",
    "tangent_stiffness_N/m",
    "indentation_by_Hertz/indentation",
    "tangent_stiffness_by_Hertz/tangent_stiffness",
)
_LIGHTEST = 1e-3  # first indentation of a pivot's table over its last one


def pivot_texts(job: ExportJob) -> Texts:
    """Return the table of a pivot in SI units, with Hertz's formula beside it, and a Python module that reads it."""
    element, depths = job.central_element, numpy.geomspace(_LIGHTEST * job.depth, job.depth, _TABLE_ROWS)
    _, force, tangent = element.potential(depths)
    hertz = Hertz().press(element.joint.with_floats(), force=force)
    ratios = hertz.indentation / depths, hertz.stiffness / tangent
    rows = force, 1e-3 * depths, 1e3 * force / depths, 1e3 * tangent, *ratios
    return {f"{job.name}_pivot.csv": _csv_text(_PIVOT_COLUMNS, rows), **job.file("ross.py.txt")}


def _csv_text(heads: Sequence[str], columns: Sequence[Numbers]) -> str:
    """Return a CSV table with nine digits."""
    rows = numpy.stack(columns, axis=1).tolist()
    return "\n".join([",".join(heads), *(",".join(f"{value:.9g}" for value in row) for row in rows)]) + "\n"


def two_axes_note(job: ExportJob) -> str:
    """Return the note on the directions of a table; empty for a joint whose force is central."""
    if job.element.constants.rim > 0.0:
        return f"the rim of the cup is in {job.name}_axes.csv only"
    if not isinstance(job.element, PreloadedElement):
        return ""
    return (
        "force on the ball over its displacement from rest, along the cup's axis (positive to the dome) or the load, "
        "and across it; for other directions export c, drake, modelica or mujoco, or use `ballsocket fmu`"
    )


def _power_law_text(element: ForceElement, fit: PowerFit) -> str:
    """Return the fitted power law as text, with expressions for Adams, MotionSolve and Simpack in mm, N and s."""
    c, k, n = element.constants.clearance, fit.stiffness, fit.exponent
    return f"""# F = k d^n of a ball in a socket, in mm, N and s; written by ballsocket {__version__}
# {element.model.name}: error up to {fit.depth:.4g} mm at most {100 * fit.error:.2g} % of the force at that depth
k = {k!r}
n = {n!r}
clearance = {c!r}

# Adams and MotionSolve: a force along the line of centres of two markers, ball on socket; mm, N
-{k!r} * MAX(DM(ball, socket) - {c!r}, 0)**{n!r}

# Simpack: an expression, x the distance of the markers
-{k!r} * MAX(x - {c!r}, 0)^{n!r}
"""
