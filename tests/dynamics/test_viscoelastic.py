"""A liner that relaxes: between two elastic limits, and as the springs have it that are followed one by one."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import Prony, Viscoelastic

from ..joints import HIP

PE = Prony(terms=((0.3, 0.1), (0.2, 10.0)))
LINER = Viscoelastic(bs.HessForsbach(), HIP, PE)
TIME = np.linspace(0.0, 1.0, 401)
PUSH = 0.05 * np.sin(np.pi * TIME)


def lost(force, depth):
    return np.trapezoid(force, depth)


def test_a_push_and_its_way_back_are_those_of_the_springs():
    springs = LINER.springs(TIME, PUSH)
    np.testing.assert_allclose(LINER.pressed(TIME, PUSH), springs, atol=1e-5 * springs.max())
    assert lost(LINER.pressed(TIME, PUSH), PUSH) == pytest.approx(lost(springs, PUSH), rel=1e-4)
    ended = np.flatnonzero(springs == 0)  # it lets go before the ball is where it touched
    assert PUSH[ended[ended > 200][0]] > 0.1 * PUSH.max()


def test_the_simple_product_is_wrong_by_a_tenth_in_the_force_and_by_most_of_the_loss():
    springs = LINER.springs(TIME, PUSH)
    product, grown = LINER.product(TIME, PUSH), LINER.grown(TIME, PUSH)
    up = TIME <= 0.5
    np.testing.assert_allclose(grown[up], springs[up], atol=1e-5 * springs.max())  # the contact grows
    assert np.abs(product - springs).max() == pytest.approx(0.098 * springs.max(), rel=0.02)
    assert np.abs(grown - springs).max() == pytest.approx(0.089 * springs.max(), rel=0.02)
    assert lost(product, PUSH) < 0.2 * lost(springs, PUSH)
    assert lost(grown, PUSH) > 1.2 * lost(springs, PUSH)
    assert grown[-2] < 0  # and it would pull


@pytest.mark.parametrize(("seconds", "share"), [(1e-6, 1.0), (1e6, PE.rest)])
def test_very_fast_and_very_slow_it_is_elastic(seconds, share):
    for model in (bs.HessForsbach(), bs.Refined()):
        liner = Viscoelastic(model, HIP, PE)
        elastic = share * liner.at_once(PUSH)
        np.testing.assert_allclose(liner.pressed(seconds * TIME, PUSH), elastic, atol=5e-5 * elastic.max())
    springs = LINER.springs(seconds * TIME, PUSH)
    np.testing.assert_allclose(springs, share * LINER.at_once(PUSH), atol=5e-5 * springs.max())


def test_a_faster_push_is_stiffer():
    peaks = [LINER.pressed(seconds * TIME, PUSH).max() for seconds in (100.0, 1.0, 0.01)]
    assert peaks == sorted(peaks)
    assert peaks[2] > 1.4 * peaks[0]


def test_it_creeps_under_a_force_that_stays_and_relaxes_at_a_depth_that_stays():
    time = np.append(0.0, np.geomspace(1e-6, 100.0, 400))
    depth = np.append(0.0, LINER.creeping(3000.0, time[1:]))
    np.testing.assert_allclose(LINER.springs(time, depth)[1:], 3000.0, rtol=3e-5)
    assert depth[-1] > 1.4 * depth[1]
    held = np.append(0.0, np.full(400, 0.05))
    np.testing.assert_allclose(LINER.springs(time, held)[1:], LINER.relaxing(0.05, time[1:]), rtol=1e-4)


def test_creep_is_the_inverse_of_relaxation():
    time = np.linspace(0.0, 30.0, 3001)
    rise = np.append(1.0, np.diff(PE.crept(time)))  # a step, then what it creeps
    stress = np.array([np.sum(rise[: n + 1] * PE.relaxed(time[n] - time[: n + 1])) for n in (0, 100, 1000, 3000)])
    np.testing.assert_allclose(stress, 1.0, rtol=2e-3)
    assert PE.crept(np.array([0.0, 1e9])) == pytest.approx([1.0, 1 / PE.rest])


def test_a_small_vibration_loses_what_the_complex_stiffness_says():
    depth, size, frequency = 0.04, 1e-5, 2.0
    rest = np.linspace(0.0, 60.0, 600)[:-1]
    shake = np.linspace(0.0, 2 / frequency, 801)
    time = np.append(rest, 60.0 + shake)
    way = np.append(np.minimum(rest / 0.5, 1.0) * depth, depth + size * np.sin(2 * np.pi * frequency * shake))
    last = slice(len(rest) + 400, None)
    found = lost(LINER.springs(time, way, rings=2000)[last], way[last])
    assert found == pytest.approx(np.pi * size**2 * LINER.dynamic_stiffness(depth, frequency).imag, rel=1e-3)


def test_the_springs_follow_a_ball_that_comes_again():
    time = np.linspace(0.0, 2.0, 801)
    again = 0.05 * np.abs(np.sin(np.pi * time))
    springs = LINER.springs(time, again)
    assert springs[600] < springs[200]  # the liner has not recovered
    assert (springs >= 0).all()
    with pytest.raises(ValueError, match="it rises once and falls then; ask `springs`"):
        LINER.pressed(time, again)


@pytest.mark.parametrize(
    ("terms", "sentence"),
    [
        ((), "the number of terms = 0 is not allowed"),
        (((-0.1, 1.0),), "a share = -0.1 is not allowed"),
        (((0.1, 0.0),), "a time = 0 is not allowed"),
        (((0.5, 1.0), (0.6, 2.0)), "the sum of the shares = 1.1 is not allowed"),
    ],
)
def test_what_is_no_modulus_is_refused(terms, sentence):
    with pytest.raises(ValueError, match=sentence):
        Prony(terms=terms)


def test_a_history_that_is_none_is_refused():
    with pytest.raises(ValueError, match="each is later than the one before"):
        LINER.pressed([0.0, 1.0, 1.0], [0.0, 0.1, 0.0])
    with pytest.raises(ValueError, match="rows of one length"):
        LINER.pressed([0.0, 1.0], [0.0])
    with pytest.raises(ValueError, match="begins before the touch"):
        LINER.pressed([0.0, 1.0], [0.1, 0.0])
    with pytest.raises(TypeError, match="springs stand for a model of radial springs"):
        Viscoelastic(bs.Hertz(), HIP, PE).springs(TIME, PUSH)
