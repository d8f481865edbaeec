"""Recorder of formulas by operator overloading: a formula evaluated on unknown numbers leaves a tape.

The formulas of this package run on anything that follows the array API standard. Here they run on `Recorded` numbers,
and the tape is written as C. `directional_derivatives` applies the chain rule to it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..core.arrays import cos, exp, sin, sqrt

Part = Any
"""A `Recorded`, or a Python number."""

Slope = Part | None  # derivative of a part; None where the part is constant

BOOLEAN = frozenset(("<", "<=", ">", ">=", "==", "!=", "&", "|", "not", "isfinite"))
"""Steps whose result is true or false."""

_GENERAL_TRUTH = {">": True, ">=": True, "!=": True, "==": False, "<": False, "<=": False}
"""Results of comparisons of a tunable parameter with 0 in the general case."""

CURVE_SLOPES = 4  # number of values that a curve returns: itself and its derivatives


@dataclass(eq=False)
class Tape:
    """Recorded steps of a calculation in their order, without duplicates."""

    steps: list[Recorded] = field(default_factory=list)
    _steps_by_key: dict[tuple[Any, ...], Recorded] = field(default_factory=dict)

    def input(self, name: str, tunable: bool = False) -> Recorded:
        """Record a named input of the calculation.

        A formula may compare a `tunable` input with 0; the general case is recorded.
        """
        return self.record("input", (), name, tunable=tunable)

    def curve(self, name: str, x: Recorded, value_count: int) -> tuple[Recorded, ...]:
        """Record the evaluation of a fitted curve at x; return its value and derivatives."""
        evaluation = self.record("curve", (x,), name)
        return tuple(self.record("slope", (evaluation,), order) for order in range(value_count))

    def record(self, step: str, parts: tuple[Part, ...], about: Any = None, *, tunable: bool | None = None) -> Recorded:
        """Record an operation on some parts, unless it is on the tape already; return its result."""
        key = (step, about, *((id(part) if isinstance(part, Recorded) else ("number", part)) for part in parts))
        if key not in self._steps_by_key:
            if tunable is None:
                tunable = all(part.tunable for part in parts if isinstance(part, Recorded))
            recorded = Recorded(self, len(self.steps), step, parts, about, tunable)
            self.steps.append(recorded)
            self._steps_by_key[key] = recorded
        return self._steps_by_key[key]


def _operator(step: str, reflected: bool = False) -> Callable[[Any, Part], Any]:
    """Make the method of an operator, which records it with another part; `reflected` if that part is on the left."""
    return lambda part, operand: part.tape.record(step, (operand, part) if reflected else (part, operand))


class Recorded:
    """Unknown number of a recorded formula: the result of an operation on its parts."""

    __slots__ = ("about", "number", "parts", "step", "tape", "tunable")
    dtype = "float64"

    def __init__(self, tape: Tape, number: int, step: str, parts: tuple[Part, ...], about: Any, tunable: bool) -> None:
        self.tape, self.number, self.step = tape, number, step
        self.parts, self.about, self.tunable = parts, about, tunable

    def __array_namespace__(self, api_version: str | None = None) -> Any:
        return _NAMESPACE

    def __bool__(self) -> bool:
        if self.tunable and self.step in _GENERAL_TRUTH:
            return _GENERAL_TRUTH[self.step]
        raise TypeError("data-dependent branches cannot be exported; use where()")

    def __hash__(self) -> int:
        return id(self)

    def __pow__(self, exponent: float) -> Part:
        if exponent in (1, 2, 3):
            return math.prod([self] * (int(exponent) - 1), start=self)
        return self.tape.record("pow", (self, float(exponent)))

    def __neg__(self) -> Recorded:
        return self.tape.record("neg", (self,))

    def __abs__(self) -> Recorded:
        return self.tape.record("fabs", (self,))

    __add__, __radd__ = _operator("+"), _operator("+", reflected=True)
    __sub__, __rsub__ = _operator("-"), _operator("-", reflected=True)
    __truediv__, __rtruediv__ = _operator("/"), _operator("/", reflected=True)
    __lt__, __le__, __gt__, __ge__ = _operator("<"), _operator("<="), _operator(">"), _operator(">=")
    __eq__, __ne__ = _operator("=="), _operator("!=")
    __and__, __or__ = _operator("&"), _operator("|")
    __rmul__ = _operator("*", reflected=True)

    def __mul__(self, operand: Part) -> Recorded:
        if isinstance(operand, Recorded) and operand.step == "exp":
            return self.tape.record("scaled_exp", (self, *operand.parts))
        return self.tape.record("*", (self, operand))

    def __xor__(self, negate: bool) -> Recorded:
        return self.tape.record("not", (self,)) if negate else self


def where(condition: Part, if_true: Part, if_false: Part) -> Part:
    """Record the choice between two parts by a condition."""
    if isinstance(condition, bool):
        return if_true if condition else if_false
    return condition.tape.record("where", (condition, if_true, if_false))


def _record_clip(x: Part, low: float, high: float) -> Part:
    """Record the limitation of a part to an interval with possibly infinite ends; NaN stays NaN."""
    if low > -math.inf:
        x = where(x < low, low, x)
    return where(x > high, high, x) if high < math.inf else x


def _recording_function(step_name: str) -> Callable[..., Recorded]:
    def record_call(*parts: Part) -> Recorded:
        tape = next(part.tape for part in parts if isinstance(part, Recorded))
        return tape.record(step_name, parts)

    return record_call


class _Namespace:
    """Array API namespace of recorded numbers, with the mathematical functions of the formulas."""

    __name__ = "recorded"
    int8 = "int8"
    isfinite = staticmethod(_recording_function("isfinite"))
    where, clip = staticmethod(where), staticmethod(_record_clip)

    def __getattr__(self, name: str) -> Callable[..., Recorded]:
        if name not in FUNCTIONS:
            raise AttributeError(name)
        return _recording_function(FUNCTIONS[name])

    @staticmethod
    def astype(part: Part, dtype: str) -> Part:
        """Return the part unchanged, because recorded numbers have one type."""
        return part


FUNCTIONS = {name: name for name in ("sqrt", "exp", "log", "log1p", "sin", "cos", "tan", "atan2")}
FUNCTIONS |= {name: name for name in ("atan", "asin", "acos", "asinh", "tanh")} | {"abs": "fabs"}
"""C names of functions by their names in the array API."""

_NAMESPACE = _Namespace()


def directional_derivatives(parts: Sequence[Part], direction: Mapping[Recorded, Part]) -> list[Part]:
    """Record the derivatives of some parts with respect to the inputs, along a direction."""
    slopes: dict[int, Slope] = {variable.number: rate for variable, rate in direction.items()}
    recorded_parts = [part for part in parts if isinstance(part, Recorded)]
    for step in list(recorded_parts[0].tape.steps) if recorded_parts else ():
        if step.number not in slopes:
            slopes[step.number] = (
                None
                if step.step in BOOLEAN
                else _record_chain_rule(step, [_derivative_of(part, slopes) for part in step.parts])
            )
    return [0.0 if (slope := _derivative_of(part, slopes)) is None else slope for part in parts]


def _derivative_of(part: Part, slopes: Mapping[int, Slope]) -> Slope:
    """Return the derivative of a part; None for a constant."""
    return slopes[part.number] if isinstance(part, Recorded) else None


def _record_chain_rule(step: Recorded, slopes: list[Slope]) -> Slope:
    """Record the derivative of a step by the chain rule, from the derivatives of its parts."""
    if all(slope is None for slope in slopes):
        return None
    if step.step == "where":
        if_true, if_false = (0.0 if slope is None else slope for slope in slopes[1:])
        return None if slopes[1] is None and slopes[2] is None else where(step.parts[0], if_true, if_false)
    if step.step == "curve":
        return slopes[0]
    if step.step == "slope":
        return step.tape.record("slope", step.parts, step.about + 1) * slopes[0]
    total: Slope = None
    for rate, slope in zip(_PARTIAL_DERIVATIVES[step.step](step, *step.parts), slopes, strict=True):
        if slope is not None:
            if not isinstance(rate, Recorded) and abs(rate) == 1.0:  # no multiplication by ±1
                term = slope if rate > 0 else -slope
            else:
                term = rate * slope
            total = term if total is None else total + term
    return total


def _asin_derivative(a: Part) -> Part:
    """Record the derivative 1/sqrt(1 - a²) of asin a; 0 at and beyond ±1, where formulas clip their arguments."""
    return where(a * a < 1.0, 1.0 / sqrt(1.0 - a * a), 0.0)


_PARTIAL_DERIVATIVES: Mapping[str, Callable[..., tuple[Part, ...]]] = {
    "+": lambda y, a, b: (1.0, 1.0),
    "-": lambda y, a, b: (1.0, -1.0),
    "*": lambda y, a, b: (b, a),
    "/": lambda y, a, b: (1.0 / b, -y / b),
    "neg": lambda y, a: (-1.0,),
    "fabs": lambda y, a: (where(a < 0.0, -1.0, 1.0),),
    "pow": lambda y, a, n: (n * y / a, 0.0),
    "sqrt": lambda y, a: (0.5 / y,),
    "exp": lambda y, a: (y,),
    "scaled_exp": lambda y, a, b: (exp(b), y),
    "log": lambda y, a: (1.0 / a,),
    "log1p": lambda y, a: (1.0 / (1.0 + a),),
    "sin": lambda y, a: (cos(a),),
    "cos": lambda y, a: (-sin(a),),
    "tan": lambda y, a: (1.0 + y * y,),
    "tanh": lambda y, a: (1.0 - y * y,),
    "atan": lambda y, a: (1.0 / (1.0 + a * a),),
    "asin": lambda y, a: (_asin_derivative(a),),
    "acos": lambda y, a: (-_asin_derivative(a),),
    "asinh": lambda y, a: (1.0 / sqrt(1.0 + a * a),),
    "atan2": lambda y, a, b: (b / (a * a + b * b), -a / (a * a + b * b)),
}
