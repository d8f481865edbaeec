"""Recorded formulas: their values, their directional derivatives, and their text in C."""

import math
import operator
import re

import numpy as np
import pytest

from ballsocket.core import arrays
from ballsocket.export.c_text import C, c_number
from ballsocket.export.recorder import FUNCTIONS, Recorded, Tape, directional_derivatives, where

NAMES = {"+": "add", "-": "sub", "*": "mul", "/": "truediv", "<": "lt", "<=": "le", ">": "gt", ">=": "ge", "==": "eq"}
NAMES |= {"!=": "ne", "&": "and_", "|": "or_", "neg": "neg", "not": "not_", "pow": "pow", "fabs": "abs"}
OPERATORS = {sign: getattr(operator, name) for sign, name in NAMES.items()}


def evaluate(part, inputs):
    """Evaluate a recorded part in Python; a curve is a cubic polynomial."""
    if not isinstance(part, Recorded):
        return part
    if part.step == "input":
        return inputs[part.about]
    if part.step == "where":
        return evaluate(part.parts[1 if evaluate(part.parts[0], inputs) else 2], inputs)
    values = [evaluate(each, inputs) for each in part.parts]
    if part.step == "curve":
        return cubic(values[0])
    if part.step == "slope":
        return values[0][part.about]
    return OPERATORS[part.step](*values) if part.step in OPERATORS else getattr(math, part.step)(*values)


def cubic(x):
    return x**3, 3 * x**2, 6 * x, 6.0


def function(name):
    return lambda x, y: getattr(x.__array_namespace__(), name)(x)


FORMULAS = {
    **{name: function(name) for name in FUNCTIONS if name not in ("atan2", "abs")},
    "atan2": lambda x, y: arrays.atan2(x, y),
    "absolute": lambda x, y: abs(x - y) * abs(y),
    "sum": lambda x, y: x + y + 2.0 + (3.0 + x),
    "difference": lambda x, y: x - y - 2.0 * y - (1.0 - x),
    "product": lambda x, y: -x * y * 3.0,
    "quotient": lambda x, y: x / y + 2.0 / y + y / 4.0,
    "square": lambda x, y: x**2 * y,
    "cube": lambda x, y: x**3 + y**1,
    "power": lambda x, y: y**2.5 + x**4,
    "where": lambda x, y: where(x < y, x * x, y) + where(x >= y, 7.0, y * y) + where(x == y, 1.0, 2.0),
    "clip": lambda x, y: arrays.clip(x, 0.1, 0.2) * y + arrays.clip(x, -1.0, 1.0) + arrays.clip(y, 5.0, math.inf),
    "curve": lambda x, y: x.tape.curve("cubic", x * y, 2)[0] + x.tape.curve("cubic", x * y, 2)[1] * y,
}


@pytest.mark.parametrize("formula", FORMULAS.values(), ids=FORMULAS)
def test_directional_derivative_of_a_formula_equals_the_difference(formula):
    tape = Tape()
    x, y, dx, dy = (tape.input(name) for name in ("x", "y", "dx", "dy"))
    recorded = formula(x, y)
    (slope,) = directional_derivatives([recorded], {x: dx, y: dy})
    for x, y in ((0.31, 0.72), (0.55, 1.9)):
        for dx, dy in ((1.0, 0.0), (0.0, 1.0), (-0.7, 1.3)):
            high, low = (evaluate(recorded, {"x": x + by * dx, "y": y + by * dy}) for by in (1e-6, -1e-6))
            values = {"x": x, "y": y, "dx": dx, "dy": dy}
            assert evaluate(slope, values) == pytest.approx((high - low) / 2e-6, rel=1e-7, abs=1e-8)


@pytest.mark.parametrize(("name", "sign"), [("asin", 1.0), ("acos", -1.0)])
def test_inverse_sine_and_cosine_have_no_slope_at_their_ends(name, sign):
    """The slope is 1/sqrt(1 - x²) inside, and 0 at the ends, where a formula has clipped its argument."""
    tape = Tape()
    x = tape.input("x")
    (rate,) = directional_derivatives([getattr(x.__array_namespace__(), name)(x)], {x: 1.0})
    assert evaluate(rate, {"x": 0.999}) == pytest.approx(sign / math.sqrt(1 - 0.999**2))
    assert evaluate(rate, {"x": 1.0}) == evaluate(rate, {"x": -1.0}) == 0.0


def test_equal_steps_are_recorded_once_and_constants_have_no_slope():
    tape = Tape()
    x, y = tape.input("x"), tape.input("y")
    assert directional_derivatives([y * y + 1.0, 3.0, x < y], {x: 1.0}) == [0.0, 0.0, 0.0]
    assert directional_derivatives([], {}) == []
    assert x * y is x * y
    assert x * 2.0 is not x * 3.0
    assert x - y is not y - x
    assert tape.input("x") is x
    assert [step.number for step in tape.steps] == list(range(len(tape.steps)))


def test_small_powers_are_products():
    x = Tape().input("x")
    for exponent in (1, 2, 3):
        assert "pow" not in C.statements({"out": x**exponent})
        assert evaluate(x**exponent, {"x": 1.7}) == pytest.approx(1.7**exponent, rel=1e-15)
    assert "= pow(x, 0.5);" in C.statements({"out": x**0.5})


@pytest.mark.parametrize("name", ["gt", "ge", "ne", "eq", "lt", "le"])
def test_a_tunable_parameter_is_in_general_above_zero_and_a_state_is_not_compared(name):
    tape, compare = Tape(), getattr(operator, name)
    tunable, state = tape.input("p", tunable=True), tape.input("x")
    assert bool(compare(tunable + tunable, 0.0)) is (name in ("gt", "ge", "ne"))
    with pytest.raises(TypeError, match="data-dependent branches cannot be exported"):
        bool(compare(tunable + state, 0.0))


@pytest.mark.parametrize(
    ("value", "text"), [(0.1, "0.1"), (-2.0, "(-2.0)"), (1e-300, "1e-300"), (3, "3.0"), (0.0, "0.0"), (math.nan, "NAN")]
)
def test_numbers_in_c_have_all_digits(value, text):
    assert c_number(value) == text
    assert c_number(math.inf) == "INFINITY"
    assert c_number(-math.inf) == "(-INFINITY)"


def test_statements_hold_only_the_steps_that_a_target_needs_in_their_order():
    tape = Tape()
    x, y = tape.input("x"), tape.input("y")
    unused = x * x
    condition = ((x < y) & (x <= 2.0)) | ((x == y) ^ True)
    chosen = where(condition, -x, abs(y))
    value, slope = tape.curve("law", chosen, 2)
    text = C.statements({"out": value + slope})
    defined = [int(number) for number in re.findall(r"(?:int|double) t(\d+)", text)]
    assert defined == sorted(set(defined))
    named = [int(number) for number in re.findall(r"\bt(\d+)", text)]
    assert all(named.count(number) > 1 for number in defined)  # where it is defined, and where it is used
    assert f"t{unused.number}" not in text


def test_limits_of_a_clipped_part_may_be_infinite():
    x = Tape().input("x")
    for low, high in ((0.0, 1.0), (-math.inf, 1.0), (0.0, math.inf)):
        clipped = arrays.clip(x, low, high)
        for value in (-3.0, 0.0, 0.5, 1.0, 4.0):
            assert evaluate(clipped, {"x": value}) == np.clip(value, low, high)
        assert math.isnan(evaluate(clipped, {"x": math.nan}))
    assert arrays.clip(x, -math.inf, math.inf) is x
