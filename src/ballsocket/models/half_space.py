"""Half-space models: Hertz, Steuermann's power-law gap, and Liu."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cache
from math import comb, factorial, inf, pi, radians
from numbers import Integral
from typing import ClassVar

from numpy.polynomial import Polynomial

from ..core.arrays import Array, clip, integral, log, power, safe_divisor, sin, sqrt, where
from ..core.checks import require
from ..core.sources import Source
from ..core.validity import SMALL_STRAIN, NeverValid, Promise, Range
from ..problem import Joint
from .closed_form import ClosedForm
from .kinematics import angle_of, linear_indentation_of_versine, linear_versine, versine_of


class HalfSpace(ClosedForm):
    """Contact of two elastic half-spaces whose gap is the power law A r^(2n).

    The radius r is the arc from the pole, and a = R2 ε is its value at the edge.

    d = κ A a^(2n) with κ = (2n)!!/(2n - 1)!!. The gap is the parabola of the two spheres at r = R2, so n = 1 is Hertz:
    A = R2^(2 - 2n)/(2 R*), R* = R1 R2/c.
    """

    planar: ClassVar[bool] = True
    domain: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity="joint.clearance",
            low=0.0,
            why="the effective radius R1 R2/c is infinite without clearance, so a half-space carries no finite load",
        ),
    )

    @property
    @abstractmethod
    def order(self) -> int:
        """Half of the gap's exponent: n for the gap A r^(2n)."""

    @property
    def validity(self) -> tuple[Range, ...]:
        return _FIRST_TOUCH

    def _gap_coefficient(self, joint: Joint) -> Array:
        """Compute the coefficient κ A in mm^(1 - 2n) that relates indentation and contact radius, d = κ A a^(2n)."""
        n = self.order
        kappa = 4**n * factorial(n) ** 2 / factorial(2 * n)
        R2 = joint.socket_radius
        return kappa * joint.clearance / (2 * joint.ball_radius * R2) * R2 ** (2 - 2 * n)

    def _contact_radius(self, joint: Joint, indentation: Array) -> Array:
        return power(indentation / self._gap_coefficient(joint), 1 / (2 * self.order))

    def force(self, joint: Joint, indentation: Array) -> Array:
        """Compute the contact force F = 2 E* d a 2n/(2n + 1) in N at an indentation in mm."""
        n = self.order
        return 4 * n / (2 * n + 1) * joint.effective_modulus * indentation * self._contact_radius(joint, indentation)

    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        # a flat punch of the contact radius: dF/dd = 2 E* a
        return 2 * joint.effective_modulus * self._contact_radius(joint, indentation)

    def energy(self, joint: Joint, indentation: Array) -> Array:
        """Compute the elastic energy in N mm, the integral of the force F ~ d^(1 + 1/2n)."""
        n = self.order
        return 2 * n / (4 * n + 1) * self.force(joint, indentation) * indentation

    def indentation(self, joint: Joint, force: Array) -> Array:
        n = self.order
        profile = self._gap_coefficient(joint)
        radius = power(force * ((2 * n + 1) / (4 * n)) / (joint.effective_modulus * profile), 1 / (2 * n + 1))
        return profile * radius ** (2 * n)

    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        return self._contact_radius(joint, indentation) / joint.socket_radius

    def indentation_of_half_angle(self, joint: Joint, half_angle: Array) -> Array:
        return self._gap_coefficient(joint) * (half_angle * joint.socket_radius) ** (2 * self.order)

    def pole_pressure(self, joint: Joint, indentation: Array) -> Array:
        """Compute the pressure p0 = (E*/π) 2n/(2n - 1) d/a at the pole in MPa, with d/a = κ A a^(2n - 1)."""
        n = self.order
        slope = self._gap_coefficient(joint) * self._contact_radius(joint, indentation) ** (2 * n - 1)
        return joint.effective_modulus / pi * (2 * n / (2 * n - 1)) * slope

    def max_pressure(self, joint: Joint, indentation: Array) -> Array:
        return _peak_position_and_ratio(self.order)[1] * self.pole_pressure(joint, indentation)

    def max_pressure_angle(self, joint: Joint, indentation: Array) -> Array:
        return _peak_position_and_ratio(self.order)[0] * self.half_angle(joint, indentation)

    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        # p = (E*/π) κ A 2n ∫ t^(2n - 1)/sqrt(t² - r²) dt over r..a, a polynomial in y = sqrt(a² - r²)
        n = self.order
        r = angle * joint.socket_radius
        a = self._contact_radius(joint, indentation)
        y = sqrt(clip(a**2 - r**2, 0.0, inf))
        series = 0.0 * y
        for j in range(n):
            series = series + comb(n - 1, j) / (2 * j + 1) * r ** (2 * (n - 1 - j)) * y ** (2 * j + 1)
        return where(r < a, joint.effective_modulus / pi * self._gap_coefficient(joint) * 2 * n * series, 0.0)


