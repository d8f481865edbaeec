"""Verdict on a contact in one sentence: the load is or is not below the strength of the materials."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..core.deprecation import renamed_names
from ..core.quantities import STRENGTH
from ..problem import Material
from .strength import joint_ball_stress_ratio, unchecked_strength_reason

if TYPE_CHECKING:
    from .contact import Contact


@dataclass(frozen=True, kw_only=True)
class StrengthUse:
    """Comparison of a contact's stress with one strength of the liner or the ball.

    Attributes
    ----------
    part : str
        "liner" or "ball".
    strength : str
        Name of the strength.
    stress, allowed : float
        Stress of the contact and the strength in MPa.
    """

    part: str
    strength: str
    stress: float
    allowed: float

    @property
    def ratio(self) -> float:
        """Ratio of stress to strength."""
        return self.stress / self.allowed

    def __str__(self) -> str:
        ratio = f"{100 * self.ratio:.0f} %" if self.ratio <= 1 else f"{self.ratio:.3g} times"
        return f"{ratio} {'of ' if self.ratio <= 1 else ''}the {STRENGTH[self.strength].title} of the {self.part}"


def strength_uses(contact: Contact) -> tuple[StrengthUse, ...]:
    """Compare the stresses of a single contact with all strengths of its materials, in descending order of ratio."""
    return strength_uses_at(contact, contact.von_mises if contact.joint.liner.strengths else 0.0)


def strength_uses_at(contact: Contact, von_mises: float) -> tuple[StrengthUse, ...]:
    """Compare a contact's stresses with all strengths, for a given von Mises stress of the liner in MPa."""
    joint, pressure = contact.joint, float(contact.max_pressure)
    uses = list(_compare_with_material_strengths("liner", joint.liner, pressure, von_mises))
    if joint.ball is not None:
        uses += _compare_with_material_strengths(
            "ball", joint.ball, pressure, joint_ball_stress_ratio(joint) * pressure
        )
    return tuple(sorted(uses, key=lambda use: -use.ratio))


def _compare_with_material_strengths(
    body: str, material: Material, pressure: float, von_mises: float
) -> Iterator[StrengthUse]:
    """Yield the comparison of stress with strength for each strength of one material."""
    for name, strength in material.strengths.items():
        stress = pressure if name == "allowable_pressure" else von_mises
        yield StrengthUse(part=body, strength=name, stress=float(stress), allowed=float(strength))


@dataclass(frozen=True, kw_only=True)
class StrengthVerdict:
    """Verdict on the strength of a contact, with its reason.

    Attributes
    ----------
    bears : bool or None
        True below all strengths, False above one of them, None without a valid result or a strength of the liner.
    words : str
        Reason in one sentence.
    """

    bears: bool | None
    words: str


def assess_strength(contact: Contact) -> StrengthVerdict:
    """Decide if the stresses of a single contact are below the strengths of its materials.

    There is no verdict (None) on an invalid result, nor if the strength of the liner is unknown.

    Parameters
    ----------
    contact : Contact
        Contact of one joint under one load.

    Returns
    -------
    StrengthVerdict

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.contact.verdict import assess_strength
    >>> assess_strength(bs.HessForsbach().press(bs.joints["hip-36"], force=3000.0)).bears
    True
    """
    if contact.status.failed:
        return StrengthVerdict(bears=None, words=f"no answer: {contact.status.sentence}")
    uses = strength_uses(contact)
    worst = uses[0] if uses else None
    if worst is not None and worst.ratio > 1:
        return StrengthVerdict(bears=False, words=f"overloaded: {worst}")
    if not contact.valid:
        return StrengthVerdict(bears=None, words=f"result not valid: {'; '.join(contact.notes)}")
    if worst is None or not contact.joint.liner.strengths:
        return StrengthVerdict(bears=None, words=unchecked_strength_reason(contact.joint))
    return StrengthVerdict(bears=True, words=f"within its strength: {worst}")


__getattr__ = renamed_names(
    __name__,
    {
        "Share": "StrengthUse",
        "Verdict": "StrengthVerdict",
        "shares": "strength_uses",
        "shares_of": "strength_uses_at",
        "verdict": "assess_strength",
    },
)
