"""Numbers of a contact as the page shows them: text and HTML, in the units that are chosen."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from html import escape
from math import floor, isfinite, isnan, log10
from typing import Any

from ..catalogue import reference
from ..compare import Comparison
from ..contact import Contact
from ..describe import COLUMNS, Column
from ..kinds import Unit
from ..output.style import THICK, line_of
from .look import Palette, colour_of

_HANDY = {
    "indentation": ("µm", 1e3),
    "stiffness": ("kN/mm", 1e-3),
}
_TITLES = {
    "force": "force",
    "indentation": "indentation",
    "half_angle_deg": "half angle",
    "max_pressure": "largest pressure",
    "max_pressure_angle_deg": "where it is largest",
    "pole_pressure": "pressure at the pole",
    "area": "contact area",
    "stiffness": "stiffness",
    "energy": "energy",
    "foundation_modulus": "foundation modulus",
}
_DIGITS = 4


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A quantity as it is shown: `column` leads from the contact to the number."""

    title: str
    column: Column

    @property
    def head(self) -> str:
        return f"{self.column.symbol} [{self.column.unit}]"

    def number(self, contact: Contact) -> float:
        """The number in the unit that is shown."""
        return float(self.column.of(contact))

    def text(self, contact: Contact) -> str:
        return number_text(self.number(contact))


def quantities(angle: str) -> tuple[Quantity, ...]:
    """All of them, angles in "degrees" or "radians"."""
    return tuple(Quantity(title=_TITLES[column.name], column=_in_units(column, angle)) for column in COLUMNS)


def _in_units(column: Column, angle: str) -> Column:
    if column.name in _HANDY:
        return replace(column, reading=Unit(*_HANDY[column.name]))
    if column.name == "half_angle_deg" and angle == "radians":
        return replace(column, reading=Unit("rad"))
    return column


def number_text(value: float) -> str:
    """Four digits; what has no answer, and what is infinite, in words."""
    if isnan(value):
        return "no answer"
    return f"{value:.{_DIGITS}g}" if isfinite(value) else "∞"


def alert(sentence: str) -> str:
    """A sentence that says why something cannot be done."""
    return f"<p class='refused' role='alert'>{escape(sentence)}</p>"


def notes_list(notes: Iterable[str]) -> str:
    """What a model says of its answer."""
    return f"<ul class='notes'>{''.join(f'<li>{escape(note)}</li>' for note in notes)}</ul>"


def headline(contact: Contact, angle: str) -> str:
    """The numbers of one contact as a list, with whether it can be trusted."""
    errors: Mapping[str, Any] = getattr(contact, "error", {})
    cells = "".join(_cell(each, contact, errors) for each in quantities(angle))
    return f"<dl class='numbers'>{cells}</dl>{trust(contact)}"


def _cell(each: Quantity, contact: Contact, errors: Mapping[str, Any]) -> str:
    value = each.number(contact)
    share = float(errors.get(each.column.attribute, float("nan")))
    bar = f"<small>± {percent(share)}</small>" if share > 0 else ""
    unit = "" if isnan(value) else f" <span class='unit'>{escape(each.column.unit)}</span>"
    return (
        f"<div><dt>{escape(each.title)} <i>{escape(each.column.symbol)}</i></dt>"
        f"<dd data-name='{each.column.attribute}' data-value='{value!r}'>{number_text(value)}{unit}{bar}</dd></div>"
    )


def trust(contact: Contact) -> str:
    """Whether the model trusts itself here, and if not why, in words and not by colour alone."""
    if bool(contact.valid):
        return "<p class='trust yes'>✓ inside the range in which this model can be trusted</p>"
    sentence = "✗ outside the range in which this model can be trusted"
    return f"<p class='trust no'>{sentence}</p>{notes_list(contact.notes)}"


def models_table(comparison: Comparison, palette: Palette, angle: str) -> str:
    """Every model in a row, with its deviation from the exact answer, its validity, and its line in the charts."""
    shown = [each for each in quantities(angle) if each.column.name not in ("energy", "foundation_modulus")]
    heads = "".join(f"<th scope='col'>{escape(each.head)}</th>" for each in shown)
    rows = "".join(_row(comparison, name, shown, palette) for name in comparison)
    missing = "".join(
        f"<tr><th scope='row'>{escape(name)}</th><td colspan='{len(shown) + 1}' class='text'>{escape(why)}</td></tr>"
        for name, why in comparison.missing.items()
    )
    return (
        "<div class='wide' tabindex='0' role='region' aria-label='every model'><table>"
        f"<tr><th scope='col'>model</th>{heads}<th scope='col' class='text'>trust it here?</th></tr>"
        f"{rows}{missing}</table></div>"
        "<p class='quiet'>Small: difference from the exact answer.</p>"
    )


def _row(comparison: Comparison, name: str, shown: list[Quantity], palette: Palette) -> str:
    contact, apart = comparison[name], comparison.deviation(name)
    cells = "".join(f"<td>{each.text(contact)}{_apart(apart, each.column.name)}</td>" for each in shown)
    why = "yes" if bool(contact.valid) else f"no: {'; '.join(contact.notes)}"
    swatch = _swatch(name, palette)
    kind = "reference" if name == reference.name else "valid" if bool(contact.valid) else "doubtful"
    return (
        f"<tr class='{kind}'><th scope='row'>{swatch}{escape(name)}</th>{cells}<td class='text'>{escape(why)}</td></tr>"
    )


def _swatch(name: str, palette: Palette) -> str:
    """A short piece of a model's line."""
    line = line_of(name)
    dashes = " ".join(f"{THICK * length:g}" for length in line.dash)
    return (
        "<svg class='swatch' viewBox='0 0 32 8' aria-hidden='true'><path d='M0 4H32' "
        f"stroke='{colour_of(line, palette)}' stroke-width='{THICK:g}' stroke-dasharray='{dashes}'/></svg>"
    )


def _apart(deviation: Mapping[str, Any] | None, name: str) -> str:
    return "" if deviation is None else f"<small>{percent(float(deviation[name]), '+')}</small>"


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


def number_rows(head: str, contacts: Mapping[str, Contact]) -> list[list[Any]]:
    """A table with its head: a row a contact, its numbers named and in the units of JSON."""
    rows = [
        [name, *(float(column.of(contact)) for column in COLUMNS), bool(contact.valid)]
        for name, contact in contacts.items()
    ]
    return [[head, *(column.name for column in COLUMNS), "valid"], *rows]
