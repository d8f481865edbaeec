"""Viscoelastic liner: elastic limits, relaxation, creep, vibration, agreement with integrated springs, and elements."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp

import ballsocket as bs
from ballsocket.dynamics import Bristles, ContactState, Damping, Prony, Viscoelastic, simulate

from ..joints import HIP

PE = Prony(terms=((0.3, 0.1), (0.2, 10.0)))
LINER = Viscoelastic(bs.HessForsbach(), HIP, PE)
TIME = np.linspace(0.0, 1.0, 401)
PUSH = 0.05 * np.sin(np.pi * TIME)
ELEMENT = bs.ForceElement(bs.HessForsbach(), HIP, relaxation=PE)


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


def at(depth):
    """Position of a ball at an indentation in mm."""
    return 0.0, 0.0, HIP.clearance + depth


def element_force(time, depth, start=(0.0, 0.0)):
    """Force in N of the element at each time, for a depth that is linear between instants, by its internal state."""

    def rates(now, relaxed):
        return ELEMENT(at(np.interp(now, time, depth)), relaxed_force=tuple(relaxed)).relaxed_force_rate

    force, state = [], start
    for begin, end in pairwise(time):
        state = solve_ivp(rates, (begin, end), state, method="LSODA", rtol=1e-9, atol=1e-6).y[:, -1]
        force.append(-ELEMENT(at(np.interp(end, time, depth)), relaxed_force=tuple(state)).force[2])
    return np.array([0.0, *force])


def test_an_element_relaxes_by_its_series_to_the_long_time_modulus():
    time = np.array([0.0, 0.05, 1.0, 200.0])
    force = element_force(time, np.full(4, 0.05))
    np.testing.assert_allclose(force[1:], LINER.relaxation_force(0.05, time[1:]), rtol=1e-7)
    assert force[-1] == pytest.approx(PE.long_term_share * LINER.instantaneous_force(0.05), rel=1e-7)


@pytest.mark.parametrize(("seconds", "share"), [(1e-6, 1.0), (1e6, PE.long_term_share)])
def test_fast_and_slow_loading_of_an_element_is_elastic(seconds, share):
    elastic = share * LINER.instantaneous_force(PUSH[::40])
    np.testing.assert_allclose(element_force(seconds * TIME[::40], PUSH[::40]), elastic, atol=3e-5 * elastic.max())


def test_an_element_has_the_exact_force_of_a_growing_contact_and_errs_less_than_its_integral_on_unloading():
    force = element_force(TIME[::4], PUSH[::4])
    exact, integral = LINER.cycle_force(TIME, PUSH)[::4], LINER.hereditary_force(TIME, PUSH)[::4]
    peak = exact.max()
    np.testing.assert_allclose(force[:51], exact[:51], atol=2e-4 * peak)  # between coarse instants the depth is linear
    assert (force >= 0.0).all()
    assert (force[51:] <= exact[51:] + 1e-4 * peak).all()
    assert 0.03 * peak < np.abs(force - exact).max() < 0.05 * peak < np.abs(integral - exact).max()
    loss, exact_loss = np.trapezoid(force, PUSH[::4]), np.trapezoid(exact, PUSH[::4])
    assert loss == pytest.approx(1.105 * exact_loss, rel=0.01)


def test_loss_of_a_small_vibration_of_an_element_follows_the_complex_stiffness():
    depth, size, frequency = 0.04, 1e-4, 2.0
    time = np.linspace(0.0, 2 / frequency, 401)
    path = depth + size * np.sin(2 * np.pi * frequency * time)
    force = element_force(time, path, start=[float(LINER.instantaneous_force(depth))] * 2)
    loss = np.trapezoid(force[200:], path[200:])
    assert loss == pytest.approx(np.pi * size**2 * LINER.dynamic_stiffness(depth, frequency).imag, rel=2e-3)


FAST = Prony(terms=((0.3, 1e-3), (0.2, 5e-3)))
THROW = {"mass": 1.0, "position": (0.0, 0.0, 0.0), "velocity": (10.0, 0.0, 100.0), "duration": 0.01, "step": 1e-5}


def test_the_loss_of_a_bounce_is_that_of_the_dashpots_and_the_rest_is_stored_in_the_springs():
    """A term with the relaxed force s and its indentation d(s) stores U(d) - s (d - d(s)) - U(d(s)) times its share."""
    motion = simulate(bs.ForceElement(bs.HessForsbach(), HIP, relaxation=FAST), **THROW)
    assert motion.bounces >= 2
    assert motion.drift < 1e-7
    relaxed, depth = motion.relaxed_force.T, np.maximum(motion.indentation, 0.0)
    total = FAST.shares @ relaxed
    force = np.maximum(LINER.instantaneous_force(depth), total)  # or that of the liner without the ball
    depths = [bs.HessForsbach().press(HIP, force=each).indentation for each in (force, *relaxed)]
    energies = [LINER.potential(each)[0] for each in depths]
    stored = FAST.long_term_share * (energies[0] - LINER.potential(depth)[0])
    for share, each, reached, energy in zip(FAST.shares, relaxed, depths[1:], energies[1:], strict=True):
        stored = stored + share * (energies[0] - each * (depths[0] - reached) - energy)
    loss = cumulative_trapezoid(motion.load.dissipation, motion.time, initial=0.0)
    assert (motion.load.dissipation >= -1e-9 * motion.load.dissipation.max()).all()
    np.testing.assert_allclose(motion.dissipated_energy, loss + stored, atol=1e-3 * loss[-1])
    assert motion.dissipated_energy.min() >= -1e-9


def test_a_ball_creeps_under_a_constant_force_as_the_liner_does():
    element = bs.ForceElement(bs.HessForsbach(), HIP, Damping(time=2e-5), relaxation=FAST)
    liner = Viscoelastic(bs.HessForsbach(), HIP, FAST)
    start = at(float(liner.creep_indentation(1000.0, 0.0)))
    motion = simulate(element, mass=1e-3, position=start, pull=(0.0, 0.0, 1000.0), duration=0.02, step=2e-4)
    np.testing.assert_allclose(motion.indentation, liner.creep_indentation(1000.0, motion.time), rtol=5e-3)


def test_numbers_and_arrays_of_an_element_agree_and_a_wrong_number_of_relaxed_forces_is_refused():
    element = bs.ForceElement(bs.Tabulated(), HIP, Damping(hysteresis=0.004), Bristles(coefficient=0.1), relaxation=PE)
    positions = np.array([at(0.05), at(0.001), at(-0.01), at(30.0)])
    relaxed = np.array([300.0, 200.0])
    several = element(positions, (0.0, 3.0, 10.0), (1.0, 2.0, 0.0), (1e-4,) * 4, relaxed_force=relaxed)
    assert several.status.tolist() == [ContactState.CONTACT] * 2 + [ContactState.FREE, ContactState.THROUGH_WALL]
    for index, position in enumerate(positions[:3]):
        load = element(tuple(position), (0.0, 3.0, 10.0), (1.0, 2.0, 0.0), (1e-4,) * 4, relaxed_force=tuple(relaxed))
        for name in ("force", "moment", "relaxed_force_rate", "deflection_rate", "energy", "dissipation", "tangent"):
            np.testing.assert_allclose(getattr(load, name), getattr(several, name)[index], rtol=1e-9, atol=1e-12)
    assert several.force[1].tolist() == [0.0] * 3  # the liner has not recovered
    assert element(at(0.05), relaxed_force=(np.nan, 0.0)).status is ContactState.NO_NUMBER
