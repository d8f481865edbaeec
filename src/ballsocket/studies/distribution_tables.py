"""Distributions in files: tables such as `{low, high}`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ..core.checks import shown
from ..core.kinds import Kind
from ..files.schema import QUANTITY_SCHEMA
from ..files.units import as_given, parse
from .distributions import Distribution, LogNormal, Normal, Rectangular, tolerance

Read = Callable[[str, Any], float]
"""Function from name and value of a number in a file to the number."""

_DISTRIBUTIONS: tuple[tuple[tuple[str, ...], Callable[..., Distribution]], ...] = (
    (("low", "high"), Rectangular),
    (("mean", "deviation"), Normal),
    (("mean", "deviation", "low"), Normal),
    (("mean", "deviation", "high"), Normal),
    (("mean", "deviation", "low", "high"), Normal),
    (("median", "factor"), LogNormal),
    (("nominal", "plus_minus"), tolerance),
)
"""Keys of the tables, and the distributions that they describe."""

DISTRIBUTION_SCHEMA: Mapping[str, Any] = {
    "type": "object",
    "properties": dict.fromkeys(dict.fromkeys(key for keys, _ in _DISTRIBUTIONS for key in keys), QUANTITY_SCHEMA),
    "additionalProperties": False,
}
"""JSON schema of a distribution."""


def distribution_of(name: str, content: Any, read: Read) -> Distribution:
    """Create a distribution from `{low, high}`, `{mean, deviation}`, `{median, factor}` or `{nominal, plus_minus}`.

    Raises
    ------
    ValueError
        Other keys, or numbers that are not allowed.
    """
    for keys, make in _DISTRIBUTIONS:
        if isinstance(content, Mapping) and set(content) == set(keys):
            numbers = {key: read(f"{name}.{key}", content[key]) for key in keys if key != "factor"}
            if "factor" in keys:  # it has no unit
                numbers["factor"] = parse(f"{name}.factor", content["factor"], Kind.NUMBER)
            with as_given(content, f"{name}."):
                return make(**numbers)
    raise ValueError(
        f"{name} = {shown(content)} must be {{low, high}}, {{mean, deviation}} with or without low and high, "
        "{median, factor}, or {nominal, plus_minus}"
    )
