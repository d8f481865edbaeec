"""Rigid ball in a bonded liner in closed form, from the liner's compliance at four wavelengths of the contact."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf, nan, pi, radians
from typing import ClassVar

from ..contact import Model
from ..contact.assembly import SolverResult
from ..contact.closed_sphere import HEMISPHERE_NOTE
from ..core import arrays
from ..core.arrays import Array, broadcast, clip, integral, safe_divisor, sin, where
from ..core.sources import Source
from ..core.validity import RIGID_BACKING, SMALL_STRAIN, Promise, Range, Remark, Status
from ..problem import Joint
from .liner_compliance import Liner, liner_of
from .refined_state import MAX_HALF_ANGLE, ScaledContact, edge_of_force, edge_of_indentation, scaled_contact

_FITTED = "fitted in this range with a rigid ball"


@dataclass(frozen=True, kw_only=True)
class Refined(Model):
    """The paper's model with the liner's modes in place of a fitted modulus, and with a compliant edge.

    cos ε = (c + λ d)/(c + d), p0 = K d, p = p0 sqrt(1 - y)(1 + β y), y = sin²(φ/2)/sin²(ε/2). K, λ and the force
    come from the compliance of the bonded liner at four wavelengths; 23 numbers are fitted to the exact solution (see
    the docs, refined). λ = 0 is Eq. (8) of the paper, K is that of Eq. (16).

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, for the problem; the formulas are derived in the docs (refined).
    """

    seconds_a_press: ClassVar[float] = 4e-6
    accepts_floats: ClassVar[bool] = True
    name: ClassVar[str] = "refined"
    title: ClassVar[str] = "closed form from the liner's own compliance, 23 coefficients"
    sources: ClassVar[tuple[Source, ...]] = (Source("hess2021", "(8), (16)"),)
    domain: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity="joint.clearance",
            low=0.0,
            why="without clearance every load gives the same half angle: use cosine-limit",
        ),
        Range(
            quantity="joint.liner_thickness",
            low=0.0,
            high=inf,
            why="a layer of infinite thickness has no layer modes: use hertz or exact",
        ),
        Range(
            quantity="joint.thickness_ratio",
            high=100.0,
            why="rounding errors are too large for so thin a layer: use bonded-layer",
        ),
    )
    validity: ClassVar[tuple[Range, ...]] = (
        Range(quantity="joint.liner.poisson", low=0.3, high=0.46, why=_FITTED),
        Range(quantity="joint.thickness_ratio", low=1.0, high=6.5, why=_FITTED),
        Range(quantity="half_angle", low=radians(15.0), high=radians(60.0), why=_FITTED),
        Range(
            quantity="joint.modulus_ratio",
            high=0.0045,
            why="the ball is assumed rigid, and softer balls exceed the model's error",
        ),
        RIGID_BACKING,
        SMALL_STRAIN,
    )
    remarks: ClassVar[tuple[Remark, ...]] = (HEMISPHERE_NOTE,)

    promise: ClassVar[Promise] = Promise(within=0.02)

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        edge = _limit_half_angle(joint, load) if kind == "half_angle" else _solve_edge(joint, kind, load)
        return make_solver_result(RefinedSolution(joint=joint, edge=edge), kind, load)


@dataclass(frozen=True, kw_only=True, eq=False)
class RefinedSolution:
    """Solution at the half angle `edge` (0: no load, NaN: no solution), with the quantities of a `Contact`."""

    joint: Joint
    edge: Array

    @cached_property
    def _liner(self) -> Liner:
        """Coefficients of the liner."""
        return _liner(self.joint)

    @cached_property
    def _scaled_contact(self) -> ScaledContact:
        """Scaled contact at the half angle."""
        return scaled_contact(safe_divisor(self.edge), self._liner)

    def _or_zero(self, value: Array) -> Array:
        """Replace values without load by 0."""
        return where(self.edge > 0, value, 0.0 * self.edge)

    @property
    def _secant(self) -> Array:
        """Secant stiffness F/d in N/mm."""
        return self.joint.liner.young * self.joint.socket_radius * self._scaled_contact.secant

    def loads(self, kind: str, load: Array) -> tuple[Array, Array]:
        """Compute F and d; the applied one is returned unchanged."""
        if kind == "force":
            d = load / self._secant
            return self._or_zero(load), self._or_zero(d)
        d = load if kind == "indentation" else self.joint.clearance * self._scaled_contact.indentation
        return self._or_zero(d * self._secant), self._or_zero(d)

    def relative_residual(self, indentation: Array) -> Array:
        """Compute the relative error of the half angle for an indentation."""
        d = self._scaled_contact.indentation
        error = abs(1 - indentation / (self.joint.clearance * d)) / self._scaled_contact.indentation_rate
        return where(self.edge > 0, error, 0.0)

    @property
    def half_angle(self) -> Array:
        return self.edge

    @property
    def indentation(self) -> Array:
        """Indentation d in mm."""
        return self._or_zero(self.joint.clearance * self._scaled_contact.indentation)

    @cached_property
    def stiffness(self) -> Array:
        return self._or_zero(
            self._secant * (1 + self._scaled_contact.secant_rate / self._scaled_contact.indentation_rate)
        )

    @cached_property
    def energy(self) -> Array:
        # ∫ F (dd/dε) dε; the points are dense near the edge, where d increases fast
        edge = safe_divisor(self.edge)
        rate = self._scaled_contact.indentation_rate / edge
        width = arrays.log(1 + rate * edge)

        def work(x: float) -> Array:
            growth = arrays.exp(width * x)
            angle = edge - (growth - 1) / rate
            contact = scaled_contact(angle, self._liner)
            return contact.secant * contact.indentation**2 * contact.indentation_rate / angle * (growth * width / rate)

        scale = self.joint.liner.young * self.joint.socket_radius * self.joint.clearance**2
        return self._or_zero(scale * integral(work, 24))

    @property
    def _modulus(self) -> Array:
        """Foundation modulus K = p0/d in MPa/mm."""
        return self.joint.liner.young / (self.joint.socket_radius * self._scaled_contact.compliance)

    @property
    def foundation_modulus(self) -> Array:
        return where(self.edge == 0, inf, where(self.edge > 0, self._modulus, nan))

    @cached_property
    def pole_pressure(self) -> Array:
        return self._or_zero(self._modulus * self.indentation)

    @property
    def _peak_position(self) -> Array:
        """Position y of the largest pressure: 0, the pole, for β up to 1/2."""
        fullness = self._fullness
        return where(fullness > 0.5, (2 * fullness - 1) / where(fullness > 0.5, 3 * fullness, 1.0), 0.0)

    @property
    def max_pressure(self) -> Array:
        return self.pole_pressure * self._profile(self._peak_position)

    @property
    def max_pressure_angle(self) -> Array:
        return self._or_zero(2 * arrays.asin(arrays.sqrt(self._peak_position * self._edge_share)))

    @property
    def _edge_share(self) -> Array:
        """Value sin²(ε/2)."""
        return sin(safe_divisor(self.edge) / 2) ** 2

    @cached_property
    def _fullness(self) -> Array:
        """Coefficient β of the profile, from 2π R2² ∫ p cos φ sin φ dφ = F."""
        S = self._edge_share
        mean = self._scaled_contact.secant * self._scaled_contact.compliance / (4 * pi * S)
        return (mean - 2 / 3 + 8 * S / 15) / (4 / 15 - 32 * S / 105)

    @cached_property
    def pressure_integral(self) -> Array:
        ring = 4 * pi * self.joint.socket_radius**2 * self._edge_share
        return ring * self.pole_pressure * (2 / 3 + 4 * self._fullness / 15)

    def _profile(self, y: Array) -> Array:
        """Compute p/p0 at y up to 1."""
        return arrays.sqrt(clip(1 - y, 0.0, 1.0)) * (1 + self._fullness * y)

    def pressure(self, angle: Array) -> Array:
        y = sin(clip(angle, -pi, pi) / 2) ** 2 / self._edge_share
        return where(y < 1, self.pole_pressure * self._profile(y), self._or_zero(0.0 * y))


def _limit_half_angle(joint: Joint, half_angle: Array) -> Array:
    """Return the half angle, NaN beyond the largest one."""
    edge = broadcast(half_angle, half_angle, *joint.numbers())
    d = RefinedSolution(joint=joint, edge=edge)._scaled_contact.indentation
    return where((edge == 0) | ((edge <= MAX_HALF_ANGLE) & (d > 0)), edge, nan)


def _solve_edge(joint: Joint, kind: str, load: Array) -> Array:
    """Solve for the half angle of F or d, NaN beyond the largest one."""
    find = edge_of_force if kind == "force" else edge_of_indentation
    return where(load > 0, find(scaled_load(joint, kind, load), _liner(joint)), 0.0 * load)


def scaled_load(joint: Joint, kind: str, load: Array) -> Array:
    """Compute F/(E R2 c) or d/c, with a positive value in place of no load."""
    scale = joint.clearance * (joint.liner.young * joint.socket_radius if kind == "force" else 1.0)
    return broadcast(safe_divisor(load) / scale, load, *joint.numbers())


def make_solver_result(solution: RefinedSolution, kind: str, load: Array) -> SolverResult:
    """Make the `SolverResult` of a refined solution for loads of one kind; mark points that have not converged."""
    force, indentation = solution.loads(kind, load)
    return SolverResult(
        laws=solution,
        force=force,
        indentation=indentation,
        failures={
            Status.NOT_CONVERGED: arrays.logical_not(
                solution.relative_residual(indentation) <= 1e5 * arrays.machine_epsilon(load)
            )
        },
    )


def _liner(joint: Joint) -> Liner:
    """Return the liner coefficients of a joint."""
    nu, b = joint.liner.poisson, 1 + joint.liner_thickness / joint.socket_radius
    return _liner_of_numbers(nu, b) if type(nu) is float and type(b) is float else liner_of(nu, b)


@lru_cache(maxsize=256)
def _liner_of_numbers(nu: float, b: float) -> Liner:
    """Compute liner coefficients of plain numbers, cached for further loads."""
    return liner_of(nu, b)
