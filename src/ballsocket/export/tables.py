"""A law as numbers: a table, and the k and n that programs with a power law ask for."""

from __future__ import annotations

import numpy

from ..dynamics import ForceElement
from .law_fit import PowerFit

_ROWS = 201
_COLUMNS = ("indentation_mm", "force_N", "stiffness_N/mm", "energy_N_mm", "half_angle_deg", "max_pressure_MPa")


def law_table(element: ForceElement, depth: float) -> str:
    """The law up to a depth in mm, as CSV."""
    d = numpy.linspace(0.0, depth, _ROWS)
    energy, force, stiffness = element.potential(d)
    angle = numpy.degrees(element.half_angle(d))
    columns = (d, force, stiffness, energy, angle, element.max_pressure(d))
    rows = numpy.stack(columns, axis=1).tolist()
    return "\n".join([",".join(_COLUMNS), *(",".join(f"{value:.9g}" for value in row) for row in rows)]) + "\n"


def power_words(element: ForceElement, fit: PowerFit, version: str) -> str:
    """k and n, how far they are off, and how Adams, MotionSolve and Simpack are given them; mm, N, s."""
    c, k, n = element.constants.clearance, fit.stiffness, fit.exponent
    return f"""# F = k d^n of a ball in a socket, in mm, N and s; written by ballsocket {version}
# {element.model.name}: at most {100 * fit.error:.2g} % of the force at {fit.depth:.4g} mm off, up to there
k = {k!r}
n = {n!r}
clearance = {c!r}

# Adams and MotionSolve: a force along the line of centres of two markers, ball on socket; mm, N
-{k!r} * MAX(DM(ball, socket) - {c!r}, 0)**{n!r}

# Simpack: an expression, x the distance of the markers
-{k!r} * MAX(x - {c!r}, 0)^{n!r}
"""
