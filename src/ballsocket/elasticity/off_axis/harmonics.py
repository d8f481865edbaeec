"""Which harmonics about the axis are computed, and how those between follow from them."""

from __future__ import annotations

from collections.abc import Callable

import numpy
from scipy.interpolate import make_interp_spline

from ...core.arrays import Numbers

_DENSE, _SPREAD = 6, 1.15
"""Harmonics that are all computed; beyond, each step is longer than the one before by this."""


def every_harmonic(some: Callable[[Numbers], Numbers], degrees: int) -> Numbers:
    """Matrices for m from 0 to `degrees`, most of them by a spline of ln m: within 2e-6 of the diagonal.

    Parameters
    ----------
    some : function
        From chosen m to their matrices (m, rings, rings).
    degrees : int
    """
    chosen = _chosen(degrees)
    exact = some(chosen)
    every = numpy.arange(degrees + 1)
    scaled = exact[2:] * (chosen[2:] + 1.0)[:, None, None]  # they fall like 1/m
    spline = make_interp_spline(numpy.log(chosen[2:] + 1.0), scaled, k=5)
    between = spline(numpy.log(every[2:] + 1.0)) / (every[2:] + 1.0)[:, None, None]
    return numpy.concatenate([exact[:2], between])


def _chosen(degrees: int) -> Numbers:
    """All low harmonics, and fewer and fewer of the higher."""
    chosen, step = list(range(min(_DENSE, degrees) + 1)), 1.0
    while chosen[-1] < degrees:
        step *= _SPREAD
        chosen.append(min(degrees, chosen[-1] + max(1, round(step))))
    return numpy.array(chosen)
