"""Fits of a force law by a power of the indentation or by one expression, with their errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..dynamics import ForceElement, PreloadedElement
from ..dynamics.reaction import SMOOTHING_SHARE

_SAMPLES = 400  # number of indentations of a fit
_DEGREE = 18  # degree of the fitted polynomial
_NEGLIGIBLE_ERROR = 1e-6  # relative error of the force without a note
_LOWEST_FITTED_SHARE = 0.05  # smallest fitted indentation as a fraction of the depth


@dataclass(frozen=True, kw_only=True)
class PowerFit:
    """Fitted power law F = k d^n, with its largest error relative to the force at the fitted depth.

    Attributes
    ----------
    stiffness : float
        k in N/mm^n.
    exponent : float
    depth : float
        In mm.
    error : float
    """

    stiffness: float
    exponent: float
    depth: float
    error: float


def power_fit(element: ForceElement, depth: float) -> PowerFit:
    """Fit the power law F = k d^n (force F, indentation d) by the smallest largest error, up to a depth in mm."""
    depths = depth * numpy.linspace(_LOWEST_FITTED_SHARE, 1.0, _SAMPLES)
    forces = element.potential(depths)[1]
    exponent = _find_minimum(lambda n: _fit_stiffness(depths, forces, n)[1])
    k, error = _fit_stiffness(depths, forces, exponent)
    return PowerFit(stiffness=k, exponent=exponent, depth=depth, error=error / float(forces[-1]))


def _fit_stiffness(depths: Numbers, forces: Numbers, exponent: float) -> tuple[float, float]:
    """Find the stiffness k of F = k d^n with the smallest largest force error; return k and the error in N."""
    relative_force = (depths / depths[-1]) ** exponent
    k = _find_minimum(
        lambda k: float(numpy.max(abs(k * relative_force - forces))), 0.5 * float(forces[-1]), 2.0 * float(forces[-1])
    )
    return k / float(depths[-1]) ** exponent, float(numpy.max(abs(k * relative_force - forces)))


def _find_minimum(function: Callable[[float], float], low: float = 0.5, high: float = 4.0) -> float:
    """Find the position of the minimum of a function with one minimum."""
    from scipy.optimize import minimize_scalar  # slow to import

    return float(minimize_scalar(function, bounds=(low, high), options={"xatol": 1e-12 * high}).x)


@dataclass(frozen=True, kw_only=True)
class ExpressionFit:
    """Fitted force law as one expression of the distance between the centres, in m and N.

    The expression of radial springs is F = G d² (3 c + 2 d)/(c + d)², which holds at every depth. Any other law is
    fitted as F = G d^n exp(a1 t + a2 t² + ...), t² = d/(d + h), up to the indentation `depth`. Beyond it the expression
    continues with the same force and slope as a power of d: a polynomial would diverge there.

    Attributes
    ----------
    scale : float
        G.
    clearance, length : float
        c and h in m.
    power : float
        n.
    coefficients : tuple of float
        a1, a2, ...; empty for radial springs.
    depth : float
        Largest fitted indentation in m.
    power_beyond : float
        Exponent of d beyond `depth`.
    error : float
        Largest relative error of the force, from a thousandth of `depth` up to `depth`.
    error_beyond : float
        Largest relative error of the force from `depth` to twice `depth`.
    smoothing : float
        Indentation in m on both sides of first touch over which the text of the expression is rounded off.
    """

    scale: float
    clearance: float
    length: float
    power: float
    coefficients: tuple[float, ...]
    depth: float
    power_beyond: float = 0.0
    error: float = 0.0
    error_beyond: float = 0.0
    smoothing: float = 0.0

    def __call__(self, distance: Numbers) -> Numbers:
        """Compute the fitted force in N at distances between the centres in m, without smoothing."""
        d = numpy.maximum(distance - self.clearance, 0.0)
        if not self.coefficients:
            return self.scale * _spring_force_shape(d, self.clearance)
        fitted = numpy.minimum(d, self.depth)
        t = numpy.sqrt(fitted / (fitted + self.length))
        exponential = numpy.exp(numpy.polyval((*self.coefficients[::-1], 0.0), t))
        return self.scale * fitted**self.power * exponential * (d / self.depth).clip(1.0) ** self.power_beyond

    def text(self, distance: str, rate: str, hysteresis: float) -> str:
        """Write the force in N as an expression of distance and rate, with Hunt-Crossley damping in s/m.

        Definitions of variables follow the expression: u is the indentation, p its slope, q and r the places on the
        smooth corners of indentation and damping.
        """
        depth, corner = _ramp_text(f"{distance}-{self.clearance!r}", self.smoothing, "q")
        definitions = f";u={depth}"
        if self.coefficients:
            nested = "0"
            for a in reversed(self.coefficients):
                nested = f"t*({a!r}+{nested})"
            beyond = f"max(u/{self.depth!r},1)^{self.power_beyond!r}"
            force = f"{self.scale!r}*v^{self.power!r}*exp({nested})*{beyond}"
            definitions = f";t=sqrt(v/(v+{self.length!r}));v=min(u,{self.depth!r}){definitions}"
        else:
            force = f"{self.scale!r}*u^2*(2*u+{3 * self.clearance!r})/(u+{self.clearance!r})^2"
        if self.smoothing:
            force, definitions = f"{force}*p", f"{definitions};p=q^3*(10-15*q+6*q^2){corner}"
        if hysteresis:
            width = SMOOTHING_SHARE if self.smoothing else 0.0
            factor, corner = _ramp_text(f"1+{hysteresis!r}*{rate}", width, "r")
            force, definitions = f"{force}*({factor})", definitions + corner
        return force + definitions

    def differentiability(self, damped: bool) -> str:
        """State how often the expression can be differentiated, which solvers of optimal control need to know."""
        order = 2 if self.smoothing else 0 if damped else ceil(self.power) - 1
        times = "continuous, not", "once continuously", "twice continuously"
        seam = f", once at an indentation of {1e6 * self.depth:.4g} um" if self.coefficients and order > 1 else ""
        advice = "" if self.smoothing else "; smoothing makes it twice differentiable"
        return f"{times[order]} differentiable{seam}{advice}"

    @property
    def range_note(self) -> str:
        """Note on the errors of the fit below and above the fitted depth; empty for an exact expression."""
        if self.error_beyond <= _NEGLIGIBLE_ERROR:
            return ""
        return (
            f"the expression is within {100 * self.error:.1g} % of the law up to {1e6 * self.depth:.4g} um of "
            f"indentation; deeper it continues as a power law, {100 * self.error_beyond:.1g} % off at twice that depth"
        )


def _ramp_text(y: str, width: float, place: str) -> tuple[str, str]:
    """Write max(y, 0) with a smooth corner within ± `width`, as `smooth_ramp` has it, and define the place on it."""
    if width == 0.0:
        return f"max({y},0)", ""
    ramp = f"max({y}-{width!r},0)+{2.0 * width!r}*{place}^4*(2.5-3*{place}+{place}^2)"
    return ramp, f";{place}=min(max(({y}+{width!r})/{2.0 * width!r},0),1)"


def _spring_force_shape(d: Numbers, c: float) -> Numbers:
    """Compute the force of radial springs over its factor G: d² (3 c + 2 d)/(c + d)², indentation d and clearance c."""
    return d * d * (3.0 * c + 2.0 * d) / (c + d) ** 2


def expression_fit(element: ForceElement, depth: float) -> ExpressionFit:
    """Fit the force law by one expression up to an indentation `depth` in mm, or the valid range if it is longer."""
    c, R2 = element.constants.clearance, element.constants.socket_radius
    fitted_depth = max(depth, element.valid_depth)
    d = numpy.geomspace(1e-3 * fitted_depth, fitted_depth, 997)
    forces = element.potential(d)[1]
    ratio = forces / _spring_force_shape(d, c)
    smoothing = 1e-3 * element.constants.smoothing
    lengths = {"clearance": 1e-3 * c, "depth": 1e-3 * fitted_depth, "smoothing": smoothing}
    if c > 0.0 and numpy.ptp(ratio) < 1e-12 * ratio[0]:
        fit = ExpressionFit(scale=1e3 * float(ratio[0]), length=1e-3 * c, power=2.0, coefficients=(), **lengths)
    else:  # a power of the indentation times the exponential of a polynomial
        length = c or 1e-3 * R2
        t = numpy.linspace(0.0, 1.0, _SAMPLES + 1)[1:] * (fitted_depth / (fitted_depth + length)) ** 0.5
        fitted = length * t * t / (1.0 - t * t)
        _, force, stiffness = element.potential(fitted)
        power = round(2.0 * float(stiffness[0] * fitted[0] / force[0])) / 2.0
        coefficients = numpy.polynomial.Polynomial.fit(t, numpy.log(force / fitted**power), _DEGREE).convert().coef
        fit = ExpressionFit(
            scale=float(numpy.exp(coefficients[0])) * 1e3**power,
            length=1e-3 * length,
            power=power,
            power_beyond=float(stiffness[-1] * fitted[-1] / force[-1]),
            coefficients=tuple(map(float, coefficients[1:])),
            **lengths,
        )
    deeper = numpy.linspace(fitted_depth, max(min(2.0 * fitted_depth, element.wall), fitted_depth), 100)
    return replace(
        fit, error=_largest_force_error(fit, element, d), error_beyond=_largest_force_error(fit, element, deeper)
    )


def _largest_force_error(fit: ExpressionFit, element: ForceElement, depths: Numbers) -> float:
    """Compute the largest relative error of the fitted force at indentations in mm."""
    forces = element.potential(depths)[1]
    return float(numpy.nanmax(abs(fit(1e-3 * (element.constants.clearance + depths)) / forces - 1.0)))


def fit_depth(element: ForceElement | PreloadedElement, load: dict[str, float]) -> float:
    """Return the largest indentation in mm of a fit: that under a given load, else the largest valid one."""
    if load and isinstance(element, ForceElement):
        model: Model = element.model
        return float(model.press(element.joint.with_floats(), **load).indentation)
    return element.valid_depth or element.wall
