"""Ranges, lists, limits, distributions and correlations of parameters: short texts, and tables of files."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from ..core.checks import check_names, number_of_percent, shown
from ..core.kinds import Kind
from ..core.quantities import QUANTITIES
from ..files.schema import QUANTITY_SCHEMA
from ..files.units import as_given, parse
from ..problem.presets import named_material
from .distributions import Correlation, Distribution, LogNormal, Normal, Rectangular, tolerance
from .parameters import MATERIAL_PARTS, PARAMETERS

if TYPE_CHECKING:
    from .limits import Limit

Read = Callable[[str, Any], float]
"""Function from name and value of a number in a file to the number."""

_MAX_CHARACTERS = 200  # largest length of a text; matching a longer one could take seconds


def parse_range(text: str, form: str = "a range, such as 'ball_radius=11..23 mm'") -> tuple[str, float, float]:
    """Parse a name and the two ends of its range in mm, N, MPa or rad, as in "ball_radius=11..23 mm".

    Raises ValueError: an unknown name, or text that is not of the `form`, which the message states.
    """
    pattern = r"\s*([\w.]+)\s*=\s*(.+?)\s*\.\.\s*(.+?)\s*"
    name, low, high = _parts(pattern, text, f"{shown(text)} is not {form}")
    check_names([name], PARAMETERS, "among what can vary")
    kind = PARAMETERS[name].kind
    return name, parse(name, _add_unit(low, high), kind), parse(name, high, kind)


def parse_ends(name: str, text: str, kind: str) -> tuple[float, float]:
    """Parse the two ends of a range of a kind of quantity, as in "30..60 deg", in mm, N, MPa or rad.

    Raises ValueError: another form; the message has the `name`.
    """
    form = f"{name} = {shown(text)} is not a range, such as '30..60 deg'"
    low, high = _parts(r"\s*(.+?)\s*\.\.\s*(.+?)\s*", text, form)
    return parse(name, _add_unit(low, high), kind), parse(name, high, kind)


def parse_choices(text: str) -> tuple[str, list[Any]] | None:
    """Parse a name and a list, as in "head_diameter=28, 32, 36 mm" or "liner=uhmwpe,pom"; None for another form.

    Raises ValueError: an unknown name or material, or text that is not a number.
    """
    match = _match(r"\s*([\w.]+)\s*=\s*([^=]+?)\s*", text)
    if match is None or ".." in text:
        return None
    name, listed = match.groups()
    items = [item.strip() for item in listed.split(",")]
    if name in MATERIAL_PARTS:
        return name, [named_material(name, item) for item in items]
    if len(items) == 1:
        return None
    check_names([name], PARAMETERS, "among what can vary")
    return name, [parse(name, _add_unit(item, items[-1]), PARAMETERS[name].kind) for item in items]


def parse_distribution(text: str) -> tuple[str, Distribution]:
    """Parse a name and its distribution: "clearance=0.10+-0.05 mm" (tolerance), "liner_poisson=0.38..0.46" (uniform).

    A tolerance may be a percentage of its nominal value, as in "clearance=0.1 mm +- 5 %".

    Raises ValueError: another form, or an unknown name.
    """
    match = _match(r"\s*([\w.]+)\s*=\s*(.+?)\s*(?:\+-|\+/-|±)\s*(.+?)\s*", text)
    if match is None:
        name, low, high = parse_range(text, "a tolerance or range, such as 'clearance=0.1+-0.02 mm' or '0.08..0.12 mm'")
        return name, Rectangular(low=low, high=high)
    name, nominal, plus_minus = match.groups()
    check_names([name], PARAMETERS, "among what can scatter")
    read = partial(parse, kind=PARAMETERS[name].kind)
    centre = read(name, nominal if number_of_percent(plus_minus) else _add_unit(nominal, plus_minus))
    return name, tolerance(centre, _read_width(name, plus_minus, centre, read))


def parse_correlations(texts: Iterable[str]) -> Correlation:
    """Parse several rank correlations, as in "clearance, liner_young = 0.5".

    Raises ValueError: another form, an unknown name, or a pair that occurs twice.
    """
    correlation: dict[tuple[str, str], float] = {}
    for text in texts:
        form = f"{shown(text)} is not a correlation, such as 'clearance, liner_young = 0.5'"
        one, other, rank = _parts(r"\s*([\w.]+)\s*,\s*([\w.]+)\s*=\s*(.+?)\s*", text, form)
        check_names([one, other], PARAMETERS, "among what can scatter")
        value = parse(f"correlation of {one} and {other}", rank, Kind.NUMBER)
        if (one, other) in correlation:
            raise ValueError(f"the correlation of {one} and {other} is given twice; one is needed")
        correlation[one, other] = value
    return correlation


def parse_limit(text: str) -> Limit:
    """Parse a limit, as in "outer_radius<=26 mm" or "edge_distance>=5 mm"; < is read as <=, since limits include ends.

    Raises ValueError: another form, or an unknown name.
    """
    from .limits import LIMITED_NAMES, Limit  # slow to import

    form = f"{shown(text)} is not a limit, such as 'outer_radius<=26 mm'"
    name, sign, end = _parts(r"\s*([\w.]+)\s*(<=|>=|≤|≥|<|>|==?)\s*(.+?)\s*", text, form)
    if "=" in (sign, sign[:1]):
        raise ValueError(f"{shown(text)} is not a limit: it needs <= or >=, such as 'outer_radius<=26 mm'")
    check_names([name], LIMITED_NAMES, "among what can be limited")
    value = parse(name, end, QUANTITIES[name].kind)
    return Limit(name=name, high=value) if sign[0] in "<≤" else Limit(name=name, low=value)


def _match(pattern: str, text: str) -> re.Match[str] | None:
    """Match a complete text of limited length; None if it does not match or is too long."""
    return re.fullmatch(pattern, text) if len(text) <= _MAX_CHARACTERS else None


def _parts(pattern: str, text: str, message: str) -> tuple[str, ...]:
    match = _match(pattern, text)
    if match is None:
        raise ValueError(message)
    return match.groups()


def _add_unit(number: str, last: str) -> str:
    """Return a number with the unit of the last number if it has no unit."""
    unit = re.fullmatch(r"[-+\d.eE]+\s*(.*)", last)
    bare = re.fullmatch(r"[-+]?[\d.]+(?:[eE][-+]?\d+)?", number)
    return f"{number} {unit.group(1)}".strip() if unit and bare else number


def _read_width(name: str, stated: Any, centre: float, read: Read) -> float:
    """Read a tolerance or a deviation, a number with a unit or a percentage of the value at the centre."""
    percent = number_of_percent(stated)
    return read(name, stated) if percent is None else parse(name, percent, Kind.NUMBER) / 100 * abs(centre)


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

    Raises ValueError: other keys, or numbers that are not allowed.
    """
    for keys, make in _DISTRIBUTIONS:
        if isinstance(content, Mapping) and set(content) == set(keys):
            numbers: dict[str, float] = {}
            for key in keys:
                label, stated = f"{name}.{key}", content[key]
                if key == "factor":  # it has no unit
                    numbers[key] = parse(label, stated, Kind.NUMBER)
                elif key in ("deviation", "plus_minus"):
                    numbers[key] = _read_width(label, stated, numbers[keys[0]], read)
                else:
                    numbers[key] = read(label, stated)
            with as_given(content, f"{name}."):
                return make(**numbers)
    raise ValueError(
        f"{name} = {shown(content)} must be {{low, high}}, {{mean, deviation}} with or without low and high, "
        "{median, factor}, or {nominal, plus_minus}"
    )
