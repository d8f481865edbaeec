"""Numbers of a contact as the page shows them: text and HTML, in the units that are chosen."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from math import floor, isfinite, isnan, log10
from typing import Any

from ..catalogue import reference
from ..compare import Comparison
from ..contact import Contact
from ..contact.describe import COLUMNS, Column
from ..core.kinds import Unit
from ..core.quantities import HEADLINE, Quantity
from ..reports.style import line_of
from ..reports.unit_systems import Units
from .chart import swatch
from .reading import Reading, number_text

_SPELT = {"°": "deg", "in²": "in2", "µm": "um", "mm²": "mm2"}
"""Units as the head of a column in a file has them."""


def alert(sentence: str) -> str:
    """A sentence that says why something cannot be done."""
    return f"<p class='refused' role='alert'>{escape(sentence)}</p>"


def notes_list(notes: Iterable[str]) -> str:
    """What a model says of its answer."""
    return f"<ul class='notes'>{''.join(f'<li>{escape(note)}</li>' for note in notes)}</ul>"


def number_cell(title: str, value: float, unit: str, more: str = "") -> str:
    """One number with its unit, and what is to be said of it below."""
    behind = "" if isnan(value) else f" <span class='unit'>{escape(unit)}</span>"
    small = f"<small>{escape(more)}</small>" if more else ""
    return f"<div><dt>{escape(title)}</dt><dd>{number_text(value)}{behind}{small}</dd></div>"


def progress(words: str, share: float | None, stop: str = "", again: str = "") -> str:
    """How far something is, with a button that stops it or begins it again: what it tells the view."""
    bar = "" if share is None else f"<progress max='1' value='{share:.3f}' aria-label='progress'></progress> "
    buttons = "".join(
        f" <button type='button' class='plain' data-tell='{told}'>{said}</button>"
        for told, said in ((stop, "Stop"), (again, "Go on"))
        if told
    )
    return f"<p class='quiet'>{bar}{escape(words)}{buttons}</p>"


def trust(contact: Contact, notes: Sequence[str]) -> str:
    """Return validity and notes of a contact as HTML; words repeat what the colour shows."""
    return f"{doubt(bool(contact.valid))}{notes_list(notes) if notes else ''}"


def doubt(valid: bool, name: str = "") -> str:
    """Return the warning for a contact outside its model's validity, with the design's name; empty if valid."""
    head = f"{escape(name)}: " if name else ""
    return "" if valid else f"<p class='trust no'>✗ {head}outside the range in which this model can be trusted</p>"


def models_table(comparison: Comparison, reading: Reading) -> str:
    """Every model in a row, with its deviation from the exact answer, its validity, and its line in the charts."""
    shown = [each for each in reading.columns if each.attribute in HEADLINE]
    heads = "".join(f"<th scope='col'>{escape(each.head)}</th>" for each in shown)
    rows = "".join(_row(comparison, name, shown) for name in comparison)
    missing = "".join(
        f"<tr><th scope='row'>{escape(name)}</th><td colspan='{len(shown) + 1}' class='text'>{escape(why)}</td></tr>"
        for name, why in comparison.missing.items()
    )
    return (
        "<div class='wide models' tabindex='0' role='region' aria-label='every model'><table>"
        f"<tr><th scope='col'>model</th>{heads}<th scope='col' class='text'>trust it here?</th></tr>"
        f"{rows}{missing}</table></div>"
        "<p class='quiet'>Small: difference from the exact answer.</p>"
    )


def _row(comparison: Comparison, name: str, shown: list[Column]) -> str:
    contact, apart = comparison[name], comparison.deviation(name)
    cells = "".join(_number(each, contact, apart) for each in shown)
    why = "yes" if bool(contact.valid) else f"no: {'; '.join(contact.notes)}"
    kind = "reference" if name == reference.name else "valid" if bool(contact.valid) else "doubtful"
    head = f"<th scope='row'>{swatch(line_of(name))}{escape(name)}</th>"
    return f"<tr class='{kind}'>{head}{cells}<td class='text'>{escape(why)}</td></tr>"


def _number(each: Column, contact: Contact, apart: Mapping[str, Any] | None) -> str:
    """A cell, which says its own head where there is no room for one above."""
    text = number_text(float(each.values_of(contact)))
    return f"<td data-head='{escape(each.head)}'>{text}{_apart(apart, each.name)}</td>"


def _apart(deviation: Mapping[str, Any] | None, name: str) -> str:
    return "" if deviation is None else f"<small>{percent(float(deviation[name]), '+').replace('below', '<')}</small>"


def percent(share: float, sign: str = "") -> str:
    """A small share of one, in percent, without more digits than it deserves."""
    if not isfinite(share):
        return ""
    if share == 0:
        return "0 %"
    if abs(share) < 1e-5:
        return "below 0.001 %"
    digits = max(0, 1 - floor(log10(abs(100 * share))))
    return f"{100 * share:{sign}.{digits}f} %"


def number_rows(head: str, contacts: Mapping[str, Contact], reading: Reading) -> list[list[Any]]:
    """A table with its head: a row a contact, its numbers its columns named by quantity and unit."""
    columns = COLUMNS if reading.units is Units.SI else reading.columns
    rows = [
        [name, *(float(each.values_of(contact)) for each in columns), bool(contact.valid)]
        for name, contact in contacts.items()
    ]
    return [[head, *(column_of(each.quantity, each.reading) for each in columns), "valid"], *rows]


def told(value: Any) -> str:
    """A value of a file as a page for people has it: four digits, and words for what is none."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value) if isinstance(value, float | int) else str(value)


def unit_of_files(quantity: Quantity, reading: Reading) -> Unit:
    """The unit of a number in a file: mm, N, MPa and degrees, or that of an inch page."""
    return quantity.written if reading.units is Units.SI else reading.unit(quantity)


def column_of(quantity: Quantity, unit: Unit) -> str:
    """The head of a column in a file, which ends in the unit."""
    if unit == quantity.written or not unit.text:
        return quantity.column
    return f"{quantity.name}_{_SPELT.get(unit.text, unit.text).replace('/', '_per_').replace(' ', '_')}"
