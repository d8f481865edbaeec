"""How far a rigid ball asks the socket's surface to give way, and what that is in Abel space.

A displacement u(φ) has the transform A[u](t) = d/dt ∫ u sin φ dφ / sqrt(2 (cos φ - cos t)) over [0, t], which turns
P_n(cos φ) into cos((n + ½) t). d is the indentation, c the clearance, e = c + d, w = 1 - cos φ; angles in rad, lengths
in mm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import ClassVar

import numpy

from ..core.arrays import Numbers, gauss_legendre
from ..core.checks import shown


@dataclass(frozen=True, kw_only=True)
class LinearGap:
    """u = d cos φ - c (1 - cos φ), Eq. (6) of Heß & Forsbach 2021, doi 10.3390/app112311170."""

    clearance: float
    socket_radius: float
    steps: ClassVar[int] = 1  # of Newton's method from d = 0: u is linear in d
    conservative: ClassVar[bool] = True  # ∂u/∂d = cos φ: the work of F is that of the pressure

    def displacement(self, angle: Numbers, d: Numbers | float) -> Numbers:
        """u(φ) in mm, at angles in rad and indentations in mm, which broadcast."""
        return d - (self.clearance + d) * 2 * numpy.sin(angle / 2) ** 2

    def transform(self, t: Numbers, d: Numbers) -> Numbers:
        """A[u](t)."""
        return d * numpy.cos(1.5 * t) - 2 * self.clearance * numpy.sin(t) * numpy.sin(t / 2)

    def slope(self, t: Numbers, d: Numbers) -> Numbers:
        """d A[u]/dt."""
        half = t / 2
        turn = 2 * numpy.cos(t) * numpy.sin(half) + numpy.sin(t) * numpy.cos(half)
        return -1.5 * d * numpy.sin(1.5 * t) - self.clearance * turn

    def indentation_derivative(self, t: Numbers, d: Numbers) -> Numbers:
        """A[∂u/∂d](t)."""
        return numpy.cos(1.5 * t) + 0.0 * d


@dataclass(frozen=True, kw_only=True)
class CircularGap:
    """u = e cos φ + sqrt(R1² - e² sin² φ) - R2, Eq. (5): the circle that the ball is."""

    clearance: float
    socket_radius: float
    steps: ClassVar[int] = 7
    conservative: ClassVar[bool] = False

    def displacement(self, angle: Numbers, d: Numbers | float) -> Numbers:
        """u(φ) in mm, at angles in rad and indentations in mm, which broadcast; NaN where the ball does not reach."""
        return self._parts(2 * numpy.sin(angle / 2) ** 2, d)[0]

    def transform(self, t: Numbers, d: Numbers) -> Numbers:
        """A[u](t)."""
        return _transform(t, lambda w: self._parts(w, d)[:2])

    def slope(self, t: Numbers, d: Numbers) -> Numbers:
        """d A[u]/dt."""
        return _transform_slope(t, lambda w: self._parts(w, d))

    def indentation_derivative(self, t: Numbers, d: Numbers) -> Numbers:
        """A[∂u/∂d](t)."""
        return _transform(t, lambda w: self._deepening(w, d))

    def _parts(self, w: Numbers, d: Numbers | float) -> tuple[Numbers, Numbers, Numbers]:
        """u and its first two derivatives in w; NaN where the ball does not reach."""
        R1, e = self.socket_radius - self.clearance, self.clearance + d
        dropped = e * e * w * (2 - w)
        root = numpy.sqrt(R1 * R1 - dropped)
        tilt = e * e * (1 - w) / root
        return d - e * w - dropped / (R1 + root), -e - tilt, (e * e - tilt * tilt) / root

    def _deepening(self, w: Numbers, d: Numbers) -> tuple[Numbers, Numbers]:
        """∂u/∂d and its derivative in w."""
        R1, e = self.socket_radius - self.clearance, self.clearance + d
        sine = w * (2 - w)
        root = numpy.sqrt(R1 * R1 - e * e * sine)
        return 1 - w - e * sine / root, -1 - e * (1 - w) * (2 * R1 * R1 - e * e * sine) / root**3


Gap = LinearGap | CircularGap


def check_gap(gap: object) -> None:
    """Raise TypeError unless it is one of the two gaps, as a type."""
    if gap not in (LinearGap, CircularGap):
        raise TypeError(f"gap must be LinearGap or CircularGap, got {shown(gap)}")


_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(24))
_SINES, _TURNS = numpy.sin(pi / 2 * _NODES), pi / 2 * _WEIGHTS

Parts = Callable[[Numbers], tuple[Numbers, ...]]
"""u and its derivatives in w, of w."""


def _at_turns(t: Numbers, parts: Parts) -> tuple[Numbers, tuple[Numbers, ...]]:
    """sin θ along a new first axis, and the parts at w = (1 - cos t) sin² θ."""
    sine = _SINES.reshape(-1, *(1 for _ in numpy.shape(t)))
    return sine, parts(2 * numpy.sin(t / 2) ** 2 * sine**2)


def _mean(values: Numbers) -> Numbers:
    """∫ values sin θ dθ over [0, π/2]."""
    return numpy.tensordot(_TURNS * _SINES, values, axes=1)


def _transform(t: Numbers, parts: Parts) -> Numbers:
    """A[u] = cos(t/2) ∫ u sin θ dθ + 2 sin(t/2) sin t ∫ u' sin³ θ dθ over [0, π/2], with w = (1 - cos t) sin² θ."""
    sine, (u, u1) = _at_turns(t, parts)
    return numpy.cos(t / 2) * _mean(u) + 2 * numpy.sin(t / 2) * numpy.sin(t) * _mean(sine**2 * u1)


def _transform_slope(t: Numbers, parts: Parts) -> Numbers:
    sine, (u, u1, u2) = _at_turns(t, parts)
    half = numpy.sin(t / 2)
    first = 2 * numpy.cos(t / 2) * numpy.sin(t) + 2 * half * numpy.cos(t)
    second = 2 * half * numpy.sin(t) ** 2
    return -half / 2 * _mean(u) + first * _mean(sine**2 * u1) + second * _mean(sine**4 * u2)
