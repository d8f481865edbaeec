"""Coefficient of restitution: published relations, and estimation of the damping with its standard error."""

from math import log1p

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ballsocket as bs
from ballsocket.dynamics import Damping, Flores, damping_from_restitution, relations
from ballsocket.dynamics.damping import from_bounces, from_restitution
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
    assert np.isnan(from_restitution(speed=[100.0], restitution=[0.8]).error)
    assert from_restitution(speed=[100.0, 200.0], restitution=[1.0, 1.0]).damping.hysteresis == 0.0


def test_three_impacts_are_one_restitution():
    estimate = from_bounces(times=[0.0, 0.2, 0.38], uncertainty=0.01)
    assert estimate.restitution == pytest.approx([0.9])
    assert estimate.speed == pytest.approx([980.665])
    moon = from_bounces(times=[0.0, 0.2, 0.38], gravity=1620.0, uncertainty=0.01)
    assert moon.speed == pytest.approx([162.0])


def simulated_restitution(damping, speed, model):
    """Integrate the impact of 1 kg by a high-order method, and return its coefficient of restitution."""
    element = bs.ForceElement(model, HIP, damping=damping)

    def rates(_, state):
        d, v = state.tolist()
        return [v, 1e3 * element((0.0, 0.0, HIP.clearance + d), (0.0, 0.0, v)).force[2]]

    def leaves(_, state):
        return state[0]

    leaves.terminal, leaves.direction = True, -1
    solution = solve_ivp(rates, (0.0, 1.0), [1e-12, speed], method="DOP853", rtol=1e-10, atol=1e-13, events=leaves)
    return -solution.y_events[0][0][1] / speed


@pytest.mark.parametrize("relation", relations.relations, ids=lambda relation: relation.name)
def test_simulated_restitution_equals_the_exact_relation(relation):
    for restitution, model in ((0.9, bs.HessForsbach()), (0.5, bs.Hertz())):
        damping = damping_from_restitution(relation, restitution, 100.0)
        h = 100.0 * damping.hysteresis
        assert simulated_restitution(damping, 100.0, model) == pytest.approx(restitution_of(h), rel=1e-7)
        assert damping.restitution(100.0) == restitution_of(h)


def test_published_relations_are_accurate_in_their_ranges():
    """All relations hold near e = 1; those of Flores and Gonthier approximate any e."""
    for relation in relations.relations:
        assert restitution_of(relation.damping(0.99)) == pytest.approx(0.99, abs=4e-3), relation
    for e in np.linspace(0.05, 1.0, 20):
        assert restitution_of(relations.exact.damping(e)) == pytest.approx(e, rel=1e-12)
        assert restitution_of(relations.gonthier.damping(e)) == pytest.approx(e, abs=0.035)
        assert restitution_of(relations.flores.damping(e)) == pytest.approx(e, abs=0.05)
    assert restitution_of(relations.hunt_crossley.damping(0.3)) > 0.55
    assert restitution_of(relations.lankarani_nikravesh.damping(0.3)) > 0.65


def test_exact_relation_satisfies_its_equation():
    for h in (1e-6, 0.99e-4, 1.01e-4, 1e-2, 1.0, 3.0):
        e = restitution_of(h)
        assert h * (1 + e) == pytest.approx(log1p(h) - log1p(-h * e), rel=1e-12)
    below, above = restitution_of(0.9999999e-4), restitution_of(1.0000001e-4)
    assert below - above == pytest.approx(2 / 3 * 2e-11, abs=3e-12)  # the series of a small damping
    damping = Flores(restitution=0.8, impact_speed=100.0)
    assert damping.restitution(50.0) > damping.restitution(100.0) > damping.restitution(200.0)


def test_published_relations_have_their_numbers_at_one_half_and_no_damping_at_one():
    expected = {"Hunt & Crossley": 0.75, "Lankarani & Nikravesh": 0.5625, "Gonthier": 1.5, "Flores": 1.6}
    assert expected.items() <= {relation.name: relation.damping(0.5) for relation in relations.relations}.items()
    assert damping_from_restitution(relations.flores, 0.5, 200.0).hysteresis == pytest.approx(0.008)
    for relation in relations.relations:
        assert relation.damping(1.0) == 0.0
        assert damping_from_restitution(relation, 1.0, 1e-3) == Damping(sources=relation.sources)
    assert restitution_of(0.0) == 1.0


@pytest.mark.parametrize("known", [True, False], ids=["noise known", "noise from the scatter"])
def test_standard_error_equals_the_scatter_of_repeated_tests(known):
    random, noise = np.random.default_rng(4), 0.005
    measured = np.minimum(RESTITUTIONS + noise * random.normal(size=(60, 12)), 1.0)
    uncertainty = noise if known else None
    estimates = [from_restitution(speed=SPEEDS, restitution=row, uncertainty=uncertainty) for row in measured]
    chi, error = np.array([(estimate.damping.hysteresis, estimate.error) for estimate in estimates]).T
    assert np.std(chi) == pytest.approx(np.mean(error), rel=0.25)
    assert abs(np.mean(chi) - CHI) < 3 * np.std(chi) / np.sqrt(60)
    assert np.mean(np.abs(chi - CHI) < 2 * error) > 0.85
