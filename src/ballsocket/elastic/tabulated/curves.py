"""What one joint's curve looks like, for every bonded liner there is.

Under the linear gap everything is proportional to c + d, so with the compliance C = 2 (1 - ν²) R2/E (1 + β) of
liner and ball, three functions of the half angle, ν, R2/L and the ball alone are all there is to know:

    ln of d/(c + d)/(1 - cos ε),     ln of F C/(R2² (c + d) ε³),     ln of p0 C/((c + d) ε).

They are tabulated as Chebyshev series; stiffness and energy follow from them. A further table has the profile p/p0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from math import inf, pi

import numpy

from ... import arrays
from ...arrays import Array, clip, cos, divisor, exp, sin, where
from ...arrays import log as ln
from ...joint import Joint
from .chebyshev import (
    LIMIT,
    NEAR,
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
        return [(summed(self.three[k, ...], waves), widening * summed(self.slopes[k, ...], waves)) for k in rows]

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
        """ln d or ln F and its derivative by ln ε, from the functions.

        Very large, with no slope, beyond the angle of an infinite load.
        """
        sigma, slope = self.opening(angle, functions[0])
        left = clip(1 - sigma, LITTLE**3, 1.0)
        outer = slope / left
        if kind == "indentation":
            value, steep = ln(self.joint.clearance * sigma / left), slope / sigma + outer
        else:
            scale = self.joint.socket_radius**2 * self.joint.clearance / self.compliance
            value, steep = functions[1][0] + 3 * ln(angle) + ln(scale / left), functions[1][1] + 3 + outer
        return value, where(left > LITTLE**3, steep, 0.0)

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


def summed(coefficients: Array, waves: Array) -> Array:
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


LITTLE = 1e-3
