"""Validity of the contact model at the worst instant of each activity, from the contacts of a whole cycle.

A run solves its contacts on the grid of the bore. Here the contact with the largest pressure in each activity becomes
a `Contact` of the matching model. That `Contact` supplies validity, utilisation and notes.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import degrees, nan
from typing import Any

import numpy

from ..contact import Contact, Model, strength
from ..contact.verdict import Bounded, Verdict, error_bar
from ..core.arrays import Array, Numbers
from ..core.display import finite_or_none, split_numbers
from ..core.unit_systems import Sentence
from ..core.validity import RIGID_BACKING, Status
from ..elasticity.off_axis.grid import Grid
from ..problem import Joint

COLUMNS = ("instant", "force", "indentation", "half_angle", "max_pressure")
"""Columns of a table of worst contacts: index of the instant, N, mm, rad, MPa."""


UNWORN_ERRORS = strength.TABLE_ERROR, 0.2
"""Relative errors, below and above, of the stress without wear; above at most 0.12 for ν up to 0.46, by a free rim."""

WORN_ERRORS = strength.WORN_ERRORS[0], UNWORN_ERRORS[1] + strength.WORN_ERRORS[1]
"""Relative errors, below and above, of the stress in a worn bore."""


@dataclass(frozen=True, kw_only=True)
class GridLaws:
    """Half angle and largest pressure of a simulated contact, for a `Contact`; other quantities are NaN."""

    half_angle: Array
    max_pressure: Array
    max_pressure_angle: Array = nan
    pole_pressure: Array = nan
    stiffness: Array = nan
    energy: Array = nan
    foundation_modulus: Array = nan
    pressure_integral: Array = nan

    def pressure(self, angle: Array) -> Array:
        """Return NaN, because the pressure of a worn bore depends on more than one angle."""
        return nan * angle


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class GridContact(Contact):
    """Contact from a wear simulation, as a `Contact` that checks validity and strength.

    Its von Mises stress is that of the axial contact of the same half angle and largest pressure. `stress_errors` are
    its relative errors, below and above.
    """

    stress_errors: tuple[float, float] = UNWORN_ERRORS

    def _compute_von_mises(self) -> Array:
        """Compute the largest von Mises stress in the liner in MPa; by the exact solution on an elastic backing."""
        joint = self.joint
        if joint.backing_ratio <= RIGID_BACKING.high:
            return super()._compute_von_mises()
        from ..elasticity.exact.exact_curve import exact_stress_ratio  # slow to import

        mean_joint = replace(joint, clearance=float(numpy.mean(joint.clearance)))
        return exact_stress_ratio(mean_joint, self.half_angle) * self.max_pressure

    @property
    def quick_von_mises(self) -> Bounded:
        """Largest von Mises stress in the liner in MPa with its bounds; it needs no solution for stresses."""
        low, high = self.stress_errors
        return Bounded(self.von_mises, (1 - low) * self.von_mises, (1 + high) * self.von_mises)


@dataclass(frozen=True, kw_only=True)
class ContactCheck:
    """Validity, strength and notes of the contact of one activity at its worst instant."""

    activity: str
    instant: str  # instant of the largest pressure, in words
    # load in N, half angle in rad of a round contact of the same area
    force: float
    half_angle: float
    # largest pressure, and largest von Mises stress in the liner, in MPa with their error bars
    pressure: Bounded
    von_mises: Bounded
    # largest von Mises stress over yield stress with its error bar; NaN where no yield stress is known
    utilisation_bar: Bounded
    utilisation_note: str  # reason why the utilisation does not cover the liner; empty where it does
    pressure_ratio: Bounded | None  # largest over allowable pressure of the liner; None where none is known
    valid: bool  # True inside the validity of the contact model
    notes: tuple[str, ...]  # notes of the contact model

    @property
    def max_pressure(self) -> float:
        """Largest pressure in MPa."""
        return float(self.pressure.value)

    @property
    def utilisation(self) -> float | None:
        """Largest von Mises stress over yield stress; None where no yield stress is known."""
        return finite_or_none(self.utilisation_bar.value)

    @property
    def verdict(self) -> Verdict:
        """Verdict on yield stress and allowable pressure; undecided without a yield stress, or outside the validity."""
        verdicts = [self.utilisation_bar.verdict(high=1.0)]
        if self.pressure_ratio is not None:
            verdicts.append(self.pressure_ratio.verdict(high=1.0))
        if self.utilisation_note or not self.valid:
            verdicts.append(Verdict.UNDECIDED)
        return max(verdicts)

    def summary(self) -> dict[str, Any]:
        """Return the contact check as a dictionary for JSON."""
        return {
            "activity": self.activity,
            "at": self.instant,
            "force_N": self.force,
            "max_pressure_MPa": self.max_pressure,
            "half_angle_deg": degrees(self.half_angle),
            "utilisation": self.utilisation,
            "utilisation_low": finite_or_none(self.utilisation_bar.low),
            "utilisation_high": finite_or_none(self.utilisation_bar.high),
            "pressure_ratio": None if self.pressure_ratio is None else finite_or_none(self.pressure_ratio.value),
            "verdict": self.verdict.word,
            "utilisation_note": self.utilisation_note or None,
            "valid": self.valid,
            "notes": list(self.notes),
        }


def half_angles(grid: Grid, reach: float, field: Numbers) -> Numbers:
    """Compute the half angles in rad of round contacts with the same areas as contacts on a grid: (contacts,).

    `field` (contacts, cells) is positive in the contact and linear across its edge; one that is 0 outside marks the
    cells alone. `reach` is the end of the bore in rad from the dome's pole.
    """
    level = field.reshape(len(field), grid.rings, grid.meridians)
    inner_level, outer_level = level[:, :-1], level[:, 1:]
    level_drop = inner_level - outer_level
    crossing = numpy.divide(
        inner_level, level_drop, out=numpy.full_like(level_drop, 0.5), where=(inner_level < 0) != (outer_level < 0)
    )
    start_fraction = numpy.where(inner_level > 0, 0.0, crossing)
    end_fraction = numpy.where(outer_level > 0, 1.0, crossing)
    pressed = (inner_level > 0) | (outer_level > 0)
    polar, polar_step = grid.polar[:-1, None], numpy.diff(grid.polar)[:, None]
    ring_versines = numpy.where(
        pressed, numpy.cos(polar + start_fraction * polar_step) - numpy.cos(polar + end_fraction * polar_step), 0.0
    )
    end_versines = (
        (level[:, 0] > 0) * (1 - numpy.cos(grid.polar[0])),
        (level[:, -1] > 0) * float(numpy.cos(grid.polar[-1]) - numpy.cos(reach)),
    )
    versine = (ring_versines.sum(axis=1) + end_versines[0] + end_versines[1]).mean(axis=1)
    return numpy.arccos(numpy.clip(1 - versine, -1.0, 1.0))


def grid_contact(
    model: Model, joint: Joint, worst: Numbers, stress_errors: tuple[float, float] = UNWORN_ERRORS
) -> GridContact:
    """Build a `GridContact` from one row or all rows of a table of worst contacts, with the columns `COLUMNS`."""
    is_single = worst.ndim == 1
    force, indentation, half_angle, max_pressure = (float(column) if is_single else column for column in worst.T[1:])
    return GridContact(
        model=model,
        joint=joint,
        status=Status.OK if is_single else numpy.zeros(len(worst), dtype=numpy.int8),
        laws=GridLaws(half_angle=half_angle, max_pressure=max_pressure),
        force=force,
        indentation=indentation,
        stress_errors=stress_errors,
    )


def check_rows(model: Model, joint: Joint, worst: Numbers) -> Numbers:
    """Compute the ratio of von Mises to yield stress, and validity, of rows of worst contacts: (2, rows).

    The clearance of the joint may be an array (rows,).
    """
    contact = grid_contact(model, joint, worst)
    return numpy.stack(
        [
            numpy.broadcast_to(numpy.asarray(values, dtype=float), len(worst))
            for values in (contact.utilisation, contact.valid)
        ]
    )


def check_contact(
    model: Model, joint: Joint, worst: Numbers, stress_errors: tuple[float, float], activity: str, instant: str
) -> ContactCheck:
    """Check validity and strength of the worst contact of one activity, a row of a table."""
    contact = grid_contact(model, joint, worst, stress_errors)
    pressure, von_mises, utilisation = (
        Bounded(*map(float, error_bar(contact, name))) for name in ("max_pressure", "von_mises", "utilisation")
    )
    allowed = joint.liner.allowable_pressure
    return ContactCheck(
        activity=activity,
        instant=instant,
        force=float(contact.force),
        half_angle=float(contact.half_angle),
        pressure=pressure,
        von_mises=von_mises,
        utilisation_bar=utilisation,
        utilisation_note=contact.utilisation_note,
        pressure_ratio=None if allowed is None else pressure.scaled(1 / float(allowed)),
        valid=bool(contact.valid),
        notes=contact.notes,
    )


def largest_utilisation(checks: Sequence[ContactCheck]) -> float | None:
    """Return the largest ratio of von Mises to yield stress of some checks; None if all are unknown."""
    return max((check.utilisation for check in checks if check.utilisation is not None), default=None)


def worst_verdict(checks: Iterable[ContactCheck]) -> Verdict:
    """Return the worst verdict on the strengths of some checks; undecided without a check."""
    return max((check.verdict for check in checks), default=Verdict.UNDECIDED)


def list_check_notes(stages: Sequence[tuple[str, Sequence[ContactCheck]]]) -> list[str]:
    """List the notes of contact checks at several stages of a run, each kind of note only once.

    A stage has a text ("in the first cycle") and its checks. Notes that differ in numbers alone are of one kind. A
    missing yield stress holds throughout the run: its note names no instant.
    """
    listed: dict[str, str] = {}
    for stage, checks in stages:
        for check in sorted(checks, key=lambda check: (-(check.utilisation or 0.0), -check.max_pressure)):
            for note in check.notes:
                everywhere = note == check.utilisation_note
                written = note if everywhere else Sentence("{} ({}, at {})", note, stage, check.instant)
                listed.setdefault(split_numbers(note)[0], written)
    return list(listed.values())
