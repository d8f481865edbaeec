"""Uncertainty of a wear prediction: bands, Sobol indices, shared coefficients, and the table of a file."""

import re
from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import iso_14242_1, population, uncertainty
from ballsocket.hip.bands import Bands, SharedCoefficient
from ballsocket.hip.config import read_hip
from ballsocket.hip.variability import RESULT_UNITS, CohortResult
from ballsocket.hip.wear_uncertainty import share_coefficient
from ballsocket.reports.hip_plots import penetration_curve
from ballsocket.studies import LogNormal, Normal, Rectangular

from .hips import SHORT, TEXT, UNCERTAINTY, K, hip, history, refuses, write_edited_file
from .test_variability import COEFFICIENT, FEW_CYCLES, TIGHT, WEIGHT, variability

FULL = {"cycle": iso_14242_1(64), "ring_width": radians(4.0)}


def short_file(path, *changes, extra=UNCERTAINTY):
    return write_edited_file(path, *SHORT, *changes, text=TEXT + extra)


def few_cycles(one):
    return history(one.use, FEW_CYCLES)


def test_the_volume_has_the_distribution_of_the_coefficient():
    one = variability(coefficient=COEFFICIENT)
    bands = uncertainty(one, few_cycles(one), count=32)
    low, high = bands.band("volume")
    assert high[-1] / low[-1] == pytest.approx(1.5 ** (2 * 1.96), rel=0.1)
    assert bands.quantile("volume", 0.5)[-1] == pytest.approx(few_cycles(one).last.volume, rel=0.03)
    assert bands.n_patients == 64


def test_indices_are_the_fractions_of_the_variance():
    rates = Normal(mean=1.5e6, deviation=0.2 * 1.5e6)
    two = variability(coefficient=Normal(mean=K, deviation=0.1 * K), cycles_per_year=rates)
    bands = uncertainty(two, few_cycles(two), count=32)
    for order in ("first_order", "total_order"):
        assert bands.indices[order][0] == pytest.approx([0.2, 0.8], abs=0.05)  # squares of the deviations
        assert bands.indices[order].shape == (3, 2)


def test_the_same_seed_gives_the_same_bands_and_progress_counts_the_patients_of_all_sample_sets():
    one, finished = variability(clearance=TIGHT, body_weight=WEIGHT), []
    full = history(one.use, 2 * FEW_CYCLES, FEW_CYCLES)
    bands = uncertainty(one, full, count=3, seed=1, progress=finished.append)
    assert (finished[0], finished[-1]) == (0, 3 * (2 + 2))
    assert finished == sorted(finished)
    assert bands.counts == (FEW_CYCLES, 2 * FEW_CYCLES)
    assert bands.cohort.table.shape == (6, 2, 6)
    again, other = (uncertainty(one, full, count=3, seed=seed).cohort.table for seed in (1, 2))
    assert (bands.cohort.table == again).all()
    assert (bands.cohort.table != other).any()


def test_the_coarse_simulation_differs_little_from_the_full_one():
    one = variability(hip(**FULL), clearance=TIGHT)
    full = history(one.use, 2e6, 1e6)
    errors = uncertainty(one, full, count=2).quick_run_errors
    assert set(errors) == {"volume", "depth", "penetration"}
    assert 0 < max(errors.values()) < 5e-3
    coarse = one.patient({}).simulate([1e6, 2e6])
    expected = max(abs(c.volume / r.volume - 1) for c, r in zip(coarse, full.reports, strict=True))
    assert errors["volume"] == pytest.approx(expected, rel=1e-9)
    cohort = population(one, [2e6, 1e6], patients=1)[1]
    assert cohort.counts == (1e6, 2e6)
    assert cohort.quick_run_errors == pytest.approx(errors, rel=1e-6)


