"""A rigid ball in a bonded liner, closed: the liner's own compliance, read at four wavelengths of the contact."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from math import factorial, inf, log, nan, pi, radians
from typing import NamedTuple

from .. import arrays
from ..arrays import Array, broadcast, clip, divisor, integral, sin, where
from ..joint import Joint
from ..sources import Source
from ..validity import RIGID_BACKING, RIGID_BALL, SMALL_STRAIN, Range
from .base import Answer, Model

WIDEST = radians(85.0)
"""The largest half angle that is answered."""


@dataclass(frozen=True, kw_only=True)
class Refined(Model):
    """The paper's model with the liner's own modes in place of a fitted modulus, and an edge that gives way.

    cos ε = (c + λ d)/(c + d), p0 = K d, p = p0 sqrt(1 - y)(1 + β y), y = sin²(φ/2)/sin²(ε/2). K, λ and the force
    come from the compliance of the bonded liner at four wavelengths; 23 numbers are fitted to the exact answer (see
    the docs, refined). λ = 0 is Eq. (8) of the paper, K is that of Eq. (16).

    References
    ----------
    Heß & Forsbach 2021, Appl. Sci. 11, 11170, for the problem; the formulas are derived in the docs.
    """

    @property
    def name(self) -> str:
        return "refined"

    @property
    def title(self) -> str:
        return "closed form from the liner's own compliance, 23 coefficients"

    @property
    def sources(self) -> tuple[Source, ...]:
        return (Source("hess2021", "(8), (16)"),)

    @property
    def domain(self) -> tuple[Range, ...]:
        fit = "without clearance every load gives the same half angle: ask cosine-limit"
        massive = "a layer of infinite thickness has no modes of its own: ask hertz or exact"
        thin = "a layer so thin is lost to rounding: ask bonded-layer"
        return (
            Range(quantity="joint.clearance", symbol="c", low=0.0, why=fit),
            Range(quantity="joint.liner_thickness", symbol="L", low=0.0, high=inf, why=massive),
            Range(quantity="joint.thickness_ratio", symbol="R2/L", high=100.0, why=thin),
        )

    @property
    def validity(self) -> tuple[Range, ...]:
        why = "fitted there: within 1 % of the exact answer"
        return (
            Range(quantity="joint.liner.poisson", symbol="ν", low=0.3, high=0.48, why=why),
            Range(quantity="joint.thickness_ratio", symbol="R2/L", low=1.0, high=6.5, why=why),
            Range(quantity="half_angle", symbol="ε", low=radians(15.0), high=radians(60.0), why=why),
            RIGID_BALL,
            RIGID_BACKING,
            SMALL_STRAIN,
        )

    def _solve(self, joint: Joint, kind: str, load: Array) -> Answer:
        edge = _given(joint, load) if kind == "half_angle" else _found(joint, kind, load)
        solution = RefinedSolution(joint=joint, edge=edge)
        force, indentation = solution.loads(kind, load)
        return Answer(
            laws=solution,
            force=force,
            indentation=indentation,
            converged=solution.miss(indentation) <= 1e5 * arrays.rounding(load),
            beyond_equator=force < 0,
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

    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        return self.edge

    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        d, secant = self._state.indentation, self._state.secant
        relative = secant.slope / secant.value * (d.value / d.slope)
        return self._or_zero(self._secant * (1 + relative))

    def energy(self, joint: Joint, indentation: Array) -> Array:
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

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        return where(indentation == 0, inf, where(self.edge > 0, self._modulus, nan))

    def max_pressure(self, joint: Joint, indentation: Array) -> Array:
        return self._or_zero(self._modulus * indentation)

    @property
    def _edge_share(self) -> Array:
        """sin²(ε/2)."""
        return sin(divisor(self.edge) / 2) ** 2

    @property
    def _fullness(self) -> Array:
        """β of the profile, from 2π R2² ∫ p cos φ sin φ dφ = F."""
        S = self._edge_share
        mean = self._state.secant.value * self._state.compliance.value / (4 * pi * S)
        return (mean - 2 / 3 + 8 * S / 15) / (4 / 15 - 32 * S / 105)

    def pressure_integral(self, joint: Joint, indentation: Array) -> Array:
        ring = 4 * pi * self.joint.socket_radius**2 * self._edge_share
        return ring * self.max_pressure(joint, indentation) * (2 / 3 + 4 * self._fullness / 15)

    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        y = sin(clip(angle, -pi, pi) / 2) ** 2 / self._edge_share
        profile = arrays.sqrt(clip(1 - y, 0.0, 1.0)) * (1 + self._fullness * y)
        return where(y < 1, self.max_pressure(joint, indentation) * profile, self._or_zero(0.0 * y))


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


def compliance(k: Dual, nu: Array, b: Array) -> Dual:
    """c(n) E/R2 of the bonded liner for real n > 0, n(n + 1) = k²; b = 1 + L/R2.

    With q = n + 1/2, k0 = 3 - 4ν and g = 8(1 - ν)(1 - 2ν) it is (1 + ν) N/D,

        N = f(q) b^2q + f(-q) b^-2q - 4q²(k² + g) b² - 8(1 - 2ν)(q² - 1) k² + 4q²(k0 k² - g/2) b^-2
        D = h(q) b^2q + h(-q) b^-2q + 4q²(k² - 2)(k² + g) b² - 8(k² - 2)(q² - 1) k² + 4q²(k⁴ - 2k² + 4 - 4ν²) b^-2
        f(q) = (2k0 q - 1)(4(1 - ν)q² + 2(2 - 3ν)q - 1 + 2ν),  h(q) = (2q + 3)(2k0 q - 1)(q² - 2νq + 3/4)

    Both vanish at q = 1, where two of the shell's four solutions coincide. Of several k along the first axis only the
    first may come near.
    """
    away = k.value * k.value - 0.75
    near = (away > -0.05) & (away < 0.05)
    if arrays.truth(~near):
        above, below = (sums.direct(b) for sums in _sums(k, nu))
        return above / below * (1 + nu)
    elsewhere = Dual(where(near, 2.0, k.value), k.slope)
    above, below = (sums.direct(b) for sums in _sums(elsewhere, nu))
    above_near, below_near = (sums.beside_one(b) for sums in _sums(Dual(k.value[:1, ...], k.slope[:1, ...]), nu))
    return _either(near, above_near / below_near, above / below) * (1 + nu)


class _Sum(NamedTuple):
    """grown b^2q + decayed b^-2q + first b² + middle (q² - 1) + last b^-2, which vanishes at q = 1.

    Also the polynomials (of n = q - 1/2, the highest power first) that remain of grown + first and of decayed + last
    when q - 1 is divided out.
    """

    q: Dual
    grown: Dual
    decayed: Dual
    first: Dual
    middle: Dual
    last: Dual
    grown_first: tuple[Array, ...]
    decayed_last: tuple[Array, ...]

    def direct(self, b: Array) -> Dual:
        """The sum, over b^2q."""
        q, b2 = self.q, b * b
        y = ((1 - q) * (2 * arrays.log(b))).exp()
        return self.grown + y * (self.first + ((q * q - 1) * self.middle + (self.last + y * self.decayed) / b2) / b2)

    def beside_one(self, b: Array) -> Dual:
        """The sum, over b^2q (q - 1)."""
        q, b2, n, rate = self.q, b * b, self.q - 0.5, 2 * arrays.log(b)
        x = (q - 1) * rate
        y, z = (-x).exp(), _decay_mean(x) * rate  # z = (1 - y)/(q - 1)
        start = _horner(n, self.grown_first) - z * self.first
        end = _horner(n, self.decayed_last) - z * self.decayed
        return start + y * ((q + 1) * self.middle + end / b2) / b2


def _sums(k: Dual, nu: Array) -> tuple[_Sum, _Sum]:
    """N and D of `compliance`."""
    k2, k0, g, t = k * k, 3 - 4 * nu, 8 * (1 - nu) * (1 - 2 * nu), 1 - 4 * nu
    square = 4 * k2 + 1  # 4q²
    q = square.sqrt() / 2

    def f(q: Dual) -> Dual:
        return (q * (2 * k0) - 1) * _horner(q, (4 * (1 - nu), 4 - 6 * nu, 2 * nu - 1))

    def h(q: Dual) -> Dual:
        return (2 * q + 3) * (q * (2 * k0) - 1) * _horner(q, (1.0, -2 * nu, 0.75))

    above = _Sum(
        q=q,
        grown=f(q),
        decayed=f(-q),
        first=-square * (k2 + g),
        middle=k2 * (16 * nu - 8),
        last=square * (k2 * k0 - g / 2),
        grown_first=(-4.0, 2 * (g + t) - 4, 3 * g + 2 * t, g),
        decayed_last=(4 * k0, 2 * k0 * (2 - t), -g - 2 * k0 * t, -g),
    )
    below = _Sum(
        q=q,
        grown=h(q),
        decayed=h(-q),
        first=square * (k2 - 2) * (k2 + g),
        middle=k2 * (2 - k2) * 8,
        last=square * ((k2 - 2) * k2 + 4 * (1 - nu * nu)),
        grown_first=(4.0, 14.0, 4 * g + 4 * t + 20, 12 * g + 10 * t + 16, 9 * g + 4 * t, 2 * g),
        decayed_last=(4.0, 14.0, 24 - 16 * nu, 10 + 8 * nu * t, 12 + 8 * nu * t, 8 * (1 - nu * nu)),
    )
    return above, below


def _decay_mean(x: Dual) -> Dual:
    """(1 - exp(-x))/x, by its series near 0."""
    small = (x.value > -0.05) & (x.value < 0.05)
    safe = Dual(where(small, 1.0, x.value), x.slope)
    series = _horner(-x, [1 / factorial(j + 1) for j in range(7, -1, -1)])
    return _either(small, series, (1 - (-safe).exp()) / safe)


@dataclass(frozen=True, slots=True, eq=False)
class Dual:
    """A number and its derivative by ln ε, carried along through the formulas; arrays stand to its right."""

    value: Array
    slope: Array

    def __neg__(self) -> Dual:
        return Dual(-self.value, -self.slope)

    def __add__(self, other: Dual | Array) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value + other.value, self.slope + other.slope)
        return Dual(self.value + other, self.slope)

    def __sub__(self, other: Dual | Array) -> Dual:
        return self + -other

    def __rsub__(self, other: Array) -> Dual:
        return -self + other

    def __mul__(self, other: Dual | Array) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value * other.value, self.value * other.slope + self.slope * other.value)
        return Dual(self.value * other, self.slope * other)

    def __truediv__(self, other: Dual | Array) -> Dual:
        if isinstance(other, Dual):
            quotient = self.value / other.value
            return Dual(quotient, (self.slope - quotient * other.slope) / other.value)
        return Dual(self.value / other, self.slope / other)

    __radd__ = __add__
    __rmul__ = __mul__

    def __rtruediv__(self, other: Array) -> Dual:
        quotient = other / self.value
        return Dual(quotient, -quotient * self.slope / self.value)

    def sqrt(self) -> Dual:
        root = arrays.sqrt(self.value)
        return Dual(root, self.slope / (2 * root))

    def exp(self) -> Dual:
        power = arrays.exp(self.value)
        return Dual(power, power * self.slope)

    def log(self) -> Dual:
        return Dual(arrays.log(self.value), self.slope / self.value)


def _either(condition: Array, this: Dual, that: Dual) -> Dual:
    return Dual(where(condition, this.value, that.value), where(condition, this.slope, that.slope))


def _horner(x: Dual, falling: Sequence[Array]) -> Dual:
    """The polynomial of x with these coefficients, the highest power first."""
    total = x * falling[0] + falling[1]
    for coefficient in falling[2:]:
        total = total * x + coefficient
    return total


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
