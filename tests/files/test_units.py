"""Products of units: parsing and refusals."""

import json
from pathlib import Path

import pytest

from ballsocket.files import units as module
from ballsocket.files.units import LONGEST, convert, parse, parse_units
from ballsocket.hip.wear_law import wear_factor, wear_per_energy, wear_per_slide

from ..refusals import text_tables

ENDLESS = ("9^9^9^9", "mm^9^9^9", "(9**9**9)*mm", "2^2^2^2^2^2^2^2", "mm^3/(N m)^9^9^9", "mm^(9^9^9)", "mm^-9**9**9")


@pytest.mark.parametrize("units", ENDLESS)
@pytest.mark.parametrize("read", [wear_factor, wear_per_energy, wear_per_slide])
def test_a_coefficient_is_not_evaluated(units, read):
    with pytest.raises(ValueError, match=r"coefficient = .* is not a coefficient, such as '1e-6 mm"):
        read("coefficient", f"1e-6 {units}")


PRODUCTS, AMBIGUOUS = text_tables(Path(__file__).parent / "units.txt")


@pytest.mark.parametrize(("text", "units"), PRODUCTS)
def test_a_product_of_units_is_parsed(text, units):
    assert parse_units(text.replace("(nothing)", "")) == json.loads(units)


NO_PRODUCTS = ("1/mm", "mm/", "/mm", "(mm", "mm)", "()", "mm^10", "mm^0", "mm^^2", "mm^1.5", "mm+mm", "9", "kkm")


@pytest.mark.parametrize("text", [*NO_PRODUCTS, "mm^9 mm^9"])
def test_anything_else_is_no_product_of_units(text):
    with pytest.raises(ValueError, match=r"."):
        parse_units(text)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("text", ["2e31 dB", "1 dBm", "1 degC", "1 Np"])
def test_units_of_another_scale_than_a_factor_are_refused(text):
    with pytest.raises(ValueError, match=r"is not a coefficient, such as '1e-6 mm/m'"):
        wear_per_slide("coefficient", text)


@pytest.mark.parametrize(
    ("kind", "texts"),
    {
        "force": ("3000 Newton", "3000 newtons", "3 Kilonewtons", "3 KILONEWTON", "3000 N."),
        "length": ("1 Inch", "1 IN", '1"', "1″", "25.4 Millimetres", "25400 Microns", "1000 mil"),
        "angle": ("40 Degrees", "40 DEG", "40º", "40 deg.", "2400 ArcMinutes"),
        "modulus": ("100 Bar", "10 Megapascals", "10 Newton/mm²", "10 newtons per square millimeter"),
    }.items(),
)
def test_full_names_may_have_any_capitals_and_plurals(kind, texts):
    first, *others = [parse("x", text, kind) for text in texts]
    assert others == pytest.approx([first] * len(others), rel=1e-12)


@pytest.mark.parametrize(("kind", "text", "right"), AMBIGUOUS)
def test_a_symbol_that_may_mean_two_units_is_refused_with_the_right_ones(kind, text, right):
    with pytest.raises(ValueError, match=f"x = '{text}' is not .*; {right}"):
        parse("x", text, kind)


def test_a_quantity_has_at_most_a_hundred_characters():
    assert parse("ball_radius", f"16{' ' * (LONGEST - 4)}mm", "length") == 16
    with pytest.raises(ValueError, match="ball_radius = '16  .* is not a length"):
        parse("ball_radius", f"16{' ' * LONGEST}mm", "length")
    with pytest.raises(ValueError, match="a unit has at most 100 characters, got 101"):
        parse_units("m" * 101)


def test_units_without_a_dimension_or_of_another_one_are_refused():
    for text in ("5 dimensionless", "5 mm dimensionless"):
        with pytest.raises(ValueError, match=f"force = '{text}' is not a force, such as '3 kN'"):
            parse("force", text, "force")
    for unit in ("K", "Qm^9 Qm^-9 Qm^-8", "parsec^9"):
        with pytest.raises(ValueError, match="has another dimension than"):
            convert(1.0, parse_units(unit), {"millimeter": 1})
    with pytest.raises(ValueError, match="coefficient = 1000.* is too large a number"):
        wear_factor("coefficient", 10**400)


def test_factors_and_names_of_common_units_are_those_of_pint(monkeypatch):
    """Common units are converted without importing pint; the numbers are the same to the last bit."""
    numbers = [0.1, 3.0, 7 / 3, 1e-9, 12345.678, *(k / 10 for k in range(100))]
    pairs = [[{name: power} for name, power in units] for units in module._COMMON_FACTORS]
    texts = list(module._COMMON_UNITS)

    def converted():
        return [[convert(number, *pair) for number in numbers] for pair in pairs], list(map(parse_units, texts))

    direct = converted()
    monkeypatch.setattr(module, "_COMMON_FACTORS", {})
    monkeypatch.setattr(module, "_COMMON_UNITS", {})
    assert converted() == direct


@pytest.mark.parametrize(("kind", "text"), [("modulus", "2 mPa"), ("foundation modulus", "280 mPa/mm")])
def test_millipascals_are_a_slip_for_megapascals_except_in_a_viscosity(kind, text):
    with pytest.raises(ValueError, match="mPa is a thousandth of 1 Pa: write MPa"):
        parse("it", text, kind)
    assert parse("it", "2.5 mPa s", "viscosity") == pytest.approx(2.5e-3)


@pytest.mark.parametrize("text", ["0.1 mm +- 5 %", "0.1 ± 0.02 mm", "0.1 +/- 0.02 mm"])
def test_a_number_with_a_tolerance_is_answered_with_the_place_of_tolerances(text):
    with pytest.raises(ValueError, match="state a tolerance apart from the number, by --spread"):
        parse("clearance", text, "length")
