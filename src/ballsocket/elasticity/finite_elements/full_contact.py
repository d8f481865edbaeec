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
    """Contact that fills the bore, at an indentation in mm; it has the quantities of a `PartialContact`."""

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

    def _integrate_pressure(self, values: Numbers) -> float:
        """Integrate the pressure times values at the quadrature points over the contact area."""
        return float(self.pressures @ self.pair.integrate_with_shapes(values))

    @cached_property
    def force(self) -> float:
        """Force F in N."""
        return self._integrate_pressure(numpy.cos(self.pair.points[0]))

    @property
    def strain_energy(self) -> float:
        """Strain energy ½ ∫ p u dA in N mm."""
        return self._integrate_pressure(self.gap.displacement(self.pair.points[0], self.indentation)) / 2

    @property
    def pressure_integral(self) -> float:
        """Integral of the pressure over the contact area, ∫ p dA, in N."""
        return self._integrate_pressure(numpy.ones_like(self.pair.points[0]))

    @property
    def tension(self) -> float:
        """Largest tension as a fraction of the pole pressure; negative if all pressures are positive."""
        return float(-self.pressures.min() / self.pole_pressure)

    @property
    def overlap(self) -> float:
        """Overlap of the bodies beyond the contact, minus infinity because the bore ends there."""
        return -numpy.inf

    @property
    def edge_element(self) -> float:
        """Length of the elements at the edge in rad, 0 because the edge is the end of the bore."""
        return 0.0

    @property
    def stiffness(self) -> float:
        """Tangent stiffness dF/dd in N/mm."""
        step = 1e-4 * self.indentation  # the force is linear in the indentation, or nearly (circular gap)
        sides = (replace(self, indentation=self.indentation + sign * step).force for sign in (0.5, -0.5))
        return (next(sides) - next(sides)) / step

    def forces(self, surface: int) -> Numbers:
        """Compute normal forces in N on the nodes of a surface: 0 is the socket, 1 the ball."""
        return self.pair.forces[surface] @ self.pressures

    def pressure(self, angle: Numbers) -> Numbers:
        """Compute the contact pressure p(φ) in MPa at polar angles (rad); 0 beyond the rim."""
        nodes = self.pair.angle
        inside = numpy.interp(angle, nodes, numpy.append(self.pole_pressure, self.pressures[1:]))
        return numpy.where(angle <= nodes[-1], inside, 0.0)

    @cached_property
    def pole_pressure(self) -> float:
        """Pressure p0 at the pole in MPa."""
        return pressure_at_pole(self.pair.angle, self.pressures, self.half_angle)
