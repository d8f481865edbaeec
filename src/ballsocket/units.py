"""The door for units: text with a unit becomes a number in mm, N, MPa or rad; inside there are only numbers.

A bare number is taken as mm, N, MPa or degrees.
"""

from __future__ import annotations

import re
from functools import cache
from math import radians
from typing import Any

_UNITS = {"length": "mm", "force": "N", "modulus": "MPa", "angle": "deg", "adhesion": "N/mm", "number": ""}
_KINDS = {
    "length": "a length, such as '16 mm'",
    "force": "a force, such as '3 kN'",
    "modulus": "a modulus, such as '1 GPa'",
    "angle": "an angle, such as '40 deg'",
    "adhesion": "a work of adhesion, such as '0.05 J/m**2'",
    "number": "a number, such as 0.4",
}

_FACTOR = r"[A-Za-z\u00b5\u03bc\u00b0]+(?:\s*(?:\*\*|\^)\s*-?\d)?"
# a number and a product or quotient of units: pint alone would also evaluate any arithmetic put before it
_QUANTITY = re.compile(rf"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*({_FACTOR}(?:\s*[*/]\s*{_FACTOR})*)", re.ASCII)


def parse(name: str, value: Any, kind: str) -> float:
    """`value` as a float in mm, N, MPa or rad.

    Parameters
    ----------
    name : str
        What it is, for the message.
    value : float, int or str
        A bare number, or text such as "16 mm", "3 kN", "1 GPa", "40 deg", "inf".
    kind : {"length", "force", "modulus", "angle", "adhesion", "number"}

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
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError(_refusal(name, value, kind))
    number = _number(name, value, kind)
    return radians(number) if kind == "angle" else number


def _number(name: str, value: float | str, kind: str) -> float:
    try:
        return float(value)
    except ValueError:
        pass
    if kind == "number":
        raise ValueError(_refusal(name, value, kind))
    return _quantity(name, str(value), kind)


def _quantity(name: str, text: str, kind: str) -> float:
    import pint

    found = _QUANTITY.fullmatch(text.strip())
    if found is None:
        raise ValueError(_refusal(name, text if len(text) < 60 else text[:40] + "...", kind))
    number, unit = found.groups()
    try:
        return float(_registry().Quantity(float(number), unit).to(_UNITS[kind]).magnitude)
    except (pint.errors.PintError, AttributeError) as error:
        raise ValueError(_refusal(name, text, kind)) from error


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def _refusal(name: str, value: Any, kind: str) -> str:
    return f"{name} = {value!r} is not {_KINDS[kind]}"
