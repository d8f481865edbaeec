"""Modal compliance of a bonded liner as a function of a real wave number.

c(n) E/R2 for real n > 0 is (1 + ν) N/D with k² = n(n + 1), q = n + ½, b = 1 + L/R2, k0 = 3 - 4ν, g = 8(1 - ν)(1 - 2ν):

    N = f(q) b^2q + f(-q) b^-2q - 4q²(k² + g) b² - 8(1 - 2ν)(q² - 1) k² + 4q²(k0 k² - g/2) b^-2
    D = h(q) b^2q + h(-q) b^-2q + 4q²(k² - 2)(k² + g) b² - 8(k² - 2)(q² - 1) k² + 4q²(k⁴ - 2k² + 4 - 4ν²) b^-2
    f(q) = (2k0 q - 1)(4(1 - ν)q² + 2(2 - 3ν)q - 1 + 2ν),  h(q) = (2q + 3)(2k0 q - 1)(q² - 2νq + 3/4)

Both vanish at q = 1, where two of the shell's four solutions coincide.
"""

from __future__ import annotations

from typing import NamedTuple

from ..core.arrays import Array, exp, log, sqrt, where

Pair = tuple[Array, Array]  # a value and its slope


class Liner(NamedTuple):
    """Coefficients of the modal compliance of a liner, independent of the wave number: polynomials in Q = q².

    N b^-2q and D b^-2q are f(q) + y [middle + y b^-4 f(-q)] with y = b^(2 - 2q) and f(±q) = even ± q odd. `numerator`
    and `denominator` are their coefficients, highest power first: of even (3), odd (2) and middle (4).
    """

    poisson: Array
    growth: Array  # ln b
    shrink: Array  # b^-2
    numerator: tuple[Array, ...]
    denominator: tuple[Array, ...]


def liner_coefficients(nu: Array, b: Array) -> Liner:
    """Compute the compliance coefficients of a liner from its Poisson's ratio ν and radius ratio b = 1 + L/R2."""
    k0, g, t, z = 3 - 4 * nu, 8 * (1 - nu) * (1 - 2 * nu), 1 - 2 * nu, 1 / (b * b)
    bent, none = 4 - 6 * nu, 0.0 * nu
    numerator = (
        none,
        2 * k0 * bent - 4 * (1 - nu),
        t,
        8 * k0 * (1 - nu),
        -2 * k0 * t - bent,
        none * z,
        4 * (k0 * z * z - 2 * t * z - 1),
        1 - 4 * g + z * (10 * t - z * (k0 + 2 * g)),
        -2 * t * z,
    )
    denominator = (
        4 * k0,
        3 * k0 - 3 - 4 * nu * (3 * k0 - 1),
        none - 2.25,
        6 * k0 - 2 - 8 * nu * k0,
        4.5 * k0 - 1.5 + 6 * nu,
        4 * (1 - z) * (1 - z) + none,
        4 * g - 10 + z * (28 - 10 * z),
        2.25 - 9 * g - z * (24.5 - z * (2.25 + 16 * (1 - nu * nu))),
        4.5 * z + none,
    )
    return Liner(poisson=nu, growth=log(b), shrink=z, numerator=numerator, denominator=denominator)


def log_compliance(k: Array, liner: Liner) -> Pair:
    """Compute the log modal compliance ln(c E/R2) and its slope by ln k, for wave numbers away from q = 1."""
    poisson, growth, shrink, upper, lower = liner
    Q = k * k + 0.25
    q = sqrt(Q)
    y = exp((1 - q) * (2 * growth))
    shrunk, decay = y * y * shrink * shrink, growth / q
    numerator, rise = _scaled_polynomial(q, Q, y, shrunk, decay, upper)
    denominator, fall = _scaled_polynomial(q, Q, y, shrunk, decay, lower)
    return log((1 + poisson) * (numerator / denominator)), 2 * k * k * (rise / numerator - fall / denominator)


def _scaled_polynomial(
    q: Array, Q: Array, y: Array, shrunk: Array, decay: Array, coefficients: tuple[Array, ...]
) -> Pair:
    """Evaluate numerator N or denominator D of the modal compliance, divided by b^2q, and its slope by Q = q².

    `shrunk` is y² b^-4, and `decay` is the slope of -ln y.
    """
    e2, e1, e0, o1, o0, r3, r2, r1, r0 = coefficients
    steep, high = e2 * Q, o1 * Q
    even, even_slope = (steep + e1) * Q + e0, 2 * steep + e1
    odd, odd_slope = q * (high + o0), (3 * high + o0) / (2 * q)
    inner, yQ = r3 * Q + r2, y * Q  # y first: Q³ overflows for short waves, where y is zero
    middle, middle_slope = inner * yQ * Q + r1 * yQ + r0 * y, (2 * inner + r3 * Q) * yQ + r1 * y
    back = shrunk * (even - odd)
    slope = even_slope + odd_slope + middle_slope + shrunk * (even_slope - odd_slope) - decay * (middle + 2 * back)
    return even + odd + middle + back, slope


