"""Published wear and friction and their predictions: the page has the computed numbers, and every source."""

from runpy import run_path
from types import SimpleNamespace

import numpy as np
import pytest

from ballsocket.evidence import hip_wear
from ballsocket.evidence.hip_wear import INPUTS, PUBLISHED, make_hip, patients, ratios, simulators
from ballsocket.hip.simulator_cycles import iso_14242_1
from ballsocket.hip.variability import RESULT_COLUMNS, RESULT_UNITS

from ..extent import some
from ..places import ROOT
from ..printed import with_numbers_of

validation = SimpleNamespace(**run_path(str(ROOT / "docs" / "make_hip_validation.py"), run_name="make_hip_validation"))
PAGE = validation.PAGE.read_text(encoding="utf-8")


def row_of(name):
    row = PUBLISHED[name]
    lines = [line for line in PAGE.splitlines() if line.startswith(f"| {row.description} |") and row.source in line]
    return next(line for line in lines if f"| {row.value:g} " in line)


def test_page_has_the_ratios_of_the_laws():
    predicted = {ratio.numerator: ratio for ratio in ratios()}
    for ratio in predicted.values():
        over, under = PUBLISHED[ratio.numerator], PUBLISHED[ratio.denominator]
        row = f"| {over.description}, over {under.description} | {over.value / under.value:.2f} | {ratio.archard:.2f} |"
        assert any(with_numbers_of(line[: len(row)], row) == line[: len(row)] for line in PAGE.splitlines())
    assert predicted["clarke-28"].archard == pytest.approx(1.24, abs=5e-3)
    assert predicted["clarke-28"].area == pytest.approx(1.56, abs=5e-3)


def test_page_has_every_input_and_every_published_number():
    assert all(text in PAGE for text in INPUTS)
    for row in PUBLISHED.values():
        assert row.value > 0
        assert (row.half_width > 0) == bool(row.spread)
        assert "Saikko" in row.source or (row.source in PAGE and row.description in PAGE)
    assert {row.read for row in PUBLISHED.values()} == {"abstract", "second hand"}
    assert (str(PUBLISHED["ali-45"]), str(PUBLISHED["clarke-22"])) == ("12.8 ± 3.8", "23")


def test_hips_have_the_stated_joints_and_tilt():
    hip = make_hip(32.0, iso_14242_1())
    assert (hip.joint.ball_radius, hip.joint.liner_thickness, hip.joint.clearance) == (16.0, 7.0, 0.1)
    assert (hip.joint.liner.young, hip.joint.liner.poisson) == (1000.0, 0.4)
    assert (hip.wear.coefficient, np.degrees(hip.cup.inclination)) == pytest.approx((1.066e-6, 30.0))


@pytest.mark.long
@pytest.mark.parametrize(("predictions", "count", "tolerance"), [(simulators, 16, 0.15), (patients, 4, 0.4)])
def test_page_has_the_bands_of_the_laws(predictions, count, tolerance):
    for band in predictions(count):
        middle, interval = row_of(band.name).split("|")[3:5]
        low, high = map(float, interval.split(" to "))
        assert low < float(middle) < high
        assert band.median == pytest.approx(float(middle), rel=tolerance)
        assert low * 0.9 <= band.low < band.high <= high * 1.1


@pytest.fixture
def simulated(monkeypatch):
    """Replace the simulation of patients by a table of known numbers; return the arguments of its calls."""
    calls = []

    def population(variability, counts, patients):
        calls.append(SimpleNamespace(hip=variability.use, spreads=variability.distributions, counts=counts, n=patients))
        table = np.zeros((101, len(counts), len(RESULT_UNITS)))
        ranks = np.arange(101.0)
        for name, slope in (("volume", 2.0), ("penetration", 3.0)):
            growth = np.array([1.0, 3.0, 7.0, 19.0][: len(counts)])
            table[:, :, RESULT_COLUMNS[name]] = slope * ranks[:, None] * growth
        return None, SimpleNamespace(cohort=SimpleNamespace(table=table))

    monkeypatch.setattr(hip_wear, "population", population)
    return calls


def test_rates_are_volumes_from_one_to_three_million_cycles_and_penetrations_a_year(simulated):
    bands = {band.name: band for band in simulators(5)}
    assert list(bands) == ["clarke-22", "clarke-28", "ali-45", "ali-65", "ali-45-off", "ali-65-off"]
    for band in bands.values():
        assert (band.low, band.median, band.high) == pytest.approx((5.0, 100.0, 195.0))
    assert np.degrees([call.hip.cup.inclination for call in simulated]) == pytest.approx([0, 0, 30, 50, 30, 50])
    medians = {band.name: band.median for band in patients(7)}
    first = ("rsa-bedding", "rsa-bedding-linked", "mccalden-linked")
    later = ("rsa-rate", "rsa-rate-linked", "teeter", "callary", "lachiewicz")
    expected = dict.fromkeys(first, 150.0) | {"lachiewicz-volume": 100.0 * 7 / 5}
    assert medians == pytest.approx(expected | dict.fromkeys(later, 150.0 * 18 / 9.75))
    assert [(call.counts, call.n) for call in simulated[6:]] == [([3.75e5, 1.5e6, 7.5e6, 1.5e7], 7)] * 2
    for call in simulated:
        coefficient = call.spreads["coefficient"]
        assert (coefficient.median, coefficient.factor) == (call.hip.wear.coefficient, 1.5)


def page_column(label):
    part = PAGE.split("% friction begin")[1].split("% friction end")[0]
    head, _, *rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in part.strip().splitlines()]
    return [row[head.index(label)] for row in rows]


@pytest.mark.long
@pytest.mark.parametrize("label", some(list(validation.LUBRICANTS)[::-1], 1))
def test_page_has_the_computed_friction(label):
    column, computed = page_column(label), validation.friction_column(label)
    assert [with_numbers_of(*texts) for texts in zip(column, computed, strict=True)] == column


def test_page_says_which_measurements_of_friction_are_missed():
    """The rise of the coefficient to toe-off and the mean power are too small, with every lubricant."""
    numbers = [[float(text.split()[0]) for text in page_column(label)] for label in validation.LUBRICANTS]
    measured = [float(text.split()[0]) for text in page_column("measured")]
    for _, moment, toe_off, _, swing, power in numbers:
        assert moment < measured[1]
        assert swing / toe_off < 0.6 * measured[4] / measured[2]
        assert power < measured[5]
