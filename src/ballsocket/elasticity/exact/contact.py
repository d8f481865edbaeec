"""The answer of the elastic solution: a contact that knows its own error and the inside of the socket."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf, prod
from typing import Any

import numpy

from ...contact.closed_sphere import (
    MAX_CHANGE,
    MAX_MODULUS_RATIO,
    NOTED_CHANGE,
    POISSON_RANGE,
    THICKNESS_RATIO_RANGE,
    indentation_change,
    largest_change,
)
from ...contact.per_joint import Piece, SolvedContact
from ...core import arrays
from ...core.arrays import Array
from ...core.checks import numeric, require
from ...core.quantities import QUANTITIES
from ...core.stress import Peak, Stress
from ...core.validity import Range
from ...problem import Support
from .abel import AbelState
from .chebyshev_curve import ChebyshevState
from .hemisphere import CHANGES, hemisphere_of
from .subsurface import (
    MIN_HALF_ANGLE,
    VON_MISES_TOLERANCE,
    estimate_von_mises,
    largest_von_mises,
    peak,
    stress,
    surface_displacement,
    von_mises_change,
)

_FITTED = (
    Range(quantity="joint.liner.poisson", low=POISSON_RANGE[0], high=POISSON_RANGE[1]),
    Range(quantity="joint.thickness_ratio", low=THICKNESS_RATIO_RANGE[0], high=THICKNESS_RATIO_RANGE[1]),
    Range(quantity="joint.modulus_ratio", high=MAX_MODULUS_RATIO),
)
"""Range of joints for the fitted estimate of the changes on a hemisphere."""

_SAFETY = 2.0
"""Safety factor on that estimate: the 1st percentile of estimate over change is 0.6."""


@dataclass(frozen=True, kw_only=True)
class NearHemisphere(Range):
    """Contacts whose indentation and largest pressure on a hemisphere differ by at most 15 %."""

    quantity: str | Callable[[Any], Array] = "indentation"
    symbol: str = "change of d or pmax on a hemisphere"
    high: float = MAX_CHANGE
    why: str = "the closed sphere of the solution is stiffer than a socket with a free rim: use fem or sphere"

    def holds(self, contact: Any) -> Array:
        """Check the range, first by an upper bound, else by the computed changes."""
        if contact.hemisphere_at_most("indentation") <= self.high:
            return contact.indentation == contact.indentation
        deeper, higher = (contact.hemisphere[name] for name in ("indentation", "max_pressure"))
        return (abs(deeper) <= self.high) & (abs(higher) <= self.high)

    def __str__(self) -> str:
        return f"{self.symbol} ≤ {100 * self.high:g} %"


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class ElasticContact(SolvedContact):
    """A contact that knows, where it is a single one, displacements and stresses in the socket."""

    def displacement(self, angle: Array) -> Array:
        """Radial displacement in mm of the socket's surface at polar angles (rad), inside and outside the contact.

        Outwards is positive; of the shape of `angle`. NumPy; by the sum of modes, to about 1e-5 of the indentation
        (1e-8 for half angles above 40 degrees).

        Raises
        ------
        ValueError
            More than one contact, or one that is narrower than 1 degree: there the half-space (`Hertz`) answers.
        """
        angles = numpy.asarray(arrays.to_numpy(QUANTITIES["angle"].checked(angle)), dtype=float)
        values = surface_displacement(self._single, angles)
        return values if angles.ndim else float(values)

    def stress(self, angle: Array, depth: Array) -> Stress:
        """Stresses in the liner and its backing at polar angles (rad) and depths (mm) below the socket's surface.

        NumPy; angle and depth broadcast against each other. By the sum of modes: at the surface to about 1e-4 of the
        peak pressure away from the edge of the contact, below it to 1e-8.

        Raises
        ------
        ValueError
            More than one contact, or one that is narrower than 1 degree; a depth above the surface or beyond the
            outermost layer.
        """
        angles, depths = (
            numpy.asarray(value, dtype=float) for value in (QUANTITIES["angle"].checked(angle), numeric("depth", depth))
        )
        thickness = sum(shell.thickness for shell in self._single.kernel.socket.shells)
        good = (depths >= 0) & (depths <= thickness * (1 + 1e-9))
        require("depth", depths, good, f"a depth (mm) lies between 0 and {thickness:g}, where the socket ends")
        found = stress(self._single, angles, depths)
        if angles.ndim or depths.ndim:
            return found
        numbers: Any = {name: float(part) for name, part in vars(found).items()}
        return Stress(**numbers)

    @cached_property
    def hemisphere(self) -> dict[str, Array]:
        """Relative change of each quantity, at the same force, on a hemisphere with a free rim and half a ball.

        The solution itself is that of a closed sphere. The names are those of `hemisphere.CHANGES`. A change is NaN
        where the contact on the hemisphere would reach its rim. The error is below 0.03 for nineteen of twenty joints.
        """
        changes = self.laws.spread(_hemisphere_of, rows=(len(CHANGES),))
        return {name: self._plain(changes[number, ...]) for number, name in enumerate(CHANGES)}

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of the contact, with one on a hemisphere that differs by more than 1 %."""
        return (*super().notes, *self._hemisphere_note())

    def _hemisphere_note(self) -> list[str]:
        if self.hemisphere_at_most("largest") <= NOTED_CHANGE:
            return []
        changes = {QUANTITIES[name].symbol: arrays.to_numpy(values) for name, values in self.hemisphere.items()}
        same = numpy.all([~(abs(values) > NOTED_CHANGE) for values in changes.values()], axis=0)
        bounded = numpy.all([numpy.isfinite(values) for values in changes.values()], axis=0)
        good = (same & bounded) | arrays.to_numpy(self._failed)
        if not good.all() and bounded.all() and self.joint.strengths() and self._is_single:
            changes["von Mises"] = numpy.array(self._hemisphere_von_mises)
        return self._note(good, _difference(changes))

    @property
    def _is_single(self) -> bool:
        return prod(self.laws.shape) == 1 and bool(self.single_state.half_angle[0] >= MIN_HALF_ANGLE)

    @property
    def _hemisphere_von_mises(self) -> float:
        state: AbelState = self.single_state.alone(0)
        factor = 1 + float(arrays.to_numpy(self.hemisphere["half_angle"]).item())
        return von_mises_change(state, float(state.half_angle[0]) * factor)

    def hemisphere_at_most(self, name: str) -> float:
        """Estimate an upper bound of the "indentation" or "largest" change; infinite without a formula."""
        fitted = not self.joint.backing and self.joint.support is Support.FIXED
        if not fitted or not all(arrays.truth(limit.holds(self)) for limit in _FITTED):
            return inf
        estimate = indentation_change(self) if name == "indentation" else largest_change(self)
        return _SAFETY * float(numpy.max(arrays.to_numpy(estimate), where=~arrays.to_numpy(self._failed), initial=0.0))

    @cached_property
    def peak_stress(self) -> Peak:
        """The largest von Mises stress in the liner, with its depth and polar angle.

        Raises
        ------
        ValueError
            More than one contact, or one without load or narrower than 1 degree.
        """
        return peak(self._single, float(self.joint.liner_thickness))

    @cached_property
    def von_mises_between(self) -> tuple[Array, Array]:
        least, most = super().von_mises_between
        if arrays.truth(arrays.isfinite(most) | self._failed) is not False:
            return least, most
        about = self._answer(lambda: self.laws.located(lambda place, piece: self._estimate_von_mises(piece)))
        return (1 - VON_MISES_TOLERANCE) * about, (1 + VON_MISES_TOLERANCE) * about

    def _estimate_von_mises(self, piece: Piece) -> numpy.ndarray:
        return estimate_von_mises(piece.state)

    def _von_mises_of(self, place: numpy.ndarray, piece: Piece) -> numpy.ndarray:
        return largest_von_mises(piece.state, piece.reached)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON, with error estimates and the changes on a hemisphere."""
        changes = {name: arrays.to_list(value) for name, value in self.hemisphere.items()}
        return {**super().summary(), "hemisphere": changes}

    @property
    def _single(self) -> AbelState:
        state: AbelState = self.single_state.alone(0)
        width = float(state.half_angle[0])
        require("half_angle", width, width >= MIN_HALF_ANGLE, "inside a contact of less than 1 degree ask hertz")
        return state


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class CurveContact(ElasticContact):
    """An `ElasticContact` whose largest stress in the liner lies on a curve of its joint too, to about 1e-3."""

    def _estimate_von_mises(self, piece: Piece) -> numpy.ndarray:
        return self._von_mises_of(numpy.empty(0), piece)

    def _von_mises_of(self, place: numpy.ndarray, piece: Piece) -> numpy.ndarray:
        if isinstance(piece.state, ChebyshevState):
            return piece.state.largest_von_mises(piece.reached)
        return super()._von_mises_of(place, piece)


def _hemisphere_of(piece: Piece) -> numpy.ndarray:
    """Compute the changes of the touching contacts of one joint: (quantities, contacts)."""
    changes = hemisphere_of(piece.state.kernel).changes(piece.state.half_angle)
    return numpy.stack([changes[name] for name in CHANGES])


def _difference(changes: dict[str, numpy.ndarray]) -> str:
    """Describe the changes beyond 1 %, the largest of each quantity."""
    largest = {
        symbol: float(values.ravel()[numpy.nanargmax(abs(values))])
        for symbol, values in changes.items()
        if numpy.isfinite(values).any()
    }
    listed = [f"{symbol} {100 * value:+.3g} %" for symbol, value in largest.items() if abs(value) > NOTED_CHANGE]
    if not listed:
        return "closed sphere: on a hemisphere the contact of this force reaches the rim: use fem or sphere"
    up_to = "" if all(values.size == 1 for values in changes.values()) else "up to "
    return (
        f"closed sphere: a hemisphere with a free rim and half a ball has {up_to}{', '.join(listed)} "
        "at the same force: use fem or sphere"
    )
