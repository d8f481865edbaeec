"""A rigid ball in a bonded liner, closed: the liner's own compliance, read at four wavelengths of the contact."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from math import inf, log, nan, pi, radians
from typing import ClassVar, NamedTuple

from .. import arrays
from ..arrays import Array, broadcast, clip, divisor, integral, sin, where
from ..joint import Joint
from ..model import Answer, Model
from ..sources import Source
from ..validity import RIGID_BACKING, SMALL_STRAIN, Promise, Range, Status
from .dual_numbers import Dual
from .liner_compliance import compliance

WIDEST = radians(85.0)
"""The largest half angle that is answered."""

_FITTED = "fitted there, with a rigid ball"


@dataclass(frozen=True, kw_only=True)
class Refined(Model):
    """The paper's model with the liner's own modes in place of a fitted modulus, and an edge that gives way.

    cos ε = (c + λ d)/(c + d), p0 = K d, p = p0 sqrt(1 - y)(1 + β y), y = sin²(φ/2)/sin²(ε/2). K, λ and the force
    come from the compliance of the bonded liner at four wavelengths; 23 numbers are fitted to the exact answer (see
    the docs, refined). λ = 0 is Eq. (8) of the paper, K is that of Eq. (16).

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, for the problem; the formulas are derived in the docs (refined).
    """

    seconds_a_press: ClassVar[float] = 3e-5
    name: ClassVar[str] = "refined"
    title: ClassVar[str] = "closed form from the liner's own compliance, 23 coefficients"
    sources: ClassVar[tuple[Source, ...]] = (Source("hess2021", "(8), (16)"),)
    domain: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity="joint.clearance",
            symbol="c",
            low=0.0,
            why="without clearance every load gives the same half angle: ask cosine-limit",
        ),
        Range(
            quantity="joint.liner_thickness",
            symbol="L",
            low=0.0,
            high=inf,
            why="a layer of infinite thickness has no modes of its own: ask hertz or exact",
        ),
        Range(
            quantity="joint.thickness_ratio",
            symbol="R2/L",
            high=100.0,
            why="a layer so thin is lost to rounding: ask bonded-layer",
        ),
    )
    validity: ClassVar[tuple[Range, ...]] = (
        Range(quantity="joint.liner.poisson", symbol="ν", low=0.3, high=0.46, why=_FITTED),
        Range(quantity="joint.thickness_ratio", symbol="R2/L", low=1.0, high=6.5, why=_FITTED),
        Range(quantity="half_angle", symbol="ε", low=radians(15.0), high=radians(60.0), why=_FITTED),
        Range(
            quantity="joint.modulus_ratio",
            symbol="E/E_ball",
            high=0.0045,
            why="the model takes the ball as rigid, and is so close that softer ones show",
        ),
        RIGID_BACKING,
        SMALL_STRAIN,
    )

    promise: ClassVar[Promise] = Promise(within=0.02)

    def _solve(self, joint: Joint, kind: str, load: Array) -> Answer:
        edge = _given(joint, load) if kind == "half_angle" else _found(joint, kind, load)
        solution = RefinedSolution(joint=joint, edge=edge)
        force, indentation = solution.loads(kind, load)
        return Answer(
            laws=solution,
            force=force,
            indentation=indentation,
            failures={Status.NOT_CONVERGED: ~(solution.miss(indentation) <= 1e5 * arrays.rounding(load))},
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class RefinedSolution:
    """The contact at the half angle `edge` (0: no load, NaN: no answer), as the `Laws` of the contact it belongs to."""

    joint: Joint
    edge: Array

    @cached_property
    def _state(self) -> State:
        return state(self.joint, divisor(self.edge))

    def _or_zero(self, value: Array) -> Array:
        return where(self.edge > 0, value, 0.0 * self.edge)

    @property
    def _secant(self) -> Array:
        """F/d in N/mm."""
        return self.joint.liner.young * self.joint.socket_radius * self._state.secant.value

    def loads(self, kind: str, load: Array) -> tuple[Array, Array]:
        """F and d, from the one that was given if one was."""
        if kind == "force":
            d = load / self._secant
            return self._or_zero(load), self._or_zero(d)
        d = load if kind == "indentation" else self.joint.clearance * self._state.indentation.value
        return self._or_zero(d * self._secant), self._or_zero(d)

    def miss(self, indentation: Array) -> Array:
        """By how much of itself the half angle misses an indentation."""
        d = self._state.indentation
        wrong = arrays.namespace(self.edge).abs(d.value - indentation / self.joint.clearance) / d.slope
        return where(self.edge > 0, wrong, 0.0)

    @property
    def half_angle(self) -> Array:
        return self.edge

    @property
    def indentation(self) -> Array:
        """d in mm."""
        return self._or_zero(self.joint.clearance * self._state.indentation.value)

    @cached_property
    def stiffness(self) -> Array:
        d, secant = self._state.indentation, self._state.secant
        relative = secant.slope / secant.value * (d.value / d.slope)
        return self._or_zero(self._secant * (1 + relative))

    @cached_property
    def energy(self) -> Array:
        # ∫ F (dd/dε) dε; the points crowd towards the edge as fast as d grows there
        edge, d = divisor(self.edge), self._state.indentation
        rate = d.slope / (d.value * edge)
        width = arrays.log(1 + rate * edge)

        def work(x: float) -> Array:
            far = arrays.exp(width * x)
            angle = edge - (far - 1) / rate
            at = state(self.joint, angle)
            return at.secant.value * at.indentation.value * at.indentation.slope / angle * (far * width / rate)

        scale = self.joint.liner.young * self.joint.socket_radius * self.joint.clearance**2
        return self._or_zero(scale * integral(work, 24))

    @property
    def _modulus(self) -> Array:
        """K = p0/d in MPa/mm."""
        return self.joint.liner.young / (self.joint.socket_radius * self._state.compliance.value)

    @property
    def foundation_modulus(self) -> Array:
        return where(self.edge == 0, inf, where(self.edge > 0, self._modulus, nan))

    @cached_property
    def pole_pressure(self) -> Array:
        return self._or_zero(self._modulus * self.indentation)

    @property
    def _ring(self) -> Array:
        """y of the largest pressure: 0 at the pole unless the profile swells towards the edge, β > 1/2."""
        fullness = self._fullness
        return where(fullness > 0.5, (2 * fullness - 1) / where(fullness > 0.5, 3 * fullness, 1.0), 0.0)

    @property
    def max_pressure(self) -> Array:
        return self.pole_pressure * self._profile(self._ring)

    @property
    def max_pressure_angle(self) -> Array:
        return self._or_zero(2 * arrays.asin(arrays.sqrt(self._ring * self._edge_share)))

    @property
    def _edge_share(self) -> Array:
        """sin²(ε/2)."""
        return sin(divisor(self.edge) / 2) ** 2

    @cached_property
    def _fullness(self) -> Array:
        """β of the profile, from 2π R2² ∫ p cos φ sin φ dφ = F."""
        S = self._edge_share
        mean = self._state.secant.value * self._state.compliance.value / (4 * pi * S)
        return (mean - 2 / 3 + 8 * S / 15) / (4 / 15 - 32 * S / 105)

    @cached_property
    def pressure_integral(self) -> Array:
        ring = 4 * pi * self.joint.socket_radius**2 * self._edge_share
        return ring * self.pole_pressure * (2 / 3 + 4 * self._fullness / 15)

    def _profile(self, y: Array) -> Array:
        """p/p0 at y up to 1."""
        return arrays.sqrt(clip(1 - y, 0.0, 1.0)) * (1 + self._fullness * y)

    def pressure(self, angle: Array) -> Array:
        y = sin(clip(angle, -pi, pi) / 2) ** 2 / self._edge_share
        return where(y < 1, self.pole_pressure * self._profile(y), self._or_zero(0.0 * y))


class State(NamedTuple):
    """A contact of half angle ε in scaled numbers, with their slopes."""

    share: Dual
    """S = sin²(ε/2)."""
    gap: Dual
    """cos ε - λ: 0 where the fit is perfect, d infinite."""
    compliance: Dual
    """χ = d E/(p0 R2)."""
    secant: Dual
    """F/(E R2 d)."""

    @property
    def indentation(self) -> Dual:
        """d/c, from cos ε = (c + λ d)/(c + d)."""
        return 2 * self.share / self.gap


def state(joint: Joint, half_angle: Array) -> State:
    """The model itself: what belongs to a half angle ε > 0."""
    k = _waves(half_angle) / half_angle
    log_c = compliance(Dual(k, -k), joint.liner.poisson, 1 + joint.liner_thickness / joint.socket_radius).log()
    S = Dual(sin(half_angle / 2) ** 2, half_angle * sin(half_angle) / 2)
    chi, edge, m = _shape([Dual(log_c.value[i, ...], log_c.slope[i, ...]) for i in range(4)], S)
    force = 4 * pi * S * (1 - 2 * S / (m + 2)) / (m + 1)  # of p0 (1 - y)^m, over p0 R2²
    return State(share=S, gap=1 - 2 * S - edge, compliance=chi, secant=force / chi)


def _waves(like: Array) -> Array:
    """The four wave numbers times the half angle, along an axis before those of `like`."""
    xp = arrays.namespace(like)
    waves = xp.asarray(coefficients()["waves"], dtype=like.dtype, device=arrays.device(like))
    return xp.reshape(waves, (-1, *(1 for _ in like.shape)))


def _shape(log_c: Sequence[Dual], S: Dual) -> tuple[Dual, Dual, Dual]:
    """χ, λ = u(ε)/d and the pressure's exponent m from ln c at the four waves.

    Where c ~ k^-s they are those of a plane bed, exactly: d/p0 = c(k) k^s 2^-s Γ(1 - s/2) Γ(2 - s/2), λ = s/2,
    m = 1 - s/2. The fitted terms vanish without the bends v, w of ln c over ln k and the curvature S = sin²(ε/2).
    """
    fit = coefficients()
    k = fit["waves"]
    s, s2, s3 = ((log_c[i] - log_c[i + 1]) / log(k[i + 1] / k[i]) for i in range(3))
    v, w = s2 - s, s3 - s2
    gamma = log(k[1] / 1.8515) * s + 0.3199 * s * s + 0.0543 * s * s * s
    level = _sum(fit["level"], (v * v, s * v, s * w * w, v * S))
    edge = _sum(fit["edge"], (w, v, s * v, s * w, w * S, S, v * v * S, v * v * w, s * S, s * v * S))
    exponent = _sum(fit["exponent"], (w, v, w * w * S, s * S, s * v * S))
    return (log_c[1] + gamma + level).exp(), s / 2 + edge, 1 - s / 2 + exponent


def _sum(factors: Sequence[float], terms: Sequence[Dual]) -> Dual:
    """The fitted part of a formula."""
    return sum((factor * term for factor, term in zip(factors[1:], terms[1:], strict=True)), factors[0] * terms[0])


@cache
def coefficients() -> dict[str, list[float]]:
    """The fitted numbers (`data/refined.toml`)."""
    return tomllib.loads((files("ballsocket") / "data" / "refined.toml").read_text(encoding="utf-8"))


def _given(joint: Joint, half_angle: Array) -> Array:
    """The half angle as it was given, NaN where it is too wide."""
    edge = broadcast(half_angle, half_angle, *joint.numbers())
    d = state(joint, divisor(edge)).indentation.value
    return where((edge == 0) | ((edge <= WIDEST) & (d > 0)), edge, nan)


def _found(joint: Joint, kind: str, given: Array) -> Array:
    """The half angle that belongs to F or d, NaN where it is too wide.

    Solved for ln x/(1 + x), x = d/c or F/(E R2 c), which passes through the perfect fit without a pole.
    """
    by_force = kind == "force"
    scale = joint.clearance * (joint.liner.young * joint.socket_radius if by_force else 1.0)
    load = broadcast(divisor(given) / scale, given, *joint.numbers())

    def law(log_angle: Array) -> tuple[Array, Array]:
        at = state(joint, arrays.exp(log_angle))
        rise = 2 * at.share * (at.secant if by_force else 1.0)  # the load is rise/gap
        value = (rise / (rise + at.gap)).log()
        return value.value, value.slope

    # F ~ ε³ and d ~ ε² as in Hertz, but never wide
    start = arrays.log(load / (2.5 + load / 3)) / 3 if by_force else arrays.log(load / (1 + load / 2)) / 2
    high = 0.0 * start + log(WIDEST)
    most = law(high)[0]
    goal = arrays.log(load / (1 + load))
    root = arrays.increasing_root(law, where(goal < most, goal, most), start - 6.0, high, start)
    edge = where(goal < most, arrays.exp(root), nan)
    return where(given > 0, edge, 0.0 * given)
