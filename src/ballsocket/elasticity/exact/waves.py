"""Modes of pressure on their way through the layers of a socket: waves that grow and waves that decay with r.

In a layer, the displacements (u_r times P_n and u_φ times dP_n/dφ) and the tractions (r σ_rr and r σ_rφ) of the mode n
are sums of four powers of r. The two that grow with r make up one wave, the two that decay another. Either wave is
known from its two displacements u at one radius: with κ < 1 the ratio to another radius and h = (1 - κ²)/2,

    r^(n+1), r^(n-1):       κ^(n-1) (1 - h N+) u  is left of u further inwards,    r σ = K+ u,
    r^-n, r^-(n+2):         κ^n (1 - h N-) u      is left of u further outwards,   r σ = K- u,

where the 2×2 matrices N and K are rational in n. No power ever grows, and K+ and K- stay well apart at any degree and
thickness. Each layer, from the outermost inwards, turns the condition on its outer surface into u = S r σ on its
inner one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import expm1, log1p

import numpy

Matrix = numpy.ndarray
"""2×2 for each degree, shape (2, 2, degrees); a pair of displacements or tractions is (2, 1, degrees)."""

_ENDLESS = 100.0  # ln(b/R2) of a layer that counts as infinite
_TINY = 1e-17  # for an incompressible layer at n = 0, which does not give way

UNIT: Matrix = numpy.eye(2)[:, :, None]


def _times(a: Matrix, b: Matrix) -> Matrix:
    return a[:, :1] * b[:1] + a[:, 1:] * b[1:]


def _inverse(a: Matrix) -> Matrix:
    return numpy.array([[a[1, 1], -a[0, 1]], [-a[1, 0], a[0, 0]]]) / (a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0])


def _outer(column: tuple[numpy.ndarray, ...], row: tuple[numpy.ndarray, ...]) -> Matrix:
    return numpy.array(column)[:, None] * numpy.array(row)


def fixed() -> tuple[Matrix, Matrix]:
    """The condition u = 0 as A and B of A u + B r σ = 0."""
    return UNIT, 0 * UNIT


def free(n: numpy.ndarray) -> tuple[Matrix, Matrix]:
    """The condition σ = 0 as A and B.

    At n = 1 it is u_r + 2 u_φ = 0 (no mean translation) and σ_rr = σ_rφ (uniform traction).
    """
    A = numpy.zeros((2, 2, len(n)))
    B = A + UNIT
    first = n == 1
    A[0, :, first], B[0, :, first], B[1, :, first] = (1.0, 2.0), (0.0, 0.0), (1.0, -1.0)
    return A, B


@dataclass(frozen=True, kw_only=True, eq=False)
class Wave:
    """Displacements that grow, or that decay, with r: N and K of the head of this file, power n - 1 or n."""

    N: Matrix
    K: Matrix
    power: numpy.ndarray

    @classmethod
    def of(cls, n: numpy.ndarray, N: Matrix, K: Matrix, power: numpy.ndarray, alone: int) -> Wave:
        # n = 0 has one power of r, ±`alone`, and no u_φ: what keeps its place must not mix with u_r, nor be singular
        zero = n == 0
        N[:, :, zero], K[1, 0, zero], K[1, 1, zero] = 0.0, 0.0, K[0, 0, zero]
        return cls(N=N, K=K, power=numpy.where(zero, alone, power))

    def left(self, x: float | numpy.ndarray, u: Matrix) -> Matrix:
        """What is left of u a way x = -ln κ down the wave."""
        return numpy.exp(-self.power * x) * (u + numpy.expm1(-2 * x) / 2 * _times(self.N, u))

    def lost(self, x: float) -> Matrix:
        """The unit matrix less what is left of it, without cancellation."""
        decay = self.power * x
        return -numpy.expm1(-decay) * UNIT - expm1(-2 * x) / 2 * numpy.exp(-decay) * self.N

    def along(self, x: numpy.ndarray, u: Matrix) -> tuple[Matrix, Matrix]:
        """Displacements and r σ at many places, which are one more axis."""
        wide = Wave(N=self.N[..., None], K=self.K[..., None], power=self.power[:, None])
        there = wide.left(x, u[..., None])
        return there, _times(wide.K, there)


def growing_wave(n: numpy.ndarray, young: float, nu: float) -> Wave:
    """From r^(n-1), where u = (n, 1), and r^(n+1)."""
    slack = 1 - 2 * nu
    below = numpy.maximum(n + slack * (2 * n + 1), _TINY)
    weight = (2 - nu - slack * n) / below
    N = _outer(((n + 1) * (n - 2 + 4 * nu), n + 5 - 4 * nu), (-1 / below, n / below))
    K = (n - 1) * UNIT + _outer((n + 1, -1 + 0 * n), (weight, -n * weight))
    return Wave.of(n, N, K * _twice_shear(young, nu), power=n - 1, alone=1)


def decaying_wave(n: numpy.ndarray, young: float, nu: float) -> Wave:
    """From r^-(n+2), where u = (-n - 1, 1), and r^-n."""
    slack = 1 - 2 * nu
    below = n + 1 + slack * (2 * n + 1)
    weight = (3 * (1 - nu) + slack * n) / below
    N = _outer((-n - 1, 1 + 0 * n), ((n - 4 + 4 * nu) / below, n * (n + 3 - 4 * nu) / below))
    K = -(n + 2) * UNIT + _outer((n, 1 + 0 * n), (weight, (n + 1) * weight))
    return Wave.of(n, N, K * _twice_shear(young, nu), power=n, alone=2)


def _twice_shear(young: float, nu: float) -> float:
    return young / (1 + nu)


@dataclass(frozen=True, kw_only=True, eq=False)
class SupportedLayer:
    """One layer on its ground, A u + B r σ = 0 on its outer surface, for all degrees at once.

    `inner` is its inner radius in mm; thickness in mm and Young's modulus in MPa.
    """

    inner: float
    thickness: float
    young: float
    poisson: float
    n: numpy.ndarray
    ground: tuple[Matrix, Matrix]

    @cached_property
    def _growing(self) -> Wave:
        return growing_wave(self.n, self.young, self.poisson)

    @cached_property
    def _decaying(self) -> Wave:
        return decaying_wave(self.n, self.young, self.poisson)

    @cached_property
    def _way(self) -> float:
        """ln(b/a) of its two radii."""
        return min(log1p(self.thickness / self.inner), _ENDLESS)

    @cached_property
    def _outwards(self) -> Matrix:
        """What is left of the decaying wave at the outer surface."""
        return self._decaying.left(self._way, UNIT)

    @cached_property
    def _solved_ground(self) -> Matrix:
        A, B = self.ground
        return _inverse(A + _times(B, self._growing.K))

    @cached_property
    def _reflected(self) -> Matrix:
        """The growing wave at the outer surface that answers a unit of the decaying one."""
        A, B = self.ground
        return -_times(self._solved_ground, A + _times(B, self._decaying.K))

    @cached_property
    def _echo(self) -> Matrix:
        """The growing wave at the inner surface that answers a unit of the decaying one there."""
        return self._growing.left(self._way, _times(self._reflected, self._outwards))

    @cached_property
    def _sent(self) -> Matrix:
        """The decaying wave at the inner surface, per r σ there."""
        return _inverse(self._decaying.K + _times(self._growing.K, self._echo))

    @cached_property
    def compliance(self) -> Matrix:
        """S, u per r σ on the inner surface."""
        # 1 + echo, which nearly cancels in a thin layer on firm ground: first as if the ground were fixed
        x, yielding = self._way, _times(self.ground[1], self._growing.K - self._decaying.K)
        fixed = self._growing.lost(x) + self._growing.left(x, self._decaying.lost(x))
        more = self._growing.left(x, _times(_times(self._solved_ground, yielding), self._outwards))
        return _times(fixed + more, self._sent)

    @cached_property
    def share(self) -> Matrix:
        """S less that of an infinite layer, which is 1/K-."""
        departure = UNIT - _times(_inverse(self._decaying.K), self._growing.K)
        return _times(departure, _times(self._echo, self._sent))

    def _waves(self, load: Matrix) -> tuple[Matrix, Matrix]:
        """The growing wave at the outer surface and the decaying one at the inner, under r σ on the inner surface."""
        decaying = _times(self._sent, load)
        return _times(self._reflected, _times(self._outwards, decaying)), decaying

    def passed_on(self, load: Matrix) -> Matrix:
        """r σ on the outer surface."""
        growing, decaying = self._waves(load)
        return _times(self._growing.K, growing) + _times(self._decaying.K, _times(self._outwards, decaying))

    def fields(self, load: Matrix, r: numpy.ndarray) -> numpy.ndarray:
        """The seven parts of `Fields` at the radii r, under r σ on the inner surface."""
        growing, decaying = self._waves(load)
        x = numpy.log(r / self.inner)
        grown = self._growing.along(numpy.maximum(self._way - x, 0.0), growing)
        decayed = self._decaying.along(x, decaying)
        (u_r, u_phi), (s_rr, s_rphi) = (a[:, 0] + b[:, 0] for a, b in zip(grown, decayed, strict=True))
        # Hooke: hoop strains (u_r P + u_φ P'')/r and (u_r P + u_φ cot φ P')/r, P'' = -n (n + 1) P - cot φ P'
        nu, bent = self.poisson, (self.n * (self.n + 1))[:, None] * u_phi
        stiff = self.young / (1 - nu**2)
        s_phiphi = nu / (1 - nu) * s_rr + stiff * ((1 + nu) * u_r - bent)
        s_thetatheta = nu / (1 - nu) * s_rr + stiff * ((1 + nu) * u_r - nu * bent)
        stresses = (s_rr, s_rphi, s_phiphi, s_thetatheta, _twice_shear(self.young, nu) * u_phi)
        return numpy.stack([u_r, u_phi, *(s / r for s in stresses)])
