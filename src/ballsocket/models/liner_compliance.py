"""The modal compliance of a bonded liner between the integers: how it answers waves of any length."""

from __future__ import annotations

from math import factorial
from typing import NamedTuple

from .. import arrays
from ..arrays import Array, where
from .dual_numbers import Dual, either, horner


def compliance(k: Dual, nu: Array, b: Array) -> Dual:
    """c(n) E/R2 of the bonded liner for real n > 0, n(n + 1) = k²; b = 1 + L/R2.

    With q = n + 1/2, k0 = 3 - 4ν and g = 8(1 - ν)(1 - 2ν) it is (1 + ν) N/D,

        N = f(q) b^2q + f(-q) b^-2q - 4q²(k² + g) b² - 8(1 - 2ν)(q² - 1) k² + 4q²(k0 k² - g/2) b^-2
        D = h(q) b^2q + h(-q) b^-2q + 4q²(k² - 2)(k² + g) b² - 8(k² - 2)(q² - 1) k² + 4q²(k⁴ - 2k² + 4 - 4ν²) b^-2
        f(q) = (2k0 q - 1)(4(1 - ν)q² + 2(2 - 3ν)q - 1 + 2ν),  h(q) = (2q + 3)(2k0 q - 1)(q² - 2νq + 3/4)

    Both vanish at q = 1, where two of the shell's four solutions coincide. Of several k along the first axis only the
    first may come near.
    """
    away = k.value * k.value - 0.75
    near = (away > -0.05) & (away < 0.05)
    if arrays.truth(~near):
        above, below = (sums.direct(b) for sums in _sums(k, nu))
        return above / below * (1 + nu)
    elsewhere = Dual(where(near, 2.0, k.value), k.slope)
    above, below = (sums.direct(b) for sums in _sums(elsewhere, nu))
    above_near, below_near = (sums.beside_one(b) for sums in _sums(Dual(k.value[:1, ...], k.slope[:1, ...]), nu))
    return either(near, above_near / below_near, above / below) * (1 + nu)


class _Sum(NamedTuple):
    """grown b^2q + decayed b^-2q + first b² + middle (q² - 1) + last b^-2, which vanishes at q = 1.

    Also the polynomials (of n = q - 1/2, the highest power first) that remain of grown + first and of decayed + last
    when q - 1 is divided out.
    """

    q: Dual
    grown: Dual
    decayed: Dual
    first: Dual
    middle: Dual
    last: Dual
    grown_first: tuple[Array, ...]
    decayed_last: tuple[Array, ...]

    def direct(self, b: Array) -> Dual:
        """The sum, over b^2q."""
        q, b2 = self.q, b * b
        y = ((1 - q) * (2 * arrays.log(b))).exp()
        return self.grown + y * (self.first + ((q * q - 1) * self.middle + (self.last + y * self.decayed) / b2) / b2)

    def beside_one(self, b: Array) -> Dual:
        """The sum, over b^2q (q - 1)."""
        q, b2, n, rate = self.q, b * b, self.q - 0.5, 2 * arrays.log(b)
        x = (q - 1) * rate
        y, z = (-x).exp(), _decay_mean(x) * rate  # z = (1 - y)/(q - 1)
        start = horner(n, self.grown_first) - z * self.first
        end = horner(n, self.decayed_last) - z * self.decayed
        return start + y * ((q + 1) * self.middle + end / b2) / b2


def _sums(k: Dual, nu: Array) -> tuple[_Sum, _Sum]:
    """N and D of `compliance`."""
    k2, k0, g, t = k * k, 3 - 4 * nu, 8 * (1 - nu) * (1 - 2 * nu), 1 - 4 * nu
    square = 4 * k2 + 1  # 4q²
    q = square.sqrt() / 2

    def f(q: Dual) -> Dual:
        return (q * (2 * k0) - 1) * horner(q, (4 * (1 - nu), 4 - 6 * nu, 2 * nu - 1))

    def h(q: Dual) -> Dual:
        return (2 * q + 3) * (q * (2 * k0) - 1) * horner(q, (1.0, -2 * nu, 0.75))

    above = _Sum(
        q=q,
        grown=f(q),
        decayed=f(-q),
        first=-square * (k2 + g),
        middle=k2 * (16 * nu - 8),
        last=square * (k2 * k0 - g / 2),
        grown_first=(-4.0, 2 * (g + t) - 4, 3 * g + 2 * t, g),
        decayed_last=(4 * k0, 2 * k0 * (2 - t), -g - 2 * k0 * t, -g),
    )
    below = _Sum(
        q=q,
        grown=h(q),
        decayed=h(-q),
        first=square * (k2 - 2) * (k2 + g),
        middle=k2 * (2 - k2) * 8,
        last=square * ((k2 - 2) * k2 + 4 * (1 - nu * nu)),
        grown_first=(4.0, 14.0, 4 * g + 4 * t + 20, 12 * g + 10 * t + 16, 9 * g + 4 * t, 2 * g),
        decayed_last=(4.0, 14.0, 24 - 16 * nu, 10 + 8 * nu * t, 12 + 8 * nu * t, 8 * (1 - nu * nu)),
    )
    return above, below


def _decay_mean(x: Dual) -> Dual:
    """(1 - exp(-x))/x, by its series near 0."""
    small = (x.value > -0.05) & (x.value < 0.05)
    safe = Dual(where(small, 1.0, x.value), x.slope)
    series = horner(-x, [1 / factorial(j + 1) for j in range(7, -1, -1)])
    return either(small, series, (1 - (-safe).exp()) / safe)
