"""Models of scatter against SciPy's distributions."""

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

from ballsocket.identify import HeavyTailed, NormalScatter

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
    assert scatter.constant == pytest.approx(float(reference.logpdf(0.0)), rel=1e-14)
    np.testing.assert_allclose(scatter.slope(Z), numeric_slope(scatter.misfit, Z), rtol=1e-7)


@each_scatter
def test_a_lower_bound_has_the_probability_of_the_distribution_function(scatter, reference):
    z = Z[Z < 8.0]
    residual, slope = scatter.censored(z)
    np.testing.assert_allclose(residual**2 / 2, -reference.logcdf(z), rtol=1e-9)
    assert np.all(residual >= 0.0)
    np.testing.assert_allclose(slope, numeric_slope(lambda x: scatter.censored(x)[0], z), rtol=1e-4, atol=1e-9)
    assert np.all(slope <= 0.0)


def test_a_lower_bound_far_below_the_result_costs_nothing():
    for scatter in (NormalScatter(), HeavyTailed()):
        residual, slope = scatter.censored(np.array([1e30]))
        assert residual == pytest.approx(0.0, abs=1e-12)
        assert np.isfinite(slope).all()
    residual, slope = NormalScatter().censored(np.array([50.0]))
    assert (residual[0], slope[0]) == (0.0, 0.0)


@each_scatter
def test_the_information_is_the_mean_square_of_the_score(scatter, reference):
    def integrand(z):
        point = np.array([z])
        return float(reference.pdf(z) * (scatter.misfit(point) * scatter.slope(point))[0] ** 2)

    assert scatter.information == pytest.approx(quad(integrand, -np.inf, np.inf)[0], rel=1e-6)


@each_scatter
def test_draws_follow_the_distribution(scatter, reference):
    draws = scatter.draw(4000, np.random.default_rng(2))
    assert draws.shape == (4000,)
    assert stats.kstest(draws, reference.cdf).pvalue > 0.01
