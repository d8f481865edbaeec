"""Messages of checks: name, value, place in an array, allowed values and hints."""

import pickle

import numpy as np
import pytest

from ballsocket.core import checks


@pytest.mark.parametrize(
    ("value", "good", "message"),
    [
        (-1.0, False, "x = -1 is not allowed: it is positive"),
        (10**20, False, "x = 100000000000000000000 is not allowed: it is positive"),
        (np.array([1.0, -2.0, -3.0]), np.array([True, False, False]), "x[1] = -2 (and 1 more) is not allowed"),
        (np.array([[1.0, 2.0], [3.0, -4.0]]), np.array([[True, True], [True, False]]), "x[1, 1] = -4 is not allowed"),
        (
            np.arange(12.0).reshape(2, 3, 2),
            np.arange(12).reshape(2, 3, 2) != 9,
            "x[1, 1, 1] = 9 is not allowed",
        ),
    ],
)
def test_first_invalid_element_is_named_with_its_index(value, good, message):
    with pytest.raises(ValueError, match=r".*") as error:
        checks.require("x", value, good, "it is positive")
    assert str(error.value).startswith(message)
    checks.require("x", value, good | True, "it is positive")


def test_first_invalid_element_is_returned():
    assert checks.first_invalid(3.0, False) == 3.0
    assert checks.first_invalid(np.array([1.0, 5.0, 7.0]), np.array([True, False, False])) == 5.0


def test_numbers_are_single():
    assert checks.check_number("x", 3) == 3.0
    assert type(checks.check_number("x", np.float64(3))) is float
    with pytest.raises(TypeError, match="x must be one number, got "):
        checks.check_number("x", [1.0, 2.0])
    with pytest.raises(TypeError, match=r"got 'a'; text with units belongs in a joint file"):
        checks.check_numeric("x", "a")
    with pytest.raises(TypeError, match="got an array of bool"):
        checks.check_numeric("x", np.array([True]))
    with pytest.raises(TypeError, match="got a masked array"):
        checks.check_numeric("x", np.ma.masked_array([1.0]))
    pandas = pytest.importorskip("pandas")
    with pytest.raises(TypeError, match="got a DataFrame: take one of its columns"):
        checks.check_numeric("x", pandas.DataFrame({"a": [1.0]}))


def test_lists_and_integers_become_floats():
    assert checks.check_numeric("x", [1, 2]).dtype == np.float64
    assert checks.check_numeric("x", np.array([1, 2], dtype=np.int8)).dtype == np.float64
    assert checks.check_numeric("x", np.ones(1, dtype=np.float32)).dtype == np.float32
    with pytest.raises(TypeError, match="got an array of float16"):
        checks.check_numeric("x", np.ones(1, dtype=np.float16))


def test_vectors_have_three_components():
    assert checks.check_vectors("x", [[1, 2, 3]], "x, y, z").shape == (1, 3)
    with pytest.raises(ValueError, match=r"x of shape \(2,\) is not allowed: its last axis holds x, y, z"):
        checks.check_vectors("x", [1.0, 2.0], "x, y, z")


def test_exactly_one_load_is_selected():
    assert checks.select_load(force=None, indentation=2.0) == ("indentation", 2.0)
    with pytest.raises(ValueError, match="exactly one of force, indentation is needed, got none"):
        checks.select_load(force=None, indentation=None)
    with pytest.raises(ValueError, match="exactly one of force, indentation is needed, got force, indentation"):
        checks.select_load(force=1.0, indentation=2.0)
    with pytest.raises(TypeError, match=r"a load needs its name: force=3.0 in N, indentation=3.0 in mm"):
        checks.reject_unnamed_loads((3.0,))
    checks.reject_unnamed_loads(())


def test_angles_in_degrees_are_converted_for_hints():
    assert checks.degrees_hint(45.0) == "45 degrees are 0.7854 radians"


def test_missing_modules_are_named_with_their_extra():
    checks.needs("study", "numpy")
    with pytest.raises(ImportError, match=r'no_such_module is not .*: pip install "ballsocket\[study\]"') as error:
        checks.needs("study", "numpy", "no_such_module")
    assert error.value.name == "no_such_module"


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("forc", "; did you mean 'force'?"),
        ("max_presure", "; did you mean 'max-pressure'?"),
        ("max", "; did you mean 'max-pressure'?"),
        ("STIFNESS", "; did you mean 'stiffness'?"),
        ("ar", "; known: force, max-pressure, stiffness"),
        (7, "; known: force, max-pressure, stiffness"),
        ("qqqqq", "; known: force, max-pressure, stiffness"),
        ("stffne", "; did you mean 'stiffness'?"),
        ("fxxxce", "; did you mean 'force'?"),  # 6 of 11 letters are shared
        ("fxxxxxce", "; known: force, max-pressure, stiffness"),  # 6 of 13
    ],
)
def test_unknown_names_get_the_most_similar_one(name, hint):
    assert checks.nearest(name, ["force", "max-pressure", "stiffness"]) == hint


