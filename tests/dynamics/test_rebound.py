"""Estimation of damping: recovery of known values, and standard errors."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import Damping, from_bounces, from_restitution, simulate
from ballsocket.dynamics.restitution import restitution_of

from ..joints import HIP

CHI = 4e-3
SPEEDS = np.geomspace(20.0, 400.0, 12)
RESTITUTIONS = np.array([restitution_of(CHI * speed) for speed in SPEEDS])


def test_exact_restitutions_recover_the_damping():
    estimate = from_restitution(speed=SPEEDS, restitution=RESTITUTIONS, uncertainty=0.01)
    assert estimate.damping.hysteresis == pytest.approx(CHI, rel=1e-9)
    assert np.abs(estimate.residuals).max() < 1e-9
    doubled = from_restitution(speed=SPEEDS, restitution=RESTITUTIONS, uncertainty=0.02)
    assert doubled.error == pytest.approx(2 * estimate.error, rel=1e-9)


@pytest.mark.parametrize("known", [True, False], ids=["noise known", "noise from the scatter"])
def test_standard_error_equals_the_scatter_of_repeated_tests(known):
    random, noise = np.random.default_rng(4), 0.005
    estimates = [
        from_restitution(
            speed=SPEEDS,
            restitution=np.minimum(RESTITUTIONS + noise * random.normal(size=12), 1.0),
            uncertainty=noise if known else None,
        )
        for _ in range(60)
    ]
    chi, error = np.array([(estimate.damping.hysteresis, estimate.error) for estimate in estimates]).T
    assert np.std(chi) == pytest.approx(np.mean(error), rel=0.25)
    assert abs(np.mean(chi) - CHI) < 3 * np.std(chi) / np.sqrt(60)
    assert np.mean(np.abs(chi - CHI) < 2 * error) > 0.85


def test_simulated_bounces_recover_the_damping():
    element = bs.ForceElement(bs.HessForsbach(), HIP, damping=Damping(hysteresis=CHI))
    throw = {"mass": 1.0, "position": (0.0, 0.0, 0.0), "velocity": (0.0, 0.0, 200.0)}
    motion = simulate(element, duration=0.02, step=5e-6, **throw)
    assert motion.bounces >= 4
    speed = np.linalg.norm(motion.velocity, axis=1)[motion.indentation < 0]
    levels = speed[np.append(True, np.diff(speed) < -1e-9)]
    estimate = from_restitution(speed=levels[:-1], restitution=levels[1:] / levels[:-1])
    assert estimate.damping.hysteresis == pytest.approx(CHI, rel=1e-3)


def test_times_of_impacts_recover_the_damping():
    speeds = [100.0]
    for _ in range(6):
        speeds.append(speeds[-1] * restitution_of(CHI * speeds[-1]))
    times = np.cumsum([0.0, *(2 * speed / 9806.65 for speed in speeds)])
    estimate = from_bounces(times=times)
    assert estimate.damping.hysteresis == pytest.approx(CHI, rel=1e-8)
    assert "from 6 restitutions" in str(estimate)


@pytest.mark.parametrize("chi", [1e-9, 4e-3, 0.1])
def test_standard_error_is_the_uncertainty_over_the_slope_of_the_restitution(chi):
    """∂e/∂χ is the derivative of the exact relation; for a small χ v it is -2 v/3."""
    restitution, step = restitution_of(chi * 50.0), 1e-3 * chi
    slope = (restitution_of((chi + step) * 50.0) - restitution_of((chi - step) * 50.0)) / (2 * step)
    estimate = from_restitution(speed=[50.0], restitution=[restitution], uncertainty=0.01)
    assert estimate.error == pytest.approx(0.01 / abs(slope), rel=1e-4)
    assert estimate.noise == 0.01
    if chi == 1e-9:
        assert estimate.error == pytest.approx(0.01 / (2 * 50.0 / 3), rel=1e-6)


def test_scatter_has_one_degree_of_freedom_less_than_measurements():
    measured = RESTITUTIONS[:3] * np.array([1.01, 0.99, 1.0])
    estimate = from_restitution(speed=SPEEDS[:3], restitution=measured)
    assert 2 * estimate.noise**2 == pytest.approx(np.sum(estimate.residuals**2), rel=1e-12)
    assert estimate.noise > 0


def test_a_single_restitution_has_no_scatter_and_a_perfect_one_no_damping():
    assert np.isnan(from_restitution(speed=[100.0], restitution=[0.8]).error)
    assert from_restitution(speed=[100.0, 200.0], restitution=[1.0, 1.0]).damping.hysteresis == 0.0


def test_three_impacts_are_one_restitution():
    estimate = from_bounces(times=[0.0, 0.2, 0.38], uncertainty=0.01)
    assert estimate.restitution == pytest.approx([0.9])
    assert estimate.speed == pytest.approx([980.665])
    moon = from_bounces(times=[0.0, 0.2, 0.38], gravity=1620.0, uncertainty=0.01)
    assert moon.speed == pytest.approx([162.0])
