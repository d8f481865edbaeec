"""Display of values: one line of text, tables of a notebook as HTML, and plots that rooms above register."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, is_dataclass
from html import escape
from math import isfinite
from pkgutil import resolve_name
from typing import Any


class OneLine:
    """Base class whose `repr` is one line: the name of the class and the text of the instance."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"


def full_repr(value: Any) -> str:
    """Return the `repr` with every field of the dataclasses in a value, also of those with a repr in one line.

    Digests and generated files use it.
    """
    if isinstance(value, OneLine) or (is_dataclass(value) and hasattr(type(value).__repr__, "__wrapped__")):
        parts = (f"{part.name}={full_repr(getattr(value, part.name))}" for part in fields(value) if part.repr)  # type: ignore[arg-type]
        return f"{type(value).__qualname__}({', '.join(parts)})"
    if type(value) is tuple:
        return f"({', '.join(map(full_repr, value))}{',' if len(value) == 1 else ''})"
    if type(value) is list:
        return f"[{', '.join(map(full_repr, value))}]"
    if type(value) is dict:
        return f"{{{', '.join(f'{full_repr(key)}: {full_repr(entry)}' for key, entry in value.items())}}}"
    return repr(value)


_LATIN = {umlaut: f"{vowel}e" for umlaut, vowel in zip("äöüÄÖÜ", "aouAOU", strict=True)}
_LATIN |= {"ß": "ss", "ø": "o", "ł": "l", "æ": "ae", "ν": "nu", "°": " deg", "±": "+-", "≤": "<="}
_LATIN |= {"–": "-", "—": "-", "−": "-", "×": "x", "·": ".", "’": "'"}
"""Letters and signs that have no decomposition into ASCII, and German umlauts, in ASCII."""


def ascii_text(text: str) -> str:
    """Transliterate a text to printable ASCII, for programs that read nothing else.

    Examples
    --------
    >>> ascii_text("Heß & Bergström, ν 0.4, 30°, 日")
    'Hess & Bergstroem, nu 0.4, 30 deg, ?'
    """
    written = "".join(_LATIN.get(letter, letter) for letter in unicodedata.normalize("NFC", text))
    plain = (letter for letter in unicodedata.normalize("NFKD", written) if not unicodedata.combining(letter))
    return "".join(letter if " " <= letter <= "~" else "?" for letter in plain)


_NUMBER = re.compile(r"\d+(?:\.\d+)?")


def split_numbers(text: str) -> tuple[str, list[float]]:
    """Return a text without its numbers, which is the same for all sentences of a kind, and its numbers.

    Examples
    --------
    >>> split_numbers("7 of 8: 1.5 times the yield stress")
    (' of :  times the yield stress', [7.0, 8.0, 1.5])
    """
    return _NUMBER.sub("", text), list(map(float, _NUMBER.findall(text)))


_LARGEST_PLAIN = 1e9  # value from which numbers have an exponent


def finite_or_none(value: float) -> float | None:
    """Return a finite number for JSON, and None for NaN and infinity."""
    return float(value) if isfinite(value) else None


def plain_number(value: float, digits: int = 4) -> str:
    """Format a number with at least these significant digits, below a billion without an exponent.

    Examples
    --------
    >>> plain_number(4e6), plain_number(13442.0, 3), plain_number(0.01234567), plain_number(-0.0)
    ('4000000', '13442', '0.01235', '0')
    """
    large = 10**digits <= abs(value) < _LARGEST_PLAIN
    return f"{value:.0f}" if large else f"{value + 0.0:.{digits}g}"


_LEFT = " style='text-align:left'"


def counted(count: float, noun: str) -> str:
    """Write a count with its noun, such as "1 point" or "3 points"; the plural of the noun ends in s."""
    number = str(count) if isinstance(count, int) else plain_number(count)
    return f"{number} {noun}{'' if count == 1 else 's'}"


def html_table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return an HTML table of texts, the first column on the left."""

    def row(tag: str, texts: Sequence[str]) -> str:
        cells = (f"<{tag}{'' if number else _LEFT}>{escape(text)}</{tag}>" for number, text in enumerate(texts))
        return f"<tr>{''.join(cells)}</tr>"

    return f"<table>{row('th', heads)}{''.join(row('td', texts) for texts in rows)}</table>"


def html_list(title: str, rows: Iterable[tuple[str, str]]) -> str:
    """Return names and values in two columns below a title, as HTML."""
    body = "".join(f"<tr><td{_LEFT}>{escape(name)}</td><td{_LEFT}>{escape(text)}</td></tr>" for name, text in rows)
    return f"<b>{escape(title)}</b><table>{body}</table>"


PLOTS: dict[str, str] = {}
"""Plot functions, such as "ballsocket.reports.press_plots:plot", by name; the room of reports adds them."""


def load_plot(name: str) -> Callable[..., Any]:
    """Import and return a function of `PLOTS` that draws a matplotlib figure, when a plot is made.

    Raises LookupError: a name that no room has registered.
    """
    if name not in PLOTS:
        raise LookupError(f"plot {name!r} is not registered; registered plots: {', '.join(sorted(PLOTS)) or 'none'}")
    plot: Callable[..., Any] = resolve_name(PLOTS[name])
    return plot
