"""Text and HTML of contacts for the page: numbers, tables, verdicts and notes in the chosen units."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from math import floor, isfinite, isnan, log10
from typing import Any

from ...catalogue import reference
from ...compare import Comparison, relative_deviation
from ...contact import Contact
from ...contact.describe import COLUMNS, Column
from ...contact.strength import unchecked_strength_reason, von_mises_ratio
from ...contact.verdict import StrengthUse, strength_uses_at
from ...core.kinds import Unit
from ...core.quantities import HEADLINE, STRENGTH, Quantity
from ...reports.style import line_of
from ...reports.unit_systems import Units
from ..pictures.chart import swatch
from .reading import Reading, number_text

_SPELT = {"°": "deg", "in²": "in2", "µm": "um", "mm²": "mm2"}
"""Units as the head of a column in a file has them."""


def alert(sentence: str) -> str:
    """Return an error message."""
    return f"<p class='refused' role='alert'>{escape(sentence)}</p>"


def notes_list(notes: Iterable[str]) -> str:
    """List the notes of a model."""
    return f"<ul class='notes'>{''.join(f'<li>{escape(note)}</li>' for note in notes)}</ul>"


def number_cell(title: str, value: float, unit: str, more: str = "") -> str:
    """Return a number with its unit, and a remark below it."""
    behind = "" if isnan(value) else f" <span class='unit'>{escape(unit)}</span>"
    small = f"<small>{escape(more)}</small>" if more else ""
    return f"<div><dt>{escape(title)}</dt><dd>{number_text(value)}{behind}{small}</dd></div>"


def progress(words: str, share: float | None, stop: str = "", again: str = "") -> str:
    """Return a progress bar with buttons to stop or continue, named by the events they send."""
    bar = "" if share is None else f"<progress max='1' value='{share:.3f}' aria-label='progress'></progress> "
    buttons = "".join(
        f" <button type='button' class='plain' data-tell='{value_text}'>{label}</button>"
        for value_text, label in ((stop, "Stop"), (again, "Go on"))
        if value_text
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
    """Tabulate the models with deviation from the exact result, validity and line style."""
    shown = [column for column in reading.columns if column.attribute in HEADLINE]
    heads = "".join(f"<th scope='col'>{escape(column.head)}</th>" for column in shown)
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
    cells = "".join(_number(column, contact, apart) for column in shown)
    why = "yes" if bool(contact.valid) else f"no: {'; '.join(contact.notes)}"
    kind = "reference" if name == reference.name else "valid" if bool(contact.valid) else "doubtful"
    head = f"<th scope='row'>{swatch(line_of(name))}{escape(name)}</th>"
    return f"<tr class='{kind}'>{head}{cells}<td class='text'>{escape(why)}</td></tr>"


def _number(column: Column, contact: Contact, apart: Mapping[str, Any] | None) -> str:
    """Return a table cell that carries its own heading for narrow pages."""
    text = number_text(float(column.values_of(contact)))
    return f"<td data-head='{escape(column.head)}'>{text}{_deviation_cell(apart, column.name)}</td>"


def _deviation_cell(deviation: Mapping[str, Any] | None, name: str) -> str:
    return "" if deviation is None else f"<small>{percent(float(deviation[name]), '+').replace('below', '<')}</small>"


def percent(share: float, sign: str = "") -> str:
    """Format a small ratio in percent with few digits."""
    if not isfinite(share):
        return ""
    if share == 0:
        return "0 %"
    if abs(share) < 1e-5:
        return "below 0.001 %"
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


_LITTLE_MARGIN = 0.8
"""Utilisation above which the margin is small."""


def estimate_von_mises(contact: Contact) -> float:
    """Estimate the largest von Mises stress (MPa) in the liner by a fit, about 6 % off."""
    joint = contact.joint
    return float(von_mises_ratio(contact.half_angle, joint.liner.poisson, joint.thickness_ratio) * contact.max_pressure)


def most_used(contact: Contact, von_mises: float) -> StrengthUse | None:
    """Return the strength of liner or ball with the largest utilisation; None if unknown."""
    return next(iter(strength_uses_at(contact, von_mises)), None)


def verdict_sentence(contact: Contact, strength_use: StrengthUse | None) -> tuple[bool | None, str]:
    """Return a verdict and its sentence; None without a strength or outside the validity."""
    if strength_use is None or (strength_use.ratio <= 1 and not contact.joint.liner.strengths):
        return None, f"No verdict: {unchecked_strength_reason(contact.joint)}. Enter the liner's allowable pressure."
    if strength_use.ratio > 1:
        return False, f"The {strength_use.part} is overloaded: {strength_use}"
    if not bool(contact.valid):
        return None, "No verdict: this contact is outside the range of its model"
    margin = ", by a small margin" if strength_use.ratio > _LITTLE_MARGIN else ""
    return True, f"The {strength_use.part} is within its strength{margin}"


_MAIN_QUANTITY = "max_pressure"
_AT_THE_POLE = ("pole_pressure", "max_pressure_angle")
"""Quantities that repeat others if the pressure is largest at the pole."""


def headline(
    contact: Contact, exact: Contact | None, von_mises: float, reading: Reading, surely: str = "about "
) -> str:
    """Return the numbers of a contact as HTML; `surely` precedes a utilisation from `von_mises` (MPa)."""
    strength_use = most_used(contact, von_mises)
    listed = [
        column
        for column in reading.columns
        if column.attribute != _MAIN_QUANTITY and not _repeats_pole(column, contact)
    ]
    first = next(column for column in reading.columns if column.attribute == _MAIN_QUANTITY)
    cells = "".join(_quantity_cell(column, contact) for column in listed)
    return (
        f"<dl class='first'>{_quantity_cell(first, contact)}</dl>"
        f"{_utilisation_bar(strength_use, surely, contact, reading)}"
        f"{_verdict_line(contact, strength_use)}{trust(contact, _notes(contact))}"
        f"<dl class='numbers'>{cells}</dl><p class='quiet'>{escape(accuracy_sentence(contact, exact))}</p>"
    )


def _notes(contact: Contact) -> list[str]:
    """List the notes; omit the utilisation note where the verdict already states it."""
    return [note for note in contact.notes if contact.joint.liner.strengths or note != contact.utilisation_note]


def _repeats_pole(column: Column, contact: Contact) -> bool:
    return column.attribute in _AT_THE_POLE and float(contact.max_pressure_angle) == 0


def _quantity_cell(column: Column, contact: Contact) -> str:
    value = float(column.values_of(contact))
    unit = "" if value != value else f" <span class='unit'>{escape(column.unit)}</span>"
    return (
        f"<div><dt>{escape(column.title)} <i>{escape(column.symbol)}</i></dt>"
        f"<dd data-name='{column.attribute}' data-value='{value!r}'>{number_text(value)}{unit}</dd></div>"
    )


def _utilisation_bar(strength_use: StrengthUse | None, surely: str, contact: Contact, reading: Reading) -> str:
    """Return the utilisation as a bar and in words."""
    if strength_use is None or strength_use.ratio != strength_use.ratio:
        return ""
    about = "" if strength_use.strength == "allowable_pressure" else surely
    name = getattr(contact.joint, strength_use.part).name or strength_use.part
    text = f"{about}{strength_use} ({name}, {reading.with_unit(STRENGTH[strength_use.strength], strength_use.allowed)})"
    kind = "yes" if strength_use.ratio <= 1 else "no"
    return (
        f"<div class='bar' aria-hidden='true'>"
        f"<i class='{kind}' style='width:{min(100.0, 100 * strength_use.ratio):.1f}%'></i>"
        f"</div><p class='share'>{escape(text)}</p>"
    )


def _verdict_line(contact: Contact, strength_use: StrengthUse | None) -> str:
    holds, words = verdict_sentence(contact, strength_use)
    kind, sign = {True: ("yes", "✓ "), False: ("no", "✗ "), None: ("quiet", "")}[holds]
    return f"<p class='verdict {kind}' role='status'>{sign}{escape(words)}</p>"


def accuracy_sentence(contact: Contact, exact: Contact | None) -> str:
    """State the largest deviation from the exact result; empty if unknown."""
    apart = (
        _estimated_error(contact)
        if exact is None or exact.model.name == contact.model.name
        else _largest_deviation(contact, exact)
    )
    if apart != apart or apart == 0:
        return ""
    return f"All within {100 * max(apart, 1e-5):.2g} % of the exact answer"


def _estimated_error(contact: Contact) -> float:
    """Return the largest estimated error of an exact result."""
    known: dict[str, Any] = getattr(contact, "error", {})
    return max((float(error) for error in known.values()), default=float("nan"))


def _largest_deviation(contact: Contact, exact: Contact) -> float:
    deviations = [
        abs(float(relative_deviation(column.values_of(contact), column.values_of(exact)))) for column in COLUMNS
    ]
    return max((share for share in deviations if share == share), default=float("nan"))
