"""Lubricant between ball and socket, with roughness and friction: a constant coefficient, or by the film (Stribeck)."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_number, require

_SEPARATED = 8.0  # film ratio from which asperities do not count: they carry 1e-16 of the pressure


@dataclass(frozen=True, kw_only=True)
class Stribeck:
    """Friction that falls with the film ratio λ: boundary, mixed and full-film lubrication in one smooth curve.

    Asperities carry the share a(λ) = F(λ)/F(0) of the pressure, F(λ) = ∫ (s - λ)^(5/2) φ(s) ds over s > λ with the
    normal distribution φ of their heights. The shear stress is μ a p + (1 - a) η v/h.

    Parameters
    ----------
    boundary : float
        Coefficient of friction μ of touching surfaces.

    Raises
    ------
    TypeError
        A coefficient that is not one number.
    ValueError
        A coefficient that is not from 0 to below 10.

    Notes
    -----
    Asperities of normally distributed heights: J. A. Greenwood, J. H. Tripp, Proc. IMechE 185 (1970) 625. Sharing of
    the load with the film: K. L. Johnson, J. A. Greenwood, S. Y. Poon, Wear 19 (1972) 91. λ is the film over the
    combined roughness.
    """

    boundary: float

    def __post_init__(self) -> None:
        check_number("boundary", self.boundary)
        require("boundary", self.boundary, 0 <= self.boundary < 10, "a coefficient of friction is 0 to below 10")

    def asperity_share(self, ratio: Numbers) -> Numbers:
        """Compute the share of the pressure that asperities carry, 1 to 0, at film ratios λ."""
        from scipy.special import pbdv  # slow to import

        # F(λ) = Γ(7/2)/sqrt(2π) exp(-λ²/4) D(λ) with the parabolic cylinder function of order -7/2
        near = numpy.minimum(ratio, _SEPARATED)
        share: Numbers = numpy.exp(-(near**2) / 4) * pbdv(-3.5, near)[0] / pbdv(-3.5, 0.0)[0]
        return numpy.where(ratio < _SEPARATED, share, 0.0)

    def shear_stress(
        self, pressure: Numbers, film: Numbers, speed: Numbers, *, roughness: float, viscosity: float
    ) -> Numbers:
        """Compute the shear stress in MPa at pressures in MPa, films in mm and sliding speeds in mm/s.

        A film that is NaN counts as no contact. The combined roughness is in mm, the viscosity in MPa s.
        """
        thickness = numpy.nan_to_num(film, nan=0.0)
        present = thickness > 0
        safe = numpy.where(present, thickness, 1.0)
        ratio = thickness / roughness if roughness > 0 else numpy.where(present, numpy.inf, 0.0)
        share = self.asperity_share(ratio)
        viscous = numpy.where(present, (1 - share) * viscosity * speed / safe, 0.0)
        return numpy.where(pressure > 0, share * self.boundary * pressure + viscous, 0.0)


@dataclass(frozen=True, kw_only=True)
class Lubricant:
    """Lubricant between ball and socket, with roughness and friction of the surfaces.

    Parameters
    ----------
    viscosity : float
        Viscosity in Pa s: 2.5e-3 (default) in a joint, about 1e-3 in diluted serum.
    ball_roughness, cup_roughness : float
        Roughness Ra in mm, 2e-5 and 1e-3 by default.
    friction : float or Stribeck
        Coefficient of friction, 0.06 by default; `Stribeck(boundary=...)` lets it depend on the film.

    Raises
    ------
    TypeError
        A value that is not one number.
    ValueError
        A viscosity that is not positive and finite; a roughness or friction that is negative or not finite.
    """

    viscosity: float = 2.5e-3
    ball_roughness: float = 2e-5
    cup_roughness: float = 1e-3
    friction: float | Stribeck = 0.06

    def __post_init__(self) -> None:
        check_number("viscosity", self.viscosity)
        require("viscosity", self.viscosity, 0 < self.viscosity < inf, "a viscosity (Pa s) is positive and finite")
        for name in ("ball_roughness", "cup_roughness"):
            value = check_number(name, getattr(self, name))
            require(name, value, 0 <= value < inf, "a roughness (mm) is at least 0, and finite")
        if not isinstance(self.friction, Stribeck):
            check_number("friction", self.friction)
            require("friction", self.friction, 0 <= self.friction < 10, "a coefficient of friction is 0 to below 10")

    @property
    def roughness(self) -> float:
        """Combined roughness of both surfaces in mm, the root of the sum of squares."""
        return hypot(self.ball_roughness, self.cup_roughness)

    @property
    def viscosity_mpa(self) -> float:
        """Viscosity in MPa s."""
        return 1e-6 * self.viscosity

    def shear_stress(self, pressure: Numbers, film: Numbers, speed: Numbers) -> Numbers:
        """Compute the shear stress in MPa at pressures in MPa, films in mm and sliding speeds in mm/s."""
        if not isinstance(self.friction, Stribeck):
            return numpy.asarray(self.friction * pressure)
        return self.friction.shear_stress(pressure, film, speed, roughness=self.roughness, viscosity=self.viscosity_mpa)
