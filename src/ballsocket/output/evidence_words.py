"""The words of a page of evidence: numbers with units and error bars, cases, limits, tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from ..evidence.matrix import KEYS, LIMITED, NAMES, number, title_of
from ..studies.parameters import LOADS
from . import html

Record = Mapping[str, Any]

_FINE = 1e-5


def case_text(case: Mapping[str, float]) -> str:
    """A case in words."""
    told = (f"{KEYS[key].title} {number(value)} {KEYS[key].written.text}".strip() for key, value in case.items())
    return ", ".join(told)


def unloaded(case: Mapping[str, float]) -> dict[str, float]:
    """A case without its load, which a cycle brings itself."""
    return {key: value for key, value in case.items() if KEYS[key].name not in LOADS}


def value_text(name: str, row: Record) -> str:
    """A number of a case with its unit and error bar."""
    each = NAMES[name]
    return f"{number(row['numbers'][each.key])} {each.written.text}".strip() + error_text(row["errors"].get(each.key))


def head(key: str) -> str:
    """The head of a column."""
    each = KEYS[key]
    return f"{each.symbol or each.title}{each.written.text_in_brackets}"


def recentred_text(change: Record) -> str:
    """Describe an input whose tolerance states another nominal value than the joint's file."""
    each = LIMITED[change["name"]]
    unit = f" {each.written.text}".rstrip()
    return (
        f"{title_of(change['name'])}: the joint has {number(change['stated'])}{unit}, its tolerance states "
        f"{number(change['used'])}{unit}; everything is computed with {number(change['used'])}{unit}."
    )


def quantities_of_interest(record: Record) -> list[str]:
    """Return the names of the limited quantities, or of all quantities with a worst case."""
    return list(dict.fromkeys(limit["name"] for limit in record["limits"])) or list(record["worst"])


def error_text(error: float | None) -> str:
    """An error bar; what is below the digits that are shown is not."""
    return f" ± {percent(error)}" if error and error > _FINE else ""


def percent(share: float) -> str:
    """A share with two digits."""
    return f"{100 * share:.2g} %"


def call(text: str) -> str:
    """The call that makes the numbers above it."""
    return f"<p class='call'>{escape(text)}</p>"


def words(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of words, all of which begin on the left."""
    return f"<div class='words'>{html.table(heads, rows)}</div>"


def listed(texts: Iterable[str]) -> str:
    """Sentences as a list."""
    return "<ul>" + "".join(f"<li>{escape(text)}</li>" for text in texts) + "</ul>"
