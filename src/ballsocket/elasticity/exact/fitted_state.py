"""Contacts that are read from the series of a joint's curve."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy

from ...contact.peak_pressure import PeakPressure, find_peak_pressure
from ...core.arrays import Numbers
from ...problem.gaps import Gap
from .abel import State, pressure_of
from .kernel import Kernel

if TYPE_CHECKING:
    from .fitted import FittedCurve

LOGS = 2
"""So many of the functions are logarithms."""

_FLAT = 1e-7  # of a pressure: what series may ripple


@dataclass(frozen=True, kw_only=True, eq=False)
class FittedState(PeakPressure):
    """Contacts at half angles ε (contacts,) above 0, with the quantities of a `State`."""

    fitted: FittedCurve
    half_angle: Numbers

    @property
    def kernel(self) -> Kernel:
        return self.fitted.curve.kernel

    @property
    def gap(self) -> Gap:
        return self.fitted.curve.gap

    @cached_property
    def _at(self) -> tuple[Numbers, Numbers]:
        return self.fitted.at(self.half_angle)

    @cached_property
    def _opened(self) -> tuple[Numbers, Numbers]:
        """d/X and its distance to 1, the perfect fit."""
        share = numpy.exp(self._at[0][0]) * 2 * numpy.sin(self.half_angle / 2) ** 2
        return share, 1 - share

    @property
    def to_fit(self) -> Numbers:
        """c/X, from 1 down to 0 at the perfect fit."""
        return self._opened[1]

    @cached_property
    def _reach(self) -> Numbers:
        """X = c + d in mm."""
        return self.gap.clearance / self._opened[1]

    @cached_property
    def indentation(self) -> Numbers:
        return self._reach * self._opened[0]

    @cached_property
    def widening(self) -> Numbers:
        """dd/dε in mm/rad."""
        rate = self._at[1][0] / self.half_angle + 1 / numpy.tan(self.half_angle / 2)
        return self._reach * self._opened[0] * rate / self._opened[1]

    @cached_property
    def _unit(self) -> Numbers:
        """X ε/C in MPa."""
        return self._reach * self.half_angle / self.kernel.compliance

    @cached_property
    def force(self) -> Numbers:
        radius = self.gap.socket_radius * self.half_angle
        return numpy.exp(self._at[0][1]) * self._unit * radius * radius

    @cached_property
    def pole_pressure(self) -> Numbers:
        return self._at[0][2] * self._unit

    @cached_property
    def stiffness(self) -> Numbers:
        return self._at[0][3] * self.gap.socket_radius**2 * self.half_angle / self.kernel.compliance

    @cached_property
    def energy(self) -> Numbers:
        return self._at[0][4] * self.force * self.indentation

    @cached_property
    def pressure_integral(self) -> Numbers:
        return self._at[0][5] * self.force

    @cached_property
    def error(self) -> Numbers:
        """Relative, at ε and X: of the exact solutions, and of what the series leave out."""
        missed, values = self.fitted.missed[:, None], abs(self._at[0][LOGS:])
        return numpy.max(missed[:LOGS]) + numpy.max(missed[LOGS:] / values, axis=0) + numpy.max(self.fitted.knots.error)

    @property
    def distance(self) -> Numbers:
        """Relative error of X at ε: it is that of the distance to the perfect fit."""
        return self.fitted.missed[0] * self._opened[0] / self._opened[1]

    @cached_property
    def largest(self) -> tuple[Numbers, Numbers]:
        """The largest pressure of each contact in MPa, and its polar angle in rad."""
        if self.fitted.knots.falls.all():
            return self.pole_pressure, 0.0 * self.half_angle
        return find_peak_pressure(self.pressure, self.pole_pressure, self.half_angle, _FLAT)

    def largest_von_mises(self, reached: Numbers) -> Numbers:
        """That in the liner of each contact that was reached (a mask), between those of half angles along the curve."""
        found = self.half_angle[reached]
        values = numpy.full(len(self.half_angle), numpy.nan)
        values[reached] = self.fitted.stresses.share(found) * self.max_pressure[reached]
        return values

    @cached_property
    def _expansion(self) -> Numbers:
        return self.fitted.expansion @ self.fitted.waves(self.half_angle)

    def pressure(self, angle: Numbers) -> Numbers:
        """p(φ) in MPa at angles (anything, contacts); 0 outside the contact."""
        return pressure_of(self.half_angle, self._expansion, angle) * (self._reach / self.kernel.compliance)

    def alone(self, number: int) -> State:
        """One of the contacts, solved."""
        return self.fitted.curve.state(self.half_angle[number : number + 1], self.fitted.knots.grid.points)
