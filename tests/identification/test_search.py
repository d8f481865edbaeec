"""Loads read by a machine, points without a result; search, ends of bands and products on a linear problem."""

from dataclasses import dataclass, replace
from math import log, sqrt

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.quantities import QUANTITIES
from ballsocket.identification import Machine, Measured
from ballsocket.identification.bands import profile_ends
from ballsocket.identification.fit import find_best_fit
from ballsocket.identification.forward_model import ForwardModel
from ballsocket.identification.information import (
    MAX_WIDTH_RATIO,
    QUANTILE_95,
    Information,
    ProfileEnd,
    ProfileInterval,
)
from ballsocket.identification.misfit import Misfit, by_differences
from ballsocket.identification.scatter import NormalScatter
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


def linear_misfit(noise=0.0, unknowns=None, matrix=MATRIX):
    """Return the misfit of five values, shifted by 5 so that none is negative."""
    values = matrix @ TRUTH[: matrix.shape[1]] + noise
    data = Measured(quantity="force", values=values + 5.0, uncertainty=0.02, indentation=np.ones(5))
    object.__setattr__(data, "values", values)
    transform = ParameterTransform(tuple(unknowns or map(unknown, NAMES)))
    return Misfit(LinearForward((data,), matrix), transform, NormalScatter(), by_differences, np.full(5, 0.02))


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


NOISE = np.array([0.03, -0.01, 0.02, -0.04, 0.01])


def fitted(*settings):
    misfit = linear_misfit(*settings)
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
    slopes = MATRIX * [unknown.prior_deviation for unknown in misfit.transform.unknowns] / 0.02
    deviations = np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
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
