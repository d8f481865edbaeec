"""A contact in words and numbers: for a terminal, a notebook and JSON."""

from __future__ import annotations

from html import escape
from math import degrees
from typing import Any

import numpy

from . import arrays
from .arrays import Array

# name in JSON, attribute, unit
_COLUMNS = (
    ("force", "force", "N"),
    ("indentation", "indentation", "mm"),
    ("half_angle_deg", "half_angle", "deg"),
    ("max_pressure", "max_pressure", "MPa"),
    ("area", "area", "mm²"),
    ("stiffness", "stiffness", "N/mm"),
    ("energy", "energy", "N mm"),
    ("foundation_modulus", "foundation_modulus", "MPa/mm"),
)
QUANTITIES = tuple(name for name, _, _ in _COLUMNS)
"""The names of a contact's numbers in JSON."""


def summary(contact: Any) -> dict[str, Any]:
    """One dictionary for JSON."""
    numbers = {name: arrays.to_list(value) for name, value, _ in _quantities(contact)}
    valid = arrays.to_list(contact.valid)
    return {"model": contact.model.name, **numbers, "valid": valid, "notes": list(contact.notes)}


def text(contact: Any) -> str:
    """A few aligned lines."""
    if arrays.truth(contact.indentation == contact.indentation) is None:
        return f"<Contact of {contact.model.name}, traced>"
    rows = _rows(contact)
    width = max(len(number) for _, number, _ in rows)
    lines = [f"{contact.model.name} on {contact.joint}"]
    lines += [f"  {name:<19}{number:>{width}} {unit}".rstrip() for name, number, unit in rows]
    return "\n".join([*lines, *(f"  note: {note}" for note in contact.notes)])


def html(contact: Any) -> str:
    """The same as a table for a notebook."""
    left = "style='text-align:left'"
    rows = "".join(
        f"<tr><td {left}>{name.replace('_', ' ')}</td><td>{escape(number)}</td><td {left}>{unit}</td></tr>"
        for name, number, unit in _rows(contact)
    )
    notes = "".join(f"<div>{escape(note)}</div>" for note in contact.notes)
    return f"<b>{escape(contact.model.name)}</b><div>{escape(str(contact.joint))}</div><table>{rows}</table>{notes}"


def count(valid: Array) -> str:
    """yes or no; how many of how many for more than one."""
    listed = arrays.to_numpy(valid)
    return ("yes" if listed.item() else "no") if listed.size == 1 else f"{int(listed.sum())} of {listed.size}"


def _quantities(contact: Any) -> list[tuple[str, Array, str]]:
    """Name, value and unit of each column, angles in degrees."""
    values = [(name, getattr(contact, attribute), unit) for name, attribute, unit in _COLUMNS]
    return [(name, value * degrees(1.0) if unit == "deg" else value, unit) for name, value, unit in values]


def _rows(contact: Any) -> list[tuple[str, str, str]]:
    rows = [
        (name.removesuffix("_deg"), _range_text(arrays.to_numpy(value)), unit)
        for name, value, unit in _quantities(contact)
    ]
    return [*rows, ("valid", count(contact.valid), "")]


def _range_text(value: numpy.ndarray) -> str:
    if value.size == 1:
        return f"{value.item():.6g}"
    known = value[numpy.isfinite(value)]
    return f"{known.min():.5g} to {known.max():.5g}" if known.size else "no answer"
