"""Texts and blocks of contacts for the page: numbers, tables, verdicts and notes in the chosen units."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from html import escape
from math import floor, isfinite, isnan, log10
from typing import Any

from ...comparison import Comparison, relative_deviation
from ...contact import Contact
from ...contact.describe import values_of
from ...contact.verdict import Verdict
from ...core.answers import Check
from ...core.kinds import Unit
from ...core.quantities import CONTACT, HEADLINE, JOINT, Quantity
from ...core.unit_systems import Units
from ...design_checks import checks_of, unchecked_text, verdict_of
from ...elasticity.off_axis.contact import OffAxisContact
from ...model_catalogue import reference
from ...problem.cup import Cup
from ...reports.style import line_of
from .blocks import Block, Cell, checks_table, notes_list, numbers, sentence, styled_row, table
from .reading import Reading, number_text, unit_suffix

_SPELT = {"°": "deg", "in²": "in2", "µm": "um", "mm²": "mm2"}  # units as the head of a column in a file has them
_MAIN_QUANTITY = "max_pressure"


def alert(sentence: str) -> str:
    """Return an error message."""
    return f"<p class='refused' role='alert'>{escape(sentence)}</p>"


def number_cell(title: str, value: float, unit: str, more: str = "", name: str = "", why: str = "") -> list[Any]:
    """Return a number of `numbers`: name, title, text, unit, a remark below it, the value, and an explanation."""
    missing = isnan(value)
    text, unit = number_text(value), "" if missing else unit_suffix(unit)
    return [name, title, text, unit, more, None if missing or not name else value, why]


def quantity_cell(quantity: Quantity, value: Any, reading: Reading, title: str = "", more: str = "") -> list[Any]:
    """Return a number in internal units by the title of its quantity, or another one, in the units of the page."""
    unit = reading.unit(quantity)
    return number_cell(title or quantity.title, float(value) * unit.factor, unit.text, more)


def trust(contact: Contact, notes: Sequence[str], reading: Reading) -> list[Block]:
    """Return validity and notes of a contact; words repeat what the colour shows."""
    return [*doubt(bool(contact.valid)), *([notes_list(notes, reading)] if notes else [])]


def doubt(valid: bool, name: str = "") -> list[Block]:
    """Return the warning for a contact outside its model's validity, with the design's name; none if valid."""
    head = f"{name}: " if name else ""
    return [] if valid else [sentence(f"✗ {head}outside the range in which this model can be trusted", "trust no")]


def models_table(comparison: Comparison, reading: Reading) -> list[Block]:
    """Tabulate the models with deviation from the exact result, validity and line style."""
    exact = comparison.contacts.get(reference.name)
    quantities = [CONTACT[name] for name in HEADLINE]
    heads = [[quantity.head(reading.unit(quantity)), "", "", quantity.title] for quantity in quantities]
    rows = [row for name, contact in comparison.items() for row in _rows(name, contact, exact, reading)]
    rows += [styled_row([name, [why, "", "text"]]) for name, why in comparison.missing.items()]
    return [
        table(["model", *heads, ["valid here?", "", "text"]], rows, "models"),
        sentence("In small digits: the difference from the exact solution."),
    ]


@lru_cache(maxsize=1024)
def _rows(name: str, contact: Contact, exact: Contact | None, reading: Reading) -> list[dict[str, Any]]:
    valid = bool(contact.valid)
    kind = "doubtful" if not valid else "reference" if name == reference.name else "valid"
    cells: list[Cell] = [name, *(_number(quantity, contact, exact, reading) for quantity in HEADLINE)]
    row = styled_row([*cells, ["yes" if valid else "no", "", "text"]], kind, line_of(name))
    why = "; ".join(map(reading.units.sentence, contact.notes))
    return [row] if valid else [row, styled_row([[why, "", "text"]], "why")]


def _number(name: str, contact: Contact, exact: Contact | None, reading: Reading) -> list[str]:
    """Return a table cell with its deviation from the exact result."""
    value, small = float(reading.values_of(contact, CONTACT[name])), ""
    if exact is not None and exact is not contact:
        share = float(relative_deviation(value, float(reading.values_of(exact, CONTACT[name]))))
        small = percent(share, "+") if share else ""
    return [number_text(value), small]


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
    columns = [(quantity, unit_of_files(quantity, reading)) for quantity in CONTACT.values()]
    rows = [
        [name, *(float(values_of(contact, *column)) for column in columns), bool(contact.valid)]
        for name, contact in contacts.items()
    ]
    return [[head, *(column_of(quantity, reading)[0] for quantity in CONTACT.values()), "valid"], *rows]


def value_text(value: Any) -> str:
    """Format a value of a file for readers: four digits, or words."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value) if isinstance(value, float | int) else str(value)


def unit_of_files(quantity: Quantity, reading: Reading) -> Unit:
    """Return the unit of a number in files: mm, N, MPa and degrees, or imperial."""
    return quantity.written if reading.units is Units.SI else reading.unit(quantity)