def test_bands_for_one_coefficient_are_those_of_patients_with_it_and_need_results_and_wear():
    weights, rates = Normal(mean=800.0, deviation=130.0), LogNormal(median=1e6, factor=1.5)
    fits = Rectangular(low=0.08, high=0.12)
    one = variability(coefficient=COEFFICIENT, body_weight=weights, cycles_per_year=rates, clearance=fits)
    cohort_run, bands = population(one, [1e5, 5e5], patients=8)
    for name, coefficient in bands.shared.values.items():
        values = {**cohort_run.values, "coefficient": np.full(8, coefficient)}
        direct = replace(cohort_run, values=values).simulate().table[:, :, :3]
        result = bands.shared.results[name]
        assert result[:, :, 0] == pytest.approx(direct[:, :, 0], rel=0.02)  # volume
        assert result == pytest.approx(direct, rel=0.15)
        expected = np.quantile(direct[:, :, 0], [0.025, 0.975], axis=0)
        assert np.array(bands.population_band("volume", name)) == pytest.approx(expected, rel=0.01)
    low, median, high = (bands.shared.values[name] for name in ("low", "median", "high"))
    assert (high / median, median / low) == pytest.approx((1.5**1.96, 1.5**1.96), rel=1e-3)
    two, alone = variability(coefficient=COEFFICIENT, clearance=TIGHT), variability(coefficient=COEFFICIENT)
    sampled = {"coefficient": np.array([K, 2 * K]), "clearance": np.array([0.1, 0.1])}
    unworn, ones = {**sampled, "coefficient": np.array([0.0, K])}, np.ones((2, 1, 6))
    for one, values, table in ((two, sampled, np.nan * ones), (two, unworn, ones), (alone, sampled, ones)):
        assert share_coefficient(one, (FEW_CYCLES,), values, table, 0.95, bs.core.executors.Serial()) is None


def test_the_band_of_the_patients_is_narrower_than_that_of_the_predictions():
    """Also in a figure."""
    one = variability(coefficient=COEFFICIENT, body_weight=Normal(mean=800.0, deviation=80.0))
    bands = uncertainty(one, few_cycles(one), count=8)
    low, high = bands.population_band("volume")
    lowest, highest = bands.band("volume")
    assert lowest[-1] < low[-1] < high[-1] < highest[-1]
    assert high[-1] / low[-1] == pytest.approx(1.1 ** (2 * 1.96), rel=0.15)
    collections = penetration_curve(few_cycles(one), bands).axes[0].collections
    tops = [collection.get_paths()[0].get_extents().y1 for collection in collections[:2]]
    expected = [band("penetration")[1][-1] for band in (bands.band, bands.population_band)]
    assert tops == pytest.approx(expected)


# the table [uncertainty]


def test_the_command_computes_bands_and_indices(solved_file):
    folder, answer = solved_file
    assert [band["cycles"] for band in answer["bands"]] == [5e3, 1e4]
    for name in ("volume", "depth", "penetration"):
        band = answer["bands"][-1][name]
        assert 0 < band["low"] < band["median"] < band["high"]
        assert set(answer["sobol"][name]) == {"coefficient", "clearance"}
    assert answer["uncertainty"]["patients"] == 4
    assert answer["valid"] is True
    assert answer["uncertainty"]["scatter"]["coefficient"]["factor"] == 1.5
    titles = re.findall("<h2 id='(\\w+)'>", (folder / "hip.html").read_text(encoding="utf-8"))
    assert titles.count("penetration") == 1
    assert {"bands", "sobol", "matters"} < set(titles)


@pytest.mark.parametrize(("text", "count"), [("", 64), ("count = 100\nseed = 0\n", 100)])
def test_count_and_seed_have_defaults(tmp_path, text, count):
    settings = read_hip(short_file(tmp_path, extra=UNCERTAINTY + text)).uncertain
    assert (settings.count, settings.seed) == (count, 0)


def test_the_nominal_patient_has_the_weight_and_the_years_of_the_file(tmp_path):
    start, rest = TEXT.split("[cycle]")
    walks = '[[activity]]\nname = "walking"\nper_year = 1e6\n\n[wear]' + rest.split("[wear]")[1]
    years = ("cycles = 5e6\nreport_at = [1e6, 2e6, 5e6]", 'years = 2\nreport_years = [1]\nbody_weight = "900 N"')
    text = f"{start}{walks}\n[uncertainty]\nbody_weight = {{ mean = 800, deviation = 100 }}\n"
    one = read_hip(write_edited_file(tmp_path, years, text=text)).uncertain.variability
    assert (one.cycles_per_year, one.body_weight) == (1e6, 900.0)
    peaks = [use.cycle.largest_force for use in (one.patient({"body_weight": 990.0}).use, one.coarse_simulation)]
    assert peaks[0] == pytest.approx(1.1 * peaks[1])
    two = text.replace("per_year = 1e6", 'per_year = 1e6\nbody_weight = "800 N"')
    with pytest.raises(ValueError, match="body_weight has several values, but patients need one"):
        read_hip(write_edited_file(tmp_path, years, text=two))


# bands of results that are known exactly

COUNTS = (1e6, 2e6)
COLUMNS = list(RESULT_UNITS)


