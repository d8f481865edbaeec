"""Load curve of a joint as Chebyshev series in the half angle, through a few dozen of its exact solutions.

With X = c + d, known factors are divided out first, as in `tabulated`: under the linear gap everything is
proportional to X, and a point contact has d ~ ε², F ~ ε³, p0 ~ ε, dF/dd ~ ε. The series use the tables' coordinate of
ε up to the widest contact of the joint.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy

from ...contact.coordinates import angle_root, half_angle_at, log_angle_derivative
from ...contact.per_joint import JointContacts
from ...contact.roots import PeakPressure, find_peak_pressure
from ...core.arrays import Numbers
from ...core.chebyshev import chebyshev_coefficients, chebyshev_points, chebyshev_polynomials
from ...problem.gaps import Gap
from .abel import ROUNDING, AbelState, scaled_pressure
from .kernel import Kernel
from .load_curve import LoadCurve, estimate_errors, log_slope
from .subsurface import StressCurve

_TERMS, _POINTS, _ATTEMPTS = 32, 28, 4
"""Number of contacts and of quadrature points each at first; half as many more of one of them at each attempt."""

_TAIL_TERMS = 3  # last coefficients, from which the truncation error is estimated
_MAX_LOG_SLOPE = 3.0  # bound on the difference of logarithmic slopes, besides that of X
_NEAR_PERFECT_FIT = 1e-3  # c/X below which contacts by half angle may exceed the tolerance
_BLOCK = 2000  # contacts in one block, which fits into the cache
_POWERS = {"indentation": 2.0, "force": 3.0}  # of ε in the loads of a point contact
_STARTS, _MIN_START, _NEWTON_STEPS, _ROUNDING = 800, 1e-9, 3, 1e-12

LOG_FUNCTIONS = 2  # number of functions that are logarithms
_PRESSURE_RIPPLE = 1e-7  # relative ripple of a pressure from series


def _dimensionless_quantities(state: AbelState) -> Numbers:
    """Compute six dimensionless quantities of contacts, which vary little with the half angle.

    They are ln of d/X/(1 - cos ε) and of F C/(R2² X ε³), then p0 C/(X ε), dF/dd C/(R2² ε), U/(F d) and ∫ p dA/F.
    """
    angle, d, F, C = state.half_angle, state.indentation, state.force, state.kernel.compliance
    reach, area = state.gap.clearance + d, state.gap.socket_radius**2
    logs = numpy.log([d / reach / (2 * numpy.sin(angle / 2) ** 2), F * C / (area * reach * angle**3)])
    pole, stiffness = state.pole_pressure * C / (reach * angle), state.stiffness * C / (area * angle)
    return numpy.stack([*logs, pole, stiffness, state.energy / (F * d), state.pressure_integral / F])


@dataclass(frozen=True, kw_only=True, eq=False)
class ChebyshevCurve:
    """Force, indentation and half angle of one joint from Chebyshev series."""

    curve: LoadCurve  # exact solutions of the joint
    knots: AbelState  # contacts that the series interpolate, at `chebyshev_points`

    def press(self, kind: str, load: Numbers) -> JointContacts:
        """Solve the contacts for loads of one kind: "force", "indentation" or "half_angle"."""
        touching = load > 0
        positive_load = load[touching]
        angle = positive_load
        if kind != "half_angle":
            angle = _evaluate_contacts_in_blocks(lambda block: self._solve_angle(kind, block), positive_load)
        reachable = angle <= self.curve.widest_angle
        state = ChebyshevState(series=self, half_angle=numpy.where(reachable, angle, self.curve.widest_angle))
        errors = self._errors(kind, state)
        return JointContacts(load=load, touching=touching, state=state, reached=reachable, error=errors)

    def _errors(self, kind: str, state: ChebyshevState) -> dict[str, Numbers]:
        """Estimate the relative error of each quantity at the applied load."""
        # near the perfect fit X depends strongly on the half angle, but the half angle hardly on a load
        sensitivity = 1.0 if kind == "half_angle" else _MAX_LOG_SLOPE / log_slope(kind, state)
        series_error = sensitivity * state.displacement_error + self.curve.kernel.tolerance
        return {name: series_error * (name != kind) + error for name, error in estimate_errors(kind, state).items()}

    @cached_property
    def _widest_coordinate(self) -> float:
        """Coordinate of the half angle of the widest contact, from 0 to 1."""
        return float(angle_root(self.curve.widest_angle, self.curve.ratio))

    @cached_property
    def _chebyshev_coefficients(self) -> Numbers:
        """Chebyshev coefficients (rows, terms) of the dimensionless functions, then of the slopes of logarithms."""
        series = chebyshev_coefficients(_dimensionless_quantities(self.knots), 1)
        slopes = numpy.zeros_like(series[:LOG_FUNCTIONS])
        slopes[:, :-1] = numpy.polynomial.chebyshev.chebder(series[:LOG_FUNCTIONS], axis=1)
        return numpy.concatenate([series, slopes])

    @cached_property
    def truncation_error(self) -> Numbers:
        """Estimated truncation error of the Chebyshev series of each function."""
        return _TAIL_TERMS * numpy.max(abs(self._chebyshev_coefficients[:-LOG_FUNCTIONS, -_TAIL_TERMS:]), axis=1)

    @property
    def is_accurate(self) -> bool:
        """True if the errors are within the tolerance and loads increase with the half angle."""
        state = ChebyshevState(series=self, half_angle=self.knots.half_angle)
        counted = state.relative_clearance > _NEAR_PERFECT_FIT
        errors = [error for kind in _POWERS for error in self._errors(kind, state).values()]
        errors += [error[counted] for error in self._errors("half_angle", state).values()]
        accurate = max(numpy.max(error) for error in errors) <= self.curve.tolerance
        return bool(accurate and all(numpy.all(numpy.diff(x) > 0) for x in self._start_loads.values()))

    @cached_property
    def expansion(self) -> Numbers:
        """Coefficients of the pressure profile G/sin s/X in Legendre and Chebyshev polynomials.

        The shape is (Legendre, Chebyshev), without negligible Legendre terms. G is explained in `abel`.
        """
        reach = self.curve.gap.clearance + self.knots.indentation
        scaled = chebyshev_coefficients((self.knots.expansion / reach[:, None]).T, 1)
        return scaled[numpy.cumsum(abs(scaled[::-1]).max(axis=1))[::-1] > ROUNDING * abs(scaled).max()]

    def evaluate_dimensionless_functions(self, angle: Numbers) -> tuple[Numbers, Numbers]:
        """Evaluate the dimensionless functions (functions, contacts) at half angles, with both log slopes by ln ε."""
        rows = _evaluate_contacts_in_blocks(
            lambda block: self._chebyshev_coefficients @ self.evaluate_polynomials(block), angle
        )
        root = angle_root(angle, self.curve.ratio)
        spacing = log_angle_derivative(angle, root, self.curve.ratio) * self._widest_coordinate
        return rows[:-LOG_FUNCTIONS], rows[-LOG_FUNCTIONS:] / spacing

    def evaluate_polynomials(self, angle: Numbers) -> Numbers:
        """Evaluate the Chebyshev polynomials (terms, contacts) at half angles."""
        coordinate = 2 * angle_root(angle, self.curve.ratio) / self._widest_coordinate - 1
        return chebyshev_polynomials(coordinate, self._chebyshev_coefficients.shape[1])

    @cached_property
    def stress_curve(self) -> StressCurve:
        """Largest von Mises stress in the liner as a function of the half angle."""
        return StressCurve(curve=self.curve, points=self.knots.grid.points)

    @cached_property
    def _start_angles(self) -> Numbers:
        widest = self.curve.widest_angle
        small, last = numpy.geomspace(_MIN_START, 0.98 * widest, _STARTS), numpy.geomspace(0.02, 1e-8, _STARTS // 4)
        return numpy.concatenate([small, widest * (1 - last[1:]), [widest]])

    @cached_property
    def _start_loads(self) -> dict[str, Numbers]:
        """Logarithms of force and indentation, by name, at the half angles of the initial estimates."""
        state = ChebyshevState(series=self, half_angle=self._start_angles)
        return {kind: numpy.log(getattr(state, kind)) for kind in _POWERS}

    def _solve_angle(self, kind: str, load: Numbers) -> Numbers:
        """Solve for the half angles in rad under loads by Newton's method; infinite beyond the widest contact."""
        start_loads, goal = self._start_loads[kind], numpy.log(load)
        below = numpy.minimum(goal - start_loads[0], 0.0) / _POWERS[kind]
        angle = numpy.exp(numpy.interp(goal, start_loads, numpy.log(self._start_angles)) + below)
        for _ in range(_NEWTON_STEPS):
            state = ChebyshevState(series=self, half_angle=angle)
            step = (numpy.log(getattr(state, kind)) - goal) / log_slope(kind, state)
            angle = numpy.minimum(angle * numpy.exp(-step), self.curve.widest_angle)
        return numpy.where(goal <= start_loads[-1] + _ROUNDING, angle, inf)


