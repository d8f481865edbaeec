"""What a contact does to the socket: displacement of its surface, stresses inside, by the sum of modes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import inf, log1p, radians

import numpy

from ...contact.strength import share_of_ball
from ...core.arrays import Numbers
from ...core.stress import Peak, Stress
from .abel import AbelState
from .free_face import free_face_of
from .hemisphere import low_modes, on_hemisphere, response
from .intervals import Intervals
from .load_curve import LoadCurve
from .tabulated.chebyshev import angle_at, angle_root

MIN_HALF_ANGLE = radians(1.0)
"""The narrowest contact whose inside is sum_series."""

_WAVES = 600  # n ε up to which modes are sum_series at the surface
_FEWEST, _MOST = 2000, 35_000


def surface_displacement(state: AbelState, angle: Numbers) -> Numbers:
    """Radial displacement of the socket's surface in mm, outwards, of one contact; shape of `angle`."""
    count = _modes(state, 0.0)
    amplitudes = _tapered(state, count) * state.kernel.socket.compliance(numpy.arange(count))
    return (amplitudes @ _legendre(angle.ravel(), count)[0]).reshape(angle.shape)


def stress(state: AbelState, angle: Numbers, depth: Numbers) -> Stress:
    """Stresses of one contact at polar angles (rad) and depths below the surface of the socket (mm)."""
    shallowest = float(numpy.min(depth, initial=inf))
    return _summed(state, angle, depth, _modes(state, shallowest if shallowest < inf else 0.0))


def _summed(state: AbelState, angle: Numbers, depth: Numbers, count: int) -> Stress:
    """Stresses from so many modes."""
    angle, depth = numpy.broadcast_arrays(angle, depth)
    angles, which = numpy.unique(angle.ravel(), return_inverse=True)
    depths, level = numpy.unique(depth.ravel(), return_inverse=True)
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


def peak(state: AbelState, thickness: float) -> Peak:
    """The largest von Mises stress of one contact in a liner of that thickness, at the surface or below."""
    angles, depths = _places(state, thickness)
    for _ in range(_ROUNDS):
        values = stress(state, angles[:, None], depths).von_mises
        i, j = numpy.unravel_index(numpy.argmax(values), values.shape)
        angles, depths = _around(angles, int(i)), _around(depths, int(j))
        best = Peak(von_mises=float(values[i, j]), depth=float(depths[_HALF]), angle=float(angles[_HALF]))
    return best


def _places(state: AbelState, thickness: float) -> tuple[Numbers, Numbers]:
    """Where the largest stress is looked for at first: angles up to a little beyond the edge, and depths."""
    angles = float(state.half_angle[0]) * numpy.linspace(0.0, 1.3, 27)
    deepest = min(thickness, 3 * state.gap.socket_radius * float(numpy.sin(state.half_angle[0])))
    return angles, deepest * numpy.linspace(0.0, 1.0, 26)


def estimate_von_mises(state: AbelState) -> Numbers:
    """About what `largest_von_mises` says of each contact, within `VON_MISES_TOLERANCE` of it: from an eighth of the modes."""
    values = state.max_pressure * share_of_ball(state.kernel.socket.shells[0].poisson)
    for number in numpy.flatnonzero(state.half_angle >= MIN_HALF_ANGLE):
        alone = state.alone(int(number))
        angles, depths = _places(alone, alone.kernel.socket.shells[0].thickness)
        count = _modes(alone, 0.0) // _FEWER_MODES
        values[number] = _summed(alone, angles[::2, None], depths[::2], count).von_mises.max()
    return values


VON_MISES_TOLERANCE, _FEWER_MODES = 0.1, 8
_OFF_RIM = radians(85.0)  # the corner of the rim has no largest stress


