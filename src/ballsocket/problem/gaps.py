"""Displacement of the socket's surface that a rigid ball prescribes, and its Abel transform.

A displacement u(φ) has the transform A[u](t) = d/dt ∫ u sin φ dφ / sqrt(2 (cos φ - cos t)) over [0, t], which turns
P_n(cos φ) into cos((n + ½) t). d is the indentation, c the clearance, e = c + d, w = 1 - cos φ; angles in rad, lengths
in mm.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Any, ClassVar

import numpy

from ..core.arrays import Array, Numbers, cos, gauss_legendre, to_numpy, where
from ..core.checks import shown
from ..core.validity import Range


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


@dataclass(frozen=True, kw_only=True)
class CircularGap:
    """Surface displacement under a circular ball, u = e cos φ + sqrt(R1² - e² sin² φ) - R2, Eq. (5).

    The transforms are those of `LinearGap`.

    Parameters
    ----------
    clearance, socket_radius : float
        c and R2 in mm.
    """

    clearance: float
    socket_radius: float
    steps: ClassVar[int] = 40
    """Largest number of Newton steps from d = 0; the widest contact takes most."""

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
        return _abel_transform(t, lambda w: self._gap_derivatives(w, d)[:2])

    def slope(self, t: Numbers, d: Numbers) -> Numbers:
        sine = _SINES.reshape(-1, *(1 for _ in numpy.shape(t)))
        half = numpy.sin(t / 2)
        u, u1, u2 = self._gap_derivatives(2 * half**2 * sine**2, d)
        first = 2 * numpy.cos(t / 2) * numpy.sin(t) + 2 * half * numpy.cos(t)
        second = 2 * half * numpy.sin(t) ** 2
        return (
            -half / 2 * _sine_weighted_mean(u)
            + first * _sine_weighted_mean(sine**2 * u1)
            + second * _sine_weighted_mean(sine**4 * u2)
        )

    def indentation_derivative(self, t: Numbers, d: Numbers) -> Numbers:
        def derivatives(w: Numbers) -> tuple[Numbers, Numbers]:  # of ∂u/∂d: none, and by w
            R1, e = self.socket_radius - self.clearance, self.clearance + d
            sine = w * (2 - w)
            root = numpy.sqrt(R1 * R1 - e * e * sine)
            return 1 - w - e * sine / root, -1 - e * (1 - w) * (2 * R1 * R1 - e * e * sine) / root**3

        return _abel_transform(t, derivatives)

    def _gap_derivatives(self, w: Numbers, d: Numbers | float) -> tuple[Numbers, Numbers, Numbers]:
        """Compute the displacement u in mm and its first two derivatives by w = 1 - cos φ; NaN beyond the ball."""
        R1, e = self.socket_radius - self.clearance, self.clearance + d
        dropped = e * e * w * (2 - w)
        root = numpy.sqrt(R1 * R1 - dropped)
        tilt = e * e * (1 - w) / root
        return d - e * w - dropped / (R1 + root), -e - tilt, (e * e - tilt * tilt) / root


Gap = LinearGap | CircularGap
"""A gap of a joint."""

GapKind = type[LinearGap] | type[CircularGap]
"""Kind of gap of a model."""

GAP_KINDS: dict[str, GapKind] = {"linear": LinearGap, "circular": CircularGap}
"""Kinds of gaps by the names of the command line."""

MAX_LINEAR_CLEARANCE_RATIO = 0.01
"""Largest c/R2 that models solve with the linear gap by default; up to ε 45° it lowers pmax by at most 1 %."""

_NOTED_REDUCTION, _MAX_REDUCTION = 0.01, 0.02
"""Reductions of pmax by the linear gap above which a contact has a note, and is not valid in an accurate model."""


def check_gap(gap: object) -> None:
    """Check that `gap` is the class LinearGap or CircularGap, or None; raise TypeError otherwise."""
    if gap not in (LinearGap, CircularGap, None):
        raise TypeError(f"gap must be LinearGap or CircularGap, or None for a choice by c/R2, got {shown(gap)}")


def select_gap(gap: GapKind | None, joint: Any) -> GapKind:
    """Return the kind of gap of a model, or the one that suits the clearance of a joint if the model has none."""
    if gap is None:
        return CircularGap if float(joint.clearance_ratio) > MAX_LINEAR_CLEARANCE_RATIO else LinearGap
    return gap


def linear_gap_reduction(contact: Any) -> Array:
    """Estimate how much lower the largest pressure is with the linear gap than with the circular one, as a fraction.

    The force is the same. Eq. (6) neglects e² sin²φ/(2 R1), e = c + d, so that the estimate is a multiple of e/R2. It
    was fitted to 1100 contacts of `Exact` with both gaps (c/R2 0.005 to 0.15, R2/L 0.3 to 15, ν 0 to 0.49, ε 5° to
    75°). It is 0.9 to 1.15 times the computed reduction for 98 % of them, and 0.87 to 1.2 times for all; so it is for
    478 others down to c/R2 1e-4.
    """
    joint = contact.joint
    narrowness = cos(contact.half_angle) / (1 + contact.width_ratio)
    reduction = (joint.clearance + contact.indentation) / joint.socket_radius * (0.432 + 0.28 * narrowness)
    return where(reduction > 0, reduction, 0.0 * reduction)


def _default_gap_reduction(contact: Any) -> Array:
    """Estimate the reduction of pmax by the gap that `select_gap` chooses; the circular gap has none."""
    reduction = linear_gap_reduction(contact)
    return where(contact.joint.clearance_ratio > MAX_LINEAR_CLEARANCE_RATIO, 0.0 * reduction, reduction)


@dataclass(frozen=True, kw_only=True)
class LinearGapRange(Range):
    """Contacts whose largest pressure Eq. (6) lowers by at most 2 %; the note has the reduction at the contact."""

    quantity: str | Callable[[Any], Array] = linear_gap_reduction
    symbol: str = "reduction of pmax by Eq. (6)"
    high: float = _MAX_REDUCTION
    why: str = "use the circular gap of exact, fem or sphere (gap=CircularGap or --gap circular)"

    def note(self, contact: Any) -> str:
        """Note with the largest reduction among the contacts outside the range."""
        reduction = to_numpy(self.quantity_of(contact))
        largest = float(numpy.nanmax(reduction[~to_numpy(self.holds(contact))]))
        up_to = "up to " if reduction.size > 1 else ""
        return f"Eq. (6) neglects sin²φ, which lowers pmax by {up_to}{100 * largest:.2g} % here: {self.why}"

    def __str__(self) -> str:
        return f"{self.symbol} ≤ {100 * self.high:g} %"


@dataclass(frozen=True, kw_only=True)
class LinearGapRemark(LinearGapRange):
    """Contacts whose largest pressure Eq. (6) lowers by less than 1 %, or so much that they are not valid."""

    high: float = _NOTED_REDUCTION

    def holds(self, contact: Any) -> Array:
        """Return a mask of the contacts without this remark."""
        reduction = self.quantity_of(contact)
        return (reduction <= self.high) | (reduction > _MAX_REDUCTION)


@dataclass(frozen=True, kw_only=True)
class CircularGapRemark(Range):
    """Joints that models solve with the linear gap by default; the others have a note."""

    quantity: str | Callable[[Any], Array] = "joint.clearance_ratio"
    high: float = MAX_LINEAR_CLEARANCE_RATIO

    def note(self, contact: Any) -> str:
        """Note that the circular gap was chosen, with the reduction of pmax by the linear one."""
        reduction = 100 * float(numpy.nanmax(to_numpy(linear_gap_reduction(contact))))
        return (
            f"c/R2 is above {self.high:g}: solved with the circular gap, Eq. (5); the linear gap, Eq. (6), "
            f"lowers pmax by about {reduction:.2g} %"
        )


LINEAR_GAP, LINEAR_GAP_REMARK = LinearGapRange(), LinearGapRemark()
"""Validity and remark of accurate models with the linear gap."""


def gap_validity(gap: GapKind | None) -> tuple[Range, ...]:
    """Return the validity ranges of a model with a gap; those of the circular gap are empty."""
    if gap is CircularGap:
        return ()
    return (LINEAR_GAP if gap else LinearGapRange(quantity=_default_gap_reduction),)


def gap_remarks(gap: GapKind | None) -> tuple[Range, ...]:
    """Return the remarks of a model with a gap: on the error of a linear one, and on the choice of the circular one."""
    if gap is CircularGap:
        return ()
    if gap is LinearGap:
        return (LINEAR_GAP_REMARK,)
    return (LinearGapRemark(quantity=_default_gap_reduction), CircularGapRemark())


_NODES, _WEIGHTS = (numpy.array(values) for values in gauss_legendre(24))

_SINES = numpy.sin(pi / 2 * _NODES)  # sin θ at the nodes of a quadrature over [0, π/2]

Derivatives = Callable[[Numbers], tuple[Numbers, ...]]
"""Function of w that returns u and its derivatives with respect to w."""


def _abel_transform(t: Numbers, derivatives: Derivatives) -> Numbers:
    """Compute the Abel transform of a displacement by quadrature over θ in [0, π/2], with w = (1 - cos t) sin² θ.

    A[u] = cos(t/2) ∫ u sin θ dθ + 2 sin(t/2) sin t ∫ u' sin³ θ dθ.
    """
    sine = _SINES.reshape(-1, *(1 for _ in numpy.shape(t)))
    u, u1 = derivatives(2 * numpy.sin(t / 2) ** 2 * sine**2)
    return numpy.cos(t / 2) * _sine_weighted_mean(u) + 2 * numpy.sin(t / 2) * numpy.sin(t) * _sine_weighted_mean(
        sine**2 * u1
    )


def _sine_weighted_mean(values: Numbers) -> Numbers:
    return numpy.tensordot(pi / 2 * _WEIGHTS * _SINES, values, axes=1)
