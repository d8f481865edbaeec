"""Kinematics of a rigid ball on radial springs: displacement, force, energy and half angle as formulas.

Closed forms of one problem: a rigid ball of radius R1, whose centre lies e = c + d below the centre of a
socket of radius R2 = R1 + c, on springs that act along the radius. With u(φ) the radial displacement of the socket's
surface and p = K u,

    F = 2π R2² ∫ p cos φ sin φ dφ.

Lengths are in mm, K in MPa/mm, forces in N. Every formula is written without cancellation from d/c = 1e-12 to 1e6,
and holds for c = 0. `versine` is 1 - cos ε of the half angle ε.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf, nan, pi
from typing import Any

from ..core.arrays import Array, asin, clip, integral, safe_divisor, sin, sqrt, where
from ..core.sources import Source
from ..core.validity import Range, Remark
from ..problem.gaps import LinearGapRange


def versine_of(angle: Array) -> Array:
    """Compute the versine 1 - cos φ of an angle in rad without cancellation."""
    return 2 * sin(angle / 2) ** 2


def angle_of(versine: Array) -> Array:
    """Compute the angle in rad, 0 to π, from its versine 1 - cos φ."""
    return 2 * asin(sqrt(versine / 2))


def linear_versine(R2: Array, c: Array, d: Array) -> Array:
    """Compute the versine 1 - cos ε of the half angle for linear kinematics."""
    # Eq. (8): cos ε = c/(c + d)
    return d / safe_divisor(c + d)


def linear_indentation_of_versine(R2: Array, c: Array, versine: Array) -> Array:
    """Compute the indentation d in mm from the versine 1 - cos ε of the half angle for linear kinematics."""
    # Eq. (8) solved for d; without clearance every load has the same half angle
    return where(c > 0, c * versine / safe_divisor(1 - versine), nan)


def linear_displacement(R2: Array, c: Array, d: Array, m: Array) -> Array:
    """Compute the radial displacement u of the springs in mm at the versine m = 1 - cos φ for linear kinematics."""
    # Eq. (6): u = d cos φ - c (1 - cos φ), with m = 1 - cos φ
    return d - (c + d) * m


def linear_force(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the contact force F in N from the indentation d for linear kinematics."""
    # Eq. (13): F = π R2² K/3 [2d - c + c (c/(c + d))²]
    e = safe_divisor(c + d)
    return (pi / 3) * K * R2**2 * (d * d * (3 * c + 2 * d) / (e * e))


