"""Whether the materials bear a contact: the strength that is used most, its share, and a sentence."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..contact import Contact
from ..contact.strength import share, share_of_ball
from ..joint import Material
from ..quantities import STRENGTH

_SPARE = 0.8
"""A share beyond which there is little to spare."""


@dataclass(frozen=True, kw_only=True)
class Borne:
    """A strength of a material, and the share of it that a contact uses."""

    share: float
    strength: str
    part: str
    material: Material

    @property
    def words(self) -> str:
        """What the share is of, "the yield stress of the liner"."""
        return f"the {STRENGTH[self.strength].title} of the {self.part}"

    @property
    def limit(self) -> float:
        """The strength in MPa."""
        return float(self.material.strengths[self.strength])


def about_von_mises(contact: Contact) -> float:
    """Largest von Mises stress in the liner in MPa, by the fit: typically 6 % off, and known at once."""
    joint = contact.joint
    return float(share(contact.half_angle, joint.liner.poisson, joint.thickness_ratio) * contact.max_pressure)


def most_used(contact: Contact, von_mises: float) -> Borne | None:
    """The strength of liner or ball that is used most, for so much von Mises stress in the liner; None if unknown."""
    return max(_all(contact, von_mises), key=lambda borne: borne.share, default=None)


def _all(contact: Contact, von_mises: float) -> Iterator[Borne]:
    joint, pressure = contact.joint, float(contact.max_pressure)
    yield from _of("liner", joint.liner, pressure, von_mises)
    if joint.ball is not None:
        yield from _of("ball", joint.ball, pressure, float(share_of_ball(joint.ball.poisson)) * pressure)


def _of(part: str, material: Material, pressure: float, von_mises: float) -> Iterator[Borne]:
    for name, strength in material.strengths.items():
        used = (pressure if name == "allowable_pressure" else von_mises) / float(strength)
        yield Borne(share=used, strength=name, part=part, material=material)


def sentence(borne: Borne | None) -> tuple[bool | None, str]:
    """Whether it holds, and that in words; None where no strength is known."""
    if borne is None:
        return None, "No verdict: no strength of these materials is known. Give the liner's allowable pressure."
    if borne.share > 1:
        return False, f"More than the {borne.part} bears: {borne.share:.2g} times {borne.words}"
    if borne.share > _SPARE:
        return True, f"The {borne.part} bears it, with little to spare"
    return True, f"The {borne.part} bears it"
