"""Viscoelastic liner: elastic limits, relaxation, creep, vibration, and agreement with integrated springs."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import Prony, Viscoelastic

from ..joints import HIP

PE = Prony(terms=((0.3, 0.1), (0.2, 10.0)))
LINER = Viscoelastic(bs.HessForsbach(), HIP, PE)
TIME = np.linspace(0.0, 1.0, 401)
PUSH = 0.05 * np.sin(np.pi * TIME)


def test_loading_and_unloading_agree_with_integrated_springs():
    springs = LINER.spring_force(TIME, PUSH)
    np.testing.assert_allclose(LINER.cycle_force(TIME, PUSH), springs, atol=1e-5 * springs.max())
    assert np.trapezoid(LINER.cycle_force(TIME, PUSH), PUSH) == pytest.approx(np.trapezoid(springs, PUSH), rel=1e-4)
    ended = np.flatnonzero(springs == 0)  # the contact separates above the point of first touch
    assert PUSH[ended[ended > 200][0]] > 0.1 * PUSH.max()


def test_a_liner_has_not_recovered_at_the_next_loading_and_resists_a_fast_one_more():
    time = np.linspace(0.0, 2.0, 801)
    springs = LINER.spring_force(time, 0.05 * np.abs(np.sin(np.pi * time)))
    assert springs[600] < springs[200]
    assert (springs >= 0).all()
    peaks = [LINER.cycle_force(seconds * TIME, PUSH).max() for seconds in (100.0, 1.0, 0.01)]
    assert 1.4 * peaks[0] < peaks[2] > peaks[1] > peaks[0]


def test_product_and_hereditary_integral_err_on_unloading():
    springs = LINER.spring_force(TIME, PUSH)
    product, grown = LINER.separable_force(TIME, PUSH), LINER.hereditary_force(TIME, PUSH)
    up = TIME <= 0.5
    np.testing.assert_allclose(grown[up], springs[up], atol=1e-5 * springs.max())  # the contact grows
    assert np.abs(product - springs).max() == pytest.approx(0.098 * springs.max(), rel=0.02)
    assert np.abs(grown - springs).max() == pytest.approx(0.089 * springs.max(), rel=0.02)
    assert np.trapezoid(product, PUSH) < 0.2 * np.trapezoid(springs, PUSH)
    assert np.trapezoid(grown, PUSH) > 1.2 * np.trapezoid(springs, PUSH)
    assert grown[-2] < 0  # a spurious tension


def test_product_relaxes_from_first_touch():
    """A ball that touches after 2 s and holds its depth has g(t - 2 s) times the elastic force."""
    time = np.array([0.0, 1.0, 2.0, 2.1, 12.0])
    depth = np.array([-0.02, -0.01, 0.0, 0.05, 0.05])
    force = LINER.separable_force(time, depth)
    elastic = float(LINER.instantaneous_force(np.array([0.05]))[0])
    for before in (LINER.separable_force, LINER.hereditary_force, LINER.cycle_force, LINER.spring_force):
        assert before(time[:4], depth[:4])[:3].tolist() == [0.0, 0.0, 0.0]
        assert before(time[:4], depth[:4])[3] > 0
    assert force[3] == pytest.approx(elastic)
    assert force[4] == pytest.approx((0.5 + 0.3 * np.exp(-99.0) + 0.2 * np.exp(-0.99)) * elastic, rel=1e-12)


def test_a_single_term_is_the_standard_linear_solid():
    """It loses most at ω τ = 1. g = 1 - g1 + g1 exp(-t/τ) has J = 1/g∞ - g1/g∞ exp(-g∞ t/τ)."""
    one = Prony(terms=((0.4, 0.1),))
    assert one.complex_modulus(1 / (2 * np.pi * 0.1)) == pytest.approx(0.8 + 0.2j)
    assert abs(one.complex_modulus(1e9) - 1.0) < 1e-6
    assert abs(one.complex_modulus(0.0) - 0.6) < 1e-12
    losses = one.complex_modulus(np.array([0.5, 1.0, 2.0]) / (2 * np.pi * 0.1)).imag
    assert losses[0] == pytest.approx(losses[2])
    assert losses[1] > losses[0]
    time = np.array([0.0, 0.05, 0.3])
    expected = 1 / 0.6 - 0.4 / 0.6 * np.exp(-0.6 * time / 0.1)
    np.testing.assert_allclose(one.creep_compliance(time), expected, rtol=1e-12)


@pytest.mark.parametrize(("seconds", "share"), [(1e-6, 1.0), (1e6, PE.long_term_share)])
def test_fast_and_slow_limits_are_elastic(seconds, share):
    for model in (bs.HessForsbach(), bs.Refined()):
        liner = Viscoelastic(model, HIP, PE)
        elastic = share * liner.instantaneous_force(PUSH)
        np.testing.assert_allclose(liner.cycle_force(seconds * TIME, PUSH), elastic, atol=5e-5 * elastic.max())
    springs = LINER.spring_force(seconds * TIME, PUSH)
    np.testing.assert_allclose(springs, share * LINER.instantaneous_force(PUSH), atol=5e-5 * springs.max())


def test_creep_and_relaxation_agree_with_integrated_springs():
    time = np.append(0.0, np.geomspace(1e-6, 100.0, 400))
    depth = np.append(0.0, LINER.creep_indentation(3000.0, time[1:]))
    np.testing.assert_allclose(LINER.spring_force(time, depth)[1:], 3000.0, rtol=3e-5)
    assert depth[-1] > 1.4 * depth[1]
    assert PE.creep_compliance(np.array([0.0, 1e9])) == pytest.approx([1.0, 1 / PE.long_term_share])
    held = LINER.spring_force(time, np.append(0.0, np.full(400, 0.05)))
    np.testing.assert_allclose(held[1:], LINER.relaxation_force(0.05, time[1:]), rtol=1e-4)


def test_loss_of_a_small_vibration_follows_the_complex_stiffness():
    depth, size, frequency = 0.04, 1e-5, 2.0
    hold = np.linspace(0.0, 60.0, 600)[:-1]
    shake = np.linspace(0.0, 2 / frequency, 801)
    time = np.append(hold, 60.0 + shake)
    path = np.append(np.minimum(hold / 0.5, 1.0) * depth, depth + size * np.sin(2 * np.pi * frequency * shake))
    last = slice(len(hold) + 400, None)
    loss = np.trapezoid(LINER.spring_force(time, path, rings=2000)[last], path[last])
    assert loss == pytest.approx(np.pi * size**2 * LINER.dynamic_stiffness(depth, frequency).imag, rel=1e-3)