def linear_stiffness(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the contact stiffness dF/dd in N/mm for linear kinematics."""
    # slope of Eq. (13)
    e = safe_divisor(c + d)
    x = c / e
    return (2 * pi / 3) * K * R2**2 * (d / e) * (1 + x + x * x)


def linear_energy(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the elastic energy of the springs in N mm for linear kinematics."""
    # integral of Eq. (13), which is also the energy of the springs
    return (pi / 3) * K * R2**2 * d * d * (d / safe_divisor(c + d))


def linear_pressure_integral(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the integral of the pressure over the contact area, in N, for linear kinematics."""
    # ∫ p dA = 2π R2² K ∫ u sin φ dφ
    return pi * K * R2**2 * d * (d / safe_divisor(c + d))


def linear_indentation(R2: Array, c: Array, K: Array, F: Array) -> Array:
    """Compute the indentation d in mm from the contact force F for linear kinematics."""
    # Eq. (13) solved for d: a cubic. The first guess is exact at both ends (d << c and d >> c) and within
    # 3.1 % elsewhere; two Halley steps (on 2z - 3 + 1/z² = q, z = 1 + d/c) reduce that to 1e-18.
    s = 1.5 * F / (pi * R2**2 * K)
    d = 0.5 * (s + sqrt(s * (s + (8 / 3) * c)))
    for _ in range(2):
        e = c + d
        N = d * d * (3 * c + 2 * d) - 2 * s * e * e
        M = d * (3 * c * (c + d) + d * d)
        d = d - 2 * N * M * e / safe_divisor(4 * M * M - 3 * N * c * c * c)
    return d


def cosine_versine(R2: Array, c: Array, d: Array) -> Array:
    """Compute the versine 1 - cos ε of the half angle for cosine kinematics: 1 (a hemisphere) under load."""
    return where(d > 0, 1.0, 0.0 * d)


def cosine_indentation_of_versine(R2: Array, c: Array, versine: Array) -> Array:
    """Return NaN for the indentation of a half angle: without clearance the half angle is always 90 degrees."""
    return versine * nan


def cosine_displacement(R2: Array, c: Array, d: Array, m: Array) -> Array:
    """Compute the radial spring displacement u in mm at the versine m = 1 - cos φ for cosine kinematics."""
    return linear_displacement(R2, 0.0 * c, d, m)


def cosine_force(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the contact force F in N from the indentation d for cosine kinematics, without clearance."""
    return linear_force(R2, 0.0 * c, K, d)


def cosine_stiffness(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the contact stiffness dF/dd in N/mm for cosine kinematics, without clearance."""
    return linear_stiffness(R2, 0.0 * c, K, d)


def cosine_energy(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the elastic energy of the springs in N mm for cosine kinematics, without clearance."""
    return linear_energy(R2, 0.0 * c, K, d)


def cosine_pressure_integral(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the integral of the pressure over the contact area, in N, for cosine kinematics, without clearance."""
    return linear_pressure_integral(R2, 0.0 * c, K, d)


def cosine_indentation(R2: Array, c: Array, K: Array, F: Array) -> Array:
    """Compute the indentation d in mm from the contact force F for cosine kinematics, without clearance."""
    # F = (2π/3) K R2² d
    return 1.5 * F / (pi * R2**2 * K)


def circular_versine(R2: Array, c: Array, d: Array) -> Array:
    """Compute the versine 1 - cos ε of the half angle for exact kinematics."""
    # Eq. (5) with u = 0: cos ε = (e² + R2² - R1²)/(2 e R2)
    return d * (2 * (R2 - c) - d) / safe_divisor(2 * R2 * (c + d))


def circular_indentation_of_versine(R2: Array, c: Array, versine: Array) -> Array:
    """Compute d in mm from the versine 1 - cos ε for exact kinematics; NaN beyond the largest half angle."""
    # smaller root of e² - 2 e R2 cos ε + R2² - R1² = 0, written for d = e - c; NaN beyond the largest half angle
    b = R2 - c - R2 * versine
    d = 2 * R2 * c * versine / safe_divisor(b + sqrt(b * b - 2 * R2 * c * versine))
    return where(c > 0, d, nan)


def circular_displacement(R2: Array, c: Array, d: Array, m: Array) -> Array:
    """Compute the radial displacement u of the springs in mm at the versine m = 1 - cos φ for exact kinematics."""
    # Eq. (5): u = e cos φ + sqrt(R1² - e² sin² φ) - R2, with m = 1 - cos φ
    e = c + d
    R1 = R2 - c
    dropped = e * e * m * (2 - m)
    return d - e * m - dropped / (R1 + sqrt(clip(R1 * R1 - dropped, 0.0, inf)))


def circular_force(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the contact force F in N for exact kinematics; NaN if the ball's centre leaves the socket."""
    # Eq. (11) with Eq. (5): F = 2π R2² K {e (1 - k³)/3 + [R1³ - (R2 - e k)³]/(3 e²) - R2 (1 - k²)/2}, k = cos ε,
    # which is a Laurent polynomial in e with a double root at first touch. The ball's centre stays inside the socket.
    e = safe_divisor(c + d)
    force = (pi / 12) * K * R2 * (d * d * (4 * R2 * (2 * e + c) - 3 * (e + c) ** 2) / (e * e))
    return where(e <= R2, force, nan)


def circular_stiffness(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the contact stiffness dF/dd in N/mm for exact kinematics."""
    # slope of the force
    e = safe_divisor(c + d)
    x = c / e
    return (pi / 6) * K * R2 * (d / e) * (4 * R2 * (1 + x + x * x) - 3 * (e + c) * (1 + x * x))


def circular_energy(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the elastic energy of the springs in N mm for exact kinematics."""
    # integral of the force
    return (pi / 12) * K * R2 * d * d * (d / safe_divisor(c + d)) * (4 * (R2 - c) - d)


def circular_pressure_integral(R2: Array, c: Array, K: Array, d: Array) -> Array:
    """Compute the integral of the pressure over the contact area, in N, for exact kinematics."""
    # ∫ p dA = 2π R2² K ∫ u dm over 0..versine by Gauss-Legendre with 8 points: u is nearly linear in m
    versine = circular_versine(R2, c, d)
    return 2 * pi * K * R2**2 * versine * integral(lambda x: circular_displacement(R2, c, d, x * versine), 8)


def circular_indentation(R2: Array, c: Array, K: Array, F: Array) -> Array:
    """Compute the indentation d in mm from the contact force F for exact kinematics, by Newton's method."""
    # The force is less than that of Eq. (13), so the linear result is a lower bound; the force is nearly linear in d
    # there and Newton's method converges from that side. NaN where the ball's centre would leave the socket.
    d = linear_indentation(R2, c, K, F)
    for _ in range(6):
        d = d - (circular_force(R2, c, K, d) - F) / safe_divisor(circular_stiffness(R2, c, K, d))
    return d


def _other_depth_ratio(contact: Any) -> Array:
    """Compute the other d of a half angle over the smaller of L and R2; the roots e have the product R2² - R1²."""
    joint = contact.joint
    R2, c, L = joint.socket_radius, joint.clearance, joint.liner_thickness
    other = c * (2 * R2 - c) / safe_divisor(c + contact.indentation) - c
    return where(c > 0, other / where(L < R2, L, R2), inf)


Formula = Callable[..., Array]  # formula of R2, c, K and d, or as `Kinematics` states


@dataclass(frozen=True, kw_only=True)
class Kinematics:
    """Kinematics of a radial foundation as a set of plain functions, such as `linear_kinematics`.

    force, stiffness, energy and pressure_integral take (R2, c, K, d); indentation takes (R2, c, K, F); versine takes
    (R2, c, d), its inverse indentation_of_versine (R2, c, versine), displacement (R2, c, d, 1 - cos φ).
    """

    name: str
    sources: tuple[Source, ...] = field(hash=False)
    force: Formula
    stiffness: Formula
    energy: Formula
    pressure_integral: Formula
    indentation: Formula
    versine: Formula
    indentation_of_versine: Formula
    displacement: Formula
    validity: tuple[Range, ...] = field(default=(), hash=False)
    remarks: tuple[Remark, ...] = field(default=(), hash=False)

    def __repr__(self) -> str:
        return f"{self.name}_kinematics"


MAX_SPRING_REDUCTION = 0.05
"""Largest reduction of pmax by the linear gap for which springs are valid; they are less accurate than elasticity."""

linear_kinematics = Kinematics(
    name="linear",
    sources=(Source("hess2021", "(6), (8), (12), (13)"),),
    force=linear_force,
    stiffness=linear_stiffness,
    energy=linear_energy,
    pressure_integral=linear_pressure_integral,
    indentation=linear_indentation,
    versine=linear_versine,
    indentation_of_versine=linear_indentation_of_versine,
    displacement=linear_displacement,
    validity=(LinearGapRange(high=MAX_SPRING_REDUCTION, why="use the same springs with exact kinematics"),),
)
"""u = d cos φ - c (1 - cos φ), Eq. (6) of the paper: sin² φ neglected under the root of Eq. (5)."""

cosine_kinematics = Kinematics(
    name="cosine",
    sources=(Source("hess2021", "(6), (8), (13)"),),
    force=cosine_force,
    stiffness=cosine_stiffness,
    energy=cosine_energy,
    pressure_integral=cosine_pressure_integral,
    indentation=cosine_indentation,
    versine=cosine_versine,
    indentation_of_versine=cosine_indentation_of_versine,
    displacement=cosine_displacement,
    validity=(Range(quantity="conformity", high=0.05, why="the limit of a ball that fills its socket"),),
)
"""u = d cos φ: Eq. (6) in the limit of vanishing clearance, half angle 90 degrees at any load."""

exact_kinematics = Kinematics(
    name="exact",
    sources=(Source("bartel1985", ""), Source("hess2021", "(4), (5), (11)")),
    force=circular_force,
    stiffness=circular_stiffness,
    energy=circular_energy,
    pressure_integral=circular_pressure_integral,
    indentation=circular_indentation,
    versine=circular_versine,
    indentation_of_versine=circular_indentation_of_versine,
    displacement=circular_displacement,
    remarks=(
        Remark(
            quantity=_other_depth_ratio,
            symbol="other d/L",
            low=0.1,
            why="two indentations below a tenth of the liner have this half angle; half_angle= takes the smaller one",
        ),
    ),
)
"""u = e cos φ + sqrt(R1² - e² sin² φ) - R2, Eq. (5) of the paper: the exact circular shape of the ball."""
