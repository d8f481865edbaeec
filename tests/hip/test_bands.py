"""Bands of a patient cohort: quantiles, fractions, notes and summary, for results that are known exactly."""

from dataclasses import replace

import numpy as np
import pytest

from ballsocket.hip.bands import Bands, SharedCoefficient
from ballsocket.hip.uncertainty import _NominalResponse
from ballsocket.hip.variability import RESULT_UNITS, CohortResult
from ballsocket.studies import LogNormal, Rectangular

from .hips import K, hip
from .test_variability import COEFFICIENT, TIGHT, WEIGHT, variability

COUNTS = (1e6, 2e6)
COLUMNS = list(RESULT_UNITS)


def cohort(patients=101):
    """Return results whose column c is number + 1000 c at the first report, and twice that at the second."""
    first = np.arange(patients)[:, None] + 1000.0 * np.arange(len(COLUMNS))
    contact = np.stack([np.full((patients, 3), 0.5), np.ones((patients, 3)), np.zeros((patients, 3))], axis=-1)
    return CohortResult(
        table=np.stack([first, 2 * first], axis=1), refused=np.full(patients, "", dtype="U60"), contact=contact
    )


def bands(result=None, use=None, level=0.9, **fields):
    distributions = fields.pop("distributions", {"clearance": TIGHT})
    return Bands(
        variability=variability(use, **distributions), counts=COUNTS, cohort=result or cohort(), level=level, **fields
    )


def shared(patients=101):
    results = {
        name: factor * cohort(patients).table[:, :, :3] for name, factor in (("low", 1), ("median", 2), ("high", 4))
    }
    return SharedCoefficient(values={"low": 1e-7, "median": 2e-7, "high": 4e-7}, results=results)


def test_the_band_has_the_level_between_equal_tails():
    low, high = bands().band("volume")
    np.testing.assert_allclose(low, [5.0, 10.0])
    np.testing.assert_allclose(high, [95.0, 190.0])
    low, high = bands(level=0.5).band("depth")
    np.testing.assert_allclose(low, [1025.0, 2050.0])
    np.testing.assert_allclose(high, [1075.0, 2150.0])
    np.testing.assert_allclose(bands().quantile("penetration", 0.3), [2030.0, 4060.0])


def test_patients_without_a_result_are_left_out():
    result = cohort(5)
    table, refused = result.table.copy(), result.refused.copy()
    table[4], refused[4] = np.nan, "dislocated: by 3 degrees"
    table[2], refused[2] = np.nan, "dislocated: by 8 degrees"
    table[0], refused[0] = np.nan, "worn through: 9 mm"
    some = bands(replace(result, table=table, refused=refused))
    assert (some.n_patients, some.n_failed) == (5, 3)
    np.testing.assert_allclose(some.quantile("volume", 0.5), [2.0, 4.0])
    assert "3 of 5 samples have no result, most often: dislocated; the bands are for the others" in some.notes
    assert some.edge_loading(0) == 0.0
    assert some.valid is True
    none = bands(replace(result, table=np.full_like(table, np.nan), refused=np.full(5, "x")))
    assert none.n_failed == 5
    assert np.isnan(none.quantile("volume", 0.5)).all()
    assert np.isnan(none.edge_loading(0))
    assert np.isnan(none.valid_fraction(0))
    assert none.valid is False
    assert none.summary()["bands"][0]["volume"] == {"low": None, "median": None, "high": None}


def test_edge_loading_is_the_fraction_of_patients_whose_contact_reaches_the_edge():
    result = cohort(4)
    result.table[:, 1, COLUMNS.index("edge_distance")] = [0.0, 0.0, 0.1, 0.0]
    some = bands(result)
    assert some.edge_loading(1) == 0.75
    assert some.edge_loading(0) == 0.0
    assert [report["edge_loading"] for report in some.summary()["bands"]] == [0.0, 0.75]
    result.contact[1, 2, 2] = 1.0  # the others are worn to the rim
    assert [report["edge_loaded"] for report in bands(result).summary()["bands"]] == [0.0, 0.25]


def test_validity_and_utilisation_are_those_since_the_first_cycle():
    result = cohort(4)
    result.contact[:, :, 0] = [[0.1, 0.2, 0.3], [0.9, 0.2, 0.3], [0.1, 0.5, 0.3], [0.1, 0.2, 0.3]]
    result.contact[:, :, 1] = [[1, 1, 1], [0, 1, 1], [1, 1, 0], [1, 1, 1]]
    np.testing.assert_array_equal(result.peak_utilisation, [[0.2, 0.3], [0.9, 0.9], [0.5, 0.5], [0.2, 0.3]])
    np.testing.assert_array_equal(result.valid, [[1, 1], [0, 0], [1, 0], [1, 1]])
    some = bands(result)
    assert (some.valid_fraction(0), some.valid_fraction(1)) == (0.75, 0.5)
    assert some.valid is False
    np.testing.assert_allclose(some.utilisation_quantile(1.0), [0.9, 0.9])
    np.testing.assert_allclose(some.utilisation_quantile(0.0), [0.2, 0.3])
    assert any(note.startswith("2 of 4 samples have contacts outside the validity") for note in some.notes)
    assert some.summary()["bands"][1]["valid"] == 0.5
    assert some.summary()["bands"][0]["peak_utilisation"]["high"] == pytest.approx(0.84)
    result.contact[3, 1, 0] = np.nan  # an unknown utilisation is left out
    np.testing.assert_allclose(bands(result).utilisation_quantile(0.0), [0.2, 0.3])
    result.contact[:, :, 0] = np.nan
    assert np.isnan(bands(result).utilisation_quantile(0.5)).all()


