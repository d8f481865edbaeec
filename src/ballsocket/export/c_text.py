"""A tape as statements of C."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from .recorder import BOOLEAN, CURVE_SLOPES, Part, Recorded

_BETWEEN = {"&": "&&", "|": "||"}


def c_number(value: float) -> str:
    """A number of C that is the same to the last digit."""
    if math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "INFINITY" if value > 0 else "(-INFINITY)"
    text = repr(float(value))
    return f"({text})" if value < 0 else text


def c_statements(targets: Mapping[str, Part]) -> str:
    """The statements that calculate parts, and put each where its name says."""
    steps = _needed(list(targets.values()))
    lines = [line for step in steps for line in _lines(step)]
    lines += [f"{name} = {_c(part)};" for name, part in targets.items()]
    return "\n".join(f"    {line}" for line in lines)


def _needed(parts: Sequence[Part]) -> list[Recorded]:
    """The steps that parts depend on, in their order."""
    found: dict[int, Recorded] = {}
    waiting = list(parts)
    while waiting:
        part = waiting.pop()
        if isinstance(part, Recorded) and part.number not in found:
            found[part.number] = part
            waiting.extend(part.parts)
    return [found[number] for number in sorted(found)]


def _lines(step: Recorded) -> Iterator[str]:
    if step.step == "input":
        return
    if step.step == "curve":
        yield f"double {_c(step)}[{CURVE_SLOPES}];"
        yield f"{step.about}({_c(step.parts[0])}, {_c(step)});"
        return
    kind = "int" if step.step in BOOLEAN else "double"
    yield f"const {kind} {_c(step)} = {_expression(step, [_c(part) for part in step.parts])};"


def _expression(step: Recorded, parts: list[str]) -> str:
    if step.step == "where":
        return "{} ? {} : {}".format(*parts)
    if step.step == "slope":
        return f"{parts[0]}[{step.about}]"
    if step.step == "neg":
        return f"-{parts[0]}"
    if step.step == "not":
        return f"!{parts[0]}"
    if len(parts) == 2 and not step.step.isalnum():
        return f"{parts[0]} {_BETWEEN.get(step.step, step.step)} {parts[1]}"
    return f"{step.step}({', '.join(parts)})"


def _c(part: Part) -> str:
    if not isinstance(part, Recorded):
        return c_number(part)
    return str(part.about) if part.step == "input" else f"t{part.number}"
