"""Largest pressure of a solved contact and its polar angle."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from math import inf

import numpy

_PROFILE_POSITIONS = numpy.array([0.0, 0.05, 0.12, 0.25, 0.4, 0.55, 0.7, 0.82, 0.92, 1.0])
"""Polar angles of a profile over the half angle; a peak of less than 1e-6 between the first two counts as the pole."""

_REFINEMENTS = 4
"""Number of refinements of the interval that holds the largest pressure."""

_INTERVAL_POSITIONS = numpy.linspace(0.0, 1.0, 9)
"""Positions in an interval of a refinement."""


def find_peak_pressure(
    pressure: Callable[[numpy.ndarray], numpy.ndarray], pole: numpy.ndarray, edge: numpy.ndarray, noise: float
) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Find the largest pressure in MPa of each contact, and the polar angle of this pressure in rad.

    Parameters
    ----------
    pressure : function
        Pressure in MPa at angles in rad (angles, contacts).
    pole, edge : array (contacts,)
        Pressure at the pole in MPa, and half angle in rad.
    noise : float
        Relative excess over the pressure at the pole that is ignored.

    Returns
    -------
    array (contacts,), array (contacts,)
        Largest pressure in MPa and its angle in rad.
    """
    values = numpy.vstack([pole, pressure(edge * _PROFILE_POSITIONS[1:-1, None]), 0.0 * edge])
    largest_index = numpy.nan_to_num(values, nan=-inf).argmax(axis=0)
    peak_off_pole = (largest_index > 0) & (
        values.max(axis=0, initial=-inf, where=numpy.isfinite(values)) > pole * (1 + noise)
    )
    if not peak_off_pole.any():
        return pole, 0.0 * edge
    low, high = (
        edge * _PROFILE_POSITIONS[numpy.clip(largest_index + neighbour, 0, len(_PROFILE_POSITIONS) - 1)]
        for neighbour in (-1, 1)
    )
    contacts = numpy.arange(len(edge))
    for _ in range(_REFINEMENTS):
        angles = low + (high - low) * _INTERVAL_POSITIONS[:, None]
        values = pressure(angles)
        largest_index = numpy.nan_to_num(values, nan=-inf).argmax(axis=0)
        angle, largest = angles[largest_index, contacts], values[largest_index, contacts]
        low, high = (
            angles[numpy.clip(largest_index + neighbour, 0, len(_INTERVAL_POSITIONS) - 1), contacts]
            for neighbour in (-1, 1)
        )
    return numpy.where(peak_off_pole, largest, pole), numpy.where(peak_off_pole, angle, 0.0)


class PeakPressure(ABC):
    """Mixin class of solved contacts that adds the largest pressure and its polar angle."""

    @property
    @abstractmethod
    def largest(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Largest pressure of each contact in MPa, and its polar angle in rad."""

    @property
    def max_pressure(self) -> numpy.ndarray:
        """Largest pressure of each contact in MPa."""
        return self.largest[0]

    @property
    def max_pressure_angle(self) -> numpy.ndarray:
        """Polar angle in rad of the largest pressure of each contact."""
        return self.largest[1]
