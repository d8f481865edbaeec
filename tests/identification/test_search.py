"""Forward model, misfit and derivatives against presses; search, bands and information on a linear problem."""

from dataclasses import dataclass, replace
from math import log, sqrt

import numpy as np
import pytest
from scipy import stats

import ballsocket as bs
from ballsocket.core.quantities import QUANTITIES
from ballsocket.identification import Machine, Measured
from ballsocket.identification.bands import compute_bands, profile_ends, scatter_ratio
from ballsocket.identification.fit import find_best_fit
from ballsocket.identification.forward_model import ForwardModel
from ballsocket.identification.information import (
    MAX_WIDTH_RATIO,
    QUANTILE_95,
    QUANTILE_99,
    Information,
    ProfileEnd,
    ProfileInterval,
)
from ballsocket.identification.misfit import FitResult, Misfit, by_differences
from ballsocket.identification.scatter import HeavyTailed, NormalScatter
from ballsocket.identification.unknowns import ParameterTransform, Unknown, collect_unknowns
from ballsocket.studies import Normal, Rectangular

from .rigid import JOINT, MODEL

MATRIX = np.array([[1.0, 0.5], [0.3, 2.0], [-1.0, 1.0], [0.5, 0.5], [2.0, -0.3]])
TRUTH = np.array([0.1, -0.2])
NAMES = ("liner_poisson", "ball_poisson")


@dataclass(frozen=True)
class LinearForward:
    data: tuple
    matrix: np.ndarray
    model: object = bs.HessForsbach()

    def results_at(self, values, load_perturbation=0.0):
        return values @ self.matrix.T * (1 + load_perturbation)


def unknown(name, prior=None, low=-0.9, high=0.45):
    prior = prior or Rectangular(low=low, high=high)
    return Unknown(name=name, quantity=QUANTITIES[name], prior=prior, low=low, high=high, logarithmic=False)


def linear_misfit(noise=0.0, unknowns=None, scatter=None, matrix=MATRIX, uncertainty=0.02, saturation=np.inf):
    """Return the misfit of five values, shifted by 5 so that none is negative."""
    values = matrix @ TRUTH[: matrix.shape[1]] + noise
    data = Measured(quantity="force", values=values + 5.0, uncertainty=uncertainty, indentation=np.ones(5))
    object.__setattr__(data, "values", values)
    object.__setattr__(data, "saturation", saturation)
    forward = LinearForward((data,), matrix)
    transform = ParameterTransform(tuple(unknowns or map(unknown, NAMES)))
    return Misfit(forward, transform, scatter or NormalScatter(), by_differences, np.full(5, uncertainty))


def scaled_covariance(misfit, uncertainty=0.02):
    slopes = MATRIX * [unknown.prior_deviation for unknown in misfit.transform.unknowns] / uncertainty
    return np.linalg.inv(slopes.T @ slopes)


def forward(*data, names=("clearance", "liner_young"), model=MODEL):
    return ForwardModel(model, JOINT, data, names)


@pytest.mark.parametrize("quantity", ["force", "area"])
def test_loads_read_by_a_compliant_machine_are_corrected_exactly(quantity):
    """Newton's method finds the force whose reading is the measured indentation."""
    machine, force = Machine(compliance=8e-6, offset=-0.004, drift=3e-4), np.array([300.0, 1200.0, 2500.0])
    contact = MODEL.press(JOINT.replace(clearance=0.08, liner=bs.Material(young=900.0, poisson=0.4)), force=force)
    reading = contact.indentation + 8e-6 * force - 0.004 + 3e-4 * np.arange(3.0)
    values = 1.1 * getattr(contact, quantity)  # a measured force is the start of the iterations
    data = Measured(quantity=quantity, values=values, uncertainty=1.0, indentation=reading, machine=machine)
    tolerance = 3e-8 if quantity == "force" else 3e-5
    results = forward(data).results_at(np.array([[0.08, 900.0]]))[0]
    np.testing.assert_allclose(results, getattr(contact, quantity), rtol=tolerance)


@pytest.mark.parametrize(("quantity", "compliance"), [("force", 0.0), ("area", 1e-6)])
def test_a_value_of_zero_is_read_below_the_zero_of_the_machine(quantity, compliance):
    machine = Machine(offset=0.002, compliance=compliance)
    data = Measured(quantity=quantity, values=[0.0], uncertainty=1.0, indentation=[0.001], machine=machine)
    assert forward(data).results_at(np.array([[0.08, 900.0]])).tolist() == [[0.0]]


