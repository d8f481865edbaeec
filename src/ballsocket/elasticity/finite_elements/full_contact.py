"""Contact that fills the bore up to its end."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy

from ...core.arrays import Numbers
from ...problem.gaps import Gap
from .round_contact import pressure_at_pole
from .surfaces import SurfacePair


@dataclass(frozen=True, kw_only=True, eq=False)
class FullContact:
    """Contact at an indentation (mm) beyond that of a `PartialContact` up to the rim, with the same quantities."""

    pair: SurfacePair
    gap: Gap
    indentation: float

    @property
    def half_angle(self) -> float:
        """Half angle in rad: the polar angle of the bore's end."""
        return float(self.pair.angle[-1])

    @cached_property
    def pressures(self) -> Numbers:
        """Nodal pressures in MPa at the pair's angles."""
        displacement = self.pair.integrate_with_shapes(self.gap.displacement(self.pair.points[0], self.indentation))
        return self.pair.whitening.T @ (self.pair.whitening @ displacement)

    def _total(self, values: Numbers) -> float:
        """Integrate the pressure times values at the points."""
        return float(self.pressures @ self.pair.integrate_with_shapes(values))

    @cached_property
    def force(self) -> float:
        """Force F in N."""
        return self._total(numpy.cos(self.pair.points[0]))

    @property
    def strain_energy(self) -> float:
        """Strain energy ½ ∫ p u dA in N mm."""
        return self._total(self.gap.displacement(self.pair.points[0], self.indentation)) / 2

    @property
    def pressure_integral(self) -> float:
        """Integral ∫ p dA in N."""
        return self._total(numpy.ones_like(self.pair.points[0]))

    @property
    def tension(self) -> float:
        """Largest tension over the pressure at the pole; negative if all pressures are positive."""
        return float(-self.pressures.min() / self.pole_pressure)

    @property
    def overlap(self) -> float:
        """Minus infinity: the bore has no surface beyond the contact."""
        return -numpy.inf

    @property
    def edge_element(self) -> float:
        """Zero: the edge is the end of the bore, independent of the elements."""
        return 0.0

    @property
    def stiffness(self) -> float:
        """Stiffness dF/dd in N/mm."""
        step = 1e-4 * self.indentation  # the force is linear in the indentation, or nearly (circular gap)
        sides = (replace(self, indentation=self.indentation + sign * step).force for sign in (0.5, -0.5))
        return (next(sides) - next(sides)) / step

    def forces(self, surface: int) -> Numbers:
        """Compute normal forces in N on the nodes of one of the surfaces."""
        return self.pair.forces[surface] @ self.pressures

    def pressure(self, angle: Numbers) -> Numbers:
        """Compute p(φ) in MPa, 0 beyond the rim."""
        nodes = self.pair.angle
        inside = numpy.interp(angle, nodes, numpy.append(self.pole_pressure, self.pressures[1:]))
        return numpy.where(angle <= nodes[-1], inside, 0.0)

    @cached_property
    def pole_pressure(self) -> float:
        """Pressure p0 at the pole in MPa."""
        return pressure_at_pole(self.pair.angle, self.pressures, self.half_angle)