@cache
def _peak_position_and_ratio(order: int) -> tuple[float, float]:
    """Compute the relative radius r/a of the largest pressure and its ratio to p0: 1/√2 and √2 for n = 2."""
    if order == 1:
        return 0.0, 1.0
    # the pressure as a polynomial in y = sqrt(1 - r²/a²), its only maximum inside
    y, square = Polynomial([0.0, 1.0]), Polynomial([1.0, 0.0, -1.0])
    terms = (comb(order - 1, j) / (2 * j + 1) * square ** (order - 1 - j) * y ** (2 * j + 1) for j in range(order))
    profile = sum(terms, Polynomial([0.0]))
    roots = profile.deriv().roots()
    inside = roots.real[(abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)]
    position = float(inside[profile(inside).argmax()])
    return float(sqrt(1 - position * position)), float(profile(position) / profile(1.0))


_FIRST_TOUCH = (
    Range(
        quantity="half_angle",
        high=radians(7.0),
        why="a half-space ignores that the surfaces curve (d is up to 15 % too large at 7°)",
    ),
    Range(quantity="width_ratio", high=0.15, why="a half-space ignores the backing of the liner"),
    SMALL_STRAIN,
)


_PROMISE = Promise(within=0.15)


@dataclass(frozen=True, kw_only=True)
class Hertz(HalfSpace):
    """Hertz contact (1882) with R* = R1 R2/c; in a close-fitting socket valid at small loads only.

    References
    ----------
    Heß & Forsbach 2021, doi 10.3390/app112311170, Eqs. (1)-(3); Johnson 1985, chapter 4, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.Hertz().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    5.94
    """

    @property
    def order(self) -> int:
        return 1

    name: ClassVar[str] = "hertz"
    title: ClassVar[str] = "two elastic half-spaces, parabolic gap"
    sources: ClassVar[tuple[Source, ...]] = (Source("hertz1882"), Source("hess2021", "(1), (2), (3)"))
    promise: ClassVar[Promise] = _PROMISE


@dataclass(frozen=True, kw_only=True)
class Steuermann(HalfSpace):
    """Contact after Steuermann 1939: two half-spaces with a gap r^(2n), flatter at the pole than a parabola.

    Parameters
    ----------
    exponent : int
        Exponent n, 1 or more; 1 is Hertz. No rule gives n for a given socket, which is the model's known weakness. The
        pressure is largest off the pole for n > 1.

    Raises
    ------
    ValueError
        The exponent is not an integer of 1 or more.

    References
    ----------
    Steuermann 1939; Johnson 1985, doi 10.1017/CBO9781139171731, section 5.3.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.Steuermann().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    6.08
    """

    exponent: int = 2

    def __post_init__(self) -> None:
        is_integer = isinstance(self.exponent, Integral) and not isinstance(self.exponent, bool)
        if not is_integer or self.exponent < 1:
            raise ValueError(f"exponent = {self.exponent!r} is not allowed: it must be an integer of 1 or more")
        object.__setattr__(self, "exponent", int(self.exponent))

    @property
    def validity(self) -> tuple[Range, ...]:
        other_gap = NeverValid(why=f"a gap that grows like r^{2 * self.exponent} is not the gap of two spheres")
        return super().validity if self.exponent == 1 else (other_gap, *super().validity)

    @property
    def promise(self) -> Promise | None:
        return _PROMISE if self.exponent == 1 else None

    @property
    def order(self) -> int:
        return self.exponent

    name: ClassVar[str] = "steuermann"

    @property
    def title(self) -> str:
        return f"two elastic half-spaces, gap growing like r^{2 * self.exponent}"

    sources: ClassVar[tuple[Source, ...]] = (Source("steuermann1939"), Source("johnson1985", "section 5.3"))


