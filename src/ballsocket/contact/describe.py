"""A contact in words and numbers: for a terminal, a notebook and JSON."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.checks import needs
from ..core.kinds import Unit
from ..core.quantities import BEARING, CONTACT, Quantity

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Column:
    """A quantity of a contact in a unit: the head of a column, and its numbers."""

    quantity: Quantity
    reading: Unit

    @property
    def name(self) -> str:
        """What JSON calls it."""
        return self.quantity.key

    @property
    def attribute(self) -> str:
        """What a contact calls it."""
        return self.quantity.name

    @property
    def symbol(self) -> str:
        return self.quantity.symbol

    @property
    def title(self) -> str:
        return self.quantity.title

    @property
    def unit(self) -> str:
        return self.reading.text

    @property
    def factor(self) -> float:
        """From the unit inside to `unit`."""
        return self.reading.factor

    @property
    def head(self) -> str:
        """Symbol and unit."""
        return self.quantity.head(self.reading)

    @property
    def label(self) -> str:
        """Title, symbol and unit."""
        return self.quantity.label(self.reading)

    def of(self, contact: Any) -> Array:
        """The contact's values in `unit`; -0 is 0."""
        return getattr(contact, self.attribute) * self.factor + 0.0


COLUMNS = tuple(Column(each, each.written) for each in CONTACT.values())
"""Every quantity that is printed, in the order in which it is printed and in the units of JSON."""


UTILISATION = Column(BEARING["utilisation"], BEARING["utilisation"].written)
"""What is shown beside them where a strength is known."""

UTILISATION_NOTE = "utilisation_note"
"""Key of JSON: the reason where the utilisation does not cover the liner."""


def summary(contact: Any) -> dict[str, Any]:
    """One dictionary for JSON."""
    numbers = {column.name: arrays.to_list(column.of(contact)) for column in COLUMNS}
    borne = {
        UTILISATION.name: arrays.to_list(UTILISATION.of(contact)),
        UTILISATION_NOTE: contact.utilisation_note or None,
    }
    valid = arrays.to_list(contact.valid)
    return {"model": contact.model.name, **numbers, **borne, "valid": valid, "notes": list(contact.notes)}


def frame(contact: Any) -> pandas.DataFrame:
    """A row a point."""
    needs("study", "pandas")
    import pandas

    columns = {column.quantity.column: arrays.to_numpy(column.of(contact)).ravel() for column in COLUMNS}
    return pandas.DataFrame({**columns, "valid": arrays.to_numpy(contact.valid).ravel()})


def text(contact: Any) -> str:
    """A few aligned lines."""
    if arrays.all_true(contact.indentation == contact.indentation) is None:
        return f"<Contact of {contact.model.name}, traced>"
    rows = _rows(contact)
    width = max(len(number) for _, number, _ in rows)
    lines = [f"{contact.model.name} on {contact.joint}"]
    lines += [f"  {name:<19}{number:>{width}} {unit}".rstrip() for name, number, unit in rows]
    return "\n".join([*lines, *(f"  note: {note}" for note in contact.notes)])


def html(contact: Any) -> str:
    """A contact as a table for a notebook."""
    left = "style='text-align:left'"
    rows = "".join(
        f"<tr><td {left}>{name.replace('_', ' ')}</td><td>{escape(number)}</td><td {left}>{unit}</td></tr>"
        for name, number, unit in _rows(contact)
    )
    notes = "".join(f"<div>{escape(note)}</div>" for note in contact.notes)
    return f"<b>{escape(contact.model.name)}</b><div>{escape(str(contact.joint))}</div><table>{rows}</table>{notes}"


def count_text(valid: Array) -> str:
    """yes or no; how many of how many for more than one."""
    listed = arrays.to_numpy(valid)
    return ("yes" if listed.item() else "no") if listed.size == 1 else f"{int(listed.sum())} of {listed.size}"


def number_text(value: Array, digits: int, gap: str) -> str:
    """One number, or the range of many; `gap` where there is no number at all."""
    listed = arrays.to_numpy(value)
    known = listed[~numpy.isnan(listed)]
    if not known.size:
        return gap
    low, high = f"{known.min():.{digits}g}", f"{known.max():.{digits}g}"
    return low if low == high else f"{low} to {high}"


def _rows(contact: Any) -> list[tuple[str, str, str]]:
    digits = 6 if arrays.to_numpy(contact.indentation).size == 1 else 5
    rows = [(column.attribute, number_text(column.of(contact), digits, "no answer"), column.unit) for column in COLUMNS]
    return [*rows, *_borne(contact), ("valid", count_text(contact.valid), "")]


def _borne(contact: Any) -> list[tuple[str, str, str]]:
    """The utilisation of a single contact where it is known."""
    if arrays.to_numpy(contact.indentation).size != 1 or not contact.joint.strengths():
        return []
    value = UTILISATION.of(contact)
    return [] if value != value else [(UTILISATION.attribute, number_text(value, 3, ""), "")]
