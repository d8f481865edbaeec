"""Conversion of text with units to numbers in mm, N, MPa or rad.

A bare number is taken as mm, N, MPa or degrees. No other module calls pint. Its parser also evaluates arithmetic, which
can take unlimited time. It therefore receives only names of single units.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import cache
from math import isinf, radians
from typing import Any

from ..core.checks import number_of_percent, shown
from ..core.kinds import Kind

LONGEST = 100  # characters of a quantity
Units = Mapping[str, float]  # product of units: exponents by the names of pint

_LARGEST_EXPONENT = 9
_NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_FRACTION = re.compile(r"([-+]?)(?:(\d+)(?:\s+|-))?(\d+)/0*([1-9]\d*)(?![\d.])", re.ASCII)
_TOKEN = re.compile(
    r"""(?P<blank>\s+)
    | (?P<name>[A-Za-z\u00b5\u03bc]+|[\u00b0\u00ba\u02da"\u2033])
      (?:(?P<digit>-?[1-9](?!\d))|\s*(?:\*\*|\^)\s*(?P<power>-?(?:[1-9]|0\.5))(?!\d))?
    | (?P<sign>[*/()\u00b7\u00d7\u22c5.])""",
    re.ASCII | re.VERBOSE,
)
_SUPERSCRIPTS = str.maketrans("\u207b\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079", "-123456789")
_WORD = re.compile(r"[^\W\d_]+")
_PHRASES = {
    re.compile(words, re.ASCII | re.IGNORECASE): sign
    for words, sign in {
        r"\s+per\s+": "/",
        r"\bsquare[ _-](\w++)": r"\1^2",
        r"\bcubic[ _-](\w++)": r"\1^3",
        r"\bpounds?[ _-]force\b": "lbf",
        r"\bkilograms?[ _-]force\b": "kgf",
    }.items()
}
"""Signs and symbols for words of full names, such as "newtons per square millimetre"."""

_INFINITE = re.compile(r"\s*[-+]?inf(?:inity)?\s*", re.IGNORECASE)

_COMMON_UNITS = {
    "mm": "millimeter",
    "um": "micrometer",
    "µm": "micrometer",
    "μm": "micrometer",
    "cm": "centimeter",
    "m": "meter",
    "N": "newton",
    "kN": "kilonewton",
    "MPa": "megapascal",
    "GPa": "gigapascal",
    "deg": "degree",
    "degree": "degree",
}
"""Names of common units in pint, whose import takes as long as a press."""

_SIGNS = {
    **dict.fromkeys("\u00b0\u00ba\u02da", "degree"),
    **dict.fromkeys('"\u2033', "inch"),
    **dict.fromkeys(("mil", "mils"), "thou"),  # an angle in pint, and the length of imperial pages
}
"""Names of units by their signs, and by the signs that keyboards have in place of them."""

_SPELLINGS = {
    **{unit.lower(): unit for unit in ("um", "mm", "cm", "N", "kN", "Pa", "kPa", "GPa", "kg", "Hz", "kHz")},
    "mpa": "MPa or mPa",
    "mn": "MN or mN",
    "mg": "Mg or mg",
    "grad": "deg or gon",
    "mikrometer": "um",
    "sekunden": "s",
    "zoll": "in",
}
"""Spellings of symbols, by their small letters, whose other spellings are wrong or may mean two units."""

_PRESSURES = (Kind.MODULUS, Kind.FOUNDATION)  # kinds of which millipascals are a slip for megapascals

_COMMON_FACTORS: dict[tuple[tuple[str, float], ...], float] = {
    (("micrometer", 1), ("millimeter", 1)): 0.001,
    (("centimeter", 1), ("millimeter", 1)): 10.0,
    (("meter", 1), ("millimeter", 1)): 1000.0,
    (("kilonewton", 1), ("newton", 1)): 1000.0,
    (("gigapascal", 1), ("megapascal", 1)): 1000.0,
}
"""Conversion factors from a unit to another one, equal to those of pint."""

_IN_RADIANS = re.compile(r"; \S+ degrees are \S+ radians$")
_REFUSED = re.compile(r"(?P<name>\w+(\[\d+\])?) = \S+( \(and \d+ more\))? is not allowed: (?P<rule>.*)")


def parse(name: str, value: Any, kind: str) -> float:
    """Convert a number or a text with a unit to a float in mm, N, MPa or rad.

    Parameters
    ----------
    name : str
        Name of the value in messages.
    value : float, int or str
        A bare number, or text such as "16 mm", "1 1/8 in", "3 kN", "1 GPa", "40 deg", "inf".
    kind : str
        One of `ballsocket.core.kinds.Kind`: "length", "force", "modulus", "angle", "number", ...

    Raises
    ------
    ValueError
        Text that is not a quantity of that kind.

    Examples
    --------
    >>> parse("force", "3 kN", "force")
    3000.0
    >>> parse("clearance", 0.1, "length")
    0.1
    """
    is_long = isinstance(value, str) and len(value) > LONGEST
    if is_long or isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError(_refusal(name, value, kind))
    number = _number(name, value, kind) + 0.0  # no -0
    if isinf(number) and not (isinstance(value, float) or _INFINITE.fullmatch(str(value))):
        raise ValueError(_too_large(name, value))
    return radians(number) if kind == Kind.ANGLE else number


@contextmanager
def as_given(texts: Mapping[str, Any], prefix: str = "") -> Iterator[None]:
    """Within the block, show a refused number ("clearance = -0.1 is not allowed: ...") as the text of the user."""
    try:
        yield
    except ValueError as error:
        refusal = _REFUSED.fullmatch(str(error))
        if refusal is None or refusal["name"] not in texts:
            raise
        rule = _IN_RADIANS.sub("", refusal["rule"]).replace("(rad)", "(deg)").replace("pi/2", "90")
        value = shown(texts[refusal["name"]])
        raise ValueError(f"{prefix}{refusal['name']} = {value} is not allowed: {rule}") from error


def _number(name: str, value: float | str, kind: str) -> float:
    try:
        return float(value)
    except OverflowError as error:
        raise ValueError(_too_large(name, value)) from error
    except ValueError:
        pass
    try:
        number, unit = split_quantity(str(value))
        if not unit:  # a fraction
            return number
        if kind == Kind.NUMBER:
            raise ValueError(f"{shown(unit)} is the unit of a plain number")
        units = parse_units(unit)
        if "millipascal" in units and kind in _PRESSURES:
            raise ValueError(f"{shown(unit)} is in millipascals")
        return convert(number, units, parse_units(Kind(kind).assumed_unit))
    except ValueError as error:
        raise ValueError(_refusal(name, value, kind)) from error


def split_quantity(text: str) -> tuple[float, str]:
    """Split text into a number or a fraction, and the text of its unit, which may be empty.

    Raises ValueError: text of more than `LONGEST` characters, or without a number at its beginning.

    Examples
    --------
    >>> split_quantity("1 1/8 in")
    (1.125, 'in')
    """
    stripped = text.strip()
    fraction, number = (part.match(stripped) if len(text) <= LONGEST else None for part in (_FRACTION, _NUMBER))
    if number is None:
        raise ValueError(f"{shown(text)} does not begin with a number")
    if fraction is None:
        return float(number[0]), stripped[number.end() :].strip()
    sign, whole, top, bottom = fraction.groups()  # of "3/8", "1 1/8" or "1-1/8"
    if whole and int(top) >= int(bottom):
        raise ValueError(f"{fraction[0]} has an improper fraction behind its whole number")
    value = int(whole or 0) + int(top) / int(bottom)
    return -value if sign == "-" else value, stripped[fraction.end() :].strip()


def parse_units(text: str) -> Units:
    """Parse a product or quotient of units, such as "mm^3/(N m)", without evaluating any arithmetic.

    Exponents are integers from -9 to 9, or 0.5. A slash divides by the next unit or bracket.

    Raises ValueError: text of more than `LONGEST` characters, an unknown unit, or text that is not a product of units.

    Examples
    --------
    >>> parse_units("kN/mm²")
    {'kilonewton': 1, 'millimeter': -2}
    """
    if len(text) > LONGEST:
        raise ValueError(f"a unit has at most {LONGEST} characters, got {len(text)}")
    plain = text.translate(_SUPERSCRIPTS).strip().removesuffix(".")
    for words, sign in _PHRASES.items():
        plain = words.sub(sign, plain)
    found, end = [], 0
    while end < len(plain):
        token = _TOKEN.match(plain, end)
        if token is None:
            raise ValueError(f"{shown(plain)} is not a product of units")
        found.append(token)
        end = token.end()
    tokens = [token for token in reversed(found) if not token["blank"]]
    units = _product(tokens) if tokens else {}
    if tokens:
        raise ValueError(f"{shown(text)} has an unexpected {tokens[-1][0]!r}")
    if any(abs(exponent) > _LARGEST_EXPONENT for exponent in units.values()):
        raise ValueError(f"an exponent of {shown(text)} is not -{_LARGEST_EXPONENT} to {_LARGEST_EXPONENT}")
    return {name: exponent for name, exponent in units.items() if exponent}


def _product(tokens: list[re.Match[str]]) -> dict[str, float]:
    """Parse factors from the end of `tokens`, up to a closing bracket."""
    units: dict[str, float] = {}
    sign = 1
    while True:
        for name, exponent in _factor(tokens).items():
            units[name] = units.get(name, 0) + sign * exponent
        following = tokens[-1]["sign"] if tokens else ")"
        if following == ")":
            return units
        sign = -1 if following == "/" else 1
        if following in ("*", "/", "·", "×", "⋅", "."):
            tokens.pop()


def _factor(tokens: list[re.Match[str]]) -> dict[str, float]:
    token = tokens.pop() if tokens else None
    if token is not None and token["name"]:
        power = token["power"] or token["digit"] or "1"
        return {_unit_name(token["name"]): float(power) if "." in power else int(power)}
    if token is None or token["sign"] != "(":
        raise ValueError("a unit is missing before or behind a sign")
    units = _product(tokens)
    if not tokens:
        raise ValueError("a bracket does not close")
    tokens.pop()
    return units


def _unit_name(text: str) -> str:
    """Return the name of a unit in pint; the common units need no import of pint."""
    symbol = _SIGNS.get(text, text)
    if symbol in _COMMON_UNITS:
        return _COMMON_UNITS[symbol]
    if right := _right_spelling(symbol):
        raise ValueError(f"{shown(text)} is no unit: write {right}")
    name = _pint_name(symbol)
    if not name:  # "dimensionless"
        raise ValueError(f"{shown(text)} is no unit: leave it out")
    if not _registry()._is_multiplicative(name):  # decibels, degrees of Celsius
        raise ValueError(f"{shown(text)} is logarithmic or has an offset: use a unit that is a factor")
    return name


def _right_spelling(symbol: str) -> str:
    """Return the spelling of a symbol with wrong capitals, or the units that it may mean; empty for a right symbol."""
    right = _SPELLINGS.get(symbol.lower(), "")
    return "" if symbol in right.split(" or ") else right


def _pint_name(symbol: str) -> str:
    """Return the name in pint of a symbol, or of a full name such as "Newtons" in any capitals."""
    import pint

    try:
        return str(_registry().get_name(symbol))
    except pint.UndefinedUnitError:
        full_name = symbol.lower()
    except (pint.PintError, ValueError) as error:
        raise ValueError(f"{shown(symbol)} is not a known unit") from error
    for prefix, name, _ in _registry().parse_unit_name(full_name):
        if full_name.startswith(prefix):  # prefixes by letter, such as the one of "KPSI", depend on capitals
            return f"{prefix}{name}"
    raise ValueError(f"{shown(symbol)} is not a known unit")


def convert(number: float, units: Units, target: Units) -> float:
    """Convert a number from one product of units to another of the same dimension.

    Raises ValueError: units of another dimension, or a number out of range.
    """
    factor = 1.0 if units == target else _COMMON_FACTORS.get((*units.items(), *target.items()))
    if factor is not None:
        return number * factor
    import pint

    registry = _registry()
    source_unit, target_unit = (registry.Unit(pint.util.UnitsContainer(factors)) for factors in (units, target))
    try:
        return float(registry.Quantity(number, source_unit).to(target_unit).magnitude)
    except (pint.PintError, ArithmeticError, ValueError) as error:
        raise ValueError(f"{source_unit} has another dimension than {target_unit}") from error


@cache
def _registry() -> Any:
    """Load the unit definitions of pint on first use, because loading takes long."""
    import pint

    return pint.UnitRegistry()


_STANDARD_GRAVITY = 9.80665  # m/s²
_TYPICAL_MASS = 75.0  # kg, of a patient
_BODY_WEIGHT = re.compile(r"(%|per\s?cent)?\s*(?:(?:of|x|times)\s+)?(?:the\s+)?(?:BW|body\s*weights?)", re.IGNORECASE)

_TOLERANCE = re.compile(r"\+-|\+/-|±")
_MARKED = re.compile(r"\s*[-+]?\d+[,' \u202f\u00a0]\d")


def _refusal(name: str, value: Any, kind: str) -> str:
    percent = number_of_percent(value) if kind == Kind.NUMBER else None
    respelled = {word: right for word in _WORD.findall(str(value)) if (right := _right_spelling(word))}
    hint = _weight_hint(str(value)) if kind == Kind.FORCE else ""
    if _TOLERANCE.search(str(value)):
        hint = "; state a tolerance apart from the number, by --spread of sensitivity or --tolerance of press"
    elif _MARKED.match(str(value)):
        hint = "; write a decimal point, and nothing between thousands"
    elif percent is not None:
        with suppress(ValueError):
            hint = f"; {percent} % is {parse(name, percent, kind) / 100:g}"
    elif kind in _PRESSURES and "mPa" in _WORD.findall(str(value)):
        hint = "; mPa is a thousandth of 1 Pa: write MPa"
    elif respelled and not hint:
        hint = "".join(f"; write {right}, not {word}" for word, right in respelled.items())
    return f"{name} = {shown(value)} is not {Kind(kind).example}{hint}"


def _weight_hint(text: str) -> str:
    """Return the conversion of a mass or a multiple of the body weight to a force; empty for another text."""
    try:
        number, unit = split_quantity(text)
        relative = _BODY_WEIGHT.fullmatch(unit)
        if relative:
            multiple = number / 100 if relative[1] else number
            force = multiple * _TYPICAL_MASS * _STANDARD_GRAVITY
            return f"; {multiple:g} times the weight of {_TYPICAL_MASS:g} kg is {force:.4g} N"
        mass = convert(number, parse_units(unit), {"kilogram": 1})
    except ValueError:
        return ""
    return f"; a mass of {number:g} {unit} weighs {mass * _STANDARD_GRAVITY:.4g} N"


def _too_large(name: str, value: Any) -> str:
    return f"{name} = {shown(value)} is too large a number"
