"""What a grid cannot carry is taken out of a field, and nothing of its integral: waves of the grid itself."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy
import scipy.fft

from ..core.arrays import Numbers
from ..elasticity.off_axis.grid import Grid


@dataclass(frozen=True, kw_only=True, eq=False)
class Smoothing:
    """One pass of [1 2 1]/4 along the meridians and around the axis, there as wide as the rings are.

    Full elasticity turns a wave of the worn depth into pressures that are the larger the shorter it is; the shortest
    are the grid's own, and nothing but stiffness. Near the pole, where cells are slivers, the pass around the axis is
    wider by as much.

    Attributes
    ----------
    grid : Grid
    """

    grid: Grid

    @cached_property
    def _around(self) -> Numbers:
        """Factors of the harmonics about the axis: (rings, harmonics)."""
        # cos²(π m / 2M') is [1 2 1]/4 on M' cells a half turn
        wide = numpy.maximum(self.grid.meridians / 2 * numpy.sin(self.grid.polar), 1.0)[:, None]
        m = numpy.arange(self.grid.max_harmonic + 1)
        return numpy.where(m < wide, numpy.cos(numpy.pi * m / (2 * wide)) ** 2, 0.0)

    @cached_property
    def _flux(self) -> Numbers:
        """From ring to ring, over the area: (rings - 1, 1)."""
        areas = self.grid.areas
        return numpy.minimum(areas[1:], areas[:-1]) / 4

    def __call__(self, fields: Numbers) -> Numbers:
        """Smoothed fields (..., rings, meridians)."""
        waves = scipy.fft.rfft(fields) * self._around
        turned = scipy.fft.irfft(waves, n=self.grid.meridians)
        flux = self._flux * numpy.diff(turned, axis=-2)
        none = numpy.zeros_like(turned[..., :1, :])
        flux = numpy.concatenate([none, flux, none], axis=-2)
        return turned + numpy.diff(flux, axis=-2) / self.grid.areas