def test_notes_state_assumptions_and_limits():
    result = cohort(3)
    result.table[:, -1, COLUMNS.index("depth")] = [7.9, 8.0, 8.1]  # mm; the liner has 8
    notes = bands(result, distributions={"clearance": TIGHT, "body_weight": WEIGHT}).notes
    assert notes == (
        "assumed: given and independent distributions of clearance, body_weight",
        "1 of 3 patients wear their liner through",
    )
    assert "patients wear" not in " ".join(bands(cohort(1), hip(liner=1e6, clearance=0.3)).notes)
    note = bands(distributions={"coefficient": LogNormal(median=1e-6, factor=2.0)}, level=0.95).notes[1]
    unknown = "the wear coefficient is unknown, but the same for all samples: "
    assert note == f"{unknown}95 % between 2.57e-07 and 3.89e-06 mm³/(N m)"
    assert set(bands().nominal_notes) >= set(hip().notes)
    assert any("nominal sample, in the first cycle" in note for note in bands(use=hip(liner=1.2)).nominal_notes)


def test_members_of_a_band_are_predictions_with_an_unknown_coefficient():
    assert bands().subject == "samples"  # of a simulator
    assert bands(members="patients").subject == "patients"
    assert bands(distributions={"body_weight": WEIGHT}).subject == "patients"
    assert bands(distributions={"coefficient": COEFFICIENT}).subject == "predictions"


def test_the_band_of_the_patients_is_that_of_one_coefficient():
    some = bands(shared=shared())
    for name, factor in (("low", 1.0), ("median", 2.0), ("high", 4.0)):
        low, high = some.population_band("volume", name)
        np.testing.assert_allclose(low, factor * np.array([5.0, 10.0]))
        np.testing.assert_allclose(high, factor * np.array([95.0, 190.0]))
    np.testing.assert_allclose(some.population_band("depth")[0], [2 * 1005.0, 2 * 2010.0])
    np.testing.assert_allclose(some.shared.quantile("low", "penetration", 0.5), [2050.0, 4100.0])
    with pytest.raises(ValueError, match="coefficient = 'middle' is not allowed: low, median, high"):
        some.population_band("volume", "middle")
    with pytest.raises(ValueError, match="'edge_distance' has no band for one coefficient: volume, depth, penetr"):
        some.population_band("edge_distance")
    with pytest.raises(ValueError, match="with coefficient and another quantity"):
        bands().population_band("volume")


def test_the_summary_has_the_bands_of_every_report():
    distributions = {"clearance": TIGHT, "cycles_per_year": LogNormal(median=5e5, factor=2.0)}
    summary = bands(distributions=distributions, seed=7, quick_run_errors={"volume": 0.01}, shared=shared()).summary()
    first, second = summary["bands"]
    assert (first["cycles"], second["cycles"]) == COUNTS
    assert (first["years"], second["years"]) == pytest.approx((2.0, 4.0))
    assert [first["depth"][name] for name in ("low", "median", "high")] == pytest.approx([1005.0, 1050.0, 1095.0])
    assert second["volume"]["given_coefficient"]["high"] == pytest.approx({"low": 40.0, "median": 400.0, "high": 760.0})
    assert "given_coefficient" not in first["max_pressure"]
    assert summary["sobol"] is None
    assert summary["uncertainty"]["coefficient"] == {"low": 1e-7, "median": 2e-7, "high": 4e-7}
    assert summary["uncertainty"]["quick_run_off"] == {"volume": 0.01}
    counts = {name: summary["uncertainty"][name] for name in ("patients", "without_answer", "seed", "level")}
    assert counts == {"patients": 101, "without_answer": 0, "seed": 7, "level": 0.9}
    plain = bands().summary()
    assert "years" not in plain["bands"][0]
    assert plain["uncertainty"]["coefficient"] is None


def test_the_summary_has_indices_and_distributions_with_angles_in_degrees():
    indices = {"first_order": np.array([[0.1, 0.9], [0.2, 0.8], [0.3, np.nan]])}
    distributions = {"body_weight": WEIGHT, "tilt": Rectangular(low=0.0, high=np.pi / 4)}
    summary = bands(distributions=distributions, indices=indices).summary()
    assert summary["sobol"]["volume"] == {"body_weight": {"first_order": 0.1}, "tilt": {"first_order": 0.9}}
    assert summary["sobol"]["penetration"]["tilt"] == {"first_order": None}
    scatter = summary["uncertainty"]["scatter"]
    assert scatter["tilt"] == {"distribution": "Rectangular", "low": 0.0, "high": pytest.approx(45.0)}
    assert scatter["body_weight"] == {"distribution": "Normal", "mean": 800.0, "deviation": 100.0}


def test_the_response_to_the_coefficient_follows_a_power_law_exactly():
    exposures = np.geomspace(1e-8, 1e-6, 5)
    table = np.stack([exposures**0.5, 3 * exposures], axis=-1)[:, None, :]
    response = _NominalResponse(exposures=exposures, table=table)
    points = np.array([1e-8, 3.3e-8, 7e-7])
    np.testing.assert_allclose(response.interpolate(points)[:, 0, 0], points**0.5, rtol=1e-12)
    np.testing.assert_allclose(response.interpolate(points)[:, 0, 1], 3 * points, rtol=1e-12)
    unworn = _NominalResponse(exposures=exposures, table=0 * table)
    assert np.isnan(unworn.interpolate(points)).all()
    assert K > 0
