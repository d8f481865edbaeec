"""Forward model, residuals and derivatives against presses by hand."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import Machine, Measured, oscillation
from ballsocket.identify.forward_model import ForwardModel
from ballsocket.identify.misfit import Misfit, by_differences
from ballsocket.identify.scatter import HeavyTailed, NormalScatter
from ballsocket.identify.unknowns import ParameterTransform, collect_unknowns, log_prior
from ballsocket.studies import Normal

from .linear_problem import MATRIX, NAMES, TRUTH, linear_misfit, unknown
from .rigid import JOINT, MODEL

FORCE = np.array([300.0, 1200.0, 2500.0])
VALUES = np.array([[0.08, 900.0], [0.12, 1100.0]])
JOINTS = [
    JOINT.replace(clearance=clearance, liner=bs.Material(young=young, poisson=0.4)) for clearance, young in VALUES
]


def forward(*data, names=("clearance", "liner_young"), model=MODEL):
    return ForwardModel(model, JOINT, data, names)


def measured(quantity, values=(1.0, 1.0, 1.0), **settings):
    settings = {"force": FORCE, "uncertainty": 0.1, **settings}
    return Measured(quantity=quantity, values=values, **settings)


def test_results_are_those_of_single_presses_in_the_order_of_the_data():
    data = (
        measured("indentation"),
        Measured(quantity="diametral_clearance", values=[0.2, 0.2], uncertainty=0.01),
        Measured(quantity="force", values=[1.0, 1.0], uncertainty=1.0, indentation=[0.01, 0.03]),
        measured("pressure", angle=[0.0, 0.1, 0.2]),
        Measured(quantity="area", values=[1.0], uncertainty=1.0, half_angle=[0.3]),
        measured("frequency", observable=oscillation(2.0)),
        Measured(quantity="liner_young", values=900.0, uncertainty=5.0),
        Measured(quantity="ball_radius", values=16.0, uncertainty=0.1),
    )
    for row, joint in zip(forward(*data).results_at(VALUES), JOINTS, strict=True):
        contact = MODEL.press(joint, force=FORCE)
        expected = [
            contact.indentation,
            [2 * joint.clearance] * 2,
            MODEL.press(joint, indentation=np.array([0.01, 0.03])).force,
            contact.pressure(np.array([0.0, 0.1, 0.2])),
            MODEL.press(joint, half_angle=np.array([0.3])).area,
            oscillation(2.0).read(contact),
            [joint.liner.young, 16.0],
        ]
        np.testing.assert_allclose(row, np.concatenate(expected), rtol=1e-12)


def test_a_perturbation_changes_every_load_by_its_fraction():
    by_depth = Measured(quantity="force", values=FORCE, uncertainty=1.0, indentation=[0.01, 0.02, 0.03])
    read = replace(by_depth, machine=Machine(offset=0.001))
    depth = 1.01 * by_depth.indentation
    for data, load, result in (
        (measured("indentation"), {"force": 1.01 * FORCE}, "indentation"),
        (by_depth, {"indentation": depth}, "force"),
        (read, {"indentation": depth - 0.001}, "force"),
    ):
        row = forward(data).results_at(VALUES[:1], load_perturbation=0.01)[0]
        np.testing.assert_allclose(row, getattr(MODEL.press(JOINTS[0], **load), result), rtol=1e-12)


def test_a_machine_adds_its_errors_to_indentations():
    machine = Machine(compliance=5e-6, offset=0.003, drift=2e-4)
    row = forward(measured("indentation", machine=machine, order=[4.0, 0.0, 2.0])).results_at(VALUES[:1])[0]
    depth = MODEL.press(JOINTS[0], force=FORCE).indentation
    np.testing.assert_allclose(row, depth + 5e-6 * FORCE + 0.003 + 2e-4 * np.array([4.0, 0.0, 2.0]), rtol=1e-12)
    unknown_compliance = Machine(compliance=(0.0, 1e-5), offset=0.003, name="frame")
    model = forward(measured("indentation", machine=unknown_compliance), names=("clearance", "frame.compliance"))
    rows = model.results_at(np.array([[0.1, 2e-6], [0.1, 4e-6]]))
    np.testing.assert_allclose(rows[1] - rows[0], 2e-6 * FORCE, rtol=1e-9)


@pytest.mark.parametrize("quantity", ["force", "area"])
def test_loads_read_by_a_compliant_machine_are_corrected_exactly(quantity):
    """Newton's method finds the force whose reading is the measured indentation."""
    machine = Machine(compliance=8e-6, offset=-0.004, drift=3e-4)
    contact = MODEL.press(JOINTS[0], force=FORCE)
    reading = contact.indentation + 8e-6 * FORCE - 0.004 + 3e-4 * np.arange(3.0)
    values = 1.1 * getattr(contact, quantity)  # a measured force is the start of the iterations
    data = Measured(quantity=quantity, values=values, uncertainty=1.0, indentation=reading, machine=machine)
    tolerance = 3e-8 if quantity == "force" else 3e-5
    np.testing.assert_allclose(forward(data).results_at(VALUES[:1])[0], getattr(contact, quantity), rtol=tolerance)


