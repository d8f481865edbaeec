"""The largest von Mises stress along the curve of one joint: known at some half angles, and between them by a line."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy

from ...core.arrays import Numbers
from .curve import Curve
from .subsurface import NARROWEST, largest_von_mises
from .tabulated.chebyshev import angle_at, angle_root

_STRESSES = 40  # steps between half angles where stresses are known


@dataclass(frozen=True, kw_only=True, eq=False)
class StressCurve:
    """The largest von Mises stress in the liner over the largest pressure, along a curve, to about 1e-3.

    `points` are those at which a contact is solved.
    """

    curve: Curve
    points: int

    @property
    def _ratio(self) -> float:
        return self.curve.ratio

    @cached_property
    def _widest(self) -> float:
        return float(angle_root(self.curve.widest, self._ratio))

    def share(self, angle: Numbers) -> Numbers:
        """Largest von Mises stress in the liner over the largest pressure, between some half angles along the curve."""
        along = numpy.clip((angle_root(angle, self._ratio) - self._roots[0]) / self._roots[1], 0.0, _STRESSES - 1e-9)
        first, part = along.astype(int), along % 1
        low, high = (self._stressed(number) for number in (first, first + 1))
        return low + part * (high - low)

    @property
    def _roots(self) -> tuple[float, float]:
        """Roots of the half angles where stresses are known: the first, and the step."""
        first = min(float(angle_root(NARROWEST, self._ratio)), self._widest)
        return first, (self._widest - first) / _STRESSES

    def _stressed(self, numbers: Numbers) -> Numbers:
        """The shares at some of those half angles, which are solved when they are first asked for."""
        each, which = numpy.unique(numbers, return_inverse=True)
        return numpy.array([self._share_at(int(number)) for number in each])[which.ravel()]

    def _share_at(self, number: int) -> float:
        if number not in self._shares:
            root = self._roots[0] + number * self._roots[1]
            angle = float(angle_at(2 * root - 1, self._ratio))
            state = self.curve.state(numpy.array([min(angle, self.curve.widest)]), self.points)
            self._shares[number] = float((largest_von_mises(state, numpy.array([True])) / state.max_pressure)[0])
        return self._shares[number]

    @cached_property
    def _shares(self) -> dict[int, float]:
        return {}
