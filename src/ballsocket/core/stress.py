"""Stresses inside a body, in the directions of its sphere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from .arrays import Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class Stress:
    """Stresses in MPa, tension positive; r counts from the centre of the socket, φ from the load axis.

    Attributes
    ----------
    radial, meridional, hoop, shear : array
        σ_rr, σ_φφ, σ_θθ and σ_rφ, of the shape that angle and depth broadcast to.
    """

    radial: Numbers
    meridional: Numbers
    hoop: Numbers
    shear: Numbers

    @property
    def von_mises(self) -> Numbers:
        """The von Mises stress in MPa."""
        first, second = self.radial - self.meridional, self.meridional - self.hoop
        third = self.hoop - self.radial
        return numpy.sqrt((first**2 + second**2 + third**2) / 2 + 3 * self.shear**2)

    @property
    def principal(self) -> tuple[Numbers, Numbers, Numbers]:
        """The principal stresses in MPa, the largest first."""
        middle = (self.radial + self.meridional) / 2
        reach = numpy.hypot((self.radial - self.meridional) / 2, self.shear)
        three = numpy.sort(numpy.stack(numpy.broadcast_arrays(middle - reach, middle + reach, self.hoop)), axis=0)
        return three[2], three[1], three[0]


@dataclass(frozen=True, kw_only=True)
class Peak:
    """The largest von Mises stress, and where.

    Attributes
    ----------
    von_mises : float
        In MPa.
    depth : float
        Below the surface of the socket, in mm.
    angle : float
        Polar angle from the load axis, in rad.
    """

    von_mises: float
    depth: float
    angle: float
