"""Rigid ball on a plane elastic layer bonded to a rigid base: a numerical solution, exact for the plane problem."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import ceil, inf, pi, radians
from typing import ClassVar

import numpy

from ..contact import Model
from ..contact.assembly import SolverResult
from ..contact.roots import increasing_root
from ..core import arrays
from ..core.arrays import (
    Array,
    broadcast,
    clip,
    cos,
    exp,
    gauss_legendre,
    integral,
    log,
    safe_divisor,
    sin,
    sqrt,
    where,
)
from ..core.lazy import cached_property
from ..core.sources import Source
from ..core.validity import RIGID_BACKING, RIGID_BALL, SMALL_STRAIN, Promise, Range, Status
from ..problem import Joint

MAX_THICKNESS_RATIO = 100.0  # largest R2/L of the quadrature


@dataclass(frozen=True, kw_only=True)
class PlaneLayer(Model):
    """Jin's (2000) model of a ball in a socket: a paraboloid of R* = R1 R2/c on a plane layer of liner thickness.

    In Abel space the layer's Hankel kernel 2(1 - ν²)/E Φ(kL)/k gives an integral equation of the second kind for H(t)
    on [0, a]. It is solved with Gauss-Legendre points (see the docs, theory):

        (π/2) H(t) + ∫ H(s) ∫ [Φ(kL) - 1] cos kt cos ks dk ds = (d - t²/R*) E / (2(1 - ν²)),   H(a) = 0.

    Half angles are arcs, ε = a/R2.

    References
    ----------
    Jin 2000, Proc. IMechE H 214, 425.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.PlaneLayer().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    12.71
    """

    seconds_a_press: ClassVar[float] = 2e-3
    name: ClassVar[str] = "plane-layer"
    title: ClassVar[str] = "rigid ball on a plane layer bonded to a rigid base (numerical)"
    sources: ClassVar[tuple[Source, ...]] = (Source("jin2000"),)
    planar: ClassVar[bool] = True
    domain: ClassVar[tuple[Range, ...]] = (
        Range(quantity="joint.clearance", low=0.0, why="the effective radius R1 R2/c is infinite without clearance"),
        Range(
            quantity="joint.liner_thickness",
            low=0.0,
            high=inf,
            why="a layer of infinite thickness is a half-space: use hertz",
        ),
        Range(
            quantity="joint.thickness_ratio",
            high=MAX_THICKNESS_RATIO,
            why="the layer is too thin for the quadrature: use bonded-layer",
        ),
    )
    validity: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity="half_angle",
            high=radians(15.0),
            why="the plane layer has no curvature: p0 is 23 % low at 45° (R2 18, L 6.75)",
        ),
        Range(
            quantity="joint.thickness_ratio",
            low=0.5,
            why="curvature is neglected: d is up to 20 % too large in a liner thicker than twice its radius",
        ),
        RIGID_BALL,
        RIGID_BACKING,
        SMALL_STRAIN,
    )

    promise: ClassVar[Promise] = Promise(within=0.15)

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        solution = _solve_width(joint, kind, load)
        force, indentation = solution.force_and_indentation
        reached = indentation if kind == "indentation" else force
        residual = 0.0 * reached if kind == "half_angle" else arrays.namespace(reached).abs(reached - load)
        return SolverResult(
            laws=solution,
            force=force,
            indentation=indentation,
            failures={Status.NOT_CONVERGED: ~(residual <= 1e5 * arrays.machine_epsilon(reached) * load)},
        )


def kernel_deviation(x: Array, poisson: Array) -> Array:
    """Compute the kernel Φ(x) - 1 of a bonded layer, the deviation of its response from that of a half-space.

    Φ = [2 k0 sinh 2x - 4x]/[2 k0 cosh 2x + 1 + k0² + 4x²], k0 = 3 - 4ν, and x is the wave number times L.
    """
    k0 = 3 - 4 * poisson
    decay = exp(-2 * x)
    denominator = k0 * (1 + decay * decay) + (1 + k0 * k0 + 4 * x * x) * decay
    return -decay * (2 * k0 * decay + (1 + 2 * x) ** 2 + k0 * k0) / denominator


@dataclass(frozen=True, kw_only=True, eq=False)
class LayerSolution:
    """Solution of the plane layer at the contact width α = a/L, with the quantities of a `Contact`.

    The scaled solution is H = (a²/(R* C)) (δ h1 - h2), with δ = d R*/a² and C = 2(1 - ν²)/E.

    h1 and h2 solve for the right-hand sides 1 and x², x = t/a. The quadrature is accurate for widths up to `widest`. A
    `Contact` delegates its quantities to this class.
    """

    joint: Joint
    width: Array
    widest: float

    @cached_property
    def _quadrature_points(self) -> tuple[Array, Array, Array, Array]:
        """Points and weights in the radius x and the wave number k L, as arrays of the caller's library."""
        like = {"dtype": self.width.dtype, "device": arrays.device(self.width)}
        return tuple(arrays.namespace(self.width).asarray(part, **like) for part in _quadrature(self.widest))

    @cached_property
    def _weighted_kernel(self) -> Array:
        """Kernel Φ - 1 at the quadrature points of the wave number, times their weights."""
        _, _, k, wk = self._quadrature_points
        return kernel_deviation(k, self.joint.liner.poisson[..., None]) * wk

    @cached_property
    def _solution_integrals(self) -> tuple[Array, Array, Array, Array]:
        """Integrals of both solutions h1 and h2 (last axis): cosine transform, edge value, mean and second moment.

        The transform is ∫ h cos(k x α) dx, the edge value h(1), the mean ∫ h dx and the second moment ∫ h x² dx.

        They are computed in blocks, since the waves of all contacts together may exceed the memory.
        """
        xp = arrays.namespace(self.width)
        x, _, k, _ = self._quadrature_points
        kernel = arrays.broadcast_to(self._weighted_kernel, (*self.width.shape, k.shape[0]))
        flat_width, flat_kernel = xp.reshape(self.width, (-1,)), xp.reshape(kernel, (-1, k.shape[0]))
        count, size = flat_width.shape[0], max(1, _BLOCK // (k.shape[0] * x.shape[0]))
        spans = [slice(first, min(first + size, count)) for first in range(0, max(count, 1), size)]
        blocks = [self._solve_contact_block(flat_width[span], flat_kernel[span, :]) for span in spans]
        joined = (xp.concat(part, axis=0) if len(blocks) > 1 else part[0] for part in zip(*blocks, strict=True))
        transform, edge, mean, second = (xp.reshape(part, (*self.width.shape, *part.shape[1:])) for part in joined)
        return transform, edge, mean, second

    def _solve_contact_block(self, width: Array, kernel: Array) -> tuple[Array, Array, Array, Array]:
        """Solve the integral equations of a block of contacts; return the arrays of `_solution_integrals`."""
        xp = arrays.namespace(width)
        x, wx, k, _ = self._quadrature_points
        alpha = width[:, None, None]
        waves = cos(k[:, None] * x * alpha)
        # integral equations at the quadrature points (Nyström's method)
        matrix = alpha * (xp.matrix_transpose(waves) @ (kernel[..., None] * waves)) * wx
        matrix = matrix + pi / 2 * xp.eye(x.shape[0], dtype=width.dtype, device=arrays.device(width))
        right_sides = xp.stack([xp.ones_like(x), x * x], axis=-1)
        h = xp.linalg.solve(matrix, arrays.broadcast_to(right_sides, (*matrix.shape[:-1], 2)))
        weighted = wx[:, None] * h
        transform = waves @ weighted
        edge_wave = cos(k * width[:, None])
        edge = (1 - width[:, None] * xp.sum((kernel * edge_wave)[..., None] * transform, axis=-2)) * (2 / pi)
        return transform, edge, xp.sum(weighted, axis=-2), xp.sum((x * x)[:, None] * weighted, axis=-2)

    @cached_property
    def _scaled_indentation(self) -> Array:
        """Scaled indentation δ = d R*/a²."""
        edge = self._solution_integrals[1]
        return edge[..., 1] / edge[..., 0]

    @property
    def _effective_radius(self) -> Array:
        return self.joint.ball_radius * self.joint.socket_radius / self.joint.clearance

    @property
    def _contact_radius(self) -> Array:
        return self.width * self.joint.liner_thickness

    @property
    def _compliance(self) -> Array:
        """Plane compliance C = 2(1 - ν²)/E in 1/MPa."""
        return 2 * (1 - self.joint.liner.poisson**2) / self.joint.liner.young

    def _pressure_density(self, x: Array) -> Array:
        """Compute the dimensionless pressure density -H'(x)/x at the relative radius x; 4/π on a half-space.

        It has the unit a²/(R* C). The pressure is the integral of -H'(x) over the radius.
        """
        xp = arrays.namespace(self.width)
        kernel, k, transform = self._weighted_kernel, self._quadrature_points[2], self._solution_integrals[0]
        wave = k * self.width[..., None]
        phase = wave * x[..., None]
        sinc = where(phase > 1e-4, sin(phase) / safe_divisor(phase), 1 - phase * phase / 6)
        mix = transform[..., 1] - self._scaled_indentation[..., None] * transform[..., 0]
        total = xp.sum(kernel * wave * wave * sinc * mix, axis=-1)
        return (2 / pi) * (2 + self.width * total)

    @cached_property
    def force_and_indentation(self) -> tuple[Array, Array]:
        """Force F in N and indentation d in mm."""
        mean = self._solution_integrals[2]
        delta, a = self._scaled_indentation, self._contact_radius
        force = 2 * pi * a**3 / (self._compliance * self._effective_radius) * (delta * mean[..., 0] - mean[..., 1])
        return force, delta * a * a / self._effective_radius

    @cached_property
    def radius_derivatives(self) -> tuple[Array, Array]:
        """Derivatives of force (N/mm) and of indentation by the contact radius a: dF/da and dd/da."""
        steep = self._pressure_density(self.width**0)
        deepening = self._contact_radius / self._effective_radius * steep / self._solution_integrals[1][..., 0]
        return self.stiffness * deepening, deepening

    @property
    def half_angle(self) -> Array:
        return self._contact_radius / self.joint.socket_radius

    @property
    def stiffness(self) -> Array:
        return 2 * pi * self._contact_radius * self._solution_integrals[2][..., 0] / self._compliance

    @property
    def energy(self) -> Array:
        """Elastic energy in N mm, half of ∫ p (d - r²/2R*) dA."""
        second, delta, a = self._solution_integrals[3], self._scaled_indentation, self._contact_radius
        force, d = self.force_and_indentation
        moment = 4 * pi * a**5 / (self._compliance * self._effective_radius) * (delta * second[..., 0] - second[..., 1])
        return (d * force - moment / (2 * self._effective_radius)) / 2

    @cached_property
    def pole_pressure(self) -> Array:
        return self.pressure(0.0)

    @property
    def max_pressure(self) -> Array:
        return self.pole_pressure

    @property
    def max_pressure_angle(self) -> Array:
        return 0.0 * self.width

    @property
    def foundation_modulus(self) -> Array:
        d = self.force_and_indentation[1]
        return where(self.width == 0, inf, self.pole_pressure / safe_divisor(d))

    @property
    def pressure_integral(self) -> Array:
        return self.force_and_indentation[0]

    def pressure(self, angle: Array) -> Array:
        # ∫ -H'(s)/sqrt(s² - r²) ds over r..a, with s² = r² + (a² - r²) y²
        position = angle * self.joint.socket_radius / safe_divisor(self._contact_radius)
        remainder = clip(1 - position * position, 0.0, 1.0)
        total = integral(lambda y: self._pressure_density(sqrt(position * position + remainder * y * y)), 32)
        scale = self._contact_radius / (self._effective_radius * self._compliance)
        return where(position < 1, scale * sqrt(remainder) * total, 0.0)


_BLOCK = 4_000_000  # numbers in a block of waves: 32 MB


TRACED_WIDTH = 8.0  # largest a/L in a call inside `jax.jit` or `jax.grad`; wider contacts are NaN


@cache
def _quadrature(widest: float) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    """Compute points and weights along the radius (0 to 1) and in k L, accurate to 1e-10 up to a width a/L."""
    x, wx = map(numpy.array, gauss_legendre(20 + 4 * ceil(widest)))
    k, wk = map(numpy.array, gauss_legendre(60 + 14 * ceil(widest)))
    return x, wx, 22 * k, 22 * wk  # Φ - 1 is below 1e-16 beyond k L = 22


_POWERS = {"force": (8.0, 3.4, 2.0), "indentation": (4.0, 1.6, 0.8)}
"""Bounds and estimate of the power of the width in the loads: first and last, and second."""


def _solve_width(joint: Joint, kind: str, load: Array) -> LayerSolution:
    """Solve for the contact width α = a/L at a load; NaN where the half angle would exceed π/2.

    `kind` is "force", "indentation" or "half_angle", for a load in N, mm or rad.
    """
    shape = (load, *joint.numbers())
    widest = broadcast(pi / 2 * clip(joint.thickness_ratio, 0.0, MAX_THICKNESS_RATIO), *shape)
    if arrays.concrete_values(widest) is None:
        widest = clip(widest, 0.0, TRACED_WIDTH)
    quadrature_width = _quadrature_width(widest)
    if kind == "half_angle":
        width = broadcast(load * joint.thickness_ratio, *shape)
        width = where(width <= widest, width, float("nan"))
        return LayerSolution(joint=joint, width=width, widest=quadrature_width)
    index = 0 if kind == "force" else 1
    log_load = log(broadcast(safe_divisor(load), *shape))

    def negative_log_load(narrowing: Array, quadrature_width: float) -> tuple[Array, Array]:
        """Compute -ln(load) and its slope at a width `widest` exp(-narrowing)."""
        width = widest * exp(-narrowing)
        solution = LayerSolution(joint=joint, width=width, widest=quadrature_width)
        value, slope = solution.force_and_indentation[index], solution.radius_derivatives[index]
        return -log(value), slope * width * joint.liner_thickness / value

    # logarithm of the ratio of the load at the widest contact to this load
    log_ratio = -log_load - negative_log_load(0.0 * log_load, quadrature_width)[0]
    # the load is about a power of the width: bounds and estimate of ln(widest/width)
    lower, estimate, upper = (clip(log_ratio, 0.0, inf) / power for power in _POWERS[kind])
    quadrature_width = _quadrature_width(widest * exp(-lower))
    root = increasing_root(
        lambda narrowing: negative_log_load(narrowing, quadrature_width), -log_load, lower, upper, estimate, steps=24
    )
    width = where(log_ratio >= 0, widest * exp(-root), float("nan"))
    return LayerSolution(joint=joint, width=where(load > 0, width, 0.0), widest=quadrature_width)


def _quadrature_width(width: Array) -> float:
    """Return the largest width a/L as the accuracy range of a quadrature; a constant inside a traced call."""
    widths = arrays.concrete_values(width)
    return TRACED_WIDTH if widths is None else float(ceil(numpy.max(widths, initial=0.0, where=numpy.isfinite(widths))))
