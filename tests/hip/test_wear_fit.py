"""Wear coefficient from measured wear: simulated data give it back, and each kind of rate gives another one."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

from ballsocket.files.columns import HeadChoice
from ballsocket.hip import Archard, FrictionEnergyWear, MeasuredWear, fit_wear_coefficient, logarithmic
from ballsocket.hip.config import read_wear_test
from ballsocket.hip.measured_wear import read_stations
from ballsocket.reports.hip_comparison import wear_fit_figure

from ..cli.command import answer, printed, refusal
from ..refusals import text_tables, unescaped
from .hips import COUNTS, QUICK, WEAR_DATA, hip, write_edited_file

REPORTS = [1e5, 2e5, 4e5]
TRUE = 8e-7


def simulated(quantity, **words):
    history = hip(wear=Archard(coefficient=TRUE), **QUICK, **words).after(REPORTS[-1], REPORTS)
    return np.array([getattr(report, quantity) for report in history.reports])


def test_a_rate_of_38_mm3_gives_three_coefficients():
    """Those of the new bore, of the second million and from 5 to 10 million cycles; 28 mm, clearance 0.1 mm."""
    use = hip(wear=Archard(coefficient=1e-6), **QUICK)
    rate = MeasuredWear(quantity="volume", values=38.0, rate="steady", begin=5e6, end=1e7, uncertainty=3.8)
    fit = fit_wear_coefficient(use, rate)
    assert fit.coefficient == pytest.approx(1.08e-6, rel=0.01)
    assert list(fit.readings.values()) == pytest.approx([1.08e-6, 1.26e-6, 1.13e-6], rel=0.01)
    assert (fit.low, fit.high) == pytest.approx((0.805 * fit.coefficient, 1.194 * fit.coefficient), rel=0.02)
    assert fit.notes[0].endswith("volume rate, steady from 5 to 10 million cycles")


@pytest.mark.parametrize(
    "quantity", ["volume", *(pytest.param(name, marks=pytest.mark.long) for name in ("depth", "penetration"))]
)
def test_simulated_totals_give_the_coefficient_back(quantity):
    words = {"creep": logarithmic()} if quantity == "penetration" else {}
    values = simulated(quantity, **words)
    measured = MeasuredWear(quantity=quantity, values=values, cycles=REPORTS, uncertainty=0.05 * values)
    fit = fit_wear_coefficient(hip(wear=Archard(coefficient=3e-6), **QUICK, **words), measured)
    assert fit.coefficient == pytest.approx(TRUE, rel=5e-3)
    assert fit.low < TRUE < fit.high
    assert fit.results[0] == pytest.approx(values, rel=5e-3)


def volume(values, **words):
    return MeasuredWear(quantity="volume", values=values, **words)


def test_several_kinds_of_data_and_another_law_are_fitted_together():
    volumes = simulated("volume")
    rate = 1e6 * (volumes[2] - volumes[1]) / 2e5
    data = [
        volume(1e6 * volumes[1] / 2e5, rate="mean", end=2e5, uncertainty=1.0),
        volume([rate, rate], rate="steady", begin=2e5, end=4e5, uncertainty=1.0),
        volume(volumes, cycles=REPORTS, uncertainty=0.1),
    ]
    fit = fit_wear_coefficient(hip(wear=FrictionEnergyWear(coefficient=2e-5, friction=0.05), **QUICK), data)
    assert fit.unit == "mm³/J"
    assert fit.coefficient * 0.05 == pytest.approx(TRUE, rel=5e-3)
    assert abs(fit.residuals).max() < 0.5
    assert len(wear_fit_figure(fit).axes) == 1


def test_scatter_makes_or_widens_the_band():
    values = simulated("volume")
    scattered, use = values * np.array([1.1, 0.9, 1.0]), hip(wear=Archard(coefficient=1e-6), **QUICK)
    unknown = fit_wear_coefficient(use, volume(scattered, cycles=REPORTS))
    assert unknown.noise_estimated
    assert unknown.uncertainty / unknown.results[0] == pytest.approx([0.1] * 3, rel=0.01)
    assert unknown.high / unknown.coefficient - 1 == pytest.approx(0.43, rel=0.05)  # t(2) is 4.3, of one reading
    assert any("one specimen, since no station is stated" in note for note in unknown.notes)
    widened = fit_wear_coefficient(use, volume(scattered, cycles=REPORTS, uncertainty=0.01 * values))
    assert widened.widening > 3
    assert any(note.startswith("the data scatter more than stated") for note in widened.notes)
    few = fit_wear_coefficient(use, volume(scattered, cycles=np.divide(REPORTS, 1e6)))
    assert [any("if these are millions" in note for note in fit.notes) for fit in (few, widened)] == [True, False]
    single = fit_wear_coefficient(use, volume(38.0, rate="initial"))
    assert np.isnan(single.low)
    assert any(note.startswith("no band") for note in single.notes)
    assert single.summary()["coefficient"]["low"] is None
    assert fit_wear_coefficient(use, volume(38.0, rate="initial", uncertainty=38.0)).low == 0.0


STATIONS = dict(zip("ABCD", (1.7e-7, 1.9e-7, 2.1e-7, 2.5e-7), strict=True))
MILLIONS = np.array([0.1, 0.2, 0.3, 0.4, 0.5])
CHANGES = (
    (COUNTS, ""),
    ("instants = 100", "instants = 16"),
    ('coefficient = "1.066e-6 mm^3/(N m)" # conventional UHMWPE', ""),
    ('contact = "springs"', f'ring_width = "8 deg"\n{WEAR_DATA}'),
)


def test_a_file_with_measured_wear_is_identified(tmp_path):
    file = str(write_edited_file(tmp_path, *CHANGES))
    text = printed("identify", file, "--figure", str(tmp_path / "fit.png"))
    assert "coefficient of the wear law 'archard'" in " ".join(text.split())
    assert (tmp_path / "fit.png").exists()
    value = answer("identify", file)["coefficient"]
    assert value["unit"] == "mm³/(N m)"
    assert (value["low"], value["high"]) == pytest.approx((0.8 * value["value"], 1.2 * value["value"]), rel=0.03)
    assert "needs coefficient" in refusal("hip", file)
    assert "--samples needs measurements of a contact" in refusal("identify", file, "--samples", "100")


def station_totals():
    """Return the totals in mm³ of each station, with its own wear factor."""
    use = hip(wear=Archard(coefficient=1e-6), **QUICK)
    ends = {name: [1e6 * count * k / 1e-6 for count in MILLIONS] for name, k in STATIONS.items()}
    reports = use.after(ends["D"][-1], sorted({end for counts in ends.values() for end in counts})).reports
    volumes = {report.cycles: report.volume for report in reports}
    return {name: [volumes[end] for end in counts] for name, counts in ends.items()}


def station_tables():
    """Return the files and [[data]] of the same four stations: wide in mg, long with decimal commas, in tables."""
    totals, cycles = station_totals(), (1e6 * MILLIONS).tolist()
    rows = zip(MILLIONS, *totals.values(), strict=True)
    wide = [f"{count}, {', '.join(str(0.94 * volume) for volume in volumes)}" for count, *volumes in rows]
    cells = [(name, volume, n) for name, vs in totals.items() for n, volume in zip(cycles, vs, strict=True)]
    long = [f"{name};{volume};{n};x".replace(".", ",") for name, volume, n in cells]
    texts = {name: str([f"{volume} mm^3" for volume in volumes]) for name, volumes in totals.items()}
    head, file = '[[data]]\nquantity = "volume"\n', 'file = "stations.csv"\n'
    mass = f'[[data]]\nquantity = "mass"\ndensity = "0.94 g/cm^3"\n{file}'
    joined = "".join(texts.values()).replace("][", ", ")
    return {
        "wide": (["cycles [Mc],A [mg],B [mg],C [mg],D [mg]", *wide], mass),
        "long": (["Station;volume;cycles;remark", *long], f'{head}{file}unit = "mm^3"\nskip = "remark"\n'),
        "tables": ([], "".join(f"{head}values = {text}\ncycles = {cycles}\n" for text in texts.values())),
        "unnamed": ([], f"{head}values = {joined}\ncycles = {cycles * 4}\n"),
    }


@pytest.mark.parametrize("form", ["wide", "long", "tables", "unnamed"])
def test_readings_of_one_station_are_one_specimen(tmp_path, form):
    """Mean and Student's band of four slopes, by hand: (1.7 + 1.9 + 2.1 + 2.5) / 4 = 2.05, ± 3.182 * 0.3416 / 2."""
    table, data = station_tables()[form]
    (tmp_path / "stations.csv").write_text("\n".join(table), encoding="utf-8")
    test = read_wear_test(write_edited_file(tmp_path, *CHANGES[:3], (CHANGES[3][0], f'ring_width = "8 deg"\n{data}')))
    fit = fit_wear_coefficient(hip(wear=Archard(coefficient=1e-6), **QUICK), test.data)
    assert list(fit.stations.values()) == pytest.approx(list(STATIONS.values()), rel=1e-3)
    assert (fit.coefficient, fit.low, fit.high) == pytest.approx((2.05e-7, 1.507e-7, 2.593e-7), rel=2e-3)
    assert fit.scatter == pytest.approx(0.3416 / 2.05, rel=5e-3)
    assert any("no station is stated" in note for note in fit.notes) == (form in ("tables", "unnamed"))
    assert test.data[0].measured_quantity == ("mass" if form == "wide" else "volume")


