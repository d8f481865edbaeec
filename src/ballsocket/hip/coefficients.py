"""Wear coefficients as people write them: a number with its unit, refused where that is another one."""

from __future__ import annotations

import re
from typing import Any

from ..core.checks import require, shown
from ..core.kinds import Kind
from ..io.units import convert, parse, parse_units, split_quantity

_WORK = re.compile(r"(?<!\()\bN[ *\u00b7]{0,3}(mm?)\b")
"""A force times a length behind a stroke, which people write without brackets."""

WEAR_FACTOR = "mm^3/(N m)"
_METRES = (WEAR_FACTOR, "m^3/(N m)")
"""Units of a wear factor for metres of sliding, of which there is nothing to mistake."""

_JOULES = (*_METRES, "mm^3/J", "mm^3/kJ", "mm^3/MJ", "m^3/J")
"""The same for work."""


def wear_factor(name: str, value: Any) -> float:
    """A wear factor k in mm³/(N m): bare, or text as "1.066e-6 mm^3/(N m)".

    Raises
    ------
    ValueError
        Text that is none; a unit of another dimension; one for other lengths of sliding, with the factor between.

    Examples
    --------
    >>> wear_factor("coefficient", "1.066e-6 mm³/(N·m)")
    1.066e-06
    >>> wear_factor("coefficient", "1.066e-9 mm^3/(N mm)")
    Traceback (most recent call last):
    ValueError: coefficient = '1.066e-9 mm^3/(N mm)' is for mm of sliding: 1 mm^3/(N mm) is 1000 mm^3/(N m), \
so that this is 1.066e-06 mm^3/(N m); write it so
    """
    number, unit = _parts(name, value, WEAR_FACTOR)
    if unit:
        number *= _factor(name, value, number, unit)
    require(name, number, 0 <= number < float("inf"), f"a wear coefficient is at least 0 {WEAR_FACTOR}, and finite")
    return number


def wear_per_energy(name: str, value: Any) -> float:
    """A wear factor in mm³ per joule of friction: bare, or text as "1e-5 mm^3/J".

    Raises
    ------
    ValueError
        As of `wear_factor`.
    """
    number, unit = _parts(name, value, "mm^3/J")
    if unit:
        number *= _factor(name, value, number, unit, _JOULES)
    require(name, number, 0 <= number < float("inf"), "a wear coefficient is at least 0 mm^3/J, and finite")
    return number


def share_of_slide(name: str, value: Any) -> float:
    """The coefficient of the area law, mm of depth per mm of sliding: bare, or text as "1e-6 mm/m".

    Raises
    ------
    ValueError
        Text that is none; a unit of another dimension.
    """
    number, unit = _parts(name, value, "mm/m")
    if unit:
        number *= _convert_one(name, value, unit, "", "mm/mm, a depth over a length of sliding")
    require(name, number, 0 <= number < float("inf"), "a wear coefficient is at least 0, and finite")
    return number


def _parts(name: str, value: Any, example: str) -> tuple[float, str]:
    """Split a coefficient into its number and the text of its unit."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return parse(name, value, Kind.NUMBER), ""
    try:
        number, unit = split_quantity(value if isinstance(value, str) else "")
        unit = _WORK.sub(r"(N*\1)", unit)
        parse_units(unit)
    except ValueError as error:
        raise ValueError(f"{name} = {shown(value)} is not a coefficient, such as '1e-6 {example}'") from error
    return number, unit


def _factor(name: str, value: Any, number: float, unit: str, allowed: tuple[str, ...] = _METRES) -> float:
    """Convert one unit to mm³/(N m)."""
    factor = _convert_one(
        name, value, unit, WEAR_FACTOR, f"{WEAR_FACTOR}, a volume over a force and a length of sliding"
    )
    if parse_units(unit) not in [parse_units(each) for each in allowed]:
        written = unit.replace("**", "^").replace("N*m", "N m")
        slid = "for mm of sliding" if abs(factor / 1000 - 1) < 1e-9 else "for another length of sliding"
        raise ValueError(
            f"{name} = {shown(value)} is {slid}: 1 {written} is {factor:.6g} {WEAR_FACTOR}, "
            f"so that this is {number * factor:.6g} {WEAR_FACTOR}; write it so"
        )
    return factor


def _convert_one(name: str, value: Any, unit: str, target: str, meaning: str) -> float:
    try:
        return convert(1.0, parse_units(unit), parse_units(target))
    except ValueError as error:
        raise ValueError(f"{name} = {shown(value)} has the wrong unit; expected {meaning}") from error