def log_compliance_any_wave(k: Array, liner: Liner) -> Pair:
    """Compute ln(c E/R2) and its slope by ln k for all wave numbers; N and D share the factor q - 1, divided out."""
    nu = liner.poisson
    k0, g, t = 3 - 4 * nu, 8 * (1 - nu) * (1 - 2 * nu), 1 - 4 * nu
    q = sqrt(k * k + 0.25)
    rate = 2 * liner.growth
    y, decay = _decay_means(q, rate)
    numerator, rise = _reduced_polynomial(
        q,
        y,
        decay,
        liner,
        liner.numerator,
        first=(-4.0, 1 - 4 * g, 0.0),
        middle=(16 * nu - 8, 2 - 4 * nu),
        grown_first=(-4.0, 2 * (g + t) - 4, 3 * g + 2 * t, g),
        decayed_last=(4 * k0, 2 * k0 * (2 - t), -g - 2 * k0 * t, -g),
    )
    denominator, fall = _reduced_polynomial(
        q,
        y,
        decay,
        liner,
        liner.denominator,
        first=(4.0, 4 * g - 10, 2.25 - 9 * g, 0.0),
        middle=(-8.0, 20.0, -4.5),
        grown_first=(4.0, 14.0, 4 * g + 4 * t + 20, 12 * g + 10 * t + 16, 9 * g + 4 * t, 2 * g),
        decayed_last=(4.0, 14.0, 24 - 16 * nu, 10 + 8 * nu * t, 12 + 8 * nu * t, 8 * (1 - nu * nu)),
    )
    return log((1 + nu) * (numerator / denominator)), k * k / q * (rise / numerator - fall / denominator)


def _decay_means(q: Array, rate: Array) -> tuple[Array, Pair]:
    """Compute y = b^(2 - 2q), and z = (1 - y)/(q - 1) with its slope by q; near q = 1, z is a series."""
    x = (q - 1) * rate
    y = exp(-x)
    is_small = (x > -0.05) & (x < 0.05)
    divisor = where(is_small, 1.0, x)
    series, series_slope = _evaluate_polynomial(x, _DECAY)
    mean = (1 - y) / divisor
    slope = where(is_small, series_slope, (y - mean) / divisor)
    return y, (rate * where(is_small, series, mean), rate * rate * slope)


def _reduced_polynomial(
    q: Array,
    y: Array,
    decay: Pair,
    liner: Liner,
    coefficients: tuple[Array, ...],
    first: tuple[Array, ...],
    middle: tuple[Array, ...],
    grown_first: tuple[Array, ...],
    decayed_last: tuple[Array, ...],
) -> Pair:
    """Evaluate numerator N or denominator D of the modal compliance, divided by b^2q (q - 1), with its slope by q.

    f(q) b^2q with the first of the middle terms, and f(-q) b^-2q with the last, are q - 1 times polynomials of q - ½.
    With those, `decay` and y of `_decay_means` the result is

        `grown_first` - z `first` + y b^-2 [(q + 1) `middle` + b^-2 (`decayed_last` - z f(-q))].

    For short waves the first two terms cancel; they are (f(q) + y `first`)/(q - 1).
    """
    (z, z_slope), Q, rate = decay, q * q, 2 * liner.growth
    e2, e1, e0, o1, o0 = coefficients[:5]
    even, even_slope = (e2 * Q + e1) * Q + e0, 2 * q * (2 * e2 * Q + e1)
    odd, odd_slope = q * (o1 * Q + o0), 3 * o1 * Q + o0
    bounded_q = where(q < _MAX_DECAYED_Q, q, _MAX_DECAYED_Q)
    P, P_slope = _evaluate_polynomial(bounded_q * bounded_q, first)
    M, M_slope = _evaluate_polynomial(bounded_q * bounded_q, middle)
    G, G_slope = _evaluate_polynomial(bounded_q - 0.5, grown_first)
    H, H_slope = _evaluate_polynomial(bounded_q - 0.5, decayed_last)
    is_short = q > 2.0
    share = 1 / where(is_short, q - 1, 1.0)
    short = (even + odd + y * P) * share
    short_slope = (even_slope + odd_slope + y * (2 * bounded_q * P_slope - rate * P) - short) * share
    head = where(is_short, short, G - z * P)
    head_slope = where(is_short, short_slope, G_slope - z_slope * P - z * 2 * bounded_q * P_slope)
    back, back_slope = even - odd, even_slope - odd_slope
    inner = (bounded_q + 1) * M + liner.shrink * (H - z * back)
    inner_slope = (
        M + (bounded_q + 1) * 2 * bounded_q * M_slope + liner.shrink * (H_slope - z_slope * back - z * back_slope)
    )
    tail = y * liner.shrink
    return head + tail * inner, head_slope + tail * (inner_slope - rate * inner)


_MAX_DECAYED_Q = 1e6
"""Largest q of the polynomials that multiply y, which is 0 for shorter waves; it avoids an overflow."""

_DECAY = (-1 / 40320, 1 / 5040, -1 / 720, 1 / 120, -1 / 24, 1 / 6, -1 / 2, 1.0)
"""Coefficients (-1)^j/(j + 1)!, highest power first."""


def _evaluate_polynomial(x: Array, coefficients: tuple[Array, ...]) -> Pair:
    """Evaluate a polynomial and its slope at x; the coefficients start with the highest power."""
    value, slope = coefficients[0] + 0.0 * x, 0.0 * x
    for coefficient in coefficients[1:]:
        slope = slope * x + value
        value = value * x + coefficient
    return value, slope
