"""Contacts as text, HTML tables, data frames and dictionaries for JSON."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce
from html import escape
from math import nan
from typing import TYPE_CHECKING, Any

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.checks import needs
from ..core.kinds import Kind, Unit
from ..core.quantities import BEARING, CONTACT, Quantity
from ..core.unit_systems import Units
from ..problem import Joint, elementwise_maximum

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Column:
    """Column of a table of contacts: a quantity in a unit."""

    quantity: Quantity
    reading: Unit  # unit of the column

    @cached_property
    def name(self) -> str:
        """Key of the quantity in JSON, such as "max_pressure"."""
        return self.quantity.key

    @cached_property
    def attribute(self) -> str:
        """Name of the `Contact` attribute that has the quantity."""
        return self.quantity.name

    @cached_property
    def symbol(self) -> str:
        """Symbol of the quantity, such as "pmax"."""
        return self.quantity.symbol

    @cached_property
    def title(self) -> str:
        """Name of the quantity in words."""
        return self.quantity.title

    @cached_property
    def unit(self) -> str:
        """Unit of the column as text, such as "MPa"."""
        return self.reading.text

    @cached_property
    def factor(self) -> float:
        """Factor from the internal unit to the unit of the column."""
        return self.reading.factor

    @cached_property
    def head(self) -> str:
        """Heading of the column: symbol and unit, such as "pmax [MPa]"."""
        return self.quantity.head(self.reading)

    @cached_property
    def label(self) -> str:
        """Axis label of a plot: title, symbol and unit of the quantity."""
        return self.quantity.label(self.reading)

    def values_of(self, contact: Any) -> Array:
        """Return the values of the quantity in a contact, converted to the unit of the column.

        -0 becomes 0.
        """
        return getattr(contact, self.attribute) * self.factor + 0.0


COLUMNS = tuple(Column(quantity, quantity.written) for quantity in CONTACT.values())
"""Printed quantities of a contact, in their order and in the units of JSON."""

UTILISATION = Column(BEARING["utilisation"], BEARING["utilisation"].written)
"""Column of the utilisation, printed if a strength is known."""


class PressureRatioColumn(Column):
    """Column of the largest pressure over the allowable pressure, the larger of liner and ball."""

    def values_of(self, contact: Any) -> Any:
        """Return the ratios of a contact; NaN without an allowable pressure."""
        materials = (contact.joint.liner, contact.joint.ball)
        allowed = [material.allowable_pressure for material in materials if material is not None]
        ratios = [contact.max_pressure / pressure for pressure in allowed if pressure is not None]
        return reduce(elementwise_maximum, ratios) if ratios else nan * contact.max_pressure


PRESSURE_RATIO = PressureRatioColumn(
    Quantity(
        "pressure_ratio",
        "pmax/pa",
        "largest over allowable pressure",
        Kind.NUMBER,
        "Largest pressure over the allowable pressure, the larger of liner and ball.",
    ),
    Unit(""),
)
"""Column of the pressure over the allowable pressure, printed if an allowable pressure is known."""


def columns_in(units: Units) -> tuple[Column, ...]:
    """Return the columns of a contact, each with its unit."""
    return (*(Column(quantity, units.unit_of(quantity)) for quantity in CONTACT.values()), UTILISATION)


def columns_of(joint: Joint, units: Units) -> tuple[Column, ...]:
    """Return the columns of a contact of a joint: without stress ratios whose strength is unknown."""
    materials = [material for material in (joint.liner, joint.ball) if material is not None]
    known = {name for material in materials for name in material.strengths}
    ratios = {"yield_stress": UTILISATION, "allowable_pressure": PRESSURE_RATIO}
    return (*columns_in(units)[:-1], *(column for name, column in ratios.items() if name in known))


UTILISATION_NOTE = "utilisation_note"
"""Key in JSON of the reason why the utilisation does not cover the liner."""


def to_summary(contact: Any) -> dict[str, Any]:
    """Return a dictionary of a contact for JSON."""
    numbers = {column.name: arrays.to_list(column.values_of(contact)) for column in COLUMNS}
    strength = {
        UTILISATION.name: arrays.to_list(UTILISATION.values_of(contact)),
        UTILISATION_NOTE: contact.utilisation_note or None,
    }
    valid = arrays.to_list(contact.valid)
    return {"model": contact.model.name, **numbers, **strength, "valid": valid, "notes": list(contact.notes)}


def to_frame(contact: Any) -> pandas.DataFrame:
    """Return a pandas data frame of a contact with one row per point; see `Contact.to_frame`."""
    needs("study", "pandas")
    import pandas

    columns = {column.quantity.column: arrays.to_numpy(column.values_of(contact)).ravel() for column in COLUMNS}
    return pandas.DataFrame({**columns, "valid": arrays.to_numpy(contact.valid).ravel()})


def to_text(contact: Any) -> str:
    """Format a contact as lines of text: model, joint, quantities and notes."""
    if arrays.all_true(contact.indentation == contact.indentation) is None:
        return f"<Contact of {contact.model.name}, traced>"
    rows = _format_rows(contact)
    width = max(len(number) for _, number, _ in rows)
    lines = [f"{contact.model.name} on {contact.joint}"]
    lines += [f"  {name:<19}{number:>{width}} {unit}".rstrip() for name, number, unit in rows]
    return "\n".join([*lines, *(f"  note: {note}" for note in contact.notes)])


def to_html(contact: Any) -> str:
    """Format a contact as an HTML table for a notebook."""
    align = "style='text-align:left'"
    rows = "".join(
        f"<tr><td {align}>{name.replace('_', ' ')}</td><td>{escape(number)}</td><td {align}>{unit}</td></tr>"
        for name, number, unit in _format_rows(contact)
    )
    notes = "".join(f"<div>{escape(note)}</div>" for note in contact.notes)
    return f"<b>{escape(contact.model.name)}</b><div>{escape(str(contact.joint))}</div><table>{rows}</table>{notes}"


def count_text(valid: Array) -> str:
    """Format a mask of valid points: "yes" or "no" for one point, such as "3 of 5" for several."""
    mask = arrays.to_numpy(valid)
    return ("yes" if mask.item() else "no") if mask.size == 1 else f"{int(mask.sum())} of {mask.size}"


def number_text(value: Array, digits: int, gap: str) -> str:
    """Format a number, or the range of an array, such as "3 to 5"; `gap` if all are NaN."""
    if type(value) is float:
        return gap if value != value else f"{value:.{digits}g}"
    values = arrays.to_numpy(value)
    numbers = values[~numpy.isnan(values)]
    if not numbers.size:
        return gap
    low, high = f"{numbers.min():.{digits}g}", f"{numbers.max():.{digits}g}"
    return low if low == high else f"{low} to {high}"


def _format_rows(contact: Any) -> list[tuple[str, str, str]]:
    is_single = arrays.to_numpy(contact.indentation).size == 1
    rows = [
        (column.attribute, number_text(column.values_of(contact), 6 if is_single else 5, "no answer"), column.unit)
        for column in COLUMNS
    ]
    if is_single and contact.joint.strengths():
        value = UTILISATION.values_of(contact)
        rows += [(UTILISATION.attribute, number_text(value, 3, ""), "")] if value == value else []
    return [*rows, ("valid", count_text(contact.valid), "")]
