"""Difference between the closed sphere of the exact solution and a hemisphere with a free rim and half a ball.

The equator of the socket is released by `free_face`.

Half a ball whose equator stays plane is half of a ball pressed symmetrically from both sides, p(φ) + p(π - φ): mode n
moves its surface by c_n (1 + (-1)^n) p_n P_n in place of c_n p_n P_n.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache, cached_property, lru_cache
from math import nan, pi
from typing import ClassVar

import numpy
from numpy.polynomial import legendre

from ...core.arrays import Numbers, gauss_legendre
from ...problem.gaps import LinearGap
from .abel import AbelState
from .free_face import MODES, POLAR_TERMS, free_face_of
from .kernel import Kernel
from .load_curve import LoadCurve, interpolate_cubic, knot_window
from .modes import ElasticBall, Socket

_ITERATIONS = 3  # fixed-point iterations before the extrapolation
_POINTS = 48  # points of integration over a contact


@dataclass(frozen=True, kw_only=True, eq=False)
class HemisphereGap(LinearGap):
    """Linear gap minus an additional displacement of the surfaces, Σ extra_n P_n(cos φ), for each contact."""

    extra: Numbers
    conservative: ClassVar[bool] = False

    def transform(self, t: Numbers, d: Numbers) -> Numbers:
        """Compute the Abel transform A[u](t) of the displacement, in mm."""
        return super().transform(t, d) - self._sum_waves(numpy.cos, t, numpy.ones(self.extra.shape[1]))

    def slope(self, t: Numbers, d: Numbers) -> Numbers:
        """Compute the derivative of the Abel transform of the displacement, dA[u]/dt, in mm/rad."""
        return super().slope(t, d) + self._sum_waves(numpy.sin, t, self._wave_numbers)

    @property
    def _wave_numbers(self) -> Numbers:
        return numpy.arange(self.extra.shape[1]) + 0.5

    def _sum_waves(self, wave: numpy.ufunc, t: Numbers, factor: Numbers) -> Numbers:
        return numpy.einsum("in,itn->it", self.extra * factor, wave(t[..., None] * self._wave_numbers))


def hemisphere_response(socket: Socket, ball: ElasticBall | None) -> Numbers:
    """Compute the additional displacement of both surfaces on a hemisphere in mm/MPa, by modes: (MODES, MODES).

    A socket with a free outer surface stands on its rim, which stays plane. It is half of a sphere that is pressed from
    both sides, as the ball is.
    """
    n = numpy.arange(MODES)
    signs = numpy.where(n % 2, -1.0, 1.0)
    total = numpy.zeros((MODES, MODES))
    face = free_face_of(socket)
    if face is None:
        total += numpy.diag(signs * socket.compliance(n))
    else:
        total[:POLAR_TERMS] += face.bore_displacement
    if ball is not None:
        total += numpy.diag(signs * ball.compliance(n))
    return total


@dataclass(frozen=True, kw_only=True, eq=False)
class HemisphereState(AbelState):
    """Contacts on a hemisphere that have the half angles of contacts on the closed sphere."""

    closed: AbelState

    @property
    def _operators(self) -> tuple[Numbers, Numbers]:
        return self.closed._operators

    @property
    def _inverse(self) -> Numbers:
        return self.closed._inverse

    @property
    def _edge_weights(self) -> Numbers:
        return self.closed._edge_weights


def solve_on_hemisphere(closed: AbelState, extra_response: Numbers) -> AbelState:
    """Solve contacts on a hemisphere, at the same half angles as contacts on the closed sphere.

    The additional displacements and the pressures depend linearly on each other. A few fixed-point iterations with
    reduced-rank extrapolation solve this system.
    """
    iterates = [numpy.zeros((len(closed.half_angle), MODES)), low_pressure_modes(closed) @ extra_response.T]
    for _ in range(_ITERATIONS):
        iterates.append(low_pressure_modes(_make_hemisphere_state(closed, iterates[-1])) @ extra_response.T)
    return _make_hemisphere_state(closed, _extrapolate_iterates(numpy.stack(iterates, axis=-1)))


def _extrapolate_iterates(iterates: Numbers) -> Numbers:
    """Extrapolate iterates (contacts, terms, iterations) of linear fixed-point maps to their limit.

    The method is reduced-rank extrapolation, a least-squares fit of differences.
    """
    steps = numpy.diff(iterates, axis=-1)
    steps = steps / (numpy.linalg.norm(steps, axis=(1, 2), keepdims=True) + 1e-300)
    weights = numpy.linalg.pinv(numpy.diff(steps, axis=-1), rcond=1e-10) @ steps[..., :1]
    return iterates[..., 0] - ((iterates[..., 1:-1] - iterates[..., :-2]) @ weights)[..., 0]


def low_pressure_modes(state: AbelState) -> Numbers:
    """Compute the pressure modes p_n in MPa of the lowest degrees: (contacts, MODES)."""
    waves, sines = _quadrature_waves(tuple(state.half_angle.tolist()))
    series = state.expansion @ _even_legendre(state.grid.points)
    return numpy.einsum("cy,cyn->cn", series * sines, waves) / state.kernel.compliance


@lru_cache(maxsize=16)
def _quadrature_waves(angles: tuple[float, ...]) -> tuple[Numbers, Numbers]:
    """Compute sin((n + ½) s) at quadrature points s of each contact, and the weights with sin s, for modes p_n."""
    y, weight = (numpy.array(part) for part in gauss_legendre(_POINTS))
    angle = numpy.array(angles)[:, None]
    s = angle * numpy.sin(pi / 2 * y)
    weights = angle * weight * pi / 2 * numpy.cos(pi / 2 * y) * numpy.sin(s)
    return numpy.sin(s[..., None] * (numpy.arange(MODES) + 0.5)), weights


@cache
def _even_legendre(count: int) -> Numbers:
    even: Numbers = legendre.legvander(numpy.array(gauss_legendre(_POINTS)[0]), 2 * count - 1)[:, ::2].T
    return even  # P_0, P_2, ... at the quadrature points: (count, points)


def _make_hemisphere_state(closed: AbelState, extra: Numbers) -> AbelState:
    gap = closed.gap
    return HemisphereState(
        kernel=closed.kernel,
        gap=HemisphereGap(clearance=gap.clearance, socket_radius=gap.socket_radius, extra=extra),
        intervals=closed.intervals,
        closed=closed,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactSeries:
    """Quantities of one body's contacts as functions of x = ln ε, interpolated between a few contacts.

    With X = c + d, the logarithms of d/X/(1 - cos ε), F/X/ε³ and p/X/ε vary little; they are cubics between `x`.
    """

    clearance: float
    x: Numbers
    logs: dict[str, Numbers]

    @classmethod
    def from_state(cls, state: AbelState, count: int) -> ContactSeries:
        """Make the series from the first contacts of a state."""
        angle, clearance = state.half_angle[:count], state.gap.clearance
        d, F, p = (values[:count] for values in (state.indentation, state.force, _estimate_max_pressure(state)))
        scaled = {"indentation": d / (clearance + d) / (2 * numpy.sin(angle / 2) ** 2)}
        scaled |= {"force": F / (clearance + d) / angle**3, "max_pressure": p / (clearance + d) / angle}
        logs = {name: numpy.log(values) for name, values in scaled.items()}
        return cls(clearance=clearance, x=numpy.log(angle), logs=logs)

    @cached_property
    def _slopes(self) -> dict[str, Numbers]:
        """Slopes of the logarithmic quantities by ln ε at the contacts, from parabolas through three points."""
        return {name: numpy.gradient(y, self.x, edge_order=2) for name, y in self.logs.items()}

    def interpolate_logarithms(self, x: Numbers) -> dict[str, Numbers]:
        """Compute the logarithms of indentation, force, largest pressure and stiffness at x = ln ε.

        The result also has the derivative d ln F/dx as "slope".
        """
        angle = numpy.exp(x)
        (depth, deepening), (force, rise), (pressure, _) = (
            interpolate_cubic(x, self.x, self.logs[name], self._slopes[name])
            for name in ("indentation", "force", "max_pressure")
        )
        depth, deepening = depth + numpy.log(2 * numpy.sin(angle / 2) ** 2), deepening + angle / numpy.tan(angle / 2)
        share = numpy.minimum(numpy.exp(depth), _MAX_SHARE)  # d/X
        reach, growth = numpy.log(self.clearance / (1 - share)), share / (1 - share) * deepening
        depth, force, pressure = depth + reach, force + 3 * x + reach, pressure + x + reach
        rise, deepening = rise + 3 + growth, deepening + growth
        stiffness = force - depth + numpy.log(rise / deepening)
        return {"indentation": depth, "force": force, "max_pressure": pressure, "stiffness": stiffness, "slope": rise}


Bodies = tuple[ContactSeries, ContactSeries]
"""Contacts of the closed sphere and of the hemisphere."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Hemisphere:
    """Contacts of a hemisphere and of the closed sphere, for all half angles of one joint.

    Under the linear gap everything is proportional to the clearance, so their ratios do not depend on it.
    """

    kernel: Kernel
    _cached_windows: dict[int, Bodies | None] = field(default_factory=dict, init=False, repr=False)  # by first index

    @cached_property
    def _load_curve(self) -> LoadCurve:
        gap = LinearGap(clearance=1.0, socket_radius=self.kernel.socket.radius)
        return LoadCurve(kernel=self.kernel, gap=gap, tolerance=_TOLERANCE)

    @cached_property
    def _extra_response(self) -> Numbers:
        return hemisphere_response(self.kernel.socket, self.kernel.ball)

    @cached_property
    def _knot_bodies(self) -> Bodies | None:
        return self._solve_bodies(self._load_curve.knots)

    def _bodies_around(self, half_angle: Numbers) -> Bodies | None:
        """Solve the contacts of both bodies around half angles; None with too few contacts or overflow."""
        window = knot_window(half_angle)
        try:
            if window is None:
                return self._knot_bodies
            if window.start not in self._cached_windows:
                closed = self._load_curve.knots_in(window)
                self._cached_windows[window.start] = self._knot_bodies if closed is None else self._solve_bodies(closed)
            return self._cached_windows[window.start]
        except numpy.linalg.LinAlgError:
            return None

    def _solve_bodies(self, closed: AbelState) -> Bodies | None:
        """Solve the hemisphere at the half angles of contacts on the closed sphere; make the series of both."""
        free = solve_on_hemisphere(closed, self._extra_response)
        valid = (free.indentation > 0) & (free.force > 0) & (_estimate_max_pressure(free) > 0)
        valid[1:] &= numpy.diff(free.force) > 0  # rounding can break this close to the perfect fit
        count = int(numpy.argmin(numpy.append(valid, False)))
        if count < _MIN_CONTACTS:
            return None
        return ContactSeries.from_state(closed, count), ContactSeries.from_state(free, count)

    def changes(self, half_angle: Numbers) -> dict[str, Numbers]:
        """Compute the relative change of each quantity on a hemisphere at the same force; NaN beyond the rim."""
        if half_angle.size == 0:
            return dict.fromkeys(CHANGES, half_angle)
        with numpy.errstate(all="ignore"):
            bodies = self._bodies_around(half_angle)
            if bodies is None:
                return dict.fromkeys(CHANGES, numpy.full(half_angle.shape, nan))
            closed, free = bodies
            x = numpy.log(numpy.maximum(half_angle, numpy.exp(closed.x[0])))
            before = closed.interpolate_logarithms(x)
            knots = free.interpolate_logarithms(free.x)["force"]
            free_x = numpy.interp(before["force"], knots, free.x)
            for _ in range(_NEWTON_STEPS):
                after = free.interpolate_logarithms(free_x)
                free_x = numpy.clip(free_x + (before["force"] - after["force"]) / after["slope"], free.x[0], free.x[-1])
            after = {**free.interpolate_logarithms(free_x), "half_angle": free_x}
            before["half_angle"] = x  # compared as logarithms, as all others
            inside = (abs(after["force"] - before["force"]) < _RELATIVE_TOLERANCE) & (x <= closed.x[-1])
            return {name: numpy.where(inside, numpy.expm1(after[name] - before[name]), nan) for name in CHANGES}


CHANGES = ("indentation", "half_angle", "max_pressure", "stiffness")  # quantities of a contact whose change is computed
_MIN_CONTACTS, _MAX_SHARE, _NEWTON_STEPS, _RELATIVE_TOLERANCE, _TOLERANCE = 4, 1 - 1e-9, 4, 1e-3, 1e-3


def _estimate_max_pressure(state: AbelState) -> Numbers:
    """Estimate the largest pressure in MPa: that at the pole, or the largest at a few angles."""
    if state.pressure_decreases.all():
        return state.pole_pressure
    return state.pressure(state.half_angle * numpy.linspace(0.0, 0.95, 20)[:, None]).max(axis=0)


hemisphere_of = lru_cache(maxsize=256)(Hemisphere)
"""Function that returns the hemisphere with the `kernel` of a joint, from a cache."""
