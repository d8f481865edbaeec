"""The exact answer from small tables: what one joint's curve looks like, for every bonded liner there is.

Under the linear gap everything is proportional to c + d, so with the compliance C = 2 (1 - ν²) R2/E (1 + β) of
liner and ball, three functions of the half angle, ν, R2/L and the ball alone are all there is to know:

    ln of d/(c + d)/(1 - cos ε),     ln of F C/(R2² (c + d) ε³),     ln of p0 C/((c + d) ε).

They are tabulated as Chebyshev series; stiffness and energy follow from them. A further table has the profile p/p0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from math import inf, pi, prod
from typing import Any

import numpy

from .. import arrays
from ..arrays import Array, broadcast, clip, cos, divisor, exp, gauss_legendre, sin, sqrt, where
from ..arrays import log as ln
from ..joint import Joint
from ..models.base import Answer, Model
from ..sources import Source
from ..validity import SMALL_STRAIN, Range
from .chebyshev import (
    LIMIT,
    NEAR,
    POISSON,
    THICKNESS_RATIO,
    WITH_BALL,
    angle_at,
    angle_place,
    ball_place,
    own,
    poisson_place,
    polynomials,
    roundness,
    tables,
    thickness_place,
)

_KNOTS = numpy.cos(pi * numpy.linspace(1.0, 0.0, 9)[1:])
_BLOCK = 1024  # contacts at a time: what stays in the cache


@dataclass(frozen=True, kw_only=True)
class Tabulated(Model):
    """`Exact` from tables, in any array library, differentiable and vectorised: about a millionth of a second a press.

    The linear gap (Eq. 6 of Heß & Forsbach 2021) and one liner bonded to something rigid. Half angles up to 85 degrees;
    within 1e-5 of `Exact` for a rigid ball, within 2e-4 for an elastic one.

    Parameters
    ----------
    file : str
        Tables made by `build_tables.build`; those that come with the package by default.

    References
    ----------
    The equation behind the tables is derived in the docs (theory).
    """

    file: str = ""

    @property
    def seconds_a_press(self) -> float:
        return 4e-6

    @property
    def name(self) -> str:
        return "tabulated"

    @property
    def title(self) -> str:
        return "elastic ball and bonded liner, from tables of the exact answer"

    @property
    def sources(self) -> tuple[Source, ...]:
        return (Source("hess2021", "(6)"), Source("goodman1965"))

    @property
    def domain(self) -> tuple[Range, ...]:
        ask = "that is not in the tables: ask exact"
        return (
            Range(quantity="joint.clearance", symbol="c", low=0.0, why="no clearance: ask cosine-limit"),
            Range(quantity="joint.liner.poisson", symbol="ν", low=POISSON[0], high=POISSON[1], why=ask),
            Range(
                quantity="joint.thickness_ratio",
                symbol="R2/L",
                low=THICKNESS_RATIO[0],
                high=THICKNESS_RATIO[1],
                why=ask,
            ),
            Range(quantity="joint.modulus_ratio", symbol="E/E_ball", high=0.0201, why=ask),
            Range(quantity=_ball_poisson, symbol="ν_ball", low=-0.01, high=0.501, why=ask),
            Range(quantity=_layers, symbol="layers behind the liner", high=1.0, why=ask),
        )

    @property
    def validity(self) -> tuple[Range, ...]:
        why = "between three tabulated balls, 0.15, 0.27 and 0.38, the tables keep 2e-4"
        return (Range(quantity=_ball_poisson, symbol="ν_ball", low=0.15, high=0.4, why=why), SMALL_STRAIN)

    def _solve(self, joint: Joint, kind: str, load: Array) -> Answer:
        solution = _solution(self.file, joint, kind, load)
        d, F, _, _ = solution.values
        return Answer(
            laws=solution,
            force=F,
            indentation=d,
            converged=_miss(kind, load, d, F) <= 1e4 * arrays.rounding(load),
            beyond_equator=d < 0,
        )


def _miss(kind: str, load: Array, d: Array, F: Array) -> Array:
    if kind == "half_angle":
        return 0.0 * F
    given = broadcast(load, F)
    return arrays.namespace(F).abs((F if kind == "force" else d) - given) / divisor(given)


def _ball_poisson(contact: Any) -> Array:
    """ν of the ball; one that is as good as any for a rigid ball."""
    joint = contact.joint
    return 0.3 + 0.0 * joint.liner.young if joint.ball is None else joint.ball.poisson + 0.0 * joint.liner.young


def _layers(contact: Any) -> Array:
    """More than 1 where something other than a rigid surface is behind the liner."""
    return contact.joint.backing_ratio + 2.0 * len(contact.joint.backing)


@dataclass(frozen=True, eq=False)
class Curves:
    """The curves of joints (joints,), one or as many as there are contacts (contacts,).

    Where many contacts share few joints, `shared` are the curves of these, and `which` of them each contact has.
    """

    file: str
    joint: Joint
    shared: Curves | None = None
    which: Array | None = None

    def _taken(self, values: Array) -> Array:
        """Columns of the shared joints, for each contact."""
        return arrays.namespace(values).take(values, self.which, axis=-1)

    @cached_property
    def ratio(self) -> Array:
        return self.joint.thickness_ratio

    @cached_property
    def _softness(self) -> Array:
        """β: compliance of the ball over that of the liner, at high degrees."""
        ball, liner = self.joint.ball, self.joint.liner
        if ball is None:
            return 0.0 * self.ratio
        plane = (1 - ball.poisson**2) * liner.young / ((1 - liner.poisson**2) * ball.young)
        return plane * self.joint.ball_radius / self.joint.socket_radius

    @cached_property
    def compliance(self) -> Array:
        """C in mm/MPa."""
        liner = self.joint.liner
        return 2 * (1 - liner.poisson**2) * self.joint.socket_radius / liner.young * (1 + self._softness)

    def series(self, name: str) -> Array:
        """Coefficients (functions, angles, joints) of the table of that name and of what an elastic ball adds."""
        if self.shared is not None:
            return self._taken(self.shared.series(name))
        nu, shelf = self.joint.liner.poisson, tables(self.file)
        places = [poisson_place(nu), thickness_place(self.ratio)]
        total = shelf[name].of(places)
        if self.joint.ball is not None:
            share = self._softness / (1 + self._softness)
            soft = ball_place(share, nu, self.ratio)
            added = shelf[WITH_BALL[name]].of([*places, soft, roundness(self.joint.ball.poisson)])
            total = total + (1 + soft) / 2 * added
        return total

    @cached_property
    def three(self) -> Array:
        return self.series("rigid") if self.shared is None else self._taken(self.shared.three)

    @cached_property
    def slopes(self) -> Array:
        """Coefficients of the derivatives."""
        if self.shared is not None:
            return self._taken(self.shared.slopes)
        xp = arrays.namespace(self.three)
        flow = own(_derivative(self.three.shape[1]), self.three)
        return xp.stack([flow @ self.three[row, ...] for row in range(3)])

    def at(self, angle: Array, rows: tuple[int, ...]) -> list[tuple[Array, Array]]:
        """The functions in `rows` at ε (contacts,) > 0, and their derivatives by ln ε."""
        place = angle_place(angle, self.ratio)
        waves, widening = polynomials(place, self.three.shape[1]), self._widening(angle, place)
        return [(_sum(self.three[k, ...], waves), widening * _sum(self.slopes[k, ...], waves)) for k in rows]

    def _widening(self, angle: Array, place: Array) -> Array:
        """d(place)/d(ln ε)."""
        near = NEAR * (1 + self.ratio)
        return 2 * near * angle / ((1 + near * angle) * ln(1 + near * LIMIT) * (1 + place))

    def opening(self, angle: Array, share: tuple[Array, Array]) -> tuple[Array, Array]:
        """d/(c + d) and its derivative by ln ε, from the first function."""
        half = sin(angle / 2)
        sigma = exp(share[0]) * 2 * half * half
        return sigma, sigma * (share[1] + angle * cos(angle / 2) / half)

    def logarithm(self, kind: str, angle: Array) -> tuple[Array, Array]:
        """ln d or ln F, and its derivative by ln ε."""
        return self._logarithm(kind, angle, self.at(angle, (0, 1) if kind == "force" else (0,)))

    def _logarithm(self, kind: str, angle: Array, functions: list[tuple[Array, Array]]) -> tuple[Array, Array]:
        """The same from the functions; very large, with no slope, beyond the angle of an infinite load."""
        sigma, slope = self.opening(angle, functions[0])
        left = clip(1 - sigma, _LITTLE**3, 1.0)
        outer = slope / left
        if kind == "indentation":
            value, steep = ln(self.joint.clearance * sigma / left), slope / sigma + outer
        else:
            scale = self.joint.socket_radius**2 * self.joint.clearance / self.compliance
            value, steep = functions[1][0] + 3 * ln(angle) + ln(scale / left), functions[1][1] + 3 + outer
        return value, where(left > _LITTLE**3, steep, 0.0)

    def contact(self, angle: Array) -> tuple[Array, ...]:
        """d, F, p0, dF/dd and dd/d(ln ε) at ε > 0."""
        share, load, pole = self.at(angle, (0, 1, 2))
        sigma, slope = self.opening(angle, share)
        reach = self.joint.clearance / (1 - sigma)
        F = exp(load[0]) * angle**3 * self.joint.socket_radius**2 * reach / self.compliance
        outer = slope / (1 - sigma)
        p0 = exp(pole[0]) * angle * reach / self.compliance
        return reach * sigma, F, p0, F * (load[1] + 3 + outer) / (reach * outer), reach * outer

    def angle(self, kind: str, load: Array) -> Array:
        """ε > 0 that belongs to a load > 0; NaN beyond the tables."""
        xp, goal = arrays.namespace(load), ln(load)
        start, end = self._start(kind, goal)
        power = 2.0 if kind == "force" else 0.7
        high = 0.0 * goal + _END
        low = high - xp.abs(end - goal) / power

        def law(x: Array) -> tuple[Array, Array]:
            return self.logarithm(kind, exp(x - _END) * LIMIT)

        start = where(start < low, low, where(start > high, high, start))
        root = arrays.increasing_root(law, goal, low, high, start, steps=16, tolerance=3e-3)
        return where(goal <= end + 4 * arrays.rounding(load), exp(root - _END) * LIMIT, float("nan"))

    def _knots(self, kind: str) -> tuple[Array, Array, Array]:
        """ln ε - ln LIMIT of a few contacts of each joint (knots, joints), and ln d or ln F there with its slope."""
        place = own(_KNOTS, self.ratio)[:, None]
        angle = angle_at(place, self.ratio)
        waves = own(_waves_at_knots(self.three.shape[1]), self.ratio)
        widening = self._widening(angle, place)
        rows = (0, 1) if kind == "force" else (0,)
        functions = [(waves @ self.three[k, ...], widening * (waves @ self.slopes[k, ...])) for k in rows]
        return ln(angle / LIMIT), *self._logarithm(kind, angle, functions)

    def known(self, kind: str) -> tuple[Array, Array, Array]:
        """The knots, found once."""
        if kind not in self._known:
            shared = None if self.shared is None else self.shared.known(kind)
            self._known[kind] = self._knots(kind) if shared is None else tuple(map(self._taken, shared))
        return self._known[kind]

    @cached_property
    def _known(self) -> dict[str, tuple[Array, Array, Array]]:
        return {}

    def _start(self, kind: str, goal: Array) -> tuple[Array, Array]:
        """The unknown by cubics between a few contacts, like a power of the load below the first; and the last load."""
        xp = arrays.namespace(goal)
        places, loads, slopes = self.known(kind)
        index = xp.count_nonzero(goal > loads[1:-1, :], axis=0)[None, :]

        def at(values: Array, step: int) -> Array:
            whole = xp.broadcast_to(values, (values.shape[0], goal.shape[0]))
            return xp.take_along_axis(whole, index + step, axis=0)[0, :]

        y, x, rise = at(places, 0), at(loads, 0), at(places, 1) - at(places, 0)
        width = divisor(at(loads, 1) - x)
        t = clip((goal - x) / width, -inf, 1.0)
        u, v = (width / divisor(at(slopes, step)) for step in (0, 1))
        cubic = t * t * (3 - 2 * t) * rise + t * (1 - t) * (u * (1 - t) - v * t)
        below = u * t
        inside = where((cubic > 0) & (cubic < rise), cubic, t * rise)
        return y + where(t < 0, below, inside) + _END, loads[-1, :]


_END = -1.0  # the unknown is ln ε, shifted so that it has this value at the widest contact and is zero nowhere


def _sum(coefficients: Array, waves: Array) -> Array:
    xp = arrays.namespace(waves)
    if coefficients.shape[-1] == 1:
        return coefficients[:, 0] @ waves
    return numpy.einsum("ij,ij->j", coefficients, waves) if xp is numpy else xp.sum(coefficients * waves, axis=0)


@cache
def _waves_at_knots(count: int) -> numpy.ndarray:
    return numpy.polynomial.chebyshev.chebvander(_KNOTS, count - 1)


@cache
def _derivative(count: int) -> numpy.ndarray:
    """From the Chebyshev coefficients of a function to those of its derivative."""
    square = numpy.zeros((count, count))
    square[:-1] = numpy.polynomial.chebyshev.chebder(numpy.eye(count))
    return square


@dataclass(frozen=True, kw_only=True, eq=False)
class TableSolution:
    """Contacts at the half angles that belong to the loads, as the `Laws` of the contact they belong to.

    `values` are d, F, p0 and dF/dd.
    """

    file: str
    joint: Joint
    angle: Array
    values: tuple[Array, Array, Array, Array]

    def force(self, joint: Joint, indentation: Array) -> Array:
        return self.values[1]

    def indentation(self, joint: Joint, indentation: Array) -> Array:
        return self.values[0]

    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        return self.angle

    def max_pressure(self, joint: Joint, indentation: Array) -> Array:
        return self.values[2]

    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        return self.values[3]

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        return where(self.values[0] == 0, inf, self.values[2] / divisor(self.values[0]))

    @cached_property
    def _energy(self) -> Array:
        (energy,) = _in_blocks(self.file, self.joint, self.angle, _work)
        return where(self.angle > 0, energy, 0.0 * self.angle)

    def energy(self, joint: Joint, indentation: Array) -> Array:
        return self._energy

    def pressure_integral(self, joint: Joint, indentation: Array) -> Array:
        """From U = (d F - c ∫ p (1 - cos φ) dA)/2 and F = ∫ p cos φ dA."""
        d, F, _, _ = self.values
        return F + (d * F - 2 * self._energy) / self.joint.clearance

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

    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
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


def _profile(curves: Curves, angle: Array) -> tuple[Array]:
    series = curves.series("profile")
    waves = polynomials(angle_place(angle, curves.ratio), series.shape[1])
    return (arrays.namespace(angle).stack([_sum(series[k, ...], waves) for k in range(series.shape[0])]),)


def _work(curves: Curves, angle: Array) -> tuple[Array]:
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


def _solution(file: str, joint: Joint, kind: str, load: Array) -> TableSolution:
    """The contacts that belong to the loads; NaN where the tables end."""

    def law(curves: Curves, given: Array) -> tuple[Array, ...]:
        angle = where(given <= LIMIT, given, float("nan")) if kind == "half_angle" else curves.angle(kind, given)
        return (angle, *curves.contact(angle)[:4])

    found = _in_blocks(file, joint, load, law)
    angle, d, F, p0, stiffness = (where(broadcast(load, part) > 0, part, 0.0) for part in found)
    return TableSolution(file=file, joint=joint, angle=angle, values=(d, F, p0, stiffness))


def _in_blocks(
    file: str, joint: Joint, load: Array, law: Callable[[Curves, Array], tuple[Array, ...]]
) -> tuple[Array, ...]:
    """law(curves, load) in the shape of the contacts, with a little in place of loads that are not above 0."""
    xp, numbers = arrays.namespace(load), joint.numbers()
    shape = numpy.broadcast_shapes(*(tuple(part.shape) for part in (load, *numbers)))
    alone = all(prod(part.shape) == 1 for part in numbers)
    shared, which = (None, None) if alone else _shared(file, joint, shape)
    wide = (part if prod(part.shape) == 1 else arrays.broadcast_to(part, shape) for part in numbers)
    flat = [xp.reshape(part, (-1,)) for part in wide]
    loads = xp.reshape(arrays.broadcast_to(where(load > 0, load, _LITTLE), shape), (-1,))
    whole = Curves(file, joint.with_numbers(flat))
    size = (4 if alone else 1) * (_BLOCK if xp is numpy else 64 * _BLOCK)
    results = []
    for first in range(0, max(prod(shape), 1), size):
        block = slice(first, min(first + size, prod(shape)))
        here = None if which is None else which[block]
        parts = [part if part.shape[0] == 1 else part[block] for part in flat]
        curves = whole if alone else Curves(file, joint.with_numbers(parts), shared, here)
        results.append(law(curves, loads[block]))
    joined = (xp.concat(parts, axis=-1) if len(parts) > 1 else parts[0] for parts in zip(*results, strict=True))
    return tuple(xp.reshape(part, (*part.shape[:-1], *shape)) for part in joined)


def _shared(file: str, joint: Joint, shape: tuple[int, ...]) -> tuple[Curves | None, Array | None]:
    """The curves of the joints of a grid, and which of them each contact has: worth while in NumPy, from a few on."""
    numbers = joint.numbers()
    inner = numpy.broadcast_shapes(*(tuple(part.shape) for part in numbers))
    if arrays.namespace(*numbers) is not numpy or prod(inner) * _FEW > prod(shape) or prod(inner) > _BLOCK:
        return None, None
    flat = [numpy.broadcast_to(part, inner).ravel() for part in numbers]
    which = numpy.broadcast_to(numpy.arange(prod(inner)).reshape(inner), shape).ravel()
    return Curves(file, joint.with_numbers(flat)), which


_FEW = 4  # contacts a joint

_LITTLE = 1e-3
