"""Messages of checks: name, value, allowed values and hints."""

import re
from functools import partial

import numpy as np
import pytest

from ballsocket.core import checks


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("forc", "; did you mean 'force'?"),
        ("max_presure", "; did you mean 'max-pressure'?"),
        ("max", "; did you mean 'max-pressure'?"),
        ("ar", "; known: force, max-pressure, stiffness"),
        ("stffne", "; did you mean 'stiffness'?"),
        ("fxxxce", "; did you mean 'force'?"),  # 6 of 11 letters are shared
        ("fxxxxxce", "; known: force, max-pressure, stiffness"),  # 6 of 13
    ],
)
def test_unknown_names_get_the_most_similar_one(name, hint):
    assert checks.nearest(name, ["force", "max-pressure", "stiffness"]) == hint


def test_similar_names_win_over_longer_ones_with_the_same_start_and_long_lists_are_cut():
    assert checks.nearest("forces", ["force", "forces-of-friction"]) == "; did you mean 'force'?"
    assert checks.nearest("exact-c", ["exact-curve", "exact"]) == "; did you mean 'exact'?"
    assert checks.nearest("bond", ["band", "bonded-layer"]) == "; did you mean 'bonded-layer'?"
    assert checks.nearest("zz", [f"name-{number:03}" for number in range(100)]).endswith("name-019, ...")


SMALL = partial(checks.check_whole_number, "steps", low=8, high=10_000)


@pytest.mark.parametrize(
    ("check", "arguments", "message"),
    [
        (checks.check_number, ("x", [1.0, 2.0]), "x must be one number, got "),
        (checks.check_names, (["a", "c"], ["a", "b"], "in a list"), "'c' in a list is not known; known: a, b"),
        *((checks.check_text, ("name", text), "at most 1000 characters") for text in ("a" * 1001, "\x1b[31m")),
        (checks.check_text, ("name", 3), "name = 3 must be text"),
        *((checks.check_filled, ("path", text), "path is empty") for text in ("", " \t")),
        (checks.check_filled, ("path", "", "table to read"), "path is empty: table to read"),
        *((SMALL, (n,), "from 8 to 10000") for n in (7, 10_001, 8.5, 72.0, True, "8", None)),
        *((checks.check_whole_number, ("seed", n), f"seed = {n} is not allowed") for n in (-1, 2**53)),
    ],
)
def test_values_that_are_not_allowed_are_refused(check, arguments, message):
    with pytest.raises(TypeError if check is checks.check_number else ValueError, match=re.escape(message)):
        check(*arguments)


def test_allowed_values_are_returned():
    assert type(checks.check_number("x", np.float64(3))) is float
    assert checks.check_numeric("x", [1, 2]).dtype == np.float64
    assert checks.check_numeric("x", np.array([1, 2], dtype=np.int8)).dtype == np.float64
    assert checks.check_numeric("x", np.ones(1, dtype=np.float32)).dtype == np.float32
    assert [SMALL(value) for value in (8, 10_000)] == [8, 10_000]
    assert checks.check_whole_number("seed", 2**53 - 1) == 2**53 - 1
    assert checks.check_text("name", "a\tb\n" + "a" * 996) == "a\tb\n" + "a" * 996
    assert checks.check_filled("path", "a b") == "a b"
    assert checks.known_name("model", " Exact Curve", ["exact-curve"]) == "exact-curve"
    assert checks.known_name("model", "exact_curve", ["exact-curve"]) == "exact-curve"
    checks.reject_unnamed_loads(())
