"""Uncertainty of a wear prediction: bands, Sobol indices, shared coefficients, and the table of a file."""

import re
from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import iso_14242_1, population, uncertainty
from ballsocket.hip.config import read_hip
from ballsocket.hip.uncertainty import share_coefficient
from ballsocket.reports.hip_plots import penetration_curve
from ballsocket.reports.hip_tables import print_bands
from ballsocket.studies import LogNormal, Normal, Rectangular

from ..extent import either
from .hips import SHORT, TEXT, UNCERTAINTY, K, hip, history, write_edited_file
from .test_variability import COEFFICIENT, FEW_CYCLES, TIGHT, WEIGHT, variability

FULL = {"cycle": iso_14242_1(64), "ring_width": radians(4.0)}
LIGHT = Normal(mean=800.0, deviation=80.0)


def short_file(path, *changes, extra=UNCERTAINTY):
    """Write the example of a hip in use with few cycles and more text."""
    return write_edited_file(path, *SHORT, *changes, text=TEXT + extra)


def few_cycles(one):
    return history(one.use, FEW_CYCLES)


def four_patients(**distributions):
    return population(variability(**distributions), [FEW_CYCLES], patients=4)[1]


# bands and indices


def test_the_volume_has_the_distribution_of_the_coefficient():
    one = variability(coefficient=COEFFICIENT)
    bands = uncertainty(one, few_cycles(one), count=32)
    low, high = bands.band("volume")
    assert high[-1] / low[-1] == pytest.approx(1.5 ** (2 * 1.96), rel=0.1)
    assert bands.quantile("volume", 0.5)[-1] == pytest.approx(few_cycles(one).last.volume, rel=0.03)
    assert bands.n_patients == 64


def test_indices_are_the_fractions_of_the_variance():
    two = variability(
        coefficient=Normal(mean=K, deviation=0.1 * K), cycles_per_year=Normal(mean=1.5e6, deviation=0.2 * 1.5e6)
    )
    for count in either(quick=(32,), long=(32, 100)):
        bands = uncertainty(two, few_cycles(two), count=count)
        for order in ("first_order", "total_order"):
            assert bands.indices[order][0] == pytest.approx([0.2, 0.8], abs=0.05)  # squares of the deviations
            assert bands.indices[order].shape == (3, 2)


def test_the_same_seed_gives_the_same_bands():
    one = variability(clearance=TIGHT, body_weight=WEIGHT)
    first, again, other = (uncertainty(one, few_cycles(one), count=4, seed=seed).cohort.table for seed in (1, 1, 2))
    assert (first == again).all()
    assert (first != other).any()


def test_progress_counts_the_patients_of_all_sample_sets():
    one, finished = variability(clearance=TIGHT, body_weight=WEIGHT), []
    bands = uncertainty(one, history(one.use, 2 * FEW_CYCLES, FEW_CYCLES), count=3, progress=finished.append)
    assert finished[0] == 0
    assert finished[-1] == 3 * (2 + 2)
    assert finished == sorted(finished)
    assert bands.counts == (FEW_CYCLES, 2 * FEW_CYCLES)
    assert bands.cohort.table.shape == (6, 2, 6)


def test_the_coarse_simulation_differs_little_from_the_full_one():
    one = variability(hip(**FULL), clearance=TIGHT)
    full = history(one.use, 2e6, 1e6)
    errors = uncertainty(one, full, count=2).quick_run_errors
    assert set(errors) == {"volume", "depth", "penetration"}
    assert 0 < max(errors.values()) < 5e-3
    coarse = one.patient({}).simulate([1e6, 2e6])
    expected = max(abs(c.volume / r.volume - 1) for c, r in zip(coarse, full.reports, strict=True))
    assert errors["volume"] == pytest.approx(expected, rel=1e-9)


def test_a_cohort_has_the_errors_of_the_coarse_simulation():
    one = variability(hip(**FULL), clearance=TIGHT)
    bands = population(one, [2e5, 1e5], patients=1)[1]
    assert bands.counts == (1e5, 2e5)
    full = history(one.use, 2e5, 1e5)
    assert bands.quick_run_errors == pytest.approx(uncertainty(one, full, count=2).quick_run_errors, rel=1e-6)


def test_dislocated_patients_are_counted_and_left_out():
    loose = variability(tilt=Rectangular(low=0.0, high=2.0))
    bands = uncertainty(loose, few_cycles(loose), count=8)
    assert 0 < bands.n_failed < bands.n_patients
    assert np.isfinite(bands.band("volume")).all()
    assert bands.indices is None
    assert bands.summary()["sobol"] is None
    assert any("samples have no result" in note for note in bands.notes)


# a shared coefficient


def test_bands_for_one_coefficient_are_those_of_patients_with_it():
    """Converted results are those of direct simulations with the shared coefficient."""
    one = variability(
        coefficient=COEFFICIENT,
        body_weight=Normal(mean=800.0, deviation=130.0),
        cycles_per_year=LogNormal(median=1e6, factor=1.5),
        clearance=Rectangular(low=0.08, high=0.12),
    )
    cohort_run, bands = population(one, [1e5, 5e5], patients=8)
    results = bands.shared.results
    for name, coefficient in bands.shared.values.items():
        values = {**cohort_run.values, "coefficient": np.full(8, coefficient)}
        direct = replace(cohort_run, values=values).simulate().table[:, :, :3]
        assert results[name][:, :, 0] == pytest.approx(direct[:, :, 0], rel=0.02)  # volume
        assert results[name] == pytest.approx(direct, rel=0.15)
        low, high = bands.population_band("volume", name)
        known_low, known_high = np.quantile(direct[:, :, 0], [0.025, 0.975], axis=0)
        assert low == pytest.approx(known_low, rel=0.01)
        assert high == pytest.approx(known_high, rel=0.01)
    assert bands.shared.values["high"] / bands.shared.values["median"] == pytest.approx(1.5**1.96, rel=1e-3)
    assert bands.shared.values["median"] / bands.shared.values["low"] == pytest.approx(1.5**1.96, rel=1e-3)


