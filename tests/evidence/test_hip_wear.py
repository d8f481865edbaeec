"""Published wear and its predictions: the page has the computed ratios and bands, and every source."""

import math

import pytest

from ballsocket.evidence.hip_wear import INPUTS, PUBLISHED, make_hip, patients, ratios, simulators
from ballsocket.hip.simulator_cycles import iso_14242_1

from ..places import ROOT

PAGE = (ROOT / "docs" / "explanation" / "hip_validation.md").read_text(encoding="utf-8")


def row_of(name):
    row = PUBLISHED[name]
    lines = [line for line in PAGE.splitlines() if line.startswith(f"| {row.description} |") and row.source in line]
    return next(line for line in lines if f"| {row.value:g} " in line)


def test_page_has_the_ratios_of_the_laws():
    predicted = {ratio.numerator: ratio for ratio in ratios()}
    for ratio in predicted.values():
        over, under = PUBLISHED[ratio.numerator], PUBLISHED[ratio.denominator]
        measured = over.value / under.value
        assert f"| {over.description}, over {under.description} | {measured:.2f} | {ratio.archard:.2f} |" in PAGE
    assert predicted["clarke-28"].archard < 1.39 < predicted["clarke-28"].area
    assert predicted["clarke-28"].archard == pytest.approx(1.24, abs=5e-3)
    assert predicted["clarke-28"].area == pytest.approx(1.56, abs=5e-3)


def test_page_has_every_input_and_every_source():
    assert all(text in PAGE for text in INPUTS)
    assert all(row.source in PAGE or "Saikko" in row.source for row in PUBLISHED.values())


def test_published_numbers_are_written_with_their_half_width():
    assert str(PUBLISHED["ali-45"]) == "12.8 ± 3.8"
    assert str(PUBLISHED["clarke-22"]) == "23"


def test_hip_has_the_stated_head_liner_and_tilt():
    hip = make_hip(36.0, iso_14242_1(), 50.0)
    assert (hip.joint.ball_radius, hip.joint.liner_thickness) == (18.0, 6.0)
    assert math.degrees(hip.cup.inclination) == pytest.approx(50.0)
    assert hip.wear.coefficient == pytest.approx(1.066e-6)


@pytest.mark.long
@pytest.mark.parametrize(("predictions", "count", "tolerance"), [(simulators, 16, 0.15), (patients, 4, 0.4)])
def test_page_has_the_bands_of_the_laws(predictions, count, tolerance):
    for band in predictions(count):
        middle, interval = row_of(band.name).split("|")[3:5]
        low, high = map(float, interval.split(" to "))
        assert low < float(middle) < high
        assert band.median == pytest.approx(float(middle), rel=tolerance)
        assert low * 0.9 <= band.low < band.high <= high * 1.1
