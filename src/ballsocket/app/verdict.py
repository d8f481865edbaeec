"""Whether the materials bear a contact, at once and in a sentence."""

from __future__ import annotations

from ..contact import Contact
from ..contact.strength import unchecked_strength_reason, von_mises_ratio
from ..contact.verdict import StrengthUse, strength_uses_at

_SPARE = 0.8
"""A share beyond which there is little to spare."""


def about_von_mises(contact: Contact) -> float:
    """Largest von Mises stress in the liner in MPa, by the fit: typically 6 % off, and known at once."""
    joint = contact.joint
    return float(von_mises_ratio(contact.half_angle, joint.liner.poisson, joint.thickness_ratio) * contact.max_pressure)


def most_used(contact: Contact, von_mises: float) -> StrengthUse | None:
    """The strength of liner or ball that is used most, for so much stress in the liner; None if none is known."""
    return next(iter(strength_uses_at(contact, von_mises)), None)


def sentence(contact: Contact, most: StrengthUse | None) -> tuple[bool | None, str]:
    """Return a verdict and its sentence; the verdict is None for an unchecked strength or an invalid contact."""
    if most is None or (most.ratio <= 1 and not contact.joint.liner.strengths):
        return None, f"No verdict: {unchecked_strength_reason(contact.joint)}. Enter the liner's allowable pressure."
    if most.ratio > 1:
        return False, f"The {most.part} does not bear it: {most}"
    if not bool(contact.valid):
        return None, "No verdict: this answer is not to be trusted here"
    return True, f"The {most.part} bears it{', with little to spare' if most.ratio > _SPARE else ''}"
