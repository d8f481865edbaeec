"""Texts of the evidence page: numbers with units and error bars, cases, heads of columns."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..evidence.matrix import KEYS, LIMITED, NAMES, number, title_of
from ..studies.parameters import LOADS

Record = Mapping[str, Any]
"""Content of the JSON file of an evidence pack, or a part of it."""

_LEAST_ERROR = 1e-5
"""Relative error below which no error bar is written: it is below the digits of the number."""


def case_text(case: Mapping[str, float]) -> str:
    """Describe a case: each input with its value and unit."""
    inputs = (f"{KEYS[key].title} {number(value)} {KEYS[key].written.text}".strip() for key, value in case.items())
    return ", ".join(inputs)


def unloaded(case: Mapping[str, float]) -> dict[str, float]:
    """Return a case without its load, because a load cycle has its own."""
    return {key: value for key, value in case.items() if KEYS[key].name not in LOADS}


def value_text(name: str, row: Record) -> str:
    """Write a number of a case with its unit and error bar."""
    quantity = NAMES[name]
    value = f"{number(row['numbers'][quantity.key])} {quantity.written.text}".strip()
    return value + error_text(row["errors"].get(quantity.key))


def column_head(key: str) -> str:
    """Return the head of a column: symbol or title with the unit in brackets."""
    quantity = KEYS[key]
    return f"{quantity.symbol or quantity.title}{quantity.written.text_in_brackets}"


def recentred_text(change: Record) -> str:
    """Describe an input whose tolerance states another nominal value than the joint's file."""
    quantity = LIMITED[change["name"]]
    unit = f" {quantity.written.text}".rstrip()
    return (
        f"{title_of(change['name'])}: the joint has {number(change['stated'])}{unit}, its tolerance states "
        f"{number(change['used'])}{unit}; everything is computed with {number(change['used'])}{unit}."
    )


def quantities_of_interest(record: Record) -> list[str]:
    """Return the names of the limited quantities, or of all quantities with a worst case."""
    return list(dict.fromkeys(limit["name"] for limit in record["limits"])) or list(record["worst"])


def error_text(error: float | None) -> str:
    """Write a relative error as an error bar; empty if the error is unknown or below the digits of the number."""
    return f" ± {percent(error)}" if error and error > _LEAST_ERROR else ""


def percent(share: float) -> str:
    """Write a share in percent with two digits."""
    return f"{100 * share:.2g} %"


def band_text(band: Record) -> str:
    """Write the low and the high end of a band."""
    return f"{number(band['low'])} to {number(band['high'])}"


def named_number(name: str, value: Any) -> str:
    """Write a number after its name, which ends in its unit: "pressure, MPa" and 3 give "pressure: 3 MPa"."""
    title, _, unit = name.rpartition(", ")
    return f"{title or unit}: {number(value)} {unit if title else ''}".strip()
