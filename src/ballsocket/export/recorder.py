"""Formulas written down while they are calculated: what a program in C is made of.

The formulas of this package run on anything that follows the array API standard. Here they run on numbers that are not
known yet, and each step that they take is noted.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

Part = Any
"""A `Recorded`, or a Python number."""

BOOLEAN = frozenset(("<", "<=", ">", ">=", "==", "!=", "&", "|", "not", "isfinite"))
_GENERAL = {">": True, ">=": True, "!=": True, "==": False, "<": False, "<=": False}


CURVE_SLOPES = 4
"""A curve gives its value and the next slopes."""


@dataclass(eq=False)
class Tape:
    """The steps of a calculation in their order; the same step is noted once."""

    steps: list[Recorded] = field(default_factory=list)
    _known: dict[tuple[Any, ...], Recorded] = field(default_factory=dict)

    def input(self, name: str, tunable: bool = False) -> Recorded:
        """A number that is given later; of one that is `tunable` formulas may ask whether it is 0: it may be any."""
        return self.note("input", (), name, tunable=tunable)

    def curve(self, name: str, x: Recorded, slopes: int) -> tuple[Recorded, ...]:
        """A curve's value and its slopes."""
        looked_up = self.note("curve", (x,), name)
        return tuple(self.note("slope", (looked_up,), order) for order in range(slopes))

    def note(self, step: str, parts: tuple[Part, ...], about: Any = None, *, tunable: bool | None = None) -> Recorded:
        key = (step, about, *((id(part) if isinstance(part, Recorded) else ("number", part)) for part in parts))
        if key not in self._known:
            if tunable is None:
                tunable = all(part.tunable for part in parts if isinstance(part, Recorded))
            made = Recorded(self, len(self.steps), step, parts, about, tunable)
            self.steps.append(made)
            self._known[key] = made
        return self._known[key]


class Recorded:
    """A number that is not known yet: a step of a tape, and the parts that it takes."""

    __slots__ = ("about", "number", "parts", "step", "tape", "tunable")
    dtype = "float64"

    def __init__(self, tape: Tape, number: int, step: str, parts: tuple[Part, ...], about: Any, tunable: bool) -> None:
        self.tape, self.number, self.step = tape, number, step
        self.parts, self.about, self.tunable = parts, about, tunable

    def __array_namespace__(self, api_version: str | None = None) -> Any:
        return _NAMESPACE

    def __bool__(self) -> bool:
        if self.tunable and self.step in _GENERAL:
            return _GENERAL[self.step]
        raise TypeError("a formula that goes different ways for different states cannot be written down")

    def __hash__(self) -> int:
        return id(self)

    def __pow__(self, exponent: float) -> Part:
        if exponent in (1, 2, 3):
            return math.prod([self] * (int(exponent) - 1), start=self)
        return self.tape.note("pow", (self, float(exponent)))

    def __neg__(self) -> Recorded:
        return self.tape.note("neg", (self,))

    def __abs__(self) -> Recorded:
        return self.tape.note("fabs", (self,))

    def __add__(self, other: Part) -> Recorded:
        return self.tape.note("+", (self, other))

    def __radd__(self, other: Part) -> Recorded:
        return self.tape.note("+", (other, self))

    def __sub__(self, other: Part) -> Recorded:
        return self.tape.note("-", (self, other))

    def __rsub__(self, other: Part) -> Recorded:
        return self.tape.note("-", (other, self))

    def __mul__(self, other: Part) -> Recorded:
        return self.tape.note("*", (self, other))

    def __rmul__(self, other: Part) -> Recorded:
        return self.tape.note("*", (other, self))

    def __truediv__(self, other: Part) -> Recorded:
        return self.tape.note("/", (self, other))

    def __rtruediv__(self, other: Part) -> Recorded:
        return self.tape.note("/", (other, self))

    def __lt__(self, other: Part) -> Recorded:
        return self.tape.note("<", (self, other))

    def __le__(self, other: Part) -> Recorded:
        return self.tape.note("<=", (self, other))

    def __gt__(self, other: Part) -> Recorded:
        return self.tape.note(">", (self, other))

    def __ge__(self, other: Part) -> Recorded:
        return self.tape.note(">=", (self, other))

    def __eq__(self, other: Part) -> Recorded:  # type: ignore[override]
        return self.tape.note("==", (self, other))

    def __ne__(self, other: Part) -> Recorded:  # type: ignore[override]
        return self.tape.note("!=", (self, other))

    def __and__(self, other: Part) -> Recorded:
        return self.tape.note("&", (self, other))

    def __or__(self, other: Part) -> Recorded:
        return self.tape.note("|", (self, other))

    def __xor__(self, other: bool) -> Recorded:
        return self.tape.note("not", (self,)) if other else self


def where(condition: Part, this: Part, that: Part) -> Part:
    """One of two parts."""
    if isinstance(condition, bool):
        return this if condition else that
    return condition.tape.note("where", (condition, this, that))


def _clip(x: Part, low: float, high: float) -> Part:
    """Between two ends, either of which may be infinite; no number stays none."""
    if low > -math.inf:
        x = where(x < low, low, x)
    return where(x > high, high, x) if high < math.inf else x


def _function(name: str) -> Callable[..., Recorded]:
    def function(*parts: Part) -> Recorded:
        tape = next(part.tape for part in parts if isinstance(part, Recorded))
        return tape.note(name, parts)

    return function


class _Namespace:
    """The functions of the array API that formulas ask for."""

    __name__ = "recorded"
    int8 = "int8"
    isfinite = staticmethod(_function("isfinite"))
    where, clip = staticmethod(where), staticmethod(_clip)

    def __getattr__(self, name: str) -> Callable[..., Recorded]:
        if name not in FUNCTIONS:
            raise AttributeError(name)
        return _function(FUNCTIONS[name])

    @staticmethod
    def astype(part: Part, dtype: str) -> Part:
        return part


FUNCTIONS = {name: name for name in ("sqrt", "exp", "log", "log1p", "sin", "cos", "tan", "atan2")}
FUNCTIONS |= {name: name for name in ("atan", "asin", "acos", "asinh", "tanh")} | {"abs": "fabs"}
"""By their names in the array API: their names in C."""

_NAMESPACE = _Namespace()
