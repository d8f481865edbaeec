"""J2 plasticity with isotropic hardening at the points of a mesh: radial return and its consistent tangent.

A deviator of an axisymmetric body has three components in an orthonormal basis, so that its norm is that of the tensor:
(ε_ρρ - ε_zz)/√2, (2 ε_θθ - ε_ρρ - ε_zz)/√6 and γ_ρz/√2. The von Mises stress is q = sqrt(3/2) |s|.

The return of Simo & Hughes (1998, chapter 3) has a closed form for a table: the equivalent plastic strain e solves
q_trial + 3G e_old = σ_y(e) + 3G e, whose right-hand side is linear between the points of the table.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy

from ...core.arrays import Numbers
from ...problem.hardening import Hardening

_ROOT = numpy.sqrt(1.5)
_ROUNDING = 1e-14  # of strains: a smaller increment is none


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticStrain:
    """Plastic strain of a body at its points: deviator (..., 3), its accumulated equivalent, and work per volume."""

    deviator: Numbers
    equivalent: Numbers
    work: Numbers

    @property
    def components(self) -> Numbers:
        """Plastic strains (..., 4): ε_ρρ, ε_zz, γ_ρz and ε_θθ."""
        first, second, third = numpy.moveaxis(self.deviator, -1, 0)
        hoop = 2 * second / numpy.sqrt(6)
        half = first / numpy.sqrt(2)
        return numpy.stack([half - hoop / 2, -half - hoop / 2, numpy.sqrt(2) * third, hoop], axis=-1)

    @classmethod
    def zero(cls, shape: tuple[int, ...]) -> PlasticStrain:
        """Return no plastic strain at points of this shape."""
        return cls(deviator=numpy.zeros((*shape, 3)), equivalent=numpy.zeros(shape), work=numpy.zeros(shape))


@dataclass(frozen=True, kw_only=True, eq=False)
class YieldLaw:
    """Shear modulus and hardening of a material, in one unit of stress."""

    shear: float
    hardening: Hardening

    @cached_property
    def _table(self) -> tuple[Numbers, Numbers, Numbers]:
        """Plastic strains e and values σ_y(e) + 3G e at the points, and slopes dσ_y/de from each point on."""
        stress, strain = numpy.array(self.hardening.stress), numpy.array(self.hardening.plastic_strain)
        slopes = numpy.append(numpy.diff(stress) / numpy.diff(strain), 0.0)
        return strain, stress + 3 * self.shear * strain, slopes

    def update(self, strain: Numbers, old: PlasticStrain) -> tuple[PlasticStrain, Numbers, Numbers]:
        """Compute the plastic strain for strain deviators (..., 3) after `old`, and factors of the tangent (...).

        The tangent of the deviatoric stress is 2G (a (I - n n) + b n n), n the direction of the stress. The factors are
        a and b; 1 where the increment is elastic.
        """
        strains, values, slopes = self._table
        trial = strain - old.deviator  # elastic strain if nothing yields
        size = numpy.linalg.norm(trial, axis=-1)
        q_trial = _ROOT * 2 * self.shear * size
        driven = q_trial + 3 * self.shear * old.equivalent
        beyond = numpy.maximum(driven - values[-1], 0.0) / (3 * self.shear)  # perfectly plastic after the last point
        increment = numpy.maximum(numpy.interp(driven, values, strains) + beyond - old.equivalent, 0.0)
        yields = increment > _ROUNDING
        increment = numpy.where(yields, increment, 0.0)
        with numpy.errstate(invalid="ignore", divide="ignore"):
            direction = numpy.where(yields[..., None], trial / size[..., None], 0.0)
            a = numpy.where(yields, 1 - 3 * self.shear * increment / q_trial, 1.0)
        slope = slopes[numpy.clip(numpy.searchsorted(values, driven, side="right") - 1, 0, None)]
        b = numpy.where(yields, slope / (3 * self.shear + slope), 1.0)
        q_new = q_trial - 3 * self.shear * increment
        q_old = numpy.interp(old.equivalent, strains, self.hardening.stress)
        new = PlasticStrain(
            deviator=old.deviator + _ROOT * increment[..., None] * direction,
            equivalent=old.equivalent + increment,
            work=old.work + increment * (q_old + q_new) / 2,
        )
        return new, a, b