def von_mises_change(closed: AbelState, half_angle: float) -> float:
    """Compute the relative change of the largest von Mises stress in the liner on the hemisphere.

    Both stresses are the largest at a few angles and depths, from a quarter of the modes.
    """
    kernel = closed.kernel
    intervals = Intervals(half_angle=numpy.array([half_angle]), grid=closed.grid)
    free = on_hemisphere(replace(closed, intervals=intervals), response(kernel.socket, kernel.ball))
    angles = min(1.2 * float(closed.half_angle[0]), _OFF_RIM) * numpy.linspace(0.0, 1.0, 9)
    face = free_face_of(kernel.socket)
    if face is None:
        return numpy.nan
    depths = face.liner_radii - kernel.socket.radius
    count = min(_modes(closed, float(depths.min())), _modes(closed, 0.0) // 4)
    before, after = (_summed(state, angles[:, None], depths, count) for state in (closed, free))
    more = face.liner_stress(low_modes(free)[0], angles)
    total = Stress(**{name: part + vars(more)[name] for name, part in vars(after).items()})
    same_force = float(closed.force[0] / free.force[0])  # at one half angle all is proportional to the clearance
    return same_force * float(total.von_mises.max() / before.von_mises.max()) - 1


def largest_von_mises(state: AbelState, reached: Numbers) -> Numbers:
    """That in the liner of each contact that was reached (a mask), NaN of the others; of a narrow one as in a ball."""
    liner = state.kernel.socket.shells[0]
    values = numpy.full(len(state.half_angle), numpy.nan)
    for number in numpy.flatnonzero(reached):
        if state.half_angle[number] < MIN_HALF_ANGLE:  # a half-space
            values[number] = state.max_pressure[number] * share_of_ball(liner.poisson)
        else:
            values[number] = peak(state.alone(int(number)), liner.thickness).von_mises
    return values


_HALF, _ROUNDS = 4, 4


def _around(values: Numbers, i: int) -> Numbers:
    """A finer row from the neighbour below to the neighbour above."""
    low, high = values[max(i - 1, 0)], values[min(i + 1, len(values) - 1)]
    below = numpy.linspace(low, values[i], _HALF + 1)
    return numpy.append(below, numpy.linspace(values[i], high, _HALF + 1)[1:])


def _modes(state: AbelState, depth: float) -> int:
    """How many modes are sum_series: enough waves over the contact, fewer where they fade like (1 + depth/R2)^-n."""
    surface = numpy.clip(_WAVES / float(state.half_angle[0]), _FEWEST, _MOST)
    fading = 35 / log1p(depth / state.gap.socket_radius) if depth > 0 else _MOST
    return int(min(surface, max(fading, 200)))


def _tapered(state: AbelState, count: int) -> Numbers:
    """p_n of one contact, the last half let out gently so that the sum does not ring."""
    n = numpy.arange(count)
    taper = numpy.cos(numpy.pi * numpy.clip(n / count - 0.5, 0.0, 0.5)) ** 2
    return state.modes(count)[0] * taper


def _legendre(angle: Numbers, count: int) -> tuple[Numbers, Numbers]:
    """P_n(cos φ) and dP_n/d(cos φ) for n below count, shape (count, angles)."""
    x, n = numpy.cos(angle), numpy.arange(count)[:, None]
    P, slope = numpy.empty((count, len(x))), numpy.zeros((count, len(x)))
    P[0], P[1] = 1.0, x
    ahead, back, dropped = list((2 * n - 1) * x / numpy.maximum(n, 1)), P[0], numpy.empty(len(x))
    for k, (here, there) in enumerate(pairwise(P[1:]), start=2):
        numpy.multiply(ahead[k], here, out=there)
        there -= numpy.multiply(back, 1 - 1 / k, out=dropped)
        back = here
    growth = (2 * n[1:] - 1) * P[:-1]
    for parity in (0, 1):  # each slope is that two degrees before, and (2n - 1) P_n-1
        slope[1 + parity :: 2] = numpy.cumsum(growth[parity::2], axis=0)
    return P, slope


_STRESSES = 40  # steps between half angles where stresses are known


@dataclass(frozen=True, kw_only=True, eq=False)
class StressCurve:
    """The largest von Mises stress in the liner over the largest pressure, along a curve, to about 1e-3.

    `points` are those at which a contact is solved.
    """

    curve: LoadCurve
    points: int

    @property
    def _ratio(self) -> float:
        return self.curve.ratio

    @cached_property
    def _widest(self) -> float:
        return float(angle_root(self.curve.widest, self._ratio))

    def share(self, angle: Numbers) -> Numbers:
        """Largest von Mises stress in the liner over the largest pressure, between some half angles along the curve."""
        along = numpy.clip((angle_root(angle, self._ratio) - self._roots[0]) / self._roots[1], 0.0, _STRESSES - 1e-9)
        first, part = along.astype(int), along % 1
        low, high = (self._stressed(number) for number in (first, first + 1))
        return low + part * (high - low)

    @property
    def _roots(self) -> tuple[float, float]:
        """Roots of the half angles where stresses are known: the first, and the step."""
        first = min(float(angle_root(MIN_HALF_ANGLE, self._ratio)), self._widest)
        return first, (self._widest - first) / _STRESSES

    def _stressed(self, numbers: Numbers) -> Numbers:
        """The shares at some of those half angles, which are solved when they are first asked for."""
        each, which = numpy.unique(numbers, return_inverse=True)
        return numpy.array([self._share_at(int(number)) for number in each])[which.ravel()]

    def _share_at(self, number: int) -> float:
        if number not in self._shares:
            root = self._roots[0] + number * self._roots[1]
            angle = float(angle_at(2 * root - 1, self._ratio))
            state = self.curve.state(numpy.array([min(angle, self.curve.widest)]), self.points)
            self._shares[number] = float((largest_von_mises(state, numpy.array([True])) / state.max_pressure)[0])
        return self._shares[number]

    @cached_property
    def _shares(self) -> dict[int, float]:
        return {}
