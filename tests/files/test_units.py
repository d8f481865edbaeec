"""Products of units: parsing and refusals."""

import pytest

from ballsocket.files import units as module
from ballsocket.files.units import LONGEST, convert, parse, parse_units
from ballsocket.hip.wear_law import wear_factor, wear_per_energy, wear_per_slide

ENDLESS = ("9^9^9^9", "mm^9^9^9", "(9**9**9)*mm", "2^2^2^2^2^2^2^2", "mm^3/(N m)^9^9^9", "mm^(9^9^9)", "mm^-9**9**9")


@pytest.mark.parametrize("units", ENDLESS)
@pytest.mark.parametrize("read", [wear_factor, wear_per_energy, wear_per_slide])
def test_a_coefficient_is_not_evaluated(units, read):
    with pytest.raises(ValueError, match=r"coefficient = .* is not a coefficient, such as '1e-6 mm"):
        read("coefficient", f"1e-6 {units}")


@pytest.mark.parametrize(
    ("text", "units"),
    [
        ("mm^3/(N m)", {"millimeter": 3, "newton": -1, "meter": -1}),
        ("mm³/(N·m)", {"millimeter": 3, "newton": -1, "meter": -1}),
        ("mm3 / (N * m)", {"millimeter": 3, "newton": -1, "meter": -1}),
        ("mPa.s", {"millipascal": 1, "second": 1}),
        ("N/mm m", {"newton": 1, "millimeter": -1, "meter": 1}),
        ("mm**-2", {"millimeter": -2}),
        ("m/m", {}),
        ("", {}),
        ("°", {"degree": 1}),
        ("((mm))", {"millimeter": 1}),
    ],
)
def test_a_product_of_units_is_parsed(text, units):
    assert parse_units(text) == units


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


def test_a_quantity_has_at_most_a_hundred_characters():
    assert parse("ball_radius", f"16{' ' * (LONGEST - 4)}mm", "length") == 16
    with pytest.raises(ValueError, match="ball_radius = '16  .* is not a length"):
        parse("ball_radius", f"16{' ' * LONGEST}mm", "length")
    with pytest.raises(ValueError, match="a unit has at most 100 characters, got 101"):
        parse_units("m" * 101)


@pytest.mark.parametrize("text", ["5 dimensionless", "5 mm dimensionless"])
def test_a_unit_without_a_dimension_is_refused(text):
    with pytest.raises(ValueError, match=f"force = '{text}' is not a force, such as '3 kN'"):
        parse("force", text, "force")


@pytest.mark.parametrize("unit", ["K", "Qm^9 Qm^-9 Qm^-8", "parsec^9"])
def test_units_that_do_not_convert_are_refused(unit):
    with pytest.raises(ValueError, match="has another dimension than"):
        convert(1.0, parse_units(unit), {"millimeter": 1})


def test_a_coefficient_of_four_hundred_digits_is_too_large():
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