@pytest.mark.parametrize(("quantity", "compliance"), [("force", 0.0), ("area", 1e-6)])
def test_a_value_of_zero_is_read_below_the_zero_of_the_machine(quantity, compliance):
    machine = Machine(offset=0.002, compliance=compliance)
    data = Measured(quantity=quantity, values=[0.0], uncertainty=1.0, indentation=[0.001], machine=machine)
    assert forward(data).results_at(VALUES[:1]).tolist() == [[0.0]]


def test_a_point_without_a_joint_or_a_result_is_nan_and_costs_infinitely_much():
    data = (measured("indentation"), Measured(quantity="clearance", values=0.1, uncertainty=0.1))
    no_joint, joint = forward(*data, names=("outer_radius",)).results_at(np.array([[15.0], [22.1]]))
    assert np.isnan(no_joint).all()
    assert np.isfinite(joint).all()
    thickness, model = ("liner_thickness",), bs.Tabulated()
    thin = forward(*data, names=thickness, model=model).results_at(np.array([[0.01], [0.02]]))
    assert (np.isnan(thin) == [True, True, True, False]).all()
    transform = ParameterTransform(collect_unknowns({"liner_thickness": (0.01, 6.0)}, (), MODEL))
    only = forward(data[0], names=thickness, model=model)
    problem = Misfit(only, transform, NormalScatter(), by_differences, data[0].uncertainty)
    theta = transform.to_theta([[0.01], [5.0]])
    assert np.isinf(problem.costs(theta)).tolist() == [True, False]
    assert problem.log_posterior(theta[:1]).tolist() == [-np.inf]


UNKNOWNS = collect_unknowns({"clearance": (0.05, 0.2), "liner_young": Normal(mean=1000.0, deviation=80.0)}, (), MODEL)
TRANSFORM = ParameterTransform(UNKNOWNS)
DATA = (measured("indentation", values=[0.02, 0.03, 0.045]), measured("max_pressure", values=[4.0, 7.0, 9.0]))
FILM = replace(DATA[1], saturation=7.0)


def misfit(*data, scatter=None):
    sigma = np.concatenate([0.02 * np.array(rows.values) for rows in data])
    return Misfit(forward(*data), TRANSFORM, scatter or NormalScatter(), by_differences, sigma)


THETA = TRANSFORM.to_theta(VALUES)


def test_differences_are_the_derivatives_of_the_results_and_one_sided_at_the_ends_of_a_range():
    def results_at(theta):
        return forward(*DATA).results_at(TRANSFORM.to_values(theta))

    results, slopes = by_differences(forward(*DATA), TRANSFORM, THETA)
    np.testing.assert_array_equal(results, results_at(THETA))
    for index, shift in enumerate(1e-3 * np.eye(2)):
        expected = (results_at(THETA + shift) - results_at(THETA - shift)) / 2e-3
        np.testing.assert_allclose(slopes[..., index], expected, rtol=1e-5)
    single, _ = by_differences(forward(*DATA), TRANSFORM, THETA[0])
    np.testing.assert_array_equal(single, results[0])
    ends = np.stack([TRANSFORM.low, TRANSFORM.high])
    ends[:, 1] = THETA[0, 1]
    _, slopes = by_differences(forward(*DATA), TRANSFORM, ends)
    for end, step, slope in zip(ends, (1e-4, -1e-4), slopes, strict=True):
        near, at_end = results_at(end + np.array([[step, 0.0], [0.0, 0.0]]))
        np.testing.assert_allclose(slope[:, 0], (near - at_end) / step, rtol=1e-3)


def test_differences_omit_a_neighbour_without_a_result():
    linear = linear_misfit()

    class Edge(type(linear.forward)):
        def results_at(self, values, load_perturbation=0.0):
            results = values @ self.matrix.T
            return np.where(values[:, :1] > TRUTH[0] + 1e-9, np.nan, results)

    theta = linear.transform.to_theta(TRUTH)
    results, slopes = by_differences(Edge(linear.forward.data, MATRIX), linear.transform, theta)
    spans = np.array([unknown(name).prior_deviation for name in NAMES])
    np.testing.assert_allclose(results, MATRIX @ TRUTH, rtol=1e-12)
    np.testing.assert_allclose(slopes, MATRIX * spans, rtol=1e-7)


@pytest.mark.parametrize("scatter", [NormalScatter(), HeavyTailed()], ids=["normal", "heavy-tailed"])
@pytest.mark.parametrize("data", [DATA, (DATA[0], FILM)], ids=["exact", "saturated"])
def test_residuals_have_the_derivatives_that_are_returned(scatter, data):
    problem = misfit(*data, scatter=scatter)
    residuals, slopes = problem.residuals_and_slopes(THETA)
    assert residuals.shape == (2, 7)  # one more for the distribution of the modulus
    np.testing.assert_allclose(residuals[:, -1], TRANSFORM.prior_residuals(THETA)[:, 1])
    np.testing.assert_allclose(slopes[:, -1], [[0.0, 1.0]] * 2)
    for index, shift in enumerate(1e-5 * np.eye(2)):
        above, below = (problem.residuals_and_slopes(theta)[0] for theta in (THETA + shift, THETA - shift))
        np.testing.assert_allclose(slopes[..., index], (above - below) / 2e-5, rtol=1e-3, atol=1e-3)
    np.testing.assert_allclose(problem.costs(THETA), np.sum(residuals**2, axis=1) / 2, rtol=1e-12)


