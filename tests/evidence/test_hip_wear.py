"""Wear that was published beside what the laws say of it: the page has what they give, and every source."""

import pytest

from ballsocket.evidence.hip_wear import INPUTS, patients, ratios, simulators
from ballsocket.evidence.published_wear import PUBLISHED

from ..places import ROOT

PAGE = (ROOT / "docs" / "explanation" / "hip_validation.md").read_text(encoding="utf-8")


def row_of(name):
    told = PUBLISHED[name]
    found = [line for line in PAGE.splitlines() if line.startswith(f"| {told.what} |") and told.source in line]
    return next(line for line in found if f"| {told.value:g} " in line)


def test_the_page_has_the_ratios_that_the_laws_give():
    found = {each.one: each for each in ratios()}
    for each in found.values():
        one, other = PUBLISHED[each.one], PUBLISHED[each.other]
        told = f"| {one.what}, over {other.what} | {one.value / other.value:.2f} | {each.archard:.2f} |"
        assert told in PAGE
    assert found["clarke-28"].archard < 1.39 < found["clarke-28"].area
    assert found["clarke-28"].archard == pytest.approx(1.24, abs=5e-3)
    assert found["clarke-28"].area == pytest.approx(1.56, abs=5e-3)


def test_every_number_and_every_input_stands_on_the_page_with_its_source():
    assert all(each in PAGE for each in INPUTS)
    assert all(each.source in PAGE or "Saikko" in each.source for each in PUBLISHED.values())


@pytest.mark.long
@pytest.mark.parametrize(("predictions", "few", "off"), [(simulators, 16, 0.15), (patients, 4, 0.4)])
def test_the_page_has_the_bands_that_the_laws_give(predictions, few, off):
    for each in predictions(few):
        middle, band = row_of(each.name).split("|")[3:5]
        low, high = map(float, band.split(" to "))
        assert low < float(middle) < high
        assert each.median == pytest.approx(float(middle), rel=off)
        assert low * 0.9 <= each.low < each.high <= high * 1.1
