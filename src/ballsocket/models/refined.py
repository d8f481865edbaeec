"""Refined model: a rigid ball in a bonded liner in closed form, from the liner's compliance at four wavelengths."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import inf, nan, pi
from typing import ClassVar

from ..contact import Model
from ..contact.assembly import SolverResult
from ..contact.closed_sphere import HEMISPHERE_NOTE
from ..core import arrays
from ..core.arrays import Array, broadcast, clip, integral, safe_divisor, sin, where
from ..core.lazy import cached_property
from ..core.sources import Source
from ..core.validity import RIGID_BACKING, RIGID_BALL, SMALL_STRAIN, Promise, Range, Status
from ..problem import Joint
from ..problem.gaps import LINEAR_GAP, LINEAR_GAP_REMARK
from .liner_compliance import Liner, liner_coefficients
from .refined_inverse import MAX_HALF_ANGLE, flatten_like, solve_contact
from .refined_state import ScaledContact, peak_position, pressure_ratio, scaled_contact, shape_coefficient


@dataclass(frozen=True, kw_only=True)
class Refined(Model):
    """Refined foundation model, with a modulus from the liner's modal compliance and a compliant edge.

    cos ε = (c + λ d)/(c + d), p0 = K d, p = p0 sqrt(1 - y)(1 + β y), y = sin²(φ/2)/sin²(ε/2). K, λ and the force
    come from the compliance of the bonded liner at four wavelengths; 23 numbers are fitted to the exact solution (see
    the docs, refined). λ = 0 is Eq. (8) of the paper, K is that of Eq. (16).

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, for the problem; the formulas are derived in the docs (refined).

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.Refined().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    17.02
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
        Range(quantity="joint.liner.poisson", low=0.0, high=0.46, why="the fit is worse for incompressible liners"),
        Range(
            quantity="width_ratio",
            low=0.5,
            high=8.0,
            why="a narrower contact hardly feels the liner's backing, and a wider one is beyond the fit",
        ),
        Range(
            quantity=lambda contact: contact.joint.modulus_ratio * contact.width_ratio,
            symbol="(E/E_ball) a/L",
            high=0.01,
            why="the ball is assumed rigid, and gives way as the contact widens on a thin liner",
        ),
        RIGID_BALL,
        RIGID_BACKING,
        LINEAR_GAP,
        SMALL_STRAIN,
    )
    remarks: ClassVar[tuple[Range, ...]] = (LINEAR_GAP_REMARK, HEMISPHERE_NOTE)

    promise: ClassVar[Promise] = Promise(within=0.02)

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        """Solve contacts for given forces, indentations or half angles."""
        if kind == "half_angle":
            edge = _mask_half_angle(joint, load)
            return make_solver_result(RefinedSolution(joint=joint, edge=edge), kind, load, 0.0 * edge)
        scaled = scaled_load(joint, kind, load)
        if type(scaled) is not float and arrays.is_jax_array(scaled) and arrays.all_true(scaled == scaled) is None:
            edge, shift, *state = _solve_in_jax_blocks(joint, kind, scaled)
        else:
            edge, shift, *state = solve_contact(kind, scaled, _joint_liner(joint), joint.thickness_ratio)
        solution = RefinedSolution(joint=joint, edge=where(load > 0, edge, 0.0 * load), state=ScaledContact(*state))
        return make_solver_result(solution, kind, load, shift)


