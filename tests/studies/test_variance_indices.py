"""Sobol indices, Shapley effects and their intervals against analytic values."""

from itertools import combinations
from math import comb, pi

import numpy
import pytest
from scipy import stats

import ballsocket as bs
from ballsocket.studies.distributions import LogNormal, Normal, Rectangular, copula_matrix
from ballsocket.studies.run import study
from ballsocket.studies.variance_indices import shapley_effects, sobol_indices
from ballsocket.studies.variance_shares import sensitivity

from ..extent import either

UNIFORM, NORMAL = Rectangular(low=-pi, high=pi), Normal(mean=0.0, deviation=1.0)
HIP = bs.joints["hess-forsbach"]


def ishigami(x, a=7.0, b=0.1):
    """Function of Ishigami and Homma 1990 at x, shape (3, n)."""
    return (numpy.sin(x[0]) + a * numpy.sin(x[1]) ** 2 + b * x[2] ** 4 * numpy.sin(x[0]))[None]


def ishigami_shares(a=7.0, b=0.1):
    """First-order indices and the only interaction, of the first and third parameter."""
    variance = a**2 / 8 + b * pi**4 / 5 + b**2 * pi**8 / 18 + 1 / 2
    first = [(1 + b * pi**4 / 5) ** 2 / 2, a**2 / 8, 0.0]
    return [part / variance for part in first], 8 * b**2 * pi**8 / 225 / variance


def linear_shares(slopes, matrix):
    """Shares of a linear function of normal parameters that each subset explains."""
    size, total = len(slopes), slopes @ matrix @ slopes
    shares = {(): 0.0}
    for subset in (list(chosen) for n in range(1, size + 1) for chosen in combinations(range(size), n)):
        covariance = slopes @ matrix[:, subset]
        shares[tuple(subset)] = covariance @ numpy.linalg.solve(matrix[numpy.ix_(subset, subset)], covariance) / total
    return shares


@pytest.mark.parametrize("count", [4096, 5000])
def test_indices_of_ishigami_are_the_analytic_ones_for_any_count(count):
    first, interaction = ishigami_shares()
    found = sobol_indices(ishigami, [UNIFORM] * 3, count, seed=1, confidence=0.95, second_order=True)
    total = [first[0] + interaction, first[1], interaction]
    assert found["first_order"][0] == pytest.approx(first, abs=0.01)
    assert found["total_order"][0] == pytest.approx(total, abs=0.01)
    pairs = found["second_order"][0]
    assert [pairs[0, 1], pairs[0, 2], pairs[1, 2]] == pytest.approx([0.0, interaction, 0.0], abs=0.01)
    assert numpy.isnan(numpy.diag(pairs)).all()
    for name, truth in (("first_order", first), ("total_order", total)):
        assert (found[f"{name}_low"][0] < truth).all()
        assert (truth < found[f"{name}_high"][0]).all()


def test_nine_of_ten_intervals_hold_the_true_index():
    """Of a linear function; Sobol points are more even than the random ones that the bootstrap assumes."""
    first = numpy.array([1.0, 4.0]) / 5
    held = []
    for seed in range(either(quick=30, long=60)):
        found = sobol_indices(lambda x: (x[0] + 2 * x[1])[None], [NORMAL] * 2, 64, seed, 0.9)
        held.append((found["first_order_low"][0] <= first) & (first <= found["first_order_high"][0]))
    assert numpy.mean(held) > 0.85


def test_correlated_parameters_share_the_variance_of_a_linear_function_as_theory_says():
    """See Owen & Prieur 2017, SIAM/ASA J. Uncertain. Quantif. 5, 986, for the Shapley effects of linear functions."""
    slopes = numpy.array([1.0, 2.0, -1.5])
    matrix = numpy.array([[1.0, 0.5, 0.0], [0.5, 1.0, -0.3], [0.0, -0.3, 1.0]])
    found = shapley_effects(lambda x: (slopes @ x)[None], [NORMAL] * 3, matrix, 4096, 0, 0.95)
    shares = linear_shares(slopes, matrix)
    shapley = numpy.zeros(3)
    for i in range(3):
        for subset in (chosen for n in range(3) for chosen in combinations({0, 1, 2} - {i}, n)):
            shapley[i] += (shares[tuple(sorted((*subset, i)))] - shares[subset]) / (3 * comb(2, len(subset)))
    total = [1 - shares[tuple(j for j in range(3) if j != i)] for i in range(3)]
    for name, truth in (("shapley", shapley), ("first_order", [shares[i,] for i in range(3)]), ("total_order", total)):
        assert found[name][0] == pytest.approx(truth, abs=2e-3)
        assert (found[f"{name}_low"][0] < truth).all()
        assert (truth < found[f"{name}_high"][0]).all()
    assert found["shapley"][0].sum() == pytest.approx(1.0, abs=1e-12)


def test_without_correlation_shapley_effects_lie_between_first_and_total_order():
    first, interaction = ishigami_shares()
    found = shapley_effects(ishigami, [UNIFORM] * 3, numpy.eye(3), 8192, 0, None)
    expected = [first[0] + interaction / 2, first[1], interaction / 2]
    assert found["shapley"][0] == pytest.approx(expected, abs=0.01)


def test_samples_have_the_rank_correlation_and_their_own_distributions():
    spreads = {"clearance": LogNormal(median=0.1, factor=1.5), "liner_young": Rectangular(low=700.0, high=1100.0)}
    pair = ("liner_young", "clearance")
    design = bs.studies.sample(8192, correlation={pair: -0.7}, **spreads)
    values = design.values_in([slice(None)])
    assert stats.spearmanr(values["clearance"], values["liner_young"]).statistic == pytest.approx(-0.7, abs=0.01)
    for name, spread in spreads.items():
        assert stats.kstest(values[name], spread.frozen.cdf).statistic < 0.01
    pressed = study(bs.HessForsbach(), HIP, design * bs.studies.grid(force=1000.0))
    assert '"correlation": [[["liner_young", "clearance"], -0.7]]' in pressed.attrs["design"]


def test_a_power_of_correlated_log_normal_parameters_has_analytic_first_order_indices():
    """Hertz: δ is a power of force and modulus; its logarithm is normal, from which the shares of δ follow."""
    spread = {"force": LogNormal(median=1000.0, factor=1.1), "liner_young": LogNormal(median=1000.0, factor=1.2)}
    pair = {("force", "liner_young"): 0.5}
    indices = sensitivity(bs.Hertz(), HIP, spread, quantities=["indentation"], count=1024, correlation=pair)
    found, matrix = indices.sel(quantity="indentation"), copula_matrix(list(spread), pair)
    slopes = found.elasticity.values * numpy.log([1.1, 1.2])
    variance = slopes @ matrix @ slopes
    first = numpy.expm1((slopes @ matrix) ** 2) / numpy.expm1(variance)
    assert found.first_order.values == pytest.approx(first, abs=0.02)
    assert found.shapley.values.sum() == pytest.approx(1.0)
