"""Radial foundation with adhesion: its springs detach beyond a critical stretch."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, pi
from typing import ClassVar

from ..contact.roots import increasing_root
from ..core.arrays import Array, broadcast, clip, safe_divisor, sqrt, where
from ..core.checks import check_numeric, require
from ..core.sources import Source
from ..core.validity import SMALL_STRAIN, Range
from ..problem import Joint
from ..problem.gaps import LinearGapRange
from .closed_form import ClosedForm
from .kinematics import MAX_SPRING_REDUCTION, angle_of, linear_displacement, linear_indentation, versine_of
from .modulus import Modulus, as_modulus, hess_forsbach


@dataclass(frozen=True, kw_only=True)
class AdhesiveSocket(ClosedForm):
    """Radial foundation with work of adhesion w: a spring detaches at the stretch u_c = sqrt(2w/K).

    The edge obeys u(ε) = -u_c, so (c + d) cos ε = c - u_c with the paper's linear kinematics. With the adhesion number
    η = u_c/c: below 1 a ball under tension detaches at `pull_off`. From 1 on the full hemisphere adheres without load
    (the bistability of Ciavarella 2018). Derived in the docs (theory).

    Parameters
    ----------
    work_of_adhesion : float or array
        w in N/mm (1 N/mm = 1000 J/m²), zero or more. The default is 0.05 J/m².
    modulus : Modulus
        Foundation modulus.

    Raises
    ------
    ValueError
        A work of adhesion that is negative or not finite.

    References
    ----------
    The two stable states are those of Ciavarella 2018, arXiv 1712.09640; the formulas are derived in the docs (theory).

    Notes
    -----
    Forces may be negative at small indentations, where adhesion holds the ball. A press by force finds the stable state
    for forces of zero or more.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.AdhesiveSocket().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    17.06
    """

    work_of_adhesion: Array = 5e-5
    modulus: Modulus = hess_forsbach

    def __post_init__(self) -> None:
        w = check_numeric("work_of_adhesion", self.work_of_adhesion)
        require("work_of_adhesion", w, (w >= 0) & (w < inf), "a work of adhesion (N/mm) must be 0 or more and finite")
        object.__setattr__(self, "work_of_adhesion", w)
        object.__setattr__(self, "modulus", as_modulus(self.modulus))

    @property
    def parameters(self) -> tuple[Array, ...]:
        """Work of adhesion in N/mm, followed by the constants of the modulus."""
        return (self.work_of_adhesion, *self.modulus.constants)

    name: ClassVar[str] = "adhesive"

    @property
    def title(self) -> str:
        return f"radial springs that adhere (work of adhesion); {self.modulus.title}"

    @property
    def sources(self) -> tuple[Source, ...]:
        return (*self.modulus.sources, Source("ciavarella2018"))

    @property
    def domain(self) -> tuple[Range, ...]:
        return self.modulus.domain

    @property
    def validity(self) -> tuple[Range, ...]:
        """Validity ranges of modulus, gap and strains, and the limit η = 1 of the adhesion number."""
        why = "from 1 on the full hemisphere adheres without load, and the result depends on the rim"
        return (
            *self.modulus.validity,
            Range(quantity=lambda contact: self.adhesion_number(contact.joint), symbol="η", high=1.0, why=why),
            LinearGapRange(high=MAX_SPRING_REDUCTION, why="springs with adhesion have the linear gap alone"),
            SMALL_STRAIN,
        )

    def for_joint(self, joint: Joint) -> AdhesiveSocket:
        return replace(self, modulus=self.modulus.for_joint(joint))

    def critical_stretch(self, joint: Joint) -> Array:
        """Compute the critical stretch u_c = sqrt(2w/K) in mm."""
        return sqrt(2 * self.work_of_adhesion / self.modulus.evaluate(joint))

    def adhesion_number(self, joint: Joint) -> Array:
        """Compute the adhesion number η = u_c/c, the critical stretch over the clearance."""
        c = joint.clearance
        return where(c > 0, self.critical_stretch(joint) / safe_divisor(c), inf)

    def pull_off(self, joint: Joint) -> Array:
        """Compute the pull-off force, the largest tensile contact force, in N (positive); NaN for η of 1 or more.

        -F = π R2² K c [1 - (1 - η)^(2/3) (1 + 2η)^(1/3)], about 2π w R2²/c for small η.
        """
        eta = self.adhesion_number(joint)
        eta = where(eta < 1, eta, float("nan"))
        remainder = 1 - eta * eta * (3 - 2 * eta)
        fraction = eta * eta * (3 - 2 * eta) / (1 + remainder ** (1 / 3) + remainder ** (2 / 3))
        pull = pi * joint.socket_radius**2 * self.modulus.evaluate(joint) * joint.clearance * fraction
        return float(pull) if isinstance(pull, float) else pull

    def _force_factor(self, joint: Joint) -> Array:
        """Compute the force 2π R2² K in N per mm of scaled force."""
        return 2 * pi * joint.socket_radius**2 * self.modulus.evaluate(joint)

    def force(self, joint: Joint, indentation: Array) -> Array:
        return self._force_factor(joint) * _scaled_force(indentation, joint.clearance, self.critical_stretch(joint))

    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        return self._force_factor(joint) * _scaled_stiffness(indentation, joint.clearance, self.critical_stretch(joint))

    def energy(self, joint: Joint, indentation: Array) -> Array:
        """Compute the energy in N mm: elastic energy of the springs less that of adhesion, from d = 0 on."""
        c, d, u = joint.clearance, indentation, self.critical_stretch(joint)
        e = safe_divisor(c + d)
        partial = d * d * (d / e) / 3 - u * u * (d / e) * (1 - 2 * u / (3 * safe_divisor(c)))
        return self._force_factor(joint) / 2 * where(u < c, partial, d * (d - c) / 3)

    def indentation(self, joint: Joint, force: Array) -> Array:
        """Compute the indentation d in mm of a force in N, by a bracketed Newton iteration."""
        # between the springs without adhesion (too stiff) and with the full hemisphere in contact (too compliant);
        # a contact that is small against the clearance has F = π R2² K (d² - u_c²)/c, from which it starts
        R2, c, K = joint.socket_radius, joint.clearance, self.modulus.evaluate(joint)
        low, stretch = linear_indentation(R2, c, K, force), self.critical_stretch(joint)
        scaled = force / self._force_factor(joint)
        high = 3 * scaled + c / 2
        high = where(high > low, high, low)
        start = sqrt(low * low + stretch * stretch)
        ends = low, high, where(start < high, start, high)
        low, high, start = (broadcast(end, *ends) for end in ends)

        def force_and_stiffness(d: Array) -> tuple[Array, Array]:
            return _scaled_force(d, c, stretch), _scaled_stiffness(d, c, stretch)

        return increasing_root(force_and_stiffness, scaled, low, high, start)

    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        return angle_of(_edge_cosine_and_versine(indentation, joint.clearance, self.critical_stretch(joint))[1])

    def indentation_of_half_angle(self, joint: Joint, half_angle: Array) -> Array:
        """Compute the indentation d in mm of a half angle in rad; NaN if it would be negative."""
        versine = versine_of(half_angle)
        d = (joint.clearance * versine - self.critical_stretch(joint)) / (1 - versine)
        return where((d >= 0) & (joint.clearance > 0), d, float("nan"))

    def pole_pressure(self, joint: Joint, indentation: Array) -> Array:
        return self.modulus.evaluate(joint) * indentation

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        return self.modulus.evaluate(joint) + 0.0 * indentation

    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        """Compute the pressure p(φ) in MPa, negative (tension) near the edge and 0 outside the contact."""
        versine = versine_of(angle)
        u = linear_displacement(joint.socket_radius, joint.clearance, indentation, versine)
        _, edge = _edge_cosine_and_versine(indentation, joint.clearance, self.critical_stretch(joint))
        return where(versine <= edge, self.modulus.evaluate(joint) * u, 0.0)


def _edge_cosine_and_versine(d: Array, c: Array, stretch: Array) -> tuple[Array, Array]:
    """Compute cos ε (0 for a full hemisphere) and 1 - cos ε at the edge, with the springs under tension included."""
    e = safe_divisor(c + d)
    return clip((c - stretch) / e, 0.0, 1.0), clip((d + stretch) / e, 0.0, 1.0)


def _scaled_force(d: Array, c: Array, stretch: Array) -> Array:
    """Compute the scaled force F/(2π R2² K) in mm of an adhesive contact."""
    # F/(2π R2² K) = e (1 - k³)/3 - c (1 - k²)/2, with m = 1 - k taken out
    k, m = _edge_cosine_and_versine(d, c, stretch)
    return m * (d * (1 + k) / 2 - (c + d) * m * (1 + 2 * k) / 6)


def _scaled_stiffness(d: Array, c: Array, stretch: Array) -> Array:
    """Compute the scaled stiffness, the derivative of the scaled force by the indentation."""
    # the edge moves: dF/de + dF/dk dk/de
    k, m = _edge_cosine_and_versine(d, c, stretch)
    return m * (1 + k + k * k) / 3 - k * k * stretch / safe_divisor(c + d)