(STATION_FORMS,) = text_tables(Path(__file__).parent / "station_forms.txt")
"""Texts, their encoding, the choice of columns, and the number of lines that are left out."""


@pytest.mark.parametrize(("text", "encoding", "choice", "n_left_out"), STATION_FORMS, ids=range(len(STATION_FORMS)))
def test_tables_of_stations_are_read_as_laboratories_write_them(text, encoding, choice, n_left_out, tmp_path):
    (tmp_path / "stations.csv").write_bytes(unescaped(text).encode(encoding))
    read = read_stations(tmp_path / "stations.csv", "mass", None, HeadChoice(**json.loads(choice)))
    grams = {"g": 1e3, "mg": 1.0, "µg": 1e-3}
    found = {}
    for station, value, cycles in zip(read.stations, read.values, read.cycles, strict=True):
        number, unit = value.split()
        found.setdefault(station, []).append((cycles, pytest.approx(float(number) * grams[unit])))
    assert found == {"A": [(5e5, 1.25), (1e6, 2.5)], "B": [(5e5, 1.5)]}
    assert bool(read.remark) == (n_left_out != "0")
    assert sum(map(int, re.findall(r"(\d+) lines? ", read.remark))) == int(n_left_out)


def test_a_relative_uncertainty_is_a_share_of_the_fitted_value():
    """The mean of 15 % less and 15 % more is right; weights by the readings would give 4.4 % less."""
    use = hip(wear=Archard(coefficient=1e-6), **QUICK)
    readings = np.array([0.85, 1.15]) * use.first.volume
    one = volume(readings, rate="initial", relative_uncertainty=0.3, station="A")
    fit = fit_wear_coefficient(use, one)
    assert fit.coefficient == pytest.approx(1e-6, rel=1e-6)
    assert fit.high / fit.coefficient - 1 == pytest.approx(1.96 * 0.3 / 2**0.5, rel=1e-3)
    equal = fit_wear_coefficient(use, volume(readings[[0, 0]], rate="initial", station=["A", "B"]))
    assert any("their scatter gives no band; state uncertainty" in note for note in equal.notes)