def test_a_saturated_value_is_a_lower_bound_at_its_limit():
    problem = misfit(DATA[0], FILM)
    assert problem.saturated.tolist() == [False] * 4 + [True, True]
    assert problem.value.tolist() == [0.02, 0.03, 0.045, 4.0, 7.0, 7.0]
    above, below = problem.residuals(np.array([[0.02, 0.03, 0.045, 4.0, *ends] for ends in ((9.0, 12.0), (6.0, 6.0))]))
    assert above.max() < 1e-6
    assert below[4] > 7.0


def test_widening_divides_the_standardised_residuals():
    problem = misfit(*DATA)
    results = problem.forward.results_at(TRANSFORM.to_values(THETA))
    wide = replace(problem, widening=2.0)
    np.testing.assert_allclose(wide.standardised_residuals(results), problem.standardised_residuals(results) / 2)
    np.testing.assert_allclose(problem.standardised_residuals(results), (results - problem.value) / problem.uncertainty)
    np.testing.assert_allclose(wide.fisher_information(THETA[0]), problem.fisher_information(THETA[0]) / 4, rtol=1e-12)


@pytest.mark.parametrize(("scatter", "factor"), [(NormalScatter(), 1.0), (HeavyTailed(), 5 / 7)])
def test_the_information_is_the_weighted_product_of_the_slopes(scatter, factor):
    problem = misfit(*DATA, scatter=scatter)
    _, slopes = by_differences(problem.forward, TRANSFORM, THETA[0])
    weighted = slopes.T * factor / problem.uncertainty**2
    np.testing.assert_allclose(problem.fisher_information(THETA[0]), weighted @ slopes, rtol=1e-10)
    errors = np.arange(12.0).reshape(2, 6)
    np.testing.assert_allclose(problem.project_errors(THETA[0], errors), weighted @ errors.T, rtol=1e-10)


def test_a_lower_bound_far_below_the_result_has_no_information():
    linear, theta = linear_misfit(saturation=-10.0), linear_misfit().transform.to_theta(TRUTH)
    object.__setattr__(linear, "value", MATRIX @ TRUTH - 0.4)
    assert abs(linear.fisher_information(theta)).max() < 1e-6
    object.__setattr__(linear, "value", MATRIX @ TRUTH)  # half the density lies above: h² = 2/π of the full weight
    full = linear_misfit().fisher_information(theta)
    np.testing.assert_allclose(linear.fisher_information(theta), 2 / np.pi * full, rtol=1e-9)


@pytest.mark.parametrize("z", [-1.5, -0.3, 0.6])
@pytest.mark.parametrize("scatter", [NormalScatter(), HeavyTailed()], ids=["normal", "heavy-tailed"])
def test_the_information_of_lower_bounds_is_the_curvature_of_the_cost(scatter, z):
    linear = linear_misfit(saturation=-10.0, scatter=scatter)
    object.__setattr__(linear, "value", MATRIX @ TRUTH - 0.02 * z)
    theta, h = linear.transform.to_theta(TRUTH), 2e-3
    above, below = (linear.costs(theta + side * h * np.eye(2)) for side in (1, -1))
    curvature = (above - 2 * linear.costs(theta[None]) + below) / h**2
    np.testing.assert_allclose(np.diag(linear.fisher_information(theta)), np.maximum(curvature, 0.0), rtol=1e-3)


def test_the_log_posterior_is_prior_plus_likelihood_within_the_ranges():
    problem = misfit(*DATA)
    residuals = problem.residuals(problem.forward.results_at(TRANSFORM.to_values(THETA)))
    expected = log_prior(TRANSFORM, THETA) - np.sum(residuals**2, axis=1) / 2
    np.testing.assert_allclose(problem.log_posterior(THETA), expected, rtol=1e-12)
    outside = np.stack([TRANSFORM.high, TRANSFORM.low]) + np.array([[0.1, 0.0], [-0.1, 0.0]])
    assert problem.log_posterior(outside).tolist() == [-np.inf] * 2


@pytest.mark.long
def test_jax_computes_the_derivatives_of_the_results():
    pytest.importorskip("jax")
    from ballsocket.identify.misfit import by_tracing

    model = forward(Measured(quantity="force", values=[1.0, 1.0], uncertainty=1.0, indentation=[0.01, 0.03]))
    results, slopes = by_tracing(model, TRANSFORM, THETA)
    expected, differences = by_differences(model, TRANSFORM, THETA)
    np.testing.assert_allclose(results, expected, rtol=1e-12)
    np.testing.assert_allclose(slopes, differences, rtol=1e-6)