@dataclass(frozen=True, kw_only=True)
class LiuReconstruction(ClosedForm):
    """Reconstruction of Liu's contact model, F = (4π λ/3) E* R2 d²/(c + d); not the published formula.

    The model is a rigid cone on a plane Winkler layer as thick as the socket's radius, with an ellipsoidal pressure
    over the contact circle a = R2 sin ε, cos ε = c/(c + d). The text of Liu et al. 2006 and its coefficients were not
    available; their construction is as Heß & Forsbach 2021 (section 2) describe it.

    Parameters
    ----------
    coefficient : float
        Coefficient λ, the only fitted number, above 0; the default 1/2 is not fitted.

    Raises
    ------
    ValueError
        A coefficient that is not above 0 and finite.

    References
    ----------
    Liu, Zhang & Yang 2006, doi 10.1115/1.2162872, after Heß & Forsbach 2021, doi 10.3390/app112311170, section 2.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.LiuReconstruction().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    8.65
    """

    coefficient: float = 0.5

    def __post_init__(self) -> None:
        require("coefficient", self.coefficient, 0 < self.coefficient < inf, "a coefficient must be above 0 and finite")

    name: ClassVar[str] = "liu-reconstruction"
    title: ClassVar[str] = "cone on a plane Winkler layer, ellipsoidal pressure (a reconstruction)"
    sources: ClassVar[tuple[Source, ...]] = (Source("liu2006"), Source("hess2021", "section 2"))

    @property
    def validity(self) -> tuple[Range, ...]:
        """Validity ranges of the model; none of its results is validated."""
        one_material = "made for ball and socket of one material"
        massive_socket = "made for a massive socket: the liner's thickness does not enter"
        return (
            NeverValid(why="unvalidated reconstruction: one coefficient is not fitted to data"),
            Range(quantity="joint.modulus_ratio", low=0.5, high=2.0, why=one_material),
            Range(quantity="joint.thickness_ratio", high=1.0, why=massive_socket),
            SMALL_STRAIN,
        )

    def _force_factor(self, joint: Joint) -> Array:
        """Compute the force factor (4π λ/3) E* R2 in N/mm."""
        return 4 * pi * self.coefficient / 3 * joint.effective_modulus * joint.socket_radius

    def force(self, joint: Joint, indentation: Array) -> Array:
        return self._force_factor(joint) * indentation * (indentation / safe_divisor(joint.clearance + indentation))

    def stiffness(self, joint: Joint, indentation: Array) -> Array:
        e = safe_divisor(joint.clearance + indentation)
        return self._force_factor(joint) * (indentation / e) * (1 + joint.clearance / e)

    def energy(self, joint: Joint, indentation: Array) -> Array:
        # ∫ s²/(c + s) ds: by quadrature where the closed form cancels
        c, d = joint.clearance, indentation
        closed = d * d / 2 - c * d + c * c * log(1 + d / safe_divisor(c))
        series = integral(lambda x: x * x / safe_divisor(c + d * x), 24)
        return self._force_factor(joint) * where(d < c, d * d * d * series, closed)

    def indentation(self, joint: Joint, force: Array) -> Array:
        """Compute the indentation d in mm of a force in N, the root of d² - s d - s c = 0."""
        s = force / self._force_factor(joint)
        return (s + sqrt(s * (s + 4 * joint.clearance))) / 2

    def half_angle(self, joint: Joint, indentation: Array) -> Array:
        return angle_of(linear_versine(joint.socket_radius, joint.clearance, indentation))

    def indentation_of_half_angle(self, joint: Joint, half_angle: Array) -> Array:
        return linear_indentation_of_versine(joint.socket_radius, joint.clearance, versine_of(half_angle))

    def pole_pressure(self, joint: Joint, indentation: Array) -> Array:
        return self.foundation_modulus(joint, indentation) * indentation

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        # F = (2/3) π a² p0; F and a² share the factor d/(c + d)
        c, d = joint.clearance, indentation
        ratio = where(c + d > 0, (c + d) / safe_divisor(2 * c + d), 1.0)
        return 1.5 * self._force_factor(joint) * ratio / (pi * joint.socket_radius**2)

    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        e = safe_divisor(joint.clearance + indentation)
        squared_sine = indentation / e * (1 + joint.clearance / e)  # sin² ε = d (2c + d)/(c + d)²
        square = sin(angle) ** 2 / safe_divisor(squared_sine)
        inside = (square < 1) & (angle < pi / 2) & (indentation > 0)
        return where(inside, self.pole_pressure(joint, indentation) * sqrt(clip(1 - square, 0.0, 1.0)), 0.0)
