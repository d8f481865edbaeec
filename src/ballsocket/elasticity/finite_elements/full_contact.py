"""One contact that reaches the rim of the socket: all of the bore is under pressure, and the edge is where it ends."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy

from ...core.arrays import Numbers
from ...problem.gaps import Gap
from .round_contact import pole
from .surfaces import SurfacePair


@dataclass(frozen=True, kw_only=True, eq=False)
class FullContact:
    """A contact at an indentation (mm) that is deeper than that of a `PartialContact` up to the rim; it knows the same things."""

    pair: SurfacePair
    gap: Gap
    indentation: float

    @property
    def half_angle(self) -> float:
        """Half angle in rad: the polar angle of the bore's end."""
        return float(self.pair.angle[-1])

    @cached_property
    def pressures(self) -> Numbers:
        """At the pair's angles, in MPa."""
        asked = self.pair.weighted(self.gap.displacement(self.pair.points[0], self.indentation))
        return self.pair.whitening.T @ (self.pair.whitening @ asked)

    def _total(self, values: Numbers) -> float:
        return float(self.pressures @ self.pair.weighted(values))

    @cached_property
    def force(self) -> float:
        """F in N."""
        return self._total(numpy.cos(self.pair.points[0]))

    @property
    def strain_energy(self) -> float:
        """Half of ∫ p u dA in N mm."""
        return self._total(self.gap.displacement(self.pair.points[0], self.indentation)) / 2

    @property
    def pressure_integral(self) -> float:
        """∫ p dA in N."""
        return self._total(numpy.ones_like(self.pair.points[0]))

    @property
    def tension(self) -> float:
        """The largest pull over the pressure at the pole; negative where everything presses."""
        return float(-self.pressures.min() / self.pole_pressure)

    @property
    def overlap(self) -> float:
        """There is nothing beyond the contact."""
        return -numpy.inf

    @property
    def edge_element(self) -> float:
        """The edge is where the bore ends, whatever the elements."""
        return 0.0

    @property
    def stiffness(self) -> float:
        """dF/dd in N/mm."""
        step = 1e-4 * self.indentation  # the force is linear in the indentation, or nearly (circular gap)
        sides = (replace(self, indentation=self.indentation + sign * step).force for sign in (0.5, -0.5))
        return (next(sides) - next(sides)) / step

    def forces(self, surface: int) -> Numbers:
        """Normal forces on the nodes of one of the surfaces, in N."""
        return self.pair.forces[surface] @ self.pressures

    def pressure(self, angle: Numbers) -> Numbers:
        """p(φ) in MPa, 0 beyond the rim."""
        nodes = self.pair.angle
        inside = numpy.interp(angle, nodes, numpy.append(self.pole_pressure, self.pressures[1:]))
        return numpy.where(angle <= nodes[-1], inside, 0.0)

    @cached_property
    def pole_pressure(self) -> float:
        """p0 in MPa."""
        return pole(self.pair.angle, self.pressures, self.half_angle)
