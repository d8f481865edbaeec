"""Systems of units for tables, figures and sentences: mm, N and MPa, or inches and pounds.

A sentence keeps its numbers, so that every door writes them in the units of its reader::

    note = Sentence("the contact ends {} from the rim", Amount(2.7, MILLIMETRE))
    str(note)                            # "the contact ends 2.7 mm from the rim"
    Units.IMPERIAL.sentence(note)        # "the contact ends 0.1063 in from the rim"
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from math import floor, inf, isinf, log10, prod
from types import MappingProxyType
from typing import Any

from .display import plain_number
from .kinds import MILLIMETRES, PLAIN, Unit
from .quantities import Quantity

_KSI_FROM = 1e4  # pressure in psi from which it is written in ksi

_INCH, _POUND = 25.4, 4.4482216152605  # mm, N
_PSI = _INCH**2 / _POUND

_WRITTEN_UNITS = MappingProxyType(
    {
        "mm³/(N m)": Unit("in³/(lbf in)", _INCH**-3 * _POUND * 1e-3 * _INCH),
        "mm^3/(N m)": Unit("in^3/(lbf in)", _INCH**-3 * _POUND * 1e-3 * _INCH),
        "MPa/mm": Unit("ksi/in", 1e-3 * _PSI * _INCH),
        "kN/mm": Unit("kip/in", _INCH / _POUND),
        "N/mm": Unit("lbf/in", _INCH / _POUND),
        "mm/s": Unit("in/s", 1 / _INCH),
        "N mm": Unit("lbf in", 1 / (_INCH * _POUND)),
        "N m": Unit("lbf in", 1e3 / (_INCH * _POUND)),
        "mm³": Unit("in³", _INCH**-3),
        "mm²": Unit("in²", _INCH**-2),
        "mm": Unit("in", 1 / _INCH),
        "µm": Unit("mil", 1 / _INCH),
        "nm": Unit("µin", 1 / _INCH),
        "kN": Unit("lbf", 1e3 / _POUND),
        "N": Unit("lbf", 1 / _POUND),
        "GPa": Unit("ksi", _PSI),
        "MPa": Unit("psi", _PSI),
        "kPa": Unit("psi", 1e-3 * _PSI),
    }
)
"""Imperial units by the metric unit; a mil is a thousandth of an inch."""


class Units(StrEnum):
    """System of units: SI with mm, N and MPa, or inches and pounds."""

    SI = "SI"
    IMPERIAL = "imperial"

    @property
    def paper(self) -> str:
        """Usual paper of the system: A4 or letter."""
        return "letter" if self is Units.IMPERIAL else "A4"

    def length(self, millimetres: float) -> str:
        """Write a length (mm) in mm or in inches."""
        if isinf(millimetres):
            return "to infinity"
        return self.amount(Amount(millimetres, MILLIMETRES))

    def short_length(self, millimetres: float) -> str:
        """Write a length (mm) to 0.1 mm or to 0.001 in."""
        return self.amount(Amount(millimetres, MILLIMETRES, decimals=1))

    def unit_of(self, quantity: Quantity) -> Unit:
        """Return the unit of a quantity."""
        return self.written(quantity.shown)

    def text_of(self, quantity: Quantity, number: float) -> str:
        """Write a number, stated in the internal unit, with the unit of this system."""
        return _written(number, self.unit_of(quantity))

    def sentence(self, text: str) -> str:
        """Write a sentence with its amounts in this system; a plain text stays.

        Examples
        --------
        >>> Units.IMPERIAL.sentence(Sentence("contact {} from the rim", Amount(2.7, MILLIMETRES)))
        'contact 0.1063 in from the rim'
        """
        return self.joined(text.pieces) if isinstance(text, Sentence) else text

    def joined(self, pieces: Iterable[Amount | str]) -> str:
        """Join texts and amounts, which are written in this system."""
        return "".join(self.amount(piece) if isinstance(piece, Amount) else piece for piece in pieces)

    def written(self, unit: Unit) -> Unit:
        """Return the unit of this system for a metric unit with its factor."""
        converted = self.of_text(unit.text)
        return Unit(converted.text, unit.factor * converted.factor)

    def amount(self, amount: Amount) -> str:
        """Write an amount with its unit; with fixed decimals, those of a smaller unit are fewer."""
        unit = self.written(amount.unit)
        if amount.decimals is None:
            return _written(amount.value, unit, amount.digits)
        text = fixed_text(amount.value, unit.factor, amount.unit.factor, amount.decimals)
        return f"{text}{'' if unit.text in ('', '°') else ' '}{unit.text}"

    def of_text(self, unit: str) -> Unit:
        """Return the unit of this system for a metric unit as text; other texts stay, with the factor 1."""
        if self is Units.SI:
            return Unit(unit)
        if unit in _WRITTEN_UNITS:
            return _WRITTEN_UNITS[unit]
        if " " in unit and "(" not in unit:
            parts = list(map(self.of_text, unit.split(" ")))
            return Unit(" ".join(part.text for part in parts), prod(part.factor for part in parts))
        base, _, power = unit.rpartition("^")
        if base:
            written = self.of_text(base)
            return Unit(f"{written.text}^{power}", written.factor ** float(power))
        if "/" not in unit:
            return Unit(unit)
        over, under = map(self.of_text, unit.rsplit("/", 1))
        return Unit(f"{over.text}/{under.text}", over.factor / under.factor)

    def axis(self, label: str) -> tuple[str, float]:
        """Return the label of an axis such as "penetration [mm]" in this system, and the factor of its numbers."""
        head, bracket, unit = label.removesuffix("]").rpartition("[")
        written = self.of_text(unit)
        return (f"{head}{bracket}{written.text}]", written.factor) if bracket else (label, 1.0)


@dataclass(frozen=True)
class Amount:
    """Number in a sentence or a cell."""

    value: float  # in the internal unit
    unit: Unit = PLAIN  # metric unit in which it is written
    digits: int = 4  # significant
    decimals: int | None = None  # in the metric unit, in place of significant digits


def with_error(value: float, error: float, unit: Unit = PLAIN, digits: int = 2) -> tuple[Amount, Amount]:
    """Round a number and its error to the last of the significant digits of the error."""
    decimals = digits - 1 - floor(log10(error * unit.factor)) if 0 < error < inf else None
    return Amount(value, unit, decimals=decimals), Amount(error, unit, digits, decimals)


class Sentence(str):
    """Sentence with amounts, which stands for its text in mm, N and MPa.

    Parameters
    ----------
    template : str
        Text with a gap `{}` for each part.
    *parts : Amount or str
        Numbers, names, which are written as they are, and other sentences, whose amounts become those of this one.

    Attributes
    ----------
    pieces : tuple of str and Amount
    """

    __slots__ = ("pieces",)
    pieces: tuple[Amount | str, ...]

    def __new__(cls, template: str, *parts: Amount | str) -> Sentence:
        first, *others = template.split("{}")
        pieces: list[Amount | str] = [first]
        for part, text in zip(parts, others, strict=True):
            pieces += [*(part.pieces if isinstance(part, Sentence) else [part]), text]
        return cls.of(pieces)

    @classmethod
    def of(cls, pieces: Iterable[Amount | str]) -> Sentence:
        """Join texts and amounts to a sentence."""
        kept = tuple(pieces)
        sentence = super().__new__(cls, Units.SI.joined(kept))
        sentence.pieces = kept
        return sentence

    def __reduce__(self) -> tuple[Any, ...]:
        return Sentence.of, (self.pieces,)

    def __str__(self) -> Sentence:
        """Return the sentence itself: a figure keeps the amounts of its title."""
        return self


def to_json(text: str) -> Any:
    """Return a text for JSON: the pieces of a sentence, whose amounts are in their metric unit; a plain text stays."""
    if not isinstance(text, Sentence):
        return text
    return [
        {**vars(piece), "value": piece.value * piece.unit.factor, "unit": piece.unit.text}
        if isinstance(piece, Amount)
        else piece
        for piece in text.pieces
    ]


def from_json(data: Any) -> str:
    """Return the sentence, or the plain text, of which `to_json` made the data."""
    if isinstance(data, str):
        return data
    return Sentence.of(
        Amount(**{**piece, "unit": Unit(piece["unit"])}) if isinstance(piece, dict) else piece for piece in data
    )


def holders_of(notes: Iterable[tuple[str, Iterable[str]]]) -> dict[str, list[str]]:
    """Collect the names that have each note, from pairs of a name and its notes."""
    holders: dict[str, list[str]] = {}
    for name, note in ((name, note) for name, own in notes for note in dict.fromkeys(own)):
        holders.setdefault(note, []).append(name)
    return holders


def fixed_text(number: float, factor: float, metric_factor: float, decimals: int) -> str:
    """Write a number with fixed decimals in its metric unit, or with those that leave as much in another one.

    The factors lead from the internal unit to the shown one and to the metric one.
    """
    shown_decimals = decimals - floor(log10(factor / metric_factor))
    return f"{round(number * factor, shown_decimals) + 0.0:.{max(shown_decimals, 0)}f}"


def _written(number: float, unit: Unit, digits: int = 4) -> str:
    """Write a number, stated in the internal unit, with a unit; large ones of psi in ksi, small ones of mil in µin."""
    size = abs(number) * unit.factor
    if unit.text == "psi" and size >= _KSI_FROM:
        unit = Unit("ksi", 1e-3 * unit.factor)
    elif unit.text == "mil" and 0 < size < 0.1:
        unit = Unit("µin", 1e3 * unit.factor)
    text = plain_number(number * unit.factor, digits)
    return f"{text}{'' if unit.text in ('', '°') else ' '}{unit.text}"