def test_there_is_no_shared_result_without_results_or_wear(monkeypatch):
    two = variability(coefficient=COEFFICIENT, clearance=TIGHT)
    sampled = {"coefficient": np.array([K, 2 * K]), "clearance": np.array([0.1, 0.1])}
    words = {"level": 0.95, "engine": bs.core.executors.Serial()}
    missing = np.full((2, 1, 6), np.nan)
    assert share_coefficient(two, (FEW_CYCLES,), sampled, missing, **words) is None
    unworn = {**sampled, "coefficient": np.array([0.0, K])}
    assert share_coefficient(two, (FEW_CYCLES,), unworn, np.ones((2, 1, 6)), **words) is None
    alone = variability(coefficient=COEFFICIENT)
    assert share_coefficient(alone, (FEW_CYCLES,), sampled, np.ones((2, 1, 6)), **words) is None


def test_the_band_of_the_patients_is_narrower_than_that_of_the_predictions():
    one = variability(coefficient=COEFFICIENT, body_weight=LIGHT)
    bands = uncertainty(one, few_cycles(one), count=8)
    low, high = bands.population_band("volume")
    lowest, highest = bands.band("volume")
    assert lowest[-1] < low[-1] < high[-1] < highest[-1]
    assert high[-1] / low[-1] == pytest.approx(1.1 ** (2 * 1.96), rel=0.15)
    volume = bands.summary()["bands"][-1]["volume"]
    assert list(volume) == ["low", "median", "high", "given_coefficient"]
    assert volume["given_coefficient"]["median"]["high"] == high[-1]
    assert bands.summary()["uncertainty"]["coefficient"] == bands.shared.values


def test_bands_without_an_unknown_coefficient_are_those_of_patients():
    assert four_patients(clearance=TIGHT).subject == "patients"
    assert four_patients(coefficient=COEFFICIENT).subject == "predictions"
    for bands in (four_patients(clearance=TIGHT), four_patients(coefficient=COEFFICIENT)):
        assert bands.shared is None
        assert "given_coefficient" not in bands.summary()["bands"][0]["volume"]


# output


def test_a_narrow_terminal_shows_every_number_of_the_bands(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    one = variability(coefficient=COEFFICIENT, body_weight=LIGHT)
    print_bands(uncertainty(one, few_cycles(one), count=8))
    printed = capsys.readouterr().out
    assert "coefficient" in printed
    assert "…" not in printed


def test_a_figure_has_the_bands_of_the_predictions_and_of_the_patients():
    one = variability(coefficient=COEFFICIENT, clearance=TIGHT)
    bands = uncertainty(one, few_cycles(one), count=2)
    collections = penetration_curve(few_cycles(one), bands).axes[0].collections
    tops = [collection.get_paths()[0].get_extents().y1 for collection in collections[:2]]
    assert tops[0] == pytest.approx(bands.band("penetration")[1][-1])
    assert tops[1] == pytest.approx(bands.population_band("penetration")[1][-1])


# the table [uncertainty]


def test_the_command_computes_bands_and_indices(solved_file):
    folder, answer = solved_file
    assert [band["cycles"] for band in answer["bands"]] == [5e3, 1e4]
    last = answer["bands"][-1]
    for name in ("volume", "depth", "penetration"):
        assert 0 < last[name]["low"] < last[name]["median"] < last[name]["high"]
        assert set(answer["sobol"][name]) == {"coefficient", "clearance"}
    assert answer["uncertainty"]["patients"] == 4
    assert answer["valid"] is True
    assert answer["uncertainty"]["scatter"]["coefficient"]["factor"] == 1.5
    titles = re.findall("<h2 id='(\\w+)'>", (folder / "hip.html").read_text(encoding="utf-8"))
    assert titles.count("penetration") == 1
    assert titles[-2:] == ["patients", "matters"]


def test_count_and_seed_have_defaults(tmp_path):
    settings = read_hip(short_file(tmp_path)).uncertain
    assert (settings.count, settings.seed) == (64, 0)
    settings = read_hip(short_file(tmp_path, extra=f"{UNCERTAINTY}count = 100\nseed = 0\n")).uncertain
    assert (settings.count, settings.seed) == (100, 0)


def test_the_nominal_patient_has_the_weight_and_the_years_of_the_file(tmp_path):
    start, rest = TEXT.split("[cycle]")
    walks = '[[activity]]\nname = "walking"\nper_year = 1e6\n\n[wear]' + rest.split("[wear]")[1]
    years = ("cycles = 5e6\nreport_at = [1e6, 2e6, 5e6]", 'years = 2\nreport_years = [1]\nbody_weight = "900 N"')
    text = f"{start}{walks}\n[uncertainty]\nbody_weight = {{ mean = 800, deviation = 100 }}\n"
    one = read_hip(write_edited_file(tmp_path, years, text=text)).uncertain.variability
    assert one.cycles_per_year == 1e6
    assert one.body_weight == 900.0
    assert one.patient({"body_weight": 990.0}).use.cycle.largest_force == pytest.approx(
        1.1 * one.coarse_simulation.cycle.largest_force
    )
    two = text.replace("per_year = 1e6", 'per_year = 1e6\nbody_weight = "800 N"')
    with pytest.raises(ValueError, match="body_weight has several values, but patients need one"):
        read_hip(write_edited_file(tmp_path, years, text=two))
