"""Contact of the elastic solution, with error estimates and the stresses inside the socket."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import inf, prod
from typing import Any, ClassVar

import numpy

from ...contact.closed_sphere import (
    MAX_CHANGE,
    MAX_MODULUS_RATIO,
    NOTED_CHANGE,
    POISSON_RANGE,
    THICKNESS_RATIO_RANGE,
    hemisphere_indentation_change,
    max_hemisphere_change,
)
from ...contact.outcome import Finding, notes_of
from ...contact.per_joint import JointContacts, SolvedContact
from ...contact.verdict import Bounded, exact_number
from ...core import arrays
from ...core.arrays import Array
from ...core.checks import check_numeric, require
from ...core.quantities import QUANTITIES
from ...core.stress import Peak, Stress
from ...core.validity import Range
from ...problem import Support
from .abel import AbelState
from .hemisphere import CHANGES, hemisphere_of
from .subsurface import (
    MIN_HALF_ANGLE,
    VON_MISES_TOLERANCE,
    estimate_von_mises,
    find_peak_stress,
    largest_von_mises,
    stress,
    surface_displacement,
    von_mises_change,
)

_FITTED_RANGES = (
    Range(quantity="joint.liner.poisson", low=POISSON_RANGE[0], high=POISSON_RANGE[1]),
    Range(quantity="joint.thickness_ratio", low=THICKNESS_RATIO_RANGE[0], high=THICKNESS_RATIO_RANGE[1]),
    Range(quantity="joint.modulus_ratio", high=MAX_MODULUS_RATIO),
)
"""Range of joints for the fitted estimate of the changes on a hemisphere."""

_SAFETY = 2.0  # safety factor on that estimate: the 1st percentile of estimate over change is 0.6


@dataclass(frozen=True, kw_only=True)
class NearHemisphere(Range):
    """Contacts whose indentation and largest pressure on a hemisphere differ by at most 15 %."""

    quantity: str | Callable[[Any], Array] = "indentation"
    symbol: str = "change of d or pmax on a hemisphere"
    high: float = MAX_CHANGE
    why: str = "the closed sphere of the solution is stiffer than a socket with a free rim: use fem or sphere"

    def holds(self, contact: Any) -> Array:
        """Return True for contacts within the range, from an upper bound or else from the computed changes."""
        if contact.hemisphere_change_bound("indentation") <= self.high:
            return contact.indentation == contact.indentation
        indentation_change, pressure_change = (contact.hemisphere[name] for name in ("indentation", "max_pressure"))
        return (abs(indentation_change) <= self.high) & (abs(pressure_change) <= self.high)

    def __str__(self) -> str:
        return f"{self.symbol} ≤ {100 * self.high:g} %"


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class ElasticContact(SolvedContact):
    """Contact with displacements and stresses in the socket, available for a single load."""

    stress_error: ClassVar[float | None] = 2e-3

    def displacement(self, angle: Array) -> Array:
        """Compute the radial displacement in mm of the socket's surface at polar angles (rad).

        Outwards is positive, and angles outside the contact are allowed. The result is a NumPy array with the shape of
        `angle`. The sum of modes is accurate to about 1e-5 of the indentation (1e-8 for half angles above 40 degrees).

        Raises ValueError: more than one contact, or one that is narrower than 1 degree: there the half-space (`Hertz`)
        answers.
        """
        angles = numpy.asarray(arrays.to_numpy(QUANTITIES["angle"].check(angle)), dtype=float)
        values = surface_displacement(self._interior_state, angles)
        return values if angles.ndim else float(values)

    def stress(self, angle: Array, depth: Array) -> Stress:
        """Compute stresses in MPa in the liner and its backing at polar angles (rad) and depths (mm) below the bore.

        Angle and depth broadcast against each other; the results are NumPy arrays. The sum of modes is accurate to
        about 1e-4 of the peak pressure at the surface away from the edge of the contact, and to 1e-8 below it.

        Raises ValueError: more than one contact, or one that is narrower than 1 degree; a depth above the surface or
        beyond the outermost layer.
        """
        angles, depths = (
            numpy.asarray(value, dtype=float)
            for value in (QUANTITIES["angle"].check(angle), check_numeric("depth", depth))
        )
        thickness = sum(shell.thickness for shell in self._interior_state.kernel.socket.shells)
        inside = (depths >= 0) & (depths <= thickness * (1 + 1e-9))
        allowed = f"a depth (mm) must lie between 0 and {thickness:g}, the thickness of the socket"
        require("depth", depths, inside, allowed)
        stresses = stress(self._interior_state, angles, depths)
        if angles.ndim or depths.ndim:
            return stresses
        numbers: Any = {name: float(component) for name, component in vars(stresses).items()}
        return Stress(**numbers)

    @cached_property
    def hemisphere(self) -> dict[str, Array]:
        """Relative change of each quantity, at the same force, on a hemisphere with a free rim and half a ball.

        The solution itself is that of a closed sphere. The keys are the names in `hemisphere.CHANGES`. A change is NaN
        where the contact on the hemisphere would reach its rim. The error is below 0.03 for nineteen of twenty joints.
        """

        def changes_of(contacts: JointContacts) -> numpy.ndarray:
            changes = hemisphere_of(kernel=contacts.state.kernel).changes(contacts.state.half_angle)
            return numpy.stack([changes[name] for name in CHANGES])

        changes = self.laws.combine(changes_of, rows=(len(CHANGES),))
        return {name: self._match_load(changes[number, ...]) for number, name in enumerate(CHANGES)}

    @property
    def quick_notes(self) -> tuple[str, ...]:
        """Notes without the numbers of a hemisphere."""
        has_solution = not bool(numpy.all(arrays.to_numpy(self._failed)))
        follows = self.hemisphere_change_bound("largest") > NOTED_CHANGE and has_solution
        return (*notes_of(super().findings()), *((_PREPARING,) if follows else ()))

    def findings(self) -> Iterator[Finding]:
        """Yield messages on the contact, with one on a hemisphere that differs by more than 1 %."""
        yield from super().findings()
        if self.hemisphere_change_bound("largest") <= NOTED_CHANGE:
            return
        changes = {QUANTITIES[name].symbol: arrays.to_numpy(values) for name, values in self.hemisphere.items()}
        negligible = numpy.all([~(abs(values) > NOTED_CHANGE) for values in changes.values()], axis=0)
        bounded = numpy.all([numpy.isfinite(values) for values in changes.values()], axis=0)
        unaffected = (negligible & bounded) | arrays.to_numpy(self._failed)
        is_noted = not unaffected.all() and bounded.all() and self.joint.strengths()
        if is_noted and prod(self.laws.shape) == 1 and self.single_state.half_angle[0] >= MIN_HALF_ANGLE:
            changes["von Mises"] = numpy.array(self._hemisphere_von_mises_change)
        yield Finding(unaffected, _describe_changes(changes))

    @cached_property
    def _hemisphere_von_mises_change(self) -> float:
        """Relative change of the largest von Mises stress in the liner, from the closed sphere to a hemisphere."""
        state: AbelState = self.single_state.single_contact(0)
        factor = 1 + float(arrays.to_numpy(self.hemisphere["half_angle"]).item())
        return von_mises_change(state, float(state.half_angle[0]) * factor)

    def hemisphere_change_bound(self, name: str) -> float:
        """Estimate an upper bound of the change of indentation or largest pressure on a hemisphere.

        `name` is "indentation" or "largest". The bound is infinite for joints without a formula.
        """
        has_formula = not self.joint.backing and self.joint.support is Support.FIXED
        if not has_formula or not all(arrays.all_true(limit.holds(self)) for limit in _FITTED_RANGES):
            return inf
        estimate = hemisphere_indentation_change(self) if name == "indentation" else max_hemisphere_change(self)
        return _SAFETY * float(numpy.max(arrays.to_numpy(estimate), where=~arrays.to_numpy(self._failed), initial=0.0))

    @cached_property
    def peak_stress(self) -> Peak:
        """Largest von Mises stress in the liner in MPa, with its depth in mm and polar angle in rad.

        Raises ValueError: more than one contact, or one without load or narrower than 1 degree.
        """
        return find_peak_stress(self._interior_state, float(self.joint.liner_thickness))

    @cached_property
    def quick_von_mises(self) -> Bounded:
        """Largest von Mises stress in MPa with its bounds; from a coarse sum of modes on a soft backing."""
        stress = super().quick_von_mises
        if arrays.all_true(arrays.isfinite(stress.high) | self._failed) is not False:
            return stress
        estimate = self._mask_failed(lambda: self.laws.combine_by_index(self._estimate_von_mises))
        return exact_number(estimate).scaled(1.0, VON_MISES_TOLERANCE)

    def _estimate_von_mises(self, position: numpy.ndarray, contacts: JointContacts) -> numpy.ndarray:
        return estimate_von_mises(contacts.state)

    def _joint_von_mises(self, position: numpy.ndarray, contacts: JointContacts) -> numpy.ndarray:
        return largest_von_mises(contacts.state, contacts.reached)

    def summary(self) -> dict[str, Any]:
        """Return the contact as a dictionary for JSON, with error estimates and the changes on a hemisphere."""
        changes = {name: arrays.to_list(value) for name, value in self.hemisphere.items()}
        return {**super().summary(), "hemisphere": changes}

    @property
    def _interior_state(self) -> AbelState:
        """Solved state of a single contact; several contacts or a narrow one raise ValueError."""
        state: AbelState = self.single_state.single_contact(0)
        width = float(state.half_angle[0])
        allowed = "stresses inside need a half angle of at least 1 degree: use hertz for narrower contacts"
        require("half_angle", width, width >= MIN_HALF_ANGLE, allowed)
        return state


_PREPARING = "closed sphere: preparing its differences from a hemisphere with a free rim"


def _describe_changes(changes: dict[str, numpy.ndarray]) -> str:
    largest = {
        symbol: float(values.ravel()[numpy.nanargmax(abs(values))])
        for symbol, values in changes.items()
        if numpy.isfinite(values).any()
    }
    listed = [f"{symbol} {100 * value:+.3g} %" for symbol, value in largest.items() if abs(value) > NOTED_CHANGE]
    if not listed:
        return "closed sphere: on a hemisphere the contact at this force reaches the rim; use fem or sphere"
    up_to = "" if all(values.size == 1 for values in changes.values()) else "up to "
    change = f"{up_to}{', '.join(listed)} at the same force"
    return f"closed sphere: a hemisphere with a free rim has {change}; use fem or sphere"
