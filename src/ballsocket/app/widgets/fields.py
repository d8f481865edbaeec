"""Inputs of the page as plain data, from which a script builds them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from math import degrees, isfinite
from typing import Any

from ...core.checks import shown
from ...core.kinds import Kind, Unit
from ...files.units import parse

_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?(?=\D|$)")
_COMMA = re.compile(r"(?<=\d),(?=\d)|^,(?=\d)|(?<=[-+]),(?=\d)")

Field = dict[str, Any]
"""One input: its name, kind, label, value, and what its kind needs."""


def choice(name: str, label: str, options: Iterable[tuple[str, str]], value: str) -> Field:
    """Return a list for one choice, from pairs of a value and its label."""
    return {
        "name": name,
        "kind": "choice",
        "label": label,
        "options": [list(option) for option in options],
        "value": value,
    }


def segments(name: str, label: str, options: Iterable[tuple[str, str]], value: str) -> Field:
    """Return a row of buttons for one choice."""
    return {**choice(name, label, options, value), "kind": "segments"}


def several(
    name: str, label: str, options: Iterable[tuple[str, str]], value: Iterable[str], pieces: Mapping[str, str]
) -> Field:
    """Return a row of boxes for any number of choices, each with HTML before its label."""
    return {**choice(name, label, options, ""), "kind": "several", "value": list(value), "pieces": dict(pieces)}


def tick(name: str, label: str, value: bool) -> Field:
    """Return a tick box."""
    return {"name": name, "kind": "tick", "label": label, "value": value}


def unknown(name: str, label: str, unit: str) -> Field:
    """Return an empty input for an optional number."""
    return {"name": name, "kind": "number", "label": label, "unit": unit, "value": None, "text": ""}


def number(name: str, label: str, unit: Unit, ends: tuple[float, float], step: float, value: float) -> Field:
    """Return an input for a number, with a slider over its typical range and the present value.

    `value` and `ends` are in the unit beside the box, to which `unit.factor` leads from that of a joint file.
    """
    return {
        "name": name,
        "kind": "number",
        "label": label,
        "unit": unit.text,
        "factor": unit.factor,
        "low": min(ends[0], value),
        "high": max(ends[1], value),
        "step": step,
        "value": value,
        "text": plain(value),
    }


def words(name: str, label: str, value: str, rows: int = 1) -> Field:
    """Return an input for text of several rows."""
    return {"name": name, "kind": "words", "label": label, "value": value, "rows": rows}


def plain(value: float) -> str:
    """Format a number for a box: up to six digits, without exponent where possible."""
    text = f"{value:.6g}"
    return f"{value:.0f}" if "e+" in text and isfinite(value) and abs(value) < 1e12 else text


def typed(name: str, text: Any, unit: Unit, kind: str, times: int = 1) -> float:
    """Convert typed text to the number of a table; a bare number has the unit beside the box.

    Parameters
    ----------
    name : str
        What it is, for a refusal.
    text : str or float
        "0.2", "0,2", "0.2 mm".
    unit : Unit
        Of a bare number; its factor leads to it from the number in the table.
    kind : str
        What it measures, for text with a unit.
    times : int
        How often the table's number is taken: a diameter is twice a radius.

    Raises
    ------
    ValueError
        No number, or one that could be two.

    Examples
    --------
    >>> typed("diametral_clearance", "0,2", Unit("mm", 2.0), "length", 2)
    0.1
    >>> typed("diametral_clearance", "0.2 mm", Unit("in", 2 / 25.4), "length", 2)
    0.1
    """
    if isinstance(text, int | float) and not isinstance(text, bool):
        return round(float(text) / unit.factor, 12)
    if not isinstance(text, str):
        raise ValueError(f"{name} = {shown(text)} is not a number")
    stripped = text.strip()
    if _THOUSANDS.match(stripped):
        plain_text = stripped.replace(",", "")
        raise ValueError(
            f"{name} = {shown(stripped)} could be two numbers: write {plain_text} or {stripped.replace(',', '.', 1)}"
        )
    bare = _COMMA.sub(".", stripped, count=1)
    try:
        return round(float(bare) / unit.factor, 12)
    except ValueError:
        pass
    try:
        value = parse(name, bare, kind)
    except ValueError as error:
        inside = f" in {unit.text}" if unit.text else ""
        meant = str(error).partition(" is ")[2]
        raise ValueError(f"{name} = {shown(stripped)} is not a number{inside}, and {meant}") from error
    return round((degrees(value) if kind == Kind.ANGLE else value) / times, 12)
