"""Displacement of the socket's surface and stresses inside, by the sum of modes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isqrt, log1p, radians

import numpy

from ...contact.coordinates import angle_root, half_angle_at
from ...core.arrays import Numbers
from ...core.stress import Peak, Stress
from .abel import AbelState
from .free_face import free_face_of
from .hemisphere import hemisphere_response, low_pressure_modes, solve_on_hemisphere
from .kernel import Intervals
from .load_curve import LoadCurve

MIN_HALF_ANGLE = radians(1.0)  # half angle in rad of the narrowest contact whose interior is computed

_SIMILAR_ANGLE = radians(1.5)
"""Half angle in rad of the contact whose stress ratio stands for narrower ones; it needs fewer modes than 1°."""

_SURFACE_WAVES = 600  # n ε of the last mode at the surface
_MIN_MODES, _MAX_MODES = 2000, 35_000


def surface_displacement(state: AbelState, angle: Numbers) -> Numbers:
    """Compute the outward radial displacement of the socket's surface in mm for one contact; shape of `angle`."""
    count = _mode_count(state, 0.0)
    amplitudes = _taper_modes(state, count) * state.kernel.socket.compliance(numpy.arange(count))
    return (amplitudes @ _legendre_and_slopes(angle.ravel(), count)[0]).reshape(angle.shape)


def stress(state: AbelState, angle: Numbers, depth: Numbers) -> Stress:
    """Compute the stresses of one contact in MPa at polar angles (rad) and depths below the bore (mm)."""
    shallowest = float(numpy.min(depth, initial=inf))
    return _sum_stresses(state, angle, depth, _mode_count(state, shallowest if shallowest < inf else 0.0))


def _sum_stresses(state: AbelState, angle: Numbers, depth: Numbers, count: int) -> Stress:
    """Compute the stresses of one contact in MPa as the sum of this number of modes."""
    angle, depth = numpy.broadcast_arrays(angle, depth)
    angles, column = numpy.unique(angle.ravel(), return_inverse=True)
    depths, row = numpy.unique(depth.ravel(), return_inverse=True)
    P, slope = _legendre_and_slopes(angles, count)
    waves = P, -numpy.cos(angles) * slope, -numpy.sin(angles) * slope
    modes = _taper_modes(state, count)
    counts = numpy.array([min(count, _mode_count(state, float(depth))) for depth in depths])
    halvings = numpy.floor(numpy.log2(count / counts)).astype(int)  # deep points need few modes
    tables = numpy.empty((5, len(depths), len(angles)))
    for halving in sorted(set(halvings.ravel().tolist())):  # numpy.unique imports masked arrays
        band, size = halvings == halving, count >> halving
        fields = state.kernel.socket.fields(numpy.arange(size), state.gap.socket_radius + depths[band])
        cosine, cotangent, sine = (wave[:size] for wave in waves)
        pairs = [(fields.sigma_rr, cosine), (fields.sigma_phiphi, cosine), (fields.sigma_thetatheta, cosine)]
        pairs += [(fields.sigma_cot, cotangent), (fields.sigma_rphi, sine)]
        tables[:, band] = [(modes[:size, None] * field).T @ wave for field, wave in pairs]
    radial, meridional, hoop, tilt, shear = tables[:, row.ravel(), column.ravel()].reshape(5, *angle.shape)
    return Stress(radial=radial, meridional=meridional - tilt, hoop=hoop + tilt, shear=shear)


def find_peak_stress(state: AbelState, thickness: float) -> Peak:
    """Find the largest von Mises stress of one contact in a liner of this thickness, at the surface or below."""
    angles, depths = _search_grid(state, thickness)
    for _ in range(_SEARCH_ROUNDS):
        values = stress(state, angles[:, None], depths).von_mises
        i, j = numpy.unravel_index(numpy.argmax(values), values.shape)
        angles, depths = _refine_points_around(angles, int(i)), _refine_points_around(depths, int(j))
    depth, angle = float(depths[_HALF_INTERVALS]), float(angles[_HALF_INTERVALS])
    return Peak(von_mises=float(values[i, j]), depth=depth, angle=angle)


def _search_grid(state: AbelState, thickness: float) -> tuple[Numbers, Numbers]:
    """Make the first grid to search for the largest stress: angles (rad) to beyond the edge, and depths (mm)."""
    angles = float(state.half_angle[0]) * numpy.linspace(0.0, 1.3, 27)
    deepest = min(thickness, 3 * state.gap.socket_radius * float(numpy.sin(state.half_angle[0])))
    return angles, deepest * numpy.linspace(0.0, 1.0, 26)


