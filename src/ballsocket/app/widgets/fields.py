"""Inputs of the page as plain data, from which a script builds them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from math import degrees
from typing import Any

from ...core.checks import check_number, shown
from ...core.kinds import Kind, Unit
from ...core.quantities import Quantity
from ...files.units import parse, split_quantity
from .reading import Reading, box_text, unit_suffix

_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?(?=\D|$)")
_COMMA = re.compile(r"(?<=\d),(?=\d)|^,(?=\d)|(?<=[-+]),(?=\d)")

_MAX_SHOWN = 60  # characters of typed text in a message

Field = dict[str, Any]  # one input: its name, kind, label, value, and what its kind needs
Options = Iterable[Sequence[str]]  # values of a choice, each with its label unless that is the value
_KEY_REFUSED = re.compile(r"[\w.]+ (?:= (?:'[^']*'|\S+) (?P<rule>is not allowed: .*)|(?P<need>must .*))", re.DOTALL)


def capital(title: str) -> str:
    """Write a title with a capital letter."""
    return f"{title[:1].upper()}{title[1:]}"


def choice(name: str, label: str, options: Options, value: str) -> Field:
    """Return a list for one choice."""
    pairs = [[option, option] if isinstance(option, str) else list(option) for option in options]
    return {"name": name, "kind": "choice", "label": label, "options": pairs, "value": value}


def segments(name: str, label: str, options: Options, value: str) -> Field:
    """Return a row of buttons for one choice."""
    return {**choice(name, label, options, value), "kind": "segments"}


def several(name: str, label: str, options: Options, value: Iterable[str], pieces: Mapping[str, str]) -> Field:
    """Return a row of boxes for any number of choices, each with HTML before its label."""
    return {**choice(name, label, options, ""), "kind": "several", "value": list(value), "pieces": dict(pieces)}


def tick(name: str, label: str, value: bool) -> Field:
    """Return a tick box."""
    return {"name": name, "kind": "tick", "label": label, "value": value}


def number(name: str, label: str, unit: Unit, ends: tuple[float, float], step: float, value: float) -> Field:
    """Return an input for a number, with a slider over its typical range and the present value.

    `value` and `ends` are in the unit beside the box, to which `unit.factor` leads from that of a joint file.
    """
    low, high = min(ends[0], value), max(ends[1], value)
    slider = {"factor": unit.factor, "low": low, "high": high, "step": step, "value": value}
    return {**empty_number(name, label, unit, box_text(value, unit.text)), **slider}


def empty_number(name: str, label: str, unit: Unit, text: str = "") -> Field:
    """Return an input for a number without a slider."""
    return {"name": name, "kind": "number", "label": label, "unit": unit.text, "value": None, "text": text}


def words(name: str, label: str, value: str, rows: int = 1) -> Field:
    """Return an input for text of several rows."""
    return {"name": name, "kind": "words", "label": label, "value": value, "rows": rows}


def typed(label: str, text: Any, unit: Unit, kind: str) -> float:
    """Convert typed text, "0.2", "0,2", "0.2 mm" or "1 1/8 in", to the number of a table.

    A bare number has the `unit` beside the box, whose factor leads to it from the number in the table. Raises
    ValueError for no number, or one that could be two.

    Examples
    --------
    >>> typed("Clearance", "0,2", Unit("mm"), "length"), typed("Clearance", "0.2 mm", Unit("in", 1 / 25.4), "length")
    (0.2, 0.2)
    """
    if isinstance(text, int | float) and not isinstance(text, bool):
        return round(check_number(label, text) / unit.factor, 12)
    inside = f" in {'inches' if unit.text == 'in' else unit.text}" if unit.text else ""
    rule = f"{label} must be a number{inside}" + (f", or {Kind(kind).example.replace(', ', ' ')}" if unit.text else "")
    stripped = text.strip() if isinstance(text, str) else ""
    if not stripped:
        raise ValueError(f"{rule}, got {'nothing' if isinstance(text, str) else shown(text)}")
    if _THOUSANDS.match(stripped):
        plain_text = stripped.replace(",", "")
        raise ValueError(
            f"{label} {shown(stripped)} could be two numbers: write {plain_text} or {stripped.replace(',', '.', 1)}"
        )
    pointed = _COMMA.sub(".", stripped, count=1)
    try:
        number, written_unit = split_quantity(pointed)
        if not written_unit:
            return round(number / unit.factor, 12)
        value = parse(label, pointed, kind)
    except ValueError as error:
        raise ValueError(f"{rule}, got {shown(stripped)}") from error
    return round(degrees(value) if kind == Kind.ANGLE else value, 12)


def typed_quantity(label: str, text: Any, quantity: Quantity, reading: Reading) -> float:
    """Convert typed text to a number in internal units; a bare number has the unit of the page."""
    unit, written = reading.unit(quantity), quantity.written.factor
    return typed(label, text, Unit(unit.text, unit.factor / written), quantity.kind) / written


def refusal_of(field: Field, error: ValueError, value: Any) -> Field | None:
    """Return what a field shows beside a refused value, which stays in its box; None for a field without a box.

    The refusal of a key becomes one of the field's label, and states the number in use.
    """
    if field["kind"] == "limits":
        return {"error": str(error), "refused": value, "wrong": getattr(error, "index", None)}
    if field["kind"] not in ("number", "words"):
        return None
    sentence = in_words_of(field, str(error), value)
    return {"error": sentence, "refused": value if isinstance(value, str) else None}


def in_words_of(field: Field, sentence: str, text: Any) -> str:
    """Word the refusal of an edit by the label of its field instead of a key, and state the number in use."""
    unit, label, kept = unit_suffix(field.get("unit", "")), field["label"], field.get("text")
    refused = _KEY_REFUSED.fullmatch(sentence)
    if refused is not None:
        value = str(text).strip()[:_MAX_SHOWN]
        value += unit if value[-1:].isdigit() else ""
        sentence = f"{label} {refused['need']}" if refused["need"] else f"{label} {value} {refused['rule']}"
    return f"{sentence}; {kept}{unit} stays in use" if kept else sentence