def test_a_point_without_a_joint_or_a_result_is_nan_and_costs_infinitely_much():
    depths = Measured(quantity="indentation", values=np.ones(3), uncertainty=0.1, force=[300.0, 1200.0, 2500.0])
    data = depths, Measured(quantity="clearance", values=0.1, uncertainty=0.1)
    rows = forward(*data, names=("outer_radius", "ball_radius")).results_at(np.array([[15.0, 16.0], [22.1, 16.0]]))
    assert np.isnan(rows).tolist() == [[True] * 4, [False] * 4]
    tabulated = forward(*data, names=("liner_thickness",), model=bs.Tabulated())
    assert np.isnan(tabulated.results_at(np.array([[0.01], [5.0]]))).tolist() == [[True] * 3 + [False], [False] * 4]
    transform = ParameterTransform(collect_unknowns({"liner_thickness": (0.01, 6.0)}, (), MODEL))
    problem = Misfit(tabulated, transform, NormalScatter(), by_differences, np.full(4, 0.1))
    theta = transform.to_theta([[0.01], [5.0]])
    assert np.isinf(problem.costs(theta)).tolist() == [True, False]
    assert problem.log_posterior(theta[:1]).tolist() == [-np.inf]


@pytest.mark.parametrize("z", [-1.5, -0.3, 0.6, 20.0])
@pytest.mark.parametrize("scatter", [NormalScatter(), HeavyTailed()], ids=["normal", "heavy-tailed"])
def test_the_information_of_lower_bounds_is_the_curvature_of_the_cost(scatter, z):
    """It is none far above the bound."""
    linear = linear_misfit(saturation=-10.0, scatter=scatter)
    object.__setattr__(linear, "value", MATRIX @ TRUTH - 0.02 * z)
    theta, h = linear.transform.to_theta(TRUTH), 2e-3
    above, below = (linear.costs(theta + side * h * np.eye(2)) for side in (1, -1))
    curvature = np.maximum((above - 2 * linear.costs(theta[None]) + below) / h**2, 0.0)
    slopes, weighted = linear.weighted_slopes(theta)
    information = np.diag(weighted @ slopes)
    np.testing.assert_allclose(information, curvature, rtol=1e-3, atol=1e-6 if z == 20.0 else 0.0)


NOISE = np.array([0.03, -0.01, 0.02, -0.04, 0.01])


def fitted(*settings, **options):
    misfit = linear_misfit(*settings, **options)
    return misfit, find_best_fit(misfit, seed=0)


def test_the_best_fit_is_the_least_squares_solution_with_a_prior_as_one_more_value():
    misfit, best = fitted(NOISE)
    expected, squares, *_ = np.linalg.lstsq(MATRIX, MATRIX @ TRUTH + NOISE, rcond=None)
    np.testing.assert_allclose(misfit.transform.to_values(best.theta), expected, atol=1e-9)
    assert best.cost == pytest.approx(squares[0] / 2 / 0.02**2, rel=1e-9)
    assert (best.converged, best.rivals, misfit.freedom) == (True, (), 3)
    prior = Normal(mean=0.0, deviation=0.005)
    misfit, best = fitted(NOISE, (unknown(NAMES[0], prior, -0.04, 0.04), unknown(NAMES[1])))
    rows = np.vstack([MATRIX / 0.02, [[1 / 0.005, 0.0]]])
    values = np.append((MATRIX @ TRUTH + NOISE) / 0.02, 0.0)
    expected = np.linalg.lstsq(rows, values, rcond=None)[0]
    np.testing.assert_allclose(misfit.transform.to_values(best.theta), expected, atol=1e-9)
    assert misfit.freedom == 4


def test_two_valleys_of_equal_depth_are_rivals():
    """A residual that depends on the square of the unknown has two solutions."""

    class Square(LinearForward):
        def results_at(self, values, load_perturbation=0.0):
            return values**2 @ self.matrix.T

    misfit = linear_misfit(unknowns=(unknown(NAMES[0], low=-0.4, high=0.4),), matrix=MATRIX[:, :1])
    square = replace(misfit, forward=Square(misfit.forward.data, MATRIX[:, :1]))
    object.__setattr__(square, "value", MATRIX[:, 0] * 0.04)
    best = find_best_fit(square, seed=0)
    valleys = [best.theta, *best.rivals]
    values = square.transform.to_values(np.stack(valleys))[:, 0]
    np.testing.assert_allclose(sorted(values), [-0.2, 0.2], rtol=1e-4)
    ((ends,),) = profile_ends(square, valleys, best.cost, (3.84,)).ends  # of a band that holds both
    low, high = (square.transform.to_values(end.theta)[0] for end in ends)
    assert low < -0.201
    assert high > 0.201


