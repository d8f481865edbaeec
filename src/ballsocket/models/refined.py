"""Refined model: a rigid ball in a bonded liner in closed form, from the liner's compliance at four wavelengths."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.resources import files
from math import inf, nan, pi
from typing import ClassVar, NamedTuple

from ..contact import Model
from ..contact.assembly import SolverResult
from ..contact.closed_sphere import HEMISPHERE_NOTE
from ..contact.coordinates import LIMIT
from ..contact.roots import increasing_root
from ..core import arrays
from ..core.arrays import Array, broadcast, clip, exp, integral, log, safe_divisor, sin, sqrt, weighted_sum, where
from ..core.lazy import cached_property
from ..core.sources import Source
from ..core.validity import RIGID_BACKING, RIGID_BALL, SMALL_STRAIN, Promise, Range, Status
from ..problem import Joint
from ..problem.gaps import LINEAR_GAP, LINEAR_GAP_REMARK
from .liner_compliance import Liner, Pair, liner_coefficients, log_compliance, log_compliance_any_wave


@dataclass(frozen=True, kw_only=True)
class Refined(Model):
    """Refined foundation model, with a modulus from the liner's modal compliance and a compliant edge.

    cos ε = (c + λ d)/(c + d), p0 = K d, p = p0 sqrt(1 - y)(1 + β y), y = sin²(φ/2)/sin²(ε/2). K, λ and the force
    come from the compliance of the bonded liner at four wavelengths; 23 numbers are fitted to the exact solution (see
    the docs, refined). λ = 0 is Eq. (8) of the paper, K is that of Eq. (16). `Tabulated` is more accurate and faster.

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

    seconds_a_press: ClassVar[float] = 6e-6
    is_closed_sphere: ClassVar[bool] = True
    accepts_floats: ClassVar[bool] = True
    has_curve: ClassVar[bool] = True
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
        c, spring = joint.clearance, joint.liner.young * joint.socket_radius
        liner, numbers = _joint_liner(joint), (load, *joint.numbers())
        if kind == "half_angle":
            edge = broadcast(load, *numbers)
            contact = scaled_contact(safe_divisor(edge), liner)
            edge = where((edge == 0) | ((edge > 0) & (edge <= LIMIT) & (contact.gap[0] > 0)), edge, nan)
            indentation, residual = c * contact.indentation, 0.0 * edge
        else:
            scaled_load = broadcast(safe_divisor(load) / (c * spring if kind == "force" else c), *numbers)
            edge = _solve_half_angle(kind, scaled_load, liner)
            contact = scaled_contact(safe_divisor(edge), liner)
            residual = log_load_ratio(kind, contact, scaled_load)[0]
            edge = where(load > 0, edge, where(load < 0, nan, 0.0 * load))
            indentation = load / (spring * contact.secant[0]) if kind == "force" else load
        is_loaded = edge > 0  # the half angle is NaN without a solution
        indentation = where(is_loaded, indentation, 0.0 * edge)
        diverged = is_loaded & (abs(residual) > arrays.machine_epsilon(load) ** 0.75)
        return SolverResult(
            laws=RefinedSolution(joint=joint, half_angle=edge, indentation=indentation, scaled=contact),
            force=where(is_loaded, load if kind == "force" else spring * contact.secant[0] * indentation, 0.0 * edge),
            indentation=indentation,
            failures={Status.NOT_CONVERGED: diverged},
        )


def _joint_liner(joint: Joint) -> Liner:
    return liner_coefficients(joint.liner.poisson, 1 + joint.liner_thickness / joint.socket_radius)


def _solve_half_angle(kind: str, load: Array, liner: Liner) -> Array:
    """Solve for the half angle ε in rad of a load F/(E R2 c) or d/c; NaN beyond the largest one."""
    end = -1.0  # the unknown is ln(ε/LIMIT) - 1, away from zero, to which the relative step refers

    def residual(x: Array) -> Pair:
        return log_load_ratio(kind, scaled_contact(LIMIT * exp(x - end), liner), load)

    # about ε³ = q/(2.5 + q/3) for a force q, and ε² = x/(2/3 + 2x/3) for an indentation x
    power, small, large = (3.0, 2.5, 1 / 3) if kind == "force" else (2.0, 2 / 3, 2 / 3)
    start = log(load / (small + large * load)) / power - log(LIMIT) + end
    root = increasing_root(residual, 0.0 * start, start - 6.0, 0.0 * start + end, where(start < end, start, end))
    return where(root < end, LIMIT * exp(root - end), nan)


