"""The words of a page of evidence: numbers with units and error bars, cases, limits, tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from ..evidence.matrix import NAMES
from ..quantities import QUANTITIES, Quantity
from ..studies.parameters import LOADS, PARAMETERS
from . import html

Record = Mapping[str, Any]

LIMITED: Mapping[str, Quantity] = {**QUANTITIES, **PARAMETERS, **NAMES}
"""By name."""

KEYS: Mapping[str, Quantity] = {each.key: each for each in LIMITED.values()}
"""By what JSON calls them."""

_FINE, _HUGE = 1e-5, 1e9


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


def limit_text(limit: Record) -> str:
    """A limit with the title and the unit of what it holds."""
    each = KEYS.get(limit["name"]) or LIMITED[limit["name"]]
    ends = [f"{word} {number(limit[end])} {each.written.text}".strip() for end, word in _ENDS if limit[end] is not None]
    return f"{title_of(limit['name'])} {' and '.join(ends)}"


_ENDS = (("low", "at least"), ("high", "at most"))


def head(key: str) -> str:
    """The head of a column."""
    each = KEYS[key]
    return f"{each.symbol or each.title}{each.written.bracketed}"


def title_of(name: str) -> str:
    """What a number is called, by its name."""
    return _MORE.get(name) or LIMITED[name].title


_MORE = {"utilisation": "utilisation (von Mises stress over yield stress)"}


def error_text(error: float | None) -> str:
    """An error bar; what is below the digits that are shown is not."""
    return f" ± {percent(error)}" if error and error > _FINE else ""


def number(value: Any) -> str:
    """Five digits; none of a usual size has an exponent."""
    if value is None or isinstance(value, str):
        return value or "–"
    text = f"{value:.5g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < _HUGE else text


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
