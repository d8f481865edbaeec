"""Text and HTML of contacts for the page: numbers, tables, verdicts and notes in the chosen units."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from html import escape
from math import floor, isfinite, isnan, log10
from typing import Any

from ...comparison import Comparison, relative_deviation
from ...contact import Contact
from ...contact.describe import COLUMNS, Column
from ...contact.verdict import Verdict
from ...core.kinds import Unit
from ...core.quantities import HEADLINE, Quantity
from ...core.unit_systems import Units
from ...elasticity.off_axis.contact import OffAxisContact
from ...model_catalogue import reference
from ...problem.cup import Cup
from ...reports.check_table import Check, checks_html, checks_of, unchecked_text, verdict_of
from ...reports.style import line_of
from ..pictures.chart import swatch
from .reading import Reading, number_text

_SPELT = {"°": "deg", "in²": "in2", "µm": "um", "mm²": "mm2"}  # units as the head of a column in a file has them
_MAIN_QUANTITY = "max_pressure"


def alert(sentence: str) -> str:
    """Return an error message."""
    return f"<p class='refused' role='alert'>{escape(sentence)}</p>"


def notes_list(notes: Iterable[str]) -> str:
    """List the notes of a model."""
    return f"<ul class='notes'>{''.join(f'<li>{escape(note)}</li>' for note in notes)}</ul>"


def number_cell(title: str, value: float, unit: str, more: str = "") -> str:
    """Return a number with its unit, and a remark below it."""
    behind = "" if isnan(value) else _unit_html(unit)
    small = f"<small>{escape(more)}</small>" if more else ""
    return f"<div><dt>{escape(title)}</dt><dd>{number_text(value)}{behind}{small}</dd></div>"


def quantity_cell(quantity: Quantity, value: Any, reading: Reading, title: str = "", more: str = "") -> str:
    """Return a number in internal units by the title of its quantity, or another one, in the units of the page."""
    unit = reading.unit(quantity)
    return number_cell(title or quantity.title, float(value) * unit.factor, unit.text, more)


def _unit_html(unit: str) -> str:
    return f"{'' if unit == '°' else ' '}<span class='unit'>{escape(unit)}</span>"


def trust(contact: Contact, notes: Sequence[str]) -> str:
    """Return validity and notes of a contact as HTML; words repeat what the colour shows."""
    return f"{doubt(bool(contact.valid))}{notes_list(notes) if notes else ''}"


def doubt(valid: bool, name: str = "") -> str:
    """Return the warning for a contact outside its model's validity, with the design's name; empty if valid."""
    head = f"{escape(name)}: " if name else ""
    return "" if valid else f"<p class='trust no'>✗ {head}outside the range in which this model can be trusted</p>"


def models_table(comparison: Comparison, reading: Reading) -> str:
    """Tabulate the models with deviation from the exact result, validity and line style."""
    exact, columns = comparison.contacts.get(reference.name), _shown_columns(reading)
    rows = "".join(_row(name, contact, exact, reading) for name, contact in comparison.items())
    heads = "".join(f"<th scope='col' title='{escape(column.title)}'>{head}</th>" for head, column in columns)
    missing = "".join(
        f"<tr><th scope='row'>{escape(name)}</th><td colspan='{len(columns) + 1}' class='text'>{escape(why)}</td></tr>"
        for name, why in comparison.missing.items()
    )
    return (
        "<div class='wide models' tabindex='0' role='region' aria-label='every model'><table>"
        f"<tr><th scope='col'>model</th>{heads}<th scope='col' class='text'>valid here?</th></tr>{rows}{missing}"
        "</table></div><p class='quiet'>In small digits: the difference from the exact solution.</p>"
    )


@lru_cache(maxsize=8)
def _shown_columns(reading: Reading) -> tuple[tuple[str, Column], ...]:
    return tuple((escape(column.head), column) for column in reading.columns if column.attribute in HEADLINE)


@lru_cache(maxsize=1024)
def _row(name: str, contact: Contact, exact: Contact | None, reading: Reading) -> str:
    cells = "".join(_number(head, column, contact, exact) for head, column in _shown_columns(reading))
    valid = bool(contact.valid)
    why = "yes" if valid else f"no: {'; '.join(contact.notes)}"
    kind = "doubtful" if not valid else "reference" if name == reference.name else "valid"
    head = f"<th scope='row'>{swatch(line_of(name))}{escape(name)}</th>"
    return f"<tr class='{kind}'>{head}{cells}<td class='text'>{escape(why)}</td></tr>"


def _number(head: str, column: Column, contact: Contact, exact: Contact | None) -> str:
    """Return a cell with its deviation from the exact result, and its own heading for narrow pages."""
    value, small = float(column.values_of(contact)), ""
    if exact is not None and exact is not contact:
        share = float(relative_deviation(value, float(column.values_of(exact))))
        small = f"<small>{escape(percent(share, '+'))}</small>" if share else ""
    return f"<td data-head='{head}'>{number_text(value)}{small}</td>"


def percent(share: float, sign: str = "") -> str:
    """Format a small ratio in percent with few digits."""
    if not isfinite(share):
        return ""
    if share == 0:
        return "0 %"
    if abs(share) < 1e-5:
        return "< 0.001 %"
    digits = max(0, 1 - floor(log10(abs(100 * share))))
    return f"{100 * share:{sign}.{digits}f} %"


def number_rows(head: str, contacts: Mapping[str, Contact], reading: Reading) -> list[list[Any]]:
    """Tabulate contacts for a file: a heading row, then one row for each contact."""
    columns = COLUMNS if reading.units is Units.SI else reading.columns
    rows = [
        [name, *(float(column.values_of(contact)) for column in columns), bool(contact.valid)]
        for name, contact in contacts.items()
    ]
    return [[head, *(column_of(column.quantity, column.reading) for column in columns), "valid"], *rows]


def value_text(value: Any) -> str:
    """Format a value of a file for readers: four digits, or words."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value) if isinstance(value, float | int) else str(value)


