"""Stresses inside a body in spherical coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from .arrays import Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class Stress:
    """Stress components in spherical coordinates in MPa, tension positive.

    The coordinates have the centre of the socket and the load axis.

    Attributes
    ----------
    radial, meridional, hoop, shear : array
        σ_rr, σ_φφ, σ_θθ and σ_rφ in MPa, of the shape that angle and depth broadcast to.
    """

    radial: Numbers
    meridional: Numbers
    hoop: Numbers
    shear: Numbers

    @property
    def von_mises(self) -> Numbers:
        """Von Mises stress in MPa."""
        first, second = self.radial - self.meridional, self.meridional - self.hoop
        third = self.hoop - self.radial
        return numpy.sqrt((first**2 + second**2 + third**2) / 2 + 3 * self.shear**2)

    @property
    def principal(self) -> tuple[Numbers, Numbers, Numbers]:
        """Principal stresses in MPa, in descending order."""
        centre = (self.radial + self.meridional) / 2
        radius = numpy.hypot((self.radial - self.meridional) / 2, self.shear)  # of Mohr's circle
        stresses = numpy.sort(numpy.stack(numpy.broadcast_arrays(centre - radius, centre + radius, self.hoop)), axis=0)
        return stresses[2], stresses[1], stresses[0]


@dataclass(frozen=True, kw_only=True)
class Peak:
    """Largest von Mises stress in a body, and its position.

    Attributes
    ----------
    von_mises : float
        Stress in MPa.
    depth : float
        Depth below the surface of the socket in mm.
    angle : float
        Polar angle from the load axis, in rad.
    """

    von_mises: float
    depth: float
    angle: float
