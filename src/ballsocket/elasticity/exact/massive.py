"""Modes of bodies without layers: of an infinite socket and of a ball they are rational in the degree."""

from __future__ import annotations

import numpy

from ...core.arrays import Numbers


def asymptote_of(radius: float, young: float, poisson: float) -> float:
    """C in mm/MPa, the limit of c_n (n + ½) at high degrees, where a sphere is a half-space."""
    return 2 * (1 - poisson**2) * radius / young


def _polynomials(nu: float) -> tuple[list[float], list[float]]:
    """Polynomials of ρ in an infinite socket, in falling powers of q = n + ½.

    The numerator begins with q², the denominator with q³. A ball has -q in place of q.
    """
    above = [-((1 - 2 * nu) ** 2) / (2 * (1 - nu)), -(4 - 17 * nu + 12 * nu**2) / (4 * (1 - nu)), -9 / 8]
    below = [1.0, 3 / 2 - 2 * nu, 3 / 4 - 3 * nu, 9 / 8]  # (q + 3/2)(q² - 2νq + 3/4)
    return above, below


def massive_excess(q: Numbers, nu: float) -> Numbers:
    """ρ_n = c_n (n + ½)/C - 1 of an infinite socket at q = n + ½, of a ball at q = -(n + ½)."""
    above, _ = _polynomials(nu)
    return numpy.asarray(numpy.polyval(above, q) / ((q + 1.5) * (q * (q - 2 * nu) + 0.75)))


def series(nu: float, order: int) -> Numbers:
    """The quotient of the polynomials in powers of 1/q."""
    above, below = _polynomials(nu)
    a = [0.0, 0.0, 0.0]
    for j in range(order):
        earlier = below[1] * a[-1] + below[2] * a[-2] + below[3] * a[-3]
        a.append((above[j] if j < 3 else 0.0) - earlier)
    return numpy.array(a[3:])