@pytest.mark.long
@pytest.mark.parametrize("counts", [(5, 5, 5, 5), (1, 2, 3, 5, 8, 12)])
def test_bands_of_stations_cover_the_true_coefficient(counts):
    """Station scatter 15 %, readings 5 %: as many of 30 bands of 95 % hold as in 999 of 1000 trials."""
    use, noise, sets = hip(wear=Archard(coefficient=1e-6), **QUICK), np.random.default_rng(0), 30
    names = [str(station) for station, count in enumerate(counts) for _ in range(count)]
    covered = 0
    for _ in range(sets):
        rates = np.repeat(1 + 0.15 * noise.standard_normal(len(counts)), counts)
        rates *= use.first.volume * (1 + 0.05 * noise.standard_normal(len(rates)))
        fit = fit_wear_coefficient(use, volume(rates, rate="initial", station=names))
        covered += fit.low < 1e-6 < fit.high
    low, high = binom.interval(0.999, sets, 0.95)
    assert low <= covered <= high


def test_rates_per_year_and_uncertainties_have_units(tmp_path):
    changes = ("/Mc", "/year"), ('"10 %"', '"0.002 cm^3/year"'), ('name = "hip in use"', "cycles_per_year = 2e6")
    (measured,) = read_wear_test(write_edited_file(tmp_path, *CHANGES, *changes)).data
    assert measured.values == pytest.approx([19.0])
    assert measured.uncertainty == pytest.approx([1.0])
