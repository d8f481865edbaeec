"""How files say that a number scatters: a small table of what its distribution needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ..core.checks import shown
from ..core.kinds import Kind
from ..files.units import as_given, parse
from .distributions import Distribution, LogNormal, Normal, Rectangular, tolerance

Read = Callable[[str, Any], float]
"""From the name and the text of a number to the number, by the units that it has."""

_KINDS: tuple[tuple[tuple[str, ...], Any], ...] = (
    (("low", "high"), Rectangular),
    (("mean", "deviation"), Normal),
    (("mean", "deviation", "low"), Normal),
    (("mean", "deviation", "high"), Normal),
    (("mean", "deviation", "low", "high"), Normal),
    (("median", "factor"), LogNormal),
    (("nominal", "plus_minus"), tolerance),
)


def distribution_of(name: str, content: Any, read: Read) -> Distribution:
    """A distribution from `{low, high}`, `{mean, deviation}`, `{median, factor}` or `{nominal, plus_minus}`.

    Raises
    ------
    ValueError
        Other keys, or numbers that are not allowed.
    """
    for keys, make in _KINDS:
        if isinstance(content, Mapping) and set(content) == set(keys):
            numbers = {key: _number(f"{name}.{key}", content[key], read) for key in keys}
            with as_given(content, f"{name}."):
                made: Distribution = make(**numbers)
                return made
    raise ValueError(
        f"{name} = {shown(content)} must be {{low, high}}, {{mean, deviation}} with or without low and high, "
        "{median, factor}, or {nominal, plus_minus}"
    )


def _number(name: str, value: Any, read: Read) -> float:
    """A factor has no unit, whatever it is of."""
    return parse(name, value, Kind.NUMBER) if name.endswith(".factor") else read(name, value)