@dataclass(frozen=True, kw_only=True, eq=False)
class ChebyshevState(PeakPressure):
    """Contacts interpolated at half angles ε (contacts,) above 0; the quantities are those of an `AbelState`."""

    series: ChebyshevCurve
    half_angle: Numbers

    @property
    def kernel(self) -> Kernel:
        return self.series.curve.kernel

    @property
    def gap(self) -> Gap:
        return self.series.curve.gap

    @cached_property
    def _function_values(self) -> tuple[Numbers, Numbers]:
        """Values of the functions of `_dimensionless_quantities`, and slopes of both logarithms by ln ε."""
        return self.series.evaluate_dimensionless_functions(self.half_angle)

    @cached_property
    def _relative_indentation(self) -> Numbers:
        """Ratio of indentation d to total displacement X = c + d."""
        return numpy.exp(self._function_values[0][0]) * 2 * numpy.sin(self.half_angle / 2) ** 2

    @cached_property
    def relative_clearance(self) -> Numbers:
        """Ratio c/X of clearance and total displacement, from 1 down to 0 at the perfect fit."""
        return 1 - self._relative_indentation

    @cached_property
    def _total_displacement(self) -> Numbers:
        """Total displacement X = c + d in mm, the sum of clearance and indentation."""
        return self.gap.clearance / self.relative_clearance

    @cached_property
    def indentation(self) -> Numbers:
        return self._total_displacement * self._relative_indentation

    @cached_property
    def indentation_slope(self) -> Numbers:
        rate = self._function_values[1][0] / self.half_angle + 1 / numpy.tan(self.half_angle / 2)
        return self._total_displacement * self._relative_indentation * rate / self.relative_clearance

    @cached_property
    def _pressure_scale(self) -> Numbers:
        """Pressure scale X ε/C in MPa."""
        return self._total_displacement * self.half_angle / self.kernel.compliance

    @cached_property
    def force(self) -> Numbers:
        radius = self.gap.socket_radius * self.half_angle
        dimensionless_force = numpy.exp(self._function_values[0][1])
        return dimensionless_force * self._pressure_scale * radius * radius

    @cached_property
    def pole_pressure(self) -> Numbers:
        return self._function_values[0][2] * self._pressure_scale

    @cached_property
    def stiffness(self) -> Numbers:
        return self._function_values[0][3] * self.gap.socket_radius**2 * self.half_angle / self.kernel.compliance

    @cached_property
    def energy(self) -> Numbers:
        return self._function_values[0][4] * self.force * self.indentation

    @cached_property
    def pressure_integral(self) -> Numbers:
        return self._function_values[0][5] * self.force

    @cached_property
    def error(self) -> Numbers:
        """Relative error of the interpolated quantities, from the exact solutions and from truncation.

        The half angle ε and the total displacement X count as exact.
        """
        truncation_error, values = self.series.truncation_error[:, None], abs(self._function_values[0][LOG_FUNCTIONS:])
        relative = numpy.max(truncation_error[LOG_FUNCTIONS:] / values, axis=0)
        return numpy.max(truncation_error[:LOG_FUNCTIONS]) + relative + numpy.max(self.series.knots.error)

    @property
    def displacement_error(self) -> Numbers:
        """Relative error of the total displacement X at a half angle, and of the distance to the perfect fit."""
        return self.series.truncation_error[0] * self._relative_indentation / self.relative_clearance

    @cached_property
    def largest(self) -> tuple[Numbers, Numbers]:
        if self.series.knots.pressure_decreases.all():
            return self.pole_pressure, 0.0 * self.half_angle
        return find_peak_pressure(self.pressure, self.pole_pressure, self.half_angle, _PRESSURE_RIPPLE)

    def largest_von_mises(self, reachable: Numbers) -> Numbers:
        """Interpolate the largest von Mises stress in the liner for each contact in the mask, NaN for the others."""
        angle = self.half_angle[reachable]
        values = numpy.full(len(self.half_angle), numpy.nan)
        values[reachable] = self.series.stress_curve.stress_ratio(angle) * self.max_pressure[reachable]
        return values

    def pressure(self, angle: Numbers) -> Numbers:
        """Compute the contact pressure p(φ) in MPa at polar angles (any, contacts); 0 outside the contact."""
        expansion = self.series.expansion @ self.series.evaluate_polynomials(self.half_angle)
        return scaled_pressure(self.half_angle, expansion, angle) * (self._total_displacement / self.kernel.compliance)

    def single_contact(self, number: int) -> AbelState:
        """Solve the contact with index `number` exactly."""
        return self.series.curve.state(self.half_angle[number : number + 1], self.series.knots.grid.points)


def fit_curve(curve: LoadCurve) -> LoadCurve | ChebyshevCurve:
    """Fit Chebyshev series to a load curve to its tolerance; return the load curve itself if the fit fails."""
    terms, points = _TERMS, _POINTS
    with numpy.errstate(all="ignore"):
        for _ in range(_ATTEMPTS if curve.widest_angle > 0 else 0):
            widest_root = float(angle_root(curve.widest_angle, curve.ratio))
            angles = half_angle_at(widest_root * (1 + chebyshev_points(terms)) - 1, curve.ratio)
            candidate = ChebyshevCurve(curve=curve, knots=curve.state(angles, points))
            if candidate.is_accurate:
                return candidate
            needs_terms = numpy.max(candidate.truncation_error) > numpy.max(candidate.knots.error)
            terms, points = (terms * 3 // 2, points) if needs_terms else (terms, points * 3 // 2)
    return curve


def _evaluate_contacts_in_blocks(function: Callable[[Numbers], Numbers], contacts: Numbers) -> Numbers:
    if len(contacts) <= _BLOCK:
        return function(contacts)
    starts = range(0, len(contacts), _BLOCK)
    return numpy.concatenate([function(contacts[first : first + _BLOCK]) for first in starts], axis=-1)
