"""Translation of a recorded tape to C statements."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from .recorder import BOOLEAN, CURVE_SLOPES, Part, Recorded

_C_OPERATORS = {"&": "&&", "|": "||"}


def c_number(value: float) -> str:
    """Format a number as a C literal without loss of digits."""
    if math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "INFINITY" if value > 0 else "(-INFINITY)"
    text = repr(float(value))
    return f"({text})" if value < 0 else text


def c_statements(targets: Mapping[str, Part]) -> str:
    """Translate recorded steps to C statements that assign a value to each target variable."""
    steps = _required_steps(list(targets.values()))
    lines = [line for step in steps for line in _step_statements(step)]
    lines += [f"{name} = {_c_operand(part)};" for name, part in targets.items()]
    return "\n".join(f"    {line}" for line in lines)


def _required_steps(parts: Sequence[Part]) -> list[Recorded]:
    """List the recorded steps that some parts depend on, in the order of the tape."""
    required: dict[int, Recorded] = {}
    pending = list(parts)
    while pending:
        part = pending.pop()
        if isinstance(part, Recorded) and part.number not in required:
            required[part.number] = part
            pending.extend(part.parts)
    return [required[number] for number in sorted(required)]


def _step_statements(step: Recorded) -> Iterator[str]:
    if step.step == "input":
        return
    if step.step == "curve":
        yield f"double {_c_operand(step)}[{CURVE_SLOPES}];"
        yield f"{step.about}({_c_operand(step.parts[0])}, {_c_operand(step)});"
        return
    kind = "int" if step.step in BOOLEAN else "double"
    yield f"const {kind} {_c_operand(step)} = {_step_expression(step, [_c_operand(part) for part in step.parts])};"


def _step_expression(step: Recorded, operands: list[str]) -> str:
    if step.step == "where":
        return "{} ? {} : {}".format(*operands)
    if step.step == "scaled_exp":  # the exponential is only computed where it counts
        return "{0} == 0.0 ? 0.0 : {0} * exp({1})".format(*operands)
    if step.step == "slope":
        return f"{operands[0]}[{step.about}]"
    if step.step == "neg":
        return f"-{operands[0]}"
    if step.step == "not":
        return f"!{operands[0]}"
    if len(operands) == 2 and not step.step.isalnum():
        return f"{operands[0]} {_C_OPERATORS.get(step.step, step.step)} {operands[1]}"
    return f"{step.step}({', '.join(operands)})"


def _c_operand(part: Part) -> str:
    """Return a part as a C operand: a literal, an input or a variable such as "t12"."""
    if not isinstance(part, Recorded):
        return c_number(part)
    return str(part.about) if part.step == "input" else f"t{part.number}"
