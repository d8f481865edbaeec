"""Make `closed_forms.csv`: the closed-form laws to 25 digits, from their definitions and not from our safe forms.

    python tests/data/make_reference.py > src/ballsocket/data/closed_forms.csv

mpmath with 80 digits. Force: the published formula (Eq. 13 of Heß & Forsbach 2021 for linear kinematics) or the
pressure integrated over the contact; both where both exist, which must agree to 40 digits. Stiffness: its derivative.
Energy: its integral over d. Inputs are doubles, taken as exact.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from mpmath import acos, cos, diff, mp, mpf, nstr, pi, quad, sin, sqrt

mp.dps = 80
R1_PLUS_C = 18.0
L, E, NU = 6.75, 1000.0, 0.4
K = 276.5  # a foundation modulus that is a double
ETA = 0.25  # adhesion number
Law = Callable[[mpf], mpf]


@dataclass
class Case:
    """One model on one joint: laws of d."""

    model: str
    force: Law
    half_angle: Law
    pole_pressure: Law


def radial(model: str, c: mpf, displacement: Callable[[mpf, mpf], mpf], edge: Law, closed: Law) -> Case:
    R2, k = mpf(R1_PLUS_C), mpf(K)

    def force(d: mpf) -> mpf:
        return closed(d)

    def integrated(d: mpf) -> mpf:
        # Eq. (11) in x = cos φ
        return 2 * pi * R2**2 * quad(lambda x: k * displacement(d, x) * x, [cos(edge(d)), 1])

    for d in (mpf("1e-3"), mpf("0.05")):
        assert abs(integrated(d) / force(d) - 1) < mpf("1e-40"), model
    return Case(model, force, edge, lambda d: k * displacement(d, mpf(1)))


def linear(c: mpf) -> Case:
    R2, k = mpf(R1_PLUS_C), mpf(K)

    def closed(d: mpf) -> mpf:  # Eq. (13)
        return pi * R2**2 * k / 3 * (2 * d - c + c * (c / (c + d)) ** 2)

    return radial("linear", c, lambda d, x: d * x - c * (1 - x), lambda d: acos(c / (c + d)), closed)


def exact(c: mpf) -> Case:
    R2, k = mpf(R1_PLUS_C), mpf(K)
    R1 = R2 - c

    def displacement(d: mpf, x: mpf) -> mpf:  # Eq. (5)
        e = c + d
        return e * x + sqrt(R1**2 - e**2 * (1 - x**2)) - R2

    def cosine(d: mpf) -> mpf:
        e = c + d
        return (e**2 + R2**2 - R1**2) / (2 * e * R2)

    def closed(d: mpf) -> mpf:  # Eq. (11) integrated term by term
        e, x = c + d, cosine(d)
        terms = e * (1 - x**3) / 3 + (R1**3 - (R2 - e * x) ** 3) / (3 * e**2) - R2 * (1 - x**2) / 2
        return 2 * pi * R2**2 * k * terms

    return radial("exact", c, displacement, lambda d: acos(cosine(d)), closed)


def half_space(c: mpf, n: int) -> Case:
    R2 = mpf(R1_PLUS_C)
    R1 = R2 - c
    modulus = mpf(E) / (1 - mpf(NU) ** 2)
    gap = c / (2 * R1 * R2) * R2 ** (2 - 2 * n)
    kappa = mpf(1)
    for j in range(1, n + 1):
        kappa *= mpf(2 * j) / (2 * j - 1)

    def radius(d: mpf) -> mpf:
        return (d / (kappa * gap)) ** (mpf(1) / (2 * n))

    def force(d: mpf) -> mpf:
        return 2 * modulus * d * radius(d) * 2 * n / (2 * n + 1)

    def peak(d: mpf) -> mpf:
        return modulus / pi * mpf(2 * n) / (2 * n - 1) * d / radius(d)

    return Case("hertz" if n == 1 else f"steuermann-{n}", force, lambda d: radius(d) / R2, peak)


def liu(c: mpf) -> Case:
    R2, modulus = mpf(R1_PLUS_C), mpf(E) / (1 - mpf(NU) ** 2)

    def force(d: mpf) -> mpf:
        return 4 * pi / 3 / 2 * modulus * R2 * d**2 / (c + d)

    def edge(d: mpf) -> mpf:
        return acos(c / (c + d))

    return Case("liu", force, edge, lambda d: 3 * force(d) / (2 * pi * (R2 * sin(edge(d))) ** 2))


def adhesive(c: mpf) -> Case:
    R2, k = mpf(R1_PLUS_C), mpf(K)
    stretch = mpf(ETA) * c

    def edge(d: mpf) -> mpf:
        return acos((c - stretch) / (c + d))

    def force(d: mpf) -> mpf:
        x = cos(edge(d))
        return 2 * pi * R2**2 * k * ((c - stretch) * (1 - x**3) / (3 * x) - c * (1 - x**2) / 2)

    return Case("adhesive", force, edge, lambda d: k * d)


def joints() -> Iterator[tuple[float, float]]:
    """(clearance, indentation): d/c from 1e-12 to 1e6, and c = 0; indentations stay small against the radius."""
    for tenth in range(-24, 13):
        ratio = 10.0 ** (tenth / 2)
        yield (0.1, 0.1 * ratio) if ratio <= 1 else (0.1 / ratio, 0.1)
    for d in (1e-9, 1e-3, 0.1):
        yield 0.0, d


def rows() -> Iterator[str]:
    for clearance, indentation in joints():
        c, d = mpf(clearance), mpf(indentation)
        cases = [linear(c), exact(c)]
        if clearance:
            cases += [half_space(c, 1), half_space(c, 3), liu(c)]
        if clearance and indentation >= clearance:  # below, forces change sign and relative errors mean nothing
            cases += [adhesive(c)]
        for case in cases:
            values = (
                case.force(d),
                case.half_angle(d),
                case.pole_pressure(d),
                diff(case.force, d, h=d * mpf("1e-30")),
                quad(case.force, [0, d / 1000, d / 30, d]),
            )
            yield ",".join([case.model, repr(clearance), repr(indentation), *(nstr(value, 25) for value in values)])


if __name__ == "__main__":
    sys.stdout.write("# make_reference.py: R2 18 mm, K 276.5 MPa/mm, E 1000 MPa, nu 0.4, rigid ball, eta 0.25\n")
    sys.stdout.write("model,clearance,indentation,force,half_angle,pole_pressure,stiffness,energy\n")
    for row in rows():
        sys.stdout.write(row + "\n")
