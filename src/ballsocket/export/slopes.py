"""Slopes of recorded formulas: the chain rule, step by step along the tape."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from ..core.arrays import cos, sin, sqrt
from .recorder import BOOLEAN, Part, Recorded, where

Slope = Part | None
"""None where a part does not change."""


def slopes_of(parts: Sequence[Part], ways: Mapping[Recorded, Part]) -> list[Part]:
    """How fast parts change while inputs change at the rates `ways`."""
    found: dict[int, Slope] = {each.number: way for each, way in ways.items()}
    known = [part for part in parts if isinstance(part, Recorded)]
    for step in list(known[0].tape.steps) if known else ():
        if step.number not in found:
            found[step.number] = (
                None if step.step in BOOLEAN else _slope(step, [_of(part, found) for part in step.parts])
            )
    return [0.0 if (slope := _of(part, found)) is None else slope for part in parts]


def _of(part: Part, found: Mapping[int, Slope]) -> Slope:
    return found[part.number] if isinstance(part, Recorded) else None


def _slope(step: Recorded, slopes: list[Slope]) -> Slope:
    if all(slope is None for slope in slopes):
        return None
    if step.step == "where":
        this, that = (0.0 if slope is None else slope for slope in slopes[1:])
        return None if slopes[1] is None and slopes[2] is None else where(step.parts[0], this, that)
    if step.step == "curve":
        return slopes[0]
    if step.step == "slope":
        return step.tape.note("slope", step.parts, step.about + 1) * slopes[0]
    total: Slope = None
    for rate, slope in zip(_RATES[step.step](step, *step.parts), slopes, strict=True):
        total = total if slope is None else _sum(total, _product(rate, slope))
    return total


def _sum(one: Slope, other: Part) -> Part:
    return other if one is None else one + other


def _product(rate: Part, slope: Part) -> Part:
    if not isinstance(rate, Recorded) and abs(rate) == 1.0:
        return slope if rate > 0 else -slope
    return rate * slope


def _over_root(a: Part) -> Part:
    # the ends are where formulas are clipped, and what they belong to goes on smoothly
    return where(a * a < 1.0, 1.0 / sqrt(1.0 - a * a), 0.0)


_RATES: Mapping[str, Callable[..., tuple[Part, ...]]] = {
    "+": lambda y, a, b: (1.0, 1.0),
    "-": lambda y, a, b: (1.0, -1.0),
    "*": lambda y, a, b: (b, a),
    "/": lambda y, a, b: (1.0 / b, -y / b),
    "neg": lambda y, a: (-1.0,),
    "fabs": lambda y, a: (where(a < 0.0, -1.0, 1.0),),
    "pow": lambda y, a, n: (n * y / a, 0.0),
    "sqrt": lambda y, a: (0.5 / y,),
    "exp": lambda y, a: (y,),
    "log": lambda y, a: (1.0 / a,),
    "log1p": lambda y, a: (1.0 / (1.0 + a),),
    "sin": lambda y, a: (cos(a),),
    "cos": lambda y, a: (-sin(a),),
    "tan": lambda y, a: (1.0 + y * y,),
    "tanh": lambda y, a: (1.0 - y * y,),
    "atan": lambda y, a: (1.0 / (1.0 + a * a),),
    "asin": lambda y, a: (_over_root(a),),
    "acos": lambda y, a: (-_over_root(a),),
    "asinh": lambda y, a: (1.0 / sqrt(1.0 + a * a),),
    "atan2": lambda y, a, b: (b / (a * a + b * b), -a / (a * a + b * b)),
}