@dataclass(frozen=True, kw_only=True, eq=False)
class RefinedSolution:
    """Solution of the refined model at a half angle, with the quantities of a `Contact`.

    `edge` is the half angle in rad: 0 without load, NaN without a solution. `state` is the contact at that half angle,
    if it is known; its derivatives are those at an angle whose relative difference is below 1e-6.
    """

    joint: Joint
    edge: Array
    state: ScaledContact | None = None

    @cached_property
    def _joint_liner(self) -> Liner:
        """Compliance coefficients of the liner."""
        return _joint_liner(self.joint)

    @cached_property
    def _scaled_contact(self) -> ScaledContact:
        """Dimensionless contact quantities at the half angle, with their derivatives there."""
        return scaled_contact(safe_divisor(self.edge), self._joint_liner)

    @property
    def _contact_values(self) -> ScaledContact:
        """Dimensionless contact quantities at the half angle, without their derivatives."""
        return self._scaled_contact if self.state is None else self.state

    def _zero_without_load(self, value: Array) -> Array:
        """Replace values of contacts without load by 0."""
        return where(self.edge > 0, value, 0.0 * self.edge)

    @property
    def _secant_stiffness(self) -> Array:
        """Secant stiffness F/d in N/mm."""
        return self.joint.liner.young * self.joint.socket_radius * self._contact_values.secant

    def force_and_indentation(self, kind: str, load: Array) -> tuple[Array, Array]:
        """Compute the force F in N and the indentation d in mm from the applied load.

        The applied load is returned unchanged.
        """
        if kind == "force":
            d = load / self._secant_stiffness
            return self._zero_without_load(load), self._zero_without_load(d)
        d = load if kind == "indentation" else self.joint.clearance * self._contact_values.indentation
        return self._zero_without_load(d * self._secant_stiffness), self._zero_without_load(d)

    @property
    def half_angle(self) -> Array:
        return self.edge

    @property
    def indentation(self) -> Array:
        """Indentation d in mm."""
        return self._zero_without_load(self.joint.clearance * self._contact_values.indentation)

    @cached_property
    def stiffness(self) -> Array:
        """Tangent stiffness dF/dd in N/mm."""
        return self._zero_without_load(
            self._secant_stiffness * (1 + self._scaled_contact.secant_rate / self._scaled_contact.indentation_rate)
        )

    @cached_property
    def energy(self) -> Array:
        """Elastic energy in N mm, integrated over the half angle."""
        # ∫ F (dd/dε) dε; the points are dense near the edge, where d increases fast
        edge = safe_divisor(self.edge)
        rate = self._scaled_contact.indentation_rate / edge
        width = arrays.log(1 + rate * edge)

        def work_rate(x: float) -> Array:
            """Compute the scaled work per unit of x, a coordinate that is dense near the edge."""
            growth = arrays.exp(width * x)
            angle = edge - (growth - 1) / rate
            contact = scaled_contact(angle, self._joint_liner)
            return contact.secant * contact.indentation**2 * contact.indentation_rate / angle * (growth * width / rate)

        scale = self.joint.liner.young * self.joint.socket_radius * self.joint.clearance**2
        return self._zero_without_load(scale * integral(work_rate, 24))

    @property
    def _modulus(self) -> Array:
        """Foundation modulus K = p0/d in MPa/mm."""
        return self.joint.liner.young / (self.joint.socket_radius * self._contact_values.compliance)

    @property
    def foundation_modulus(self) -> Array:
        return where(self.edge == 0, inf, where(self.edge > 0, self._modulus, nan))

    @cached_property
    def pole_pressure(self) -> Array:
        return self._zero_without_load(self._modulus * self.indentation)

    @property
    def _peak_position(self) -> Array:
        """Position y = sin²(φ/2)/sin²(ε/2) of the largest pressure."""
        return peak_position(self._shape_coefficient)

    @cached_property
    def max_pressure(self) -> Array:
        return self.pole_pressure * pressure_ratio(self._peak_position, self._shape_coefficient)

    @property
    def max_pressure_angle(self) -> Array:
        return self._zero_without_load(2 * arrays.asin(arrays.sqrt(self._peak_position * self._squared_sine)))

    @property
    def _squared_sine(self) -> Array:
        """Squared sine sin²(ε/2), with the half angle ε of the contact."""
        return sin(safe_divisor(self.edge) / 2) ** 2

    @cached_property
    def _shape_coefficient(self) -> Array:
        """Shape coefficient β of the pressure profile."""
        return shape_coefficient(self._contact_values)

    @cached_property
    def pressure_integral(self) -> Array:
        ring = 4 * pi * self.joint.socket_radius**2 * self._squared_sine
        return ring * self.pole_pressure * (2 / 3 + 4 * self._shape_coefficient / 15)

    def pressure(self, angle: Array) -> Array:
        y = sin(clip(angle, -pi, pi) / 2) ** 2 / self._squared_sine
        ratio = pressure_ratio(y, self._shape_coefficient)
        return where(y < 1, self.pole_pressure * ratio, self._zero_without_load(0.0 * y))


def _solve_in_jax_blocks(joint: Joint, kind: str, scaled: Array) -> tuple[Array, ...]:
    """Solve contacts inside `jax.jit` for dimensionless loads of the shape of all contacts, block by block."""

    def solve_block(poisson: Array, ratio: Array, load: Array) -> tuple[Array, ...]:
        """Solve the contacts of one block."""
        return solve_contact(kind, load, liner_coefficients(poisson, 1 + 1 / ratio), ratio)

    rows = [flatten_like(number, scaled) for number in (joint.liner.poisson, joint.thickness_ratio, scaled)]
    values = arrays.map_jax_blocks(solve_block, rows, len(ScaledContact._fields))
    return tuple(value.reshape(scaled.shape) for value in values)


def _mask_half_angle(joint: Joint, half_angle: Array) -> Array:
    """Return the half angle in rad, replaced by NaN beyond the largest one that the model solves."""
    edge = broadcast(half_angle, half_angle, *joint.numbers())
    d = RefinedSolution(joint=joint, edge=edge)._scaled_contact.indentation
    return where((edge == 0) | ((edge <= MAX_HALF_ANGLE) & (d > 0)), edge, nan)


def scaled_load(joint: Joint, kind: str, load: Array) -> Array:
    """Compute the dimensionless load F/(E R2 c) or d/c; a zero load is replaced by a positive number."""
    scale = joint.clearance * (joint.liner.young * joint.socket_radius if kind == "force" else 1.0)
    return broadcast(safe_divisor(load) / scale, load, *joint.numbers())


def make_solver_result(solution: RefinedSolution, kind: str, load: Array, shift: Array) -> SolverResult:
    """Make the solver result of solved contacts, with a check of their last relative change of the half angle."""
    force, indentation = solution.force_and_indentation(kind, load)
    converged = (shift * shift <= square_tolerance(load)) | (solution.edge == 0)
    return SolverResult(
        laws=solution,
        force=force,
        indentation=indentation,
        failures={Status.NOT_CONVERGED: arrays.logical_not(converged)},
    )


def square_tolerance(load: Array) -> float:
    """Return the largest square of the last relative change of ε; the error left by the change is of that order."""
    return 1e4 * arrays.machine_epsilon(load)


def _joint_liner(joint: Joint) -> Liner:
    """Return the compliance coefficients of a joint's liner."""
    nu, b = joint.liner.poisson, 1 + joint.liner_thickness / joint.socket_radius
    return _liner_of_numbers(nu, b) if type(nu) is float and type(b) is float else liner_coefficients(nu, b)


@lru_cache(maxsize=256)
def _liner_of_numbers(nu: float, b: float) -> Liner:
    """Compute the compliance coefficients of a liner from plain numbers, cached for further loads."""
    return liner_coefficients(nu, b)