def estimate_von_mises(state: AbelState) -> Numbers:
    """Estimate the largest von Mises stress of each contact in MPa from an eighth of the modes.

    The estimate differs from `largest_von_mises` by at most `VON_MISES_TOLERANCE`.
    """

    def estimate_peak(contact: AbelState) -> float:
        angles, depths = _search_grid(contact, contact.kernel.socket.shells[0].thickness)
        count = _mode_count(contact, 0.0) // _FEWER_MODES
        return float(_sum_stresses(contact, angles[::2, None], depths[::2], count).von_mises.max())

    return _evaluate_contacts(estimate_peak, state, numpy.ones_like(state.half_angle, dtype=bool))


VON_MISES_TOLERANCE = 0.1  # relative error of `estimate_von_mises`
_FEWER_MODES = 8  # the estimate divides the number of modes by this
_MAX_SEARCH_ANGLE = radians(85.0)  # the stress in the corner of the rim is unbounded


def von_mises_change(closed: AbelState, half_angle: float) -> float:
    """Compute the relative change of the largest von Mises stress in the liner on the hemisphere.

    Both stresses are the largest at a few angles and depths, computed from a quarter of the modes.
    """
    kernel = closed.kernel
    intervals = Intervals(half_angle=numpy.array([half_angle]), grid=closed.grid)
    free = solve_on_hemisphere(replace(closed, intervals=intervals), hemisphere_response(kernel.socket, kernel.ball))
    angles = min(1.2 * float(closed.half_angle[0]), _MAX_SEARCH_ANGLE) * numpy.linspace(0.0, 1.0, 9)
    face = free_face_of(kernel.socket)
    if face is None:
        return numpy.nan
    depths = face.liner_radii - kernel.socket.radius
    count = min(_mode_count(closed, float(depths.min())), _mode_count(closed, 0.0) // 4)
    before, after = (_sum_stresses(state, angles[:, None], depths, count) for state in (closed, free))
    release = face.liner_stress(low_pressure_modes(free)[0], angles)
    total = Stress(**{name: values + vars(release)[name] for name, values in vars(after).items()})
    same_force = float(closed.force[0] / free.force[0])  # at one half angle stresses are proportional to the clearance
    return same_force * float(total.von_mises.max() / before.von_mises.max()) - 1


def largest_von_mises(state: AbelState, reachable: Numbers) -> Numbers:
    """Compute the largest von Mises stress in the liner in MPa for the contacts in a mask, NaN for others."""

    def peak(contact: AbelState) -> float:
        return find_peak_stress(contact, contact.kernel.socket.shells[0].thickness).von_mises

    return _evaluate_contacts(peak, state, reachable)


def _evaluate_contacts(peak: Callable[[AbelState], float], state: AbelState, mask: Numbers) -> Numbers:
    """Evaluate the largest von Mises stress in MPa of the contacts in a mask one by one; NaN for the others."""
    values = numpy.full(len(state.half_angle), numpy.nan)
    for number in numpy.flatnonzero(mask):
        contact, angle = state.single_contact(int(number)), state.half_angle[number]
        if angle >= MIN_HALF_ANGLE:
            values[number] = peak(contact)
        else:
            wider = [_wider_contact(contact, factor * _SIMILAR_ANGLE) for factor in (1, 2)]
            first, second = (peak(similar) / float(similar.max_pressure[0]) for similar in wider)
            values[number] = state.max_pressure[number] * (first + (angle / _SIMILAR_ANGLE - 1) * (second - first))
    return values


def _wider_contact(contact: AbelState, angle: float) -> AbelState:
    """Make the contact of a half angle in rad on thicker layers, with the same ratio of contact radius and thickness.

    A narrow contact acts on plane layers. Its stress ratio depends on this ratio alone, and the curvature adds a term
    that is proportional to the half angle.
    """
    socket, factor = contact.kernel.socket, angle / float(contact.half_angle[0])
    shells = tuple(replace(shell, thickness=shell.thickness * factor) for shell in socket.shells)
    return replace(
        contact,
        kernel=replace(contact.kernel, socket=replace(socket, shells=shells)),
        intervals=Intervals(half_angle=numpy.array([angle]), grid=contact.grid),
    )


_HALF_INTERVALS, _SEARCH_ROUNDS = 4, 4


def _refine_points_around(values: Numbers, i: int) -> Numbers:
    low, high = values[max(i - 1, 0)], values[min(i + 1, len(values) - 1)]
    below = numpy.linspace(low, values[i], _HALF_INTERVALS + 1)
    return numpy.append(below, numpy.linspace(values[i], high, _HALF_INTERVALS + 1)[1:])


def _mode_count(state: AbelState, depth: float) -> int:
    """Choose the number of modes to sum for the stresses of one contact at a depth in mm.

    It resolves the contact, and is smaller where modes decay like (1 + depth/R2)^-n.
    """
    surface = numpy.clip(_SURFACE_WAVES / float(state.half_angle[0]), _MIN_MODES, _MAX_MODES)
    decayed = 35 / log1p(depth / state.gap.socket_radius) if depth > 0 else _MAX_MODES
    return int(min(surface, max(decayed, 200)))


def _taper_modes(state: AbelState, count: int) -> Numbers:
    """Compute the pressure modes p_n of one contact in MPa, tapered over the last half to avoid oscillations."""
    n = numpy.arange(count)
    taper = numpy.cos(numpy.pi * numpy.clip(n / count - 0.5, 0.0, 0.5)) ** 2
    return state.pressure_modes(count)[0] * taper


def _legendre_and_slopes(angle: Numbers, count: int) -> tuple[Numbers, Numbers]:
    """Compute the Legendre polynomials P_n(cos φ) and their derivatives by cos φ: (count, angles)."""
    P, n = _legendre(angle, count), numpy.arange(1, count)[:, None]
    growth, slope = (2 * n - 1) * P[:-1], numpy.zeros_like(P)
    for parity in (0, 1):  # each slope is that two degrees before, and (2n - 1) P_n-1
        slope[1 + parity :: 2] = numpy.cumsum(growth[parity::2], axis=0)
    return P, slope


def _legendre(angle: Numbers, count: int) -> Numbers:
    """Compute the Legendre polynomials P_n(cos φ): (count, angles).

    Blocks of degrees advance together from two starts, as P_n and its difference D_n to P_n-1 depend linearly on those
    at the end of the block before.
    """
    size = isqrt(count) + 1
    reciprocal = 1 / numpy.arange(1, size * size + 1).reshape(size, size, 1)  # 1/n of blocks and degrees
    decay, drop = 1 - reciprocal, (2 - reciprocal) * -2 * numpy.sin(angle / 2) ** 2  # cos φ - 1 = -2 sin²(φ/2)
    starts = numpy.empty((size, 2, size, len(angle)))  # degrees, starts, blocks, angles
    P, D = (numpy.array(pair)[:, None, None] for pair in ((1.0, 0.0), (0.0, 1.0)))
    for degree in range(size):  # n P_n = (2n - 1) cos φ P_n-1 - (n - 1) P_n-2
        D = decay[:, degree] * D + drop[:, degree] * P
        starts[degree] = P = P + D
    polynomials = numpy.ones((1 + size * size, len(angle)))
    last, difference = numpy.ones_like(angle), numpy.zeros_like(angle)
    for block in range(size):
        polynomials[1 + block * size :][:size] = starts[:, 0, block] * last + starts[:, 1, block] * difference
        last, difference = polynomials[(block + 1) * size], D[0, block] * last + D[1, block] * difference
    return polynomials[:count]


_STRESS_INTERVALS = 40  # between half angles where stresses are solved
_NARROWEST = radians(0.005)
"""Half angle in rad below which the stress ratio is constant: the contact is small against the thinnest liner."""


@dataclass(frozen=True, kw_only=True, eq=False)
class StressCurve:
    """Ratio of the largest von Mises stress in the liner to the largest pressure along a load curve, to about 1e-3.

    `points` is the number of quadrature points of each solution.
    """

    curve: LoadCurve
    points: int
    _cached_ratios: dict[int, float] = field(default_factory=dict, init=False, repr=False)  # by index of the half angle

    def stress_ratio(self, angle: Numbers) -> Numbers:
        """Interpolate the ratio of the largest von Mises stress to the largest pressure at half angles."""
        start, step = self._first_coordinate_and_step
        position = (angle_root(angle, self.curve.ratio) - start) / step
        position = numpy.clip(position, 0.0, _STRESS_INTERVALS - 1e-9)
        first, fraction = position.astype(int), position % 1
        unique, which = numpy.unique(numpy.stack([first, first + 1]), return_inverse=True)
        for number in set(unique.tolist()) - set(self._cached_ratios):
            half_angle = float(half_angle_at(2 * (start + number * step) - 1, self.curve.ratio))
            state = self.curve.state(numpy.array([min(half_angle, self.curve.widest_angle)]), self.points)
            self._cached_ratios[number] = float((largest_von_mises(state, numpy.array([True])) / state.max_pressure)[0])
        low, high = numpy.array([self._cached_ratios[number] for number in unique.tolist()])[which.reshape(2, -1)]
        return low + fraction * (high - low)

    @cached_property
    def _first_coordinate_and_step(self) -> tuple[float, float]:
        """First coordinate of the half angles at which stresses are solved, and the coordinate step to the next."""
        first, last = (float(angle_root(a, self.curve.ratio)) for a in (_NARROWEST, self.curve.widest_angle))
        return min(first, last), max(last - first, 0.0) / _STRESS_INTERVALS