def log_load_ratio(kind: str, contact: ScaledContact, load: Array) -> Pair:
    """Compute ln x/(1 + x), x = d/c, less its value under a load F/(E R2 c) or d/c, and its slope by ln ε."""
    # x is infinite at the perfect fit, x/(1 + x) is not
    (S, S_slope), (gap, gap_slope) = contact.share, contact.gap
    stiffness, rate = contact.secant if kind == "force" else (1.0, 0.0)
    total = 2 * S + gap
    value = log(2 * S / total * (1 + stiffness / load))
    return value, (S_slope / S * gap - gap_slope) / total + rate * stiffness / (stiffness + load)


FIT: dict[str, list[float]] = tomllib.loads((files("ballsocket") / "data" / "refined.toml").read_text("utf-8"))


class ScaledContact(NamedTuple):
    """Dimensionless contact of half angle ε; slopes are derivatives by ln ε."""

    share: Pair  # S = sin²(ε/2) and its slope
    gap: Pair  # cos ε - λ and its slope; it is 0 at the perfect fit, where d is infinite
    compliance: Array  # scaled compliance χ = d E/(p0 R2)
    secant: Pair  # scaled secant stiffness F/(E R2 d), and the slope of its logarithm

    @property
    def indentation(self) -> Array:
        """Indentation d/c, from cos ε = (c + λ d)/(c + d)."""
        return 2 * self.share[0] / self.gap[0]

    @property
    def indentation_rate(self) -> Array:
        """Slope of ln d."""
        return self.share[1] / self.share[0] - self.gap[1] / self.gap[0]


def scaled_contact(half_angle: Array, liner: Liner, fit: dict[str, list[float]] = FIT) -> ScaledContact:
    """Compute the dimensionless contact at a half angle ε > 0 in rad.

    χ, λ = u(ε)/d and the pressure's exponent m come from ln c at four waves. Where c ~ k^-s they equal those of a plane
    layer exactly: d/p0 = c(k) k^s 2^-s Γ(1 - s/2) Γ(2 - s/2), λ = s/2, m = 1 - s/2. The fitted terms vanish without the
    bends v, w of ln c over ln k and the curvature S = sin²(ε/2). Names such as `sv` are products. Every quantity is a
    pair with its slope by ln ε.
    """
    k1, k2, k3, k4 = fit["waves"]
    longest = log_compliance_any_wave(k1 / half_angle, liner)  # only this wave may come near q = 1
    others = (log_compliance(k / half_angle, liner) for k in (k2, k3, k4))
    c1, c2, c3, c4 = ((value, -rise) for value, rise in (longest, *others))  # k = k_i/ε; `rise` is the slope by ln k
    s, s2, s3 = _descent(c1, c2, log(k2 / k1)), _descent(c2, c3, log(k3 / k2)), _descent(c3, c4, log(k4 / k3))
    v, w = _descent(s2, s, 1.0), _descent(s3, s2, 1.0)
    S = (sin(half_angle / 2) ** 2, half_angle * sin(half_angle) / 2)
    ss, sv, sw, vv, ww, sS, vS, wS = map(_product, (s, s, s, v, w, s, v, w), (s, v, w, v, w, S, S, S))
    scale, square, cube = fit["plane"]
    level_terms = c2, s, ss, _product(s, ss), vv, sv, _product(s, ww), vS
    level, level_slope = _sum((1.0, log(k2 / scale), square, cube, *fit["level"]), level_terms)
    svS, vvS, vvw, wwS = map(_product, (sv, vv, vv, ww), (S, S, w, S))
    edge, edge_slope = _sum((0.5, *fit["edge"]), (s, w, v, sv, sw, wS, S, vvS, vvw, sS, svS))
    bend, m_slope = _sum((-0.5, *fit["exponent"]), (s, w, v, wwS, sS, svS))
    m, chi = 1 + bend, exp(level)
    deficit = 2 * S[0] / (m + 2)  # F = 4π R2² S p0 (1 - deficit)/(m + 1), the vertical force of p0 (1 - y)^m
    deficit_slope = (2 * S[1] - deficit * m_slope) / (m + 2)
    secant = 4 * pi * S[0] * (1 - deficit) / ((m + 1) * chi)
    secant_rate = S[1] / S[0] - deficit_slope / (1 - deficit) - m_slope / (m + 1) - level_slope
    gap = (1 - 2 * S[0] - edge, -2 * S[1] - edge_slope)
    return ScaledContact(share=S, gap=gap, compliance=chi, secant=(secant, secant_rate))


