"""Displacement of the socket's surface that a rigid ball prescribes, and its Abel transform.

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
from ..core.deprecation import RenamedAttribute


@dataclass(frozen=True, kw_only=True)
class LinearGap:
    """Linearised surface displacement under a rigid ball, u = d cos φ - c (1 - cos φ).

    Eq. (6) of Heß & Forsbach 2021, doi 10.3390/app112311170.

    Parameters
    ----------
    clearance, socket_radius : float
        c and R2 in mm.
    """

    clearance: float
    socket_radius: float
    steps: ClassVar[int] = 1
    """Number of Newton steps from d = 0; u is linear in d."""

    conservative: ClassVar[bool] = True
    """True since ∂u/∂d = cos φ: the work of the force equals that of the pressure."""

    def displacement(self, angle: Numbers, d: Numbers | float) -> Numbers:
        """Compute the radial surface displacement u(φ) in mm.

        Angles are in rad, indentations in mm; they broadcast.
        """
        return d - (self.clearance + d) * 2 * numpy.sin(angle / 2) ** 2

    def transform(self, t: Numbers, d: Numbers) -> Numbers:
        """Compute the Abel transform A[u](t) of the displacement in mm."""
        return d * numpy.cos(1.5 * t) - 2 * self.clearance * numpy.sin(t) * numpy.sin(t / 2)

    def slope(self, t: Numbers, d: Numbers) -> Numbers:
        """Compute the derivative dA[u]/dt of the Abel transform in mm/rad."""
        half = t / 2
        clearance_term = 2 * numpy.cos(t) * numpy.sin(half) + numpy.sin(t) * numpy.cos(half)
        return -1.5 * d * numpy.sin(1.5 * t) - self.clearance * clearance_term

    def indentation_derivative(self, t: Numbers, d: Numbers) -> Numbers:
        """Compute the Abel transform A[∂u/∂d](t), the change of A[u] per unit of the indentation d."""
        return numpy.cos(1.5 * t) + 0.0 * d

    deepening = RenamedAttribute("indentation_derivative")


@dataclass(frozen=True, kw_only=True)
class CircularGap:
    """Surface displacement under a circular ball, u = e cos φ + sqrt(R1² - e² sin² φ) - R2, Eq. (5).

    Parameters
    ----------
    clearance, socket_radius : float
        c and R2 in mm.
    """

    clearance: float
    socket_radius: float
    steps: ClassVar[int] = 7
    """Number of Newton steps from d = 0."""

    conservative: ClassVar[bool] = False
    """False since ∂u/∂d is not cos φ: the work of the force differs from that of the pressure."""

    def displacement(self, angle: Numbers, d: Numbers | float) -> Numbers:
        """Compute the radial surface displacement u(φ) in mm; NaN beyond the ball.

        Angles are in rad, indentations in mm; they broadcast.
        """
        versine = 2 * numpy.sin(angle / 2) ** 2  # w = 1 - cos φ
        u, _, _ = self._gap_derivatives(versine, d)
        return u

    def transform(self, t: Numbers, d: Numbers) -> Numbers:
        """Compute the Abel transform A[u](t) of the displacement in mm."""
        return _abel_transform(t, lambda w: self._gap_derivatives(w, d)[:2])

    def slope(self, t: Numbers, d: Numbers) -> Numbers:
        """Compute the derivative dA[u]/dt of the Abel transform in mm/rad."""
        return _abel_transform_slope(t, lambda w: self._gap_derivatives(w, d))

    def indentation_derivative(self, t: Numbers, d: Numbers) -> Numbers:
        """Compute the Abel transform A[∂u/∂d](t), the change of A[u] per unit of the indentation d."""
        return _abel_transform(t, lambda w: self._indentation_derivatives(w, d))

    deepening = RenamedAttribute("indentation_derivative")

    def _gap_derivatives(self, w: Numbers, d: Numbers | float) -> tuple[Numbers, Numbers, Numbers]:
        """Compute the displacement u in mm and its first two derivatives by w = 1 - cos φ; NaN beyond the ball."""
        R1, e = self.socket_radius - self.clearance, self.clearance + d
        dropped = e * e * w * (2 - w)
        root = numpy.sqrt(R1 * R1 - dropped)
        tilt = e * e * (1 - w) / root
        return d - e * w - dropped / (R1 + root), -e - tilt, (e * e - tilt * tilt) / root

    def _indentation_derivatives(self, w: Numbers, d: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the derivative ∂u/∂d by the indentation, and the derivative of ∂u/∂d by w = 1 - cos φ."""
        R1, e = self.socket_radius - self.clearance, self.clearance + d
        sine = w * (2 - w)
        root = numpy.sqrt(R1 * R1 - e * e * sine)
        return 1 - w - e * sine / root, -1 - e * (1 - w) * (2 * R1 * R1 - e * e * sine) / root**3


Gap = LinearGap | CircularGap
"""A gap of a joint."""


def check_gap(gap: object) -> None:
    """Check that `gap` is the class LinearGap or CircularGap; raise TypeError otherwise."""
    if gap not in (LinearGap, CircularGap):
        raise TypeError(f"gap must be LinearGap or CircularGap, got {shown(gap)}")


_NODES, _WEIGHTS = (numpy.array(values) for values in gauss_legendre(24))

_SINES = numpy.sin(pi / 2 * _NODES)
"""sin θ at the nodes of a quadrature over [0, π/2]."""

_ANGLE_WEIGHTS = pi / 2 * _WEIGHTS
"""Weights of that quadrature."""

Derivatives = Callable[[Numbers], tuple[Numbers, ...]]
"""Function of w that returns u and its derivatives with respect to w."""


def _evaluate_at_nodes(t: Numbers, derivatives: Derivatives) -> tuple[Numbers, tuple[Numbers, ...]]:
    """Evaluate the displacement and its derivatives at the quadrature nodes θ, where w = (1 - cos t) sin² θ.

    Returns sin θ along a new first axis, and the values.
    """
    sine = _SINES.reshape(-1, *(1 for _ in numpy.shape(t)))
    return sine, derivatives(2 * numpy.sin(t / 2) ** 2 * sine**2)


def _sine_weighted_mean(values: Numbers) -> Numbers:
    """Compute the mean of values over θ in [0, π/2] with the weight sin θ."""
    return numpy.tensordot(_ANGLE_WEIGHTS * _SINES, values, axes=1)


def _abel_transform(t: Numbers, derivatives: Derivatives) -> Numbers:
    """Compute the Abel transform of a displacement by quadrature over θ in [0, π/2].

    A[u] = cos(t/2) ∫ u sin θ dθ + 2 sin(t/2) sin t ∫ u' sin³ θ dθ.
    """
    sine, (u, u1) = _evaluate_at_nodes(t, derivatives)
    return numpy.cos(t / 2) * _sine_weighted_mean(u) + 2 * numpy.sin(t / 2) * numpy.sin(t) * _sine_weighted_mean(
        sine**2 * u1
    )


def _abel_transform_slope(t: Numbers, derivatives: Derivatives) -> Numbers:
    """Compute the derivative of the Abel transform of a displacement with respect to t."""
    sine, (u, u1, u2) = _evaluate_at_nodes(t, derivatives)
    half = numpy.sin(t / 2)
    first = 2 * numpy.cos(t / 2) * numpy.sin(t) + 2 * half * numpy.cos(t)
    second = 2 * half * numpy.sin(t) ** 2
    return (
        -half / 2 * _sine_weighted_mean(u)
        + first * _sine_weighted_mean(sine**2 * u1)
        + second * _sine_weighted_mean(sine**4 * u2)
    )