def test_similar_names_win_over_longer_ones_with_the_same_start():
    """A name that is nearly right is closer than one that only begins alike."""
    assert checks.nearest("forces", ["force", "forces-of-friction"]) == "; did you mean 'force'?"
    assert checks.nearest("exact-c", ["exact-curve", "exact"]) == "; did you mean 'exact'?"
    assert checks.nearest("bond", ["band", "bonded-layer"]) == "; did you mean 'bonded-layer'?"


def test_long_lists_of_names_are_cut():
    names = [f"name-{number:03}" for number in range(100)]
    hint = checks.nearest("zz", names)
    assert hint.startswith("; known: name-000, name-001")
    assert hint.endswith("name-019, ...")


def test_names_are_matched_regardless_of_spelling():
    assert checks.known_name("model", " Exact Curve", ["exact-curve"]) == "exact-curve"
    assert checks.known_name("model", "exact_curve", ["exact-curve"]) == "exact-curve"
    with pytest.raises(ValueError, match="model 'exct' is not known; did you mean 'exact'"):
        checks.known_name("model", "exct", ["exact"])
    checks.check_names(["a"], ["a", "b"], "in a list")
    with pytest.raises(ValueError, match="'c' in a list is not known; known: a, b"):
        checks.check_names(["a", "c"], ["a", "b"], "in a list")


def test_named_items_suggest_a_name_and_can_be_pickled():
    items = checks.NamedItems("planet", {"earth": 3})
    copy = pickle.loads(pickle.dumps(items))
    for table in (items, copy):
        assert table["earth"] == 3
        with pytest.raises(KeyError, match="planet 'Earth' is not known; did you mean 'earth'"):
            table["Earth"]


def test_texts_have_no_control_characters():
    assert checks.check_text("name", "a\tb\n") == "a\tb\n"
    assert checks.check_text("name", "a" * 1000)
    for text in ("a" * 1001, "\x1b[31m"):
        with pytest.raises(ValueError, match="must be at most 1000 characters with no control characters"):
            checks.check_text("name", text)
    with pytest.raises(ValueError, match="name = 3 must be text"):
        checks.check_text("name", 3)


def test_values_are_shown_on_one_short_line():
    assert checks.shown("a") == "'a'"
    assert checks.shown("x" * 57) == "'" + "x" * 57 + "'"
    assert checks.shown("x" * 58) == "'" + "x" * 39 + "..."
    assert checks.shown(np.eye(2)) == "array([[1., 0.], [0., 1.]])"
    assert checks.shown(10**5000) == "(int too long to show)"


@pytest.mark.parametrize("value", [7, 10_001, 8.5, 72.0, True, "8", None])
def test_whole_numbers_out_of_range_are_rejected(value):
    with pytest.raises(ValueError, match=r"^steps = .* is not allowed: a whole number from 8 to 10000$"):
        checks.check_whole_number("steps", value, 8, 10_000)


def test_whole_numbers_in_range_are_returned():
    assert [checks.check_whole_number("steps", value, 8, 10) for value in (8, 9, 10)] == [8, 9, 10]
    assert checks.check_whole_number("seed", 2**53 - 1) == 2**53 - 1
    for value in (-1, 2**53):
        with pytest.raises(ValueError, match="seed = .* is not allowed"):
            checks.check_whole_number("seed", value)


@pytest.mark.parametrize(
    ("text", "number"),
    [("10 %", "10"), (" 2.5e-1% ", "2.5e-1"), ("-3 %", "-3"), ("10", None), ("% 10", None), (10, None), ("", None)],
)
def test_percentages_are_recognised(text, number):
    assert checks.number_of_percent(text) == number


def test_blank_texts_are_rejected():
    assert checks.check_filled("path", "a b") == "a b"
    for text in ("", " \t"):
        with pytest.raises(ValueError, match="^path is empty: table to read$"):
            checks.check_filled("path", text, "table to read")
        with pytest.raises(ValueError, match="^path is empty$"):
            checks.check_filled("path", text)