def _descent(first: Pair, second: Pair, span: float) -> Pair:
    return (first[0] - second[0]) / span, (first[1] - second[1]) / span


def _product(first: Pair, second: Pair) -> Pair:
    return first[0] * second[0], first[1] * second[0] + first[0] * second[1]


def _sum(coefficients: tuple[float, ...], terms: tuple[Pair, ...]) -> Pair:
    values, slopes = zip(*terms, strict=True)
    return weighted_sum(values, coefficients), weighted_sum(slopes, coefficients)


@dataclass(frozen=True, kw_only=True, eq=False)
class RefinedSolution:
    """Solution of the refined model at a half angle, with the quantities of a `Contact`.

    The half angle in rad is 0 without load, NaN without a solution. The indentation is in mm.
    """

    joint: Joint
    half_angle: Array
    indentation: Array
    scaled: ScaledContact

    def _zero_without_load(self, value: Array) -> Array:
        return where(self.half_angle > 0, value, 0.0 * self.half_angle)

    @cached_property
    def stiffness(self) -> Array:
        """Tangent stiffness dF/dd in N/mm."""
        secant, rate = self.scaled.secant
        growth = 1 + rate / self.scaled.indentation_rate
        return self._zero_without_load(self.joint.liner.young * self.joint.socket_radius * secant * growth)

    @cached_property
    def energy(self) -> Array:
        """Elastic energy ∫ F (dd/dε) dε in N mm; the points are dense near the edge, where d increases fast."""
        edge, liner = safe_divisor(self.half_angle), _joint_liner(self.joint)
        rate = self.scaled.indentation_rate / edge
        width = log(1 + rate * edge)

        def work_rate(x: float) -> Array:
            growth = exp(width * x)
            angle = edge - (growth - 1) / rate
            contact = scaled_contact(angle, liner)
            force = contact.secant[0] * contact.indentation
            return force * contact.indentation * contact.indentation_rate / angle * (growth * width / rate)

        scale = self.joint.liner.young * self.joint.socket_radius * self.joint.clearance**2
        return self._zero_without_load(scale * integral(work_rate, 24))

    @property
    def foundation_modulus(self) -> Array:
        K = self.joint.liner.young / (self.joint.socket_radius * self.scaled.compliance)
        return where(self.half_angle == 0, inf, K + 0.0 * self.half_angle)

    @cached_property
    def pole_pressure(self) -> Array:
        scale = self.joint.liner.young / self.joint.socket_radius
        return self._zero_without_load(scale * self.indentation / self.scaled.compliance)

    @cached_property
    def _shape_coefficient(self) -> Array:
        """Shape coefficient β of the pressure profile, whose vertical force 2π R2² ∫ p cos φ sin φ dφ is F."""
        contact, S = self.scaled, self.scaled.share[0]
        mean = contact.secant[0] * contact.compliance / (4 * pi * S)
        return (mean - 2 / 3 + 8 * S / 15) / (4 / 15 - 32 * S / 105)

    @property
    def _peak_position(self) -> Array:
        """Position y = sin²(φ/2)/sin²(ε/2) of the largest pressure: 0, the pole, for β up to 1/2."""
        beta = self._shape_coefficient
        return where(beta > 0.5, (2 * beta - 1) / where(beta > 0.5, 3 * beta, 1.0), 0.0)

    def _pressure_ratio(self, y: Array) -> Array:
        """Compute p/p0 at the position y = sin²(φ/2)/sin²(ε/2), 0 to 1."""
        return sqrt(clip(1 - y, 0.0, 1.0)) * (1 + self._shape_coefficient * y)

    @cached_property
    def max_pressure(self) -> Array:
        return self.pole_pressure * self._pressure_ratio(self._peak_position)

    @property
    def max_pressure_angle(self) -> Array:
        return self._zero_without_load(2 * arrays.asin(sqrt(self._peak_position * self.scaled.share[0])))

    @cached_property
    def pressure_integral(self) -> Array:
        ring = 4 * pi * self.joint.socket_radius**2 * self.scaled.share[0]
        return ring * self.pole_pressure * (2 / 3 + 4 * self._shape_coefficient / 15)

    def pressure(self, angle: Array) -> Array:
        y = sin(clip(angle, -pi, pi) / 2) ** 2 / self.scaled.share[0]
        return where(y < 1, self.pole_pressure * self._pressure_ratio(y), self._zero_without_load(0.0 * y))
