"""Reconstruction of the spherical joint model of Liu, Zhang & Yang."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi
from typing import ClassVar

from ..core.arrays import Array, clip, integral, log, safe_divisor, sin, sqrt, where
from ..core.checks import require
from ..core.sources import Source
from ..core.validity import SMALL_STRAIN, NeverValid, Range
from ..problem import Joint
from .closed_form import ClosedForm
from .kinematics import angle_of, linear_indentation_of_versine, linear_versine, versine_of


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
        """Compute the elastic energy in N mm, the integral of the force over the indentation."""
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

    def _squared_sine(self, joint: Joint, indentation: Array) -> Array:
        """Compute sin² ε of the contact's half angle."""
        # sin² ε = d (2c + d)/(c + d)²
        e = safe_divisor(joint.clearance + indentation)
        return indentation / e * (1 + joint.clearance / e)

    def pole_pressure(self, joint: Joint, indentation: Array) -> Array:
        return self.foundation_modulus(joint, indentation) * indentation

    def foundation_modulus(self, joint: Joint, indentation: Array) -> Array:
        """Compute the foundation modulus K = p0/d in MPa/mm at an indentation in mm."""
        # F = (2/3) π a² p0; F and a² share the factor d/(c + d)
        c, d = joint.clearance, indentation
        ratio = where(c + d > 0, (c + d) / safe_divisor(2 * c + d), 1.0)
        return 1.5 * self._force_factor(joint) * ratio / (pi * joint.socket_radius**2)

    def pressure(self, joint: Joint, indentation: Array, angle: Array) -> Array:
        """Compute the contact pressure p(φ) in MPa at a polar angle in rad; 0 outside the contact."""
        square = sin(angle) ** 2 / safe_divisor(self._squared_sine(joint, indentation))
        inside = (square < 1) & (angle < pi / 2) & (indentation > 0)
        return where(inside, self.pole_pressure(joint, indentation) * sqrt(clip(1 - square, 0.0, 1.0)), 0.0)
