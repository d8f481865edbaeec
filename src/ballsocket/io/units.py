"""The door for units: text with a unit becomes a number in mm, N, MPa or rad; inside there are only numbers.

A bare number is taken as mm, N, MPa or degrees.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from math import isinf, radians
from typing import Any

from ..checks import shown
from ..kinds import Kind

LONGEST = 200
"""Characters of a quantity."""

_FACTOR = r"[A-Za-z\u00b5\u03bc\u00b0]+(?:\s*(?:\*\*|\^)\s*-?[1-9]|[2\u00b2])?"
# a number and a product or quotient of units: pint alone would also evaluate any arithmetic put before it
_QUANTITY = re.compile(
    rf"([-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?)\s*({_FACTOR}(?:(?:\s*[*/]\s*|\s+){_FACTOR})*)", re.ASCII
)
_INFINITE = re.compile(r"\s*[-+]?inf(?:inity)?\s*", re.IGNORECASE)
_SQUARE = re.compile(r"(?<=[A-Za-z])[2\u00b2]")  # of units as people and the CF conventions write them: mm², mm2

_IN_RADIANS = re.compile(r"; \S+ degrees are \S+ radians$")
_REFUSED = re.compile(r"(?P<name>\w+) = \S+ is not allowed: (?P<rule>.*)")


def parse(name: str, value: Any, kind: str) -> float:
    """`value` as a float in mm, N, MPa or rad.

    Parameters
    ----------
    name : str
        What it is, for the message.
    value : float, int or str
        A bare number, or text such as "16 mm", "3 kN", "1 GPa", "40 deg", "inf".
    kind : str
        One of `ballsocket.kinds.Kind`: "length", "force", "modulus", "angle", "number", ...

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
    if isinstance(value, str) and len(value) > LONGEST:
        raise ValueError(_refusal(name, value, kind))
    number = _number(name, value, kind) + 0.0  # no -0
    if isinf(number) and not (isinstance(value, float) or _INFINITE.fullmatch(str(value))):
        raise ValueError(_too_large(name, value))
    return radians(number) if kind == Kind.ANGLE else number


@contextmanager
def as_given(given: Mapping[str, Any], prefix: str = "") -> Iterator[None]:
    """Inside, the refusal of a number ("clearance = -0.1 is not allowed: ...") shows it as it was given."""
    try:
        yield
    except ValueError as error:
        found = _REFUSED.fullmatch(str(error))
        if found is None or found["name"] not in given:
            raise
        rule = _IN_RADIANS.sub("", found["rule"]).replace("(rad)", "(deg)").replace("pi/2", "90")
        value = shown(given[found["name"]])
        raise ValueError(f"{prefix}{found['name']} = {value} is not allowed: {rule}") from error


def _number(name: str, value: float | str, kind: str) -> float:
    try:
        return float(value)
    except OverflowError as error:
        raise ValueError(_too_large(name, value)) from error
    except ValueError:
        pass
    if kind == Kind.NUMBER:
        raise ValueError(_refusal(name, value, kind))
    return _quantity(name, str(value), kind)


def _quantity(name: str, text: str, kind: str) -> float:
    found = _QUANTITY.fullmatch(text.strip())
    if found is None:
        raise ValueError(_refusal(name, text, kind))
    number, unit = found.groups()
    try:
        return float(registry().Quantity(float(number), _plain(unit)).to(_plain(Kind(kind).typed)).magnitude)
    except Exception as error:  # whatever pint makes of units that nobody meant: it has no list of them
        raise ValueError(_refusal(name, text, kind)) from error


def _plain(unit: str) -> str:
    """A unit as pint reads it."""
    return _SQUARE.sub("**2", unit)


@cache
def registry() -> Any:
    """Where pint keeps its units; made once, which takes a while."""
    import pint

    return pint.UnitRegistry()


def _refusal(name: str, value: Any, kind: str) -> str:
    return f"{name} = {shown(value)} is not {Kind(kind).example}"


def _too_large(name: str, value: Any) -> str:
    return f"{name} = {shown(value)} is too large a number"
