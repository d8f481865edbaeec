"""Runge-Kutta-Chebyshev steps: exact low orders, convergence and stability."""

import numpy as np
import pytest

from ballsocket.hip.wear_integrator import integrate_step, max_step_length, stage_count


@pytest.mark.parametrize("stages", [2, 3, 5, 12, 60])
def test_a_constant_rate_is_exact_and_has_no_error(stages):
    step = integrate_step(lambda y: np.array([2.0, -1.0]), np.array([1.0, 5.0]), np.array([2.0, -1.0]), 3.0, stages)
    assert step.values == pytest.approx([7.0, 2.0], rel=1e-12)
    assert step.error == pytest.approx([0.0, 0.0], abs=1e-12)
    assert step.rate == pytest.approx([2.0, -1.0])


@pytest.mark.parametrize("stages", [2, 4, 9])
def test_the_error_estimate_is_of_third_order_and_close_to_the_local_error(stages):
    """For y' = λ y the estimate is 0.8 (1 - R) + 0.4 z (1 + R); the local error is R - exp z."""
    estimates = []
    for z in (-0.02, -0.04):
        step = integrate_step(lambda y, z=z: z * y, np.ones(1), np.array([z]), 1.0, stages)
        value = step.values[0]
        assert step.error[0] == pytest.approx(0.8 * (1 - value) + 0.4 * z * (1 + value), rel=1e-9)
        assert step.rate[0] == pytest.approx(z * value)
        estimates.append(step.error[0])
    assert estimates[1] / estimates[0] == pytest.approx(8.0, rel=0.1)


@pytest.mark.parametrize("stages", [2, 3, 5, 12])
def test_a_nonlinear_rate_converges_with_the_third_power_of_a_step(stages):
    """y' = -y², y(0) = 1 has y = 1/(1 + t)."""
    errors = [
        abs(integrate_step(lambda y: -(y**2), np.ones(1), -np.ones(1), h, stages).values[0] - 1 / (1 + h))
        for h in (0.04, 0.02)
    ]
    assert errors[0] / errors[1] == pytest.approx(8.0, rel=0.15)


@pytest.mark.parametrize("stages", [2, 3, 8, 30, 60])
def test_steps_are_stable_and_damped_up_to_their_limit(stages):
    limit = ((stages - 1) ** 2 - 1) / 1.54 if stages > 2 else 0.6
    for z in -np.linspace(0.05, 1.0, 40) * limit:
        value = integrate_step(lambda y, z=z: z * y, np.ones(1), np.array([z]), 1.0, stages).values[0]
        assert abs(value) <= 1.0
    beyond = -4.0 * max(limit, 2.0)
    value = integrate_step(lambda y: beyond * y, np.ones(1), np.array([beyond]), 1.0, stages).values[0]
    assert abs(value) > 1.0


@pytest.mark.parametrize(("length", "radius", "stages"), [(0, 1, 3), (1, 0, 3), (1, 2, 4), (10, 10, 14), (1e9, 1, 60)])
def test_stage_count_covers_the_step(length, radius, stages):
    assert stage_count(length, radius) == stages
    if stages < 60:
        assert ((stages - 1) ** 2 - 1) / 1.54 >= length * radius


def test_the_longest_step_is_stable_with_all_stages():
    assert max_step_length(2.0) == pytest.approx((58**2 - 1) / 1.54 / 2.0)
    assert max_step_length(0.0) == float("inf")
    assert stage_count(0.999 * max_step_length(3.0), 3.0) <= 60
