"""Contacts read from the tables: found by their loads, block by block, with their energy and their pressure."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from math import inf, pi, prod

import numpy

from ....core import arrays
from ....core.arrays import Array, broadcast, clip, divisor, gauss_legendre, sin, sqrt, where
from ....problem import Joint
from .chebyshev import LIMIT, angle_coordinate, chebyshev_polynomials, chebyshev_values
from .curves import SMALL_LOAD, JointCurves, curves_of_one
from .formulas import sum_series

_BLOCK = 2000  # contacts at a time: what stays in the cache; rows of a power of two would fall on each other there


@dataclass(frozen=True, kw_only=True, eq=False)
class TableSolution:
    """Contacts at the half angles that belong to the loads, as the `Laws` of the contact they belong to.

    `values` are d, F, p0 and dF/dd.
    """

    file: str
    joint: Joint
    angle: Array
    values: tuple[Array, Array, Array, Array]

    @property
    def half_angle(self) -> Array:
        return self.angle

    @property
    def pole_pressure(self) -> Array:
        return self.values[2]

    @property
    def max_pressure(self) -> Array:
        """Largest pressure in MPa, the one at the pole: no joint of the tables has more elsewhere."""
        return self.values[2]

    @property
    def max_pressure_angle(self) -> Array:
        return 0.0 * self.angle

    @property
    def stiffness(self) -> Array:
        return self.values[3]

    @property
    def foundation_modulus(self) -> Array:
        return where(self.values[0] == 0, inf, self.values[2] / divisor(self.values[0]))

    @cached_property
    def energy(self) -> Array:
        (energy,) = _in_blocks(self.file, self.joint, self.angle, _work)
        return where(self.angle > 0, energy, 0.0 * self.angle)

    @property
    def pressure_integral(self) -> Array:
        """From U = (d F - c ∫ p (1 - cos φ) dA)/2 and F = ∫ p cos φ dA."""
        d, F, _, _ = self.values
        return F + (d * F - 2 * self.energy) / self.joint.clearance

    @cached_property
    def _profile(self) -> Array:
        """Chebyshev coefficients of p/(p0 sqrt(1 - v)) in 2v - 1 (first axis), v = sin²(φ/2)/sin²(ε/2)."""
        (series,) = _in_blocks(self.file, self.joint, self.angle, _profile)
        return series

    @cached_property
    def _tilt(self) -> tuple[Array, Array]:
        """What makes the profile 1 at the pole and carry F: p = p0 sqrt(1 - v) [q(v) + (first) + (second) v]."""
        q = [self._profile[k, ...] for k in range(self._profile.shape[0])]
        _, F, p0, _ = self.values
        height = sin(divisor(self.angle) / 2) ** 2
        plain, tilted = _moments(len(q))
        carries = [even - 2 * height * odd for even, odd in zip(plain, tilted, strict=True)]
        lift = 1 - arrays.weighted_sum(q, [(-1.0) ** k for k in range(len(q))])
        wanted = F / divisor(4 * pi * self.joint.socket_radius**2 * p0 * height)
        carried = sum((part * each for part, each in zip(q, carries, strict=False)), lift * carries[0])
        return lift, (wanted - carried) / carries[-1]

    def pressure(self, angle: Array) -> Array:
        lift, tilt = self._tilt
        half, height = sin(angle / 2), sin(divisor(self.angle) / 2) ** 2
        v = half * half / height
        total = _clenshaw(self._profile, clip(2 * v - 1, -1.0, 1.0)) + lift + tilt * v
        inside = (v < 1) & (abs(angle) < pi) & (self.angle > 0)
        return where(inside, self.values[2] * sqrt(clip(1 - v, 0.0, 1.0)) * clip(total, 0.0, inf), 0.0)


def _clenshaw(series: Array, x: Array) -> Array:
    """Σ series[k] T_k(x)."""
    ahead = here = 0.0 * x
    for k in range(series.shape[0] - 1, 0, -1):
        here, ahead = series[k, ...] + 2 * x * here - ahead, here
    return series[0, ...] + x * here - ahead


def _profile(curves: JointCurves, angle: Array) -> tuple[Array]:
    series = curves.series("profile")
    if series.ndim == 2:
        return (series @ chebyshev_values(angle_coordinate(angle, curves.ratio), series.shape[1]),)
    waves = chebyshev_polynomials(angle_coordinate(angle, curves.ratio), series.shape[1])
    return (arrays.namespace(angle).stack([sum_series(series[k, ...], waves) for k in range(series.shape[0])]),)


def _work(curves: JointCurves, angle: Array) -> tuple[Array]:
    """∫ F dd, with ε' = ε sin²(πy/2): a root at a point contact, and steep where the load becomes infinite."""
    total = 0.0 * angle
    for node, weight in zip(*gauss_legendre(32), strict=True):
        _, F, _, _, deepening = curves.contact(angle * math.sin(pi / 2 * node) ** 2)
        total = total + pi * weight / math.tan(pi / 2 * node) * F * deepening
    return (total,)


