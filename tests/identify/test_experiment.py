"""Candidates for the next measurement, their gains, and synthetic data."""

from dataclasses import replace
from math import log2, sqrt

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import HeavyTailed, Machine, Measured
from ballsocket.identify.experiment import Candidate, Experiment, Gain, experiment, standard_candidates
from ballsocket.identify.synthetic import Trials, draw_data_sets, trials

from .rigid import JOINT, MODEL

FORCE = np.array([400.0, 1000.0, 2000.0, 3000.0])
CONTACT = MODEL.press(JOINT, force=FORCE)


def identified(*data, free=None, **settings):
    return bs.identify(MODEL, JOINT, data, free or {"clearance": (0.02, 0.4)}, **settings)


def measured(quantity="indentation", uncertainty=2e-4, **settings):
    return Measured(
        quantity=quantity, values=getattr(CONTACT, quantity), uncertainty=uncertainty, force=FORCE, **settings
    )


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
    read = {"values": CONTACT.indentation + 0.001, "uncertainty": 2e-4, "force": FORCE, "order": [3.0, 7.0, 5.0, 1.0]}
    result = identified(Measured(quantity="indentation", machine=machine, **read), measured("area", 4.0))
    following = {(candidate.machine, candidate.order) for candidate in candidates_of("indentation", result)}
    assert following == {(machine, 8.0)}
    (half_angle, *_) = candidates_of("half_angle", result)
    assert (half_angle.machine.name, half_angle.order) == ("", 0.0)


@pytest.mark.parametrize(("scatter", "weight"), [(None, 1.0), (HeavyTailed(), 5 / 7)])
def test_the_gain_of_one_unknown_is_half_the_logarithm_of_the_growth(scatter, weight):
    result = identified(measured(), **({"scatter": scatter} if scatter else {}))
    candidate = Candidate("half_angle", 0.004, 1500.0)
    (gain,) = experiment(result, [candidate]).gains
    step = 1e-4
    theta = result.best.theta[0] + step * np.array([1.0, -1.0])
    joints = [JOINT.replace(clearance=value) for value in result.transform.to_values(theta[:, None])[:, 0]]
    above, below = (MODEL.press(joint, force=1500.0).half_angle for joint in joints)
    slope = (above - below) / (2 * step)
    growth = 1 + weight * (slope / 0.004) ** 2 * result.information.covariance[0, 0]
    assert gain.bits == pytest.approx(log2(growth) / 2, rel=1e-4)
    assert gain.uncertainty_ratio["clearance"] == pytest.approx(1 / sqrt(growth), rel=1e-4)
    assert gain.identifies == ()
    stated = {"quantity": "half_angle", "force": 1500.0, "uncertainty": 0.004}
    assert gain.summary() == {**stated, "bits": gain.bits, "left": gain.uncertainty_ratio}


def test_a_candidate_without_a_result_is_omitted():
    depth = bs.Tabulated().press(JOINT, force=FORCE).indentation
    data = Measured(quantity="indentation", values=depth, uncertainty=2e-4, force=FORCE)
    result = bs.identify(bs.Tabulated(), JOINT, data, {"clearance": (0.05, 0.2)})
    assert experiment(result, [Candidate("indentation", 1e-3, 1e12)]).gains == ()


def gain(quantity, bits, identifies=()):
    return Gain(Candidate(quantity, 1.0), bits, {}, identifies)


def test_gains_are_in_descending_order_and_the_best_of_a_quantity_comes_first():
    result = identified(measured())
    found = experiment(result)
    assert [gain.bits for gain in found.gains] == sorted((gain.bits for gain in found.gains), reverse=True)
    assert found.best is found.gains[0]
    gains = (gain("area", 3.0), gain("half_angle", 2.0), gain("area", 1.0))
    assert Experiment(gains, ()).best_by_quantity == gains[:2]
    assert len(found.summary()) == len(found.gains) == 19


def test_sufficient_quantities_identify_every_unidentifiable_unknown():
    gains = (
        gain("diametral_clearance", 3.0, ("a", "b")),
        gain("indentation", 2.0, ("a",)),
        gain("indentation", 1.0, ("b", "a")),
        gain("max_pressure", 1.0, ("b",)),
    )
    assert Experiment(gains, ("a", "b")).sufficient_quantities == ("indentation", "diametral_clearance")
    assert Experiment(gains, ()).sufficient_quantities == ()


def test_coverage_and_bias_of_trials():
    truth = np.array([0.0, 1.0])
    middle = np.array([[0.1, 1.0], [-0.1, 1.2], [0.4, 1.0], [0.0, 1.2]])
    tried = Trials(("a", "b"), truth, middle, middle - 0.2, middle + 0.2)
    assert tried.coverage == {"a": 0.75, "b": 1.0}
    assert tried.bias == pytest.approx({"a": 0.25, "b": 0.25})
    np.testing.assert_allclose(tried.half_widths, 0.2)
    assert tried.summary() == {"trials": 4, "coverage": tried.coverage, "bias": tried.bias}


def test_synthetic_data_scatter_about_the_results_with_the_widened_uncertainty():
    result = identified(measured())
    wide = replace(result, misfit=replace(result.misfit, widening=3.0))
    (plain,), (widened,) = (draw_data_sets(case, np.random.default_rng(5)) for case in (result, wide))
    noise = np.random.default_rng(5).standard_normal(4)
    np.testing.assert_allclose(plain.values, result.results[0] + 2e-4 * noise, rtol=1e-12)
    np.testing.assert_allclose(widened.values, result.results[0] + 6e-4 * noise, rtol=1e-12)


def test_synthetic_data_are_saturated_and_not_negative():
    film = {"values": np.minimum(CONTACT.max_pressure, 6.0), "uncertainty": 50.0, "force": FORCE, "saturation": 6.0}
    result = identified(Measured(quantity="max_pressure", **film), measured())
    values = np.stack([draw_data_sets(result, np.random.default_rng(seed))[0].values for seed in range(20)])
    assert (values.min(), values.max()) == (0.0, 6.0)
    machine = measured(uncertainty=0.2, machine=Machine())
    read = draw_data_sets(identified(machine, measured()), np.random.default_rng(0))[0].values
    assert read.min() < 0.0


def test_trials_repeat_with_their_seed_and_need_a_count():
    result = identified(measured())
    first, second, third = trials(result, 3, seed=1), trials(result, 3, seed=1), trials(result, 3, seed=2)
    np.testing.assert_allclose(first.middle, second.middle, rtol=1e-9)
    assert abs(first.middle - third.middle).max() > 0
    assert (first.low < first.middle).all()
    assert (first.middle < first.high).all()
    assert first.names == ("clearance",)
    np.testing.assert_array_equal(first.truth, result.best.theta)
    one = trials(result, 1).middle
    assert one.shape == (1, 1)
    np.testing.assert_allclose(one, trials(result, 1, seed=0).middle, rtol=1e-9)
