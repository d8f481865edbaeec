"""What a contact does to the socket: displacement of its surface, stresses inside, by the sum of modes."""

from __future__ import annotations

from dataclasses import replace
from math import log1p, radians

import numpy

from ..arrays import Numbers
from ..contact.strength import share_of_ball
from ..stress import Peak, Stress
from .abel import State
from .intervals import Intervals

NARROWEST = radians(1.0)
"""The narrowest contact whose inside is summed."""

_WAVES = 600  # n ε up to which modes are summed at the surface
_FEWEST, _MOST = 2000, 35_000


def surface_displacement(state: State, angle: Numbers) -> Numbers:
    """Radial displacement of the socket's surface in mm, outwards, of one contact; shape of `angle`."""
    count = _modes(state, 0.0)
    amplitudes = _tapered(state, count) * state.kernel.socket.compliance(numpy.arange(count))
    return (amplitudes @ _legendre(angle.ravel(), count)[0]).reshape(angle.shape)


def stress(state: State, angle: Numbers, depth: Numbers) -> Stress:
    """Stresses of one contact at polar angles (rad) and depths below the surface of the socket (mm)."""
    angle, depth = numpy.broadcast_arrays(angle, depth)
    angles, which = numpy.unique(angle.ravel(), return_inverse=True)
    depths, level = numpy.unique(depth.ravel(), return_inverse=True)
    count = _modes(state, float(depths[0]) if depths.size else 0.0)
    fields = state.kernel.socket.fields(numpy.arange(count), state.gap.socket_radius + depths)
    P, slope = _legendre(angles, count)
    modes = _tapered(state, count)

    def total(field: Numbers, wave: Numbers) -> Numbers:
        table = (modes[:, None] * field).T @ wave  # depths by angles
        return table[level.ravel(), which.ravel()].reshape(angle.shape)

    tilt = total(fields.sigma_cot, -numpy.cos(angles) * slope)
    return Stress(
        radial=total(fields.sigma_rr, P),
        meridional=total(fields.sigma_phiphi, P) - tilt,
        hoop=total(fields.sigma_thetatheta, P) + tilt,
        shear=total(fields.sigma_rphi, -numpy.sin(angles) * slope),
    )


def peak(state: State, thickness: float) -> Peak:
    """The largest von Mises stress of one contact in a liner of that thickness, at the surface or below."""
    angles = float(state.half_angle[0]) * numpy.linspace(0.0, 1.3, 27)  # a little beyond the edge
    deepest = min(thickness, 3 * state.gap.socket_radius * float(numpy.sin(state.half_angle[0])))
    depths = deepest * numpy.linspace(0.0, 1.0, 26)
    for _ in range(4):
        values = stress(state, angles[:, None], depths).von_mises
        i, j = numpy.unravel_index(numpy.argmax(values), values.shape)
        angles, depths = _around(angles, int(i)), _around(depths, int(j))
        best = Peak(von_mises=float(values[i, j]), depth=float(depths[_HALF]), angle=float(angles[_HALF]))
    return best


def largest_von_mises(state: State, reached: Numbers) -> Numbers:
    """That in the liner of each contact that was reached (a mask), NaN of the others; of a narrow one as in a ball."""
    liner = state.kernel.socket.shells[0]
    values = numpy.full(len(state.half_angle), numpy.nan)
    for number in numpy.flatnonzero(reached):
        angle = state.half_angle[number : number + 1]
        if angle[0] < NARROWEST:  # a half-space
            values[number] = state.max_pressure[number] * share_of_ball(liner.poisson)
        else:
            alone = replace(state, intervals=Intervals(half_angle=angle, grid=state.grid))
            values[number] = peak(alone, liner.thickness).von_mises
    return values


_HALF = 4


def _around(values: Numbers, i: int) -> Numbers:
    """A finer row from the neighbour below to the neighbour above."""
    low, high = values[max(i - 1, 0)], values[min(i + 1, len(values) - 1)]
    below = numpy.linspace(low, values[i], _HALF + 1)
    return numpy.append(below, numpy.linspace(values[i], high, _HALF + 1)[1:])


def _modes(state: State, depth: float) -> int:
    """How many modes are summed: enough waves over the contact, fewer where they fade like (1 + depth/R2)^-n."""
    surface = numpy.clip(_WAVES / float(state.half_angle[0]), _FEWEST, _MOST)
    fading = 35 / log1p(depth / state.gap.socket_radius) if depth > 0 else _MOST
    return int(min(surface, max(fading, 200)))


def _tapered(state: State, count: int) -> Numbers:
    """p_n of one contact, the last half let out gently so that the sum does not ring."""
    n = numpy.arange(count)
    taper = numpy.cos(numpy.pi * numpy.clip(n / count - 0.5, 0.0, 0.5)) ** 2
    return state.modes(count)[0] * taper


def _legendre(angle: Numbers, count: int) -> tuple[Numbers, Numbers]:
    """P_n(cos φ) and dP_n/d(cos φ) for n below count, shape (count, angles)."""
    x = numpy.cos(angle)
    P, slope = numpy.empty((count, len(x))), numpy.empty((count, len(x)))
    P[0], P[1], slope[0], slope[1] = 1.0, x, 0.0, 1.0
    for n in range(2, count):
        P[n] = ((2 * n - 1) * x * P[n - 1] - (n - 1) * P[n - 2]) / n
        slope[n] = slope[n - 2] + (2 * n - 1) * P[n - 1]
    return P, slope
