"""Lubricant between ball and socket, with roughness and friction of their surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_number, require
from .friction import Stribeck


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