def cohort(patients=101):
    """Return results whose column c is number + 1000 c at the first report, and twice that at the second."""
    first = np.arange(patients)[:, None] + 1000.0 * np.arange(len(COLUMNS))
    contact = np.stack([np.full((patients, 3), 0.5), np.ones((patients, 3)), np.zeros((patients, 3))], axis=-1)
    table, refused = np.stack([first, 2 * first], axis=1), np.full(patients, "", dtype="U60")
    return CohortResult(table=table, refused=refused, contact=contact)


def bands(result=None, use=None, level=0.9, **fields):
    distributions = fields.pop("distributions", {"clearance": TIGHT})
    one = variability(use, **distributions)
    return Bands(variability=one, counts=COUNTS, cohort=result or cohort(), level=level, **fields)


def shared():
    factors = {"low": 1, "median": 2, "high": 4}
    results = {name: factor * cohort().table[:, :, :3] for name, factor in factors.items()}
    return SharedCoefficient(values={name: factor * 1e-7 for name, factor in factors.items()}, results=results)


def test_a_band_has_its_level_between_equal_tails_also_for_one_coefficient():
    low, high = bands().band("volume")
    np.testing.assert_allclose(low, [5.0, 10.0])
    np.testing.assert_allclose(high, [95.0, 190.0])
    low, high = bands(level=0.5).band("depth")
    np.testing.assert_allclose(low, [1025.0, 2050.0])
    np.testing.assert_allclose(high, [1075.0, 2150.0])
    np.testing.assert_allclose(bands().quantile("penetration", 0.3), [2030.0, 4060.0])
    some = bands(shared=shared())
    for name, factor in (("low", 1.0), ("median", 2.0), ("high", 4.0)):
        low, high = some.population_band("volume", name)
        np.testing.assert_allclose(low, factor * np.array([5.0, 10.0]))
        np.testing.assert_allclose(high, factor * np.array([95.0, 190.0]))
    np.testing.assert_allclose(some.population_band("depth")[0], [2 * 1005.0, 2 * 2010.0])
    np.testing.assert_allclose(some.shared.quantile("low", "penetration", 0.5), [2050.0, 4100.0])
    refuses("coefficient = 'middle' is not allowed: low, median, high", some.population_band, "volume", "middle")
    with pytest.raises(ValueError, match="'edge_distance' has no band for one coefficient: volume, depth, penetr"):
        some.population_band("edge_distance")
    refuses("with coefficient and another quantity", bands().population_band, "volume")


def test_patients_without_a_result_are_left_out():
    result = cohort(5)
    table, refused = result.table.copy(), result.refused.copy()
    table[[0, 2, 4]] = np.nan
    refused[[0, 2, 4]] = "worn through: 9 mm", "dislocated: by 8 degrees", "dislocated: by 3 degrees"
    some = bands(replace(result, table=table, refused=refused))
    assert (some.n_patients, some.n_failed) == (5, 3)
    np.testing.assert_allclose(some.quantile("volume", 0.5), [2.0, 4.0])
    assert "3 of 5 samples have no result, most often: dislocated; the bands are for the others" in some.notes
    assert some.edge_loading(0) == 0.0
    assert some.valid is True
    none = bands(replace(result, table=np.full_like(table, np.nan), refused=np.full(5, "x")))
    assert none.n_failed == 5
    for unknown in (none.quantile("volume", 0.5), none.edge_loading(0), none.valid_fraction(0)):
        assert np.isnan(unknown).all()
    assert none.valid is False
    assert none.summary()["bands"][0]["volume"] == {"low": None, "median": None, "high": None}


def changed(result, name, index, values):
    """Return a result with other values in one array."""
    array = getattr(result, name).copy()
    array[index] = values
    return replace(result, **{name: array})


def test_edge_loading_is_a_fraction_of_patients_and_their_validity_that_since_the_first_cycle():
    result = cohort(4)
    result = changed(result, "table", np.s_[:, 1, COLUMNS.index("edge_distance")], [0.0, 0.0, 0.1, 0.0])
    assert [report["edge_loading"] for report in bands(result).summary()["bands"]] == [0.0, 0.75]
    result = changed(result, "contact", np.s_[1, 2, 2], 1.0)  # the others are worn to the rim
    assert [report["edge_loaded"] for report in bands(result).summary()["bands"]] == [0.0, 0.25]
    result = cohort(4)
    result = changed(
        result, "contact", np.s_[:, :, 0], [[0.1, 0.2, 0.3], [0.9, 0.2, 0.3], [0.1, 0.5, 0.3], [0.1, 0.2, 0.3]]
    )
    result = changed(result, "contact", np.s_[:, :, 1], [[1, 1, 1], [0, 1, 1], [1, 1, 0], [1, 1, 1]])
    np.testing.assert_array_equal(result.peak_utilisation, [[0.2, 0.3], [0.9, 0.9], [0.5, 0.5], [0.2, 0.3]])
    np.testing.assert_array_equal(result.valid, [[1, 1], [0, 0], [1, 0], [1, 1]])
    some = bands(result)
    np.testing.assert_allclose([some.utilisation_quantile(level) for level in (0.0, 1.0)], [[0.2, 0.3], [0.9, 0.9]])
    assert any(note.startswith("2 of 4 samples have contacts outside the validity") for note in some.notes)
    assert [report["valid"] for report in some.summary()["bands"]] == [0.75, 0.5]
    assert some.valid is False
    assert some.summary()["bands"][0]["peak_utilisation"]["high"] == pytest.approx(0.84)
    result = changed(result, "contact", np.s_[3, 1, 0], np.nan)  # an unknown utilisation is left out
    np.testing.assert_allclose(bands(result).utilisation_quantile(0.0), [0.2, 0.3])
    result = changed(result, "contact", np.s_[:, :, 0], np.nan)
    assert np.isnan(bands(result).utilisation_quantile(0.5)).all()


