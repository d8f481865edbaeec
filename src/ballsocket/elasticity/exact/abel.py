"""The contact equation of a ball in a layered socket, solved at given half angles.

With C = lim c_n (n + ½), ρ_n = c_n (n + ½)/C - 1 and k(x) = Σ ρ_n cos((n + ½) x), a frictionless contact of half
angle ε under the displacement u(φ) of the socket's surface obeys

    (π/2) H(t) + ½ ∫ k(t - s) H(s) ds = A[u](t)/C   over [-ε, ε],   H even,   H(ε) = 0,

where A is the transform of `gaps` and H(ε) = 0, a pressure that is bounded at the edge, fixes the indentation. The
pressure follows from G = -H', which obeys the derivative of the equation and is odd:

    p(φ) = ∫ G(s) ds / sqrt(2 (cos φ - cos s)) over [φ, ε],     p_n = ∫ sin((n + ½) s) G(s) ds over [0, ε].

Both equations are of the second kind. They are solved at the points of a `QuadratureGrid`, for many half angles at once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, pi

import numpy

from ...contact.peak_pressure import Peaked, largest_pressure
from ...core.arrays import Numbers, gauss_legendre
from ...problem.gaps import Gap
from .grid import QuadratureGrid
from .intervals import CachedIntervals, Intervals
from .kernel import Kernel


@dataclass(frozen=True, kw_only=True, eq=False)
class AbelState(Peaked):
    """Contacts of one joint at half angles ε (loads,) above 0; quantities have that shape.

    Arrays over the points of the grid have one more axis. H and G are counted in units of 1/C: they are in mm.
    """

    kernel: Kernel
    gap: Gap
    intervals: Intervals | CachedIntervals

    @property
    def half_angle(self) -> Numbers:
        return self.intervals.half_angle

    @property
    def grid(self) -> QuadratureGrid:
        return self.intervals.grid

    @cached_property
    def _targets(self) -> Numbers:
        """t in rad at the points, and ε."""
        return self.half_angle[:, None] * self.grid.place

    @property
    def _places(self) -> Numbers:
        return self._targets[:, :-1]

    @cached_property
    def _weights(self) -> Numbers:
        """Weights of integrals over [0, ε] at the points."""
        return self.half_angle[:, None] * (self.grid.weights * self.grid.slope)[self.grid.points :]

    @cached_property
    def _operators(self) -> tuple[Numbers, Numbers]:
        even, odd = self.kernel.operators(self.intervals)
        unit = pi / 2 * numpy.eye(self.grid.points)
        even[:, :-1] += unit
        odd[:, :-1] += unit
        return even, odd

    @cached_property
    def _inverse(self) -> Numbers:
        """Inverse of the even equation at the points: it has three right-hand sides, one after the other."""
        return numpy.linalg.inv(self._operators[0][:, :-1])

    @cached_property
    def _edge_weights(self) -> Numbers:
        """From a right-hand side at the points to the integral at t = ε."""
        return (self._operators[0][:, -1:] @ self._inverse)[:, 0]

    def _at_edge(self, side: Numbers) -> Numbers:
        """H(ε) of a right-hand side at the targets."""
        return 2 / pi * (side[:, -1] - numpy.sum(self._edge_weights * side[:, :-1], axis=-1))

    @cached_property
    def indentation(self) -> Numbers:
        """d in mm: H(ε) = 0, by Newton's method."""
        d = numpy.zeros_like(self.half_angle)[:, None]
        for _ in range(self.gap.steps):
            miss, slope = (side(self._targets, d) for side in (self.gap.transform, self.gap.deepening))
            step = (self._at_edge(miss) / self._at_edge(slope))[:, None]
            d = d - step
            if not numpy.any(abs(step) > 1e-13 * abs(d)):
                break
        return d[:, 0]

    @cached_property
    def _deepening(self) -> Numbers:
        """A[∂u/∂d] at the targets."""
        return self.gap.deepening(self._targets, self.indentation[:, None])

    @cached_property
    def _G(self) -> tuple[Numbers, Numbers]:  # noqa: N802
        """G at the points and at ε."""
        side = -self.gap.slope(self._targets, self.indentation[:, None])
        odd = self._operators[1]
        inside = numpy.linalg.solve(odd[:, :-1], side[:, :-1, None])[..., 0]
        return inside, 2 / pi * (side[:, -1] - numpy.sum(odd[:, -1] * inside, axis=-1))

    @cached_property
    def error(self) -> Numbers:
        """How far the two solutions disagree: H at the points against the integral of G, over the largest H."""
        side = self.gap.transform(self._places, self.indentation[:, None])
        H = (self._inverse @ side[..., None])[..., 0]
        steps = self._G[0] * (self.grid.slope[self.grid.points :] * self.half_angle[:, None])
        return numpy.max(abs(H - steps @ self.grid.to_edge.T), axis=-1) / numpy.max(abs(H), axis=-1)

    def _integral(self, factor: Numbers) -> Numbers:
        """∫ factor G ds/C over [0, ε]."""
        return numpy.sum(self._weights * factor * self._G[0], axis=-1) / self.kernel.compliance

    @property
    def _area(self) -> float:
        """R2² in mm²."""
        return self.gap.socket_radius * self.gap.socket_radius

    @cached_property
    def force(self) -> Numbers:
        """F in N."""
        return 4 * pi / 3 * self._area * self._integral(numpy.sin(1.5 * self._places))

    @cached_property
    def pole_pressure(self) -> Numbers:
        """p0 in MPa."""
        return self._integral(0.5 / numpy.sin(self._places / 2))

    @property
    def decreases(self) -> Numbers:
        """Whether the pressure is sure to fall from the pole to the edge.

        By p = 2 sqrt(Δ)/C ∫ g dz, g = G/sin s (see `pressure`), it does where g sqrt(sin²(ε/2) - sin²(s/2)) decreases.
        """
        s = self._places
        room = numpy.sin(self.half_angle / 2)[:, None] ** 2 - numpy.sin(s / 2) ** 2
        return numpy.all(numpy.diff(self._G[0] / numpy.sin(s) * numpy.sqrt(room), axis=-1) < 0, axis=-1)

    @cached_property
    def largest(self) -> tuple[Numbers, Numbers]:
        """The largest pressure of each contact in MPa, and its polar angle in rad."""
        if self.decreases.all():
            return self.pole_pressure, 0.0 * self.half_angle
        return largest_pressure(self.pressure, self.pole_pressure, self.half_angle, ROUNDING)

    @cached_property
    def pressure_integral(self) -> Numbers:
        """∫ p dA in N."""
        return 4 * pi * self._area * self._integral(numpy.sin(self._places / 2))

    @cached_property
    def stiffness(self) -> Numbers:
        """dF/dd in N/mm: since G does not jump at the edge, that of a punch which the contact does not outgrow."""
        punch = (self._inverse @ self._deepening[:, :-1, None])[..., 0]
        total = numpy.sum(self._weights * numpy.cos(1.5 * self._places) * punch, axis=-1)
        return 2 * pi * self._area * total / self.kernel.compliance

    @cached_property
    def widening(self) -> Numbers:
        """dd/dε in mm/rad: a deeper punch adds at the edge what a wider contact takes away."""
        return self._G[1] / self._at_edge(self._deepening)

    @cached_property
    def energy(self) -> Numbers:
        """∫ F dd in N mm."""
        if not self.gap.conservative:
            return self._work()
        spread = 16 * pi / 3 * self._area * self._integral(numpy.sin(self._places / 2) ** 3)
        return (self.indentation * self.force - self.gap.clearance * spread) / 2

    def _work(self) -> Numbers:
        nodes, weights = (numpy.array(part) for part in gauss_legendre(16))
        angles = (nodes[:, None] * self.half_angle).ravel()
        parts = AbelState(kernel=self.kernel, gap=self.gap, intervals=Intervals(half_angle=angles, grid=self.grid))
        power = (parts.force * parts.widening).reshape(len(nodes), -1)
        return self.half_angle * (weights @ power)

    @cached_property
    def expansion(self) -> Numbers:
        """G/sin s as a series of even Legendre polynomials in y."""
        size = self.grid.points
        y, w = (part[size:] for part in self.grid.nodes)
        P = numpy.polynomial.legendre.legvander(y, 2 * size - 1)[:, ::2]
        return (self._G[0] / numpy.sin(self._places)) @ (w[:, None] * P * (4 * numpy.arange(size) + 1))

    def pressure(self, angle: Numbers) -> Numbers:
        """p(φ) in MPa at angles (anything, loads); 0 outside the contact."""
        return pressure_of(self.half_angle, self.expansion.T, angle) / self.kernel.compliance

    def alone(self, number: int) -> AbelState:
        """One of the contacts."""
        return replace(self, intervals=Intervals(half_angle=self.half_angle[number : number + 1], grid=self.grid))

    def modes(self, count: int) -> Numbers:
        """p_n in MPa for n below count: p = Σ p_n P_n(cos φ). Shape (loads, count)."""
        if len(self._known) == 0 or self._known[0].shape[1] < count:
            self._known[:] = [self._modes(count)]
        return self._known[0][:, :count]

    @cached_property
    def _known(self) -> list[Numbers]:
        """The modes that were asked for so far: those inside the socket are asked for again and again."""
        return []

    def _modes(self, count: int) -> Numbers:
        """By Gauss-Legendre points in panels that are short against the waves."""
        panels = 4 + ceil(count * float(self.half_angle.max(initial=0.0)) / 4)
        x, w = (numpy.array(part) for part in gauss_legendre(12))
        y = ((numpy.arange(panels)[:, None] + x) / panels).ravel()
        weights = numpy.tile(w / panels, panels) * pi / 2 * numpy.cos(pi / 2 * y)
        blocks = -(-count // _BLOCK)
        start, step = numpy.arange(blocks)[:, None] * _BLOCK + 0.5, numpy.arange(_BLOCK)[:, None]
        modes = numpy.empty((len(self.half_angle), blocks, _BLOCK))
        for modes_here, angle, series in zip(modes, self.half_angle, self.expansion, strict=True):
            s = angle * numpy.sin(pi / 2 * y)
            G = angle * weights * numpy.sin(s) * _even_series(series, y)
            # sin((start + step) s) as a sum of products: a sine for each start and each step, not for each mode
            modes_here[:] = (G * numpy.sin(start * s)) @ numpy.cos(step * s).T
            modes_here[:] += (G * numpy.cos(start * s)) @ numpy.sin(step * s).T
        return modes.reshape(len(modes), -1)[:, :count] / self.kernel.compliance


def pressure_of(half_angle: Numbers, expansion: Numbers, angle: Numbers) -> Numbers:
    """C p(φ) at angles (anything, contacts) from G/sin s as series of even Legendre polynomials (terms, contacts).

    With sin²(s/2) = sin²(φ/2) + Δ z², Δ = sin²(ε/2) - sin²(φ/2): C p = 2 sqrt(Δ) ∫ G/sin s dz over [0, 1].
    """
    here, edge = (numpy.sin(part / 2) ** 2 for part in (angle, half_angle))
    inside = (here < edge) & (abs(angle) < pi)
    room = numpy.where(inside, edge - here, 0.0)
    total = numpy.zeros_like(room)
    nodes, weights = gauss_legendre(len(expansion) + 8)
    for node, weight in zip(nodes, weights, strict=True):
        z = numpy.sin(pi / 2 * node)  # tames the logarithm at the edge
        s = 2 * numpy.arcsin(numpy.sqrt(numpy.clip(here + room * z * z, 0.0, 1.0)))
        y = 2 / pi * numpy.arcsin(numpy.clip(s / half_angle, 0.0, 1.0))
        total += weight * pi / 2 * numpy.cos(pi / 2 * node) * _even_series(expansion, y)
    return numpy.where(inside, 2 * numpy.sqrt(room) * total, 0.0)


ROUNDING = 1e-9
"""Of a pressure."""

_BLOCK = 64  # modes


def _even_series(coefficients: Numbers, y: Numbers) -> Numbers:
    """Σ coefficients[k] P_2k(y), by Clenshaw's recurrence in y²."""
    square = y * y
    ahead, here = 0.0, coefficients[-1]
    for k in range(len(coefficients) - 2, -1, -1):
        n = 2 * k
        # P_n+2 = (A y² + B) P_n + D P_n-2
        here, ahead = coefficients[k] + _step(n, square) * here + _drop(n + 2) * ahead, here
    return here + 0.0 * y


def _step(n: int, square: Numbers) -> Numbers:
    lead = (2 * n + 1) * (2 * n + 3) / ((n + 1) * (n + 2))
    shift = (n + 1) ** 2 / ((2 * n + 1) * (2 * n + 3)) + (n**2 / ((2 * n + 1) * (2 * n - 1)))
    return lead * (square - shift)


def _drop(n: int) -> float:
    return -((2 * n + 1) * (2 * n + 3) / ((n + 1) * (n + 2))) * (n * (n - 1) / ((2 * n - 1) * (2 * n + 1)))
