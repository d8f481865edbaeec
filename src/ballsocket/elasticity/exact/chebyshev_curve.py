"""A joint's curve as Chebyshev series in the half angle, through a few dozen of its exact solutions.

With X = c + d, what varies is taken out first, as in `tabulated`: under the linear gap everything is proportional to X,
and a point contact has d ~ ε², F ~ ε³, p0 ~ ε, dF/dd ~ ε. The series run over the tables' axis of ε up to the widest
contact of the joint.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy

from ...contact.peak_pressure import Peaked, largest_pressure
from ...contact.per_joint import Piece
from ...core.arrays import Numbers
from ...problem.gaps import Gap
from .abel import ROUNDING, AbelState, pressure_of
from .kernel import Kernel
from .load_curve import LoadCurve, errors, log_slope
from .subsurface import StressCurve
from .tabulated.chebyshev import angle_at, angle_root, chebyshev_points, chebyshev_polynomials, coefficients
from .tabulated.formulas import angle_derivative

_TERMS, _POINTS, _TRIES = 32, 28, 4
"""Contacts, and points at which each is solved: at first, and half as many more of what errs most each time."""

_LAST = 3  # coefficients, which tell what comes after them
_SLOPE = 3.0  # by which slopes in the logarithms differ at most, besides that of X
_FULL = 1e-3  # of c/X: nearer to the perfect fit contacts by half angle are answered as far as errors allow
_BLOCK = 2000  # contacts at a time: what stays in the cache
_POWERS = {"indentation": 2.0, "force": 3.0}  # of ε in the load of a point contact
_STARTS, _SMALLEST, _STEPS, _ROUNDED = 800, 1e-9, 3, 1e-12

LOGS = 2
"""So many of the functions are logarithms."""

_FLAT = 1e-7  # of a pressure: what series may ripple


def _functions(state: AbelState) -> Numbers:
    """ln of d/X/(1 - cos ε) and of F C/(R2² X ε³), then p0 C/(X ε), dF/dd C/(R2² ε), U/(F d) and ∫ p dA/F."""
    angle, d, F, C = state.half_angle, state.indentation, state.force, state.kernel.compliance
    reach, area = state.gap.clearance + d, state.gap.socket_radius**2
    logs = numpy.log([d / reach / (2 * numpy.sin(angle / 2) ** 2), F * C / (area * reach * angle**3)])
    pole, stiffness = state.pole_pressure * C / (reach * angle), state.stiffness * C / (area * angle)
    return numpy.stack([*logs, pole, stiffness, state.energy / (F * d), state.pressure_integral / F])


@dataclass(frozen=True, kw_only=True, eq=False)
class ChebyshevCurve:
    """Force, indentation and half angle of one joint, by the series.

    Attributes
    ----------
    curve : LoadCurve
        The exact solutions.
    knots : AbelState
        Those that the series go through, at `chebyshev_points`.
    """

    curve: LoadCurve
    knots: AbelState

    def press(self, kind: str, load: Numbers) -> Piece:
        """The contacts that belong to loads of one kind: "force", "indentation" or "half_angle"."""
        touching = load > 0
        given = load[touching]
        angle = given if kind == "half_angle" else _in_blocks(lambda part: self._angle_of(kind, part), given)
        reached = angle <= self.curve.widest
        state = ChebyshevState(fitted=self, half_angle=numpy.where(reached, angle, self.curve.widest))
        return Piece(load=load, touching=touching, state=state, reached=reached, error=self._errors(kind, state))

    def _errors(self, kind: str, state: ChebyshevState) -> dict[str, Numbers]:
        """Relative errors of each quantity, at the given load."""
        # near the perfect fit X says little of a half angle, and a half angle much of X: that of a load is as good
        felt = 1.0 if kind == "half_angle" else _SLOPE / log_slope(kind, state)
        more = felt * state.distance + self.curve.kernel.tolerance
        return {name: more * (name != kind) + each for name, each in errors(kind, state).items()}

    @cached_property
    def _whole(self) -> float:
        return float(angle_root(self.curve.widest, self.curve.ratio))

    @cached_property
    def _series(self) -> Numbers:
        """Coefficients (rows, terms): of the functions, and of the derivatives of the logarithms by the place."""
        series = coefficients(_functions(self.knots), 1)
        slopes = numpy.zeros_like(series[:LOGS])
        slopes[:, :-1] = numpy.polynomial.chebyshev.chebder(series[:LOGS], axis=1)
        return numpy.concatenate([series, slopes])

    @cached_property
    def missed(self) -> Numbers:
        """What the terms that are left out may amount to, of each function."""
        return _LAST * numpy.max(abs(self._series[:-LOGS, -_LAST:]), axis=1)

    @property
    def good(self) -> bool:
        """Whether these are enough terms, of loads that grow with the half angle."""
        state = ChebyshevState(fitted=self, half_angle=self.knots.half_angle)
        found = [error for kind in _POWERS for error in self._errors(kind, state).values()]
        away = [error[state.to_fit > _FULL] for error in self._errors("half_angle", state).values()]
        worst = max(numpy.max(error) for error in (*found, *away))
        return bool(worst <= self.curve.tolerance and all(numpy.all(numpy.diff(x) > 0) for x in self._known.values()))

    @cached_property
    def expansion(self) -> Numbers:
        """Coefficients (Legendre chebyshev_polynomials, terms) of G/sin s/X, see `abel`, as far as they count."""
        reach = self.curve.gap.clearance + self.knots.indentation
        scaled = coefficients((self.knots.expansion / reach[:, None]).T, 1)
        return scaled[numpy.cumsum(abs(scaled[::-1]).max(axis=1))[::-1] > ROUNDING * abs(scaled).max()]

    def at(self, angle: Numbers) -> tuple[Numbers, Numbers]:
        """The functions at ε (functions, contacts), and the slopes of the two logarithms by ln ε."""
        rows = _in_blocks(lambda part: self._series @ self.waves(part), angle)
        slope = angle_derivative(angle, angle_root(angle, self.curve.ratio), self.curve.ratio) / self._whole
        return rows[:-LOGS], rows[-LOGS:] * slope

    def waves(self, angle: Numbers) -> Numbers:
        """Chebyshev chebyshev_polynomials (terms, contacts) at ε."""
        return chebyshev_polynomials(2 * angle_root(angle, self.curve.ratio) / self._whole - 1, self._series.shape[1])

    @cached_property
    def stresses(self) -> StressCurve:
        return StressCurve(curve=self.curve, points=self.knots.grid.points)

    @cached_property
    def _starts(self) -> Numbers:
        """Half angles: close to each other near a point contact, and near the perfect fit, where loads are steep."""
        widest = self.curve.widest
        small, last = numpy.geomspace(_SMALLEST, 0.98 * widest, _STARTS), numpy.geomspace(0.02, 1e-8, _STARTS // 4)
        return numpy.concatenate([small, widest * (1 - last[1:]), [widest]])

    @cached_property
    def _known(self) -> dict[str, Numbers]:
        """ln(load) of the starts."""
        state = ChebyshevState(fitted=self, half_angle=self._starts)
        return {kind: numpy.log(getattr(state, kind)) for kind in _POWERS}

    def _angle_of(self, kind: str, given: Numbers) -> Numbers:
        """ε by Newton's method in the logarithms, from between the starts; infinite beyond the widest contact."""
        known, goal = self._known[kind], numpy.log(given)
        below = numpy.minimum(goal - known[0], 0.0) / _POWERS[kind]
        angle = numpy.exp(numpy.interp(goal, known, numpy.log(self._starts)) + below)
        for _ in range(_STEPS):
            state = ChebyshevState(fitted=self, half_angle=angle)
            step = (numpy.log(getattr(state, kind)) - goal) / log_slope(kind, state)
            angle = numpy.minimum(angle * numpy.exp(-step), self.curve.widest)
        return numpy.where(goal <= known[-1] + _ROUNDED, angle, inf)