@cache
def _moments(size: int) -> tuple[list[float], list[float]]:
    """∫ sqrt(1 - v) f dv and ∫ sqrt(1 - v) f v dv over [0, 1], for f = T_0(2v - 1) ... T_size-1 and then f = v."""
    y, w = (numpy.array(part) for part in gauss_legendre(2 * size + 4))
    v, w = 1 - y * y, 2 * y * y * w
    parts = [*numpy.polynomial.chebyshev.chebvander(2 * v - 1, size - 1).T, v]
    return [float(w @ part) for part in parts], [float(w @ (part * v)) for part in parts]


CurveReader = Callable[[JointCurves, Array], tuple[Array, ...]]
"""From the curves of joints and the loads of contacts (contacts,) to numbers of each contact."""


def solution_of(file: str, joint: Joint, load: Array, read: CurveReader) -> TableSolution:
    """The contacts that belong to the loads, NaN where the tables end; `read` finds ε, d, F, p0 and dF/dd."""
    found = _in_blocks(file, joint, load, read)
    fits = arrays.false(found[1] < 0)  # a ball that filled its socket at less has no wider contact
    angle, d, F, p0, stiffness = (
        where(broadcast(load, part) > 0, where(fits, part, float("nan")), 0.0) for part in found
    )
    return TableSolution(file=file, joint=joint, angle=angle, values=(d, F, p0, stiffness))


def curve_reader(kind: str) -> CurveReader:
    """ε, d, F, p0 and dF/dd of contacts by loads of one kind."""

    def read(curves: JointCurves, given: Array) -> tuple[Array, ...]:
        angle = where(given <= LIMIT, given, float("nan")) if kind == "half_angle" else curves.angle(kind, given)
        return (angle, *curves.contact(angle)[:4])

    return read


def _in_blocks(file: str, joint: Joint, load: Array, read: CurveReader) -> tuple[Array, ...]:
    """read(curves, load) in the shape of the contacts, with a little in place of loads that are not above 0."""
    if type(load) is float:
        return read(curves_of_one(file, joint), load if load > 0 else SMALL_LOAD)
    xp, numbers = arrays.namespace(load), joint.numbers()
    shape = numpy.broadcast_shapes(*(tuple(part.shape) for part in (load, *numbers)))
    if not prod(shape):  # the shape of nothing is that of something, cut off
        one = xp.ones((1,), dtype=load.dtype)
        some = read(JointCurves(file, joint.with_numbers([one for _ in numbers])), one)
        return tuple(xp.reshape(part[..., :0], (*part.shape[:-1], *shape)) for part in some)
    alone = all(prod(part.shape) == 1 for part in numbers)
    shared, which = (None, None) if alone else _shared(file, joint, shape)
    wide = (part if prod(part.shape) == 1 else arrays.broadcast_to(part, shape) for part in numbers)
    flat = [xp.reshape(part, (-1,)) for part in wide]
    loads = xp.reshape(arrays.broadcast_to(where(load > 0, load, SMALL_LOAD), shape), (-1,))
    whole = JointCurves(file, joint.with_numbers(flat))
    size = (4 if alone else 1) * (_BLOCK if xp is numpy else 64 * _BLOCK)
    results = []
    for first in range(0, max(prod(shape), 1), size):
        block = slice(first, min(first + size, prod(shape)))
        here = None if which is None else which[block]
        parts = [part if part.shape[0] == 1 else part[block] for part in flat]
        curves = whole if alone else JointCurves(file, joint.with_numbers(parts), shared, here)
        results.append(read(curves, loads[block]))
    joined = (xp.concat(parts, axis=-1) if len(parts) > 1 else parts[0] for parts in zip(*results, strict=True))
    return tuple(xp.reshape(part, (*part.shape[:-1], *shape)) for part in joined)


def _shared(file: str, joint: Joint, shape: tuple[int, ...]) -> tuple[JointCurves | None, Array | None]:
    """The curves of the joints of a grid, and which of them each contact has: worth while in NumPy, from a few on."""
    numbers = joint.numbers()
    inner = numpy.broadcast_shapes(*(tuple(part.shape) for part in numbers))
    if arrays.namespace(*numbers) is not numpy or prod(inner) * _FEW > prod(shape) or prod(inner) > _BLOCK:
        return None, None
    flat = [numpy.broadcast_to(part, inner).ravel() for part in numbers]
    which = numpy.broadcast_to(numpy.arange(prod(inner)).reshape(inner), shape).ravel()
    return JointCurves(file, joint.with_numbers(flat)), which


_FEW = 4  # contacts a joint