def column_of(quantity: Quantity, reading: Reading) -> tuple[str, float]:
    """Return the heading of a column in a file, which ends in the unit, and the factor of its numbers."""
    unit = unit_of_files(quantity, reading)
    if unit == quantity.written or not unit.text:
        return quantity.column, unit.factor
    spelt = _SPELT.get(unit.text, unit.text).replace("/", "_per_").replace(" ", "_")
    return f"{quantity.name}_{spelt}", unit.factor


VERDICT_KINDS = {Verdict.KEPT: "yes", Verdict.UNDECIDED: "doubt", Verdict.EXCEEDED: "no"}
"""Style of each verdict on the page."""

_SYMBOL = re.compile(r"[^\W\d]+\d?")  # such as R1, p0 and ε, without exponents
_LENGTHS = ("ball_radius", "socket_radius", "clearance", "liner_thickness")
_AT_THE_POLE = ("pole_pressure", "max_pressure_angle")
"""Quantities that repeat others if the pressure is largest at the pole."""


def distinct_quantities(max_pressure_angle: float) -> list[Quantity]:
    """List the quantities of a contact, without those that repeat others if the pressure is largest at the pole."""
    return [CONTACT[name] for name in CONTACT if max_pressure_angle or name not in _AT_THE_POLE]


@lru_cache(maxsize=256)
def headline(
    contact: Contact,
    exact: Contact | None,
    cup: Cup,
    reading: Reading,
    von_mises: float | None = None,
    explained: tuple[str, ...] = (),
) -> list[Any]:
    """Return the numbers and checks of a contact; `von_mises` (MPa) and slow notes may follow.

    Some numbers are `explained`.
    """
    quantities = distinct_quantities(float(contact.max_pressure_angle))
    cells = {}
    for quantity in quantities:
        why = explanation(quantity, contact, reading) if quantity.name in explained else ""
        value, unit = float(reading.values_of(contact, quantity)), reading.unit(quantity).text
        cells[quantity.name] = number_cell(quantity.title, value, unit, name=quantity.name, why=why)
    notes = contact.quick_notes if von_mises is None else contact.notes
    if not contact.joint.liner.strengths:  # the verdict already states the utilisation
        notes = tuple(note for note in notes if note != contact.utilisation_note)
    sources = "; ".join(map(str, contact.model.sources))
    model = f"{contact.model.name}: {contact.model.title}.{f' Source: {sources}.' if sources else ''}"
    return [
        numbers([cells.pop(_MAIN_QUANTITY)], "first"),
        *checked(checks_of(contact, cup, von_mises), reading),
        *trust(contact, notes, reading),
        numbers(cells.values(), "numbers"),
        sentence(accuracy_sentence(contact, exact)),
        f"<details class='quiet' data-why='model'><summary>Model and sources</summary><p>{escape(model)}</p></details>",
    ]


def checked(rows: Sequence[Check], reading: Reading) -> list[Block]:
    """Return the verdict on checks in one sentence, and their table."""
    verdict, words = verdict_of(rows)
    kind = "doubt" if verdict is Verdict.KEPT and any(row.is_near for row in rows) else VERDICT_KINDS[verdict]
    unchecked = f"N{text[1:]}" if (text := unchecked_text(rows)) else ""
    return [
        sentence(f"{verdict.sign} {words}", f"verdict {kind}"),
        *([sentence(unchecked)] if unchecked else []),
        *([checks_table(rows, reading)] if rows else []),
    ]


def explanation(quantity: Quantity, contact: Contact, reading: Reading) -> str:
    """Explain a number: its symbol and meaning, and the values of the symbols in that."""
    meaning, joint = quantity.meaning.replace("`", ""), contact.joint
    symbols = _SYMBOL.findall(meaning)
    values = {JOINT[name]: getattr(joint, name) for name in _LENGTHS}
    values |= {other: getattr(contact, other.name) for other in CONTACT.values() if other is not quantity}
    known = [
        f"{other.symbol} = {reading.with_unit(other, float(value))}"
        for other, value in values.items()
        if other.symbol in symbols
    ]
    here = f" Here {', '.join(known)}." if known else ""
    return f"{quantity.symbol}: {meaning}{here}"


def accuracy_sentence(contact: Contact, exact: Contact | None) -> str:
    """State the estimated error in a real cup, else the largest deviation from the exact result; empty if unknown."""
    if isinstance(contact, OffAxisContact):
        return f"Estimated error of the largest pressure in the real cup: {percent(contact.error['max_pressure'])}"
    if exact is None or exact.model.name == contact.model.name:
        known = [float(contact.error.get(name, 0.0)) for name in CONTACT]
    else:
        pairs = ((values_of(contact, quantity), values_of(exact, quantity)) for quantity in CONTACT.values())
        known = [float(relative_deviation(value, truth)) for value, truth in pairs]
    apart = max((abs(share) for share in known if share == share), default=0.0)
    if apart == 0:
        return ""
    return f"All within {100 * max(apart, 1e-5):.2g} % of the exact solution"
