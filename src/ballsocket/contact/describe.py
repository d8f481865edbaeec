"""Contacts as text, HTML tables, data frames and dictionaries for JSON."""

from __future__ import annotations

from html import escape
from math import nan
from typing import TYPE_CHECKING, Any

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.checks import needs
from ..core.kinds import Kind, Unit
from ..core.quantities import BEARING, CONTACT, PLASTIC, Quantity
from ..problem import Joint

if TYPE_CHECKING:
    import pandas


UTILISATION = BEARING["utilisation"]

PRESSURE_RATIO = Quantity(
    "pressure_ratio",
    "pmax/pa",
    "largest over allowable pressure",
    Kind.NUMBER,
    "Largest pressure over the allowable pressure, the larger of liner and ball.",
)
"""Quantity that is printed if an allowable pressure is known."""


def quantities_of(joint: Joint) -> tuple[Quantity, ...]:
    """Return the printed quantities of a contact of a joint: without stress ratios whose strength is unknown."""
    materials = [material for material in (joint.liner, joint.ball) if material is not None]
    known = {name for material in materials for name in material.strengths}
    ratios = {"yield_stress": UTILISATION, "allowable_pressure": PRESSURE_RATIO}
    return (*CONTACT.values(), *(quantity for name, quantity in ratios.items() if name in known))


def quantities_of_contact(contact: Any) -> dict[str, Quantity]:
    """Return the printed quantities of a contact by name, with those of its liner if that may yield."""
    return {**CONTACT, **(PLASTIC if contact.yields else {})}


def number_of(contact: Any, quantity: Quantity) -> float:
    """Return a quantity of a single contact in internal units; NaN without a result or a strength."""
    if quantity.name in PLASTIC and not contact.yields:
        return nan
    return float(pressure_ratio(contact) if quantity is PRESSURE_RATIO else getattr(contact, quantity.name))


def pressure_ratio(contact: Any) -> Array:
    """Compute `PRESSURE_RATIO` of a contact; NaN without an allowable pressure."""
    ratio = nan * contact.max_pressure
    for material in (contact.joint.liner, contact.joint.ball):
        if material is not None and material.allowable_pressure is not None:
            other = contact.max_pressure / material.allowable_pressure
            ratio = arrays.where(ratio > other, ratio, other)
    return ratio


def values_of(contact: Any, quantity: Quantity, unit: Unit | None = None) -> Array:
    """Return a quantity of a contact in a unit, by default that of JSON; -0 becomes 0."""
    return getattr(contact, quantity.name) * (unit or quantity.written).factor + 0.0


UTILISATION_NOTE = "utilisation_note"
"""Key in JSON of the reason why the utilisation does not cover the liner."""


def to_summary(contact: Any) -> dict[str, Any]:
    """Return a dictionary of a contact for JSON."""
    numbers = {
        quantity.key: arrays.to_list(values_of(contact, quantity))
        for quantity in quantities_of_contact(contact).values()
    }
    strength = {
        UTILISATION.key: arrays.to_list(values_of(contact, UTILISATION)),
        PRESSURE_RATIO.key: arrays.to_list(pressure_ratio(contact)),
        UTILISATION_NOTE: contact.utilisation_note or None,
    }
    valid = arrays.to_list(contact.valid)
    return {"model": contact.model.name, **numbers, **strength, "valid": valid, "notes": list(contact.notes)}


def to_frame(contact: Any) -> pandas.DataFrame:
    """Return a pandas data frame of a contact with one row per point; see `Contact.to_frame`."""
    needs("study", "pandas")
    import pandas

    columns = {
        quantity.column: arrays.to_numpy(values_of(contact, quantity)).ravel()
        for quantity in quantities_of_contact(contact).values()
    }
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
    digits = 6 if is_single else 5
    rows = [
        (name, number_text(values_of(contact, quantity), digits, "no answer"), quantity.written.text)
        for name, quantity in quantities_of_contact(contact).items()
    ]
    if is_single and contact.joint.strengths():
        value = contact.utilisation
        rows += [(UTILISATION.name, number_text(value, 3, ""), "")] if value == value else []
    return [*rows, ("valid", count_text(contact.valid), "")]