@dataclass(frozen=True, kw_only=True, eq=False)
class ChebyshevState(Peaked):
    """Contacts at half angles ε (contacts,) above 0, with the quantities of a `AbelState`."""

    fitted: ChebyshevCurve
    half_angle: Numbers

    @property
    def kernel(self) -> Kernel:
        return self.fitted.curve.kernel

    @property
    def gap(self) -> Gap:
        return self.fitted.curve.gap

    @cached_property
    def _at(self) -> tuple[Numbers, Numbers]:
        return self.fitted.at(self.half_angle)

    @cached_property
    def _opened(self) -> tuple[Numbers, Numbers]:
        """d/X and its distance to 1, the perfect fit."""
        share = numpy.exp(self._at[0][0]) * 2 * numpy.sin(self.half_angle / 2) ** 2
        return share, 1 - share

    @property
    def to_fit(self) -> Numbers:
        """c/X, from 1 down to 0 at the perfect fit."""
        return self._opened[1]

    @cached_property
    def _reach(self) -> Numbers:
        """X = c + d in mm."""
        return self.gap.clearance / self._opened[1]

    @cached_property
    def indentation(self) -> Numbers:
        return self._reach * self._opened[0]

    @cached_property
    def widening(self) -> Numbers:
        """dd/dε in mm/rad."""
        rate = self._at[1][0] / self.half_angle + 1 / numpy.tan(self.half_angle / 2)
        return self._reach * self._opened[0] * rate / self._opened[1]

    @cached_property
    def _unit(self) -> Numbers:
        """X ε/C in MPa."""
        return self._reach * self.half_angle / self.kernel.compliance

    @cached_property
    def force(self) -> Numbers:
        radius = self.gap.socket_radius * self.half_angle
        return numpy.exp(self._at[0][1]) * self._unit * radius * radius

    @cached_property
    def pole_pressure(self) -> Numbers:
        return self._at[0][2] * self._unit

    @cached_property
    def stiffness(self) -> Numbers:
        return self._at[0][3] * self.gap.socket_radius**2 * self.half_angle / self.kernel.compliance

    @cached_property
    def energy(self) -> Numbers:
        return self._at[0][4] * self.force * self.indentation

    @cached_property
    def pressure_integral(self) -> Numbers:
        return self._at[0][5] * self.force

    @cached_property
    def error(self) -> Numbers:
        """Relative, at ε and X: of the exact solutions, and of what the series leave out."""
        missed, values = self.fitted.missed[:, None], abs(self._at[0][LOGS:])
        return numpy.max(missed[:LOGS]) + numpy.max(missed[LOGS:] / values, axis=0) + numpy.max(self.fitted.knots.error)

    @property
    def distance(self) -> Numbers:
        """Relative error of X at ε: it is that of the distance to the perfect fit."""
        return self.fitted.missed[0] * self._opened[0] / self._opened[1]

    @cached_property
    def largest(self) -> tuple[Numbers, Numbers]:
        """The largest pressure of each contact in MPa, and its polar angle in rad."""
        if self.fitted.knots.decreases.all():
            return self.pole_pressure, 0.0 * self.half_angle
        return largest_pressure(self.pressure, self.pole_pressure, self.half_angle, _FLAT)

    def largest_von_mises(self, reached: Numbers) -> Numbers:
        """That in the liner of each contact that was reached (a mask), between those of half angles along the curve."""
        found = self.half_angle[reached]
        values = numpy.full(len(self.half_angle), numpy.nan)
        values[reached] = self.fitted.stresses.share(found) * self.max_pressure[reached]
        return values

    @cached_property
    def _expansion(self) -> Numbers:
        return self.fitted.expansion @ self.fitted.waves(self.half_angle)

    def pressure(self, angle: Numbers) -> Numbers:
        """p(φ) in MPa at angles (anything, contacts); 0 outside the contact."""
        return pressure_of(self.half_angle, self._expansion, angle) * (self._reach / self.kernel.compliance)

    def alone(self, number: int) -> AbelState:
        """One of the contacts, solved."""
        return self.fitted.curve.state(self.half_angle[number : number + 1], self.fitted.knots.grid.points)


def fitted(curve: LoadCurve) -> LoadCurve | ChebyshevCurve:
    """The series through a curve, of as many terms as its tolerance asks; the curve itself where these do not do."""
    terms, points = _TERMS, _POINTS
    with numpy.errstate(all="ignore"):
        for _ in range(_TRIES if curve.widest > 0 else 0):
            found = ChebyshevCurve(curve=curve, knots=curve.state(_knots(curve, terms), points))
            if found.good:
                return found
            short = numpy.max(found.missed) > numpy.max(found.knots.error)
            terms, points = (terms * 3 // 2, points) if short else (terms, points * 3 // 2)
    return curve


def _knots(curve: LoadCurve, terms: int) -> Numbers:
    """Half angles at `chebyshev_points`."""
    whole = float(angle_root(curve.widest, curve.ratio))
    return angle_at(whole * (1 + chebyshev_points(terms)) - 1, curve.ratio)


def _in_blocks(values: Callable[[Numbers], Numbers], over: Numbers) -> Numbers:
    """Values of contacts (..., contacts), as many at a time as stay in the cache."""
    if len(over) <= _BLOCK:
        return values(over)
    return numpy.concatenate([values(over[first : first + _BLOCK]) for first in range(0, len(over), _BLOCK)], axis=-1)