def unit_of_files(quantity: Quantity, reading: Reading) -> Unit:
    """Return the unit of a number in files: mm, N, MPa and degrees, or imperial."""
    return quantity.written if reading.units is Units.SI else reading.unit(quantity)


def column_of(quantity: Quantity, unit: Unit) -> str:
    """Return the heading of a column in a file, which ends in the unit."""
    if unit == quantity.written or not unit.text:
        return quantity.column
    return f"{quantity.name}_{_SPELT.get(unit.text, unit.text).replace('/', '_per_').replace(' ', '_')}"


VERDICT_KINDS = {Verdict.KEPT: "yes", Verdict.UNDECIDED: "doubt", Verdict.EXCEEDED: "no"}
"""Style of each verdict on the page."""

_AT_THE_POLE = ("pole_pressure", "max_pressure_angle")
"""Quantities that repeat others if the pressure is largest at the pole."""


def distinct_columns(reading: Reading, max_pressure_angle: float) -> list[Column]:
    """List the quantities of a contact, without those that repeat others if the pressure is largest at the pole."""
    return [column for column in reading.columns if max_pressure_angle or column.attribute not in _AT_THE_POLE]


@lru_cache(maxsize=256)
def headline(
    contact: Contact, exact: Contact | None, cup: Cup, reading: Reading, von_mises: float | None = None
) -> str:
    """Return the numbers and checks of a contact as HTML; `von_mises` (MPa) and slow notes may follow."""
    columns = distinct_columns(reading, float(contact.max_pressure_angle))
    first = next(column for column in columns if column.attribute == _MAIN_QUANTITY)
    cells = "".join(_quantity_cell(column, contact) for column in columns if column is not first)
    notes = contact.quick_notes if von_mises is None else contact.notes
    if not contact.joint.liner.strengths:  # the verdict already states the utilisation
        notes = tuple(note for note in notes if note != contact.utilisation_note)
    return (
        f"<dl class='first'>{_quantity_cell(first, contact)}</dl>"
        f"{checked(checks_of(contact, cup, von_mises), reading)}{trust(contact, notes)}"
        f"<dl class='numbers'>{cells}</dl><p class='quiet'>{escape(accuracy_sentence(contact, exact))}</p>"
    )


def checked(rows: Sequence[Check], reading: Reading) -> str:
    """Return the verdict on checks in one sentence, and their table, as HTML."""
    verdict, sentence = verdict_of(rows)
    status = f"<p class='verdict {VERDICT_KINDS[verdict]}' role='status'>{verdict.sign} {escape(sentence)}</p>"
    unchecked = f"<p class='quiet'>N{escape(text[1:])}</p>" if (text := unchecked_text(rows)) else ""
    return f"{status}{unchecked}{checks_html(rows, reading.with_unit) if rows else ''}"


def _quantity_cell(column: Column, contact: Contact) -> str:
    value = float(column.values_of(contact))
    unit = "" if isnan(value) else _unit_html(column.unit)
    return (
        f"<div><dt title='{escape(column.symbol)}'>{escape(column.title)}</dt>"
        f"<dd data-name='{column.attribute}' data-value='{value!r}'>{number_text(value)}{unit}</dd></div>"
    )


def accuracy_sentence(contact: Contact, exact: Contact | None) -> str:
    """State the estimated error in a real cup, else the largest deviation from the exact result; empty if unknown."""
    if isinstance(contact, OffAxisContact):
        return f"Estimated error of the largest pressure in the real cup: {percent(contact.error['max_pressure'])}"
    if exact is None or exact.model.name == contact.model.name:
        known = [float(contact.error.get(column.attribute, 0.0)) for column in COLUMNS]
    else:
        known = [float(relative_deviation(column.values_of(contact), column.values_of(exact))) for column in COLUMNS]
    apart = max((abs(share) for share in known if share == share), default=0.0)
    if apart == 0:
        return ""
    return f"All within {100 * max(apart, 1e-5):.2g} % of the exact solution"
