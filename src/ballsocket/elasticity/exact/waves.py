"""Waves of each pressure mode in the layers of a socket: they grow or decay with r.

In a layer, the displacements (u_r times P_n and u_φ times dP_n/dφ) and the tractions (r σ_rr and r σ_rφ) of the mode n
are sums of four powers of r. The two that grow with r make up one wave, the two that decay another. Either wave is
known from its two displacements u at one radius. With κ < 1 the ratio to another radius and h = (1 - κ²)/2,

    r^(n+1), r^(n-1):       u further inwards is κ^(n-1) (1 - h N+) u,     r σ = K+ u,
    r^-n, r^-(n+2):         u further outwards is κ^n (1 - h N-) u,        r σ = K- u,

where the 2×2 matrices N and K are rational in n. No power ever grows, and K+ and K- stay distinct at any degree and
thickness. Each layer, from the outermost inwards, turns the condition on its outer surface into u = S r σ on its
inner one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import expm1, log1p

import numpy

Matrix = numpy.ndarray
"""2×2 matrices for each degree, shape (2, 2, degrees); a pair of displacements or tractions is (2, 1, degrees)."""

_MAX_LOG_RATIO = 100.0  # ln(b/R2) of a layer that counts as infinite
_MIN_DENOMINATOR = 1e-17  # for an incompressible layer at n = 0, which is rigid
UNIT: Matrix = numpy.eye(2)[:, :, None]  # unit matrix for all degrees


def _matmul(a: Matrix, b: Matrix) -> Matrix:
    return a[:, :1] * b[:1] + a[:, 1:] * b[1:]


def _inverse(a: Matrix) -> Matrix:
    return numpy.array([[a[1, 1], -a[0, 1]], [-a[1, 0], a[0, 0]]]) / (a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0])


def _outer_product(column: tuple[numpy.ndarray, ...], row: tuple[numpy.ndarray, ...]) -> Matrix:
    return numpy.array(column)[:, None] * numpy.array(row)


def free_surface_condition(n: numpy.ndarray) -> tuple[Matrix, Matrix]:
    """Return the boundary condition σ = 0 of a free surface as matrices A and B of A u + B r σ = 0.

    At n = 1 the condition is u_r + 2 u_φ = 0 (no mean translation) and σ_rr = σ_rφ (uniform traction).
    """
    A = numpy.zeros((2, 2, len(n)))
    B = A + UNIT  # a unit matrix for each degree
    first = n == 1
    A[0, :, first], B[0, :, first], B[1, :, first] = (1.0, 2.0), (0.0, 0.0), (1.0, -1.0)
    return A, B


@dataclass(frozen=True, kw_only=True, eq=False)
class Wave:
    """Part of a mode in a layer: the two powers of r that grow outwards, or the two that decay.

    `N` and `K` are the matrices of the module docstring, `power` is n - 1 or n.
    """

    N: Matrix
    K: Matrix
    power: numpy.ndarray

    @classmethod
    def from_matrices(cls, n: numpy.ndarray, N: Matrix, K: Matrix, power: numpy.ndarray, single_power: int) -> Wave:
        """Make a wave from its matrices; degree n = 0 has the single power ±`single_power`."""
        # n = 0 has one power of r and no u_φ: the unused entries must not mix with u_r, nor be singular
        zero = n == 0
        N[:, :, zero], K[1, 0, zero], K[1, 1, zero] = 0.0, 0.0, K[0, 0, zero]
        return cls(N=N, K=K, power=numpy.where(zero, single_power, power))

    def propagate(self, x: float | numpy.ndarray, u: Matrix) -> Matrix:
        """Compute the displacements of a wave after its decay from u over a logarithmic distance x of radii."""
        return numpy.exp(-self.power * x) * (u + numpy.expm1(-2 * x) / 2 * _matmul(self.N, u))

    def decay_deficit(self, x: float) -> Matrix:
        """Compute the unit matrix minus the decay over the logarithmic distance x, without cancellation."""
        decay = self.power * x
        return -numpy.expm1(-decay) * UNIT - expm1(-2 * x) / 2 * numpy.exp(-decay) * self.N

    def evaluate_fields(self, x: numpy.ndarray, u: Matrix) -> tuple[Matrix, Matrix]:
        """Compute displacements and tractions r σ at several logarithmic distances x, on a new last axis."""
        wave = Wave(N=self.N[..., None], K=self.K[..., None], power=self.power[:, None])
        displacements = wave.propagate(x, u[..., None])
        return displacements, _matmul(wave.K, displacements)


@dataclass(frozen=True, kw_only=True, eq=False)
class SupportedLayer:
    """Elastic layer with the boundary condition A u + B r σ = 0 on its outer surface, for all degrees.

    `inner` is its inner radius in mm; thickness in mm and Young's modulus in MPa.
    """

    inner: float
    thickness: float
    young: float
    poisson: float
    n: numpy.ndarray
    condition: tuple[Matrix, Matrix]

    @cached_property
    def _growing_wave(self) -> Wave:
        """Wave of r^(n-1) and r^(n+1), which grow outwards; r^(n-1) has the displacements u = (n, 1)."""
        n, nu, compressibility = self.n, self.poisson, 1 - 2 * self.poisson
        denominator = numpy.maximum(n + compressibility * (2 * n + 1), _MIN_DENOMINATOR)
        weight = (2 - nu - compressibility * n) / denominator
        N = _outer_product(((n + 1) * (n - 2 + 4 * nu), n + 5 - 4 * nu), (-1 / denominator, n / denominator))
        K = (n - 1) * UNIT + _outer_product((n + 1, -1 + 0 * n), (weight, -n * weight))
        return Wave.from_matrices(n, N, K * (self.young / (1 + nu)), power=n - 1, single_power=1)

    @cached_property
    def _decaying_wave(self) -> Wave:
        """Wave of r^-(n+2) and r^-n, which decay outwards; r^-(n+2) has the displacements u = (-n - 1, 1)."""
        n, nu, compressibility = self.n, self.poisson, 1 - 2 * self.poisson
        denominator = n + 1 + compressibility * (2 * n + 1)
        weight = (3 * (1 - nu) + compressibility * n) / denominator
        N = _outer_product((-n - 1, 1 + 0 * n), ((n - 4 + 4 * nu) / denominator, n * (n + 3 - 4 * nu) / denominator))
        K = -(n + 2) * UNIT + _outer_product((n, 1 + 0 * n), (weight, (n + 1) * weight))
        return Wave.from_matrices(n, N, K * (self.young / (1 + nu)), power=n, single_power=2)

    @cached_property
    def _log_ratio(self) -> float:
        """Logarithm ln(b/a) of the ratio of outer and inner radius."""
        return min(log1p(self.thickness / self.inner), _MAX_LOG_RATIO)

    @cached_property
    def _transmission(self) -> Matrix:
        """Decaying wave at the outer surface, per unit of decaying wave at the inner surface."""
        return self._decaying_wave.propagate(self._log_ratio, UNIT)

    @cached_property
    def _condition_inverse(self) -> Matrix:
        """Inverse matrix of the outer boundary condition, applied to the growing wave."""
        A, B = self.condition
        return _inverse(A + _matmul(B, self._growing_wave.K))

    @cached_property
    def _outer_reflection(self) -> Matrix:
        """Reflection at the outer surface: growing wave per unit of the decaying wave there."""
        A, B = self.condition
        return -_matmul(self._condition_inverse, A + _matmul(B, self._decaying_wave.K))

    @cached_property
    def _inner_reflection(self) -> Matrix:
        """Reflection at the inner surface: growing wave per unit of the decaying wave there."""
        return self._growing_wave.propagate(self._log_ratio, _matmul(self._outer_reflection, self._transmission))

    @cached_property
    def _traction_response(self) -> Matrix:
        """Decaying wave at the inner surface, per unit of the traction r σ there."""
        return _inverse(self._decaying_wave.K + _matmul(self._growing_wave.K, self._inner_reflection))

    @cached_property
    def compliance(self) -> Matrix:
        """Compliance matrix S of the layer: displacements u per traction r σ on the inner surface."""
        # 1 + reflection nearly cancels in a thin layer on a stiff backing: first as if the outer surface were fixed
        x = self._log_ratio
        growing, decaying = self._growing_wave, self._decaying_wave
        fixed_term = growing.decay_deficit(x) + growing.propagate(x, decaying.decay_deficit(x))
        backing = _matmul(self._condition_inverse, _matmul(self.condition[1], growing.K - decaying.K))
        backing_term = growing.propagate(x, _matmul(backing, self._transmission))
        return _matmul(fixed_term + backing_term, self._traction_response)

    @cached_property
    def layer_correction(self) -> Matrix:
        """Compliance matrix S of the layer minus that of an infinite layer, the inverse of K-."""
        departure = UNIT - _matmul(_inverse(self._decaying_wave.K), self._growing_wave.K)
        return _matmul(departure, _matmul(self._inner_reflection, self._traction_response))

    def _wave_amplitudes(self, traction: Matrix) -> tuple[Matrix, Matrix]:
        """Compute the growing wave outside and the decaying wave inside from the traction r σ on the inner surface."""
        decaying = _matmul(self._traction_response, traction)
        return _matmul(self._outer_reflection, _matmul(self._transmission, decaying)), decaying

    def outer_traction(self, traction: Matrix) -> Matrix:
        """Compute the traction r σ on the outer surface from that on the inner surface."""
        growing, decaying = self._wave_amplitudes(traction)
        transmitted = _matmul(self._transmission, decaying)
        return _matmul(self._growing_wave.K, growing) + _matmul(self._decaying_wave.K, transmitted)

    def fields(self, traction: Matrix, r: numpy.ndarray) -> numpy.ndarray:
        """Compute displacements and stresses at radii r (mm) from the traction r σ on the inner surface.

        The rows are the seven components of `Fields`.
        """
        growing, decaying = self._wave_amplitudes(traction)
        x = numpy.log(r / self.inner)
        grown = self._growing_wave.evaluate_fields(numpy.maximum(self._log_ratio - x, 0.0), growing)
        inward = self._decaying_wave.evaluate_fields(x, decaying)
        (u_r, u_phi), (s_rr, s_rphi) = (a[:, 0] + b[:, 0] for a, b in zip(grown, inward, strict=True))
        # Hooke: hoop strains (u_r P + u_φ P'')/r and (u_r P + u_φ cot φ P')/r, P'' = -n (n + 1) P - cot φ P'
        nu, bent = self.poisson, (self.n * (self.n + 1))[:, None] * u_phi
        stiff = self.young / (1 - nu**2)
        s_phiphi = nu / (1 - nu) * s_rr + stiff * ((1 + nu) * u_r - bent)
        s_thetatheta = nu / (1 - nu) * s_rr + stiff * ((1 + nu) * u_r - nu * bent)
        stresses = (s_rr, s_rphi, s_phiphi, s_thetatheta, self.young / (1 + nu) * u_phi)
        return numpy.stack([u_r, u_phi, *(s / r for s in stresses)])
