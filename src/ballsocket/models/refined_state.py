"""Dimensionless formulas of the refined model at a half angle: indentation, pressure and force, with slopes."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from importlib.resources import files
from math import log as ln
from math import nan, pi, radians
from typing import NamedTuple

from ..contact.roots import Increasing, increasing_root
from ..core import arrays
from ..core.arrays import Array, cos, exp, log, sin, where
from .liner_compliance import Liner, Pair, log_compliance, log_compliance_any_wave


class Fit(NamedTuple):
    """Fitted coefficients of the refined model."""

    waves: tuple[float, ...]
    """Wave numbers times ε."""
    level: tuple[float, ...]
    edge: tuple[float, ...]
    exponent: tuple[float, ...]
    spans: tuple[float, float, float]
    """Differences of ln k between successive waves."""
    gamma: tuple[float, float, float]
    """Coefficients of ln[(k2/2)^s Γ(1 - s/2) Γ(2 - s/2)] as a cubic in s."""


def make_fit(
    waves: Sequence[float],
    level: Sequence[float],
    edge: Sequence[float],
    exponent: Sequence[float],
    plane: Sequence[float],
) -> Fit:
    """Make the fitted coefficients from the rows of `data/refined.toml`, by their names in that file."""
    k1, k2, k3, k4 = waves
    scale, square, cube = plane
    return Fit(
        waves=tuple(waves),
        level=tuple(level),
        edge=tuple(edge),
        exponent=tuple(exponent),
        spans=(ln(k2 / k1), ln(k3 / k2), ln(k4 / k3)),
        gamma=(ln(k2 / scale), square, cube),
    )


NUMBERS: dict[str, list[float]] = tomllib.loads(
    (files("ballsocket") / "data" / "refined.toml").read_text(encoding="utf-8")
)
FIT = make_fit(**NUMBERS)
"""Fit of `data/refined.toml`."""


class ScaledContact(NamedTuple):
    """Dimensionless contact of half angle ε, with derivatives by ln ε.

    A slope is the derivative of a quantity, a rate that of its logarithm.
    """

    share: Array
    """Value S = sin²(ε/2)."""
    share_rate: Array
    gap: Array
    """Value cos ε - λ, which is 0 at the perfect fit, where d is infinite."""
    gap_slope: Array
    compliance: Array
    """Scaled compliance χ = d E/(p0 R2)."""
    secant: Array
    """Scaled secant stiffness F/(E R2 d)."""
    secant_rate: Array

    @property
    def indentation(self) -> Array:
        """Dimensionless indentation d/c, from cos ε = (c + λ d)/(c + d)."""
        return 2 * self.share / self.gap

    @property
    def indentation_rate(self) -> Array:
        """Derivative of the log indentation ln d by ln ε."""
        return self.share_rate - self.gap_slope / self.gap


def scaled_contact(half_angle: Array, liner: Liner, fit: Fit = FIT) -> ScaledContact:
    """Compute the dimensionless contact at a half angle ε > 0 in rad.

    χ, λ = u(ε)/d and the pressure's exponent m come from ln c at four waves. Where c ~ k^-s they equal those of a plane
    layer exactly: d/p0 = c(k) k^s 2^-s Γ(1 - s/2) Γ(2 - s/2), λ = s/2, m = 1 - s/2. The fitted terms vanish without the
    bends v, w of ln c over ln k and the curvature S = sin²(ε/2).
    """
    waves = log_compliances(half_angle, liner, fit.waves)
    (c1, rise1), (c2, rise2), (c3, rise3), (c4, rise4) = waves  # by ln k, and k = k_i/ε
    s, v, w = log_slopes(c1, c2, c3, c4, fit.spans)
    half = sin(half_angle / 2)
    S, S_rate = half * half, half_angle * cos(half_angle / 2) / half
    s_, v_, w_ = log_slopes(-rise1, -rise2, -rise3, -rise4, fit.spans)
    slopes = s_, v_, w_, S * S_rate
    level = _log_compliance(c2, s, v, w, S, fit)
    edge, exponent = _edge_displacement(s, v, w, S, fit.edge), _pressure_exponent(s, v, w, S, fit.exponent)
    m, m_slope = exponent[0], angle_derivative(exponent, slopes)
    deficit = 2 * S / (m + 2)
    secant_rate = (
        S_rate
        - deficit * (S_rate - m_slope / (m + 2)) / (1 - deficit)
        - m_slope / (m + 1)
        - (angle_derivative(level, slopes) - rise2)
    )
    chi = exp(level[0])
    return ScaledContact(
        share=S,
        share_rate=S_rate,
        gap=1 - 2 * S - edge[0],
        gap_slope=-2 * S * S_rate - angle_derivative(edge, slopes),
        compliance=chi,
        secant=4 * pi * S * (1 - deficit) / ((m + 1) * chi),  # of p0 (1 - y)^m, over p0 R2²
        secant_rate=secant_rate,
    )


def log_compliances(half_angle: Array, liner: Liner, waves: tuple[float, ...]) -> tuple[Pair, Pair, Pair, Pair]:
    """Compute the log compliance ln c and its slope by ln k at the four wave numbers of a half angle.

    Only the smallest wave number may come near q = 1.
    """
    if arrays.is_plain_number(half_angle):
        return scalar_log_compliances(half_angle, liner, waves)
    xp = arrays.namespace(half_angle)
    short = xp.asarray(waves[1:], dtype=half_angle.dtype, device=arrays.device(half_angle))
    values, slopes = log_compliance(xp.reshape(short, (-1, *(1 for _ in half_angle.shape))) / half_angle, liner)
    second, third, fourth = ((values[i, ...], slopes[i, ...]) for i in range(3))
    return log_compliance_any_wave(waves[0] / half_angle, liner), second, third, fourth


def scalar_log_compliances(half_angle: Array, liner: Liner, waves: tuple[float, ...]) -> tuple[Pair, Pair, Pair, Pair]:
    """Compute the log compliance ln c and its slope by ln k at the four wave numbers of a scalar half angle."""
    return (
        log_compliance_any_wave(waves[0] / half_angle, liner),
        log_compliance(waves[1] / half_angle, liner),
        log_compliance(waves[2] / half_angle, liner),
        log_compliance(waves[3] / half_angle, liner),
    )


def log_slopes(
    c1: Array, c2: Array, c3: Array, c4: Array, spans: tuple[float, float, float]
) -> tuple[Array, Array, Array]:
    """Compute the log-log slope s of the compliance and its differences v and w from four samples of ln c.

    s is the negative slope over ln k; v and w are its first and second change between successive intervals.
    """
    s, s2, s3 = (c1 - c2) / spans[0], (c2 - c3) / spans[1], (c3 - c4) / spans[2]
    return s, s2 - s, s3 - s2


ValueAndSlopes = tuple[Array, Array, Array, Array, Array]
"""Value and its slopes by s, v, w and S."""


def _log_compliance(c2: Array, s: Array, v: Array, w: Array, S: Array, fit: Fit) -> ValueAndSlopes:
    """Compute the log compliance ln χ of the contact, with its derivatives by s, v, w and S = sin²(ε/2).

    `log_slopes` explains s, v and w. The derivative by ln c is 1.
    """
    A1, A2, A3 = fit.gamma
    G1, G2, G3, G4 = fit.level
    return (
        c2 + s * (A1 + s * (A2 + s * A3)) + v * (G1 * v + G2 * s + G4 * S) + G3 * s * w * w,
        A1 + s * (2 * A2 + s * 3 * A3) + G2 * v + G3 * w * w,
        2 * G1 * v + G2 * s + G4 * S,
        2 * G3 * s * w,
        G4 * v,
    )


def _edge_displacement(s: Array, v: Array, w: Array, S: Array, fit: tuple[float, ...]) -> ValueAndSlopes:
    """Compute the relative edge displacement λ = u(ε)/d, with its derivatives by s, v, w and S = sin²(ε/2)."""
    L1, L2, L3, L4, L5, L6, L7, L8, L9, L10 = fit
    by_s = 0.5 + L3 * v + L4 * w + S * (L9 + L10 * v)
    by_w = L1 + L5 * S + L8 * v * v
    return (
        s * by_s + w * by_w + v * L2 + S * (L6 + L7 * v * v),
        by_s,
        L2 + L3 * s + 2 * v * (L7 * S + L8 * w) + L10 * s * S,
        by_w + L4 * s,
        L5 * w + L6 + L7 * v * v + s * (L9 + L10 * v),
    )


def _pressure_exponent(s: Array, v: Array, w: Array, S: Array, fit: tuple[float, ...]) -> ValueAndSlopes:
    """Compute the exponent m of the pressure profile, with its derivatives by s, v, w and S = sin²(ε/2)."""
    M1, M2, M3, M4, M5 = fit
    by_s = -0.5 + S * (M4 + M5 * v)
    return (
        1 + s * by_s + M1 * w + M2 * v + M3 * w * w * S,
        by_s,
        M2 + M5 * s * S,
        M1 + 2 * M3 * w * S,
        M3 * w * w + s * (M4 + M5 * v),
    )


def angle_derivative(value_and_slopes: ValueAndSlopes, slopes: tuple[Array, Array, Array, Array]) -> Array:
    """Compute the derivative of a formula by ln ε from its derivatives by s, v, w and S, by the chain rule."""
    return (
        value_and_slopes[1] * slopes[0]
        + value_and_slopes[2] * slopes[1]
        + value_and_slopes[3] * slopes[2]
        + value_and_slopes[4] * slopes[3]
    )


MAX_HALF_ANGLE = radians(85.0)
"""Largest half angle in rad that is solved."""

_LOG_OFFSET = -1.0
"""Value of the unknown, a shifted ln ε, at the widest contact; the shift keeps it away from zero."""


def half_angle_of_indentation(load: Array, liner: Liner) -> Array:
    """Solve for the half angle ε in rad of a dimensionless indentation d/c; NaN beyond the largest half angle."""
    return _solve_half_angle(_indentation_residual, load, log(1.5 * load / (1 + load)) / 2, liner)


def half_angle_of_force(load: Array, liner: Liner) -> Array:
    """Solve for the half angle ε in rad of a dimensionless force F/(E R2 c); NaN beyond the largest half angle."""
    return _solve_half_angle(_force_residual, load, log(load / (2.5 + load / 3)) / 3, liner)


def _solve_half_angle(residual: Increasing, load: Array, log_estimate: Array, liner: Liner) -> Array:
    """Solve for the half angle ε in rad by Newton's method, from an estimate of ln ε."""
    start = log_estimate + (_LOG_OFFSET - ln(MAX_HALF_ANGLE))
    end = 0.0 * start + (_LOG_OFFSET + 1e-12)  # includes the widest contact itself
    root = increasing_root(residual, 0.0 * start, start - 6.0, end, start, arguments=(load, liner))
    return where(root < end, exp(root - _LOG_OFFSET) * MAX_HALF_ANGLE, nan)


def _indentation_residual(log_angle: Array, load: Array, liner: Liner) -> Pair:
    """Compute the residual of the indentation at a trial half angle, and its slope by ln ε.

    The residual is ln x/(1 + x), x = d/c, less its value at the load.
    """
    contact = scaled_contact(exp(log_angle - _LOG_OFFSET) * MAX_HALF_ANGLE, liner)
    total = 2 * contact.share + contact.gap
    residual = log(2 * contact.share / total * (1 + 1 / load))
    return residual, (contact.share_rate * contact.gap - contact.gap_slope) / total


def _force_residual(log_angle: Array, load: Array, liner: Liner) -> Pair:
    """Compute the residual of the force at a trial half angle, and its slope by ln ε.

    The residual is ln x/(1 + x), x = d/c, less its value at the load over the secant stiffness.
    """
    contact = scaled_contact(exp(log_angle - _LOG_OFFSET) * MAX_HALF_ANGLE, liner)
    total = 2 * contact.share + contact.gap
    residual = log(2 * contact.share / total * (1 + contact.secant / load))
    indentation_slope = (contact.share_rate * contact.gap - contact.gap_slope) / total
    return residual, indentation_slope + contact.secant_rate * contact.secant / (contact.secant + load)
