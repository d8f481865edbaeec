"""Models of scatter against SciPy, convergence of Markov chains, and a posterior with a closed form."""

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

import ballsocket as bs
from ballsocket.identification import HeavyTailed, Measured, NormalScatter
from ballsocket.identification.posterior import _autocorrelation_time, _r_hat
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
    """Two steps a half: within-variance and between-variance by hand; the middle one of an odd number is left out."""
    chains = np.array([[[0.0], [2.0], [1.0], [3.0]], [[4.0], [6.0], [5.0], [7.0]]])
    halves = np.array([[0.0, 2.0], [4.0, 6.0], [1.0, 3.0], [5.0, 7.0]])
    within = halves.var(axis=1, ddof=1).mean()
    variance = within / 2 + halves.mean(axis=1).var(ddof=1)
    for ensemble in (chains, np.insert(chains, 2, 99.0, axis=1)):
        assert _r_hat(ensemble) == pytest.approx(np.sqrt(variance / within), rel=1e-12)
    alike = np.random.default_rng(1).standard_normal((2, 500, 8))
    assert _r_hat(alike) == pytest.approx(1.0, abs=2e-3)
    alike[1] += 1.0
    assert _r_hat(alike) > 1.05


def test_the_posterior_of_a_number_follows_from_its_prior_and_a_value():
    pytest.importorskip("emcee")
    data = Measured(quantity="ball_radius", values=18.0, uncertainty=0.2)
    free = {"ball_radius": Normal(mean=17.6, deviation=0.2)}
    result = bs.identify(bs.HessForsbach(), bs.joints["hess-forsbach"], data, free)
    assert result.point["ball_radius"] == pytest.approx(17.8)
    posterior = result.posterior(400, seed=3)
    assert posterior.samples.shape == (400, 1)
    assert posterior.samples.mean() == pytest.approx(17.8, abs=0.03)
    assert posterior.samples.std() == pytest.approx(0.2 / np.sqrt(2.0), rel=0.15)
    assert posterior.effective["ball_radius"] >= 400
    assert 0.3 < posterior.acceptance <= 1.0
    np.testing.assert_array_equal(result.posterior(400, seed=3).samples, posterior.samples)
    with pytest.raises(ValueError, match="samples = 99 is not allowed: a posterior has 100 samples or more"):
        result.posterior(99)


Z = np.array([-40.0, -5.0, -1.3, -0.2, 0.0, 1e-7, 0.4, 2.0, 6.0, 30.0])
CASES = [
    (NormalScatter(), stats.norm()),
    (HeavyTailed(), stats.t(4.0)),
    (HeavyTailed(degrees=1.5), stats.t(1.5)),
    (HeavyTailed(degrees=40.0), stats.t(40.0)),
]
each_scatter = pytest.mark.parametrize(("scatter", "reference"), CASES, ids=["normal", "t4", "t1.5", "t40"])


def numeric_slope(function, z):
    step = 1e-6 * np.maximum(1.0, abs(z))
    return (function(z + step) - function(z - step)) / (2 * step)


@each_scatter
def test_half_the_squared_misfit_is_minus_the_log_density_with_its_slope(scatter, reference):
    expected = reference.logpdf(0.0) - reference.logpdf(Z)
    np.testing.assert_allclose(scatter.misfit(Z) ** 2 / 2, expected, rtol=1e-12, atol=1e-13)
    assert np.all(np.sign(scatter.misfit(Z)) == np.sign(Z))
    np.testing.assert_allclose(scatter.slope(Z), numeric_slope(scatter.misfit, Z), rtol=1e-7)


@each_scatter
def test_a_lower_bound_has_the_probability_of_the_distribution_function(scatter, reference):
    z = Z[Z < 8.0]
    residual, slope = scatter.censored(z)
    np.testing.assert_allclose(residual**2 / 2, -reference.logcdf(z), rtol=1e-9)
    np.testing.assert_allclose(slope, numeric_slope(lambda x: scatter.censored(x)[0], z), rtol=1e-4, atol=1e-9)
    assert residual.min() >= 0.0 >= slope.max()
    residual, slope = scatter.censored(np.array([1e30]))  # far below the result
    assert residual == pytest.approx(0.0, abs=1e-12)
    assert np.isfinite(slope).all()


@each_scatter
def test_the_information_is_the_mean_square_of_the_score_and_draws_follow_the_distribution(scatter, reference):
    def integrand(z):
        point = np.array([z])
        return float(reference.pdf(z) * (scatter.misfit(point) * scatter.slope(point))[0] ** 2)

    assert scatter.information == pytest.approx(quad(integrand, -np.inf, np.inf)[0], rel=1e-6)
    draws = scatter.draw(4000, np.random.default_rng(2))
    assert draws.shape == (4000,)
    assert stats.kstest(draws, reference.cdf).pvalue > 0.01
