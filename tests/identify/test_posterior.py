"""Markov chains: convergence measures with known values, and a posterior with a closed form."""

import numpy as np
import pytest
from scipy import stats

import ballsocket as bs
from ballsocket.identify import Measured
from ballsocket.identify.posterior import (
    CONVERGED,
    Posterior,
    _autocorrelation_time,
    _r_hat,
    _StudentProposal,
    posterior,
)
from ballsocket.studies import Normal


def test_the_autocorrelation_time_of_an_autoregressive_chain_is_known():
    """x' = ρ x + noise has the time (1 + ρ)/(1 - ρ)."""
    random = np.random.default_rng(0)
    for coefficient in (0.0, 0.5, 0.8):
        chain = np.zeros((2, 4000, 16))
        for step in range(1, 4000):
            chain[:, step] = coefficient * chain[:, step - 1] + random.standard_normal((2, 16))
        expected = (1 + coefficient) / (1 - coefficient)
        assert _autocorrelation_time(chain + 7.0) == pytest.approx(expected, rel=0.06)
    alternating = np.tile(np.array([1.0, -1.0]), 200).reshape(1, 400, 1)
    assert _autocorrelation_time(alternating) == 1.0  # at least one


def test_r_hat_compares_halves_of_the_ensembles():
    """Two steps a half: within-variance and between-variance by hand."""
    chains = np.array([[[0.0], [2.0], [1.0], [3.0]], [[4.0], [6.0], [5.0], [7.0]]])
    halves = np.array([[0.0, 2.0], [4.0, 6.0], [1.0, 3.0], [5.0, 7.0]])
    within = halves.var(axis=1, ddof=1).mean()
    variance = within / 2 + halves.mean(axis=1).var(ddof=1)
    assert _r_hat(chains) == pytest.approx(np.sqrt(variance / within), rel=1e-12)
    odd = np.concatenate([chains[:, :2], np.full((2, 1, 1), 99.0), chains[:, 2:]], axis=1)
    assert _r_hat(odd) == pytest.approx(_r_hat(chains), rel=1e-12)
    alike = np.random.default_rng(1).standard_normal((2, 500, 8))
    assert _r_hat(alike) == pytest.approx(1.0, abs=2e-3)
    alike[1] += 1.0
    assert _r_hat(alike) > 1.05


def test_proposals_follow_students_t_about_the_centre():
    covariance = np.array([[2.0, 0.6], [0.6, 1.0]])
    proposal = _StudentProposal(np.array([1.0, -2.0]), np.linalg.cholesky(covariance))
    reference = stats.multivariate_t(proposal.centre, covariance, df=5.0)
    theta = np.array([[1.0, -2.0], [3.0, 0.0], [-2.0, 1.0]])
    density = proposal.log_density(theta)
    np.testing.assert_allclose(density - density[0], reference.logpdf(theta) - reference.logpdf(theta[0]), rtol=1e-10)
    draws = proposal.draw(6000, np.random.RandomState(3))
    standard = np.linalg.solve(proposal.root, (draws - proposal.centre).T)
    for row in standard:
        assert stats.kstest(row, stats.t(5.0).cdf).pvalue > 0.01
    assert np.corrcoef(draws.T)[0, 1] == pytest.approx(0.6 / np.sqrt(2.0), abs=0.05)
    new, ratio = proposal(theta, np.random.RandomState(4))
    np.testing.assert_allclose(ratio, proposal.log_density(theta) - proposal.log_density(new), rtol=1e-12)


def test_the_band_of_samples_is_their_central_interval():
    samples = np.stack([np.linspace(0.0, 1.0, 1001), np.linspace(5.0, 3.0, 1001)], axis=1)
    ones = {"a": 1.0, "b": CONVERGED}
    result = Posterior(("a", "b"), samples, 0.4, ones, ones, ones)
    assert result.band("a") == pytest.approx((0.025, 0.975))
    assert result.band("b", 0.5) == pytest.approx((3.5, 4.5))
    assert result.median("b") == pytest.approx(4.0)
    assert result.converged
    assert not Posterior(("a",), samples, 0.4, ones, ones, {"a": CONVERGED + 1e-6}).converged
    summary = result.summary()
    assert summary["samples"] == 1001
    assert summary["estimates"][0] == pytest.approx({"name": "a", "median": 0.5, "low": 0.025, "high": 0.975}, abs=1e-9)


def test_the_posterior_of_a_number_without_data_is_its_prior():
    """The ball radius follows from its prior and one value: two normal distributions."""
    pytest.importorskip("emcee")
    joint, model = bs.joints["hess-forsbach"], bs.HessForsbach()
    data = Measured(quantity="ball_radius", values=18.0, uncertainty=0.2)
    result = bs.identify(model, joint, data, {"ball_radius": Normal(mean=17.6, deviation=0.2)})
    assert result.point["ball_radius"] == pytest.approx(17.8)
    samples = posterior(result, 400, seed=3)
    assert samples.samples.shape == (400, 1)
    assert samples.samples.mean() == pytest.approx(17.8, abs=0.03)
    assert samples.samples.std() == pytest.approx(0.2 / np.sqrt(2.0), rel=0.15)
    assert samples.effective["ball_radius"] >= 400
    assert 0.3 < samples.acceptance <= 1.0
    np.testing.assert_array_equal(result.posterior(400, seed=3).samples, samples.samples)
    with pytest.raises(ValueError, match="samples = 99 is not allowed: a posterior has 100 samples or more"):
        result.posterior(99)
