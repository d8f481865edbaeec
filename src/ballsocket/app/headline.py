"""The numbers of one contact: its largest pressure first, what of that the materials bear, the others smaller."""

from __future__ import annotations

from html import escape
from typing import Any

from ..compare import relative_deviation
from ..contact import Contact
from ..contact.describe import COLUMNS, Column
from ..contact.verdict import StrengthUse
from ..core.quantities import STRENGTH
from .reading import Reading, number_text
from .verdict import most_used, sentence
from .words import trust

_FIRST = "max_pressure"
_AT_THE_POLE = ("pole_pressure", "max_pressure_angle")
"""What says nothing new where the pressure is largest at the pole."""


def headline(
    contact: Contact, exact: Contact | None, von_mises: float, reading: Reading, surely: str = "about "
) -> str:
    """A contact as HTML.

    Parameters
    ----------
    contact, exact : Contact
        What is shown, and the exact answer where there is one.
    von_mises : float
        The largest in the liner, in MPa.
    reading : Reading
    surely : str
        Before a share that hangs on that stress.
    """
    most = most_used(contact, von_mises)
    listed = [each for each in reading.columns if each.attribute != _FIRST and not _idle(each, contact)]
    first = next(each for each in reading.columns if each.attribute == _FIRST)
    rest = "".join(_cell(each, contact) for each in listed)
    return (
        f"<dl class='first'>{_cell(first, contact)}</dl>{_share(most, surely, contact, reading)}"
        f"{_verdict(contact, most)}{trust(contact, _notes(contact))}"
        f"<dl class='numbers'>{rest}</dl><p class='quiet'>{escape(nearness(contact, exact))}</p>"
    )


def _notes(contact: Contact) -> list[str]:
    """List the notes; omit the utilisation note where the verdict already states it."""
    return [note for note in contact.notes if contact.joint.liner.strengths or note != contact.utilisation_note]


def _idle(each: Column, contact: Contact) -> bool:
    return each.attribute in _AT_THE_POLE and float(contact.max_pressure_angle) == 0


def _cell(each: Column, contact: Contact) -> str:
    value = float(each.values_of(contact))
    unit = "" if value != value else f" <span class='unit'>{escape(each.unit)}</span>"
    return (
        f"<div><dt>{escape(each.title)} <i>{escape(each.symbol)}</i></dt>"
        f"<dd data-name='{each.attribute}' data-value='{value!r}'>{number_text(value)}{unit}</dd></div>"
    )


def _share(most: StrengthUse | None, surely: str, contact: Contact, reading: Reading) -> str:
    """The share as a bar and in words."""
    if most is None or most.ratio != most.ratio:
        return ""
    about = "" if most.strength == "allowable_pressure" else surely
    name = getattr(contact.joint, most.part).name or most.part
    said = f"{about}{most} ({name}, {reading.said(STRENGTH[most.strength], most.allowed)})"
    kind = "yes" if most.ratio <= 1 else "no"
    return (
        f"<div class='bar' aria-hidden='true'><i class='{kind}' style='width:{min(100.0, 100 * most.ratio):.1f}%'></i>"
        f"</div><p class='share'>{escape(said)}</p>"
    )


def _verdict(contact: Contact, most: StrengthUse | None) -> str:
    holds, words = sentence(contact, most)
    kind, sign = {True: ("yes", "✓ "), False: ("no", "✗ "), None: ("quiet", "")}[holds]
    return f"<p class='verdict {kind}' role='status'>{sign}{escape(words)}</p>"


def nearness(contact: Contact, exact: Contact | None) -> str:
    """How near all numbers are to the exact answer, in one sentence; empty where that is not known."""
    apart = _error(contact) if exact is None or exact.model.name == contact.model.name else _apart(contact, exact)
    if apart != apart or apart == 0:
        return ""
    return f"All within {100 * max(apart, 1e-5):.2g} % of the exact answer"


def _error(contact: Contact) -> float:
    """What the exact answer says of its own numbers."""
    known: dict[str, Any] = getattr(contact, "error", {})
    return max((float(each) for each in known.values()), default=float("nan"))


def _apart(contact: Contact, exact: Contact) -> float:
    shares = [abs(float(relative_deviation(each.values_of(contact), each.values_of(exact)))) for each in COLUMNS]
    return max((share for share in shares if share == share), default=float("nan"))
