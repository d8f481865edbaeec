"""Friction of the ball in its socket: Coulomb stresses integrated over the patch, as slopes of a potential.

On the patch the ball slides with the speed |w|. Here w is v + R1 ω x m without its component along the normal m. The
resultants are the slopes of μ ∫ p |w| dA = μ N q over v and ω, with N = ∫ p |a x m| dA for an axis a across the load.
q is an effective slip speed: |v| for a sliding ball, and R1 |ω| for a ball that turns about an axis across the load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..core.arrays import Array, exp
from ..core.checks import check_number, require


class CoulombCoefficients:
    """Coulomb coefficients of sliding and static friction."""

    coefficient: float
    static_coefficient: float | None

    @property
    def breakaway_coefficient(self) -> float:
        """Coefficient of friction at the onset of sliding; equals the sliding one by default."""
        return self.coefficient if self.static_coefficient is None else self.static_coefficient

    def check_static(self) -> None:
        """Check that the static coefficient of friction is not below the sliding one; ValueError otherwise."""
        if self.static_coefficient is not None:
            allowed = "static friction must be at least the sliding friction"
            check_and_store_number(self, "static_coefficient", self.coefficient, allowed)


@dataclass(frozen=True, kw_only=True)
class Friction(CoulombCoefficients):
    """Regularised Coulomb friction: smooth in the slip speed, and nearly μ N above the transition speed.

    Sliding, turning and drilling share one limit. q is the effective slip speed of the patch, rounded off by the
    transition speed, and N the normal force times the widening factor of the contact::

        f = -N (μ(q) + viscous q) ∂q/∂v,   M = -N (μ(q) + viscous q) ∂q/∂ω,
        μ(q) = coefficient + (static - coefficient) exp[-(q/stribeck_speed)²].

    q is a fit to the integral of the stresses over the patch of radial springs with half angles of 4° to 86°. The
    power of pure sliding, turning, drilling and rolling about the pole agrees with it within 1e-4, that of mixed
    states within 0.3 %. Up to 65° the force differs by 0.4 % (rms) and 5 % (largest) of μ N, the drilling moment by
    0.8 % and 4.6 % of itself. Where the pole slips less than about the edge of the patch, force and moments differ by
    4 % (rms) and 11 % (largest), the power by 0.5 % and 2.2 %. Friction along the load, from the approach of the ball,
    is neglected.

    Parameters
    ----------
    coefficient : float
        Coefficient of sliding friction, 0 or more.
    transition_speed : float
        Slip in mm/s, above 0, at which the force has 71 % of its limit. Below it the ball creeps.
    static_coefficient : float, optional
        Coefficient at vanishing slip, not below `coefficient`. None, the default, is the same coefficient.
    stribeck_speed : float
        Speed of the transition from static to sliding friction in mm/s, above 0.
    viscous : float
        Increase of the coefficient with the slip in s/mm, 0 or more.

    Raises
    ------
    ValueError
        A value out of range.
    TypeError
        A value that is not a number.
    """

    coefficient: float
    transition_speed: float = 0.1
    static_coefficient: float | None = None
    stribeck_speed: float = 10.0
    viscous: float = 0.0

    def __post_init__(self) -> None:
        for name in ("coefficient", "viscous"):
            check_and_store_number(
                self, name, 0.0, "friction must be at least 0 and finite; negative friction would generate energy"
            )
        for name in ("transition_speed", "stribeck_speed"):
            check_and_store_number(self, name, 5e-324, "a speed (mm/s) must be above 0 and finite")
        self.check_static()


def check_and_store_number(instance: object, name: str, low: float, allowed: str) -> None:
    """Check a number of a frozen dataclass against its limits, and store it as a float."""
    value = check_number(name, getattr(instance, name))
    require(name, value, low <= value < math.inf, allowed)
    object.__setattr__(instance, name, value)


def widening_factor(versine: Array) -> Array:
    """Compute the ratio ∫ p |a x n| dA/F of the friction of an extended patch to that of a point contact.

    a is an axis across the load, and 1 - cos ε the versine. The polynomial fits radial springs within 2e-6; other
    pressure distributions differ by about 1 %.
    """
    m = versine
    return 1.0 + m * (0.166617 + m * (0.066859 + m * (0.019915 + m * (0.023034 + m * (0.009908 * m - 0.013095)))))


def drill_lever(versine: Array) -> Array:
    """Compute the lever arm of the drilling moment (about the load axis), divided by the patch radius R2 sin ε.

    ρ is ∫ p R2 sin φ dA over the force and the widening factor, 8/15 of R2 sin ε for a small contact. The polynomial
    fits radial springs within 1e-5.
    """
    m = versine
    return 8 / 15 + m * (0.165042 + m * (0.054402 + m * (0.015167 + m * (0.019374 + m * (0.009834 * m - 0.011755)))))


def friction_coefficient(speed: Array, sliding: Array, static: Array, stribeck_speed: Array) -> Array:
    """Compute the coefficient of friction μ at a slip speed in mm/s, including the Stribeck effect."""
    excess = static - sliding
    if excess == 0.0:
        return sliding + 0.0 * speed
    speed_ratio = speed / stribeck_speed
    return sliding + excess * exp(-speed_ratio * speed_ratio)


def rolling_slip_ratio(versine: Array) -> Array:
    """Compute the ratio κ = ∫ p sin²(φ/2) dA/N of mean slip to surface speed for a ball that rolls about the pole.

    The polynomial fits radial springs within 2e-5 of κ.
    """
    m = versine
    return m * (0.1666654 + m * (0.02783786 + m * (0.00243272 + m * (0.00084687 - m * 0.00142777))))


SLIP_FIT = (0.40815, 0.01064, -0.08503, 0.66324, 1.29028)
"""Numbers α0 + α1 m + α2 m², β and θ of `effective_slip`; m is the versine."""

TURN_FIT = (0.47204, -0.15697, 0.48267, 2.85234)  # numbers τ0 + τ1 m + τ2 m² and ν of `effective_slip`
DRILL_FIT = (1.54279, 0.61077, 2.43054, 0.65760)  # numbers η0 + η1 m and λ0 + λ1 m of `effective_slip`
ROLL_FIT = (0.40882, 0.62470)  # numbers γ and ζ of `effective_slip`


def effective_slip(
    slip: Array, tilt: Array, spin: Array, mixed: Array, transition_squared: Array, tilt_squared: Array, versine: Array
) -> tuple[Array, Array, Array, Array, Array]:
    """Compute the squared effective slip speed q² of the patch in (mm/s)², and its partial derivatives.

    X = |S|², Y = κ²|D|², Z = (ρ ω_n)² and P = κ S·D are in (mm/s)².

    S = v + b is the slip at the pole and D = v - b, where b = R1 ω x n. `transition_squared` is the
    square of the transition speed v0. With G = X + θ Y + v0²::

        q² = v0² + (1 - κ²) X + Y + Z - Z [X (α X + β Z) + P (τ X + ν Z)]/(G² + η G Z + λ Z²)
             - γ Y Z/(X + Y + ζ Z + v0²).

    The constants are a least-squares fit to the slopes of ∫ p |w| dA of radial springs with half angles of 4° to 86°.
    """
    (a0, a1, a2, b, theta), (t0, t1, t2, n), (e0, e1, l0, l1), (g, zeta) = SLIP_FIT, TURN_FIT, DRILL_FIT, ROLL_FIT
    m, total = versine, slip + tilt + spin + transition_squared
    scale = 1.0 / total
    x, y, z, p = scale * slip, scale * tilt, scale * spin, scale * mixed
    a, t, eta, lam_z = a0 + m * (a1 + m * a2), t0 + m * (t1 + m * t2), e0 + e1 * m, (l0 + l1 * m) * z
    G = x + theta * y + scale * transition_squared
    axial_sum, turning_sum = a * x + b * z, t * x + n * z
    inverse_denominator, roll = 1.0 / (G * (G + eta * z) + lam_z * z), g / (1.0 + (zeta - 1.0) * z)
    numerator = x * axial_sum + p * turning_sum
    ratio, rolling = z * numerator * inverse_denominator, roll * y * z
    denominator_slope = ratio * (2.0 * G + eta * z) * inverse_denominator
    rolling_slope = rolling * roll * (1.0 / g)
    return (
        total * (1.0 - ratio - rolling) - tilt_squared * slip,
        1.0 - tilt_squared - z * (axial_sum + a * x + t * p) * inverse_denominator + denominator_slope + rolling_slope,
        1.0 + theta * denominator_slope - roll * z + rolling_slope,
        1.0
        - (numerator + z * (b * x + n * p) - ratio * (eta * G + 2.0 * lam_z)) * inverse_denominator
        - roll * y
        + zeta * rolling_slope,
        -z * turning_sum * inverse_denominator,
    )


def effective_slip_bends(
    slip: Array, tilt: Array, spin: Array, mixed: Array, transition_squared: Array, versine: Array
) -> dict[tuple[int, int], Array]:
    """Compute the second partial derivatives of the squared effective slip speed q² by X, Y, Z and P.

    The keys number X, Y, Z and P from 0 to 3; see `effective_slip`.
    """
    (a0, a1, a2, b, theta), (t0, t1, t2, n), (e0, e1, l0, l1), (g, zeta) = SLIP_FIT, TURN_FIT, DRILL_FIT, ROLL_FIT
    m, scale = versine, 1.0 / (slip + tilt + spin + transition_squared)
    x, y, z, p = scale * slip, scale * tilt, scale * spin, scale * mixed
    a, t, eta, lam = a0 + m * (a1 + m * a2), t0 + m * (t1 + m * t2), e0 + e1 * m, l0 + l1 * m
    G = x + theta * y + scale * transition_squared
    inverse_denominator = 1.0 / (G * (G + eta * z) + lam * z * z)
    inverse_roll_denominator = 1.0 / (1.0 + (zeta - 1.0) * z)
    zero = 0.0 * x
    # N/d with N = z [x (α x + β z) + p (τ x + ν z)]
    ratio = z * (x * (a * x + b * z) + p * (t * x + n * z)) * inverse_denominator
    top = (
        z * (2.0 * a * x + b * z + t * p),
        zero,
        x * (a * x + 2.0 * b * z) + p * (t * x + 2.0 * n * z),
        z * (t * x + n * z),
    )
    low = 2.0 * G + eta * z, theta * (2.0 * G + eta * z), eta * G + 2.0 * lam * z, zero
    first = [(up - ratio * down) * inverse_denominator for up, down in zip(top, low, strict=True)]
    tops = {(0, 0): 2.0 * a * z, (0, 2): 2.0 * (a * x + b * z) + t * p, (0, 3): t * z, (2, 3): t * x + 2.0 * n * z}
    tops |= {(2, 2): 2.0 * (b * x + n * p)}
    lows = {(0, 0): 2.0, (0, 1): 2.0 * theta, (1, 1): 2.0 * theta * theta, (0, 2): eta, (1, 2): theta * eta}
    lows |= {(2, 2): 2.0 * lam}
    # γ y z/o with o = x + y + ζ z + v0²
    roll, edge = g * y * z * inverse_roll_denominator, (1.0, 1.0, zeta, 0.0)
    rolled = [
        (g * part - roll * down) * inverse_roll_denominator for part, down in zip((zero, z, y, zero), edge, strict=True)
    ]
    bends = {}
    for i in range(4):
        for j in range(i, 4):
            bend = tops.get((i, j), zero) - ratio * lows.get((i, j), 0.0) - first[i] * low[j] - first[j] * low[i]
            tilted = (g if (i, j) == (1, 2) else 0.0) - rolled[i] * edge[j] - rolled[j] * edge[i]
            bends[i, j] = -scale * (bend * inverse_denominator + tilted * inverse_roll_denominator)
    return bends