def test_ends_of_profiles_are_at_the_marginal_standard_deviation():
    misfit, best = fitted(NOISE)
    deviations = np.sqrt(np.diag(scaled_covariance(misfit)))
    profiles = profile_ends(misfit, [best.theta], best.cost, (1.0, 9.0))
    for rise, row in zip((1.0, 9.0), profiles.ends, strict=True):
        for index, ends in enumerate(row):
            for sign, end in zip((-1, 1), ends, strict=True):
                half = sign * (end.theta[index] - best.theta[index])
                assert half == pytest.approx(sqrt(rise) * deviations[index], rel=0.011)
                assert (end.closed, end.limited_by) == (True, ())
                assert 2 * (misfit.costs(end.theta[None])[0] - best.cost) == pytest.approx(rise, rel=0.021)
    assert profiles.cost == pytest.approx(best.cost, abs=1e-9)
    np.testing.assert_allclose(profiles.lowest, best.theta, atol=1e-6)


def test_the_scatter_ratio_ignores_met_lower_bounds_and_is_the_likeliest_scale_of_a_heavy_tail():
    saturated = linear_misfit(NOISE)
    object.__setattr__(saturated, "saturated", np.ones(5, dtype=bool))
    best = FitResult(saturated.transform.to_theta(TRUTH + 0.3), 0.0, True)
    results = saturated.forward.results_at(saturated.transform.to_values(best.theta[None]))[0]
    z = np.minimum(saturated.standardised_residuals(results), 0.0)
    assert scatter_ratio(saturated, best) == pytest.approx(max(sqrt(np.sum(z**2) / 3), 1.0), rel=1e-5)
    noise = np.array([0.06, -0.07, 0.09, -0.06, 0.5])
    misfit = linear_misfit(noise, scatter=HeavyTailed())
    u = noise / 0.02 / scatter_ratio(misfit, FitResult(misfit.transform.to_theta(TRUTH), 0.0, True))
    assert np.sum(5 * u**2 / (4 + u**2)) == pytest.approx(3.0, rel=1e-4)


def test_bands_use_students_quantile_for_an_improbable_scatter_and_the_normal_one_for_a_probable():
    misfit, best, information = compute_bands(*fitted(NOISE, uncertainty=0.002))
    assert misfit.widening > 3
    assert information.quantile == pytest.approx(float(stats.t.ppf(0.975, 3)))
    deviation = sqrt(scaled_covariance(misfit, uncertainty=0.002)[0, 0]) * misfit.widening
    width = (information.intervals[0].high.theta - information.intervals[0].low.theta)[0]
    assert width == pytest.approx(2 * information.quantile * deviation, rel=0.02)
    expected = np.linalg.inv(scaled_covariance(misfit, uncertainty=0.002)) / misfit.widening**2
    np.testing.assert_allclose(information.matrix, expected)
    assert best.cost == pytest.approx(1.5, rel=1e-4)  # χ² of 3 degrees of freedom, halved
    misfit, _, information = compute_bands(*fitted(0.5 * NOISE))
    assert information.quantile == QUANTILE_95
    assert misfit.widening < 1.5
    np.testing.assert_allclose(information.matrix, np.linalg.inv(scaled_covariance(misfit)) / misfit.widening**2)
    assert stats.norm.ppf([0.975, 0.995]) == pytest.approx([QUANTILE_95, QUANTILE_99], rel=1e-15)


LOG = [replace(unknown("clearance", low=1.0, high=9.0), name=name, logarithmic=True) for name in ("a", "b")]
SPAN = log(9.0) / sqrt(12)
DIAGONAL = np.array([[1.0, -1.0], [1.0, -1.0]]) / sqrt(2)
OPEN = (False, False)


def information_of(
    directions, half_widths, closed=(True, True), limits=((), ()), matrix=((1, 0), (0, 1)), unknowns=LOG
):
    """Return the information of intervals along given directions about the middle of the ranges."""
    transform = ParameterTransform(tuple(unknowns))
    middle = (transform.low + transform.high) / 2
    intervals = tuple(
        ProfileInterval(
            *(ProfileEnd(middle + side * half * np.array(direction), is_closed, limited) for side in (-1, 1)), is_closed
        )
        for direction, half, is_closed, limited in zip(directions, half_widths, closed, limits, strict=True)
    )
    return Information(transform, middle, np.array(matrix), intervals)


