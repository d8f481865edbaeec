"""Dimensionless formulas of the refined model at a half angle: indentation, pressure and force, with slopes."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from importlib.resources import files
from math import log as ln
from math import pi
from typing import NamedTuple

from ..core.arrays import Array, clip, exp, short_sine, sqrt, where
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
    compliance_rate: Array

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
    half = short_sine(half_angle / 2)
    S, S_rate = half * half, half_angle * sqrt(1 - half * half) / half
    s_, v_, w_ = log_slopes(-rise1, -rise2, -rise3, -rise4, fit.spans)
    slopes = s_, v_, w_, S * S_rate
    level = _log_compliance(c2, s, v, w, S, fit)
    edge, exponent = _edge_displacement(s, v, w, S, fit.edge), _pressure_exponent(s, v, w, S, fit.exponent)
    m, m_slope = exponent[0], angle_derivative(exponent, slopes)
    compliance_rate = angle_derivative(level, slopes) - rise2
    deficit = 2 * S / (m + 2)
    secant_rate = S_rate - deficit * (S_rate - m_slope / (m + 2)) / (1 - deficit) - m_slope / (m + 1) - compliance_rate
    chi = exp(level[0])
    return ScaledContact(
        share=S,
        share_rate=S_rate,
        gap=1 - 2 * S - edge[0],
        gap_slope=-2 * S * S_rate - angle_derivative(edge, slopes),
        compliance=chi,
        secant=4 * pi * S * (1 - deficit) / ((m + 1) * chi),  # of p0 (1 - y)^m, over p0 R2²
        secant_rate=secant_rate,
        compliance_rate=compliance_rate,
    )


def shift_contact(contact: ScaledContact, shift: Array) -> ScaledContact:
    """Move a contact by a small shift of ln ε; the relative error is of the order of the squared shift.

    The derivatives stay those of the contact before the shift.
    """
    return ScaledContact(
        share=contact.share * (1 + contact.share_rate * shift),
        share_rate=contact.share_rate,
        gap=contact.gap + contact.gap_slope * shift,
        gap_slope=contact.gap_slope,
        compliance=contact.compliance * (1 + contact.compliance_rate * shift),
        secant=contact.secant * (1 + contact.secant_rate * shift),
        secant_rate=contact.secant_rate,
        compliance_rate=contact.compliance_rate,
    )


def log_compliances(half_angle: Array, liner: Liner, waves: tuple[float, ...]) -> tuple[Pair, Pair, Pair, Pair]:
    """Compute the log compliance ln c and its slope by ln k at the four wave numbers of a half angle.

    Only the smallest wave number may come near q = 1.
    """
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


def shape_coefficient(contact: ScaledContact) -> Array:
    """Compute the shape coefficient β of the pressure profile, from the balance of pressure and force.

    The balance is 2π R2² ∫ p cos φ sin φ dφ = F.
    """
    S = contact.share
    mean = contact.secant * contact.compliance / (4 * pi * S)
    return (mean - 2 / 3 + 8 * S / 15) / (4 / 15 - 32 * S / 105)


def peak_position(beta: Array) -> Array:
    """Compute the position y = sin²(φ/2)/sin²(ε/2) of the largest pressure: 0, the pole, for β up to 1/2."""
    return where(beta > 0.5, (2 * beta - 1) / where(beta > 0.5, 3 * beta, 1.0), 0.0)


def pressure_ratio(y: Array, beta: Array) -> Array:
    """Compute the pressure ratio p/p0 at the position y = sin²(φ/2)/sin²(ε/2), 0 to 1."""
    return sqrt(clip(1 - y, 0.0, 1.0)) * (1 + beta * y)
