"""The contact equation of a ball in a layered socket, solved at given half angles.

With C = lim c_n (n + ½), ρ_n = c_n (n + ½)/C - 1 and k(x) = Σ ρ_n cos((n + ½) x), a frictionless contact of half
angle ε under the displacement u(φ) of the socket's surface obeys

    (π/2) H(t) + ½ ∫ k(t - s) H(s) ds = A[u](t)/C   over [-ε, ε],   H even,   H(ε) = 0,

where A is the transform of `gaps` and H(ε) = 0, a pressure that is bounded at the edge, fixes the indentation. The
pressure follows from G = -H', which obeys the derivative of the equation and is odd:

    p(φ) = ∫ G(s) ds / sqrt(2 (cos φ - cos s)) over [φ, ε],     p_n = ∫ sin((n + ½) s) G(s) ds over [0, ε].

Both equations are of the second kind. They are solved at the points of a `QuadratureGrid`, for many half angles
at once.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import ceil, pi

import numpy

from ...contact.roots import PeakPressure, find_peak_pressure
from ...core.arrays import Numbers, gauss_legendre
from ...problem.gaps import Gap
from .grid import QuadratureGrid
from .kernel import Intervals, Kernel


@dataclass(frozen=True, kw_only=True, eq=False)
class AbelState(PeakPressure):
    """Solved contacts of one joint at positive half angles ε; every quantity has the shape (loads,).

    Arrays over the points of the grid have one more axis. H and G are stored in units of 1/C: they are in mm.
    """

    kernel: Kernel
    gap: Gap
    intervals: Intervals
    _cached_modes: list[Numbers] = field(default_factory=list, init=False, repr=False)  # for stresses in the socket

    @cached_property
    def half_angle(self) -> Numbers:
        """Half angles ε in rad."""
        return self.intervals.half_angle

    @cached_property
    def grid(self) -> QuadratureGrid:
        """Quadrature grid on the intervals [0, ε]."""
        return self.intervals.grid

    @cached_property
    def _target_angles(self) -> Numbers:
        """Angles t in rad at which the contact equation is satisfied: the quadrature points, then the edge ε."""
        return self.half_angle[:, None] * self.grid.position

    @property
    def _point_angles(self) -> Numbers:
        return self._target_angles[:, :-1]

    @cached_property
    def _weights(self) -> Numbers:
        """Quadrature weights of integrals over [0, ε]."""
        return self.half_angle[:, None] * (self.grid.nodes[1] * self.grid.slope)[self.grid.points :]

    @cached_property
    def _operators(self) -> tuple[Numbers, Numbers]:
        """Matrices of the contact equation for even and for odd functions."""
        even, odd = self.kernel.operators(self.intervals)
        unit = pi / 2 * numpy.eye(self.grid.points)
        even[:, :-1] += unit
        odd[:, :-1] += unit
        return even, odd

    @cached_property
    def _inverse(self) -> Numbers:
        """Inverse matrix of the even contact equation, without the row of the edge."""
        return numpy.linalg.inv(self._operators[0][:, :-1])

    @cached_property
    def _edge_weights(self) -> Numbers:
        """Weights of a right-hand side that give the integral term of the contact equation at the edge."""
        return (self._operators[0][:, -1:] @ self._inverse)[:, 0]

    def _solve_edge_value(self, right_side: Numbers) -> Numbers:
        """Compute the solution of the even contact equation at the edge, H(ε), from its right-hand side."""
        return 2 / pi * (right_side[:, -1] - numpy.sum(self._edge_weights * right_side[:, :-1], axis=-1))

    @cached_property
    def indentation(self) -> Numbers:
        """Indentation d in mm, solved by Newton's method; NaN if a circular gap has no contact of this half angle.

        The condition is H(ε) = 0: the pressure is bounded at the edge. H(ε) is concave in d, so that the steps from
        d = 0 do not pass its root. Under a circular gap the widest contact lies along a great circle of the ball; for
        wider ones H(ε) has no root.
        """
        d = numpy.zeros_like(self.half_angle)[:, None]
        for _ in range(self.gap.steps):
            residual = self._solve_edge_value(self.gap.transform(self._target_angles, d))
            slope = self._solve_edge_value(self.gap.indentation_derivative(self._target_angles, d))
            step = (residual / slope)[:, None]
            d = d - step
            if not numpy.any(abs(step) > 1e-13 * abs(d)):
                break
            if self.gap.steps > 1:
                d[step > _DEPTH_TOLERANCE * abs(d)] = numpy.nan  # back from beyond the maximum
        if self.gap.steps > 1:
            d[abs(step) > _DEPTH_TOLERANCE * abs(d)] = numpy.nan
        return d[:, 0]

    @cached_property
    def _indentation_transform(self) -> Numbers:
        """Abel transform of the displacement per unit of indentation, A[∂u/∂d], at the target angles."""
        return self.gap.indentation_derivative(self._target_angles, self.indentation[:, None])

    @cached_property
    def _odd_solution(self) -> tuple[Numbers, Numbers]:
        """Solution G in mm of the odd contact equation, at the quadrature points and at the edge; G = -H'."""
        right_side = -self.gap.slope(self._target_angles, self.indentation[:, None])
        odd = self._operators[1]
        inside = numpy.linalg.solve(odd[:, :-1], right_side[:, :-1, None])[..., 0]
        return inside, 2 / pi * (right_side[:, -1] - numpy.sum(odd[:, -1] * inside, axis=-1))

    @cached_property
    def error(self) -> Numbers:
        """Relative error of the solution: difference between H and the integral of G, over the largest H."""
        right_side = self.gap.transform(self._point_angles, self.indentation[:, None])
        H = (self._inverse @ right_side[..., None])[..., 0]
        steps = self._odd_solution[0] * (self.grid.slope[self.grid.points :] * self.half_angle[:, None])
        return numpy.max(abs(H - steps @ self.grid.integral_to_edge.T), axis=-1) / numpy.max(abs(H), axis=-1)

    def _integrate_solution(self, factor: Numbers) -> Numbers:
        """Integrate a factor times the solution G over [0, ε], divided by the compliance C."""
        return numpy.sum(self._weights * factor * self._odd_solution[0], axis=-1) / self.kernel.compliance

    @property
    def _squared_radius(self) -> float:
        return self.gap.socket_radius * self.gap.socket_radius

    @cached_property
    def force(self) -> Numbers:
        """Force F in N."""
        return 4 * pi / 3 * self._squared_radius * self._integrate_solution(numpy.sin(1.5 * self._point_angles))

    @cached_property
    def pole_pressure(self) -> Numbers:
        """Pressure p0 at the pole in MPa."""
        return self._integrate_solution(0.5 / numpy.sin(self._point_angles / 2))

    @property
    def pressure_decreases(self) -> Numbers:
        """True for each contact whose pressure certainly decreases from the pole to the edge.

        Since p = 2 sqrt(Δ)/C ∫ g dz with g = G/sin s (see `pressure`), the pressure decreases where
        g sqrt(sin²(ε/2) - sin²(s/2)) decreases.
        """
        s = self._point_angles
        half_chord = numpy.sin(self.half_angle / 2)[:, None] ** 2 - numpy.sin(s / 2) ** 2
        decreasing = numpy.diff(self._odd_solution[0] / numpy.sin(s) * numpy.sqrt(half_chord), axis=-1) < 0
        return numpy.all(decreasing, axis=-1)

    @cached_property
    def largest(self) -> tuple[Numbers, Numbers]:
        """Largest pressure of each contact in MPa, and its polar angle in rad."""
        if self.pressure_decreases.all():
            return self.pole_pressure, 0.0 * self.half_angle
        return find_peak_pressure(self.pressure, self.pole_pressure, self.half_angle, ROUNDING)

    @cached_property
    def pressure_integral(self) -> Numbers:
        """Integral of the pressure over the contact area, ∫ p dA, in N."""
        return 4 * pi * self._squared_radius * self._integrate_solution(numpy.sin(self._point_angles / 2))

    @cached_property
    def stiffness(self) -> Numbers:
        """Tangent stiffness dF/dd in N/mm: of a punch of constant contact area, because G is continuous at the edge."""
        punch = (self._inverse @ self._indentation_transform[:, :-1, None])[..., 0]
        total = numpy.sum(self._weights * numpy.cos(1.5 * self._point_angles) * punch, axis=-1)
        return 2 * pi * self._squared_radius * total / self.kernel.compliance

    @cached_property
    def indentation_slope(self) -> Numbers:
        """Derivative dd/dε of the indentation with respect to the half angle, in mm/rad.

        It follows from the balance of a deeper punch and a wider contact at the edge.
        """
        return self._odd_solution[1] / self._solve_edge_value(self._indentation_transform)

    @cached_property
    def energy(self) -> Numbers:
        """Energy U = ∫ F dd in N mm, the work of the force during indentation."""
        if not self.gap.conservative:
            return self._integrate_work()
        gap_work = 16 * pi / 3 * self._squared_radius * self._integrate_solution(numpy.sin(self._point_angles / 2) ** 3)
        return (self.indentation * self.force - self.gap.clearance * gap_work) / 2

    def _integrate_work(self) -> Numbers:
        """Compute the work ∫ F dd in N mm by quadrature over the half angle, for gaps without a potential.

        The half angles are ε (1 - x⁸). The points x are dense where dd/dε grows towards the widest contact: the error
        is at most 2e-9, also there.
        """
        x, weights = (numpy.array(part) for part in gauss_legendre(48))
        angles = ((1 - x**8)[:, None] * self.half_angle).ravel()
        narrower = AbelState(kernel=self.kernel, gap=self.gap, intervals=Intervals(half_angle=angles, grid=self.grid))
        power = (narrower.force * narrower.indentation_slope).reshape(len(x), -1)
        return self.half_angle * ((weights * 8 * x**7) @ power)

    @cached_property
    def expansion(self) -> Numbers:
        """Coefficients of G/sin s in mm, for the even Legendre polynomials of the grid coordinate y."""
        size = self.grid.points
        y, w = (part[size:] for part in self.grid.nodes)
        P = numpy.polynomial.legendre.legvander(y, 2 * size - 1)[:, ::2]
        return (self._odd_solution[0] / numpy.sin(self._point_angles)) @ (w[:, None] * P * (4 * numpy.arange(size) + 1))

    def pressure(self, angle: Numbers) -> Numbers:
        """Compute the contact pressure p(φ) in MPa at polar angles (any, loads); 0 outside the contact."""
        return scaled_pressure(self.half_angle, self.expansion.T, angle) / self.kernel.compliance

    def single_contact(self, number: int) -> AbelState:
        """Return the contact with index `number`."""
        return replace(self, intervals=Intervals(half_angle=self.half_angle[number : number + 1], grid=self.grid))

    def pressure_modes(self, count: int) -> Numbers:
        """Compute the pressure modes p_n in MPa for degrees n below `count`.

        They are the coefficients of p = Σ p_n P_n(cos φ), in the shape (loads, count).
        """
        if self._cached_modes and self._cached_modes[0].shape[1] >= count:
            return self._cached_modes[0][:, :count]
        # Gauss-Legendre quadrature in panels of at most two wavelengths
        panels = 4 + ceil(count * float(self.half_angle.max(initial=0.0)) / 8)
        x, w = (numpy.array(part) for part in gauss_legendre(12))
        y = ((numpy.arange(panels)[:, None] + x) / panels).ravel()
        weights = numpy.tile(w / panels, panels) * pi / 2 * numpy.cos(pi / 2 * y)
        blocks = -(-count // _MODES_PER_BLOCK)
        pressure_modes = numpy.empty((len(self.half_angle), blocks, _MODES_PER_BLOCK))
        for contact_modes, angle, series in zip(pressure_modes, self.half_angle, self.expansion, strict=True):
            s = angle * numpy.sin(pi / 2 * y)
            G = angle * weights * numpy.sin(s) * _evaluate_even_series(series, y)
            # sin((n + 1/2) s) is the imaginary part of a product of powers, not a sine of each mode
            starts = _powers(numpy.exp(0.5j * s), numpy.exp(1j * _MODES_PER_BLOCK * s), blocks)
            contact_modes[:] = (starts @ _powers(G, numpy.exp(1j * s), _MODES_PER_BLOCK).T).imag
        self._cached_modes[:] = [pressure_modes.reshape(len(pressure_modes), -1)[:, :count] / self.kernel.compliance]
        return self._cached_modes[0]


def _powers(first: Numbers, factor: Numbers, count: int) -> Numbers:
    factors = numpy.tile(factor, (count, 1))
    factors[0] = first
    return numpy.cumprod(factors, axis=0)


def scaled_pressure(half_angle: Numbers, expansion: Numbers, angle: Numbers) -> Numbers:
    """Compute C p(φ) in mm, the pressure times the compliance C, from the Legendre coefficients of G/sin s.

    `angle` has the shape (any, contacts), `expansion` (terms, contacts).

    With sin²(s/2) = sin²(φ/2) + Δ z², Δ = sin²(ε/2) - sin²(φ/2): C p = 2 sqrt(Δ) ∫ G/sin s dz over [0, 1].
    """
    inner, edge = (numpy.sin(half / 2) ** 2 for half in (angle, half_angle))
    inside = (inner < edge) & (abs(angle) < pi)
    width = numpy.where(inside, edge - inner, 0.0)
    total = numpy.zeros_like(width)
    nodes, weights = gauss_legendre(len(expansion) + 8)
    for node, weight in zip(nodes, weights, strict=True):
        z = numpy.sin(pi / 2 * node)  # removes the logarithmic singularity at the edge
        s = 2 * numpy.arcsin(numpy.sqrt(numpy.clip(inner + width * z * z, 0.0, 1.0)))
        y = 2 / pi * numpy.arcsin(numpy.clip(s / half_angle, 0.0, 1.0))
        total += weight * pi / 2 * numpy.cos(pi / 2 * node) * _evaluate_even_series(expansion, y)
    return numpy.where(inside, 2 * numpy.sqrt(width) * total, 0.0)


ROUNDING = 1e-9  # relative rounding error of a pressure
_MODES_PER_BLOCK = 64
_DEPTH_TOLERANCE = 1e-9  # relative, of an indentation: least accurate for the widest contact of a circular gap


def _evaluate_even_series(coefficients: Numbers, y: Numbers) -> Numbers:
    """Evaluate a series of even Legendre polynomials P_2k at y, by Clenshaw's recurrence in y²."""
    square = y * y
    following, current = 0.0, coefficients[-1]
    for k in range(len(coefficients) - 2, -1, -1):
        # P_n+2 = (A y² + B) P_n + D P_n-2: A y² + B at n = 2k, D at m = n + 2
        n, m = 2 * k, 2 * k + 2
        lead = (2 * n + 1) * (2 * n + 3) / ((n + 1) * (n + 2))
        shift = (n + 1) ** 2 / ((2 * n + 1) * (2 * n + 3)) + (n**2 / ((2 * n + 1) * (2 * n - 1)))
        D = -((2 * m + 1) * (2 * m + 3) / ((m + 1) * (m + 2))) * (m * (m - 1) / ((2 * m - 1) * (2 * m + 1)))
        current, following = coefficients[k] + lead * (square - shift) * current + D * following, current
    return current + 0.0 * y