def test_a_band_of_half_the_range_or_without_an_end_makes_an_unknown_without_a_distribution_unidentifiable():
    half_range = MAX_WIDTH_RATIO * sqrt(12) / 2
    below = information_of(np.eye(2), (0.99 * half_range, 0.1))
    assert (below.unidentifiable, below.rank, below.products) == ((), 2, ())
    above = information_of(np.eye(2), (1.01 * half_range, 0.1))
    assert (above.unidentifiable, above.rank) == (("a",), 1)
    assert above.deviations["a"] == pytest.approx(0.505)
    assert information_of(np.eye(2), (0.1, 0.1), closed=(True, False)).unidentifiable == ("b",)
    known = replace(LOG[0], prior=Normal(mean=3.0, deviation=1.0))
    information = information_of(np.eye(2), (5.0, 0.1), closed=(False, True), unknowns=(known, LOG[1]))
    assert (information.unidentifiable, information.limited_by("a")) == ((), ())
    assert information.deviations["a"] == pytest.approx(10.0 / (2 * QUANTILE_95))


@pytest.mark.parametrize(("shift", "unidentifiable"), [(0.11, ("a", "b")), (0.09, ("b",))])
def test_an_unknown_that_an_unidentifiable_one_shifts_is_unidentifiable_too(shift, unidentifiable):
    """The band of b shifts a from end to end by a tenth of its range or more."""
    half = 1.7
    directions = np.array([[1.0, 0.0], [shift * sqrt(12) / (2 * half), 1.0]])
    information = information_of(directions, (0.2, half), closed=(True, False), limits=((1,), (1,)))
    assert information.unidentifiable == unidentifiable
    assert information.limited_by("a") == ("b",)
    assert information_of(directions, (0.2, half), closed=(True, False)).unidentifiable == ("b",)


def test_parallel_bands_are_one_product_with_powers_in_halves():
    matrix = 5e3 * np.ones((2, 2))
    information = information_of(DIAGONAL, (2.0, 2.0), OPEN, matrix=matrix)
    assert (information.unidentifiable, information.rank) == (("a", "b"), 1)
    np.testing.assert_allclose(information.eigenvalues, [1e4, 0.0], atol=1e-9)
    assert information.condition == np.inf
    (product,) = information.products
    assert (product.name, product.exponents) == ("a · b", {"a": 1.0, "b": 1.0})
    half = np.exp(QUANTILE_95 * SPAN * sqrt(2 / 1e4))
    assert (product.low, product.value, product.high) == pytest.approx((9.0 / half, 9.0, 9.0 * half), rel=1e-6)
    assert information_of(np.eye(2), (2.0, 2.0), OPEN, matrix=matrix).rank == 0  # perpendicular
    direction = np.array([1.0, 2.02]) / np.linalg.norm([1.0, 2.02])
    across = np.array([[direction[1], -direction[0]]] * 2)
    information = information_of(across, (2.0, 2.0), OPEN, matrix=1e4 * np.outer(direction, direction))
    (product,) = information.products
    assert (product.name, product.unit, product.exponents) == ("a^0.5 · b", "mm^0.5 mm", {"a": 0.5, "b": 1.0})
    keys = ("name", "exponents", "unit", "value", "low", "high")
    assert product.summary() == {key: getattr(product, key) for key in keys}
    assert information_of(np.eye(2)[[1, 1]], (2.0, 2.0), OPEN, matrix=[[1e4, 0.0], [0.0, 0.0]]).products == ()  # of one
    assert information_of(DIAGONAL, (2.0, 2.0), OPEN, matrix=0.5 * np.ones((2, 2))).products == ()  # too wide


def test_the_covariance_combines_data_and_ranges():
    """The data hold one direction; the range counts in unidentifiable unknowns."""
    matrix = np.array([[3.0, 1.0], [1.0, 2.0]])
    identified = information_of(np.eye(2), (0.1, 0.1), matrix=matrix)
    np.testing.assert_allclose(identified.covariance, np.linalg.inv(matrix), rtol=1e-12)
    assert identified.condition == pytest.approx(np.linalg.cond(matrix))
    free = information_of(DIAGONAL, (2.0, 2.0), OPEN, matrix=8.0 * np.ones((2, 2)))
    np.testing.assert_allclose(free.covariance, np.linalg.inv(8.0 * np.ones((2, 2)) + np.eye(2)), rtol=1e-12)
