"""Short phrases of shells and links: ranges, limits and tolerances of named numbers."""

from __future__ import annotations

import re
from typing import Any

from ..core.checks import check_names, shown
from ..core.quantities import QUANTITIES
from ..files.units import parse
from ..problem.presets import named_material
from .distributions import Distribution, Rectangular, tolerance
from .limits import NAMES as LIMITED
from .limits import Limit
from .parameters import PARAMETERS, PARTS_OF

_MAX_CHARACTERS = 200


def range_of(phrase: str) -> tuple[str, float, float]:
    """A name with two ends, from "ball_radius=11..23 mm".

    Raises
    ------
    ValueError
        Another form, or a name that is not known.
    """
    found = _matched(r"\s*(\w+)\s*=\s*(.+?)\s*\.\.\s*(.+?)\s*", phrase)
    if found is None:
        raise ValueError(f"{shown(phrase)} is not a range, such as 'ball_radius=11..23 mm'")
    name, low, high = found.groups()
    check_names([name], PARAMETERS, "among what can vary")
    kind = PARAMETERS[name].kind
    return name, parse(name, _with_unit(low, high), kind), parse(name, high, kind)


def ends_of(name: str, phrase: str, kind: str) -> tuple[float, float]:
    """Two ends of a range of something of that kind, from "30..60 deg".

    Raises
    ------
    ValueError
        Another form.
    """
    found = _matched(r"\s*(.+?)\s*\.\.\s*(.+?)\s*", phrase)
    if found is None:
        raise ValueError(f"{name} = {shown(phrase)} is not a range, such as '30..60 deg'")
    low, high = found.groups()
    return parse(name, _with_unit(low, high), kind), parse(name, high, kind)


def choice_of(phrase: str) -> tuple[str, list[Any]] | None:
    """A name with a list, from "head_diameter=28, 32, 36 mm" or "liner=uhmwpe,pom"; None of another form.

    Raises
    ------
    ValueError
        A name, a material or a number that is not known.
    """
    found = _matched(r"\s*(\w+)\s*=\s*([^=]+?)\s*", phrase)
    if found is None or ".." in phrase:
        return None
    name, listed = found.groups()
    texts = [text.strip() for text in listed.split(",")]
    if name in PARTS_OF:
        return name, [named_material(name, text) for text in texts]
    if len(texts) == 1:
        return None
    check_names([name], PARAMETERS, "among what can vary")
    return name, [parse(name, _with_unit(text, texts[-1]), PARAMETERS[name].kind) for text in texts]


def spread_of(phrase: str) -> tuple[str, Distribution]:
    """A name that scatters, from "clearance=0.10+-0.05 mm" (a tolerance) or "liner_poisson=0.38..0.46" (uniform).

    Raises
    ------
    ValueError
        Another form, or a name that is not known.
    """
    found = _matched(r"\s*(\w+)\s*=\s*(.+?)\s*(?:\+-|\+/-|±)\s*(.+?)\s*", phrase)
    if found is None:
        name, low, high = range_of(phrase)
        return name, Rectangular(low=low, high=high)
    name, middle, half = found.groups()
    check_names([name], PARAMETERS, "among what can scatter")
    kind = PARAMETERS[name].kind
    return name, tolerance(parse(name, _with_unit(middle, half), kind), parse(name, half, kind))


def limit_of(phrase: str) -> Limit:
    """A limit, from "outer_radius<=26 mm" or "edge_distance>=5 mm"; < is taken as <=, since ends count.

    Raises
    ------
    ValueError
        Another form, or a name that is not known.
    """
    found = _matched(r"\s*(\w+)\s*(<=|>=|≤|≥|<|>|==?)\s*(.+?)\s*", phrase)
    if found is None:
        raise ValueError(f"{shown(phrase)} is not a limit, such as 'outer_radius<=26 mm'")
    name, sign, end = found.groups()
    if "=" in (sign, sign[:1]):
        raise ValueError(f"{shown(phrase)} is not a limit: it needs <= or >=, such as 'outer_radius<=26 mm'")
    check_names([name], LIMITED, "among what can be limited")
    value = parse(name, end, QUANTITIES[name].kind)
    return Limit(name=name, high=value) if sign[0] in "<≤" else Limit(name=name, low=value)


def _matched(form: str, phrase: str) -> re.Match[str] | None:
    """The parts of a phrase; none of one that is too long to be meant, in which a search could take seconds."""
    return re.fullmatch(form, phrase) if len(phrase) <= _MAX_CHARACTERS else None


def _with_unit(first: str, last: str) -> str:
    """The first number with the unit of the last, where it has none of its own."""
    unit = re.fullmatch(r"[-+\d.eE]+\s*(.*)", last)
    bare = re.fullmatch(r"[-+]?[\d.]+(?:[eE][-+]?\d+)?", first)
    return f"{first} {unit.group(1)}".strip() if unit and bare else first
