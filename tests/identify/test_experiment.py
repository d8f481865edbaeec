"""Candidates for the next measurement, their gains, and synthetic data."""

from dataclasses import replace
from math import log2, sqrt

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import HeavyTailed, Machine, Measured, NormalScatter
from ballsocket.identify.experiment import Candidate, Experiment, Gain, experiment, standard_candidates
from ballsocket.identify.synthetic import Trials, draw_data_sets, trials

from .rigid import JOINT, MODEL

FORCE = np.array([400.0, 1000.0, 2000.0, 3000.0])
CONTACT = MODEL.press(JOINT, force=FORCE)


def identified(*data, model=MODEL, **settings):
    return bs.identify(model, JOINT, data, {"clearance": (0.02, 0.4)}, **settings)


def measured(quantity="indentation", uncertainty=2e-4, values=None, **settings):
    values = getattr(CONTACT, quantity) if values is None else values
    return Measured(quantity=quantity, values=values, uncertainty=uncertainty, force=FORCE, **settings)


def candidates_of(quantity, result):
    return [candidate for candidate in standard_candidates(result) if candidate.quantity == quantity]


def test_standard_candidates_are_six_loads_up_to_one_and_a_half_times_the_largest():
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


def test_the_uncertainty_of_a_candidate_is_absolute_or_relative_as_in_the_data():
    constant = candidates_of("indentation", identified(measured()))
    assert [candidate.uncertainty for candidate in constant] == pytest.approx([2e-4] * 6)
    result = identified(measured(uncertainty=0.03 * CONTACT.indentation))
    for quantity, share in (("indentation", 0.03), ("max_pressure", 0.02)):
        for candidate in candidates_of(quantity, result):
            value = getattr(MODEL.press(result.joint, force=candidate.force), quantity)
            assert candidate.uncertainty == pytest.approx(share * value, rel=1e-6)


def test_a_candidate_is_the_next_reading_of_the_machine():
    machine = Machine(offset=0.001)
    read = measured(values=CONTACT.indentation + 0.001, machine=machine, order=[3.0, 7.0, 5.0, 1.0])
    result = identified(read, measured("area", 4.0))
    following = {(candidate.machine, candidate.order) for candidate in candidates_of("indentation", result)}
    assert following == {(machine, 8.0)}
    (half_angle, *_) = candidates_of("half_angle", result)
    assert (half_angle.machine.name, half_angle.order) == ("", 0.0)


@pytest.mark.parametrize(("scatter", "weight"), [(NormalScatter(), 1.0), (HeavyTailed(), 5 / 7)])
def test_the_gain_of_one_unknown_is_half_the_logarithm_of_the_growth(scatter, weight):
    result = identified(measured(), scatter=scatter)
    (gain,) = experiment(result, [Candidate("half_angle", 0.004, 1500.0)]).gains
    theta = result.best.theta[0] + 1e-4 * np.array([1.0, -1.0])
    joints = [JOINT.replace(clearance=value) for value in result.transform.to_values(theta[:, None])[:, 0]]
    above, below = (MODEL.press(joint, force=1500.0).half_angle for joint in joints)
    growth = 1 + weight * ((above - below) / 2e-4 / 0.004) ** 2 * result.information.covariance[0, 0]
    assert gain.bits == pytest.approx(log2(growth) / 2, rel=1e-4)
    assert gain.uncertainty_ratio["clearance"] == pytest.approx(1 / sqrt(growth), rel=1e-4)
    assert gain.identifies == ()
    stated = {"quantity": "half_angle", "force": 1500.0, "uncertainty": 0.004}
    assert gain.summary() == {**stated, "bits": gain.bits, "left": gain.uncertainty_ratio}


def test_a_candidate_without_a_result_is_omitted():
    depth = bs.Tabulated().press(JOINT, force=FORCE).indentation
    data = Measured(quantity="indentation", values=depth, uncertainty=2e-4, force=FORCE)
    result = identified(data, model=bs.Tabulated())
    assert experiment(result, [Candidate("indentation", 1e-3, 1e12)]).gains == ()


def gain(quantity, bits, identifies=()):
    return Gain(Candidate(quantity, 1.0), bits, {}, identifies)


def test_gains_are_in_descending_order_and_the_best_of_a_quantity_comes_first():
    found = experiment(identified(measured()))
    assert [gain.bits for gain in found.gains] == sorted((gain.bits for gain in found.gains), reverse=True)
    assert found.best is found.gains[0]
    gains = (gain("area", 3.0), gain("half_angle", 2.0), gain("area", 1.0))
    assert Experiment(gains, ()).best_by_quantity == gains[:2]


def test_sufficient_quantities_identify_every_unidentifiable_unknown():
    free_play, both = gain("diametral_clearance", 3.0, ("a", "b")), gain("indentation", 1.0, ("b", "a"))
    gains = (free_play, gain("indentation", 2.0, ("a",)), both, gain("max_pressure", 1.0, ("b",)))
    assert Experiment(gains, ("a", "b")).sufficient_quantities == ("indentation", "diametral_clearance")
    assert Experiment(gains, ()).sufficient_quantities == ()


def test_coverage_and_bias_of_trials():
    middle = np.array([[0.1, 1.0], [-0.1, 1.2], [0.4, 1.0], [0.0, 1.2]])
    tried = Trials(("a", "b"), np.array([0.0, 1.0]), middle, middle - 0.2, middle + 0.2)
    assert tried.summary() == {"trials": 4, "coverage": tried.coverage, "bias": tried.bias}
    assert tried.coverage == {"a": 0.75, "b": 1.0}
    assert tried.bias == pytest.approx({"a": 0.25, "b": 0.25})


def test_synthetic_data_scatter_about_the_results_with_the_widened_uncertainty_of_values_and_loads():
    result = identified(measured(load_uncertainty=60.0))
    wide = replace(result, misfit=replace(result.misfit, widening=3.0))
    noise = result.misfit.uncertainty * np.random.default_rng(5).standard_normal(4)
    for fitted, factor in ((result, 1.0), (wide, 3.0)):
        (drawn,) = draw_data_sets(fitted, np.random.default_rng(5))
        np.testing.assert_allclose(drawn.values, result.results[0] + factor * noise, rtol=1e-12)


def test_synthetic_data_are_saturated_and_not_negative():
    film = Measured(quantity="max_pressure", values=[2.0, 6.0], uncertainty=50.0, force=FORCE[[0, 3]], saturation=6.0)
    result = identified(film, measured(uncertainty=0.2, machine=Machine()), measured())
    drawn = [draw_data_sets(result, np.random.default_rng(seed)) for seed in range(20)]
    pressures, depths = (np.stack([sets[index].values for sets in drawn]) for index in (0, 1))
    assert (pressures.min(), pressures.max()) == (0.0, 6.0)
    assert depths.min() < 0.0  # as a machine may read


def test_trials_repeat_with_their_seed():
    result = identified(measured())
    first, second, third = (trials(result, 3, seed=seed) for seed in (0, 0, 2))
    np.testing.assert_allclose(first.middle, second.middle, rtol=1e-9)
    assert abs(first.middle - third.middle).max() > 0
    assert (first.low < first.middle).all()
    assert (first.middle < first.high).all()
    assert first.names == ("clearance",)
    np.testing.assert_array_equal(first.truth, result.best.theta)
    np.testing.assert_allclose(trials(result, 1).middle, first.middle[:1], rtol=1e-9)
