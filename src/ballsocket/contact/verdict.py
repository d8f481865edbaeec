"""A contact in one sentence: whether its materials bear it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..core.quantities import STRENGTH
from ..problem import Material
from .strength import joint_ball_stress_ratio, unchecked_strength_reason

if TYPE_CHECKING:
    from .contact import Contact


@dataclass(frozen=True, kw_only=True)
class StrengthUse:
    """What a contact takes of a strength of its liner or its ball."""

    part: str
    strength: str
    stress: float
    allowed: float

    @property
    def ratio(self) -> float:
        return self.stress / self.allowed

    def __str__(self) -> str:
        much = f"{100 * self.ratio:.0f} %" if self.ratio <= 1 else f"{self.ratio:.3g} times"
        return f"{much} {'of ' if self.ratio <= 1 else ''}the {STRENGTH[self.strength].title} of the {self.part}"


def strength_uses(contact: Contact) -> tuple[StrengthUse, ...]:
    """Every strength that is known, largest share first; of a contact of plain numbers."""
    return strength_uses_at(contact, contact.von_mises if contact.joint.liner.strengths else 0.0)


def strength_uses_at(contact: Contact, von_mises: float) -> tuple[StrengthUse, ...]:
    """The same, for so much von Mises stress in the liner (MPa)."""
    joint, pressure = contact.joint, float(contact.max_pressure)
    found = list(_of("liner", joint.liner, pressure, von_mises))
    if joint.ball is not None:
        found += _of("ball", joint.ball, pressure, joint_ball_stress_ratio(joint) * pressure)
    return tuple(sorted(found, key=lambda share: -share.ratio))


def _of(part: str, material: Material, pressure: float, von_mises: float) -> Iterator[StrengthUse]:
    for name, strength in material.strengths.items():
        stress = pressure if name == "allowable_pressure" else von_mises
        yield StrengthUse(part=part, strength=name, stress=float(stress), allowed=float(strength))


@dataclass(frozen=True, kw_only=True)
class StrengthVerdict:
    """Whether the materials bear a contact (None where nothing can be said), and why."""

    bears: bool | None
    words: str


def assess_strength(contact: Contact) -> StrengthVerdict:
    """The verdict on a contact of plain numbers.

    An answer outside its model's validity has no verdict, and neither has one whose strength is not checked.
    """
    if contact.status.failed:
        return StrengthVerdict(bears=None, words=f"no answer: {contact.status.sentence}")
    found = strength_uses(contact)
    worst = found[0] if found else None
    if worst is not None and worst.ratio > 1:
        return StrengthVerdict(bears=False, words=f"does not bear it: {worst}")
    if not contact.valid:
        return StrengthVerdict(bears=None, words=f"not to be trusted here: {'; '.join(contact.notes)}")
    if worst is None or not contact.joint.liner.strengths:
        return StrengthVerdict(bears=None, words=unchecked_strength_reason(contact.joint))
    return StrengthVerdict(bears=True, words=f"bears it: {worst}")