def test_notes_state_assumptions_and_limits_and_members_are_predictions_with_an_unknown_coefficient():
    result = cohort(3)
    result = changed(result, "table", np.s_[:, -1, COLUMNS.index("depth")], [7.9, 8.0, 8.1])  # mm; the liner has 8
    notes = bands(result, distributions={"clearance": TIGHT, "body_weight": WEIGHT}).notes
    assumed = "assumed: given and independent distributions of clearance, body_weight"
    assert notes == (assumed, "1 of 3 patients wear their liner through")
    assert "patients wear" not in " ".join(bands(cohort(1), hip(liner=1e6, clearance=0.3)).notes)
    note = bands(distributions={"coefficient": LogNormal(median=1e-6, factor=2.0)}, level=0.95).notes[1]
    unknown = "the wear coefficient is unknown, but the same for all samples: "
    assert note == f"{unknown}95 % between 2.57e-07 mm³/(N m) and 3.89e-06 mm³/(N m)"
    assert set(bands().nominal_notes) >= set(hip().notes)
    assert any("nominal sample, in the first cycle" in note for note in bands(use=hip(liner=1.2)).nominal_notes)
    assert bands().subject == "samples"  # of a simulator
    assert bands(members="patients").subject == "patients"
    assert bands(distributions={"body_weight": WEIGHT}).subject == "patients"
    assert bands(distributions={"coefficient": COEFFICIENT}).subject == "predictions"


def test_the_summary_has_bands_indices_and_distributions_with_angles_in_degrees():
    distributions = {"tilt": Rectangular(low=0.0, high=np.pi / 4), "cycles_per_year": LogNormal(median=5e5, factor=2.0)}
    indices = {"first_order": np.array([[0.1, 0.9], [0.2, 0.8], [0.3, np.nan]])}
    words = {"seed": 7, "quick_run_errors": {"volume": 0.01}, "shared": shared(), "indices": indices}
    summary = bands(distributions=distributions, **words).summary()
    first, second = summary["bands"]
    assert (first["cycles"], second["cycles"]) == COUNTS
    assert (first["years"], second["years"]) == pytest.approx((2.0, 4.0))
    assert [first["depth"][name] for name in ("low", "median", "high")] == pytest.approx([1005.0, 1050.0, 1095.0])
    assert second["volume"]["given_coefficient"]["high"] == pytest.approx({"low": 40.0, "median": 400.0, "high": 760.0})
    assert "given_coefficient" not in first["max_pressure"]
    assert summary["sobol"]["volume"] == {"tilt": {"first_order": 0.1}, "cycles_per_year": {"first_order": 0.9}}
    assert summary["sobol"]["penetration"]["cycles_per_year"] == {"first_order": None}
    stated = summary["uncertainty"]
    assert stated["scatter"]["tilt"] == {"distribution": "Rectangular", "low": 0.0, "high": pytest.approx(45.0)}
    assert stated["scatter"]["cycles_per_year"] == {"distribution": "LogNormal", "median": 5e5, "factor": 2.0}
    assert stated["coefficient"] == {"low": 1e-7, "median": 2e-7, "high": 4e-7}
    assert stated["quick_run_off"] == {"volume": 0.01}
    counts = {name: stated[name] for name in ("patients", "without_answer", "seed", "level")}
    assert counts == {"patients": 101, "without_answer": 0, "seed": 7, "level": 0.9}
    plain = bands().summary()
    assert "years" not in plain["bands"][0]
    assert plain["sobol"] is plain["uncertainty"]["coefficient"] is None
