"""Assembled contacts: statuses, solutions of many joints, and the largest pressure."""

from dataclasses import replace
from math import inf, nan
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact import closed_sphere
from ballsocket.contact.assembly import SolverResult, as_arrays, make_contact, make_scalar_contact
from ballsocket.contact.per_joint import JointContacts, solve_per_joint
from ballsocket.contact.roots import find_peak_pressure
from ballsocket.core.validity import Status

from ..joints import HIP

MODEL = bs.HessForsbach()
LAWS = SimpleNamespace(half_angle=0.5)


def assembled(kind, force, indentation, failures, load=None):
    """Assemble one contact by arrays and by numbers; both must agree."""
    value = {"force": force, "indentation": indentation, "half_angle": 0.5}[kind] if load is None else load
    number = SolverResult(laws=LAWS, force=force, indentation=indentation, failures=failures)
    alone = make_scalar_contact(MODEL, bs.Contact, HIP, kind, value, number)
    masks = {status: np.array([bool(mask)]) for status, mask in failures.items()}
    result = SolverResult(laws=LAWS, force=np.array([force]), indentation=np.array([indentation]), failures=masks)
    _, joint, loads = as_arrays(HIP, np.array([value]))
    many = make_contact(MODEL, bs.Contact, joint, kind, loads, np.array([True]), result, False)
    assert (alone.force, alone.indentation) == pytest.approx((many.force[0], many.indentation[0]), nan_ok=True)
    assert alone.status == many.status[0]
    return alone


@pytest.mark.parametrize(
    ("failures", "status"),
    [
        ({Status.BEYOND_EQUATOR: True}, Status.BEYOND_EQUATOR),
        ({Status.AT_RIM: True, Status.BEYOND_EQUATOR: True}, Status.AT_RIM),
        ({Status.NOT_ROUND: True, Status.AT_RIM: True}, Status.NOT_ROUND),
        ({Status.NOT_CONVERGED: True, Status.NOT_ROUND: True}, Status.NOT_CONVERGED),
        ({Status.DISLOCATED: True, Status.NOT_CONVERGED: True}, Status.DISLOCATED),
        ({Status.NOT_CONVERGED: False}, Status.OK),
    ],
)
def test_the_most_severe_failure_is_the_status(failures, status):
    contact = assembled("half_angle", 3.0, 0.1, failures)
    assert contact.status == status
    expected = (nan, nan) if status.failed else (3.0, 0.1)
    assert (contact.force, contact.indentation) == pytest.approx(expected, nan_ok=True)


def test_a_failed_point_keeps_its_load():
    for kind in ("force", "indentation"):
        contact = assembled(kind, 3.0, 0.1, {Status.NOT_CONVERGED: True})
        assert np.isnan([contact.force, contact.indentation]).tolist() == [kind != "force", kind != "indentation"]
    for number in (nan, inf):
        contact = assembled("force", 3.0, number, {}, load=5.0)
        assert (contact.force, contact.status) == (5.0, Status.NOT_REACHED)


def test_unreached_loads_and_points_outside_the_domain_have_no_result():
    result = SolverResult(laws=LAWS, force=np.array([1.0, 2.0]), indentation=np.array([0.1, 0.2]))
    _, joint, load = as_arrays(HIP, np.array([0.1, 0.2]))
    contact = make_contact(MODEL, bs.Contact, joint, "indentation", load, np.array([True, False]), result, False)
    assert contact.status.tolist() == [0, int(Status.OUTSIDE_DOMAIN)]
    np.testing.assert_array_equal(np.isnan(contact.force), [False, True])
    joint = replace(HIP, liner=bs.Material(young=1000.0, poisson=np.array([0.3, 0.5, 0.3])))
    solution = solve_per_joint(bs.Exact(), joint, np.array([1.0, 1.0, 200.0]), doubled, np.array(0.0))
    np.testing.assert_allclose(solution.force, [0.1, np.nan, np.nan])
    single = solve_per_joint(bs.Exact(), HIP, np.array(2.0), doubled, np.array(0.0))
    assert single.force.shape == ()
    assert single.force == pytest.approx(0.2)


