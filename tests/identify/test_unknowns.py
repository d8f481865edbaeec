"""Unknowns, their priors, and the transform to scaled parameters."""

from math import inf, log, sqrt

import numpy as np
import pytest

from ballsocket.identify import Machine
from ballsocket.identify.unknowns import ParameterTransform, collect_unknowns, log_prior
from ballsocket.studies import LogNormal, Normal, Rectangular

from .rigid import MODEL


def unknown_of(name, prior, machines=()):
    return collect_unknowns({name: prior}, machines, MODEL)[0]


RANGE = unknown_of("clearance", (0.02, 0.3))
LINEAR = unknown_of("clearance", (0.0, 0.3))
POISSON = unknown_of("liner_poisson", (0.3, 0.48))
NORMAL = unknown_of("liner.young", Normal(mean=900.0, deviation=50.0))
FACTOR = unknown_of("clearance", LogNormal(median=0.1, factor=1.2))
ALL = ParameterTransform((RANGE, POISSON, NORMAL, FACTOR))
VALUES = np.array([[0.05, 0.4, 860.0, 0.09], [0.2, 0.31, 1000.0, 0.13]])


def test_a_range_above_zero_is_searched_on_a_logarithmic_scale():
    assert [unknown.logarithmic for unknown in (RANGE, FACTOR, LINEAR, POISSON, NORMAL)] == [True, True, *[False] * 3]
    assert [unknown.has_distribution for unknown in (RANGE, POISSON, NORMAL, FACTOR)] == [False, False, True, True]
    assert not any(unknown.of_machine for unknown in ALL.unknowns)


def test_spans_and_middles_are_the_deviations_and_scaled_means_of_the_priors():
    deviations = [unknown.prior_deviation for unknown in (RANGE, LINEAR, NORMAL, FACTOR)]
    assert deviations == pytest.approx([log(15.0) / sqrt(12), 0.3 / sqrt(12), 50.0, log(1.2)])
    means = [unknown.prior_mean for unknown in (RANGE, NORMAL, FACTOR)]
    assert means == pytest.approx([0.0, 18.0, log(0.1) / log(1.2)])


def test_theta_is_the_scaled_value_over_the_span():
    theta = ALL.to_theta(VALUES)
    scaled = VALUES.copy()
    scaled[:, [0, 3]] = np.log(VALUES[:, [0, 3]])
    np.testing.assert_allclose(theta, scaled / [unknown.prior_deviation for unknown in ALL.unknowns], rtol=1e-14)
    np.testing.assert_allclose(ALL.to_values(theta), VALUES, rtol=1e-13)
    np.testing.assert_allclose(ALL.low, ALL.to_theta([unknown.low for unknown in ALL.unknowns]))
    assert ALL.names == ("clearance", "liner_poisson", "liner_young", "clearance")


def test_derivatives_are_those_of_the_values():
    theta, step = ALL.to_theta(VALUES), 1e-6
    for index in range(4):
        shift = step * np.eye(4)[index]
        slope = (ALL.to_values(theta + shift) - ALL.to_values(theta - shift)) / (2 * step)
        np.testing.assert_allclose(ALL.derivatives(theta)[:, index], slope[:, index], rtol=1e-7)


def test_prior_residuals_count_standard_deviations_from_the_mean():
    residuals = ALL.prior_residuals(ALL.to_theta(VALUES))
    np.testing.assert_allclose(residuals[:, :2], 0.0)
    np.testing.assert_allclose(residuals[:, 2], [-0.8, 2.0], rtol=1e-12)
    np.testing.assert_allclose(residuals[:, 3], np.log([0.9, 1.3]) / log(1.2), rtol=1e-12)


def test_the_log_prior_is_flat_in_the_value_of_a_range():
    transform = ParameterTransform((RANGE,))
    theta = transform.to_theta([[0.03], [0.06]])
    density = log_prior(transform, theta)
    assert density[1] - density[0] == pytest.approx(log(2.0))  # d value / d theta grows with the value
    assert log_prior(transform, transform.to_theta([[0.019], [0.31]])).tolist() == [-inf, -inf]
    assert np.isfinite(log_prior(transform, np.stack([transform.low, transform.high]))).all()


def test_the_log_prior_of_a_distribution_is_minus_half_the_squared_distance():
    transform = ParameterTransform((NORMAL, FACTOR))
    theta = transform.to_theta([[900.0, 0.1], [950.0, 0.1], [900.0, 0.144]])
    np.testing.assert_allclose(log_prior(transform, theta), [0.0, -0.5, -2.0], atol=1e-9)


def test_distributions_are_searched_within_eight_standard_deviations_of_allowed_values():
    assert (NORMAL.low, NORMAL.high) == (500.0, 1300.0)
    assert (FACTOR.low, FACTOR.high) == pytest.approx((0.1 / 1.2**8, 0.1 * 1.2**8))
    cut = unknown_of("liner_young", Normal(mean=900.0, deviation=50.0, low=850.0, high=1000.0))
    assert (cut.low, cut.high) == (850.0, 1000.0)
    assert unknown_of("liner_young", Normal(mean=900.0, deviation=300.0)).low == pytest.approx(0.9)
    assert unknown_of("liner_poisson", Normal(mean=0.45, deviation=0.02)).high == 0.5


def test_a_physical_limit_is_an_end_beyond_which_no_value_is_allowed():
    compliance = collect_unknowns({}, [Machine(compliance=(0.0, 1e-5), offset=(0.0, 0.01))], MODEL)
    low = compliance[0].to_scale(0.0) / compliance[0].prior_deviation
    assert compliance[0].is_physical(-1, low)
    assert not compliance[0].is_physical(-1, low + 1e-3)
    assert not compliance[0].is_physical(1, compliance[0].high / compliance[0].prior_deviation)
    assert not compliance[1].is_physical(-1, 0.0)  # an offset may be negative
    poisson = unknown_of("liner_poisson", (0.3, 0.5))
    assert poisson.is_physical(1, 0.5 / poisson.prior_deviation)
    assert not POISSON.is_physical(1, 0.48 / POISSON.prior_deviation)


def test_unknowns_are_those_of_the_joint_and_then_those_of_machines():
    machines = [Machine(drift=(-1e-3, 1e-3), compliance=(0.0, 1e-5), name="a"), Machine(name="b"), Machine(name="")]
    unknowns = collect_unknowns({"clearance": (0.1, 0.2)}, [*machines, machines[0]], MODEL)
    assert [unknown.name for unknown in unknowns] == ["clearance", "a.compliance", "a.drift"]
    assert [unknown.of_machine for unknown in unknowns] == [False, True, True]
    assert isinstance(unknowns[0].prior, Rectangular)
