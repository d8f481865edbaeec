"""Where the pressure of a solved contact is largest: from its profile, and as what every solved state offers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from math import inf

import numpy

_PLACES = numpy.array([0.0, 0.05, 0.12, 0.25, 0.4, 0.55, 0.7, 0.82, 0.92, 1.0])
"""Shares of the half angle: a peak of less than 1e-6 between the first two counts as the pole."""

_ROUNDS, _FINER = 4, numpy.linspace(0.0, 1.0, 9)


def find_peak_pressure(
    pressure: Callable[[numpy.ndarray], numpy.ndarray], pole: numpy.ndarray, edge: numpy.ndarray, noise: float
) -> tuple[numpy.ndarray, numpy.ndarray]:
    """The largest pressure of each contact and its polar angle, from the profiles alone.

    Parameters
    ----------
    pressure : function
        From angles in rad (places, contacts) to MPa.
    pole, edge : array (contacts,)
        The pressure at the pole (MPa) and the half angle (rad).
    noise : float
        Relative; a pressure that exceeds the pole's by less is taken for the pole's.

    Returns
    -------
    array (contacts,), twice
        In MPa and in rad.
    """
    values = numpy.vstack([pole, pressure(edge * _PLACES[1:-1, None]), 0.0 * edge])
    best = numpy.nan_to_num(values, nan=-inf).argmax(axis=0)
    off = (best > 0) & (values.max(axis=0, initial=-inf, where=numpy.isfinite(values)) > pole * (1 + noise))
    if not off.any():
        return pole, 0.0 * edge
    low, high = (edge * _PLACES[numpy.clip(best + step, 0, len(_PLACES) - 1)] for step in (-1, 1))
    each = numpy.arange(len(edge))
    for _ in range(_ROUNDS):
        angles = low + (high - low) * _FINER[:, None]
        values = pressure(angles)
        best = numpy.nan_to_num(values, nan=-inf).argmax(axis=0)
        angle, largest = angles[best, each], values[best, each]
        low, high = (angles[numpy.clip(best + step, 0, len(_FINER) - 1), each] for step in (-1, 1))
    return numpy.where(off, largest, pole), numpy.where(off, angle, 0.0)


class PeakPressure(ABC):
    """What knows its largest pressure and where that is."""

    @property
    @abstractmethod
    def largest(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """The largest pressure of each contact in MPa, and its polar angle in rad."""

    @property
    def max_pressure(self) -> numpy.ndarray:
        """The largest pressure in MPa."""
        return self.largest[0]

    @property
    def max_pressure_angle(self) -> numpy.ndarray:
        """Where the pressure is largest, in rad from the pole."""
        return self.largest[1]