def doubled(joint, load, extra):
    """Solve for a state whose force is the load times the clearance, plus an extra number."""
    touching, reached = load > 0, (load > 0)[load > 0] & (load[load > 0] < 100)
    force = load[touching] * joint.clearance + extra[touching]
    state = SimpleNamespace(force=force, pressure=lambda angle: force * angle)
    return JointContacts(load=load, touching=touching, state=state, reached=reached, error={"force": 0.01 * force})


def test_joints_are_solved_once_with_all_of_their_loads_and_each_has_its_own_solution():
    calls = []

    def solve(joint, load, extra):
        calls.append((joint.clearance, load.tolist()))
        return doubled(joint, load, extra)

    joint = replace(HIP, clearance=np.array([0.1, 0.2, 0.1, 0.2]))
    solution = solve_per_joint(bs.Exact(), joint, np.array([1.0, 2.0, 3.0, 0.0]), solve, np.array(10.0))
    assert sorted(calls) == [(0.1, [1.0, 3.0]), (0.2, [2.0, 0.0])]
    np.testing.assert_allclose(solution.force, [10.1, 10.4, 10.3, 0.0])
    np.testing.assert_allclose(solution.pressure(np.array([[0.5], [2.0]])), np.outer([0.5, 2.0], solution.force))
    np.testing.assert_allclose(solution.pressure(np.array(0.5)), 0.5 * solution.force)
    np.testing.assert_allclose(solution.combine(lambda piece: piece.error["force"]), 0.01 * solution.force)


def test_an_excess_within_the_noise_counts_as_the_pole():
    edge = np.array([1.0])
    largest, angle = find_peak_pressure(lambda a: 1.0 + 1e-5 * a * (1 - a), np.ones(1), edge, 1e-4)
    assert (largest, angle) == (1.0, 0.0)
    largest, angle = find_peak_pressure(lambda a: 1.0 + 1e-5 * a * (1 - a), np.ones(1), edge, 1e-7)
    assert angle == pytest.approx(0.5, abs=1e-3)
    assert largest == pytest.approx(1.0 + 0.25e-5, abs=1e-10)


def test_variables_of_the_hemisphere_estimate_are_clipped():
    angle, ratio, poisson = closed_sphere.polynomial_variables(0.5, 0.3, 4.0)
    assert (angle, ratio, poisson) == pytest.approx((0.5, np.log(4.0), np.log(0.22)))
    low = closed_sphere.polynomial_variables(0.0, -0.9, 0.01)
    assert low == pytest.approx((np.radians(3.0), np.log(0.2), np.log(0.52)))
    high = closed_sphere.polynomial_variables(1.5, 0.4999, 100.0)
    assert high == pytest.approx((np.radians(83.0), np.log(20.0), np.log(0.52 - 0.499)))


@pytest.mark.parametrize("ball", [None, bs.COCR])
@pytest.mark.parametrize("load", [500.0, 3000.0])
def test_estimated_change_on_a_hemisphere_is_that_of_the_exact_solution(ball, load):
    joint = replace(bs.joints["hip-28"], ball=ball)
    contact = bs.Exact().press(joint, force=load)
    change = closed_sphere.hemisphere_indentation_change(contact)
    assert change == pytest.approx(contact.hemisphere["indentation"], rel=0.3, abs=1e-4)
    largest = max(abs(value) for value in contact.hemisphere.values())
    assert closed_sphere.max_hemisphere_change(contact) == pytest.approx(largest, rel=0.4, abs=2e-4)
    softer = replace(joint, ball=bs.Material(young=50e3, poisson=0.3))
    soft = bs.Exact().press(softer, force=load)
    assert closed_sphere.hemisphere_indentation_change(soft) > change
