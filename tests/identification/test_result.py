"""Notes, summary, curves and sensitivities of a result; candidates for the next measurement; synthetic data."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identification import Machine, Measured
from ballsocket.identification.bands import Trials, draw_data_sets, trials
from ballsocket.identification.experiment import Candidate, Experiment, Gain, experiment, standard_candidates
from ballsocket.identification.result import von_neumann_ratio
from ballsocket.reports.identify_results import corner_figure

from .rigid import JOINT, MODEL

FORCE = np.array([2000.0, 400.0, 3000.0, 1000.0, 2500.0, 1500.0])
CONTACT = MODEL.press(JOINT, force=FORCE)
FREE = {"clearance": (0.02, 0.4)}


def identified(*data, free=FREE, model=MODEL, **settings):
    return bs.identify(model, JOINT, data, free, **settings)


def measured(quantity="indentation", values=None, uncertainty=2e-4, **settings):
    values = getattr(CONTACT, quantity) if values is None else values
    return Measured(quantity=quantity, values=values, uncertainty=uncertainty, force=FORCE, **settings)


def test_the_curve_is_the_model_over_the_loads_of_the_data():
    result = identified(measured("area", uncertainty=4.0), measured())
    loads, depths = result.curve(1, 7)
    np.testing.assert_allclose(loads, np.linspace(400.0, 3000.0, 7))
    np.testing.assert_allclose(depths, MODEL.press(result.joint, force=loads).indentation, rtol=1e-12)
    np.testing.assert_allclose(result.curve(0, 3)[1], MODEL.press(result.joint, force=loads[[0, 3, 6]]).area)
    order = np.array([10.0, 1.0, 14.0, 4.0, 12.0, 7.0])
    result = identified(measured(values=CONTACT.indentation + 1e-3 * order, machine=Machine(drift=1e-3), order=order))
    loads, depths = result.curve(0, 2)
    expected = MODEL.press(result.joint, force=loads).indentation + 1e-3 * np.array([1.0, 14.0])
    np.testing.assert_allclose(depths, expected, rtol=1e-9)


def test_residuals_are_values_less_results_in_stated_uncertainties():
    noise = np.array([3.0, -2.0, 1.0, 2.0, -3.0, 1.0])
    result = identified(measured(values=CONTACT.indentation + 2e-4 * noise), measured("area", uncertainty=4.0))
    depth = MODEL.press(result.joint, force=FORCE).indentation
    np.testing.assert_allclose(result.residuals[0], (result.data[0].values - depth) / 2e-4, rtol=1e-9)
    total = np.sum(result.residuals[0] ** 2) + np.sum(result.residuals[1] ** 2)
    assert result.spread == pytest.approx(np.sqrt(total / 11))
    assert (result.freedom, [len(row) for row in result.results]) == (11, [6, 6])
    film = measured("max_pressure", np.minimum(CONTACT.max_pressure, 6.0), 0.1, saturation=6.0)
    shortfall = identified(measured(), film).residuals[1]  # of lower bounds
    assert shortfall[CONTACT.max_pressure > 6.5].max() == 0.0
    assert shortfall.min() >= -1e-6
    one = identified(Measured(quantity="diametral_clearance", values=0.2, uncertainty=0.01))
    assert (one.freedom, np.isnan(one.spread), one.summary()["spread"]) == (0, True, None)


def test_at_most_five_outliers_are_named_in_descending_order():
    values = CONTACT.indentation + 2e-4 * np.array([0.0, 30.0, 0.0, 60.0, 0.0, 0.0])
    result = identified(measured(values=values, name="press"))
    notes = [note for note in result.notes if note.startswith("value ")]
    sizes = [abs(float(note.split()[5])) for note in notes]
    assert notes[0].startswith("value 4 of press is +")
    assert sizes == sorted(sizes, reverse=True)
    assert min(sizes) > 4.0
    assert any("there are outliers (HeavyTailed)" in note for note in result.notes)
    assert result.misfit.widening == pytest.approx(result.spread, rel=1e-4)  # Birge's ratio
    assert any(note.startswith(f"bands are {result.misfit.widening:.3g} times as wide") for note in result.notes)
    notes = identified(measured(values=CONTACT.indentation * (1 + 0.2 * (-1.0) ** np.arange(6)))).notes
    assert sum(note.startswith("value ") for note in notes) == 5


def test_good_data_have_no_notes_on_the_fit():
    machine = Machine(offset=(-0.01, 0.01), compliance=(0.0, 1e-5), drift=(-1e-3, 1e-3))
    result = identified(measured(machine=machine), measured("area", uncertainty=0.1))
    assert not [note for note in result.notes if "uncertaint" in note or "search" in note or "would move" in note]
    offset = measured(values=CONTACT.indentation + 0.004, machine=Machine(offset=(-0.01, 0.01)))
    result = identified(offset, free={})  # the machine alone is unknown
    assert result.point == pytest.approx({"machine.offset": 0.004}, rel=1e-6)
    assert (result.joint, "would move" in " ".join(result.notes)) == (JOINT, False)


def test_residuals_that_follow_the_load_are_noted_with_their_ratio():
    rising = np.array([-1.1, -1.0, -0.4, 0.5, 1.2])  # squared differences 0.01 + 0.36 + 0.81 + 0.49
    ratio, probability = von_neumann_ratio(np.array([5.0, 4.0, 3.0, 2.0, 1.0]), rising)
    assert ratio == pytest.approx(1.67 / (rising @ rising - 5 * rising.mean() ** 2))
    assert probability == pytest.approx(2 / 120, abs=0.003)  # two of 120 orders, by 20 000 draws
    shallow = measured(values=MODEL.press(JOINT.replace(clearance=0.03), force=FORCE).indentation)
    assert [note for note in identified(shallow, free={"liner.young": (200.0, 5000.0)}).notes if "trend" in note]
    assert not [note for note in identified(shallow).notes if "trend" in note]  # with the clearance free


def test_the_corner_figure_draws_the_printed_bands():
    noise = np.array([3.0, -2.0, 1.0, 2.0, -3.0, 1.0])
    result = identified(measured(values=CONTACT.indentation + 2e-4 * noise, uncertainty=None))
    (panel,) = corner_figure(result).axes
    estimate = result["clearance"]
    assert [line.get_xdata()[0] for line in panel.lines] == pytest.approx([estimate.low, estimate.high])
    assert np.ptp(panel.patches[0].xy[:, 0]) > 1.2 * (estimate.high - estimate.low)  # Student's quantile: 2.57


def test_the_best_value_at_the_end_of_a_range_is_noted():
    for free, end in (((0.11, 0.4), "0.11"), ((0.02, 0.09), "0.09")):
        result = identified(measured(uncertainty=2e-3), free={"clearance": free})
        note = f"the best clearance is {end} mm, the end of its range: widen the range, or check the data"
        assert note in result.notes
    machine = Machine(compliance=(0.0, 1e-5))  # which ends at a physical limit
    result = identified(measured(machine=machine, values=0.99 * CONTACT.indentation), free={})
    assert result.point == pytest.approx({"machine.compliance": 0.0}, abs=1e-12)
    assert not any(note.startswith("the best machine.compliance") for note in result.notes)


def test_a_search_without_convergence_is_noted_with_the_notes_of_the_model():
    thick = JOINT.replace(liner_thickness=100.0)
    contact = MODEL.press(thick, force=FORCE)
    result = bs.identify(MODEL, thick, measured(values=contact.indentation), FREE)
    assert set(contact.notes) - {contact.utilisation_note} <= set(result.notes)
    stopped = replace(result, best=replace(result.best, converged=False, rivals=(result.best.theta,)))
    assert "the search did not converge: the numbers are those of its last step" in stopped.notes
    assert "another point fits the data about as well: sample the posterior" in stopped.notes
    assert (result.summary()["valid"], stopped.summary()["valid"]) == (True, False)


def candidates_of(quantity, result):
    return [candidate for candidate in standard_candidates(result) if candidate.quantity == quantity]


def test_standard_candidates_are_six_loads_with_the_absolute_or_relative_uncertainty_of_the_data():
    result = identified(measured())
    candidates = candidates_of("indentation", result)
    np.testing.assert_allclose([candidate.force for candidate in candidates], 4500.0 * np.arange(1, 7) / 6)
    (clearance,) = candidates_of("diametral_clearance", result)
    assert clearance.force is None
    assert clearance.uncertainty == pytest.approx(0.02 * 0.2, rel=1e-3)
    assert [candidate.order for candidate in candidates] == [0.0] * 6
    by_depth = Measured(quantity="force", values=FORCE, uncertainty=5.0, indentation=CONTACT.indentation)
    assert candidates_of("indentation", identified(by_depth))[-1].force == pytest.approx(4500.0, rel=1e-3)
    free_play = Measured(quantity="diametral_clearance", values=0.2, uncertainty=0.01)
    assert candidates_of("indentation", identified(free_play))[-1].force == pytest.approx(3000.0)
    constant = candidates_of("indentation", identified(measured()))
    assert [candidate.uncertainty for candidate in constant] == pytest.approx([2e-4] * 6)
    result = identified(measured(uncertainty=0.03 * CONTACT.indentation))
    for quantity, share in (("indentation", 0.03), ("max_pressure", 0.02)):
        for candidate in candidates_of(quantity, result):
            value = getattr(MODEL.press(result.joint, force=candidate.force), quantity)
            assert candidate.uncertainty == pytest.approx(share * value, rel=1e-6)


def test_a_candidate_is_the_next_reading_of_the_machine():
    machine = Machine(offset=0.001)
    read = measured(values=CONTACT.indentation + 0.001, machine=machine, order=[3.0, 7.0, 5.0, 1.0, 2.0, 4.0])
    result = identified(read, measured("area", uncertainty=4.0))
    following = {(candidate.machine, candidate.order) for candidate in candidates_of("indentation", result)}
    assert following == {(machine, 8.0)}
    (half_angle, *_) = candidates_of("half_angle", result)
    assert (half_angle.machine.name, half_angle.order) == ("", 0.0)


def test_gains_are_in_descending_order_without_candidates_that_have_no_result():
    depth = bs.Tabulated().press(JOINT, force=FORCE).indentation
    data = Measured(quantity="indentation", values=depth, uncertainty=2e-4, force=FORCE)
    result = identified(data, model=bs.Tabulated())
    assert experiment(result, [Candidate("indentation", 1e-3, 1e12)]).gains == ()
    found = experiment(identified(measured()))
    assert [gain.bits for gain in found.gains] == sorted((gain.bits for gain in found.gains), reverse=True)
    assert found.best is found.gains[0]
    gains = (gain("area", 3.0), gain("half_angle", 2.0), gain("area", 1.0))
    assert Experiment(gains, ()).best_by_quantity == gains[:2]


def gain(quantity, bits, identifies=()):
    return Gain(Candidate(quantity, 1.0), bits, {}, identifies)


def test_trials_have_coverage_and_bias_and_repeat_with_their_seed():
    middle = np.array([[0.1, 1.0], [-0.1, 1.2], [0.4, 1.0], [0.0, 1.2]])
    tried = Trials(("a", "b"), np.array([0.0, 1.0]), middle, middle - 0.2, middle + 0.2)
    assert tried.summary() == {"trials": 4, "coverage": tried.coverage, "bias": tried.bias}
    assert tried.coverage == {"a": 0.75, "b": 1.0}
    assert tried.bias == pytest.approx({"a": 0.25, "b": 0.25})
    result = identified(measured())
    first, second, third = (trials(result, 3, seed=seed) for seed in (0, 0, 2))
    np.testing.assert_allclose(first.middle, second.middle, rtol=1e-9)
    assert abs(first.middle - third.middle).max() > 0
    assert (first.low < first.middle).all()
    assert (first.middle < first.high).all()
    assert first.names == ("clearance",)
    np.testing.assert_array_equal(first.truth, result.best.theta)
    np.testing.assert_allclose(trials(result, 1).middle, first.middle[:1], rtol=1e-9)


def test_synthetic_data_scatter_by_the_widened_uncertainty_and_are_saturated_and_not_negative():
    result = identified(measured(load_uncertainty=60.0))
    wide = replace(result, misfit=replace(result.misfit, widening=3.0))
    noise = result.misfit.uncertainty * np.random.default_rng(5).standard_normal(6)
    for fitted, factor in ((result, 1.0), (wide, 3.0)):
        (drawn,) = draw_data_sets(fitted, np.random.default_rng(5))
        np.testing.assert_allclose(drawn.values, result.results[0] + factor * noise, rtol=1e-12)
    film = Measured(quantity="max_pressure", values=[2.0, 6.0], uncertainty=50.0, force=FORCE[[1, 2]], saturation=6.0)
    result = identified(film, measured(uncertainty=0.2, machine=Machine()), measured())
    drawn = [draw_data_sets(result, np.random.default_rng(seed)) for seed in range(20)]
    pressures, depths = (np.stack([sets[index].values for sets in drawn]) for index in (0, 1))
    assert (pressures.min(), pressures.max()) == (0.0, 6.0)
    assert depths.min() < 0.0  # as a machine may read
