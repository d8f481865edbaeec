"""Translation of a recorded tape to statements of C or another language."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from .recorder import BOOLEAN, CURVE_SLOPES, Part, Recorded


def c_number(value: float) -> str:
    """Format a number as a C literal without loss of digits."""
    if math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "INFINITY" if value > 0 else "(-INFINITY)"
    text = repr(float(value))
    return f"({text})" if value < 0 else text


@dataclass(frozen=True, kw_only=True)
class Language:
    """Words of a programming language for the steps of a tape, as formats.

    Attributes
    ----------
    number : function
        Literal of a number.
    operators : dict
        Operators by those of the tape, where they differ.
    formats : dict
        Formats of the steps "where", "not" and "scaled_exp".
    function : str
        Format of a function's name.
    functions : dict
        Names of functions by those of C, where that format does not give them.
    assignment : dict
        Formats of an assignment to a new variable by its type, "int" or "double"; of one to a target by "target".
    curve : str
        Format of the evaluation of a curve: name of the curve, argument, variable and number of values.
    """

    number: Callable[[float], str]
    operators: Mapping[str, str]
    formats: Mapping[str, str]
    function: str
    functions: Mapping[str, str]
    assignment: Mapping[str, str]
    curve: str

    def statements(self, targets: Mapping[str, Part], indent: int = 4) -> str:
        """Translate recorded steps to statements that assign a value to each target variable."""
        required: dict[int, Recorded] = {}  # steps that the targets depend on, by their place on the tape
        pending = list(targets.values())
        while pending:
            part = pending.pop()
            if isinstance(part, Recorded) and part.number not in required:
                required[part.number] = part
                pending.extend(part.parts)
        steps = [required[number] for number in sorted(required)]
        lines = [self._statement(step) for step in steps if step.step != "input"]
        lines += [self.assignment["target"].format(name, self._operand(part)) for name, part in targets.items()]
        return "\n".join(f"{'':{indent}}{line}" for line in lines)

    def _statement(self, step: Recorded) -> str:
        variable, operands = self._operand(step), [self._operand(part) for part in step.parts]
        if step.step == "curve":
            return self.curve.format(step.about, operands[0], variable, CURVE_SLOPES)
        kind = "int" if step.step in BOOLEAN else "double"
        return self.assignment[kind].format(variable, self._expression(step, operands))

    def _expression(self, step: Recorded, operands: list[str]) -> str:
        """Write the expression of a recorded step from the texts of its operands."""
        if step.step in self.formats:
            return self.formats[step.step].format(*operands)
        if step.step == "slope":
            return f"{operands[0]}[{step.about}]"
        if step.step == "neg":
            return f"-{operands[0]}"
        if len(operands) == 2 and not step.step.isalnum():
            return f"{operands[0]} {self.operators.get(step.step, step.step)} {operands[1]}"
        return f"{self.functions.get(step.step, self.function.format(step.step))}({', '.join(operands)})"

    def _operand(self, part: Part) -> str:
        """Write a part as an operand: a literal, an input or a variable such as "t12"."""
        if not isinstance(part, Recorded):
            return self.number(part)
        return str(part.about) if part.step == "input" else f"t{part.number}"


C = Language(
    number=c_number,
    operators={"&": "&&", "|": "||"},
    formats={
        "where": "{} ? {} : {}",
        "not": "!{}",
        "scaled_exp": "{0} == 0.0 ? 0.0 : {0} * exp({1})",  # the exponential is only computed where it counts
    },
    function="{}",
    functions={},
    assignment={"int": "const int {} = {};", "double": "const double {} = {};", "target": "{} = {};"},
    curve="double {2}[{3}]; {0}({1}, {2});",
)
"""C99."""
