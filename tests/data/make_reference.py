"""Make `closed_forms.csv`: the closed-form laws to 25 digits, from their definitions and not from our safe forms.

    python tests/data/make_reference.py > src/ballsocket/data/closed_forms.csv

mpmath with 80 digits. Force: the published formula (Eq. 13 of Heß & Forsbach 2021 for linear kinematics) or the
pressure integrated over the contact; both where both exist, which must agree to 40 digits. Stiffness: its derivative.
Energy: its integral over d. Inputs are doubles, taken as exact.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from mpmath import acos, cos, diff, mp, mpf, nstr, pi, quad, sin, sqrt

mp.dps = 80
R2, E, NU = mpf(18), mpf(1000), mpf(0.4)
K = mpf("276.5")  # a foundation modulus that is a double
ETA = mpf("0.25")  # adhesion number
PLANE_MODULUS = E / (1 - NU**2)
Law = Callable[[mpf], mpf]


@dataclass
class Case:
    """One model on one joint: laws of d."""

    model: str
    force: Law
    half_angle: Law
    pole_pressure: Law


def radial(model: str, displacement: Callable[[mpf, mpf], mpf], edge: Law, force: Law) -> Case:
    for d in (mpf("1e-3"), mpf("0.05")):  # Eq. (11) in x = cos φ
        integrated = 2 * pi * R2**2 * quad(lambda x, d=d: K * displacement(d, x) * x, [cos(edge(d)), 1])
        assert abs(integrated / force(d) - 1) < mpf("1e-40"), model
    return Case(model, force, edge, lambda d: K * displacement(d, mpf(1)))


def linear(c: mpf) -> Case:
    def force(d: mpf) -> mpf:  # Eq. (13)
        return pi * R2**2 * K / 3 * (2 * d - c + c * (c / (c + d)) ** 2)

    return radial("linear", lambda d, x: d * x - c * (1 - x), lambda d: acos(c / (c + d)), force)


def exact(c: mpf) -> Case:
    R1 = R2 - c

    def displacement(d: mpf, x: mpf) -> mpf:  # Eq. (5)
        e = c + d
        return e * x + sqrt(R1**2 - e**2 * (1 - x**2)) - R2

    def cosine(d: mpf) -> mpf:
        e = c + d
        return (e**2 + R2**2 - R1**2) / (2 * e * R2)

    def force(d: mpf) -> mpf:  # Eq. (11) integrated term by term
        e, x = c + d, cosine(d)
        terms = e * (1 - x**3) / 3 + (R1**3 - (R2 - e * x) ** 3) / (3 * e**2) - R2 * (1 - x**2) / 2
        return 2 * pi * R2**2 * K * terms

    return radial("exact", displacement, lambda d: acos(cosine(d)), force)


def half_space(c: mpf, n: int) -> Case:
    gap, kappa = c / (2 * (R2 - c) * R2) * R2 ** (2 - 2 * n), mpf(1)
    for j in range(1, n + 1):
        kappa *= mpf(2 * j) / (2 * j - 1)

    def radius(d: mpf) -> mpf:
        return (d / (kappa * gap)) ** (mpf(1) / (2 * n))

    def force(d: mpf) -> mpf:
        return 2 * PLANE_MODULUS * d * radius(d) * 2 * n / (2 * n + 1)

    def peak(d: mpf) -> mpf:
        return PLANE_MODULUS / pi * mpf(2 * n) / (2 * n - 1) * d / radius(d)

    return Case("hertz" if n == 1 else f"steuermann-{n}", force, lambda d: radius(d) / R2, peak)


def liu(c: mpf) -> Case:
    def force(d: mpf) -> mpf:
        return 4 * pi / 3 / 2 * PLANE_MODULUS * R2 * d**2 / (c + d)

    def edge(d: mpf) -> mpf:
        return acos(c / (c + d))

    return Case("liu", force, edge, lambda d: 3 * force(d) / (2 * pi * (R2 * sin(edge(d))) ** 2))


def adhesive(c: mpf) -> Case:
    free = c - ETA * c

    def force(d: mpf) -> mpf:
        x = free / (c + d)
        return 2 * pi * R2**2 * K * (free * (1 - x**3) / (3 * x) - c * (1 - x**2) / 2)

    return Case("adhesive", force, lambda d: acos(free / (c + d)), lambda d: K * d)


def joints() -> Iterator[tuple[float, float]]:
    """(clearance, indentation): d/c from 1e-12 to 1e6, and c = 0; indentations stay small against the radius."""
    for tenth in range(-24, 13):
        ratio = 10.0 ** (tenth / 2)
        yield (0.1, 0.1 * ratio) if ratio <= 1 else (0.1 / ratio, 0.1)
    for d in (1e-9, 1e-3, 0.1):
        yield 0.0, d


def main() -> None:
    print("# make_reference.py: R2 18 mm, K 276.5 MPa/mm, E 1000 MPa, nu 0.4, rigid ball, eta 0.25")
    print("model,clearance,indentation,force,half_angle,pole_pressure,stiffness,energy")
    for clearance, indentation in joints():
        c, d = mpf(clearance), mpf(indentation)
        cases = [linear(c), exact(c)]
        if clearance:
            cases += [half_space(c, 1), half_space(c, 3), liu(c)]
        if clearance and indentation >= clearance:  # below, forces change sign and relative errors mean nothing
            cases += [adhesive(c)]
        for case in cases:
            values = [law(d) for law in (case.force, case.half_angle, case.pole_pressure)]
            values += [diff(case.force, d, h=d * mpf("1e-30")), quad(case.force, [0, d / 1000, d / 30, d])]
            print(case.model, repr(clearance), repr(indentation), *(nstr(value, 25) for value in values), sep=",")


if __name__ == "__main__":
    main()
